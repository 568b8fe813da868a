//! Histories of an impact in closed form: half-sine contact forces on rigid spheres, velocities and
//! displacements their exact integrals. Physically plausible (the size of Fig. 10), and consistent
//! to rounding, so that whatever a check finds in them has been put there.
#![allow(dead_code)] // Each test file uses its own part.

use impactcheck::kinds::plate_impact::PlateImpact;
use impactcheck::kinds::plate_impact::{CURVES, PlateQuantities};
use impactcheck::result::{History, Outcome, SCHEMA_VERSION, Source, Summary};
use impactcheck::scene::{
    Edge, Geometry, Inner, Material, Model, Outer, Plate, ReducedSettings, ReferenceSettings, RunSettings,
    Scene, Shape, Tolerance, Turning,
};
use std::collections::BTreeMap;
use std::f64::consts::PI;

pub const SPEED: f64 = 0.55;
pub const SAMPLE_INTERVAL: f64 = 0.125e-6;

/// Half-sine contact force.
#[derive(Debug, Clone, Copy)]
pub struct Pulse {
    pub start: f64,
    pub end: f64,
    pub peak: f64,
}

impl Pulse {
    fn duration(&self) -> f64 {
        self.end - self.start
    }
    fn phase(&self, t: f64) -> f64 {
        PI * (t.clamp(self.start, self.end) - self.start) / self.duration()
    }
    pub fn force(&self, t: f64) -> f64 {
        if t > self.start && t < self.end { self.peak * self.phase(t).sin() } else { 0.0 }
    }
    /// Impulse from 0 to `t`.
    pub fn impulse(&self, t: f64) -> f64 {
        self.peak * self.duration() / PI * (1.0 - self.phase(t).cos())
    }
    /// Integral of the impulse from 0 to `t`.
    fn double_impulse(&self, t: f64) -> f64 {
        let (scale, inside) = (self.duration() / PI, t.clamp(self.start, self.end) - self.start);
        let within = self.peak * scale * (inside - scale * self.phase(t).sin());
        within + self.impulse(self.end) * (t - self.end).max(0.0)
    }
}

/// The forces of one solution.
#[derive(Debug, Clone, Copy)]
pub struct Impact {
    pub outer: Pulse,
    pub inner: Pulse,
    pub plate_amplitude: f64,
}

/// What the synthetic reference does.
pub const REFERENCE: Impact = Impact {
    outer: Pulse { start: 0.0, end: 180e-6, peak: 243.0 },
    inner: Pulse { start: 3e-6, end: 85e-6, peak: 286.0 },
    plate_amplitude: 18e-6,
};

/// What the synthetic reduced model does: longer contact, lower force, as model B.
pub const REDUCED: Impact = Impact {
    outer: Pulse { start: 0.0, end: 183e-6, peak: 238.0 },
    inner: Pulse { start: 3e-6, end: 87e-6, peak: 278.0 },
    plate_amplitude: 18.3e-6,
};

/// Scene with two equal steel spheres.
pub fn scene() -> Scene {
    let steel = Material::elastic("steel", 210e9, 0.3, 7780.0);
    let sphere = Shape::Sphere { radius: 0.01 };
    Scene {
        flight: None,
        vibration: None,
        name: "synthetic".into(),
        description: "Half-sine forces on two spheres".into(),
        setup: PlateImpact {
            friction: 0.0,
            plate: Plate {
                radius: 0.033,
                thickness: 0.002,
                edge: Edge::Clamped,
                material: steel.clone(),
                damping_ratio: 0.0,
            },
            outer: Outer::centred(sphere.clone(), steel.clone(), SPEED),
            inner: Inner {
                shape: sphere,
                material: steel,
                gap: 0.0,
                speed: 0.0,
                turning: Turning::default(),
            },
            fluid: None,
            series: None,
        }
        .into(),
        run: RunSettings { end_time: None },
        reduced: ReducedSettings { model: Some(Model::B), modes: Some(16), frequencies: None },
        reference: ReferenceSettings {
            geometry: Geometry::Axisymmetric,
            elements_per_contact_radius: Some(12.0),
            elements_per_thickness: None,
            elements_per_ring_radius: None,
            element_order: None,
            rigid: None,
        },
        tolerances: BTreeMap::new(),
        uncertainty: None,
        external: Vec::new(),
    }
}

/// The scene with tolerances of model B: half a per cent about the known discrepancies.
pub fn gated_scene() -> Scene {
    let comparison = impactcheck::comparison::compare_scene(&scene(), &reference(), &[reduced()]);
    let mut tolerances = BTreeMap::new();
    for row in &comparison.models[0].discrepancies {
        let tolerance = match row.quantity.as_str() {
            "energy_residual" | "momentum_residual" => {
                Tolerance { absolute: Some(1e-5), ..Tolerance::default() }
            }
            _ => Tolerance { relative: Some(0.005), bias: row.relative, ..Tolerance::default() },
        };
        tolerances.insert(row.quantity.clone(), tolerance);
    }
    Scene { tolerances: BTreeMap::from([("B".to_owned(), tolerances)]), ..scene() }
}

fn mass() -> f64 {
    4.0 / 3.0 * PI * 0.01_f64.powi(3) * 7780.0
}

/// History at the given instants; with `interval`, forces are averages over the interval before.
pub fn history(impact: &Impact, time: Vec<f64>, interval: Option<f64>) -> History {
    let m = mass();
    let of = |f: &dyn Fn(f64) -> f64| time.iter().map(|&t| f(t)).collect::<Vec<f64>>();
    let force = |pulse: Pulse| {
        of(&|t| match interval {
            Some(dt) if t > 0.0 => (pulse.impulse(t) - pulse.impulse(t - dt)) / dt,
            _ => pulse.force(t),
        })
    };
    // The plate swings down and back once.
    let (amplitude, omega) = (impact.plate_amplitude, PI / impact.outer.end);
    let mut history = History::new(&CURVES);
    for (name, values) in [
        ("outer_displacement", of(&|t| -SPEED * t + impact.outer.double_impulse(t) / m)),
        ("outer_velocity", of(&|t| -SPEED + impact.outer.impulse(t) / m)),
        ("plate_displacement", of(&|t| -amplitude * (omega * t).sin().powi(2))),
        ("plate_velocity", of(&|t| -amplitude * omega * (2.0 * omega * t).sin())),
        ("inner_displacement", of(&|t| -impact.inner.double_impulse(t) / m)),
        ("inner_velocity", of(&|t| -impact.inner.impulse(t) / m)),
        ("outer_force", force(impact.outer)),
        ("inner_force", force(impact.inner)),
    ] {
        history[name] = values;
    }
    history.time = time;
    history
}

/// Puts another value in the place of a quantity's.
pub fn alter(summary: &mut Summary, name: &str, change: impl Fn(f64) -> f64) {
    let value = summary.quantities.value_mut(name).expect("a quantity");
    *value = value.map(change);
}

/// Summary in closed form.
pub fn summary(impact: &Impact, source: Source) -> Summary {
    let (outer, inner) = (impact.outer, impact.inner);
    let inner_velocity = -inner.impulse(inner.end) / mass();
    Summary {
        flight: None,
        vibration: None,
        impacts: Vec::new(),
        elastic_efficiency: None,
        elastic_limit: None,
        schema_version: SCHEMA_VERSION,
        scene: "synthetic".into(),
        scene_hash: "5ce4e".into(),
        source,
        model: None,
        modes: None,
        quantities: PlateQuantities {
            efficiency: (inner_velocity / SPEED).powi(2),
            outer_velocity_final: -SPEED + outer.impulse(outer.end) / mass(),
            inner_velocity_final: inner_velocity,
            outer_force_peak: outer.peak,
            inner_force_peak: inner.peak,
            outer_contact_end: outer.end,
            inner_contact_end: inner.end,
            outer_contacts: 1,
            inner_contacts: 1,
            first_frequency: 4655.0,
        }
        .table(),
        energy_residual: Some(1e-8),
        momentum_residual: Some(1e-11),
        steps: Some(40_000),
        failure: None,
        solve_seconds: 1.0,
        uncertainty: BTreeMap::new(),
        convergence: None,
        mesh: None,
        sideways: None,
        sphere_spin: None,
        friction_work: None,
        bender: None,
        stack: None,
        contact_pressure: None,
        losses: None,
        solver: None,
        mesh_error: None,
        frequencies: Vec::new(),
        truncation_error: None,
        integration_error: None,
        choice: None,
        warnings: Vec::new(),
        limits: Vec::new(),
        samples: None,
        sample_interval: None,
    }
}

/// Reference result: uniform samples over 250 us, forces averaged over the sampling interval.
pub fn reference() -> Outcome {
    let time: Vec<f64> = (0..=2000).map(|k| f64::from(k) * SAMPLE_INTERVAL).collect();
    let mut summary = summary(&REFERENCE, Source::Reference);
    summary.uncertainty = BTreeMap::from([
        ("efficiency".into(), 2e-4),
        ("outer_force_peak".into(), 0.7),
        ("inner_force_peak".into(), 0.7),
    ]);
    summary.mesh = Some(serde_json::json!({"nodes": 9000, "dofs": 18000}));
    summary.solver = Some(serde_json::json!({"time_step": 5e-9, "versions": {"dolfinx": "0.5.2"}}));
    summary.samples = Some(time.len());
    summary.sample_interval = Some(SAMPLE_INTERVAL);
    Outcome { summary, history: history(&REFERENCE, time, Some(SAMPLE_INTERVAL)) }
}

/// Reduced result of model B: about 1 us apart, closer at first touch and at release, ending
/// shortly after the last contact.
pub fn reduced() -> Outcome {
    reduced_of(&REDUCED, "B")
}

pub fn reduced_of(impact: &Impact, model: &str) -> Outcome {
    let mut time: Vec<f64> = (0..=190).map(|k| f64::from(k) * 1e-6).collect();
    for event in [impact.outer.start, impact.outer.end, impact.inner.start, impact.inner.end] {
        time.extend((-8..=8).map(|k| event + f64::from(k) * 0.11e-6).filter(|&t| t > 0.0));
    }
    time.sort_by(f64::total_cmp);
    time.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let mut summary = summary(impact, Source::Reduced);
    summary.model = Some(model.into());
    summary.modes = Some(16);
    summary.samples = Some(time.len());
    Outcome { summary, history: history(impact, time, None) }
}
