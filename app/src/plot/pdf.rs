//! PDF of a figure: the paths of its SVG, and its text, which can be searched and copied.

use crate::error::{Error, Result};
use crate::plot::pdf_text::{self, Glyphs};
use crate::plot::png::{SVG_RESOLUTION, tree};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish, Pdf, Rect, Ref, TextStr};
use resvg::tiny_skia::{PathSegment, Point, Transform};
use resvg::usvg::{FillRule, Group, LineCap, LineJoin, Node, Paint, PaintOrder, Path, Text, Tree};
use std::io::Write;

/// Number of the font's first object.
const FIRST_OF_FONT: i32 = 6;
/// Points of a PDF per px of an SVG.
const POINTS: f32 = 72.0 / SVG_RESOLUTION;

fn internal(what: impl std::fmt::Display) -> Error {
    Error::Internal(format!("writing the figure as PDF: {what}"))
}

/// One page of the size of the drawing.
///
/// # Errors
/// [`Error::Internal`] if the SVG is not valid, or has what figures don't have: images, gradients, translucency.
pub(crate) fn pdf(svg: &str, title: &str) -> Result<Vec<u8>> {
    let tree = tree(svg)?;
    let glyphs = Glyphs::of(tree.root());
    let content = compressed(&content(&tree, &glyphs)?)?;
    let [catalog, pages, page, contents, info] = [1, 2, 3, 4, 5].map(Ref::new);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([page]).count(1);
    let (width, height) = (tree.size().width() * POINTS, tree.size().height() * POINTS);
    let mut sheet = pdf.page(page);
    sheet.media_box(Rect::new(0.0, 0.0, width, height)).parent(pages).contents(contents);
    sheet.resources().fonts().pair(pdf_text::RESOURCE, Ref::new(FIRST_OF_FONT));
    sheet.finish();
    pdf.stream(contents, &content).filter(Filter::FlateDecode);
    glyphs.write_font(&mut pdf, FIRST_OF_FONT, compressed)?;
    pdf.document_info(info).title(TextStr(title)).creator(TextStr("impactcheck"));
    Ok(pdf.finish())
}

fn compressed(bytes: &[u8]) -> Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).map_err(internal)
}

fn content(tree: &Tree, glyphs: &Glyphs) -> Result<Vec<u8>> {
    let mut content = Content::new();
    // y points up in a PDF
    content.transform([POINTS, 0.0, 0.0, -POINTS, 0.0, tree.size().height() * POINTS]);
    group(&mut content, tree.root(), glyphs)?;
    Ok(content.finish().to_vec())
}

fn group(content: &mut Content, of: &Group, glyphs: &Glyphs) -> Result<()> {
    if of.opacity().get() < 1.0 || of.clip_path().is_some() || of.mask().is_some() || !of.filters().is_empty()
    {
        return Err(internal("groups with opacity, clip, mask or filter"));
    }
    for node in of.children() {
        match node {
            Node::Group(inner) => group(content, inner, glyphs)?,
            Node::Text(text) if pdf_text::is_written(text) => write(content, text, glyphs)?,
            Node::Text(text) => group(content, text.flattened(), glyphs)?,
            Node::Path(path) if path.is_visible() => draw(content, path)?,
            Node::Path(_) => {}
            Node::Image(_) => return Err(internal("an image")),
        }
    }
    Ok(())
}

fn write(content: &mut Content, text: &Text, glyphs: &Glyphs) -> Result<()> {
    content.save_state();
    transform(content, text.abs_transform());
    for span in text.layouted().iter().filter(|span| span.visible) {
        let Some(fill) = &span.fill else { continue };
        let [r, g, b] = colour(fill.paint(), fill.opacity().get())?;
        content.set_fill_rgb(r, g, b);
        glyphs.write(content, span);
    }
    content.restore_state();
    Ok(())
}

fn transform(content: &mut Content, t: Transform) {
    content.transform([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty]);
}

fn draw(content: &mut Content, path: &Path) -> Result<()> {
    content.save_state();
    transform(content, path.abs_transform());
    match path.paint_order() {
        PaintOrder::FillAndStroke => {
            fill(content, path)?;
            stroke(content, path)?;
        }
        PaintOrder::StrokeAndFill => {
            stroke(content, path)?;
            fill(content, path)?;
        }
    }
    content.restore_state();
    Ok(())
}

fn fill(content: &mut Content, path: &Path) -> Result<()> {
    let Some(fill) = path.fill() else { return Ok(()) };
    let [r, g, b] = colour(fill.paint(), fill.opacity().get())?;
    content.set_fill_rgb(r, g, b);
    outline(content, path);
    match fill.rule() {
        FillRule::NonZero => content.fill_nonzero(),
        FillRule::EvenOdd => content.fill_even_odd(),
    };
    Ok(())
}

fn stroke(content: &mut Content, path: &Path) -> Result<()> {
    let Some(stroke) = path.stroke() else { return Ok(()) };
    let [r, g, b] = colour(stroke.paint(), stroke.opacity().get())?;
    content.set_stroke_rgb(r, g, b).set_line_width(stroke.width().get());
    content.set_line_cap(match stroke.linecap() {
        LineCap::Butt => LineCapStyle::ButtCap,
        LineCap::Round => LineCapStyle::RoundCap,
        LineCap::Square => LineCapStyle::ProjectingSquareCap,
    });
    content.set_line_join(match stroke.linejoin() {
        LineJoin::Round => LineJoinStyle::RoundJoin,
        LineJoin::Bevel => LineJoinStyle::BevelJoin,
        LineJoin::Miter | LineJoin::MiterClip => LineJoinStyle::MiterJoin,
    });
    let dashes = stroke.dasharray().unwrap_or_default();
    content.set_dash_pattern(dashes.iter().copied(), stroke.dashoffset());
    outline(content, path);
    content.stroke();
    Ok(())
}

fn colour(paint: &Paint, opacity: f32) -> Result<[f32; 3]> {
    match paint {
        Paint::Color(c) if opacity == 1.0 => Ok([c.red, c.green, c.blue].map(|v| f32::from(v) / 255.0)),
        Paint::Color(_) => Err(internal("a translucent colour")),
        _ => Err(internal("a gradient or a pattern")),
    }
}

fn outline(content: &mut Content, path: &Path) {
    let mut last = Point::zero();
    for segment in path.data().segments() {
        match segment {
            PathSegment::MoveTo(p) => {
                content.move_to(p.x, p.y);
                last = p;
            }
            PathSegment::LineTo(p) => {
                content.line_to(p.x, p.y);
                last = p;
            }
            PathSegment::QuadTo(c, p) => {
                // the same curve as a cubic
                let toward = |end: Point| Point {
                    x: end.x + 2.0 / 3.0 * (c.x - end.x),
                    y: end.y + 2.0 / 3.0 * (c.y - end.y),
                };
                let (a, b) = (toward(last), toward(p));
                content.cubic_to(a.x, a.y, b.x, b.y, p.x, p.y);
                last = p;
            }
            PathSegment::CubicTo(a, b, p) => {
                content.cubic_to(a.x, a.y, b.x, b.y, p.x, p.y);
                last = p;
            }
            PathSegment::Close => {
                content.close_path();
            }
        }
    }
}
