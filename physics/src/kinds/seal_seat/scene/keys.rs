//! The keys of a seal seat.

use crate::scene::flight::{FLIGHT, SEAT_FLIGHT};
use crate::scene::grammar::{
    BODY_MATERIAL, Bound, Field, Kind, TIP_RADIUS, choice, one_way, optional, positive, pure, required,
};
use crate::scene::quantity::Dimension;

const ACUTE: Bound = Bound { low: Some((0.0, true)), high: Some((std::f64::consts::FRAC_PI_2, false)) };
const CONE: Bound = Bound { low: Some((0.0, false)), high: Some((std::f64::consts::PI, false)) };
const HALF_TURN: Bound =
    Bound { low: Some((-std::f64::consts::PI, true)), high: Some((std::f64::consts::PI, true)) };

/// A key of the notch.
const fn notch(key: &'static str, doc: &'static str) -> Field {
    one_way(None, "the notch", "notch", optional(key, positive(Dimension::LENGTH), doc))
}

/// The keys that only a seal seat has.
pub(super) fn keys() -> Vec<Field> {
    vec![
        required("seat", Kind::Table(&SEAT), "Membrane and island with the two seats, one piece"),
        required("sphere", Kind::Table(&SPHERE), "The sphere, at rest in the seat at x < 0"),
        required(
            "actuator",
            Kind::Table(&ACTUATOR),
            "Strikes the underside from below; rigid, guided along z",
        ),
        required("intended", Kind::Table(&INTENDED), "Where the sphere is meant to fly"),
        optional("reduced", Kind::Table(&REDUCED), "Settings of the reduced model"),
        optional("reference", Kind::Table(&REFERENCE), "Settings of the finite-element reference"),
        optional("flight", Kind::Table(&SEAT_FLIGHT), FLIGHT),
    ]
}

static SEAT: [Field; 14] = [
    required("material", Kind::Material, "Material of the whole piece, a name under [materials]"),
    required("membrane_radius", positive(Dimension::LENGTH), "Radius of the membrane, whose rim is clamped"),
    required("membrane_thickness", positive(Dimension::LENGTH), "Thickness of the membrane, from z = 0 up"),
    required("island_length", positive(Dimension::LENGTH), "Length of the island along x"),
    required("island_width", positive(Dimension::LENGTH), "Width of the island along y"),
    required("island_height", positive(Dimension::LENGTH), "z of the island's top"),
    required("seat_distance", positive(Dimension::LENGTH), "Distance of the two seated centres along x"),
    required(
        "seated_height",
        positive(Dimension::LENGTH),
        "z of the centre of a sphere that rests in a seat",
    ),
    required(
        "tilt",
        Kind::Quantity(Dimension::ANGLE, ACUTE),
        "alpha: inward tilt of the seats' axes against z",
    ),
    required("aperture_angle", Kind::Quantity(Dimension::ANGLE, CONE), "gamma: full angle of the cones"),
    required("bore_radius", positive(Dimension::LENGTH), "Radius of the bores"),
    required(
        "bore_depth",
        positive(Dimension::LENGTH),
        "Depth of the bores' floors below the seated centres",
    ),
    notch("notch_width", "Width of the slot between the seats along x; absent = no slot"),
    notch("notch_floor", "z of the slot's floor"),
];

static SPHERE: [Field; 4] = [
    required("radius", positive(Dimension::LENGTH), "Radius of the sphere"),
    BODY_MATERIAL,
    optional("mass", positive(Dimension::MASS), "Mass of the sphere; absent = that of a full one"),
    optional(
        "body",
        Kind::Choice(&[choice("rigid"), choice("elastic")]),
        "Whether the sphere deforms, in the reference",
    )
    .otherwise("rigid"),
];

/// Largest number of tips of the actuator.
const MOST_TIPS: usize = 8;

static ACTUATOR: [Field; 4] = [
    required("mass", positive(Dimension::MASS), "Mass of the actuator"),
    required("speed", positive(Dimension::SPEED), "Speed towards the seat"),
    TIP_RADIUS,
    required(
        "tip_positions",
        Kind::Quantities(Dimension::LENGTH, Bound::ANY, MOST_TIPS),
        "x of each tip, at y = 0 below the underside",
    ),
];

static INTENDED: [Field; 1] = [required(
    "angle",
    Kind::Quantity(Dimension::ANGLE, HALF_TURN),
    "Direction of the sphere's flight against z, positive towards +x",
)];

static REDUCED: [Field; 2] = [
    optional("model", Kind::Choice(&[choice("C")]), "Model to run: this kind has model C only"),
    optional("modes", Kind::Count(1, 1024), "Number of modes of the seat; absent = 32"),
];

/// Smallest and largest number of elements across the ring's radius.
const RING_ELEMENTS: Bound = Bound { low: Some((1.0, true)), high: Some((64.0, true)) };

static REFERENCE: [Field; 2] = [
    optional(
        "element_order",
        Kind::Count(1, 2),
        "Order of the tetrahedra: 1 linear, 2 quadratic; absent = 2",
    ),
    optional(
        "elements_per_ring_radius",
        pure(RING_ELEMENTS),
        "Elements across the radius of the contact ring at `paper` resolution",
    )
    .otherwise("10"),
];
