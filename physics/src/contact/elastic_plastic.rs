//! A spherical tip pressed into the flat of a material that yields, with the dent that stays.
//!
//! Loading: Jackson & Green, A finite element study of elasto-plastic hemispherical contact against a rigid flat, J. Tribology 127
//! (2005) 343, eqs. (16) to (23), which is Hertz's law up to about twice the critical approach x_c. Unloading and loading again up to
//! the largest approach so far: Etsion, Kligerman & Kadin, Unloading of an elastic-plastic loaded spherical contact, Int. J. Solids
//! Struct. 42 (2005) 3716, eqs. (13) and (15). The law knows no hardening.

use super::Hertz;
use crate::numerics::quadrature::gauss_legendre;
use std::f64::consts::PI;

/// Exponent with which the force of a dent grows (Etsion et al., eq. 15).
fn unloading_exponent(w: f64) -> f64 {
    1.5 * w.powf(-0.0331)
}

/// Steps of Newton's method after which the inverse of the loading curve is taken as found.
const MAX_ITERATIONS: usize = 40;

/// Gauss points of the work of loading.
const LOADING_POINTS: usize = 32;

/// Loading curve of a tip and a flat of which one yields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticPlastic {
    hertz: Hertz,
    /// x_c in m.
    critical_approach: f64,
    /// F_c in N.
    critical_force: f64,
    /// B: how the radius of the contact grows beyond Hertz's.
    growth: f64,
    /// 4/(C Y) times the largest hardness, 2.84 Y.
    constraint: f64,
}

/// What a contact has been through: its largest approach from the virgin surfaces, and what follows from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dent {
    /// Largest approach x_m in m and the force there in N.
    largest: [f64; 2],
    /// Approach at which the force vanishes, x_r in m.
    residual: f64,
    /// n of F = F_m ((x - x_r)/(x_m - x_r))^n.
    exponent: f64,
}

impl Dent {
    /// Virgin surfaces.
    pub const NONE: Dent = Dent { largest: [0.0; 2], residual: 0.0, exponent: 1.5 };

    /// Approach in m at which the dented surfaces touch.
    pub fn depth(&self) -> f64 {
        self.residual
    }
}

impl ElasticPlastic {
    /// The contact `hertz` of two bodies with the composite modulus `modulus` = 1/sum((1 - nu^2)/E) in Pa, of which one has the yield
    /// strength `yield_strength` in Pa and Poisson's ratio `poisson_ratio`.
    pub fn new(hertz: Hertz, modulus: f64, yield_strength: f64, poisson_ratio: f64) -> Self {
        let factor = 1.295 * (0.736 * poisson_ratio).exp();
        let onset = 0.5 * PI * factor * yield_strength;
        let critical_approach = (onset / modulus).powi(2) * hertz.tip_radius;
        Self {
            hertz,
            critical_approach,
            critical_force: hertz.force(critical_approach),
            growth: 0.14 * (23.0 * yield_strength / modulus).exp(),
            constraint: 4.0 * 2.84 / factor,
        }
    }

    /// Force in N up to which the contact is elastic.
    pub fn critical_force(&self) -> f64 {
        self.critical_force
    }

    /// Force in N at the approach `x` in m from virgin surfaces, and its slope in N/m.
    pub fn loading(&self, x: f64) -> [f64; 2] {
        let w = x / self.critical_approach;
        let elastic = [self.hertz.force(x), self.hertz.tangent(x)];
        if w < 1.9 {
            return elastic;
        }
        let force = self.beyond_onset(w);
        // the two curves cross near there
        if force >= elastic[0] {
            return elastic;
        }
        let step = 1e-5 * w;
        let slope = (self.beyond_onset(w + step) - self.beyond_onset(w - step)) / (2.0 * step);
        [force, slope / self.critical_approach]
    }

    /// Jackson and Green's force in N beyond 1.9 critical approaches, at `w` of them.
    fn beyond_onset(&self, w: f64) -> f64 {
        let radius =
            (w * self.critical_approach / self.hertz.tip_radius * (w / 1.9).powf(self.growth)).sqrt();
        let hardness = 1.0 - (-0.82 * radius.powf(-0.7)).exp();
        let share = 1.0 - (-w.powf(5.0 / 9.0) / 25.0).exp();
        self.critical_force
            * ((-0.25 * w.powf(5.0 / 12.0)).exp() * w.powf(1.5) + self.constraint * hardness * share * w)
    }

    /// Approach in m under the `force` in N on virgin surfaces.
    fn loaded_approach(&self, force: f64) -> f64 {
        let mut x = self.hertz.approach(force);
        for _ in 0..MAX_ITERATIONS {
            let [found, slope] = self.loading(x);
            let step = (force - found) / slope;
            x += step;
            if step.abs() <= 1e-14 * x {
                break;
            }
        }
        x
    }

    /// Approach in m from virgin surfaces under the `force` in N with the dent so far.
    pub fn approach(&self, dent: &Dent, force: f64) -> f64 {
        let [x_m, f_m] = dent.largest;
        if force <= 0.0 {
            return dent.residual;
        }
        if force >= f_m {
            return self.loaded_approach(force);
        }
        dent.residual + (x_m - dent.residual) * (force / f_m).powf(1.0 / dent.exponent)
    }

    /// Energy in J taken under the `force` in N that has made the dent so far: what unloading would give back, and what it would not.
    pub fn taken(&self, dent: &Dent, force: f64) -> f64 {
        let [x_m, f_m] = dent.largest;
        if f_m == 0.0 {
            return 0.4 * force * self.hertz.approach(force);
        }
        let (points, weights) = gauss_legendre(LOADING_POINTS);
        // Hertz's law up to the critical approach
        let (elastic, middle) =
            (0.4 * self.critical_force * self.critical_approach, 0.5 * (x_m + self.critical_approach));
        let half = x_m - middle;
        let at = |p: &f64| self.loading(middle + half * p)[0];
        let loaded = elastic + half * points.iter().zip(weights).map(|(p, w)| w * at(p)).sum::<f64>();
        let n = dent.exponent;
        let given_back = f_m * (x_m - dent.residual) / (n + 1.0);
        loaded - given_back * (1.0 - (force / f_m).powf((n + 1.0) / n))
    }

    /// Force in N at the approach `x` in m from virgin surfaces with the dent so far, and its slope in N/m.
    pub fn force(&self, dent: &Dent, x: f64) -> [f64; 2] {
        let [x_m, f_m] = dent.largest;
        let past = x - dent.residual;
        if x >= x_m {
            return self.loading(x);
        }
        if past <= 0.0 {
            return [0.0; 2];
        }
        let force = f_m * (past / (x_m - dent.residual)).powf(dent.exponent);
        [force, dent.exponent * force / past]
    }

    /// The dent after a `force` in N.
    pub fn dent_after(&self, dent: Dent, force: f64) -> Dent {
        if force <= dent.largest[1].max(self.critical_force) {
            return dent;
        }
        let x_m = self.loaded_approach(force);
        let w = x_m / self.critical_approach;
        Dent {
            largest: [x_m, force],
            residual: x_m * (1.0 - w.powf(-0.28)) * (1.0 - w.powf(-0.69)),
            exponent: unloading_exponent(w),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn steel() -> ElasticPlastic {
        let modulus = 0.5 * 210e9 / (1.0 - 0.09);
        let hertz = Hertz { stiffness: 4.0 / 3.0 * 0.01_f64.sqrt() * modulus, tip_radius: 0.01 };
        ElasticPlastic::new(hertz, modulus, 600e6, 0.3)
    }

    /// Onset where the largest pressure is about 1.6 yield strengths (Johnson, Contact Mechanics, section 6.2).
    #[test]
    fn yield_begins_at_the_pressure_of_hertz_and_tresca() {
        let law = steel();
        assert_relative_eq!(law.hertz.maximum_pressure(law.critical_force) / 600e6, 1.6, max_relative = 0.02);
    }

    /// What was taken is the work done along the way: loaded, unloaded in part, loaded further, unloaded.
    #[test]
    fn what_is_taken_is_the_work_done() {
        let law = steel();
        let (mut dent, mut x, mut work) = (Dent::NONE, 0.0, 0.0);
        for turn in [0.5, 12.0, 11.0, 40.0, 0.0] {
            let (from, to) = (x, turn * law.critical_approach);
            let n = 20_000;
            for k in 1..=n {
                let next = from + (to - from) * f64::from(k) / f64::from(n);
                work += 0.5 * (law.force(&dent, x)[0] + law.force(&dent, next)[0]) * (next - x);
                dent = law.dent_after(dent, law.force(&dent, next)[0]);
                x = next;
            }
            let taken = law.taken(&dent, law.force(&dent, x)[0]);
            assert_relative_eq!(taken, work, max_relative = 1e-3);
        }
        assert!(work > 20.0 * 0.4 * law.critical_force * law.critical_approach);
    }

    /// Full plasticity: the mean pressure of Jackson and Green's own contact area is at most 2.84 Y.
    #[test]
    fn the_loading_curve_is_continuous_and_softer_than_hertz() {
        let law = steel();
        let mut before = 0.0;
        for k in 1..4000 {
            let x = 0.01 * f64::from(k) * law.critical_approach;
            let [force, slope] = law.loading(x);
            assert!(force > before && force <= law.hertz.force(x) && slope > 0.0, "{k}");
            assert!(force - before < 1.6 * 0.01 * law.critical_approach * law.hertz.tangent(x), "{k}");
            assert_relative_eq!(law.loaded_approach(force), x, max_relative = 1e-9);
            before = force;
        }
    }

    #[test]
    fn unloading_meets_the_loading_curve_and_leaves_a_dent() {
        let law = steel();
        let dent = law.dent_after(Dent::NONE, 30.0 * law.critical_force);
        let [x_m, f_m] = dent.largest;
        assert_relative_eq!(law.approach(&dent, f_m), x_m, max_relative = 1e-9);
        for force in [0.1 * f_m, 0.9 * f_m, 1.1 * f_m] {
            let x = law.approach(&dent, force);
            let [found, slope] = law.force(&dent, x);
            assert_relative_eq!(found, force, max_relative = 1e-9);
            let [above, _] = law.force(&dent, x * (1.0 + 1e-6));
            assert_relative_eq!((above - force) / (1e-6 * x), slope, max_relative = 1e-4);
        }
        assert_eq!(law.force(&dent, dent.depth()), [0.0; 2]);
        assert_relative_eq!(law.approach(&dent, 0.0), dent.depth());
        assert!(dent.depth() > 0.1 * x_m && dent.depth() < x_m);
        // once more with less changes nothing, a little more deepens it
        assert_eq!(law.dent_after(dent, 0.9 * f_m), dent);
        assert!(law.dent_after(dent, 1.1 * f_m).depth() > dent.depth());
        assert_eq!(law.dent_after(Dent::NONE, law.critical_force), Dent::NONE);
    }
}
