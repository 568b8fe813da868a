//! What a step may be wrong by for the tolerance asked for.

use super::contact_balance::ContactBalance;
use super::system::System;
use crate::analytical::hertz::HertzImpact;
use crate::numerics::stages::STAGES;

/// Share of the impact's energy by which one step's rounding errors may change it.
const ROUNDING: f64 = 1e-12;

/// Steps up to which their errors hardly add up; of more each may have a smaller one.
const FEW_STEPS: f64 = 150.0;

/// See [`peak_share`].
const PEAK_SHARE: f64 = 1.0 / 40.0;
/// Rise of a force between the last points of a step, over itself, below which its maximum is near.
const FLAT: f64 = 0.02;

/// Tolerance at which the longest lengths of a step are powers of 2 of a Hertz contact.
const PLAIN_TOLERANCE: f64 = 1e-7;
/// Power of the tolerance with which steps of the collocation's order shorten.
const STEP_POWER: f64 = 0.14;

/// Step lengths are the base length times 2^-level, level in this range.
const LEVELS: std::ops::RangeInclusive<i32> = -8..=44;

/// Length of adapted steps.
pub(super) struct AdaptedLength {
    base: f64,
    level: i32,
}

impl AdaptedLength {
    /// `base` s times 2^-level.
    pub(super) fn new(base: f64, level: i32) -> Self {
        Self { base, level }
    }

    /// Length in s.
    #[inline]
    pub(super) fn length(&self) -> f64 {
        self.base * 0.5_f64.powi(self.level)
    }

    /// Number of the length: tables are kept by it.
    #[inline]
    pub(super) fn level(&self) -> i32 {
        self.level
    }

    /// Base length, s.
    pub(super) fn base(&self) -> f64 {
        self.base
    }

    /// Shortest length, s.
    pub(super) fn shortest(&self) -> f64 {
        self.base * 0.5_f64.powi(*LEVELS.end())
    }

    /// Whether the length is below the shortest.
    #[inline]
    pub(super) fn is_exhausted(&self) -> bool {
        self.level > *LEVELS.end()
    }

    /// Makes it no longer than the longest length.
    #[inline]
    pub(super) fn limit(&mut self) {
        self.level = self.level.max(*LEVELS.start());
    }

    /// Halves the length.
    #[inline]
    pub(super) fn halve(&mut self) {
        self.level += 1;
    }

    /// Makes it no longer than that of `level`.
    #[inline]
    pub(super) fn limit_to_level(&mut self, level: i32) {
        self.level = self.level.max(level);
    }

    /// Shortens it for a step that is wrong by `excess` times what it may be.
    #[inline]
    pub(super) fn shorten(&mut self, excess: f64) {
        self.level += (excess.log2() / (STAGES + 1) as f64).ceil().clamp(1.0, 8.0) as i32;
    }

    /// Doubles it after a step that was wrong by so small an `excess` that twice the length is in order: that multiplies the defect of
    /// smooth forces by 2^(STAGES+1).
    #[inline]
    pub(super) fn lengthen(&mut self, excess: f64) {
        if excess < 0.5_f64.powi(STAGES as i32 + 2) {
            self.level -= 1;
        }
    }
}

/// Length in s of which steps are a power of 2, in an impact whose contact on a rigid wall lasts `contact_time` s. It follows the
/// `tolerance`: else neighbouring ones could take the same steps, and their results would agree however wrong both are.
pub(super) fn base_step(contact_time: f64, tolerance: f64) -> f64 {
    0.25 * contact_time * (tolerance / PLAIN_TOLERANCE).powf(STEP_POWER)
}

/// Defects that a step may have, as impulses over the momentum.
pub(super) struct StepBounds {
    /// Where the force is smooth.
    pub(super) smooth: f64,
    /// There too, of the force over its peak: where contacts are much shorter than the impact, impulses alone leave the
    /// forces open.
    pub(super) force_defect: f64,
    /// Where a contact touches or opens at the start or the end of the step.
    pub(super) edge: f64,
    /// Where a contact touches or opens within the step.
    pub(super) kinked: f64,
    /// Error of a step's impulses from ending the sweeps.
    pub(super) impulse: f64,
    /// Relative error of its forces from the same.
    pub(super) force: f64,
}

impl StepBounds {
    /// For a relative error `tolerance` of the efficiency. The error of a step is of about twice the order of its
    /// defect where the forces are smooth, so that the bound may fall more slowly than the tolerance; factors and
    /// exponents are measured over scenes and numbers of modes (tests/physics/integrator_runge_kutta.rs).
    pub(super) fn new(tolerance: f64) -> Self {
        let smooth = 0.6 * tolerance.powf(0.7);
        let kinked = 1e-3 * tolerance.powf(0.95);
        // a force that is off makes energy however short the step is
        let force = (0.5 * tolerance).clamp(1e-11, 1e-5);
        let force_defect = 80.0 * smooth;
        Self { smooth, force_defect, kinked, edge: 10.0 * kinked, impulse: 0.02 * smooth, force }
    }

    /// Share of the bounds for smooth forces that each step may use up after `steps` of them.
    pub(super) fn share(steps: u64) -> f64 {
        (FEW_STEPS / steps as f64).min(1.0)
    }
}

/// Energy that an integration makes from nothing, against what it may.
pub(super) struct EnergyAccount {
    /// Energy of the impact, J.
    initial: f64,
    /// Bound per `contact_time` in J.
    per_contact: f64,
    /// Duration of the outer body's impact on a rigid wall, s.
    pub(super) contact_time: f64,
    /// Sum of the steps' errors so far, J.
    energy_error: f64,
}

impl EnergyAccount {
    /// Of an impact `hit` with `initial` J, for a relative error `tolerance` of the efficiency.
    pub(super) fn new(hit: &HertzImpact, initial: f64, tolerance: f64) -> Self {
        let share = (5.0 * tolerance).max(1e-9);
        Self { initial, per_contact: share * initial, contact_time: hit.duration(), energy_error: 0.0 }
    }

    /// The `energy_error` in J of a step of `h` s over what it may be, `rounding` J of that for the rounding of work. Errors of one
    /// sign, step after step, have to become smaller.
    #[inline]
    pub(super) fn excess(&self, energy_error: f64, h: f64, rounding: f64) -> f64 {
        let same_sign = (self.energy_error * energy_error.signum()).max(0.0);
        let left = (0.5 * self.per_contact / same_sign).min(1.0);
        let bound =
            self.per_contact * (left * left) * h / self.contact_time + self.initial * ROUNDING + rounding;
        energy_error.abs() / bound
    }

    /// Books the energy made in an accepted step, J.
    #[inline]
    pub(super) fn book(&mut self, energy_error: f64) {
        self.energy_error += energy_error;
    }
}

/// Momenta in N s in relation to which the impulses of both contacts have to be right.
#[inline]
pub(super) fn momentum_scale(system: &System, contacts: &[ContactBalance; 2]) -> [f64; 2] {
    let initial = system.masses[0] * system.speed;
    let light = initial.min(system.masses[1] * system.speed);
    // a light inner body feels an error that the heavy outer one would not
    [initial.min(3.0 * light), contacts[1].impulse.max(least_impulse(system))]
}

/// Impulse in N s up to which a contact hardly moves even the lighter body; its errors count as if it had this one.
pub(super) fn least_impulse(system: &System) -> f64 {
    0.01 * system.speed * system.masses[0].min(system.masses[1])
}

/// Force in N of a contact that gives a body the `momentum` in N s in about `duration` s: its peak may be still to come.
#[inline]
pub(super) fn least_force(momentum: f64, duration: f64) -> f64 {
    0.4 * momentum / duration
}

/// Share of the bound on a force's defect that a step may use up whose `forces` at its points, in N, have a maximum of at least
/// `peak` N: the peak itself is off by nearly as much.
#[inline]
pub(super) fn peak_share(forces: &[f64], peak: f64) -> f64 {
    let last = forces.len() - 1;
    let (highest, largest) = argmax(forces);
    let passes = highest != last || forces[last] - forces[last - 1] < FLAT * largest;
    if passes && largest >= peak { PEAK_SHARE } else { 1.0 }
}

/// Force in N in relation to which the `forces` of a step have to be right, of a contact with the peak `peak` N so far and
/// the `momentum` N s (see [`momentum_scale`]) in an impact of about `duration` s.
#[inline]
pub(super) fn force_scale(forces: &[f64], peak: f64, momentum: f64, duration: f64) -> f64 {
    forces.iter().fold(peak.max(least_force(momentum, duration)), |scale, force| scale.max(*force))
}

/// Index and value of the largest of `values`, of equal ones the first.
#[inline]
pub(super) fn argmax(values: &[f64]) -> (usize, f64) {
    let values = values.iter().copied().enumerate();
    values.fold((0, f64::NEG_INFINITY), |best, (i, v)| if v > best.1 { (i, v) } else { best })
}
