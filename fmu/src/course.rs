//! Values of an impact's curves between their samples.

/// Displacement and velocity at time `t`, from samples of both at the times `time`, strictly increasing: the cubic that has both values
/// at both neighbouring samples. Before the first sample and after the last one the velocity stays.
pub fn motion(time: &[f64], displacement: &[f64], velocity: &[f64], t: f64) -> [f64; 2] {
    let next = time.partition_point(|sample| *sample <= t);
    if next == 0 || next == time.len() {
        let end = next.saturating_sub(1);
        return [displacement[end] + velocity[end] * (t - time[end]), velocity[end]];
    }
    let before = next - 1;
    let h = time[next] - time[before];
    let s = (t - time[before]) / h;
    let rise = displacement[next] - displacement[before];
    let [v0, v1] = [velocity[before], velocity[next]];
    // h00, h10, h01, h11 of the cubic Hermite spline, grouped by what they add to the start's value
    let [bend, twist] = [3.0 * rise - h * (2.0 * v0 + v1), h * (v0 + v1) - 2.0 * rise];
    let at = displacement[before] + s * (h * v0 + s * (bend + s * twist));
    let rate = v0 + s / h * (2.0 * bend + 3.0 * s * twist);
    [at, rate]
}

/// Integral of the samples `values` from the first time to every other one, by the trapezoidal rule with its correction by the slopes
/// at both ends, which are those of parabolas through three samples. Shape (samples).
pub fn integrals(time: &[f64], values: &[f64]) -> Vec<f64> {
    let slopes: Vec<f64> = (0..time.len()).map(|k| slope(time, values, k)).collect();
    let mut integrals = vec![0.0; time.len()];
    for k in 1..time.len() {
        let h = time[k] - time[k - 1];
        let area = 0.5 * h * (values[k - 1] + values[k]) + h * h / 12.0 * (slopes[k - 1] - slopes[k]);
        integrals[k] = integrals[k - 1] + area;
    }
    integrals
}

/// Slope at sample `k` of the parabola through it and its neighbours.
fn slope(time: &[f64], values: &[f64], k: usize) -> f64 {
    if time.len() < 3 {
        let rise = values[values.len() - 1] - values[0];
        return if time.len() < 2 { 0.0 } else { rise / (time[1] - time[0]) };
    }
    let middle = k.clamp(1, time.len() - 2);
    let chord = |i: usize| (values[i + 1] - values[i]) / (time[i + 1] - time[i]);
    let [before, after] = [chord(middle - 1), chord(middle)];
    let bend = (after - before) / (time[middle + 1] - time[middle - 1]);
    before + bend * (2.0 * time[k] - time[middle - 1] - time[middle])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both rules against a sine of which one period has 200 uneven samples.
    #[test]
    fn values_between_samples_are_those_of_the_curve() {
        let time: Vec<f64> = (0..=200).map(|k| 0.031 * f64::from(k) + 0.01 * f64::from(k % 3)).collect();
        let of = |f: fn(f64) -> f64| time.iter().map(|t| f(*t)).collect::<Vec<_>>();
        let (displacement, velocity) = (of(f64::sin), of(f64::cos));
        for k in 0..1000 {
            let t = 6.2 * f64::from(k) / 1000.0;
            let [u, v] = motion(&time, &displacement, &velocity, t);
            assert!((u - t.sin()).abs() < 2e-8 && (v - t.cos()).abs() < 1e-6, "{t}: {u} {v}");
        }
        let error = |(t, area): (&f64, f64)| (area - t.sin() + time[0].sin()).abs();
        let worst = time.iter().zip(integrals(&time, &velocity)).map(error).fold(0.0, f64::max);
        assert!(worst < 1e-6, "{worst}");
    }

    #[test]
    fn bodies_fly_on_after_the_last_sample() {
        assert_eq!(motion(&[0.0, 1.0], &[0.0, 1.0], &[1.0, 2.0], 3.0), [5.0, 2.0]);
        assert_eq!(motion(&[0.0, 1.0], &[0.0, 1.0], &[1.0, 2.0], -1.0), [-1.0, 1.0]);
    }
}
