//! Models over their number of modes, and the reference's meshes, against the finest stored reference.

use crate::error::{Error, Result};
use crate::evidence::bench::{Bench, Ratio, WorkPrecision, timed};
use crate::kinds::plate_impact::reduced::Reduced;
use crate::reference::{Resolution, Store};
use crate::scene::{self, Model, Scene};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

/// Numbers of modes of models B and C.
const MODES: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];
/// Tolerances of the time integration, with what they add to the solver's name: one whose error is none of the model's, and
/// one that does for a rough answer.
const TOLERANCES: [(f64, &str); 2] = [(1e-5, ""), (1e-3, ", tolerance 1e-3")];
/// Calls of which the quickest is the time of a whole program, a mesh's or a model's.
const PROGRAM_CALLS: usize = 3;
/// Error of the efficiency at which model C is compared with the reference's meshes.
const ERROR: f64 = 3e-3;

/// Runs every shipped scene.
pub(super) fn run(store: &Store, bench: &mut Bench) -> Result<()> {
    for path in scene::shipped()? {
        let scene = Scene::read(&path)?;
        if scene.plate_impact().is_err() {
            bench
                .notes
                .push(format!("scene `{}` is a seal seat: `impactcheck study seal-seat-cost`", scene.name));
            continue;
        }
        let Some(finest) = store.find(&scene, Resolution::Fine).found() else {
            bench.notes.push(format!("scene `{}` has no stored fine reference", scene.name));
            continue;
        };
        let Some(exact) = finest.outcome.summary.value("efficiency") else { continue };
        let problem = format!("{}, against the fine reference", scene.name);
        let first = bench.work_precision.len();
        for resolution in [Resolution::Coarse, Resolution::Paper] {
            match mesh(&path, resolution) {
                Ok(run) => bench.work_precision.push(run.against(exact, resolution, &problem)),
                Err(error) => bench.notes.push(format!("{} mesh of `{}`: {error}", resolution, scene.name)),
            }
        }
        for model in [Model::A, Model::B, Model::C] {
            for modes in MODES.into_iter().filter(|n| model != Model::A || *n == 1) {
                let reduced = Reduced::new(&scene, model, Some(modes))?;
                for (tolerance, name) in TOLERANCES {
                    let (point, seconds) = timed(200, || reduced.point(tolerance))?;
                    bench.work_precision.push(WorkPrecision {
                        solver: format!("model {model}{name}"),
                        problem: problem.clone(),
                        modes: Some(modes),
                        tolerance: None,
                        relative_error: (point.quantities.efficiency / exact - 1.0).abs(),
                        seconds,
                        seconds_with_setup: Some(reduced_program(&path, model, modes, tolerance)?),
                    });
                }
            }
        }
        bench.ratios.extend(ratios(&problem, &bench.work_precision[first..]));
    }
    Ok(())
}

/// The time of a run that is meant.
type Time = fn(&WorkPrecision) -> f64;

/// Model C against the quickest mesh that is as good, per run (the mesh's time loop) and both with all their set-up.
fn ratios(problem: &str, runs: &[WorkPrecision]) -> Vec<Ratio> {
    let good = |start: &str| -> Vec<&WorkPrecision> {
        runs.iter().filter(|r| r.solver.starts_with(start) && r.relative_error <= ERROR).collect()
    };
    let quickest = |runs: &[&WorkPrecision], time: Time| {
        runs.iter().copied().min_by(|a, b| time(a).total_cmp(&time(b))).cloned()
    };
    let ways: [(&str, Time); 2] = [
        ("per run", |r| r.seconds),
        ("with set-up, nothing cached", |r| r.seconds_with_setup.unwrap_or(f64::INFINITY)),
    ];
    ways.into_iter()
        .filter_map(|(way, time)| {
            let (mesh, ours) = (quickest(&good("FE reference"), time)?, quickest(&good("model C"), time)?);
            Some(Ratio {
                peer: format!("{} / model C {way}", mesh.solver),
                problem: problem.to_owned(),
                modes: ours.modes,
                relative_error: ERROR,
                ratio: time(&mesh) / time(&ours),
                seconds: time(&ours),
            })
        })
        .collect()
}

/// Runs of the reference on one mesh, made now: stored times are of another day.
struct MeshRun {
    efficiency: f64,
    /// Of the time loop, s.
    seconds: f64,
    /// Of the whole program, s.
    whole: f64,
}

impl MeshRun {
    fn against(&self, exact: f64, resolution: Resolution, problem: &str) -> WorkPrecision {
        WorkPrecision {
            solver: format!("FE reference, {resolution}"),
            problem: problem.to_owned(),
            modes: None,
            tolerance: None,
            relative_error: (self.efficiency / exact - 1.0).abs(),
            seconds: self.seconds,
            seconds_with_setup: Some(self.whole),
        }
    }
}

/// Solves `scene` by finite elements [`PROGRAM_CALLS`] times, each into a store of its own; the shortest times count.
fn mesh(scene: &Path, resolution: Resolution) -> Result<MeshRun> {
    let mut quickest: Option<MeshRun> = None;
    for _ in 0..PROGRAM_CALLS {
        let store = tempfile::tempdir().map_err(|e| Error::Internal(format!("a temporary folder: {e}")))?;
        let mut command = program("reference", scene)?;
        command.args(["--resolution", &resolution.argument(), "--fresh", "--store"]).arg(store.path());
        let (document, whole) = output(command)?;
        let value = |name: &str| {
            let value = document.get(name).and_then(serde_json::Value::as_f64);
            value.ok_or_else(|| Error::Internal(format!("`impactcheck reference` gave no `{name}`")))
        };
        let (efficiency, seconds) = (value("efficiency")?, value("solve_seconds")?);
        let before = quickest.map_or([f64::INFINITY; 2], |run| [run.seconds, run.whole]);
        quickest = Some(MeshRun { efficiency, seconds: seconds.min(before[0]), whole: whole.min(before[1]) });
    }
    quickest.ok_or_else(|| Error::Internal("no run of a mesh".to_owned()))
}

/// Wall time in s of the program from its start to its result, without a cache of bodies.
fn reduced_program(scene: &Path, model: Model, modes: usize, tolerance: f64) -> Result<f64> {
    (0..PROGRAM_CALLS).try_fold(f64::INFINITY, |shortest, _| {
        let mut command = program("reduced", scene)?;
        command.args(["--model", &model.to_string(), "--modes", &modes.to_string()]);
        command.args(["--tolerance", &tolerance.to_string()]);
        Ok(output(command)?.1.min(shortest))
    })
}

/// This program with `verb` on `scene`, without a cache.
fn program(verb: &str, scene: &Path) -> Result<Command> {
    let program = std::env::current_exe().map_err(|e| Error::Internal(format!("this program: {e}")))?;
    let mut command = Command::new(program);
    command.arg(verb).arg(scene).args(["--json", "--quiet"]).env("IMPACTCHECK_CACHE", "");
    Ok(command)
}

/// Runs `command`: its document and its wall time in s.
fn output(mut command: Command) -> Result<(serde_json::Value, f64)> {
    let start = Instant::now();
    let output = command
        .stdin(Stdio::null())
        .output()
        .map_err(|e| Error::Internal(format!("running this program: {e}")))?;
    let seconds = start.elapsed().as_secs_f64();
    let log = String::from_utf8_lossy(&output.stderr);
    let failed = |what: &str| Error::Internal(format!("this program ended with {}: {what}", output.status));
    if !output.status.success() {
        return Err(failed(log.lines().last().unwrap_or("it printed nothing")));
    }
    let document = serde_json::from_slice(&output.stdout).map_err(|e| failed(&e.to_string()))?;
    Ok((document, seconds))
}
