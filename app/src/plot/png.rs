//! Raster image of the figure, drawn from its SVG with an embedded font.

use crate::error::{Error, Result};
use resvg::{tiny_skia, usvg};
use std::sync::Arc;

/// DejaVu Sans; licence in `fonts/LICENSE.DejaVu`. Embedded so that the picture is the same everywhere.
pub(crate) const FONT: &[u8] = include_bytes!("fonts/DejaVuSans.ttf");
/// Pixels of an SVG per inch.
pub(crate) const SVG_RESOLUTION: f32 = 96.0;

fn internal(what: &str) -> Error {
    Error::Internal(format!("drawing the figure: {what}"))
}

/// The drawing with its text in the embedded font.
///
/// # Errors
/// [`Error::Internal`] if the SVG is not valid.
pub(crate) fn tree(svg: &str) -> Result<usvg::Tree> {
    let mut options = usvg::Options { font_family: "DejaVu Sans".into(), ..usvg::Options::default() };
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    usvg::Tree::from_str(svg, &options).map_err(|e| internal(&e.to_string()))
}

/// The drawing as pixels, `scale` px per unit of it.
///
/// # Errors
/// As [`png`].
fn raster(svg: &str, scale: f32) -> Result<tiny_skia::Pixmap> {
    let tree = tree(svg)?;
    let size = tree.size().to_int_size().scale_by(scale).ok_or_else(|| internal("no size"))?;
    let mut pixmap =
        tiny_skia::Pixmap::new(size.width(), size.height()).ok_or_else(|| internal("too large"))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    Ok(pixmap)
}

/// PNG of a stand-alone SVG, `scale` px per unit of the drawing.
///
/// # Errors
/// [`Error::Internal`] if the SVG is not valid or the picture too large.
pub fn png(svg: &str, scale: f32) -> Result<Vec<u8>> {
    let pixmap = raster(svg, scale)?;
    let straight = |p: &tiny_skia::PremultipliedColorU8| {
        let colour = p.demultiply();
        [colour.red(), colour.green(), colour.blue(), colour.alpha()]
    };
    let pixels: Vec<u8> = pixmap.pixels().iter().flat_map(straight).collect();
    encoded(&pixmap, png::ColorType::Rgba, &pixels, None)
}

/// The file of a picture, whose `pixels` have 8 bits per channel.
fn encoded(
    pixmap: &tiny_skia::Pixmap,
    colours: png::ColorType,
    pixels: &[u8],
    per_metre: Option<u32>,
) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixmap.width(), pixmap.height());
    encoder.set_color(colours);
    encoder.set_depth(png::BitDepth::Eight);
    // flat areas compress best as they are, and in a third of the time
    encoder.set_filter(png::Filter::NoFilter);
    encoder.set_deflate_compression(png::DeflateCompression::Level(3));
    let unit = png::Unit::Meter;
    encoder.set_pixel_dims(per_metre.map(|n| png::PixelDimensions { xppu: n, yppu: n, unit }));
    let failed = |e: png::EncodingError| internal(&e.to_string());
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(pixels).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// PNG of a stand-alone SVG with a white background, at `resolution` dots per inch of its size, which the file states.
///
/// # Errors
/// As [`png`].
pub(crate) fn printed_png(svg: &str, resolution: f32) -> Result<Vec<u8>> {
    const INCH: f32 = 0.0254;
    let pixmap = raster(svg, resolution / SVG_RESOLUTION)?;
    // the background is opaque, and so is every pixel
    let colours: Vec<u8> = pixmap.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]).collect();
    encoded(&pixmap, png::ColorType::Rgb, &colours, Some((resolution / INCH).round() as u32))
}
