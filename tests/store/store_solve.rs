//! The runner of the finite-element solver: what a solver that succeeds, fails, dies or lies
//! leaves in the store, and what is said about it. The solver is a shell script here.
#![cfg(unix)]

use crate::store_fixture::*;
use crate::waiting::wait_until;
use impactcheck::reference::{Lookup, Progress, Resolution, Store, Wish, solve_with};
use impactcheck::scene::Scene;
use impactcheck::{Error, ExitStatus, Result};
use serde_json::json;
use std::fs::{self, File};
use std::io::Write;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

const PAPER: Resolution = Resolution::Paper;

/// An empty store, a prepared result and an interpreter that runs a script in place of the solver.
struct Bench {
    folder: tempfile::TempDir,
    store: Store,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("folder");
        write_entry(&folder.path().join("prepared"), &scene(), PAPER);
        let store = Store::open(Some(&folder.path().join("store")));
        Bench { folder, store }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// An interpreter that runs `script`; there `$here` is the bench, `$scene` and `$out` the arguments.
    fn solver(&self, script: &str) -> PathBuf {
        let path = self.path("python");
        let here = self.folder.path().display();
        let text = format!("#!/bin/sh\nhere='{here}'\nscene=$5\nout=$7\n{script}\n");
        fs::write(&path, text).expect("script");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("executable");
        path
    }

    fn solve(&self, script: &str) -> Result<Vec<Progress>> {
        let mut steps = Vec::new();
        solve_with(&self.solver(script), &scene(), PAPER, &self.store, &Wish::default(), &mut |p| {
            steps.push(p.clone())
        })?;
        Ok(steps)
    }

    /// The script fails with exactly this status, says all of `words`, and leaves nothing.
    #[track_caller]
    fn fails(&self, script: &str, status: ExitStatus, words: &[&str]) {
        let error = self.solve(script).expect_err("failure");
        assert_eq!(error.exit_status(), status, "{error}");
        let said = flat(&error);
        for word in words {
            assert!(said.contains(word), "`{word}` is not in: {said}");
        }
        assert!(!self.store.root().join("scaled-plate-r10").exists(), "left behind: {:?}", self.contents());
        assert_eq!(self.store.find(&scene(), PAPER), Lookup::Missing);
    }

    /// Names in the folder of the scene, if there is one, sorted.
    fn contents(&self) -> Vec<String> {
        let entries = fs::read_dir(self.store.root().join("scaled-plate-r10")).into_iter().flatten();
        let mut names: Vec<String> =
            entries.map(|e| e.expect("entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// The message without the line breaks of the terminal.
fn flat(error: &Error) -> String {
    error.to_string().replace('\u{2502}', " ").split_whitespace().collect::<Vec<_>>().join(" ")
}

const COPY: &str = "cp -r \"$here/prepared\" \"$out\"";

#[test]
fn a_solid_run_receives_its_processes_and_the_folder_of_its_states() {
    let bench = Bench::new();
    let mut scene = scene();
    scene.reference.geometry = impactcheck::scene::Geometry::Solid;
    write_entry(&bench.path("solid"), &scene, PAPER);
    let solver = bench.solver("echo \"$@\" > \"$here/arguments\"; cp -r \"$here/solid\" \"$out\"");
    let wish = Wish { processes: 3, threads: 6, fields: 7, ..Wish::default() };
    let stored = solve_with(&solver, &scene, PAPER, &bench.store, &wish, &mut |_| ()).expect("success");
    let arguments = fs::read_to_string(bench.path("arguments")).expect("arguments");
    let words: Vec<&str> = arguments.split_whitespace().collect();
    let after = |key: &str| words[words.iter().position(|w| *w == key).expect(key) + 1];
    assert_eq!((after("--np"), after("--threads"), after("--fields")), ("3", "6", "7"));
    // Beside the entry, so that the next start of the same finds them.
    let states = Path::new(after("--checkpoint"));
    assert!(states.is_absolute());
    assert_eq!(states.file_name().expect("name"), ".checkpoint-paper");
    assert_eq!(states.parent(), stored.folder.canonicalize().expect("folder").parent());
}

#[test]
fn success_enters_the_store_complete() {
    let bench = Bench::new();
    let steps = bench
        .solve(&format!(
            r#"echo '{{"phase":"mesh","done":0.5,"message":"meshing"}}'
            echo '{{"phase":"stepping","done":1,"message":"44000 steps"}}'
            echo "$@" > "$here/arguments"; pwd > "$here/cwd"; echo "$PYTHONPATH" > "$here/search"
            cp "$scene" "$here/received.json"
            {COPY}"#
        ))
        .expect("success");
    let phases: Vec<(&str, f64)> = steps.iter().map(|p| (p.phase.as_str(), p.done)).collect();
    assert_eq!(phases, [("mesh", 0.5), ("stepping", 1.0)]);
    assert_eq!(steps[1].message, "44000 steps");
    assert!(matches!(bench.store.find(&scene(), PAPER), Lookup::Found(_)));
    assert_eq!(bench.contents(), ["paper"]);

    let read = |name: &str| fs::read_to_string(bench.path(name)).expect(name);
    let arguments = read("arguments");
    let words: Vec<&str> = arguments.split_whitespace().collect();
    assert_eq!(words[..4], ["-m", "fem_reference", "solve", "--scene"]);
    assert_eq!((words[5], words[7], words[8]), ("--out", "--resolution", "paper"));
    // Neither processes nor checkpoints: the scene is axisymmetric; threads are left to the solver.
    assert_eq!(words.len(), 9);
    let root = read("cwd").trim().to_owned();
    assert!(Path::new(&root).join("scenes").is_dir());
    assert!(read("search").starts_with(&root));
}

#[test]
fn the_solver_receives_the_scene_in_si_and_nothing_else() {
    let bench = Bench::new();
    bench.solve(&format!("cp \"$scene\" \"$here/received.json\"; {COPY}")).expect("success");
    let text = fs::read_to_string(bench.path("received.json")).expect("scene");
    let received: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let steel = json!({"name": "steel", "youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7780.0});
    assert_eq!(
        received,
        json!({
            "name": "scaled-plate-r10",
            "description": "Scaled plate of Table 1, 10 mm spheres (Fig. 10)",
            "kind": "plate-impact",
            "scene_hash": scene().hash(),
            "settings_hash": impactcheck::reference::settings_hash(&scene(), PAPER),
            "plate": {"radius": 0.033, "thickness": 0.002, "edge": "clamped", "material": steel, "damping_ratio": 0.0},
            "outer": {"kind": "sphere", "radius": 0.01, "material": steel, "speed": 0.55},
            "inner": {"kind": "sphere", "radius": 0.01, "material": steel, "gap": 0.0},
            "fluid": null,
            "run": {"end_time": null},
            "reference": {"geometry": "axisymmetric", "elements_per_contact_radius": 12.0},
        })
    );
}

#[test]
fn a_solver_that_fails_is_quoted() {
    let bench = Bench::new();
    let error = r#"echo '{"phase":"error","message":"time step 2e-9 s is above 1e-9 s"}'; exit "#;
    bench.fails(&format!("{error} 12"), ExitStatus::Solver, &["time step 2e-9 s is above 1e-9 s"]);
    bench.fails(&format!("{error} 1"), ExitStatus::Solver, &["time step 2e-9 s is above 1e-9 s"]);
    bench.fails(
        &format!("{error} 3"),
        ExitStatus::InvalidScene,
        &["can't run this scene", "time step 2e-9 s"],
    );
    let crash = "echo first >&2; echo 'ImportError: libmpi.so' >&2; exit 1";
    bench.fails(
        crash,
        ExitStatus::Solver,
        &["exit status 1", "without saying why", "ImportError: libmpi.so"],
    );
    let half = format!("{COPY}; exit 12");
    bench.fails(&half, ExitStatus::Solver, &["exit status 12"]);
}

#[test]
fn a_solver_killed_half_way_leaves_nothing() {
    let bench = Bench::new();
    let script = r#"mkdir "$out"; echo x > "$out/summary.json"; mkdir "$out/../.partial-7"
        echo '{"phase":"stepping","done":0.5,"message":""}'; kill -9 $$"#;
    bench.fails(script, ExitStatus::Solver, &["ended before it was done", "signal: 9", "nothing was stored"]);
}

#[test]
fn garbage_is_no_result() {
    let bench = Bench::new();
    bench.fails("echo '<html>'", ExitStatus::Solver, &["wrote no result", "<html>"]);
    bench.fails("head -c 300000 /dev/urandom", ExitStatus::Solver, &["wrote no result"]);
    bench.fails("mkdir \"$out\"", ExitStatus::Solver, &["checksums.sha256 can't be read"]);
    let cut = format!("{COPY}; echo >> \"$out/history.csv\"");
    bench.fails(&cut, ExitStatus::Solver, &["history.csv", "SHA-256"]);
    let chatty = format!("echo 'Info: meshing'; echo '{{\"phase\":3}}'; {COPY}");
    assert_eq!(bench.solve(&chatty).expect("a library that prints does no harm"), []);
}

#[test]
fn a_result_of_another_scene_is_refused() {
    let bench = Bench::new();
    let faster = scene_with("550 mm/s", "600 mm/s");
    write_entry(&bench.path("prepared-faster"), &faster, PAPER);
    let words = ["not one of this scene", "outer.speed: 0.6 -> 0.55 m/s"];
    bench.fails("cp -r \"$here/prepared-faster\" \"$out\"", ExitStatus::Solver, &words);
    write_entry(&bench.path("prepared-coarse"), &scene(), Resolution::Coarse);
    let words = ["not one of this scene", "resolution: coarse -> paper"];
    bench.fails("cp -r \"$here/prepared-coarse\" \"$out\"", ExitStatus::Solver, &words);
}

#[test]
fn much_output_does_not_stop_the_solver() {
    let bench = Bench::new();
    let noise = "head -c 2000000 /dev/zero | tr '\\0' 'x'";
    let script = format!("{noise} >&2; {noise}; echo; {COPY}");
    bench.solve(&script).expect("success");
}

#[test]
fn an_older_entry_stays_until_a_new_one_is_proven() {
    let bench = Bench::new();
    let entry = bench.store.folder(&scene(), PAPER);
    write_entry(&entry, &scene_with("550 mm/s", "600 mm/s"), PAPER);
    bench.solve("exit 12").expect_err("failure");
    bench.solve(&format!("{COPY}; rm \"$out/mesh.vtu\"")).expect_err("damaged result");
    assert!(matches!(bench.store.find(&scene(), PAPER), Lookup::Stale { .. }));
    bench.solve(COPY).expect("success");
    assert!(matches!(bench.store.find(&scene(), PAPER), Lookup::Found(_)));
}

#[test]
fn a_solution_of_another_scene_of_the_same_name_is_stored_and_found_again() {
    let bench = Bench::new();
    let faster = scene_with("550 mm/s", "600 mm/s");
    write_entry(&bench.path("prepared-faster"), &faster, PAPER);
    let solve = |scene: &Scene, script: &str| {
        let python = bench.solver(script);
        solve_with(&python, scene, PAPER, &bench.store, &Wish::default(), &mut |_| ()).expect("success")
    };
    let copy_faster = "cp -r \"$here/prepared-faster\" \"$out\"";
    let found = |scene: &Scene| match bench.store.find(scene, PAPER) {
        Lookup::Found(stored) => stored,
        other => panic!("{other:?}"),
    };
    assert_eq!(solve(&faster, copy_faster).earlier, None);
    let slower = solve(&scene(), COPY);
    let earlier = slower.earlier.expect("the faster one made room");
    assert_eq!(found(&faster).folder, earlier);
    assert_eq!(found(&faster).outcome.summary.scene_hash, faster.hash());
    assert_eq!(found(&scene()).folder, slower.folder);
    assert_eq!(bench.store.resolutions(&faster), [PAPER]);
    // Computed again, the kept one would be out of date: one of each is there, whatever the order.
    let again = solve(&faster, copy_faster);
    assert_eq!((again.folder, bench.contents().len()), (slower.folder, 2));
    assert!(!earlier.exists() && found(&scene()).folder == again.earlier.expect("kept"));
    // The same scene takes its own place.
    assert_eq!(solve(&faster, copy_faster).earlier, None);
    assert_eq!(bench.contents().len(), 2);
    // What says not of what it is, is not worth keeping.
    fs::write(bench.store.folder(&scene(), PAPER).join("provenance.json"), "{").expect("file");
    assert_eq!(solve(&faster, copy_faster).earlier, None);
    // Other settings are another solution.
    let finer = scene_with("radius = 12", "radius = 14");
    write_entry(&bench.path("finer"), &finer, PAPER);
    assert!(solve(&finer, "cp -r \"$here/finer\" \"$out\"").earlier.is_some());
    for solved in [&faster, &scene(), &finer] {
        assert_eq!(found(solved).outcome.summary.scene_hash, solved.hash());
    }
}

#[test]
fn scenes_of_one_name_solved_at_once_are_all_stored() {
    let bench = Bench::new();
    let scenes: Vec<Scene> = (0..4).map(|k| scene_with("550 mm/s", &format!("{} mm/s", 500 + k))).collect();
    for (k, scene) in scenes.iter().enumerate() {
        write_entry(&bench.path(&format!("prepared-{k}")), scene, PAPER);
        let text = format!("#!/bin/sh\ncp -r '{}' \"$7\"\n", bench.path(&format!("prepared-{k}")).display());
        let path = bench.path(&format!("python-{k}"));
        fs::write(&path, text).expect("script");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("executable");
    }
    std::thread::scope(|scope| {
        for (k, scene) in scenes.iter().enumerate() {
            let (python, store) = (bench.path(&format!("python-{k}")), &bench.store);
            scope.spawn(move || {
                for _ in 0..5 {
                    solve_with(&python, scene, PAPER, store, &Wish::default(), &mut |_| ()).expect("success");
                }
            });
        }
    });
    for scene in &scenes {
        assert!(matches!(bench.store.find(scene, PAPER), Lookup::Found(_)), "{:?}", bench.contents());
    }
}

#[test]
fn a_request_for_a_running_solution_waits_and_takes_it() {
    let bench = Bench::new();
    // a run ends when as many others wait for it as it is told to expect
    let count = r#"wc -l < "$here/others""#;
    let script = format!(
        "echo run >> \"$here/runs\"; while [ $({count}) -lt $(cat \"$here/wanted\") ]; do sleep 0.01; done; {COPY}"
    );
    let python = bench.solver(&script);
    let runs = || fs::read_to_string(bench.path("runs")).unwrap_or_default().lines().count();
    let other = || {
        let mut others = File::options().append(true).create(true).open(bench.path("others")).expect("file");
        writeln!(others, "other").expect("line");
    };
    let wanted = |count: &str| {
        fs::write(bench.path("others"), "").expect("file");
        fs::write(bench.path("wanted"), count).expect("file");
    };
    let solve = |wish: &Wish| {
        let mut waited = false;
        let mut progress = |p: &Progress| {
            if p.phase == "waiting" && !waited {
                waited = true;
                other();
            }
        };
        solve_with(&python, &scene(), PAPER, &bench.store, wish, &mut progress).expect("success");
        waited
    };
    let plain = Wish::default();
    wanted("2");
    let waited: usize = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..3).map(|_| scope.spawn(|| usize::from(solve(&plain)))).collect();
        workers.into_iter().map(|worker| worker.join().expect("thread")).sum()
    });
    assert_eq!((runs(), waited, bench.contents()), (1, 2, vec!["paper".to_owned()]));
    // what nobody computes is not waited for, and fields are everyone's own
    wanted("0");
    assert!(!solve(&plain));
    wanted("1");
    std::thread::scope(|scope| {
        scope.spawn(|| solve(&plain));
        wait_until(|| runs() == 3, || "the first run does not start".to_owned());
        let fields = Wish { fields: 4, ..Wish::default() };
        assert!(solve(&fields));
    });
    assert_eq!(runs(), 4);
}

#[test]
fn runs_at_once_leave_one_complete_entry() {
    let bench = Bench::new();
    let python = bench.solver(COPY);
    std::thread::scope(|scope| {
        let run = || solve_with(&python, &scene(), PAPER, &bench.store, &Wish::default(), &mut |_| ());
        let workers: Vec<_> = (0..6).map(|_| scope.spawn(move || (0..5).all(|_| run().is_ok()))).collect();
        for worker in workers {
            assert!(worker.join().expect("thread"));
        }
    });
    assert!(matches!(bench.store.find(&scene(), PAPER), Lookup::Found(_)));
    assert_eq!(bench.contents(), ["paper"]);
}

#[test]
fn the_solver_does_not_outlive_its_caller() {
    let bench = Bench::new();
    let step = r#"echo '{"phase":"mesh","done":0,"message":""}'"#;
    let python = bench.solver(&format!("{step}; sleep 4; touch \"$here/survived\""));
    let store = bench.store.clone();
    let stopped = std::thread::spawn(move || {
        let _ = solve_with(&python, &scene(), PAPER, &store, &Wish::default(), &mut |_| {
            panic!("the caller stops")
        });
    });
    // The caller waits for its child's end: one that was not killed has left its mark by then.
    assert!(stopped.join().is_err());
    assert!(!bench.path("survived").exists(), "the solver went on");
    assert_eq!(bench.contents(), [] as [&str; 0]);
}

#[test]
fn leftovers_of_dead_runs_go_and_those_of_living_ones_stay() {
    let bench = Bench::new();
    let parent = bench.store.root().join("scaled-plate-r10");
    let leftover = |name: &str, hours: u64, has_lock: bool| {
        let folder = parent.join(name);
        fs::create_dir_all(folder.join("result")).expect("folder");
        let lock = has_lock.then(|| File::create(folder.join("lock")).expect("lock"));
        let then = SystemTime::now() - Duration::from_secs(3600 * hours);
        File::open(&folder).and_then(|f| f.set_modified(then)).expect("time");
        lock
    };
    let living = leftover(".partial-living", 100, true).expect("lock");
    living.lock().expect("locked");
    drop(leftover(".partial-dead", 1, true));
    leftover(".partial-old", 25, false);
    leftover(".partial-unknown", 1, false);
    bench.solve(COPY).expect("success");
    assert_eq!(bench.contents(), [".partial-living", ".partial-unknown", "paper"]);
}

#[test]
fn a_store_that_can_not_be_written_is_named() {
    let bench = Bench::new();
    fs::write(bench.path("store"), "a file").expect("file");
    let error = bench.solve(COPY).expect_err("no store");
    assert_eq!(error.exit_status(), ExitStatus::Usage);
    assert!(flat(&error).contains("creating") && flat(&error).contains("store/scaled-plate-r10"), "{error}");
}

#[test]
fn an_interpreter_that_is_not_there_is_named() {
    let bench = Bench::new();
    let none = bench.path("none");
    let error = solve_with(&none, &scene(), PAPER, &bench.store, &Wish::default(), &mut |_| ())
        .expect_err("no interpreter");
    assert_eq!(error.exit_status(), ExitStatus::Solver);
    assert!(
        flat(&error).contains(&*none.to_string_lossy()) && flat(&error).contains("can't be run"),
        "{error}"
    );
}
