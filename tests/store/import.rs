//! Results of other programs become references: read with their units and signs, checked, kept with where they come from.

use impactcheck::Error;
use impactcheck::comparison::import;
use impactcheck::comparison::{Verdict, compare_scene};
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::reference::{Lookup, Resolution, Store};
use impactcheck::scene::{Model, Scene};
use std::fs;
use std::path::{Path, PathBuf};

fn recipe(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/import").join(file)
}

fn scene() -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/scaled-plate-r10.toml");
    Scene::read(file).expect("shipped scene")
}

/// Every recipe of the guide gives a reference that model C is judged by, and that knows where it comes from.
#[test]
fn recipes_give_references_that_models_are_judged_by() {
    let model = Reduced::new(&scene(), Model::C, None).expect("model").run_with_history(1e-7).expect("run");
    for (file, map, program) in
        [("abaqus.rpt", "abaqus.toml", "Abaqus/Explicit"), ("lsprepost.csv", "lsprepost.toml", "LS-DYNA")]
    {
        let folder = tempfile::tempdir().expect("folder");
        let store = Store::open(Some(folder.path()));
        let imported = import(&scene(), &recipe(file), Some(&recipe(map)), &store).expect(file);
        let Lookup::Found(stored) = store.find(&scene(), Resolution::Imported) else { panic!("{file}") };
        assert_eq!(stored.outcome, imported.outcome);
        assert_eq!(
            (&stored.provenance["program"], &stored.provenance["file"]),
            (&program.into(), &file.into())
        );
        let hash = impactcheck::scene::hash::sha256_hex(&fs::read(recipe(file)).expect("file"));
        assert_eq!(stored.provenance["file_sha256"], hash);
        let is_stated = !stored.outcome.summary.uncertainty.is_empty();
        assert_eq!(stored.provenance["uncertainty"] == "none stated", !is_stated, "{file}");
        let comparison = compare_scene(&scene(), &stored.outcome, std::slice::from_ref(&model));
        let judged = &comparison.models[0];
        for quantity in ["efficiency", "outer_velocity_final", "outer_force_peak", "outer_velocity_rms"] {
            let row = judged.discrepancy(quantity).expect(quantity);
            assert!(matches!(row.verdict, Verdict::Pass | Verdict::Undecided), "{file}: {row:?}");
        }
        // what the program does not state, such as the plate's frequency, can't be decided
        assert_eq!(judged.verdict, Verdict::Undecided, "{file}: {judged:?}");
        let open = judged.discrepancy("first_frequency").expect("a row");
        assert!(open.has_no_reference() && open.is_gated() && open.tolerance.is_none(), "{open:?}");
        assert!(open.would_decide.as_ref().is_some_and(|how| how.contains("has no value of it")));
        // it is not the reference of any other speed
        let text = fs::read_to_string(recipe("../../scenes/scaled-plate-r10.toml")).expect("scene");
        let faster = Scene::parse("faster", &text.replace("550 mm/s", "560 mm/s")).expect("valid");
        assert!(matches!(store.find(&faster, Resolution::Imported), Lookup::Stale { .. }));
        // and a changed file is damaged
        let history = stored.folder.join("history.csv");
        let text = fs::read_to_string(&history).expect("history");
        fs::write(&history, text.replacen("0e0", "1e0", 1)).expect("written");
        assert!(matches!(store.find(&scene(), Resolution::Imported), Lookup::Damaged { .. }));
    }
}

/// A wrong sign, unit, column or offset contradicts the scene; nothing is stored.
#[test]
fn faults_of_a_map_are_reported_and_nothing_is_stored() {
    let folder = tempfile::tempdir().expect("folder");
    let store = Store::open(Some(&folder.path().join("store")));
    let map = fs::read_to_string(recipe("abaqus.toml")).expect("map");
    for (from, to, part) in [
        ("column = 2, unit = \"mm/s\", sign = -1", "column = 2, unit = \"mm/s\"", "outer velocity start"),
        ("column = 2, unit = \"mm/s\"", "column = 2, unit = \"m/s\"", "outer velocity start"),
        ("column = 4, unit = \"N\"", "column = 4, unit = \"kN\"", "outer momentum balance"),
        ("column = 1, unit = \"s\"", "column = 1, unit = \"ms\"", "outer momentum balance"),
        (
            "column = 1, unit = \"s\"",
            "column = 1, unit = \"s\", offset = \"1 us\"",
            "t = 0 must be the first contact",
        ),
        ("column = 4, unit = \"N\"", "column = 4, unit = \"mm\"", "`mm` is the unit of something else"),
        ("column = 5", "column = 9", "there is no column 9"),
        ("sign = -1", "sign = -1000", "must be 1 or -1"),
        ("outer_force    =", "outer_forces   =", "did you mean `outer_force`?"),
        ("efficiency       = 0.001", "efficiency       = -0.001", "must be 0 or more"),
        ("efficiency       = 0.001", "efficency        = 0.001", "`efficency` is no quantity"),
        ("delimiter = \"spaces\"", "delimiter = \"spaces\"\nseparator = 1", "unknown field"),
    ] {
        assert!(map.contains(from), "{from}");
        let changed = folder.path().join("map.toml");
        fs::write(&changed, map.replacen(from, to, 1)).expect("written");
        let error = import(&scene(), &recipe("abaqus.rpt"), Some(&changed), &store).expect_err(part);
        assert!(matches!(error, Error::Reference(_)), "{error}");
        assert!(error.to_string().contains(part), "{part}: {error}");
    }
    // one heading over two columns
    let text = fs::read_to_string(recipe("lsprepost.csv")).expect("file");
    let twice = folder.path().join("twice.csv");
    fs::write(&twice, text.replacen("Mat-1", "Mat-3", 1)).expect("written");
    let error = import(&scene(), &twice, Some(&recipe("lsprepost.toml")), &store).expect_err("which one?");
    assert!(error.to_string().contains("several columns are called"), "{error}");
    assert_eq!(store.find(&scene(), Resolution::Imported), Lookup::Missing);
}

/// The velocities of both bodies as another program writes them, changed by `change`.
fn velocities(change: impl Fn(f64, f64, f64) -> (f64, f64, f64)) -> String {
    let run = Reduced::new(&scene(), Model::B, None).expect("model").run_with_history(5e-7).expect("run");
    let [outer, inner] = ["outer_velocity", "inner_velocity"].map(|name| &run.history[name]);
    let rows = run.history.time.iter().zip(outer.iter().zip(inner)).map(|(t, (v, w))| {
        let (t, v, w) = change(*t, *v, *w);
        format!("\n{t},{v},{w}")
    });
    // both fly on
    let flight: String = (1..=40)
        .map(|k| {
            let last = run.history.len() - 1;
            let (t, v, w) = change(run.history.time[last] + 5e-7 * f64::from(k), outer[last], inner[last]);
            format!("\n{t},{v},{w}")
        })
        .collect();
    format!("time,outer_velocity,inner_velocity{}{flight}\n", rows.collect::<String>())
}

/// Velocities alone, without forces to weigh them against.
#[test]
fn velocities_that_mechanics_forbids_are_refused() {
    let folder = tempfile::tempdir().expect("folder");
    let store = Store::open(Some(&folder.path().join("store")));
    let file = folder.path().join("velocities.csv");
    let imported = |text: String| {
        fs::write(&file, text).expect("written");
        import(&scene(), &file, None, &store)
    };
    for (what, text, law) in [
        ("a body twice as fast", velocities(|t, v, w| (t, v, 2.0 * w)), "energy gained"),
        ("a wrong sign", velocities(|t, v, w| (t, v, -w)), "inner velocity direction"),
        ("microseconds", velocities(|t, v, w| (1e6 * t, v, w)), "outer push time"),
        ("milliseconds", velocities(|t, v, w| (1e3 * t, v, w)), "outer depth"),
    ] {
        let error = imported(text).expect_err(what).to_string();
        assert!(error.contains(law) && error.contains("nothing is stored"), "{what}: {error}");
    }
    assert_eq!(store.find(&scene(), Resolution::Imported), Lookup::Missing);
    // a byte order mark before the headings, and Fortran's exponents
    let right = velocities(|t, v, w| (t, v, w)).replace("\n0,-0.55,", "\n0.0D+00,-5.5D-01,");
    assert!(right.contains("D-01"));
    let stored = imported(format!("\u{feff}{right}")).expect("stored").outcome;
    assert!((stored.summary.value("efficiency").expect("shown") - 0.6960).abs() < 1e-3);
}

/// A line keeps its number, whatever was skipped before it.
#[test]
fn an_unreadable_value_is_reported_with_its_line() {
    let folder = tempfile::tempdir().expect("folder");
    let text = fs::read_to_string(recipe("abaqus.rpt")).expect("report");
    let line = text.lines().nth(9).expect("a row");
    let file = folder.path().join("abaqus.rpt");
    fs::write(&file, text.replacen(line, &line.replacen("E+02", "E+0x", 1), 1)).expect("written");
    let store = Store::open(Some(&folder.path().join("store")));
    let error = import(&scene(), &file, Some(&recipe("abaqus.toml")), &store).expect_err("no number");
    assert!(error.to_string().contains("line 10: outer_velocity is"), "{error}");
}
