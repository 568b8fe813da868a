//! The flight that a scene asks for, from the results of its impact.

use super::of;
use crate::error::{Error, Result};
use crate::flight::{Ending, Landscape, Launch, Setup, Thresholds, judge, thresholds};
use crate::result::{FlightSummary, Summary, VibrationSummary};
use crate::scene::{Flight, Scene};

/// How the sphere is launched by the impact that `summary` tells of; `None` if the run was cut during a contact.
pub fn launch(scene: &Scene, summary: &Summary) -> Option<Launch> {
    of(scene).launch(summary)
}

/// The flight that `scene` asks for.
fn settings(scene: &Scene) -> Result<&Flight> {
    scene.flight.as_ref().ok_or_else(|| {
        Error::Usage(format!(
            "scene `{}` has no [flight]: add one, with spring, chamber and friction",
            scene.name
        ))
    })
}

/// Sphere, chamber, forces and energy landscape of the flight that `scene` asks for, with this coefficient of restitution.
///
/// # Errors
/// [`Error::Usage`] if it asks for none; the checks of the scene have seen to the rest.
pub fn flight_of(scene: &Scene, restitution: f64) -> Result<(Setup, Landscape)> {
    let of_scene = |sentence: String| Error::Solver(format!("{}: {sentence}", scene.name));
    let setup = settings(scene)?.setup(scene, restitution).map_err(of_scene)?;
    let landscape = Landscape::new(&setup).map_err(of_scene)?;
    Ok((setup, landscape))
}

/// Adds to `summary` what `scene` asks of flight and vibration; `restitution` gives the coefficient if the scene leaves it open.
///
/// # Errors
/// Those of `restitution`.
pub fn add_flight(
    scene: &Scene,
    summary: &mut Summary,
    restitution: impl FnOnce() -> Result<f64>,
) -> Result<()> {
    let Some(flight) = &scene.flight else { return Ok(()) };
    let restitution = flight.restitution.map_or_else(restitution, Ok)?;
    if let Some(launch) = launch(scene, summary) {
        let (flown, ending) = flown(scene, launch, restitution)?;
        summary.warnings.extend(warning(ending, flown.share));
        summary.flight = Some(flown);
    }
    if let Some(vibration) = &scene.vibration {
        let (setup, landscape) = flight_of(scene, restitution)?;
        let Thresholds { unseats, shifts, energy_bound } =
            thresholds(&setup, &landscape, &vibration.wave, vibration.direction);
        summary.vibration = Some(VibrationSummary { unseats, shifts, energy_bound });
    }
    Ok(())
}

/// Where the sphere lands in `scene` after a `launch`, with this coefficient of restitution, and how sure that is.
///
/// # Errors
/// Those of [`flight_of`].
pub fn flight_summary(scene: &Scene, launch: Launch, restitution: f64) -> Result<FlightSummary> {
    Ok(flown(scene, launch, restitution)?.0)
}

fn flown(scene: &Scene, launch: Launch, restitution: f64) -> Result<(FlightSummary, Ending)> {
    let (setup, landscape) = flight_of(scene, restitution)?;
    let judged = judge(&setup, &landscape, &launch, &settings(scene)?.deviation);
    let ending = judged.flight.ending;
    let summary = FlightSummary {
        seat: ending.seat(),
        time: judged.flight.time,
        margin: judged.margin,
        share: judged.share(),
        landings: judged.landings,
        least_speed: judged.least_speed,
        restitution,
        launch,
        reason: ending.reason(),
    };
    Ok((summary, ending))
}

/// That a verdict hangs on more than is known.
fn warning(ending: Ending, share: f64) -> Option<String> {
    if let Ending::Moves | Ending::Bounces = ending {
        return ending.reason();
    }
    (share > 0.0 && share < 1.0).then(|| {
        format!(
            "{:.0} % of the launches within the ranges of speed, angle and restitution end in the other seat: the result of one flight is not reliable",
            100.0 * share
        )
    })
}
