//! What `compare` and `gate` are both asked.

use super::asked_model::{self, AskedModel};
use super::external::Permission;
use super::{JsonArgument, compare_inputs};
use crate::measured::Speed;
use crate::reference::Resolution;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene files or names of shipped scenes [default: all shipped scenes]
    pub(super) scenes: Vec<String>,
    /// Models to compare; auto stands for the cheapest whose estimated error meets the tolerance, external for the programs that
    /// the scene names
    #[arg(long, value_delimiter = ',', default_value = "A,B,C,external")]
    pub(super) models: Vec<AskedModel>,
    #[command(flatten)]
    pub(super) permission: Permission,
    /// Tolerance of auto: relative error of the efficiency, the outer body's final velocity and both force peaks [default: 1%]
    #[arg(long, value_parser = asked_model::tolerance)]
    pub(super) tolerance: Option<f64>,
    /// Resolution of the reference: coarse, paper, fine, or the error of one computed with --target-error, such as 0.2%
    #[arg(long, default_value = "paper")]
    pub(super) resolution: Resolution,
    /// Compute references that are missing or stale instead of stopping (needs FEniCSx)
    #[arg(long)]
    pub(super) compute: bool,
    /// CalculiX's solution of each scene beside the reference has to be there (`--compute` computes it) and within the bands of
    /// both, or the exit status is 10; without this it is shown where it is stored. Scenes that CalculiX does not take are left out
    #[arg(long)]
    pub(super) reference_check: bool,
    /// Measured histories of the scene (CSV, units in the header: `time [us],outer_velocity [mm/s],...`); several files are
    /// repeated impacts, with commas or spaces between them
    #[arg(long, value_delimiter = ',', value_name = "FILE")]
    pub(super) measured: Vec<PathBuf>,
    /// Bandwidth of the instrument, to which the models' curves are filtered
    #[arg(long, default_value = "100 kHz", value_name = "FREQUENCY", value_parser = compare_inputs::bandwidth)]
    pub(super) bandwidth: f64,
    /// Where the outer body's measured speed comes from: scene (the signal may have an offset) or measured (it has none)
    #[arg(long, default_value = "scene", value_name = "SOURCE")]
    pub(super) speed: Speed,
    /// Write the figure for a paper to this file (.svg, .pdf or .png); of several scenes, the scene's name is added
    #[arg(long, value_name = "FILE")]
    pub(super) figure: Option<PathBuf>,
    /// Width of that figure: 85 mm is one column, 175 mm a page
    #[arg(long, default_value = "175 mm", value_name = "LENGTH", value_parser = compare_inputs::figure_width, requires = "figure")]
    pub(super) figure_width: f64,
    /// Results over commits to draw in the report [default: trends.jsonl in the report's folder, if it exists]
    #[arg(long, value_name = "FILE")]
    pub(super) trends: Option<PathBuf>,
    /// Folder the report is written to
    #[arg(long, default_value = "reports", value_name = "DIR")]
    pub(super) out: PathBuf,
    #[command(flatten)]
    pub(super) json: JsonArgument,
}

impl Arguments {
    /// Tables among the scenes belong to `--measured`, whose files a shell lists with spaces between them.
    pub(super) fn with_tables_measured(mut self) -> Self {
        if !self.measured.is_empty() {
            let is_table = |name: &String| name.to_lowercase().ends_with(".csv");
            let (tables, scenes) = self.scenes.into_iter().partition(is_table);
            self.scenes = scenes;
            self.measured.extend(Vec::into_iter(tables).map(PathBuf::from));
        }
        self
    }
}
