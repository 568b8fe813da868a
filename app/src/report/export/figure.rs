//! Drawings as files for papers.

use super::{Export, by_ending};
use crate::error::Result;
use crate::plot::pdf::pdf;
use crate::plot::png::printed_png;
use std::path::Path;

/// Dots per inch of a PNG, what journals ask of line drawings.
const RESOLUTION: f32 = 600.0;

/// A drawing that has a file of its own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FigureFile {
    /// Title of the file.
    pub title: String,
    /// The drawing as a stand-alone SVG.
    pub svg: String,
}

/// The format that the ending of `file`, of the option `--figure`, names: SVG, PDF (text stays text, in an embedded font) or
/// PNG.
///
/// # Errors
/// [`Error::Usage`](crate::Error::Usage) if it names none.
pub fn figure_format(file: &Path) -> Result<&'static dyn Export<FigureFile>> {
    by_ending("--figure", file, &[&SvgFile, &PdfFile, &PngFile])
}

struct SvgFile;
struct PdfFile;
struct PngFile;

impl Export<FigureFile> for SvgFile {
    fn ending(&self) -> &'static str {
        "svg"
    }

    fn bytes(&self, figure: &FigureFile) -> Result<Vec<u8>> {
        Ok(figure.svg.clone().into_bytes())
    }
}

impl Export<FigureFile> for PdfFile {
    fn ending(&self) -> &'static str {
        "pdf"
    }

    fn bytes(&self, figure: &FigureFile) -> Result<Vec<u8>> {
        pdf(&figure.svg, &figure.title)
    }
}

impl Export<FigureFile> for PngFile {
    fn ending(&self) -> &'static str {
        "png"
    }

    fn bytes(&self, figure: &FigureFile) -> Result<Vec<u8>> {
        printed_png(&figure.svg, RESOLUTION)
    }
}
