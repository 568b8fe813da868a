//! The reduced model: both equations of motion by Dormand & Prince's method of order 8.

use super::{CURVES, Kind, NAME, SpringMass, SpringQuantities};
use crate::error::{Error, Result};
use crate::kinds::{Kind as _, SeriesModel};
use crate::numerics::explicit_runge_kutta::{DORMAND_PRINCE_8, Tolerances, integrate};
use crate::result::{CUT, History, Outcome, Summary};
use crate::scene::{Model, Scene};
use std::time::Instant;

/// Samples in the contact with a free mass, and the most there may be in all.
const SAMPLES: f64 = 500.0;
const MOST_SAMPLES: usize = 1_000_000;
/// Share of a run's tolerance that a step may miss, and the least that rounding allows.
const OF_A_STEP: f64 = 1e-2;
const ROUNDING: f64 = 1e-13;

/// Displacement and velocity of the sphere and of the mass, impulse of the spring. SI units.
type Motion = [f64; 5];

/// A sphere and a mass on a spring, ready to run.
#[derive(Debug)]
pub(super) struct SpringModel {
    scene: Scene,
    bodies: SpringMass,
}

impl SpringModel {
    /// Of `scene`.
    ///
    /// # Errors
    /// [`Error::Scene`] for another kind of scene.
    pub(super) fn new(scene: &Scene) -> Result<Self> {
        Ok(Self { bodies: scene.of_kind::<SpringMass>(NAME)?.clone(), scene: scene.clone() })
    }

    /// Approach in m and duration in s of the contact with a free mass (Hertz).
    fn contact(&self) -> (f64, f64) {
        let (sphere, mass) = (&self.bodies.sphere, &self.bodies.mass);
        let effective = sphere.mass * mass.mass / (sphere.mass + mass.mass);
        let approach = (1.25 * effective * sphere.speed.powi(2) / self.bodies.law().stiffness).powf(0.4);
        (approach, 2.9432 * approach / sphere.speed)
    }

    fn rate(&self, [x, v, y, w, _]: Motion) -> Motion {
        let (sphere, mass) = (&self.bodies.sphere, &self.bodies.mass);
        let (force, spring) = (self.bodies.law().force(x - y), mass.stiffness * y);
        [v, -force / sphere.mass, w, (force - spring) / mass.mass, spring]
    }

    /// Whether the sphere flies away behind all that the mass can reach.
    fn is_clear(&self, [x, v, y, w, _]: Motion) -> bool {
        let reach = y.hypot(w * (self.bodies.mass.mass / self.bodies.mass.stiffness).sqrt());
        v < 0.0 && x < -reach
    }

    /// Energy of the mass and its spring, and of everything, in J.
    fn energy(&self, [x, v, y, w, _]: Motion) -> [f64; 2] {
        let (sphere, mass) = (&self.bodies.sphere, &self.bodies.mass);
        let own = 0.5 * (mass.mass * w * w + mass.stiffness * y * y);
        [own, own + 0.5 * sphere.mass * v * v + self.bodies.law().energy(x - y)]
    }

    /// The motion at even instants, from the first touch to the end of the run; their distance in s; and the number of evaluations.
    fn motion(&self, tolerance: f64) -> Result<(Vec<Motion>, f64, u64)> {
        let (sphere, (approach, duration)) = (&self.bodies.sphere, self.contact());
        let end = self.scene.run.end_time;
        // whole steps to the end
        let step = end.map_or(duration / SAMPLES, |end| end / (end * SAMPLES / duration).ceil());
        let count = end.map(|end| (end / step).round() as usize);
        let scale = [approach, sphere.speed, approach, sphere.speed, sphere.mass * sphere.speed];
        let each = (OF_A_STEP * tolerance).max(ROUNDING);
        let tolerances = Tolerances { relative: each, absolute: each, max_evaluations: 100_000 };
        let mut motion = vec![[0.0, sphere.speed, 0.0, 0.0, 0.0]];
        let (mut now, mut evaluations) = (motion[0], 0);
        while count.map_or(!self.is_clear(now), |count| motion.len() <= count) {
            let rate = |y: &[f64], dy: &mut [f64]| {
                dy.copy_from_slice(&self.rate([y[0], y[1], y[2], y[3], y[4]]));
            };
            let done = integrate(&DORMAND_PRINCE_8, rate, &mut now, &scale, step, &tolerances);
            evaluations += done.filter(|_| motion.len() < MOST_SAMPLES).ok_or_else(|| {
                Error::Solver(format!("`{}` has not ended after {} steps", self.scene.name, motion.len()))
            })?;
            motion.push(now);
        }
        Ok((motion, step, evaluations))
    }
}

impl SeriesModel for SpringModel {
    fn run_with_history(&self, tolerance: f64) -> Result<Outcome> {
        let started = Instant::now();
        let (sphere, law) = (&self.bodies.sphere, self.bodies.law());
        let (motion, step, steps) = self.motion(tolerance)?;
        let approach: Vec<f64> = motion.iter().map(|m| m[0] - m[2]).collect();
        let force: Vec<f64> = approach.iter().map(|delta| law.force(*delta)).collect();
        let (first, last) = (motion[0], motion[motion.len() - 1]);
        let [[_, before], [given, after]] = [first, last].map(|motion| self.energy(motion));
        let momentum = |m: Motion| sphere.mass * m[1] + self.bodies.mass.mass * m[3] + m[4];
        let released = approach.iter().rposition(|delta| *delta > 0.0).unwrap_or(0);
        let is_cut = released + 1 == motion.len();
        let share =
            if is_cut { 0.0 } else { approach[released] / (approach[released] - approach[released + 1]) };
        let mut table = SpringQuantities {
            efficiency: given / before,
            sphere_velocity_final: last[1],
            sphere_force_peak: peak(&force),
            sphere_contact_end: step * (released as f64 + share),
        }
        .table();
        if is_cut {
            table = table.cut();
        }
        let mut history = History::new(&CURVES);
        for (k, [x, v, y, w, _]) in motion.iter().copied().enumerate() {
            history.push(step * k as f64, [x, v, y, w, force[k]]);
        }
        let mut summary = Summary {
            energy_residual: Some((after - before).abs() / before),
            momentum_residual: Some((momentum(last) - momentum(first)).abs() / momentum(first)),
            steps: Some(steps),
            solve_seconds: started.elapsed().as_secs_f64(),
            samples: Some(history.len()),
            sample_interval: Some(step),
            warnings: if is_cut { vec![CUT.into()] } else { Vec::new() },
            ..Summary::of_reduced(&self.scene, Model::A, 1, table)
        };
        Kind.judge(&self.scene, &mut summary, Some(&history));
        Ok(Outcome { summary, history })
    }
}

/// Largest value of a smooth curve: that of the parabola through its highest sample and both neighbours.
fn peak(values: &[f64]) -> f64 {
    let (at, top) = values.iter().enumerate().fold((0, 0.0), |m, (k, &f)| if f > m.1 { (k, f) } else { m });
    match (at.checked_sub(1).map(|k| values[k]), values.get(at + 1)) {
        (Some(before), Some(after)) => {
            let bend = before - 2.0 * top + after;
            if bend < 0.0 { top - (before - after).powi(2) / (8.0 * bend) } else { top }
        }
        _ => top,
    }
}
