//! What a result of a plate impact must obey by itself: it starts as the scene says, its summary is found again in its
//! history, and its balances close.

use super::PlateImpact;
use super::laws::laws;
use super::shown::shown;
use crate::kinds::consistency::{
    EFFICIENCY_SLACK, FORCE_FLOOR, SLACK, Stated, VELOCITY_SLACK, contact, displacement_balance,
    momentum_balance, peak,
};
use crate::result::{History, Outcome, Source, Statement, Summary};
use crate::scene::Shape;

/// Share of the largest force of all contacts that may be missed in the peak of another.
const UNSEEN_FORCE: f64 = 1e-4;
/// Share of the peak displacement that the path of the plate's centre may miss, whose velocity may hold oscillations faster than the sampling.
const PLATE_SLACK: f64 = 0.05;

/// Statements about a result: of its curves only if they can be sampled, and each only if the curves it needs are there.
/// `is_cut`: the run ends at a time of the scene's.
pub(super) fn checks(setup: &PlateImpact, outcome: &Outcome, is_cut: bool) -> Vec<Statement> {
    let summary = &outcome.summary;
    let sampled = Some(&outcome.history).filter(|history| history.can_be_sampled());
    let mut checks: Vec<Statement> = sampled.into_iter().flat_map(|history| start(setup, history)).collect();
    checks.extend(sampled.into_iter().flat_map(|history| contacts(summary, history)));
    checks.extend(sampled.into_iter().flat_map(|history| end(setup, summary, history)));
    checks.extend(efficiency(setup, summary));
    checks.extend(sampled.into_iter().flat_map(|history| balances(setup, summary, history)));
    if summary.source == Source::External {
        checks.extend(laws(setup, is_cut, summary, sampled));
    }
    checks
}

/// The curve of a body.
fn of<'h>(history: &'h History, body: &str, what: &str) -> Option<&'h [f64]> {
    history.curve(&format!("{body}_{what}"))
}

/// The bodies start as the scene says, and the first touch is at t = 0.
fn start(setup: &PlateImpact, history: &History) -> Vec<Statement> {
    let speed = setup.outer.normal_speed();
    let velocity = |(body, expected): (&str, f64)| {
        let found = of(history, body, "velocity")?[0];
        Some(Statement::new(format!("{body}_velocity_start"), "m/s", found, expected, VELOCITY_SLACK * speed))
    };
    let displacement = |body: &str| {
        let motion = of(history, body, "displacement")?;
        Some(Statement::new(format!("{body}_displacement_start"), "m", motion[0], 0.0, 1e-3 * peak(motion)))
    };
    let contact_start = |force: &[f64]| {
        let floor = FORCE_FLOOR * peak(force);
        let contact_start = force.iter().position(|&f| f > floor).map_or(f64::NAN, |k| history.time[k]);
        // The force of the first instant may be zero, that of the next sample is not.
        let next = history.time[2.min(history.time.len() - 1)];
        Statement::new("outer_contact_start", "s", contact_start, 0.0, next)
    };
    // a stack begins at rest, or with what speed it has come to the plate
    let outer = (!matches!(setup.outer.shape, Shape::Stack(_))).then_some(("outer", -speed));
    let velocities = outer.into_iter().chain([("inner", setup.inner.speed)]).filter_map(velocity);
    let displacements = ["outer", "plate", "inner"].into_iter().filter_map(displacement);
    velocities.chain(displacements).chain(of(history, "outer", "force").map(contact_start)).collect()
}

/// The contact forces against what the summary states of them.
fn contacts(summary: &Summary, history: &History) -> Vec<Statement> {
    let stated = ["outer", "inner"].map(|body| Stated::of(summary, body));
    // a contact that hardly happens is no longer than a sample or two: its peak is known as well as others matter
    let unseen = UNSEEN_FORCE * stated[0].peak.unwrap_or(0.0).max(stated[1].peak.unwrap_or(0.0));
    let of_body = |(body, stated): (&str, Stated)| {
        let force = of(history, body, "force")?;
        Some(contact(body, summary.source, (&history.time, force), stated, unseen))
    };
    ["outer", "inner"].into_iter().zip(stated).filter_map(of_body).flatten().collect()
}

/// Final velocities, where they are determined. The last sample tells if it lies in free flight; without forces the curves
/// of the velocities do.
fn end(setup: &PlateImpact, summary: &Summary, history: &History) -> Vec<Statement> {
    let bound = VELOCITY_SLACK * setup.outer.speed;
    let forces = ["outer", "inner"].map(|body| of(history, body, "force").and_then(|force| force.last()));
    let by_curves = (forces == [None; 2]).then(|| shown(setup, history));
    let velocity = |body: &str| {
        let name = format!("{body}_velocity_final");
        let last = || of(history, body, "velocity")?.last().copied();
        let found = by_curves.as_ref().map_or_else(last, |shown| shown.value(&name))?;
        Some(Statement::new(&*name, "m/s", found, summary.value(&name)?, bound))
    };
    // In a fluid the inner body slows down after the last contact.
    let bodies: &[&str] = if setup.fluid.is_none() { &["outer", "inner"] } else { &["outer"] };
    let bodies = if by_curves.is_some() || forces == [Some(&0.0); 2] { bodies } else { &[] };
    bodies.iter().copied().filter_map(velocity).collect()
}

/// The efficiency is that of the inner body's final velocity, eq. (1). The kinetic energy of a bender or a stack is its own.
fn efficiency(setup: &PlateImpact, summary: &Summary) -> Option<Statement> {
    let (outer, inner) = (&setup.outer, &setup.inner);
    let (stated, velocity) = (summary.value("efficiency")?, summary.value("inner_velocity_final")?);
    let mass_ratio = inner.shape.mass(&inner.material) / outer.shape.mass(&outer.material);
    let along = summary.sideways.and_then(|sideways| sideways.inner_tangential_velocity_final).unwrap_or(0.0);
    let efficiency = mass_ratio * (velocity.powi(2) + along.powi(2)) / outer.speed.powi(2);
    let is_mounted = outer.shape.is_mounted();
    (!is_mounted)
        .then(|| Statement::new("efficiency", "1", stated, efficiency, EFFICIENCY_SLACK * efficiency))
}

/// Momentum against impulse and path against velocity.
fn balances(setup: &PlateImpact, summary: &Summary, history: &History) -> Vec<Statement> {
    // Forces of a reference are averages over the sampling interval, which shifts them by up to one.
    let interval = summary.sample_interval.unwrap_or(0.0);
    let (outer, inner) = (&setup.outer, &setup.inner);
    // a bender's clamp or a stack's base has a part in its momentum; in a fluid more than the contact force acts on the inner body
    let outer_mass = (!outer.shape.is_mounted()).then(|| outer.shape.mass(&outer.material));
    let inner_mass = setup.fluid.is_none().then(|| inner.shape.mass(&inner.material));
    let momentum = |(body, mass, sign): (&str, Option<f64>, f64)| {
        let (velocity, force) = (of(history, body, "velocity")?, of(history, body, "force")?);
        Some(momentum_balance(body, mass?, &history.time, velocity, force, sign, interval))
    };
    let path = |(body, slack): (&str, f64)| {
        let motion = (of(history, body, "displacement")?, of(history, body, "velocity")?);
        Some(displacement_balance(body, &history.time, motion, interval, slack))
    };
    let masses = [("outer", outer_mass, 1.0), ("inner", inner_mass, -1.0)].into_iter().filter_map(momentum);
    let paths = [("outer", SLACK), ("plate", PLATE_SLACK), ("inner", SLACK)].into_iter().filter_map(path);
    masses.chain(paths).collect()
}
