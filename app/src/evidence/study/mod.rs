//! Parameter studies and the paper's tables and figures: numbers in rows, and what the paper says about them.
//!
//! A study is one file below `kinds` with one function that returns a [`Study`], and one entry in [`STUDIES`].

mod kinds;
mod plot;
mod write;

pub use kinds::*;
pub use plot::{Axis, Only, Panel, figure};
pub use write::{MOST_ROWS, csv, in_words, json, markdown, write};

use crate::error::Result;
use crate::project::project_root;
use crate::scene::{Model, Scene, unknown_name};
use serde::Serialize;
use std::path::PathBuf;

/// Version of the study document.
pub const SCHEMA_VERSION: u32 = 1;

/// What a study tells a person while it runs.
pub type Note<'a> = dyn FnMut(&str) + 'a;

/// What the user may choose about a study.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Settings {
    /// The reduced model; `None` = the study's own choice.
    pub model: Option<Model>,
    /// Folder of the stored references, for studies that look at them; `None` = the usual one.
    pub store: Option<PathBuf>,
}

/// A study that can be asked for by name.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    /// Name on the command line and of the files.
    pub name: &'static str,
    /// One line for people.
    pub about: &'static str,
    /// Whether the reduced model can be chosen.
    pub takes_model: bool,
    /// Runs it.
    pub run: fn(&Settings, &mut Note) -> Result<Study>,
    /// How it is drawn, from the columns of its table; empty = it is no figure.
    pub panels: &'static [Panel],
    /// Draws it, where panels of curves are not what it needs.
    pub drawing: Option<fn(&Study) -> String>,
}

impl Entry {
    /// The study called `name`.
    const fn new(
        name: &'static str,
        run: fn(&Settings, &mut Note) -> Result<Study>,
        about: &'static str,
    ) -> Self {
        Entry { name, about, takes_model: false, run, panels: &[], drawing: None }
    }

    /// With a figure of panels.
    const fn panels(self, panels: &'static [Panel]) -> Self {
        Entry { panels, ..self }
    }

    /// With a choice of the reduced model.
    const fn with_models(self) -> Self {
        Entry { takes_model: true, ..self }
    }

    /// With a figure of its own.
    const fn drawn(self, drawing: fn(&Study) -> String) -> Self {
        Entry { drawing: Some(drawing), ..self }
    }

    /// The figure of the study as SVG, if it has one.
    ///
    /// # Errors
    /// As [`figure`].
    pub fn figure(&self, study: &Study) -> Result<Option<String>> {
        match self.drawing {
            Some(draw) => Ok(Some(draw(study))),
            None if self.panels.is_empty() => Ok(None),
            None => figure(study, self.panels).map(Some),
        }
    }
}

/// A scene of the project by its path below `scenes/`, without the ending.
///
/// # Errors
/// As [`project_root`] and [`Scene::read`].
fn of_project(name: &str) -> Result<Scene> {
    Scene::read(project_root()?.join(format!("scenes/{name}.toml")))
}

/// The study called `name`.
///
/// # Errors
/// [`crate::Error::Usage`] if there is none; it lists those there are.
pub fn find(name: &str) -> Result<&'static Entry> {
    STUDIES.iter().find(|entry| entry.name == name).ok_or_else(|| {
        unknown_name(format!("there is no study `{name}`"), name, &STUDIES.map(|entry| entry.name))
    })
}

/// One value of a row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// A quantity in the column's SI unit.
    Number(f64),
    /// A number of something.
    Count(usize),
    /// A name of something.
    Text(&'static str),
    /// Not known here, for example because a solver is not installed; null in JSON.
    Missing,
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Cell::Missing, Into::into)
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Cell::Number(value)
    }
}

impl From<usize> for Cell {
    fn from(value: usize) -> Self {
        Cell::Count(value)
    }
}

/// What becomes of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Ours is within the bound.
    Pass,
    /// Ours differs by more than the bound.
    Fail,
    /// There is no value to judge, for example because a solver is not installed.
    Unchecked,
}

/// Something the paper says, or two of our solvers have to agree on, and what was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Claim {
    /// The claim in words.
    pub claim: String,
    /// Unit of the three numbers; "1" for pure numbers.
    pub unit: &'static str,
    /// The paper's value, if the claim is the paper's.
    pub paper: Option<f64>,
    /// What was found, if it was.
    pub ours: Option<f64>,
    /// How far ours may lie from the paper's value, or from zero if the paper gives none.
    pub bound: f64,
    /// The verdict.
    pub verdict: Verdict,
}

impl Claim {
    /// A claim whose verdict follows from |ours - paper| <= bound.
    pub fn new(claim: String, unit: &'static str, paper: Option<f64>, ours: Option<f64>, bound: f64) -> Self {
        let verdict = match ours.map(|ours| (ours - paper.unwrap_or(0.0)).abs() <= bound) {
            Some(true) => Verdict::Pass,
            Some(false) => Verdict::Fail,
            None => Verdict::Unchecked,
        };
        Claim { claim, unit, paper, ours, bound, verdict }
    }
}

/// The result of a study; the document that `study --json` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Study {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// Name of the study.
    pub study: &'static str,
    /// What it is, in a sentence or two.
    pub description: String,
    /// Names of the columns.
    pub columns: Vec<&'static str>,
    /// SI units of the columns, "1" for pure numbers.
    pub units: Vec<&'static str>,
    /// The values. Shape (rows, columns).
    pub rows: Vec<Vec<Cell>>,
    /// What follows from them.
    pub claims: Vec<Claim>,
}

impl Study {
    /// The study called `study`; its columns are those of `header`, as of a table's, with a unit in brackets where there is one.
    fn new(
        study: &'static str,
        description: impl Into<String>,
        header: &'static str,
        rows: Vec<Vec<Cell>>,
        claims: Vec<Claim>,
    ) -> Self {
        let (schema_version, description) = (SCHEMA_VERSION, description.into());
        let (columns, units) = columns(header).unzip();
        Study { schema_version, study, description, columns, units, rows, claims }
    }
}

/// Name and unit of the columns of `header`, such as `case, gap [m]`; "1" without a unit.
fn columns(header: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    header.split(", ").map(|column| match column.split_once(" [") {
        Some((name, unit)) => (name, unit.trim_end_matches(']')),
        None => (column, "1"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_is_judged_by_its_bound_and_unchecked_without_a_value() {
        let verdict = |paper, ours, bound| Claim::new(String::new(), "Hz", paper, ours, bound).verdict;
        assert_eq!(verdict(Some(136e3), Some(133.5e3), 636.0), Verdict::Fail);
        assert_eq!(verdict(Some(136e3), Some(135.5e3), 636.0), Verdict::Pass);
        assert_eq!(verdict(None, Some(-2e-3), 1e-3), Verdict::Fail);
        assert_eq!(verdict(None, Some(f64::NAN), 1e-3), Verdict::Fail);
        assert_eq!(verdict(None, None, 1e-3), Verdict::Unchecked);
    }

    #[test]
    fn columns_are_those_of_the_header_with_their_units() {
        let study = Study::new("x", "", "case, gap [m], peak_speed [m/s]", Vec::new(), Vec::new());
        assert_eq!((study.columns, study.units), (vec!["case", "gap", "peak_speed"], vec!["1", "m", "m/s"]));
    }

    #[test]
    fn an_unknown_study_is_a_usage_error_that_names_the_nearest() {
        let refused = find("tabel2").expect_err("unknown");
        assert_eq!(refused.hints()[0], "did you mean `table2`?");
    }
}
