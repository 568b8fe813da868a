//! From the voltage to the seat: both demonstrators of section 5, each from its actuator through plate or seat to where its
//! sphere comes to rest.
//!
//! The tip of a piezo bender is as fast as the voltage it was bent by is high, for all of it is linear: the examples' speeds are those at
//! the paper's voltage. Spring, travel, friction and chamber are the examples', since the paper gives none; so numbers show how a valve
//! behaves, not the paper's one.

use crate::error::{Error, Result};
use crate::evidence::study::{Axis, Cell, Claim, Note, Panel, Study};
use crate::flight::Seat;
use crate::kinds::{self, Series};
use crate::project::project_root;
use crate::reference::mesh_to_follow;
use crate::result::FlightSummary;
use crate::scene::{Distribution, Field, Model, Spread, Template, UncertainInput, Uncertainty};
use crate::uncertainty::Inputs;
use crate::uncertainty::design::Point;
use rayon::prelude::*;
use std::fs;

/// Voltage in V at which the actuators have the speeds of the example scenes (section 2.2: "about 150 Volts").
const NOMINAL: f64 = 150.0;
/// Voltages of the table in V.
const VOLTAGES: [f64; 2] = [40.0, 200.0];
const COUNT: usize = 33;
/// Accuracy in V to which the least voltage that shifts is looked for.
const ACCURACY: f64 = 0.05;
/// Valves that are drawn for the scatter: two of each sequence.
const DRAWN: usize = 32;
const SEED: u32 = 1;
/// Relative error of the efficiency that the time integration may have.
const TOLERANCE: f64 = 1e-4;
/// Relative change of the launch's speed up to which a flight's margin is looked for.
const WIDEST_MARGIN: f64 = 0.5;
/// Section 5.1.2: the sphere stopped 8 times in 2 million shifts. So many standard deviations of a Gaussian leave 4e-6 on one side.
const LONG_TERM: f64 = 4.5;

/// How a spring presses on the sphere (Fig. 23).
#[derive(Clone, Copy, PartialEq)]
enum Transmission {
    /// By its last turn, with friction.
    LastTurn,
    /// By a plunger in a blind hole, at a point.
    Plunger,
}

/// A valve that was built and tried.
struct Demonstrator {
    name: &'static str,
    /// Its example scene.
    scene: &'static str,
    model: Model,
    /// How the spring presses on the sphere of a rocker.
    transmission: Option<Transmission>,
    /// The actuator's speed, which the voltage sets.
    speed: &'static str,
    /// Its capacitance, if the scene knows it.
    capacitance: Option<&'static str>,
    /// Plausible standard deviations, relative; the paper states none.
    tolerances: &'static [(&'static str, f64)],
}

const ROCKER_TOLERANCES: &[(&str, f64)] = &[
    ("outer.speed", 0.01),
    ("plate.thickness", 0.01),
    ("materials.titanium.youngs_modulus", 0.02),
    ("inner.radius", 0.002),
];

const DEMONSTRATORS: [Demonstrator; 3] = [
    Demonstrator {
        name: "rocker",
        scene: "rocker-flight",
        model: Model::C,
        transmission: Some(Transmission::LastTurn),
        speed: "outer.speed",
        capacitance: Some("outer.capacitance"),
        tolerances: ROCKER_TOLERANCES,
    },
    Demonstrator {
        name: "rocker with plunger",
        scene: "rocker-flight",
        model: Model::C,
        transmission: Some(Transmission::Plunger),
        speed: "outer.speed",
        capacitance: Some("outer.capacitance"),
        tolerances: ROCKER_TOLERANCES,
    },
    Demonstrator {
        name: "flexible seal seat",
        scene: "valve-flight",
        model: Model::C,
        transmission: None,
        speed: "actuator.speed",
        capacitance: None,
        tolerances: &[
            ("actuator.speed", 0.01),
            ("actuator.mass", 0.01),
            ("materials.polymer.youngs_modulus", 0.02),
        ],
    },
];

/// How it is drawn: what the actuator gives, and the share that shifts.
pub const PANELS: [Panel; 2] =
    [panel("launch_speed", "Speed of the sphere in m/s"), panel("share", "Share of launches that shift")];

const fn panel(column: &'static str, label: &'static str) -> Panel {
    Panel::of(Axis::new("voltage", "Voltage in V", 1.0), Axis::new(column, label, 1.0)).by(Axis::new(
        "demonstrator",
        "",
        1.0,
    ))
}

/// An impact and the flight that follows.
struct ValveShift {
    flight: FlightSummary,
    /// Kinetic energy of the actuator at the touch in J.
    actuator_energy: f64,
    /// The same of the sphere at its launch.
    sphere_energy: f64,
}

/// A demonstrator and what its shifts share.
struct Valve {
    template: Template,
    transmission: Option<Transmission>,
    speed: Field,
    /// Speed of the actuator in m/s at [`NOMINAL`].
    nominal: f64,
    /// In F.
    capacitance: Option<f64>,
    series: Box<dyn Series>,
    model: Model,
    /// What scatters.
    fields: Vec<Field>,
    inputs: Inputs,
}

impl Valve {
    fn new(demonstrator: &Demonstrator) -> Result<Self> {
        let path = project_root()?.join(format!("scenes/examples/{}.toml", demonstrator.scene));
        let text = fs::read_to_string(&path).map_err(|e| Error::io("read", &path, e))?;
        let template = Template::parse(demonstrator.scene, &text)?;
        let speed = template.field(demonstrator.speed)?;
        let nominal = template.number(&speed).ok_or_else(|| {
            Error::Internal(format!("scene `{}` has no `{}`", demonstrator.scene, demonstrator.speed))
        })?;
        let capacitance = demonstrator.capacitance.map(|field| template.field(field)).transpose()?;
        let capacitance = capacitance.and_then(|field| template.number(&field));
        let mesh = mesh_to_follow(template.scene(), None)?;
        let fields = demonstrator.tolerances.iter().map(|(field, _)| template.field(field));
        let fields = fields.collect::<Result<Vec<Field>>>()?;
        let uncertain = |(field, (name, share)): (&Field, &(&str, f64))| UncertainInput {
            field: (*name).to_owned(),
            unit: field.unit(),
            nominal: template.number(field).unwrap_or(f64::NAN),
            distribution: Distribution::Normal(Spread::Relative(*share)),
        };
        let inputs = fields.iter().zip(demonstrator.tolerances).map(uncertain).collect();
        let uncertainty = Uncertainty { inputs, correlations: Vec::new() };
        let inputs = Inputs::new(&uncertainty, SEED)
            .ok_or_else(|| Error::Internal("independent inputs have a correlation".into()))?;
        let transmission = demonstrator.transmission;
        let series = kinds::series([], template.scene(), mesh.as_ref(), 1)?;
        let model = demonstrator.model;
        Ok(Self { template, transmission, speed, nominal, capacitance, series, model, fields, inputs })
    }

    /// A shift with other numbers than the scene's.
    fn shift(&self, numbers: &[(&Field, f64)]) -> Result<ValveShift> {
        let mut scene =
            self.template.with(numbers).map_err(|rejected| Error::Internal(rejected.to_string()))?;
        let spring = scene.flight.as_mut().and_then(|flight| flight.spring.as_mut());
        if let (Some(Transmission::Plunger), Some(spring)) = (self.transmission, spring) {
            spring.friction = 0.0;
        }
        let plate = scene.plate_impact().cloned().ok();
        let seat = scene.seal_seat().cloned().ok();
        let summary = self.series.model(scene, self.model, None)?.run(TOLERANCE)?;
        let (actuator_energy, sphere_mass) = match (plate, seat, &summary.bender) {
            (Some(plate), _, Some(bender)) => {
                (bender.drive.kinetic_energy, plate.inner.shape.mass(&plate.inner.material))
            }
            (_, Some(seat), _) => (0.5 * seat.actuator.mass * seat.actuator.speed.powi(2), seat.sphere.mass),
            _ => return Err(Error::Internal("a demonstrator's plate is not struck by a bender".into())),
        };
        let flight = summary.flight.ok_or_else(|| Error::Internal("a shift has no flight".into()))?;
        let sphere_energy = 0.5 * sphere_mass * flight.launch.speed.powi(2);
        Ok(ValveShift { flight, actuator_energy, sphere_energy })
    }

    /// A shift by `voltage` V.
    fn at(&self, voltage: f64) -> Result<ValveShift> {
        self.shift(&[(&self.speed, self.nominal * voltage / NOMINAL)])
    }

    /// Energy in J that the bender is charged with to `voltage` V and that its resistor takes, C V^2 / 2.
    fn electrical_energy(&self, voltage: f64) -> Option<f64> {
        self.capacitance.map(|capacitance| 0.5 * capacitance * voltage.powi(2))
    }

    /// What a shift by `voltage` V takes and gives, in J.
    fn energies(&self, voltage: f64) -> Result<Vec<(&'static str, f64)>> {
        let shift = self.at(voltage)?;
        let electrical = self.electrical_energy(voltage).map(|energy| ("electrical energy", energy));
        let mechanical = [
            ("energy of the actuator", shift.actuator_energy),
            ("energy of the sphere", shift.sphere_energy),
        ];
        Ok(electrical.into_iter().chain(mechanical).collect())
    }

    /// Least voltage in V that shifts, between those of the table at `low` and `high`.
    fn least_voltage(&self, mut low: f64, mut high: f64) -> Result<f64> {
        while high - low > ACCURACY {
            let middle = 0.5 * (low + high);
            if self.at(middle)?.flight.seat == Seat::Other { high = middle } else { low = middle }
        }
        Ok(high)
    }
}

/// What the valves of a workshop do at [`NOMINAL`].
struct Workshop {
    /// Standard deviations of the launch's speed from that of the valve as designed to the nearest that ends in another seat, if that is
    /// the other one.
    margin: Option<f64>,
    /// Share that shifts.
    share: f64,
}

impl Workshop {
    fn of(valve: &Valve) -> Result<Self> {
        let one = |row: usize| {
            let numbers = valve.inputs.place(&valve.inputs.design().at(row, Point::A));
            let drawn: Vec<(&Field, f64)> = valve.fields.iter().zip(numbers).collect();
            let flight = valve.shift(&drawn)?.flight;
            Ok((flight.launch.speed, flight.seat == Seat::Other))
        };
        let found: Vec<(f64, bool)> = (0..DRAWN).into_par_iter().map(one).collect::<Result<_>>()?;
        let count = DRAWN as f64;
        let mean = found.iter().map(|(speed, _)| speed).sum::<f64>() / count;
        let squares = found.iter().map(|(speed, _)| (speed - mean).powi(2)).sum::<f64>();
        let deviation = (squares / (count - 1.0)).sqrt();
        let designed = valve.at(NOMINAL)?.flight;
        let room = designed.margin.unwrap_or(WIDEST_MARGIN) * designed.launch.speed;
        Ok(Self {
            margin: (designed.seat == Seat::Other).then_some(room / deviation),
            share: found.iter().filter(|(_, shifts)| *shifts).count() as f64 / count,
        })
    }
}

/// The study.
///
/// # Errors
/// Those of the example scenes' models.
pub fn run(note: &mut Note) -> Result<Study> {
    let (mut rows, mut claims) = (Vec::new(), Vec::new());
    for demonstrator in &DEMONSTRATORS {
        note(&format!("{}: {COUNT} voltages, {DRAWN} valves", demonstrator.name));
        let valve = Valve::new(demonstrator)?;
        let [low, high] = VOLTAGES;
        let step = (high - low) / (COUNT - 1) as f64;
        let voltages: Vec<f64> = (0..COUNT).map(|k| low + step * k as f64).collect();
        let shifts: Vec<ValveShift> =
            voltages.par_iter().map(|voltage| valve.at(*voltage)).collect::<Result<_>>()?;
        let struck = |voltage: f64| valve.nominal * voltage / NOMINAL;
        for (voltage, shift) in voltages.iter().zip(&shifts) {
            let flight = &shift.flight;
            rows.push(vec![
                Cell::Text(demonstrator.name),
                (*voltage).into(),
                struck(*voltage).into(),
                valve.electrical_energy(*voltage).into(),
                shift.actuator_energy.into(),
                shift.sphere_energy.into(),
                flight.launch.speed.into(),
                flight.launch.angle.into(),
                flight.least_speed.into(),
                Cell::Text(flight.seat.name()),
                flight.share.into(),
            ]);
        }
        let first = shifts.iter().position(|shift| shift.flight.seat == Seat::Other);
        let least = match first {
            Some(0) => Some(low),
            Some(k) => Some(valve.least_voltage(voltages[k - 1], voltages[k])?),
            None => None,
        };
        let energies = match least {
            Some(voltage) => valve.energies(voltage)?,
            None => Vec::new(),
        };
        claims.extend(claims_of(demonstrator, &shifts, (least, energies), &Workshop::of(&valve)?));
    }
    Ok(Study::new(
        "valve",
        format!(
            "Both demonstrators of section 5, from the voltage on the bender to the seat that the sphere comes to rest in: the \
             example scenes rocker-flight and valve-flight, whose actuators have their speeds at {NOMINAL} V. Spring, travel, friction and \
             chamber are those of the examples, the paper specifies none. {DRAWN} valves have plausible tolerances of speed, masses, materials \
             and thickness. The margin is to the nearest launch \
             that ends in another seat, in standard deviations of its speed. 8 failures in 2 million operations correspond to {LONG_TERM}."
        ),
        "demonstrator, voltage [V], actuator_speed [m/s], electrical_energy [J], \
         actuator_energy [J], sphere_energy [J], launch_speed [m/s], launch_angle [rad], \
         least_speed [m/s], seat, share",
        rows,
        claims,
    ))
}

/// What section 5 says of a demonstrator, and what it leaves open.
fn claims_of(
    demonstrator: &Demonstrator,
    shifts: &[ValveShift],
    (least, energies): (Option<f64>, Vec<(&'static str, f64)>),
    workshop: &Workshop,
) -> Vec<Claim> {
    let name = demonstrator.name;
    let truth = |text: &str, holds: bool| {
        Claim::new(format!("{name}: {text}"), "1", Some(1.0), Some(f64::from(u8::from(holds))), 0.5)
    };
    let found =
        |text: &str, unit, value| Claim::new(format!("{name}: {text}"), unit, None, value, f64::INFINITY);
    let any = |seat: Seat| shifts.iter().any(|shift| shift.flight.seat == seat);
    let mut claims = vec![
        truth("the sphere falls back when the impact is too weak (5.1.1)", any(Seat::Same)),
        found("least voltage that shifts", "V", least),
        found("share of drawn valves that shift at the paper's voltage", "1", Some(workshop.share)),
        found("standard deviations from the launch to the nearest that does not shift", "1", workshop.margin),
    ];
    let of_energy = |(name, energy)| found(&format!("{name} per shift at that voltage"), "J", Some(energy));
    claims.splice(2..2, energies.into_iter().map(of_energy));
    let lasts = workshop.margin.is_some_and(|margin| margin >= LONG_TERM);
    claims.extend(match demonstrator.transmission {
        Some(Transmission::LastTurn) => {
            vec![truth("friction of the spring stops the sphere in the middle (5.1.2)", any(Seat::None))]
        }
        Some(Transmission::Plunger) => vec![
            truth("the sphere never stops in the middle (5.1.2)", !any(Seat::None)),
            truth(
                "shifts with the margin that the long-term test shows, 4.5 standard deviations (5.1.2)",
                lasts,
            ),
        ],
        None => vec![truth("shifts at the paper's voltage (5.2)", workshop.margin.is_some())],
    });
    claims
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn rocker(k: usize) -> Valve {
        Valve::new(&DEMONSTRATORS[k]).unwrap()
    }

    /// Too weak an impact lets the sphere fall back; the spring's last turn holds it in the middle, a plunger does not.
    #[test]
    fn a_plunger_cures_what_the_spring_holds_up() {
        let [spring, plunger] =
            [0, 1].map(|k| [60.0, NOMINAL].map(|voltage| rocker(k).at(voltage).unwrap().flight.seat));
        assert_eq!(spring, [Seat::Same, Seat::None]);
        assert_eq!(plunger, [Seat::Same, Seat::Other]);
    }

    /// What the sphere has is what the impact's efficiency says, and goes with the square of the voltage.
    #[test]
    fn a_shift_shares_the_bender_s_energy() {
        let valve = rocker(0);
        let [half, whole] = [0.5 * NOMINAL, NOMINAL].map(|voltage| valve.at(voltage).unwrap());
        let scene = valve.template.scene().clone();
        let efficiency = valve.series.model(scene, valve.model, None).unwrap().run(TOLERANCE).unwrap();
        let share = whole.sphere_energy / whole.actuator_energy;
        assert_relative_eq!(share, efficiency.value("efficiency").unwrap(), max_relative = 1e-9);
        assert_relative_eq!(4.0 * half.actuator_energy, whole.actuator_energy, max_relative = 1e-9);
        // the contact is stiffer the harder the blow
        assert_relative_eq!(4.0 * half.sphere_energy, whole.sphere_energy, max_relative = 0.1);
        let taken = valve.electrical_energy(NOMINAL).unwrap();
        assert!(taken > whole.actuator_energy, "{taken:e} J make {:e} J", whole.actuator_energy);
    }

    /// Without friction of the spring the sphere rolls, and its launch, which has no spin, loses two sevenths of its energy to that: the
    /// least speed is that of the saddle over sqrt(5/7), and the voltage in proportion.
    #[test]
    fn the_least_voltage_is_that_of_the_saddle() {
        let valve = rocker(1);
        let least = valve.least_voltage(60.0, NOMINAL).unwrap();
        let flight = valve.at(least).unwrap().flight;
        let ratio = flight.launch.speed / flight.least_speed;
        assert_relative_eq!(ratio, (7.0_f64 / 5.0).sqrt(), max_relative = 0.05);
    }
}
