//! The measured records in the report: alignment, efficiencies, curve metrics.

use crate::format::{minus, prefixed, significant, with_unit, words};
use crate::kinds::KINDS;
use crate::measured::{AlignedRecord, Channel, Measured, MeasuredComparison};
use crate::plot::{ChartPanel, Series, chart};
use crate::report::page::html::{detailed, scrolled};
use crate::report::page::prose::prose;
use crate::report::{SceneReport, Theme, measured_figure};
use maud::{Markup, PreEscaped, html};

/// Rows of a table, the heading first.
type Rows = Vec<Vec<String>>;

/// The efficiencies of repeated impacts over their number (Fig. 13), with their mean and scatter as a band and the models as
/// lines, as a stand-alone SVG; without an inner body the restitutions. `None` for fewer than two records.
pub fn efficiency_figure(scene: &str, measured: &Measured) -> Option<String> {
    if measured.records.len() < 2 {
        return None;
    }
    let impacts = measured.records.iter().enumerate();
    let points = impacts.filter_map(|(k, record)| Some((k as f64 + 1.0, 100.0 * record.key()?))).collect();
    let last = measured.records.len() as f64;
    let level = |comparator: &MeasuredComparison| Series {
        name: if comparator.partner == "reference" {
            "FE".into()
        } else {
            format!("model {}", comparator.partner)
        },
        points: comparator.key().map_or_else(Vec::new, |own| vec![(1.0, 100.0 * own), (last, 100.0 * own)]),
        ..Series::default()
    };
    let series = measured.partners.iter().map(level).chain([Series {
        name: "measured".into(),
        points,
        marks: true,
        ..Series::default()
    }]);
    let band = measured.key_series().and_then(|e| Some((100.0 * e.mean, 100.0 * e.standard_deviation?)));
    let panel = ChartPanel {
        x_label: "Number of the impact".into(),
        y_label: format!("{} in %", capitalised(key_in_words(measured))),
        series: series.collect(),
        counted: true,
        band,
        ..ChartPanel::default()
    };
    Some(chart(&format!("{scene}: {} of repeated impacts", key_in_words(measured)), &[panel]))
}

/// What the quantity is called that records show as one number.
pub(crate) fn key_in_words(measured: &Measured) -> &'static str {
    if measured.key == "efficiency" { "efficiency" } else { "restitution" }
}

fn capitalised(text: &str) -> String {
    let (first, rest) = text.split_at(1);
    first.to_uppercase() + rest
}

/// Most points of a curve that is drawn.
const POINTS: usize = 800;

/// The signals of the first record as they were measured and as they are compared, and below what the fits of the free flights leave.
fn corrections(measured: &Measured) -> Option<String> {
    let record = measured.records.first()?;
    let thinned = |samples: &mut dyn ExactSizeIterator<Item = (f64, f64)>| -> Vec<(f64, f64)> {
        let step = samples.len().div_ceil(POINTS).max(1);
        samples.step_by(step).map(|(t, y)| (1e6 * t, y)).collect()
    };
    let named = |name: &str, points, marks| Series { name: name.into(), points, marks, ..Series::default() };
    let over_time = |values: &[f64]| thinned(&mut record.time.iter().copied().zip(values.iter().copied()));
    let panels = |(k, channel): (usize, &Channel)| {
        let curve = KINDS.iter().flat_map(|kind| kind.curves()).find(|curve| curve.name == channel.quantity);
        let unit = curve.map_or("1", |curve| curve.unit);
        let signal = ChartPanel {
            x_label: "Time in µs".into(),
            y_label: format!("{} in {unit}", words(channel.quantity)),
            series: vec![
                named("as measured", over_time(&record.raw[k]), false),
                named("compared", over_time(&channel.values), false),
                named("left of the free flights", Vec::new(), true),
            ],
            ..ChartPanel::default()
        };
        let flights = thinned(&mut record.residuals[k].iter().copied());
        let left = ChartPanel {
            x_label: "Time in µs".into(),
            y_label: format!("residual in {unit}"),
            series: vec![
                Series::default(),
                Series::default(),
                named("left of the free flights", flights, true),
            ],
            ..ChartPanel::default()
        };
        [signal, left]
    };
    let panels: Vec<ChartPanel> = record.signals.iter().enumerate().flat_map(panels).collect();
    Some(chart(&format!("{}: what was removed", name(record)), &panels))
}

fn name(record: &AlignedRecord) -> String {
    record.file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What is wrong with the records: name of the record, sentence.
pub(crate) fn effects(measured: &Measured) -> impl Iterator<Item = (String, &str)> {
    let of = |record| (name(record), record);
    measured.records.iter().map(of).flat_map(|(name, record)| {
        record.findings.iter().map(move |finding| (name.clone(), finding.effect.as_str()))
    })
}

/// A time in s to 0.01 µs, finer than any shift is known.
fn microseconds(time: f64) -> String {
    // what rounds to zero has no sign
    let rounded = (1e8 * time).round() / 1e2 + 0.0;
    minus(&format!("{rounded:.2} µs"))
}

/// The unit of a drift.
fn per_second(unit: &str) -> String {
    if unit == "m/s" { "m/s²".into() } else { format!("{unit}/s") }
}

fn alignment(measured: &Measured) -> Rows {
    let key = key_in_words(measured);
    let heading = ["record", "samples", "first contact at", "offset and drift", key, "uncertainty (95 %)"];
    let row = |record: &AlignedRecord| {
        let corrections: Vec<String> = record
            .channels
            .iter()
            .map(|c| {
                let mut curves = KINDS.iter().flat_map(|kind| kind.curves());
                let unit = curves.find(|curve| curve.name == c.quantity).map_or("1", |curve| curve.unit);
                format!(
                    "{}: {}, {} {}",
                    words(c.quantity),
                    with_unit(c.offset, prefixed(unit, c.offset), 4),
                    significant(c.drift, 2),
                    per_second(unit)
                )
            })
            .collect();
        let percent = |value: Option<f64>, digits| {
            value.map_or("–".into(), |v| format!("{} %", significant(100.0 * v, digits)))
        };
        vec![
            name(record),
            record.samples.to_string(),
            microseconds(record.shift),
            corrections.join("; "),
            percent(record.key(), 4),
            percent(record.key_uncertainty(), 2),
        ]
    };
    std::iter::once(heading.map(str::to_owned).into()).chain(measured.records.iter().map(row)).collect()
}

fn metrics(measured: &Measured) -> Rows {
    let heading =
        ["result", key_in_words(measured), "difference", "curve", "Sprague-Geers", "Russell", "ISO/TS 18571"];
    let score = |value: Option<f64>| value.map_or("–".into(), |v| significant(v, 3));
    let mut rows: Rows = vec![heading.map(str::to_owned).into()];
    for comparator in &measured.partners {
        for curve in &comparator.curves {
            rows.push(vec![
                comparator.partner.clone(),
                comparator.key().map_or("–".into(), |own| format!("{} %", significant(100.0 * own, 4))),
                comparator
                    .key_difference()
                    .map_or("–".into(), |d| format!("{} percentage points", significant(100.0 * d, 3))),
                words(&curve.quantity),
                score(curve.sprague_geers),
                score(curve.russell),
                score(curve.iso18571),
            ]);
        }
    }
    rows
}

/// What the comparators' efficiencies show; nothing if no uncertainty is known.
fn validation(measured: &Measured) -> Option<Rows> {
    let heading = ["result", "E", "u_val", "u_num", "u_input", "u_D", "shows", "area", "above, below"];
    let points = |value: f64| format!("{} percentage points", significant(100.0 * value, 3));
    let row = |comparator: &MeasuredComparison| {
        let of = comparator.validation.as_ref()?;
        let known = |u: Option<f64>| u.map_or("–".into(), points);
        Some(vec![
            comparator.partner.clone(),
            points(of.error),
            points(of.u_val),
            known(of.parts.u_num),
            points(of.parts.u_input),
            known(of.parts.u_d),
            format!("{}: {}", of.verdict.words(), of.sentence),
            comparator.area.map_or("–".into(), |area| points(area.area)),
            comparator
                .area
                .map_or("–".into(), |area| format!("{}, {}", points(area.above), points(area.below))),
        ])
    };
    let rows: Rows = measured.partners.iter().filter_map(row).collect();
    (!rows.is_empty()).then(|| std::iter::once(heading.map(str::to_owned).into()).chain(rows).collect())
}

/// What the columns of [`validation`] are.
const VALIDATION: &str = "E is the computed value minus the mean of the measured ones. Inputs without a stated uncertainty count as exact.     u_val² = u_num² + u_input² + u_D² (ASME V&V 20-2009). Area: between the distribution of the computed value and that of the measured ones     (Ferson, Oberkampf & Ginzburg 2008), and its parts where the computed one is larger and smaller.";

/// Mean and scatter in a sentence.
pub(crate) fn sentence(measured: &Measured) -> String {
    let key = key_in_words(measured);
    let Some(series) = measured.key_series() else {
        return match key {
            "efficiency" => "No record shows the inner body's free flight: there is no measured efficiency.",
            _ => "No record shows the rebound from a body that is held: there is no measured restitution.",
        }
        .into();
    };
    let mean = significant(100.0 * series.mean, 4);
    match series.standard_deviation {
        Some(deviation) => {
            let deviation = significant(100.0 * deviation, 2);
            format!(
                "Measured {key} of {} impacts: mean {mean} %, standard deviation {deviation} percentage points.",
                series.count
            )
        }
        None => format!("Measured {key}: {mean} %."),
    }
}

fn bandwidth(measured: &Measured) -> String {
    let to = prefixed("Hz", measured.bandwidth);
    let shown = with_unit(measured.bandwidth, to, 4);
    format!("The curves of reference and models are filtered to {shown} (zero phase); the records are not.")
}

/// The section of the page of the scene called `scene`.
pub(crate) fn measured_html(scene: &str, measured: &Measured) -> Markup {
    let table = |rows: Rows| {
        let mut rows = rows.into_iter();
        let heading = rows.next().unwrap_or_default();
        html! {
            (scrolled("Measurement", &html! { table.measured {
                thead { tr { @for cell in &heading { th.left scope="col" { (cell) } } } }
                tbody { @for row in rows { tr { @for cell in &row { td.left { (cell) } } } } }
            } }))
        }
    };
    html! {
        p { (sentence(measured)) }
        @for (record, effect) in effects(measured) { p { strong { "Warning, " (record) ": " } (prose(effect)) } }
        figure {
            (detailed("Measured and computed motion", &PreEscaped(measured_figure(scene, measured, Theme::Inline))))
            figcaption {
                "The first record with the results that it is compared with. " (bandwidth(measured)) " "
                a href=(format!("{scene}-measured.svg")) { "SVG" } " · "
                a href=(format!("{scene}-measured.png")) { "PNG" }
                @if measured.records.len() > 1 {
                    " · " a href=(format!("{scene}-efficiencies.svg")) { (key_in_words(measured)) " of each" }
                }
            }
        }
        (table(alignment(measured)))
        @if let Some(drawing) = corrections(measured) {
            details {
                summary { "Signals as measured and as compared, and residuals of the free flights (first record)" }
                (PreEscaped(drawing))
            }
        }
        (table(metrics(measured)))
        @if let Some(rows) = validation(measured) { (table(rows)) p.soft { (VALIDATION) } }
        p.soft { (prose(measured.rule)) }
    }
}

/// The section of the Markdown report.
pub(crate) fn measured_markdown(report: &SceneReport) -> String {
    let Some(measured) = &report.comparison.measured else { return String::new() };
    let table = |rows: Rows| {
        let line = |cells: &Vec<String>| format!("| {} |\n", cells.join(" | ").replace('\n', " "));
        let columns = rows.first().map_or(0, Vec::len);
        let mut text = String::new();
        for (k, row) in rows.iter().enumerate() {
            text += &line(row);
            if k == 0 {
                text += &format!("|{}\n", "---|".repeat(columns));
            }
        }
        text
    };
    let warnings: String =
        effects(measured).map(|(record, effect)| format!("**Warning, {record}:** {effect}\n\n")).collect();
    let validation =
        validation(measured).map_or_else(String::new, |rows| format!("{}\n{VALIDATION}\n\n", table(rows)));
    format!(
        "\n### Measurement\n\n{} {}\n\n{warnings}![Measured displacement and velocity]({}-measured.svg)\n\n{}\n{}\n{validation}{}\n",
        sentence(measured),
        bandwidth(measured),
        report.comparison.scene,
        table(alignment(measured)),
        table(metrics(measured)),
        measured.rule
    )
}
