//! Circular plate whose faces are pushed along themselves at the centre: motion with one nodal diameter.
//!
//! With the angle t from the direction of the force the displacements are u_r = (s + d/2) cos t, u_t = (d/2 - s) sin t and
//! u_z = w cos t. In these components only d and w are divided by r in the strains, and both vanish on the axis (Wilson, AIAA J. 3 (1965)
//! 2269, has the strains); the surface at the centre moves by s. Each parity about the mid-plane (see [`super::mirror`]) is one problem:
//! bending turns the plate's normal, so that the faces move against each other; in the other one they move together.
//!
//! Ritz vectors are those of Krylov's sequence from the static displacement on: its flexibility is exact, and high modes that the
//! force does not excite are left out (Wilson, Yuan and Dickens, Earthquake Eng. Struct. Dyn. 10 (1982) 813).

use super::MeshOptions;
use super::basis::{QuadraturePoint, tabulate};
use super::mesh::Mesh;
use super::patch::{half_space_flexibility_along, nodal_forces};
use super::plate::plate_mesh;
use crate::error::{Error, Result};
use crate::numerics::eigenmodes::symmetric;
use crate::numerics::vectors::{axpy, dot};
use crate::scene::{Edge, Material, Plate};
use faer::linalg::solvers::Solve;
use faer::mat::MatMut;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use faer::{ColRef, Mat, Side};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Radius of the patch that is pushed, over the thickness. What a plate gives way beyond a half-space hardly depends on it, and wide contacts
/// come no nearer to finite elements with their own patch.
const PATCH: f64 = 0.1;
/// Ritz vectors of each parity.
const VECTORS: usize = 6;
/// Displacement components of a node: s, d, w.
const COMPONENTS: usize = 3;

/// Modes by which a plate's faces move along themselves at its centre, beyond what half-spaces give way there: that is part of the contacts.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ModesAlong {
    /// Angular frequencies in rad/s. Shape (n).
    pub omega: Vec<f64>,
    /// Mass-normalised displacements of outer and inner face in the direction of the force, kg^(-1/2). Shape (n, 2).
    pub along: Vec<[f64; 2]>,
}

impl ModesAlong {
    /// Of `plate`, clamped or simply supported. The latter support leaves the motion of both faces together free: that is left out.
    ///
    /// # Errors
    /// [`Error::Solver`] if the plate is too thin for double precision, or the numerics fail.
    pub fn new(plate: &Plate, options: &MeshOptions) -> Result<Self> {
        Self::pushed_over(PATCH * plate.thickness, plate, options)
    }

    /// The same with a force over a patch of the radius `patch` m.
    fn pushed_over(patch: f64, plate: &Plate, options: &MeshOptions) -> Result<Self> {
        let mesh = plate_mesh(plate, Some(patch), 1, options);
        // half of it in each parity
        let local = 0.5 * half_space_flexibility_along(&plate.material, patch);
        let mut found = Self::default();
        for together in [false, true].into_iter().filter(|together| !together || plate.edge == Edge::Clamped)
        {
            let half = HalfPlate::new(plate, &mesh, patch, together)?;
            let (omega, mut along) = half.ritz()?;
            take_out(local, &omega, &mut along);
            let sign = if together { 1.0 } else { -1.0 };
            for (omega, along) in omega.into_iter().zip(along).filter(|(_, along)| *along != 0.0) {
                found.omega.push(omega);
                found.along.push([along, sign * along]);
            }
        }
        Ok(found)
    }
}

/// Takes the flexibility `local` in m/N out of modes, from the highest on; of what is stiffer than that nothing is left.
fn take_out(mut local: f64, omega: &[f64], along: &mut [f64]) {
    for (omega, along) in omega.iter().zip(along).rev() {
        let own = (*along / omega).powi(2);
        *along *= (1.0 - local / own).max(0.0).sqrt();
        local = (local - own).max(0.0);
    }
}

/// Upper half of the plate for one parity.
struct HalfPlate {
    stiffness: Llt<usize, f64>,
    mass: SparseColMat<usize, f64>,
    /// Of a unit force along the face. Shape (n).
    load: Vec<f64>,
}

impl HalfPlate {
    /// Of `mesh`, whose faces move `together` or against each other.
    fn new(plate: &Plate, mesh: &Mesh, patch: f64, together: bool) -> Result<Self> {
        let mut size = 0;
        let number = |held: bool, size: &mut usize| {
            *size += usize::from(!held);
            (!held).then(|| *size - 1)
        };
        let numbers = |[r, z]: &[f64; 2], size: &mut usize| -> [Option<usize>; COMPONENTS] {
            let [axis, mirror, rim] = [*r == 0.0, *z == 0.0, *r == mesh.radius];
            let in_plane = mirror && !together || rim && plate.edge == Edge::Clamped;
            let across = mirror && together || rim && plate.edge != Edge::Free;
            [in_plane, in_plane || axis, across || axis].map(|held| number(held, size))
        };
        let dof: Vec<_> = mesh.nodes.iter().map(|node| numbers(node, &mut size)).collect();
        let (mut stiffness, mut mass) = (Vec::new(), Vec::new());
        let quadrature = tabulate(mesh.order);
        for nodes in &mesh.elements {
            let coordinates: Vec<[f64; 2]> = nodes.iter().map(|&node| mesh.nodes[node]).collect();
            let numbers: Vec<Option<usize>> = nodes.iter().flat_map(|&node| dof[node]).collect();
            let [k, m] = element(&coordinates, &quadrature, &plate.material);
            for (a, row) in numbers.iter().enumerate() {
                for (b, column) in numbers.iter().enumerate() {
                    let (Some(row), Some(column)) = (*row, *column) else { continue };
                    if row >= column {
                        stiffness.push(Triplet::new(row, column, k[(a, b)]));
                    }
                    mass.push(Triplet::new(row, column, m[(a, b)]));
                }
            }
        }
        let assembled = |entries: &[Triplet<usize, usize, f64>]| {
            SparseColMat::try_new_from_triplets(size, size, entries).map_err(|e| {
                Error::Internal(format!("assembling a plate that is pushed along itself: {e:?}"))
            })
        };
        let (stiffness, mass) = (assembled(&stiffness)?, assembled(&mass)?);
        let symbolic = SymbolicLlt::try_new(stiffness.symbolic(), Side::Lower)
            .map_err(|e| Error::Internal(format!("ordering a plate that is pushed along itself: {e:?}")))?;
        let stiffness =
            Llt::try_new_with_symbolic(symbolic, stiffness.as_ref(), Side::Lower).map_err(|e| {
                Error::Solver(format!(
                    "the stiffness of the plate along its faces ({size} degrees of freedom) is not positive definite ({e:?}): it is too thin or too nearly incompressible for double precision"
                ))
            })?;
        let mut load = vec![0.0; size];
        for (node, force) in nodal_forces(mesh, patch) {
            if let Some(s) = dof[node][0] {
                load[s] += force;
            }
        }
        Ok(Self { stiffness, mass, load })
    }

    /// Ritz frequencies in rad/s, ascending, and displacements of the face per unit of the whole plate's mode, kg^(-1/2).
    fn ritz(&self) -> Result<(Vec<f64>, Vec<f64>)> {
        let size = self.load.len();
        // mass-normalised vectors, and stiffness and mass times them
        let [mut basis, mut forces, mut momenta] = [const { Vec::<Vec<f64>>::new() }; 3];
        let mut force = self.load.clone();
        for _ in 0..VECTORS {
            let mut vector = force.clone();
            self.stiffness.solve_in_place(MatMut::from_column_major_slice_mut(&mut vector, size, 1));
            // twice is enough (Parlett, 6.9)
            for _ in 0..2 {
                for k in 0..basis.len() {
                    let share = -dot(&momenta[k], &vector);
                    axpy(share, &basis[k], &mut vector);
                    axpy(share, &forces[k], &mut force);
                }
            }
            let momentum: Vec<f64> = (&self.mass * ColRef::from_slice(&vector)).iter().copied().collect();
            let scale = dot(&vector, &momentum).sqrt().recip();
            let scaled =
                |values: Vec<f64>| values.into_iter().map(|value| scale * value).collect::<Vec<f64>>();
            basis.push(scaled(vector));
            forces.push(scaled(force));
            momenta.push(scaled(momentum));
            force = momenta[momenta.len() - 1].clone();
        }
        let projected = Mat::from_fn(VECTORS, VECTORS, |i, j| {
            0.5 * (dot(&basis[i], &forces[j]) + dot(&basis[j], &forces[i]))
        });
        let (squares, vectors) = symmetric(&projected)
            .ok_or_else(|| Error::Internal("modes of a plate that is pushed along itself".into()))?;
        let moved: Vec<f64> = basis.iter().map(|vector| dot(vector, &self.load)).collect();
        // a mode of the half has twice the norm on the whole plate
        let along =
            |mode: usize| FRAC_1_SQRT_2 * (0..VECTORS).map(|k| moved[k] * vectors[(k, mode)]).sum::<f64>();
        Ok((squares.iter().map(|square| square.sqrt()).collect(), (0..VECTORS).map(along).collect()))
    }
}

/// Stiffness and mass of the element with the node coordinates `nodes` (r, z) in m over components (s, d, w) of each node.
fn element(nodes: &[[f64; 2]], quadrature: &[QuadraturePoint], material: &Material) -> [Mat<f64>; 2] {
    let shear = material.shear_modulus();
    let nu = material.poisson_ratio;
    let lambda = 2.0 * shear * nu / (1.0 - 2.0 * nu);
    let size = COMPONENTS * nodes.len();
    let mut matrices = [Mat::zeros(size, size), Mat::zeros(size, size)];
    for point in quadrature {
        let at =
            |values: &[f64], c: usize| -> f64 { values.iter().zip(nodes).map(|(v, node)| v * node[c]).sum() };
        let r = at(&point.value, 0);
        let [[r_xi, r_eta], [z_xi, z_eta]] = [0, 1].map(|c| [at(&point.d_xi, c), at(&point.d_eta, c)]);
        let determinant = r_xi * z_eta - r_eta * z_xi;
        // the integral of cos^2 t or sin^2 t over the circle
        let weight = point.weight * determinant * PI * r;
        // strains rr, tt, zz, rz, rt, tz of each component
        let strains: Vec<[f64; 6]> = (0..nodes.len())
            .flat_map(|a| {
                let dr = (point.d_xi[a] * z_eta - point.d_eta[a] * z_xi) / determinant;
                let dz = (point.d_eta[a] * r_xi - point.d_xi[a] * r_eta) / determinant;
                let hoop = point.value[a] / r;
                [
                    [dr, 0.0, 0.0, dz, -dr, -dz],
                    [0.5 * dr, hoop, 0.0, 0.5 * dz, 0.5 * dr - hoop, 0.5 * dz],
                    [0.0, 0.0, dz, dr, 0.0, -hoop],
                ]
            })
            .collect();
        // u_r^2 + u_t^2 + u_z^2 = 2 s^2 + d^2/2 + w^2
        let inertia = [2.0, 0.5, 1.0].map(|share| share * weight * material.density);
        for (a, of_a) in strains.iter().enumerate() {
            let volume = lambda * (of_a[0] + of_a[1] + of_a[2]);
            for (b, of_b) in strains.iter().enumerate() {
                let normal: f64 = (0..3).map(|k| (volume + 2.0 * shear * of_a[k]) * of_b[k]).sum();
                let sheared: f64 = (3..6).map(|k| shear * of_a[k] * of_b[k]).sum();
                matrices[0][(a, b)] += weight * (normal + sheared);
                if a % COMPONENTS == b % COMPONENTS {
                    let values = point.value[a / COMPONENTS] * point.value[b / COMPONENTS];
                    matrices[1][(a, b)] += inertia[a % COMPONENTS] * values;
                }
            }
        }
    }
    matrices
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::kirchhoff::UnitPlate;
    use crate::body::kirchhoff::UnitPlates;
    use crate::body::off_centre;
    use approx::assert_relative_eq;

    fn plate(edge: Edge, thickness: f64) -> Plate {
        let material = Material::elastic("steel", 210e9, 0.3, 7780.0);
        Plate { radius: 16e-3, thickness, edge, material, damping_ratio: 0.0 }
    }

    fn flexibilities(modes: &ModesAlong) -> [f64; 2] {
        let sum = |i: usize| {
            let each = modes.omega.iter().zip(&modes.along);
            each.map(|(omega, along)| along[0] * along[i] / omega.powi(2)).sum()
        };
        [sum(0), sum(1)]
    }

    /// Leissa, table 2.1, and Leissa & Narita, J. Sound Vib. 70 (1980) 221: squares of the wave numbers with one nodal diameter.
    #[test]
    fn thin_plates_have_leissa_s_frequencies_with_one_nodal_diameter() {
        for (edge, table) in [(Edge::Clamped, [21.26, 60.82]), (Edge::SimplySupported, [13.898, 48.479])] {
            let plate = plate(edge, 0.08e-3);
            let found = ModesAlong::new(&plate, &MeshOptions::default()).expect("modes");
            let unit = UnitPlate::new(edge, 0.3, 1).expect("a mode").frequency(&plate);
            for (omega, expected) in found.omega.iter().zip(table) {
                assert_relative_eq!(omega / unit, expected, max_relative = 1e-3);
            }
            // bending moves the faces against each other
            assert!(found.along.iter().take(2).all(|[outer, inner]| *outer == -inner));
        }
    }

    /// In their own plane both faces of a thin plate move together, as in plane stress: a disc of the radius R, held at its rim, gives way to
    /// forces over circles of the radii a and b by (3 - nu)(1 + nu)/(8 pi E t) 2 ln(b/a) less under the wider one, if both are small
    /// (Kelvin's solution in plane stress: Timoshenko & Goodier 1970, article 42).
    #[test]
    fn a_thin_plate_gives_way_in_its_plane_as_in_plane_stress() {
        let plate = plate(Edge::Clamped, 0.1e-3);
        let together = |patch: f64| {
            let mesh = plate_mesh(&plate, Some(patch), 1, &MeshOptions::default());
            let half = HalfPlate::new(&plate, &mesh, patch, true).expect("a plate");
            let (omega, along) = half.ritz().expect("modes");
            omega.iter().zip(along).map(|(omega, along)| (along / omega).powi(2)).sum::<f64>()
        };
        // many thicknesses, few of the radius
        let found = together(0.5e-3) - together(1.5e-3);
        let nu = plate.material.poisson_ratio;
        let unit = (3.0 - nu) * (1.0 + nu) / (4.0 * PI * plate.material.youngs_modulus * plate.thickness);
        // on the upper face half of the force acts on the lower half: it moves alike
        assert_relative_eq!(found, unit * 3.0_f64.ln(), max_relative = 0.02);
    }

    /// Neither a finer mesh nor a smaller patch changes what the plate gives way beyond a half-space; it may be a tenth of that.
    #[test]
    fn the_flexibility_beyond_a_half_space_depends_on_neither_mesh_nor_patch() {
        for thickness in [0.5e-3, 2e-3] {
            let plate = plate(Edge::Clamped, thickness);
            let mesh = MeshOptions::default();
            let found = flexibilities(&ModesAlong::new(&plate, &mesh).expect("modes"));
            let finer = ModesAlong::new(&plate, &mesh.refined(2.0)).expect("modes");
            let smaller = ModesAlong::pushed_over(0.05 * thickness, &plate, &mesh).expect("modes");
            for other in [finer, smaller].map(|modes| flexibilities(&modes)) {
                (0..2).for_each(|i| assert_relative_eq!(found[i], other[i], max_relative = 0.02));
            }
        }
    }

    /// The long waves that models A and B take give way against each other about as the continuum does; of a thick plate nothing is left.
    #[test]
    fn kirchhoff_s_long_waves_turn_the_normal_as_much() {
        for thickness in [0.25e-3, 0.5e-3, 1e-3, 2e-3] {
            let plate = plate(Edge::Clamped, thickness);
            let found = ModesAlong::new(&plate, &MeshOptions::default()).expect("modes");
            let thin = off_centre::modes_along(&plate, &UnitPlates::default()).expect("modes");
            let [own, mutual] = flexibilities(&found);
            let [bending, _] = flexibilities(&thin);
            assert_relative_eq!(bending, 0.5 * (own - mutual), max_relative = 0.15);
        }
        let thick = ModesAlong::new(&plate(Edge::Clamped, 8e-3), &MeshOptions::default()).expect("modes");
        assert!(thick.omega.is_empty());
    }
}
