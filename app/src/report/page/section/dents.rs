//! What impacts leave behind in bodies that yield: dents, and the plastic strain around the contacts.

use crate::error::Result;
use crate::plot::frame::ColourScale;
use crate::plot::raster::{Raster, View};
use crate::plot::{ChartPanel, Series, chart};
use crate::reference::Dents;
use crate::report::SceneReport;
use crate::report::page::html::detailed;
use crate::report::page::section::mesh::{face_heights, picture};
use maud::{Markup, PreEscaped, html};

/// Surfaces in the order of [`Dents::heights`].
const SURFACES: [&str; 4] = ["Outer body", "Plate, outer face", "Plate, inner face", "Inner body"];
/// Impacts drawn beside the last one: the later ones change little.
const FIRST: usize = 3;
/// Half the width of a picture over the radius of the zone in which nodes may touch.
const AROUND: f64 = 1.8;
/// Pixels of a picture.
const PIXELS: usize = 676;

/// Heights of all four surfaces over the radius after the first impacts and the last one, as a stand-alone SVG.
pub(crate) fn dents_figure(report: &SceneReport) -> Option<String> {
    let dents = &report.attachments.dents;
    let last = dents.len().checked_sub(1)?;
    let shown = || dents.iter().enumerate().filter(|(k, _)| *k < FIRST || *k == last).map(|(_, dents)| dents);
    let panel = |surface: usize| ChartPanel {
        x_label: "Radius in µm".into(),
        y_label: format!("{} in µm", SURFACES[surface]),
        series: shown().map(|dents| profile(dents, surface)).collect(),
        ..ChartPanel::default()
    };
    let title = format!("{}: surfaces at rest after the impacts", report.scene.name);
    Some(chart(&title, &[0, 1, 2, 3].map(panel)))
}

fn profile(dents: &Dents, surface: usize) -> Series {
    let points = dents.radius.iter().zip(&dents.heights[surface]).map(|(r, height)| (1e6 * r, 1e6 * height));
    Series { name: format!("after impact {}", dents.impact), points: points.collect(), ..Series::default() }
}

/// The section of a scene's page; nothing if nothing can yield.
///
/// # Errors
/// If a picture can't be encoded.
pub(crate) fn dents_html(report: &SceneReport) -> Result<Markup> {
    let Some(figure) = dents_figure(report) else { return Ok(html! {}) };
    let strains = strains(report)?;
    Ok(html! {
        p.soft { "Surfaces of the reference at rest after the impacts: height over the virgin surface, out of the body; of bodies \
            against their mean displacement, so that the plate's has its bending that stays." }
        figure {
            (detailed("Surfaces at rest after the impacts", &PreEscaped(figure)))
            figcaption { a href=(format!("{}-dents.svg", report.comparison.scene)) { "SVG" } }
        }
        @if !strains.is_empty() {
            figure.pictures {
                div.pair { @for picture in &strains { (picture) } }
                figcaption { "Equivalent plastic strain after the last impact (means at the nodes), accumulated over all of them: outer \
                    and inner contact, each with a scale of its own." }
            }
        }
    })
}

/// The plastic strain around both contacts.
fn strains(report: &SceneReport) -> Result<Vec<Markup>> {
    let Some(mesh) = &report.attachments.mesh else { return Ok(Vec::new()) };
    let zone = report.provenance["settings"]["contact_zone"].as_f64().filter(|zone| *zone > 0.0);
    let (Some(strain), Some(zone)) = (&mesh.plastic_strain, zone) else { return Ok(Vec::new()) };
    let [bottom, top] = face_heights(mesh);
    let around = |(k, z): (usize, f64)| {
        let radius = AROUND * zone;
        let view = View { radius, low: z - radius, high: z + radius };
        let largest = Raster::within(mesh.into(), strain, 1.0, view, PIXELS);
        let raster = Raster::field(mesh.into(), strain, largest, view, PIXELS);
        picture(&raster, view, Some(ColourScale::plastic_strain(largest)), &format!("strain-{k}"))
    };
    [top, bottom].into_iter().enumerate().map(around).collect()
}
