//! Impacts of materials with memory: viscoelastic bodies, and contacts that yield.
//!
//! Modes with internal variables move exactly under the forces of a step; the contacts are laws of the approach at its
//! end, whose memory moves from step to step. The steps are of second order, and of one length unless nothing touches or the forces change
//! slowly; runs
//! with half the length follow until the result stands. Elastic impacts know nothing of this: they take [`super::integrator`].

mod bending;
mod contact;
mod modes;
mod step_force;
mod step_length;
mod stepper;

pub use self::bending::{Bending, ForceHistory};
pub(crate) use self::modes::ModeFlow;

use self::contact::Contact;
use self::step_force::StepForce;
use self::stepper::MemoryStepper;
use super::driver;
use super::error_control::differences;
use super::integration::{Converged, Integration, Options};
use super::system::System;
use crate::analytical::hertz::HertzImpact;
use crate::contact::{DentedContact, Hertz, TABOR, ViscoelasticContact};
use crate::error::{Error, Result};
use crate::material::{Creep, Material, Relaxation, vibration_frequency};
use crate::scene::Spot;

/// Steps of the first run per duration of the outer body's impact on a rigid wall.
const FIRST_STEPS: f64 = 200.0;
/// Springs of a viscoelastic contact across its radius in the first run, and their distance over that of the run before.
const SPRINGS: f64 = 64.0;
const FINER: f64 = 0.8;
/// Most halvings of the step.
const MAX_HALVINGS: usize = 7;
/// Change of velocities, over the impact speed, and force peaks, relative, from one run to the next that is in order: of second order,
/// the finer one is off by a third of it.
pub const CHANGE: f64 = 1e-4;
/// Rounds in which the plate's bending and the forces settle at most, those that take it as found, and the change of results that is
/// in order.
const MOST_ROUNDS: usize = 24;
const STRAIGHT: usize = 3;
const CONVERGED: f64 = 1e-5;

/// Approaches over the critical one up to which the law of a contact that yields was compared with finite elements, and up to which it is
/// used: beyond, contacts last so much longer than Hertz's that steps of his are the wrong ones.
const PROVEN_OVERLOAD: f64 = 110.0;
const MOST_OVERLOAD: f64 = 1e4;

/// Largest contact radius over the tip's for which the finite elements, of small strains, were solved.
const WIDEST: f64 = 1.0 / 5.2;

/// What the materials of an impact remember.
#[derive(Debug, Clone)]
pub struct Memory {
    bodies: CreepingContacts,
    /// What the models leave out, a sentence each.
    pub warnings: Vec<String>,
    /// Relaxation of the plate's material.
    plate: Vec<Relaxation>,
    /// How the plate bends, if there is one.
    bending: Option<Bending>,
}

/// Contacts and what lies beneath them.
#[derive(Debug, Clone)]
struct CreepingContacts {
    contacts: [Contact; 2],
    /// Creep of the plate and of the tips of both bodies beyond half-spaces.
    plate: Creep,
    tips: [Creep; 2],
    /// Residual flexibility of the tips, m/N.
    tip_residual: [f64; 2],
}

impl CreepingContacts {
    /// Prepares steps of `h` s.
    fn prepare(&mut self, h: f64) {
        self.contacts.iter_mut().for_each(|contact| contact.prepare(h));
        self.plate.prepare(h);
        self.tips.iter_mut().for_each(|tip| tip.prepare(h));
    }

    /// The creep beneath contact `i` of the plate (`part` 0) or of the body's tip (1).
    fn creep(&self, i: usize, part: usize) -> &Creep {
        if part == 0 { &self.plate } else { &self.tips[i] }
    }

    /// What plate and tip yield at once beyond half-spaces under the forces `force` in N (m, shape (contact; plate, tip)), the patches
    /// in m, from those of a nearby state, and the flexibilities in m/N.
    fn elastic(
        &self,
        system: &System,
        force: [f64; 2],
        patch: [f64; 2],
    ) -> ([[f64; 2]; 2], [f64; 2], [[f64; 2]; 2]) {
        let Some(residual) = &system.residual else {
            return (
                Default::default(),
                [0, 1].map(|i| system.laws[i].approach(force[i])),
                Default::default(),
            );
        };
        let (both, patch) = residual.displacement(&system.laws, force, patch);
        let parts = [0, 1].map(|i| {
            let tip = self.tip_residual[i] * force[i];
            [both[i] - tip, tip]
        });
        (parts, patch, residual.state(&system.laws, patch).beyond_half_spaces())
    }

    /// Elastic energy in J of what yields at once beyond half-spaces under the forces `force` in N with the patches `patch` in m.
    fn energy_beyond(&self, system: &System, force: [f64; 2], patch: [f64; 2]) -> f64 {
        let Some(residual) = &system.residual else { return 0.0 };
        let half_space = |i: usize| 0.4 * force[i] * system.laws[i].approach(force[i]);
        residual.energy(&system.laws, patch) - half_space(0) - half_space(1)
    }

    /// How the forces of a step follow from those at its ends: a plate that relaxes has no contact that does not.
    fn step_force(&self) -> StepForce {
        if self.contacts.iter().any(Contact::relaxes) { StepForce::Linear } else { StepForce::Conserving }
    }
}

impl Memory {
    /// What the `materials` of outer body, plate and inner body remember in a model that is `system` of a plate with this `bending`, or of none,
    /// virgin; `None` if all of them are elastic.
    ///
    /// # Errors
    /// [`Error::Solver`] for a yield strength far below the contact pressure, [`Error::Internal`] for what no scene may have.
    pub fn new(materials: [&Material; 3], bending: Option<Bending>, system: &System) -> Result<Option<Self>> {
        let [outer, plate, inner] = materials;
        let bodies = [outer, inner];
        if materials.iter().all(|m| m.is_elastic()) {
            return Ok(None);
        }
        let hits = [0, 1].map(|i| hit(system, i));
        let contact = |i: usize| match system.can_close(i) {
            true => contact([bodies[i], plate], system.laws[i], &hits[i]),
            false => Ok(Contact::Elastic(system.laws[i])),
        };
        let contacts = [contact(0)?, contact(1)?];
        Ok(Some(Self {
            warnings: overloaded(&contacts, &hits)?.into_iter().collect(),
            bodies: CreepingContacts {
                contacts,
                plate: Creep::new(&plate.relaxation),
                tips: bodies.map(|m| Creep::new(&m.relaxation)),
                tip_residual: system.tip_residual,
            },
            plate: plate.relaxation.clone(),
            bending,
        }))
    }

    /// Whether plate and contacts are elastic as they are now, until something yields.
    pub fn is_elastic(&self) -> bool {
        self.plate.is_empty() && self.critical_forces([0.0; 2]).iter().all(|force| *force >= 0.0)
    }

    /// Whether they stay so under `loads` with the largest forces `peaks` in N, in a model that is `system`.
    pub fn is_elastic_under(&self, system: &System, loads: &ForceHistory, peaks: [f64; 2]) -> bool {
        let critical = self.critical_forces(stress_at_peaks(self.bending, system, loads));
        self.plate.is_empty() && critical.into_iter().zip(peaks).all(|(critical, peak)| peak <= critical)
    }

    /// Forces in N up to which the contacts are elastic as they are now, under the stresses `stress` in Pa along the plate's faces: none of
    /// a dented or a viscoelastic one.
    pub fn critical_forces(&self, stress: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| self.bodies.contacts[i].clone().on_a_pulled_plate(stress[i]).critical_force())
    }

    /// The same when everything has come to rest and recovered, with fresh spots of outer and inner body if the series has them so.
    #[must_use]
    pub fn next(mut self, spot: Spot) -> Self {
        for contact in &mut self.bodies.contacts {
            match contact {
                Contact::Dented(contact) if spot == Spot::Fresh => **contact = contact.on_a_fresh_spot(),
                Contact::Viscoelastic(contact) => **contact = contact.virgin(),
                _ => {}
            }
        }
        self
    }

    /// Frequency in Hz at which the plate vibrates in a mode of `instantaneous` Hz.
    pub fn frequency(&self, instantaneous: f64) -> f64 {
        vibration_frequency(&self.plate, instantaneous)
    }

    /// Whether the plate's bending matters to a contact: one that can yield and has not.
    fn bends(&self) -> bool {
        self.bending.is_some()
            && self
                .bodies
                .contacts
                .iter()
                .any(|c| matches!(c, Contact::Dented(contact) if contact.is_virgin()))
    }

    /// A sentence if a contact has yielded over a larger part of its tip than its law was found for.
    pub fn too_wide(&self) -> Option<String> {
        let widest = self.bodies.contacts.iter().map(Contact::widest).fold(0.0, f64::max);
        (widest > WIDEST).then(|| {
            format!(
                "a plastic contact has a radius of {widest:.2} tip radii; its law assumes small strains and was compared with finite elements up to {WIDEST:.2}"
            )
        })
    }

    /// Whether outer and inner contact can yield.
    pub fn yields(&self) -> [bool; 2] {
        [0, 1].map(|i| matches!(self.bodies.contacts[i], Contact::Dented(_)))
    }
}

/// Where outer and inner contact, virgin, begin to yield at low rates.
#[derive(Debug, Clone)]
pub struct OnsetOfYield {
    /// `None` where no yield strength is known.
    contacts: [Option<DentedContact>; 2],
    bending: Option<Bending>,
}

impl OnsetOfYield {
    /// Of the materials that meet at the contact of the outer and of the inner body, each body's first; `None` if no yield strength is
    /// known.
    pub fn new(pairs: [[&Material; 2]; 2], bending: Option<Bending>, system: &System) -> Option<Self> {
        let contacts = [0, 1].map(|i| {
            DentedContact::new(system.laws[i], pairs[i], pairs[i].map(|m| m.yield_strength))
                .filter(|_| system.can_close(i))
        });
        contacts.iter().any(Option::is_some).then_some(Self { contacts, bending })
    }

    /// Force in N at which contact `i` of `system` begins to yield in an impact with the course of `loads`; `None` if nothing there can.
    pub fn force(&self, i: usize, system: &System, loads: &ForceHistory) -> Option<f64> {
        let stress = stress_at_peaks(self.bending, system, loads)[i];
        Some(self.contacts[i]?.on_a_pulled_plate(stress).critical_force())
    }
}

/// Stress in Pa along the faces of a plate with this `bending` where the forces `loads` are largest; none without a plate.
fn stress_at_peaks(bending: Option<Bending>, system: &System, loads: &ForceHistory) -> [f64; 2] {
    bending.map_or([0.0; 2], |bending| bending.at_peaks(&system.laws, loads))
}

/// Contact `i` as an impact on a rigid plate, both bodies closing: the scale of its load. Without a plate there is one impact.
fn hit(system: &System, i: usize) -> HertzImpact {
    if !system.can_close(1) {
        return system.hertz_impact();
    }
    let speed = system.speed + system.inner_speed.max(0.0);
    HertzImpact { mass: system.masses[i], speed, stiffness: system.laws[i].stiffness }
}

/// The contact of a body and the plate, the materials `pair`.
fn contact(pair: [&Material; 2], hertz: Hertz, hit: &HertzImpact) -> Result<Contact> {
    let radius = (hertz.tip_radius * hit.approach_peak()).sqrt();
    let relaxes = pair.iter().any(|m| !m.relaxation.is_empty());
    let yields = pair.map(|m| yield_strength(m, TABOR * radius / hertz.tip_radius / (0.5 * hit.duration())));
    match (relaxes, DentedContact::new(hertz, pair, yields)) {
        (false, None) => Ok(Contact::Elastic(hertz)),
        (false, Some(contact)) => Ok(Contact::Dented(Box::new(contact))),
        (true, None) => {
            let springs = ViscoelasticContact::new(hertz.tip_radius, pair, radius / SPRINGS);
            Ok(Contact::Viscoelastic(Box::new(springs)))
        }
        (true, Some(_)) => Err(Error::Internal("a contact that yields and relaxes".into())),
    }
}

/// A sentence if a contact as hard as one of `hits` is driven beyond what its law was found for.
///
/// # Errors
/// [`Error::Solver`] if it is so far beyond that nothing is known.
fn overloaded(contacts: &[Contact; 2], hits: &[HertzImpact; 2]) -> Result<Option<String>> {
    let overload = |i: usize| contacts[i].overload(hits[i].approach_peak());
    let overload = overload(0).max(overload(1));
    let warning = format!(
        "a contact reaches about {overload:.0} times the approach at first yield; the law of plastic contacts was compared with finite elements up to {PROVEN_OVERLOAD} times"
    );
    if overload > MOST_OVERLOAD {
        return Err(Error::Solver(format!(
            "reduced model: {warning}, and it is refused beyond {MOST_OVERLOAD:.0}; is `yield_strength` in the right unit?"
        )));
    }
    Ok((overload > PROVEN_OVERLOAD).then_some(warning))
}

/// Yield strength in Pa at the rate of plastic `strain` in 1/s, if the material yields.
fn yield_strength(material: &Material, strain_rate: f64) -> Option<f64> {
    let plasticity = material.plasticity()?;
    let growth = plasticity.rate.map_or(0.0, |r| (strain_rate / r.reference_rate).powf(1.0 / r.exponent));
    Some(plasticity.yield_strength * (1.0 + growth))
}

/// A run that is over.
struct Ran {
    integration: Integration,
    /// The contacts as they are then.
    contacts: [Contact; 2],
    loads: ForceHistory,
}

/// Integrates the impact of `system` with materials that remember `memory`; gives also what they remember afterwards.
///
/// # Errors
/// [`Error::Solver`] if a contact has no equilibrium or the run does not end.
pub fn integrate(system: &System, memory: &Memory, options: &Options) -> Result<(Integration, Memory)> {
    let base = system.hertz_impact().duration() / FIRST_STEPS;
    let run = |halvings: usize, stress: [f64; 2], peaks: Option<[f64; 2]>| -> Result<Ran> {
        let h = base * 0.5_f64.powi(halvings as i32);
        let mut bodies = memory.bodies.clone();
        for (i, contact) in bodies.contacts.iter_mut().enumerate() {
            *contact = contact.clone().on_a_pulled_plate(stress[i]);
            let radius = peaks.map(|peaks| system.laws[i].contact_radius(peaks[i])).filter(|r| *r > 0.0);
            // as many springs as the peak of the run before asks for, and more with every halving
            if let (Contact::Viscoelastic(contact), Some(radius)) = (contact, radius) {
                **contact = contact.with_springs_every(radius / SPRINGS * FINER.powi(halvings as i32));
            }
        }
        let mut stepper = MemoryStepper::new(system, bodies, &memory.plate, h, options);
        driver::run(&mut stepper)?;
        Ok(stepper.finish())
    };
    let after = |ran: &Ran| Memory {
        bodies: CreepingContacts { contacts: ran.contacts.clone(), ..memory.bodies.clone() },
        ..memory.clone()
    };
    if let Some(Converged::Even { halvings, stress, peaks }) = options.converged {
        let ran = run(halvings, stress, Some(peaks))?;
        let memory = after(&ran);
        return Ok((ran.integration, memory));
    }
    let peaks_of = |ran: &Ran| ran.integration.contacts.map(|contact| contact.force_peak);
    let change = |before: &Ran, ran: &Ran| -> f64 {
        let results = [before, ran].map(|ran| &ran.integration);
        let velocities = results.map(|result| result.velocity);
        let [velocity, force] = differences(system, velocities, [before, ran].map(peaks_of));
        velocity.max(force)
    };
    let mut before = run(0, [0.0; 2], None)?;
    let mut stress = [0.0; 2];
    // the plate bends under the forces that the contacts answer with, which its bending changes a little
    let mut unsettled = 0.0;
    for round in 0..if memory.bends() { MOST_ROUNDS } else { 0 } {
        let found = stress_at_peaks(memory.bending, system, &before.loads);
        // where it changes them by more than a little, half of the way
        let share = if round < STRAIGHT { 1.0 } else { 0.5 };
        stress = [0, 1].map(|i| stress[i] + share * (found[i] - stress[i]));
        let ran = run(0, stress, Some(peaks_of(&before)))?;
        unsettled = change(&before, &ran);
        before = ran;
        if unsettled <= CONVERGED {
            unsettled = 0.0;
            break;
        }
    }
    for halvings in 1..=MAX_HALVINGS {
        let peaks = peaks_of(&before);
        let ran = run(halvings, stress, Some(peaks))?;
        let change = change(&before, &ran);
        if change <= CHANGE || halvings == MAX_HALVINGS {
            let memory = after(&ran);
            let error_estimate = Some((change / 3.0).max(unsettled));
            let converged = Some(Converged::Even { halvings, stress, peaks });
            return Ok((Integration { error_estimate, converged, ..ran.integration }, memory));
        }
        before = ran;
    }
    unreachable!("the last halving returns")
}
