//! A series of impacts in the report: the course of the efficiency (Fig. 13), and what each impact comes to.

use crate::format::{prefixed, significant, with_unit};
use crate::plot::{ChartPanel, Series, chart};
use crate::report::SceneReport;
use crate::report::page::html::{detailed, scrolled};
use crate::result::{Impact, Summary};
use maud::{Markup, PreEscaped, html};

/// Cells of a table, the heading first.
type Rows = Vec<Vec<String>>;

/// Efficiency over the number of the impact, reference with bands and models, as a stand-alone SVG; `None` without a series.
pub(crate) fn impacts_figure(report: &SceneReport) -> Option<String> {
    let comparison = &report.comparison;
    if comparison.reference.impacts.len() < 2 {
        return None;
    }
    let models =
        comparison.models.iter().map(|model| course(&model.summary, format!("model {}", model.model)));
    let last = comparison.reference.impacts.len() as f64;
    let elastic = comparison.models.iter().filter_map(|model| {
        let efficiency = 100.0 * model.summary.elastic_efficiency?;
        let name = format!("model {}, elastic", model.model);
        Some(Series { name, points: vec![(1.0, efficiency), (last, efficiency)], ..Series::default() })
    });
    let bands = comparison.reference.impacts.iter().map(|i| 100.0 * i.band("efficiency").unwrap_or(0.0));
    let reference = Series {
        marks: true,
        half_widths: bands.collect(),
        ..course(&comparison.reference, "FE, with its uncertainty (95 %)".into())
    };
    let panel = ChartPanel {
        x_label: "Number of the impact".into(),
        y_label: "Efficiency in %".into(),
        series: std::iter::once(reference).chain(models).chain(elastic).collect(),
        counted: true,
        ..ChartPanel::default()
    };
    Some(chart(&format!("{}: efficiency of the impacts in series", report.scene.name), &[panel]))
}

/// The efficiencies of a series.
pub(crate) fn course(summary: &Summary, name: String) -> Series {
    let point = |i: &Impact| (i.number as f64, i.value("efficiency").map_or(f64::NAN, |share| 100.0 * share));
    Series { name, points: summary.impacts.iter().map(point).collect(), ..Series::default() }
}

/// The impacts of reference and models in a table.
fn rows(report: &SceneReport) -> Rows {
    let comparison = &report.comparison;
    let sides: Vec<&Summary> =
        std::iter::once(&comparison.reference).chain(comparison.models.iter().map(|m| &m.summary)).collect();
    let names = std::iter::once("FE".to_owned()).chain(comparison.models.iter().map(|m| m.model.clone()));
    let columns = ["efficiency", "outer peak", "inner peak", "kept"];
    let heading = names.flat_map(|name| columns.map(|column| format!("{column}, {name}")));
    let count = sides.iter().map(|side| side.impacts.len()).max().unwrap_or(0);
    let row = |k: usize| {
        let of_side = |side: &&Summary| cells(side.impacts.get(k));
        std::iter::once((k + 1).to_string()).chain(sides.iter().flat_map(of_side)).collect()
    };
    std::iter::once(std::iter::once("impact".to_owned()).chain(heading).collect())
        .chain((0..count).map(row))
        .collect()
}

fn cells(impact: Option<&Impact>) -> [String; 4] {
    Impact::COMPARED.map(|(name, unit)| {
        let value = impact.and_then(|impact| impact.value(name));
        let band = impact.and_then(|impact| impact.band(name));
        value.map_or("–".into(), |value| shown(name, unit, value, band))
    })
}

fn shown(name: &str, unit: &str, value: f64, band: Option<f64>) -> String {
    let within = |text: String| band.map_or(String::new(), |_| format!(" ± {text}"));
    if name == "efficiency" {
        let width = within(significant(100.0 * band.unwrap_or(0.0), 2));
        return format!("{}{width} %", significant(100.0 * value, 4));
    }
    let to = prefixed(unit, value);
    format!("{}{}", with_unit(value, to, 4), within(with_unit(band.unwrap_or(0.0), to, 2)))
}

/// The section of a scene's page.
pub(crate) fn impacts_html(report: &SceneReport) -> Markup {
    let Some(figure) = impacts_figure(report) else { return html! {} };
    let mut rows = rows(report).into_iter();
    let heading = rows.next().unwrap_or_default();
    html! {
        p.soft { "Every impact finds the dents of those before. Kept: energy that stays in the contacts, plastic work and what is \
            locked in. The quantities of the page are those of the last impact of either side." }
        figure {
            (detailed("Efficiency over the number of the impact", &PreEscaped(figure)))
            figcaption { a href=(format!("{}-impacts.svg", report.comparison.scene)) { "SVG" } }
        }
        (scrolled("Impacts in series", &html! { table.impacts {
            thead { tr { @for cell in &heading { th scope="col" { (cell) } } } }
            tbody { @for row in rows { tr { @for cell in &row { td { (cell) } } } } }
        } }))
    }
}
