//! What a step may be wrong by for the tolerance asked for.

use super::contact_ledger::ContactLedger;
use super::system::System;
use crate::analytical::hertz::HertzImpact;

/// Share of the impact's energy by which one step's rounding errors may change it.
const ROUNDING: f64 = 1e-12;

/// Defects that a step may have, as impulses over the momentum.
pub(super) struct Bounds {
    /// Where the force is smooth.
    pub(super) smooth: f64,
    /// Where a contact touches or opens at the start or the end of the step.
    pub(super) edge: f64,
    /// Where a contact touches or opens within the step.
    pub(super) kinked: f64,
    /// Error of a step's impulses from ending the sweeps.
    pub(super) impulse: f64,
    /// Relative error of its forces from the same.
    pub(super) force: f64,
}

impl Bounds {
    /// For a relative error `tolerance` of the efficiency. The error of a step is of about twice the order of its
    /// defect where the forces are smooth, so that the bound may fall more slowly than the tolerance; factors and
    /// exponents are measured over scenes and numbers of modes (tests/physics/integrator_runge_kutta.rs).
    pub(super) fn new(tolerance: f64) -> Self {
        let smooth = 0.6 * tolerance.powf(0.7);
        let kinked = 1e-3 * tolerance.powf(0.95);
        // a force that is off makes energy however short the step is
        let force = (0.5 * tolerance).clamp(1e-11, 1e-5);
        Self { smooth, kinked, edge: 10.0 * kinked, impulse: 0.02 * smooth, force }
    }
}

/// Energy that an integration makes from nothing, against what it may.
pub(super) struct EnergyAccount {
    /// Energy of the impact, J.
    initial: f64,
    /// Bound per `contact_time` in J.
    per_contact: f64,
    /// Duration of the outer body's impact on a rigid wall, s.
    contact_time: f64,
    /// Made so far, J.
    made: f64,
}

impl EnergyAccount {
    /// Of an impact `hit` with `initial` J, for a relative error `tolerance` of the efficiency.
    pub(super) fn new(hit: &HertzImpact, initial: f64, tolerance: f64) -> Self {
        let share = (5.0 * tolerance).max(1e-9);
        Self { initial, per_contact: share * initial, contact_time: hit.duration(), made: 0.0 }
    }

    /// Energy `made` in a step of `h` s over what may be. Errors of one sign, step after step, have to become smaller.
    #[inline]
    pub(super) fn excess(&self, made: f64, h: f64) -> f64 {
        let same_sign = (self.made * made.signum()).max(0.0);
        let left = (0.5 * self.per_contact / same_sign).min(1.0);
        let bound = self.per_contact * (left * left) * h / self.contact_time + self.initial * ROUNDING;
        made.abs() / bound
    }

    /// Books the energy made in an accepted step, J.
    #[inline]
    pub(super) fn book(&mut self, made: f64) {
        self.made += made;
    }
}

/// Momenta in N s in relation to which the impulses of both contacts have to be right.
#[inline]
pub(super) fn momentum_scale(system: &System, contacts: &[ContactLedger; 2]) -> [f64; 2] {
    let initial = system.masses[0] * system.speed;
    let light = initial.min(system.masses[1] * system.speed);
    // a light inner body feels an error that the heavy outer one would not
    [initial.min(3.0 * light), contacts[1].impulse.max(0.01 * light)]
}
