//! From checked values to the bodies that strike and are struck, whatever lies between them, and to impacts in series.

use crate::Result;
use crate::actuator::inductance::Inductance;
use crate::actuator::magnet::Magnet;
use crate::actuator::{Bender, Stack, Supply, beam, cantilever};
use crate::scene::material::material;
use crate::scene::read::refused;
use crate::scene::values::{Node, unknown};
use crate::scene::{Inner, Outer, Series, Shape, Turning};

/// How often the impact is repeated, if `root` says so.
pub(super) fn series(root: &Node) -> Result<Option<Series>> {
    let Some(series) = root.optional_table("series")? else { return Ok(None) };
    Ok(Some(Series { impacts: series.count("impacts")?, sphere_spot: series.word("sphere_spot")? }))
}

fn shape(body: &Node) -> Result<Shape> {
    match body.text("kind")? {
        "sphere" => Ok(Shape::Sphere { radius: body.number("radius")? }),
        "compact" => {
            Ok(Shape::Compact { mass: body.number("mass")?, tip_radius: body.number("tip_radius")? })
        }
        other => Err(unknown("kind", other)),
    }
}

fn turning(body: &Node, friction: f64) -> Result<Turning> {
    let own_friction = body.optional_number("friction")?;
    Ok(Turning {
        friction: own_friction.unwrap_or(friction),
        own_friction,
        spin: body.number("spin")?,
        moment_of_inertia: body.optional_number("moment_of_inertia")?,
    })
}

/// The inner body, where the scene has the coefficient of `friction`.
pub(super) fn inner(inner: &Node, materials: &Node, friction: f64) -> Result<Inner> {
    Ok(Inner {
        shape: shape(inner)?,
        material: material(materials, inner.text("material")?)?,
        gap: inner.number("gap")?,
        speed: inner.number("speed")?,
        turning: turning(inner, friction)?,
    })
}

/// The outer body, where the scene has the coefficient of `friction`.
pub(super) fn outer(outer: &Node, materials: &Node, friction: f64) -> Result<Outer> {
    Ok(Outer { turning: turning(outer, friction)?, ..striking(outer, materials)? })
}

/// The outer body without spin and friction; the speed of a bender's or a stack's tip follows from its drive.
fn striking(outer: &Node, materials: &Node) -> Result<Outer> {
    let material = material(materials, outer.text("material")?)?;
    if outer.text("kind")? == "stack" {
        let stack = stack(outer)?;
        return Ok(Outer::centred(Shape::Stack(stack), material, stack.step_speed()));
    }
    if outer.text("kind")? == "magnet" {
        let magnet = magnet(outer)?;
        let plunger = Shape::Compact { mass: magnet.mass, tip_radius: outer.number("tip_radius")? };
        return Ok(Outer::centred(plunger, material, magnet.lift()?.speed));
    }
    if outer.text("kind")? != "bender" {
        return Ok(Outer {
            shape: shape(outer)?,
            material,
            speed: outer.number("speed")?,
            offset: outer.number("offset")?,
            angle: outer.number("angle")?,
            turning: Turning::default(),
        });
    }
    let mut bender = bender(outer)?;
    let offset = outer.number("offset")?;
    let speed = if outer.has("speed") {
        let speed = outer.number("speed")?;
        bender.strike_at = strike_at(bender, offset, speed)?;
        speed
    } else {
        let torque = if outer.has("torque") {
            outer.number("torque")?
        } else {
            cantilever::moment_for_deflection(
                bender.length,
                bender.bending_stiffness,
                outer.number("tip_deflection")?,
            )
        };
        bender.strike_at = within(offset / deflection(&bender, torque), offset)?;
        torque * beam::Release::new(&bender)?.speed_per_moment
    };
    Ok(Outer::centred(Shape::Bender(bender), material, speed))
}

fn magnet(outer: &Node) -> Result<Magnet> {
    Ok(Magnet {
        mass: outer.number("mass")?,
        voltage: outer.number("voltage")?,
        resistance: outer.number("resistance")?,
        inductance: pull(outer)?,
        travel: outer.number("travel")?,
    })
}

/// How a magnet pulls: by the inductances at both ends of its way, or by a curve.
fn pull(outer: &Node) -> Result<Inductance> {
    let (start, travel) = (outer.number("inductance")?, outer.number("travel")?);
    if let Some(stop) = outer.optional_number("stop_inductance")? {
        if stop <= start {
            return Err(refused(
                &format!(
                    "`outer.stop_inductance` is {stop} H, but it must be more than `outer.inductance`, {start} H"
                ),
                "the plunger is pulled to where the inductance is larger",
            ));
        }
        return Ok(Inductance::even_gap([start, stop], travel));
    }
    let rows = outer.tables("curve")?;
    let column = |key: &str| -> Result<Vec<[f64; 2]>> {
        let given = rows.iter().filter(|row| row.has(key));
        given.map(|row| Ok([row.number("way")?, row.number(key)?])).collect()
    };
    let (inductances, forces) = (column("inductance")?, column("force")?);
    let refuse = |what: String| {
        Err(refused(
            &format!("`outer.curve` {what}"),
            "its points go from the start of the plunger to its stop",
        ))
    };
    if !inductances.is_empty() && !forces.is_empty() {
        return refuse("has inductances and forces, but it must be of one kind".into());
    }
    let points = if forces.is_empty() { &inductances } else { &forces };
    if points.len() < 2 || points[0][0] != 0.0 || points[points.len() - 1][0] < travel {
        return refuse(format!("does not cover the travel from 0 to `outer.travel`, {travel} m"));
    }
    if let Some(pair) = points.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
        return refuse(format!("has the way {} m after {} m, but it must increase", pair[1][0], pair[0][0]));
    }
    if !forces.is_empty() {
        return Ok(Inductance::of_forces(start, &forces));
    }
    if let Some(pair) = points.windows(2).find(|pair| pair[1][1] <= pair[0][1]) {
        return refuse(format!(
            "has the inductance {} H after {} H, but it has to rise",
            pair[1][1], pair[0][1]
        ));
    }
    if points[0][1] != start {
        return refuse(format!("begins with {} H, but `outer.inductance` is {start} H", points[0][1]));
    }
    Ok(Inductance::through(&inductances))
}

fn stack(outer: &Node) -> Result<Stack> {
    let drive = outer.optional_table("drive")?;
    let supply = |drive: Node| -> Result<Supply> {
        Ok(Supply {
            resistance: drive.number("resistance")?,
            buffer_capacitance: drive.optional_number("buffer_capacitance")?,
        })
    };
    let mut stack = Stack {
        length: outer.number("length")?,
        area: outer.number("area")?,
        stroke: outer.number("stroke")?,
        blocked_force: outer.number("blocked_force")?,
        voltage: outer.number("voltage")?,
        capacitance: outer.number("capacitance")?,
        density: f64::NAN,
        poisson_ratio: outer.number("poisson_ratio")?,
        tip_radius: outer.number("tip_radius")?,
        gap: outer.number("gap")?,
        drive: drive.map(supply).transpose()?,
    };
    stack.density = if outer.has("density") {
        outer.number("density")?
    } else {
        stack.density_for(outer.number("first_frequency")?)
    };
    let coupled = stack.force_per_voltage().powi(2) / stack.stiffness();
    if coupled >= stack.capacitance {
        return Err(refused(
            &format!(
                "`outer.capacitance` is {} F, but it must be more than its coupled part, `outer.blocked_force` times `outer.stroke` over the square of `outer.voltage`, {coupled:.4e} F",
                stack.capacitance
            ),
            "a stack that is held has less capacitance than a free one, by just that, and still some",
        ));
    }
    let most = MOST_STROKES * stack.stroke;
    if stack.gap >= most {
        return Err(refused(
            &format!(
                "`outer.gap` is {} m, but the stack's tip swings out by less than twice `outer.stroke`, {most:.4e} m: it never reaches the plate",
                stack.gap
            ),
            "bring the stack nearer, or take one with a larger stroke",
        ));
    }
    Ok(stack)
}

/// Strokes by which a stack swings out at most, when the voltage is there at once.
const MOST_STROKES: f64 = 2.0;

/// Deflection of the tip in m under a uniform bending moment of `torque` N m.
fn deflection(bender: &Bender, torque: f64) -> f64 {
    torque / cantilever::moment_for_deflection(bender.length, bender.bending_stiffness, 1.0)
}

/// Largest offset of a bender over its deflection before the release.
const FARTHEST: f64 = 0.9;
/// Iterations for the deflection from which a bender has its speed at an offset, and their relative change in the end.
const ITERATIONS: usize = 60;
const CONVERGED: f64 = 1e-13;

/// `share` of the deflection at which a bender strikes, for an `offset` in m.
fn within(share: f64, offset: f64) -> Result<f64> {
    if share.abs() <= FARTHEST {
        return Ok(share);
    }
    Err(refused(
        &format!(
            "`outer.offset` is {offset} m, but its magnitude must be at most {FARTHEST} of the tip's deflection before the release, {:.4e} m",
            FARTHEST * (offset / share).abs()
        ),
        "bend the bender more, or bring the plate nearer to its straight position",
    ))
}

/// The same of a bender that strikes with `speed` m/s.
fn strike_at(bender: Bender, offset: f64, speed: f64) -> Result<f64> {
    let mut share = 0.0;
    for _ in 0..if offset == 0.0 { 0 } else { ITERATIONS } {
        let release = beam::Release::new(&Bender { strike_at: share, ..bender })?;
        let next = within(offset / deflection(&bender, speed / release.speed_per_moment), offset)?;
        let change = (next - share).abs();
        share = next;
        if change <= CONVERGED {
            break;
        }
    }
    Ok(share)
}

fn bender(outer: &Node) -> Result<Bender> {
    let (length, tip_mass) = (outer.number("length")?, outer.number("tip_mass")?);
    let (bending_stiffness, line_mass) = if outer.has("bending_stiffness") {
        (outer.number("bending_stiffness")?, outer.number("line_mass")?)
    } else {
        let (frequency, stiffness) = (outer.number("first_frequency")?, outer.number("tip_stiffness")?);
        let Some(mass) = cantilever::mass_from_frequency(frequency, stiffness, tip_mass) else {
            let bound = cantilever::largest_tip_mass(frequency, stiffness);
            return Err(refused(
                &format!(
                    "`outer.tip_mass` is {tip_mass} kg, but a massless beam of `outer.tip_stiffness` = {stiffness} N/m already swings below `outer.first_frequency` = {frequency} Hz with more than {bound:.6e} kg at its tip"
                ),
                "lower the tip mass or the frequency, or raise the stiffness",
            ));
        };
        (cantilever::bending_stiffness(length, stiffness), mass / length)
    };
    Ok(Bender {
        length,
        bending_stiffness,
        line_mass,
        tip_mass,
        tip_radius: outer.number("tip_radius")?,
        discharge_time: if outer.has("capacitance") {
            outer.number("capacitance")? * outer.number("discharge_resistance")?
        } else {
            outer.number("discharge_time")?
        },
        strike_at: 0.0,
    })
}
