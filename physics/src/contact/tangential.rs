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
//! [`radial_slip`]: super::radial_slip

use super::Hertz;
use super::radial_slip::{dundurs_beta, parted};
use crate::material::Material;
use std::f64::consts::FRAC_1_SQRT_2;

/// Springs on one side of the middle, in all directions together.
const SPRINGS: usize = 64;
/// Radial directions of the springs, along the motion and across it, of like and of unlike materials.
static ONE_WAY: [[f64; 2]; 1] = [[1.0, 0.0]];
static BOTH_WAYS: [[f64; 2]; 2] = [[FRAC_1_SQRT_2, FRAC_1_SQRT_2], [-FRAC_1_SQRT_2, FRAC_1_SQRT_2]];

/// A contact under a changing normal force, whose surfaces move along each other.
#[derive(Debug, Clone)]
pub struct TangentialContact {
    law: Hertz,
    /// Stiffnesses of the row of springs across and along it, N/m^2.
    normal: f64,
    tangential: f64,
    /// Dundurs' beta: by it Hertz's pressure moves both surfaces apart radially.
    beta: f64,
    friction: f64,
    /// Distance of the springs, m.
    spacing: f64,
    directions: &'static [[f64; 2]],
    /// Deflections of the springs along the motion and across it, m. Shape (directions, springs).
    deflections: Vec<[f64; 2]>,
    /// Contact radius, m.
    radius: f64,
    /// Tangential force on the face in the direction of the tip's motion, N.
    pub force: f64,
    /// Work of the motion along the surface so far, J.
    work: f64,
}

/// What a step does to the springs at a place.
struct SpringStep {
    /// Share of the motion that they take part in.
    share: f64,
    /// Their radial motion, m.
    radial: f64,
    /// Deflection from which on they slide, m.
    most: f64,
}

impl TangentialContact {
    /// Of a tip and a face of these materials that touch by `law`, with a coefficient of `friction`, under at most `largest_force` N.
    pub fn new(law: Hertz, [tip, face]: [&Material; 2], friction: f64, largest_force: f64) -> Self {
        // Mindlin's stiffness 8 a/((2 - nu)/G + ...), over the length 2 a
        let compliance = |of: &Material| 0.25 * (2.0 - of.poisson_ratio) / of.shear_modulus();
        let beta = dundurs_beta(tip, face);
        let directions: &[[f64; 2]] = if beta == 0.0 { &ONE_WAY } else { &BOTH_WAYS };
        let springs = SPRINGS / directions.len();
        Self {
            law,
            normal: 0.75 * law.stiffness / law.tip_radius.sqrt(),
            tangential: 1.0 / (compliance(tip) + compliance(face)),
            beta,
            friction,
            spacing: law.contact_radius(largest_force) / springs as f64,
            directions,
            deflections: vec![[0.0; 2]; SPRINGS],
            radius: 0.0,
            force: 0.0,
            work: 0.0,
        }
    }

    /// Stiffness in N/m of a contact under `force` N in which nothing slides.
    pub fn sticking_stiffness(&self, force: f64) -> f64 {
        2.0 * self.law.contact_radius(force) * self.tangential
    }

    /// Strain energy by the motion along the surface, J.
    pub fn stored(&self) -> f64 {
        0.5 * self.spring_stiffness() * self.deflections.iter().map(|[along, _]| along * along).sum::<f64>()
    }

    /// Energy in J that the motion along the surface has lost so far.
    pub fn dissipated(&self) -> f64 {
        self.work - self.stored()
    }

    /// Moves the surfaces by another `step` m while the normal force becomes `force` N.
    pub fn advance(&mut self, force: f64, step: f64) {
        let radius = self.law.contact_radius(force);
        let mut held = 0.0;
        // those beyond are at rest
        let reached = (radius.max(self.radius) / self.spacing).ceil() as usize;
        for place in 0..self.places().min(reached) {
            let at = self.step(place, radius);
            for direction in 0..self.directions.len() {
                let spring = direction * self.places() + place;
                let now = self.moved(spring, direction, &at, step);
                held += now[0];
                self.deflections[spring] = now;
            }
        }
        self.radius = radius;
        let force = self.spring_stiffness() * held;
        let before = std::mem::replace(&mut self.force, force);
        self.work += 0.5 * (before + self.force) * step;
    }

    /// Stiffness in N/m of a spring and its mirror image on the other side.
    fn spring_stiffness(&self) -> f64 {
        2.0 * self.spacing * self.tangential / self.directions.len() as f64
    }

    fn places(&self) -> usize {
        self.deflections.len() / self.directions.len()
    }

    /// While the contact radius becomes `radius` m.
    #[inline]
    fn step(&self, place: usize, radius: f64) -> SpringStep {
        let place = (place as f64 + 0.5) * self.spacing;
        if place >= radius {
            return SpringStep { share: 0.0, radial: 0.0, most: 0.0 };
        }
        let touched = place < self.radius;
        // what the growing contact reaches in between takes part from then on
        let share = if touched { 1.0 } else { (radius - place) / (radius - self.radius) };
        let parted = |place: f64, radius: f64| match self.beta {
            0.0 => 0.0,
            beta => parted(beta, place, radius) / self.law.tip_radius,
        };
        let before = if touched { parted(place, self.radius) } else { 0.0 };
        let pressed = self.normal * (radius * radius - place * place) / self.law.tip_radius;
        SpringStep {
            share,
            radial: parted(place, radius) - before,
            most: self.friction * pressed / self.tangential,
        }
    }

    /// Deflection of a spring afterwards, m.
    #[inline]
    fn moved(&self, spring: usize, direction: usize, at: &SpringStep, step: f64) -> [f64; 2] {
        let [[along, across], radial] = [self.deflections[spring], self.directions[direction]];
        let wanted = [along + at.share * step + at.radial * radial[0], across + at.radial * radial[1]];
        let length = wanted[0].hypot(wanted[1]);
        let share = if length <= at.most { 1.0 } else { at.most / length };
        wanted.map(|part| part * share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRICTION: f64 = 0.3;
    const NORMAL_FORCE: f64 = 50.0;

    fn contact(friction: f64) -> TangentialContact {
        let steel = Material::elastic("steel", 210e9, 0.3, 7800.0);
        let law = Hertz::new(3e-3, &steel, &steel);
        let mut contact = TangentialContact::new(law, [&steel, &steel], friction, NORMAL_FORCE);
        contact.advance(NORMAL_FORCE, 0.0);
        contact
    }

    /// Displacement in m at which all of it slides, over 1 - (1 - T/(mu N))^(2/3) (Johnson 1985, eq. 7.42).
    fn whole(contact: &TangentialContact) -> f64 {
        1.5 * FRICTION * NORMAL_FORCE / contact.sticking_stiffness(NORMAL_FORCE)
    }

    /// Mindlin and Deresiewicz's loop under a constant normal force: loading to 0.8 mu N, unloading to its opposite, loading again
    /// (Johnson 1985, eqs. 7.42 to 7.46).
    #[test]
    fn a_loop_of_loading_and_unloading_is_mindlin_s() {
        let mut contact = contact(FRICTION);
        let (whole, limit) = (whole(&contact), FRICTION * NORMAL_FORCE);
        let turn = 0.8 * limit;
        let loading = |force: f64| whole * (1.0 - (1.0 - force / limit).powf(2.0 / 3.0));
        let unloading = |force: f64| {
            loading(turn) - 2.0 * whole * (1.0 - (1.0 - 0.5 * (turn - force) / limit).powf(2.0 / 3.0))
        };
        let mut place = 0.0;
        let mut go = |contact: &mut TangentialContact, to: f64| {
            // small steps, over which the work is summed up
            (0..100).for_each(|_| contact.advance(NORMAL_FORCE, (to - place) / 100.0));
            place = to;
        };
        for share in [0.1, 0.3, 0.5, 0.7, 0.8] {
            go(&mut contact, loading(share * limit));
            assert!((contact.force - share * limit).abs() < 1e-3 * limit, "{share} {}", contact.force);
        }
        for share in [0.6, 0.2, -0.2, -0.5, -0.8] {
            go(&mut contact, unloading(share * limit));
            assert!((contact.force - share * limit).abs() < 1e-3 * limit, "{share} {}", contact.force);
        }
        // back the same way, mirrored: the loop closes
        for share in [0.5, 0.0, -0.5, -0.8_f64] {
            go(&mut contact, -unloading(share * limit));
            assert!((contact.force + share * limit).abs() < 1e-3 * limit, "{share} {}", contact.force);
        }
        // energy of the loop (Johnson 1985, eq. 7.49)
        let lost = |ratio: f64| {
            let left: f64 = 1.0 - ratio;
            3.6 * limit * limit / contact.sticking_stiffness(NORMAL_FORCE)
                * (1.0 - left.powf(5.0 / 3.0) - 5.0 / 6.0 * ratio * (1.0 + left.powf(2.0 / 3.0)))
        };
        // one of loading before it, which dissipates an eighth less than half a loop of the same amplitude
        let mut first = super::tests::contact(FRICTION);
        (0..500).for_each(|_| first.advance(NORMAL_FORCE, loading(turn) / 500.0));
        let loop_energy = contact.dissipated() - first.dissipated();
        assert!((loop_energy / (2.0 * lost(0.8)) - 1.0).abs() < 5e-3, "{loop_energy} {}", lost(0.8));
    }

    /// Where it slides, friction times the normal force; without friction nothing; what sticks does not dissipate.
    #[test]
    fn it_slides_by_coulomb_and_sticks_by_mindlin() {
        let mut sliding = contact(FRICTION);
        sliding.advance(NORMAL_FORCE, 3.0 * whole(&sliding));
        assert!((sliding.force / (FRICTION * NORMAL_FORCE) - 1.0).abs() < 1e-4);
        let mut smooth = contact(0.0);
        smooth.advance(NORMAL_FORCE, 1e-6);
        assert_eq!((smooth.force, smooth.dissipated()), (0.0, 0.0));
        let mut sticking = contact(1e9);
        sticking.advance(NORMAL_FORCE, 1e-6);
        let stiffness = sticking.sticking_stiffness(NORMAL_FORCE);
        assert!((sticking.force / (stiffness * 1e-6) - 1.0).abs() < 1e-12);
        assert!(sticking.dissipated().abs() < 1e-12 * sticking.stored());
        assert!((sticking.stored() / (0.5 * stiffness * 1e-12) - 1.0).abs() < 1e-12);
    }

    /// Under a falling normal force what sticks slides in the end: no energy comes out of nothing.
    #[test]
    fn nothing_is_gained_under_a_changing_normal_force() {
        let mut contact = contact(FRICTION);
        let (whole, count) = (whole(&contact), 4000);
        let mut lost = 0.0;
        for step in 1..=count {
            let phase = step as f64 / count as f64;
            contact.advance(NORMAL_FORCE * (1.0 - 0.9 * phase), 2.0 * whole * (0.7 - phase) / count as f64);
            assert!(contact.dissipated() > lost - 1e-6 * FRICTION * NORMAL_FORCE * whole);
            lost = contact.dissipated();
        }
        assert!(lost > 0.02 * FRICTION * NORMAL_FORCE * whole);
    }
}
