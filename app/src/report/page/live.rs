//! The live page: reduced models that answer in the page itself while a reader changes numbers. One file, offline.

use crate::curves::{CommonAxis, SampledCurve, sample};
use crate::error::{Error, Result};
use crate::format::{rounded, words};
use crate::kinds;
use crate::reference::Stored;
use crate::report::figure::geometry::PanelOf;
use crate::report::kinds as shown;
use crate::report::page::html::{named, page, scrolled};
use crate::report::page::interactive::{STYLE as PLOT_STYLE, plotting};
use crate::report::page::page_data::embedded;
use crate::result::Quantity;
use crate::scene::Template;
use crate::validated::Validation;
use base64::Engine;
use flate2::Compression;
use flate2::write::GzEncoder;
use maud::{Markup, PreEscaped, html};
use serde_json::{Map, Value, json};
use std::fs;
use std::io::Write;
use std::path::Path;
use std::sync::OnceLock;

const STYLE: &str = include_str!("assets/live.css");
const SCRIPT: &str = include_str!("assets/live.js");
const DRAWINGS: &str = include_str!("assets/live_drawings.js");
const WORKER: &str = include_str!("assets/live_worker.js");
/// Name of the page in the folder of a report.
pub(crate) const FILE: &str = "live.html";
/// Begin of what the page is about.
const DOCUMENT: &str = "<script type=\"application/json\" id=\"live\">";
/// Samples of a reference's curves.
const SAMPLES: usize = 400;
/// Significant digits of them.
const DIGITS: usize = 5;

/// The models, compiled to WebAssembly and compressed by gzip; empty where they were not built.
static MODELS: OnceLock<&[u8]> = OnceLock::new();

/// Gives the program the models that it puts into pages. For programs, called once.
pub fn embed_live(models: &'static [u8]) {
    MODELS.get_or_init(|| models);
}

/// Whether the program has the models for pages.
pub fn has_live() -> bool {
    MODELS.get().is_some_and(|models| !models.is_empty())
}

/// A scene of a live page.
#[derive(Debug, Clone)]
pub struct LiveScene(Value);

impl LiveScene {
    /// The scene of `template`, with its reference if there is one, and the mesh of a seat. `tolerance`: relative error of the time
    /// integration of its models.
    ///
    /// # Errors
    /// [`Error::Usage`] of a scene whose model C needs a solid mesh; [`Error::Io`] of the mesh; [`Error::Internal`] of a scene that can't be written.
    pub fn new(
        template: &Template,
        stored: Option<&Stored>,
        mesh: Option<&Path>,
        tolerance: f64,
    ) -> Result<Self> {
        let scene = template.scene();
        let kind = kinds::of(scene);
        if !kind.mesh_requests(scene).is_empty() {
            return Err(Error::Usage(format!(
                "scene `{}`: its model C needs a mesh of a solid (a body from a mesh, or an impact off-centre or at an angle), which a live \
                 page can't make: `impactcheck reduced {0} --page FILE` writes a page of its result",
                scene.name
            )));
        }
        let has = |name: &str| kind.has(scene, name);
        let panel = |panel: &PanelOf| {
            let curves: Vec<_> = panel.curves.iter().filter(|(_, name)| has(name)).collect();
            json!({"label": panel.label, "factor": panel.factor, "curves": curves})
        };
        let quantity = |quantity: &Quantity| {
            json!({
                "name": quantity.name, "label": words(quantity.name), "unit": quantity.unit, "about": quantity.about,
                "count": quantity.is_count,
            })
        };
        let quantities = kind.quantities().iter().filter(|quantity| has(quantity.name));
        Ok(Self(json!({
            "name": scene.name,
            "description": scene.description,
            // with the record that it names, if it names one: the page reads no file
            "scene": template.text_with(&scene.name, &[])?,
            "mesh": mesh.map(|path| fs::read(path).map_err(|e| Error::io("reading", path, e)).and_then(|text| packed(&text))).transpose()?,
            "tolerance": tolerance,
            "panels": shown::of(scene).panels().iter().map(panel).collect::<Vec<_>>(),
            "quantities": quantities.map(quantity).collect::<Vec<_>>(),
            "reference": stored.and_then(reference),
        })))
    }

    /// Its name.
    pub(crate) fn name(&self) -> &str {
        self.0["name"].as_str().unwrap_or_default()
    }

    /// Those of the page in `dir`; none if it can't be read.
    pub(crate) fn all_in(dir: &Path) -> Vec<Self> {
        let page = fs::read_to_string(dir.join(FILE)).unwrap_or_default();
        let document = page.split_once(DOCUMENT).and_then(|(_, rest)| rest.split_once("</script>"));
        let document = document.and_then(|(text, _)| serde_json::from_str::<Value>(text).ok());
        let scenes = document.and_then(|document| document["scenes"].as_array().cloned());
        scenes.unwrap_or_default().into_iter().map(Self).collect()
    }
}

/// Curves with bands and values of a reference; `None` if its history can't be used.
fn reference(stored: &Stored) -> Option<Value> {
    let axis = CommonAxis { samples: SAMPLES, ..CommonAxis::of_reference(&stored.outcome)? };
    let short = |values: &[f64]| -> Vec<Option<f64>> {
        let of = |v: &f64| v.is_finite().then(|| rounded(*v, DIGITS));
        values.iter().map(of).collect()
    };
    let summary = &stored.outcome.summary;
    let of_curve = |curve: SampledCurve| {
        let band = stored.bands.as_ref().and_then(|bands| bands.sampled(curve.quantity, &axis));
        let of = json!({"values": short(&curve.values), "band": band.map(|band| short(&band))});
        (curve.quantity.to_owned(), of)
    };
    let curves: Map<String, Value> =
        sample(axis, &stored.outcome.history).into_iter().map(of_curve).collect();
    let values = summary.quantities.iter().map(|quantity| {
        let name = quantity.name.to_owned();
        (name, json!([quantity.value, summary.band(quantity.name)]))
    });
    let times: Vec<f64> = (0..axis.samples).map(|k| axis.time(k)).collect();
    Some(json!({"times": short(&times), "curves": curves, "values": values.collect::<Map<_, _>>()}))
}

/// `bytes` compressed, as text.
fn packed(bytes: &[u8]) -> Result<String> {
    let failed = |e: std::io::Error| Error::Internal(format!("compressing for the live page: {e}"));
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).map_err(failed)?;
    Ok(base64(&encoder.finish().map_err(failed)?))
}

fn base64(bytes: &[u8]) -> String {
    base64::engine::general_purpose::STANDARD.encode(bytes)
}

/// The page of `scenes`, with the scenes in which models were `validated`.
///
/// # Errors
/// [`Error::Usage`] if the program was built without the models for pages.
pub fn live_page(scenes: &[LiveScene], validated: &[Validation]) -> Result<String> {
    let models = MODELS.get().copied().unwrap_or_default();
    if models.is_empty() {
        return Err(Error::Usage("this program has no models for live pages, or had those of other sources when it was built".into()).hint([
            "`make live-page` builds them into the program; it needs `rustup target add wasm32-unknown-unknown`".into(),
        ]));
    }
    let of_validation = |validation: &Validation| {
        let (place, worst) = validation.place.zip(validation.worst())?;
        let (scene, model) = (&validation.scene, &validation.model);
        Some(json!({"scene": scene, "model": model, "place": place.measures(), "off": worst.relative()}))
    };
    let document = json!({
        "scenes": scenes.iter().map(|scene| &scene.0).collect::<Vec<_>>(),
        "validated": validated.iter().filter_map(of_validation).collect::<Vec<_>>(),
    });
    let scripts = html! {
        script type="application/json" id="live" { (PreEscaped(embedded(&document))) }
        script type="text/plain" id="models" { (base64(models)) }
        script type="text/plain" id="worker" { (PreEscaped(WORKER)) }
        script { (PreEscaped(plotting())) }
        script { (PreEscaped(DRAWINGS)) }
        script { (PreEscaped(SCRIPT)) }
    };
    Ok(page("Live page · impactcheck", &[PLOT_STYLE, STYLE], &body(), &scripts))
}

/// What the script fills.
fn body() -> Markup {
    html! {
        h1 #title { "Live page" }
        p.soft #description {}
        noscript { p { "The models run in this page: turn JavaScript on." } }
        p #failure role="alert" hidden {}
        div.workbench {
            section.inputs aria-label="Numbers of the scene" {
                p { label { "Scene " select #scene {} } }
                p.buttons {
                    button type="button" #reset { "Reset" }
                    button type="button" #share { "Copy link" }
                    button type="button" #toml { "Copy scene (TOML)" }
                }
                p.soft { "Type a number, also with a unit, or drag. Locked numbers change by the same factor. The bar shows how much "
                    (named("efficiency")) " or the first result changes: percent for one percent of the number (model B, or the only model)." }
                div #fields {}
            }
            section.outputs aria-label="Results" {
                p #status role="status" {}
                div #controls role="group" aria-label="Curves shown" {}
                div #plots {}
                p.soft #original { "Gray: the stored finite-element reference with its 95 % band. It belongs to the original scene, not to changed numbers." }
                (scrolled("Results", &html! { table #results {} }))
                p.note #prediction {}
                h2 { "Assumptions" }
                ul #warnings {}
                p.buttons #downloads {}
            }
        }
        section #flight-section hidden {
            h2 { "Flight after the impact" }
            div.map #flight {}
            ul.note #flights {}
            p.note { "The chamber in section with the paths of the sphere's centre until its seat is certain; dashed: the sphere in both seats." }
        }
        section #map-section {
            h2 { "Map over two numbers" }
            p.buttons {
                label { "Quantity " select #map-quantity {} } label { "Model " select #map-model {} }
                label { "Across " select #map-x {} } label { "Up " select #map-y {} }
            }
            div.chart { canvas #map role="img" aria-label="Map" {} }
            p.note #map-text {}
        }
        section #validated-section {
            h2 { "Where the models were compared with references" }
            div.map #validated {}
            p.note { "Marks: scenes in which a model was compared with a reference; green: efficiency and peak forces differ by up to 1 %, "
                "orange: up to 5 %, red: more. Ring: the scene with the present numbers; dashed: within a factor of 2 of it." }
        }
    }
}
