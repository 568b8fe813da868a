//! `impactcheck bench` on its smallest setting: what is run, that errors are measured and fall, and nothing of time.

use impactcheck::evidence::bench::{OURS, Settings, WorkPrecision, figure, run};
use impactcheck::reference::Store;

/// Solver of points of sweeps, at the tolerances for which there are any.
const POINTS: &str = "impactcheck, points of sweeps";

#[test]
fn errors_of_every_integrator_fall_with_its_tolerance_and_ratios_follow_from_the_runs() {
    let settings = Settings {
        modes: vec![2],
        tolerances: vec![1e-2, 1e-4, 1e-6, 1e-8],
        peer_tolerances: vec![1e-3, 1e-6, 1e-9],
        scipy: false,
        peers: vec!["false".into()],
        models: false,
        series: 12,
    };
    let bench = run(&settings, &Store::open(None), &|_| ()).unwrap();
    let mut solvers: Vec<&str> = bench.work_precision.iter().map(|run| run.solver.as_str()).collect();
    solvers.dedup();
    assert_eq!(solvers.len(), 4, "{solvers:?}");
    for solver in solvers.into_iter().filter(|solver| *solver != POINTS) {
        let runs: Vec<&WorkPrecision> =
            bench.work_precision.iter().filter(|run| run.solver == solver).collect();
        let error = |k: usize| runs[k].relative_error;
        let last = runs.len() - 1;
        assert_eq!(last, if solver == OURS { 3 } else { 2 });
        assert!(
            error(last) < 1e-3 * error(0) && error(last) < 1e-7,
            "{solver}: {} {}",
            error(0),
            error(last)
        );
    }
    assert!(bench.work_precision.iter().all(|run| run.seconds > 0.0 && run.modes == Some(2)));
    // what is promised: the tolerance bounds the error of the efficiency
    for run in bench.work_precision.iter().filter(|run| run.solver.starts_with(OURS)) {
        assert!(run.relative_error <= run.tolerance.unwrap(), "{run:?}");
    }
    assert!(
        bench.notes.len() == 1 && bench.notes[0].starts_with("false with 2 modes can't be run"),
        "{:?}",
        bench.notes
    );
    assert!(!bench.ratios.is_empty());
    for ratio in &bench.ratios {
        let best = |solver: &str| {
            let sound = bench.work_precision.iter().filter(|run| run.solver == solver);
            let good = sound.filter(|run| run.relative_error <= ratio.relative_error).map(|run| run.seconds);
            good.fold(f64::INFINITY, f64::min)
        };
        assert_eq!(ratio.ratio, best(&ratio.peer) / best(OURS), "{ratio:?}");
    }
    assert_eq!(bench.series.iter().map(|s| s.model.as_str()).collect::<Vec<_>>(), ["B", "C", "B", "C"]);
    for series in &bench.series {
        let [most, largest] = series.error;
        assert!(most <= largest && series.efficiency_error[1] <= largest && series.per_second_cold > 0.0);
        // Hertz's half-spaces are off by percents where bodies scaled from others are not
        assert_eq!(largest > 0.02, series.model == "B", "{series:?}");
    }
    let drawn = figure(&bench);
    assert!(
        bench.work_precision.iter().all(|run| drawn.contains(&run.solver) && drawn.contains(&run.problem))
    );
}
