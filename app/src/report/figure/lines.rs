//! The curves of a figure, result by result, and how they are drawn.

use crate::curves::{CommonAxis, SampledCurve, sample};
use crate::format::model_name;
use crate::measured::{AlignedRecord, Measured};
use crate::plot::colours::look;
use crate::report::SceneReport;
use crate::result::{Outcome, Summary};
use maud::{Markup, html};

/// Curves of one result, and how they are drawn.
pub(crate) struct Line {
    pub(crate) name: String,
    pub(crate) short: String,
    pub(crate) class: String,
    pub(crate) dash: &'static str,
    pub(crate) width: f64,
    pub(crate) efficiency: f64,
    pub(crate) curves: Vec<SampledCurve>,
    /// Half widths of the curves' bands, if they are known.
    pub(crate) bands: Vec<SampledCurve>,
}

/// What the reference is called: that of another program by the program's name.
pub(crate) fn reference_name(reference: &Summary) -> String {
    reference.model.clone().unwrap_or_else(|| "FE reference".into())
}

pub(crate) fn lines(report: &SceneReport, axis: CommonAxis) -> Vec<Line> {
    let reference = Line {
        name: reference_name(&report.reference.summary),
        short: "FE".into(),
        class: "fig-reference".into(),
        dash: "none",
        width: 2.1,
        efficiency: efficiency(report.reference),
        curves: sample(axis, &report.reference.history),
        bands: bands(report, axis),
    };
    let with_curves = report.reduced.iter().filter(|outcome| outcome.summary.failure.is_none());
    let reduced = with_curves.map(|outcome| {
        let model = outcome.summary.model.clone().unwrap_or_default();
        let look = look(&model, report.comparison.names());
        Line {
            name: format!("model {}", model_name(&model, outcome.summary.modes)),
            dash: look.dash,
            class: look.class.into(),
            width: 1.7,
            efficiency: efficiency(outcome),
            curves: sample(axis, &outcome.history),
            bands: Vec::new(),
            short: model,
        }
    });
    std::iter::once(reference).chain(reduced).collect()
}

/// Half widths of the 95 % bands of the reference's curves; empty if they are not known.
fn bands(report: &SceneReport, axis: CommonAxis) -> Vec<SampledCurve> {
    let Some(bands) = &report.attachments.bands else { return Vec::new() };
    let curves = report.reference.history.curves.iter();
    let band = |quantity| Some(SampledCurve { quantity, values: bands.sampled(quantity, &axis)? });
    curves.filter_map(|curve| band(curve.name)).collect()
}

/// NaN, which is shown as a dash, if it is not determined.
fn efficiency(outcome: &Outcome) -> f64 {
    outcome.summary.value("efficiency").unwrap_or(f64::NAN)
}

/// The first measured record and everything it is compared with, as the instrument shows it.
pub(crate) fn measured_lines(measured: &Measured) -> Vec<Line> {
    let record = Line {
        name: "measured".into(),
        short: "exp.".into(),
        class: "fig-measured".into(),
        dash: "none",
        width: 1.4,
        efficiency: measured.records.first().and_then(AlignedRecord::key).unwrap_or(f64::NAN),
        curves: measured.curves.clone(),
        bands: Vec::new(),
    };
    let comparators = measured.partners.iter().map(|comparator| {
        let reference = comparator.partner == "reference";
        let names = measured.partners.iter().map(|comparator| &*comparator.partner);
        let look = look(&comparator.partner, names.filter(|name| *name != "reference"));
        let name = if reference { "FE reference".into() } else { format!("model {}", comparator.partner) };
        Line {
            name,
            short: if reference { "FE".into() } else { comparator.partner.clone() },
            class: if reference { "fig-reference" } else { look.class }.into(),
            dash: if reference { "none" } else { look.dash },
            width: if reference { 2.1 } else { 1.7 },
            efficiency: comparator.key().unwrap_or(f64::NAN),
            curves: comparator.filtered.clone(),
            bands: Vec::new(),
        }
    });
    std::iter::once(record).chain(comparators).collect()
}

/// The curve `data` in the style of its line.
pub(crate) fn stroke(line: &Line, data: &str) -> Markup {
    html! {
        path class=(line.class) d=(data) fill="none" stroke-width=(line.width)
            stroke-dasharray=(line.dash) stroke-linejoin="round" {}
    }
}
