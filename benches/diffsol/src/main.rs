//! The reduced model's equations by diffsol's integrators: one JSON document in, one JSON line per run out, as
//! `impactcheck bench --peer` asks for it.
//!
//! q'' + 2 alpha q' + omega^2 q = -B^T F,  F = k max(B q - gap, 0)^(3/2), state y = [q, q'].

use diffsol::{
    Bdf, NalgebraLU, NalgebraMat, OdeBuilder, OdeEquationsImplicit, OdeSolverMethod, OdeSolverProblem,
    OdeSolverStopReason,
};
use serde::Deserialize;
use std::time::Instant;

type M = NalgebraMat<f64>;
type V = <M as diffsol::MatrixCommon>::V;
type LS = NalgebraLU<f64>;

/// What the program asks for.
#[derive(Deserialize, Clone)]
struct Problem {
    /// Angular frequencies in rad/s and dampings in 1/s. Shape (n).
    omega: Vec<f64>,
    alpha: Vec<f64>,
    /// B: approaches of both contacts per coordinate. Shape (2, n).
    approach: [Vec<f64>; 2],
    gap: [f64; 2],
    /// k in N/m^(3/2).
    contact_stiffness: [f64; 2],
    /// State at t = 0, and sizes of its entries. Shape (2 n).
    start: Vec<f64>,
    scale: Vec<f64>,
    end_time: f64,
    tolerances: Vec<f64>,
    repeats: usize,
    /// Wall time in s that a run may take.
    budget: f64,
}

impl Problem {
    fn approaches(&self, q: &[f64]) -> [f64; 2] {
        [0, 1].map(|i| (dot(&self.approach[i], q) - self.gap[i]).max(0.0))
    }

    fn rate(&self, y: &[f64], dy: &mut [f64]) {
        let n = self.omega.len();
        let (q, v) = y.split_at(n);
        let d = self.approaches(q);
        let force = [0, 1].map(|i| self.contact_stiffness[i] * d[i] * d[i].sqrt());
        dy[..n].copy_from_slice(v);
        self.accelerate(q, v, force, &mut dy[n..]);
    }

    /// The Jacobian at `y` times `w`.
    fn tangent(&self, y: &[f64], w: &[f64], dw: &mut [f64]) {
        let n = self.omega.len();
        let (q, v) = w.split_at(n);
        let d = self.approaches(&y[..n]);
        let change =
            [0, 1].map(|i| 1.5 * self.contact_stiffness[i] * d[i].sqrt() * dot(&self.approach[i], q));
        dw[..n].copy_from_slice(v);
        self.accelerate(q, v, change, &mut dw[n..]);
    }

    fn accelerate(&self, q: &[f64], v: &[f64], force: [f64; 2], a: &mut [f64]) {
        for k in 0..q.len() {
            a[k] = -2.0 * self.alpha[k] * v[k]
                - self.omega[k] * self.omega[k] * q[k]
                - self.approach[0][k] * force[0]
                - self.approach[1][k] * force[1];
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// State at `end`, or `None` if the solver gives up or is not there within `budget` s.
fn finish<'a, E, S>(solver: &mut S, end: f64, budget: f64) -> Option<Vec<f64>>
where
    E: OdeEquationsImplicit<M = M, V = V, T = f64> + 'a,
    S: OdeSolverMethod<'a, E>,
{
    let begin = Instant::now();
    solver.set_stop_time(end).ok()?;
    while !matches!(solver.step().ok()?, OdeSolverStopReason::TstopReached) {
        if begin.elapsed().as_secs_f64() > budget {
            return None;
        }
    }
    Some(solver.state().y.batch_as_slice(0).to_vec())
}

/// A run with one of the integrators.
fn run<E>(method: &str, problem: &OdeSolverProblem<E>, end: f64, budget: f64) -> Option<Vec<f64>>
where
    E: OdeEquationsImplicit<M = M, V = V, T = f64, C = <M as diffsol::MatrixCommon>::C>,
{
    match method {
        "Tsit45" => finish(&mut problem.tsit45().ok()?, end, budget),
        "ESDIRK34" => finish(&mut problem.esdirk34::<LS>().ok()?, end, budget),
        "TR-BDF2" => finish(&mut problem.tr_bdf2::<LS>().ok()?, end, budget),
        _ => {
            let mut solver: Bdf<'_, E, LS> = problem.bdf::<LS>().ok()?;
            finish(&mut solver, end, budget)
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let problem: Problem = serde_json::from_reader(std::io::stdin())?;
    let inner = problem.omega.len() + 1;
    for method in ["Tsit45", "BDF", "ESDIRK34", "TR-BDF2"] {
        for &tolerance in &problem.tolerances {
            let mut best = f64::INFINITY;
            let mut end = None;
            for _ in 0..problem.repeats {
                let (rate, tangent, start) = (problem.clone(), problem.clone(), problem.start.clone());
                let equations = OdeBuilder::<M>::new()
                    .rtol(tolerance)
                    .atol(problem.scale.iter().map(|scale| tolerance * scale))
                    .h0(1e-4 * problem.end_time)
                    .rhs_implicit(
                        move |y, _, _, dy| rate.rate(y, dy),
                        move |y, _, _, w, dw| tangent.tangent(y, w, dw),
                    )
                    .init(move |_, _, y| y.copy_from_slice(&start), problem.start.len())
                    .build()?;
                let begin = Instant::now();
                end = run(method, &equations, problem.end_time, problem.budget);
                best = best.min(begin.elapsed().as_secs_f64());
                if end.is_none() || best > 1.0 {
                    break;
                }
            }
            let Some(state) = end else { break };
            let answer = serde_json::json!({
                "solver": method, "tolerance": tolerance, "inner_rate": state[inner], "seconds": best,
            });
            println!("{answer}");
            if best > problem.budget / 3.0 {
                break;
            }
        }
    }
    Ok(())
}
