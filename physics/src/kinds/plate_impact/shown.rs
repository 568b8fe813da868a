//! What the curves of another program or of a measurement show of an impact's results, where nobody states them.

use super::PlateImpact;
use super::PlateQuantities;
use crate::kinds::consistency::{FORCE_FLOOR, VELOCITY_SLACK, peak};
use crate::kinds::rubbing::moves_along;
use crate::result::{History, Table};

/// Share of the samples, the last ones, over which the velocity of a body that flies freely does not change.
const FLIGHT: f64 = 0.05;

/// The quantities that the curves of `history` show; those they do not show are not determined.
pub(super) fn shown(setup: &PlateImpact, history: &History) -> Table {
    let mut table = Table::new(PlateQuantities::ALL);
    if !history.can_be_sampled() {
        return table;
    }
    let mut set = |name: &str, value: Option<f64>| {
        if let (Some(slot), Some(value)) = (table.value_mut(name), value) {
            *slot = Some(value);
        }
    };
    for body in ["outer", "inner"] {
        let Some(force) = history.curve(&format!("{body}_force")) else { continue };
        let floor = FORCE_FLOOR * peak(force);
        let in_contact = |k: usize| force[k] > floor;
        let last = (0..force.len()).rev().find(|k| in_contact(*k));
        let begins = (0..force.len()).filter(|&k| in_contact(k) && (k == 0 || !in_contact(k - 1))).count();
        let is_over = last.is_none_or(|k| k + 1 < force.len());
        set(&format!("{body}_force_peak"), Some(force.iter().fold(0.0, |a, f| f64::max(a, *f))));
        set(&format!("{body}_contact_end"), is_over.then(|| last.map_or(0.0, |k| history.time[k])));
        set(&format!("{body}_contacts"), is_over.then_some(begins as f64));
    }
    // what touches nothing now may be struck again while the other body still is
    let is_over = ["outer", "inner"].into_iter().all(|body| flies(setup, history, body));
    let last = |body: &str| history.curve(&format!("{body}_velocity"))?.last().copied().filter(|_| is_over);
    let outer = last("outer");
    // in a fluid the inner body slows down after the last contact
    let inner = last("inner").filter(|_| setup.fluid.is_none());
    set("outer_velocity_final", outer);
    set("inner_velocity_final", inner);
    let mass_ratio =
        setup.inner.shape.mass(&setup.inner.material) / setup.outer.shape.mass(&setup.outer.material);
    let is_mounted = setup.outer.shape.is_mounted();
    let efficiency = |velocity: f64| mass_ratio * (velocity / setup.outer.speed).powi(2);
    // the motion along the plate is no curve
    set(
        "efficiency",
        inner.filter(|_| !is_mounted && !moves_along(&setup.outer, Some(&setup.inner))).map(efficiency),
    );
    table
}

/// Whether a body flies freely at the end of the history, as far as its curves tell: its velocity does not change any more,
/// and its force is zero. In a fluid the inner body slows down.
fn flies(setup: &PlateImpact, history: &History, body: &str) -> bool {
    let steady = |velocity: &[f64]| {
        let count = ((FLIGHT * velocity.len() as f64).ceil() as usize).clamp(2, velocity.len());
        let flight = &velocity[velocity.len() - count..];
        flight.iter().all(|v| (v - flight[count - 1]).abs() <= VELOCITY_SLACK * setup.outer.speed)
    };
    let velocity = history.curve(&format!("{body}_velocity"));
    let force = history.curve(&format!("{body}_force"));
    let is_drifting = body == "inner" && setup.fluid.is_some();
    velocity.is_none_or(|velocity| is_drifting || steady(velocity))
        && force.is_none_or(|force| force[force.len() - 1] <= FORCE_FLOOR * peak(force))
}

#[cfg(test)]
mod tests {
    use super::shown;
    use crate::kinds::plate_impact::CURVES;
    use crate::kinds::plate_impact::reduced::Reduced;
    use crate::result::History;
    use crate::scene::{Model, Scene};

    const SCENE: &str = include_str!("../../../../scenes/scaled-plate-r10.toml");

    #[test]
    fn what_the_curves_of_a_model_show_is_what_it_states() {
        let scene = Scene::parse("scene", SCENE).expect("valid");
        let ours = Reduced::new(&scene, Model::C, None).expect("model").run_with_history_until(1e-7, 2e-4);
        let ours = ours.expect("run");
        let setup = scene.plate_impact().expect("a plate");
        let found = shown(setup, &ours.history);
        let interval = ours.history.time.windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
        for quantity in ours.summary.quantities.iter().filter(|q| q.name != "first_frequency") {
            let (stated, shown) = (quantity.value.expect("whole"), found.value(quantity.name));
            let slack = if quantity.unit == "s" { 1.01 * interval } else { 2e-3 * stated.abs() };
            assert!(shown.is_some_and(|shown| (shown - stated).abs() <= slack), "{quantity:?} {shown:?}");
        }
        assert_eq!(found.value("first_frequency"), None);
        // a record that ends during a contact leaves open what comes of it
        let half = ours.history.time.partition_point(|t| *t < 4e-5);
        let mut cut =
            History { time: ours.history.time[..half].to_vec(), curves: ours.history.curves.clone() };
        cut.curves.iter_mut().for_each(|curve| curve.values.truncate(half));
        let found = shown(setup, &cut);
        for open in ["efficiency", "outer_contact_end", "inner_velocity_final"] {
            assert_eq!(found.value(open), None, "{open}");
        }
        // the inner body flies, and the outer one still touches: without forces, too
        let half = ours.history.time.partition_point(|t| *t < 1.3e-4);
        let velocities = ours.history.curves.iter().filter(|curve| curve.name.ends_with("velocity"));
        let mut cut = History {
            time: ours.history.time[..half].to_vec(),
            curves: velocities.filter(|curve| !curve.is_elastic).cloned().collect(),
        };
        cut.curves.iter_mut().for_each(|curve| curve.values.truncate(half));
        assert!(shown(setup, &cut).iter().all(|quantity| quantity.value.is_none()));
        assert!(shown(setup, &History::new(&CURVES)).iter().all(|quantity| quantity.value.is_none()));
    }
}
