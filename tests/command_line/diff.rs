//! What `diff` says has moved are the numbers of the two documents.

use assert_cmd::Command;
use serde_json::Value;
use std::path::Path;

fn impactcheck(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::cargo_bin("impactcheck")
        .unwrap()
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env_remove("IMPACTCHECK_STORE")
        .output()
        .unwrap();
    let [out, error] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (output.status.code(), out, error)
}

/// The report of a scene on the mesh `resolution`.
fn report(folder: &Path, resolution: &str) -> String {
    let out = folder.join(resolution).display().to_string();
    let arguments = ["compare", "scaled-plate-r6.35", "--resolution", resolution, "--out", &out, "--quiet"];
    assert_eq!(impactcheck(&arguments).0, Some(0));
    out
}

#[test]
fn a_coarser_reference_moves_and_the_models_stay() {
    let folder = tempfile::tempdir().unwrap();
    let [coarse, paper] = ["coarse", "paper"].map(|resolution| report(folder.path(), resolution));
    let (status, table, _) = impactcheck(&["diff", &paper, &paper]);
    assert_eq!((status, table.trim_end()), (Some(0), "nothing changed"));

    let efficiency = |report: &str| -> f64 {
        let text = std::fs::read_to_string(Path::new(report).join("comparison.json")).unwrap();
        let document: Value = serde_json::from_str(&text).unwrap();
        document["scenes"][0]["reference"]["efficiency"].as_f64().unwrap()
    };
    let (status, json, _) = impactcheck(&["diff", &coarse, &paper, "--json"]);
    let found: Value = serde_json::from_str(&json).unwrap();
    assert_eq!((status, &found["schema_version"]), (Some(0), &1.into()));
    let moved = found["moved"].as_array().unwrap();
    let of_efficiency: Vec<_> = moved.iter().filter(|entry| entry["quantity"] == "efficiency").collect();
    assert_eq!(of_efficiency.len(), 1, "the reference alone, once: {of_efficiency:?}");
    assert_eq!(of_efficiency[0]["model"], "reference");
    assert_eq!(of_efficiency[0]["a"].as_f64().unwrap(), efficiency(&coarse));
    assert_eq!(of_efficiency[0]["b"].as_f64().unwrap(), efficiency(&paper));

    let (_, json, _) = impactcheck(&["diff", &coarse, &paper, "--json", "--above", "5%"]);
    let some: Value = serde_json::from_str(&json).unwrap();
    let verdicts = some["verdicts"].as_array().unwrap().len();
    let some = some["moved"].as_array().unwrap();
    assert!(!some.is_empty() && some.len() < moved.len());
    assert!(some.iter().all(|entry| entry["relative"].as_f64().is_none_or(|share| share.abs() > 0.05)));
    let (_, table, _) = impactcheck(&["diff", &coarse, &paper, "--above", "5%"]);
    assert_eq!(table.lines().count(), 2 + verdicts + some.len());
}

/// The attribute `name` of an opening tag.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = tag.split_once(&format!(" {name}=\""))?;
    Some(rest.split_once('"').unwrap().0)
}

#[test]
fn the_page_has_every_move_where_it_belongs_and_the_largest_first() {
    let folder = tempfile::tempdir().unwrap();
    let [coarse, paper] = ["coarse", "paper"].map(|resolution| report(folder.path(), resolution));
    let file = folder.path().join("moved.html").display().to_string();
    let (status, json, _) = impactcheck(&["diff", &coarse, &paper, "--json", "--out", &file]);
    assert_eq!(status, Some(0));
    let found: Value = serde_json::from_str(&json).unwrap();
    let page = std::fs::read_to_string(&file).unwrap();
    let mut seen = 0;
    for (class, endings) in [("verdicts", false), ("distances", true)] {
        let (_, table) = page.split_once(&format!("<table class=\"moves {class}\"")).unwrap();
        let (head, rows) = table.split_once("<tbody>").unwrap();
        let rows = rows.split_once("</tbody>").unwrap().0;
        let number = |tag: &str, name: &str| attribute(tag, name).map(|text| text.parse::<f64>().unwrap());
        let head = format!(" {head}");
        let (linear, limit) = (number(&head, "data-linear").unwrap(), number(&head, "data-limit").unwrap());
        let place = |v: f64| {
            let side = (1.0 + v.abs() / linear).ln() / (1.0 + limit / linear).ln();
            50.0 + 50.0 * side.min(1.0).copysign(v)
        };
        let (mut last, mut shown) = (f64::INFINITY, Vec::new());
        for row in rows.split("<tr>").skip(1) {
            let values: Vec<&str> = row.split("<td").collect();
            let [a, b] = [3, 4].map(|k| number(values[k], "data-si"));
            let entries = found["moved"].as_array().unwrap();
            let entry = entries.iter().find(|e| (e["a"].as_f64(), e["b"].as_f64()) == (a, b)).expect(row);
            let share = entry["relative"].as_f64();
            assert!(share.map_or(f64::INFINITY, f64::abs) <= last, "{row}");
            last = share.map_or(f64::INFINITY, f64::abs);
            assert_eq!(number(values[5], "data-sort"), share.map(f64::abs));
            if let Some(share) = share {
                let (_, mark) = values[7].split_once("<svg x").unwrap();
                let x: f64 =
                    attribute(&format!(" x{mark}"), "x").unwrap().trim_end_matches('%').parse().unwrap();
                assert!((x - place(share)).abs() < 1e-3 && number(mark, "data-si") == Some(share), "{row}");
            }
            if let Some(band) = entry["band"].as_f64() {
                let band = band / entry["a"].as_f64().unwrap().abs();
                assert_eq!(number(values[6], "data-sort"), Some(band));
                let left = attribute(values[7].split_once("<rect").unwrap().1, "x").unwrap();
                assert!((left.trim_end_matches('%').parse::<f64>().unwrap() - place(-band)).abs() < 1e-3);
            }
            let quantity = entry["quantity"].as_str().unwrap().to_owned();
            assert_eq!(["_rms", "_max", "_residual"].iter().any(|e| quantity.ends_with(e)), endings);
            shown.push(quantity);
        }
        seen += shown.len();
    }
    assert_eq!(seen, found["moved"].as_array().unwrap().len());
    assert!(found["verdicts"].as_array().unwrap().iter().all(|v| page.contains(v["a"].as_str().unwrap())));
    // nothing changed is a page too
    assert_eq!(impactcheck(&["diff", &paper, &paper, "--out", &file]).0, Some(0));
    let page = std::fs::read_to_string(&file).unwrap();
    assert!(page.contains("Nothing changed") && !page.contains("<table"));
}

#[test]
fn what_is_no_comparison_is_refused_in_one_sentence() {
    for file in ["README.md", "scenes", "no-such-file.json", "reports/comparison.md"] {
        let (status, out, error) = impactcheck(&["diff", file, file]);
        assert_eq!((status, out.as_str()), (Some(2), ""), "{error}");
        assert!(error.starts_with("error: ") && error.contains(file), "{error}");
    }
}
