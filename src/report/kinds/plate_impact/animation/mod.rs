//! The impact moving: on the left the reference's stress, on the right a reduced model's deflection, below them the forces.

mod forces;
mod frame;
mod palette;
mod stage;

use crate::error::{Error, Result};
use crate::movement::Movement;
use crate::plot::png::raster;
use crate::report::attachments::instant_of_peak;
use crate::result::Outcome;
use crate::scene::Scene;
use palette::Palette;
use resvg::tiny_skia::PremultipliedColorU8;
use stage::{SCALE, Stage};

/// Hundredths of a second that all frames take together, and those that the last one stays.
const DURATION: usize = 500;
const PAUSE: u16 = 120;

/// An animation and one of its frames.
#[derive(Debug, Clone, PartialEq)]
pub struct Animation {
    /// The animation as GIF.
    pub gif: Vec<u8>,
    /// PNG of the frame nearest to the largest force.
    pub still: Vec<u8>,
    /// Instant of that frame, s.
    pub instant: f64,
    /// What it shows, in a sentence.
    pub told: String,
}

/// The animation of `scene`.
///
/// # Errors
/// [`Error::Internal`] if it can't be drawn.
pub fn film(
    scene: &Scene,
    reference: &Outcome,
    reduced: &[Outcome],
    movement: &Movement,
) -> Result<Animation> {
    let stage = Stage::new(scene, reference, &reduced[movement.model], movement)?;
    let mut palette = Palette::new();
    let frames = (0..movement.times.len()).map(|k| AnimationFrame::new(&stage, k, &mut palette));
    let frames: Vec<AnimationFrame> = frames.collect::<Result<_>>()?;
    let peak = instant_of_peak(&reference.history, "outer_force");
    let distance = |k: &usize| (movement.times[*k] - peak).abs();
    let nearest = (0..frames.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
    Ok(Animation {
        gif: gif(&frames, &palette).map_err(|e| internal(&e.to_string()))?,
        still: palette.png(&frames[nearest])?,
        instant: movement.times[nearest],
        told: stage.told(),
    })
}

fn internal(what: &str) -> Error {
    Error::Internal(format!("drawing the animation: {what}"))
}

/// Indices into the palette, row by row.
struct AnimationFrame {
    width: usize,
    height: usize,
    pixels: Vec<u8>,
}

impl AnimationFrame {
    /// Frame number `k`: the drawing, and the field in its left half.
    fn new(stage: &Stage, k: usize, palette: &mut Palette) -> Result<Self> {
        let drawing = raster(&frame::svg(stage, k), SCALE as f32)?;
        let (width, height) = (drawing.width() as usize, drawing.height() as usize);
        let field = stage.field(k);
        let index = |(n, pixel): (usize, &PremultipliedColorU8)| {
            let ground = [pixel.red(), pixel.green(), pixel.blue()];
            let shown = field.as_ref().map_or(ground, |field| field.colour_at(n % width, n / width, ground));
            palette.index(shown)
        };
        Ok(AnimationFrame { width, height, pixels: drawing.pixels().iter().enumerate().map(index).collect() })
    }
}

/// Frames one after the other, of each what has changed.
fn gif(frames: &[AnimationFrame], palette: &Palette) -> std::result::Result<Vec<u8>, gif::EncodingError> {
    let mut bytes = Vec::new();
    let [width, height] = frames.first().map_or([0; 2], |frame| [frame.width as u16, frame.height as u16]);
    let mut encoder = gif::Encoder::new(&mut bytes, width, height, &palette.colours().concat())?;
    encoder.set_repeat(gif::Repeat::Infinite)?;
    for (k, frame) in frames.iter().enumerate() {
        let before = k.checked_sub(1).map(|before| &frames[before]);
        let buffer: Vec<u8> = match before {
            None => frame.pixels.clone(),
            Some(before) => {
                let both = frame.pixels.iter().zip(&before.pixels);
                both.map(|(new, old)| if new == old { Palette::SAME } else { *new }).collect()
            }
        };
        encoder.write_frame(&gif::Frame {
            width,
            height,
            delay: if k + 1 == frames.len() { PAUSE } else { (DURATION / frames.len()).max(2) as u16 },
            transparent: before.map(|_| Palette::SAME),
            dispose: gif::DisposalMethod::Keep,
            buffer: buffer.into(),
            ..gif::Frame::default()
        })?;
    }
    drop(encoder);
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinds::plate_impact::reduced::Reduced;
    use crate::reference::FieldMesh;
    use crate::scene::Model;

    const FRAMES: usize = 9;

    /// A block of the plate's size that rises by 10 µm per frame, with the stress of its frame's number.
    fn block(k: usize) -> FieldMesh {
        let (r, h) = (0.033, 0.001);
        FieldMesh {
            points: vec![[0.0, -h], [r, -h], [r, h], [0.0, h]],
            quads: vec![[0, 1, 2, 3]],
            bodies: vec![1],
            von_mises: Some(vec![1e6 * k as f64]),
            plastic_strain: None,
            displacement: Some(vec![[0.0, 1e-5 * k as f64]; 4]),
        }
    }

    fn acted(fields: Vec<FieldMesh>) -> (Animation, Vec<Vec<u8>>, [usize; 2]) {
        let text = include_str!("../../../../../tests/fixtures/plate-impact.toml");
        let scene = Scene::parse("plate-impact.toml", text).expect("valid");
        let run =
            |model| Reduced::new(&scene, model, None).and_then(|r| r.run_with_history(1e-6)).expect("runs");
        let outcomes = [run(Model::A), run(Model::B)];
        let movement = Movement {
            times: (0..FRAMES).map(|k| 2e-5 * k as f64).collect(),
            fields,
            model: 1,
            radii: vec![0.0, 0.033],
            deflection: (0..FRAMES).map(|k| vec![1e-5 * k as f64; 2]).collect(),
            bodies: [vec![0.0; FRAMES], vec![0.0; FRAMES]],
        };
        let film = film(&scene, &outcomes[0], &outcomes, &movement).expect("film");
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::Indexed);
        let mut decoder = options.read_info(&film.gif[..]).expect("GIF");
        let size = [usize::from(decoder.width()), usize::from(decoder.height())];
        let palette = decoder.global_palette().expect("one for all frames").to_vec();
        let mut canvas = vec![0; 3 * size[0] * size[1]];
        let mut shown = Vec::new();
        while let Some(frame) = decoder.read_next_frame().expect("frame") {
            assert_eq!([usize::from(frame.width), usize::from(frame.height)], size);
            for (n, index) in frame.buffer.iter().enumerate().filter(|(_, i)| Some(**i) != frame.transparent)
            {
                let colour = 3 * usize::from(*index);
                canvas[3 * n..3 * n + 3].copy_from_slice(&palette[colour..colour + 3]);
            }
            shown.push(canvas.clone());
        }
        (film, shown, size)
    }

    /// Rows of the picture (from its top) in which the column at a share of the width has the plate.
    fn rows(
        frame: &[u8],
        [width, height]: [usize; 2],
        share: f64,
        is_plate: impl Fn([u8; 3]) -> bool,
    ) -> Vec<usize> {
        let column = (share * width as f64) as usize;
        let at = |y: usize| std::array::from_fn(|c| frame[3 * (y * width + column) + c]);
        (70..height / 2).filter(|y| is_plate(at(*y))).collect()
    }

    #[test]
    fn both_halves_rise_by_the_stated_factor_and_the_colour_is_that_of_the_stress() {
        let (film, shown, size) = acted((0..FRAMES).map(block).collect());
        assert_eq!(shown.len(), FRAMES);
        assert_eq!(size[0], 800);
        let near = |a: [u8; 3], b: [u8; 3]| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) < 12);
        let factor: f64 =
            film.told.split("× ").nth(1).and_then(|t| t.split(' ').next()).unwrap().parse().unwrap();
        // 770 pixels are 1.03 times the plate's diameter
        let expected = factor * 8e-5 * 770.0 / (2.06 * 0.033);
        assert!(expected > 10.0, "{expected}");
        let highest = |k: usize, share: f64, colour: [u8; 3]| {
            *rows(&shown[k], size, share, |c| near(c, colour)).first().expect("the plate is there") as f64
        };
        let stress = |k: usize| crate::plot::colours::cividis(k as f64 / (FRAMES - 1) as f64);
        let rise = highest(0, 0.2, stress(0)) - highest(FRAMES - 1, 0.2, stress(FRAMES - 1));
        assert!((rise - expected).abs() <= 2.0, "the reference rises by {rise}, expected {expected}");
        let plate = [226, 226, 220];
        let rise = highest(0, 0.8, plate) - highest(FRAMES - 1, 0.8, plate);
        assert!((rise - expected).abs() <= 2.0, "the model rises by {rise}, expected {expected}");
        // the marker's line moves to the right over the forces
        let marker = |frame: &Vec<u8>| {
            // below the panel's frame, above the largest force
            let y = size[1] - (155.0 * SCALE) as usize;
            let dark = |x: &usize| frame[3 * (y * size[0] + x)..][..3].iter().all(|c| *c < 120);
            (100..785).find(dark).expect("marker")
        };
        assert!(marker(&shown[2]) < marker(&shown[5]));
        assert!(film.still.starts_with(b"\x89PNG") && film.told.contains("von Mises"), "{}", film.told);
    }

    #[test]
    fn without_fields_the_model_is_on_both_sides() {
        let (film, shown, size) = acted(Vec::new());
        let plate = |c: [u8; 3]| c == [226, 226, 220];
        assert_eq!(rows(&shown[4], size, 0.2, plate).len(), rows(&shown[4], size, 0.8, plate).len());
        assert!(rows(&shown[4], size, 0.2, plate).len() > 10);
        assert!(!film.told.contains("reference"), "{}", film.told);
    }
}
