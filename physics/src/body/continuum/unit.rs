//! Continuum bodies of one shape: of any size, modulus and density, and under any contact patches, without a new mesh.
//!
//! In units of radius, Young's modulus and density a plate is given by its edge, Poisson's ratio and thickness, a sphere by
//! Poisson's ratio. What is left is the contact patch. Shapes and flexibilities weighted by Hertz's pressure are even and analytic in
//! its radius: polynomials in the square of it, through Chebyshev's points, have them to [`NODES`] terms.

use super::lanczos::ShiftInvert;
use super::mirror::{HalfBody, Parity};
use super::patch::{half_space_flexibility, nodal_forces};
use super::plate::{ContinuumPlate, Halves, SpectrumEntry, WAVES, WEIGHTED, plate_mesh, sign};
use super::{MeshOptions, sphere_residual};
use crate::body::layer::Waves;
use crate::contact::{PatchTable, RADII, TABULATED, WHOLE};
use crate::error::Result;
use crate::numerics::chebyshev::{Chebyshev, blend};
use crate::numerics::vectors::dot;
use crate::scene::{Edge, Material, Plate};
use std::f64::consts::SQRT_2;

/// Chebyshev's points of the patches of a plate, and of a sphere.
const NODES: usize = 32;
const SPHERE_NODES: usize = 12;
/// Widest patch over the plate's thickness; wider ones are beyond model C.
const WIDEST: f64 = 1.1;
/// Patches of a sphere over its radius.
const SPHERE_PATCHES: [f64; 2] = [1e-3, 0.45];
/// Modes whose share of the static flexibility stands apart.
const APART: usize = 6;
/// Thicknesses over radii that differ by less are the same.
const ROUNDING: f64 = 1e-14;
/// Size ratio of adjacent elements along the face, where no patch's rim is among their ends, as it is where a mesh is made for one
/// patch; and away from the face.
const GROWTH: [f64; 2] = [1.15, 1.4];

/// Plates of one shape.
#[derive(Debug)]
pub(super) struct MeshedPlate {
    pub(super) edge: Edge,
    pub(super) poisson_ratio: f64,
    /// Over the radius.
    pub(super) thickness: f64,
    pub(super) modes: usize,
    /// Of the squares of the patches' radii.
    pub(super) patches: Chebyshev,
    /// The `modes` + 1 lowest in bending, then in longitudinal motion. Shape (2 (modes + 1)).
    pub(super) omega: Vec<f64>,
    /// Mass-normalised, of the face turned outwards. Shape (2 (modes + 1), nodes).
    pub(super) shapes: Vec<Vec<f64>>,
    /// Static flexibility of a face without the half-space and the modes [`Self::apart`], by finite elements and of the layer. Shape (2, nodes).
    pub(super) own: [Vec<f64>; 2],
    /// The same between the faces. Shape (2, nodes, nodes).
    pub(super) mutual: [Vec<Vec<f64>>; 2],
    pub(super) degrees_of_freedom: usize,
}

impl MeshedPlate {
    /// Plates like `plate`.
    pub(super) fn of(plate: &Plate, modes: usize) -> Result<Self> {
        let thickness = plate.thickness / plate.radius;
        Self::new(plate.edge, plate.material.poisson_ratio, thickness, modes, widest_patch(thickness))
    }

    /// With patches up to `widest` thicknesses.
    pub(super) fn new(
        edge: Edge,
        poisson_ratio: f64,
        thickness: f64,
        modes: usize,
        widest: f64,
    ) -> Result<Self> {
        let material = Material::elastic("unit", 1.0, poisson_ratio, 1.0);
        let unit = Plate { radius: 1.0, thickness, edge, material, damping_ratio: 0.0 };
        let patches = patches(widest * thickness);
        let radii: Vec<f64> = patches.nodes.iter().map(|square| square.sqrt()).collect();
        let [growth, depth_growth] = GROWTH;
        let options = MeshOptions { growth, depth_growth, ..MeshOptions::default() };
        let mesh = plate_mesh(&unit, Some(radii[0]), modes, &options);
        let halves = Halves::new(&unit, &mesh)?;
        let forces: Vec<_> = radii.iter().map(|a| nodal_forces(&mesh, *a)).collect();
        let loads = halves.each().map(|(_, half)| forces.iter().map(|f| half.axial_load(f)).collect());
        let spectra = halves.spectra(modes + 1)?;
        let (own, mutual) = static_flexibility(&unit, &radii, &halves, &loads);
        let mut plate = Self {
            edge,
            poisson_ratio,
            thickness,
            modes,
            omega: spectra.iter().map(|entry| entry.omega).collect(),
            shapes: weighted(&spectra, &loads),
            own,
            mutual,
            degrees_of_freedom: halves.degrees_of_freedom(),
            patches,
        };
        plate.take_out_modes();
        Ok(plate)
    }

    /// Leaves the flexibilities what they are beyond the modes that make most of them.
    fn take_out_modes(&mut self) {
        let nodes = 0..self.patches.nodes.len();
        for (i, j) in nodes.clone().flat_map(|i| nodes.clone().map(move |j| (i, j))) {
            let term = |k: usize| self.shapes[k][i] * self.shapes[k][j] / self.omega[k].powi(2);
            let compliance: f64 = self.apart().map(term).sum();
            for (own, mutual) in self.own.iter_mut().zip(&mut self.mutual) {
                mutual[i][j] -= compliance;
                if i == j {
                    own[i] -= compliance;
                }
            }
        }
    }

    /// The modes whose yielding is not among the flexibilities: some in bending, which are nearly all of it.
    fn apart(&self) -> std::ops::Range<usize> {
        0..APART.min(self.modes + 1)
    }

    pub(super) fn is_of(&self, plate: &Plate, modes: usize) -> bool {
        self.edge == plate.edge
            && self.poisson_ratio == plate.material.poisson_ratio
            && (self.thickness * plate.radius / plate.thickness - 1.0).abs() < ROUNDING
            && self.modes == modes
    }

    /// [`ContinuumPlate::new`] of `plate`, which has this shape; `None` if a patch is too wide.
    pub(super) fn scaled(&self, plate: &Plate, patch_radius: [f64; 2]) -> Option<ContinuumPlate> {
        let Plate { radius, material, .. } = plate;
        let square = |a: f64| (a / radius).powi(2);
        if patch_radius.iter().any(|a| square(a * WEIGHTED[TABULATED]) > self.patches.to) {
            return None;
        }
        let weights = patch_radius.map(|a| WEIGHTED.map(|r| self.patches.weights(square(r * a))));
        let amplitude = 1.0 / (material.density * radius.powi(3)).sqrt();
        let speed = (material.youngs_modulus / material.density).sqrt() / radius;
        let by_node = |node: usize| weights.each_ref().map(|of| of.each_ref().map(|w| w[node]));
        let by_node: Vec<[[f64; WEIGHTED.len()]; 2]> = (0..self.patches.nodes.len()).map(by_node).collect();
        let shape = |k: usize| {
            let mut sums = [[0.0; WEIGHTED.len()]; 2];
            for (weights, value) in by_node.iter().zip(&self.shapes[k]) {
                let pairs = sums.as_flattened_mut().iter_mut().zip(weights.as_flattened());
                pairs.for_each(|(sum, weight)| *sum += weight * value);
            }
            let parity = if k <= self.modes { Parity::Bending } else { Parity::Longitudinal };
            [0, 1].map(|i| sums[i].map(|sum| amplitude * sign(parity, i) * sum))
        };
        let mut flexibility = self.flexibility(&weights, 1.0 / (material.youngs_modulus * radius));
        for k in self.apart() {
            let share = (self.omega[k] * speed).powi(-2);
            flexibility.add(share, share, shape(k).map(|phi| std::array::from_fn(|m| phi[m])));
        }
        let mut order: Vec<usize> = (0..self.omega.len()).collect();
        order.sort_by(|i, j| self.omega[*i].total_cmp(&self.omega[*j]));
        order.truncate(self.modes + 1);
        Some(ContinuumPlate {
            omega: order.iter().map(|k| self.omega[*k] * speed).collect(),
            participation: order.iter().map(|k| shape(*k)).collect(),
            flexibility,
            patch_radius,
            free_mass: (plate.edge == Edge::Free).then(|| plate.mass()),
            damping_ratio: plate.damping_ratio,
            degrees_of_freedom: self.degrees_of_freedom,
        })
    }

    /// Beyond the modes [`Self::apart`], by the weights of every radius of both patches; `unit` in m/N.
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

/// Radius over the thickness of the widest patch with which shapes of plates of `thickness` radii are weighted.
pub(super) fn widest_patch(thickness: f64) -> f64 {
    WEIGHTED[TABULATED] * WIDEST.min(0.5 / thickness)
}

/// Squares of the radii of patches up to `widest`.
pub(super) fn patches(widest: f64) -> Chebyshev {
    Chebyshev::new(0.0, widest * widest, NODES)
}

/// Loads of unit forces over patches, in the motions of [`Halves::each`]. Shape (2, patches, unknowns).
type Loads = [Vec<Vec<f64>>; 2];

/// The shapes of `spectrum` over the patches of the `loads`, of the face turned outwards. Shape (modes, patches).
fn weighted(spectrum: &[SpectrumEntry], [bending, longitudinal]: &Loads) -> Vec<Vec<f64>> {
    let over = |entry: &SpectrumEntry| {
        let loads = if entry.parity == Parity::Bending { bending } else { longitudinal };
        loads.iter().map(|load| dot(load, &entry.shape) / SQRT_2).collect()
    };
    spectrum.iter().map(over).collect()
}

/// [`MeshedPlate::own`] and [`MeshedPlate::mutual`] of patches of the `radii` under their `loads`.
fn static_flexibility(
    unit: &Plate,
    radii: &[f64],
    halves: &Halves,
    loads: &Loads,
) -> ([Vec<f64>; 2], [Vec<Vec<f64>>; 2]) {
    let displaced = |half: &HalfBody, loads: &Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        let mut displacements = loads.concat();
        half.solve_each(&mut displacements);
        let under = |displacement: &[f64]| loads.iter().map(|load| dot(load, displacement)).collect();
        displacements.chunks_exact(half.size()).map(under).collect()
    };
    let [(_, bending), (_, longitudinal)] = halves.each();
    let [bending, longitudinal] = [displaced(bending, &loads[0]), displaced(longitudinal, &loads[1])];
    let face = |i: usize, j: usize, sign: f64| 0.5 * (bending[i][j] + sign * longitudinal[i][j]);
    let all = 0..radii.len();
    let own = |i: usize| face(i, i, 1.0) - half_space_flexibility(&unit.material, radii[i]);
    let mutual = all.clone().map(|i| all.clone().map(|j| face(i, j, -1.0)).collect()).collect();
    let layer = Waves::new(unit, WAVES).flexibilities(radii);
    ([all.map(own).collect(), layer.0], [mutual, layer.1])
}

/// Spheres of one Poisson's ratio.
#[derive(Debug)]
pub(super) struct UnitSphere {
    pub(super) poisson_ratio: f64,
    /// Of the logarithms of the patches' radii.
    pub(super) patches: Chebyshev,
    /// Residual flexibility. Shape (nodes).
    pub(super) residual: Vec<f64>,
}

impl UnitSphere {
    pub(super) fn new(poisson_ratio: f64) -> Result<Self> {
        let [from, to] = SPHERE_PATCHES.map(f64::ln);
        let patches = Chebyshev::new(from, to, SPHERE_NODES);
        let material = Material::elastic("unit", 1.0, poisson_ratio, 1.0);
        let at = |x: f64| sphere_residual(1.0, &material, x.exp(), &MeshOptions::default());
        let residual = patches.nodes.iter().copied().map(at).collect::<Result<_>>()?;
        Ok(Self { poisson_ratio, patches, residual })
    }

    /// [`sphere_residual`]; `None` if the patch is too small or too wide.
    pub(super) fn scaled(&self, radius: f64, material: &Material, patch_radius: f64) -> Option<f64> {
        let patch = patch_radius / radius;
        let known = (SPHERE_PATCHES[0]..=SPHERE_PATCHES[1]).contains(&patch);
        let unit = 1.0 / (material.youngs_modulus * radius);
        known.then(|| unit * dot(&self.patches.weights(patch.ln()), &self.residual))
    }
}
