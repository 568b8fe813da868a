//! Numbers that are admissible and yet hardly meant: a forgotten unit most often.

use super::{Material, Scene, Tolerance};

/// Densities of solids, from aerogel-filled foams to osmium, in kg/m^3.
const DENSITY: [f64; 2] = [50.0, 23e3];
/// Young's moduli from soft rubber to diamond, in Pa.
const MODULUS: [f64; 2] = [1e5, 1.3e12];

/// One sentence per doubtful number, none if there is none.
pub fn doubts(scene: &Scene) -> Vec<String> {
    let mut found = scene.setup.bodies().doubts();
    for (model, tolerances) in &scene.tolerances {
        for (quantity, Tolerance { relative, .. }) in tolerances {
            if let Some(relative) = relative.filter(|r| *r > 1.0) {
                found.push(format!(
                    "tolerances.{model}.{quantity}: relative = {relative} is {} %; a share is meant, 0.05 for 5 %",
                    100.0 * relative
                ));
            }
        }
    }
    found.dedup();
    found
}

/// Doubts about a material.
pub(crate) fn material(material: &Material) -> Vec<String> {
    let name = |key: &str| format!("materials.{}.{key}", material.name);
    [
        outside(&name("density"), material.density, DENSITY, "kg/m^3"),
        outside(&name("youngs_modulus"), material.youngs_modulus, MODULUS, "Pa"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// A doubt about a `value` in `unit` that lies outside its usual range.
pub(crate) fn outside(name: &str, value: f64, [low, high]: [f64; 2], unit: &str) -> Option<String> {
    (!(low..=high).contains(&value)).then(|| {
        format!(
            "{name} = {value:e} {unit} lies outside {low:e} to {high:e} {unit}; a number without unit is in {unit}"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::doubts;
    use crate::scene::Scene;

    fn text(plate: &str, density: &str, relative: &str) -> String {
        format!(
            r#"
            name = "x"
            kind = "plate-impact"
            materials.steel = {{ youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = {density} }}
            plate = {{ radius = {plate}, thickness = "2 mm", edge = "clamped", material = "steel" }}
            outer = {{ kind = "sphere", radius = "8 mm", material = "steel", speed = "550 mm/s" }}
            inner = {{ kind = "sphere", radius = "8 mm", material = "steel" }}
            tolerances.B = {{ efficiency = {{ relative = {relative} }} }}
            "#
        )
    }

    fn scene(plate: &str, density: &str, relative: &str) -> Scene {
        Scene::parse("x.toml", &text(plate, density, relative)).expect("valid")
    }

    #[test]
    fn a_forgotten_unit_is_doubted_once() {
        assert_eq!(doubts(&scene("\"33 mm\"", "7780", "0.05")), Vec::<String>::new());
        let found = doubts(&scene("33", "7.78", "5"));
        assert_eq!(found.len(), 3, "{found:?}");
        assert!(found[0].starts_with("materials.steel.density = 7.78e0 kg/m^3"), "{found:?}");
        assert!(found[1].starts_with("plate.radius = 3.3e1 m"), "{found:?}");
        assert!(found[2].contains("500 %"), "{found:?}");
        let rod = doubts(&scene("\"0.3 mm\"", "7780", "0.05"));
        assert!(rod[0].contains("6.667 times plate.radius"), "{rod:?}");
    }

    #[test]
    fn a_film_too_wide_for_lubrication_theory_is_doubted() {
        let of = |gap: &str| {
            let fluid = format!("fluid = {{ viscosity = 0.01, density = 1000, minimum_gap = \"{gap}\" }}\n");
            let text =
                text("\"33 mm\"", "7780", "0.05").replace("tolerances.B", &format!("{fluid}tolerances.B"));
            doubts(&Scene::parse("x.toml", &text).expect("valid"))
        };
        // at 0.01 of the tip's radius the exact force is larger by 0.01 (ln 100/5 + 0.9713) of that of lubrication theory
        assert_eq!(of("10 um"), Vec::<String>::new());
        assert!(of("80 um")[0].contains("about 2 % of the film's force"), "{:?}", of("80 um"));
        assert!(of("5 mm").len() == 1, "{:?}", of("5 mm"));
    }
}
