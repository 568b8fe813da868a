//! The stress that a plate's bending lays along its faces under the contacts.
//!
//! Where a plate is bent its struck face is pressed along itself and the other one pulled: so the one bears more pressure before it yields and
//! the other less, by as much as that stress is (von Mises on the axis). Under a force that rises step by step the moment below it is that of
//! an infinite plate, into which bending spreads like heat, with the square root of time:
//! M = (1 + nu)/(8 pi) sum dF ln(b^2/r^2), b^2 = 4 t sqrt(D/m) exp(-gamma), m the mass per area (Boussinesq; Zener, Phys. Rev. 59, 1941, 669), until it is
//! that of the whole plate at rest (Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells, 2nd ed., articles 16 to 19).

use crate::analytical::circular_plate::rigidity;
use crate::contact::Hertz;
use crate::result::History;
use crate::scene::{Edge, Plate};
use std::f64::consts::PI;

/// Euler's constant.
const GAMMA: f64 = 0.577_215_664_901_532_9;
/// Power of the force by which the stresses of a course are weighted, and the least weight that counts: nearly the stress under the
/// largest force, but of two humps that are equally high it is the mean.
const SHARPNESS: i32 = 20;
const LEAST_WEIGHT: f64 = 1e-3;
/// Patch over the plate's thickness from which on a ring is the patch's.
const WIDE: f64 = 1.724;

/// Forces of outer and inner contact over the time of an impact, from before the first touch on.
#[derive(Debug, Clone, Default)]
pub struct ForceHistory {
    /// In s.
    time: Vec<f64>,
    /// In N. Shape (2, samples).
    force: [Vec<f64>; 2],
}

impl ForceHistory {
    /// Those of a `history`; `None` if it does not tell them.
    pub fn of(history: &History) -> Option<Self> {
        let force = |name: &str| Some(history.curve(name)?.to_vec());
        Some(Self { time: history.time.clone(), force: [force("outer_force")?, force("inner_force")?] })
    }

    /// Adds the forces `force` in N at `time` s.
    pub fn push(&mut self, time: f64, force: [f64; 2]) {
        self.time.push(time);
        self.force.iter_mut().zip(force).for_each(|(all, one)| all.push(one));
    }

    /// Weights of the samples of contact `i` that count, in the order of time, and the largest force in N.
    fn weights(&self, i: usize) -> (Vec<(usize, f64)>, f64) {
        let (time, force) = (&self.time, &self.force[i]);
        let peak = force.iter().copied().fold(0.0, f64::max);
        let last = time.len().saturating_sub(1);
        let weight = |k: usize| {
            let size = (force[k] / peak).max(0.0).powi(SHARPNESS);
            (size > LEAST_WEIGHT).then(|| (k, size * (time[(k + 1).min(last)] - time[k.saturating_sub(1)])))
        };
        ((0..time.len()).filter_map(weight).collect(), peak)
    }
}

/// A plate that is bent by forces at its centre.
#[derive(Debug, Clone, Copy)]
pub struct Bending {
    thickness: f64,
    poisson_ratio: f64,
    /// Growth of the square of b, to where the plate is bent, m^2/s, and the largest one, m^2.
    spreading: f64,
    farthest: f64,
}

impl Bending {
    /// Of `plate`.
    pub fn new(plate: &Plate) -> Self {
        let Plate { radius, thickness, material, edge, .. } = plate;
        let (nu, mass) = (material.poisson_ratio, material.density * thickness);
        let stiffness = rigidity(material.youngs_modulus, nu, *thickness);
        // moments at the centre of what edge and inertia add to a clamped plate, over (1 + nu)/(8 pi) F
        let beyond_clamped = match edge {
            Edge::Clamped => 0.0,
            Edge::SimplySupported => 2.0 / (1.0 + nu),
            Edge::Free => 0.5 * (1.0 - nu) / (1.0 + nu),
        };
        Self {
            thickness: *thickness,
            poisson_ratio: nu,
            spreading: 4.0 * (stiffness / mass).sqrt() * (-GAMMA).exp(),
            farthest: radius.powi(2) * (beyond_clamped - 1.0).exp(),
        }
    }

    /// Stress in Pa along the faces under outer and inner contact, tension positive, where the forces there are largest.
    pub fn at_peaks(&self, laws: &[Hertz; 2], loads: &ForceHistory) -> [f64; 2] {
        [(0, -1.0), (1, 1.0)].map(|(i, sign)| {
            let (weights, peak) = loads.weights(i);
            let ring = self.ring(laws[i].contact_radius(peak));
            let moments =
                weights.iter().map(|&(k, weight)| weight * self.moment(ring, loads, k)).sum::<f64>();
            let all = weights.iter().map(|(_, weight)| weight).sum::<f64>();
            let moment = if all > 0.0 { moments / all } else { 0.0 };
            sign * 6.0 * moment / self.thickness.powi(2)
        })
    }

    /// Radius in m of the ring that bends the plate in its middle as a patch of the radius `patch` in m does: that of a thin plate's
    /// circle with the stress under the patch (Westergaard 1926, after Timoshenko, article 19), over sqrt(e).
    fn ring(&self, patch: f64) -> f64 {
        let t = self.thickness;
        let circle =
            if patch < WIDE * t { (1.6 * patch.powi(2) + t.powi(2)).sqrt() - 0.675 * t } else { patch };
        circle * (-0.5_f64).exp()
    }

    /// Bending moment per width in N within forces on rings of the radius `ring` in m at the sample `end`.
    fn moment(&self, ring: f64, loads: &ForceHistory, end: usize) -> f64 {
        let ForceHistory { time, force: [outer, inner] } = loads;
        let force = |k: usize| outer[k] - inner[k];
        let reach = |k: usize| self.spreading * (time[end] - 0.5 * (time[k] + time[k - 1]));
        let weight = |reach: f64| (reach / ring.powi(2)).max(1.0).ln();
        let step = |k: usize| {
            let rise = force(k) - force(k - 1);
            if rise == 0.0 { 0.0 } else { rise * weight(reach(k)) }
        };
        // what has come to the edge is at rest: there the rises add up to the force
        let (mut settled, mut open) = (0, end);
        while settled < open {
            let middle = settled + (open - settled).div_ceil(2);
            if reach(middle) >= self.farthest { settled = middle } else { open = middle - 1 }
        }
        let at_rest = (force(settled) - force(0)) * weight(self.farthest);
        let rising = (settled + 1..=end).map(step).sum::<f64>();
        (1.0 + self.poisson_ratio) / (8.0 * PI) * (at_rest + rising)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::kirchhoff::UnitPlate;
    use crate::scene::Material;
    use approx::assert_relative_eq;

    const RADIUS: f64 = 0.033;

    fn plate(edge: Edge) -> Plate {
        let material = Material::elastic("steel", 210e9, 0.3, 7780.0);
        Plate { radius: RADIUS, thickness: 2e-3, material, edge, damping_ratio: 0.0 }
    }

    /// Moment within a ring of `r` radii of the plate by all modes, which answer a unit force by `answer` times their deflection at the centre,
    /// by their frequency in units of the plate: from how much deeper the centre lies than that ring; which is what the moment is within a ring
    /// e times smaller.
    fn by_modes(edge: Edge, r: f64, answer: impl Fn(f64) -> f64) -> f64 {
        let modes = UnitPlate::new(edge, 0.3, 150).unwrap();
        let around = modes.deflection(&[std::f64::consts::E * r]);
        let elastic = (0..modes.omega().len()).filter(|k| modes.omega()[*k] > 0.0);
        let deeper = elastic.map(|k| {
            let centre = modes.centre()[k];
            centre * (centre - around[k][0]) * answer(modes.omega()[k])
        });
        0.5 * 1.3 * 4.0 / (std::f64::consts::E * r).powi(2) * deeper.sum::<f64>()
    }

    /// Under a force that stays the plate comes to the moment that its edge leaves it.
    #[test]
    fn at_rest_the_moment_is_that_of_the_plate_s_modes() {
        let lasting = ForceHistory { time: vec![0.0, 1.0, 1e9], force: [vec![0.0, 1.0, 1.0], vec![0.0; 3]] };
        for edge in [Edge::Clamped, Edge::SimplySupported, Edge::Free] {
            let found = Bending::new(&plate(edge)).moment(0.03 * RADIUS, &lasting, 2);
            assert_relative_eq!(found, by_modes(edge, 0.03, |w| w.powi(-2)), max_relative = 5e-3);
        }
    }

    /// Under forces that grow evenly, those on both faces against each other, it is that of the modes until waves come back from the edge.
    #[test]
    fn soon_after_contact_the_moment_is_that_of_the_plate_s_modes() {
        let plate = plate(Edge::Clamped);
        let mass = plate.thickness * plate.material.density;
        let unit = RADIUS.powi(2) * (mass / rigidity(210e9, 0.3, plate.thickness)).sqrt();
        for t in [0.02, 0.04, 0.06] {
            let time: Vec<f64> = (0..=2000).map(|k| f64::from(k) / 2000.0 * t * unit).collect();
            let grown = |force: f64| time.iter().map(|now| force * now / (t * unit)).collect::<Vec<f64>>();
            let loads = ForceHistory { force: [grown(3.0), grown(2.0)], time: time.clone() };
            let found = Bending::new(&plate).moment(0.03 * RADIUS, &loads, 2000);
            let exact = by_modes(Edge::Clamped, 0.03, |w| (1.0 - (w * t).sin() / (w * t)) / (w * w));
            assert_relative_eq!(found, exact, max_relative = 0.02);
        }
    }
}
