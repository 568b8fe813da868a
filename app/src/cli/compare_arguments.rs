//! What `compare` and `gate` are both asked.

use super::external::Permission;
use super::record_map::RecordMap;
use super::requested_model::{self, RequestedModel};
use super::{JsonArgument, compare_inputs};
use crate::measured::Speed;
use crate::reference::Resolution;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene files or names of shipped scenes [default: all shipped scenes]
    pub(super) scenes: Vec<String>,
    /// Models to compare; auto is the least expensive one within the tolerance, external the programs under
    /// [[external]]
    #[arg(long, value_delimiter = ',', default_value = "A,B,C,external")]
    pub(super) models: Vec<RequestedModel>,
    #[command(flatten)]
    pub(super) permission: Permission,
    /// Tolerance of auto: relative error of efficiency, final velocity of the outer body and both peak forces
    /// [default: 1%]
    #[arg(long, value_parser = requested_model::tolerance)]
    pub(super) tolerance: Option<f64>,
    /// Resolution of the reference: coarse, paper (standard), fine, or the value given to --target-error, such as 0.2%
    /// [default: paper; `compare` takes the finest stored one of a scene that has no other]
    #[arg(long)]
    pub(super) resolution: Option<Resolution>,
    /// Compute references that are missing or out of date (needs FEniCSx)
    #[arg(long)]
    pub(super) compute: bool,
    /// Require that CalculiX's solution agrees with the reference within both uncertainties; else the exit status is
    /// 10. With --compute a missing one is computed. Scenes that CalculiX cannot solve are skipped
    #[arg(long)]
    pub(super) reference_check: bool,
    /// Measured histories: tables of text with headings such as `time [us]`, `outer_velocity [mm/s]`, or with --map.
    /// Several files, separated by commas or spaces, are repeated impacts; files joined by + have the channels of one.
    /// Text of LS-DYNA, OpenRadioss, CalculiX and ISO-MME is read too; binary formats (UFF 58, TDMS, MAT, HDF5, Parquet,
    /// WAV) need Python
    #[arg(long, value_delimiter = ',', value_name = "FILE")]
    pub(super) measured: Vec<PathBuf>,
    #[command(flatten)]
    pub(super) record_map: RecordMap,
    /// Bandwidth of the instrument; the models' curves are filtered to it
    #[arg(long, default_value = "100 kHz", value_name = "FREQUENCY", value_parser = compare_inputs::bandwidth)]
    pub(super) bandwidth: f64,
    /// Source of the outer body's speed: scene (the signal may have an offset) or measured (it has none)
    #[arg(long, default_value = "scene", value_name = "SOURCE")]
    pub(super) speed: Speed,
    /// Write the figure for a paper to this file (.svg, .pdf or .png); of several scenes, the scene's name is added
    #[arg(long, value_name = "FILE")]
    pub(super) figure: Option<PathBuf>,
    /// Width of the figure: 85 mm (one column) to 175 mm (a page)
    #[arg(long, default_value = "175 mm", value_name = "LENGTH", value_parser = compare_inputs::figure_width, requires = "figure")]
    pub(super) figure_width: f64,
    /// Recorded results over commits, drawn in the report [default: trends.jsonl in the report's folder]
    #[arg(long, value_name = "FILE")]
    pub(super) trends: Option<PathBuf>,
    /// Print the values of the models too; the table is then up to 150 columns wide
    #[arg(long, conflicts_with = "json")]
    pub(super) wide: bool,
    /// Folder of the report
    #[arg(long, default_value = "reports", value_name = "DIR")]
    pub(super) out: PathBuf,
    #[command(flatten)]
    pub(super) json: JsonArgument,
}

impl Arguments {
    pub(super) fn resolution(&self) -> Resolution {
        self.resolution.unwrap_or(Resolution::Paper)
    }

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
