//! Roots of functions of one variable.

/// When a motion, `[value, rate]` at a time, first falls to `zero` after the time `from`; `None` if it has not by `latest`. `bound` is one
/// of its second derivative: steps provably pass no zero, and close to it they are Newton's.
pub(crate) fn first_fall(
    motion: impl Fn(f64) -> [f64; 2],
    [from, latest]: [f64; 2],
    bound: f64,
    zero: f64,
) -> Option<f64> {
    let mut time = from;
    while time <= latest {
        let [value, rate] = motion(time);
        if value <= zero {
            return Some(time);
        }
        let root = (rate * rate + 2.0 * bound * value).sqrt();
        let step = if rate >= 0.0 { (rate + root) / bound } else { 2.0 * value / (root - rate) };
        if time + step == time {
            return Some(time);
        }
        time += step;
    }
    None
}

/// Secants of [`root_near`] and steps of [`newton_near`] at most, and the step, relative, from which on the next one ends at rounding.
const SECANTS: usize = 12;
const LAST_STEP: f64 = 1e-9;
/// Last step of [`root_from`], relative; the error that is left is about its square.
const CLOSE: f64 = 1e-8;

/// Where the positive `f`, about the power `power` of its positive argument, is `value`: by secants of the logarithms from `near` on.
/// `None` if these don't settle, as they may not across a kink.
pub(crate) fn root_near(f: impl Fn(f64) -> f64, value: f64, near: f64, power: f64) -> Option<f64> {
    let error = |x: f64| (f(x.exp()) / value).ln();
    let mut x = near.ln();
    let (mut miss, mut slope) = (error(x), power);
    for _ in 0..SECANTS {
        let step = -miss / slope;
        x += step;
        if step.abs() <= LAST_STEP {
            return Some(x.exp());
        }
        let before = miss;
        miss = error(x);
        slope = (miss - before) / step;
        if !slope.is_finite() || slope <= 0.0 {
            return None;
        }
    }
    None
}

/// Where a positive function of a positive argument is `value`: by Newton's method for the logarithms from `near` on. `f` gives the function
/// and its power there, d ln f/d ln x. `None` if it does not settle.
pub(crate) fn newton_near(f: impl Fn(f64) -> [f64; 2], value: f64, near: f64) -> Option<f64> {
    let mut x = near;
    for _ in 0..SECANTS {
        let [found, power] = f(x);
        let step = (value / found).ln() / power;
        if !step.is_finite() || power <= 0.0 {
            return None;
        }
        x *= step.exp();
        if step.abs() <= LAST_STEP {
            return Some(x);
        }
    }
    None
}

/// Root of `f` within the `bracket`, found from `near` on: by secants to about the square of [`CLOSE`], and where these leave the bracket by [`root`];
/// `None` if `f` has the same sign at both ends then.
pub(crate) fn root_from(f: impl Fn(f64) -> f64, near: f64, bracket: [f64; 2]) -> Option<f64> {
    let [low, high] = bracket;
    let (mut old, mut new) = (near, near + 1e-3 * (high - low));
    let (mut f_old, mut f_new) = (f(old), f(new));
    for _ in 0..SECANTS {
        let step = -f_new * (new - old) / (f_new - f_old);
        (old, f_old) = (new, f_new);
        new += step;
        // a step that is not a number leaves it too
        if !(low..=high).contains(&new) {
            break;
        }
        if step.abs() <= CLOSE * new.abs() {
            return Some(new);
        }
        f_new = f(new);
    }
    let values = bracket.map(&f);
    (values[0] * values[1] <= 0.0).then(|| root(f, bracket, values))
}

/// Root of `f` within the `bracket`, at whose ends it has the `values`, to rounding: false position, the end that stays
/// weighed half (Illinois; Dowell & Jarratt, BIT 11, 1971).
pub(crate) fn root(f: impl Fn(f64) -> f64, bracket: [f64; 2], values: [f64; 2]) -> f64 {
    let ([mut old, mut new], [mut f_old, mut f_new]) = (bracket, values);
    while f_new != 0.0 && (new - old).abs() > 4.0 * f64::EPSILON * new.abs() {
        let next = new - f_new * (new - old) / (f_new - f_old);
        if next == new || next == old {
            return next;
        }
        let value = f(next);
        if value * f_new < 0.0 {
            (old, f_old) = (new, f_new);
        } else {
            f_old *= 0.5;
        }
        (new, f_new) = (next, value);
    }
    new
}
