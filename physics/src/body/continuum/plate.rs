//! Circular plate of any thickness as a continuum.
//!
//! Supports of the rim r = R, on its whole face -t/2 <= z <= t/2:
//! - clamped: u_r = u_z = 0 (Table 2 of the paper);
//! - simply supported: u_z = 0, u_r free. The rim may rotate, as in plate theory, and the problem has a
//!   limit under mesh refinement: holding only the mid-plane's circle would be a line load, under which a
//!   continuum sinks without bound;
//! - free.

use super::assembly::Matrices;
use super::grading::Grading;
use super::lanczos::{Modes, ShiftInvert, lowest_modes};
use super::mesh::{self, Mesh, patch_then_graded};
use super::mirror::{HalfBody, Parity};
use super::patch::{half_space_flexibility, nodal_forces, point};
use super::{MeshOptions, check_patch};
use crate::body::ModalBody;
use crate::body::layer::Waves;
use crate::contact::{PatchFlexibility, PatchTable, RADII, TABULATED, WHOLE};
use crate::error::{Error, Result};
use crate::numerics::vectors::dot;
use crate::scene::{Edge, Plate};
use std::f64::consts::{PI, SQRT_2, TAU};
use std::rc::Rc;

/// Frequency of the mode that stands for all that are left out, over the lowest of theirs (see [`ContinuumPlate::modal_body_in_film`]).
const ATTACHED: f64 = 1.5;

/// Mode of the continuum plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateMode {
    /// Eigenfrequency in Hz; 0 = rigid motion.
    pub frequency: f64,
    /// Whether the axial displacement is antisymmetric about the mid-plane.
    pub longitudinal: bool,
}

/// Continuum plate seen from the contact points 0 (outer face, z = +t/2) and 1 (inner face), both at r = 0.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContinuumPlate {
    /// Elastic eigenfrequencies in rad/s, ascending, one more than asked for. Shape (n + 1).
    pub omega: Vec<f64>,
    /// Mass-normalised shapes weighted over patches of [`WEIGHTED`] times the patch radii, kg^(-1/2). Shape (n + 1, 2, 5).
    pub participation: Vec<[[f64; WEIGHTED.len()]; 2]>,
    /// Static flexibility of all elastic modes, without Hertz's half-spaces.
    pub flexibility: PatchTable,
    /// Radii of the patches in m: outer, inner face.
    pub patch_radius: [f64; 2],
    /// Mass of the plate in kg if it is free to move, otherwise `None`.
    pub free_mass: Option<f64>,
    /// Modal damping ratio.
    pub damping_ratio: f64,
    /// Degrees of freedom of the mesh (both parities).
    pub degrees_of_freedom: usize,
}

impl ContinuumPlate {
    /// Meshes the plate and finds `modes` elastic modes, the next one, and the flexibility, for contact patches
    /// of the radii `patch_radius` (outer, inner face) in m.
    ///
    /// # Errors
    /// [`Error::Solver`] if a patch radius is not below the plate's radius, the plate is so thin (t/R below about
    /// 0.002, for nearly incompressible materials 0.005) that rounding spoils it, or the numerics fail,
    /// [`Error::Usage`] for a mesh option out of bounds.
    pub fn new(plate: &Plate, patch_radius: [f64; 2], modes: usize, options: &MeshOptions) -> Result<Self> {
        options.check()?;
        for a in patch_radius {
            check_patch(a, 0.5 * plate.radius, "half the plate's radius")?;
        }
        let mesh = plate_mesh(plate, Some(patch_radius[0].min(patch_radius[1])), modes, options);
        let halves = Halves::new(plate, &mesh)?;
        let spectrum = halves.spectrum(modes + 1)?;
        let forces = patch_radius.map(|a| WEIGHTED.map(|r| nodal_forces(&mesh, r * a)));
        // of contact 0, between the contacts, of contact 1
        let mut flexibility = [0.0; 3];
        let mut result = Self {
            omega: Vec::new(),
            participation: Vec::new(),
            // how it changes with the patches
            flexibility: Waves::new(plate, WAVES).flexibility(patch_radius),
            patch_radius,
            free_mass: (plate.edge == Edge::Free).then(|| plate.mass()),
            damping_ratio: plate.damping_ratio,
            degrees_of_freedom: halves.degrees_of_freedom(),
        };
        for (parity, half) in halves.each() {
            let load = forces.each_ref().map(|forces| forces.each_ref().map(|f| half.axial_load(f)));
            for j in 0..2 {
                let mut displacement = load[j][WHOLE].clone();
                half.solve(&mut displacement);
                for i in 0..=j {
                    let half_sign = 0.5 * sign(parity, i) * sign(parity, j);
                    flexibility[i + j] += half_sign * dot(&load[i][WHOLE], &displacement);
                }
            }
            for entry in spectrum.iter().filter(|entry| entry.parity == parity) {
                let phi = |i: usize| {
                    load[i].each_ref().map(|load| sign(parity, i) * dot(load, &entry.shape) / SQRT_2)
                };
                result.omega.push(entry.omega);
                result.participation.push([phi(0), phi(1)]);
            }
        }
        let mut order: Vec<usize> = (0..result.omega.len()).collect();
        order.sort_by(|&i, &j| result.omega[i].total_cmp(&result.omega[j]));
        result.omega = order.iter().map(|&i| result.omega[i]).collect();
        result.participation = order.iter().map(|&i| result.participation[i]).collect();
        for (i, a) in patch_radius.into_iter().enumerate() {
            flexibility[2 * i] -= half_space_flexibility(&plate.material, a);
        }
        result.flexibility.shift_to(flexibility);
        Ok(result)
    }

    /// The body with its `modes` lowest elastic modes (at most as many as were asked for) and what they lack
    /// as residual. The rigid motion of a free plate comes before them as a mode of its own.
    ///
    /// A mode below `slow` rad/s moves by itself while the patches grow and shrink: it is weighted over the patches as they
    /// are at most, and its curvature is none of the residual's. A quicker one follows the forces and with them the
    /// patches: its curvature is the residual's, its weight that of a patch so wide that the residual stays positive
    /// definite.
    pub fn modal_body(&self, modes: usize, slow: f64) -> ModalBody {
        let (body, flexibility) = self.lowest(modes, slow);
        self.with_residual(body, flexibility)
    }

    /// The same for a film, which presses on the plate around the contact: of its `modes` the last one stands for all that are left
    /// out, as far as they bend the plate (a residual attachment mode: Rubin, AIAA Journal 13 (1975) 995).
    ///
    /// It has their flexibility between the faces, and of a frequency in which their inertia is right too: as the frequencies of a bending plate
    /// grow with the square of their number, that is 1.5 times the lowest of them.
    pub fn modal_body_in_film(&self, modes: usize, slow: f64) -> ModalBody {
        let real = modes.min(self.omega.len() - 1).saturating_sub(1);
        let (mut body, mut flexibility) = self.lowest(real, slow);
        let omega = ATTACHED * self.omega_next(real);
        let participation = omega * flexibility.mutual[WHOLE][WHOLE].max(0.0).sqrt();
        body.omega.push(omega);
        body.damping_ratio.push(self.damping_ratio);
        body.participation.push([participation; 2]);
        let share = -omega.powi(-2);
        flexibility.add(share, share, [[participation; TABULATED]; 2]);
        self.with_residual(body, flexibility)
    }

    fn with_residual(&self, body: ModalBody, flexibility: PatchTable) -> ModalBody {
        ModalBody { residual: Some(PatchFlexibility::through(&flexibility, self.patch_radius)), ..body }
    }

    /// The lowest `modes`, and the flexibility beyond them.
    fn lowest(&self, modes: usize, slow: f64) -> (ModalBody, PatchTable) {
        let modes = modes.min(self.omega.len() - 1);
        let mut flexibility = self.flexibility;
        let mut body = ModalBody {
            omega: Vec::with_capacity(modes + 1),
            damping_ratio: Vec::with_capacity(modes + 1),
            participation: Vec::with_capacity(modes + 1),
            residual: None,
        };
        if let Some(mass) = self.free_mass {
            body.omega.push(0.0);
            body.damping_ratio.push(0.0);
            body.participation.push([1.0 / mass.sqrt(); 2]);
        }
        for (&omega, phi) in self.omega.iter().zip(&self.participation).take(modes) {
            body.omega.push(omega);
            body.damping_ratio.push(self.damping_ratio);
            let moving = if omega < slow { WHOLE } else { WIDE };
            body.participation.push(phi.map(|phi| phi[moving]));
            let taken = phi.map(|phi| std::array::from_fn(|m| phi[if omega < slow { m } else { WIDE }]));
            let share = -omega.powi(-2);
            flexibility.add(share, share, taken);
        }
        (body, flexibility)
    }

    /// Frequency in rad/s of the lowest elastic mode that [`Self::modal_body`] leaves to the residual.
    ///
    /// The residual is static: a contact of frequency w sees it with a relative error of about
    /// (w / omega_next)^2.
    pub fn omega_next(&self, modes: usize) -> f64 {
        self.omega[modes.min(self.omega.len() - 1)]
    }
}

/// Continuum plate with `modes` elastic modes (and before them the rigid motion if the plate is free) and
/// residual flexibility; see [`ContinuumPlate`].
///
/// # Errors
/// As [`ContinuumPlate::new`].
pub fn plate(plate: &Plate, patch_radius: [f64; 2], modes: usize, mesh: &MeshOptions) -> Result<ModalBody> {
    Ok(ContinuumPlate::new(plate, patch_radius, modes, mesh)?.modal_body(modes, 0.0))
}

/// Mass-normalised displacements along z of the inner face at `radii` in m, in the modes of [`plate`] with the same
/// arguments, kg^(-1/2), up to their signs. Shape (modes, radii).
///
/// # Errors
/// As [`ContinuumPlate::new`].
pub fn face_shapes(
    plate: &Plate,
    patch_radius: [f64; 2],
    modes: usize,
    options: &MeshOptions,
    radii: &[f64],
) -> Result<Vec<Vec<f64>>> {
    let mesh = plate_mesh(plate, Some(patch_radius[0].min(patch_radius[1])), modes, options);
    let halves = Halves::new(plate, &mesh)?;
    let points: Vec<_> = radii.iter().map(|r| point(&mesh, *r)).collect();
    let mut shapes = Vec::new();
    if plate.edge == Edge::Free {
        shapes.push(vec![1.0 / plate.mass().sqrt(); radii.len()]);
    }
    for entry in halves.spectrum(modes + 1)?.iter().take(modes) {
        let half = if entry.parity == Parity::Bending { &halves.bending } else { &halves.longitudinal };
        let at = |nodal: &Vec<(usize, f64)>| dot(&half.axial_load(nodal), &entry.shape);
        shapes.push(points.iter().map(|nodal| sign(entry.parity, 1) * at(nodal) / SQRT_2).collect());
    }
    Ok(shapes)
}

/// The `count` lowest axisymmetric modes of the plate, the rigid motion of a free one included.
///
/// # Errors
/// [`Error::Solver`] if the numerics fail.
pub fn eigenfrequencies(plate: &Plate, count: usize) -> Result<Vec<PlateMode>> {
    let options = MeshOptions { order: 4, ..MeshOptions::default().refined(1.5) };
    let mesh = plate_mesh(plate, None, count, &options);
    let rigid = PlateMode { frequency: 0.0, longitudinal: false };
    let mut modes = vec![rigid; usize::from(plate.edge == Edge::Free).min(count)];
    modes.extend(Halves::new(plate, &mesh)?.spectrum(count - modes.len())?.iter().map(|entry| PlateMode {
        frequency: entry.omega / TAU,
        longitudinal: entry.parity == Parity::Longitudinal,
    }));
    Ok(modes)
}

/// Largest [`HalfBody::rounding_error`] that is accepted; what neighbouring meshes differ by is 3 to 10 times smaller.
const ROUNDING_LIMIT: f64 = 0.01;

/// Radii in patch radii over which shapes are weighted: the tabulated ones and a wide one. A punch as wide as the widest
/// patch of the table moves a wave as little as a Hertz pressure 1.3 times as wide does (sin(x)/x against 1 - x^2/10).
pub const WEIGHTED: [f64; TABULATED + 1] = [RADII[0], RADII[1], RADII[2], RADII[3], 2.0];
/// Index of the wide patch.
const WIDE: usize = TABULATED;
/// Waves of the layer that tells how the flexibility changes with the patches.
pub(super) const WAVES: usize = 32;

/// +1, or -1 for the inner face in longitudinal motion.
pub(super) fn sign(parity: Parity, point: usize) -> f64 {
    if parity == Parity::Longitudinal && point == 1 { -1.0 } else { 1.0 }
}

/// The two independent motions of the plate.
pub(super) struct Halves {
    bending: HalfBody,
    longitudinal: HalfBody,
}

/// Elastic mode of one parity; `shape` as in [`Modes`].
pub(super) struct SpectrumEntry {
    pub(super) omega: f64,
    pub(super) parity: Parity,
    pub(super) shape: Vec<f64>,
}

impl Halves {
    pub(super) fn new(plate: &Plate, mesh: &Mesh) -> Result<Self> {
        let matrices = Rc::new(Matrices::new(mesh, &plate.material)?);
        let fixed = match plate.edge {
            Edge::Clamped => [true, true],
            Edge::SimplySupported => [false, true],
            Edge::Free => [false, false],
        };
        let support = |[r, _]: [f64; 2]| {
            if r == mesh.radius { fixed } else { [false, false] }
        };
        let half = |parity| HalfBody::new(mesh, &matrices, parity, support, plate.edge == Edge::Free);
        Ok(Self { bending: half(Parity::Bending)?, longitudinal: half(Parity::Longitudinal)? })
    }

    /// Of both meshes.
    pub(super) fn degrees_of_freedom(&self) -> usize {
        self.bending.size() + self.longitudinal.size()
    }

    pub(super) fn each(&self) -> [(Parity, &HalfBody); 2] {
        [(Parity::Bending, &self.bending), (Parity::Longitudinal, &self.longitudinal)]
    }

    /// The `count` lowest elastic modes of both parities, ascending.
    pub(super) fn spectrum(&self, count: usize) -> Result<Vec<SpectrumEntry>> {
        let bending = self.bending_modes(count)?;
        let limit = bending.omega.last().copied().unwrap_or(0.0);
        let longitudinal = lowest_modes(&self.longitudinal, count, limit)?;
        let mut all = entries(bending, Parity::Bending);
        all.extend(entries(longitudinal, Parity::Longitudinal));
        all.sort_by(|a, b| a.omega.total_cmp(&b.omega));
        all.truncate(count);
        Ok(all)
    }

    /// The `count` lowest elastic modes of each parity, all bending first.
    pub(super) fn spectra(&self, count: usize) -> Result<Vec<SpectrumEntry>> {
        let mut all = entries(self.bending_modes(count)?, Parity::Bending);
        let longitudinal = lowest_modes(&self.longitudinal, count, f64::INFINITY)?;
        all.extend(entries(longitudinal, Parity::Longitudinal));
        Ok(all)
    }

    fn bending_modes(&self, count: usize) -> Result<Modes> {
        let bending = lowest_modes(&self.bending, count, f64::INFINITY)?;
        if let (Some(&first), Some(shape)) = (bending.omega.first(), bending.shape.first()) {
            let error = self.bending.rounding_error(first, shape);
            if error > ROUNDING_LIMIT {
                return Err(Error::Solver(format!(
                    "the continuum plate is too thin or too nearly incompressible for double precision: rounding may change its stiffness by {error:.1e}, the limit is {ROUNDING_LIMIT}; use model B"
                )));
            }
        }
        Ok(bending)
    }
}

fn entries(modes: Modes, parity: Parity) -> Vec<SpectrumEntry> {
    let entry = |(omega, shape)| SpectrumEntry { omega, parity, shape };
    modes.omega.into_iter().zip(modes.shape).map(entry).collect()
}

/// Mesh of the upper half, fine at the patch (if any) and at a held rim, and
/// fine enough everywhere for the `modes` lowest modes.
pub(super) fn plate_mesh(
    plate: &Plate,
    patch_radius: Option<f64>,
    modes: usize,
    options: &MeshOptions,
) -> Mesh {
    let half_thickness = 0.5 * plate.thickness;
    // Wave number of the highest mode: at most that of modes in one row along the longer
    // side, and of twice Weyl's count of modes over the section (wider rows, surface waves).
    let count = modes as f64 + 2.0;
    let row = PI * count / plate.radius.max(plate.thickness);
    let area = (8.0 * PI * (count + 2.0) / (plate.radius * plate.thickness)).sqrt();
    let wavelength = TAU / row.min(area);
    let wave_size = options.order as f64 * wavelength / options.nodes_per_wavelength;
    let largest = wave_size.min(plate.radius / 4.0);
    let thick = largest.min(half_thickness / options.thickness_elements);
    // The stress at the corners of a held rim is singular. A simply supported plate of nu near -1 bends into its first
    // shape for next to nothing, so that what the corners yield is a part of its flexibility that grows with 1/(1 + nu).
    let bending = (1.0 + plate.material.poisson_ratio) * (0.1 * plate.radius / plate.thickness).max(0.8);
    let rim_size = match plate.edge {
        Edge::Clamped => 0.25 * thick,
        Edge::SimplySupported => bending.min(0.25) * thick,
        Edge::Free => thick,
    };
    let size = patch_radius.map(|a| a / options.patch_elements);
    let radial_grading = |start: f64| Grading { start, end: rim_size, largest, growth: options.growth };
    let radial = match (patch_radius, size) {
        (Some(a), Some(size)) => patch_then_graded(a, plate.radius, size.min(largest), radial_grading),
        _ => radial_grading(largest).breakpoints(plate.radius),
    };
    let start = size.unwrap_or(f64::INFINITY).min(rim_size);
    let depth = Grading { start, end: f64::INFINITY, largest: thick, growth: options.depth_growth };
    mesh::plate(options.order, &radial, &depth.breakpoints(half_thickness))
}
