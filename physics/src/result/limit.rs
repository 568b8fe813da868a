//! How near a result comes to the bounds of the theories that the reduced models and the reference share.

use crate::contact::Hertz;
use crate::scene::Material;
use serde::{Deserialize, Serialize};

/// A theory that is relied on up to a bound of a dimensionless measure.
#[derive(Debug, Clone, Copy)]
pub struct Theory {
    /// The measure, as part of names; after the place in sentences.
    measure: &'static str,
    /// Largest value up to which the theory is relied on.
    pub(crate) bound: f64,
    /// What is wrong beyond, and what to do.
    beyond: &'static str,
}

/// Contact of half-spaces: radius of the contact patch over that of the tip. Of a rigid sphere (Sneddon, Int. J. Eng. Sci. 3,
/// 1965, 47) Hertz's force at the same approach is 0.4 % high at the bound.
pub const HERTZ: Theory = Theory {
    measure: "contact_radius_over_tip_radius",
    bound: 0.2,
    beyond: "Hertz's law assumes a contact that is small compared with the tip; for a rigid sphere its force is 0.4 % too large at 0.2 and 3 % at 0.5",
};

/// Linear elasticity: largest shear strain below a contact, 0.31 p0 / G (Johnson, Contact Mechanics, 1985, section 4.2).
pub const SMALL_STRAIN: Theory = Theory {
    measure: "shear_strain",
    bound: 0.02,
    beyond: "linear elasticity is not accurate at such strains, and most solids yield before",
};

/// Linear theory of plates: deflection over thickness w/t. A clamped plate under a central force is stiffer by 0.443 (w/t)^2
/// (Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, 2nd ed., article 100): 4 % at the bound.
pub const SMALL_DEFLECTION: Theory = Theory {
    measure: "deflection_over_thickness",
    bound: 0.3,
    beyond: "linear plate theory omits that the plate stretches; a clamped plate is 4 % stiffer at 0.3 and 11 % at 0.5",
};

/// Linear theory of beams: deflection of the tip over the length x. A cantilever that a moment bends to a circle deflects less by x^2/3, and
/// its tip comes nearer to the base by 2 x^2/3 of the length.
pub const SMALL_ROTATION: Theory = Theory {
    measure: "tip_deflection_over_length",
    bound: 0.2,
    beyond: "linear beam theory omits large rotations; a beam bent by a moment deflects 1.3 % less at 0.2 and 8 % less at 0.5",
};

/// Quasi-static contact: impact speed over sqrt(E/rho), the wave speed of a bar, of the slowest body (Johnson 1985, section
/// 11.4). The share of the energy left in waves grows as its 3/5th power (Hutchings, J. Phys. D 12, 1979, 1819).
pub const QUASI_STATIC: Theory = Theory {
    measure: "impact_speed_over_wave_speed",
    bound: 0.01,
    beyond: "the contact is not quasi-static; some per cent of the energy remain in waves within the bodies, which the reduced models take as rigid",
};

/// Elasticity: Hertz's largest pressure over 1.6 times the yield strength, at which plastic flow begins below the surface
/// (Johnson 1985, section 6.1, von Mises).
pub const ELASTICITY: Theory = Theory {
    measure: "contact_pressure_over_onset_of_yield",
    bound: 1.0,
    beyond: "the contact yields (below the surface, from a pressure of 1.6 times the yield strength on), but the model is elastic; specify `hardening` of the material, or reduce the speed",
};

/// The plate's elasticity beside its contacts: largest bending stress along its faces over its yield strength.
pub const ELASTIC_BENDING: Theory = Theory {
    measure: "bending_stress_over_yield_strength",
    bound: 1.0,
    beyond: "the plate yields in bending, which the reduced models omit",
};

/// How near a result comes to the bound of a theory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Place and measure, such as `outer_shear_strain`.
    pub measure: String,
    /// Value of the measure.
    pub value: f64,
    /// Largest value up to which the theory is relied on.
    pub bound: f64,
}

/// Largest shear stress below a Hertz contact over its largest pressure (Johnson 1985, section 4.2).
const SHEAR: f64 = 0.31;
/// Plastic flow below a Hertz contact begins at this multiple of the yield strength (Johnson 1985, section 6.1, von Mises).
const ONSET_OF_YIELD: f64 = 1.6;

/// The limits of a contact by `law` at `place` under its largest `force` in N, between bodies of these elastic `materials`.
pub(crate) fn of_contact<'m>(
    place: &str,
    law: &Hertz,
    force: f64,
    materials: &[&'m Material],
) -> impl Iterator<Item = Limit> + use<'m> {
    let pressure = law.maximum_pressure(force);
    let least = |of: fn(&Material) -> Option<f64>| materials.iter().filter_map(|m| of(m)).reduce(f64::min);
    let strain = least(|m| Some(m.shear_modulus())).map(|g| SMALL_STRAIN.at(place, SHEAR * pressure / g));
    let yielding = least(|m| m.yield_strength).map(|y| ELASTICITY.at(place, pressure / (ONSET_OF_YIELD * y)));
    [Some(HERTZ.at(place, law.contact_radius(force) / law.tip_radius)), strain, yielding]
        .into_iter()
        .flatten()
}

impl Theory {
    /// The limit at `place` where the measure is `value`.
    pub fn at(&self, place: &str, value: f64) -> Limit {
        Limit { measure: format!("{place}_{}", self.measure), value, bound: self.bound }
    }
}

impl Limit {
    /// Whether the measure is beyond its bound.
    pub fn is_exceeded(&self) -> bool {
        self.value > self.bound
    }

    /// Whether it is about the yield strength of a material.
    pub fn is_of_yield(&self) -> bool {
        self.measure.ends_with(ELASTICITY.measure)
    }

    /// If the bound is exceeded: by what, and what that means, in one sentence.
    pub fn warning(&self) -> Option<String> {
        let theories = [
            HERTZ,
            SMALL_STRAIN,
            SMALL_DEFLECTION,
            SMALL_ROTATION,
            QUASI_STATIC,
            ELASTICITY,
            ELASTIC_BENDING,
        ];
        let theory = theories.iter().find(|theory| self.measure.ends_with(theory.measure))?;
        let measure = self.measure.replace("_over_", " / ").replace('_', " ");
        self.is_exceeded().then(|| {
            let value = beyond(self.value, self.bound);
            format!("{measure} is {value}, above its limit of {}: {}", self.bound, theory.beyond)
        })
    }
}

/// `value`, which is larger than `bound`, with two significant digits, or as many more as show that it is.
fn beyond(value: f64, bound: f64) -> String {
    let fewest = (1.0 - value.log10().floor()).clamp(0.0, 6.0) as usize;
    let with = |decimals: usize| format!("{value:.decimals$}");
    let shows = |text: &String| text.parse::<f64>().is_ok_and(|rounded| rounded > bound);
    (fewest..fewest + 4).map(with).find(shows).unwrap_or_else(|| with(fewest + 4))
}

#[cfg(test)]
mod tests {
    use super::{HERTZ, Limit, SMALL_ROTATION};

    /// Sneddon's rigid sphere of radius R on a half-space, patch of radius a: delta = a/2 ln((R+a)/(R-a)),
    /// F = E*/2 ((a^2 + R^2) ln((R+a)/(R-a)) - 2 a R).
    #[test]
    fn hertz_is_as_far_off_at_its_bound_as_is_said() {
        let error = |a: f64| {
            let log = ((1.0 + a) / (1.0 - a)).ln();
            let (approach, force) = (0.5 * a * log, 0.5 * ((1.0 + a * a) * log - 2.0 * a));
            4.0 / 3.0 * approach.powf(1.5) / force - 1.0
        };
        assert!((error(HERTZ.bound) - 0.004).abs() < 1e-4 && (error(0.5) - 0.03).abs() < 2e-3);
    }

    /// A beam that a moment bends is a circle: with the angle a = 2 x its tip deflects by (1 - cos a)/a of the length.
    #[test]
    fn a_bender_deflects_as_much_less_as_is_said() {
        let less = |x: f64| 1.0 - (1.0 - (2.0 * x).cos()) / (2.0 * x) / x;
        assert!((less(SMALL_ROTATION.bound) - 0.013).abs() < 5e-4, "{}", less(0.2));
        assert!((less(0.5) - 0.08).abs() < 5e-3, "{}", less(0.5));
    }

    #[test]
    fn only_what_exceeds_its_bound_is_warned_of() {
        assert_eq!(HERTZ.at("outer", 0.2).warning(), None);
        assert_eq!(HERTZ.at("outer", f64::NAN).warning(), None);
        let warning_text = HERTZ.at("outer", 0.25).warning().expect("beyond");
        assert!(
            warning_text.starts_with("outer contact radius / tip radius is 0.25, above its limit of 0.2: "),
            "{warning_text}"
        );
        let barely = HERTZ.at("outer", 0.2004).warning().expect("beyond");
        assert!(barely.contains("is 0.2004, above"), "{barely}");
        let unknown = Limit { measure: "x".into(), value: 2.0, bound: 1.0 };
        assert_eq!(unknown.warning(), None);
    }
}
