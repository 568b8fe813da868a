//! The largest forces of a step, from the motion that the bodies have in it.

use super::DryStepper;
use crate::dynamics::collocation::{POINTS, derivative, horner};
use crate::dynamics::contact_forces::{Course, StepSolver};
use crate::dynamics::force_peak::SolvedStep;

impl DryStepper<'_> {
    /// Books the largest forces of the step from the present state to the next.
    pub(super) fn add_peaks(&mut self, trial: &Course) {
        let StepSolver { system, collocation, batch, .. } = &self.solver;
        let h = trial.h;
        let forces = || trial.stages().map(|stages| collocation.derivatives(&stages, h));
        let local = |approach: [f64; 2]| [0, 1].map(|i| approach[i] - system.gap[i]);
        let along = || trial.along.map(|stages| collocation.derivatives(&stages, h));
        let shift =
            system.tangential_load.as_ref().map(|_| trial.shift.map(|shift| collocation.through(&shift)));
        // with its derivatives by the place
        let add_shift = |motion: &mut [[f64; 2]], place: f64| {
            for (i, shift) in shift.iter().flatten().enumerate() {
                let slope = derivative(shift);
                let values =
                    [horner(shift, place), horner(&slope, place), horner(&derivative(&slope), place)];
                motion.iter_mut().zip(values).for_each(|(row, value)| row[i] += value);
            }
        };
        let pushed = |t: f64| system.tangential_load.as_ref().map(|_| batch.pushed_after(&along(), t));
        let motion = |place: f64| {
            let mut motion = batch.approach_after((&self.q, &self.v), &forces(), place * h);
            if let Some(pushed) = pushed(place * h) {
                for (value, added) in motion.as_flattened_mut().iter_mut().zip(pushed.as_flattened()) {
                    *value += added;
                }
            }
            let [approach, rate, acceleration] = motion;
            let mut motion = [
                local(approach),
                rate.map(|rate| rate * h),
                acceleration.map(|acceleration| acceleration * (h * h)),
            ];
            add_shift(&mut motion, place);
            motion
        };
        let samples = |intervals: usize| {
            let mut samples = batch.approaches_within((&self.q, &self.v), &forces(), h, intervals);
            for (k, [approach, rate]) in samples.iter_mut().enumerate().filter(|(k, _)| *k > 0) {
                if let Some([moved, sped, _]) = pushed(h * k as f64 / intervals as f64) {
                    for i in 0..2 {
                        approach[i] += moved[i];
                        rate[i] += sped[i];
                    }
                }
            }
            for (k, sample) in samples.iter_mut().enumerate() {
                let [approach, rate] = *sample;
                *sample = [local(approach), rate.map(|rate| rate * h)];
                add_shift(sample, k as f64 / intervals as f64);
            }
            samples
        };
        let step = SolvedStep {
            system,
            collocation,
            h,
            approach: &trial.approach,
            force: &trial.force,
            error: self.peak_error,
            motion,
            samples,
        };
        for (i, contact) in self.contacts.iter_mut().enumerate() {
            contact.force_peak = step.peak(i, contact.force_peak, |end| {
                let v = if end == 0 { &self.v } else { &self.next_v };
                let local = trial.local_approach.map(|values| values[end * (POINTS - 1)]);
                system.force_rate(local, batch.approach_rate(v))[i] > 0.0
            });
        }
    }
}
