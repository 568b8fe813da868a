//! `auto` without a mesh: model C of a plate whose bending modes are known in closed form.
//!
//! Below the frequency at which its thickness shears a plate is its bending waves ([`crate::body::bending`]) and an elastic layer
//! under the contacts ([`crate::body::layer`]), its spheres are Lur'e's ([`crate::body::free_sphere`]).
//!
//! What the modes left out lack is their inertia: a mode of the frequency omega follows a force of the contacts' frequency w later by
//! powers of w/omega. Weighed by what the modes yield, over what the outer contact yields and over what the plate moves by, that
//! estimates the error of the forces ([`ModalTruncation`]); impacts that touch again and again exceed others by far. A number of modes that looks
//! enough is compared with twice as many: without that about 1 in 100 promises of 0.3, 1 and 3 % was broken, by up to ten times the
//! estimate. Their shapes are off by what the closed form may be ([`misshapen`]), so that impacts which take small errors far tell it.

use super::PlateImpact;
use super::assembled::{Assembled, join};
use super::errors::{COVERED, largest_error};
use super::predictor::Predictor;
use super::results::quantities;
use super::{choice, validity};
use crate::body::bending::{self, BendingMode};
use crate::body::layer::elastic_layer;
use crate::body::{ModalBody, free_sphere};
use crate::dynamics::integration::Options;
use crate::dynamics::integrator::integrate;
use crate::dynamics::system::System;
use crate::error::Result;
use crate::result::{CandidateModel, Choice};
use crate::scene::{Edge, Model, Plate, Shape};

/// Thickness over radius up to which the closed form is taken.
pub(super) const THICKEST: f64 = 0.25;
/// Poisson's ratio from which on it is taken for a simply supported plate: below, the rim decides about the first mode.
const RIM_DECIDES: f64 = -0.5;
/// Patch over a sphere's radius up to which the closed form of the sphere is known.
const WIDEST_PATCH: f64 = 0.4;
/// Modes that are looked at first, and at most.
const FIRST: usize = 16;
const MOST: usize = 128;
/// Modes that the first look at the impact takes.
const LOOK: usize = 8;
/// Patch over the thickness on whose size hardly anything depends.
const NEGLIGIBLE: f64 = 0.1;
/// Error of the closed form itself, of a thin plate and per fourth power of thickness over radius: within it of converged meshes in 98
/// of 100 random scenes.
const CLOSED_FORM: [f64; 2] = [5e-4, 6.0];
/// Error per what is lacking of the outer contact's approach, and of the plate's motion; and what is added to any error by each contact
/// beyond the first of either body, squared.
const BY_CONTACT: f64 = 10.0;
const BY_PLATE: f64 = 80.0;
const BY_CONTACTS: f64 = 0.1;
/// Error over what as many modes again change.
pub(super) const BY_TWICE: f64 = 2.0;

/// Why it was chosen.
pub(super) const REASON: &str = "model C by plate series (no mesh) is estimated to be within the tolerance";

/// Whether the plate of `setup` and its spheres under patches of the radii `patch` in m have a closed form.
pub(super) fn holds(setup: &PlateImpact, patch: [f64; 2]) -> bool {
    let plate = &setup.plate;
    let rim = plate.edge == Edge::SimplySupported && plate.material.poisson_ratio < RIM_DECIDES;
    let small = |shape: &Shape, patch: f64| match *shape {
        Shape::Sphere { radius } => patch <= WIDEST_PATCH * radius,
        Shape::Compact { .. } | Shape::Bender(_) | Shape::Stack(_) => true,
    };
    !rim && plate.thickness <= THICKEST * plate.radius
        && small(&setup.outer.shape, patch[0])
        && small(&setup.inner.shape, patch[1])
}

/// Relative error of the closed form of `plate` for want of what it does not know of the rim.
fn own_error(plate: &Plate) -> f64 {
    let [thin, more] = CLOSED_FORM;
    thin + more * (plate.thickness / plate.radius).powi(4)
}

/// `body`, the closed form of `plate`, with its elastic modes larger and smaller in turn, so that [`BY_TWICE`] what that changes is what
/// the closed form may be off by.
pub(super) fn misshapen(mut body: ModalBody, plate: &Plate) -> ModalBody {
    let off = own_error(plate) / BY_TWICE;
    let elastic = body.omega.iter().zip(&mut body.participation).filter(|(omega, _)| **omega > 0.0);
    for (factor, (_, phi)) in [1.0 + off, 1.0 - off].into_iter().cycle().zip(elastic) {
        *phi = phi.map(|phi| factor * phi);
    }
    body
}

/// What many touches make of an error: each takes what was wrong before it further.
pub(super) fn amplified(repeated_contacts: f64) -> f64 {
    1.0 + BY_CONTACTS * repeated_contacts * repeated_contacts
}

/// Model C of `setup` with as few modes as are estimated to be enough for `tolerance` until `end_time` s; `None` if no number is, or
/// what the scene asks for has no closed form.
///
/// # Errors
/// As [`super::reduced::Reduced::new`].
pub(super) fn choose(
    setup: &PlateImpact,
    tolerance: f64,
    end_time: Option<f64>,
) -> Result<Option<(Assembled, Choice)>> {
    let plate = &setup.plate;
    if setup.fluid.is_some() || setup.outer.shape.is_mounted() || !holds(setup, [0.0; 2]) {
        return Ok(None);
    }
    let mut modes = bending::modes(plate, FIRST);
    if modes.len() < 2 {
        return Ok(None);
    }
    let look = join(setup, waves(plate, &modes[..modes.len().min(LOOK)]), [0.0; 2])?;
    let predictor = Predictor::rough(&look, NEGLIGIBLE * plate.thickness)?;
    let patch = predictor.patch_radius;
    let wide = patch[0].max(patch[1]) > choice::STATED_ACCURACY * plate.thickness;
    let floor = validity::measured_error(patch, plate.thickness).filter(|_| !wide && holds(setup, patch));
    let Some(floor) = floor else { return Ok(None) };
    let approach = look.laws[0].approach(predictor.force_peak[0]) / predictor.force_peak[0];
    let total = |truncation: f64, next: &BendingMode| {
        (truncation + predictor.undamped(plate, next.omega)).hypot(floor)
    };
    let own = own_error(plate) * amplified(predictor.repeated_contacts);
    let enough = |modes: &[BendingMode]| {
        let truncations = truncations(plate, modes, &predictor);
        let estimate = |(n, truncation): (usize, &ModalTruncation)| {
            (n, total(own + truncation.error(approach, predictor.repeated_contacts), &modes[n]))
        };
        truncations
            .iter()
            .enumerate()
            .skip(choice::LEAST)
            .map(estimate)
            .find(|(_, error)| *error <= tolerance)
    };
    let mut found = enough(&modes);
    while found.is_none() && modes.len() < MOST {
        let known = modes.len();
        modes = bending::modes(plate, 2 * known);
        if modes.len() < 2 * known {
            break;
        }
        found = enough(&modes);
    }
    let Some((count, glance)) = found else { return Ok(None) };
    if modes.len() < 2 * count {
        modes = bending::modes(plate, 2 * count);
    }
    if modes.len() < 2 * count {
        return Ok(None);
    }
    let layer = elastic_layer(plate, &modes, patch);
    let tips = free_sphere::tip_residuals(&setup.outer, &setup.inner, patch);
    let with = |count: usize| layer.modal_body(count, predictor.slow());
    let system = join(setup, with(count), tips)?;
    let twice = join(setup, misshapen(with(2 * count), plate), tips)?;
    let options =
        Options { tolerance: choice::integration_tolerance(tolerance), end_time, ..Options::default() };
    let run = |system: &System| quantities(system, &integrate(system, &options)?);
    let (Ok(ours), Ok(more)) = (run(&system), run(&twice)) else { return Ok(None) };
    let (change, quantity) = largest_error(&ours, &more, setup.outer.speed);
    let estimate = total(BY_TWICE * change, &modes[count]).max(glance);
    if estimate.is_nan() || estimate > tolerance {
        return Ok(None);
    }
    let warnings = validity::warnings(setup.plate.thickness, predictor.patch_radius, &system);
    let candidate = CandidateModel {
        model: Model::C.to_string(),
        modes: count,
        estimated_error: Some(estimate),
        quantity: Some(quantity.to_owned()),
        chosen: true,
    };
    let choice = Choice {
        tolerance,
        covers: COVERED.map(str::to_owned).to_vec(),
        estimated_error: Some(estimate),
        coverage: choice::COVERAGE,
        floor: Some(floor),
        met: true,
        tried: vec![candidate],
        reason: REASON.to_owned(),
    };
    Ok(Some((Assembled { system, omega_next: modes[count].omega, fluid: None, warnings }, choice)))
}

/// The plate with these `modes` alone, seen from points.
fn waves(plate: &Plate, modes: &[BendingMode]) -> ModalBody {
    let rigid = (plate.edge == Edge::Free).then(|| (0.0, 1.0 / plate.mass().sqrt()));
    let all = || rigid.into_iter().chain(modes.iter().map(|mode| (mode.omega, mode.centre)));
    ModalBody {
        omega: all().map(|(omega, _)| omega).collect(),
        damping_ratio: all().map(|(omega, _)| if omega > 0.0 { plate.damping_ratio } else { 0.0 }).collect(),
        participation: all().map(|(_, centre)| [centre; 2]).collect(),
        residual: None,
    }
}

/// What modes left out lack.
#[derive(Debug, Clone, Copy, Default)]
struct ModalTruncation {
    /// What they yield at the outer face times w/omega, m/N.
    compliance: f64,
    /// What they yield between the faces times (w/omega)^2, over what the plate moves by.
    share: f64,
}

impl ModalTruncation {
    /// Relative error of the forces, with the `approach` of the outer contact in m/N and so many `repeated_contacts` beyond the first of either
    /// body.
    fn error(&self, approach: f64, repeated_contacts: f64) -> f64 {
        let once = BY_CONTACT * self.compliance / approach + BY_PLATE * self.share;
        once * amplified(repeated_contacts)
    }
}

/// What is lacking with the first n of the `modes`. Shape (modes).
fn truncations(plate: &Plate, modes: &[BendingMode], predictor: &Predictor) -> Vec<ModalTruncation> {
    let (slow, patch) = (predictor.slow(), predictor.patch_radius);
    let mut truncations = vec![ModalTruncation::default(); modes.len()];
    // a force of the contacts' frequency moves slower modes by their inertia
    let mut motion = if plate.edge == Edge::Free { 1.0 / (plate.mass() * slow * slow) } else { 0.0 };
    let mut truncation = ModalTruncation::default();
    for (n, mode) in modes.iter().enumerate().rev() {
        let phi = patch.map(|a| mode.under(a));
        let late = slow / mode.omega;
        // shapes grow as the root of the number and frequencies as its square: what is beyond the last goes on as its powers
        let beyond = |power: f64| if n + 1 == modes.len() { 1.0 + modes.len() as f64 / power } else { 1.0 };
        truncation.compliance += beyond(4.0) * late * (phi[0] / mode.omega).powi(2);
        truncation.share += beyond(6.0) * late.powi(2) * phi[0] * phi[1] / mode.omega.powi(2);
        motion += phi[0] * phi[0] / (mode.omega.powi(2) + slow * slow);
        truncations[n] = truncation;
    }
    for truncation in &mut truncations {
        truncation.share /= motion;
    }
    truncations
}
