//! The time integration against general-purpose integrators on the same equations.

use crate::dynamics::equations::Equations;
use crate::dynamics::error_control::{SMALLEST_TOLERANCE_IN_EVEN_STEPS, controlled};
use crate::dynamics::integration::Options;
use crate::dynamics::integrator::integrate;
use crate::dynamics::system::{INNER, System};
use crate::error::Result;
use crate::evidence::bench::{Bench, OURS, Settings, WorkPrecision, timed};
use crate::kinds::plate_impact::reduced::Reduced;
use crate::numerics::explicit_runge_kutta::{
    self as runge_kutta, DORMAND_PRINCE_5, DORMAND_PRINCE_8, Tolerances,
};
use crate::reference::python;
use crate::scene::{self, Model, Scene};
use serde::Deserialize;
use std::io::Write;
use std::process::{Command, Stdio};

const SCENE: &str = "scaled-plate-r10";
/// Name of the solver of points of sweeps: solutions in steps of one length, two at least.
const POINTS: &str = "impactcheck, points of sweeps";
/// Evaluations times state entries that a compiled peer's run may cost.
const PEER_WORK: f64 = 4e9;
/// Wall time in s that a run of a peer may take.
const PEER_BUDGET: f64 = 20.0;

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
    let label = format!("{SCENE}, model B, time integration");
    let mut add = |solver: &str, tolerance: f64, velocity: f64, seconds: f64| {
        bench.work_precision.push(WorkPrecision {
            solver: solver.to_owned(),
            problem: label.clone(),
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
    for &tolerance in settings.tolerances.iter().filter(|t| **t >= SMALLEST_TOLERANCE_IN_EVEN_STEPS) {
        let (result, seconds) = timed(300, || controlled(&options(tolerance), system, None))?;
        add(POINTS, tolerance, result.velocity[1], seconds);
    }
    let equations = Equations::new(system);
    let (start, scale) = equations.start(system.hertz_impact().duration());
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
    let problem = problem(system, (&start, &scale), end_time, &settings.peer_tolerances);
    for (name, command) in peers(settings)? {
        match run_peer(command, &problem) {
            Ok(runs) => {
                for run in runs {
                    let velocity = run.inner_rate / system.masses[1].sqrt();
                    add(&format!("{name} {}", run.solver), run.tolerance, velocity, run.seconds);
                }
            }
            Err(what) => bench.notes.push(format!("{name} with {modes} modes can't be run: {what}")),
        }
    }
    Ok(())
}

/// The peers that are programs of their own.
fn peers(settings: &Settings) -> Result<Vec<(String, Command)>> {
    const SCRIPT: &str = include_str!("peers.py");
    let mut peers = Vec::new();
    if settings.scipy {
        let mut command = Command::new(python()?);
        command.args(["-c", SCRIPT]);
        peers.push(("SciPy".to_owned(), command));
    }
    for program in &settings.peers {
        let name = program.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        peers.push((name.trim_end_matches("-peer").to_owned(), Command::new(program)));
    }
    Ok(peers)
}

/// A run of a peer.
#[derive(Deserialize)]
struct PeerRun {
    solver: String,
    tolerance: f64,
    inner_rate: f64,
    seconds: f64,
}

/// The equations, and what is asked of a peer.
fn problem(
    system: &System,
    (start, scale): (&[f64], &[f64]),
    end_time: f64,
    tolerances: &[f64],
) -> serde_json::Value {
    const { assert!(INNER == 1, "the peers read the inner body's rate there") };
    serde_json::json!({
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
        "budget": PEER_BUDGET,
    })
}

/// All runs of a peer, or why there are none.
fn run_peer(mut command: Command, problem: &serde_json::Value) -> std::result::Result<Vec<PeerRun>, String> {
    let mut child = command
        // one core, as this program's integrator
        .envs([("OMP_NUM_THREADS", "1"), ("OPENBLAS_NUM_THREADS", "1")])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|e| e.to_string())?;
    let mut input = child.stdin.take().ok_or("no standard input")?;
    // a peer that ends without reading says why below
    let written = input.write_all(problem.to_string().as_bytes());
    drop(input);
    let output = child.wait_with_output().map_err(|e| e.to_string())?;
    if !output.status.success() {
        let log = String::from_utf8_lossy(&output.stderr);
        return Err(log.lines().last().unwrap_or("it printed nothing").to_owned());
    }
    written.map_err(|e| e.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines()
        .map(|line| serde_json::from_str(line).map_err(|e| format!("unexpected answer `{line}` ({e})")))
        .collect()
}
