//! Continuum bodies of a series of impacts: scaled from those of their shape, and these between the shapes of a few.

use super::family::{NODES, PlateFamily, SphereFamily};
use super::plate::ContinuumPlate;
use super::unit::{MeshedPlate, UnitSphere};
use crate::body::memo::MemoList;
use crate::error::Result;
use crate::scene::{Edge, Material, Plate};
use std::sync::OnceLock;

/// Largest ratio of thicknesses and difference of Poisson's ratios in a family.
const THICKEST: f64 = 1.9;
const POISSON_RANGE: f64 = 0.15;
/// Impacts that a plate of a family has to serve: fewer are quicker with a mesh each.
const SERVED: usize = 4;

/// In which ranges the shapes of the bodies of a series vary.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Varied {
    /// Thickness of the plate over its radius.
    pub thickness: Option<[f64; 2]>,
    /// Poisson's ratios, by the names of the materials.
    pub poisson_ratio: Vec<(String, [f64; 2])>,
}

impl Varied {
    /// Range of Poisson's ratio of `material`.
    fn poisson_ratio(&self, material: &Material) -> Option<[f64; 2]> {
        self.poisson_ratio.iter().find(|(name, _)| *name == material.name).map(|(_, range)| *range)
    }

    /// Whether a series of so many `impacts` through plates of `material` is quicker with families of shapes than with meshes.
    pub fn pays(&self, impacts: usize, material: &Material) -> bool {
        let plates = |range: Option<[f64; 2]>, largest: f64, nodes: usize| {
            range.map_or(1, |range| parts(range, largest) * nodes)
        };
        let [thicknesses, ratios] = NODES[0];
        let thickness = plates(self.thickness.map(|t| t.map(f64::ln)), THICKEST.ln(), thicknesses);
        impacts >= SERVED * thickness * plates(self.poisson_ratio(material), POISSON_RANGE, ratios)
    }
}

/// In how many parts a range is cut of which each may be as long as `largest`.
fn parts([from, to]: [f64; 2], largest: f64) -> usize {
    (((to - from) / largest).ceil() as usize).max(1)
}

/// The part of `range` that `x` is in; `None` if it is outside.
fn part([from, to]: [f64; 2], largest: f64, x: f64) -> Option<[f64; 2]> {
    let rounding = 1e-12 * (to - from);
    if !(from - rounding..=to + rounding).contains(&x) {
        return None;
    }
    let count = parts([from, to], largest) as f64;
    let end = |k: f64| from + (to - from) * k / count;
    let k = ((x - from) / (to - from) * count).floor().clamp(0.0, count - 1.0);
    Some([end(k), end(k + 1.0)])
}

/// A family of plates that is made when the first of them is asked for.
#[derive(Debug)]
struct LazyPlateFamily {
    edge: Edge,
    thickness: [f64; 2],
    poisson_ratio: [f64; 2],
    modes: usize,
    /// `None` if the polynomials are not good enough, or a mesh failed.
    family: OnceLock<Option<PlateFamily>>,
}

/// The shapes of continuum bodies that a series of impacts has needed so far; shared by its threads.
#[derive(Debug, Default)]
pub struct UnitBodies {
    varied: Varied,
    plates: MemoList<MeshedPlate>,
    spheres: MemoList<UnitSphere>,
    families: MemoList<LazyPlateFamily>,
    sphere_families: MemoList<([f64; 2], SphereFamily)>,
}

impl UnitBodies {
    /// Of a series in which so much is `varied`.
    pub fn new(varied: Varied) -> Self {
        Self { varied, ..Self::default() }
    }

    /// [`ContinuumPlate::new`] on the default mesh without a mesh of its own; `None` for patches and shapes that only such a mesh has.
    ///
    /// # Errors
    /// As [`ContinuumPlate::new`].
    pub fn plate(
        &self,
        plate: &Plate,
        patch_radius: [f64; 2],
        modes: usize,
    ) -> Result<Option<ContinuumPlate>> {
        let ratio = self.varied.poisson_ratio(&plate.material);
        if self.varied.thickness.is_some() || ratio.is_some() {
            return self.between(plate, patch_radius, modes, ratio);
        }
        let unit = self.plates.find_or(|unit| unit.is_of(plate, modes), || MeshedPlate::of(plate, modes))?;
        Ok(unit.scaled(plate, patch_radius))
    }

    /// [`Self::plate`] of a shape that varies, with Poisson's ratio in the range `ratio` if it does.
    fn between(
        &self,
        plate: &Plate,
        patch_radius: [f64; 2],
        modes: usize,
        ratio: Option<[f64; 2]>,
    ) -> Result<Option<ContinuumPlate>> {
        let (t, nu) = (plate.thickness / plate.radius, plate.material.poisson_ratio);
        let logarithms = self.varied.thickness.unwrap_or([t; 2]).map(f64::ln);
        let thickness = self.varied.thickness.map_or(Some([t; 2]), |_| {
            part(logarithms, THICKEST.ln(), t.ln()).map(|range| range.map(f64::exp))
        });
        let ratio = ratio.map_or(Some([nu; 2]), |range| part(range, POISSON_RANGE, nu));
        let (Some(thickness), Some(poisson_ratio)) = (thickness, ratio) else { return Ok(None) };
        let edge = plate.edge;
        let fits = |plates: &LazyPlateFamily| {
            (plates.edge, plates.thickness, plates.poisson_ratio, plates.modes)
                == (edge, thickness, poisson_ratio, modes)
        };
        let plates = self.families.find_or(fits, || {
            Ok(LazyPlateFamily { edge, thickness, poisson_ratio, modes, family: OnceLock::new() })
        })?;
        // by one thread, while the others wait: it takes seconds
        let family = plates
            .family
            .get_or_init(|| PlateFamily::new(edge, thickness, poisson_ratio, modes).ok().flatten());
        Ok(family.as_ref().and_then(|family| family.at(t, nu).scaled(plate, patch_radius)))
    }

    /// [`super::sphere_residual`] on the default mesh likewise.
    ///
    /// # Errors
    /// As [`super::sphere_residual`].
    pub fn sphere_residual(
        &self,
        radius: f64,
        material: &Material,
        patch_radius: f64,
    ) -> Result<Option<f64>> {
        let ratio = material.poisson_ratio;
        let Some(range) = self.varied.poisson_ratio(material) else {
            let unit = self.spheres.find_or(|unit| unit.poisson_ratio == ratio, || UnitSphere::new(ratio))?;
            return Ok(unit.scaled(radius, material, patch_radius));
        };
        let Some(range) = part(range, POISSON_RANGE, ratio) else { return Ok(None) };
        let family = self
            .sphere_families
            .find_or(|(of, _)| *of == range, || Ok((range, SphereFamily::new(range)?)))?;
        Ok(family.1.at(ratio).scaled(radius, material, patch_radius))
    }
}

#[cfg(test)]
mod tests {
    use super::super::family::misses;
    use super::super::patch::half_space_flexibility;
    use super::super::plate::ContinuumPlate;
    use super::super::{MeshOptions, sphere_residual};
    use super::*;
    use crate::scene::Edge;

    #[test]
    fn a_scaled_plate_is_as_near_to_the_truth_as_one_with_a_mesh_of_its_own() {
        let bodies = UnitBodies::default();
        let material = Material::elastic("brass", 100e9, 0.3, 8400.0);
        for (edge, thickness) in [(Edge::Clamped, 0.06), (Edge::SimplySupported, 0.02), (Edge::Free, 0.5)] {
            let radius = 12e-3;
            let thickness = thickness * radius;
            let plate = Plate { radius, thickness, edge, material: material.clone(), damping_ratio: 0.01 };
            for patch in [[0.06, 0.3], [0.21, 0.2], [0.8, 1.0]] {
                let patch = patch.map(|a| (a * plate.thickness).min(0.45 * radius));
                let own = |mesh: MeshOptions| ContinuumPlate::new(&plate, patch, 8, &mesh).unwrap();
                let (meshed, fine) = (own(MeshOptions::default()), own(MeshOptions::default().refined(1.6)));
                let scaled = bodies.plate(&plate, patch, 8).unwrap().expect("within the range");
                let half_space = half_space_flexibility(&plate.material, patch[0].max(patch[1]));
                let [ours, theirs] = [&scaled, &meshed].map(|of| misses(of, &fine, half_space));
                for (ours, theirs) in ours.into_iter().zip(theirs) {
                    assert!(ours < 1.5 * theirs + 3e-5, "{edge:?} {patch:?}: {ours:e}, meshed {theirs:e}");
                }
                assert_eq!(
                    (scaled.free_mass, scaled.damping_ratio),
                    (meshed.free_mass, meshed.damping_ratio)
                );
            }
            assert!(bodies.plate(&plate, [0.3e-3, 2.0 * radius], 8).unwrap().is_none());
        }
        assert_eq!(bodies.plates.len(), 3);
    }

    #[test]
    fn a_scaled_sphere_is_the_meshed_one() {
        let bodies = UnitBodies::default();
        let material = Material::elastic("brass", 100e9, 0.35, 8400.0);
        let radius = 4e-3;
        for patch in [0.0013, 0.004, 0.03, 0.3, 0.44] {
            let ours =
                bodies.sphere_residual(radius, &material, patch * radius).unwrap().expect("within the range");
            let exact = sphere_residual(radius, &material, patch * radius, &MeshOptions::default()).unwrap();
            let half_space = half_space_flexibility(&material, patch * radius);
            assert!((ours - exact).abs() < 1.2e-4 * half_space, "{patch}: {ours:e}, {exact:e}");
        }
        assert!(bodies.sphere_residual(radius, &material, 1e-4 * radius).unwrap().is_none());
    }
}
