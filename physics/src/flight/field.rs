//! What acts on the sphere in flight: gravity, spring, drag, and the acceleration of the valve's body.

use super::{Spring, Vector};
use serde::Serialize;

/// Steps per period of whatever oscillates.
const STEPS_PER_PERIOD: f64 = 40.0;

/// The forces of the flight.
#[derive(Debug, Clone, Default)]
pub struct Field {
    /// Gravity in m/s^2.
    pub gravity: Vector,
    /// The spring, if there is one.
    pub spring: Option<Spring>,
    /// Drag of a fluid, if there is one.
    pub drag: Option<SphereDrag>,
    /// How the valve's body is shaken, if it is.
    pub shaken: Option<Excitation>,
}

/// Drag of a sphere, eq. (2) of the paper: c_W rho / 2 A v^2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphereDrag {
    /// Half the density of the fluid times coefficient and section of the sphere, kg/m.
    pub factor: f64,
}

impl SphereDrag {
    /// Of a sphere of `radius` m with the drag coefficient c_W in a fluid of `density` kg/m^3.
    pub fn new(coefficient: f64, density: f64, radius: f64) -> Self {
        SphereDrag { factor: 0.5 * coefficient * density * std::f64::consts::PI * radius.powi(2) }
    }
}

/// Acceleration of the valve's body along a direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Excitation {
    /// Direction, of length 1.
    pub direction: Vector,
    /// Largest acceleration in m/s^2; with a record the factor on it.
    pub amplitude: f64,
    /// Its course.
    pub wave: Wave,
}

/// Course of an acceleration over time, of amplitude 1.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "form", rename_all = "kebab-case")]
pub enum Wave {
    /// A sine that begins at 0.
    Sine {
        /// Frequency in Hz.
        frequency: f64,
        /// Number of periods.
        periods: f64,
    },
    /// Half a period of a sine: a shock.
    HalfSine {
        /// Length in s.
        duration: f64,
    },
    /// Samples over the time in s from 0 on, straight lines between them, 0 afterwards.
    Record {
        /// Times in s, ascending. Shape (samples).
        time: Vec<f64>,
        /// Accelerations in m/s^2. Shape (samples).
        acceleration: Vec<f64>,
    },
}

impl Wave {
    /// Value at `time` in s.
    pub fn at(&self, time: f64) -> f64 {
        if !(0.0..self.end()).contains(&time) {
            return 0.0;
        }
        match self {
            Wave::Sine { frequency, .. } => (2.0 * std::f64::consts::PI * frequency * time).sin(),
            Wave::HalfSine { duration } => (std::f64::consts::PI * time / duration).sin(),
            Wave::Record { time: times, acceleration } => {
                let after = times.partition_point(|t| *t <= time).clamp(1, times.len() - 1);
                let [t0, t1] = [times[after - 1], times[after]];
                let share = ((time - t0) / (t1 - t0)).clamp(0.0, 1.0);
                acceleration[after - 1] + share * (acceleration[after] - acceleration[after - 1])
            }
        }
    }

    /// Time in s from which on it is 0.
    pub fn end(&self) -> f64 {
        match self {
            Wave::Sine { frequency, periods } => periods / frequency,
            Wave::HalfSine { duration } => *duration,
            Wave::Record { time, .. } => time.last().copied().unwrap_or(0.0),
        }
    }

    /// Largest magnitude: 1, of a record in m/s^2.
    pub fn size(&self) -> f64 {
        let [high, low] = self.peaks();
        high.max(-low)
    }

    /// Largest and smallest value: a sine's peaks are 1 and -1.
    pub fn peaks(&self) -> [f64; 2] {
        match self {
            Wave::Sine { .. } => [1.0, -1.0],
            Wave::HalfSine { .. } => [1.0, 0.0],
            Wave::Record { acceleration, .. } => {
                let peak = |of: fn(f64, f64) -> f64| acceleration.iter().copied().fold(0.0, of);
                [peak(f64::max), peak(f64::min)]
            }
        }
    }

    /// Integral of its magnitude over time, s (of a record m/s).
    pub fn impulse(&self) -> f64 {
        match self {
            Wave::Sine { .. } | Wave::HalfSine { .. } => 2.0 / std::f64::consts::PI * self.end(),
            Wave::Record { time, acceleration } => {
                let pieces = time.windows(2).zip(acceleration.windows(2));
                let area = |(t, a): (&[f64], &[f64])| {
                    let size = a[0].abs() + a[1].abs();
                    // a line through zero makes two triangles
                    let twice = if a[0] * a[1] < 0.0 { (a[0].powi(2) + a[1].powi(2)) / size } else { size };
                    0.5 * (t[1] - t[0]) * twice
                };
                pieces.map(area).sum()
            }
        }
    }

    /// Frequency in Hz, of a half-sine that of the whole one; `None` of a record.
    pub fn frequency(&self) -> Option<f64> {
        match self {
            Wave::Sine { frequency, .. } => Some(*frequency),
            Wave::HalfSine { duration } => Some(0.5 / duration),
            Wave::Record { .. } => None,
        }
    }

    /// The same wave at another `frequency` in Hz; a record stays as it is.
    pub fn at_frequency(&self, frequency: f64) -> Self {
        match self {
            Wave::Sine { periods, .. } => Wave::Sine { frequency, periods: *periods },
            Wave::HalfSine { .. } => Wave::HalfSine { duration: 0.5 / frequency },
            Wave::Record { .. } => self.clone(),
        }
    }

    /// The end in s of the piece from `time` on in which it is smooth, and the longest step in it.
    fn smooth_from(&self, time: f64) -> (f64, f64) {
        let end = self.end();
        if time >= end {
            return (f64::INFINITY, f64::INFINITY);
        }
        match self {
            Wave::Sine { frequency, .. } => (end, 1.0 / (STEPS_PER_PERIOD * frequency)),
            Wave::HalfSine { duration } => (end, 2.0 * duration / STEPS_PER_PERIOD),
            Wave::Record { time: times, .. } => {
                (times[times.partition_point(|t| *t <= time).min(times.len() - 1)], f64::INFINITY)
            }
        }
    }
}

impl Field {
    /// Acceleration in m/s^2 of a sphere of `mass` kg by gravity, spring and shaking at `place` and `time`, without drag.
    pub fn acceleration(&self, mass: f64, time: f64, place: Vector) -> Vector {
        let mut sum = self.gravity;
        if let Some(spring) = &self.spring {
            sum += spring.push(place) / mass;
        }
        if let Some(shaken) = &self.shaken {
            sum -= shaken.amplitude * shaken.wave.at(time) * shaken.direction;
        }
        sum
    }

    /// Acceleration in m/s^2 by drag at a `velocity`.
    pub(super) fn drag(&self, mass: f64, velocity: Vector) -> Vector {
        self.drag.map_or_else(Vector::zeros, |drag| -drag.factor / mass * velocity.norm() * velocity)
    }

    /// Potential in J of gravity and spring for a sphere of `mass` kg at `place`.
    pub fn potential(&self, mass: f64, place: Vector) -> f64 {
        -mass * self.gravity.dot(&place) + self.spring.as_ref().map_or(0.0, |spring| spring.potential(place))
    }

    /// Largest moment in N m with which the spring resists a turn of a sphere of `radius` m at `place`.
    pub(super) fn resisting_moment(&self, radius: f64, place: Vector) -> f64 {
        self.spring
            .as_ref()
            .filter(|spring| spring.friction > 0.0)
            .map_or(0.0, |spring| spring.friction * radius * spring.push(place).norm())
    }

    /// Longest step in s from `time` on at a `speed` in m/s.
    pub(super) fn longest_step(&self, mass: f64, time: f64, speed: f64) -> f64 {
        let oscillation = self.spring.as_ref().map_or(0.0, |spring| spring.frequency(mass));
        let slowing = self.drag.map_or(0.0, |drag| drag.factor * speed / mass);
        let rate = (oscillation / (2.0 * std::f64::consts::PI)).max(slowing) * STEPS_PER_PERIOD;
        let (until, longest) =
            self.shaken.as_ref().map_or((f64::INFINITY, f64::INFINITY), |s| s.wave.smooth_from(time));
        (1.0 / rate).min(longest).min(until - time)
    }
}
