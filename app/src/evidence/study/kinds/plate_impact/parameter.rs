//! What the parameter studies of section 4.2 share: plate, spheres, and many impacts at once.
//!
//! Model B runs unless another is asked for: the paper made these figures with it, so that its statements are held
//! against like. Model C is closer to the finite elements and moves optima a little; `--model C` shows how far the
//! paper's statements survive that.

use crate::error::Result;
use crate::evidence::study::{Claim, Note};
use crate::kinds::plate_impact::PlateImpact;
use crate::kinds::plate_impact::PlateQuantities;
use crate::kinds::plate_impact::reduced::Reduced;
use crate::kinds::plate_impact::shared::SharedBodies;
use crate::scene::{
    Edge, Geometry, Inner, Material, Model, Outer, Plate, ReducedSettings, ReferenceSettings, RunSettings,
    Scene, Shape, Turning,
};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Relative error of the efficiency that the time integration may have; far below what a plot shows.
const TOLERANCE: f64 = 1e-6;
/// Speed of the outer sphere in m/s; the paper names none for section 4.2, and 0.5 m/s is close to its 550 mm/s.
const SPEED: f64 = 0.5;

/// Steel of the paper's scaled model (section 3.3).
pub fn steel() -> Material {
    Material::elastic("steel", 210e9, 0.3, 7780.0)
}

/// Titanium alloy of the paper (Table 3).
pub fn titanium() -> Material {
    Material::elastic("titanium", 115e9, 0.37, 4430.0)
}

/// Steel spheres of `sphere` m radius on both sides of a plate of `radius` and `thickness` m.
pub fn impact(radius: f64, thickness: f64, edge: Edge, material: Material, sphere: f64) -> PlateImpact {
    let shape = Shape::Sphere { radius: sphere };
    PlateImpact {
        friction: 0.0,
        plate: Plate { radius, thickness, edge, material, damping_ratio: 0.0 },
        outer: Outer::centred(shape.clone(), steel(), SPEED),
        inner: Inner { shape, material: steel(), gap: 0.0, speed: 0.0, turning: Turning::default() },
        fluid: None,
        series: None,
    }
}

/// The scene of an impact of a study; nothing but the bodies and their motion is set.
pub fn scene(name: &str, setup: PlateImpact) -> Scene {
    Scene {
        name: name.into(),
        description: format!("An impact of the study {name}"),
        setup: setup.into(),
        run: RunSettings { end_time: None },
        reduced: ReducedSettings { model: None, modes: None, frequencies: None },
        reference: ReferenceSettings {
            geometry: Geometry::Axisymmetric,
            elements_per_contact_radius: Some(12.0),
            elements_per_thickness: None,
            elements_per_ring_radius: None,
            element_order: None,
            rigid: None,
        },
        tolerances: BTreeMap::new(),
        uncertainty: None,
        flight: None,
        vibration: None,
        external: Vec::new(),
    }
}

/// The impacts of a study, run one by one or in parallel, without solving an eigenproblem twice.
#[derive(Debug)]
pub struct Runner {
    model: Model,
    bodies: SharedBodies,
}

impl Runner {
    /// Runs `model`.
    pub fn new(model: Model) -> Self {
        Runner { model, bodies: SharedBodies::default() }
    }

    /// The result of one impact.
    ///
    /// # Errors
    /// As [`Reduced::new`] and [`Reduced::point`].
    pub fn run(&self, setup: PlateImpact) -> Result<PlateQuantities> {
        let reduced = Reduced::in_series(scene("study", setup), self.model, None, &self.bodies)?;
        Ok(reduced.point(TOLERANCE)?.quantities)
    }

    /// The results of `setups`, in their order.
    ///
    /// # Errors
    /// As [`Runner::run`].
    pub fn run_all(&self, setups: Vec<PlateImpact>, note: &mut Note) -> Result<Vec<PlateQuantities>> {
        note(&format!("{} impacts with model {}", setups.len(), self.model));
        setups.into_par_iter().map(|setup| self.run(setup)).collect()
    }
}

/// `count` values from `low` to `high`, both included, in equal steps.
pub fn linear(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| low + (high - low) * k as f64 / (count - 1) as f64).collect()
}

/// `count` values from `low` to `high`, both included, in equal ratios.
pub fn logarithmic(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| logarithmic_at(low, high, k as f64 / (count - 1) as f64)).collect()
}

/// The value between `low` and `high` at the part `x`, 0 to 1, of the way, in ratios.
pub fn logarithmic_at(low: f64, high: f64, x: f64) -> f64 {
    low * (high / low).powf(x)
}

/// The claim that `values` do nothing but rise (or fall): the share of steps that do, which has to be 1.
pub fn monotone(claim: String, values: &[f64], rises: bool) -> Claim {
    let steps = values.windows(2);
    let count = steps.len();
    let good = steps.filter(|w| if rises { w[1] > w[0] } else { w[1] < w[0] }).count();
    Claim::new(format!("{claim} (share of steps)"), "1", Some(1.0), Some(good as f64 / count as f64), 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::study::Verdict;

    #[test]
    fn one_step_the_other_way_breaks_the_trend() {
        let verdict = |values: &[f64], rises| monotone(String::new(), values, rises).verdict;
        assert_eq!(verdict(&[1.0, 2.0, 4.0], true), Verdict::Pass);
        assert_eq!(verdict(&[1.0, 2.0, 4.0], false), Verdict::Fail);
        assert_eq!(verdict(&[1.0, 2.0, 2.0], true), Verdict::Fail);
        assert_eq!(verdict(&[4.0, 3.0, f64::NAN], false), Verdict::Fail);
    }

    #[test]
    fn ranges_include_their_ends() {
        assert_eq!(linear(2.0, 10.0, 5), [2.0, 4.0, 6.0, 8.0, 10.0]);
        let decades = logarithmic(1.0, 1000.0, 4);
        assert!(decades.iter().zip([1.0, 10.0, 100.0, 1000.0]).all(|(a, b)| (a / b - 1.0).abs() < 1e-12));
    }
}
