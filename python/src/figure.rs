//! The curves of a run, drawn.

use impactcheck::kinds::KINDS;
use impactcheck::report::curves_chart;
use pyo3::prelude::*;

/// Velocities and contact forces over the time in s as SVG; what is no curve of any kind of scene is left out.
#[pyfunction]
pub fn figure(title: &str, time: Vec<f64>, curves: Vec<(String, Vec<f64>)>) -> String {
    let unit = |name: &str| KINDS.iter().flat_map(|kind| kind.curves()).find(|curve| curve.name == name);
    let known = |(name, values)| Some((name, unit(name)?.unit, values));
    let curves: Vec<_> =
        curves.iter().filter_map(|(name, values)| known((name.as_str(), &values[..]))).collect();
    curves_chart(title, &time, &curves)
}
