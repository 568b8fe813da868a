//! Seal seats that can't be, and numbers that are hardly meant.

use super::super::NAME;
use super::SealSeat;
use crate::scene::collision::{Collision, Rule, broken};
use crate::scene::plausibility::material;
use crate::scene::{Bodies, Flight, Flyer};
use std::f64::consts::FRAC_PI_2;

/// Least thickness of a wall between two features, over the island's height: what a mesh can follow.
const LEAST_WALL: f64 = 0.02;
/// Least distance of two tips over their radius: closer ones make one contact.
const LEAST_TIP_DISTANCE: f64 = 0.1;

impl Bodies for SealSeat {
    fn kind(&self) -> &'static str {
        NAME
    }

    fn collisions(&self) -> Vec<Collision> {
        let mut found = island(self);
        found.extend(cone_and_bore(self));
        // Where the ring lies means nothing unless cone and island are sound.
        if found.is_empty() {
            found.extend(ring_and_walls(self));
        }
        found.extend(tips(self));
        let [seat, sphere] = [&self.seat.material, &self.sphere.material];
        found.extend(broken(vec![
            Rule {
                fields: vec!["seat.material"],
                holds: seat.plasticity().is_none(),
                message: format!("`seat.material` is `{}`, which yields, but a seal seat is elastic or relaxes", seat.name),
                help: "leave `hardening` out of the material",
            },
            Rule {
                fields: vec!["sphere.material"],
                holds: sphere.is_elastic(),
                message: format!(
                    "`sphere.material` is `{}`, which is plastic or viscoelastic, but the sphere in a seal seat must be elastic",
                    sphere.name
                ),
                help: "leave `hardening`, `relaxation` and `loss_factor` out of the material",
            },
        ]));
        found
    }

    fn flyer(&self, flight: &Flight) -> Result<Flyer, String> {
        let chamber = self.chamber(flight.chamber_height).map_err(|error| error.0)?;
        Ok(Flyer { mass: self.sphere.mass, radius: self.sphere.radius, chamber })
    }

    fn doubts(&self) -> Vec<String> {
        [&self.seat.material, &self.sphere.material].into_iter().flat_map(material).collect()
    }
}

/// A length in mm, as people read it; the rounding is far below what a mesh resolves.
fn mm(length: f64) -> String {
    format!("{} mm", (length * 1e9).round() / 1e6)
}

fn island(setup: &SealSeat) -> Vec<Collision> {
    let seat = &setup.seat;
    let corner = 0.5 * seat.island_length.hypot(seat.island_width);
    let mut rules = vec![
        Rule {
            fields: vec!["seat.island_height", "seat.membrane_thickness"],
            holds: seat.island_height > seat.membrane_thickness,
            message: format!(
                "the island does not rise above the membrane: `seat.island_height` is {}, but it must be greater than `seat.membrane_thickness`, {}",
                mm(seat.island_height),
                mm(seat.membrane_thickness)
            ),
            help: "raise the island, or make the membrane thinner",
        },
        Rule {
            fields: vec!["seat.island_length", "seat.island_width", "seat.membrane_radius"],
            holds: corner < seat.membrane_radius,
            message: format!(
                "the island reaches over the rim of the membrane: its corners (`seat.island_length` {}, `seat.island_width` {}) lie at a radius of {}, but it must be less than `seat.membrane_radius`, {}",
                mm(seat.island_length),
                mm(seat.island_width),
                mm(corner),
                mm(seat.membrane_radius)
            ),
            help: "make the island smaller, or the membrane larger",
        },
    ];
    if let Some(notch) = &seat.notch {
        rules.push(Rule {
            fields: vec!["seat.notch_floor", "seat.membrane_thickness"],
            holds: notch.floor >= seat.membrane_thickness,
            message: format!(
                "the notch cuts into the membrane: `seat.notch_floor` is {}, but it must be at least `seat.membrane_thickness`, {}",
                mm(notch.floor),
                mm(seat.membrane_thickness)
            ),
            help: "raise the floor of the notch",
        });
        rules.push(Rule {
            fields: vec!["seat.notch_floor", "seat.island_height"],
            holds: notch.floor < seat.island_height,
            message: format!(
                "the notch lies above the island: `seat.notch_floor` is {}, but it must be less than `seat.island_height`, {}",
                mm(notch.floor),
                mm(seat.island_height)
            ),
            help: "lower the floor of the notch, or leave both keys of the notch out",
        });
        rules.push(Rule {
            fields: vec!["seat.notch_width", "seat.island_length"],
            holds: notch.width < seat.island_length,
            message: format!(
                "the notch is wider than the island: `seat.notch_width` is {}, but it must be less than `seat.island_length`, {}",
                mm(notch.width),
                mm(seat.island_length)
            ),
            help: "make the notch narrower",
        });
    }
    broken(rules)
}

fn cone_and_bore(setup: &SealSeat) -> Vec<Collision> {
    let (seat, r) = (&setup.seat, setup.sphere.radius);
    let (ring, half) = (setup.ring(), 0.5 * seat.aperture_angle);
    let wall = LEAST_WALL * seat.island_height;
    let floor = seat.seated_height - seat.bore_depth * seat.tilt.cos() - seat.bore_radius * seat.tilt.sin();
    broken(vec![
        Rule {
            fields: vec!["seat.aperture_angle", "seat.tilt"],
            holds: half + seat.tilt < FRAC_PI_2,
            message: format!(
                "the cones of the two seats cut away the web between them: half of `seat.aperture_angle` and `seat.tilt` are {:.2} deg together, but it must be less than 90 deg",
                (half + seat.tilt).to_degrees()
            ),
            help: "make the cones narrower, or tilt the seats less",
        },
        Rule {
            fields: vec!["seat.bore_radius", "seat.aperture_angle"],
            holds: seat.bore_radius < ring.radius,
            message: format!(
                "the bore cuts away the contact ring: `seat.bore_radius` is {}, but it must be less than the radius of the ring, {} (sphere radius times the cosine of half the aperture angle)",
                mm(seat.bore_radius),
                mm(ring.radius)
            ),
            help: "make the bore narrower, or the aperture angle smaller",
        },
        Rule {
            fields: vec!["seat.bore_depth", "sphere.radius"],
            holds: seat.bore_depth > r,
            message: format!(
                "the sphere rests on the floor of the bore instead of the contact ring: `seat.bore_depth` is {}, but it must be greater than `sphere.radius`, {}",
                mm(seat.bore_depth),
                mm(r)
            ),
            help: "deepen the bore",
        },
        Rule {
            fields: vec!["seat.bore_depth", "seat.seated_height"],
            holds: floor >= wall,
            message: format!(
                "the bore breaks through the underside: the lowest edge of its floor (`seat.bore_depth` {} below the centre at `seat.seated_height` {}) lies at z = {}, but it must be at least {} (2 % of the island's height)",
                mm(seat.bore_depth),
                mm(seat.seated_height),
                mm(floor),
                mm(wall)
            ),
            help: "make the bore less deep, or raise the seats",
        },
    ])
}

fn ring_and_walls(setup: &SealSeat) -> Vec<Collision> {
    let (seat, ring) = (&setup.seat, setup.ring());
    let wall = LEAST_WALL * seat.island_height;
    let [inner, outer] = [ring.point(0.0), ring.point(std::f64::consts::PI)];
    // Along the outer flank the cone must leave the island through its top, not through its side.
    let mut rules = vec![
        Rule {
            fields: vec!["seat.seated_height", "seat.island_height"],
            holds: outer[2] <= seat.island_height - wall,
            message: format!(
                "the contact ring lies above the island (`seat.seated_height` is {}): its highest point is at z = {}, but it must be at most {} (`seat.island_height` {} less a wall of 2 %)",
                mm(seat.seated_height),
                mm(outer[2]),
                mm(seat.island_height - wall),
                mm(seat.island_height)
            ),
            help: "lower the seats, or raise the island",
        },
        Rule {
            fields: vec!["seat.island_width", "sphere.radius"],
            holds: ring.radius <= 0.5 * seat.island_width - wall,
            message: format!(
                "the contact ring reaches over the side of the island: its radius is {}, but it must be at most {} (half of `seat.island_width` less a wall of 2 % of the height)",
                mm(ring.radius),
                mm(0.5 * seat.island_width - wall)
            ),
            help: "make the island wider, or the ring smaller",
        },
        Rule {
            fields: vec!["seat.island_length", "seat.seat_distance"],
            holds: -outer[0] <= 0.5 * seat.island_length - wall,
            message: format!(
                "the contact ring reaches over the end of the island: its outermost point is at x = {}, but it must be at least {} (half of `seat.island_length` less a wall of 2 % of the height)",
                mm(outer[0]),
                mm(wall - 0.5 * seat.island_length)
            ),
            help: "make the island longer, or bring the seats closer together",
        },
        Rule {
            fields: vec!["seat.seat_distance", "seat.tilt"],
            holds: inner[0] <= -0.5 * wall,
            message: format!(
                "the contact rings of the two seats overlap (`seat.seat_distance` is {}): the innermost point of the left one is at x = {}, but it must be at most {} (half a wall of 2 % of the height)",
                mm(seat.seat_distance),
                mm(inner[0]),
                mm(-0.5 * wall)
            ),
            help: "move the seats apart (`seat.seat_distance`)",
        },
    ];
    if let Some(notch) = &seat.notch
        && notch.floor < inner[2].max(outer[2])
    {
        rules.push(Rule {
            fields: vec!["seat.notch_width", "seat.seat_distance"],
            holds: inner[0] <= -0.5 * notch.width - wall,
            message: format!(
                "the notch cuts the contact ring: the ring's innermost point is at x = {}, but it must be at most {} (half of `seat.notch_width` and a wall of 2 % of the height)",
                mm(inner[0]),
                mm(-0.5 * notch.width - wall)
            ),
            help: "make the notch narrower, or move the seats apart",
        });
    }
    broken(rules)
}

fn tips(setup: &SealSeat) -> Vec<Collision> {
    let (actuator, radius) = (&setup.actuator, setup.seat.membrane_radius);
    // Hertz's approach of a half-space, (15 m v^2 / (16 E* sqrt(R)))^(2/5), is then R.
    let energy = 15.0 / 16.0 * actuator.mass * actuator.speed.powi(2);
    let least = (energy / setup.seat.material.plane_strain_modulus()).cbrt();
    let mut rules = vec![Rule {
        fields: vec!["actuator.tip_radius", "actuator.speed"],
        holds: actuator.tip_radius >= least,
        message: format!(
            "the tips are too narrow: at `actuator.speed` {} m/s a tip goes deeper into the seat's material than its radius, `actuator.tip_radius` {}, which must be at least {}",
            actuator.speed,
            mm(actuator.tip_radius),
            mm(least)
        ),
        help: "take blunter tips, or a slower or lighter actuator",
    }];
    for (i, x) in actuator.tip_positions.iter().enumerate() {
        rules.push(Rule {
            fields: vec!["actuator.tip_positions", "seat.membrane_radius"],
            holds: x.abs() < radius,
            message: format!(
                "a tip of the actuator strikes beyond the membrane: `actuator.tip_positions` has {}, but it must be less than `seat.membrane_radius`, {}, on either side",
                mm(*x),
                mm(radius)
            ),
            help: "move the tip inwards",
        });
        let least = LEAST_TIP_DISTANCE * actuator.tip_radius;
        for other in &actuator.tip_positions[..i] {
            rules.push(Rule {
                fields: vec!["actuator.tip_positions", "actuator.tip_radius"],
                holds: (x - other).abs() >= least,
                message: format!(
                    "two tips of the actuator strike the same place: `actuator.tip_positions` has {} and {}, but their distance must be at least {} (a tenth of `actuator.tip_radius`)",
                    mm(*other),
                    mm(*x),
                    mm(least)
                ),
                help: "move the tips apart, or leave one out",
            });
        }
    }
    broken(rules)
}
