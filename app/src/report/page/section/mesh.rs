//! Mesh and stress of the reference in section, after Fig. 9 of the paper.

use crate::error::Result;
use crate::format::{prefixed, with_unit};
use crate::plot::frame::{Bounds, ColourScale, Frame};
use crate::plot::raster::{QuadMesh, Raster, View};
use crate::reference::FieldMesh;
use crate::report::SceneReport;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::{Markup, html};

/// Pixels of the picture.
const PIXELS: usize = 676;
/// Share of the whole scene's section whose stress the scale of colours covers: the contacts would leave nothing to see.
const SHARE_IN_SCALE: f64 = 0.97;
/// Number of the plate among the bodies.
const PLATE: usize = 1;

/// Section of the page; nothing if there is no picture to show.
///
/// # Errors
/// If a picture can't be encoded.
pub(crate) fn mesh_html(report: &SceneReport) -> Result<Markup> {
    let Some(mesh) = &report.attachments.mesh else { return Ok(html! {}) };
    let Some(views) = views(mesh, report) else { return Ok(html! {}) };
    let mut meshes = Vec::new();
    let mut stresses = Vec::new();
    for (k, view) in views.into_iter().enumerate() {
        meshes.push(picture(&Raster::mesh(mesh.into(), view, PIXELS), view, None, &format!("mesh-{k}"))?);
        if let Some((_, stress)) = &report.attachments.stress
            && let Some(values) = &stress.von_mises
        {
            let share = if k == 0 { 1.0 } else { SHARE_IN_SCALE };
            let largest = Raster::within(stress.into(), values, share, view, PIXELS);
            let raster = Raster::field(stress.into(), values, largest, view, PIXELS);
            stresses.push(picture(
                &raster,
                view,
                Some(ColourScale::von_mises(largest)),
                &format!("stress-{k}"),
            )?);
        }
    }
    Ok(html! {
        figure.pictures {
            div.pair { @for picture in meshes { (picture) } }
            figcaption { "Mesh of the reference in section: contact, and the whole scene. r and z in mm; outer body above "
                "the plate, inner body below it. Lines are the lighter the nearer they are to each other." }
        }
        @if let Some((time, _)) = &report.attachments.stress {
            figure.pictures {
                div.pair { @for picture in stresses { (picture) } }
                figcaption { "Von Mises stress at " (with_unit(*time, prefixed("s", *time), 4)) " (means at the nodes), "
                    "each picture with a scale of its own; that of the whole scene covers 97 % of the section, higher values "
                    "have its last colour. Between the contacts the plate is not free of stress, as Hertz's "
                    "law for half-spaces would have it." }
            }
        }
        (paraview(report))
    })
}

/// Where the fields of the reference are, or the command that stores them.
pub(crate) fn paraview(report: &SceneReport) -> Markup {
    html! {
        p.soft {
            "The impact over time in ParaView: "
            @if let Some(fields) = &report.attachments.fields { code { (fields.display()) } "; " }
            code { "impactcheck reference " (report.scene.name) " --fields 40" } " stores fields at 40 instants."
        }
    }
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

impl<'a> From<&'a FieldMesh> for QuadMesh<'a> {
    fn from(FieldMesh { points, quads, bodies, .. }: &'a FieldMesh) -> Self {
        QuadMesh { points, quads, bodies }
    }
}

/// z of the plate's lower and upper face, m.
pub(crate) fn face_heights(mesh: &FieldMesh) -> [f64; 2] {
    let plate = mesh.quads.iter().zip(&mesh.bodies).filter(|(_, body)| **body == PLATE).flat_map(|(q, _)| q);
    range(plate.map(|n| mesh.points[*n][1]))
}

/// The contact, and everything.
fn views(mesh: &FieldMesh, report: &SceneReport) -> Option<[View; 2]> {
    let [_, radius] = range(mesh.points.iter().map(|p| p[0]));
    let [low, high] = range(mesh.points.iter().map(|p| p[1]));
    let [bottom, top] = face_heights(mesh);
    let zone = report.provenance["settings"]["contact_zone"].as_f64().unwrap_or(0.0);
    let half = (1.5 * (top - bottom)).max(3.0 * zone).min(radius);
    let middle = 0.5 * (top + bottom);
    let near = View { radius: half, low: middle - 0.8 * half, high: middle + 0.8 * half };
    let sound = [half, radius, high - low].iter().all(|v| v.is_finite() && *v > 0.0);
    sound.then_some([near, View { radius, low, high }])
}

/// A picture with its axes and, for a field, the scale of its colours.
pub(crate) fn picture(raster: &Raster, view: View, scale: Option<ColourScale>, id: &str) -> Result<Markup> {
    let image = BASE64_STANDARD.encode(raster.png(scale.is_some())?);
    let bounds = Bounds { across: [-view.radius, view.radius], up: [view.low, view.high] };
    let name = scale.map_or("Mesh in section", |scale| scale.name);
    let frame = Frame { bounds, aspect: Some(raster.aspect()), across: "r in mm", scale, name, id };
    Ok(frame.around(|place| {
        let [x, y, width, height] = place.rectangle();
        html! {
            image x=(x) y=(y) width=(width) height=(height) preserveAspectRatio="none"
                href=(format!("data:image/png;base64,{image}")) {}
        }
    }))
}
