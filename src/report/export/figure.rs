//! The figure of a scene as a file for a paper.

use crate::error::{Error, Result};
use crate::report::{SceneReport, printed_figure};
use std::path::Path;

/// Dots per inch of a PNG, what journals ask of line drawings.
const RESOLUTION: f32 = 600.0;

/// Kind of a figure's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureFormat {
    /// Vector drawing for the web and for editors; text stays text.
    Svg,
    /// Vector drawing for LaTeX; text stays text, in an embedded font.
    Pdf,
    /// 600 dots per inch.
    Png,
}

impl FigureFormat {
    /// A stand-alone drawing in this format.
    ///
    /// # Errors
    /// [`Error::Internal`] if it can't be drawn.
    pub fn of_svg(self, svg: String, title: &str) -> Result<Vec<u8>> {
        match self {
            FigureFormat::Svg => Ok(svg.into_bytes()),
            FigureFormat::Pdf => crate::plot::pdf::pdf(&svg, title),
            FigureFormat::Png => crate::plot::png::printed_png(&svg, RESOLUTION),
        }
    }

    /// The format that the ending of `file` stands for.
    ///
    /// # Errors
    /// [`Error::Usage`] if it is none of them.
    pub fn of(file: &Path) -> Result<Self> {
        Self::of_ending(file).ok_or_else(|| unknown(file, ""))
    }

    fn of_ending(file: &Path) -> Option<Self> {
        match ending(file).as_str() {
            "svg" => Some(FigureFormat::Svg),
            "pdf" => Some(FigureFormat::Pdf),
            "png" => Some(FigureFormat::Png),
            _ => None,
        }
    }
}

/// What a scene is drawn as in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureFile {
    /// The figure of its curves.
    Curves(FigureFormat),
    /// The impact moving, a GIF.
    Animation,
}

impl FigureFile {
    /// What the ending of `file` stands for.
    ///
    /// # Errors
    /// [`Error::Usage`] if it is none of them.
    pub fn of(file: &Path) -> Result<Self> {
        if ending(file) == "gif" {
            return Ok(FigureFile::Animation);
        }
        let format = FigureFormat::of_ending(file).map(FigureFile::Curves);
        format.ok_or_else(|| unknown(file, ", of a plate impact that moves in .gif"))
    }
}

fn ending(file: &Path) -> String {
    file.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

fn unknown(file: &Path, more: &str) -> Error {
    Error::Usage(format!("--figure {}: the name has to end in .svg, .pdf or .png{more}", file.display()))
}

/// The figure of a scene, `width` mm wide (within [`crate::report::FIGURE_WIDTHS`]), or its animation as a file's bytes.
///
/// # Errors
/// [`Error::Internal`] if it can't be drawn, or the report has no animation.
pub fn figure_file(report: &SceneReport, width: f64, file: FigureFile) -> Result<Vec<u8>> {
    match file {
        FigureFile::Curves(format) => format.of_svg(printed_figure(report, width), &report.scene.name),
        FigureFile::Animation => {
            let film = report.attachments.film.as_ref();
            film.map(|film| film.gif.clone()).ok_or_else(|| Error::Internal("there is no animation".into()))
        }
    }
}
