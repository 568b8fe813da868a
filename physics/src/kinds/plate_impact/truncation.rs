//! What the modes that a reduced model leaves out would change.
//!
//! Models A and B are held against Kirchhoff's plate with all its modes, model C with the plate as an elastic layer
//! against that layer with more modes: [`Trials`]. A fluid's film and drag are left out of both.

use super::errors::largest_error;
use super::trials::{RUNGS, Trials};
use crate::dynamics::integrator::Options;
use crate::dynamics::system::System;
use crate::error::Result;
use crate::scene::{Model, PlateImpact};

/// Relative errors of which the user is warned.
const LARGEST: f64 = 0.01;
/// Truncation error of what counts as converged: of the layer, which has a residual, and of Kirchhoff's plate.
const RESOLUTION: [f64; 2] = [5e-4, 5e-6];
/// Relative error of the time integration.
const INTEGRATION: f64 = 1e-5;

/// The error that a model has for want of modes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Truncation {
    /// Largest estimated relative error of the quantities covered ([`super::errors::COVERED`]).
    pub(super) error: f64,
    /// What the user has to be told of it.
    pub(super) warning: Option<String>,
}

/// Estimates what the modes left out of `system`, which is `model` of `setup`, change within `end_time` s.
///
/// # Errors
/// As [`Trials::new`].
pub(super) fn estimate(
    setup: &PlateImpact,
    model: Model,
    system: &System,
    end_time: Option<f64>,
) -> Result<Truncation> {
    let mut dry = setup.clone();
    if let Some(fluid) = &mut dry.fluid {
        (fluid.squeeze_film, fluid.drag_coefficient) = (false, 0.0);
    }
    let options = Options { tolerance: INTEGRATION, end_time, sample_interval: None };
    let resolution = RESOLUTION[usize::from(model < Model::C)];
    let trials = Trials::new(&dry, resolution, options)?;
    let converged = match model {
        Model::A | Model::B => trials.converged(),
        Model::C => trials.continuum(trials.waves.modes()),
    }
    .ok();
    let of = |modes: usize| match (model, &converged) {
        (Model::C, converged) => trials.truncated(modes, converged.as_ref()),
        (_, Some(exact)) => match trials.kirchhoff(modes) {
            Ok(ours) => {
                let (error, name) = largest_error(&ours, exact, setup.outer.speed);
                (error, Some(name))
            }
            Err(_) => (trials.truncation(modes), None),
        },
        (_, None) => (trials.truncation(modes), None),
    };
    let modes = system.bending_modes();
    let (error, quantity) = of(modes);
    let warning = (error > LARGEST).then(|| {
        let enough = RUNGS.into_iter().find(|n| *n > modes && of(*n).0 <= LARGEST);
        warning(model, system.modes, error, quantity, enough)
    });
    Ok(Truncation { error, warning })
}

fn warning(model: Model, modes: usize, error: f64, quantity: Option<&str>, enough: Option<usize>) -> String {
    let most = quantity.map_or(String::new(), |name| format!(", most of all {name}"));
    let remedy = match (model, enough) {
        (Model::A, Some(enough)) => {
            format!("model B with {enough} modes is within 1 % of all modes of its plate")
        }
        (Model::B, Some(enough)) => format!("{enough} modes are enough for 1 % (--modes {enough})"),
        (Model::C, Some(enough)) => format!("about {enough} modes are enough for 1 % (--modes {enough})"),
        (_, None) => "more than 192 modes are needed for 1 %".to_owned(),
    };
    let plural = if modes == 1 { "" } else { "s" };
    format!(
        "model {model} with {modes} mode{plural}: the modes left out would change the result by an estimated {:.2} %{most}; {remedy}",
        100.0 * error
    )
}
