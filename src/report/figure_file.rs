//! The figure of a scene as a file for a paper.

use super::{SceneReport, printed_figure};
use crate::error::{Error, Result};
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
    /// The impact moving: no figure of curves.
    Gif,
}

impl FigureFormat {
    /// A stand-alone drawing in this format.
    ///
    /// # Errors
    /// [`Error::Internal`] if it can't be drawn.
    pub fn of_svg(self, svg: String, title: &str) -> Result<Vec<u8>> {
        match self {
            FigureFormat::Svg => Ok(svg.into_bytes()),
            FigureFormat::Pdf => super::pdf::pdf(&svg, title),
            FigureFormat::Png => super::png::printed_png(&svg, RESOLUTION),
            FigureFormat::Gif => Err(Error::Internal("a drawing that stands still is no animation".into())),
        }
    }

    /// The format that the ending of `file` stands for.
    ///
    /// # Errors
    /// [`Error::Usage`] if it is none of them.
    pub fn of(file: &Path) -> Result<Self> {
        let ending = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match ending.as_str() {
            "svg" => Ok(FigureFormat::Svg),
            "pdf" => Ok(FigureFormat::Pdf),
            "png" => Ok(FigureFormat::Png),
            "gif" => Ok(FigureFormat::Gif),
            _ => Err(Error::Usage(format!(
                "--figure {}: the name has to end in .svg, .pdf or .png, of a plate impact that moves in .gif",
                file.display()
            ))),
        }
    }

    /// As [`FigureFormat::of`], of a drawing that does not move.
    ///
    /// # Errors
    /// [`Error::Usage`] if it is none of them.
    pub fn of_still(file: &Path) -> Result<Self> {
        match Self::of(file) {
            Ok(format) if format != FigureFormat::Gif => Ok(format),
            _ => Err(Error::Usage(format!(
                "--figure {}: the name has to end in .svg, .pdf or .png",
                file.display()
            ))),
        }
    }
}

/// The figure of a scene, `width` mm wide (within [`super::FIGURE_WIDTHS`]), or its animation as a file's bytes.
///
/// # Errors
/// [`Error::Internal`] if it can't be drawn.
pub fn figure_file(report: &SceneReport, width: f64, format: FigureFormat) -> Result<Vec<u8>> {
    match (format, &report.attachments.film) {
        (FigureFormat::Gif, Some(film)) => return Ok(film.gif.clone()),
        (FigureFormat::Gif, None) => return Err(Error::Internal("there is no animation".into())),
        _ => {}
    }
    format.of_svg(printed_figure(report, width), &report.scene.name)
}
