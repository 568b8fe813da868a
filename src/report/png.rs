//! Raster image of the figure, drawn from its SVG with an embedded font.

use crate::error::{Error, Result};
use resvg::{tiny_skia, usvg};
use std::sync::Arc;

/// DejaVu Sans; licence in `fonts/LICENSE.DejaVu`. Embedded so that the picture is the same everywhere.
const FONT: &[u8] = include_bytes!("fonts/DejaVuSans.ttf");

/// PNG of a stand-alone SVG, `scale` px per unit of the drawing.
///
/// # Errors
/// [`Error::Internal`] if the SVG is not valid or the picture too large.
pub fn png(svg: &str, scale: f32) -> Result<Vec<u8>> {
    let mut options = usvg::Options { font_family: "DejaVu Sans".into(), ..usvg::Options::default() };
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let internal = |what: &str| Error::Internal(format!("drawing the figure: {what}"));
    let tree = usvg::Tree::from_str(svg, &options).map_err(|e| internal(&e.to_string()))?;
    let size = tree.size().to_int_size().scale_by(scale).ok_or_else(|| internal("no size"))?;
    let mut pixmap =
        tiny_skia::Pixmap::new(size.width(), size.height()).ok_or_else(|| internal("too large"))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    pixmap.encode_png().map_err(|e| internal(&e.to_string()))
}
