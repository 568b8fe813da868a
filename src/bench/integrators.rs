//! The time integration against general-purpose integrators on the same equations.

use super::{Bench, OURS, Settings, WorkPrecision, timed};
use crate::analytical::hertz::HertzImpact;
use crate::error::{Error, Result};
use crate::impact::explicit_runge_kutta::{
    self as runge_kutta, DORMAND_PRINCE_5, DORMAND_PRINCE_8, Equations, Tolerances,
};
use crate::impact::integrator::{Options, integrate};
use crate::impact::reduced::Reduced;
use crate::impact::system::{INNER, System};
use crate::reference::python;
use crate::scene::{self, Model, Scene};
use serde::Deserialize;
use std::io::Write;
use std::process::{Command, Stdio};

const SCENE: &str = "scaled-plate-r10";
/// Evaluations times state entries that a compiled peer's run may cost.
const PEER_WORK: f64 = 4e9;
/// Wall time in s that a run of SciPy may take.
const SCIPY_BUDGET: f64 = 20.0;

/// Runs model B with `modes` modes by all integrators.
pub(super) fn run(modes: usize, settings: &Settings, bench: &mut Bench) -> Result<()> {
    let scene = Scene::read(scene::resolve(SCENE)?)?;
    let reduced = Reduced::new(&scene, Model::B, Some(modes))?;
    let system = reduced.system();
    let options = |tolerance| Options { tolerance, ..Options::default() };
    let exact = integrate(system, &options(1e-12))?;
    // the bodies have parted for good: the inner velocity is final
    let end_time = 1.001 * exact.contacts[0].end.max(exact.contacts[1].end);
    let error = |velocity: f64| (velocity / exact.velocity[1]).powi(2) - 1.0;
    let problem = format!("{SCENE}, model B, time integration");
    let mut add = |solver: &str, tolerance: f64, velocity: f64, seconds: f64| {
        bench.work_precision.push(WorkPrecision {
            solver: solver.to_owned(),
            problem: problem.clone(),
            modes: Some(modes),
            tolerance: Some(tolerance),
            relative_error: error(velocity).abs(),
            seconds,
            seconds_with_setup: None,
        });
    };
    for &tolerance in &settings.tolerances {
        let (result, seconds) = timed(300, || integrate(system, &options(tolerance)))?;
        add(OURS, tolerance, result.velocity[1], seconds);
    }
    let equations = Equations::new(system);
    let (start, scale) = equations.start(hertz(system).duration());
    for method in [DORMAND_PRINCE_5, DORMAND_PRINCE_8] {
        for &relative in &settings.peer_tolerances {
            let max_evaluations = (PEER_WORK / start.len() as f64) as u64;
            let tolerances = Tolerances { relative, absolute: relative, max_evaluations };
            let (velocity, seconds) = timed(50, || {
                let mut state = start.clone();
                let rate = |y: &[f64], dy: &mut [f64]| equations.rate(y, dy);
                let done = runge_kutta::integrate(&method, rate, &mut state, &scale, end_time, &tolerances);
                Ok(done.map(|_| equations.velocity(&state)[1]))
            })?;
            let Some(velocity) = velocity else { break };
            add(&format!("{} (Rust)", method.name), relative, velocity, seconds);
        }
    }
    if !settings.scipy {
        return Ok(());
    }
    match scipy(system, (&start, &scale), end_time, &settings.peer_tolerances) {
        Ok(runs) => {
            for run in runs {
                let velocity = run.inner_rate / system.masses[1].sqrt();
                add(&format!("SciPy {}", run.solver), run.tolerance, velocity, run.seconds);
            }
        }
        Err(error) => bench.notes.push(format!("SciPy with {modes} modes: {error}")),
    }
    Ok(())
}

fn hertz(system: &System) -> HertzImpact {
    HertzImpact { mass: system.masses[0], speed: system.speed, stiffness: system.laws[0].stiffness }
}

/// A run of SciPy.
#[derive(Deserialize)]
struct Run {
    solver: String,
    tolerance: f64,
    inner_rate: f64,
    seconds: f64,
}

/// All runs of SciPy's integrators.
fn scipy(
    system: &System,
    (start, scale): (&[f64], &[f64]),
    end_time: f64,
    tolerances: &[f64],
) -> Result<Vec<Run>> {
    const SCRIPT: &str = include_str!("peers.py");
    let failed = |what: String| Error::Solver(format!("SciPy's integrators can't be run: {what}"));
    let problem = serde_json::json!({
        "omega": system.oscillators.iter().map(|o| o.omega).collect::<Vec<_>>(),
        "alpha": system.oscillators.iter().map(|o| o.alpha).collect::<Vec<_>>(),
        "approach": system.approach,
        "gap": system.gap,
        "contact_stiffness": system.laws.map(|law| law.stiffness),
        "start": start,
        "scale": scale,
        "end_time": end_time,
        "methods": ["RK45", "DOP853", "LSODA", "Radau"],
        "tolerances": tolerances,
        "repeats": 3,
        "budget": SCIPY_BUDGET,
    });
    const { assert!(INNER == 1, "the script reads the inner body's rate there") };
    let mut child = Command::new(python()?)
        .args(["-c", SCRIPT])
        // one core, as this program's integrator
        .envs([("OMP_NUM_THREADS", "1"), ("OPENBLAS_NUM_THREADS", "1")])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|e| failed(e.to_string()))?;
    let mut input = child.stdin.take().ok_or_else(|| failed("no standard input".into()))?;
    input.write_all(problem.to_string().as_bytes()).map_err(|e| failed(e.to_string()))?;
    drop(input);
    let output = child.wait_with_output().map_err(|e| failed(e.to_string()))?;
    if !output.status.success() {
        let log = String::from_utf8_lossy(&output.stderr);
        return Err(failed(log.lines().last().unwrap_or("it says nothing").to_owned()));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines()
        .skip(1)
        .map(|line| {
            serde_json::from_str(line).map_err(|e| failed(format!("unexpected answer `{line}` ({e})")))
        })
        .collect()
}
