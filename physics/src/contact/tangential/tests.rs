//! The springs along the surfaces against closed forms.

use super::*;
use crate::contact::Hertz;
use crate::material::Relaxation;
use approx::assert_relative_eq;

const FRICTION: f64 = 0.3;
const NORMAL_FORCE: f64 = 50.0;

fn law() -> Hertz {
    let steel = Material::elastic("steel", 210e9, 0.3, 7800.0);
    Hertz::new(3e-3, &steel, &steel)
}

fn contact(friction: f64) -> TangentialContact {
    let steel = Material::elastic("steel", 210e9, 0.3, 7800.0);
    let law = law();
    let mut contact = TangentialContact::new([&steel, &steel], friction, law.contact_radius(NORMAL_FORCE));
    contact.advance(law.press(NORMAL_FORCE), 0.0, 0.0);
    contact
}

/// Displacement in m at which all of it slides, over 1 - (1 - T/(mu N))^(2/3) (Johnson 1985, eq. 7.42).
fn whole(contact: &TangentialContact) -> f64 {
    1.5 * FRICTION * NORMAL_FORCE / contact.sticking_stiffness(contact.press.radius)
}

/// Mindlin and Deresiewicz's loop under a constant normal force: loading to 0.8 mu N, unloading to its opposite, loading again
/// (Johnson 1985, eqs. 7.42 to 7.46).
#[test]
fn a_loop_of_loading_and_unloading_is_mindlin_s() {
    let mut contact = contact(FRICTION);
    let (whole, limit) = (whole(&contact), FRICTION * NORMAL_FORCE);
    let turn = 0.8 * limit;
    let loading = |force: f64| whole * (1.0 - (1.0 - force / limit).powf(2.0 / 3.0));
    let unloading = |force: f64| {
        loading(turn) - 2.0 * whole * (1.0 - (1.0 - 0.5 * (turn - force) / limit).powf(2.0 / 3.0))
    };
    let mut place = 0.0;
    let mut go = |contact: &mut TangentialContact, to: f64| {
        // small steps, over which the work is summed up
        (0..100).for_each(|_| contact.advance(contact.press, (to - place) / 100.0, 0.0));
        place = to;
    };
    for share in [0.1, 0.3, 0.5, 0.7, 0.8] {
        go(&mut contact, loading(share * limit));
        assert!((contact.force - share * limit).abs() < 1e-3 * limit, "{share} {}", contact.force);
    }
    for share in [0.6, 0.2, -0.2, -0.5, -0.8] {
        go(&mut contact, unloading(share * limit));
        assert!((contact.force - share * limit).abs() < 1e-3 * limit, "{share} {}", contact.force);
    }
    // back the same way, mirrored: the loop closes
    for share in [0.5, 0.0, -0.5, -0.8_f64] {
        go(&mut contact, -unloading(share * limit));
        assert!((contact.force + share * limit).abs() < 1e-3 * limit, "{share} {}", contact.force);
    }
    // energy of the loop (Johnson 1985, eq. 7.49)
    let lost = |ratio: f64| {
        let left: f64 = 1.0 - ratio;
        3.6 * limit * limit / contact.sticking_stiffness(contact.press.radius)
            * (1.0 - left.powf(5.0 / 3.0) - 5.0 / 6.0 * ratio * (1.0 + left.powf(2.0 / 3.0)))
    };
    // one of loading before it, which dissipates an eighth less than half a loop of the same amplitude
    let mut first = super::tests::contact(FRICTION);
    (0..500).for_each(|_| first.advance(first.press, loading(turn) / 500.0, 0.0));
    let loop_energy = contact.dissipated() - first.dissipated();
    assert!((loop_energy / (2.0 * lost(0.8)) - 1.0).abs() < 5e-3, "{loop_energy} {}", lost(0.8));
}

/// Where it slides, friction times the normal force; without friction nothing; what sticks does not dissipate.
#[test]
fn it_slides_by_coulomb_and_sticks_by_mindlin() {
    let mut sliding = contact(FRICTION);
    sliding.advance(sliding.press, 3.0 * whole(&sliding), 0.0);
    assert!((sliding.force / (FRICTION * NORMAL_FORCE) - 1.0).abs() < 1e-4);
    let mut smooth = contact(0.0);
    smooth.advance(smooth.press, 1e-6, 0.0);
    assert_eq!((smooth.force, smooth.dissipated()), (0.0, 0.0));
    let mut sticking = contact(1e9);
    sticking.advance(sticking.press, 1e-6, 0.0);
    let stiffness = sticking.sticking_stiffness(sticking.press.radius);
    assert!((sticking.force / (stiffness * 1e-6) - 1.0).abs() < 1e-12);
    assert!(sticking.dissipated().abs() < 1e-12 * sticking.stored());
    assert!((sticking.stored() / (0.5 * stiffness * 1e-12) - 1.0).abs() < 1e-12);
}

/// Under a falling normal force what sticks slides in the end: no energy comes out of nothing.
#[test]
fn nothing_is_gained_under_a_changing_normal_force() {
    let mut contact = contact(FRICTION);
    let (whole, count) = (whole(&contact), 4000);
    let mut lost = 0.0;
    for step in 1..=count {
        let phase = step as f64 / count as f64;
        let press = law().press(NORMAL_FORCE * (1.0 - 0.9 * phase));
        contact.advance(press, 2.0 * whole * (0.7 - phase) / count as f64, 0.0);
        assert!(contact.dissipated() > lost - 1e-6 * FRICTION * NORMAL_FORCE * whole);
        lost = contact.dissipated();
    }
    assert!(lost > 0.02 * FRICTION * NORMAL_FORCE * whole);
}

/// Bodies of one material that relaxes, without sliding: the tangential force falls as the modulus does, and friction takes nothing.
#[test]
fn what_sticks_relaxes_as_the_material_does() {
    let polymer = Material {
        relaxation: vec![Relaxation { ratio: 0.4, time: 3e-5 }],
        ..Material::elastic("polymer", 2.6e9, 0.38, 1320.0)
    };
    let press = Press { force: NORMAL_FORCE, radius: 2e-4, ..Press::default() };
    let mut contact = TangentialContact::new([&polymer, &polymer], 1e6, press.radius);
    // the surfaces touch, and move at once
    contact.advance(press, 0.0, 1e-9);
    contact.advance(press, 1e-7, 1e-9);
    let (at_once, h) = (contact.force, 1e-7);
    assert_relative_eq!(at_once, contact.sticking_stiffness(press.radius) * 1e-7, max_relative = 1e-4);
    for step in 1..=600 {
        contact.advance(press, 0.0, h);
        let left = 1.0 - 0.4 * (1.0 - (-h * f64::from(step) / 3e-5).exp());
        assert_relative_eq!(contact.force, at_once * left, max_relative = 1e-4);
    }
    assert!(contact.dissipated().abs() < 1e-4 * contact.stored(), "{}", contact.dissipated());
    // without a load nothing holds, and what was moved recovers
    contact.advance(Press::default(), 0.0, h);
    assert_eq!(contact.force, 0.0);
}

/// A contact that has yielded bears more at its rim than Hertz's: all of it sticks up to a larger share of friction's force.
#[test]
fn an_even_pressure_slides_later_than_hertz_s() {
    let force = |evenness: f64| {
        let mut contact = contact(FRICTION);
        contact.advance(Press { evenness, ..contact.press }, 0.3 * whole(&contact), 0.0);
        contact.force
    };
    let all_sticks = contact(FRICTION).sticking_stiffness(contact(FRICTION).press.radius)
        * 0.3
        * whole(&contact(FRICTION));
    assert!(force(0.0) < 0.95 * all_sticks);
    assert!(force(1.0) > force(0.0) && force(1.0) < all_sticks);
}
