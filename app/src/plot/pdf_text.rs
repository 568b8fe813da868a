//! Text of a PDF: glyphs of the embedded font, of which the file gets the part it uses, and what they read as.

use crate::error::{Error, Result};
use crate::plot::png::FONT;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str};
use resvg::usvg::layout::{PositionedGlyph, Span};
use resvg::usvg::{Group, Node, Text};
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, GlyphId, MetadataProvider};
use std::collections::BTreeMap;
use subsetter::GlyphRemapper;

/// The font in the page's resources.
pub(crate) const RESOURCE: Name<'static> = Name(b"F0");
/// Name of the font; the six letters say that it is a part of one.
const FONT_NAME: Name<'static> = Name(b"IMPACT+DejaVuSans");
/// Of the font.
const UNITS_PER_EM: f32 = 2048.0;
const CMAP_NAME: Name<'static> = Name(b"Custom");
const SYSTEM: SystemInfo<'static> =
    SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

/// Whether a text is written as text: what has a halo is drawn behind another one that says the same.
pub(crate) fn is_written(text: &Text) -> bool {
    text.layouted().iter().all(|span| span.stroke.is_none())
}

/// The glyphs a drawing writes, and what they read as.
#[derive(Default)]
pub(crate) struct Glyphs {
    /// New numbers of the glyphs, those of the font's part.
    numbers: GlyphRemapper,
    /// By the glyph's number in the font.
    text: BTreeMap<u16, String>,
}

impl Glyphs {
    /// Those of all written texts in `group`.
    pub(crate) fn of(group: &Group) -> Self {
        let mut glyphs = Glyphs::default();
        glyphs.collect(group);
        glyphs
    }

    fn collect(&mut self, group: &Group) {
        for node in group.children() {
            match node {
                Node::Group(inner) => self.collect(inner),
                Node::Text(text) if is_written(text) => {
                    for glyph in text.layouted().iter().flat_map(|span| &span.positioned_glyphs) {
                        if let Ok(id) = u16::try_from(glyph.id.0) {
                            self.numbers.remap(id);
                            self.text.insert(id, glyph.text.clone());
                        }
                    }
                }
                _ => {}
            }
        }
    }

    /// Writes the glyphs of `span` where they stand; its colour is set already.
    pub(crate) fn write(&self, content: &mut Content, span: &Span) {
        content.begin_text();
        content.set_font(RESOURCE, 1.0);
        for glyph in &span.positioned_glyphs {
            let number = u16::try_from(glyph.id.0).ok().and_then(|id| self.numbers.get(id));
            if let Some(number) = number {
                content.set_text_matrix(matrix(glyph));
                content.show(Str(&number.to_be_bytes()));
            }
        }
        content.end_text();
    }

    /// Writes the font as object `first` and the four after it.
    ///
    /// # Errors
    /// [`Error::Internal`] if the font can't be taken apart.
    pub(crate) fn write_font(
        &self,
        pdf: &mut Pdf,
        first: i32,
        compressed: impl Fn(&[u8]) -> Result<Vec<u8>>,
    ) -> Result<()> {
        let failed = |e: String| Error::Internal(format!("embedding the font of the figure: {e}"));
        let [font, descendant, descriptor, file, unicode] = [0, 1, 2, 3, 4].map(|k| Ref::new(first + k));
        let face = FontRef::new(FONT).map_err(|e| failed(e.to_string()))?;
        let metrics = face.metrics(Size::unscaled(), LocationRef::default());
        let advances = face.glyph_metrics(Size::unscaled(), LocationRef::default());
        let per_em = 1000.0 / UNITS_PER_EM;
        let part = subsetter::subset(FONT, 0, &self.numbers).map_err(|e| failed(e.to_string()))?;

        pdf.type0_font(font)
            .base_font(FONT_NAME)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(descendant)
            .to_unicode(unicode);
        let mut cid = pdf.cid_font(descendant);
        cid.subtype(CidFontType::Type2).base_font(FONT_NAME).system_info(SYSTEM).font_descriptor(descriptor);
        cid.cid_to_gid_map_predefined(Name(b"Identity"));
        let width = |id: u16| per_em * advances.advance_width(GlyphId::new(u32::from(id))).unwrap_or(0.0);
        cid.widths().consecutive(0, self.numbers.remapped_gids().map(width));
        cid.finish();
        let bounds = metrics.bounds.unwrap_or_default();
        let [left, low, right, high] =
            [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max].map(|v| per_em * v);
        pdf.font_descriptor(descriptor)
            .name(FONT_NAME)
            .flags(FontFlags::NON_SYMBOLIC)
            .bbox(Rect::new(left, low, right, high))
            .italic_angle(0.0)
            .ascent(per_em * metrics.ascent)
            .descent(per_em * metrics.descent)
            .cap_height(per_em * metrics.cap_height.unwrap_or(metrics.ascent))
            // the width of an upright stem; a hint for substitutes, which are not needed
            .stem_v(80.0)
            .font_file2(file);
        let mut stream = compressed(&part)?;
        pdf.stream(file, &stream).filter(Filter::FlateDecode).pair(Name(b"Length1"), part.len() as i32);
        let mut cmap = UnicodeCmap::<u16>::new(CMAP_NAME, SYSTEM);
        for (id, text) in &self.text {
            if let Some(number) = self.numbers.get(*id) {
                cmap.pair_with_multiple(number, text.chars());
            }
        }
        stream = compressed(&cmap.finish().into_vec())?;
        pdf.cmap(unicode, &stream).filter(Filter::FlateDecode);
        Ok(())
    }
}

/// From the em square, y up, to the drawing.
fn matrix(glyph: &PositionedGlyph) -> [f32; 6] {
    let t = glyph.outline_transform();
    let em = UNITS_PER_EM;
    [em * t.sx, em * t.ky, em * t.kx, em * t.sy, t.tx, t.ty]
}
