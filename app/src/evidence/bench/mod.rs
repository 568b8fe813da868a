//! Run time against error: integrators with their peers, models over their number of modes, meshes of the reference, impacts in series.
//!
//! Everything is measured in one run of one program on one machine, so that ratios mean something. Every solver
//! is run over its own tolerances; at each error the quickest run that is at least that good counts.

mod figure;
mod kinds;

pub use figure::figure;
pub use kinds::Series;

use crate::error::Result;
use crate::reference::Store;
use crate::result::SCHEMA_VERSION;
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant;

/// Name of this program's integrator in the documents.
pub const OURS: &str = "impactcheck";

/// One solver at one setting: how wrong, how long.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorkPrecision {
    /// Solver, with what language it runs in if it is a peer.
    pub solver: String,
    /// What is solved.
    pub problem: String,
    /// Elastic modes; `None` for finite elements.
    pub modes: Option<usize>,
    /// The tolerance of an integrator; `None` for models, whose name says it if it is a rough one, and meshes.
    pub tolerance: Option<f64>,
    /// Relative error of the efficiency: of an integrator against the converged solution of the same equations, of a
    /// model or mesh against the finest stored reference.
    pub relative_error: f64,
    /// Wall time of a run in s.
    pub seconds: f64,
    /// Wall time of the whole program from nothing (no cached bodies) in s, where it was measured.
    pub seconds_with_setup: Option<f64>,
}

/// How many times quicker this program is than a peer at the same error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ratio {
    /// The peer.
    pub peer: String,
    /// What is solved.
    pub problem: String,
    /// Elastic modes.
    pub modes: Option<usize>,
    /// Both are at least this good.
    pub relative_error: f64,
    /// Peer's time over ours.
    pub ratio: f64,
    /// Our time in s.
    pub seconds: f64,
}

/// The benchmark's document.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bench {
    /// Version of the document.
    pub schema_version: u32,
    /// Processor, system, number of cores.
    pub machine: String,
    /// Compiler of this program, with its version.
    pub compiler: &'static str,
    /// All runs.
    pub work_precision: Vec<WorkPrecision>,
    /// What follows from them.
    pub ratios: Vec<Ratio>,
    /// Impacts in series.
    pub series: Vec<Series>,
    /// Peers that could not be run, and why.
    pub notes: Vec<String>,
}

/// What is run.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Numbers of modes at which integrators are compared.
    pub modes: Vec<usize>,
    /// Tolerances of this program's integrator.
    pub tolerances: Vec<f64>,
    /// Relative tolerances of the peers.
    pub peer_tolerances: Vec<f64>,
    /// Whether SciPy's integrators are among them.
    pub scipy: bool,
    /// Programs that solve the same equations with other integrators, as `benches/diffsol` does.
    pub peers: Vec<PathBuf>,
    /// Whether models over their modes, and the reference's meshes, are compared as well.
    pub models: bool,
    /// Impacts in each series; 0 = none.
    pub series: usize,
}

impl Default for Settings {
    /// 1 and 16 modes, half decades of tolerance, everything else on.
    fn default() -> Self {
        let half_decades = |from: i32, to: i32| {
            let pairs = (to..from).rev().flat_map(|n| [10f64.powi(n + 1), 3.0 * 10f64.powi(n)]);
            pairs.chain([10f64.powi(to)]).collect()
        };
        Self {
            modes: vec![1, 16],
            tolerances: half_decades(-2, -9),
            peer_tolerances: half_decades(-3, -10),
            scipy: true,
            peers: Vec::new(),
            models: true,
            series: 1000,
        }
    }
}

/// Errors at which solvers are compared.
const ERRORS: [f64; 4] = [1e-3, 1e-4, 1e-6, 1e-8];

/// Runs the benchmark; `note` is told what is going on.
///
/// # Errors
/// If one of this program's own solvers fails; a peer that is missing, or a mesh that can't be solved, is noted in the
/// document.
pub fn run(settings: &Settings, store: &Store, note: &dyn Fn(&str)) -> Result<Bench> {
    let mut bench = Bench {
        schema_version: SCHEMA_VERSION,
        machine: machine(),
        compiler: env!("COMPILER"),
        work_precision: Vec::new(),
        ratios: Vec::new(),
        series: Vec::new(),
        notes: Vec::new(),
    };
    kinds::run(settings, store, note, &mut bench)?;
    bench.ratios.splice(0..0, integrator_ratios(&bench.work_precision));
    Ok(bench)
}

/// Every peer against this program's integrator at every error both reach.
fn integrator_ratios(runs: &[WorkPrecision]) -> Vec<Ratio> {
    let mut keys: Vec<(&str, &str, Option<usize>)> = Vec::new();
    for run in runs.iter().filter(|run| !run.solver.starts_with(OURS) && run.tolerance.is_some()) {
        let key = (run.solver.as_str(), run.problem.as_str(), run.modes);
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    let best = |solver: &str, problem: &str, modes, error: f64| {
        runs.iter()
            .filter(|r| {
                r.solver == solver && r.problem == problem && r.modes == modes && r.relative_error <= error
            })
            .map(|r| r.seconds)
            .min_by(f64::total_cmp)
    };
    let mut ratios = Vec::new();
    for (peer, problem, modes) in keys {
        for error in ERRORS {
            if let (Some(ours), Some(theirs)) =
                (best(OURS, problem, modes, error), best(peer, problem, modes, error))
            {
                ratios.push(Ratio {
                    peer: peer.to_owned(),
                    problem: problem.to_owned(),
                    modes,
                    relative_error: error,
                    ratio: theirs / ours,
                    seconds: ours,
                });
            }
        }
    }
    ratios
}

/// Shortest wall time in s of `repeats` calls, fewer if they are slow, and the last result.
fn timed<T>(repeats: usize, mut call: impl FnMut() -> Result<T>) -> Result<(T, f64)> {
    let begin = Instant::now();
    let mut shortest = f64::INFINITY;
    loop {
        let start = Instant::now();
        let result = call()?;
        shortest = shortest.min(start.elapsed().as_secs_f64());
        if begin.elapsed().as_secs_f64() > shortest * repeats as f64 || begin.elapsed().as_secs_f64() > 1.0 {
            return Ok((result, shortest));
        }
    }
}

/// Processor, system and number of cores.
fn machine() -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = cpu
        .lines()
        .find_map(|line| line.strip_prefix("model name"))
        .map_or("unknown processor", |rest| rest.trim_start_matches([' ', '\t', ':']));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{name}, {cores} cores, {} {}", std::env::consts::OS, std::env::consts::ARCH)
}

#[cfg(test)]
mod tests {
    use super::Settings;

    #[test]
    fn tolerances_are_half_decades() {
        let settings = Settings::default();
        assert_eq!((settings.tolerances.len(), settings.peer_tolerances.len()), (15, 15));
        assert_eq!(settings.tolerances[..3], [1e-2, 3e-3, 1e-3]);
        assert!((settings.peer_tolerances[14] / 1e-10 - 1.0).abs() < 1e-12);
        assert!(settings.tolerances.windows(2).all(|pair| pair[1] < pair[0]));
    }
}
