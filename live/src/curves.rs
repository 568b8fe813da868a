//! Curves for drawing and for a file.

use impactcheck_physics::result::History;
use serde_json::{Map, Value, json};

/// The curves of `history` at so many `samples` over equal steps from the first contact to `end` s, by default its own, in SI; null
/// after its own end.
pub(crate) fn drawn(history: &History, end: Option<f64>, samples: usize) -> Value {
    let own = history.time.last().copied().unwrap_or(0.0);
    let end = end.unwrap_or(own);
    let times: Vec<f64> = (0..samples).map(|k| end * k as f64 / (samples.max(2) - 1) as f64).collect();
    let curves: Map<String, Value> = history
        .curves
        .iter()
        .map(|curve| (curve.name.to_owned(), json!(sampled(&history.time, &curve.values, &times))))
        .collect();
    json!({"end": own, "values": curves})
}

/// `values` at ascending `times`, with straight lines between samples; NaN after the last.
fn sampled(time: &[f64], values: &[f64], times: &[f64]) -> Vec<f64> {
    let mut next = 1;
    let at = |t: &f64| {
        while next + 1 < time.len() && time[next] < *t {
            next += 1;
        }
        match (time.get(next), values.get(next)) {
            (Some(&right), Some(&above)) if *t <= right => {
                let (left, below) = (time[next - 1], values[next - 1]);
                below + (above - below) * ((t - left) / (right - left)).clamp(0.0, 1.0)
            }
            _ => f64::NAN,
        }
    };
    times.iter().map(at).collect()
}

/// All samples as a CSV file, in SI.
pub(crate) fn csv(history: &History) -> String {
    let names: Vec<&str> = history.curves.iter().map(|curve| curve.name).collect();
    let mut text = format!("time,{}\n", names.join(","));
    for (k, time) in history.time.iter().enumerate() {
        text += &time.to_string();
        for curve in &history.curves {
            text += &format!(",{}", curve.values[k]);
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_lines_pass_through_unequal_samples() {
        let (time, times) = ([0.0, 0.1, 0.15, 0.9, 1.0], [0.0, 0.05, 0.1, 0.12, 0.5, 0.95, 1.0]);
        let values = time.map(|t| 3.0 - 2.0 * t);
        for (found, t) in sampled(&time, &values, &times).iter().zip(times) {
            assert!((found - (3.0 - 2.0 * t)).abs() < 1e-12, "{found} at {t}");
        }
        assert!(sampled(&time, &values, &[1.1])[0].is_nan(), "after the end");
    }
}
