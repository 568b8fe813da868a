//! A contact whose force depends on what it has been through.

use crate::contact::{DentedContact, Hertz, Press, ViscoelasticContact};

/// A contact law with memory: during a step its force is a function of the approach at the step's end.
#[derive(Debug, Clone)]
pub(super) enum Contact {
    /// Remembers nothing.
    Elastic(Hertz),
    Dented(Box<DentedContact>),
    Viscoelastic(Box<ViscoelasticContact>),
}

impl Contact {
    /// Prepares steps of `h` s.
    pub(super) fn prepare(&mut self, h: f64) {
        if let Contact::Viscoelastic(contact) = self {
            contact.prepare(h);
        }
    }

    /// Force in N at the approach `x` in m at the end of the step, its slope in N/m, and the work in J that the contact would have taken
    /// by then; not known of one that relaxes.
    pub(super) fn answer(&self, x: f64) -> [f64; 3] {
        match self {
            Contact::Elastic(hertz) => [hertz.force(x), hertz.tangent(x), hertz.energy(x)],
            Contact::Dented(contact) => contact.answer(x),
            Contact::Viscoelastic(contact) => {
                let [force, slope] = contact.force(x);
                [force, slope, f64::NAN]
            }
        }
    }

    /// Whether its force depends on time.
    pub(super) fn relaxes(&self) -> bool {
        matches!(self, Contact::Viscoelastic(_))
    }

    /// Ends the step at the approach `x` in m.
    pub(super) fn advance(&mut self, x: f64) {
        match self {
            Contact::Elastic(_) => {}
            Contact::Dented(contact) => contact.advance(x),
            Contact::Viscoelastic(contact) => contact.advance(x),
        }
    }

    /// How it is pressed at the end of a step with `force` N.
    pub(super) fn press(&self, force: f64) -> Press {
        match self {
            Contact::Elastic(hertz) => hertz.press(force),
            Contact::Dented(contact) => contact.press(),
            Contact::Viscoelastic(contact) => contact.press(),
        }
    }

    /// Energy in J that it has taken under `force` N: what it stores and what it has lost, by its law alone.
    pub(super) fn taken(&self, force: f64) -> f64 {
        match self {
            Contact::Elastic(hertz) => 0.4 * force * hertz.approach(force),
            Contact::Dented(contact) => contact.taken(),
            Contact::Viscoelastic(contact) => contact.taken(),
        }
    }

    /// Energy in J that it does not give back: dissipated by yielding, or taken by what relaxes and without a force keeps it until it has.
    /// Never negative.
    pub(super) fn dissipated(&self) -> f64 {
        match self {
            Contact::Elastic(_) => 0.0,
            Contact::Dented(contact) => contact.dissipated(),
            Contact::Viscoelastic(contact) => contact.taken(),
        }
    }

    /// Largest contact radius over the tip's at which it has yielded; 0 of one that has not.
    pub(super) fn widest(&self) -> f64 {
        match self {
            Contact::Dented(contact) => contact.widest(),
            _ => 0.0,
        }
    }

    /// Force in N up to which the contact is elastic; negative if it is not even without one.
    pub(super) fn critical_force(&self) -> f64 {
        match self {
            Contact::Elastic(_) => f64::INFINITY,
            Contact::Dented(contact) if contact.is_virgin() => contact.critical_force(),
            Contact::Dented(_) | Contact::Viscoelastic(_) => -1.0,
        }
    }

    /// The same on a plate that is pulled along its face by `stress` Pa while it is struck.
    pub(super) fn on_a_pulled_plate(self, stress: f64) -> Self {
        match self {
            Contact::Dented(contact) => Contact::Dented(Box::new(contact.on_a_pulled_plate(stress))),
            other => other,
        }
    }

    /// The approach `x` in m over that at which the contact begins to yield; 0 of one that does not.
    pub(super) fn overload(&self, x: f64) -> f64 {
        match self {
            Contact::Dented(contact) => x / contact.critical_approach(),
            _ => 0.0,
        }
    }

    /// Approach in m up to which there is no force at the end of the step.
    pub(super) fn contact_approach(&self) -> f64 {
        match self {
            Contact::Viscoelastic(contact) => contact.contact_approach(),
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
