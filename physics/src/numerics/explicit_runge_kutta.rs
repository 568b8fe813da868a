//! Explicit Runge-Kutta methods with embedded error estimates.
//!
//! Dormand & Prince's 5(4) (J. Comput. Appl. Math. 6, 1980, 19) and 8(5,3) (Hairer, Norsett & Wanner, Solving
//! Ordinary Differential Equations I, section II.10).

/// An explicit method: coefficients, weights, and the weights of its error estimates.
#[derive(Debug, Clone, Copy)]
pub struct Method {
    /// Name for reports.
    pub name: &'static str,
    a: &'static [&'static [f64]],
    b: &'static [f64],
    /// The estimate, and one of lower order that guards it.
    errors: [&'static [f64]; 2],
    /// Order of the estimate.
    order: i32,
}

/// Dormand & Prince of order 5. Its seventh stage, at the end of the step, serves the estimate only.
pub const DORMAND_PRINCE_5: Method = Method {
    name: "Dormand-Prince 5(4)",
    a: &[
        &[],
        &[1.0 / 5.0],
        &[3.0 / 40.0, 9.0 / 40.0],
        &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
        &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
        &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
    ],
    b: &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0, 0.0],
    errors: [
        &[
            71.0 / 57600.0,
            0.0,
            -71.0 / 16695.0,
            71.0 / 1920.0,
            -17253.0 / 339200.0,
            22.0 / 525.0,
            -1.0 / 40.0,
        ],
        &[],
    ],
    order: 4,
};

/// Dormand & Prince of order 8.
pub const DORMAND_PRINCE_8: Method = Method {
    name: "Dormand-Prince 8(5,3)",
    a: DOP853_A,
    b: DOP853_B,
    errors: [DOP853_E5, DOP853_E3],
    order: 7,
};

impl Method {
    /// Weights of the stages before each stage, and of all stages in the result.
    pub(crate) fn weights(&self) -> (&'static [&'static [f64]], &'static [f64]) {
        (self.a, self.b)
    }
}

/// Tolerances and the most evaluations of a run.
#[derive(Debug, Clone, Copy)]
pub struct Tolerances {
    /// Relative to the state.
    pub relative: f64,
    /// Relative to `scale`.
    pub absolute: f64,
    /// Evaluations of the rate after which the run is given up.
    pub max_evaluations: u64,
}

/// Integrates y' = `rate`(y) over `duration` s in place; `scale` is the typical size of each entry. Gives the number of
/// evaluations, or `None` if they exceed the most allowed.
pub fn integrate(
    method: &Method,
    rate: impl FnMut(&[f64], &mut [f64]),
    y: &mut [f64],
    scale: &[f64],
    duration: f64,
    tolerances: &Tolerances,
) -> Option<u64> {
    integrate_watched(method, rate, |_| true, y, scale, duration, tolerances)
}

/// A step of which the error is small enough.
pub struct Step<'a> {
    /// Its length in s.
    pub h: f64,
    /// State and its rate at the start.
    pub start: [&'a [f64]; 2],
    /// The same at the end.
    pub end: [&'a [f64]; 2],
}

/// As [`integrate`]; a step that `watch` refuses is tried again with half the length.
pub fn integrate_watched(
    method: &Method,
    mut rate: impl FnMut(&[f64], &mut [f64]),
    mut watch: impl FnMut(&Step) -> bool,
    y: &mut [f64],
    scale: &[f64],
    duration: f64,
    tolerances: &Tolerances,
) -> Option<u64> {
    let n = y.len();
    let mut after = vec![0.0; n];
    let stages = method.a.len();
    let mut k = vec![vec![0.0; n]; stages];
    let mut trial = vec![0.0; n];
    let mut evaluations = 1;
    rate(y, &mut k[0]);
    let weight = |y: &[f64], i: usize| tolerances.absolute * scale[i] + tolerances.relative * y[i].abs();
    // a step in which no entry changes by more than a thousandth of its scale
    let quickest = (0..n).map(|i| k[0][i].abs() / scale[i]).fold(0.0, f64::max);
    let mut h = duration.min(1e-3 / quickest.max(1.0 / duration));
    let mut time = 0.0;
    while time < duration {
        if evaluations > tolerances.max_evaluations {
            return None;
        }
        h = h.min(duration - time);
        for stage in 1..stages {
            let (done, rest) = k.split_at_mut(stage);
            combine(&mut trial, y, h, method.a[stage], done);
            rate(&trial, &mut rest[0]);
        }
        evaluations += stages as u64 - 1;
        combine(&mut trial, y, h, method.b, &k);
        let [error, guard] = method.errors.map(|weights| {
            let mut sum = 0.0;
            for i in 0..n {
                let local: f64 = weights.iter().zip(&k).map(|(w, k)| w * k[i]).sum();
                let bound = weight(y, i).max(weight(&trial, i));
                sum += (local / bound).powi(2);
            }
            sum
        });
        // Hairer's combination; without a guard it is the plain estimate
        let denominator = if guard > 0.0 { error + 0.01 * guard } else { error };
        let size = if error > 0.0 { h * error / (denominator * n as f64).sqrt() } else { 0.0 };
        let factor = 0.9 * size.powf(-1.0 / f64::from(method.order + 1));
        if size < 1.0 {
            rate(&trial, &mut after);
            evaluations += 1;
            if !watch(&Step { h, start: [y, &k[0]], end: [&trial, &after] }) {
                h *= 0.5;
                continue;
            }
            time += h;
            y.copy_from_slice(&trial);
            k[0].copy_from_slice(&after);
            h *= factor.clamp(0.2, 10.0);
        } else {
            h *= if factor.is_nan() { 0.2 } else { factor.clamp(0.2, 1.0) };
            if h <= f64::EPSILON * time.max(duration * 1e-12) {
                return None;
            }
        }
    }
    Some(evaluations)
}

/// `out` = `y` + h sum of `weights` times `k`.
fn combine(out: &mut [f64], y: &[f64], h: f64, weights: &[f64], k: &[Vec<f64>]) {
    out.copy_from_slice(y);
    for (weight, k) in weights.iter().zip(k) {
        if *weight != 0.0 {
            let factor = h * weight;
            for (out, k) in out.iter_mut().zip(k) {
                *out += factor * k;
            }
        }
    }
}

const DOP853_A: &[&[f64]] = &[
    &[],
    &[0.05260015195876773],
    &[0.0197250569845379, 0.0591751709536137],
    &[0.02958758547680685, 0.0, 0.08876275643042054],
    &[0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792],
    &[0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242],
    &[0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125],
    &[
        0.03709200011850479,
        0.0,
        0.0,
        0.17038392571223998,
        0.10726203044637328,
        -0.015319437748624402,
        0.008273789163814023,
    ],
    &[
        0.6241109587160757,
        0.0,
        0.0,
        -3.3608926294469414,
        -0.868219346841726,
        27.59209969944671,
        20.154067550477894,
        -43.48988418106996,
    ],
    &[
        0.47766253643826434,
        0.0,
        0.0,
        -2.4881146199716677,
        -0.590290826836843,
        21.230051448181193,
        15.279233632882423,
        -33.28821096898486,
        -0.020331201708508627,
    ],
    &[
        -0.9371424300859873,
        0.0,
        0.0,
        5.186372428844064,
        1.0914373489967295,
        -8.149787010746927,
        -18.52006565999696,
        22.739487099350505,
        2.4936055526796523,
        -3.0467644718982196,
    ],
    &[
        2.273310147516538,
        0.0,
        0.0,
        -10.53449546673725,
        -2.0008720582248625,
        -17.9589318631188,
        27.94888452941996,
        -2.8589982771350235,
        -8.87285693353063,
        12.360567175794303,
        0.6433927460157636,
    ],
];
const DOP853_B: &[f64] = &[
    0.054293734116568765,
    0.0,
    0.0,
    0.0,
    0.0,
    4.450312892752409,
    1.8915178993145003,
    -5.801203960010585,
    0.3111643669578199,
    -0.1521609496625161,
    0.20136540080403034,
    0.04471061572777259,
];
const DOP853_E5: &[f64] = &[
    0.01312004499419488,
    0.0,
    0.0,
    0.0,
    0.0,
    -1.2251564463762044,
    -0.4957589496572502,
    1.6643771824549864,
    -0.35032884874997366,
    0.3341791187130175,
    0.08192320648511571,
    -0.022355307863886294,
];
const DOP853_E3: &[f64] = &[
    -0.18980075407240762,
    0.0,
    0.0,
    0.0,
    0.0,
    4.450312892752409,
    1.8915178993145003,
    -5.801203960010585,
    -0.4226823213237919,
    -0.1521609496625161,
    0.20136540080403034,
    0.02265179219836082,
];

#[cfg(test)]
mod tests {
    use super::*;

    /// An undamped oscillator over ten periods: the error follows the tolerance, and the higher order pays.
    #[test]
    fn oscillator_is_integrated_to_the_tolerance() {
        let mut evaluations = Vec::new();
        for method in [DORMAND_PRINCE_5, DORMAND_PRINCE_8] {
            for relative in [1e-4, 1e-7, 1e-10] {
                let mut y = [1.0, 0.0];
                let duration = 20.0 * std::f64::consts::PI;
                let tolerances = Tolerances { relative, absolute: relative, max_evaluations: 1_000_000 };
                let rate = |y: &[f64], dy: &mut [f64]| (dy[0], dy[1]) = (y[1], -y[0]);
                evaluations.push(integrate(&method, rate, &mut y, &[1.0; 2], duration, &tolerances).unwrap());
                let error = (y[0] - 1.0).hypot(y[1]);
                assert!(error < 200.0 * relative, "{}: {error:e} at {relative:e}", method.name);
                assert!(error > 1e-4 * relative, "{}: the estimate does not steer", method.name);
            }
        }
        // three decades of tolerance cost 10^(3/order)
        for (order, more) in [(5.0, &evaluations[1..3]), (8.0, &evaluations[4..6])] {
            let observed = 3.0 / (more[1] as f64 / more[0] as f64).log10();
            assert!(
                (observed / order - 1.0_f64).abs() < 0.1,
                "order {order}: {observed} from {evaluations:?}"
            );
        }
    }
}
