//! Surfaces that harden.
//!
//! A material that hardens is at every flattening as one that does not and has the yield stress at a representative plastic strain (Tabor,
//! The Hardness of Metals, 1951).
//!
//! The unknown is the overload of that other surface: its onset follows from what it keeps of its flattening.

use super::{EVEN, EVENS, ElasticPlastic, Flattened, HERTZ};

/// Representative plastic strain over the flattening that stays: that of a deep indentation is 0.2 a/R (Tabor).
pub const TABOR: f64 = 0.2;
/// Most steps of an iteration for what hardening adds, and the step, relative, from which on the next one ends at rounding.
const MOST_STEPS: usize = 12;
const CLOSE: f64 = 1e-8;

impl ElasticPlastic {
    /// The surface without hardening that first yields at `onset`.
    fn without_hardening(&self, onset: f64) -> Self {
        Self { onset, hardening: 0.0, ..*self }
    }

    /// Growth of the onset per flattening that stays: Tabor's strain makes the surface stronger.
    pub(super) fn hardens(&self) -> f64 {
        self.per_stress * self.hardening * TABOR
    }

    /// Overload at a `flattening` of the surface without hardening that is as strong there, if it kept all its flattening but that of first
    /// yield.
    pub(super) fn about_overload(&self, flattening: f64) -> f64 {
        flattening * (1.0 + self.hardens()) / (self.onset + flattening * self.hardens())
    }

    /// Flattening that stays at an overload over that at first yield, without hardening; the last argument is what [`Self::pressures`]
    /// gives there.
    fn kept(&self, overload: f64, [_, pressure, evenness]: [f64; 3]) -> f64 {
        let bends = Flattened { evenness, ..Flattened::NONE }.bends();
        overload - bends * pressure / self.modulus / self.onset
    }

    /// Its derivative by the overload, where the logarithm of the pressure has the derivative `growth`.
    pub(super) fn kept_growth(&self, [_, pressure, evenness]: [f64; 3], growth: f64) -> f64 {
        let bends = Flattened { evenness, ..Flattened::NONE }.bends();
        let evens = EVENS * (1.0 - evenness) * (EVEN[1] - HERTZ);
        1.0 - (evens + bends * growth) * pressure / self.modulus / self.onset
    }

    /// The surface without hardening that is as strong as this one is at a `flattening`, where the contact radius is `slope` of the tip's.
    pub(super) fn hardened(&self, flattening: f64, slope: f64) -> Self {
        if flattening <= self.onset {
            return self.without_hardening(self.onset);
        }
        // the onset is that of a virgin surface and what the lasting flattening adds: flattening/overload = onset/(1 - hardens kept)
        let mut overload = self.about_overload(flattening);
        for _ in 0..MOST_STEPS {
            let now = self.pressures(overload, slope);
            let kept_growth = self.kept_growth(now, self.grows(overload, [slope, 0.0], now).iter().sum());
            let miss = self.onset * overload - flattening * (1.0 - self.hardens() * self.kept(overload, now));
            let step = miss / (self.onset + flattening * self.hardens() * kept_growth);
            overload = (overload - step).max(1.0);
            if step.abs() <= CLOSE * overload {
                break;
            }
        }
        self.without_hardening(flattening / overload)
    }

    /// That surface where its own `overload` is known, the slope being that of this surface alone.
    pub(super) fn hardened_to(&self, overload: f64) -> Self {
        if self.hardening == 0.0 {
            return *self;
        }
        let mut onset = self.onset;
        for _ in 0..MOST_STEPS {
            let kept = self.kept(overload, self.pressures(overload, onset * overload));
            let before = onset;
            onset = self.onset / (1.0 - self.hardens() * kept);
            if !self.is_sphere || (onset - before).abs() <= CLOSE * onset {
                break;
            }
        }
        self.without_hardening(onset)
    }
}
