//! Where the sphere flies after the impact, and how the valve is shaken: `[flight]` and `[vibration]` of any kind of scene.
//!
//! They are told to no solver of the impact and are no part of its identity: the same impact with another spring has the same
//! reference.

mod keys;
mod read;
mod record;

pub(super) use keys::VIBRATION;
pub(crate) use keys::{FLIGHT, PLATE_FLIGHT, SEAT_FLIGHT};
pub(super) use read::{flight, vibration};
pub(super) use record::with_record;

use super::Scene;
use super::collision::{Collision, Rule, broken};
use super::tolerances::LANDING_SHARE;
use crate::flight::{self as physics, Chamber, Field, LaunchDeviation, SphereDrag, Vector, Wave};

/// A spring as a scene gives it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightSpring {
    /// Force in N on a sphere that rests in a seat.
    pub force: f64,
    /// N/m.
    pub stiffness: f64,
    /// Direction of the push against -z in rad.
    pub angle: f64,
    /// Distance in m of its held end from the line between the seats, above their middle.
    pub anchor_distance: Option<f64>,
    /// Coulomb's coefficient between its last turn and the sphere.
    pub friction: f64,
}

/// The flight of the sphere after the impact.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// Way in m from one position to the other, behind a plate.
    pub travel: Option<f64>,
    /// z in m of the chamber's ceiling.
    pub chamber_height: f64,
    /// Gravity (x, z) in m/s^2.
    pub gravity: Vector,
    /// The spring, if there is one.
    pub spring: Option<FlightSpring>,
    /// Newton's coefficient of restitution; `None` = computed by the seat's model.
    pub restitution: Option<f64>,
    /// Coulomb's coefficient of friction.
    pub friction: f64,
    /// Density in kg/m^3 and drag coefficient of a fluid.
    pub drag: Option<[f64; 2]>,
    /// Time in s after which a flight is given up.
    pub end_time: f64,
    /// The bands of launch and restitution.
    pub deviation: LaunchDeviation,
}

/// The sphere that flies, and where.
#[derive(Debug, Clone)]
pub struct Flyer {
    /// Mass in kg.
    pub mass: f64,
    /// Radius in m.
    pub radius: f64,
    /// Its chamber.
    pub chamber: Chamber,
}

/// How the valve is shaken.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibration {
    /// Course of the acceleration.
    pub wave: Wave,
    /// Direction of the acceleration, of length 1.
    pub direction: Vector,
}

impl Flight {
    /// Sphere, chamber and forces of the flight in `scene`, with this coefficient of restitution.
    ///
    /// # Errors
    /// A sentence if the sphere has no room in the chamber, or is none.
    pub fn setup(&self, scene: &Scene, restitution: f64) -> Result<physics::Setup, String> {
        let Flyer { mass, radius, chamber } = scene.setup.bodies().flyer(self)?;
        let seat = chamber.seats()[0];
        let spring = self.spring.map(|spring| physics::Spring {
            force: spring.force,
            stiffness: spring.stiffness,
            direction: Vector::new(spring.angle.sin(), -spring.angle.cos()),
            anchor: spring.anchor_distance.map(|distance| Vector::new(0.0, seat.y + distance)),
            friction: spring.friction,
            seat,
        });
        let drag = self.drag.map(|[density, coefficient]| SphereDrag::new(coefficient, density, radius));
        let field = Field { gravity: self.gravity, spring, drag, shaken: None };
        Ok(physics::Setup {
            mass,
            radius,
            chamber,
            field,
            restitution,
            friction: self.friction,
            end_time: self.end_time,
        })
    }
}

/// A chamber that the sphere has no room in, or seats in which nothing holds it.
pub(super) fn collisions(scene: &Scene) -> Vec<Collision> {
    let rule = |field: &'static str, holds: bool, message: &str, help: &'static str| Rule {
        fields: vec![field],
        holds,
        message: message.to_owned(),
        help,
    };
    let mut rules = Vec::new();
    if let Some(Vibration { wave: Wave::Record { time, acceleration }, .. }) = &scene.vibration {
        let ascends = time.windows(2).all(|pair| pair[0] < pair[1]);
        let fits = time.len() > 1 && time.len() == acceleration.len() && time[0] == 0.0 && ascends;
        let fields = vec!["vibration.time", "vibration.file"];
        let message = "`vibration.time` and `vibration.acceleration` are no record: it needs as many accelerations as times, at least 2, and times that ascend from 0".into();
        rules.push(Rule { fields, holds: fits, message, help: "give every sample a time" });
        rules.push(rule(
            "vibration",
            acceleration.iter().any(|a| *a != 0.0),
            "`vibration.acceleration` is 0 m/s^2 throughout, and so is any multiple of it",
            "give a record that shakes",
        ));
    }
    match &scene.flight {
        None => rules.push(rule(
            "vibration",
            scene.vibration.is_none(),
            "`[vibration]` needs a table `[flight]`, which specifies what holds the sphere in its seat",
            "add a table [flight]",
        )),
        Some(flight) => {
            // whether the seats hold the sphere is no matter of the restitution
            let setup = flight.setup(scene, flight.restitution.unwrap_or(0.5));
            let fault = setup.and_then(|setup| physics::Landscape::new(&setup).map(|_| ())).err();
            rules.push(rule(
                "flight",
                fault.is_none(),
                &fault.map_or_else(String::new, |fault| format!("`[flight]` is impossible: {fault}")),
                "change spring, gravity or chamber so that the sphere stays in both seats",
            ));
        }
    }
    let landings = scene.tolerances.iter().filter(|(_, of_model)| of_model.contains_key(LANDING_SHARE));
    let landings = landings.filter(|_| scene.flight.is_none());
    landings.map(|(model, _)| without_landing(model)).chain(broken(rules)).collect()
}

/// A tolerance of `model` on a landing that there is not.
fn without_landing(model: &str) -> Collision {
    let field = format!("tolerances.{model}.{LANDING_SHARE}");
    Collision {
        message: format!(
            "`{field}` bounds how many launches land in the other seat, but there is no `[flight]`"
        ),
        fields: vec![field.into()],
        help: "add a table [flight], or remove the tolerance",
    }
}
