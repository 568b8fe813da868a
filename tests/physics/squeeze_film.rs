//! The squeeze film (section 3.5.2 of the paper) against closed forms of lubrication theory.

use approx::assert_relative_eq;
use impactcheck::fluid::{Film, FilmForces, Indentation, Profile, Ring, Viscosity};
use impactcheck::scene::{Fluid, ShearThinning};
use std::f64::consts::PI;

const MU: f64 = 1e-3;
const RADIUS: f64 = 2e-3;

/// Rigid plate: the same gap and rate at every radius.
struct Rigid {
    gap: f64,
    rate: f64,
}

impl Profile for Rigid {
    fn gap(&self, _: f64) -> f64 {
        self.gap
    }
    fn rate(&self, _: Ring, _: f64) -> f64 {
        self.rate
    }
}

/// The same around the contact of an elastic tip with a patch of the squared radius `patch` times [`RADIUS`].
struct Pressed {
    patch: f64,
    rate: f64,
}

impl Pressed {
    fn indentation(&self) -> Indentation {
        Indentation::new(self.patch, 1.0, RADIUS)
    }
}

impl Profile for Pressed {
    fn gap(&self, r: f64) -> f64 {
        self.indentation().gap(r)
    }
    fn rate(&self, _: Ring, closing: f64) -> f64 {
        self.rate * closing
    }
    fn patch(&self) -> f64 {
        self.indentation().square()
    }
    fn closing(&self, ring: Ring) -> f64 {
        self.indentation().closing(ring)
    }
}

/// A plate that is curved and moves unevenly.
struct Wavy {
    gap: f64,
    phase: f64,
}

impl Profile for Wavy {
    fn gap(&self, r: f64) -> f64 {
        self.gap + 1e-6 * ((4e3 * r + self.phase).cos() - self.phase.cos())
    }
    fn rate(&self, ring: Ring, _: f64) -> f64 {
        0.3 * (3e3 * ring.radius() + 7.0 * self.phase).sin()
    }
}

fn solve(film: &Film, profile: &impl Profile) -> FilmForces {
    let mut forces = FilmForces::default();
    film.solve(profile, &mut forces);
    forces
}

fn sphere(minimum_gap: f64, cells: usize) -> Film {
    Film::new(Viscosity::Newtonian(MU), minimum_gap, RADIUS, RADIUS, cells)
}

fn taylor(gap: f64, speed: f64) -> f64 {
    6.0 * PI * MU * RADIUS * RADIUS * speed / gap
}

#[test]
fn sphere_near_a_plate_feels_taylors_force() {
    for gap in [0.25e-6, 1e-6, 3e-6] {
        for speed in [0.5, -0.5] {
            let force = solve(&sphere(1e-9, 64), &Rigid { gap, rate: -speed }).force;
            println!("h/R = {:.1e}: {:.5} of Taylor's force", gap / RADIUS, force / taylor(gap, speed));
            assert_relative_eq!(force, taylor(gap, speed), max_relative = 0.01);
            // the film ends at r = R, where its pressure is zero
            let edge = gap + 0.5 * RADIUS;
            let finite = taylor(gap, speed) * (1.0 - gap / edge).powi(2);
            assert_relative_eq!(force, finite, max_relative = 1e-3);
            // exact Stokes flow (Brenner 1961, Cox & Brenner 1967): R/h + ln(R/h)/5 + 0.971
            let stokes = taylor(gap, speed) * (1.0 + gap / RADIUS * (0.2 * (RADIUS / gap).ln() + 0.971));
            assert_relative_eq!(force, stokes, max_relative = 0.015);
        }
    }
}

#[test]
fn error_falls_with_the_square_of_the_cells() {
    let force = |cells| solve(&sphere(1e-9, cells), &Rigid { gap: 1e-6, rate: -1.0 }).force;
    let exact = force(16_384);
    let errors = [32, 64, 128, 256].map(|cells| (force(cells) / exact - 1.0).abs());
    println!("{errors:?}");
    assert!(errors[1] < 3e-3, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((3.5..4.5).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
}

#[test]
fn parallel_discs_feel_stefans_force() {
    // a tip so blunt that it is flat: 3 pi mu v a^4/(2 h^3)
    let (rim, gap, speed) = (1e-3, 1e-4, 0.1);
    let film = Film::new(Viscosity::Newtonian(MU), 1e-9, 1e4, rim, 256);
    let force = solve(&film, &Rigid { gap, rate: -speed }).force;
    assert_relative_eq!(force, 1.5 * PI * MU * speed * rim.powi(4) / gap.powi(3), max_relative = 1e-3);
}

#[test]
fn parallel_discs_in_a_power_law_fluid_feel_scotts_force() {
    // 2 pi K/h ((2 n + 1) v/(n h^2))^n a^(n + 3)/(n + 3)
    let (rim, gap, speed, n, time) = (1e-3, 1e-5, 0.05, 0.5_f64, 10.0);
    let shear_thinning =
        Some(ShearThinning { infinite_shear_viscosity: 1e-12, relaxation_time: time, power_index: n });
    let fluid = Fluid {
        viscosity: MU,
        density: 1e3,
        minimum_gap: 1e-9,
        squeeze_film: true,
        added_mass_frequency_ratio: 1.0,
        plate_damping_ratio: 0.0,
        drag_coefficient: 0.0,
        shear_thinning,
    };
    let film = Film::new(Viscosity::new(&fluid), 1e-9, 1e4, rim, 256);
    let force = solve(&film, &Rigid { gap, rate: -speed }).force;
    let consistency = MU * time.powf(n - 1.0);
    let scott = 2.0 * PI * consistency / gap
        * ((2.0 * n + 1.0) * speed / (n * gap * gap)).powf(n)
        * rim.powf(n + 3.0)
        / (n + 3.0);
    assert_relative_eq!(force, scott, max_relative = 3e-3);
}

#[test]
fn bodies_in_contact_feel_the_film_around_the_patch() {
    // with V(r), what is squeezed out inside of r per second, the force is the integral of 6 mu V^2/(pi r h*^3) dr
    let minimum_gap = 0.25e-6;
    for patch in [1e-8, 1e-6, 5e-6] {
        let a = (RADIUS * patch).sqrt();
        let rim = RADIUS / a;
        let integrand = |rho: f64| {
            let opening = rho.recip().acos();
            let side = (rho * rho - 1.0).sqrt();
            let gap = patch / PI * (side + (rho * rho - 2.0) * opening);
            let volume = 2.0 * a * a * (rho * rho * opening - side);
            6.0 * MU * volume * volume / (PI * rho * gap.max(minimum_gap).powi(3))
        };
        // r = a + (rim - a) s^4 has most points at the patch
        let count = 200_000;
        let expected: f64 = (0..count)
            .map(|k| (f64::from(k) + 0.5) / f64::from(count))
            .map(|s| {
                integrand(1.0 + (rim - 1.0) * s.powi(4)) * 4.0 * (rim - 1.0) * s.powi(3) / f64::from(count)
            })
            .sum();
        let force = solve(&sphere(minimum_gap, 64), &Pressed { patch, rate: -1.0 }).force;
        println!("patch {:.1e} m: {force:.5} N, quadrature {expected:.5} N", a);
        assert_relative_eq!(force, expected, max_relative = 0.01);
    }
}

#[test]
fn film_takes_from_the_motion_exactly_what_it_dissipates() {
    for (i, gap) in [1e-2, 1e-4, 3e-6, 2e-7, 0.0, -1e-7, -3e-6].into_iter().enumerate() {
        for phase in [0.0, 0.7, 2.0, 4.0] {
            let profile = Wavy { gap, phase: phase + i as f64 };
            let forces = solve(&sphere(0.25e-6, 64), &profile);
            let taken: f64 = forces
                .faces
                .iter()
                .zip(&forces.load)
                .map(|(face, load)| -load * profile.rate(face.ring, face.closing))
                .sum();
            assert!(forces.dissipation >= 0.0);
            assert_relative_eq!(taken, forces.dissipation, max_relative = 1e-11);
        }
    }
}

#[test]
fn force_is_finite_and_continuous_from_ten_millimetres_to_contact_and_back() {
    let film = sphere(0.25e-6, 64);
    // gaps from 10 mm to 1e-12 m, through zero, to a patch as wide as the film
    let outside = (0..=2000).map(|i| 1e-2 * 1e-10_f64.powf(f64::from(i) / 2000.0));
    let inside = (0..=2000).map(|i| -1e-12 * 1e10_f64.powf(f64::from(i) / 2000.0));
    let path: Vec<f64> = outside.chain([0.0]).chain(inside).collect();
    let force = |gap: f64, rate| solve(&film, &Pressed { patch: -gap, rate }).force;
    let closing: Vec<f64> = path.iter().map(|&gap| force(gap, -1.0)).collect();
    let opening: Vec<f64> = path.iter().rev().map(|&gap| force(gap, 1.0)).collect();
    let largest = closing.iter().copied().fold(0.0, f64::max);
    // the minimal gap bounds the force: 18 pi mu R^2 v/h_min at the touch
    assert_relative_eq!(largest, 3.0 * taylor(0.25e-6, 1.0), max_relative = 0.02);
    for (closing, opening) in closing.iter().zip(opening.iter().rev()) {
        assert!(closing.is_finite() && *closing >= 0.0, "{closing}");
        assert_relative_eq!(*closing, -opening, max_relative = 1e-12);
    }
    for pair in closing.windows(2) {
        assert!((pair[1] - pair[0]).abs() < 0.02 * largest, "{pair:?}");
    }
}

/// A plate that bends around the tip: with the tip's paraboloid the gap is gap + slope x + curve x^2 in x = r^2.
struct Around {
    gap: f64,
    slope: f64,
    curve: f64,
}

impl Profile for Around {
    fn gap(&self, r: f64) -> f64 {
        let x = r * r;
        self.gap + (self.slope - 0.5 / RADIUS) * x + self.curve * x * x
    }
    fn rate(&self, _: Ring, _: f64) -> f64 {
        -0.1
    }
}

#[test]
fn overlap_off_the_axis_has_a_warning() {
    let film = sphere(1e-7, 512);
    // deepest at x = -slope/(2 curve), by slope^2/(4 curve)
    let (slope, curve) = (-20.0f64, 2e7);
    let (place, dip) = ((-slope / (2.0 * curve)).sqrt(), slope * slope / (4.0 * curve));
    for gap in [1e-6, 0.0] {
        let overlap = solve(&film, &Around { gap, slope, curve }).overlap.expect("an overlap");
        assert_relative_eq!(overlap.depth, dip - gap, max_relative = 0.05);
        assert_relative_eq!(overlap.radius, place, max_relative = 0.2);
    }
    // how much deeper than the minimal gap counts is for the integrator to say
    let little = solve(&film, &Around { gap: dip - 0.5e-7, slope, curve }).overlap.expect("an overlap");
    assert_relative_eq!(little.depth, 0.5e-7, max_relative = 0.05);
    assert_eq!(solve(&film, &Around { gap: 1e-6, slope: 100.0, curve: 0.0 }).overlap, None);
    assert_eq!(solve(&film, &Pressed { patch: 1e-6, rate: -1.0 }).overlap, None);
}
