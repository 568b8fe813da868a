//! Heat in the resistor of a stack's drive: the square of a current with all frequencies of the rod, summed up over each step.

use super::collocation::Collocation;
use super::system::{System, dot};
use crate::numerics::duhamel::Oscillator;
use crate::numerics::stages::{STAGES, Stages};

/// Heat of a decay that is not looked at, over the energy that the buffer gives the free stack.
const NEGLIGIBLE: f64 = 1e-14;

/// Radians of the quickest vibration of the circuit between two of Gauss's points at most, on an average; of a decay in the first panel.
const PANEL: f64 = 0.5;
const DECAY_PANEL: f64 = 0.2;
/// Length of a later panel of a decay over the time before it: doubled panels would lose 3e-6 of the heat of the charging.
const GROWTH: f64 = 0.25;

/// Heat in J of the `h` s from the state (`q`, `v`) on, under the outer contact's forces `force` in N at the nodes; none without a circuit.
pub(super) fn heat(
    system: &System,
    collocation: &Collocation,
    h: f64,
    [q, v]: [&[f64]; 2],
    force: &Stages,
) -> f64 {
    let Some(circuit) = &system.circuit else { return 0.0 };
    let modes = || system.feeds.iter().map(|(k, _)| system.oscillators[*k]);
    let longest = |panel: f64, of: fn(&Oscillator) -> bool| {
        let quickest = modes().filter(of).map(|mode| mode.omega).fold(0.0, f64::max);
        panel * STAGES as f64 / quickest
    };
    let own = |values: &[f64]| system.feeds.iter().map(|(k, _)| values[*k]).collect::<Vec<f64>>();
    let transient = circuit.transient_heat(&own(q), &own(v), &collocation.derivatives(force, h));
    let even = h / (h / longest(PANEL, |mode| mode.alpha < mode.omega)).ceil().max(1.0);
    // what only decays has died away the later the slower
    let first = match transient > NEGLIGIBLE * circuit.supplied_energy() {
        true => longest(DECAY_PANEL, |mode| mode.alpha >= mode.omega),
        false => even,
    };
    let (mut sum, mut from) = (0.0, 0.0);
    while from < h * (1.0 - 1e-12) {
        let panel = even.min(first.max(GROWTH * from)).min(h - from);
        for (node, weight) in collocation.nodes.iter().zip(&collocation.weights) {
            let t = from + panel * node;
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
            sum += weight * panel * circuit.heating(&q, &v);
        }
        from += panel;
    }
    sum
}
