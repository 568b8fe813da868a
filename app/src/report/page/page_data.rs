//! What a scene's page carries for its script: the curves on the common axis, and the comparison document of the scene.

use crate::curves::{CommonAxis, SampledCurve, sample};
use crate::format::model_name;
use crate::plot::colours::look;
use crate::reference::CurveBands;
use crate::report::SceneReport;
use crate::report::figure::geometry::PanelOf;
use crate::report::figure::lines::reference_name;
use serde_json::{Value, json};

/// Significant digits of a curve's peak that are kept.
const DIGITS: i32 = 5;

/// JSON of the curves, values in the units of the panels; without times if the reference's history can't be used.
pub(crate) fn curves(report: &SceneReport, panels: &[PanelOf]) -> Value {
    let Some(axis) = report.comparison.window else {
        return json!({"time": [], "sources": [], "panels": []});
    };
    let reference = (
        "reference".to_owned(),
        reference_name(&report.reference.summary),
        sample(axis, &report.reference.history),
    );
    let with_curves = report.reduced.iter().filter(|outcome| outcome.summary.failure.is_none());
    let reduced = with_curves.map(|outcome| {
        let model = outcome.summary.model.clone().unwrap_or_default();
        let name = format!("model {}", model_name(&model, outcome.summary.modes));
        (model, name, sample(axis, &outcome.history))
    });
    let sources: Vec<_> = std::iter::once(reference).chain(reduced).collect();
    let panels: Vec<Value> = panels
        .iter()
        .map(|panel| of_panel(panel, &sources, axis, report.attachments.bands.as_ref()))
        .collect();
    let of_source = |(id, name, _): &Source| {
        let is_reference = id == "reference";
        let look = look(id, report.comparison.names());
        let class = if is_reference { "fig-reference" } else { look.class };
        let dashes: Vec<f64> = if is_reference {
            Vec::new()
        } else {
            look.dash.split(' ').filter_map(|d| d.parse().ok()).collect()
        };
        json!({
            "id": id, "name": name, "short": if is_reference { "FE" } else { id }, "dash": dashes,
            "width": if is_reference { 2.1 } else { 1.7 },
            "class": class,
            "colour": if is_reference { "fg".to_owned() } else { class.trim_start_matches("fig-").to_lowercase() },
        })
    };
    json!({"time": times(axis), "sources": sources.iter().map(of_source).collect::<Vec<_>>(), "panels": panels})
}

/// Identifier, name and curves of a result.
type Source = (String, String, Vec<SampledCurve>);

fn of_panel(panel: &PanelOf, sources: &[Source], axis: CommonAxis, bands: Option<&CurveBands>) -> Value {
    let named = |curves: &[SampledCurve], name: &str| curves.iter().find(|c| c.quantity == name).cloned();
    let values = sources
        .iter()
        .flat_map(|(_, _, curves)| curves.iter().filter(|c| panel.holds(c)))
        .flat_map(|c| &c.values);
    let peak = values.filter(|v| v.is_finite()).fold(0.0_f64, |p, v| p.max(v.abs())) * panel.factor;
    let decimals = if peak > 0.0 { (DIGITS - 1 - peak.log10().floor() as i32).clamp(0, 12) } else { 0 };
    let shortened = |values: &[f64]| rounded(values, panel.factor, decimals);
    let curves = panel.curves.iter().map(|(body, name)| {
        let of_source = |(id, _, curves): &Source| {
            let values = named(curves, name).map_or(vec![f64::NAN; axis.samples], |curve| curve.values);
            (id.clone(), shortened(&values))
        };
        let values: serde_json::Map<String, Value> = sources.iter().map(of_source).collect();
        let band = bands.and_then(|bands| bands.sampled(name, &axis)).map(|band| shortened(&band));
        json!({"body": body, "name": name, "values": values, "band": band})
    });
    let curves: Vec<Value> = curves.collect();
    json!({"label": panel.label, "factor": panel.factor, "decimals": decimals.max(1) - 1, "curves": curves})
}

/// Instants in us.
fn times(axis: CommonAxis) -> Value {
    let seconds: Vec<f64> = (0..axis.samples).map(|k| axis.time(k)).collect();
    rounded(&seconds, 1e6, (DIGITS + 2 - (axis.end * 1e6).log10().ceil() as i32).clamp(0, 12))
}

/// Values times `factor`, rounded; `null` for what is not finite.
fn rounded(values: &[f64], factor: f64, decimals: i32) -> Value {
    let unit = 10_f64.powi(decimals);
    let number = |v: &f64| {
        let rounded = (v * factor * unit).round() / unit;
        // a whole number needs no point, and zero no sign
        match rounded {
            0.0 => json!(0),
            r if r.fract() == 0.0 && r.abs() < 1e15 => json!(r as i64),
            r => json!(r),
        }
    };
    values.iter().map(number).collect()
}

/// A JSON document as the text of a script element, which no text inside can end.
pub(crate) fn embedded(document: &impl serde::Serialize) -> String {
    serde_json::to_string(document).unwrap_or_else(|_| "null".into()).replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::{embedded, rounded};
    use serde_json::json;

    #[test]
    fn numbers_are_rounded_and_short() {
        let found = rounded(&[-2.956_614e-4, 0.0, -1e-12, f64::NAN, 0.5], 1e6, 2);
        assert_eq!(found.to_string(), "[-295.66,0,0,null,500000]");
    }

    #[test]
    fn no_text_ends_the_script() {
        let text = embedded(&json!({"a": "</script><script>"}));
        assert!(!text.contains('<'));
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).expect("JSON")["a"], "</script><script>");
    }
}
