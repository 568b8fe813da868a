//! What is made as large as can be.

use crate::error::{Error, Result};
use crate::kinds::{self, INTENDED_SPEED};
use crate::scene::{Scene, unknown_name};

/// A number of a result that is to be large.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective {
    /// The quantity of this name and unit.
    Quantity(&'static str, &'static str),
    /// The speed along the direction that a scene intends, m/s, with a direction within so much (rad) of it; beyond that less.
    IntendedSpeed(f64),
}

impl Objective {
    /// The one called `name` for `scene`; without name that of its kind, a speed in an intended direction `within` so many rad of it
    /// if given.
    ///
    /// # Errors
    /// [`Error::Usage`] if the scene has no such quantity, or `within` belongs to none.
    pub fn of(name: Option<&str>, within: Option<f64>, scene: &Scene) -> Result<Self> {
        let kind = kinds::of(scene);
        let own = kind.objective(scene);
        let name = name.unwrap_or(own);
        let intends = own == INTENDED_SPEED;
        if intends && name == INTENDED_SPEED {
            return Ok(Self::IntendedSpeed(within.unwrap_or(std::f64::consts::PI)));
        }
        if within.is_some() {
            return Err(Error::Usage(format!(
                "--within belongs to the {INTENDED_SPEED} of a seal seat, not to {name}"
            )));
        }
        let quantities = kind.quantities();
        if let Some(quantity) = quantities.iter().find(|quantity| quantity.name == name && !quantity.is_count)
        {
            return Ok(Self::Quantity(quantity.name, quantity.unit));
        }
        let names: Vec<&str> =
            intends.then_some(INTENDED_SPEED).into_iter().chain(quantities.iter().map(|q| q.name)).collect();
        let message = format!("--objective {name}: scene `{}` has no such quantity", scene.name);
        Err(unknown_name(message, name, &names))
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Quantity(name, _) => name,
            Self::IntendedSpeed(_) => INTENDED_SPEED,
        }
    }

    /// Its SI unit; "1" for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Quantity(_, unit) => unit,
            Self::IntendedSpeed(_) => "m/s",
        }
    }

    /// Its value in a result of `scene` whose quantities are `value`; `None` if that does not determine it.
    pub fn value(self, scene: &Scene, value: impl Fn(&str) -> Option<f64>) -> Option<f64> {
        match self {
            Self::Quantity(name, _) => value(name),
            Self::IntendedSpeed(within) => kinds::of(scene).intended_speed(scene, within, &value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Template;

    #[test]
    fn the_speed_in_the_intended_direction_is_a_projection() {
        let scene =
            Template::parse("seat", include_str!("../../../scenes/seal-seat-improved.toml")).expect("scene");
        let objective = Objective::of(None, None, scene.scene()).expect("a seal seat's");
        let along = |angle: f64| {
            let [x, z] = [2.0 * angle.to_radians().sin(), 2.0 * angle.to_radians().cos()];
            objective.value(scene.scene(), |name| Some(if name == "sphere_velocity_x" { x } else { z }))
        };
        // intended are 15 degrees
        assert!((along(15.0).unwrap() - 2.0).abs() < 1e-12 && along(105.0).unwrap().abs() < 1e-12);
        assert!((along(75.0).unwrap() - 1.0).abs() < 1e-12);
        let within = Objective::of(None, Some(2_f64.to_radians()), scene.scene()).expect("a seal seat's");
        let at = |angle: f64| {
            let [x, z] = [2.0 * angle.to_radians().sin(), 2.0 * angle.to_radians().cos()];
            within.value(scene.scene(), |name| Some(if name == "sphere_velocity_x" { x } else { z })).unwrap()
        };
        assert_eq!(Some(at(13.5)), along(13.5));
        assert!(at(11.0) < 0.7 * along(11.0).unwrap() && at(11.0) < at(12.0));
    }

    #[test]
    fn objectives_are_quantities_of_the_kind() {
        let plate =
            Template::parse("base", include_str!("../../../scenes/scaled-plate-r10.toml")).expect("scene");
        assert_eq!(Objective::of(None, None, plate.scene()).unwrap(), Objective::Quantity("efficiency", "1"));
        assert_eq!(Objective::of(Some("inner_force_peak"), None, plate.scene()).unwrap().unit(), "N");
        let meeting = |struck: &str| {
            let (head, end) = ("name = \"o\"\nkind = \"impact\"\n", "material = \"steel\"\n");
            let steel = "[materials.steel]\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\ndensity = 7780\n";
            let outer = "[outer]\nkind = \"sphere\"\nradius = 0.01\nspeed = 0.5\n";
            let text = format!("{head}{steel}{outer}{end}{struck}{end}");
            let scene = Template::parse("o", &text).expect("scene");
            Objective::of(None, None, scene.scene()).expect("an objective").name()
        };
        assert_eq!(meeting("[wall]\n"), "outer_restitution");
        assert_eq!(meeting("[inner]\nkind = \"sphere\"\nradius = 0.01\n"), "efficiency");
        for name in ["intended_speed", "outer_contacts", "sphere_speed"] {
            let refused = Objective::of(Some(name), None, plate.scene()).unwrap_err();
            assert!(refused.to_string().contains(name), "{refused}");
            assert!(refused.hints().iter().any(|hint| hint.contains("efficiency")), "{refused:?}");
        }
    }
}
