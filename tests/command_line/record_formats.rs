//! Text formats of instruments and other programs: a record of model C in each gives its efficiency.

use super::program::{file, flat, impactcheck, json, text};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Efficiency of `scaled-plate-r10` by model C, and the mass of its inner sphere in kg.
const EFFICIENCY: f64 = 0.6946;
const MASS: f64 = 7780.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6;
/// Start and interval of the samples, s; the first touch is at 0.
const START: f64 = -200e-6;
const INTERVAL: f64 = 0.2e-6;

/// Velocities of outer and inner body in m/s at even times, with free flight on both sides.
fn velocities(folder: &Path) -> Vec<[f64; 2]> {
    let history = folder.join("history.csv");
    let summary =
        json(&["reduced", "scaled-plate-r10", "--model", "C", "--history", text(&history), "--json"]);
    let mut reader = csv::Reader::from_path(&history).unwrap();
    let headers = reader.headers().unwrap().clone();
    let places = ["time", "outer_velocity", "inner_velocity"];
    let places = places.map(|name| headers.iter().position(|heading| heading == name).unwrap());
    let rows: Vec<[f64; 3]> = reader
        .records()
        .map(|row| row.unwrap())
        .map(|row| places.map(|place| row[place].parse().unwrap()))
        .collect();
    let finals = ["outer_velocity_final", "inner_velocity_final"].map(|name| summary[name].as_f64().unwrap());
    let at = |t: f64| match rows.partition_point(|row| row[0] <= t) {
        0 => [-0.55, 0.0],
        k if k == rows.len() => finals,
        k => {
            let (a, b) = (rows[k - 1], rows[k]);
            let s = (t - a[0]) / (b[0] - a[0]);
            [1, 2].map(|c| a[c] + s * (b[c] - a[c]))
        }
    };
    (0..2500).map(|k| at(START + INTERVAL * f64::from(k))).collect()
}

/// What `compare` says of the record in `named`, read by `map`.
fn compared(folder: &Path, named: &Path, map: &str) -> (Value, String) {
    let (out, map) = (folder.join("report"), file(folder, "map.toml", map));
    let arguments =
        ["compare", "scaled-plate-r10", "--models", "B", "--measured", text(named), "--out", text(&out)];
    let ended = impactcheck(&[&arguments[..], &["--json", "--map", text(&map)]].concat());
    assert_eq!(ended.status, 0, "{}", ended.error);
    let document: Value = serde_json::from_str(&ended.out).unwrap();
    (document["scenes"][0]["measured"]["records"][0].clone(), ended.error)
}

fn assert_read(record: &Value, shift: f64) {
    let efficiency = record["efficiency"].as_f64().unwrap();
    assert!((efficiency - EFFICIENCY).abs() < 0.001, "{record}");
    assert!((record["shift"].as_f64().unwrap() - shift).abs() < 0.1e-6, "{record}");
}

/// `nodout`, in tonnes, millimetres and seconds, with a title, a legend and a block of rotations per time; `matsum` of both spheres.
#[test]
fn ls_dyna_text_is_read_by_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let head = " a plate impact                                       ls-dyna mpp.1 date 11/27/2026\n\n {BEGIN LEGEND}\n  \
                Entity #        Title\n          7     outer\n {END LEGEND}\n";
    let (mut nodes, mut parts) = (head.to_owned(), head.to_owned());
    for (k, [outer, inner]) in velocities(folder.path()).into_iter().enumerate() {
        let t = INTERVAL * k as f64;
        let step = format!(
            "\n\n\n n o d a l   p r i n t   o u t   f o r   t i m e  s t e p{k:8}                              ( at time{t:14.7E} )\n\n"
        );
        let _ = writeln!(
            nodes,
            "{step} nodal point  x-disp     y-disp      z-disp      x-vel       y-vel       z-vel"
        );
        for (node, velocity) in [(7, outer), (4012, inner)] {
            let _ = writeln!(
                nodes,
                "{node:9} 0.0000E+00  0.0000E+00  0.0000E+00  0.0000E+00-1.0000E-09{:12.4E}",
                1e3 * velocity
            );
        }
        let _ = writeln!(
            nodes,
            "{step} nodal point  x-rot      y-rot       z-rot\n        7  0.0000E+00  0.0000E+00  0.0000E+00"
        );
        let _ = writeln!(parts, "\n\n time ={t:13.4E}");
        for (part, velocity) in [(1, outer), (3, inner)] {
            let _ = writeln!(
                parts,
                " mat.#={part:5}             inten=   1.0000E-03     kinen=   1.0000E-03     eroded_ie=   0.0000E+00\n \
                x-mom=   0.0000E+00     y-mom=   0.0000E+00     z-mom=   0.0000E+00\n x-rbv=   0.0000E+00     y-rbv=   0.0000E+00     z-rbv={velocity:13.4E}"
            );
        }
    }
    let nodout = file(folder.path(), "nodout", &nodes);
    let map = "[columns]\nouter_velocity = { column = \"node 7 z-vel\", unit = \"mm/s\" }\n\
               inner_velocity = { column = \"node 4012 z-vel\", unit = \"mm/s\" }\n";
    let (record, said) = compared(folder.path(), &nodout, map);
    assert_read(&record, -START);
    assert!(flat(&said).contains(&flat("not used: node 7 x-disp")), "{said}");
    let matsum = file(folder.path(), "matsum", &parts);
    let map = "[columns]\nouter_velocity = { column = \"part 1 z-rbv\" }\ninner_velocity = { column = \"part 3 z-rbv\" }\n";
    assert_read(&compared(folder.path(), &matsum, map).0, -START);
    // without a map the message lists what there is
    let ended = impactcheck(&["compare", "scaled-plate-r10", "--measured", text(&nodout)]);
    assert_eq!(ended.status, 3, "{}", ended.error);
    assert!(flat(&ended.error).contains(&flat("node 7 z-vel")), "{}", ended.error);
}

/// What `th_to_csv` writes, in kg, mm and ms: padded titles in quotation marks; a contact's force is its impulse, from which the efficiency
/// follows.
#[test]
fn openradioss_impulses_become_forces() {
    let folder = tempfile::tempdir().unwrap();
    let title = |name: &str| format!("\"NODE      7 {name:<24} var 14\"");
    let mut rows = format!(
        "\"time\",\"INTERNAL ENERGY\",\"KINETIC ENERGY\",\"TIME STEP\",{},\"INTER 2 {:<24}  FNZ        \"\n",
        title("sphere  outer"),
        "behind"
    );
    for (k, [outer, inner]) in velocities(folder.path()).into_iter().enumerate() {
        // the impulse on the inner body: it flies off along -z
        let impulse = -MASS * inner;
        let _ = writeln!(
            rows,
            "{:.6},0.000000,0.004930,0.000010,{outer:.6},{impulse:.9}",
            1e3 * INTERVAL * k as f64
        );
    }
    let csv = file(folder.path(), "plateT01.csv", &rows);
    let map = |kind: &str| {
        format!(
            "[columns]\ntime = {{ column = \"time\", unit = \"ms\" }}\nouter_velocity = {{ column = \"NODE 7 sphere outer var 14\" }}\n\
             inner_force = {{ column = \"INTER 2 behind FNZ\", {kind} = \"impulse\", unit = \"N*s\" }}\n"
        )
    };
    for kind in ["kind", "quantity"] {
        assert_read(&compared(folder.path(), &csv, &map(kind)).0, -START);
    }
}

/// A test in ISO-MME, named by its header, needs no map if its channels have the names of curves; a channel may be called by its code.
#[test]
fn iso_mme_is_read_by_the_header_of_the_test() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("Channel")).unwrap();
    let rows = velocities(folder.path());
    let head = |code: &str, name: &str| {
        format!(
            "Test object number          :1\nName of the channel         :{name}\nChannel code                :{code}\n\
             Unit                        :mm/s\nReference channel           :implicit\nReference channel name      :NOVALUE\n\
             Sampling interval           :{INTERVAL:.6E}\nBit resolution              :NOVALUE\n\
             Time of first sample        :{START:.6E}\nNumber of samples           :{}\n",
            rows.len()
        )
    };
    for (k, (code, name)) in
        [("11TIPX000000VEZP", "outer_velocity"), ("12TIPX000000VEZP", "inner_velocity")].iter().enumerate()
    {
        let values: String = rows.iter().map(|row| format!("{:.6E}\n", 1e3 * row[k])).collect();
        file(folder.path(), &format!("Channel/impact.00{}", k + 1), &(head(code, name) + &values));
    }
    let test = file(
        folder.path(),
        "impact.mme",
        "Data format edition number  :1.6\nLaboratory name             :NOVALUE\nNumber of media             :1\n",
    );
    assert_read(&compared(folder.path(), &test, "").0, 0.0);
    let map = "[columns]\nouter_velocity = { column = \"11TIPX000000VEZP\" }\ninner_velocity = { column = \"inner_velocity\" }\n";
    assert_read(&compared(folder.path(), &test, map).0, 0.0);
    // one channel, by its own file
    let (record, _) = compared(folder.path(), &folder.path().join("Channel/impact.002"), "");
    assert_read(&record, 0.0);
    assert_eq!(record["channels"].as_array().unwrap().len(), 1);
}

/// Rigol's oscilloscopes number the samples; start and interval stand in the header, which the map that is saved leaves there.
#[test]
fn start_and_interval_in_a_header_need_no_map() {
    let folder = tempfile::tempdir().unwrap();
    let velocities = velocities(folder.path());
    let table = |names: &str, units: &str, scale: f64| {
        let mut rows =
            format!("X,{names},Start,Increment,\r\nSequence,{units},{START:.6e},{INTERVAL:.6e}\r\n");
        for (k, [outer, inner]) in velocities.iter().enumerate() {
            let _ = write!(rows, "{k},{:.4e},{:.4e},\r\n", scale * outer, scale * inner);
        }
        rows
    };
    let scope = file(folder.path(), "NewFile1.csv", &table("CH1,CH2", "Volt,Volt", 2.0));
    let map = "[columns]\nouter_velocity = { column = \"CH1\", sensitivity = \"500 mm/s/V\" }\n\
               inner_velocity = { column = \"CH2\", sensitivity = \"500 mm/s/V\" }\n";
    let (record, said) = compared(folder.path(), &scope, map);
    assert_read(&record, 0.0);
    assert!(flat(&said).contains(&flat("interval 0.2000 µs from the header")), "{said}");
    let named = file(folder.path(), "named.csv", &table("outer_velocity,inner_velocity", "m/s,m/s", 1.0));
    let (saved, out) = (folder.path().join("saved.toml"), folder.path().join("report"));
    let arguments =
        ["compare", "scaled-plate-r10", "--models", "C", "--measured", text(&named), "--out", text(&out)];
    json(&[&arguments[..], &["--json", "--save-map", text(&saved)]].concat());
    let saved = fs::read_to_string(saved).unwrap();
    assert!(!saved.contains("[time]") && !saved.contains("time ="), "{saved}");
    assert_read(&compared(folder.path(), &named, &saved).0, 0.0);
}

/// What CalculiX prints per set of nodes; another program's `.dat` is a table.
#[test]
fn calculix_prints_are_records() {
    let folder = tempfile::tempdir().unwrap();
    let (mut printed, mut table) = (String::new(), "time;outer_velocity;inner_velocity\n".to_owned());
    for (k, [outer, inner]) in velocities(folder.path()).into_iter().enumerate() {
        let t = INTERVAL * k as f64;
        for (set, velocity) in [("NOUTER", outer), ("NINNER", inner)] {
            let _ = writeln!(
                printed,
                "\n velocities (vx,vy,vz) for set {set} and time  {t:.7E}\n\n         1  0.000000E+00  0.000000E+00 {velocity:13.6E}\n         2  0.000000E+00  0.000000E+00 {velocity:13.6E}"
            );
        }
        let _ = writeln!(table, "{t:e};{outer:.7};{inner:.7}");
    }
    let dat = file(folder.path(), "impact.dat", &printed);
    let map = "[columns]\ntime = { column = \"time\" }\nouter_velocity = { column = \"velocities NOUTER vz\" }\n\
               inner_velocity = { column = \"velocities NINNER vz\" }\n";
    assert_read(&compared(folder.path(), &dat, map).0, -START);
    let other = file(folder.path(), "scope.dat", &table);
    assert_read(&compared(folder.path(), &other, "").0, -START);
}
