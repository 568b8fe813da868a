//! Roots of functions of one variable.

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
