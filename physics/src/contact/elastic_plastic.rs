//! The virgin surface of a body that yields, pressed flat over a circle.
//!
//! Loading: Jackson & Green, A finite element study of elasto-plastic hemispherical contact against a rigid flat, J. Tribology 127
//! (2005) 343, eqs. (16) to (23), which is Hertz's law up to about twice the critical approach. What stays of it: Etsion, Kligerman &
//! Kadin, Unloading of an elastic-plastic loaded spherical contact, Int. J. Solids Struct. 42 (2005) 3716, eqs. (13) and (15). Both
//! are written per radius a of the contact: then the mean pressure p depends on how far the surface has been flattened, a/rho, and
//! on nothing else, rho the radius of the curvature that it has lost. The law knows no hardening.

use crate::numerics::root::{root, root_near};
use std::f64::consts::PI;

/// Greatest hardness over the yield strength.
const HARDNESS: f64 = 2.84;
/// Critical approaches up to which the contact is as wide as Hertz's, and loading is his law.
const ELASTIC: f64 = 1.9;
/// Exponent with which the mean pressure grows once it is that of full plasticity: hardly, but an approach has to tell the pressure.
const HARDER: f64 = 1e-3;
/// Critical approaches between which the largest mean pressure and the evenest one are looked for, and steps of a search.
const SEARCHED: [f64; 2] = [ELASTIC, 1e4];
const SEARCH_STEPS: usize = 60;

/// Share of the yield strength that is left at least where the surface is pulled along itself.
const LEAST_STRENGTH: f64 = 0.1;

/// Depth of a half-space under a pressure of Hertz's distribution, and twice what the middle is deeper than the edge: both 3 pi/4; and of
/// an even pressure: 2, and 4 - 8/pi. In units of p a/E' (Johnson, Contact Mechanics, 1985, sections 3.4 and 4.2).
const HERTZ: f64 = 0.75 * PI;
const EVEN: [f64; 2] = [2.0, 4.0 - 8.0 / PI];

/// Largest shear stress on the axis over the mean pressure, of Hertz's distribution and an even one, nu = 0.3 (Johnson 1985, sections 4.2
/// and 3.4).
const SHEAR: [f64; 2] = [0.465, 0.332];

/// Power of the approach with which that stress grows, about: 1/2 of Hertz's contact, less of one that yields.
const SHEARED_POWER: f64 = 0.3;

/// Surface of a material that yields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticPlastic {
    /// E' = E/(1 - nu^2) in Pa.
    modulus: f64,
    /// Yield strength in Pa without a stress along the surface, and Poisson's ratio.
    yield_strength: f64,
    poisson_ratio: f64,
    /// a/rho at the onset of yield, pi C Y/(2 E').
    onset: f64,
    /// B: how the contact grows beyond Hertz's.
    growth: f64,
    /// 4/(C Y) times the largest hardness.
    constraint: f64,
    /// Critical approaches at which the mean pressure is largest, and that pressure in Pa: there it stays, where the fit would let it fall.
    hardest: [f64; 2],
    /// Critical approaches at which the pressure is most even, and how even: so it stays.
    evenest: [f64; 2],
}

/// State of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flattened {
    /// Its approach over the critical one.
    pub approach: f64,
    /// Mean pressure in Pa.
    pub pressure: f64,
    /// Radius of the contact over the radius of the curvature that it has lost: for good, and all of it.
    pub lasting: f64,
    pub flattening: f64,
    /// Depth that stays over the radius of the contact.
    pub stays: f64,
    /// Depth that comes back, in units of p a/E'.
    pub recovers: f64,
    /// From Hertz's distribution of the pressure, 0, to an even one, 1.
    pub evenness: f64,
    /// n of the force (depth)^n when it is let go and pressed again.
    pub exponent: f64,
}

impl Flattened {
    /// Virgin, without pressure.
    pub const NONE: Flattened = Flattened {
        approach: 0.0,
        pressure: 0.0,
        lasting: 0.0,
        flattening: 0.0,
        stays: 0.0,
        recovers: HERTZ,
        evenness: 0.0,
        exponent: 1.5,
    };

    /// The curvature times a that an elastic surface loses under the same pressure, in units of p/E': the more even the pressure is
    /// the less it bends the surface for its depth.
    pub fn bends(&self) -> f64 {
        HERTZ + self.evenness * (EVEN[1] - HERTZ)
    }

    /// Largest shear stress that an elastic surface has under the same pressure, over the mean pressure: the more even the pressure
    /// is the later it yields.
    pub fn shears(&self) -> f64 {
        SHEAR[0] + self.evenness * (SHEAR[1] - SHEAR[0])
    }
}

/// Where within [`SEARCHED`] a function with one peak has it.
fn largest(f: impl Fn(f64) -> f64) -> f64 {
    let [mut low, mut high] = SEARCHED.map(f64::ln);
    for _ in 0..SEARCH_STEPS {
        let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if f(a.exp()) < f(b.exp()) { low = a } else { high = b }
    }
    low.exp()
}

impl ElasticPlastic {
    /// Surface of a material with the plane-strain modulus `modulus` = E/(1 - nu^2) and the yield strength `yield_strength` in Pa and
    /// Poisson's ratio `poisson_ratio`.
    pub fn new(modulus: f64, yield_strength: f64, poisson_ratio: f64) -> Self {
        let factor = 1.295 * (0.736 * poisson_ratio).exp();
        let law = Self {
            modulus,
            yield_strength,
            poisson_ratio,
            onset: 0.5 * PI * factor * yield_strength / modulus,
            growth: 0.14 * (23.0 * yield_strength / modulus).exp(),
            constraint: 4.0 * HARDNESS / factor,
            hardest: [f64::INFINITY; 2],
            evenest: [f64::INFINITY; 2],
        };
        let [hardest, evenest] = [largest(|w| law.pressed(w)[0]), largest(|w| law.flattened(w).evenness)];
        Self {
            hardest: [hardest, law.pressed(hardest)[0]],
            evenest: [evenest, law.flattened(evenest).evenness],
            ..law
        }
    }

    /// The same pulled along the surface by `stress` Pa in all directions: on the axis of the contact that adds to what shears it, and
    /// so it yields as if it were so much weaker (von Mises), as far as it does not yield by that stress alone.
    pub fn pulled(&self, stress: f64) -> Self {
        let most = (1.0 - LEAST_STRENGTH) * self.yield_strength;
        let left = self.yield_strength - stress.clamp(-most, most);
        Self { yield_strength: self.yield_strength, ..Self::new(self.modulus, left, self.poisson_ratio) }
    }

    /// Mean pressure in Pa at the onset of yield.
    pub fn onset_pressure(&self) -> f64 {
        4.0 / (3.0 * PI) * self.modulus * self.onset
    }

    /// Mean pressure in Pa and a/rho at `w` critical approaches.
    fn pressed(&self, w: f64) -> [f64; 2] {
        if w <= 1.0 {
            return [self.onset_pressure() * w.sqrt(), self.onset * w.sqrt()];
        }
        let log = w.ln();
        let power = |exponent: f64| (exponent * log).exp();
        let area = w * (self.growth * (log - ELASTIC.ln()).max(0.0)).exp();
        let flattening = self.onset * area.sqrt();
        if w > self.hardest[0] {
            let [hardest, pressure] = self.hardest;
            return [pressure * (w / hardest).powf(HARDER), flattening];
        }
        let hardness = 1.0 - (-0.82 * flattening.powf(-0.7)).exp();
        let share = 1.0 - (-power(5.0 / 9.0) / 25.0).exp();
        let elastic = w * w.sqrt();
        let force = (-0.25 * power(5.0 / 12.0)).exp() * elastic + self.constraint * hardness * share * w;
        // the two curves cross near `ELASTIC`
        [self.onset_pressure() * force.min(elastic) / area, flattening]
    }

    /// The surface at `w` critical approaches.
    pub fn flattened(&self, w: f64) -> Flattened {
        let [pressure, flattening] = self.pressed(w);
        if w <= 1.0 {
            return Flattened { approach: w, pressure, flattening, ..Flattened::NONE };
        }
        let depth = w * self.onset.powi(2) / flattening;
        let log = w.ln();
        let power = |exponent: f64| (exponent * log).exp();
        let residual = (1.0 - power(-0.28)) * (1.0 - power(-0.69));
        let unit = pressure / self.modulus;
        let recovers = (1.0 - residual) * depth / unit;
        let [evenest, most] = self.evenest;
        let evenness =
            if w > evenest { most } else { ((HERTZ - recovers) / (HERTZ - EVEN[0])).clamp(0.0, 1.0) };
        let state = Flattened {
            approach: w,
            pressure,
            lasting: 0.0,
            flattening,
            stays: residual * depth,
            recovers,
            evenness,
            exponent: 1.5 * power(-0.0331),
        };
        Flattened { lasting: (flattening - state.bends() * unit).max(0.0), ..state }
    }

    /// The surface where the pressure strives to shear it by `shear` Pa, looked for `near` so many critical approaches; at `w` of them if it
    /// can bear no more.
    pub fn sheared(&self, shear: f64, w: f64, near: f64) -> Flattened {
        let elastic = (shear / (self.onset_pressure() * SHEAR[0])).powi(2);
        if elastic <= 1.0 {
            return self.flattened(elastic);
        }
        let bears = |w: f64| {
            let state = self.flattened(w);
            state.pressure * state.shears()
        };
        let ends = [1.0, self.hardest[0]];
        let found = root_near(bears, shear, near.clamp(ends[0], ends[1]), SHEARED_POWER);
        if let Some(found) = found.filter(|w| (ends[0]..=ends[1]).contains(w)) {
            return self.flattened(found);
        }
        let error = |w: f64| bears(w) - shear;
        let values = ends.map(error);
        if values[1] <= 0.0 {
            self.flattened(w.max(ends[1]))
        } else {
            self.flattened(root(error, ends, values))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn steel(yield_strength: f64) -> ElasticPlastic {
        ElasticPlastic::new(210e9 / (1.0 - 0.09), yield_strength, 0.3)
    }

    /// Onset where the largest pressure, 3/2 of the mean one, is about 1.6 yield strengths (Johnson, Contact Mechanics, section 6.2).
    #[test]
    fn yield_begins_at_the_pressure_of_hertz_and_tresca() {
        assert_relative_eq!(1.5 * steel(600e6).onset_pressure() / 600e6, 1.6, max_relative = 0.02);
    }

    /// On the axis sigma_r - sigma_z = Y: a stress along the surface takes its part of Y, a pressure gives it, and neither adds to one before.
    #[test]
    fn a_surface_that_is_pulled_yields_earlier_by_the_stress() {
        let law = steel(600e6);
        for stress in [60e6, -120e6] {
            let onset = law.pulled(1e8).pulled(stress).onset_pressure() / law.onset_pressure();
            assert_relative_eq!(onset, 1.0 - stress / 600e6, max_relative = 1e-12);
        }
        assert!(law.pulled(9e8).onset_pressure() > 0.0);
    }

    /// Full plasticity: the mean pressure grows towards 2.84 Y, less for a strong material, 2 % beyond for a soft one.
    #[test]
    fn the_pressure_grows_from_the_onset_to_the_hardness() {
        for yield_strength in [100e6, 600e6, 2000e6] {
            let law = steel(yield_strength);
            let mut before = Flattened::NONE;
            for k in 1..3000 {
                let w = (0.005 * f64::from(k)).exp() * 0.01;
                let state = law.flattened(w);
                assert!(state.pressure >= before.pressure && state.flattening > before.flattening, "{w}");
                assert!(state.stays >= before.stays && state.lasting >= before.lasting, "{w}");
                if w < 0.999 * law.hardest[0] {
                    assert_relative_eq!(
                        law.sheared(state.pressure * state.shears(), 0.0, 1.0).approach,
                        w,
                        max_relative = 1e-6
                    );
                }
                before = state;
            }
            let hardness = before.pressure / yield_strength;
            assert!(hardness < 1.03 * HARDNESS && hardness > 2.3, "{hardness}");
        }
    }

    /// Jackson and Green's pressure and Etsion, Kligerman and Kadin's recovery, which were fitted apart from each other, come from
    /// Hertz's distribution to an even one: a depth of 3 pi/4 p a/E' becomes 2 p a/E'.
    #[test]
    fn what_comes_back_is_the_depth_under_a_pressure_that_becomes_even() {
        let law = steel(350e6);
        assert_relative_eq!(law.flattened(1.0 + 1e-12).recovers, HERTZ, max_relative = 1e-6);
        for w in [8.0, 12.0, 20.0, 34.0, 60.0, 110.0] {
            assert_relative_eq!(law.flattened(w).recovers, 2.0, max_relative = 0.05);
        }
    }
}
