//! Comma-separated text, SI units: a history, and the curves of a scene on the common axis.

use super::Export;
use crate::curves::sample;
use crate::error::{Error, Result};
use crate::kinds;
use crate::report::SceneReport;
use crate::result::{Curve, History};

/// Comma-separated text.
pub struct Csv;

impl Export<History> for Csv {
    fn ending(&self) -> &'static str {
        "csv"
    }

    fn bytes(&self, history: &History) -> Result<Vec<u8>> {
        history_csv(history).map_err(|e| Error::Internal(format!("writing CSV: {e}")))
    }
}

impl Export<SceneReport<'_>> for Csv {
    fn ending(&self) -> &'static str {
        "csv"
    }

    fn bytes(&self, scene: &SceneReport) -> Result<Vec<u8>> {
        curves_csv(scene).map(String::into_bytes)
    }
}

/// Name, unit and values of every column of a history's file.
pub(super) fn columns(history: &History) -> Vec<(&'static str, &'static str, &[f64])> {
    let curves = history.curves.iter().map(|curve| (curve.name, curve.unit, &curve.values[..]));
    std::iter::once(("time", "s", &history.time[..])).chain(curves).collect()
}

fn history_csv(history: &History) -> std::result::Result<Vec<u8>, csv::Error> {
    let columns = columns(history);
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns.iter().map(|(name, ..)| name))?;
    for i in 0..history.len() {
        writer.serialize(columns.iter().map(|(.., values)| values[i]).collect::<Vec<f64>>())?;
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}

/// CSV, eight significant digits, with the columns `time`, then `<source>_<curve>` for the reference and every model. A cell
/// is empty where the result doesn't cover the axis or has no such curve; without a common axis there is only the header.
///
/// # Errors
/// [`Error::Internal`] if it can't be written.
pub fn curves_csv(report: &SceneReport) -> Result<String> {
    let internal = |e: String| Error::Internal(format!("writing the curves as CSV: {e}"));
    let reference = ("reference".to_owned(), &report.reference.history);
    let reduced = report.reduced.iter().map(|o| (o.summary.model.clone().unwrap_or_default(), &o.history));
    let sources: Vec<_> = std::iter::once(reference).chain(reduced).collect();

    let mut writer = csv::Writer::from_writer(Vec::new());
    let curves = kinds::of(report.scene).curves();
    let names =
        sources.iter().flat_map(|(s, _)| curves.iter().map(move |curve| format!("{s}_{}", curve.name)));
    writer.write_record(["time".to_owned()].into_iter().chain(names)).map_err(|e| internal(e.to_string()))?;
    if let Some(axis) = report.comparison.window {
        let columns: Vec<Vec<f64>> = sources
            .iter()
            .flat_map(|(_, history)| {
                let sampled = sample(axis, history);
                let values = move |curve: &Curve| {
                    let found = sampled.iter().find(|found| found.quantity == curve.name);
                    found.map_or_else(Vec::new, |found| found.values.clone())
                };
                curves.iter().map(values)
            })
            .collect();
        for k in 0..axis.samples {
            let cell = |column: &Vec<f64>| match column.get(k) {
                Some(v) if v.is_finite() => format!("{v:.7e}"),
                _ => String::new(),
            };
            let row = [format!("{:.7e}", axis.time(k))].into_iter().chain(columns.iter().map(cell));
            writer.write_record(row).map_err(|e| internal(e.to_string()))?;
        }
    }
    let bytes = writer.into_inner().map_err(|e| internal(e.to_string()))?;
    String::from_utf8(bytes).map_err(|e| internal(e.to_string()))
}
