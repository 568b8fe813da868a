//! What a result of an impact on a wall or another body must obey by itself, and what its curves show.

use super::{GeneralImpact, ImpactQuantities};
use crate::kinds::consistency::{
    ENERGY_SLACK, FORCE_FLOOR, SLACK, Stated, VELOCITY_SLACK, contact, displacement_balance,
    momentum_balance, not_negative, peak,
};
use crate::result::{History, Outcome, Statement, Summary, Table};

/// The bodies that have a contact of their own, as names begin.
const CONTACTS: [&str; 2] = ["outer", "inner"];

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
    for body in CONTACTS {
        if let Some(force) = history.curve(&format!("{body}_force")) {
            let stated = Stated::of(summary, body);
            found.extend(contact(body, summary.source, (&history.time, force), stated, 0.0));
        }
    }
    let interval = summary.sample_interval.unwrap_or(0.0);
    let outer_mass = (!setup.outer.shape.is_mounted()).then(|| setup.outer.shape.mass(&setup.outer.material));
    for (body, mass, sign) in [("outer", outer_mass, 1.0), ("inner", setup.inner_mass(), -1.0)] {
        let curve = |what: &str| history.curve(&format!("{body}_{what}"));
        let Some(velocity) = curve("velocity") else { continue };
        let own = if body == "inner" && setup.body().is_some() { "inner_force" } else { "outer_force" };
        if let (Some(mass), Some(force)) = (mass, history.curve(own)) {
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
    if setup.is_held().is_some() {
        return energy_between(setup, summary).into_iter().collect();
    }
    let inner = match setup.inner {
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

/// Energy that both bodies have gained through an elastic one at rest, over what they had.
fn energy_between(setup: &GeneralImpact, summary: &Summary) -> Option<Statement> {
    let energy = |mass: f64, speed: f64| 0.5 * mass * speed * speed;
    let mass = setup.outer.shape.mass(&setup.outer.material);
    let inner = setup.inner.as_ref().zip(setup.inner_mass());
    let before = energy(mass, setup.outer.normal_speed())
        + inner.map_or(0.0, |(inner, mass)| energy(mass, inner.speed));
    let moving =
        inner.map_or(Some(0.0), |(_, mass)| Some(energy(mass, summary.value("inner_velocity_final")?)))?;
    let after = energy(mass, summary.value("outer_velocity_final")?) + moving;
    Some(Statement::at_most("energy_gained", "1", after / before - 1.0, 0.0, ENERGY_SLACK))
}

/// The quantities that the curves of `history` show; those they do not show are not determined.
pub(super) fn shown(setup: &GeneralImpact, history: &History) -> Table {
    let mut table = Table::new(ImpactQuantities::ALL);
    if !history.can_be_sampled() {
        return table;
    }
    let mut set = |name: String, value: Option<f64>| {
        if let (Some(slot), Some(value)) = (table.value_mut(&name), value) {
            *slot = Some(value);
        }
    };
    let time = &history.time;
    let contacts = CONTACTS.iter().filter_map(|body| Some((*body, history.curve(&format!("{body}_force"))?)));
    let mut is_over = true;
    for (body, force) in contacts {
        let floor = FORCE_FLOOR * peak(force);
        let touches = |k: usize| force[k] > floor;
        let last = (0..force.len()).rev().find(|k| touches(*k));
        let begins = (0..force.len()).filter(|&k| touches(k) && (k == 0 || !touches(k - 1))).count();
        let has_ended = last.is_none_or(|k| k + 1 < force.len());
        let impulse = (1..force.len()).map(|k| 0.5 * (time[k] - time[k - 1]) * (force[k] + force[k - 1]));
        set(format!("{body}_force_peak"), Some(force.iter().copied().fold(0.0, f64::max)));
        set(format!("{body}_contact_end"), has_ended.then(|| last.map_or(0.0, |k| time[k])));
        set(format!("{body}_contacts"), has_ended.then_some(begins as f64));
        set(format!("{body}_impulse"), has_ended.then(|| impulse.sum()));
        is_over &= has_ended;
    }
    let final_of =
        |body: &str| history.curve(&format!("{body}_velocity"))?.last().copied().filter(|_| is_over);
    let outer = final_of("outer").filter(|_| !setup.outer.shape.is_mounted());
    let inner = setup.inner.as_ref().and_then(|_| final_of("inner"));
    set("outer_velocity_final".into(), outer);
    set("inner_velocity_final".into(), inner);
    let struck = match setup.is_held() {
        // how a free body moves is not among the curves
        Some(held) => held.then_some(0.0),
        None if setup.inner.is_some() => inner,
        None => Some(0.0),
    };
    let restitution = outer.zip(struck).map(|(outer, struck)| (outer - struck) / setup.closing_speed());
    set("outer_restitution".into(), restitution);
    let mass = setup.outer.shape.mass(&setup.outer.material);
    let efficiency =
        |(inner, velocity): (f64, f64)| inner * velocity.powi(2) / (mass * setup.outer.speed.powi(2));
    // the motion along the surfaces is no curve
    let is_known = !setup.outer.shape.is_mounted() && !setup.moves_along();
    set("efficiency".into(), setup.inner_mass().zip(inner).filter(|_| is_known).map(efficiency));
    table
}
