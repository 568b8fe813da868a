//! A stack and what supplies it as one linear system: its eigenmodes, and what they say of charge and energy.
//!
//! Charge Q = C_S V + alpha x, C_S = C - alpha^2/k; R dQ/dt = V_buffer - V, and the buffer loses what the stack takes. With
//! A(s) = sum phi_k^2/(s^2 + omega_k^2) the extension is x = A (alpha V - F), and with Z(s) = R s + 1/C_B the poles are where
//! f(s) = 1 + (C_S + alpha^2 A) Z is zero: one pair per mode of the rod and a real one of the circuit. Each pole s_j adds
//! z_j to the extension, z_j' = s_j z_j + r_j F with the residue r_j of x/F = -A (1 + C_S Z)/f. A pair is a damped oscillator
//! q = 2 Re z, v = 2 Re(s z) whose force also moves q: q' = v - 2 Re(-r) F. A real pole is one with a second, quicker pole that nothing
//! ever excites.

use super::stack::{MODES, RodMode, Stack, Supply};
use crate::error::{Error, Result};
use crate::numerics::duhamel::{Feed, Oscillator};
use nalgebra::{Complex, DMatrix, Schur};

/// Iterations for the poles, and for their last digits.
const ITERATIONS: usize = 10_000;
const POLISHING: usize = 6;
/// Imaginary part of a pole over it below which it is real.
const REAL: f64 = 1e-9;
/// Second pole of a real one over it.
const QUICKER: f64 = 2.0;

/// A mode of stack and circuit.
#[derive(Debug, Clone, Copy)]
pub struct CircuitMode {
    /// Its free motion.
    pub oscillator: Oscillator,
    /// Extension of the tip per unit, kg^(-1/2).
    pub tip: f64,
    /// How the force acts on it.
    pub feed: Feed,
    /// Coordinate and its rate when the circuit is closed.
    pub start: [f64; 2],
    pole: Complex<f64>,
    /// A at the pole.
    admittance: Complex<f64>,
}

impl CircuitMode {
    /// Whether it decays without a vibration.
    pub fn is_decay(&self) -> bool {
        self.pole.im == 0.0
    }
}

/// A stack with its supply.
#[derive(Debug, Clone)]
pub struct Circuit {
    stack: Stack,
    supply: Supply,
    rod: Vec<RodMode>,
    /// The modes.
    pub modes: Vec<CircuitMode>,
}

/// Energies of stack and circuit in J.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Account {
    /// What the buffer has lost.
    pub taken: f64,
    /// What the stack holds: electrical, strain and kinetic.
    pub held: f64,
    /// What stack and buffer can still give.
    pub available: f64,
}

impl Circuit {
    /// The modes of `stack` behind `supply`.
    ///
    /// # Errors
    /// [`Error::Solver`] if the poles can't be found.
    pub fn new(stack: &Stack, supply: Supply) -> Result<Self> {
        let rod = stack.modes(MODES);
        let mut circuit = Self { stack: *stack, supply, rod, modes: Vec::new() };
        circuit.modes = circuit.poles()?.into_iter().map(|pole| circuit.mode(pole)).collect();
        Ok(circuit)
    }

    /// Voltage at which everything comes to rest, V.
    pub fn final_voltage(&self) -> f64 {
        self.stack.voltage / (1.0 + self.stack.capacitance * self.supply.elastance())
    }

    /// Energy in J that a source at the stack's voltage gives the free stack.
    pub fn supplied_energy(&self) -> f64 {
        self.stack.capacitance * self.stack.voltage.powi(2)
    }

    /// Extension in m at which the free stack comes to rest.
    pub fn final_extension(&self) -> f64 {
        self.stack.stroke * self.final_voltage() / self.stack.voltage
    }

    /// A and its derivative.
    fn admittance(&self, s: Complex<f64>) -> [Complex<f64>; 2] {
        let mut sums = [Complex::from(0.0); 2];
        for mode in &self.rod {
            let resonance = (s * s + mode.omega.powi(2)).inv() * mode.tip;
            sums[0] += resonance * mode.tip;
            sums[1] -= s * 2.0 * resonance * resonance;
        }
        sums
    }

    /// f and its derivative.
    fn characteristic(&self, s: Complex<f64>) -> [Complex<f64>; 2] {
        let square = self.stack.force_per_voltage().powi(2);
        let impedance = s * self.supply.resistance + self.supply.elastance();
        let [a, slope] = self.admittance(s);
        let capacitance = a * square + self.stack.clamped_capacitance();
        [capacitance * impedance + 1.0, capacitance * self.supply.resistance + slope * square * impedance]
    }

    /// The poles, of pairs the one with the positive imaginary part.
    fn poles(&self) -> Result<Vec<Complex<f64>>> {
        // states omega q, v and Q/sqrt(C_S), whose squares are energies; rates over the first frequency
        let n = self.rod.len();
        let (capacitance, unit) = (self.stack.clamped_capacitance(), self.rod[0].omega);
        let coupling = self.stack.force_per_voltage() / capacitance.sqrt();
        let discharge = 1.0 / self.supply.resistance;
        let mut rates = DMatrix::zeros(2 * n + 1, 2 * n + 1);
        for (i, row) in self.rod.iter().enumerate() {
            rates[(i, n + i)] = row.omega / unit;
            rates[(n + i, i)] = -row.omega / unit;
            for (j, column) in self.rod.iter().enumerate() {
                rates[(n + i, j)] -= coupling.powi(2) * row.tip * column.tip / column.omega / unit;
            }
            rates[(n + i, 2 * n)] = coupling * row.tip / unit;
            rates[(2 * n, i)] = discharge / capacitance * coupling * row.tip / row.omega / unit;
        }
        rates[(2 * n, 2 * n)] = -discharge * (self.supply.elastance() + 1.0 / capacitance) / unit;
        let schur = Schur::try_new(rates, f64::EPSILON, ITERATIONS).ok_or_else(|| {
            Error::Solver("reduced model: the eigenmodes of the stack and its drive are not found".into())
        })?;
        let poles = schur.complex_eigenvalues();
        let rough = poles.iter().map(|pole| pole * unit);
        Ok(rough.filter(|s| s.im >= -REAL * s.norm()).map(|s| self.polished(s)).collect())
    }

    /// The pole near `s` to its last digits, by Newton's method.
    fn polished(&self, s: Complex<f64>) -> Complex<f64> {
        let mut pole = if s.im.abs() <= REAL * s.norm() { Complex::from(s.re) } else { s };
        for _ in 0..POLISHING {
            let [value, slope] = self.characteristic(pole);
            let step = value / slope;
            // false for what is not a number
            if step.norm() < 1e-6 * pole.norm() {
                pole -= step;
            }
        }
        pole
    }

    fn mode(&self, s: Complex<f64>) -> CircuitMode {
        let [a, _] = self.admittance(s);
        let [_, slope] = self.characteristic(s);
        let impedance = s * self.supply.resistance + self.supply.elastance();
        let residue = -a * (impedance * self.stack.clamped_capacitance() + 1.0) / slope;
        let start = a * self.stack.force_per_voltage() * self.stack.voltage / (s * slope);
        let real = s.im == 0.0;
        // of both poles of a pair
        let both = |z: Complex<f64>| if real { z.re } else { 2.0 * z.re };
        let (slip, push) = (-both(residue), -both(residue * s));
        let tip = push.abs().sqrt();
        let oscillator = if real {
            Oscillator { omega: QUICKER.sqrt() * s.re.abs(), alpha: -0.5 * (1.0 + QUICKER) * s.re }
        } else {
            Oscillator { omega: s.norm(), alpha: -s.re }
        };
        CircuitMode {
            oscillator,
            tip,
            feed: Feed { push: push / tip - tip, slip: slip / tip },
            start: [both(start) / tip, both(start * s) / tip],
            pole: s,
            admittance: a,
        }
    }

    /// What a mode in the state (`q`, `v`) adds to the extension as a complex number, without its conjugate.
    fn complex(mode: &CircuitMode, q: f64, v: f64) -> Complex<f64> {
        let (q, v, s) = (mode.tip * q, mode.tip * v, mode.pole);
        if s.im == 0.0 { Complex::from(q) } else { Complex::new(0.5 * q, 0.5 * (s.re * q - v) / s.im) }
    }

    /// Power in W of the resistor in the state (`q`, `v`) of the modes.
    pub fn heating(&self, q: &[f64], v: &[f64]) -> f64 {
        let of = |((mode, q), v): ((&CircuitMode, &f64), &f64)| {
            let weight = if mode.pole.im == 0.0 { 1.0 } else { 2.0 };
            let charge = self.charge(mode) * Self::complex(mode, *q, *v);
            weight * (mode.pole * charge).re
        };
        let current: f64 = self.modes.iter().zip(q).zip(v).map(of).sum();
        self.supply.resistance * current * current
    }

    /// Bound in J on the heat of what dies away without a vibration from the state (`q`, `v`) of the modes on, beyond what follows the force
    /// that has there the value and the derivatives by time `force`, in N, N/s, ...
    pub fn transient_heat(&self, q: &[f64], v: &[f64], force: &[f64]) -> f64 {
        let resistance = self.supply.resistance;
        let now = (self.heating(q, v) / resistance).sqrt();
        let of = |(mode, q): (&CircuitMode, &f64)| {
            let rate = mode.pole.re;
            // z' = s z + r F, so that z follows -r (F/s + F'/s^2 + ...)
            let follows = force.iter().rev().fold(0.0, |sum, f| (sum + f) / rate);
            let left = mode.tip * (q - mode.feed.slip * follows);
            let current = rate * self.charge(mode).re * left;
            resistance * current.abs() * (3.0 * current.abs() + 2.0 * now) / rate.abs()
        };
        self.modes.iter().zip(q).filter(|(mode, _)| mode.is_decay()).map(of).sum()
    }

    /// Charge in C per extension in m that a mode adds.
    fn charge(&self, mode: &CircuitMode) -> Complex<f64> {
        let alpha = self.stack.force_per_voltage();
        Complex::from(self.stack.clamped_capacitance()) / (mode.admittance * alpha) + alpha
    }

    /// The energies in the state (`q`, `v`) of the modes.
    pub fn account(&self, q: &[f64], v: &[f64]) -> Account {
        let Stack { voltage, capacitance, .. } = self.stack;
        let (alpha, clamped) = (self.stack.force_per_voltage(), self.stack.clamped_capacitance());
        let mut volts = 0.0;
        let mut rod = vec![[0.0; 2]; self.rod.len()];
        for ((mode, q), v) in self.modes.iter().zip(q).zip(v) {
            let (s, z) = (mode.pole, Self::complex(mode, *q, *v));
            let weight = if s.im == 0.0 { 1.0 } else { 2.0 };
            let share = z / (mode.admittance * alpha);
            volts += weight * share.re;
            for (state, shape) in rod.iter_mut().zip(&self.rod) {
                let own = share * alpha * shape.tip / (s * s + shape.omega.powi(2));
                state[0] += weight * own.re;
                state[1] += weight * (s * own).re;
            }
        }
        let energy = |offset: f64, voltage: f64| {
            let rod = rod.iter().zip(&self.rod).map(|([q, v], shape)| {
                let still = offset * shape.tip * alpha / shape.omega.powi(2);
                0.5 * (v * v + (shape.omega * (q + still)).powi(2))
            });
            0.5 * clamped * voltage * voltage + rod.sum::<f64>()
        };
        let at_rest = self.final_voltage();
        let extension: f64 = rod.iter().zip(&self.rod).map(|([q, _], shape)| shape.tip * q).sum();
        let moved = clamped * volts + alpha * extension;
        let charge = capacitance * at_rest + moved;
        let elastance = self.supply.elastance();
        Account {
            taken: voltage * charge - 0.5 * elastance * charge * charge,
            held: energy(at_rest, at_rest + volts),
            available: energy(0.0, volts) + 0.5 * elastance * moved * moved,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::stack::tests::tokin;
    use super::*;
    use approx::assert_relative_eq;

    fn circuit(resistance: f64, buffer_capacitance: Option<f64>) -> Circuit {
        Circuit::new(&tokin(), Supply { resistance, buffer_capacitance }).unwrap()
    }

    /// Extension and its rate `t` s after the circuit was closed, by the modes.
    fn extension(circuit: &Circuit, t: f64) -> [f64; 2] {
        let mut sums = [circuit.final_extension(), 0.0];
        for CircuitMode { oscillator: o, tip, start: [q, v], .. } in &circuit.modes {
            let [slope, impulse] = o.free(t);
            sums[0] += tip * ((slope + 2.0 * o.alpha * impulse) * q + impulse * v);
            sums[1] += tip * (slope * v - o.omega.powi(2) * impulse * q);
        }
        sums
    }

    /// The same by Runge and Kutta from the equations as they stand.
    fn by_steps(circuit: &Circuit, t: f64, steps: usize) -> f64 {
        let (stack, supply, rod) = (&circuit.stack, &circuit.supply, &circuit.rod);
        let (n, alpha) = (rod.len(), stack.force_per_voltage());
        let rate = |w: &[f64]| -> Vec<f64> {
            let x: f64 = rod.iter().zip(w).map(|(m, q)| m.tip * q).sum();
            let volts = (w[2 * n] - alpha * x) / stack.clamped_capacitance();
            let buffer = stack.voltage - supply.buffer_capacitance.map_or(0.0, |c| w[2 * n] / c);
            let mut rate = w[n..2 * n].to_vec();
            rate.extend(rod.iter().zip(w).map(|(m, q)| m.tip * alpha * volts - m.omega.powi(2) * q));
            rate.push((buffer - volts) / supply.resistance);
            rate
        };
        let h = t / steps as f64;
        let mut w = vec![0.0; 2 * n + 1];
        for _ in 0..steps {
            let add =
                |k: &[f64], c: f64| -> Vec<f64> { w.iter().zip(k).map(|(w, k)| w + c * h * k).collect() };
            let k1 = rate(&w);
            let k2 = rate(&add(&k1, 0.5));
            let k3 = rate(&add(&k2, 0.5));
            let k4 = rate(&add(&k3, 1.0));
            for i in 0..w.len() {
                w[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
        rod.iter().zip(&w).map(|(m, q)| m.tip * q).sum()
    }

    #[test]
    fn modes_of_stack_and_circuit_move_as_the_equations_say() {
        for (resistance, buffer) in [(1e-3, None), (1.0, Some(20e-6)), (10.0, None), (100.0, Some(3e-6))] {
            let circuit = circuit(resistance, buffer);
            assert_eq!(circuit.modes.len(), MODES + 2);
            let [x, v] = extension(&circuit, 0.0);
            assert!(x.abs() < 1e-9 * circuit.final_extension() && v.abs() < 1e-6, "{x} {v}");
            if resistance >= 1.0 {
                for t in [3e-6, 17e-6, 60e-6] {
                    let [x, _] = extension(&circuit, t);
                    assert_relative_eq!(x, by_steps(&circuit, t, 20_000), max_relative = 1e-7);
                }
            }
        }
    }

    /// Without resistance the tip has the speed stroke c/L until the wave comes back, FE 1.921 m/s (provenance: prototype).
    #[test]
    fn a_voltage_step_moves_the_tip_with_its_speed() {
        let stack = tokin();
        let circuit = circuit(1e-4, None);
        let span = stack.length / stack.wave_speed();
        // on an average over the ripples that lateral inertia and the modes left out leave behind the wave
        let (from, to) = (0.3 * span, 1.7 * span);
        let at = |k: usize| from + (to - from) * k as f64 / 400.0;
        let middle = 0.5 * (from + to);
        let (moment, square) = (0..=400).fold((0.0, 0.0), |(moment, square), k| {
            let t = at(k) - middle;
            (moment + t * extension(&circuit, at(k))[0], square + t * t)
        });
        let mean = moment / square;
        assert_relative_eq!(mean, stack.step_speed(), max_relative = 0.01);
    }

    /// The ledger while nothing touches: taken = held + heat.
    #[test]
    fn what_the_buffer_loses_is_stored_or_heat() {
        for (resistance, buffer) in [(1.0, Some(20e-6)), (30.0, None)] {
            let circuit = circuit(resistance, buffer);
            let state = |t: f64| -> [Vec<f64>; 2] {
                let at = circuit.modes.iter().map(|CircuitMode { oscillator: o, start: [q, v], .. }| {
                    let [slope, impulse] = o.free(t);
                    [
                        (slope + 2.0 * o.alpha * impulse) * q + impulse * v,
                        slope * v - o.omega.powi(2) * impulse * q,
                    ]
                });
                let (q, v): (Vec<f64>, Vec<f64>) = at.map(|[q, v]| (q, v)).unzip();
                [q, v]
            };
            let heating = |t: f64| {
                let [q, v] = state(t);
                circuit.heating(&q, &v)
            };
            let account = |t: f64| {
                let [q, v] = state(t);
                circuit.account(&q, &v)
            };
            let (end, panels) = (40e-6, 8000);
            let (points, weights) = crate::numerics::quadrature::gauss_legendre(4);
            let h = end / f64::from(panels);
            let heat: f64 = (0..panels)
                .flat_map(|p| {
                    points.iter().zip(&weights).map(move |(x, w)| (f64::from(p) + 0.5 * (x + 1.0), w))
                })
                .map(|(place, w)| 0.5 * h * w * heating(place * h))
                .sum();
            let (start, now) = (account(0.0), account(end));
            assert!(start.taken.abs() < 1e-12 * now.taken && start.held.abs() < 1e-12 * now.taken);
            assert_relative_eq!(now.taken, now.held + heat, max_relative = 1e-9);
            // what can still be given falls by what is heat, since nothing else goes
            assert_relative_eq!(start.available, now.available + heat, max_relative = 1e-9);
        }
    }
}
