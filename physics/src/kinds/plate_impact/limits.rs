//! How near a plate impact comes to the bounds of the theories behind its models and its reference.

use super::PlateCurves;
use super::PlateImpact;
use crate::contact::Hertz;
use crate::dynamics::memory::{Bending, ForceHistory};
use crate::result::limit::{self, ELASTIC_BENDING, QUASI_STATIC, SMALL_DEFLECTION, SMALL_ROTATION};
use crate::result::{ContactPressure, History, Limit, Summary};
use crate::scene::{Edge, Material, Shape};

/// Adds contact pressures and limits to the `summary` of any model or reference; without `history` deflection and bending
/// are not known.
pub(super) fn judge(setup: &PlateImpact, summary: &mut Summary, history: Option<&History>) {
    let plate = &setup.plate.material;
    let bodies = [
        ("outer", &setup.outer.material, setup.outer.shape.tip_radius()),
        ("inner", &setup.inner.material, setup.inner.shape.tip_radius()),
    ];
    let laws = bodies.map(|(_, material, tip_radius)| Hertz::new(tip_radius, material, plate));
    let peaks = bodies.map(|(place, ..)| summary.value(&format!("{place}_force_peak")));
    // Hertz's patches and pressures are those of elastic contacts
    let elastic = bodies.map(|(_, material, _)| material.is_elastic() && plate.is_elastic());
    if let ([Some(outer), Some(inner)], [true, true]) = (peaks, elastic) {
        summary.contact_pressure = Some(ContactPressure::new(&laws, [outer, inner]));
    }
    let mut limits: Vec<Limit> = Vec::new();
    for (((law, peak), (place, material, _)), elastic) in laws.iter().zip(peaks).zip(bodies).zip(elastic) {
        let peak = peak.filter(|_| elastic);
        limits.extend(
            peak.into_iter().flat_map(|force| limit::of_contact(place, law, force, &[material, plate])),
        );
    }
    let curves = history.and_then(PlateCurves::of);
    let deflection = curves.and_then(|curves| deflection(setup, &curves));
    limits.extend(deflection.map(|w| SMALL_DEFLECTION.at("plate", w / setup.plate.thickness)));
    // off-centre forces bend the plate in two places, a film in none
    let is_struck_alone = setup.outer.is_centred() && setup.fluid.as_ref().is_none_or(|f| !f.squeeze_film);
    let loads =
        history.and_then(ForceHistory::of).filter(|_| is_struck_alone && peaks.iter().all(Option::is_some));
    if let (Some(strength), Some(loads)) = (plate.yield_strength, loads) {
        let [outer, inner] = Bending::new(&setup.plate).at_peaks(&laws, &loads).map(f64::abs);
        limits.push(ELASTIC_BENDING.at("plate", outer.max(inner) / strength));
    }
    if let (Shape::Bender(beam), Some(bender)) = (&setup.outer.shape, summary.bender) {
        limits.push(SMALL_ROTATION.at("outer", bender.drive.tip_deflection.abs() / beam.length));
    }
    let slowest = [plate, &setup.outer.material, &setup.inner.material].map(Material::bar_wave_speed);
    let slowest = slowest.into_iter().fold(f64::INFINITY, f64::min);
    limits.push(QUASI_STATIC.at("outer", setup.outer.speed / slowest));
    summary.set_limits(limits);
}

/// Largest deflection in m of the plate's centre; of a free plate against its centre of mass, in a fluid unknown.
fn deflection(setup: &PlateImpact, curves: &PlateCurves) -> Option<f64> {
    let centre = curves.plate.displacement;
    let rigid = match (setup.plate.edge, &setup.fluid) {
        (Edge::Free, Some(_)) => return None,
        (Edge::Free, None) => rigid_motion(setup.plate.mass(), curves),
        _ => vec![0.0; centre.len()],
    };
    centre.iter().zip(rigid).map(|(w, rigid)| (w - rigid).abs()).reduce(f64::max)
}

/// Displacement in m of a free plate of `mass` kg under both forces, by the trapezoidal rule.
fn rigid_motion(mass: f64, curves: &PlateCurves) -> Vec<f64> {
    let acceleration = |k: usize| (curves.inner_force[k] - curves.outer_force[k]) / mass;
    let (mut velocity, mut displacement) = (0.0, 0.0);
    let mut motion = vec![0.0];
    for (k, times) in curves.time.windows(2).enumerate() {
        let (step, before) = (times[1] - times[0], velocity);
        velocity += 0.5 * step * (acceleration(k) + acceleration(k + 1));
        displacement += 0.5 * step * (before + velocity);
        motion.push(displacement);
    }
    motion
}

#[cfg(test)]
mod tests {
    use super::rigid_motion;
    use crate::kinds::plate_impact::{Motion, PlateCurves};

    #[test]
    fn a_free_plate_under_a_growing_force_moves_with_the_cube_of_time() {
        let time: Vec<f64> = (0..=1000).map(|k| 1e-3 * f64::from(k)).collect();
        let zero = vec![0.0; time.len()];
        let still = Motion { displacement: &zero, velocity: &zero };
        let (outer_force, inner_force): (Vec<f64>, Vec<f64>) = time.iter().map(|t| (6.0 * t, 2.0)).unzip();
        let (outer_force, inner_force) = (&outer_force[..], &inner_force[..]);
        let curves =
            PlateCurves { time: &time, outer: still, plate: still, inner: still, outer_force, inner_force };
        // x'' = (2 - 6 t) / m
        for (t, x) in time.iter().zip(rigid_motion(2.0, &curves)) {
            assert!((x - 0.5 * (t * t - t * t * t)).abs() < 1e-6, "{t} {x}");
        }
    }
}
