//! Models over their number of modes, and the reference's meshes, against the finest stored reference.

use super::{Bench, Ratio, WorkPrecision, timed};
use crate::error::{Error, Result};
use crate::impact::reduced::Reduced;
use crate::reference::{Lookup, Resolution, Store};
use crate::scene::{self, Model, Scene, Setup};
use std::process::{Command, Stdio};
use std::time::Instant;

/// Numbers of modes of models B and C.
const MODES: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];
/// Tolerance of the time integration: its error is none of the model's.
const TOLERANCE: f64 = 1e-5;
/// Error of the efficiency at which model C is compared with the reference's meshes.
const ERROR: f64 = 3e-3;

/// Runs every shipped scene.
pub(super) fn run(store: &Store, bench: &mut Bench) -> Result<()> {
    for path in scene::shipped()? {
        let scene = Scene::read(&path)?;
        if matches!(scene.setup, Setup::SealSeat(_)) {
            bench
                .notes
                .push(format!("scene `{}` is a seal seat: `impactcheck study seal-seat-cost`", scene.name));
            continue;
        }
        let Lookup::Found(finest) = store.find(&scene, Resolution::Fine) else {
            bench.notes.push(format!("scene `{}` has no stored fine reference", scene.name));
            continue;
        };
        let exact = finest.outcome.summary.quantities.efficiency;
        let problem = format!("{}, against the fine reference", scene.name);
        let first = bench.work_precision.len();
        for resolution in [Resolution::Coarse, Resolution::Paper] {
            if let Lookup::Found(stored) = store.find(&scene, resolution) {
                let summary = &stored.outcome.summary;
                bench.work_precision.push(WorkPrecision {
                    solver: format!("FE reference, {}", resolution),
                    problem: problem.clone(),
                    modes: None,
                    tolerance: None,
                    relative_error: (summary.quantities.efficiency / exact - 1.0).abs(),
                    seconds: summary.solve_seconds,
                    seconds_with_setup: None,
                });
            }
        }
        for model in [Model::A, Model::B, Model::C] {
            for modes in MODES.into_iter().filter(|n| model != Model::A || *n == 1) {
                let reduced = Reduced::new(&scene, model, Some(modes))?;
                let (summary, seconds) = timed(200, || reduced.run(TOLERANCE))?;
                bench.work_precision.push(WorkPrecision {
                    solver: format!("model {model}"),
                    problem: problem.clone(),
                    modes: Some(modes),
                    tolerance: None,
                    relative_error: (summary.quantities.efficiency / exact - 1.0).abs(),
                    seconds,
                    seconds_with_setup: Some(whole_program(&path, model, modes)?),
                });
            }
        }
        bench.ratios.extend(ratios(&problem, &bench.work_precision[first..]));
    }
    Ok(())
}

/// The time of a run that is meant.
type Time = fn(&WorkPrecision) -> f64;

/// Model C against the quickest mesh that is as good, per run and with set-up.
fn ratios(problem: &str, runs: &[WorkPrecision]) -> Vec<Ratio> {
    let good = |start: &str| -> Vec<&WorkPrecision> {
        runs.iter().filter(|r| r.solver.starts_with(start) && r.relative_error <= ERROR).collect()
    };
    let quickest = |runs: &[&WorkPrecision], time: Time| {
        runs.iter().copied().min_by(|a, b| time(a).total_cmp(&time(b))).cloned()
    };
    let Some(mesh) = quickest(&good("FE reference"), |r| r.seconds) else { return Vec::new() };
    let ways: [(&str, Time); 2] = [
        ("per run", |r| r.seconds),
        ("with set-up, nothing cached", |r| r.seconds_with_setup.unwrap_or(f64::INFINITY)),
    ];
    ways.into_iter()
        .filter_map(|(way, time)| {
            let ours = quickest(&good("model C"), time)?;
            Some(Ratio {
                peer: format!("{} / model C {way}", mesh.solver),
                problem: problem.to_owned(),
                modes: ours.modes,
                relative_error: ERROR,
                ratio: mesh.seconds / time(&ours),
                seconds: time(&ours),
            })
        })
        .collect()
}

/// Wall time in s of the program from its start to its result, without a cache of bodies.
fn whole_program(scene: &std::path::Path, model: Model, modes: usize) -> Result<f64> {
    let failed = |what: String| Error::Internal(format!("running this program: {what}"));
    let program = std::env::current_exe().map_err(|e| failed(e.to_string()))?;
    let start = Instant::now();
    let status = Command::new(program)
        .arg("reduced")
        .arg(scene)
        .args(["--model", &model.to_string(), "--modes", &modes.to_string(), "--json"])
        .env("IMPACTCHECK_CACHE", "")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .status()
        .map_err(|e| failed(e.to_string()))?;
    if !status.success() {
        return Err(failed(format!("it ended with {status}")));
    }
    Ok(start.elapsed().as_secs_f64())
}
