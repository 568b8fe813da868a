//! Vibration against closed forms.

use super::*;

/// Static limit -(F_s + m g).t / (m (-d.t)) with t up the inner flank, and the least half-sine above pi sqrt(2 dU/m) / (2 T).
#[test]
fn limits_of_vibration() {
    let setup = valve(37e-3, 0.5, 0.3);
    let landscape = Landscape::new(&setup).expect("held");
    let scene = improved();
    let ring = scene.seal_seat().expect("a seat").ring();
    // up the inner flank, which rises by 15 deg
    let slope = ring.axis[1].acos() + 0.5 * PI - PI / 3.0 - 2.0 * ring.axis[0].asin();
    let up = Vector::new(slope.cos(), slope.sin());
    let left = Vector::new(-1.0, 0.0);
    let pull = G + 37e-3 / setup.mass;
    let expected = pull * up.y / up.x;
    for (duration, friction) in [(0.5e-3, 0.3), (2e-3, 0.3), (8e-3, 0.3), (5e-3, 0.0), (1e-3, 0.0)] {
        let setup = Setup { friction, ..setup.clone() };
        let found = thresholds(&setup, &landscape, &Wave::HalfSine { duration }, left);
        let unseats = found.unseats.expect("it leans out");
        assert!((unseats / expected - 1.0).abs() < 1e-12, "{unseats} instead of {expected}");
        let (shifts, bound) = (found.shifts.expect("it shifts"), found.energy_bound);
        assert!(shifts > bound && shifts > unseats, "{shifts} {bound} {unseats}");
        // of a short shock little is lost to the way during it; rolling takes two fifths more of the energy
        let most = if friction > 0.0 { 1.4 } else { 1.2 };
        assert!(duration > 1e-3 || shifts < most * bound, "{shifts} {bound}");
    }
    // a slow sine shifts what it unseats as soon as it stays long enough: half a period far longer than the way takes
    let slow = Wave::Sine { frequency: 0.5, periods: 1.0 };
    let found = thresholds(&setup, &landscape, &slow, left);
    assert!(found.shifts.expect("it shifts") < 2.0 * found.unseats.expect("it leans out"));
    // pressed into the seat it stays
    let shock = Wave::HalfSine { duration: 1e-3 };
    let up = thresholds(&setup, &landscape, &shock, Vector::new(0.0, 1.0));
    assert_eq!((up.unseats, up.shifts), (None, None));
}

/// With a spring force that falls linearly over the way to the saddle s, a_u = v_min^2 / s: 63 g at 555 mm/s and 0.5 mm.
#[test]
fn what_is_shifted_easily_does_not_hold() {
    let mut setup = rocker(0.5, 0.0, 0.0);
    let half = 0.5e-3_f64;
    if let Some(spring) = &mut setup.field.spring {
        // an anchor far away: the push along the floor is linear
        spring.anchor = Some(Vector::new(0.0, 0.05 + setup.radius));
        let arm = half.hypot(0.05) - 0.05;
        spring.force = 0.5 * setup.mass * 0.555_f64.powi(2) / arm;
    }
    let landscape = Landscape::new(&setup).expect("two seats");
    assert!((landscape.least_speed(setup.mass) / 0.555 - 1.0).abs() < 1e-9);
    let shock = Wave::HalfSine { duration: 1e-3 };
    let found = thresholds(&setup, &landscape, &shock, Vector::new(-1.0, 0.0));
    let law = 0.555_f64.powi(2) / half;
    let unseats = found.unseats.expect("off the wall");
    assert!((unseats / law - 1.0).abs() < 1e-4, "{unseats} instead of {law}");
    assert!((unseats / G - 63.0).abs() < 1.0);
}

/// Rolling waits in its seat until the valve is shaken, and afterwards lies there again.
#[test]
fn a_weak_shock_leaves_the_sphere_in_its_seat() {
    let mut setup = valve(37e-3, 0.5, 0.3);
    let landscape = Landscape::new(&setup).expect("held");
    let wave = Wave::Sine { frequency: 200.0, periods: 5.0 };
    setup.field.shaken = Some(Excitation { direction: Vector::new(-1.0, 0.0), amplitude: 150.0, wave });
    let (state, mode) = setup.seated(&landscape);
    assert!(matches!(mode, MotionMode::Wedged(..)), "{mode:?}");
    let flight = moved(&setup, &landscape, state, mode, MotionRequest { path: true, beyond: None });
    assert_eq!(flight.ending, Ending::Seat(Seat::Same));
    let farthest = flight.path.iter().map(|s| (s.place - state.place).norm()).fold(0.0, f64::max);
    assert!(farthest > 1e-6, "150 m/s^2 lift it off: {farthest}");
}

/// A short shock gives all its impulse to a sphere that can slide, and shifts with the saddle's energy; a long one as soon as statics lets
/// the sphere go, because the spring's force falls on the way. Between them neither is enough.
#[test]
fn energy_bounds_short_shocks_and_statics_long_ones() {
    let setup = rocker(0.5, 0.0, 0.0);
    let landscape = Landscape::new(&setup).expect("two seats");
    let left = Vector::new(-1.0, 0.0);
    let of = |duration: f64| {
        let found = thresholds(&setup, &landscape, &Wave::HalfSine { duration }, left);
        (found.shifts.expect("it shifts"), found.unseats.expect("off the wall"), found.energy_bound)
    };
    let (shifts, _, bound) = of(1e-6);
    assert!((1.0..1.001).contains(&(shifts / bound)), "{shifts} {bound}");
    let (shifts, unseats, _) = of(0.2);
    assert!((1.0..1.001).contains(&(shifts / unseats)), "{shifts} {unseats}");
    for k in [-2, 0, 2] {
        let frequency = 100.0 * 4.0_f64.powi(k);
        for wave in [Wave::HalfSine { duration: 1.0 }, Wave::Sine { frequency, periods: 3.0 }] {
            let found = thresholds(&setup, &landscape, &wave.at_frequency(frequency), left);
            let least = found.unseats.expect("off the wall").max(found.energy_bound);
            assert!(found.shifts.expect("it shifts") > least, "{frequency} Hz: {found:?}");
        }
    }
}

/// A record of a half-sine is one, with an error that falls with the square of the samples' distance; so is its impulse.
#[test]
fn a_record_of_a_shock_is_the_shock() {
    let setup = valve(37e-3, 0.5, 0.0);
    let landscape = Landscape::new(&setup).expect("held");
    let shock = Wave::HalfSine { duration: 2e-3 };
    let record = |samples: u32| {
        let time: Vec<f64> = (0..=samples).map(|k| 2e-3 * f64::from(k) / f64::from(samples)).collect();
        let acceleration = time.iter().map(|t| shock.at(*t)).collect();
        Wave::Record { time, acceleration }
    };
    let shifts =
        |wave: &Wave| thresholds(&setup, &landscape, wave, Vector::new(-1.0, 0.0)).shifts.expect("it shifts");
    let exact = shifts(&shock);
    let [coarse, fine] = [20, 40].map(|samples| {
        let record = record(samples);
        let impulse = record.impulse() / shock.impulse() - 1.0;
        [impulse, shifts(&record) / exact - 1.0]
    });
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(coarse.abs() < 3e-3 && (3.5..4.5).contains(&(coarse / fine)), "{coarse} {fine}");
    }
    // a rectangle ends at once, however few samples it has
    let rectangle = |samples: u32| {
        let time: Vec<f64> = (0..=samples).map(|k| 1e-4 * f64::from(k) / f64::from(samples)).collect();
        Wave::Record { acceleration: vec![3.0; time.len()], time }
    };
    let [one, many] = [1, 100].map(|samples| shifts(&rectangle(samples)));
    assert!((one / many - 1.0).abs() < 1e-6, "{one} {many}");
    let through_zero = Wave::Record { time: vec![0.0, 1.0, 4.0], acceleration: vec![2.0, 2.0, -1.0] };
    assert!((through_zero.impulse() - (2.0 + 2.0 + 0.5)).abs() < 1e-15);
}

/// A map has the seat of every flight, and leaves out launches into the floor.
#[test]
fn a_map_is_made_of_flights() {
    let setup = rocker(0.5, 0.2, 0.0);
    let landscape = Landscape::new(&setup).expect("two seats");
    let (speeds, angles) = ([0.2, 0.8, 1.4], [0.3 * PI, 0.5 * PI, 0.6 * PI]);
    let map = map_of_landings(&setup, &landscape, [&speeds, &angles], 0.0);
    assert_eq!(map.len(), 6, "{map:?}");
    for Landing { launch, seat } in map {
        assert!(launch.angle < 0.51 * PI);
        assert_eq!(fly(&setup, &landscape, &launch, false).ending.seat(), seat);
    }
}
