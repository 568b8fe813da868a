//! The law of two surfaces against closed forms, published finite elements and its own energy.

use super::*;
use approx::assert_relative_eq;

fn steel(factor: f64) -> Material {
    Material::elastic("steel", factor * 210e9, 0.3, 7780.0)
}

/// A tip of 10 mm and a flat of steel; `factors` of their stiffness.
fn pair(tip_radius: f64, factors: [f64; 2], yield_strength: [Option<f64>; 2]) -> DentedContact {
    let [body, plate] = factors.map(steel);
    let hertz = Hertz::new(tip_radius, &body, &plate);
    DentedContact::new(hertz, [&body, &plate], yield_strength).unwrap()
}

/// The contact driven from one approach in m to another in small steps, and the work done on it, J.
fn driven(mut contact: DentedContact, [from, to]: [f64; 2]) -> (DentedContact, f64) {
    let mut work = 0.0;
    let mut before = contact.force(from)[0];
    for k in 1..=STEPS {
        let x = from + (to - from) * f64::from(k) / f64::from(STEPS);
        let force = contact.force(x)[0];
        work += 0.5 * (before + force) * (to - from) / f64::from(STEPS);
        before = force;
        contact.advance(x);
    }
    (contact, work)
}

const STEPS: u32 = 400;
const STRENGTH: f64 = 600e6;

/// Jackson and Green's eqs. (16) to (23), of a sphere on a rigid flat: force in N at `w` critical approaches.
fn jackson_and_green(radius: f64, modulus: f64, strength: f64, w: f64) -> f64 {
    let factor = 1.295 * (0.736_f64 * 0.3).exp();
    let critical = (0.5 * PI * factor * strength / modulus).powi(2) * radius;
    let critical_force = 4.0 / 3.0 * (radius / modulus).powi(2) * (0.5 * PI * factor * strength).powi(3);
    let contact = (radius * w * critical * (w / 1.9).powf(0.14 * (23.0 * strength / modulus).exp())).sqrt();
    let hardness = 2.84 * strength * (1.0 - (-0.82 * (contact / radius).powf(-0.7)).exp());
    critical_force
        * ((-0.25 * w.powf(5.0 / 12.0)).exp() * w.powf(1.5)
            + 4.0 * hardness / (factor * strength) * (1.0 - (-w.powf(5.0 / 9.0) / 25.0).exp()) * w)
}

/// Other people's finite elements, with large deformations, in their range of 110 critical approaches.
#[test]
fn on_a_rigid_flat_the_force_is_about_that_of_jackson_and_green() {
    let contact = pair(0.01, [1.0, 1e9], [Some(STRENGTH), None]);
    for w in [3.0, 10.0, 40.0, 100.0] {
        let x = w * contact.critical_approach();
        let force = driven(contact, [0.0, x]).0.force(x)[0];
        let expected = jackson_and_green(0.01, 210e9 / 0.91, STRENGTH, w);
        assert_relative_eq!(force, expected, max_relative = 0.05);
    }
}

/// Two equal surfaces meet in a plane, which is a rigid flat to each: half the approach, twice the radius. The slope of the sphere beside
/// the contact is no matter at so small a strength.
#[test]
fn equal_surfaces_are_mirror_images() {
    let weak = Some(0.05 * STRENGTH);
    let mut both = pair(0.01, [1.0; 2], [weak; 2]);
    let mut one = pair(0.02, [1.0, 1e9], [weak, None]);
    let mut from = 0.0;
    for x in [10.0, 40.0, 20.0, 60.0, 50.0].map(|w| w * both.critical_approach()) {
        (both, one) = (driven(both, [from, x]).0, driven(one, [0.5 * from, 0.5 * x]).0);
        from = x;
        assert_relative_eq!(both.force(x)[0], one.force(0.5 * x)[0], max_relative = 3e-3);
        assert_relative_eq!(both.depth(), 2.0 * one.depth(), max_relative = 3e-3);
    }
}

/// Unlike moduli and yield strengths: continuous where either surface begins to yield, and Hertz's law before.
#[test]
fn loading_is_hertz_s_law_and_then_softer() {
    for strengths in
        [[None, Some(3e8)], [Some(4e8), Some(3e8)], [Some(3e8), Some(3.001e8)], [Some(9e8), Some(3e8)]]
    {
        let mut contact = pair(0.01, [1.0, 0.4], strengths);
        let critical = contact.critical_approach();
        let mut before = 0.0;
        for k in 1..6000 {
            let x = 0.02 * f64::from(k) * critical;
            let [force, slope] = contact.force(x);
            let elastic = contact.hertz.force(x);
            if x < critical {
                assert_relative_eq!(force, elastic, max_relative = 1e-9);
            }
            assert!(force > before && force < 1.03 * elastic && slope > 0.0, "{strengths:?} {k}");
            assert!(force - before < 2.0 * 0.02 * critical * contact.hertz.tangent(x), "{strengths:?} {k}");
            before = force;
            contact.advance(x);
        }
    }
}

/// Beside the depth of a dent the first touch after it is below the rounding of the approach; the force begins as a power all the same.
#[test]
fn an_indentation_is_contacted_gently() {
    let mut contact = pair(0.01, [1.0; 2], [None, Some(1e8)]);
    contact.advance(300.0 * contact.critical_approach());
    contact.advance(0.0);
    let depth = contact.depth();
    let mut before = 0.0;
    for k in 0..40 {
        let x = depth + 1e-20 * 2.0_f64.powi(k) * (depth / 1e-5);
        let [force, slope] = contact.force(x);
        assert!(force >= before && slope.is_finite() && (x == depth || slope > 0.0), "{k}: {force} {slope}");
        before = force;
    }
}

/// Let go and pressed again it is elastic, F = F_m ((x - x_r)/(x_m - x_r))^n, whichever surface yields.
#[test]
fn a_dent_is_elastic_up_to_the_force_that_made_it() {
    for strengths in [[Some(STRENGTH); 2], [None, Some(STRENGTH)], [Some(STRENGTH), None]] {
        let contact = pair(0.01, [1.0; 2], strengths);
        let x_m = 30.0 * contact.critical_approach();
        let (contact, _) = driven(contact, [0.0, x_m]);
        let [f_m, _] = contact.force(x_m);
        let x_r = contact.depth();
        assert!(x_r > 0.2 * x_m && x_r < 0.7 * x_m);
        let exponent = contact.surfaces.iter().flatten().next().unwrap().dent.deepest.exponent();
        for share in [0.1, 0.5, 0.9, 0.999] {
            let [force, slope] = contact.force(x_r + share * (x_m - x_r));
            assert_relative_eq!(force, f_m * share.powf(exponent), max_relative = 2e-2);
            assert_relative_eq!(slope, exponent * force / (share * (x_m - x_r)), max_relative = 2e-2);
        }
        assert_eq!(contact.force(x_r), [0.0; 2]);
        let mut again = contact;
        for x in [x_r, x_m, 0.5 * (x_r + x_m), x_r] {
            again.advance(x);
        }
        assert_relative_eq!(again.depth(), x_r, max_relative = 1e-6);
        assert_relative_eq!(again.dissipated(), contact.dissipated(), max_relative = 1e-6);
        again.advance(1.1 * x_m);
        assert!(again.depth() > x_r && again.dissipated() > contact.dissipated());
    }
}

/// The rebound falls from 1 without a jump, and never rises above it: just past first yield the old law returned more than it took.
#[test]
fn the_rebound_is_continuous_through_the_onset_of_yield() {
    for strengths in
        [[Some(STRENGTH), None], [None, Some(STRENGTH)], [Some(1.3e9); 2], [Some(1.1e9), Some(1e9)]]
    {
        let virgin = pair(0.01, [1.0; 2], strengths);
        let mut before = 1.0;
        for k in 0..60 {
            let x = (0.9 + 0.02 * f64::from(k)) * virgin.critical_approach();
            let (pressed, work) = driven(virgin, [0.0, x]);
            let share = pressed.dissipated() / work;
            assert!(share >= 0.0 && (x > virgin.critical_approach() || share == 0.0), "{k}: {share}");
            assert!(1.0 - share <= before && before - (1.0 - share) < 0.01, "{k}: {share}");
            before = 1.0 - share;
        }
    }
}

/// Work on closed loops, by the force alone, is what the contact says that it has dissipated, and never negative: random strengths, moduli
/// (a flat ten times softer too), depths and fresh spots.
#[test]
fn no_closed_loop_returns_more_than_it_took() {
    let mut state = 12345_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for case in 0..60 {
        let strengths =
            [0, 1].map(|i| (case % 3 != i).then(|| 0.25 * STRENGTH * 4.0_f64.powf(random() - 0.5)));
        let mut contact = pair(0.01, [1.0, 10.0_f64.powf(0.5 - 1.5 * random())], strengths);
        let critical = contact.critical_approach();
        for _ in 0..4 {
            let (start, lost) = (contact.depth(), contact.dissipated());
            let x = start + critical * 1.05 * 100.0_f64.powf(random());
            let (pressed, up) = driven(contact, [start, x]);
            let (free, down) = driven(pressed, [x, start]);
            assert!(pressed.dissipated() >= lost && free.dissipated() == pressed.dissipated(), "{case}");
            assert!(up + down > -1e-4 * up, "{case}: {up} {down}");
            let error = (up + down - (free.dissipated() - lost)).abs() / up;
            assert!(error < 3e-3, "{case}: {error} {strengths:?}");
            contact = if random() < 0.3 { free.on_a_fresh_spot() } else { free };
        }
    }
}

/// The contact after a `force` in N.
fn after(mut contact: DentedContact, force: f64) -> DentedContact {
    let step = 0.02 * contact.critical_approach();
    let mut x = contact.depth();
    while contact.force(x)[0] < force {
        x += step.max(0.01 * (x - contact.depth()));
        contact.advance(x);
    }
    contact
}

/// At first either surface bears half; once the pressure is that of a hardness test (Johnson 1985, section 6.3) it forms what yields
/// alone.
#[test]
fn where_one_surface_yields_it_takes_most_of_the_dent_in_the_end() {
    let both = pair(0.01, [1.0; 2], [Some(STRENGTH); 2]);
    let one = pair(0.01, [1.0; 2], [None, Some(STRENGTH)]);
    let share = |load: f64| {
        let [one, both] =
            [one, both].map(|contact| after(contact, load * both.critical_force()).dissipated());
        one / both
    };
    assert_relative_eq!(share(1.2), 0.5, epsilon = 0.15);
    for load in [10.0, 50.0, 300.0] {
        assert!(share(load) > 0.8 && share(load) < 1.05, "{}", share(load));
    }
}

/// A fresh spot of the body keeps the plate's dent, which spreads the force: the body yields less than against a virgin plate. A body that
/// has not yielded is as fresh as ever.
#[test]
fn a_fresh_spot_keeps_the_other_dent() {
    let virgin = pair(0.01, [1.0; 2], [Some(STRENGTH); 2]);
    let force = 100.0 * virgin.critical_force();
    let dented = after(virgin, force);
    let fresh = dented.on_a_fresh_spot();
    assert_eq!(fresh.depth(), dented.surfaces[1].unwrap().dent.depth);
    assert!(fresh.depth() > 0.4 * dented.depth() && fresh.depth() < 0.5 * dented.depth());
    let [again, first] =
        [fresh, virgin].map(|contact| after(contact, 0.3 * force).surfaces[0].unwrap().dent.lost);
    assert!(again < 0.9 * first && again > 0.05 * first, "{again} {first}");
    let soft = after(pair(0.01, [1.0; 2], [Some(4.0 * STRENGTH), Some(STRENGTH)]), force);
    assert_eq!(soft.on_a_fresh_spot().depth(), soft.depth());
    let x = soft.depth() + soft.critical_approach();
    assert_relative_eq!(soft.on_a_fresh_spot().force(x)[0], soft.force(x)[0], max_relative = 1e-9);
}
