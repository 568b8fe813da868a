//! What the modes that a reduced model leaves out would change.
//!
//! Models A and B are compared with Kirchhoff's plate with all its modes. Model C is compared with the plate as an elastic layer
//! with more modes ([`Trials`]), which knows bending far from the rim, and against itself with fewer modes, which knows the
//! rest. A fluid's film and drag are omitted of both.

use super::assembled::off_centre_system;
use super::errors::estimated_percent;
use super::results::quantities;
use super::trials::{RUNGS, Trials, TruncationError};
use super::{MAX_MODES, PlateImpact};
use crate::body::kirchhoff::UnitPlates;
use crate::body::off_centre;
use crate::dynamics::integration::Options;
use crate::dynamics::integrator::integrate;
use crate::dynamics::system::System;
use crate::error::Result;
use crate::scene::Model;

/// Relative errors of which the user is warned.
const LARGEST: f64 = 0.01;
/// Truncation error of what counts as converged: of the layer, which has a residual, and of Kirchhoff's plate.
const RESOLUTION: [f64; 2] = [5e-4, 5e-6];
/// Relative error of the time integration.
const INTEGRATION: f64 = 1e-5;
/// Thickness over radius up to which the layer knows the plate well enough alone.
const THIN: f64 = 0.1;
/// Modes that stand for all of a plate that is struck off its centre, at least, and over those of the model.
const MANY: usize = 256;
const MORE: usize = 4;
/// Its error over the difference to them.
const OFF_CENTRE_SAFETY: f64 = 1.2;
/// Steps of an impact from which on fewer modes count as converged, and the number of modes that is enough is estimated and not tried out.
const LONG: u64 = 10_000;
/// Largest ratio of two models' errors that is trusted.
const NEAR: f64 = 0.9;

/// The error that a model has for want of modes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Truncation {
    /// Largest estimated relative error of the quantities covered ([`super::errors::COVERED`]).
    pub(super) error: f64,
    /// What the user has to know of it.
    pub(super) warning: Option<String>,
}

/// Estimates what the modes left out of `system`, which is `model` of `setup`, change within `end_time` s; the plate of model C
/// has its next frequency at `omega_next` rad/s. The impact took so many `steps`.
///
/// # Errors
/// As [`Trials::new`].
pub(super) fn estimate(
    setup: &PlateImpact,
    model: Model,
    system: &System,
    omega_next: f64,
    end_time: Option<f64>,
    steps: u64,
) -> Result<Truncation> {
    if setup.outer.offset > 0.0 && model == Model::C {
        let options = Options { tolerance: INTEGRATION, end_time, ..Options::default() };
        // its upper Ritz modes stand for what lies above them
        let truncation = by_fewer_modes(system, &options, [6], |_| 1.0);
        let warning = (truncation.error > LARGEST).then(|| warning(model, system.modes, truncation, None));
        return Ok(Truncation { error: truncation.error, warning });
    }
    if setup.outer.offset > 0.0 {
        return off_centre(setup, model, system, end_time);
    }
    let mut dry = setup.clone();
    if let Some(fluid) = &mut dry.fluid {
        (fluid.squeeze_film, fluid.drag_coefficient) = (false, 0.0);
    }
    let options = Options { tolerance: INTEGRATION, end_time, ..Options::default() };
    let is_long = steps > LONG;
    let resolution = RESOLUTION[usize::from(model < Model::C && !is_long)];
    let trials = Trials::new(&dry, resolution, options)?;
    let converged = match model {
        Model::A | Model::B => trials.converged(),
        Model::C => trials.continuum(trials.waves.modes()),
    }
    .ok();
    let of = |modes: usize| match (model, &converged) {
        (Model::C, layer) => trials.truncated(modes, layer.as_ref()),
        (_, Some(all)) => match trials.kirchhoff(modes) {
            Ok(ours) => TruncationError::between(&ours, all, setup.outer.speed),
            Err(_) => TruncationError { error: trials.truncation(modes), quantity: None },
        },
        (_, None) => TruncationError { error: trials.truncation(modes), quantity: None },
    };
    let modes = system.bending_modes();
    let mut truncation = of(modes);
    // models A and B are compared with all modes of their own plate, which are no waves under a contact
    let undamped = if model == Model::C { trials.predictor.undamped(&setup.plate, omega_next) } else { 0.0 };
    if model == Model::C && setup.plate.thickness > THIN * setup.plate.radius {
        truncation = truncation.or(of_continuum(system, omega_next, &options));
    }
    truncation.error += undamped;
    let warning = (truncation.error > LARGEST).then(|| {
        let error = |modes| if is_long { trials.truncation(modes) } else { of(modes).error };
        let enough = RUNGS.into_iter().find(|n| *n > modes && error(*n) + undamped <= LARGEST);
        // of a continuum some modes are no bending modes
        let enough = enough.map(|bending| bending + system.modes - modes);
        warning(model, system.modes, truncation, enough)
    });
    Ok(Truncation { error: truncation.error, warning })
}

/// The same of a plate that is struck off its centre, from its difference to many modes and the static flexibility of the waves
/// beyond them. Twice as many modes would not do: near the centre they may all be ones whose nodal diameters pass through it.
fn off_centre(
    setup: &PlateImpact,
    model: Model,
    system: &System,
    end_time: Option<f64>,
) -> Result<Truncation> {
    let options = Options { tolerance: INTEGRATION, end_time, ..Options::default() };
    let run = |system: &System| quantities(system, &integrate(system, &options)?);
    let many = off_centre_system(setup, MANY.max(MORE * system.modes), &UnitPlates::default())?;
    let [outer, mutual, inner] =
        off_centre::flexibility_beyond(&setup.plate, setup.outer.offset, many.highest_frequency());
    // the inner contact closes when the plate moves down
    let all = many.softer([outer, -mutual, inner]);
    let truncation = match (run(system), run(&all)) {
        (Ok(ours), Ok(more)) => TruncationError::between(&ours, &more, setup.outer.speed),
        _ => TruncationError { error: f64::INFINITY, quantity: None },
    };
    let truncation = truncation.times(OFF_CENTRE_SAFETY);
    let error = truncation.error;
    let enough = (system.modes as f64 * error / LARGEST).ceil() as usize;
    let warning = (error > LARGEST)
        .then(|| warning(model, system.modes, truncation, (enough <= MAX_MODES).then_some(enough)));
    Ok(Truncation { error, warning })
}

/// What the modes that `system`, a model C, leaves out change, from what its own upper ones do: the error goes with the square of
/// (contact frequency / lowest frequency left out), that of the system being `omega_next` rad/s.
pub(super) fn of_continuum(system: &System, omega_next: f64, options: &Options) -> TruncationError {
    by_fewer_modes(system, options, [4, 6], |modes| {
        let truncated = system.oscillators[system.elastic().start + modes].omega;
        let ratio = (truncated / omega_next).powi(2).min(NEAR);
        ratio / (1.0 - ratio)
    })
}

/// The largest of what `eighths` of its modes change of `system`, times `share` of so many modes.
pub(super) fn by_fewer_modes(
    system: &System,
    options: &Options,
    eighths: impl IntoIterator<Item = usize>,
    share: impl Fn(usize) -> f64,
) -> TruncationError {
    let run = |system: &System| quantities(system, &integrate(system, options)?);
    let unknown = TruncationError { error: f64::INFINITY, quantity: None };
    let Ok(whole) = run(system) else { return unknown };
    let part = |eighths: usize| {
        let modes = eighths * system.modes / 8;
        let Ok(part) = run(&system.lowest(modes)) else { return unknown };
        TruncationError::between(&part, &whole, system.speed).times(share(modes))
    };
    eighths.into_iter().map(part).reduce(TruncationError::or).unwrap_or(unknown)
}

fn warning(model: Model, modes: usize, truncation: TruncationError, enough: Option<usize>) -> String {
    let most = truncation.quantity.map_or(String::new(), |name| format!(", most of all {name}"));
    let remedy = match (model, enough) {
        (Model::A, Some(enough)) => {
            format!("model B with {enough} modes is within 1 % of all modes of its plate")
        }
        (Model::B, Some(enough)) => format!("{enough} modes are enough for 1 % (--modes {enough})"),
        (Model::C, Some(enough)) => format!("try about {enough} modes (--modes {enough})"),
        (Model::C, None) => format!("try {} modes (--modes {})", 2 * modes, 2 * modes),
        (_, None) => "more than 192 modes are needed for 1 %".to_owned(),
    };
    let plural = if modes == 1 { "" } else { "s" };
    format!(
        "model {model} with {modes} mode{plural}: modal truncation error about {}{most}; {remedy}",
        estimated_percent(truncation.error)
    )
}
