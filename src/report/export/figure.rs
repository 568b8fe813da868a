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
        match file.extension().unwrap_or_default().to_string_lossy().to_lowercase().as_str() {
            "svg" => Ok(FigureFormat::Svg),
            "pdf" => Ok(FigureFormat::Pdf),
            "png" => Ok(FigureFormat::Png),
            _ => Err(Error::Usage(format!(
                "--figure {}: the name has to end in .svg, .pdf or .png",
                file.display()
            ))),
        }
    }
}

/// The figure of a scene, `width` mm wide (within [`crate::report::FIGURE_WIDTHS`]), as a file's bytes.
///
/// # Errors
/// [`Error::Internal`] if it can't be drawn.
pub fn figure_file(report: &SceneReport, width: f64, format: FigureFormat) -> Result<Vec<u8>> {
    format.of_svg(printed_figure(report, width), &report.scene.name)
}
