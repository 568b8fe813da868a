//! Model curves as an instrument of limited bandwidth shows them.

use crate::curves::MonotoneCubic;
use crate::error::{Error, Result};
use crate::result::History;
use biquad::{Biquad, Coefficients, DirectForm2Transposed, Q_BUTTERWORTH_F64, ToHertz, Type};

/// Samples per period of the bandwidth.
const SAMPLES_PER_PERIOD: f64 = 40.0;
/// Periods of the bandwidth by which a curve is extended on both sides: free flight, and room for the filter to settle.
const MARGIN: f64 = 12.0;
/// The curves that can be measured.
pub(super) const SIGNALS: [&str; 6] = [
    "outer_displacement",
    "outer_velocity",
    "outer_force",
    "inner_displacement",
    "inner_velocity",
    "inner_force",
];

/// Low-pass filter without phase: Butterworth's of second order, forwards and backwards, -3 dB at `bandwidth` Hz for both
/// together (as SAE J211 does). `step` is the distance of the samples in s; the ends settle within some periods.
///
/// # Errors
/// [`Error::Usage`] if the bandwidth is not below half the sampling frequency.
pub fn low_pass(values: &[f64], step: f64, bandwidth: f64) -> Result<Vec<f64>> {
    // each pass has -1.5 dB at the bandwidth: (f/f_c)^4 = sqrt(2) - 1
    let corner = bandwidth / (2.0_f64.sqrt() - 1.0).powf(0.25);
    let refused = || {
        let limit = 0.5 / step;
        Error::Usage(format!(
            "a bandwidth of {bandwidth} Hz needs more samples: with steps of {step} s it must be well below {limit} Hz"
        ))
    };
    let design =
        Coefficients::<f64>::from_params(Type::LowPass, (1.0 / step).hz(), corner.hz(), Q_BUTTERWORTH_F64);
    let coefficients = design.map_err(|_| refused())?;
    let pass = |values: &mut dyn Iterator<Item = f64>| -> Vec<f64> {
        let mut filter = DirectForm2Transposed::<f64>::new(coefficients);
        values.map(|value| filter.run(value)).collect()
    };
    let forwards = pass(&mut values.iter().copied());
    let mut backwards = pass(&mut forwards.into_iter().rev());
    backwards.reverse();
    Ok(backwards)
}

/// The measurable curves of a history as the instrument shows them, on a uniform axis that reaches beyond the
/// history.
#[derive(Debug, Clone)]
pub struct Filtered {
    time: Vec<f64>,
    curves: Vec<FilteredCurve>,
}

/// One of [`SIGNALS`].
#[derive(Debug, Clone)]
struct FilteredCurve {
    name: &'static str,
    /// Rates at which a displacement goes on before and after the axis, m/s; 0 of all else.
    rates: [f64; 2],
    values: Vec<f64>,
}

impl Filtered {
    /// Filters `history` to `bandwidth` Hz. Before its begin and after its end the bodies fly freely.
    ///
    /// # Errors
    /// [`Error::Usage`] if the history has fewer than two samples, no curve that can be measured, or the bandwidth is not usable.
    pub fn new(history: &History, bandwidth: f64) -> Result<Self> {
        let (Some(&start), Some(&end)) = (history.time.first(), history.time.last()) else {
            return Err(Error::Usage("a history without samples can't be filtered".into()));
        };
        if history.len() < 2 {
            return Err(Error::Usage("a history of one sample can't be filtered".into()));
        }
        let step = 1.0 / (SAMPLES_PER_PERIOD * bandwidth);
        let margin = MARGIN / bandwidth;
        let count = ((end - start + 2.0 * margin) / step).ceil() as usize + 1;
        let time: Vec<f64> = (0..count).map(|k| start - margin + step * k as f64).collect();
        let mut curves = Vec::with_capacity(SIGNALS.len());
        let curve = |name: &str| history.curve(name).filter(|values| values.len() == history.len());
        for name in SIGNALS {
            let velocity = name.strip_suffix("displacement").map(|body| curve(&format!("{body}velocity")));
            let (Some(values), false) = (curve(name), velocity == Some(None)) else { continue };
            let rates = velocity.flatten().map_or([0.0; 2], |v| [v[0], v[history.len() - 1]]);
            let course = MonotoneCubic::new(&history.time, values);
            let at = |t: f64| course.at(t) + rates[0] * (t - start).min(0.0) + rates[1] * (t - end).max(0.0);
            let sampled: Vec<f64> = time.iter().map(|t| at(*t)).collect();
            curves.push(FilteredCurve { name, rates, values: low_pass(&sampled, step, bandwidth)? });
        }
        if curves.is_empty() {
            return Err(Error::Usage(format!(
                "a history without any of {} can't be filtered",
                SIGNALS.join(", ")
            )));
        }
        let mut filtered = Filtered { time, curves };
        filtered.cut((0.5 * MARGIN * SAMPLES_PER_PERIOD) as usize);
        Ok(filtered)
    }

    /// Drops `count` samples on both sides, where the filter has not settled.
    fn cut(&mut self, count: usize) {
        let keep = count..self.time.len() - count;
        self.time = self.time[keep.clone()].to_vec();
        for curve in &mut self.curves {
            curve.values = curve.values[keep.clone()].to_vec();
        }
    }

    /// The curve called `quantity` at any time in s after the first touch; `None` if it can't be measured.
    pub fn curve(&self, quantity: &str) -> Option<impl Fn(f64) -> f64 + '_> {
        let FilteredCurve { rates: [before, after], values, .. } =
            self.curves.iter().find(|curve| curve.name == quantity)?;
        let last = self.time.len() - 1;
        let (start, end) = (self.time[0], self.time[last]);
        let step = (end - start) / last as f64;
        Some(move |t: f64| {
            if t <= start {
                return values[0] + before * (t - start);
            }
            if t >= end {
                return values[last] + after * (t - end);
            }
            // cubic through the four nearest samples: smooth, as a search for the best shift needs it
            let place = ((t - start) / step).clamp(0.0, last as f64);
            let k = (place as usize).clamp(1, last - 2);
            let s = place - k as f64;
            let (a, b, c, d) = (values[k - 1], values[k], values[k + 1], values[k + 2]);
            let (p, q, r) = (s + 1.0, s - 1.0, s - 2.0);
            -a * s * q * r / 6.0 + b * p * q * r / 2.0 - c * p * s * r / 2.0 + d * p * s * q / 6.0
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinds::plate_impact::CURVES;
    use std::f64::consts::PI;

    /// Amplitude and shift in s of a sine of `frequency` after the filter.
    fn response(frequency: f64) -> (f64, f64) {
        let step = 0.1e-6;
        let wave: Vec<f64> = (0..20_000).map(|k| (2.0 * PI * frequency * step * k as f64).sin()).collect();
        let out = low_pass(&wave, step, 100e3).expect("filtered");
        let (mut a, mut b) = (0.0, 0.0);
        // a whole number of periods in the middle
        let count = ((10_000.0 * step * frequency).floor() / (step * frequency)).round() as usize;
        for k in 5000..5000 + count {
            let phase = 2.0 * PI * frequency * step * k as f64;
            a += 2.0 * out[k] * phase.sin() / count as f64;
            b += 2.0 * out[k] * phase.cos() / count as f64;
        }
        (a.hypot(b), b.atan2(a) / (2.0 * PI * frequency))
    }

    #[test]
    fn half_the_power_passes_at_the_bandwidth_and_no_phase_is_added() {
        // |H|^2 of two Butterworth passes is 1/(1 + (f/f_c)^4)
        let ratio = 2.0_f64.sqrt() - 1.0;
        for (frequency, expected) in [
            (10e3, 1.0 / (1.0 + ratio * 1e-4)),
            (100e3, 0.5_f64.sqrt()),
            (400e3, 1.0 / (1.0 + ratio * 256.0)),
        ] {
            let (amplitude, shift) = response(frequency);
            assert!((amplitude - expected).abs() < 0.01, "{frequency} Hz: {amplitude}, expected {expected}");
            assert!(shift.abs() < 1e-9, "{frequency} Hz: {shift} s");
        }
    }

    #[test]
    fn free_flight_passes_unchanged() {
        let time: Vec<f64> = (0..=200).map(|k| 1e-6 * f64::from(k)).collect();
        let mut history = History::new(&CURVES);
        for t in &time {
            history.push(*t, [-0.55 * t, 0.0, 0.0, -0.55, 0.0, 0.0, 0.0, 0.0]);
        }
        let filtered = Filtered::new(&history, 100e3).expect("filtered");
        let (x, v) =
            (filtered.curve("outer_displacement").expect("x"), filtered.curve("outer_velocity").expect("v"));
        for t in [-1e-3, -40e-6, 0.0, 33.33e-6, 199e-6, 230e-6, 2e-3] {
            assert!((x(t) + 0.55 * t).abs() < 1e-12, "{t}: {}", x(t));
            assert!((v(t) + 0.55).abs() < 1e-9, "{t}: {}", v(t));
        }
    }
}
