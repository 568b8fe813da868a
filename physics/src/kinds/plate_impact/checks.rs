//! What a result of a plate impact must obey by itself: it starts as the scene says, its summary is found again in its
//! history, and its balances close.

use super::{Motion, PlateCurves};
use crate::kinds::consistency::{
    EFFICIENCY_SLACK, FORCE_FLOOR, SLACK, Stated, VELOCITY_SLACK, contact, displacement_balance,
    momentum_balance, peak,
};
use crate::result::{Outcome, Statement, Summary};
use crate::scene::{PlateImpact, Shape};

/// Share of the largest force of all contacts that may be missed in the peak of another.
const UNSEEN_FORCE: f64 = 1e-4;
/// Share of the peak displacement that the path of the plate's centre may miss, whose velocity may hold oscillations faster than the sampling.
const PLATE_SLACK: f64 = 0.05;

/// Statements about a result whose curves can be sampled.
pub(super) fn checks(setup: &PlateImpact, outcome: &Outcome) -> Vec<Statement> {
    let summary = &outcome.summary;
    let Some(history) = PlateCurves::of(&outcome.history) else { return Vec::new() };
    let mut checks = start(setup, &history);
    let [outer, inner] = ["outer", "inner"].map(|body| Stated::of(summary, body));
    // a contact that hardly happens is no longer than a sample or two: its peak is known as well as others matter
    let unseen = UNSEEN_FORCE * outer.peak.unwrap_or(0.0).max(inner.peak.unwrap_or(0.0));
    let of = |name, force, stated| contact(name, summary.source, (history.time, force), stated, unseen);
    checks.extend(of("outer", history.outer_force, outer));
    checks.extend(of("inner", history.inner_force, inner));
    checks.extend(end(setup, summary, &history));
    checks.extend(balances(setup, summary, &history));
    checks
}

/// The bodies start as the scene says, and the first touch is at t = 0.
fn start(setup: &PlateImpact, history: &PlateCurves) -> Vec<Statement> {
    let speed = setup.outer.speed;
    let velocity = |name: &str, motion: &[f64], expected: f64| {
        Statement::new(name, "m/s", motion[0], expected, VELOCITY_SLACK * speed)
    };
    let displacement =
        |name: &str, motion: &[f64]| Statement::new(name, "m", motion[0], 0.0, 1e-3 * peak(motion));
    let force = history.outer_force;
    let floor = FORCE_FLOOR * peak(force);
    let touch = force.iter().position(|&f| f > floor).map_or(f64::NAN, |k| history.time[k]);
    vec![
        velocity("outer_velocity_start", history.outer.velocity, -speed),
        velocity("inner_velocity_start", history.inner.velocity, setup.inner.speed),
        displacement("outer_displacement_start", history.outer.displacement),
        displacement("plate_displacement_start", history.plate.displacement),
        displacement("inner_displacement_start", history.inner.displacement),
        // The force of the first instant may be zero, that of the next sample is not.
        Statement::new("outer_contact_start", "s", touch, 0.0, history.time[2.min(history.time.len() - 1)]),
    ]
}

/// Final velocities and efficiency, where they are determined. The last sample tells if it lies in free flight.
fn end(setup: &PlateImpact, summary: &Summary, history: &PlateCurves) -> Vec<Statement> {
    let (outer, inner) = (&setup.outer, &setup.inner);
    let last = history.time.len() - 1;
    let flies = history.outer_force[last] == 0.0 && history.inner_force[last] == 0.0;
    let bound = VELOCITY_SLACK * outer.speed;
    let velocity = |name: &str, found: f64| {
        summary.value(name).map(|stated| Statement::new(name, "m/s", found, stated, bound))
    };
    let mut checks = Vec::new();
    if flies {
        checks.extend(velocity("outer_velocity_final", history.outer.velocity[last]));
    }
    // In a fluid the inner body slows down after the last contact.
    if flies && setup.fluid.is_none() {
        checks.extend(velocity("inner_velocity_final", history.inner.velocity[last]));
    }
    let mass_ratio = inner.shape.mass(&inner.material) / outer.shape.mass(&outer.material);
    let is_bender = matches!(outer.shape, Shape::Bender(_));
    // the kinetic energy of a bender is that of its own beam
    if !is_bender
        && let (Some(stated), Some(velocity)) =
            (summary.value("efficiency"), summary.value("inner_velocity_final"))
    {
        // Eq. (1).
        let efficiency = mass_ratio * (velocity / outer.speed).powi(2);
        checks.push(Statement::new("efficiency", "1", stated, efficiency, EFFICIENCY_SLACK * efficiency));
    }
    checks
}

/// Momentum against impulse and path against velocity.
fn balances(setup: &PlateImpact, summary: &Summary, history: &PlateCurves) -> Vec<Statement> {
    let mut checks = Vec::new();
    // Forces of a reference are averages over the sampling interval, which shifts them by up to one.
    let interval = summary.sample_interval.unwrap_or(0.0);
    let mut momentum = |name: &str, mass: f64, motion: Motion, force: &[f64], sign: f64| {
        checks.push(momentum_balance(name, mass, history.time, motion.velocity, force, sign, interval));
    };
    let (outer, inner) = (&setup.outer, &setup.inner);
    let outer_mass = outer.shape.mass(&outer.material);
    // a bender's clamp has a part in it
    if !matches!(outer.shape, Shape::Bender(_)) {
        momentum("outer", outer_mass, history.outer, history.outer_force, 1.0);
    }
    // In a fluid more than the contact force acts on the inner body.
    if setup.fluid.is_none() {
        let inner_mass = inner.shape.mass(&inner.material);
        momentum("inner", inner_mass, history.inner, history.inner_force, -1.0);
    }
    let motions = [
        ("outer", history.outer, SLACK),
        ("plate", history.plate, PLATE_SLACK),
        ("inner", history.inner, SLACK),
    ];
    for (name, motion, slack) in motions {
        let motion = (motion.displacement, motion.velocity);
        checks.push(displacement_balance(name, history.time, motion, interval, slack));
    }
    checks
}
