//! Deflection of the plate along its radius during a model's run: its modes under the contact forces that the run has kept.

use super::joined::{continuum_shapes, kirchhoff_system};
use super::predictor::Predictor;
use super::reduced::Reduced;
use crate::body::kirchhoff::{self, UnitPlates};
use crate::dynamics::system::PLATE;
use crate::error::{Error, Result};
use crate::numerics::duhamel::Oscillator;
use crate::result::History;
use crate::scene::DEFAULT_MODES;
use crate::scene::{Model, Scene};

/// Deflection in m, signed along z, at `radii` (m, the first 0) and `times` (s, rising) of the plate of `scene` in `model` with
/// `modes` modes, whose run has given `history`; of model C that of the inner face, without what yields under the contacts.
/// Shape (times, radii).
///
/// # Errors
/// [`Error::Usage`] if the plate swings in a fluid, whose forces no history keeps; as [`Reduced::new`].
pub fn deflection(
    scene: &Scene,
    (model, modes): (Model, Option<usize>),
    history: &History,
    radii: &[f64],
    times: &[f64],
) -> Result<Vec<Vec<f64>>> {
    let setup = scene.plate_impact()?;
    if setup.fluid.is_some() {
        return Err(Error::Usage(format!(
            "scene `{}` has a fluid: the deflection of its plate is not known from the contact forces alone",
            scene.name
        )));
    }
    if setup.outer.offset > 0.0 {
        return Err(Error::Usage(format!(
            "scene `{}` strikes its plate off-centre: the deflection is not axisymmetric",
            scene.name
        )));
    }
    let reduced = Reduced::new(scene, model, modes)?;
    let system = reduced.system();
    let shapes = match model {
        Model::A | Model::B => kirchhoff::shapes(&setup.plate, system.modes, radii)?,
        Model::C => {
            let predictor = Predictor::of(&kirchhoff_system(setup, DEFAULT_MODES, &UnitPlates::default())?)?;
            let inner: Vec<f64> = system.approach[1][PLATE..].iter().map(|b| -b).collect();
            continuum_shapes(setup, &predictor, system.modes, &inner, radii)?
        }
    };
    let forces = ["outer_force", "inner_force"].map(|name| history.curve(name).unwrap_or_default());
    let mut deflection = vec![vec![0.0; radii.len()]; times.len()];
    for (k, shape) in (PLATE..).zip(&shapes) {
        let loads = forces[0].iter().zip(forces[1]);
        let loads =
            loads.map(|(outer, inner)| -(system.approach[0][k] * outer + system.approach[1][k] * inner));
        let amplitudes = response(&system.oscillators[k], &history.time, &loads.collect::<Vec<_>>(), times);
        for (row, amplitude) in deflection.iter_mut().zip(amplitudes) {
            row.iter_mut().zip(shape).for_each(|(sum, value)| *sum += amplitude * value);
        }
    }
    Ok(deflection)
}

/// Coordinate at the rising instants `at` of an oscillator that starts at rest, under `loads` at `times`, linear between them
/// and zero after the last.
fn response(oscillator: &Oscillator, times: &[f64], loads: &[f64], at: &[f64]) -> Vec<f64> {
    let (mut state, mut sample) = ([0.0; 2], 0);
    let coordinate = |instant: &f64| {
        while times.get(sample + 1).is_some_and(|next| next <= instant) {
            let step = times[sample + 1] - times[sample];
            state = after(oscillator, state, [loads[sample], loads[sample + 1]], step);
            sample += 1;
        }
        let (step, from) = (instant - times[sample], loads[sample]);
        match times.get(sample + 1) {
            Some(next) => {
                let to = from + (loads[sample + 1] - from) * step / (next - times[sample]);
                after(oscillator, state, [from, to], step)[0]
            }
            None => after(oscillator, state, [0.0; 2], step)[0],
        }
    };
    at.iter().map(coordinate).collect()
}

/// Coordinate and rate `time` later, under a force that goes from one value to the other.
fn after(oscillator: &Oscillator, [q, v]: [f64; 2], [from, to]: [f64; 2], time: f64) -> [f64; 2] {
    if time <= 0.0 {
        return [q, v];
    }
    let Oscillator { omega, alpha } = *oscillator;
    let [slope, impulse, step, ramp, ..] = oscillator.moments(time);
    let rate = (to - from) / time;
    [
        (slope + 2.0 * alpha * impulse) * q + impulse * v + from * step + rate * ramp,
        -omega * omega * impulse * q + slope * v + from * impulse + rate * step,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At the centre it is the curve of the run, which the integrator has made of the same modes, but for what yields locally.
    #[test]
    fn the_centre_moves_as_the_run_says_and_the_clamped_edge_does_not() {
        let text = include_str!("../../../../tests/fixtures/plate-impact.toml");
        let scene = Scene::parse("plate-impact.toml", text).expect("valid");
        let radius = scene.plate_impact().expect("plate").plate.radius;
        for (model, within) in [(Model::A, 2e-5), (Model::B, 2e-5), (Model::C, 2e-3)] {
            let reduced = Reduced::new(&scene, model, None).expect("model");
            let (system, outcome) = (reduced.system(), reduced.run_with_history(1e-7).expect("runs"));
            let (times, curve) = (&outcome.history.time, &outcome.history["plate_displacement"]);
            let forces = [&outcome.history["outer_force"], &outcome.history["inner_force"]];
            let yields = |k: usize| {
                let force = forces.map(|force| force[k]);
                let local = [0, 1].map(|i| system.laws[i].approach(force[i]));
                system.local_centre.displacement(local, force)
            };
            let centre: Vec<f64> = curve.iter().enumerate().map(|(k, v)| v - yields(k)).collect();
            let asked: Vec<f64> = times.iter().step_by(7).map(|t| t + 1e-9).collect();
            let found =
                deflection(&scene, (model, outcome.summary.modes), &outcome.history, &[0.0, radius], &asked);
            let found = found.expect("deflection");
            let largest = centre.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            for (row, expected) in found.iter().zip(centre.iter().step_by(7)) {
                // the plate moves by some 1e-9 m in 1e-9 s
                let off = (row[0] - expected).abs() / largest;
                assert!(off < within + 1e-9 / largest, "model {model}: off by {off}");
                assert!(row[1].abs() < 1e-6 * largest, "model {model}: {}", row[1]);
            }
        }
    }
}
