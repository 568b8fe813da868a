//! What a result of an impact on a wall or another body must obey by itself, and what its curves show.

use super::{GeneralImpact, ImpactQuantities};
use crate::kinds::consistency::{
    ENERGY_SLACK, FORCE_FLOOR, SLACK, Stated, VELOCITY_SLACK, contact, displacement_balance,
    momentum_balance, not_negative, peak,
};
use crate::result::{History, Outcome, Statement, Summary, Table};

/// Statements about a result: of its curves only if they can be sampled, and each only if the curves it needs are there.
pub(super) fn checks(setup: &GeneralImpact, outcome: &Outcome) -> Vec<Statement> {
    let (summary, history) = (&outcome.summary, &outcome.history);
    let mut found = not_negative(summary);
    // clamp of a bender and voltage of a stack bring energy and momentum of their own
    if !setup.outer.shape.is_mounted() {
        found.extend(energy(setup, summary));
    }
    if !history.can_be_sampled() {
        return found;
    }
    let force = history.curve("outer_force");
    if let Some(force) = force {
        found.extend(contact(
            "outer",
            summary.source,
            (&history.time, force),
            Stated::of(summary, "outer"),
            0.0,
        ));
    }
    let interval = summary.sample_interval.unwrap_or(0.0);
    let outer_mass = (!setup.outer.shape.is_mounted()).then(|| setup.outer.shape.mass(&setup.outer.material));
    for (body, mass, sign) in [("outer", outer_mass, 1.0), ("inner", setup.inner_mass(), -1.0)] {
        let curve = |what: &str| history.curve(&format!("{body}_{what}"));
        let Some(velocity) = curve("velocity") else { continue };
        if let (Some(mass), Some(force)) = (mass, force) {
            found.push(momentum_balance(body, mass, &history.time, velocity, force, sign, interval));
        }
        if let Some(path) = curve("displacement") {
            found.push(displacement_balance(body, &history.time, (path, velocity), interval, SLACK));
        }
        let name = format!("{body}_velocity_final");
        let last = velocity.last().copied().filter(|_| force.is_none_or(|force| force.last() == Some(&0.0)));
        if let (Some(last), Some(stated)) = (last, summary.value(&name)) {
            found.push(Statement::new(name, "m/s", last, stated, VELOCITY_SLACK * setup.closing_speed()));
        }
    }
    found
}

/// Energy of relative motion that the contact has made out of nothing: a restitution above 1; and the impulse is that of the velocities.
fn energy(setup: &GeneralImpact, summary: &Summary) -> Vec<Statement> {
    let mut found = Vec::new();
    let outer = summary.value("outer_velocity_final");
    let inner = match setup.inner() {
        Some(_) => summary.value("inner_velocity_final"),
        None => Some(0.0),
    };
    let by_velocities = outer.zip(inner).map(|(outer, inner)| (outer - inner) / setup.closing_speed());
    let stated = summary.value("outer_restitution");
    for restitution in [by_velocities, stated].into_iter().flatten() {
        found.push(Statement::at_most("energy_gained", "1", restitution.powi(2) - 1.0, 0.0, ENERGY_SLACK));
    }
    if let Some((found_by, stated)) = by_velocities.zip(stated) {
        found.push(Statement::new("outer_restitution", "1", stated, found_by, VELOCITY_SLACK));
    }
    let mass = setup.outer.shape.mass(&setup.outer.material);
    if let (Some(velocity), Some(impulse)) = (outer, summary.value("outer_impulse")) {
        let gained = mass * (velocity + setup.outer.normal_speed());
        found.push(Statement::new("outer_impulse", "N*s", impulse, gained, SLACK * gained.abs()));
    }
    found
}

/// The quantities that the curves of `history` show; those they do not show are not determined.
pub(super) fn shown(setup: &GeneralImpact, history: &History) -> Table {
    let mut table = Table::new(ImpactQuantities::ALL);
    let Some(force) = history.curve("outer_force").filter(|_| history.can_be_sampled()) else { return table };
    let mut set = |name: &str, value: Option<f64>| {
        if let (Some(slot), Some(value)) = (table.value_mut(name), value) {
            *slot = Some(value);
        }
    };
    let floor = FORCE_FLOOR * peak(force);
    let touches = |k: usize| force[k] > floor;
    let last = (0..force.len()).rev().find(|k| touches(*k));
    let begins = (0..force.len()).filter(|&k| touches(k) && (k == 0 || !touches(k - 1))).count();
    let is_over = last.is_none_or(|k| k + 1 < force.len());
    set("outer_force_peak", Some(force.iter().copied().fold(0.0, f64::max)));
    set("outer_contact_end", is_over.then(|| last.map_or(0.0, |k| history.time[k])));
    set("outer_contacts", is_over.then_some(begins as f64));
    let impulse =
        (1..force.len()).map(|k| 0.5 * (history.time[k] - history.time[k - 1]) * (force[k] + force[k - 1]));
    set("outer_impulse", is_over.then(|| impulse.sum()));
    let final_of =
        |body: &str| history.curve(&format!("{body}_velocity"))?.last().copied().filter(|_| is_over);
    let outer = final_of("outer").filter(|_| !setup.outer.shape.is_mounted());
    let inner = setup.inner().and_then(|_| final_of("inner"));
    set("outer_velocity_final", outer);
    set("inner_velocity_final", inner);
    let struck = if setup.inner().is_some() { inner } else { Some(0.0) };
    set(
        "outer_restitution",
        outer.zip(struck).map(|(outer, struck)| (outer - struck) / setup.closing_speed()),
    );
    let mass = setup.outer.shape.mass(&setup.outer.material);
    let efficiency =
        |(inner, velocity): (f64, f64)| inner * velocity.powi(2) / (mass * setup.outer.speed.powi(2));
    let is_mounted = setup.outer.shape.is_mounted();
    set("efficiency", setup.inner_mass().zip(inner).filter(|_| !is_mounted).map(efficiency));
    table
}
