//! Thin circular plate (Kirchhoff): finite elements along the radius and their modes.
//!
//! Bending energy per D of w(r) cos(n phi): 1/2 integral of ((w'' + s)^2 - 2 (1 - nu) (w'' s - t^2)) r dr times 2 pi (n = 0) or pi,
//! with s = w'/r - n^2 w/r^2 and t = n (w'/r - w/r^2) (Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells, 1959, sections 59
//! and 64).
//! Elements are C1: Hermite cubics for deflection and slope at the nodes, and inside the element
//! twice integrated Legendre polynomials, which vanish with their slope at both ends.

use super::ModalBody;
use super::memo::MemoList;
use crate::analytical::circular_plate::rigidity;
use crate::error::Result;
use crate::numerics::eigenmodes::lowest;
use crate::scene::{Edge, Plate};
use faer::Mat;
use std::f64::consts::PI;
use std::sync::Arc;

/// Degree of the polynomials in an element.
const DEGREE: usize = 9;
/// Functions of an element: deflection and slope at both ends, then the inner ones.
const SHAPES: usize = DEGREE + 1;
/// Gauss points of an element; the integrands are smooth but, near the axis, rational in r.
const POINTS: usize = DEGREE + 4;

/// Modes of the plate of unit radius, rigidity and mass per area; they depend on the edge, nodal diameters and
/// Poisson's ratio only, so that a parameter study solves one eigenproblem for all its plates.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitPlate {
    edge: Edge,
    poisson_ratio: f64,
    /// Number n of nodal diameters.
    diameters: usize,
    /// omega of each mode, ascending; first 0 for a free plate.
    omega: Vec<f64>,
    /// Deflection of the centre in each mass-normalised mode.
    centre: Vec<f64>,
    /// Mass-normalised mode shapes in the free unknowns of the elements, with positive deflection of the centre.
    /// Shape (unknowns, modes).
    shapes: Mat<f64>,
    elements: usize,
}

impl UnitPlate {
    /// The lowest `modes` elastic modes without nodal diameters, and the rigid one if the edge is free.
    ///
    /// # Errors
    /// [`crate::Error::Internal`] if the eigenproblem does not converge.
    pub fn new(edge: Edge, poisson_ratio: f64, modes: usize) -> Result<Self> {
        Self::with_diameters(edge, poisson_ratio, modes, 0)
    }

    /// The lowest `modes` elastic modes with so many nodal `diameters`; a free edge has to have none.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn with_diameters(
        edge: Edge,
        poisson_ratio: f64,
        modes: usize,
        diameters: usize,
    ) -> Result<Self> {
        debug_assert!(diameters == 0 || edge != Edge::Free);
        // 4/3 half waves of the highest mode to an element of degree 9: shapes to 1e-8, frequencies beyond
        let elements = modes * 3 / 4 + 3;
        let (stiffness, mass) = assemble(edge, poisson_ratio, elements, diameters);
        // a free plate's stiffness is singular: shift by a part of its first elastic eigenvalue
        let shift = if edge == Edge::Free { 10.0 } else { 0.0 };
        let count = modes + usize::from(edge == Edge::Free);
        let (squares, shapes) = lowest(&stiffness, &mass, shift, count, "plate modes")?;
        let rigid = |mode: usize| edge == Edge::Free && mode == 0;
        let omega =
            squares.iter().enumerate().map(|(k, s)| if rigid(k) { 0.0 } else { s.max(0.0).sqrt() }).collect();
        // the deflection of the axis is the first unknown
        let mut shapes = Mat::from_fn(shapes.nrows(), count, |i, k| shapes[(i, k)] * shapes[(0, k)].signum());
        if rigid(0) {
            // exactly even: a film's momentum rests on it. Only the slope on the axis is held
            let even = |row: usize| row == 0 || (row + 1).is_multiple_of(PER_ELEMENT);
            (0..shapes.nrows())
                .for_each(|row| shapes[(row, 0)] = if even(row) { PI.sqrt().recip() } else { 0.0 });
        }
        let centre = (0..count).map(|k| if diameters == 0 { shapes[(0, k)] } else { 0.0 }).collect();
        Ok(Self { edge, poisson_ratio, diameters, omega, centre, shapes, elements })
    }

    /// Eigenfrequencies of the unit plate, k^2 of the closed form; first 0 for a free plate.
    pub fn omega(&self) -> &[f64] {
        &self.omega
    }

    /// Deflection of the centre in each mass-normalised mode.
    pub fn centre(&self) -> &[f64] {
        &self.centre
    }

    /// Deflection in every mass-normalised mode at the `radii`, 0 to 1, where cos(n phi) is 1. Shape (modes, radii).
    pub fn deflection(&self, radii: &[f64]) -> Vec<Vec<f64>> {
        self.derivative(0, radii)
    }

    /// Derivative of that `order`, at most 2, along the radius. Shape (modes, radii).
    fn derivative(&self, order: usize, radii: &[f64]) -> Vec<Vec<f64>> {
        let fixed = fixed_unknowns(self.edge, self.elements, self.diameters);
        let row = |unknown: usize| {
            (!fixed.contains(&unknown)).then(|| unknown - fixed.iter().filter(|f| **f < unknown).count())
        };
        let length = 1.0 / self.elements as f64;
        let at = |mode: usize, r: f64| -> f64 {
            let element = ((r / length) as usize).min(self.elements - 1);
            let shapes = shape_functions(2.0 * (r / length - element as f64) - 1.0, length);
            let value = |(i, shape): (usize, &[f64; 3])| {
                row(unknown(element, i)).map_or(0.0, |row| shape[order] * self.shapes[(row, mode)])
            };
            shapes.iter().enumerate().map(value).sum()
        };
        (0..self.omega.len()).map(|mode| radii.iter().map(|r| at(mode, *r)).collect()).collect()
    }

    /// Mass-normalised deflections of `plate` at `radii` in m, see [`shapes`].
    pub(super) fn shapes(&self, plate: &Plate, radii: &[f64]) -> Vec<Vec<f64>> {
        let unit: Vec<f64> = radii.iter().map(|r| r / plate.radius).collect();
        let amplitude = Self::amplitude(plate);
        let mut shapes = self.deflection(&unit);
        shapes.iter_mut().flatten().for_each(|value| *value *= amplitude);
        shapes
    }

    /// Their slopes along the radius, kg^(-1/2)/m. Shape (modes, radii).
    pub(super) fn slopes(&self, plate: &Plate, radii: &[f64]) -> Vec<Vec<f64>> {
        let unit: Vec<f64> = radii.iter().map(|r| r / plate.radius).collect();
        let amplitude = Self::amplitude(plate) / plate.radius;
        let mut slopes = self.derivative(1, &unit);
        slopes.iter_mut().flatten().for_each(|value| *value *= amplitude);
        slopes
    }

    /// Amplitude of a mass-normalised mode of `plate` per that of the unit plate.
    fn amplitude(plate: &Plate) -> f64 {
        1.0 / (plate.radius * (plate.material.density * plate.thickness).sqrt())
    }

    /// Angular frequency in rad/s of a mode of `plate` per that of the unit plate.
    pub(super) fn frequency(&self, plate: &Plate) -> f64 {
        let material = &plate.material;
        let mass_per_area = material.density * plate.thickness;
        let bending = rigidity(material.youngs_modulus, material.poisson_ratio, plate.thickness);
        (bending / mass_per_area).sqrt() / plate.radius.powi(2)
    }

    /// The modes in the terms of `plate`, which must have this edge and (about) this Poisson's ratio.
    pub fn scale(&self, plate: &Plate) -> ModalBody {
        debug_assert!(plate.edge == self.edge);
        let frequency = self.frequency(plate);
        let amplitude = Self::amplitude(plate);
        ModalBody {
            omega: self.omega.iter().map(|w| w * frequency).collect(),
            damping_ratio: vec![plate.damping_ratio; self.omega.len()],
            participation: self.centre.iter().map(|c| [c * amplitude; 2]).collect(),
            residual: None,
        }
    }
}

/// The lowest `modes` elastic modes of `plate` (and the rigid one of a free plate).
///
/// # Errors
/// As [`UnitPlate::new`].
pub fn modes(plate: &Plate, modes: usize) -> Result<ModalBody> {
    Ok(UnitPlate::new(plate.edge, plate.material.poisson_ratio, modes)?.scale(plate))
}

/// The unit plates that a series of impacts has needed so far; shared by its threads.
#[derive(Debug, Default)]
pub struct UnitPlates(MemoList<UnitPlate>);

impl UnitPlates {
    /// As [`modes`], without solving an eigenproblem again.
    ///
    /// # Errors
    /// As [`UnitPlate::new`].
    pub fn modes(&self, plate: &Plate, modes: usize) -> Result<ModalBody> {
        Ok(self.unit(plate.edge, plate.material.poisson_ratio, modes, 0)?.scale(plate))
    }

    /// As [`Self::modes`], of a plate whose Poisson's ratio may be another by 0.05 in its edge's moments, not in its rigidity.
    ///
    /// # Errors
    /// As [`UnitPlate::new`].
    pub(crate) fn initial_modes(&self, plate: &Plate, modes: usize) -> Result<ModalBody> {
        let poisson_ratio = (10.0 * plate.material.poisson_ratio).round().min(4.0) / 10.0;
        Ok(self.unit(plate.edge, poisson_ratio, modes, 0)?.scale(plate))
    }

    /// Mass-normalised deflections of `plate` at `radii` in m in its lowest `modes` elastic modes (and before them in the
    /// rigid one of a free plate), kg^(-1/2); positive at the centre, as in [`modes`]. Shape (modes, radii).
    ///
    /// # Errors
    /// As [`UnitPlate::new`].
    pub fn shapes(&self, plate: &Plate, modes: usize, radii: &[f64]) -> Result<Vec<Vec<f64>>> {
        Ok(self.unit(plate.edge, plate.material.poisson_ratio, modes, 0)?.shapes(plate, radii))
    }

    /// The unit plate with this edge and Poisson's ratio and the lowest `modes` elastic modes of so many nodal `diameters`.
    ///
    /// # Errors
    /// As [`UnitPlate::new`].
    pub(super) fn unit(
        &self,
        edge: Edge,
        poisson_ratio: f64,
        modes: usize,
        diameters: usize,
    ) -> Result<Arc<UnitPlate>> {
        let count = modes + usize::from(edge == Edge::Free);
        // the edge's moments do no work where it is clamped: the modes are those of any Poisson's ratio
        let poisson_ratio = if edge == Edge::Clamped { 0.3 } else { poisson_ratio };
        let fits = |unit: &UnitPlate| {
            unit.edge == edge
                && unit.poisson_ratio == poisson_ratio
                && unit.diameters == diameters
                && unit.omega.len() == count
        };
        self.0.find_or(fits, || UnitPlate::with_diameters(edge, poisson_ratio, modes, diameters))
    }
}

/// Unknowns of a node stand before those of the element outside it: w, w', inner ...
const PER_ELEMENT: usize = SHAPES - 2;

/// Unknown that belongs to a function of an element.
fn unknown(element: usize, shape: usize) -> usize {
    match shape {
        0 | 1 => element * PER_ELEMENT + shape,
        2 | 3 => (element + 1) * PER_ELEMENT + shape - 2,
        _ => element * PER_ELEMENT + shape - 2,
    }
}

/// Unknowns that smoothness at the axis and the edge hold at zero.
fn fixed_unknowns(edge: Edge, elements: usize, diameters: usize) -> Vec<usize> {
    let rim = elements * PER_ELEMENT;
    let mut fixed = match diameters {
        0 => vec![1],
        1 => vec![0],
        _ => vec![0, 1],
    };
    match edge {
        Edge::Clamped => fixed.extend([rim, rim + 1]),
        Edge::SimplySupported => fixed.push(rim),
        Edge::Free => {}
    }
    fixed
}

/// Stiffness and mass of the unit plate on `elements` equal elements for so many nodal `diameters`, constrained by smoothness at
/// the axis and by the edge. Without diameters the first unknown is the deflection of the axis.
fn assemble(edge: Edge, poisson_ratio: f64, elements: usize, diameters: usize) -> (Mat<f64>, Mat<f64>) {
    let (n, around) = (diameters as f64, if diameters == 0 { 2.0 * PI } else { PI });
    let total = elements * PER_ELEMENT + 2;
    let mut stiffness = Mat::<f64>::zeros(total, total);
    let mut mass = Mat::<f64>::zeros(total, total);
    let length = 1.0 / elements as f64;
    let (points, weights) = crate::numerics::quadrature::gauss_legendre(POINTS);
    for element in 0..elements {
        for (&xi, &weight) in points.iter().zip(&weights) {
            let r = (element as f64 + 0.5 * (xi + 1.0)) * length;
            let area = around * r * weight * 0.5 * length;
            let shapes = shape_functions(xi, length);
            for (i, a) in shapes.iter().enumerate() {
                for (j, b) in shapes.iter().enumerate() {
                    let across = |w: &[f64; 3]| w[1] / r - n * n * w[0] / (r * r);
                    let twist = |w: &[f64; 3]| n * (w[1] / r - w[0] / (r * r));
                    let (slope_a, slope_b) = (across(a), across(b));
                    let bending = (a[2] + slope_a) * (b[2] + slope_b)
                        - (1.0 - poisson_ratio) * (a[2] * slope_b + slope_a * b[2])
                        + 2.0 * (1.0 - poisson_ratio) * twist(a) * twist(b);
                    stiffness[(unknown(element, i), unknown(element, j))] += area * bending;
                    mass[(unknown(element, i), unknown(element, j))] += area * a[0] * b[0];
                }
            }
        }
    }
    let fixed = fixed_unknowns(edge, elements, diameters);
    let free: Vec<usize> = (0..total).filter(|i| !fixed.contains(i)).collect();
    let reduce = |full: &Mat<f64>| Mat::from_fn(free.len(), free.len(), |i, j| full[(free[i], free[j])]);
    (reduce(&stiffness), reduce(&mass))
}

/// Value, first and second derivative in r of the element's functions at xi in -1..1.
fn shape_functions(xi: f64, length: f64) -> [[f64; 3]; SHAPES] {
    let scale = 2.0 / length;
    let mut shapes = [[0.0; 3]; SHAPES];
    let (m, p) = (1.0 - xi, 1.0 + xi);
    let half = 0.5 * length;
    // value, d/dxi, d2/dxi2
    shapes[0] = [0.25 * m * m * (2.0 + xi), -0.75 * m * p, 1.5 * xi];
    shapes[1] =
        [0.25 * half * m * m * p, 0.25 * half * (-m) * (1.0 + 3.0 * xi), 0.25 * half * (6.0 * xi - 2.0)];
    shapes[2] = [0.25 * p * p * (2.0 - xi), 0.75 * m * p, -1.5 * xi];
    shapes[3] =
        [-0.25 * half * p * p * m, 0.25 * half * (-p) * (1.0 - 3.0 * xi), 0.25 * half * (6.0 * xi + 2.0)];
    let legendre = legendre(xi);
    let once = |j: usize| (legendre[j + 1] - legendre[j - 1]) / (2 * j + 1) as f64;
    for (shape, j) in shapes[4..].iter_mut().zip(2..) {
        *shape = [(once(j + 1) - once(j - 1)) / (2 * j + 1) as f64, once(j), legendre[j]];
    }
    shapes.map(|[value, first, second]| [value, first * scale, second * scale * scale])
}

/// Legendre polynomials P_0 to P_(DEGREE) at xi.
fn legendre(xi: f64) -> [f64; DEGREE + 1] {
    let mut p = [1.0; DEGREE + 1];
    p[1] = xi;
    for n in 1..DEGREE {
        p[n + 1] = ((2 * n + 1) as f64 * xi * p[n] - n as f64 * p[n - 1]) / (n + 1) as f64;
    }
    p
}
