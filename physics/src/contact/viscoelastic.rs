//! A spherical tip on the flat of a viscoelastic material, by the method of dimensionality reduction.
//!
//! Popov & Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction, 2015, chapters 3 and 7: a row of independent
//! springs with the stiffness 2 E* per length, pressed by the tip's section x^2/r. Each relaxes as the material does; it leaves the
//! tip when its force would pull and stays off, recovering, until the tip reaches it again. While the contact grows this is Lee and
//! Radok's solution, while it shrinks Ting's. Here every spring is two in series, one of each body.

use super::Press;
use crate::material::{Creep, Deformation, Material};

/// One body's half of the springs.
#[derive(Debug, Clone)]
struct Half {
    /// 2 E/(1 - nu^2) times the width of a spring, N/m.
    stiffness: f64,
    creep: Creep,
}

/// The springs of a contact, and what they have been through.
#[derive(Debug, Clone)]
pub struct ViscoelasticContact {
    tip_radius: f64,
    /// Distance of the springs in m; the first stands on the axis.
    width: f64,
    halves: [Half; 2],
    springs: Vec<[Deformation; 2]>,
    /// Deformation in m that each spring would have at the end of the step without a force. Shape (springs).
    free: Vec<f64>,
    /// How it is pressed at the end of the last step, as if by Hertz's distribution.
    press: Press,
    /// Length of a step in s, the power that the springs lose in W, and what they have lost in J.
    step: f64,
    power: f64,
    lost: f64,
}

impl ViscoelasticContact {
    /// A tip of `tip_radius` m between two materials, with a spring every `width` m.
    pub fn new(tip_radius: f64, materials: [&Material; 2], width: f64) -> Self {
        let half = |material: &Material| Half {
            stiffness: 2.0 * material.plane_strain_modulus() * width,
            creep: Creep::new(&material.relaxation),
        };
        Self::virgin_springs(tip_radius, width, materials.map(half))
    }

    fn virgin_springs(tip_radius: f64, width: f64, halves: [Half; 2]) -> Self {
        let (springs, free) = (Vec::new(), Vec::new());
        Self {
            tip_radius,
            width,
            halves,
            springs,
            free,
            press: Press::default(),
            step: 0.0,
            power: 0.0,
            lost: 0.0,
        }
    }

    /// Prepares steps of `h` s.
    pub fn prepare(&mut self, h: f64) {
        self.step = h;
        self.halves.iter_mut().for_each(|half| half.creep.prepare(h));
        self.set_free();
    }

    /// The same never touched.
    #[must_use]
    pub fn virgin(&self) -> Self {
        self.with_springs_every(self.width)
    }

    /// The same never touched, with a spring every `width` m.
    #[must_use]
    pub fn with_springs_every(&self, width: f64) -> Self {
        let half =
            |half: &Half| Half { stiffness: half.stiffness * width / self.width, creep: half.creep.clone() };
        Self::virgin_springs(self.tip_radius, width, [half(&self.halves[0]), half(&self.halves[1])])
    }

    /// Deformation in m of spring `k`, positive into the bodies, if the tip has approached by `x` m.
    fn pressed(&self, k: usize, x: f64) -> f64 {
        let distance = k as f64 * self.width;
        x - distance * distance / self.tip_radius
    }

    /// Looks where the springs are at the end of the next step without a force.
    fn set_free(&mut self) {
        let Self { halves, springs, free, .. } = self;
        let of = |(half, state): (&Half, &Deformation)| half.creep.deformation(state, 0.0);
        free.clear();
        free.extend(springs.iter().map(|states| halves.iter().zip(states).map(of).sum::<f64>()));
    }

    /// Deformation in m of a spring at the end of the step per force, m/N.
    fn compliance(&self) -> f64 {
        self.halves.iter().map(|half| half.creep.growth() / half.stiffness).sum()
    }

    /// Force of spring `k` in N with the `compliance` in m/N, pressed by `w` m at the end of the step, and its stiffness in N/m; none if
    /// it would pull.
    fn spring(&self, k: usize, compliance: f64, w: f64) -> [f64; 2] {
        let free = self.free.get(k).copied().unwrap_or_default();
        if w <= free { [0.0; 2] } else { [(w - free) / compliance, 1.0 / compliance] }
    }

    /// Approach in m up to which no spring pushes at the end of the step.
    pub fn contact_approach(&self) -> f64 {
        let of = |(k, free): (usize, &f64)| free - self.pressed(k, 0.0);
        let first = self.free.iter().enumerate().map(of).fold(f64::INFINITY, f64::min);
        first.min(-self.pressed(self.springs.len(), 0.0))
    }

    /// Force in N at the end of a step at the approach `x` in m, and its slope in N/m.
    pub fn force(&self, x: f64) -> [f64; 2] {
        let compliance = self.compliance();
        let mut sum = [0.0; 2];
        for k in 0.. {
            let w = self.pressed(k, x);
            if w <= 0.0 && k >= self.springs.len() {
                break;
            }
            let [force, slope] = self.spring(k, compliance, w);
            sum[0] += sides(k) * force;
            sum[1] += sides(k) * slope;
        }
        sum
    }

    /// Ends the step at the approach `x` in m.
    pub fn advance(&mut self, x: f64) {
        while self.pressed(self.springs.len(), x) > 0.0 {
            self.springs.push(Default::default());
        }
        let compliance = self.compliance();
        self.press = Press { radius: self.radius(x), curvature: self.tip_radius.recip(), ..Press::default() };
        for k in 0..self.springs.len() {
            let [force, _] = self.spring(k, compliance, self.pressed(k, x));
            self.press.force += sides(k) * force;
            for (half, state) in self.halves.iter().zip(&mut self.springs[k]) {
                half.creep.advance(state, force / half.stiffness);
            }
        }
        let power = self.sum(Creep::power);
        self.lost += 0.5 * self.step * (self.power + power);
        self.power = power;
        self.set_free();
    }

    /// How it is pressed at the end of the last step.
    pub fn press(&self) -> Press {
        self.press
    }

    /// Radius in m up to which springs push at the end of the step at the approach `x` in m.
    fn radius(&self, x: f64) -> f64 {
        let beyond_free = |k: usize| self.pressed(k, x) - self.free.get(k).copied().unwrap_or_default();
        let last = (0..self.springs.len()).rev().find(|k| beyond_free(*k) > 0.0);
        let between = |last: usize| {
            let [inside, outside] = [last, last + 1].map(beyond_free);
            (last as f64 + inside / (inside - outside)) * self.width
        };
        last.map_or(0.0, between)
    }

    /// Energy in J that the springs store and have lost.
    pub fn taken(&self) -> f64 {
        self.sum(Creep::stored) + self.lost
    }

    /// Sum over all springs of what `of` gives per stiffness.
    fn sum(&self, of: impl Fn(&Creep, &Deformation) -> f64) -> f64 {
        let spring = |(k, state): (usize, &[Deformation; 2])| {
            let halves =
                self.halves.iter().zip(state).map(|(half, state)| half.stiffness * of(&half.creep, state));
            sides(k) * halves.sum::<f64>()
        };
        self.springs.iter().enumerate().map(spring).sum()
    }
}

/// Share of spring `k`: both sides of the axis are one spring, whose stiffness has the factor 2 E*; on the axis there is but one.
fn sides(k: usize) -> f64 {
    if k == 0 { 0.5 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Hertz;
    use crate::material::Relaxation;
    use approx::assert_relative_eq;

    fn polymer(relaxation: Vec<Relaxation>) -> Material {
        Material { relaxation, ..Material::elastic("polymer", 2.6e9, 0.38, 1320.0) }
    }

    #[test]
    fn without_relaxation_it_is_hertz() {
        let (soft, hard) = (polymer(vec![]), Material::elastic("steel", 210e9, 0.3, 7780.0));
        let hertz = Hertz::new(1.5e-3, &soft, &hard);
        let x: f64 = 4e-6;
        let mut contact = ViscoelasticContact::new(1.5e-3, [&soft, &hard], (1.5e-3 * x).sqrt() / 64.0);
        contact.prepare(1e-7);
        let [force, slope] = contact.force(x);
        assert_relative_eq!(force, hertz.force(x), max_relative = 1e-4);
        assert_relative_eq!(slope, hertz.tangent(x), max_relative = 0.01);
    }

    /// Lee and Radok (1960): under a growing patch the relaxation acts on Hertz's force, F = k integral of E(t - s)/E_0 d(x^1.5).
    #[test]
    fn a_growing_contact_is_lee_and_radoks() {
        let terms = vec![Relaxation { ratio: 0.4, time: 3e-5 }];
        let soft = polymer(terms.clone());
        let rigid = Material::elastic("rigid", 1e20, 0.3, 7780.0);
        let hertz = Hertz::new(1.5e-3, &soft, &rigid);
        let (end, n) = (1e-4, 2000);
        let approach = |t: f64| 4e-6 * (t / end).powf(0.8);
        let mut contact =
            ViscoelasticContact::new(1.5e-3, [&soft, &rigid], (1.5e-3 * 4e-6_f64).sqrt() / 64.0);
        let h = end / f64::from(n);
        contact.prepare(h);
        for k in 1..=n {
            contact.advance(approach(h * f64::from(k)));
        }
        let [force, _] = contact.force(approach(end));
        let hereditary: f64 = (0..n)
            .map(|k| {
                let [a, b] = [h * f64::from(k), h * f64::from(k + 1)];
                let modulus = 1.0 - 0.4 * (1.0 - (-(end - 0.5 * (a + b)) / 3e-5).exp());
                modulus * (hertz.force(approach(b)) - hertz.force(approach(a)))
            })
            .sum();
        assert_relative_eq!(force, hereditary, max_relative = 2e-3);
        assert!(force < 0.8 * hertz.force(4e-6));
        // unloaded, the surface lags behind the tip, and what the springs took is what was done to them
        let mut work = 0.0;
        let (mut pressed, mut x) = (contact.clone(), approach(end));
        for k in 1..=n {
            let next = approach(end) * (1.0 - f64::from(k) / f64::from(n));
            let before = pressed.force(x)[0];
            work += 0.5 * (before + pressed.force(next)[0]) * (next - x);
            pressed.advance(next);
            x = next;
        }
        let stored = contact.taken();
        assert!(-work > 0.3 * stored && -work < 0.9 * stored, "{work} {stored}");
        assert_relative_eq!(pressed.taken(), stored + work, max_relative = 5e-3);
        let contact_approach = contact.contact_approach();
        assert!(
            contact_approach > 0.02 * approach(end) && contact_approach < approach(end),
            "{contact_approach}"
        );
        assert_eq!(contact.force(contact_approach)[0], 0.0);
        assert!(contact.force(contact_approach * (1.0 + 1e-9))[0] > 0.0);
    }
}
