//! Thin circular plate (Kirchhoff) that is struck off its centre: modes with nodal diameters, too.

use super::ModalBody;
use super::continuum::ModesAlong;
use super::kirchhoff::UnitPlates;
use crate::analytical::circular_plate::rigidity;
use crate::error::Result;
use crate::numerics::quadrature::gauss_legendre;
use crate::scene::Plate;
use std::f64::consts::PI;

/// Wave number by which the edge raises the modes, and some more.
const EDGE: f64 = 6.0;
/// Wave number times thickness up to which waves turn the normal under a force along the face more than a half-space does: measured on
/// continuum plates ([`ModesAlong::new`]); and how many of them count at most, in plates thinner than a hundredth of their radius.
const SHORTEST_WAVE: f64 = 0.7;
const MOST_WAVES: usize = 24;
/// Points of the quadrature over the waves left out.
const QUADRATURE: usize = 64;

/// Modes of a plate that is struck off-centre.
#[derive(Debug, Clone)]
pub struct OffCentreModes {
    /// The inner body faces the centre, which modes with nodal diameters leave at rest.
    pub body: ModalBody,
    /// Displacements of the faces along x, along which the outer body strikes off-centre, at the outer and the inner contact:
    /// the plate's normal turns. kg^(-1/2). Shape (n, 2).
    pub along: Vec<[f64; 2]>,
}

/// The lowest `modes` modes of `plate`, clamped or simply supported, that move the point at `offset` in m from its centre, where the
/// outer body strikes, from `plates` as far as they are known.
///
/// # Errors
/// As [`UnitPlates::modes`].
pub fn modes(plate: &Plate, offset: f64, modes: usize, plates: &UnitPlates) -> Result<OffCentreModes> {
    // x^2/8 modes lie below the wave number x if it is large (Weyl), fewer by the edge
    let highest = (8.0 * modes as f64).sqrt() + EDGE;
    let half = 0.5 * plate.thickness;
    let mut found: Vec<(f64, [f64; 2], [f64; 2])> = Vec::new();
    for diameters in 0..=highest as usize {
        // zeros of Bessel functions of the order n begin above n and are pi apart at least
        let count = ((highest - diameters as f64) / PI) as usize + 2;
        let unit = plates.unit(plate.edge, plate.material.poisson_ratio, count, diameters)?;
        let body = unit.scale(plate);
        let both = body.participation.iter().zip(unit.shapes(plate, &[offset]));
        let both = both.map(|(centre, struck)| [struck[0], centre[1]]);
        // the outer face is above the middle plane, the inner one below
        let slopes = unit.slopes(plate, &[offset, 0.0]);
        let along = slopes.iter().map(|slope| [-half * slope[0], half * slope[1]]);
        let below = unit.frequency(plate) * highest.powi(2);
        let each = body.omega.into_iter().zip(both).zip(along);
        found.extend(each.map(|((omega, both), along)| (omega, both, along)).filter(|mode| mode.0 <= below));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    debug_assert!(found.len() >= modes);
    found.truncate(modes);
    let body = ModalBody {
        damping_ratio: vec![plate.damping_ratio; modes],
        omega: found.iter().map(|mode| mode.0).collect(),
        participation: found.iter().map(|mode| mode.1).collect(),
        residual: None,
    };
    Ok(OffCentreModes { body, along: found.iter().map(|mode| mode.2).collect() })
}

/// Modes with one nodal diameter of `plate`, clamped or simply supported: its faces move along themselves at the centre, where its normal
/// turns, and it stays.
///
/// # Errors
/// As [`UnitPlates::modes`].
pub fn modes_along(plate: &Plate, plates: &UnitPlates) -> Result<ModesAlong> {
    let fitting = SHORTEST_WAVE * plate.radius / (PI * plate.thickness);
    let count = (fitting as usize + 1).min(MOST_WAVES);
    let unit = plates.unit(plate.edge, plate.material.poisson_ratio, count, 1)?;
    let highest = unit.frequency(plate) * (SHORTEST_WAVE * plate.radius / plate.thickness).powi(2);
    let half = 0.5 * plate.thickness;
    let slopes = unit.slopes(plate, &[0.0]);
    let modes = unit.scale(plate).omega.into_iter().zip(slopes);
    let (omega, along) = modes
        .filter(|(omega, _)| *omega <= highest)
        .map(|(omega, slope)| (omega, [-half * slope[0], half * slope[0]]))
        .unzip();
    Ok(ModesAlong { omega, along })
}

/// Static flexibility in m/N of the modes of `plate` beyond the angular frequency `omega` in rad/s: at the point `offset` m from the centre,
/// between both, at the centre.
///
/// An endless plate has its waves evenly spread over the plane of wave numbers, so that those beyond the wave number k yield
/// integral of J_0(s d) / (2 pi D s^3) ds over s > k between points at the distance d: 1/(4 pi D k^2) at one point, and a share of
/// that, integral of J_0(k d/sqrt(u)) du over 0..1, between two.
pub fn flexibility_beyond(plate: &Plate, offset: f64, omega: f64) -> [f64; 3] {
    let material = &plate.material;
    let bending = rigidity(material.youngs_modulus, material.poisson_ratio, plate.thickness);
    let mass = material.density * plate.thickness;
    let squared_wave_number = omega * (mass / bending).sqrt();
    let own = 1.0 / (4.0 * PI * bending * squared_wave_number);
    let way = squared_wave_number.sqrt() * offset;
    let (points, weights) = gauss_legendre(QUADRATURE);
    let at = |x: f64| libm::j0(way / (0.5 * (1.0 + x)).sqrt());
    let share: f64 = points.iter().zip(&weights).map(|(x, weight)| 0.5 * weight * at(*x)).sum();
    [own, share * own, own]
}

#[cfg(test)]
mod tests {
    use super::super::kirchhoff::UnitPlate;
    use super::*;
    use crate::scene::{Edge, Material};
    use approx::assert_relative_eq;

    fn plate(edge: Edge) -> Plate {
        let material = Material::elastic("steel", 210e9, 0.3, 7780.0);
        Plate { radius: 0.03, thickness: 0.001, edge, material, damping_ratio: 0.0 }
    }

    /// Leissa, table 2.1, and Leissa & Narita, J. Sound Vib. 70 (1980) 221: squares of the wave numbers.
    #[test]
    fn frequencies_with_nodal_diameters_are_leissas() {
        for (edge, table) in [
            (Edge::Clamped, [10.2158, 21.26, 34.88, 39.771, 51.04, 60.82, 69.666, 84.58, 89.104]),
            (Edge::SimplySupported, [4.9351, 13.898, 25.613, 29.720, 39.957, 48.479, 56.842, 70.117, 74.156]),
        ] {
            let (plate, plates) = (plate(edge), UnitPlates::default());
            let found = modes(&plate, 0.01, table.len(), &plates).expect("modes").body;
            let unit = UnitPlate::new(edge, 0.3, 1).expect("a mode").frequency(&plate);
            for (omega, expected) in found.omega.iter().zip(table) {
                assert_relative_eq!(omega / unit, expected, max_relative = 3e-4);
            }
        }
    }

    /// Static deflection under the load of a clamped plate off its centre: Michell's solution, with c = offset/radius
    /// (1 - c^2)^2 P R^2/(16 pi D) (Timoshenko & Woinowsky-Krieger, section 64); at the centre, by reciprocity,
    /// (1 - c^2 + 2 c^2 ln c) P R^2/(16 pi D) (section 19).
    #[test]
    fn all_modes_together_have_the_compliance_of_a_plate_under_an_off_centre_force() {
        let (plate, plates) = (plate(Edge::Clamped), UnitPlates::default());
        let stiffness = plate.material.youngs_modulus * plate.thickness.powi(3) / (12.0 * (1.0 - 0.09));
        for c in [0.2, 0.5] {
            let body = modes(&plate, c * plate.radius, 600, &plates).expect("modes").body;
            let sum = |i: usize, j: usize| -> f64 {
                let each = body.omega.iter().zip(&body.participation);
                each.map(|(omega, phi)| phi[i] * phi[j] / omega.powi(2)).sum()
            };
            let unit = plate.radius.powi(2) / (16.0 * PI * stiffness);
            assert_relative_eq!(sum(0, 0), (1.0 - c * c).powi(2) * unit, max_relative = 4e-3);
            assert_relative_eq!(sum(0, 1), (1.0 - c * c + 2.0 * c * c * c.ln()) * unit, max_relative = 1e-4);
        }
    }

    /// Slopes at both contacts under an off-centre force, from Michell's solution (Timoshenko & Woinowsky-Krieger, section 64):
    /// at x on the line of the force at c, ((1 - x^2)(1 - c^2) + (x - c)^2 ln((x - c)^2/(1 - x c)^2)) P R^2/(16 pi D).
    #[test]
    fn the_faces_move_along_x_where_the_plate_s_normal_turns() {
        let (plate, plates) = (plate(Edge::Clamped), UnitPlates::default());
        let stiffness = plate.material.youngs_modulus * plate.thickness.powi(3) / (12.0 * (1.0 - 0.09));
        let half = 0.5 * plate.thickness;
        for c in [0.2_f64, 0.5] {
            let OffCentreModes { body, along } =
                modes(&plate, c * plate.radius, 600, &plates).expect("modes");
            let moved = |i: usize| -> f64 {
                let each = body.omega.iter().zip(&body.participation).zip(&along);
                each.map(|((omega, phi), along)| phi[0] * along[i] / omega.powi(2)).sum()
            };
            let unit = plate.radius / (16.0 * PI * stiffness);
            let at_force = -2.0 * c * (1.0 - c * c) * unit;
            let at_centre = (2.0 * c * (c * c - 1.0) - 4.0 * c * c.ln()) * unit;
            assert_relative_eq!(moved(0), -half * at_force, max_relative = 4e-3);
            assert_relative_eq!(moved(1), half * at_centre, max_relative = 4e-3);
        }
    }

    /// However thin a plate is, so that a foil takes no longer.
    #[test]
    fn a_foil_has_few_long_waves() {
        let foil = Plate { thickness: 3e-8, ..plate(Edge::Clamped) };
        assert_eq!(modes_along(&foil, &UnitPlates::default()).expect("modes").omega.len(), MOST_WAVES);
    }

    /// Few modes and what the waves beyond them yield, against the same closed forms.
    #[test]
    fn modes_and_the_waves_beyond_them_have_the_compliance_of_all_modes() {
        let (plate, plates) = (plate(Edge::Clamped), UnitPlates::default());
        let unit = plate.radius.powi(2)
            / (16.0 * PI * rigidity(plate.material.youngs_modulus, 0.3, plate.thickness));
        for c in [0.015_f64, 0.2, 0.5] {
            let body = modes(&plate, c * plate.radius, 150, &plates).expect("modes").body;
            let rest = flexibility_beyond(&plate, c * plate.radius, body.omega[149]);
            let sum = |i: usize, j: usize| -> f64 {
                let each = body.omega.iter().zip(&body.participation);
                each.map(|(omega, phi)| phi[i] * phi[j] / omega.powi(2)).sum()
            };
            assert_relative_eq!(sum(0, 0) + rest[0], (1.0 - c * c).powi(2) * unit, max_relative = 2e-3);
            assert_relative_eq!(
                sum(0, 1) + rest[1],
                (1.0 - c * c + 2.0 * c * c * c.ln()) * unit,
                max_relative = 2e-3
            );
            assert_relative_eq!(sum(1, 1) + rest[2], unit, max_relative = 2e-3);
        }
    }
}
