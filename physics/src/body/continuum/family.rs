//! Plates and spheres between shapes: what [`super::unit`] has of one shape, as polynomials of thickness and Poisson's ratio.
//!
//! Frequencies, shapes and flexibilities are analytic in both, mode by mode of one parity: those of different parity cross without
//! knowing of each other and are sorted afterwards. Where modes of one parity avoid each other the polynomials are not good
//! enough: from the frequency on at which the plate's thickness is half a shear wave, bending modes meet those that shear the
//! thickness, within every range of some width. Families end there; every one is tried between its nodes.

use super::patch::half_space_flexibility;
use super::plate::ContinuumPlate;
use super::unit::{MeshedPlate, UnitSphere, patches, widest_patch};
use crate::contact::WHOLE;
use crate::error::Result;
use crate::numerics::chebyshev::{Chebyshev, blend};
use crate::numerics::vectors::dot;
use crate::scene::{Edge, Material, Plate};
use std::f64::consts::PI;

/// Nodes over the logarithm of the thickness and over Poisson's ratio: first few, then more if those are not good enough.
pub(super) const NODES: [[usize; 2]; 2] = [[4, 3], [6, 4]];
/// Places at which a family is tried, in -1..1 of both ranges: between the nodes, and at the ends, where polynomials are worst.
const TRIED: [[f64; 2]; 2] = [[0.0, 0.5], [1.0, 1.0]];
/// Patch over the thickness at which it is tried.
const TRIED_PATCH: f64 = 0.3;
/// Nodes of spheres over Poisson's ratio.
const SPHERE_RATIOS: usize = 4;
/// Error that it may have there: of frequencies, of shapes over the largest, of flexibilities over the half-space's.
const ENOUGH: f64 = 1e-4;
/// Error beyond which more nodes are of no use: modes of one parity avoid each other.
const HOPELESS: f64 = 1e-2;

/// Plates of one edge within a range of thicknesses over radii and one of Poisson's ratios.
#[derive(Debug)]
pub(super) struct PlateFamily {
    /// Of the logarithm.
    thicknesses: Chebyshev,
    poisson_ratios: Chebyshev,
    /// Shape (thicknesses, Poisson's ratios).
    plates: Vec<MeshedPlate>,
    /// Widest patch over the thickness.
    widest: f64,
}

/// Chebyshev's points in a range, one if it is a single value.
fn nodes([from, to]: [f64; 2], count: usize) -> Chebyshev {
    Chebyshev::new(from, to, if from < to { count } else { 1 })
}

impl PlateFamily {
    /// With `modes` elastic modes; `None` if the polynomials are not good enough.
    pub(super) fn new(
        edge: Edge,
        thickness: [f64; 2],
        poisson_ratio: [f64; 2],
        modes: usize,
    ) -> Result<Option<Self>> {
        let widest = widest_patch(thickness[1]);
        let at = |[from, to]: [f64; 2], s: f64| 0.5 * ((1.0 - s) * from + (1.0 + s) * to);
        let exact = |[s, r]: [f64; 2]| {
            let (t, nu) = (at(thickness.map(f64::ln), s).exp(), at(poisson_ratio, r));
            MeshedPlate::new(edge, nu, t, modes, widest)
        };
        let [between, end] = TRIED;
        let thickest = exact(end)?;
        if thickest.reaches_shear() {
            return Ok(None);
        }
        let tried = [exact(between)?, thickest];
        for counts in NODES {
            let family = Self::through(edge, (thickness, poisson_ratio), counts, modes)?;
            let miss =
                |exact: &MeshedPlate| family.at(exact.thickness, exact.poisson_ratio).largest_miss(exact);
            let worst = tried.iter().map(|exact| miss(exact).unwrap_or(f64::INFINITY)).fold(0.0, f64::max);
            if worst <= ENOUGH {
                return Ok(Some(family));
            }
            if worst > HOPELESS {
                break;
            }
        }
        Ok(None)
    }

    /// Through so many nodes over the ranges of both.
    fn through(
        edge: Edge,
        (thickness, poisson_ratio): ([f64; 2], [f64; 2]),
        counts: [usize; 2],
        modes: usize,
    ) -> Result<Self> {
        let mut family = Self {
            thicknesses: nodes(thickness.map(f64::ln), counts[0]),
            poisson_ratios: nodes(poisson_ratio, counts[1]),
            plates: Vec::new(),
            widest: widest_patch(thickness[1]),
        };
        for x in &family.thicknesses.nodes {
            for nu in &family.poisson_ratios.nodes {
                let mut plate = MeshedPlate::new(edge, *nu, x.exp(), modes, family.widest)?;
                if let Some(before) = family.plates.last() {
                    align(&mut plate, before);
                }
                family.plates.push(plate);
            }
        }
        Ok(family)
    }

    /// The plate of `thickness` radii.
    pub(super) fn at(&self, thickness: f64, poisson_ratio: f64) -> MeshedPlate {
        let first = &self.plates[0];
        let (by_thickness, by_ratio) =
            (self.thicknesses.weights(thickness.ln()), self.poisson_ratios.weights(poisson_ratio));
        let pairs = |values: &[f64]| -> Vec<f64> {
            values.iter().flat_map(|value| by_ratio.iter().map(move |w| value * w)).collect()
        };
        let weights = pairs(&by_thickness);
        // What is interpolated hardly changes: the speed of bending waves is taken out of the frequencies, the mass out of the
        // shapes, and what yields beyond the lowest modes goes with a power of the thickness between bending's 3 and a half-space's 1.
        let scaled = |power: i32, stiffening: f64| -> Vec<f64> {
            let stiffness = |nu: f64| (1.0 - nu * nu).powf(stiffening);
            let of = |plate: &MeshedPlate| {
                (thickness / plate.thickness).powi(power) * stiffness(plate.poisson_ratio)
                    / stiffness(poisson_ratio)
            };
            self.plates.iter().zip(&weights).map(|(plate, weight)| weight * of(plate)).collect()
        };
        let (of_speeds, of_flexibilities) = (scaled(1, 0.5), scaled(-2, 0.0));
        let of_shapes: Vec<f64> = self
            .plates
            .iter()
            .zip(&weights)
            .map(|(plate, w)| w * (plate.thickness / thickness).sqrt())
            .collect();
        let own = |m: usize| blend(&of_flexibilities, self.plates.iter().map(|plate| &plate.own[m]));
        let mutual = |m: usize| {
            let row =
                |i: usize| blend(&of_flexibilities, self.plates.iter().map(|plate| &plate.mutual[m][i]));
            (0..first.patches.nodes.len()).map(row).collect()
        };
        let shape = |k: usize| blend(&of_shapes, self.plates.iter().map(|plate| &plate.shapes[k]));
        MeshedPlate {
            edge: first.edge,
            poisson_ratio,
            thickness,
            modes: first.modes,
            patches: patches(self.widest * thickness),
            omega: blend(&of_speeds, self.plates.iter().map(|plate| &plate.omega)),
            shapes: (0..first.shapes.len()).map(shape).collect(),
            own: [own(0), own(1)],
            mutual: [mutual(0), mutual(1)],
            degrees_of_freedom: first.degrees_of_freedom,
        }
    }
}

/// Gives the shapes of `plate` the signs they have in `neighbour`.
fn align(plate: &mut MeshedPlate, neighbour: &MeshedPlate) {
    for (shape, known) in plate.shapes.iter_mut().zip(&neighbour.shapes) {
        if dot(shape, known) < 0.0 {
            shape.iter_mut().for_each(|value| *value = -*value);
        }
    }
}

impl MeshedPlate {
    /// Whether its modes go beyond the lowest frequency at which its thickness shears, pi c/t with the speed c of shear waves
    /// (Mindlin, J. Appl. Mech. 18, 1951, 31): families up to 0.95 of it were found good enough, and none from 1.05 on.
    fn reaches_shear(&self) -> bool {
        let mut omega = self.omega.clone();
        omega.sort_by(f64::total_cmp);
        let shear = (0.5 / (1.0 + self.poisson_ratio)).sqrt();
        omega[self.modes] > PI * shear / self.thickness
    }

    /// What it differs by from `exact`, the largest of [`misses`]; `None` if patches as they are tried are too wide for either.
    fn largest_miss(&self, exact: &Self) -> Option<f64> {
        let material = Material::elastic("unit", 1.0, exact.poisson_ratio, 1.0);
        let (radius, thickness) = (1.0, exact.thickness);
        let patch = TRIED_PATCH.min(0.25 / thickness) * thickness;
        let half_space = half_space_flexibility(&material, patch);
        let plate = Plate { radius, thickness, edge: exact.edge, material, damping_ratio: 0.0 };
        let [ours, theirs] = [self.scaled(&plate, [patch; 2])?, exact.scaled(&plate, [patch; 2])?];
        Some(misses(&ours, &theirs, half_space).into_iter().fold(0.0, f64::max))
    }
}

/// What `of` differs from `exact` by: flexibilities beyond the modes over the half-space's, frequencies, shapes over the largest.
pub(super) fn misses(of: &ContinuumPlate, exact: &ContinuumPlate, half_space: f64) -> [f64; 3] {
    let tables = |plate: &ContinuumPlate| {
        let mut table = plate.flexibility;
        for (omega, phi) in plate.omega.iter().zip(&plate.participation) {
            let share = -omega.powi(-2);
            table.add(share, share, phi.map(|phi| std::array::from_fn(|m| phi[m])));
        }
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
    let frequencies = of.omega.iter().zip(&exact.omega).fold(0.0_f64, |m, (a, b)| m.max((a / b - 1.0).abs()));
    let flexibility = largest(&tables(of), &tables(exact)) / half_space;
    [flexibility, frequencies, largest(&shapes(of), &shapes(exact)) / scale]
}

/// Spheres within a range of Poisson's ratios.
#[derive(Debug)]
pub(super) struct SphereFamily {
    poisson_ratios: Chebyshev,
    spheres: Vec<UnitSphere>,
}

impl SphereFamily {
    pub(super) fn new(poisson_ratio: [f64; 2]) -> Result<Self> {
        let poisson_ratios = nodes(poisson_ratio, SPHERE_RATIOS);
        let spheres = poisson_ratios.nodes.iter().map(|nu| UnitSphere::new(*nu)).collect::<Result<_>>()?;
        Ok(Self { poisson_ratios, spheres })
    }

    /// The sphere of this Poisson's ratio.
    pub(super) fn at(&self, poisson_ratio: f64) -> UnitSphere {
        let weights = self.poisson_ratios.weights(poisson_ratio);
        UnitSphere {
            poisson_ratio,
            patches: self.spheres[0].patches.clone(),
            residual: blend(&weights, self.spheres.iter().map(|sphere| &sphere.residual)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between its nodes, and at the ends, a family is as near to a plate of that shape as neighbouring meshes are to each other.
    #[test]
    fn a_plate_between_shapes_is_that_of_its_shape() {
        let (thickness, ratio, modes) = ([0.045, 0.079], [0.25, 0.35], 8);
        let family = PlateFamily::new(Edge::Clamped, thickness, ratio, modes).unwrap().expect("good enough");
        for (t, nu) in [(0.045, 0.35), (0.052, 0.27), (0.067, 0.31)] {
            let exact = MeshedPlate::new(Edge::Clamped, nu, t, modes, family.widest).unwrap();
            let miss = family.at(t, nu).largest_miss(&exact).unwrap();
            assert!(miss < 2.0 * ENOUGH, "{t} {nu}: {miss:e}");
        }
    }

    /// Modes of one parity avoid each other within the range: of thick plates, and of others if there are many of them. That is told
    /// by one plate: where it is, the polynomials do fail, and the largest number that a range is known to bear is not refused.
    #[test]
    fn a_range_in_which_modes_avoid_each_other_is_an_error() {
        let ratio = [0.3; 2];
        for (edge, range, modes) in [(Edge::Free, [0.6, 1.1], 12), (Edge::Clamped, [0.05, 0.08], 24)] {
            let widest = widest_patch(range[1]);
            let exact = |t: f64| MeshedPlate::new(edge, ratio[0], t, modes, widest).unwrap();
            assert!(exact(range[1]).reaches_shear(), "{edge:?} {range:?} {modes}");
            assert!(PlateFamily::new(edge, range, ratio, modes).unwrap().is_none());
            let family = PlateFamily::through(edge, (range, ratio), NODES[1], modes).unwrap();
            let middle = (range[0] * range[1]).sqrt();
            let miss = [middle, range[1]].map(|t| family.at(t, ratio[0]).largest_miss(&exact(t)).unwrap());
            assert!(miss[0].max(miss[1]) > ENOUGH, "{edge:?} {range:?} {modes}: {miss:?}");
        }
        assert!(PlateFamily::new(Edge::Clamped, [0.05, 0.08], ratio, 20).unwrap().is_some());
    }
}
