//! Sweeps from the command line: shards, kills, refusals, and what a series gives.

use super::program::{ROOT, THIN_PLATE, file, flat, impactcheck, json, text};
use crate::waiting::wait_until;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn sweep(folder: &Path, vary: &str) -> PathBuf {
    file(folder, "thin.toml", THIN_PLATE);
    file(folder, "sweep.toml", &format!("scene = \"thin.toml\"\n{vary}"))
}

const SMALL: &str = r#"
[[vary]]
fields = ["outer.radius", "inner.radius"]
from = "1 mm"
to = "2 mm"
count = 3
[[vary]]
field = "plate.thickness"
values = ["-1 mm", "0.2 mm", 0.0003]
"#;

#[test]
fn sweep_runs_every_point_and_reports_scenes_that_are_not_valid() {
    let folder = tempfile::tempdir().unwrap();
    let (plan, out) = (sweep(folder.path(), SMALL), folder.path().join("out"));
    let document = json(&["study", "sweep", text(&plan), "--out", text(&out), "--json"]);
    let columns: Vec<&str> =
        document["columns"].as_array().unwrap().iter().map(|c| c.as_str().unwrap()).collect();
    assert_eq!(
        columns[..6],
        ["index", "outer.radius", "inner.radius", "plate.thickness", "status", "efficiency"]
    );
    let rows = document["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 9);
    for (k, row) in rows.iter().enumerate() {
        let (radius, thickness) = ([1e-3, 1.5e-3, 2e-3][k / 3], [-1e-3, 0.2e-3, 0.3e-3][k % 3]);
        assert_eq!(row[0], k);
        assert_eq!((row[1].as_f64(), row[2].as_f64()), (Some(radius), Some(radius)));
        assert_eq!(row[3].as_f64(), Some(thickness));
        let reason = row.as_array().unwrap().last().unwrap();
        if thickness < 0.0 {
            assert!(row[4] == "invalid" && row[5].is_null(), "{row}");
            assert!(reason.as_str().unwrap().contains("plate.thickness"), "{row}");
        } else {
            assert!(row[4] == "ok" && reason.is_null(), "{row}");
            assert!((0.0..1.0).contains(&row[5].as_f64().unwrap()), "{row}");
        }
    }
    // a point of the sweep is the impact that `reduced` runs
    let scene = THIN_PLATE.replace("\"5 mm\", thickness = \"0.3 mm\"", "\"5 mm\", thickness = \"0.2 mm\"");
    let scene = file(folder.path(), "same.toml", &scene);
    let reduced = json(&["reduced", text(&scene), "--model", "B", "--json"]);
    let [alone, swept] = [&reduced["efficiency"], &rows[4][5]].map(|value| value.as_f64().unwrap());
    assert!((swept / alone - 1.0).abs() < 1e-4, "{swept} {alone}");
    let converged = columns.iter().position(|name| *name == "converged").unwrap();
    assert_eq!(rows[4][converged], 1.0);
    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    assert!(
        table.starts_with("index,outer.radius [m],inner.radius [m],plate.thickness [m],status,efficiency,")
    );
    assert_eq!(table.lines().count(), 10);
}

#[test]
fn shards_merge_into_the_table_of_the_whole_and_parquet_holds_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let plan = sweep(
        folder.path(),
        "sampling = \"latin-hypercube\"\nsamples = 40\nseed = 3\n\
         [[vary]]\nfield = \"plate.radius\"\nfrom = \"3 mm\"\nto = \"9 mm\"\nscale = \"log\"\n\
         [[vary]]\nfield = \"inner.gap\"\nfrom = \"-1 um\"\nto = \"3 um\"\n",
    );
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    assert_eq!(impactcheck(&["study", "sweep", text(&plan), "--out", text(&whole)]).status, 0);
    for shard in ["2/3", "3/3"] {
        let ended = impactcheck(&["study", "sweep", text(&plan), "--out", text(&parts), "--shard", shard]);
        assert_eq!(ended.status, 0, "{}", ended.error);
    }
    let early = impactcheck(&["study", "merge", text(&plan), "--out", text(&parts)]);
    assert_eq!(early.status, 2, "{}", early.error);
    assert!(early.error.contains("14 of 40") && !parts.join("sweep.csv").exists(), "{}", early.error);
    impactcheck(&["study", "sweep", text(&plan), "--out", text(&parts), "--shard", "1/3"]);
    let merged = json(&["study", "merge", text(&plan), "--out", text(&parts), "--json"]);
    assert_eq!(fs::read(whole.join("sweep.csv")).unwrap(), fs::read(parts.join("sweep.csv")).unwrap());

    let ended = impactcheck(&["study", "merge", text(&plan), "--out", text(&parts), "--format", "parquet"]);
    assert_eq!(ended.status, 0, "{}", ended.error);
    use parquet::file::reader::{FileReader, SerializedFileReader};
    let reader = SerializedFileReader::new(fs::File::open(parts.join("sweep.parquet")).unwrap()).unwrap();
    let mut count = 0;
    for (row, expected) in reader.get_row_iter(None).unwrap().zip(merged["rows"].as_array().unwrap()) {
        let cells: BTreeMap<String, parquet::record::Field> =
            row.unwrap().get_column_iter().map(|(name, field)| (name.clone(), field.clone())).collect();
        for (name, expected) in merged["columns"].as_array().unwrap().iter().zip(expected.as_array().unwrap())
        {
            use parquet::record::Field;
            let same = match &cells[name.as_str().unwrap()] {
                Field::Long(value) => expected.as_i64() == Some(*value),
                Field::Double(value) => expected.as_f64() == Some(*value),
                Field::Str(value) => expected.as_str().unwrap_or("") == value,
                Field::Null => expected.is_null(),
                other => panic!("{other:?}"),
            };
            assert!(same, "{name}: {:?}, expected {expected}", cells[name.as_str().unwrap()]);
        }
        count += 1;
    }
    assert_eq!(count, 40);
}

/// Points that have a record, each with how often.
fn recorded(dir: &Path) -> BTreeMap<usize, usize> {
    let mut seen = BTreeMap::new();
    let text = fs::read_to_string(dir.join("1-of-1.records")).unwrap_or_default();
    for line in text.lines().skip(1) {
        if let [_, index, "ok", ref rest @ ..] = line.split(' ').collect::<Vec<_>>()[..]
            && rest.len() == 14
        {
            *seen.entry(index.parse().unwrap()).or_insert(0) += 1;
        }
    }
    seen
}

#[test]
fn killed_sweep_resumes_without_losing_or_doubling_a_result() {
    const POINTS: usize = 3000;
    let folder = tempfile::tempdir().unwrap();
    let vary =
        format!("[[vary]]\nfield = \"plate.radius\"\nfrom = \"3 mm\"\nto = \"9 mm\"\ncount = {POINTS}\n");
    let (plan, out) = (sweep(folder.path(), &vary), folder.path().join("out"));
    let arguments = ["study", "sweep", text(&plan), "--out", text(&out)];
    let mut before = BTreeMap::new();
    for _ in 0..3 {
        let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("impactcheck"))
            .args(arguments)
            .spawn()
            .unwrap();
        let count = before.len();
        let recorded_now = || recorded(&out).len();
        wait_until(|| recorded_now() >= count + 100, || format!("{} records", recorded_now()));
        // SIGKILL: nothing of the program runs any more
        child.kill().unwrap();
        child.wait().unwrap();
        let now = recorded(&out);
        assert!(now.len() >= count + 100 && before.keys().all(|k| now.contains_key(k)), "{}", now.len());
        before = now;
    }
    // and a line torn in the middle, as a killed process may leave it
    let log = out.join("1-of-1.records");
    let mut bytes = fs::read(&log).unwrap();
    bytes.extend_from_slice(b"deadbeef 17 ok 1.5e0 2.5");
    fs::write(&log, bytes).unwrap();
    let finished = before.len();
    let ended = impactcheck(&arguments);
    assert_eq!(ended.status, 0, "{}", ended.error);
    assert!(ended.error.contains(&format!("{} of them run now", POINTS - finished)), "{}", ended.error);
    let all = recorded(&out);
    assert_eq!(all.len(), POINTS);
    assert!(all.values().all(|count| *count == 1), "none twice");
    let fresh = folder.path().join("fresh");
    assert_eq!(impactcheck(&["study", "sweep", text(&plan), "--out", text(&fresh)]).status, 0);
    assert_eq!(fs::read(out.join("sweep.csv")).unwrap(), fs::read(fresh.join("sweep.csv")).unwrap());
    // once more: nothing is left to do
    let again = impactcheck(&arguments);
    assert!(again.error.contains(" 0 of them run now"), "{}", again.error);
}

#[test]
fn sweep_files_that_make_no_sense_end_with_a_sentence_and_write_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let range = |field: &str, rest: &str| format!("[[vary]]\nfield = \"{field}\"\n{rest}\n");
    let cases = [
        (String::new(), 3, "missing field `vary`"),
        (range("plate.radius", "from = 1\nto = 2\ncount = 3\nsteps = 4"), 3, "steps"),
        (range("plate.radius", "from = 1\nto = 2"), 3, "count"),
        (range("plate.radius", "from = \"1 kg\"\nto = 2\ncount = 2"), 2, "1 kg"),
        (range("plate.radius", "from = 0\nto = 2\ncount = 2\nscale = \"log\""), 3, "positive"),
        (range("plate.radios", "values = [1]"), 2, "did you mean `plate.radius`?"),
        (range("plate.radius", "values = []"), 3, "values"),
        (range("plate.radius", "values = [1]") + &range("plate.radius", "values = [2]"), 3, "varied twice"),
        (format!("samples = 5\n{}", range("plate.radius", "values = [1]")), 3, "latin-hypercube"),
        (format!("model = \"D\"\n{}", range("plate.radius", "values = [1]")), 3, "A, B and C"),
        (format!("mesh = \"seat.vtu\"\n{}", range("plate.radius", "values = [1]")), 2, "is no seal seat"),
        (format!("tolerance = 1\n{}", range("plate.radius", "values = [1]")), 3, "tolerance"),
    ];
    let out = folder.path().join("out");
    for (vary, status, part) in cases {
        let plan = sweep(folder.path(), &vary);
        let ended = impactcheck(&["study", "sweep", text(&plan), "--out", text(&out)]);
        assert_eq!(ended.status, status, "{vary}: {}", ended.error);
        assert!(flat(&ended.error).contains(&flat(part)), "{vary}: {}", ended.error);
        assert!(ended.out.is_empty() && !out.exists());
    }
    let plan = sweep(folder.path(), SMALL);
    for arguments in [
        &["study", "sweep", "no-such.toml"][..],
        &["study", "sweep", text(&plan), "--shard", "4/3"],
        &["study", "sweep", text(&plan), "--format", "xls"],
        &["study", "sweep"],
        &["study"],
        &["study", "table2", "--model", "B"],
    ] {
        assert_eq!(impactcheck(arguments).status, 2, "{arguments:?}");
    }
    // a folder with the records of another sweep
    assert_eq!(impactcheck(&["study", "sweep", text(&plan), "--out", text(&out)]).status, 0);
    let other = sweep(folder.path(), &SMALL.replace("count = 3", "count = 4"));
    let ended = impactcheck(&["study", "sweep", text(&other), "--out", text(&out)]);
    assert_eq!(ended.status, 2, "{}", ended.error);
    assert!(ended.error.contains("another sweep"), "{}", ended.error);
}

/// Sweep and optimum of a series are those of its last impact, the steady state.
#[test]
fn sweep_and_optimum_of_a_series_are_those_of_its_steady_state() {
    let folder = tempfile::tempdir().unwrap();
    // the last of two impacts, of hard spheres: a quarter of the work
    let shipped = fs::read_to_string(format!("{ROOT}/scenes/examples/repeated-impacts.toml")).unwrap();
    assert!(shipped.contains("impacts = 20"));
    let (plate, spheres) = shipped.split_once("[outer]").unwrap();
    let hard =
        "[materials.hard]\nyoungs_modulus = \"210 GPa\"\npoisson_ratio = 0.3\ndensity = \"7780 kg/m^3\"\n";
    let spheres = spheres.replace("\"steel\"", "\"hard\"").replace("impacts = 20", "impacts = 2");
    let short = format!("{plate}{hard}[outer]{spheres}");
    let scene = text(&file(folder.path(), "short.toml", &short)).to_owned();
    let at = |thickness: &str| {
        let changed = short.replace("thickness = \"2 mm\"", &format!("thickness = {thickness}"));
        let scene = file(folder.path(), "changed.toml", &changed);
        let document = json(&["reduced", text(&scene), "--model", "B", "--json"]);
        let [first, steady] =
            [&document["impacts"][0], &document].map(|of| of["efficiency"].as_f64().unwrap());
        assert!(
            steady > first + 0.02 && document["elastic_limit"]["outer"].as_f64().unwrap() < 0.1,
            "{document}"
        );
        steady
    };
    let plan = file(
        folder.path(),
        "plan.toml",
        &format!(
            "scene = '{scene}'\nmodel = \"B\"\n[[vary]]\nfield = \"plate.thickness\"\nvalues = [2e-3, 3e-3]\n"
        ),
    );
    let out = folder.path().join("sweep");
    assert_eq!(impactcheck(&["study", "sweep", text(&plan), "--out", text(&out)]).status, 0);
    let mut table = csv::Reader::from_path(out.join("sweep.csv")).unwrap();
    let column = table.headers().unwrap().iter().position(|name| name == "efficiency").unwrap();
    let found: Vec<f64> = table.records().map(|row| row.unwrap()[column].parse().unwrap()).collect();
    for (found, thickness) in found.into_iter().zip(["2e-3", "3e-3"]) {
        assert!((found - at(thickness)).abs() < 2e-4, "{found} at {thickness}");
    }
    let arguments = ["--over", "plate.thickness=1.5mm..3mm", "--samples", "8", "--model", "B", "--json"];
    let best = json(&[&["optimise", scene.as_str()][..], &arguments].concat());
    let [thickness, efficiency] =
        [&best["variables"][0]["optimum"], &best["efficiency"]].map(|v| v.as_f64().unwrap());
    assert!((efficiency - at(&thickness.to_string())).abs() < 2e-4, "{best}");
}
