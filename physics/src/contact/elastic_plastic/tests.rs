//! The surface that yields against closed forms, static and published finite elements.

use super::*;
use approx::assert_relative_eq;

const MODULUS: f64 = 210e9 / (1.0 - 0.09);

fn steel(yield_strength: f64) -> ElasticPlastic {
    ElasticPlastic::new(MODULUS, [yield_strength, 0.0], 0.3, false)
}

/// State at E' a/(Y rho).
fn at(law: &ElasticPlastic, strain: f64) -> Flattened {
    law.flattened((strain * law.yield_strength / law.modulus / law.onset).powi(2))
}

/// Onset where the largest pressure, 3/2 of the mean one, is about 1.6 yield strengths (Johnson, Contact Mechanics, section 6.2).
#[test]
fn yield_begins_at_the_pressure_of_hertz_and_tresca() {
    assert_relative_eq!(1.5 * steel(600e6).onset_pressure() / 600e6, 1.6, max_relative = 0.02);
}

#[test]
fn the_power_of_the_shear_stress_is_its_derivative() {
    for (is_sphere, hardening) in [(false, 0.0), (true, 0.0), (false, 2e9), (true, 2e9)] {
        let law = ElasticPlastic::new(MODULUS, [600e6, hardening], 0.3, is_sphere);
        // how strong a sphere that hardens is follows from its slope, whose small part of the power is left out
        let close = if is_sphere && hardening > 0.0 { 0.02 } else { 1e-8 };
        for w in [1.5, 10.0, 300.0, 2e4] {
            let [below, above] = [-1e-6, 1e-6].map(|step: f64| law.bears(w * step.exp())[0].ln());
            assert_relative_eq!(law.bears(w)[1], 0.5e6 * (above - below), epsilon = close);
        }
    }
}

/// On the axis sigma_r - sigma_z = Y: a stress along the surface takes its part of Y, a pressure gives it, and neither adds to one before.
#[test]
fn a_surface_that_is_pulled_yields_earlier_by_the_stress() {
    let law = steel(600e6);
    for stress in [60e6, -120e6] {
        let onset = law.pulled(1e8).pulled(stress).onset_pressure() / law.onset_pressure();
        assert_relative_eq!(onset, 1.0 - stress / 600e6, max_relative = 1e-12);
    }
    assert!(law.pulled(9e8).onset_pressure() > 0.0);
}

/// Neither a half-space nor a sphere jumps where it begins to yield: a force that does makes energy.
#[test]
fn the_pressure_is_continuous_at_first_yield() {
    for (is_sphere, hardening) in [(false, 0.0), (true, 0.0), (false, 100e9), (true, 100e9)] {
        let law = ElasticPlastic::new(MODULUS, [1e9, hardening], 0.3, is_sphere);
        let beyond = law.flattened(1.0 + 1e-6);
        assert_relative_eq!(beyond.pressure, law.flattened(1.0).pressure, max_relative = 2e-6);
        assert!(beyond.lasting < 1e-6 * beyond.flattening, "{beyond:?}");
    }
}

/// Up to half as far again as the curves were found.
#[test]
fn everything_grows_with_the_flattening() {
    for stresses in [[100e6, 0.0], [600e6, 0.0], [2000e6, 0.0], [600e6, 6e9], [600e6, 60e9], [600e6, 6e23]] {
        let law = ElasticPlastic::new(MODULUS, stresses, 0.3, false);
        let mut before = Flattened::NONE;
        for k in 1..2400 {
            let w = (0.005 * f64::from(k)).exp() * 0.01;
            let state = law.flattened(w);
            assert!(state.pressure > before.pressure && state.flattening > before.flattening, "{w}");
            assert!(state.lost >= before.lost && state.lasting >= before.lasting, "{w}");
            let shear = state.pressure * state.shears();
            assert_relative_eq!(law.sheared(shear, 0.0, 1.0).approach, w, max_relative = 1e-6);
            before = state;
        }
        let hardness = before.pressure / stresses[0];
        assert!((2.8..3.1).contains(&hardness) || stresses[1] > 0.0 && hardness > 3.1, "{hardness}");
    }
}

/// Mean pressure over Y at E' a/(Y rho), and what a rigid indenter rebounds with, of static finite elements (20 elements per contact radius,
/// the rim half an element inside the last node that touches).
#[test]
fn a_half_space_is_as_in_static_finite_elements() {
    let law = steel(600e6);
    for (strain, pressure, rebound) in [
        (4.0, 1.55, 0.949),
        (8.7, 2.09, 0.788),
        (11.7, 2.249, 0.726),
        (25.0, 2.617, 0.574),
        (39.0, 2.786, 0.492),
        (58.5, 2.877, 0.425),
        (78.0, 2.913, 0.381),
    ] {
        let state = at(&law, strain);
        assert_relative_eq!(state.pressure / 600e6, pressure, max_relative = 0.021);
        let stored = state.energy() * state.pressure.powi(2) / MODULUS;
        assert_relative_eq!((stored / (stored + state.lost)).sqrt(), rebound, max_relative = 0.015);
    }
}

/// The same of a sphere on a rigid flat: mean pressure over Y at a/R and E' a/(Y R).
#[test]
fn a_sphere_is_softer_as_in_static_finite_elements() {
    for (slope, strain, pressure) in [(0.195, 78.0, 2.397), (0.0975, 39.0, 2.60), (0.0975, 78.0, 2.661)] {
        let law = ElasticPlastic::new(MODULUS, [MODULUS * slope / strain, 0.0], 0.3, true);
        assert_relative_eq!(at(&law, strain).pressure / law.yield_strength, pressure, max_relative = 0.02);
    }
}

/// Hertz's energy is 2/5 F d; an even pressure moves the surface by 16/(3 pi) p a/E' in the mean (Johnson 1985, section 3.4).
#[test]
fn elastic_energies_are_those_of_the_half_space() {
    assert_relative_eq!(Flattened::NONE.energy(), 0.4 * PI * HERTZ, max_relative = 1e-12);
    assert_relative_eq!(Flattened::NONE.exponent(), 1.5, max_relative = 1e-12);
    let even = Flattened { evenness: 1.0, ..Flattened::NONE };
    assert_relative_eq!(even.energy(), 0.5 * PI * 16.0 / (3.0 * PI), max_relative = 1e-12);
}

/// Etsion, Kligerman & Kadin, Int. J. Solids Struct. 42 (2005) 3716, eq. (13): what comes back of the approach of w critical ones, over
/// p a/E' of Jackson and Green's loading, at the same flattening.
#[test]
#[allow(clippy::approx_constant, reason = "an overload, not 2 pi")]
fn what_comes_back_is_that_of_published_finite_elements() {
    let law = steel(600e6);
    for (w, overload, recovers) in [
        (3.8, 2.044, 2.151),
        (6.7, 2.836, 2.075),
        (14.4, 4.41, 1.990),
        (26.6, 6.28, 1.963),
        (48.5, 8.86, 1.985),
    ] {
        let found = law.flattened(overload * overload).recovers();
        assert!((found / recovers - 1.0).abs() < 0.025, "{w}: {found}");
    }
}
