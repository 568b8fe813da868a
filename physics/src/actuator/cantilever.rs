//! Euler-Bernoulli cantilever with a point mass at its tip, closed form
//! (R. Blevins, Formulas for Natural Frequency and Mode Shape, 1979, table 8-8).
//!
//! Frequencies: omega = lambda^2/L^2 sqrt(E I/(rho A)) with
//! 1 + cos lambda cosh lambda + mu lambda (cos lambda sinh lambda - sin lambda cosh lambda) = 0, mu = tip mass over beam
//! mass. Statics: a force F at the tip deflects it by F L^3/(3 E I), a uniform bending moment M by M L^2/(2 E I).
//!
//! From measurements (section 4.3 of the paper): with the stiffness k = 3 E I/L^3 at the tip and the first frequency
//! omega the beam's mass is m = lambda^4 k/(3 omega^2), and lambda solves the frequency equation with mu = tip mass/m.
//! Stiffness, frequency and mass hold for any length; the length enters where a moment is applied.

use std::f64::consts::PI;

/// The frequency equation divided by cosh, which keeps it bounded.
fn characteristic(lambda: f64, mass_ratio: f64) -> f64 {
    let (sine, cosine) = lambda.sin_cos();
    1.0 / lambda.cosh() + cosine + mass_ratio * lambda * (cosine * lambda.tanh() - sine)
}

/// The first `count` values of lambda for the ratio `mass_ratio` of tip mass to beam mass.
pub fn frequency_parameters(mass_ratio: f64, count: usize) -> Vec<f64> {
    // for any mass ratio one root lies in each ((n - 1) pi, n pi): at n pi the sign is that of cos
    let start = |n: usize| if n == 0 { 1e-9 } else { n as f64 * PI };
    (0..count).map(|n| bisect(|l| characteristic(l, mass_ratio), start(n), start(n + 1))).collect()
}

/// The first `count` eigenfrequencies in Hz of a beam of `length` m, `bending_stiffness` N m^2 and `line_mass` kg/m
/// with `tip_mass` kg at its tip.
pub fn frequencies(
    length: f64,
    bending_stiffness: f64,
    line_mass: f64,
    tip_mass: f64,
    count: usize,
) -> Vec<f64> {
    let unit = (bending_stiffness / line_mass).sqrt() / length.powi(2) / (2.0 * PI);
    frequency_parameters(tip_mass / (line_mass * length), count).iter().map(|l| l * l * unit).collect()
}

/// Bending stiffness E I in N m^2 of a beam of `length` m whose tip yields with `tip_stiffness` N/m.
pub fn bending_stiffness(length: f64, tip_stiffness: f64) -> f64 {
    tip_stiffness * length.powi(3) / 3.0
}

/// Uniform bending moment in N m that deflects the tip by `deflection` m.
pub fn moment_for_deflection(length: f64, bending_stiffness: f64, deflection: f64) -> f64 {
    2.0 * bending_stiffness * deflection / length.powi(2)
}

/// Strain energy in J of a beam of `length` m under the uniform bending moment `moment` N m: M^2 L/(2 E I).
pub fn moment_energy(length: f64, bending_stiffness: f64, moment: f64) -> f64 {
    0.5 * moment.powi(2) * length / bending_stiffness
}

/// The mass in kg at the tip of a massless beam of `tip_stiffness` N/m that swings at `frequency` Hz.
pub fn largest_tip_mass(frequency: f64, tip_stiffness: f64) -> f64 {
    tip_stiffness / (2.0 * PI * frequency).powi(2)
}

/// Mass in kg of the beam that swings at `frequency` Hz with `tip_mass` kg at a tip of `tip_stiffness` N/m; `None`
/// if the tip mass alone brings the frequency down to that.
pub fn mass_from_frequency(frequency: f64, tip_stiffness: f64, tip_mass: f64) -> Option<f64> {
    let swinging = largest_tip_mass(frequency, tip_stiffness);
    if tip_mass >= swinging {
        return None;
    }
    let mass = |lambda: f64| lambda.powi(4) * swinging / 3.0;
    let lambda = bisect(|l| characteristic(l, tip_mass / mass(l)), 1e-3, 1.9);
    Some(mass(lambda))
}

/// Root of `f`, which is positive at `low` and changes sign once, to double precision.
fn bisect(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let sign = f(low).signum();
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle).signum() == sign { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn parameters_without_and_with_a_tip_mass() {
        // Blevins, tables 8-1 and 8-8
        for (lambda, expected) in
            frequency_parameters(0.0, 4).iter().zip([1.875_104_07, 4.694_091_13, 7.854_757_44, 10.995_540_73])
        {
            assert_relative_eq!(*lambda, expected, max_relative = 1e-8);
        }
        // mass ratio 1: 1.2479; a heavy tip: clamped-pinned beam from the second on, 3.926602
        assert_relative_eq!(frequency_parameters(1.0, 1)[0], 1.2479, max_relative = 1e-4);
        assert_relative_eq!(frequency_parameters(1e9, 2)[1], 3.926_602_31, max_relative = 1e-8);
    }

    #[test]
    fn beam_from_measurements_has_them() {
        let (frequency, stiffness, tip_mass) = (500.0, 2500.0, 128e-6);
        let mass = mass_from_frequency(frequency, stiffness, tip_mass).expect("a beam");
        for length in [5e-3, 14e-3] {
            let bending = bending_stiffness(length, stiffness);
            let first = frequencies(length, bending, mass / length, tip_mass, 1)[0];
            assert_relative_eq!(first, frequency, max_relative = 1e-10);
        }
        // all the swinging mass at the tip leaves none for the beam
        assert_eq!(mass_from_frequency(500.0, 2500.0, 254e-6), None);
        assert!(mass_from_frequency(500.0, 2500.0, 253e-6).expect("a beam") < 3e-6);
    }
}
