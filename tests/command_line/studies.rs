//! Sweeps, optimisation, studies and measured files from the command line: results, exit statuses, nothing half-written.

use assert_cmd::Command;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

struct Ended {
    status: i32,
    out: String,
    error: String,
}

fn impactcheck(arguments: &[&str]) -> Ended {
    let output = Command::cargo_bin("impactcheck")
        .unwrap()
        .args(arguments)
        .current_dir(ROOT)
        .env_remove("IMPACTCHECK_STORE")
        .env("IMPACTCHECK_PYTHON", "/no/such/python3")
        .output()
        .unwrap();
    Ended {
        status: output.status.code().expect("ended by itself"),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        error: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// Text without the line breaks of a message's frame.
fn flat(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace() && *c != '│').collect()
}

fn json(arguments: &[&str]) -> Value {
    let ended = impactcheck(arguments);
    assert_eq!(ended.status, 0, "{arguments:?}: {}", ended.error);
    serde_json::from_str(&ended.out).expect("one JSON document")
}

fn file(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Fig. 16's impact.
const THIN_PLATE: &str = r#"
name = "thin-plate-r1.5"
kind = "plate-impact"
materials.steel = { youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = "7780 kg/m^3" }
materials.titanium = { youngs_modulus = "115 GPa", poisson_ratio = 0.37, density = "4430 kg/m^3" }
plate = { radius = "5 mm", thickness = "0.3 mm", edge = "clamped", material = "titanium" }
outer = { kind = "sphere", radius = "1.5 mm", material = "steel", speed = "500 mm/s" }
inner = { kind = "sphere", radius = "1.5 mm", material = "steel" }
"#;

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
    let reduced = json(&["reduced", text(&scene), "--model", "B", "--tolerance", "1e-3", "--json"]);
    assert_eq!(reduced["efficiency"], rows[4][5]);
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
            && rest.len() == 13
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
        let (start, count) = (Instant::now(), before.len());
        while recorded(&out).len() < count + 100 && start.elapsed() < Duration::from_secs(20) {
            std::thread::sleep(Duration::from_millis(5));
        }
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
    let kept = before.len();
    let ended = impactcheck(&arguments);
    assert_eq!(ended.status, 0, "{}", ended.error);
    assert!(ended.error.contains(&format!("{} of them run now", POINTS - kept)), "{}", ended.error);
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

#[test]
fn optimum_of_fig_16_with_its_neighbourhood() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (file(folder.path(), "thin.toml", THIN_PLATE), folder.path().join("out"));
    let document =
        json(&["optimise", text(&scene), "--over", "plate.radius=2mm..10mm", "--out", text(&out), "--json"]);
    let variable = &document["variables"][0];
    let (best, range) = (variable["optimum"].as_f64().unwrap(), &variable["range_within_1_percent"]);
    // the paper: 5.5 mm
    assert!((best - 5.5e-3).abs() < 0.25e-3, "{document}");
    assert!(range[0].as_f64().unwrap() < best && best < range[1].as_f64().unwrap());
    assert!(variable["curvature"].as_f64().unwrap() < 0.0 && variable["on_bound"] == false);
    let efficiency = document["efficiency"].as_f64().unwrap();
    for point in variable["profile"].as_array().unwrap() {
        assert!(point[1].as_f64().unwrap() <= efficiency, "{point}");
    }
    for name in ["optimum.json", "optimum.svg", "optimum.png"] {
        assert!(fs::metadata(out.join(name)).unwrap().len() > 100);
    }
    // model C runs there too, as by itself
    let by_c = json(&["reduced", text(&out.join("optimum.toml")), "--model", "C", "--json"]);
    let confirmed = document["confirmation"]["efficiency"].as_f64().unwrap();
    assert!((by_c["efficiency"].as_f64().unwrap() - confirmed).abs() < 1e-4, "{confirmed} {by_c}");
    // the scene it writes has this efficiency
    let again = json(&["reduced", text(&out.join("optimum.toml")), "--model", "B", "--json"]);
    assert_eq!(again["efficiency"].as_f64(), Some(efficiency));
}

#[test]
fn optimum_is_verified_by_the_reference_or_its_lack_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let scene = file(folder.path(), "thin.toml", THIN_PLATE);
    let store = folder.path().join("store");
    let arguments = [
        "optimise",
        text(&scene),
        "--over",
        "plate.radius=5mm..6mm",
        "--verify",
        "--json",
        "--store",
        text(&store),
    ];
    let ended = impactcheck(&arguments);
    assert_eq!(ended.status, 12, "{}", ended.error);
    let document: Value = serde_json::from_str(&ended.out).expect("the optimum all the same");
    assert_eq!(document["verification"]["verdict"], "missing");
    assert!(document["verification"]["missing"].as_str().unwrap().contains("/no/such/python3"), "{document}");
    for over in [
        "plate.radius",
        "plate.radius=1mm",
        "plate.radius=6mm..5mm",
        "plate.radius=-1mm..5mm",
        "plate.radius=1kg..2kg",
        "plate.radios=1mm..2mm",
        "reduced.modes=1..5",
        "plate.radius,outer.speed=1..2",
    ] {
        let ended = impactcheck(&["optimise", text(&scene), "--over", over]);
        assert_eq!(ended.status, 2, "{over}: {}", ended.error);
        assert!(
            ended.error.contains("plate.") || ended.error.contains("reduced.modes"),
            "{over}: {}",
            ended.error
        );
    }
    let twice =
        ["optimise", text(&scene), "--over", "plate.radius=5mm..6mm", "--over", "plate.radius=5mm..7mm"];
    assert_eq!(impactcheck(&twice).status, 2);
}

/// Sweep and optimum of a series are those of its last impact, the steady state.
#[test]
fn sweep_and_optimum_of_a_series_are_those_of_its_steady_state() {
    let folder = tempfile::tempdir().unwrap();
    let scene = format!("{ROOT}/scenes/examples/repeated-impacts.toml");
    let at = |thickness: &str| {
        let changed = fs::read_to_string(&scene)
            .unwrap()
            .replace("thickness = \"2 mm\"", &format!("thickness = {thickness}"));
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
    let best = json(&["optimise", &scene, "--over", "plate.thickness=1.5mm..3mm", "--model", "B", "--json"]);
    let [thickness, efficiency] =
        [&best["variables"][0]["optimum"], &best["efficiency"]].map(|v| v.as_f64().unwrap());
    assert!((efficiency - at(&thickness.to_string())).abs() < 2e-4, "{best}");
}

/// A record of model C, without noise, with the clock `shift` us ahead.
fn measured(folder: &Path, name: &str, shift: f64) -> PathBuf {
    let history = folder.join("history.csv");
    let arguments = ["reduced", "scaled-plate-r10", "--model", "C", "--history", text(&history), "--json"];
    let summary = json(&arguments);
    let mut rows = vec!["time [us],outer_velocity [mm/s],inner_velocity [mm/s]".to_owned()];
    rows.extend((0..200).map(|k| format!("{},-550,0", f64::from(k) - 200.0 + shift)));
    let mut reader = csv::Reader::from_path(&history).unwrap();
    let headers = reader.headers().unwrap().clone();
    let column = |name: &str| headers.iter().position(|h| h == name).unwrap();
    let (time, outer, inner) = (column("time"), column("outer_velocity"), column("inner_velocity"));
    let mut last = 0.0;
    for row in reader.records().step_by(4) {
        let row = row.unwrap();
        let number = |k: usize| row[k].parse::<f64>().unwrap();
        last = 1e6 * number(time);
        rows.push(format!("{},{},{}", last + shift, 1e3 * number(outer), 1e3 * number(inner)));
    }
    let finals = ["outer_velocity_final", "inner_velocity_final"].map(|q| 1e3 * summary[q].as_f64().unwrap());
    rows.extend((1..200).map(|k| format!("{},{},{}", last + f64::from(k) + shift, finals[0], finals[1])));
    file(folder, name, &rows.join("\n"))
}

#[test]
fn compare_takes_measured_files_as_a_third_partner() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) =
        (measured(folder.path(), "first.csv", 5.0), measured(folder.path(), "second.csv", -3.0));
    let out = folder.path().join("report");
    let both = format!("{},{}", text(&first), text(&second));
    let document = json(&[
        "compare",
        "scaled-plate-r10",
        "--models",
        "B,C",
        "--measured",
        &both,
        "--out",
        text(&out),
        "--json",
    ]);
    let found = &document["scenes"][0]["measured"];
    for (record, shift) in found["records"].as_array().unwrap().iter().zip([5e-6, -3e-6]) {
        assert!((record["shift"].as_f64().unwrap() - shift).abs() < 0.1e-6, "{record}");
        assert!((record["efficiency"].as_f64().unwrap() - 0.6946).abs() < 0.001, "{record}");
    }
    assert_eq!(found["efficiency"]["count"], 2);
    assert!(found["rule"].as_str().unwrap().contains("free flight"));
    let partners: Vec<&str> =
        found["partners"].as_array().unwrap().iter().map(|p| p["partner"].as_str().unwrap()).collect();
    assert_eq!(partners, ["reference", "B", "C"]);
    for kind in ["measured", "efficiencies"] {
        for extension in ["svg", "png"] {
            assert!(out.join(format!("scaled-plate-r10-{kind}.{extension}")).is_file());
        }
    }
    let page = fs::read_to_string(out.join("scaled-plate-r10.html")).unwrap();
    assert!(page.contains("Measurement") && page.contains("first.csv") && page.contains("free flight"));
    assert!(fs::read_to_string(out.join("comparison.md")).unwrap().contains("### Measurement"));
}

#[test]
fn bad_measured_files_end_with_2_or_3_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let good = measured(folder.path(), "good.csv", 0.0);
    let wrong = file(folder.path(), "wrong.csv", "time [kg],outer_velocity\n1,2\n");
    let late: Vec<String> = (0..90).map(|k| format!("{k},{},{}", -500 + 3 * k, 5 * k)).collect();
    let header = "time [us],outer_velocity [mm/s],inner_velocity [mm/s]\n";
    let late = file(folder.path(), "late.csv", &(header.to_owned() + &late.join("\n")));
    let out = folder.path().join("report");
    for (arguments, status, part) in [
        (vec!["scaled-plate-r10", "--measured", "no-such.csv"], 2, "no-such.csv"),
        (vec!["scaled-plate-r10", "--measured", text(&wrong)], 3, "wrong.csv"),
        (vec!["scaled-plate-r10", "--measured", text(&late)], 3, "late.csv"),
        (vec!["--measured", text(&good)], 2, "exactly one plate impact"),
        (vec!["scaled-plate-r10", "--measured", text(&good), "--bandwidth", "3 mm"], 2, "bandwidth"),
        (vec!["scaled-plate-r10", "--measured", text(&good), "--bandwidth", "1 Hz"], 2, "bandwidth"),
        (vec!["scaled-plate-r10", "--measured", text(&good), "--speed", "guess"], 2, "speed"),
    ] {
        let all: Vec<&str> =
            ["compare"].into_iter().chain(arguments).chain(["--out", text(&out), "--models", "B"]).collect();
        let ended = impactcheck(&all);
        assert_eq!(ended.status, status, "{all:?}: {}", ended.error);
        assert!(flat(&ended.error).contains(&flat(part)), "{all:?}: {}", ended.error);
        assert!(ended.out.is_empty() && !out.exists(), "{all:?}");
    }
}
