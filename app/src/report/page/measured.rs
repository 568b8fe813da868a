//! The page of a measurement without a reference: models, and what the records show of them.

use crate::format::model_name;
use crate::kinds::of as kind_of;
use crate::measured::Measured;
use crate::report::kinds;
use crate::report::page::facts::facts;
use crate::report::page::html::{page, scrolled};
use crate::report::page::section::measured::measured_html;
use crate::report::page::section::{Section, sections};
use crate::result::Outcome;
use crate::scene::Scene;
use maud::{Markup, html};

/// The page of `scene`, whose `models` are compared with records alone.
pub(crate) fn measured_page(scene: &Scene, models: &[Outcome], measured: &Measured) -> String {
    let name = &scene.name;
    let all = [
        Section::new("models", "Models", table(scene, models)),
        Section::new("measurement", "Measurement", measured_html(name, measured)),
        Section::new(
            "scene",
            "The scene (SI units)",
            facts(&[("", serde_json::to_value(scene).ok().as_ref())]),
        ),
    ];
    let body = html! {
        h1 { (name) ": measurement" }
        p.soft { (scene.description) }
        p.note { "Reduced models without a reference." }
        (sections(&all))
    };
    page(&format!("{name}: measurement · impactcheck"), &[], &body, &html! {})
}

/// The results of the models in short, and their warnings.
fn table(scene: &Scene, models: &[Outcome]) -> Markup {
    // without those that the scene does not have
    let columns = kinds::of(scene).columns().iter();
    let columns: Vec<_> = columns.filter(|column| kind_of(scene).has(scene, column.quantity)).collect();
    let name = |Outcome { summary, .. }: &Outcome| {
        let modes = summary.modes.filter(|modes| *modes > 0);
        format!("Model {}", model_name(summary.model.as_deref().unwrap_or("?"), modes))
    };
    let warnings =
        models.iter().flat_map(|one| one.summary.warnings.iter().map(move |text| (name(one), text)));
    html! {
        (scrolled("Models", &html! { table {
            thead { tr { th {} @for column in &columns { th scope="col" { (column.label()) } } } }
            tbody { @for outcome in models { tr {
                th scope="row" { (name(outcome)) }
                @for column in &columns { td { (column.cell(&outcome.summary, None).map_or("–".to_owned(), |cell| cell.value)) } }
            } } }
        } }))
        @for (model, warning) in warnings { p { strong { (model) ": " } (warning) } }
    }
}
