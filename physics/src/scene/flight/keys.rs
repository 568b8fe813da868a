//! The keys of flight and vibration.

use crate::scene::grammar::{Bound, Field, Kind, choice, one_way, only, optional, positive, pure, required};
use crate::scene::quantity::Dimension;

/// What a table `[flight]` is for.
pub(crate) const FLIGHT: &str =
    "Flight of the sphere after the impact, to its seat; absent = none. Does not change the impact";

const TURN: Bound =
    Bound { low: Some((-std::f64::consts::PI, true)), high: Some((std::f64::consts::PI, true)) };
const SHARE: Bound = Bound { low: Some((0.0, true)), high: Some((1.0, true)) };

const fn not_negative(dimension: Dimension) -> Kind {
    Kind::Quantity(dimension, Bound::NOT_NEGATIVE)
}

static SPRING: [Field; 5] = [
    required("force", positive(Dimension::FORCE), "Force on a sphere that rests in a seat"),
    optional(
        "stiffness",
        not_negative(Dimension::STIFFNESS),
        "Decrease of the force per displacement of the sphere",
    ).otherwise("0"),
    one_way(
        None,
        "where the spring pushes from",
        "a direction",
        optional(
            "angle",
            Kind::Quantity(Dimension::ANGLE, TURN),
            "Direction of its push against -z, positive towards +x",
        ).otherwise("0"),
    ),
    one_way(
        None,
        "where the spring pushes from",
        "an anchor",
        optional(
            "anchor_distance",
            positive(Dimension::LENGTH),
            "Distance of its fixed end above the middle between the seats",
        ),
    ),
    optional(
        "friction",
        pure(Bound::NOT_NEGATIVE),
        "Coulomb's coefficient with which its last turn resists every turn of the sphere; 0 = it pushes through a point",
    ).otherwise("0"),
];

const HEIGHT: Field = required("chamber_height", positive(Dimension::LENGTH), "z of the chamber's ceiling");
const GRAVITY: Field =
    optional("gravity", not_negative(Dimension::ACCELERATION), "Gravity").otherwise("9.80665 m/s^2");
const GRAVITY_ANGLE: Field = optional(
    "gravity_angle",
    Kind::Quantity(Dimension::ANGLE, TURN),
    "Direction of gravity against -z, positive towards +x",
)
.otherwise("0");
const SPRING_KEY: Field = optional(
    "spring",
    Kind::Table(&SPRING),
    "The spring that presses the sphere into its seats; absent = none",
);
const FRICTION: Field =
    required("friction", pure(Bound::NOT_NEGATIVE), "Coulomb's coefficient of friction of sphere and walls");
const FLUID_DENSITY: Field = one_way(
    None,
    "drag",
    "drag",
    optional("fluid_density", positive(Dimension::DENSITY), "Density of the fluid; absent = no drag"),
);
const DRAG_COEFFICIENT: Field =
    one_way(None, "drag", "drag", optional("drag_coefficient", pure(Bound::NOT_NEGATIVE), "c_W of eq. (2)"));
const END_TIME: Field =
    optional("end_time", positive(Dimension::TIME), "Longest time of a flight without a result")
        .otherwise("1 s");
const SPEED_DEVIATION: Field =
    optional("speed_scatter", pure(SHARE), "Half width of the range of the launch's speed, relative")
        .otherwise("0.01");
const ANGLE_DEVIATION: Field = optional(
    "angle_scatter",
    not_negative(Dimension::ANGLE),
    "Half width of the range of the launch's angle",
)
.otherwise("0.5 deg");
const RESTITUTION_DEVIATION: Field =
    optional("restitution_scatter", pure(SHARE), "Half width of the range of the restitution")
        .otherwise("0.02");

/// Of a seal seat, whose shape is the chamber's floor.
pub(crate) static SEAT_FLIGHT: [Field; 12] = [
    HEIGHT,
    GRAVITY,
    GRAVITY_ANGLE,
    SPRING_KEY,
    optional(
        "restitution",
        pure(SHARE),
        "Newton's coefficient of restitution; absent = computed: the sphere falls on the model of the seat",
    ),
    FRICTION,
    FLUID_DENSITY,
    DRAG_COEFFICIENT,
    END_TIME,
    SPEED_DEVIATION,
    ANGLE_DEVIATION,
    RESTITUTION_DEVIATION,
];

/// Behind a plate: over a rocker.
pub(crate) static PLATE_FLIGHT: [Field; 13] = [
    required("travel", positive(Dimension::LENGTH), "Way of the sphere from one position to the other"),
    HEIGHT,
    GRAVITY,
    GRAVITY_ANGLE,
    SPRING_KEY,
    required("restitution", pure(SHARE), "Newton's coefficient of restitution of walls and floor"),
    FRICTION,
    FLUID_DENSITY,
    DRAG_COEFFICIENT,
    END_TIME,
    SPEED_DEVIATION,
    ANGLE_DEVIATION,
    RESTITUTION_DEVIATION,
];

/// Most samples of a record.
pub(super) const MOST_SAMPLES: usize = 10_000;
const SAMPLES: &str = "the record's samples";

pub(in crate::scene) static VIBRATION: [Field; 8] = [
    required(
        "kind",
        Kind::Choice(&[choice("sine"), choice("half-sine"), choice("record")]),
        "Course of the acceleration of the valve",
    ),
    optional(
        "angle",
        Kind::Quantity(Dimension::ANGLE, TURN),
        "Direction of the acceleration against z, positive towards +x; -90 deg = away from the other seat",
    )
    .otherwise("-90 deg"),
    only(&["sine"], required("frequency", positive(Dimension::FREQUENCY), "Frequency of the sine")),
    only(&["sine"], optional("periods", Kind::Count(1, 1000), "Number of its periods").otherwise("10")),
    only(&["half-sine"], required("duration", positive(Dimension::TIME), "Length of the shock")),
    only(
        &["record"],
        one_way(
            Some("record"),
            SAMPLES,
            "lists",
            required(
                "time",
                Kind::Quantities(Dimension::TIME, Bound::NOT_NEGATIVE, MOST_SAMPLES),
                "Times of the samples, from 0 on",
            ),
        ),
    ),
    only(
        &["record"],
        one_way(
            Some("record"),
            SAMPLES,
            "lists",
            required(
                "acceleration",
                Kind::Quantities(Dimension::ACCELERATION, Bound::ANY, MOST_SAMPLES),
                "Accelerations, of which the thresholds are multiples",
            ),
        ),
    ),
    only(
        &["record"],
        one_way(
            Some("record"),
            SAMPLES,
            "a file",
            required(
                "file",
                Kind::Text,
                "Table in CSV with the columns time and acceleration, in the folder of the scene file",
            ),
        ),
    ),
];
