//! An independent, slow integration of the reduced model: classical Runge-Kutta with a fixed small step.

use impactcheck::dynamics::system::{INNER, System};
use impactcheck::dynamics::wet::{FluidForces, FluidLoad};

/// Velocities of outer and inner body in m/s after `steps` steps of `h` s, in a `fluid` if there is one.
pub fn final_velocities(system: &System, fluid: Option<&FluidForces>, h: f64, steps: usize) -> [f64; 2] {
    let n = system.size();
    let (q, v) = system.initial_state();
    let mut state: Vec<f64> = q.into_iter().chain(v).collect();
    let mut load = FluidLoad::default();
    let mut rate = |state: &[f64]| -> Vec<f64> {
        let (q, v) = state.split_at(n);
        let y = system.modal_approach(q);
        let (local, forces) = system.contact(y, y).expect("equilibrium");
        if let Some(fluid) = fluid {
            fluid.evaluate(q, v, system.indentation(local), &mut load);
        }
        let acceleration = (0..n).map(|k| {
            let o = system.oscillators[k];
            let fluid = k.checked_sub(INNER).and_then(|i| load.force.get(i)).copied().unwrap_or(0.0);
            fluid
                - 2.0 * o.alpha * v[k]
                - o.omega.powi(2) * q[k]
                - system.approach[0][k] * forces[0]
                - system.approach[1][k] * forces[1]
        });
        v.iter().copied().chain(acceleration).collect()
    };
    let add = |state: &[f64], k: &[f64], c: f64| -> Vec<f64> {
        state.iter().zip(k).map(|(s, k)| s + c * k).collect()
    };
    for _ in 0..steps {
        let k1 = rate(&state);
        let k2 = rate(&add(&state, &k1, 0.5 * h));
        let k3 = rate(&add(&state, &k2, 0.5 * h));
        let k4 = rate(&add(&state, &k3, h));
        for i in 0..2 * n {
            state[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
    [state[n] / system.masses[0].sqrt(), state[n + 1] / system.masses[1].sqrt()]
}
