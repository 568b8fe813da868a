//! The curves of a run, drawn.

use impactcheck::kinds::KINDS;
use impactcheck::report::{ChartPanel, Series, chart};
use pyo3::prelude::*;

/// Unit of the curves of a panel, its label, and how often its own unit is in theirs.
const PANELS: [(&str, &str, f64); 2] = [("m/s", "Velocity in mm/s", 1e3), ("N", "Contact force in N", 1.0)];

/// Velocities and contact forces over the time in s as SVG; what is no curve of any kind of scene is left out.
#[pyfunction]
pub fn figure(title: &str, time: Vec<f64>, curves: Vec<(String, Vec<f64>)>) -> String {
    let of_unit = |unit: &str| -> Vec<&(String, Vec<f64>)> {
        let known = |name: &str| KINDS.iter().flat_map(|kind| kind.curves()).find(|curve| curve.name == name);
        curves.iter().filter(|(name, _)| known(name).is_some_and(|curve| curve.unit == unit)).collect()
    };
    let body = |name: &str| name.split('_').next().map(str::to_owned);
    let velocities = of_unit("m/s");
    let panel = |(unit, label, factor): (&str, &str, f64)| ChartPanel {
        x_label: "Time in µs".into(),
        y_label: label.into(),
        series: of_unit(unit)
            .into_iter()
            .enumerate()
            .map(|(k, (name, values))| Series {
                name: name.replace("_velocity", "").replace('_', " "),
                points: time.iter().zip(values).map(|(t, value)| (1e6 * t, factor * value)).collect(),
                // a force looks like the velocity of the body that it acts on
                look: match unit {
                    "m/s" => Some(k),
                    _ => velocities.iter().position(|(velocity, _)| body(velocity) == body(name)),
                },
                ..Series::default()
            })
            .collect(),
        ..ChartPanel::default()
    };
    chart(title, &PANELS.map(panel))
}
