//! What is made as large as can be.

use crate::error::{Error, Result};
use crate::kinds;
use crate::scene::{Scene, Setup, suggestion};

/// A number of a result that is to be large.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective {
    /// The quantity of this name and unit.
    Quantity(&'static str, &'static str),
    /// Of a seal seat: the sphere's velocity along the intended direction, m/s.
    IntendedSpeed,
}

/// Name of [`Objective::IntendedSpeed`].
const INTENDED_SPEED: &str = "intended_speed";

impl Objective {
    /// The one called `name` for `scene`; without name the efficiency of a plate's impact, and of a seal seat the speed in the
    /// intended direction.
    ///
    /// # Errors
    /// [`Error::Usage`] if the scene has no such quantity.
    pub fn of(name: Option<&str>, scene: &Scene) -> Result<Self> {
        let is_seat = matches!(scene.setup, Setup::SealSeat(_));
        let name = name.unwrap_or(if is_seat { INTENDED_SPEED } else { "efficiency" });
        if is_seat && name == INTENDED_SPEED {
            return Ok(Self::IntendedSpeed);
        }
        let quantities = kinds::of(scene).quantities();
        if let Some(quantity) = quantities.iter().find(|quantity| quantity.name == name && !quantity.is_count)
        {
            return Ok(Self::Quantity(quantity.name, quantity.unit));
        }
        let names: Vec<&str> =
            is_seat.then_some(INTENDED_SPEED).into_iter().chain(quantities.iter().map(|q| q.name)).collect();
        let hint = suggestion(name, names.iter().copied()).map(|near| format!("; did you mean `{near}`?"));
        Err(Error::Usage(format!(
            "--objective {name}: scene `{}` has no such number{} (there: {})",
            scene.name,
            hint.unwrap_or_default(),
            names.join(", ")
        )))
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Quantity(name, _) => name,
            Self::IntendedSpeed => INTENDED_SPEED,
        }
    }

    /// Its SI unit; "1" for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Quantity(_, unit) => unit,
            Self::IntendedSpeed => "m/s",
        }
    }

    /// Its value in a result of `scene` whose quantities are `value`; `None` if that does not determine it.
    pub fn value(self, scene: &Scene, value: impl Fn(&str) -> Option<f64>) -> Option<f64> {
        match self {
            Self::Quantity(name, _) => value(name),
            Self::IntendedSpeed => {
                let (sin, cos) = scene.seal_seat().ok()?.intended_angle.sin_cos();
                Some(value("sphere_velocity_x")? * sin + value("sphere_velocity_z")? * cos)
            }
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
            Template::parse("seat", include_str!("../../scenes/seal-seat-improved.toml")).expect("scene");
        let objective = Objective::of(None, scene.scene()).expect("a seal seat's");
        let along = |angle: f64| {
            let [x, z] = [2.0 * angle.to_radians().sin(), 2.0 * angle.to_radians().cos()];
            objective.value(scene.scene(), |name| Some(if name == "sphere_velocity_x" { x } else { z }))
        };
        // intended are 15 degrees
        assert!((along(15.0).unwrap() - 2.0).abs() < 1e-12 && along(105.0).unwrap().abs() < 1e-12);
        assert!((along(75.0).unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn objectives_are_quantities_of_the_kind() {
        let plate =
            Template::parse("base", include_str!("../../scenes/scaled-plate-r10.toml")).expect("scene");
        assert_eq!(Objective::of(None, plate.scene()).unwrap(), Objective::Quantity("efficiency", "1"));
        assert_eq!(Objective::of(Some("inner_force_peak"), plate.scene()).unwrap().unit(), "N");
        for name in ["intended_speed", "outer_contacts", "sphere_speed"] {
            let told = Objective::of(Some(name), plate.scene()).unwrap_err().to_string();
            assert!(told.contains(name) && told.contains("efficiency"), "{told}");
        }
    }
}
