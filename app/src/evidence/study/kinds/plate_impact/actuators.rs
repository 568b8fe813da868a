//! Section 2.2 of the paper: what stack, bender and lift magnet give the inner sphere, over where the plate stands.

use super::parameter::{self, linear};
use super::rocker::{bender, setup};
use crate::actuator::beam::Release;
use crate::actuator::cantilever::{moment_energy, moment_for_deflection};
use crate::actuator::inductance::Inductance;
use crate::actuator::magnet::Magnet;
use crate::actuator::{Bender, Stack, Supply};
use crate::dynamics::MovingBody;
use crate::error::Result;
use crate::evidence::study::{Axis, Cell, Claim, Note, Panel, Settings, Study};
use crate::kinds::plate_impact::PlateImpact;
use crate::kinds::plate_impact::reduced::Reduced;
use crate::result::Summary;
use crate::scene::{Model, Shape};
use rayon::prelude::*;

/// Stack of the class of TOKIN's AE0505D16DF (data sheet), in contact with its plate at a source that holds the voltage.
pub const STACK: Stack = Stack {
    length: 18e-3,
    area: 25e-6,
    stroke: 17.4e-6,
    blocked_force: 850.0,
    voltage: 150.0,
    capacitance: 1.4e-6,
    density: 8000.0,
    poisson_ratio: 0.3,
    tip_radius: 4e-3,
    gap: 0.0,
    drive: None,
};
/// Names of the stack's drives and their resistances in Ohm, of which the paper names none; 0 = a source that holds the voltage.
const DRIVES: [(&str, f64); 4] =
    [("stack, held voltage", 0.0), ("stack, 2.8 us", 2.0), ("stack, 14 us", 10.0), ("stack, 42 us", 30.0)];
/// Largest gap of the stack in m, and how many are drawn.
const GAPS: (f64, usize) = (32e-6, 33);
/// Moment of the bender in N m (section 4.3), and the time constant of its discharge in s, short as section 2.2.2 asks.
const TORQUE: f64 = 4e-3;
const DISCHARGE: f64 = 0.05e-3;
/// Offsets of the bender's plate to both sides in m, and how many are drawn.
const OFFSETS: (f64, usize) = (100e-6, 41);
/// Mass of a small lift magnet's plunger in kg, and its travel in m; the paper gives no data of one.
const PLUNGER: (f64, f64) = (1e-3, 1e-3);
/// Gap in m within which a stack has lost half of what it gives without, whatever its drive.
const FEW_MICROMETRES: f64 = 22e-6;
/// Relative error of the time integration.
const TOLERANCE: f64 = 1e-6;

/// How it is drawn.
pub const PANELS: [Panel; 2] = [
    panel("inner_energy", "Energy of the inner sphere in uJ", 1e6),
    panel("inner_energy_over_gap_0", "The same over that at gap 0", 1.0),
];

const fn panel(column: &'static str, label: &'static str, factor: f64) -> Panel {
    Panel::of(
        Axis::new("gap", "Plate offset from its nominal position in µm", 1e6),
        Axis::new(column, label, factor),
    )
    .by(Axis::new("actuator", "", 1.0))
}

/// An actuator with the plate at a place.
struct ActuatorCase {
    actuator: &'static str,
    gap: f64,
    setup: Option<PlateImpact>,
    /// Electrical energy taken and mechanical energy had before the touch in J, where the impact's own result does not say.
    energies: [Option<f64>; 2],
}

/// What a case comes to: kinetic energy of the inner sphere, electrical energy taken, mechanical energy given or had, J.
struct ActuatorEnergies {
    inner: f64,
    electrical: Option<f64>,
    mechanical: Option<f64>,
}

/// The stack at `gap` m behind `resistance` Ohm; `None` for the setup if it does not reach the plate.
fn stack(name: &'static str, resistance: f64, gap: f64) -> ActuatorCase {
    let drive = (resistance > 0.0).then_some(Supply { resistance, buffer_capacitance: None });
    let stack = Stack { gap, drive, ..STACK };
    let setup = Some(setup(Shape::Stack(stack), stack.step_speed()))
        .filter(|setup| MovingBody::outer(&setup.outer).is_ok());
    ActuatorCase { actuator: name, gap, setup, energies: [None; 2] }
}

/// The bender with its plate `gap` m beyond the straight position of its tip.
///
/// # Errors
/// As [`Release::new`].
fn bent(gap: f64) -> Result<ActuatorCase> {
    let straight = bender(DISCHARGE)?;
    let (length, stiffness) = (straight.length, straight.bending_stiffness);
    let deflection = TORQUE / moment_for_deflection(length, stiffness, 1.0);
    let bender = Bender { strike_at: -gap / deflection, ..straight };
    let speed = TORQUE * Release::new(&bender)?.speed_per_moment;
    Ok(ActuatorCase {
        actuator: "bender",
        gap,
        setup: Some(setup(Shape::Bender(bender), speed)),
        energies: [None, Some(moment_energy(length, stiffness, TORQUE))],
    })
}

/// The magnet with its plate `-gap` m before its stop.
///
/// # Errors
/// As [`Magnet::lift`].
fn magnet(gap: f64) -> Result<ActuatorCase> {
    let (mass, travel) = PLUNGER;
    let inductance = Inductance::even_gap([20e-3, 40e-3], travel);
    let lift = Magnet { mass, voltage: 12.0, resistance: 8.0, inductance, travel: travel + gap }.lift()?;
    let plunger = Shape::Compact { mass, tip_radius: STACK.tip_radius };
    Ok(ActuatorCase {
        actuator: "magnet",
        gap,
        setup: Some(setup(plunger, lift.speed)),
        energies: [Some(lift.taken), Some(0.5 * mass * lift.speed.powi(2))],
    })
}

fn solve(case: &ActuatorCase, model: Model) -> Result<ActuatorEnergies> {
    let Some(setup) = &case.setup else {
        return Ok(ActuatorEnergies { inner: 0.0, electrical: None, mechanical: Some(0.0) });
    };
    let mass = setup.inner.shape.mass(&setup.inner.material);
    let scene = parameter::scene("actuators", setup.clone());
    let result: Summary = Reduced::new(&scene, model, None)?.run(TOLERANCE)?;
    let [electrical, mechanical] = case.energies;
    Ok(ActuatorEnergies {
        inner: 0.5 * mass * result.value("inner_velocity_final").unwrap_or(f64::NAN).powi(2),
        electrical: electrical.or(result.stack.map(|stack| stack.electrical_energy)),
        mechanical: mechanical.or(result.stack.map(|stack| stack.mechanical_energy)),
    })
}

/// The study.
///
/// # Errors
/// As [`Reduced::new`] and [`Reduced::run`], and those of the actuators.
pub fn run(settings: &Settings, note: &mut Note) -> Result<Study> {
    let model = settings.model.unwrap_or(Model::B);
    let gaps = linear(0.0, GAPS.0, GAPS.1);
    let offsets = linear(-OFFSETS.0, OFFSETS.0, OFFSETS.1);
    let mut cases: Vec<ActuatorCase> =
        DRIVES.iter().flat_map(|(name, r)| gaps.iter().map(|gap| stack(name, *r, *gap))).collect();
    for gap in offsets {
        cases.push(bent(gap)?);
        if gap <= 0.0 {
            cases.push(magnet(gap)?);
        }
    }
    note(&format!("{} impacts with model {model}", cases.len()));
    let outcomes =
        cases.par_iter().map(|case| solve(case, model)).collect::<Result<Vec<ActuatorEnergies>>>()?;
    let curve = |name: &str| -> Vec<(f64, f64)> {
        let own = cases.iter().zip(&outcomes).filter(|(case, _)| case.actuator == name);
        own.map(|(case, outcome)| (case.gap, outcome.inner)).collect()
    };
    let nominal = |name: &str| {
        let near = curve(name).into_iter().min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        near.map_or(f64::NAN, |(_, energy)| energy)
    };
    let row = |(case, outcome): (&ActuatorCase, &ActuatorEnergies)| {
        vec![
            Cell::Text(case.actuator),
            case.gap.into(),
            outcome.inner.into(),
            (outcome.inner / nominal(case.actuator)).into(),
            outcome.electrical.into(),
            outcome.mechanical.into(),
            outcome.electrical.map(|taken| outcome.inner / taken).into(),
        ]
    };
    let mut claims: Vec<Claim> = DRIVES
        .iter()
        .map(|(name, _)| {
            let text = format!("{name}: gap at which half of the energy without a gap is lost (micrometres)");
            Claim::new(text, "m", None, halved(&curve(name)), FEW_MICROMETRES)
        })
        .collect();
    let bender = curve("bender");
    let least = bender.iter().map(|(_, energy)| *energy).fold(f64::INFINITY, f64::min);
    let most =
        bender.iter().copied().fold((0.0, 0.0), |best, point| if point.1 > best.1 { point } else { best });
    claims.push(Claim::new(
        "bender: energy lost at worst within 100 um of its straight position, over the largest".into(),
        "1",
        None,
        Some(1.0 - least / most.1),
        0.5,
    ));
    Ok(Study::new(
        "actuators",
        format!(
            "Section 2.2 of the paper: energy of the inner sphere behind the membrane of section 4.3, struck by a piezo stack (several time constants of its drive), the \
             piezo bender and a small lift magnet, over the position of the plate, model {model}. A stack's strokes of micrometres forgive no tolerance \
             (2.2.1), the bender those of a wide range (2.2.2). Stack and magnet are of a usual class, the paper gives no data of either."
        ),
        "actuator, gap [m], inner_energy [J], inner_energy_over_gap_0, electrical_energy [J], \
         mechanical_energy [J], share",
        cases.iter().zip(&outcomes).map(row).collect(),
        claims,
    ))
}

/// Where a curve first falls below half of its start, linear between its points; `None` if it does not.
fn halved(curve: &[(f64, f64)]) -> Option<f64> {
    let half = 0.5 * curve.first()?.1;
    let [(x, y), (next_x, next_y)] = *curve.windows(2).find(|pair| pair[1].1 < half)? else { return None };
    Some(x + (next_x - x) * (y - half) / (y - next_y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_half_is_found_between_two_points() {
        assert_eq!(halved(&[(0.0, 4.0), (1.0, 3.0), (2.0, 1.0)]), Some(1.5));
        assert_eq!(halved(&[(0.0, 4.0), (1.0, 3.0)]), None);
    }

    #[test]
    fn a_plate_before_the_stop_is_struck_by_a_slower_plunger() {
        let speed = |gap| magnet(gap).unwrap().setup.unwrap().outer.speed;
        assert!(speed(-0.5e-3) < speed(-0.1e-3) && speed(-0.1e-3) < speed(0.0));
    }
}
