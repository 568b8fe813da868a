//! What a sweep draws: curves and maps with the numbers of its table, references, the formats of a figure.

use crate::store_fixture::SCENE;
use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Runs `study sweep` of the scaled plate in `folder`; its exit status, its document, and what it told.
fn sweep(folder: &Path, file: &str, arguments: &[&str]) -> (Option<i32>, Value, String) {
    fs::write(folder.join("mine.toml"), SCENE).unwrap();
    fs::write(folder.join("sweep.toml"), format!("scene = \"mine.toml\"\n{file}")).unwrap();
    let mut command = Command::cargo_bin("impactcheck").unwrap();
    command.args(["study", "sweep", "sweep.toml", "--json"]).args(arguments).current_dir(folder);
    command.env("IMPACTCHECK_HOME", env!("CARGO_MANIFEST_DIR")).env_remove("IMPACTCHECK_STORE");
    let output = command.output().unwrap();
    let document = serde_json::from_slice(&output.stdout).unwrap_or_default();
    (output.status.code(), document, String::from_utf8_lossy(&output.stderr).into_owned())
}

/// The cells of a column of the rows of `model`.
fn column(document: &Value, model: &str, name: &str) -> Vec<f64> {
    let names = document["columns"].as_array().unwrap();
    let place = |name: &str| names.iter().position(|n| n == name).unwrap();
    let rows = document["rows"].as_array().unwrap().iter().filter(|row| row[place("model")] == model);
    rows.map(|row| row[place(name)].as_f64().unwrap()).collect()
}

/// The attribute `name` of every `element` of the drawing that has all `marks`.
fn attributes<'a>(svg: &'a str, element: &str, marks: &[&str], name: &str) -> Vec<&'a str> {
    let elements = svg.split('<').filter(|e| e.starts_with(&format!("{element} ")));
    let marked = elements.filter(|e| marks.iter().all(|mark| e.contains(mark)));
    marked.map(|e| e.split(&format!(" {name}=\"")).nth(1).unwrap().split('"').next().unwrap()).collect()
}

fn points(path: &str) -> Vec<[f64; 2]> {
    let pairs = path.split(['M', 'L']).filter(|pair| !pair.is_empty());
    pairs
        .map(|pair| {
            let mut numbers = pair.split(' ').map(|n| n.parse().unwrap());
            [numbers.next().unwrap(), numbers.next().unwrap()]
        })
        .collect()
}

const ORANGE: &str = "stroke=\"#d55e00\"";
const BLUE: &str = "stroke=\"#0072b2\"";
const RADIUS: &str =
    "[[vary]]\nfields = [\"outer.radius\", \"inner.radius\"]\nvalues = [\"5 mm\", \"10 mm\", \"14 mm\"]\n";

/// Both coordinates of both curves are one linear function each of the table's numbers, and so is the reference.
#[test]
fn curves_and_references_have_the_places_of_their_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let (status, document, messages) =
        sweep(folder.path(), &format!("model = [\"A\", \"B\"]\n{RADIUS}"), &[]);
    assert_eq!(status, Some(0), "{messages}");
    let svg = fs::read_to_string(folder.path().join("sweep-sweep/sweep.svg")).unwrap();
    let curve = |colour| points(attributes(&svg, "path", &[colour], "d").last().unwrap());
    let drawn = [curve(ORANGE), curve(BLUE)];
    let values = ["A", "B"].map(|model| column(&document, model, "efficiency"));
    let (top, bottom) = (drawn[0][0], drawn[0][1]);
    let slope = (bottom[1] - top[1]) / (values[0][1] - values[0][0]);
    assert!(slope < -100.0, "upwards, over a good part of the drawing: {slope}");
    let place = |radius: f64, efficiency: f64| {
        let x = top[0] + (bottom[0] - top[0]) * (radius - 5e-3) / 5e-3;
        [x, top[1] + slope * (efficiency - values[0][0])]
    };
    let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() < 0.05 && (a[1] - b[1]).abs() < 0.05;
    for (curve, values) in drawn.iter().zip(&values) {
        assert_eq!(curve.len(), 3);
        for ((point, radius), value) in curve.iter().zip([5e-3, 10e-3, 14e-3]).zip(values) {
            assert!(near(*point, place(radius, *value)), "{point:?} for {value} at {radius}");
        }
    }
    // the stored reference of the 10 mm spheres, and its band; that of the 6.35 mm spheres has another speed
    let number = |name| attributes(&svg, "circle", &["#1a1a1a"], name);
    let [x, y] = ["cx", "cy"].map(|name| number(name).last().unwrap().parse().unwrap());
    assert_eq!(number("cx").len(), 1 + 1, "in the legend and at its place");
    assert!(near([x, y], place(10e-3, 0.694_666)), "{x} {y}");
    assert!(svg.contains("reference (uncertainty 95 %)") && svg.contains("outer.radius, inner.radius in mm"));
    // between 10 and 14 mm the contact comes to last half the plate's first period
    let said: Vec<f64> =
        attributes(&svg, "line", &["fig-note"], "x1").iter().map(|x| x.parse().unwrap()).collect();
    let [end, first] = ["inner_contact_end", "first_frequency"].map(|name| column(&document, "B", name));
    let ratio: Vec<f64> = end.iter().zip(&first).map(|(end, first)| 2.0 * end * first).collect();
    assert!(ratio[1] < 1.0 && ratio[2] > 1.0, "{ratio:?}");
    let at = 10e-3 + 4e-3 * (1.0 - ratio[1]) / (ratio[2] - ratio[1]);
    assert_eq!(said.len(), 1);
    assert!((said[0] - place(at, 0.5)[0]).abs() < 0.05, "{said:?}, expected {at}");
}

#[test]
fn a_map_has_the_lightest_cell_where_the_efficiency_is_highest() {
    let folder = tempfile::tempdir().unwrap();
    let vary = "[[vary]]\nfield = \"plate.thickness\"\nfrom = \"2 mm\"\nto = \"4 mm\"\ncount = 3\nscale = \"log\"\n\
                [[vary]]\nfield = \"plate.radius\"\nvalues = [\"33 mm\", \"15 mm\", \"-1 mm\"]\n";
    let figure = folder.path().join("map.pdf");
    let arguments = ["--figure", figure.to_str().unwrap(), "--quantity", "efficiency,inner_force_peak"];
    let (status, document, messages) = sweep(folder.path(), &format!("model = [\"B\"]\n{vary}"), &arguments);
    assert_eq!(status, Some(0), "{messages}");
    let rows = document["rows"].as_array().unwrap();
    let ok: Vec<&Value> = rows.iter().filter(|row| row[3] == "ok").collect();
    assert_eq!((rows.len(), ok.len()), (9, 6));
    let svg = fs::read_to_string(folder.path().join("sweep-sweep/sweep.svg")).unwrap();
    let scale = attributes(&svg, "rect", &["width=\"14\"", "stroke-width"], "fill");
    let (cells, panels) = (["x", "y", "fill"], 2);
    let [x, y, fill] = cells.map(|name| {
        let all = attributes(&svg, "rect", &["stroke-width"], name);
        all[..all.len() / panels].to_vec()
    });
    let best = ok.iter().max_by(|a, b| a[4].as_f64().unwrap().total_cmp(&b[4].as_f64().unwrap())).unwrap();
    let lightest: Vec<usize> = (0..6).filter(|k| fill[*k] == scale[63]).collect();
    assert_eq!(lightest.len(), 1, "{fill:?}");
    // the scene with 2 mm and 33 mm is in the first column, above that of 15 mm
    assert_eq!((best[1].as_f64(), best[2].as_f64()), (Some(2e-3), Some(33e-3)));
    let number = |texts: &[&str], k: usize| texts[k].parse::<f64>().unwrap();
    let (left, upper) = (number(&x, lightest[0]), number(&y, lightest[0]));
    assert!((0..6).all(|k| left <= number(&x, k) && upper <= number(&y, k)), "{x:?} {y:?}");
    assert!(svg.contains("inner force, peak in N") && svg.contains("plate.thickness in mm"));
    assert!(fs::read(figure).unwrap().starts_with(b"%PDF"));
}

#[test]
fn more_than_two_parameters_are_a_table_alone() {
    let folder = tempfile::tempdir().unwrap();
    let three = "[[vary]]\nfield = \"outer.speed\"\nvalues = [0.4, 0.5]\n\
                 [[vary]]\nfield = \"plate.radius\"\nvalues = [0.03, 0.04]\n\
                 [[vary]]\nfield = \"plate.thickness\"\nvalues = [0.002, 0.003]\n";
    let out = folder.path().join("sweep-sweep");
    let (status, _, messages) = sweep(folder.path(), three, &["--figure", "figure.svg"]);
    assert!(status == Some(2) && messages.contains("3 parameters vary") && !out.exists(), "{messages}");
    assert_eq!(sweep(folder.path(), three, &[]).0, Some(0));
    assert!(out.join("sweep.csv").is_file() && !out.join("sweep.svg").exists());
    let (status, _, messages) = sweep(folder.path(), RADIUS, &["--quantity", "efficency"]);
    assert!(status == Some(2) && messages.contains("did you mean `efficiency`?"), "{messages}");
    for twice in ["model = [\"B\", \"B\"]", "model = []"] {
        assert_eq!(sweep(folder.path(), &format!("{twice}\n{RADIUS}"), &[]).0, Some(3), "{twice}");
    }
}
