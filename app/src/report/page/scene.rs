//! The page of one scene, whatever its kind: what to trust first, then the curves, then everything that backs it.

use crate::error::Result;
use crate::format::{model_name, prefixed, with_unit};
use crate::report::conclusion::assumptions;
use crate::report::export::Export;
use crate::report::figure::convergence::convergence_html;
use crate::report::page::facts::facts;
use crate::report::page::html::{assumptions_badge, model_badge, page, scene_badge};
use crate::report::page::section::discrepancy::{checks, contradictions, model_section};
use crate::report::page::section::{self, Section, contents, sections};
use crate::report::page::validated_map::ValidatedMap;
use crate::report::page::{discrepancy_picture, first_screen, interactive, live};
use crate::report::{SceneReport, Theme, figure, kinds};
use crate::validated::Place;
use maud::{Markup, html};

/// The page of a scene.
pub(crate) struct Page;

impl Export<SceneReport<'_>> for Page {
    fn ending(&self) -> &'static str {
        "html"
    }

    fn bytes(&self, scene: &SceneReport) -> Result<Vec<u8>> {
        Ok(scene_page(scene).into_bytes())
    }
}

/// The page of one scene.
pub fn scene_page(report: &SceneReport) -> String {
    let comparison = &report.comparison;
    let name = &comparison.scene;
    let all = all_sections(report);
    let body = html! {
        h1 { (name) " " (scene_badge(comparison.verdict)) @if let Some(words) = assumptions(comparison) { " " (assumptions_badge(words)) } }
        p.soft { (report.scene.description) }
        (contents(&all))
        (contradictions("reference", &comparison.integrity))
        (first_screen::first_screen(report))
        (sections(&all))
    };
    let scripts = interactive::scripts(report, kinds::of(report.scene).panels());
    page(&format!("{name} · impactcheck"), &[interactive::STYLE], &body, &scripts)
}

fn all_sections(report: &SceneReport) -> Vec<Section> {
    let (comparison, attachments) = (&report.comparison, &report.attachments);
    let shown = kinds::of(report.scene);
    let mut all = vec![
        Section::new("discrepancies", "Differences", discrepancy_picture::discrepancy_picture(comparison)),
        Section::new(
            "measurement",
            "Measurement",
            comparison.measured.as_ref().map_or_else(
                || html! {},
                |measured| section::measured::measured_html(&comparison.scene, measured),
            ),
        ),
        Section::new("over-time", "Curves", curves(report)),
        Section::new("validation", "Uncertain inputs", section::validation::validation_html(comparison)),
    ];
    all.extend(comparison.models.iter().map(|model| {
        let title = format!("Model {}", model_name(&model.model, model.summary.modes));
        Section::new(&format!("model-{}", model.model), &title, model_section(model))
            .linked_as(format!("Model {}", model.model))
            .marked(model_badge(model))
    }));
    all.extend(shown.sections(report));
    let accepted = section::acceptance::acceptances_html(attachments, &comparison.changed_tolerances);
    all.extend([
        Section::new(
            "reference-check",
            "Independent solver",
            section::reference_check::reference_check_html(comparison.reference_check.as_ref()),
        ),
        Section::new("validated", "Compared scenes", validated(report)),
        Section::new("validity", "Assumptions", section::limits::limits_html(comparison)),
        Section::new("trends", "Trends", section::trend::trends_html(attachments)),
        Section::new("accepted", "Accepted changes", accepted),
        Section::new("mesh", "Mesh and solver", mesh(report, &shown.mesh(report))),
        Section::new("provenance", "Provenance", provenance(report)),
    ]);
    all
}

/// The scene among those in which the models were compared with references; nothing of kinds without a place there.
fn validated(report: &SceneReport) -> Markup {
    let here = Place::of(report.scene, &report.comparison.reference);
    let map = here.and_then(|here| ValidatedMap::of(&report.attachments.validated, Some(here)));
    map.map_or_else(|| html! {}, |map| map.html())
}

fn curves(report: &SceneReport) -> Markup {
    let scene = &report.comparison.scene;
    html! {
        (interactive::panels(figure(report, Theme::Inline)))
        p.soft {
            (kinds::of(report.scene).curves_caption()) " Shaded: the uncertainty (95 %) of the reference. "
            a href=(format!("{scene}.svg")) { "SVG" } " · "
            a href=(format!("{scene}.png")) { "PNG" } " · "
            a href=(format!("{scene}.csv")) { "curves as CSV" }
            @if report.attachments.live.is_some() {
                " · " a href=(format!("{}#scene={scene}", live::FILE)) { "change numbers and see the impact (live page)" }
            }
        }
    }
}

fn mesh(report: &SceneReport, pictures: &Markup) -> Markup {
    let reference = &report.comparison.reference;
    let interval = reference.sample_interval.unwrap_or(f64::NAN);
    html! {
        (pictures)
        (convergence_html(reference))
        details {
            summary { "Mesh and solver in numbers (SI units)" }
            (facts(&[("mesh", reference.mesh.as_ref()), ("solver", reference.solver.as_ref())]))
            p { "Samples of the reference's history: " (reference.samples.map_or("–".into(), |n| n.to_string())) ", every "
                (with_unit(interval, prefixed("s", interval), 4)) "." }
        }
    }
}

/// What goes in, where the reference comes from, and how to make the page again.
fn provenance(report: &SceneReport) -> Markup {
    let comparison = &report.comparison;
    let scene = serde_json::to_value(report.scene).ok();
    html! {
        p { "Make it again: " }
        pre tabindex="0" { (report.command) }
        p { "Scene hash " code { (comparison.reference.scene_hash) } }
        details {
            summary { "The scene (SI units)" }
            (facts(&[("", scene.as_ref())]))
        }
        details {
            summary { "How the reference was made" }
            (facts(&[("", Some(&report.provenance))]))
        }
        details {
            summary { "Internal consistency checks of the reference (" (comparison.integrity.len()) ")" }
            (checks(&comparison.integrity))
        }
    }
}
