//! Laws of mechanics that every result of an impact obeys: no energy is gained, contacts push and never pull, the bodies move
//! apart after the last contact, and forces, depths and times fit the energy and the natural period of the scene.
//!
//! A result from outside may state a few numbers only, each possible by itself: a wrong sign, unit or column then contradicts
//! nothing but these laws. Bounds are exact up to a factor that covers what they leave out, such as the shear of a thick plate.

use super::PlateImpact;
use crate::analytical::circular_plate::rigidity;
use crate::analytical::hertz::HertzImpact;
use crate::contact::Hertz;
use crate::kinds::consistency::{ENERGY_SLACK, RunningIntegral, VELOCITY_SLACK, not_negative, peak};
use crate::result::{History, Statement, Summary};
use crate::scene::{Edge, Material};
use std::f64::consts::PI;

/// Share of the outer body's speed by which a velocity may be on the wrong side of its bound.
const DIRECTION_SLACK: f64 = 0.01;
/// The same in a fluid, whose film pulls as well.
const FILM_SLACK: f64 = 0.25;
/// The same of velocities over time, which may be those of a node that oscillates about its body.
const NODE_SLACK: f64 = 0.1;
/// Factor on bounds of forces and depths from the energy, for what Hertz and Kirchhoff leave out.
const STATICS_SLACK: f64 = 1.5;
/// Most natural periods until the outer body has changed half of its velocity.
const LONGEST_PUSH: f64 = 30.0;
/// Most natural periods until the last contact ends: weak ones may follow late.
const LONGEST_CONTACT: f64 = 1000.0;

/// Statements about a `summary`, and about the curves of `history` where they can be sampled. `is_cut`: the run ends at a time
/// of the scene's, so that bodies may touch again.
pub(super) fn laws(
    setup: &PlateImpact,
    is_cut: bool,
    summary: &Summary,
    history: Option<&History>,
) -> Vec<Statement> {
    let mut laws = not_negative(summary);
    laws.extend(directions(setup, is_cut, summary));
    laws.extend(history.and_then(|history| inner_is_pushed(setup, history)));
    // the clamp of a bender and the voltage of a stack bring energy and momentum of their own
    if !setup.outer.shape.is_mounted() {
        let scales = ImpactScales::of(setup);
        laws.extend(energy(&scales, setup, summary));
        laws.extend(scales.forces_and_times(summary));
        laws.extend(history.into_iter().flat_map(|history| scales.motion(setup, history)));
    }
    laws
}

/// Final velocities: an impulse never pulls, and when all is over the bodies move apart.
fn directions(setup: &PlateImpact, is_cut: bool, summary: &Summary) -> Vec<Statement> {
    let (outer, inner) = (&setup.outer, &setup.inner);
    let slack = if setup.fluid.is_some() { FILM_SLACK } else { DIRECTION_SLACK } * outer.speed;
    let common = common_velocity(setup).filter(|_| !is_cut);
    let highest = common.map_or(inner.speed, |common| common.min(inner.speed));
    let lowest = common.filter(|_| !outer.shape.is_mounted());
    let value = |name: &str| summary.value(name);
    let inner = value("inner_velocity_final")
        .map(|v| Statement::at_most("inner_velocity_final_direction", "m/s", v, highest, slack));
    let outer = value("outer_velocity_final")
        .zip(lowest)
        .map(|(v, lowest)| Statement::at_least("outer_velocity_final_direction", "m/s", v, lowest, slack));
    inner.into_iter().chain(outer).collect()
}

/// Velocity in m/s that lies between those of both bodies once they no longer touch: that of a held rim, or of the common
/// centre of mass. `None` if a free plate turns.
fn common_velocity(setup: &PlateImpact) -> Option<f64> {
    if setup.plate.edge != Edge::Free {
        return Some(0.0);
    }
    let (outer, inner) = masses(setup);
    let momentum = inner * setup.inner.speed - outer * setup.outer.normal_speed();
    let is_conserved = setup.outer.is_centred() && !setup.outer.shape.is_mounted();
    is_conserved.then(|| momentum / (outer + setup.plate.mass() + inner))
}

/// The inner body's velocity never rises.
fn inner_is_pushed(setup: &PlateImpact, history: &History) -> Option<Statement> {
    let velocity = history.curve("inner_velocity").filter(|_| setup.fluid.is_none())?;
    let highest = velocity.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let slack = NODE_SLACK * setup.outer.speed;
    Some(Statement::at_most("inner_velocity_direction", "m/s", highest, setup.inner.speed, slack))
}

/// Energy that both bodies have gained, relative to what they had.
fn energy(scales: &ImpactScales, setup: &PlateImpact, summary: &Summary) -> Option<Statement> {
    let (outer, inner) = masses(setup);
    let kinetic = |mass: f64, velocity: f64| 0.5 * mass * velocity.powi(2);
    let of_outer = summary.value("outer_velocity_final").map(|v| kinetic(outer, v));
    let of_inner = summary.value("inner_velocity_final").map(|v| kinetic(inner, v));
    let by_efficiency = summary.value("efficiency").map(|e| e * kinetic(outer, setup.outer.speed));
    let inner = [of_inner, by_efficiency].into_iter().flatten().reduce(f64::max);
    let after: f64 = [of_outer, inner].into_iter().flatten().sum();
    let gained = after / scales.energy - 1.0;
    (of_outer.is_some() || inner.is_some())
        .then(|| Statement::at_most("energy_gained", "1", gained, 0.0, ENERGY_SLACK))
}

/// Masses of outer and inner body in kg.
fn masses(setup: &PlateImpact) -> (f64, f64) {
    (setup.outer.shape.mass(&setup.outer.material), setup.inner.shape.mass(&setup.inner.material))
}

/// How large what happens can be.
struct ImpactScales {
    /// Masses of outer and inner body in kg.
    masses: [f64; 2],
    /// Velocities of both at t = 0 in m/s.
    start: [f64; 2],
    /// Kinetic energy of both bodies at t = 0 in J.
    energy: f64,
    /// Largest forces in N of contacts that hold all of it; `None` if a material relaxes or yields.
    forces: [Option<f64>; 2],
    /// Largest depth in m of the outer body in a plate whose rim is held.
    depth: Option<f64>,
    /// Period in s of both bodies and the plate on the plate's stiffness, with the time over the gap.
    period: f64,
    /// Duration in s of an impact on a rigid plate, the shortest one.
    shortest: f64,
    is_wet: bool,
}

impl ImpactScales {
    fn of(setup: &PlateImpact) -> Self {
        let (outer, inner) = masses(setup);
        let energy = 0.5 * outer * setup.outer.speed.powi(2) + 0.5 * inner * setup.inner.speed.powi(2);
        let plate = &setup.plate;
        let is_elastic = |material: &Material| material.is_elastic() && plate.material.is_elastic();
        let contacts =
            [(&setup.outer.shape, &setup.outer.material), (&setup.inner.shape, &setup.inner.material)].map(
                |(shape, material)| {
                    (Hertz::new(shape.tip_radius(), material, &plate.material), is_elastic(material))
                },
            );
        // all of the energy in one contact
        let full = |(law, _): &(Hertz, bool)| HertzImpact {
            mass: outer,
            speed: (2.0 * energy / outer).sqrt(),
            stiffness: law.stiffness,
        };
        let forces =
            contacts.each_ref().map(|contact| contact.1.then(|| STATICS_SLACK * full(contact).force_peak()));
        // a central force on Kirchhoff's plate (Timoshenko and Woinowsky-Krieger, articles 17 and 19)
        let nu = plate.material.poisson_ratio;
        let bending = rigidity(plate.material.youngs_modulus, nu, plate.thickness);
        let support = if plate.edge == Edge::Clamped { 1.0 } else { (1.0 + nu) / (3.0 + nu) };
        let stiffness = 16.0 * PI * bending / plate.radius.powi(2) * support;
        let shear = 1.0 + 4.0 * (plate.thickness / plate.radius).powi(2);
        let deflection = (2.0 * energy / stiffness).sqrt() * shear;
        let depth = STATICS_SLACK * (deflection + full(&contacts[0]).approach_peak());
        let shortest = HertzImpact { speed: setup.outer.normal_speed(), ..full(&contacts[0]) }.duration();
        let swing = 2.0 * PI * ((outer + inner + plate.mass()) / stiffness * shear).sqrt();
        ImpactScales {
            masses: [outer, inner],
            start: [-setup.outer.normal_speed(), setup.inner.speed],
            energy,
            forces,
            depth: (plate.edge != Edge::Free && contacts[0].1).then_some(depth),
            period: swing + shortest + setup.inner.gap / setup.outer.speed,
            shortest,
            is_wet: setup.fluid.is_some(),
        }
    }

    /// Peaks are those of contacts that hold all energy at most, a force and its duration bound the impulse, and contacts end.
    fn forces_and_times(&self, summary: &Summary) -> Vec<Statement> {
        let mut laws = Vec::new();
        for (k, body) in ["outer", "inner"].into_iter().enumerate() {
            let value = |what: &str| summary.value(&format!("{body}_{what}"));
            let [peak, end, velocity] = ["force_peak", "contact_end", "velocity_final"].map(value);
            if let (Some(peak), Some(most)) = (peak, self.forces[k]) {
                laws.push(Statement::at_most(format!("{body}_force_possible"), "N", peak, most, 0.0));
            }
            let longest = LONGEST_CONTACT * self.period;
            laws.extend(end.map(|end| {
                Statement::at_most(format!("{body}_contact_end_possible"), "s", end, longest, 0.0)
            }));
            // in a fluid the inner body feels more than its contact
            let is_dry = k == 0 || !self.is_wet;
            if let (Some(peak), Some(end), Some(velocity), true) = (peak, end, velocity, is_dry) {
                let impulse = self.masses[k] * (velocity - self.start[k]).abs();
                let slack = 0.01 * impulse + 10.0 * VELOCITY_SLACK * self.masses[0] * self.start[0].abs();
                laws.push(Statement::at_most(format!("{body}_impulse"), "N*s", impulse, peak * end, slack));
            }
        }
        laws
    }

    /// The bodies get no farther and no deeper than their energy takes them, in a time that fits the scene.
    fn motion(&self, setup: &PlateImpact, history: &History) -> Vec<Statement> {
        let [outer, inner] = self.masses.map(|mass| (2.0 * self.energy / mass).sqrt());
        let bodies = [("outer", outer), ("inner", inner), ("plate", 10.0 * outer.max(inner))];
        let paths = bodies.into_iter().filter_map(|(body, fastest)| path(history, body, fastest));
        let mut laws: Vec<Statement> = paths.collect();
        laws.extend(self.displacement_directions(history));
        let velocity = self.outer_velocity(history);
        laws.extend(velocity.as_ref().and_then(|velocity| self.push_time(setup, history, velocity)));
        let by_velocity = velocity.map(|velocity| RunningIntegral::of(&history.time, &velocity).values);
        let motion = history.curve("outer_displacement").map(<[f64]>::to_vec).or(by_velocity);
        if let (Some(motion), Some(depth)) = (motion, self.depth) {
            laws.push(Statement::at_least("outer_depth", "m", lowest(&motion), -depth, 0.0));
        }
        laws
    }

    /// The inner body never lags behind its first velocity, and the outer one moves towards the plate at first.
    fn displacement_directions(&self, history: &History) -> Vec<Statement> {
        let displacement = |body: &str| history.curve(&format!("{body}_displacement"));
        let inner = displacement("inner").filter(|_| !self.is_wet).map(|motion| {
            let beyond = history.time.iter().zip(motion).map(|(t, u)| u - motion[0] - self.start[1] * t);
            let slack = 0.05 * peak(motion);
            Statement::at_most("inner_displacement_direction", "m", beyond.fold(0.0, f64::max), 0.0, slack)
        });
        // at first it moves on as it came
        let early = history.time.partition_point(|t| *t <= 0.25 * self.shortest).saturating_sub(1);
        let outer = displacement("outer").filter(|_| early > 0).map(|motion| {
            let least = 0.3 * self.start[0] * history.time[early];
            Statement::at_most("outer_displacement_direction", "m", motion[early] - motion[0], least, 0.0)
        });
        inner.into_iter().chain(outer).collect()
    }

    /// How long the outer body takes to change half of its `velocity` in m/s; nothing if it hardly changes.
    fn push_time(&self, setup: &PlateImpact, history: &History, velocity: &[f64]) -> Option<Statement> {
        let change = |k: usize| (velocity[k] - velocity[0]).abs();
        let half = 0.5 * change(velocity.len() - 1);
        let at = (0..velocity.len()).find(|k| change(*k) >= half)?;
        let longest = LONGEST_PUSH * self.period;
        (half > NODE_SLACK * setup.outer.speed)
            .then(|| Statement::at_most("outer_push_time", "s", history.time[at], longest, 0.0))
    }

    /// The outer body's velocity in m/s, by the impulse of its force where it is not given.
    fn outer_velocity(&self, history: &History) -> Option<Vec<f64>> {
        let by_force = |force: &[f64]| {
            let impulse = RunningIntegral::of(&history.time, force).values;
            impulse.into_iter().map(|impulse| self.start[0] + impulse / self.masses[0]).collect()
        };
        let given = history.curve("outer_velocity").map(<[f64]>::to_vec);
        given.or_else(|| history.curve("outer_force").map(by_force))
    }
}

/// Smallest of `values`.
fn lowest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Where a body is farthest beyond what it can reach at the speed `fastest` in m/s.
fn path(history: &History, body: &str, fastest: f64) -> Option<Statement> {
    let motion = history.curve(&format!("{body}_displacement"))?;
    let reach = |t: f64| 1.05 * fastest * t;
    let moved = history.time.iter().zip(motion).map(|(t, u)| ((u - motion[0]).abs(), reach(*t)));
    let (far, reach) = moved.max_by(|(u, r), (v, s)| (u - r).total_cmp(&(v - s)))?;
    let slack = 0.01 * fastest * history.time.last()?;
    Some(Statement::at_most(format!("{body}_path"), "m", far, reach, slack))
}

#[cfg(test)]
mod tests {
    use super::laws;
    use crate::kinds::consistency::RunningIntegral;
    use crate::kinds::plate_impact::reduced::Reduced;
    use crate::result::{History, Outcome};
    use crate::scene::{Model, Scene};
    use std::path::Path;

    const CLAMPED: &str = include_str!("../../../../scenes/scaled-plate-r10.toml");

    fn impact(text: &str) -> (Scene, Outcome) {
        let scene = Scene::parse("scene", text).expect("valid");
        let model = Reduced::new(&scene, Model::B, None).expect("model");
        let outcome = model.run_with_history_until(1e-7, 2.5e-4).expect("run");
        (scene, outcome)
    }

    /// What does not hold of a result.
    fn broken(scene: &Scene, outcome: &Outcome) -> Vec<String> {
        let setup = scene.plate_impact().expect("a plate");
        let history = Some(&outcome.history).filter(|history| history.can_be_sampled());
        let all = laws(setup, scene.run.end_time.is_some(), &outcome.summary, history);
        all.into_iter().filter(|law| !law.holds()).map(|law| law.about).collect()
    }

    /// The history with some of its curves.
    fn with(outcome: &Outcome, names: &[&str]) -> Outcome {
        let mut cut = outcome.clone();
        cut.history.curves.retain(|curve| names.contains(&curve.name));
        cut
    }

    #[test]
    fn a_summary_that_contradicts_mechanics_is_named() {
        let free = CLAMPED.replace("\"clamped\"", "\"free\"");
        for (of, text) in [("clamped", CLAMPED), ("free", &free)] {
            let (scene, outcome) = impact(text);
            let stated = Outcome { history: History::default(), ..outcome };
            assert_eq!(broken(&scene, &stated), [""; 0], "{of}");
            for (factor, quantities, law) in [
                (-1.0, &["inner_velocity_final"][..], "inner_velocity_final_direction"),
                (-5.0, &["outer_velocity_final"], "outer_velocity_final_direction"),
                (-1.0, &["outer_velocity_final", "inner_velocity_final"], "inner_velocity_final_direction"),
                (2.0, &["inner_velocity_final", "outer_velocity_final"], "energy_gained"),
                (1e3, &["inner_velocity_final"], "energy_gained"),
                (10.0, &["efficiency"], "energy_gained"),
                (-1.0, &["efficiency"], "efficiency_sign"),
                (-1.0, &["outer_force_peak"], "outer_force_peak_sign"),
                (-1.0, &["inner_contact_end"], "inner_contact_end_sign"),
                (1e3, &["inner_force_peak"], "inner_force_possible"),
                (1e-3, &["outer_force_peak"], "outer_impulse"),
                (1e-3, &["inner_contact_end"], "inner_impulse"),
                (1e6, &["outer_contact_end"], "outer_contact_end_possible"),
            ] {
                let mut wrong = stated.clone();
                for quantity in quantities {
                    let slot = wrong.summary.quantities.value_mut(quantity).expect("known");
                    *slot = slot.map(|value| value * factor);
                }
                let found = broken(&scene, &wrong);
                assert!(found.iter().any(|name| name == law), "{of}: {factor} {quantities:?}: {found:?}");
            }
        }
    }

    #[test]
    fn curves_that_contradict_mechanics_are_named() {
        let (scene, outcome) = impact(CLAMPED);
        let mut outcome = outcome;
        outcome.summary.quantities.iter().map(|q| q.name).collect::<Vec<_>>().into_iter().for_each(|name| {
            *outcome.summary.quantities.value_mut(name).expect("known") = None;
        });
        let scaled = |outcome: &Outcome, name: &str, factor: f64| {
            let mut wrong = outcome.clone();
            wrong.history[name].iter_mut().for_each(|value| *value *= factor);
            wrong
        };
        let later = |outcome: &Outcome, factor: f64| {
            let mut wrong = outcome.clone();
            wrong.history.time.iter_mut().for_each(|time| *time *= factor);
            wrong
        };
        let sums = |outcome: &Outcome, name: &str| {
            let mut wrong = outcome.clone();
            wrong.history[name] = RunningIntegral::of(&outcome.history.time, &outcome.history[name]).values;
            wrong
        };
        let velocities = with(&outcome, &["outer_velocity", "inner_velocity"]);
        let paths = with(&outcome, &["outer_displacement", "plate_displacement", "inner_displacement"]);
        let forces = with(&outcome, &["outer_force", "inner_force"]);
        for right in [&outcome, &velocities, &paths, &forces] {
            assert_eq!(broken(&scene, right), [""; 0]);
        }
        for (wrong, law) in [
            (later(&velocities, 1e3), "outer_push_time"),
            (later(&velocities, 1e6), "outer_depth"),
            (scaled(&velocities, "inner_velocity", -1.0), "inner_velocity_direction"),
            (scaled(&paths, "inner_displacement", 1e3), "inner_path"),
            (scaled(&paths, "plate_displacement", 1e3), "plate_path"),
            (scaled(&paths, "outer_displacement", 1e3), "outer_depth"),
            (scaled(&paths, "outer_displacement", -1.0), "outer_displacement_direction"),
            (scaled(&paths, "inner_displacement", -1.0), "inner_displacement_direction"),
            (scaled(&forces, "outer_force", 1e-3), "outer_depth"),
            (sums(&forces, "outer_force"), "outer_depth"),
        ] {
            let found = broken(&scene, &wrong);
            assert!(found.iter().any(|name| name == law), "{law}: {found:?}");
        }
    }

    /// The laws hold of the results of model B in all scenes of plates that the project has.
    #[test]
    fn no_right_result_contradicts_mechanics() {
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
        let mut count = 0;
        for folder in ["", "examples", "validation"] {
            for file in std::fs::read_dir(scenes.join(folder)).expect("scenes").flatten() {
                let path = file.path();
                let is_scene = path.extension().is_some_and(|ending| ending == "toml");
                let Some(scene) = is_scene.then(|| Scene::read(&path).expect("valid")) else { continue };
                if scene.plate_impact().is_err() {
                    continue;
                }
                let outcome = Reduced::new(&scene, Model::B, None).and_then(|m| m.run_with_history(1e-6));
                let Ok(outcome) = outcome else { continue };
                assert_eq!(broken(&scene, &outcome), [""; 0], "{}", path.display());
                count += 1;
            }
        }
        assert!(count > 20, "{count}");
    }
}
