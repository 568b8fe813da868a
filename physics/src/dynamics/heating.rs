//! Heat in the resistor of a stack's drive: the square of a current with all frequencies of the rod, summed up over each step.

use super::collocation::Collocation;
use super::stages::{STAGES, Stages};
use super::system::{System, dot};

/// Radians of the quickest oscillator of the circuit between two of Gauss's points at most, on an average.
const PANEL: f64 = 0.5;

/// Heat in J of the `h` s from the state (`q`, `v`) on, under the outer contact's forces `force` in N at the nodes; none without a circuit.
pub(super) fn heat(
    system: &System,
    collocation: &Collocation,
    h: f64,
    [q, v]: [&[f64]; 2],
    force: &Stages,
) -> f64 {
    let Some(circuit) = &system.circuit else { return 0.0 };
    let quickest = system.feeds.iter().map(|(k, _)| system.oscillators[*k].omega).fold(0.0, f64::max);
    let panels = (quickest * h / (PANEL * STAGES as f64)).ceil().max(1.0);
    let mut sum = 0.0;
    for panel in 0..panels as usize {
        for (node, weight) in collocation.nodes.iter().zip(&collocation.weights) {
            let t = h * (panel as f64 + node) / panels;
            let at = |(k, feed): &(usize, _)| {
                let oscillator = &system.oscillators[*k];
                let free = oscillator.after(t, [q[*k], v[*k]]);
                let own = collocation.response(oscillator, t, h);
                let fed = collocation.fed(oscillator, feed, t, h);
                let b = system.approach[0][*k];
                let direct = [own.displacement_per_force, own.velocity_per_force];
                let moved = |i: usize| free[i] - b * dot(&direct[i], force) - dot(&fed[i], force);
                (moved(0), moved(1))
            };
            let (q, v): (Vec<f64>, Vec<f64>) = system.feeds.iter().map(at).unzip();
            sum += weight * h / panels * circuit.heating(&q, &v);
        }
    }
    sum
}
