//! A study as JSON, CSV and Markdown.

use super::{Cell, Claim, Study, Verdict};
use crate::error::{Error, Result};
use crate::file::write_file;
use crate::format::significant;
use crate::plot::png;
use std::path::{Path, PathBuf};

/// Rows of a study that the terminal shows.
pub const MOST_ROWS: usize = 30;

/// Pixels of the PNG per unit of the drawing, as in the report.
const PNG_SCALE: f32 = 3.0;

/// Writes `<study>.json`, `<study>.csv` and `<study>.md`, and of its `figure`, if there is one, `<study>.svg` and
/// `<study>.png` into `dir`, which is made if it does not exist, each by way of a temporary file. Returns the paths.
///
/// # Errors
/// [`Error::Io`] naming the file.
pub fn write(study: &Study, figure: Option<String>, dir: &Path) -> Result<Vec<PathBuf>> {
    let mut files = vec![("json", json(study)?.into_bytes()), ("csv", csv(study)?.into_bytes())];
    let mut text = markdown(study);
    if let Some(svg) = figure {
        text += &format!("\n![{0}]({0}.svg)\n", study.study);
        files.push(("png", png(&svg, PNG_SCALE)?));
        files.push(("svg", svg.into_bytes()));
    }
    files.push(("md", text.into_bytes()));
    let mut written = Vec::new();
    for (extension, bytes) in files {
        let path = dir.join(format!("{}.{extension}", study.study));
        write_file(&path, &bytes)?;
        written.push(path);
    }
    Ok(written)
}

/// Pretty JSON, ending with a line break.
///
/// # Errors
/// [`Error::Internal`] if it can't be serialised.
pub fn json(study: &Study) -> Result<String> {
    serde_json::to_string_pretty(study)
        .map(|text| text + "\n")
        .map_err(|e| Error::Internal(format!("writing the study as JSON: {e}")))
}

/// The rows as CSV with a header; full precision, a missing value is empty.
///
/// # Errors
/// [`Error::Internal`] if it can't be written.
pub fn csv(study: &Study) -> Result<String> {
    let failed = |e: String| Error::Internal(format!("writing the study as CSV: {e}"));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(headings(study)).map_err(|e| failed(e.to_string()))?;
    for row in &study.rows {
        let cells = row.iter().map(|cell| match cell {
            Cell::Number(value) => value.to_string(),
            Cell::Count(value) => value.to_string(),
            Cell::Text(text) => (*text).to_owned(),
            Cell::Missing => String::new(),
        });
        writer.write_record(cells).map_err(|e| failed(e.to_string()))?;
    }
    let bytes = writer.into_inner().map_err(|e| failed(e.to_string()))?;
    String::from_utf8(bytes).map_err(|e| failed(e.to_string()))
}

/// Markdown with the rows and the claims as tables, aligned so that it is also read in a terminal.
pub fn markdown(study: &Study) -> String {
    let cells = study.rows.iter().map(|row| row.iter().map(shown).collect());
    let rows = std::iter::once(headings(study)).chain(cells).collect();
    let mut text = format!("# {}\n\n{}\n\n{}", study.study, study.description, table(rows));
    if !study.claims.is_empty() {
        let heading = ["claim", "unit", "paper", "ours", "bound", "verdict"].map(str::to_owned).into();
        let rows = std::iter::once(heading).chain(study.claims.iter().map(claim)).collect();
        text += &format!("\n{}", table(rows));
    }
    text
}

/// For the terminal: as [`markdown`], of a long table only the first [`MOST_ROWS`] rows.
pub fn in_words(study: &Study) -> String {
    let mut short = study.clone();
    short.rows.truncate(MOST_ROWS);
    markdown(&short)
}

/// Column names, with the unit where there is one.
fn headings(study: &Study) -> Vec<String> {
    let heading = |(name, unit): (&&str, &&str)| match *unit {
        "1" => (*name).to_owned(),
        unit => format!("{name} [{unit}]"),
    };
    study.columns.iter().zip(&study.units).map(heading).collect()
}

fn claim(claim: &Claim) -> Vec<String> {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| digits(value, 6));
    let verdict = match claim.verdict {
        Verdict::Pass => "pass",
        Verdict::Fail => "FAIL",
        Verdict::Unchecked => "unchecked",
    };
    let unit = if claim.unit == "1" { "" } else { claim.unit };
    let bound = digits(claim.bound, 3);
    [claim.claim.clone(), unit.into(), number(claim.paper), number(claim.ours), bound, verdict.into()].into()
}

fn shown(cell: &Cell) -> String {
    match cell {
        Cell::Number(value) => digits(*value, 6),
        Cell::Count(value) => value.to_string(),
        Cell::Text(text) => (*text).to_owned(),
        Cell::Missing => "–".to_owned(),
    }
}

/// `value` with at most `most` significant digits, without zeros at the end of a fraction.
fn digits(value: f64, most: usize) -> String {
    let text = significant(value, most);
    if text.contains('.') && !text.contains('e') {
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    text
}

/// Markdown table of `rows`, the first of which is the heading.
fn table(rows: Vec<Vec<String>>) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |c: usize| rows.iter().map(|row| row[c].chars().count()).max().unwrap_or(0).max(3);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for (i, row) in rows.iter().enumerate() {
        for (cell, width) in row.iter().zip(&widths) {
            text += &format!("| {cell:<width$} ");
        }
        text += "|\n";
        if i == 0 {
            text += &widths.iter().map(|w| format!("|{}", "-".repeat(w + 2))).collect::<String>();
            text += "|\n";
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn study() -> Study {
        Study {
            schema_version: 1,
            study: "example",
            description: "An example.".into(),
            columns: vec!["thickness", "number", "frequency"],
            units: vec!["m", "1", "Hz"],
            rows: vec![
                vec![Cell::Number(1e-4), Cell::Count(7), Cell::Number(28_544.693_2)],
                vec![Cell::Number(5e-4), Cell::Count(4), Cell::Missing],
            ],
            claims: vec![Claim::new("first".into(), "Hz", Some(29e3), Some(28_544.7), 500.0)],
        }
    }

    #[test]
    fn json_has_the_fields_others_read_and_null_for_what_is_missing() {
        let document: serde_json::Value = serde_json::from_str(&json(&study()).unwrap()).unwrap();
        assert_eq!(document["columns"][2], "frequency");
        assert_eq!(document["rows"], serde_json::json!([[1e-4, 7, 28_544.693_2], [5e-4, 4, null]]));
        let claim = &document["claims"][0];
        for (key, value) in [("paper", 29e3), ("ours", 28_544.7)] {
            assert_eq!(claim[key], value);
        }
        assert_eq!(claim["verdict"], "pass");
    }

    #[test]
    fn csv_keeps_every_digit() {
        let expected = "thickness [m],number,frequency [Hz]\n0.0001,7,28544.6932\n0.0005,4,\n";
        assert_eq!(csv(&study()).unwrap(), expected);
    }

    #[test]
    fn markdown_is_aligned_and_names_the_verdict() {
        let text = markdown(&study());
        assert!(text.contains("| 0.0001        | 7      | 28544.7        |\n"), "{text}");
        assert!(text.contains("| pass    |"), "{text}");
        let tables: Vec<&str> = text.lines().filter(|line| line.starts_with('|')).collect();
        assert_eq!(tables.len(), 4 + 3, "{text}");
    }

    #[test]
    fn three_files_are_written_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let written = write(&study(), None, &folder.path().join("new")).unwrap();
        let mut names: Vec<_> =
            std::fs::read_dir(folder.path().join("new")).unwrap().map(|e| e.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["example.csv", "example.json", "example.md"]);
        assert!(written.iter().all(|path| path.is_file()));
    }
}
