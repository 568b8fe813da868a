//! The colours of an animation: one palette for all its frames, so that what does not move stays the same.

use super::AnimationFrame;
use crate::error::{Error, Result};
use crate::plot::colours::cividis;
use crate::plot::colours::{BODIES, MODELS};
use std::collections::HashMap;

/// Colours of the field, from its lowest to its highest value.
const LEVELS: usize = 96;
/// Greys from black to white.
const GREYS: usize = 16;
/// Colours between one of a body or a model and white, and between it and an outline.
const STEPS: usize = 4;

/// At most 255 colours, and one index for a pixel that stays as it was.
pub(super) struct Palette {
    colours: Vec<[u8; 3]>,
    known: HashMap<[u8; 3], u8>,
}

impl Palette {
    /// The index of a pixel that stays as it was.
    pub(super) const SAME: u8 = 255;

    pub(super) fn new() -> Self {
        let between = |from: [u8; 3], to: u8, share: f64| {
            from.map(|c| (f64::from(c) + share * (f64::from(to) - f64::from(c))).round() as u8)
        };
        let mut colours: Vec<[u8; 3]> = (0..GREYS).map(|k| [(k * 255 / (GREYS - 1)) as u8; 3]).collect();
        for base in BODIES.into_iter().chain(MODELS.map(|(_, colour)| colour)) {
            let steps = (0..STEPS).map(|k| k as f64 / STEPS as f64);
            colours.extend(steps.clone().map(|share| between(base, 255, share)));
            colours.extend(steps.skip(1).map(|share| between(base, 60, share)));
        }
        colours.extend((0..LEVELS).map(|k| cividis(k as f64 / (LEVELS - 1) as f64)));
        Palette { colours, known: HashMap::new() }
    }

    /// Index of the nearest colour.
    pub(super) fn index(&mut self, colour: [u8; 3]) -> u8 {
        let colours = &self.colours;
        *self.known.entry(colour).or_insert_with(|| {
            let distance = |other: &[u8; 3]| -> u32 {
                other.iter().zip(colour).map(|(a, b)| u32::from(a.abs_diff(b)).pow(2)).sum()
            };
            (0..colours.len()).min_by_key(|k| distance(&colours[*k])).unwrap_or(0) as u8
        })
    }

    /// 256 colours.
    pub(super) fn colours(&self) -> Vec<[u8; 3]> {
        let mut colours = self.colours.clone();
        colours.resize(256, [255; 3]);
        colours
    }

    /// PNG of a frame.
    ///
    /// # Errors
    /// [`Error::Internal`] if it can't be encoded.
    pub(super) fn png(&self, frame: &AnimationFrame) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, frame.width as u32, frame.height as u32);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(self.colours().concat());
        encoder.set_filter(png::Filter::NoFilter);
        let failed = |e: png::EncodingError| Error::Internal(format!("drawing a frame: {e}"));
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(&frame.pixels).map_err(failed)?;
        writer.finish().map_err(failed)?;
        Ok(bytes)
    }
}
