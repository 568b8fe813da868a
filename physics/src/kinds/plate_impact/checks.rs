//! What a result of a plate impact must obey by itself: it starts as the scene says, its summary is found again in its
//! history, and its balances close.

use super::{Motion, PlateCurves};
use crate::kinds::consistency::{
    EFFICIENCY_SLACK, FORCE_FLOOR, SLACK, Stated, VELOCITY_SLACK, contact, displacement_balance,
    momentum_balance, peak,
};
use crate::result::{History, Outcome, Statement, Summary};
use crate::scene::{PlateImpact, Shape};

/// Share of the largest force of all contacts that may be missed in the peak of another.
const UNSEEN_FORCE: f64 = 1e-4;
/// Share of the peak displacement that the path of the plate's centre may miss, whose velocity may hold oscillations faster than the sampling.
const PLATE_SLACK: f64 = 0.05;

/// Statements about a result: of its curves only if they can be sampled, of most of them only if all are there.
pub(super) fn checks(setup: &PlateImpact, outcome: &Outcome) -> Vec<Statement> {
    let summary = &outcome.summary;
    let sampled = Some(&outcome.history).filter(|history| history.can_be_sampled());
    let curves = sampled.and_then(PlateCurves::of);
    let mut checks: Vec<Statement> =
        sampled.into_iter().flat_map(|history| start_velocities(setup, history)).collect();
    checks.extend(curves.iter().flat_map(|history| contacts(setup, summary, history)));
    checks.extend(efficiency(setup, summary));
    checks.extend(curves.iter().flat_map(|history| balances(setup, summary, history)));
    checks
}

/// Beginning and end, and the contact forces between.
fn contacts(setup: &PlateImpact, summary: &Summary, history: &PlateCurves) -> Vec<Statement> {
    let mut checks = start(history);
    let [outer, inner] = ["outer", "inner"].map(|body| Stated::of(summary, body));
    // a contact that hardly happens is no longer than a sample or two: its peak is known as well as others matter
    let unseen = UNSEEN_FORCE * outer.peak.unwrap_or(0.0).max(inner.peak.unwrap_or(0.0));
    let of = |name, force, stated| contact(name, summary.source, (history.time, force), stated, unseen);
    checks.extend(of("outer", history.outer_force, outer));
    checks.extend(of("inner", history.inner_force, inner));
    checks.extend(end(setup, summary, history));
    checks
}

/// The bodies start with the velocities that the scene says.
fn start_velocities(setup: &PlateImpact, history: &History) -> impl Iterator<Item = Statement> {
    let bound = VELOCITY_SLACK * setup.outer.speed;
    [("outer", -setup.outer.speed), ("inner", setup.inner.speed)].into_iter().filter_map(
        move |(body, expected)| {
            let found = history.curve(&format!("{body}_velocity"))?[0];
            Some(Statement::new(format!("{body}_velocity_start"), "m/s", found, expected, bound))
        },
    )
}

/// The bodies start from where they are, and the first touch is at t = 0.
fn start(history: &PlateCurves) -> Vec<Statement> {
    let displacement =
        |name: &str, motion: &[f64]| Statement::new(name, "m", motion[0], 0.0, 1e-3 * peak(motion));
    let force = history.outer_force;
    let floor = FORCE_FLOOR * peak(force);
    let touch = force.iter().position(|&f| f > floor).map_or(f64::NAN, |k| history.time[k]);
    vec![
        displacement("outer_displacement_start", history.outer.displacement),
        displacement("plate_displacement_start", history.plate.displacement),
        displacement("inner_displacement_start", history.inner.displacement),
        // The force of the first instant may be zero, that of the next sample is not.
        Statement::new("outer_contact_start", "s", touch, 0.0, history.time[2.min(history.time.len() - 1)]),
    ]
}

/// Final velocities, where they are determined. The last sample tells if it lies in free flight.
fn end(setup: &PlateImpact, summary: &Summary, history: &PlateCurves) -> Vec<Statement> {
    let last = history.time.len() - 1;
    let flies = history.outer_force[last] == 0.0 && history.inner_force[last] == 0.0;
    let bound = VELOCITY_SLACK * setup.outer.speed;
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
    checks
}

/// The efficiency is that of the inner body's final velocity, eq. (1). The kinetic energy of a bender is that of its own beam.
fn efficiency(setup: &PlateImpact, summary: &Summary) -> Option<Statement> {
    let (outer, inner) = (&setup.outer, &setup.inner);
    let (stated, velocity) = (summary.value("efficiency")?, summary.value("inner_velocity_final")?);
    let mass_ratio = inner.shape.mass(&inner.material) / outer.shape.mass(&outer.material);
    let efficiency = mass_ratio * (velocity / outer.speed).powi(2);
    let is_bender = matches!(outer.shape, Shape::Bender(_));
    (!is_bender).then(|| Statement::new("efficiency", "1", stated, efficiency, EFFICIENCY_SLACK * efficiency))
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
