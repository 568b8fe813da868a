//! A contact whose force depends on what it has been through.

use crate::contact::{Dent, ElasticPlastic, Hertz, ViscoelasticContact};
use crate::material::Material;

/// A contact law with memory: during a step its force is a function of the approach at the step's end.
#[derive(Debug, Clone)]
pub(super) enum Contact {
    /// Remembers nothing.
    Elastic(Hertz),
    Dented(DentedContact),
    Viscoelastic(ViscoelasticContact),
}

impl Contact {
    /// Prepares steps of `h` s.
    pub(super) fn prepare(&mut self, h: f64) {
        if let Contact::Viscoelastic(contact) = self {
            contact.prepare(h);
        }
    }

    /// Force in N at the approach `x` in m at the end of the step, and its slope in N/m.
    pub(super) fn force(&self, x: f64) -> [f64; 2] {
        match self {
            Contact::Elastic(hertz) => [hertz.force(x), hertz.tangent(x)],
            Contact::Dented(contact) => contact.force(x),
            Contact::Viscoelastic(contact) => contact.force(x),
        }
    }

    /// Ends the step at the approach `x` in m.
    pub(super) fn advance(&mut self, x: f64) {
        match self {
            Contact::Elastic(_) => {}
            Contact::Dented(contact) => contact.advance(x),
            Contact::Viscoelastic(contact) => contact.advance(x),
        }
    }

    /// Energy in J that it has taken under `force` N: what it stores and what it has lost, by its law alone.
    pub(super) fn taken(&self, force: f64) -> f64 {
        match self {
            Contact::Elastic(hertz) => 0.4 * force * hertz.approach(force),
            Contact::Dented(contact) => contact.taken(force),
            Contact::Viscoelastic(contact) => contact.taken(),
        }
    }

    /// Force in N up to which the contact is elastic; negative if it is not even without one.
    pub(super) fn critical_force(&self) -> f64 {
        match self {
            Contact::Elastic(_) => f64::INFINITY,
            Contact::Dented(contact) if contact.depth() == 0.0 => contact.critical_force(),
            Contact::Dented(_) | Contact::Viscoelastic(_) => -1.0,
        }
    }

    /// The approach `x` in m over that at which the contact begins to yield; 0 of one that does not.
    pub(super) fn overload(&self, x: f64) -> f64 {
        match self {
            Contact::Dented(contact) => x / contact.hertz.approach(contact.critical_force()),
            _ => 0.0,
        }
    }

    /// Approach in m up to which there is no force at the end of the step.
    pub(super) fn touch(&self) -> f64 {
        match self {
            Contact::Viscoelastic(contact) => contact.touch(),
            _ => self.depth(),
        }
    }

    /// Approach in m at which the surfaces touch for good: that of their dents.
    pub(super) fn depth(&self) -> f64 {
        match self {
            Contact::Dented(contact) => contact.depth(),
            _ => 0.0,
        }
    }
}

/// One of two surfaces in contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surface {
    /// Its part of the approach: the pair's composite modulus over its own plane-strain modulus.
    share: f64,
    law: Option<ElasticPlastic>,
    pub(super) dent: Dent,
}

/// Two surfaces in series, of which at least one yields: each takes its share of the approach, with a dent of its own.
///
/// With equal materials and dents they are one contact under the law for both; a fresh spot of one of them keeps the other's dent.
#[derive(Debug, Clone, Copy)]
pub(super) struct DentedContact {
    hertz: Hertz,
    pub(super) surfaces: [Surface; 2],
}

/// Most steps in which an approach is inverted.
const MAX_ITERATIONS: usize = 100;

impl DentedContact {
    /// The contact `hertz` of a body and the plate, of the materials `pair`; a material yields at `yield_strength` in Pa of its own.
    pub(super) fn new(hertz: Hertz, pair: [&Material; 2], yield_strength: [Option<f64>; 2]) -> Self {
        let modulus = 1.0 / pair.iter().map(|m| 1.0 / m.plane_strain_modulus()).sum::<f64>();
        let surface = |i: usize| Surface {
            share: modulus / pair[i].plane_strain_modulus(),
            law: yield_strength[i].map(|y| ElasticPlastic::new(hertz, modulus, y, pair[i].poisson_ratio)),
            dent: Dent::NONE,
        };
        Self { hertz, surfaces: [surface(0), surface(1)] }
    }

    /// Force in N up to which the virgin contact is elastic.
    pub(super) fn critical_force(&self) -> f64 {
        let of = |surface: &Surface| surface.law.map_or(f64::INFINITY, |law| law.critical_force());
        self.surfaces.iter().map(of).fold(f64::INFINITY, f64::min)
    }

    /// As [`Contact::taken`].
    fn taken(&self, force: f64) -> f64 {
        let elastic = 0.4 * force * self.hertz.approach(force);
        let of = |s: &Surface| s.share * s.law.map_or(elastic, |law| law.taken(&s.dent, force));
        self.surfaces.iter().map(of).sum()
    }

    /// Approach from the virgin surfaces in m under `force` N.
    fn approach(&self, force: f64) -> f64 {
        let of = |s: &Surface| {
            s.share * s.law.map_or_else(|| self.hertz.approach(force), |law| law.approach(&s.dent, force))
        };
        self.surfaces.iter().map(of).sum()
    }

    /// Approach in m at which the dented surfaces touch.
    pub(super) fn depth(&self) -> f64 {
        self.surfaces.iter().map(|s| s.share * s.dent.depth()).sum()
    }

    /// As [`Contact::force`], by regula falsi over the approach that Hertz's law has under the force: the two grow nearly evenly with each
    /// other.
    fn force(&self, x: f64) -> [f64; 2] {
        if x <= self.depth() {
            return [0.0; 2];
        }
        // equal surfaces with equal dents are one law
        let [one, other] = &self.surfaces;
        if let Some(law) = one.law
            && other.law == one.law
            && other.dent == one.dent
        {
            return law.force(&one.dent, x);
        }
        let at = |u: f64| self.approach(self.hertz.force(u)) - x;
        let mut ends = [0.0, x - self.depth()];
        while at(ends[1]) < 0.0 {
            ends = [ends[1], 2.0 * ends[1]];
        }
        let mut values = ends.map(at);
        let (mut u, mut last) = (ends[1], 2);
        for _ in 0..MAX_ITERATIONS {
            let next = ends[0] - values[0] * (ends[1] - ends[0]) / (values[1] - values[0]);
            let value = at(next);
            let moved = (next - u).abs();
            u = next;
            let side = usize::from(value > 0.0);
            (ends[side], values[side]) = (next, value);
            // an end that stays twice counts half (Illinois)
            if side == last {
                values[1 - side] *= 0.5;
            }
            last = side;
            if moved <= 1e-13 * u || value == 0.0 {
                break;
            }
        }
        let force = self.hertz.force(u);
        let step = 1e-6 * u;
        let per_u = (at(u + step) - at(u - step)) / (2.0 * step);
        [force, self.hertz.tangent(u) / per_u]
    }

    fn advance(&mut self, x: f64) {
        let [force, _] = self.force(x);
        for surface in &mut self.surfaces {
            if let Some(law) = &surface.law {
                surface.dent = law.dent_after(surface.dent, force);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn pair(yield_strength: [Option<f64>; 2]) -> DentedContact {
        let steel = Material::elastic("steel", 210e9, 0.3, 7780.0);
        DentedContact::new(Hertz::new(0.01, &steel, &steel), [&steel, &steel], yield_strength)
    }

    /// Two surfaces of one material and one history are the law of Jackson and Green for the pair.
    #[test]
    fn equal_surfaces_are_one_law() {
        let mut contact = pair([Some(600e6); 2]);
        let law = contact.surfaces[0].law.unwrap();
        for x in [1e-6, 5e-6, 8e-6] {
            assert_relative_eq!(contact.force(x)[0], law.loading(x)[0], max_relative = 1e-9);
        }
        contact.advance(8e-6);
        let dent = law.dent_after(Dent::NONE, law.loading(8e-6)[0]);
        assert_relative_eq!(contact.depth(), dent.depth(), max_relative = 1e-9);
        let half = law.loading(8e-6)[0] * 0.5;
        assert_relative_eq!(contact.force(law.approach(&dent, half))[0], half, max_relative = 1e-9);
    }

    /// Where only one surface yields the dent is smaller, and a fresh spot keeps the other's.
    #[test]
    fn a_surface_has_its_own_dent() {
        let [mut both, mut one] = [pair([Some(600e6); 2]), pair([None, Some(600e6)])];
        let [force, _] = both.force(8e-6);
        for contact in [&mut both, &mut one] {
            contact.advance(contact.approach(force));
        }
        assert!(one.depth() > 0.0 && one.depth() < both.depth());
        let before = both.depth();
        both.surfaces[0].dent = Dent::NONE;
        assert_relative_eq!(both.depth(), 0.5 * before, max_relative = 1e-12);
    }
}
