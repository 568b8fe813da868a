//! Mesh and stress of the reference in section, after Fig. 9 of the paper.

use super::SceneReport;
use super::field_raster::{Raster, View, cividis};
use super::figure::x2;
use super::format::{prefixed, with_unit};
use super::ticks::{tick_label, ticks};
use crate::error::Result;
use crate::reference::FieldMesh;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::{Markup, html};

/// Width of a picture's drawing, and of the picture in it, in px of the drawing.
const WIDTH: f64 = 400.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 8.0;
const FONT_SIZE: f64 = 13.0;
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
pub(super) fn mesh_html(report: &SceneReport) -> Result<Markup> {
    let Some(mesh) = &report.attachments.mesh else { return Ok(html! {}) };
    let Some(views) = views(mesh, report) else { return Ok(html! {}) };
    let mut meshes = Vec::new();
    let mut stresses = Vec::new();
    for (k, view) in views.into_iter().enumerate() {
        meshes.push(picture(&Raster::mesh(mesh, view, PIXELS), view, None, &format!("mesh-{k}"))?);
        if let Some((_, stress)) = &report.attachments.stress
            && let Some(values) = &stress.von_mises
        {
            let share = if k == 0 { 1.0 } else { SHARE_IN_SCALE };
            let (raster, largest) = Raster::field(stress, values, share, view, PIXELS);
            stresses.push(picture(&raster, view, Some(largest), &format!("stress-{k}"))?);
        }
    }
    Ok(html! {
        figure.pictures {
            div.pair { @for picture in meshes { (picture) } }
            figcaption { "Mesh of the reference in section: contact, and the whole scene. r and z in mm; outer body above "
                "the plate, inner body below it. Lines are lighter where elements are smaller than a few pixels." }
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
    })
}

/// The contact, and everything.
fn views(mesh: &FieldMesh, report: &SceneReport) -> Option<[View; 2]> {
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (_, radius) = range(&mut mesh.points.iter().map(|p| p[0]));
    let (low, high) = range(&mut mesh.points.iter().map(|p| p[1]));
    let plate = mesh.quads.iter().zip(&mesh.bodies).filter(|(_, body)| **body == PLATE).flat_map(|(q, _)| q);
    let (bottom, top) = range(&mut plate.map(|n| mesh.points[*n][1]));
    let zone = report.provenance["settings"]["contact_zone"].as_f64().unwrap_or(0.0);
    let half = (1.5 * (top - bottom)).max(3.0 * zone).min(radius);
    let middle = 0.5 * (top + bottom);
    let near = View { radius: half, low: middle - 0.8 * half, high: middle + 0.8 * half };
    let sound = [half, radius, high - low].iter().all(|v| v.is_finite() && *v > 0.0);
    sound.then_some([near, View { radius, low, high }])
}

/// A picture with its axes and, for a field, the scale of its colours.
fn picture(raster: &Raster, view: View, largest: Option<f64>, id: &str) -> Result<Markup> {
    let width = WIDTH - LEFT - RIGHT;
    let height = width * raster.aspect();
    let bottom = TOP + height;
    let image = BASE64_STANDARD.encode(raster.png(largest.is_some())?);
    let x_of = |r: f64| LEFT + width * (r * 1e-3 + view.radius) / (2.0 * view.radius);
    let y_of = |z: f64| TOP + height * (view.high - z * 1e-3) / (view.high - view.low);
    let (r_marks, z_marks) = (
        ticks(-view.radius * 1e3, view.radius * 1e3, 5),
        ticks(view.low * 1e3, view.high * 1e3, (height / 50.0) as usize),
    );
    let total = bottom + if largest.is_some() { 92.0 } else { 44.0 };
    let name = if largest.is_some() { "Von Mises stress in section" } else { "Mesh in section" };
    Ok(html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {WIDTH} {total:.1}")) role="img"
            font-family="DejaVu Sans, Verdana, sans-serif" font-size=(FONT_SIZE) aria-labelledby=(format!("{id}-title")) {
            title id=(format!("{id}-title")) { (name) }
            image x=(LEFT) y=(TOP) width=(x2(width)) height=(x2(height)) preserveAspectRatio="none"
                href=(format!("data:image/png;base64,{image}")) {}
            rect.fig-frame x=(LEFT) y=(TOP) width=(x2(width)) height=(x2(height)) {}
            @for r in &r_marks {
                line.fig-frame x1=(x2(x_of(*r))) x2=(x2(x_of(*r))) y1=(x2(bottom)) y2=(x2(bottom + 4.0)) {}
                text.fig-text x=(x2(x_of(*r))) y=(x2(bottom + 18.0)) text-anchor="middle" { (tick_label(*r, &r_marks)) }
            }
            text.fig-text x=(x2(LEFT + 0.5 * width)) y=(x2(bottom + 36.0)) text-anchor="middle" { "r in mm" }
            @for z in &z_marks {
                line.fig-frame x1=(LEFT - 4.0) x2=(LEFT) y1=(x2(y_of(*z))) y2=(x2(y_of(*z))) {}
                text.fig-text x=(LEFT - 7.0) y=(x2(y_of(*z) + 4.7)) text-anchor="end" { (tick_label(*z, &z_marks)) }
            }
            text.fig-text transform=(format!("translate(13 {:.2}) rotate(-90)", TOP + 0.5 * height)) text-anchor="middle" {
                "z in mm"
            }
            @if let Some(largest) = largest { (colour_scale(largest, bottom + 46.0, id)) }
        }
    })
}

fn colour_scale(largest: f64, top: f64, id: &str) -> Markup {
    const STOPS: usize = 12;
    let width = WIDTH - LEFT - RIGHT;
    let to = 1e-6 * largest;
    let marks = ticks(0.0, to, 5);
    html! {
        defs { linearGradient id=(format!("{id}-scale")) {
            @for k in 0..=STOPS {
                @let share = k as f64 / STOPS as f64;
                @let [r, g, b] = cividis(share);
                stop offset=(x2(share)) stop-color=(format!("rgb({r},{g},{b})")) {}
            }
        } }
        rect.fig-edge x=(LEFT) y=(x2(top)) width=(x2(width)) height="10" fill=(format!("url(#{id}-scale)")) {}
        @for mark in &marks {
            @let x = LEFT + if to > 0.0 { width * mark / to } else { 0.0 };
            text.fig-text x=(x2(x)) y=(x2(top + 24.0)) text-anchor="middle" { (tick_label(*mark, &marks)) }
        }
        text.fig-text x=(x2(LEFT + 0.5 * width)) y=(x2(top + 41.0)) text-anchor="middle" { "von Mises stress in MPa" }
    }
}
