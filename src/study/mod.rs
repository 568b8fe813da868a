//! Parameter studies and the paper's tables and figures: numbers in rows, and what the paper says about them.
//!
//! A study is one file with one function that returns a [`Study`], and one line in [`STUDIES`].

pub mod actuators;
pub mod auto;
pub mod damping;
pub mod fig14;
pub mod fig15;
pub mod fig16;
pub mod fig17;
pub mod flight;
pub mod fluid;
pub mod half_period;
pub mod insensitivity;
pub mod parameter;
mod plot;
pub mod rocker;
pub mod seal_seat;
pub mod seal_seat_cost;
pub mod seal_seat_direction;
pub mod shakedown;
pub mod table2;
pub mod test_bed;
pub mod valve;
mod write;

pub use plot::{Axis, Only, Panel, figure};
pub use write::{MOST_ROWS, csv, json, markdown, told, write};

use crate::error::{Error, Result};
use crate::project::project_root;
use crate::scene::{Model, Scene, suggestion};
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
    /// Number of random scenes, for the study that draws some; `None` = its own.
    pub cases: Option<usize>,
    /// Seed they are drawn with; `None` = its own.
    pub seed: Option<u64>,
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

/// All studies there are.
pub const STUDIES: [Entry; 19] = [
    Entry {
        name: "table2",
        about: "Table 2: first and first longitudinal eigenfrequency from plate to rod",
        takes_model: false,
        run: |_, note| table2::run(note),
        panels: &[],
        drawing: None,
    },
    Entry {
        name: "fig14",
        about: "Fig. 14: efficiency over Young's modulus of plate and spheres",
        takes_model: true,
        run: fig14::run,
        panels: &fig14::PANELS,
        drawing: None,
    },
    Entry {
        name: "fig15",
        about: "Fig. 15: efficiency over the plate's thickness, clamped and free",
        takes_model: true,
        run: fig15::run,
        panels: &fig15::PANELS,
        drawing: None,
    },
    Entry {
        name: "fig16",
        about: "Fig. 16: efficiency over the plate's radius, and the best radius",
        takes_model: true,
        run: fig16::run,
        panels: &fig16::PANELS,
        drawing: None,
    },
    Entry {
        name: "fig17",
        about: "Fig. 17: efficiency over the tip radius",
        takes_model: true,
        run: fig17::run,
        panels: &fig17::PANELS,
        drawing: None,
    },
    Entry {
        name: "half-period",
        about: "Section 4.1: best when the contact lasts half the plate's first period",
        takes_model: true,
        run: half_period::run,
        panels: &half_period::PANELS,
        drawing: None,
    },
    Entry {
        name: "insensitivity",
        about: "Model C with other numbers of modes, patch radii and meshes, both scenes of Table 1",
        takes_model: false,
        run: |_, note| insensitivity::run(note),
        panels: &[],
        drawing: None,
    },
    Entry {
        name: "auto",
        about: "The models that `auto` chooses: estimated against true error, and their cost",
        takes_model: false,
        run: auto::run,
        panels: &[],
        drawing: Some(auto::figure),
    },
    Entry {
        name: "actuators",
        about: "Section 2.2: energy of the inner sphere over the gap, from stack, bender and lift magnet",
        takes_model: true,
        run: actuators::run,
        panels: &actuators::PANELS,
        drawing: None,
    },
    Entry {
        name: "rocker",
        about: "Section 4.3: membrane between sapphire spheres, and struck by a piezo bender",
        takes_model: false,
        run: |_, note| rocker::run(note),
        panels: &rocker::PANELS,
        drawing: None,
    },
    Entry {
        name: "shakedown",
        about: "Section 3.4.2, Fig. 13: efficiency of repeated impacts, several yield strengths, same and fresh spots, rate",
        takes_model: true,
        run: shakedown::run,
        panels: &shakedown::PANELS,
        drawing: None,
    },
    Entry {
        name: "test-bed",
        about: "Section 3.4.2, Figs. 12 and 13: whether its statements survive the tolerances of a test bed",
        takes_model: true,
        run: test_bed::run,
        panels: &test_bed::PANELS,
        drawing: None,
    },
    Entry {
        name: "flight",
        about: "Sections 5.1.1 to 5.1.3: flights and shocks of the sphere against MuJoCo, statements on the rocker",
        takes_model: false,
        run: |_, note| flight::run(note),
        panels: &[],
        drawing: None,
    },
    Entry {
        name: "valve",
        about: "Section 5: both demonstrators from the voltage to the seat, with the scatter of a workshop",
        takes_model: false,
        run: |_, note| valve::run(note),
        panels: &valve::PANELS,
        drawing: None,
    },
    Entry {
        name: "fluid",
        about: "Section 4.2.5: squeeze film, plate damping, added mass and drag, alone and together",
        takes_model: true,
        run: fluid::run,
        panels: &fluid::PANELS,
        drawing: None,
    },
    Entry {
        name: "damping",
        about: "Section 4.2.4: what a polymer plate's damping takes, in its modes and in both contacts",
        takes_model: false,
        run: |_, note| damping::run(note),
        panels: &damping::PANELS,
        drawing: None,
    },
    Entry {
        name: "seal-seat",
        about: "Section 4.4: what decides the direction of the sphere out of the flexible seal seat",
        takes_model: false,
        run: |_, note| seal_seat::run(note),
        panels: &seal_seat::PANELS,
        drawing: None,
    },
    Entry {
        name: "seal-seat-direction",
        about: "The direction out of the flexible seal seat with the band of many meshes",
        takes_model: false,
        run: seal_seat_direction::run,
        panels: &seal_seat_direction::PANELS,
        drawing: None,
    },
    Entry {
        name: "seal-seat-cost",
        about: "Run times of the reduced seal seat and of the finite elements on the same mesh",
        takes_model: false,
        run: |_, note| seal_seat_cost::run(note),
        panels: &[],
        drawing: None,
    },
];

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
/// [`Error::Usage`] if there is none; it lists those there are.
pub fn find(name: &str) -> Result<&'static Entry> {
    STUDIES.iter().find(|entry| entry.name == name).ok_or_else(|| {
        let names = STUDIES.map(|entry| entry.name);
        let hint =
            suggestion(name, names).map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
        Error::Usage(format!("there is no study `{name}`{hint} (there: {})", names.join(", ")))
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
    fn an_unknown_study_is_a_usage_error_that_names_the_nearest() {
        let said = find("tabel2").expect_err("unknown").to_string();
        assert!(said.contains("did you mean `table2`?"), "{said}");
    }
}
