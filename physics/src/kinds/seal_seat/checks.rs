//! What a result of a seal-seat scene must obey by itself: it starts as the scene says, its summary is found again in
//! its history, impulse changes momentum, and velocity changes displacement.

use super::SealSeat;
use super::{SeatCurves, SeatQuantities};
use crate::kinds::consistency::{
    EFFICIENCY_SLACK, ENERGY_SLACK, SLACK, Stated, VELOCITY_SLACK, contact, displacement_balance,
    momentum_balance, not_negative, peak,
};
use crate::result::{Outcome, Source, Statement, Summary};

/// Statements about a result: of its curves if all are there and can be sampled.
pub(super) fn checks(setup: &SealSeat, outcome: &Outcome) -> Vec<Statement> {
    let summary = &outcome.summary;
    let whole = Some(&outcome.history).filter(|history| history.can_be_sampled());
    let history = whole.and_then(SeatCurves::of);
    let mut checks = Vec::new();
    if let Some(history) = &history {
        checks.extend(start(setup, history));
        let of = |name, force| {
            contact(name, summary.source, (history.time, force), Stated::of(summary, name), 0.0)
        };
        checks.extend(of("sphere", history.sphere_force));
        checks.extend(of("actuator", history.actuator_force));
    }
    checks.extend(relations(setup, summary));
    if let Some(history) = &history {
        if let Some(q) = SeatQuantities::of_table(&summary.quantities) {
            checks.extend(velocities(setup, &q, history));
        }
        checks.push(components(history));
        checks.extend(balances(setup, summary.sample_interval.unwrap_or(0.0), history));
    }
    if summary.source == Source::External {
        checks.extend(not_negative(summary));
        checks.extend(energy(setup, summary));
    }
    checks
}

/// Energy that sphere and actuator have gained, relative to what the actuator had.
fn energy(setup: &SealSeat, summary: &Summary) -> Option<Statement> {
    let before = setup.actuator.mass * setup.actuator.speed.powi(2);
    let sphere = summary.value("sphere_speed").map(|v| setup.sphere.mass * v.powi(2) / before);
    let sphere = [sphere, summary.value("efficiency")].into_iter().flatten().reduce(f64::max)?;
    let actuator = summary.value("actuator_velocity_final").unwrap_or(0.0);
    let after = sphere + setup.actuator.mass * actuator.powi(2) / before;
    Some(Statement::at_most("energy_gained", "1", after - 1.0, 0.0, ENERGY_SLACK))
}

fn start(setup: &SealSeat, history: &SeatCurves) -> Vec<Statement> {
    let speed = setup.actuator.speed;
    let velocity = |name: &str, curve: &[f64], expected: f64| {
        Statement::new(name, "m/s", curve[0], expected, VELOCITY_SLACK * speed)
    };
    let [x, z] = history.sphere_displacement;
    vec![
        velocity("actuator_velocity_start", history.actuator_velocity, speed),
        velocity("sphere_velocity_x_start", history.sphere_velocity[0], 0.0),
        velocity("sphere_velocity_z_start", history.sphere_velocity[1], 0.0),
        Statement::new("sphere_displacement_start", "m", x[0].hypot(z[0]), 0.0, 1e-3 * peak(z)),
    ]
}

/// What follows from the sphere's velocity, where it is determined: speed, direction, efficiency.
fn relations(setup: &SealSeat, summary: &Summary) -> Vec<Statement> {
    let value = |name: &str| summary.value(name);
    let (Some(x), Some(z)) = (value("sphere_velocity_x"), value("sphere_velocity_z")) else {
        return Vec::new();
    };
    let mass_ratio = setup.sphere.mass / setup.actuator.mass;
    let efficiency = mass_ratio * (x * x + z * z) / setup.actuator.speed.powi(2);
    let speed = VELOCITY_SLACK * setup.actuator.speed;
    let relations = [
        ("sphere_speed", "m/s", x.hypot(z), speed),
        ("sphere_angle", "rad", x.atan2(z), 1e-6),
        ("efficiency", "1", efficiency, EFFICIENCY_SLACK * efficiency),
    ];
    let statement =
        |(name, unit, expected, bound)| Some(Statement::new(name, unit, value(name)?, expected, bound));
    relations.into_iter().filter_map(statement).collect()
}

/// Final velocities, where the last sample lies in free flight.
fn velocities(setup: &SealSeat, q: &SeatQuantities, history: &SeatCurves) -> Vec<Statement> {
    let last = history.time.len() - 1;
    let bound = VELOCITY_SLACK * setup.actuator.speed;
    let velocity = |name: &str, found: f64, stated: f64| Statement::new(name, "m/s", found, stated, bound);
    let (x, z) = (q.sphere_velocity_x, q.sphere_velocity_z);
    let mut checks = Vec::new();
    if history.sphere_force[last] == 0.0 {
        checks.push(velocity("sphere_velocity_x", history.sphere_velocity[0][last], x));
        checks.push(velocity("sphere_velocity_z", history.sphere_velocity[1][last], z));
    }
    if history.actuator_force[last] == 0.0 {
        let found = history.actuator_velocity[last];
        checks.push(velocity("actuator_velocity_final", found, q.actuator_velocity_final));
    }
    checks
}

/// The sphere's force is that of its components.
fn components(history: &SeatCurves) -> Statement {
    let [fx, fz] = history.sphere_force_components;
    let missed =
        history.sphere_force.iter().zip(fx.iter().zip(fz)).map(|(f, (x, z))| (f - x.hypot(*z)).abs());
    let bound = 1e-6 * peak(history.sphere_force);
    Statement::new("sphere_force_components", "N", missed.fold(0.0, f64::max), 0.0, bound)
}

/// Momentum against impulse and path against velocity, of sphere and actuator.
fn balances(setup: &SealSeat, interval: f64, history: &SeatCurves) -> Vec<Statement> {
    let time = history.time;
    let mut checks = Vec::new();
    for (axis, c) in [("x", 0), ("z", 1)] {
        let (path, velocity) = (history.sphere_displacement[c], history.sphere_velocity[c]);
        let force = history.sphere_force_components[c];
        let name = format!("sphere_{axis}");
        checks.push(momentum_balance(&name, setup.sphere.mass, time, velocity, force, 1.0, interval));
        checks.push(displacement_balance(&name, time, (path, velocity), interval, SLACK));
    }
    let (path, velocity) = (history.actuator_displacement, history.actuator_velocity);
    let force = history.actuator_force;
    checks.push(momentum_balance("actuator", setup.actuator.mass, time, velocity, force, -1.0, interval));
    checks.push(displacement_balance("actuator", time, (path, velocity), interval, SLACK));
    checks
}
