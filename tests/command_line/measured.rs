//! Measured files as a third partner of a comparison.

use super::program::{file, flat, impactcheck, json, text};
use std::fs;
use std::path::{Path, PathBuf};

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
fn compare_takes_measured_files_as_a_third_comparator() {
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
    let comparators: Vec<&str> =
        found["partners"].as_array().unwrap().iter().map(|p| p["partner"].as_str().unwrap()).collect();
    assert_eq!(comparators, ["reference", "B", "C"]);
    for kind in ["measured", "efficiencies"] {
        for extension in ["svg", "png"] {
            assert!(out.join(format!("scaled-plate-r10-{kind}.{extension}")).is_file());
        }
    }
    let page = fs::read_to_string(out.join("scaled-plate-r10.html")).unwrap();
    assert!(page.contains("Measurement") && page.contains("first.csv") && page.contains("free flight"));
    assert!(fs::read_to_string(out.join("comparison.md")).unwrap().contains("### Measurement"));
}

/// The channels of one impact in two files with one clock are one record; a channel in both is refused.
#[test]
fn files_of_one_impact_are_joined() {
    let folder = tempfile::tempdir().unwrap();
    let both = fs::read_to_string(measured(folder.path(), "both.csv", 5.0)).unwrap();
    let part = |name: &str, column: usize, skip: usize| {
        let rows = both.lines().enumerate().filter(|(k, _)| *k == 0 || *k > skip);
        let rows = rows.map(|(_, row)| {
            let cells: Vec<&str> = row.split(',').collect();
            format!("{},{}", cells[0], cells[column])
        });
        file(folder.path(), name, &rows.collect::<Vec<_>>().join("\n"))
    };
    let (outer, inner) = (part("outer.csv", 1, 0), part("inner.csv", 2, 40));
    let out = folder.path().join("report");
    let named = |second: &Path| format!("{}+{}", text(&outer), text(second));
    let arguments = |joined: &str| {
        ["compare", "scaled-plate-r10", "--models", "C", "--measured", joined, "--out", text(&out), "--json"]
            .map(str::to_owned)
    };
    let joined = arguments(&named(&inner));
    let found = &json(&joined.each_ref().map(String::as_str))["scenes"][0]["measured"];
    assert_eq!(found["records"].as_array().unwrap().len(), 1);
    assert!((found["records"][0]["efficiency"].as_f64().unwrap() - 0.6946).abs() < 0.001, "{found}");
    let twice = arguments(&named(&outer));
    let ended = impactcheck(&twice.each_ref().map(String::as_str));
    assert_eq!(ended.status, 3, "{}", ended.error);
    assert!(
        flat(&ended.error).contains(&flat("outer_velocity is in both files of one impact")),
        "{}",
        ended.error
    );
}

/// A history that the program has written begins with the first touch and ends with the last: it has no free flights.
#[test]
fn a_history_of_the_program_is_a_record() {
    let folder = tempfile::tempdir().unwrap();
    let (history, out) = (folder.path().join("history.csv"), folder.path().join("report"));
    json(&["reduced", "scaled-plate-r10", "--model", "B", "--history", text(&history), "--json"]);
    let document = json(&[
        "compare",
        "scaled-plate-r10",
        "--models",
        "B",
        "--measured",
        text(&history),
        "--out",
        text(&out),
        "--json",
    ]);
    let found = &document["scenes"][0]["measured"];
    let of_b = &found["partners"][1];
    assert!(of_b["efficiency_difference"].as_f64().unwrap().abs() < 1e-4, "{found}");
    assert!(found["records"][0]["shift"].as_f64().unwrap().abs() < 2e-6, "{found}");
}

/// Models and measurement need no reference: a store without one. The page has both.
#[test]
fn measured_files_are_compared_with_the_models_alone() {
    let folder = tempfile::tempdir().unwrap();
    let record = measured(folder.path(), "record.csv", 5.0);
    let scene = include_str!("../../scenes/scaled-plate-r10.toml").replace("scaled-plate-r10", "mine");
    let scene = file(folder.path(), "mine.toml", scene.split("# The gate.").next().unwrap());
    let out = folder.path().join("report");
    let arguments =
        ["compare", text(&scene), "--models", "A,C", "--measured", text(&record), "--out", text(&out)];
    let document = json(&[&arguments[..], &["--json"]].concat());
    let found = &document["measured"];
    assert_eq!((&found["aligned_with"], &document["scene"]), (&"C".into(), &"mine".into()));
    assert!((found["records"][0]["efficiency"].as_f64().unwrap() - 0.6946).abs() < 0.001, "{found}");
    let ended = impactcheck(&arguments);
    assert_eq!(ended.status, 0, "{}", ended.error);
    assert!(flat(&ended.error).contains(&flat("page: ")) && !out.join("index.html").exists());
    let page = fs::read_to_string(out.join("mine-measured.html")).unwrap();
    let [models, measurement] = ["id=\"models\"", "id=\"measurement\""].map(|part| page.find(part).unwrap());
    assert!(models < measurement && page.contains("record.csv") && page.contains("Measured and computed"));
    assert!(out.join("mine-measured.svg").is_file() && out.join("mine-measured.png").is_file());
    let line =
        |name: &str| ended.out.lines().find(|line| line.trim_start().starts_with(name)).unwrap().to_owned();
    assert!(line("C ").contains("within") && line("A ").contains("model error shown"), "{}", ended.out);
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
        (vec!["--measured", text(&good)], 2, "exactly one scene"),
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
    let seat =
        ["compare", "seal-seat-initial", "--models", "C", "--measured", text(&good), "--out", text(&out)];
    let ended = impactcheck(&seat);
    assert_eq!(ended.status, 3, "{}", ended.error);
    assert!(flat(&ended.error).contains(&flat("of kind `plate-impact` or `impact` only")), "{}", ended.error);
}

/// Files that are no records: one sentence each, and nothing is read of them that need not be.
#[test]
fn a_file_that_is_no_record_ends_in_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let table = fs::read(measured(folder.path(), "good.csv", 0.0)).unwrap();
    let rubbish: Vec<u8> = (0..9000_u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    let numbers = (0..90).map(|k| format!("{k}.5\n")).collect::<String>();
    for (name, bytes) in [
        ("empty.csv", &b""[..]),
        ("rubbish.csv", &rubbish),
        ("nul.csv", &[&table[..40], &[0; 8], &table[40..]].concat()),
        ("column.csv", numbers.as_bytes()),
        ("words.csv", b"nothing but\nwords\n"),
        ("large.csv", &table),
        ("cut.001", b"Channel code :A\nUnit :m/s\nSampling interval :1E-6\nNumber of samples :9\n1.0\n"),
        ("nodout", b" n o d a l   p r i n t   o u t   f o r   t i m e  s t e p  1  ( at time 0.0E+00 )\n nodal point  z-vel\n  5  x\n"),
    ] {
        fs::write(path(name), bytes).unwrap();
    }
    // takes no place on the disk
    fs::File::options().write(true).open(path("large.csv")).unwrap().set_len(3_000_000_000).unwrap();
    fs::create_dir(path("folder.csv")).unwrap();
    for (name, status, part) in [
        ("empty.csv", 3, "empty.csv: is empty"),
        ("rubbish.csv", 3, "rubbish.csv: is no text: it has the character U+00"),
        ("nul.csv", 3, "nul.csv: is no text: it has the character U+0000"),
        ("column.csv", 3, "column.csv: has one column of numbers"),
        ("words.csv", 3, "words.csv: has no columns of numbers"),
        ("large.csv", 3, "large.csv: has 3000000000 bytes; at most 2000000000 are read of a text"),
        ("cut.001", 3, "cut.001: as ISO-MME: has 1 samples, its header states 9"),
        ("nodout", 3, "nodout: as LS-DYNA nodout: line 3: node 5 has `x`, not numbers"),
        ("folder.csv", 2, "folder.csv is no file; name a file with a record"),
    ] {
        let named = path(name);
        let ended =
            impactcheck(&["compare", "scaled-plate-r10", "--models", "B", "--measured", text(&named)]);
        assert_eq!(ended.status, status, "{name}: {}", ended.error);
        assert!(flat(&ended.error).contains(&flat(part)), "{name}: {}", ended.error);
        assert!(ended.out.is_empty() && ended.error.lines().count() < 12, "{name}: {}", ended.error);
    }
}
