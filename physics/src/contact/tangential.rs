//! Tangential contact of spherical tips with Coulomb's friction.
//!
//! Method of dimensionality reduction (Popov and Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction, Springer
//! 2015, chapter 5): a row of independent springs, each pressed on as Hertz's contact is and each sticking or sliding by Coulomb's law,
//! has the tangential force of Cattaneo's and Mindlin's theory, whatever the order of loading and unloading.
//!
//! That theory is of like materials. The surfaces of unlike ones also slide radially while the normal force changes ([`radial_slip`]),
//! and what rubs radially resists less along the motion. Springs of unlike materials deflect both ways, in two directions from the
//! middle that stand for all.
//!
//! Where bodies yield, the pressure is more even and its radius the dent's, but what springs back along the surfaces is elastic. Springs of
//! bodies that relax creep as those across the surfaces do ([`super::ViscoelasticContact`]).
//!
//! [`radial_slip`]: super::radial_slip

mod creeping;

use self::creeping::CreepingSprings;
use super::Press;
use super::radial_slip::{dundurs_beta, parted};
use crate::material::Material;
use std::f64::consts::FRAC_1_SQRT_2;
use wide::f64x4;

/// Springs on one side of the middle, in all directions together.
const SPRINGS: usize = 64;
/// Springs side by side.
const LANES: usize = 4;
/// Radial directions of the springs, along the motion and across it, of like and of unlike materials.
static ONE_WAY: [[f64; 2]; 1] = [[1.0, 0.0]];
static BOTH_WAYS: [[f64; 2]; 2] = [[FRAC_1_SQRT_2, FRAC_1_SQRT_2], [-FRAC_1_SQRT_2, FRAC_1_SQRT_2]];

/// A contact under a changing normal force, whose surfaces move along each other.
#[derive(Debug, Clone)]
pub struct TangentialContact {
    /// Stiffness of the row of springs along the surfaces, N/m^2.
    tangential: f64,
    /// Dundurs' beta: by it Hertz's pressure moves both surfaces apart radially.
    beta: f64,
    friction: f64,
    /// Distance of the springs, m.
    spacing: f64,
    directions: &'static [[f64; 2]],
    /// Distance of the first springs from the middle, m.
    first: f64x4,
    /// Deflections of the springs along the motion and across it, m. Shape (directions, springs / LANES).
    deflections: Vec<[f64x4; 2]>,
    /// What springs of bodies that relax have been through; `None`: they are elastic.
    creeping: Option<CreepingSprings>,
    press: Press,
    /// Tangential force on the face in the direction of the tip's motion, N.
    pub force: f64,
    /// Work of the motion along the surface so far, J.
    work: f64,
}

/// What a step does to the springs at some places.
struct SpringStep {
    /// Share of the motion that they take part in.
    share: f64x4,
    /// Their radial motion, m.
    radial: f64x4,
    /// Deflection from which on they slide, m.
    most: f64x4,
}

impl TangentialContact {
    /// Of a tip and a face of these materials with a coefficient of `friction`, and at most the contact radius `widest` m.
    pub fn new([tip, face]: [&Material; 2], friction: f64, widest: f64) -> Self {
        // Mindlin's stiffness 8 a/((2 - nu)/G + ...), over the length 2 a
        let compliance = |of: &Material| 0.25 * (2.0 - of.poisson_ratio) / of.shear_modulus();
        let compliances = [tip, face].map(compliance);
        let whole = compliances[0] + compliances[1];
        let beta = dundurs_beta(tip, face);
        let directions: &[[f64; 2]] = if beta == 0.0 { &ONE_WAY } else { &BOTH_WAYS };
        let spacing = widest / (SPRINGS / directions.len()) as f64;
        Self {
            tangential: 1.0 / whole,
            beta,
            friction,
            spacing,
            directions,
            first: f64x4::from([0.5, 1.5, 2.5, 3.5]) * spacing,
            deflections: vec![[f64x4::ZERO; 2]; SPRINGS / LANES],
            creeping: CreepingSprings::new([tip, face], compliances.map(|part| part / whole), SPRINGS),
            press: Press::default(),
            force: 0.0,
            work: 0.0,
        }
    }

    /// Stiffness in N/m, at once, of a contact with this `radius` in m in which nothing slides.
    pub fn sticking_stiffness(&self, radius: f64) -> f64 {
        2.0 * radius * self.tangential
    }

    /// Strain energy by the motion along the surface, J.
    pub fn stored(&self) -> f64 {
        let elastic =
            || 0.5 * self.deflections.iter().map(|[along, _]| (*along * *along).reduce_add()).sum::<f64>();
        self.spring_stiffness() * self.creeping.as_ref().map_or_else(elastic, CreepingSprings::stored)
    }

    /// Energy in J that friction has taken so far.
    pub fn dissipated(&self) -> f64 {
        let crept = self.creeping.as_ref().map_or(0.0, CreepingSprings::lost);
        self.work - self.stored() - self.spring_stiffness() * crept
    }

    /// Moves the surfaces by another `step` m in `h` s until the contact is pressed by `press`.
    pub fn advance(&mut self, press: Press, step: f64, h: f64) {
        self.creeping.iter_mut().for_each(|creeping| creeping.prepare(h));
        let mut held = f64x4::ZERO;
        let blocks = self.deflections.len() / self.directions.len();
        // those beyond are at rest, unless they creep
        let reached = press.radius.max(self.press.radius) / (LANES as f64 * self.spacing);
        let reached = if self.creeping.is_some() { blocks } else { blocks.min(reached.ceil() as usize) };
        for block in 0..reached {
            let at = self.step(self.first + f64x4::splat((block * LANES) as f64 * self.spacing), &press);
            for (direction, radial) in self.directions.iter().enumerate() {
                held += self.moved(direction * blocks + block, radial, &at, step);
            }
        }
        self.creeping.iter_mut().for_each(CreepingSprings::book);
        self.press = press;
        let force = self.spring_stiffness() * held.reduce_add();
        let before = std::mem::replace(&mut self.force, force);
        self.work += 0.5 * (before + self.force) * step;
    }

    /// Stiffness in N/m of a spring and its mirror image on the other side.
    fn spring_stiffness(&self) -> f64 {
        2.0 * self.spacing * self.tangential / self.directions.len() as f64
    }

    /// Until the contact is pressed by `press`.
    #[inline(always)]
    fn step(&self, place: f64x4, press: &Press) -> SpringStep {
        let before = &self.press;
        let inside = place.simd_lt(f64x4::splat(press.radius));
        let touched = place.simd_lt(f64x4::splat(before.radius));
        // what the growing contact reaches in between takes part from then on
        let reached = (f64x4::splat(press.radius) - place) * (press.radius - before.radius).recip();
        let parted = |press: &Press| match self.beta {
            0.0 => f64x4::ZERO,
            beta => {
                f64x4::from(place.to_array().map(|place| parted(beta, place, press.radius))) * press.curvature
            }
        };
        let within = |value: f64x4| inside.select(value, f64x4::ZERO);
        SpringStep {
            share: within(touched.select(f64x4::ONE, reached)),
            radial: within(parted(press) - touched.select(parted(before), f64x4::ZERO)),
            most: within(press.load(place) * (self.friction / self.tangential)),
        }
    }

    /// Moves springs side by side; gives their forces along the motion afterwards over their stiffness, m.
    #[inline(always)]
    fn moved(&mut self, springs: usize, radial: &[f64; 2], at: &SpringStep, step: f64) -> f64x4 {
        let [along, across] = self.deflections[springs];
        let wanted = [along + at.share * step + at.radial * radial[0], across + at.radial * radial[1]];
        let deflections = &mut self.deflections[springs];
        match &mut self.creeping {
            Some(creeping) => return creeping.moved(springs, wanted, at.most, deflections),
            // like materials: along the motion alone
            None if self.beta == 0.0 => deflections[0] = wanted[0].fast_min(at.most).fast_max(-at.most),
            None => *deflections = at_most(wanted, at.most),
        }
        deflections[0]
    }
}

/// The same in every lane's direction, of `most` length.
#[inline(always)]
fn at_most([x, y]: [f64x4; 2], most: f64x4) -> [f64x4; 2] {
    let length = (x * x + y * y).sqrt();
    let share = length.simd_le(most).select(f64x4::ONE, most / length);
    [x * share, y * share]
}

#[cfg(test)]
mod tests;
