//! Thresholds of vibration over the frequency, with the limits of statics and energy.

use crate::flight::{Landscape, Setup, Thresholds, thresholds_within};
use crate::plot::{ChartPanel, Series, chart};
use crate::scene::Vibration;
use rayon::prelude::*;

/// Frequencies of the chart, the middle one the scene's, and how far it goes to both sides of the scene's.
const COUNT: usize = 21;
const REACH: f64 = 6.0;
/// Relative error that no chart shows.
const ERROR: f64 = 1e-3;

/// The chart as a stand-alone SVG; `None` of a record, which has no frequency, and where nothing unseats.
pub(crate) fn vibration_chart(setup: &Setup, landscape: &Landscape, vibration: &Vibration) -> Option<String> {
    let of_scene = vibration.wave.frequency()?;
    let at = |k: usize| of_scene * REACH.powf(2.0 * k as f64 / (COUNT - 1) as f64 - 1.0);
    let found: Vec<(f64, Thresholds)> = (0..COUNT)
        .into_par_iter()
        .map(|k| {
            let wave = vibration.wave.at_frequency(at(k));
            (at(k), thresholds_within(setup, landscape, &wave, vibration.direction, ERROR))
        })
        .collect();
    found.iter().find_map(|(_, found)| found.unseats)?;
    let series = |name: &str, value: fn(&Thresholds) -> Option<f64>| Series {
        name: name.into(),
        points: found.iter().map(|(f, found)| (*f, value(found).unwrap_or(f64::NAN))).collect(),
        ..Series::default()
    };
    let own = found[COUNT / 2].1.shifts;
    let scene = Series {
        name: "this scene".into(),
        points: own.map(|shifts| (of_scene, shifts)).into_iter().collect(),
        marks: true,
        ..Series::default()
    };
    let panel = ChartPanel {
        x_label: "Frequency in Hz".into(),
        y_label: "Amplitude in m/s²".into(),
        series: vec![
            series("shifts", |found| found.shifts),
            series("unseats (statics)", |found| found.unseats),
            series("least by energy", |found| Some(found.energy_bound)),
            scene,
        ],
        logarithmic: true,
        ..ChartPanel::default()
    };
    Some(chart("Thresholds of vibration over the frequency", &[panel]))
}
