//! What a result of a seal-seat scene must obey by itself: it starts as the scene says, its summary is found again in
//! its history, impulse changes momentum, and velocity changes displacement.

use super::{SeatCurves, SeatQuantities};
use crate::kinds::consistency::{
    EFFICIENCY_SLACK, SLACK, Stated, VELOCITY_SLACK, contact, displacement_balance, momentum_balance, peak,
};
use crate::result::{Outcome, Statement};
use crate::scene::SealSeat;

/// Statements about a result whose curves are all there and can be sampled.
pub(super) fn checks(setup: &SealSeat, outcome: &Outcome) -> Vec<Statement> {
    let summary = &outcome.summary;
    let whole = Some(&outcome.history).filter(|history| history.can_be_sampled());
    let Some(history) = whole.and_then(SeatCurves::of) else { return Vec::new() };
    let mut checks = start(setup, &history);
    let of =
        |name, force| contact(name, summary.source, (history.time, force), Stated::of(summary, name), 0.0);
    checks.extend(of("sphere", history.sphere_force));
    checks.extend(of("actuator", history.actuator_force));
    if let Some(q) = SeatQuantities::of_table(&summary.quantities) {
        checks.extend(velocities(setup, &q, &history));
    }
    checks.push(components(&history));
    checks.extend(balances(setup, summary.sample_interval.unwrap_or(0.0), &history));
    checks
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

/// Velocities and what follows from them: speed, direction, efficiency.
fn velocities(setup: &SealSeat, q: &SeatQuantities, history: &SeatCurves) -> Vec<Statement> {
    let last = history.time.len() - 1;
    let bound = VELOCITY_SLACK * setup.actuator.speed;
    let velocity = |name: &str, found: f64, stated: f64| Statement::new(name, "m/s", found, stated, bound);
    let (x, z) = (q.sphere_velocity_x, q.sphere_velocity_z);
    let mass_ratio = setup.sphere.mass / setup.actuator.mass;
    let efficiency = mass_ratio * (x * x + z * z) / setup.actuator.speed.powi(2);
    let mut checks = vec![
        velocity("sphere_speed", q.sphere_speed, x.hypot(z)),
        Statement::new("sphere_angle", "rad", q.sphere_angle, x.atan2(z), 1e-6),
        Statement::new("efficiency", "1", q.efficiency, efficiency, EFFICIENCY_SLACK * efficiency),
    ];
    // The last sample tells if it lies in free flight.
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
