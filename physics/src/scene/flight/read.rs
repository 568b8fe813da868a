//! From the checked values of `[flight]` and `[vibration]` to their types.

use super::{Flight, FlightSpring, Vibration};
use crate::Result;
use crate::flight::{LaunchDeviation, Vector, Wave};
use crate::scene::values::{Checked, Node, unknown};
use std::f64::consts::{FRAC_PI_2, PI};

/// Standard gravity, m/s^2.
const STANDARD_GRAVITY: f64 = 9.80665;
/// Periods of a sine unless the scene gives another number.
const PERIODS: u64 = 10;

/// The flight, if there is one.
pub(in crate::scene) fn flight(root: &Node) -> Result<Option<Flight>> {
    let Some(node) = root.optional_table("flight")? else { return Ok(None) };
    let angle = node.number_or("gravity_angle", 0.0)?;
    let density = node.optional_number("fluid_density")?;
    let drag = density.map(|density| Ok([density, node.number("drag_coefficient")?]));
    Ok(Some(Flight {
        travel: node.optional_number("travel")?,
        chamber_height: node.number("chamber_height")?,
        gravity: node.number_or("gravity", STANDARD_GRAVITY)? * Vector::new(angle.sin(), -angle.cos()),
        spring: node.optional_table("spring")?.as_ref().map(spring).transpose()?,
        restitution: node.optional_number("restitution")?,
        friction: node.number("friction")?,
        drag: drag.transpose()?,
        end_time: node.number_or("end_time", 1.0)?,
        deviation: LaunchDeviation {
            speed: node.number_or("speed_scatter", 0.01)?,
            angle: node.number_or("angle_scatter", 0.5 * PI / 180.0)?,
            restitution: node.number_or("restitution_scatter", 0.02)?,
        },
    }))
}

fn spring(node: &Node) -> Result<FlightSpring> {
    Ok(FlightSpring {
        force: node.number("force")?,
        stiffness: node.number_or("stiffness", 0.0)?,
        angle: node.number_or("angle", 0.0)?,
        anchor_distance: node.optional_number("anchor_distance")?,
        friction: node.number_or("friction", 0.0)?,
    })
}

/// How the valve is shaken, if it is.
pub(in crate::scene) fn vibration(root: &Node) -> Result<Option<Vibration>> {
    let Some(node) = root.optional_table("vibration")? else { return Ok(None) };
    let angle = node.number_or("angle", -FRAC_PI_2)?;
    let periods = match node.0.get("periods") {
        Some(Checked::Count(periods)) => *periods,
        _ => PERIODS,
    };
    let wave = match node.text("kind")? {
        "sine" => Wave::Sine { frequency: node.number("frequency")?, periods: periods as f64 },
        "half-sine" => Wave::HalfSine { duration: node.number("duration")? },
        "record" => Wave::Record { time: node.numbers("time")?, acceleration: node.numbers("acceleration")? },
        other => return Err(unknown("vibration.kind", other)),
    };
    Ok(Some(Vibration { wave, direction: Vector::new(angle.sin(), angle.cos()) }))
}
