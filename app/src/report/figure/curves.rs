//! The curves of one run, drawn.

use crate::plot::{ChartPanel, Series, chart};

/// Unit of the curves of a panel, its label, and how often its own unit is in theirs.
const PANELS: [(&str, &str, f64); 2] = [("m/s", "Velocity in mm/s", 1e3), ("N", "Contact force in N", 1.0)];

/// Velocities and contact forces over the `time` in s as a stand-alone SVG; `curves` are names, SI units and values.
pub fn curves_chart(title: &str, time: &[f64], curves: &[(&str, &str, &[f64])]) -> String {
    // of a force with components the magnitude says enough
    let is_component = |(name, unit, _): &(&str, &str, &[f64])| *unit == "N" && !name.ends_with("_force");
    let of_unit =
        |unit: &'static str| curves.iter().filter(move |curve| curve.1 == unit && !is_component(curve));
    let body = |name: &str| name.split('_').next().map(str::to_owned);
    let panel = |(unit, label, factor): (&'static str, &str, f64)| ChartPanel {
        x_label: "Time in µs".into(),
        y_label: label.into(),
        series: of_unit(unit)
            .enumerate()
            .map(|(k, (name, _, values))| Series {
                name: name.replace("_velocity", "").replace('_', " "),
                points: time.iter().zip(*values).map(|(t, value)| (1e6 * t, factor * value)).collect(),
                // a force looks like the velocity of the body that it acts on
                look: match unit {
                    "m/s" => Some(k),
                    _ => of_unit("m/s").position(|(velocity, ..)| body(velocity) == body(name)),
                },
                ..Series::default()
            })
            .collect(),
        ..ChartPanel::default()
    };
    chart(title, &PANELS.map(panel))
}
