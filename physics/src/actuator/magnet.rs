//! Lift magnet (section 2.2): a coil pulls a plunger, which strikes with the speed it has come to.
//!
//! R i + d(L i)/dt = V, m x'' = i^2 L'(x)/2, from rest and without current. The plunger starts `travel` before its stop, where the
//! plate is.
//! The plunger is a compact body from the touch on: in the microseconds of the impact the coil's force, of newtons, does nothing.

use super::inductance::Inductance;
use crate::error::{Error, Result};

/// Steps of the integration from the start to the stop, about.
const STEPS: f64 = 20_000.0;
/// Times `characteristic` after which a plunger that has not come to its stop never will.
const PATIENCE: f64 = 100.0;
/// Most steps in the characteristic time.
const MOST_STEPS: f64 = 1e8;

/// Lift magnet.
#[derive(Debug, Clone, PartialEq)]
pub struct Magnet {
    /// Mass of the plunger in kg.
    pub mass: f64,
    /// Voltage in V.
    pub voltage: f64,
    /// Resistance of the circuit in Ohm.
    pub resistance: f64,
    /// Inductance over the way of the plunger.
    pub inductance: Inductance,
    /// Way of the plunger from the start to the stop in m.
    pub travel: f64,
}

/// A magnet's plunger at its stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lift {
    /// Time since the switching on in s.
    pub time: f64,
    /// Speed of the plunger in m/s.
    pub speed: f64,
    /// Current in A.
    pub current: f64,
    /// Energy taken from the source in J.
    pub taken: f64,
    /// Heat in the resistance in J.
    pub heat: f64,
}

/// State: way, speed, flux linkage, energy taken, heat.
type State = [f64; 5];

impl Magnet {
    fn rates(&self, [way, speed, flux, ..]: State) -> State {
        let [inductance, slope] = self.inductance.at(way);
        let current = flux / inductance;
        let force = 0.5 * current * current * slope;
        let heating = self.resistance * current * current;
        [speed, force / self.mass, self.voltage - self.resistance * current, self.voltage * current, heating]
    }

    /// A step of `h` s by Runge and Kutta.
    fn step(&self, state: State, h: f64) -> State {
        let add = |k: State, c: f64| -> State { std::array::from_fn(|i| state[i] + c * h * k[i]) };
        let k1 = self.rates(state);
        let k2 = self.rates(add(k1, 0.5));
        let k3 = self.rates(add(k2, 0.5));
        let k4 = self.rates(add(k3, 1.0));
        std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    }

    /// Time in s that the plunger would take under the force of the final current at the start.
    fn characteristic(&self) -> f64 {
        let [inductance, slope] = self.inductance.at(0.0);
        let force = 0.5 * (self.voltage / self.resistance).powi(2) * slope;
        (2.0 * self.travel * self.mass / force).sqrt() + inductance / self.resistance
    }

    /// The plunger at its stop.
    ///
    /// # Errors
    /// [`Error::Solver`] if it takes too long to be meant, or the current follows the voltage too quickly for both to be followed.
    pub fn lift(&self) -> Result<Lift> {
        let characteristic = self.characteristic();
        // longer steps than the circuit's time constant would not be stable
        let h = (characteristic / STEPS).min(self.inductance.at(0.0)[0] / self.resistance);
        if characteristic / h > MOST_STEPS {
            return Err(Error::Solver(format!(
                "the magnet's current follows in {h:.1e} s, its plunger in {characteristic:.1e} s: too far apart to follow both; take a smaller resistance"
            )));
        }
        let (mut state, mut time) = (State::default(), 0.0);
        // a step across a bend of the inductance's curve would lose the method's order
        for place in self.inductance.bends(self.travel).chain([self.travel]) {
            let mut next = self.step(state, h);
            while next[0] < place {
                if time > PATIENCE * characteristic {
                    return Err(Error::Solver(format!(
                        "the magnet's plunger has not come to its stop after {time:.3e} s: is its mass, or a voltage, in the wrong unit?"
                    )));
                }
                (state, time) = (next, time + h);
                next = self.step(state, h);
            }
            // by Newton's method in the length of the last step
            let mut last = h;
            for _ in 0..20 {
                let end = self.step(state, last);
                last -= (end[0] - place) / end[1];
            }
            (state, time) = (self.step(state, last), time + last);
        }
        let [_, speed, flux, taken, heat] = state;
        Ok(Lift { time, speed, current: flux / self.inductance.at(self.travel)[0], taken, heat })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn magnet() -> Magnet {
        let inductance = Inductance::even_gap([20e-3, 60e-3], 2e-3);
        Magnet { mass: 5e-3, voltage: 12.0, resistance: 8.0, inductance, travel: 2e-3 }
    }

    /// The even gap's law at `count` + 1 points, as inductances or as forces at 1 A.
    fn curves(count: u32) -> [Inductance; 2] {
        let law = magnet().inductance;
        let ways: Vec<f64> = (0..=count).map(|k| 2e-3 * f64::from(k) / f64::from(count)).collect();
        let points = |of: &dyn Fn([f64; 2]) -> f64| -> Vec<[f64; 2]> {
            ways.iter().map(|way| [*way, of(law.at(*way))]).collect()
        };
        let forces = points(&|[_, slope]| 0.5 * slope);
        [Inductance::through(&points(&|[inductance, _]| inductance)), Inductance::of_forces(20e-3, &forces)]
    }

    #[test]
    fn what_the_source_gives_is_heat_field_or_motion() {
        for resistance in [1.0, 8.0, 40.0] {
            for inductance in curves(8).into_iter().chain([magnet().inductance]) {
                let magnet = Magnet { resistance, inductance, ..magnet() };
                let lift = magnet.lift().unwrap();
                let field = 0.5 * magnet.inductance.at(magnet.travel)[0] * lift.current.powi(2);
                let motion = 0.5 * magnet.mass * lift.speed.powi(2);
                assert_relative_eq!(lift.taken, lift.heat + field + motion, max_relative = 1e-12);
            }
        }
    }

    /// With so much resistance that the current is there at once the work is i^2 (L_1 - L_0)/2.
    #[test]
    fn a_constant_current_works_by_the_change_of_inductance() {
        let magnet = Magnet { resistance: 1e6, voltage: 1e6, mass: 50.0, ..magnet() };
        let lift = magnet.lift().unwrap();
        assert_relative_eq!(0.5 * magnet.mass * lift.speed.powi(2), 0.5 * 40e-3, max_relative = 1e-3);
    }

    /// Fewer and longer steps end at the same place with the same speed.
    #[test]
    fn speed_does_not_hang_on_the_steps() {
        let magnet = magnet();
        let lift = magnet.lift().unwrap();
        let (mut state, h) = (State::default(), lift.time / 3000.0);
        for _ in 0..3000 {
            state = magnet.step(state, h);
        }
        assert_relative_eq!(state[0], magnet.travel, max_relative = 1e-9);
        assert_relative_eq!(state[1], lift.speed, max_relative = 1e-9);
    }

    /// Points of the law give what the law gives: inductances however few, forces ever closer with their number, of second order.
    #[test]
    fn a_curve_of_the_law_is_the_law() {
        let exact = magnet().lift().unwrap().speed;
        let off = |count| {
            curves(count)
                .map(|inductance| Magnet { inductance, ..magnet() }.lift().unwrap().speed / exact - 1.0)
        };
        let [few, coarse, fine] = [2, 16, 32].map(off);
        assert!(few[0].abs() < 1e-9 && fine[0].abs() < 1e-9, "{few:?} {fine:?}");
        let order = (coarse[1] / fine[1]).abs().log2();
        assert!((1.9..2.1).contains(&order) && fine[1].abs() < 1e-3, "order {order}, {coarse:?} {fine:?}");
    }
}
