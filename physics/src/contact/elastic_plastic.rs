//! The virgin surface of a material that yields, flattened over a circle.
//!
//! Everything depends on the flattening alone: the radius a of the contact times the curvature that the surface has lost. Over its value
//! at first yield that is the overload l. Three things follow from it.
//!
//! - The mean pressure p. It begins as Hertz's and tends to full plasticity. On a sphere it is lower than on a half-space, since the surface
//!   falls away around the contact: less material holds back the flow (Jackson & Green, J. Tribology 127, 2005, 343, their section on hardness).
//! - The distribution of the pressure. It begins as Hertz's and becomes even. Unloading is elastic, and the work that it returns is the
//!   elastic energy of the half-space under that distribution: residual stresses do no work on an elastic displacement (Johnson, Contact
//!   Mechanics, 1985, section 6.4). No constant enters.
//! - The dissipated energy over that elastic energy. It grows with l from zero, so no contact can return more than it took.
//!
//! The curves of l are those of static finite elements: a rigid paraboloid on a half-space and a sphere on a rigid flat, small strains,
//! nu = 0.3, l from 1 to 31, a/R up to 0.2. They hold the mean pressure within 2 %, the rebound within 1.5 %.
//!
//! What hardens is in [`hardening`].

mod hardening;

pub use hardening::TABOR;

use crate::numerics::root::{newton_near, root};
use std::f64::consts::PI;

/// Mean pressure of full plasticity over the yield strength, and the power of the overload with which the pressure tends to it.
const FULL_PLASTICITY: f64 = 3.23;
const TENDS: f64 = 0.6;
/// Overload and power with which the slope of a sphere around the contact begins to count.
const SLOPING: [f64; 2] = [13.0, 1.3];
/// Slope beyond which nothing is known, and the pressure falls no further.
const STEEPEST: f64 = 0.5;
/// How fast the pressure becomes even with the overload.
const EVENS: f64 = 0.9;
/// Dissipated over elastic energy, x = l - 1: c x^(1 + m)/(x + x0), as c, m, x0.
const LOSS: [f64; 3] = [0.33, 0.85, 0.5];
/// Squares of the overload between which the largest shear stress is looked for, and steps of the search.
const SEARCHED: [f64; 2] = [1.0, 1e6];
const SEARCH_STEPS: usize = 60;

/// Relative error of a stress at which it has been found.
const FITS: f64 = 1e-7;

/// Share of the yield strength that is left at least where the surface is pulled along itself.
const LEAST_STRENGTH: f64 = 0.1;

/// Depth of a half-space under a pressure of Hertz's distribution, and twice what the middle is deeper than the edge: both 3 pi/4; and of
/// an even pressure: 2, and 4 - 8/pi. In units of p a/E' (Johnson, Contact Mechanics, 1985, sections 3.4 and 4.2).
const HERTZ: f64 = 0.75 * PI;
const EVEN: [f64; 2] = [2.0, 4.0 - 8.0 / PI];
/// Elastic energy of a half-space under Hertz's distribution, half the work of one on the displacement of the other, and the energy
/// under an even pressure, in units of p^2 a^3/E'.
const ENERGY: [f64; 3] = [0.3 * PI * PI, 9.0 / 32.0 * PI * PI, 8.0 / 3.0];

/// Largest shear stress on the axis over the mean pressure, of Hertz's distribution and an even one, nu = 0.3 (Johnson 1985, sections 4.2
/// and 3.4).
const SHEAR: [f64; 2] = [0.465, 0.332];

/// Surface of a material that yields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticPlastic {
    /// E' = E/(1 - nu^2) in Pa.
    modulus: f64,
    /// Yield strength in Pa without a stress along the surface, and Poisson's ratio.
    yield_strength: f64,
    poisson_ratio: f64,
    /// Whether the surface falls away around the contact.
    is_sphere: bool,
    /// Growth of the yield stress per plastic strain, Pa.
    hardening: f64,
    /// Flattening at first yield over the yield stress, pi C/(2 E'), C as Jackson and Green have it, 1/Pa; and at first yield.
    per_stress: f64,
    onset: f64,
    /// Mean pressure of full plasticity on a half-space over that at first yield.
    hardness: f64,
    /// Square of the overload at which the surface is sheared most.
    strongest: f64,
}

/// State of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flattened {
    /// Square of the overload: of an elastic surface the approach over the critical one.
    pub approach: f64,
    /// Mean pressure in Pa.
    pub pressure: f64,
    /// Radius of the contact over the radius of the curvature that it has lost: for good, and all of it.
    pub lasting: f64,
    pub flattening: f64,
    /// From Hertz's distribution of the pressure, 0, to an even one, 1.
    pub evenness: f64,
    /// Dissipated energy over the cube of the contact radius, J/m^3.
    pub lost: f64,
}

impl Flattened {
    /// Virgin, without pressure.
    pub const NONE: Flattened =
        Flattened { approach: 0.0, pressure: 0.0, lasting: 0.0, flattening: 0.0, evenness: 0.0, lost: 0.0 };

    fn between(&self, [hertz, even]: [f64; 2]) -> f64 {
        hertz + self.evenness * (even - hertz)
    }

    /// Depth that comes back, in units of p a/E'.
    pub fn recovers(&self) -> f64 {
        self.between([HERTZ, EVEN[0]])
    }

    /// The curvature times a that an elastic surface loses under the same pressure, in units of p/E': the more even the pressure
    /// is the less it bends the surface for its depth.
    pub fn bends(&self) -> f64 {
        self.between([HERTZ, EVEN[1]])
    }

    /// Largest shear stress that an elastic surface has under the same pressure, over the mean pressure: the more even the pressure
    /// is the later it yields.
    pub fn shears(&self) -> f64 {
        self.between(SHEAR)
    }

    /// Elastic energy under the pressure, in units of p^2 a^3/E'.
    pub fn energy(&self) -> f64 {
        let [hertz, both, even] = ENERGY;
        let rest = 1.0 - self.evenness;
        rest * rest * hertz + 2.0 * rest * self.evenness * both + self.evenness * self.evenness * even
    }

    /// n of the force (depth)^n with which unloading returns that energy over the depth that comes back.
    pub fn exponent(&self) -> f64 {
        PI * self.recovers() / self.energy() - 1.0
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
    /// Surface of a material with the plane-strain modulus `modulus` = E/(1 - nu^2), the yield stress `yield_strength` that grows by
    /// `hardening` per plastic strain, in Pa, and Poisson's ratio `poisson_ratio`; a sphere, or flat.
    pub fn new(
        modulus: f64,
        [yield_strength, hardening]: [f64; 2],
        poisson_ratio: f64,
        is_sphere: bool,
    ) -> Self {
        let factor = 1.295 * (0.736 * poisson_ratio).exp();
        let per_stress = 0.5 * PI * factor / modulus;
        let law = Self {
            modulus,
            yield_strength,
            poisson_ratio,
            is_sphere,
            hardening,
            per_stress,
            onset: per_stress * yield_strength,
            hardness: 1.5 * FULL_PLASTICITY / factor,
            strongest: f64::INFINITY,
        };
        let strongest = largest(|w| law.strength(w));
        Self { strongest, ..law }
    }

    /// The same pulled along the surface by `stress` Pa in all directions: on the axis of the contact that adds to what shears it, and
    /// so it yields as if it were so much weaker (von Mises), as far as it does not yield by that stress alone.
    pub fn pulled(&self, stress: f64) -> Self {
        let most = (1.0 - LEAST_STRENGTH) * self.yield_strength;
        let left = self.yield_strength - stress.clamp(-most, most);
        let law = Self::new(self.modulus, [left, self.hardening], self.poisson_ratio, self.is_sphere);
        Self { yield_strength: self.yield_strength, ..law }
    }

    /// Mean pressure in Pa at the onset of yield.
    pub fn onset_pressure(&self) -> f64 {
        4.0 / (3.0 * PI) * self.modulus * self.onset
    }

    /// The surface at the square `w` of its overload, alone on something that does not yield.
    pub fn flattened(&self, w: f64) -> Flattened {
        self.flattened_at(w, self.onset * w.sqrt())
    }

    /// The same where the contact radius is `slope` of the tip's.
    pub fn flattened_at(&self, w: f64, slope: f64) -> Flattened {
        let overload = w.sqrt();
        let flattening = self.onset * overload;
        if self.hardening > 0.0 {
            let law = self.hardened(flattening, slope);
            let state = law.flattened_at((flattening / law.onset).powi(2), slope);
            return Flattened { approach: w, ..state };
        }
        let [flat, pressure, evenness] = self.pressures(overload, slope);
        let state = Flattened { approach: w, pressure, flattening, evenness, ..Flattened::NONE };
        if w <= 1.0 {
            return state;
        }
        let beyond = overload - 1.0;
        let [size, power, start] = LOSS;
        let loss = size * beyond.powf(1.0 + power) / (beyond + start);
        Flattened {
            lasting: (flattening - state.bends() * pressure / self.modulus).max(0.0),
            // what is lost is work of the pressure, what is stored goes with its square
            lost: loss * state.energy() * pressure * flat / self.modulus,
            ..state
        }
    }

    /// Mean pressure in Pa at an `overload` where the contact radius is `slope` of the tip's: on a half-space, and on this surface; and the
    /// evenness.
    fn pressures(&self, overload: f64, slope: f64) -> [f64; 3] {
        let elastic = self.onset_pressure() * overload;
        if overload <= 1.0 {
            return [elastic, elastic, 0.0];
        }
        let beyond = overload - 1.0;
        // begins with the slope of Hertz's law
        let rise = self.hardness - 1.0;
        let flat =
            self.onset_pressure() * (self.hardness - rise * (1.0 + beyond / (TENDS * rise)).powf(-TENDS));
        let evenness = -(-EVENS * beyond).exp_m1();
        // what flows is held back less; at first yield nothing does
        [flat, flat * if self.is_sphere { falls_away(overload, evenness * slope) } else { 1.0 }, evenness]
    }

    /// Shear stress in Pa that the surface bears at the square `w` of its overload.
    fn strength(&self, w: f64) -> f64 {
        let state = self.flattened(w);
        state.pressure * state.shears()
    }

    /// Growth of the logarithm of the mean pressure with the overload, without hardening: on a half-space, and by the `slope`, which comes
    /// with its derivative. The last argument is what [`Self::pressures`] gives there.
    fn grows(&self, overload: f64, [slope, steepens]: [f64; 2], [flat, _, evenness]: [f64; 3]) -> [f64; 2] {
        let rise = self.hardness - 1.0;
        let left = self.hardness - flat / self.onset_pressure();
        let of_flat = self.onset_pressure() * left / (rise + (overload - 1.0) / TENDS) / flat;
        if !self.is_sphere {
            return [of_flat, 0.0];
        }
        let evens = EVENS * (1.0 - evenness);
        [of_flat, falling_away(overload, [evenness * slope, evens * slope + evenness * steepens])]
    }

    /// The shear stress in Pa that the surface bears at the square `w`, from 1 on, of the overload of the surface without hardening that is
    /// as strong, and the power of `w` with which it grows there.
    fn bears(&self, w: f64) -> [f64; 2] {
        let overload = w.sqrt();
        let law = self.hardened_to(overload);
        let slope = law.onset * overload;
        let now @ [_, pressure, evenness] = law.pressures(overload, slope);
        let shears = Flattened { evenness, ..Flattened::NONE }.shears();
        let evens = EVENS * (1.0 - evenness) * (SHEAR[1] - SHEAR[0]) / shears;
        let [of_flat, of_slope] = law.grows(overload, [slope, law.onset], now);
        let kept_growth = law.kept_growth(now, of_flat + of_slope);
        let stronger = self.hardens() * kept_growth * law.onset / self.onset;
        [pressure * shears, 0.5 * overload * (of_flat + evens + of_slope + stronger)]
    }

    /// The surface where the pressure strives to shear it by `shear` Pa, looked for `near` that square of the overload; at `w` if it
    /// can bear no more.
    pub fn sheared(&self, shear: f64, w: f64, near: f64) -> Flattened {
        let elastic = (shear / (self.onset_pressure() * SHEAR[0])).powi(2);
        if elastic <= 1.0 {
            return self.flattened(elastic);
        }
        let ends = [1.0, self.strongest];
        let near = near.clamp(ends[0], ends[1]);
        let about = match self.hardening > 0.0 {
            true => self.about_overload(self.onset * near.sqrt()).powi(2),
            false => near,
        };
        if let Some(found) = newton_near(|w| self.bears(w), shear, about) {
            let approach = match self.hardening > 0.0 {
                true => found * (self.hardened_to(found.sqrt()).onset / self.onset).powi(2),
                false => found,
            };
            // close to the overload at which hardening has no bound a last step may lead anywhere
            if (ends[0]..=ends[1]).contains(&approach) {
                let state = self.flattened(approach);
                if (state.pressure * state.shears() / shear - 1.0).abs() < FITS {
                    return state;
                }
            }
        }
        let error = |w: f64| self.strength(w) - shear;
        let values = ends.map(error);
        if values[1] <= 0.0 {
            self.flattened(w.max(ends[1]))
        } else {
            self.flattened(root(error, ends, values))
        }
    }
}

/// Mean pressure on a sphere over that on a half-space: lower by the `slope` at the rim, a/R, as in a slip-line field under a sloping face.
fn falls_away(overload: f64, slope: f64) -> f64 {
    let [scale, power] = SLOPING;
    (slope.min(STEEPEST) * (-(overload / scale).powf(power)).exp_m1()).exp()
}

/// Derivative of its logarithm by the overload; the `slope` comes with its own.
fn falling_away(overload: f64, [slope, steepens]: [f64; 2]) -> f64 {
    let [scale, power] = SLOPING;
    let weight = (overload / scale).powf(power);
    let steepens = if slope < STEEPEST { steepens } else { 0.0 };
    steepens * (-weight).exp_m1() - slope.min(STEEPEST) * (-weight).exp() * power * weight / overload
}

#[cfg(test)]
mod tests;
