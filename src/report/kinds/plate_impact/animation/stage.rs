//! What all frames of an animation have in common: the part of the scene in view, the scales, and the fields.

use super::forces::ForceCurves;
use crate::curves::peak;
use crate::error::Result;
use crate::format::{minus, model_name};
use crate::kinds::plate_impact::PlateImpact;
use crate::movement::Movement;
use crate::plot::colours::{hex, of_model};
use crate::plot::raster::{QuadMesh, Raster, View};
use crate::plot::ticks::round_below;
use crate::reference::FieldMesh;
use crate::result::Outcome;
use crate::scene::Scene;

/// Width of a frame, and of the picture of the scene in it, px.
pub(super) const WIDTH: usize = 640;
const MARGIN: usize = 12;
const PICTURE: usize = WIDTH - 2 * MARGIN;
/// What stands above the picture, px.
const TOP: usize = 52;
/// Most that is seen above and below the plate's middle, over its radius.
const HALF_HEIGHT: f64 = 0.42;
/// The largest displacement is drawn as this part of the picture's height, or somewhat less.
const LARGEST: f64 = 0.13;
/// Share of the section in view whose stress the colours cover, in every frame: waves in the plate are to be seen.
const SHARE: f64 = 0.95;
/// Pixels of a frame per px of its drawing.
pub(super) const SCALE: f64 = 1.25;
/// Pixels of a field in a pixel of a frame, across and down.
const SAMPLES: usize = 2;

pub(super) struct Stage<'a> {
    pub(super) scene: &'a Scene,
    pub(super) setup: &'a PlateImpact,
    pub(super) movement: &'a Movement,
    pub(super) model: String,
    pub(super) colour: String,
    pub(super) forces: ForceCurves,
    pub(super) view: View,
    /// By which displacements are drawn too large.
    pub(super) exaggeration: f64,
    /// Stress at the end of the scale of colours, Pa.
    pub(super) largest: f64,
}

/// A field where it is in the frame.
pub(super) struct Placed(Raster);

impl Placed {
    /// Colour at a pixel of the frame on a `ground`; the field has the left half of the picture.
    pub(super) fn colour_at(&self, x: usize, y: usize, ground: [u8; 3]) -> [u8; 3] {
        let from = |place: usize, start: usize| place.checked_sub((start as f64 * SCALE) as usize);
        let ([width, height], (Some(x), Some(y))) = (self.0.size(), (from(x, MARGIN), from(y, TOP))) else {
            return ground;
        };
        if 2 * SAMPLES * (x + 1) > width || SAMPLES * (y + 1) > height {
            return ground;
        }
        let mut sum = [0_usize; 3];
        for sample in 0..SAMPLES * SAMPLES {
            let (x, y) = (SAMPLES * x + sample % SAMPLES, SAMPLES * y + sample / SAMPLES);
            let colour = self.0.colour(x, y).unwrap_or(ground);
            sum.iter_mut().zip(colour).for_each(|(sum, c)| *sum += usize::from(c));
        }
        sum.map(|sum| (sum / (SAMPLES * SAMPLES)) as u8)
    }
}

impl<'a> Stage<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        reference: &Outcome,
        reduced: &Outcome,
        movement: &'a Movement,
    ) -> Result<Self> {
        let setup = scene.plate_impact()?;
        let view = view(setup);
        let displacements = movement.bodies.iter().chain(&movement.deflection).map(|values| peak(values));
        let largest = displacements.fold(0.0, f64::max);
        let room = LARGEST * (view.high - view.low);
        let within = |mesh: &FieldMesh| {
            mesh.von_mises
                .as_ref()
                .map_or(0.0, |values| Raster::within(mesh.into(), values, SHARE, view, PICTURE))
        };
        let model = reduced.summary.model.as_deref().unwrap_or_default();
        Ok(Stage {
            scene,
            setup,
            movement,
            model: format!("model {}", model_name(model, reduced.summary.modes)),
            colour: hex(of_model(model)),
            forces: ForceCurves::new(reference, reduced, movement),
            view,
            exaggeration: if largest > 0.0 { round_below(room / largest).max(1.0) } else { 1.0 },
            largest: movement.fields.iter().map(within).fold(0.0, f64::max),
        })
    }

    /// Left, top, width and height of the picture of the scene, px.
    pub(super) fn picture(&self) -> [f64; 4] {
        let height = PICTURE as f64 * (self.view.high - self.view.low) / (2.0 * self.view.radius);
        [MARGIN as f64, TOP as f64, PICTURE as f64, height.round()]
    }

    /// The field of frame number `k`, deformed.
    pub(super) fn field(&self, k: usize) -> Option<Placed> {
        let mesh = self.movement.fields.get(k)?;
        let (stress, moved) = (mesh.von_mises.as_ref()?, mesh.displacement.as_ref()?);
        let place = |(p, u): (&[f64; 2], &[f64; 2])| [0, 1].map(|c| p[c] + self.exaggeration * u[c]);
        let points: Vec<[f64; 2]> = mesh.points.iter().zip(moved).map(place).collect();
        let mesh = QuadMesh { points: &points, quads: &mesh.quads, bodies: &mesh.bodies };
        let width = (PICTURE as f64 * SCALE) as usize * SAMPLES;
        Some(Placed(Raster::field(mesh, stress, self.largest, self.view, width)))
    }

    /// How large displacements are drawn, in words.
    pub(super) fn scale_told(&self) -> String {
        format!("displacements × {}", minus(&format!("{}", self.exaggeration)))
    }

    /// What the animation shows, in a sentence.
    pub(super) fn told(&self) -> String {
        let scale = self.scale_told();
        if self.movement.fields.is_empty() {
            return format!("The impact in {}, {scale}.", self.model);
        }
        format!(
            "The impact in section: on the left the reference with its von Mises stress, on the right the deflection and the rigid \
             bodies of {}; {scale} in both.",
            self.model
        )
    }
}

/// The plate with as much of the bodies as there is room for.
fn view(setup: &PlateImpact) -> View {
    let plate = &setup.plate;
    let body = setup.outer.shape.tip_radius().max(setup.inner.shape.tip_radius() + 0.5 * setup.inner.gap);
    let half =
        (0.55 * plate.thickness + 2.0 * body).min(HALF_HEIGHT * plate.radius).max(2.0 * plate.thickness);
    View { radius: 1.03 * plate.radius, low: -half, high: half }
}
