//! From the checked values of `[flight]` and `[vibration]` to their types.

use super::{Flight, FlightSpring, Vibration};
use crate::Result;
use crate::flight::{LaunchDeviation, Vector, Wave};
use crate::scene::values::{Node, unknown};

/// The flight, if there is one.
pub(in crate::scene) fn flight(root: &Node) -> Result<Option<Flight>> {
    let Some(node) = root.optional_table("flight")? else { return Ok(None) };
    let angle = node.number("gravity_angle")?;
    let density = node.optional_number("fluid_density")?;
    let drag = density.map(|density| Ok([density, node.number("drag_coefficient")?]));
    Ok(Some(Flight {
        travel: node.optional_number("travel")?,
        chamber_height: node.number("chamber_height")?,
        gravity: node.number("gravity")? * Vector::new(angle.sin(), -angle.cos()),
        spring: node.optional_table("spring")?.as_ref().map(spring).transpose()?,
        restitution: node.optional_number("restitution")?,
        friction: node.number("friction")?,
        drag: drag.transpose()?,
        end_time: node.number("end_time")?,
        deviation: LaunchDeviation {
            speed: node.number("speed_scatter")?,
            angle: node.number("angle_scatter")?,
            restitution: node.number("restitution_scatter")?,
        },
    }))
}

fn spring(node: &Node) -> Result<FlightSpring> {
    Ok(FlightSpring {
        force: node.number("force")?,
        stiffness: node.number("stiffness")?,
        angle: node.number("angle")?,
        anchor_distance: node.optional_number("anchor_distance")?,
        friction: node.number("friction")?,
    })
}

/// How the valve is shaken, if it is.
pub(in crate::scene) fn vibration(root: &Node) -> Result<Option<Vibration>> {
    let Some(node) = root.optional_table("vibration")? else { return Ok(None) };
    let angle = node.number("angle")?;
    let wave = match node.text("kind")? {
        "sine" => Wave::Sine { frequency: node.number("frequency")?, periods: node.count("periods")? as f64 },
        "half-sine" => Wave::HalfSine { duration: node.number("duration")? },
        "record" => Wave::Record { time: node.numbers("time")?, acceleration: node.numbers("acceleration")? },
        other => return Err(unknown("vibration.kind", other)),
    };
    Ok(Some(Vibration { wave, direction: Vector::new(angle.sin(), angle.cos()) }))
}
