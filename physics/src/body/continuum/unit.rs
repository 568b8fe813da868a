//! Continuum bodies of one shape: of any size, modulus and density, and under any contact patches, without a new mesh.
//!
//! In units of radius, Young's modulus and density a plate is given by its edge, Poisson's ratio and thickness, a sphere by
//! Poisson's ratio. What is left is the contact patch. Shapes and flexibilities weighted by Hertz's pressure are even and analytic in
//! its radius: polynomials in the square of it, through Chebyshev's points, have them to [`NODES`] terms.

use super::lanczos::ShiftInvert;
use super::mirror::{HalfBody, Parity, dot};
use super::patch::{half_space_flexibility, nodal_forces};
use super::plate::{ContinuumPlate, Halves, SpectrumEntry, WAVES, WEIGHTED, plate_mesh, sign};
use super::{MeshOptions, sphere_residual};
use crate::body::kept::Kept;
use crate::body::layer::Waves;
use crate::contact::{PatchTable, RADII, TABULATED, WHOLE};
use crate::error::Result;
use crate::numerics::chebyshev::{Chebyshev, blend};
use crate::scene::{Edge, Material, Plate};
use std::f64::consts::SQRT_2;

/// Chebyshev's points of the patches of a plate, and of a sphere.
const NODES: usize = 32;
const SPHERE_NODES: usize = 12;
/// Widest patch over the plate's thickness; wider ones are beyond model C.
const WIDEST: f64 = 1.1;
/// Patches of a sphere over its radius.
const SPHERE_PATCHES: [f64; 2] = [1e-3, 0.45];
/// Thicknesses over radii that differ by less are the same.
const ROUNDING: f64 = 1e-14;
/// Size ratio of adjacent elements: no patch's rim is among their ends, as it is where a mesh is made for one patch.
const GROWTH: f64 = 1.15;

/// Plates of one shape.
#[derive(Debug)]
struct UnitPlate {
    edge: Edge,
    poisson_ratio: f64,
    /// Over the radius.
    thickness: f64,
    /// Of the squares of the patches' radii.
    patches: Chebyshev,
    /// One more than there are modes. Shape (modes + 1).
    omega: Vec<f64>,
    parity: Vec<Parity>,
    /// Mass-normalised, of the face turned outwards. Shape (nodes, modes + 1).
    shapes: Vec<Vec<f64>>,
    /// Static flexibility of a face without the half-space, by finite elements and of the layer. Shape (2, nodes).
    own: [Vec<f64>; 2],
    /// The same between the faces. Shape (2, nodes, nodes).
    mutual: [Vec<Vec<f64>>; 2],
    degrees_of_freedom: usize,
}

impl UnitPlate {
    fn new(plate: &Plate, modes: usize) -> Result<Self> {
        let thickness = plate.thickness / plate.radius;
        let material = Material::elastic("unit", 1.0, plate.material.poisson_ratio, 1.0);
        let unit = Plate { radius: 1.0, thickness, edge: plate.edge, material, damping_ratio: 0.0 };
        let widest = WEIGHTED[TABULATED] * (WIDEST * thickness).min(0.5);
        let patches = Chebyshev::new(0.0, widest * widest, NODES);
        let radii: Vec<f64> = patches.nodes.iter().map(|square| square.sqrt()).collect();
        let options = MeshOptions { growth: GROWTH, ..MeshOptions::default() };
        let mesh = plate_mesh(&unit, Some(radii[0]), modes, &options);
        let halves = Halves::new(&unit, &mesh)?;
        let forces: Vec<_> = radii.iter().map(|a| nodal_forces(&mesh, *a)).collect();
        let loads = halves.each().map(|(_, half)| forces.iter().map(|f| half.axial_load(f)).collect());
        let spectrum = halves.spectrum(modes + 1)?;
        let (own, mutual) = static_flexibility(&unit, &radii, &halves, &loads);
        Ok(Self {
            edge: plate.edge,
            poisson_ratio: plate.material.poisson_ratio,
            thickness,
            omega: spectrum.iter().map(|entry| entry.omega).collect(),
            parity: spectrum.iter().map(|entry| entry.parity).collect(),
            shapes: weighted(&spectrum, &loads),
            own,
            mutual,
            degrees_of_freedom: halves.degrees_of_freedom(),
            patches,
        })
    }

    fn is_of(&self, plate: &Plate, modes: usize) -> bool {
        self.edge == plate.edge
            && self.poisson_ratio == plate.material.poisson_ratio
            && (self.thickness * plate.radius / plate.thickness - 1.0).abs() < ROUNDING
            && self.omega.len() == modes + 1
    }

    /// [`ContinuumPlate::new`] of `plate`, which has this shape; `None` if a patch is too wide.
    fn scaled(&self, plate: &Plate, patch_radius: [f64; 2]) -> Option<ContinuumPlate> {
        let Plate { radius, material, .. } = plate;
        let square = |a: f64| (a / radius).powi(2);
        if patch_radius.iter().any(|a| square(a * WEIGHTED[TABULATED]) > self.patches.to) {
            return None;
        }
        let weights = patch_radius.map(|a| WEIGHTED.map(|r| self.patches.weights(square(r * a))));
        let amplitude = 1.0 / (material.density * radius.powi(3)).sqrt();
        let speed = (material.youngs_modulus / material.density).sqrt() / radius;
        let shapes = weights.each_ref().map(|weights| weights.each_ref().map(|w| blend(w, &self.shapes)));
        let shape = |(k, parity): (usize, &Parity)| {
            [0, 1].map(|i| shapes[i].each_ref().map(|shape| amplitude * sign(*parity, i) * shape[k]))
        };
        Some(ContinuumPlate {
            omega: self.omega.iter().map(|omega| omega * speed).collect(),
            participation: self.parity.iter().enumerate().map(shape).collect(),
            flexibility: self.flexibility(&weights, 1.0 / (material.youngs_modulus * radius)),
            patch_radius,
            free_mass: (plate.edge == Edge::Free).then(|| plate.mass()),
            damping_ratio: plate.damping_ratio,
            degrees_of_freedom: self.degrees_of_freedom,
        })
    }

    /// By the weights of every radius of both patches; `unit` in m/N.
    fn flexibility(&self, weights: &[[Vec<f64>; WEIGHTED.len()]; 2], unit: f64) -> PatchTable {
        let own = |which: usize, i: usize, m: usize| unit * dot(&weights[i][m], &self.own[which]);
        let radii: [usize; RADII.len()] = std::array::from_fn(|m| m);
        // by the radii of contact 1, at the nodes of contact 0; the plate is the same from both sides
        let along = |which: usize, n: usize| blend(&weights[1][n], &self.mutual[which]);
        let layer = radii.map(|n| along(1, n));
        let mut table = PatchTable {
            own: [0, 1].map(|i| radii.map(|m| own(1, i, m))),
            mutual: radii.map(|m| radii.map(|n| unit * dot(&weights[0][m], &layer[n]))),
        };
        let between = unit * dot(&weights[0][WHOLE], &along(0, WHOLE));
        table.shift_to([own(0, 0, WHOLE), between, own(0, 1, WHOLE)]);
        table
    }
}

/// Loads of unit forces over patches, in the motions of [`Halves::each`]. Shape (2, patches, unknowns).
type Loads = [Vec<Vec<f64>>; 2];

/// The shapes of `spectrum` over the patches of the `loads`, of the face turned outwards. Shape (patches, modes).
fn weighted(spectrum: &[SpectrumEntry], [bending, longitudinal]: &Loads) -> Vec<Vec<f64>> {
    let over = |(bending, longitudinal): (&Vec<f64>, &Vec<f64>)| {
        let at = |entry: &SpectrumEntry| {
            let load = if entry.parity == Parity::Bending { bending } else { longitudinal };
            dot(load, &entry.shape) / SQRT_2
        };
        spectrum.iter().map(at).collect()
    };
    bending.iter().zip(longitudinal).map(over).collect()
}

/// [`UnitPlate::own`] and [`UnitPlate::mutual`] of patches of the `radii` under their `loads`.
fn static_flexibility(
    unit: &Plate,
    radii: &[f64],
    halves: &Halves,
    loads: &Loads,
) -> ([Vec<f64>; 2], [Vec<Vec<f64>>; 2]) {
    let displaced = |half: &HalfBody, loads: &Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        let under = |load: &Vec<f64>| {
            let mut displacement = load.clone();
            half.solve(&mut displacement);
            loads.iter().map(|load| dot(load, &displacement)).collect()
        };
        loads.iter().map(under).collect()
    };
    let [(_, bending), (_, longitudinal)] = halves.each();
    let [bending, longitudinal] = [displaced(bending, &loads[0]), displaced(longitudinal, &loads[1])];
    let waves = Waves::new(unit, WAVES);
    let face = |i: usize, j: usize, sign: f64| 0.5 * (bending[i][j] + sign * longitudinal[i][j]);
    let layer = |i: usize, j: usize| waves.layer([radii[i], radii[j]]).flexibility;
    let all = 0..radii.len();
    let each = |value: &dyn Fn(usize) -> f64| all.clone().map(value).collect();
    let pairs = |value: &dyn Fn(usize, usize) -> f64| {
        all.clone().map(|i| all.clone().map(|j| value(i, j)).collect()).collect()
    };
    let own = |i: usize| face(i, i, 1.0) - half_space_flexibility(&unit.material, radii[i]);
    (
        [each(&own), each(&|i| layer(i, i).own[0][WHOLE])],
        [pairs(&|i, j| face(i, j, -1.0)), pairs(&|i, j| layer(i, j).mutual[WHOLE][WHOLE])],
    )
}

/// Spheres of one Poisson's ratio.
#[derive(Debug)]
struct UnitSphere {
    poisson_ratio: f64,
    /// Of the logarithms of the patches' radii.
    patches: Chebyshev,
    /// Residual flexibility. Shape (nodes).
    residual: Vec<f64>,
}

impl UnitSphere {
    fn new(poisson_ratio: f64) -> Result<Self> {
        let [from, to] = SPHERE_PATCHES.map(f64::ln);
        let patches = Chebyshev::new(from, to, SPHERE_NODES);
        let material = Material::elastic("unit", 1.0, poisson_ratio, 1.0);
        let at = |x: f64| sphere_residual(1.0, &material, x.exp(), &MeshOptions::default());
        let residual = patches.nodes.iter().copied().map(at).collect::<Result<_>>()?;
        Ok(Self { poisson_ratio, patches, residual })
    }

    /// [`sphere_residual`]; `None` if the patch is too small or too wide.
    fn scaled(&self, radius: f64, material: &Material, patch_radius: f64) -> Option<f64> {
        let patch = patch_radius / radius;
        let known = (SPHERE_PATCHES[0]..=SPHERE_PATCHES[1]).contains(&patch);
        let unit = 1.0 / (material.youngs_modulus * radius);
        known.then(|| unit * dot(&self.patches.weights(patch.ln()), &self.residual))
    }
}

/// The shapes of continuum bodies that a series of impacts has needed so far; shared by its threads.
#[derive(Debug, Default)]
pub struct UnitBodies {
    plates: Kept<UnitPlate>,
    spheres: Kept<UnitSphere>,
}

impl UnitBodies {
    /// [`ContinuumPlate::new`] on the default mesh without a mesh of its own; `None` for patches that only such a mesh has.
    ///
    /// # Errors
    /// As [`ContinuumPlate::new`].
    pub fn plate(
        &self,
        plate: &Plate,
        patch_radius: [f64; 2],
        modes: usize,
    ) -> Result<Option<ContinuumPlate>> {
        let unit = self.plates.find_or(|unit| unit.is_of(plate, modes), || UnitPlate::new(plate, modes))?;
        Ok(unit.scaled(plate, patch_radius))
    }

    /// [`sphere_residual`] on the default mesh likewise.
    ///
    /// # Errors
    /// As [`sphere_residual`].
    pub fn sphere_residual(
        &self,
        radius: f64,
        material: &Material,
        patch_radius: f64,
    ) -> Result<Option<f64>> {
        let ratio = material.poisson_ratio;
        let unit = self.spheres.find_or(|unit| unit.poisson_ratio == ratio, || UnitSphere::new(ratio))?;
        Ok(unit.scaled(radius, material, patch_radius))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Flexibilities over the half-space's, frequencies and shapes over the largest: all that `of` differs from `exact` by.
    fn misses(of: &ContinuumPlate, exact: &ContinuumPlate, half_space: f64) -> [f64; 3] {
        let tables = |plate: &ContinuumPlate| {
            let table = plate.flexibility;
            table.own.iter().chain(&table.mutual).flatten().copied().collect::<Vec<f64>>()
        };
        // the sign of a shape is arbitrary
        let shapes = |plate: &ContinuumPlate| {
            let turned = plate.participation.iter().map(|phi| {
                let sign = phi[0][WHOLE].signum();
                phi.as_flattened().iter().map(move |value| sign * value)
            });
            turned.flatten().collect::<Vec<f64>>()
        };
        let largest = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        let scale = shapes(exact).iter().fold(0.0_f64, |m, value| m.max(value.abs()));
        let frequencies =
            of.omega.iter().zip(&exact.omega).fold(0.0_f64, |m, (a, b)| m.max((a / b - 1.0).abs()));
        let flexibility = largest(&tables(of), &tables(exact)) / half_space;
        [flexibility, frequencies, largest(&shapes(of), &shapes(exact)) / scale]
    }

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
