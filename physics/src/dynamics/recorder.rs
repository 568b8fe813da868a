//! Sampling of the course over time; a run that is not asked for its history has no recorder.

use super::collocation::{Collocation, POINTS};
use super::integration::Options;
use super::system::{System, dot};
use crate::error::Result;
use crate::numerics::stages::Stages;
use crate::result::{Curve, History};

/// The curves of outer body (mass average), plate (around its centre, mean of both faces) and inner body
/// (mass average), signed along z; contact forces are positive in compression.
pub static CURVES: [Curve; 8] = [
    Curve::new("outer_displacement", "m"),
    Curve::elastic("plate_displacement", "m"),
    Curve::new("inner_displacement", "m"),
    Curve::new("outer_velocity", "m/s"),
    Curve::elastic("plate_velocity", "m/s"),
    Curve::new("inner_velocity", "m/s"),
    Curve::new("outer_force", "N"),
    Curve::new("inner_force", "N"),
];

/// Those of the contact forces alone.
static FORCES: [Curve; 2] = [Curve::new("outer_force", "N"), Curve::new("inner_force", "N")];

/// The values of [`CURVES`] with the coordinates and rates `motion` under the contact `forces` in N; `local` is what the contacts add
/// to displacement and velocity of the plate's centre, in m and m/s.
pub(super) fn sample(system: &System, motion: [&[f64]; 2], local: [f64; 2], forces: [f64; 2]) -> [f64; 8] {
    let [q, v] = motion;
    let (displacement, velocity) = (system.of_bodies(q), system.of_bodies(v));
    [
        displacement[0] + system.gap[0],
        dot(&system.centre, q) + local[0],
        displacement[1],
        velocity[0],
        dot(&system.centre, v) + local[1],
        velocity[1],
        forces[0],
        forces[1],
    ]
}

/// Collects a [`History`] with samples at the end of every step and, as long as there is room, at most `interval` s apart.
///
/// The room for samples within steps and flights is bounded: one that is so long that it would take more than half of what is left has
/// wider intervals.
pub struct Recorder<'a, const P: usize = POINTS> {
    system: &'a System,
    collocation: &'a Collocation<P>,
    interval: f64,
    /// See [`Options::forces_alone`].
    forces_alone: bool,
    /// Samples that may still lie within steps and flights.
    room: usize,
    history: History,
}

impl<'a, const P: usize> Recorder<'a, P> {
    /// Starts with the sample at t = 0; `None` if the `options` request no history.
    pub fn new(system: &'a System, collocation: &'a Collocation<P>, options: &Options) -> Option<Self> {
        let interval = options.sample_interval?;
        let room = options.samples_between;
        let forces_alone = options.forces_alone;
        let history = History::new(if forces_alone { &FORCES } else { &CURVES });
        let mut recorder = Self { system, collocation, interval, forces_alone, room, history };
        if forces_alone {
            recorder.history.push(0.0, [0.0; 2]);
        } else {
            let (q, v) = system.initial_state();
            recorder.push(0.0, &q, &v);
        }
        Some(recorder)
    }

    /// Samples the step of length `h` that starts at `time` in the state (q, v) under `forces` at the nodes, and those `along` the surfaces.
    ///
    /// # Errors
    /// As the contact's system of equations.
    pub fn step(
        &mut self,
        time: f64,
        h: f64,
        [q, v]: [&[f64]; 2],
        forces: &[Stages; 2],
        along: &[Stages; 2],
    ) -> Result<()> {
        if self.forces_alone {
            self.step_of_forces(time, h, forces);
            return Ok(());
        }
        let [b0, b1] = &self.system.approach;
        let load = self.system.tangential_load.as_ref();
        self.step_under(time, h, q, v, forces[0], |k| {
            std::array::from_fn(|l| {
                let across = -(b0[k] * forces[0][l] + b1[k] * forces[1][l]);
                load.map_or(across, |load| {
                    across + load.along[k][0] * along[0][l] + load.along[k][1] * along[1][l]
                })
            })
        })
    }

    /// As [`Recorder::step`], under the generalised forces `forces` of each oscillator and the `outer` contact's at the nodes.
    ///
    /// # Errors
    /// As the contact's system of equations.
    pub fn step_under(
        &mut self,
        time: f64,
        h: f64,
        q: &[f64],
        v: &[f64],
        outer: Stages,
        forces: impl Fn(usize) -> Stages,
    ) -> Result<()> {
        debug_assert!(!self.forces_alone, "a film has no history of the contact forces alone");
        let count = self.samples(h);
        let (mut q_at, mut v_at) = (vec![0.0; q.len()], vec![0.0; q.len()]);
        for sample in 1..=count {
            let t = h * sample as f64 / count as f64;
            for (k, oscillator) in self.system.oscillators.iter().enumerate() {
                let at = self.collocation.response(oscillator, t, h);
                let force = forces(k);
                q_at[k] = at.displacement_per_displacement * q[k]
                    + at.displacement_per_velocity * v[k]
                    + dot(&at.displacement_per_force, &force);
                v_at[k] = at.velocity_per_displacement * q[k]
                    + at.velocity_per_velocity * v[k]
                    + dot(&at.velocity_per_force, &force);
            }
            for (k, feed) in &self.system.feeds {
                let oscillator = &self.system.oscillators[*k];
                let [displacement, rate] = self.collocation.fed(oscillator, feed, t, h);
                q_at[*k] -= dot(&displacement, &outer);
                v_at[*k] -= dot(&rate, &outer);
            }
            self.push(time + t, &q_at, &v_at);
        }
        Ok(())
    }

    /// Number of samples of a step of `h` s, of which the last is its end.
    fn samples(&mut self, h: f64) -> usize {
        let count = (h / self.interval).ceil().clamp(1.0, 1.0 + (self.room / 2) as f64) as usize;
        self.room -= count - 1;
        count
    }

    fn step_of_forces(&mut self, time: f64, h: f64, forces: &[Stages; 2]) {
        let is_open = forces.iter().flatten().all(|force| *force == 0.0);
        let count = if is_open { 1 } else { self.samples(h) };
        for sample in 1..=count {
            let share = sample as f64 / count as f64;
            let weights = self.collocation.interpolation(share);
            if self.history.time.last().is_none_or(|last| *last < time + share * h) {
                self.history.push(time + share * h, [0, 1].map(|i| dot(&weights, &forces[i]).max(0.0)));
            }
        }
    }

    /// The history so far.
    pub fn finish(self) -> History {
        self.history
    }

    fn push(&mut self, time: f64, q: &[f64], v: &[f64]) {
        let system = self.system;
        // a step too short to move the clock adds nothing
        if self.history.time.last().is_some_and(|last| *last >= time) {
            return;
        }
        let approach = system.touched_at(time).modal_approach(q);
        let (patch, forces) = system.contact(approach, approach).unwrap_or(([f64::NAN; 2], [f64::NAN; 2]));
        let rate = [0, 1].map(|i| dot(&system.approach[i], v));
        let local = system.motion_of_centre(patch, rate, forces);
        self.history.push(time, sample(system, [q, v], local, forces));
    }
}
