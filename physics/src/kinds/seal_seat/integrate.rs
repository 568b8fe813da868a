//! Time integration of the reduced seal seat.
//!
//! Splitting: contact forces as kicks, between them modes and rigid bodies move exactly, so that high modes need no small
//! steps. The kicks are those of the potential V - h^2/24 |grad V|^2 (metric of the masses): what is left of Strang's error of
//! second order is then a change of coordinates, which vanishes where no contact acts, before the impact and after it
//! (Takahashi & Imada 1984, J. Phys. Soc. Jpn 53, 3765; Wisdom, Holman & Touma 1996, Fields Inst. Commun. 10, 217). So the
//! launch converges with fourth order as far as the contact forces are smooth; they are continuous, with kinks where a node
//! touches or lets go. In contact positions and velocities are off by that change of coordinates, of second order; the corrected
//! forces are those at the places without it.

use super::candidates::in_plane;
use super::contact::Loads;
use super::drift::Drift;
use super::friction::Friction;
use super::integration::{Integration, Sample, Tally};
use super::system::{Forces, State, System, Workspace};
use super::traces::Traces;
use crate::dynamics::StopReason;
use crate::dynamics::driver::{self, Stepper};
use crate::error::Result;
use nalgebra::Vector3;

/// Steps between two surveys of all candidates, and between two looks whether contact is still possible.
const INTERVAL: u64 = 4;
/// Gap below which an open candidate is watched until the next survey at least, over the actuator's way in between. Should
/// one be missed, the steps since the last survey are done again with more.
const MARGIN: f64 = 0.1;

/// Settings of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Time step in s.
    pub step: f64,
    /// End in s; `None` = until no further contact is possible.
    pub end_time: Option<f64>,
    /// Whether a sample is kept of every step.
    pub history: bool,
    /// Relative error that the run may have; friction forces are solved to a tenth of it.
    pub tolerance: f64,
}

/// Runs the impact.
///
/// # Errors
/// [`crate::Error::Solver`] if the contact forces do not converge, or contact does not end.
pub fn integrate(system: &System, options: &Options) -> Result<Integration> {
    integrate_from(system, system.start(), options)
}

/// Runs what follows from the state `start`; the balance of momentum is that of an actuator that arrives.
///
/// # Errors
/// As [`integrate`].
pub(super) fn integrate_from(system: &System, start: State, options: &Options) -> Result<Integration> {
    let traces = (!system.relaxation.is_empty()).then(|| Traces::new(&system.relaxation, options.step));
    let softer = traces.as_ref().map(|traces| system.nodes.softer(traces.growth()));
    let (candidates, balls) = (system.nodes.len(), system.balls.len());
    let friction =
        (system.friction > 0.0).then(|| Friction::new(system.friction, candidates, balls, options.tolerance));
    let workspace = Workspace::new(system, softer.as_ref().unwrap_or(&system.nodes), traces, friction);
    let mut run = SealSeatRun::new(system, start, options, workspace);
    run.workspace.survey(system, &run.state, run.margin());
    run.workspace.forces(system, &run.state, options.step, &mut run.forces)?;
    run.sample();
    driver::run(&mut run)?;
    Ok(run.finish())
}

struct SealSeatRun<'a> {
    system: &'a System,
    options: Options,
    drift: Drift<'a>,
    workspace: Workspace<'a>,
    state: State,
    forces: Forces,
    tally: Tally,
    samples: Vec<Sample>,
    start_energy: f64,
    checkpoint: Checkpoint,
}

/// Where a run can go back to.
struct Checkpoint {
    state: State,
    forces: Forces,
    tally: Tally,
    loads: Loads,
    samples: usize,
}

impl<'a> SealSeatRun<'a> {
    fn new(system: &'a System, state: State, options: &Options, workspace: Workspace<'a>) -> Self {
        Self {
            system,
            options: *options,
            drift: Drift::over(system, options.step),
            start_energy: workspace.energy(system, &state),
            workspace,
            forces: Forces::default(),
            tally: Tally::default(),
            samples: Vec::new(),
            checkpoint: Checkpoint {
                state: state.clone(),
                forces: Forces::default(),
                tally: Tally::default(),
                loads: Loads::default(),
                samples: 0,
            },
            state,
        }
    }

    /// Steps to the next survey, again and with more candidates watched if one has been missed.
    fn interval(&mut self) -> Result<()> {
        self.keep();
        let left = self.options.end_time.map(|end| ((end - self.time()) / self.options.step).round() as u64);
        let steps = left.map_or(INTERVAL, |left| left.clamp(1, INTERVAL));
        loop {
            for _ in 0..steps {
                self.step()?;
            }
            let survey = self.workspace.survey(self.system, &self.state, self.margin());
            if !survey.missed {
                return Ok(());
            }
            self.go_back();
            self.workspace.survey(self.system, &self.state, self.margin().max(2.0 * survey.needed));
        }
    }

    /// Gap in m below which an open candidate is watched at least.
    fn margin(&self) -> f64 {
        MARGIN * self.system.speed * self.options.step * INTERVAL as f64
    }

    fn keep(&mut self) {
        self.checkpoint.state.clone_from(&self.state);
        self.checkpoint.forces.clone_from(&self.forces);
        self.checkpoint.tally = self.tally;
        self.checkpoint.samples = self.samples.len();
        self.workspace.contact.keep(&mut self.checkpoint.loads);
    }

    fn go_back(&mut self) {
        self.state.clone_from(&self.checkpoint.state);
        self.forces.clone_from(&self.checkpoint.forces);
        self.tally = self.checkpoint.tally;
        self.samples.truncate(self.checkpoint.samples);
        self.workspace.contact.go_back(&self.checkpoint.loads);
    }

    fn step(&mut self) -> Result<()> {
        let step = self.options.step;
        self.apply_impulse(0.5 * step);
        self.drift(step);
        self.workspace.contact.pass();
        self.workspace.forces(self.system, &self.state, step, &mut self.forces)?;
        self.apply_impulse(0.5 * step);
        self.tally.steps += 1;
        self.sample();
        Ok(())
    }

    fn apply_impulse(&mut self, step: f64) {
        for (v, f) in self.state.modal_velocity.iter_mut().zip(&self.forces.modal) {
            *v += step * f;
        }
        for (v, f) in self.state.sphere_velocity.iter_mut().zip(self.forces.sphere) {
            *v += step * f / self.system.sphere_mass;
        }
        self.state.spin += step * self.forces.torque / self.system.sphere_inertia;
        self.state.actuator_velocity += step * self.forces.actuator / self.system.actuator_mass;
        for (impulse, force) in self.tally.flank_impulse.iter_mut().zip(self.forces.flanks) {
            *impulse += 2.0 * step * force;
        }
        self.tally.seat_impulse += step * self.forces.seat;
    }

    fn drift(&mut self, step: f64) {
        self.tally.modal_loss += self.drift.apply(&mut self.state);
        for (x, v) in self.state.sphere.iter_mut().zip(self.state.sphere_velocity) {
            *x += step * v;
        }
        self.state.turn += step * self.state.spin;
        self.state.actuator += step * self.state.actuator_velocity;
    }

    /// Keeps what the result needs of this instant.
    fn sample(&mut self) {
        let sphere_force = self.forces.sphere.map(|f| 2.0 * f);
        let magnitudes = [sphere_force[0].hypot(sphere_force[1]), -2.0 * self.forces.actuator];
        let step = self.options.step;
        let time = self.time();
        let tally = &mut self.tally;
        for (i, &force) in magnitudes.iter().enumerate() {
            tally.force_peak[i] = tally.force_peak[i].max(force);
            tally.reach[i] = tally.reach[i].max(self.forces.reach[i]);
            let [last, earlier] = [tally.before[0][i], tally.before[1][i]];
            if force == 0.0 && last > 0.0 {
                // the force goes on falling as over the last step, until it is zero
                let falling = earlier - last;
                let share = if falling > 0.0 { (last / falling).min(1.0) } else { 1.0 };
                tally.contact_end[i] = time - step + share * step;
            } else if force > 0.0 {
                tally.contact_end[i] = time;
            }
        }
        tally.before = [magnitudes, tally.before[0]];
        if self.options.history {
            self.samples.push(Sample {
                time,
                sphere: self.state.sphere,
                sphere_velocity: self.state.sphere_velocity,
                sphere_force,
                actuator: self.state.actuator,
                actuator_velocity: self.state.actuator_velocity,
                actuator_force: magnitudes[1],
            });
        }
    }

    /// Whether no candidate can be met again: all contacts are open, and the straight flights of sphere and actuator stay clear of every place
    /// that the modes' present amplitudes let the candidates reach.
    fn is_over(&self) -> bool {
        if self.tally.steps == 0 || !self.workspace.contact.active().is_empty() {
            return false;
        }
        let amplitude = self.drift.reach(self.system, &self.state);
        // what recovers from its forces does so within where it is now
        let lag = self.workspace.contact.lag();
        self.system.candidates.iter().enumerate().all(|(i, candidate)| {
            let room: f64 = self
                .system
                .participation
                .iter()
                .zip(&amplitude)
                .map(|(shape, a)| a * shape[3 * i..3 * i + 3].iter().map(|s| s * s).sum::<f64>().sqrt())
                .sum();
            let (ball, moved, velocity) = self.contact_body(candidate);
            let from = self.system.balls[ball].centre + moved - candidate.place;
            let square = velocity.norm_squared();
            let nearest = if square > 0.0 { (-from.dot(&velocity) / square).max(0.0) } else { 0.0 };
            (from + nearest * velocity).norm() - self.system.balls[ball].radius > room + lag
        })
    }

    /// Number of the ball a candidate meets, its displacement and velocity.
    fn contact_body(&self, candidate: &super::Candidate) -> (usize, Vector3<f64>, Vector3<f64>) {
        let state = &self.state;
        match candidate.contact_body {
            super::ContactBody::Sphere => (0, in_plane(state.sphere), in_plane(state.sphere_velocity)),
            super::ContactBody::Tip(tip) => {
                (1 + tip, in_plane([0.0, state.actuator]), in_plane([0.0, state.actuator_velocity]))
            }
        }
    }

    fn finish(self) -> Integration {
        let (system, state) = (self.system, &self.state);
        let start = system.actuator_mass * system.speed;
        let left =
            system.actuator_mass * state.actuator_velocity + system.sphere_mass * state.sphere_velocity[1];
        let rubbed = self.workspace.contact.rubbed();
        let energy = self.workspace.energy(system, state) + self.tally.modal_loss + rubbed;
        Integration {
            stop: StopReason::of(self.tally.before[0].iter().any(|force| *force > 0.0)),
            momentum_residual: (left + self.tally.seat_impulse - start).abs() / start,
            energy_residual: (energy - self.start_energy).abs() / self.start_energy,
            rubbed: 2.0 * rubbed,
            relaxed: 2.0 * (self.tally.modal_loss + self.workspace.contact.relaxed()),
            time: self.time(),
            work: self.workspace.contact.work,
            state: self.state,
            tally: self.tally,
            samples: self.samples,
        }
    }
}

impl Stepper for SealSeatRun<'_> {
    const MOST_STEPS: u64 = 2_000_000;

    fn time(&self) -> f64 {
        self.tally.steps as f64 * self.options.step
    }

    fn end(&self) -> f64 {
        self.options.end_time.map_or(f64::INFINITY, |end| end - 0.5 * self.options.step)
    }

    fn steps(&self) -> u64 {
        self.tally.steps
    }

    fn advance(&mut self) -> Result<bool> {
        if self.options.end_time.is_none() && self.is_over() {
            return Ok(false);
        }
        self.interval()?;
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use super::super::nodes::{Ball, Nodes};
    use super::super::{Candidate, ContactBody};
    use super::*;
    use crate::material::Relaxation;
    use std::f64::consts::PI;

    const MASS: f64 = 2e-3;
    const SPEED: f64 = 0.5;
    const FLEXIBILITY: f64 = 1e-6;

    /// An actuator under a node, straight above its tip, that yields by its residual flexibility and `modes`, given by
    /// (omega, participation along z).
    fn spring(modes: &[(f64, f64)]) -> System {
        let residual = [[FLEXIBILITY, 0.0, 0.0], [0.0, FLEXIBILITY, 0.0], [0.0, 0.0, FLEXIBILITY]].concat();
        let place = Vector3::zeros();
        let participation: Vec<Vec<f64>> = modes.iter().map(|m| vec![0.0, 0.0, m.1]).collect();
        System {
            nodes: Nodes::new(vec![place], vec![1], &participation, &residual),
            omega: modes.iter().map(|m| m.0).collect(),
            participation,
            relaxation: vec![],
            candidates: vec![Candidate {
                node: 0,
                place,
                contact_body: ContactBody::Tip(0),
                offset: 0.0,
                right_flank: false,
            }],
            sphere_mass: 1e-4,
            sphere_inertia: 4e-11,
            friction: 0.0,
            actuator_mass: MASS,
            speed: SPEED,
            indentation: SPEED * (MASS * FLEXIBILITY).sqrt(),
            balls: vec![
                Ball { centre: Vector3::new(0.0, 0.0, 1.0), radius: 1e-3, turn: 0.0 },
                Ball { centre: Vector3::new(0.0, 0.0, -3e-3), radius: 3e-3, turn: 0.0 },
            ],
        }
    }

    fn run(system: &System, steps: f64, end_time: Option<f64>) -> Integration {
        let duration = PI * (MASS * FLEXIBILITY).sqrt();
        integrate(system, &Options { step: duration / steps, end_time, history: false, tolerance: 1e-3 })
            .expect("run")
    }

    #[test]
    fn an_actuator_on_a_spring_is_thrown_back_after_half_a_period() {
        let (omega, duration) = ((MASS * FLEXIBILITY).sqrt().recip(), PI * (MASS * FLEXIBILITY).sqrt());
        let result = run(&spring(&[]), 400.3, None);
        assert!((result.state.actuator_velocity / -SPEED - 1.0).abs() < 1e-4);
        // the half body's force is doubled
        assert!((result.tally.force_peak[1] / (2.0 * MASS * SPEED * omega) - 1.0).abs() < 1e-4);
        assert!((result.tally.contact_end[1] / duration - 1.0).abs() < 1e-3);
        assert!(result.momentum_residual < 1e-12 && result.energy_residual < 1e-4);
        assert_eq!(result.state.sphere_velocity, [0.0; 2]);
    }

    fn relaxing(modes: &[(f64, f64)], ratio: f64, time: f64) -> System {
        System { relaxation: vec![Relaxation { ratio, time }], ..spring(modes) }
    }

    /// m y'' = -k (y - g xi), xi' = (y - xi)/tau until the force would pull: velocity at the end and energy of the half body that is lost.
    fn zener(ratio: f64, time: f64) -> [f64; 2] {
        let (stiffness, h) = (1.0 / FLEXIBILITY, 1e-4 * (MASS * FLEXIBILITY).sqrt());
        let force = |s: &[f64; 3]| stiffness * (s[0] - ratio * s[2]);
        let rates = |s: [f64; 3]| [s[1], -force(&s) / MASS, (s[0] - s[2]) / time];
        let add = |s: [f64; 3], h: f64, k: [f64; 3]| std::array::from_fn(|i| s[i] + h * k[i]);
        let mut s = [0.0, SPEED, 0.0];
        while s[0] == 0.0 || force(&s) > 0.0 {
            let a = rates(s);
            let b = rates(add(s, 0.5 * h, a));
            let c = rates(add(s, 0.5 * h, b));
            let d = rates(add(s, h, c));
            s = std::array::from_fn(|i| s[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        [s[1], 0.5 * MASS * (SPEED * SPEED - s[1] * s[1])]
    }

    #[test]
    fn an_actuator_on_a_spring_that_relaxes_leaves_as_the_closed_system_has_it() {
        let duration = PI * (MASS * FLEXIBILITY).sqrt();
        for (ratio, time) in [(0.3, 0.1 * duration), (0.5, duration), (0.2, 10.0 * duration)] {
            let [velocity, lost] = zener(ratio, time);
            let [coarse, fine] = [400.0, 800.0].map(|steps| run(&relaxing(&[], ratio, time), steps, None));
            for (result, bound) in [(coarse, 1e-4), (fine, 3e-5)] {
                assert!((result.state.actuator_velocity / velocity - 1.0).abs() < bound, "{ratio} {time}");
                // of whole bodies
                assert!((result.relaxed / (2.0 * lost) - 1.0).abs() < 2e-3, "{} {lost}", result.relaxed);
                assert!(result.energy_residual < 1e-4 && result.momentum_residual < 1e-12);
            }
        }
    }

    /// What relaxes long after the contact is elastic, and what relaxes at once is softer, modes and residual alike.
    #[test]
    fn a_very_slow_term_does_nothing_and_a_very_fast_one_softens() {
        let modes = [(4e4, 12.0), (1.1e5, -9.0)];
        let of = |system: &System| run(system, 400.0, None);
        let close = |a: &Integration, b: &Integration, bound: f64| {
            let velocity = a.state.actuator_velocity / b.state.actuator_velocity - 1.0;
            let end = a.tally.contact_end[1] / b.tally.contact_end[1] - 1.0;
            velocity.abs() < bound && end.abs() < bound
        };
        let slow = of(&relaxing(&modes, 0.3, 1e4));
        assert!(close(&slow, &of(&spring(&modes)), 1e-5), "{slow:?}");
        let fast = of(&relaxing(&modes, 0.3, 1e-14));
        // frequencies as the root of the modulus, the residual as its inverse
        let softer = modes.map(|(omega, shape)| (omega * 0.7_f64.sqrt(), shape));
        let mut softer = spring(&softer);
        softer.nodes = softer.nodes.softer(1.0 / 0.7);
        assert!(close(&fast, &of(&softer), 1e-4), "{fast:?}");
        assert!(!close(&fast, &slow, 0.1), "{fast:?}");
    }

    #[test]
    fn time_integration_is_of_fourth_order_before_the_release_and_at_least_second_after_it() {
        let system = spring(&[(4e4, 12.0), (1.1e5, -9.0)]);
        let duration = PI * (MASS * FLEXIBILITY).sqrt();
        let error = |end: f64, steps: f64, exact: f64| {
            (run(&system, steps, Some(end)).state.actuator_velocity - exact).abs()
        };
        for (end, least) in [(0.5 * duration, 3.8), (3.0 * duration, 2.0)] {
            let exact = run(&system, 51200.0, Some(end)).state.actuator_velocity;
            let errors = [100.0, 400.0, 1600.0].map(|steps| error(end, steps, exact));
            let observed = (errors[0] / errors[2]).log(16.0);
            assert!(errors[2] < 1e-4 * SPEED, "{errors:?}");
            assert!(observed > least, "order {observed} up to {end} s: {errors:?}");
        }
    }

    #[test]
    fn a_step_that_is_too_long_for_contact_shows_in_the_energy() {
        let coarse = run(&spring(&[(4e4, 12.0)]), 4.0, None).energy_residual;
        let fine = run(&spring(&[(4e4, 12.0)]), 400.0, None).energy_residual;
        assert!(coarse > 100.0 * fine, "{coarse} {fine}");
    }
}
