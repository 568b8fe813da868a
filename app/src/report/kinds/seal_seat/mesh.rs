//! Mesh and stress of a seal seat's reference in the plane of symmetry.

use crate::format::{prefixed, with_unit};
use crate::plot::colours::cividis;
use crate::plot::frame::{Bounds, ColourScale, Frame, Place};
use crate::plot::svg::x2;
use crate::reference::MeshSection;
use crate::report::SceneReport;
use maud::{Markup, html};

/// Colours of stresses between 0 and the end of the scale.
const LEVELS: usize = 32;
/// Share of the section whose stress the scale of colours covers: the contacts would leave nothing to see.
const SHARE_IN_SCALE: f64 = 0.99;
/// Room around the seat in the closer view, over the sphere's radius.
const AROUND: f64 = 1.25;

/// Section of the page; nothing if there is no picture to show.
pub(super) fn mesh_html(report: &SceneReport) -> Markup {
    let Some(mesh) = &report.attachments.section else { return html! {} };
    let views = views(mesh, report);
    html! {
        figure.pictures {
            div.pair { @for (k, view) in views.iter().enumerate() { (picture(mesh, *view, None, &format!("mesh-{k}"))) } }
            figcaption { "Mesh of the reference, and of the reduced model, in the plane of symmetry: the seat of the sphere, and the "
                "whole. x and z in mm." }
        }
        @if let Some((time, section)) = &report.attachments.section_stress && let Some(values) = &section.von_mises {
            @let largest = covering(section, values);
            figure.pictures {
                div.pair {
                    @for (k, view) in views.iter().enumerate() {
                        (picture(section, *view, Some((values, largest)), &format!("stress-{k}")))
                    }
                }
                figcaption { "Von Mises stress at " (with_unit(*time, prefixed("s", *time), 4)) " (per element); the scale covers 99 % of "
                    "the section, higher values have its last colour." }
            }
        }
    }
}

/// The seat, and everything.
fn views(mesh: &MeshSection, report: &SceneReport) -> Vec<Bounds> {
    let range = |c: usize| {
        let values = mesh.triangles.iter().flatten().map(|p| p[c]);
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
    };
    let [left, right] = range(0);
    let [low, high] = range(1);
    let margin = 0.02 * (right - left);
    let whole = Bounds { across: [left - margin, right + margin], up: [low - margin, high + margin] };
    let near = report.scene.seal_seat().ok().map(|setup| {
        let ([x, _], half) = (setup.ring().sphere_centre, AROUND * setup.sphere.radius);
        Bounds { across: [x - half, x + half], up: [low - 0.1 * half, high + 0.1 * half] }
    });
    near.into_iter().chain([whole]).collect()
}

/// The stress in Pa that [`SHARE_IN_SCALE`] of the section does not exceed.
fn covering(section: &MeshSection, values: &[f64]) -> f64 {
    let area = |[a, b, c]: &[[f64; 2]; 3]| {
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
    };
    let mut sorted: Vec<(f64, f64)> =
        section.triangles.iter().zip(values).map(|(t, v)| (*v, area(t))).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut left = SHARE_IN_SCALE * sorted.iter().map(|(_, area)| area).sum::<f64>();
    let passes = |(_, area): &&(f64, f64)| {
        left -= area;
        left <= 0.0
    };
    sorted.iter().find(passes).or(sorted.last()).map_or(0.0, |(value, _)| *value)
}

/// Triangles with their edges or, with `field` (values and the end of the scale in Pa), in colours.
fn picture(section: &MeshSection, bounds: Bounds, field: Option<(&[f64], f64)>, id: &str) -> Markup {
    let name = if field.is_some() { "Von Mises stress in section" } else { "Mesh in section" };
    let scale = field.map(|(_, largest)| ColourScale::von_mises(largest));
    let frame = Frame { bounds, aspect: None, across: "x in mm", scale, name, id };
    let shown = |t: &&[[f64; 2]; 3]| {
        let outside =
            |c: usize, [low, high]: [f64; 2]| t.iter().all(|p| p[c] < low) || t.iter().all(|p| p[c] > high);
        !(outside(0, bounds.across) || outside(1, bounds.up))
    };
    frame.around(|place| {
        let [x, y, width, height] = place.rectangle();
        html! {
            clipPath id=(format!("{id}-clip")) { rect x=(x) y=(y) width=(width) height=(height) {} }
            g clip-path=(format!("url(#{id}-clip)")) stroke-linejoin="round" {
                @match field {
                    None => {
                        path d=(path(section.triangles.iter().filter(shown), place)) fill="#f0dfb8" stroke="#6b5518" stroke-width="0.5" {}
                    }
                    Some((values, largest)) => {
                        @for level in 0..LEVELS {
                            @let of_level = |v: f64| ((v / largest * LEVELS as f64) as usize).min(LEVELS - 1) == level;
                            @let own = section.triangles.iter().zip(values).filter(|(_, v)| of_level(**v)).map(|(t, _)| t).filter(shown);
                            @let drawn = path(own, place);
                            @let [r, g, b] = cividis((level as f64 + 0.5) / LEVELS as f64);
                            @let colour = format!("rgb({r},{g},{b})");
                            // the stroke closes the seams between triangles
                            @if !drawn.is_empty() { path d=(drawn) fill=(colour) stroke=(colour) stroke-width="0.4" {} }
                        }
                    }
                }
            }
        }
    })
}

fn path<'a>(triangles: impl Iterator<Item = &'a [[f64; 2]; 3]>, place: &Place) -> String {
    let point = |[x, z]: [f64; 2]| format!("{} {}", x2(place.x(x)), x2(place.y(z)));
    triangles.map(|[a, b, c]| format!("M{}L{}L{}Z", point(*a), point(*b), point(*c))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_covers_its_share_of_the_area_whatever_the_triangles() {
        // 199 of 200 equal triangles below 1, the last one far above; then the same with the last one large
        let triangle = |size: f64| [[0.0, 0.0], [size, 0.0], [0.0, size]];
        let values: Vec<f64> = (0..200).map(|k| if k == 0 { 50.0 } else { f64::from(k) / 200.0 }).collect();
        let mut section = MeshSection { triangles: vec![triangle(1.0); 200], von_mises: None };
        assert!((0.98..1.0).contains(&covering(&section, &values)));
        section.triangles[0] = triangle(10.0);
        assert_eq!(covering(&section, &values), 50.0);
    }
}
