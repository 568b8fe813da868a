//! Contacts that yield: impacts in series against finite elements, and where the elastic limit lies.

use approx::assert_relative_eq;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::result::Summary;
use impactcheck::scene::{Model, Scene, resolve};

fn series(scene: &str, model: Model, more: &str, strength: &str) -> Summary {
    let text = std::fs::read_to_string(resolve(scene).unwrap()).unwrap();
    let density = "density        = \"7780 kg/m^3\"";
    assert!(text.contains(density));
    let steel = format!("{density}\nyield_strength = \"{strength}\"\nhardening = \"2.1 GPa\"");
    let scene = Scene::parse("series", &(text.replace(density, &steel) + more)).unwrap();
    Reduced::new(&scene, model, None).unwrap().run(1e-7).unwrap()
}

fn efficiencies(summary: &Summary) -> Vec<f64> {
    summary.impacts.iter().map(|impact| impact.quantities.value("efficiency").unwrap()).collect()
}

/// Shakedown against the finite elements of a throw-away prototype with plastic elements (Table 1's scenes, all bodies alike,
/// Y = 600 MPa, H = E/100): a low start, a rise, a steady state above the elastic efficiency.
#[test]
fn repeated_impacts_shake_down_as_in_finite_elements() {
    for (scene, elastic, first, second, steady, peaks) in [
        ("scaled-plate-r10", 0.6946, 0.570, 0.653, 0.7043, [496.0, 421.0]),
        ("scaled-plate-r6.35", 0.3868, 0.333, 0.405, 0.4376, [158.0, 99.0]),
    ] {
        let summary = series(scene, Model::C, "\n[series]\nimpacts = 20\n", "600 MPa");
        let found = efficiencies(&summary);
        assert_relative_eq!(found[0], first, max_relative = 0.02);
        assert_relative_eq!(found[1], second, max_relative = 0.02);
        let last = *found.last().unwrap();
        assert_relative_eq!(last, steady, max_relative = 0.015);
        assert!(last > elastic && found.windows(2).all(|pair| pair[1] > pair[0]), "{found:?}");
        for (name, peak) in ["outer_force_peak", "inner_force_peak"].into_iter().zip(peaks) {
            assert_relative_eq!(summary.value(name).unwrap(), peak, max_relative = 0.03);
        }
        assert_eq!(summary.value("efficiency"), Some(last));
        let work = summary.impacts.last().unwrap().plastic_work.unwrap();
        assert!(found.len() < 20 && work < 3e-4 * 5e-3, "{} impacts, {work} J", found.len());
    }
}

/// The dents of the spheres decide the sign: with a fresh spot each time the steady state stays below the elastic efficiency.
#[test]
fn fresh_spots_stay_below_the_elastic_efficiency() {
    let fresh =
        series("scaled-plate-r10", Model::B, "\n[series]\nimpacts = 8\nsphere_spot = \"fresh\"\n", "600 MPa");
    let found = efficiencies(&fresh);
    let elastic = series("scaled-plate-r10", Model::B, "", "6000 MPa").value("efficiency").unwrap();
    assert_eq!(found.len(), 8);
    let told = |warning: &String| warning.contains("finite elements");
    assert!(!fresh.warnings.iter().any(told), "{:?}", fresh.warnings);
    assert!(found[0] < found[7] && found[7] < 0.95 * elastic, "{found:?} {elastic}");
}

/// Efficiency of the first three impacts and of the eighth where plate and spheres yield at strengths of their own or strike with fresh
/// spots, against the finite elements of `fem_reference` on one mesh (6 elements per contact radius, which is worth half a percent in the
/// first impact).
#[test]
fn surfaces_that_yield_unlike_shake_down_as_in_finite_elements() {
    let scene = |[plate, spheres]: [Option<&str>; 2], size: [&str; 3], spot: &str| {
        let yields = |strength: Option<&str>| {
            strength.map_or(String::new(), |y| format!(", yield_strength = \"{y}\", hardening = \"2.1 GPa\""))
        };
        let steel = "youngs_modulus = \"210 GPa\", poisson_ratio = 0.3, density = 7780";
        let [thickness, radius, speed] = size;
        let text = format!(
            r#"
            name = "unlike"
            kind = "plate-impact"
            materials.plate = {{ {steel}{} }}
            materials.sphere = {{ {steel}{} }}
            plate = {{ radius = "33 mm", thickness = "{thickness}", edge = "clamped", material = "plate" }}
            outer = {{ kind = "sphere", radius = "{radius}", material = "sphere", speed = "{speed}" }}
            inner = {{ kind = "sphere", radius = "{radius}", material = "sphere" }}
            series = {{ impacts = 8, sphere_spot = "{spot}" }}
            "#,
            yields(plate),
            yields(spheres)
        );
        Scene::parse("unlike", &text).unwrap()
    };
    let table1 = ["2 mm", "10 mm", "550 mm/s"];
    for (strengths, size, spot, found) in [
        ([Some("350 MPa"), None], table1, "same", [0.4825, 0.5798, 0.6341, 0.7009]),
        ([None, Some("350 MPa")], table1, "same", [0.4918, 0.5923, 0.6423, 0.7033]),
        // spheres of 600 MPa hardly yield before a plate of 350 MPa, and a fresh spot of them changes next to nothing
        ([Some("350 MPa"), Some("600 MPa")], table1, "fresh", [0.4824, 0.5799, 0.6339, 0.7003]),
        ([Some("600 MPa"), None], ["2 mm", "6.35 mm", "800 mm/s"], "same", [0.3532, 0.4430, 0.4732, 0.4919]),
        // without the plate's bending -2.0 and -4.2 % in the end
        ([Some("600 MPa"); 2], table1, "fresh", [0.569, 0.623, 0.634, 0.638]),
        ([Some("400 MPa"); 2], ["2 mm", "6.35 mm", "550 mm/s"], "fresh", [0.2815, 0.3435, 0.3647, 0.3754]),
        (
            [Some("450 MPa"), None],
            ["1.5 mm", "6.35 mm", "500 mm/s"],
            "same",
            [0.4517, 0.5488, 0.5826, 0.6162],
        ),
    ] {
        let summary = Reduced::new(&scene(strengths, size, spot), Model::C, None).unwrap().run(1e-7).unwrap();
        let ours = efficiencies(&summary);
        for k in 0..3 {
            assert_relative_eq!(ours[k], found[k], max_relative = 0.04);
        }
        assert_relative_eq!(*ours.last().unwrap(), found[3], max_relative = 0.015);
        assert!(summary.energy_residual.unwrap() < 1e-3, "{:?}", summary.energy_residual);
        let told =
            summary.warnings.iter().any(|warning| warning.contains("the plate yields before the bodies"));
        let softer = strengths[0].is_some() && strengths[0] != strengths[1];
        assert_eq!(told, softer, "{:?}", summary.warnings);
    }
}

/// A contact that does not reach its onset of yield takes the elastic branch: the same steps and bits as without.
#[test]
fn below_the_onset_of_yield_everything_is_elastic() {
    let scene = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    let elastic = Reduced::new(&scene, Model::C, None).unwrap().run(1e-7).unwrap();
    let strong = series("scaled-plate-r10", Model::C, "\n[series]\nimpacts = 5\n", "2000 MPa");
    assert_eq!((strong.quantities, strong.steps), (elastic.quantities, elastic.steps));
    assert_eq!(strong.impacts.len(), 1);
}

/// Steel that yields at 600 MPa where `soft` says so, of outer body, plate and inner body, struck once at `speed` m/s.
fn struck(soft: [bool; 3], plate: &str, speed: f64, model: Model) -> Summary {
    let [outer, middle, inner] = soft.map(|soft| if soft { "b" } else { "a" });
    let text = format!(
        r#"
        name = "struck"
        kind = "plate-impact"
        materials.a = {{ youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = 7780 }}
        materials.b = {{ youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = 7780, yield_strength = 6e8, hardening = 0 }}
        plate = {{ {plate}, edge = "clamped", material = "{middle}" }}
        outer = {{ kind = "sphere", radius = "10 mm", material = "{outer}", speed = {speed:e} }}
        inner = {{ kind = "sphere", radius = "10 mm", material = "{inner}" }}
        series.impacts = 1
        "#
    );
    Reduced::new(&Scene::parse("struck", &text).unwrap(), model, None).unwrap().run(1e-7).unwrap()
}

/// Bisection between speeds with and without plastic work in the model itself ends at the elastic limit it tells; a plate that yields alone
/// does so where its bending pulls it.
#[test]
fn the_elastic_limit_is_where_the_model_begins_to_yield() {
    let plate = "radius = \"33 mm\", thickness = \"2 mm\"";
    for (soft, model) in
        [([true, false, false], Model::C), ([false, false, true], Model::B), ([false, true, false], Model::B)]
    {
        let limit = struck(soft, plate, 0.55, model).elastic_limit.unwrap();
        assert_eq!(
            [limit.outer, limit.inner].map(|speed| speed.is_some()),
            [!soft[2], !soft[0]],
            "{limit:?}"
        );
        let told = limit.outer.into_iter().chain(limit.inner).reduce(f64::min);
        let yields = |speed: f64| struck(soft, plate, speed, model).impacts[0].plastic_work != Some(0.0);
        let (mut low, mut high) = (0.001, 0.1);
        assert!(!yields(low) && yields(high));
        while high - low > 1e-4 * high {
            let middle = 0.5 * (low + high);
            if yields(middle) { high = middle } else { low = middle }
        }
        assert_relative_eq!(told.unwrap(), high, max_relative = 3e-4);
    }
    assert_eq!(struck([false; 3], plate, 0.55, Model::B).elastic_limit, None);
}

/// On a plate that hardly gives way it is the closed form of a rigid wall (Johnson 1985, eq. 11.39): m V^2/2 = (8/15) E* R^(1/2) d^(5/2),
/// d = R (pi p/(2 E*))^2, p = 1.615 Y at first yield (Jackson and Green 2005).
#[test]
fn the_elastic_limit_on_a_thick_plate_is_that_of_a_rigid_wall() {
    let found = struck([true; 3], "radius = \"400 mm\", thickness = \"200 mm\"", 0.55, Model::B);
    let modulus = 0.5 * 210e9 / (1.0 - 0.09);
    let pressure = 1.295 * (0.736_f64 * 0.3).exp() * 600e6;
    let approach = 0.01 * (std::f64::consts::PI * pressure / (2.0 * modulus)).powi(2);
    let energy = 8.0 / 15.0 * modulus * 0.1 * approach.powf(2.5);
    let mass = 7780.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6;
    let wall = (2.0 * energy / mass).sqrt();
    assert_relative_eq!(found.elastic_limit.unwrap().outer.unwrap(), wall, max_relative = 0.01);
}
