//! The keys of bodies that strike and are struck, whatever lies between them, and of impacts in series.

use crate::scene::grammar::{
    BODY_MATERIAL, Bound, Field, Kind, TIP_RADIUS, choice, one_way, only, optional, positive, pure, required,
};
use crate::scene::quantity::Dimension;

/// Smallest and largest number of elements of a reference across the contact radius.
pub(super) const CONTACT_ELEMENTS: Bound = Bound { low: Some((2.0, true)), high: Some((64.0, true)) };
/// Number of quadratic solid elements there if a scene names none.
pub(super) const SOLID_ELEMENTS: f64 = 3.0;

const SHAPE_KIND: &str = "Shape of the body";
const SPHERE_RADIUS: Field =
    only(&["sphere"], required("radius", positive(Dimension::LENGTH), "Radius of the sphere"));
const COMPACT_MASS: Field =
    only(&["compact"], required("mass", positive(Dimension::MASS), "Mass of the body"));
/// A key of the piezo stack (section 2.2.1 of the paper).
const fn stack(key: &'static str, dimension: Dimension, doc: &'static str) -> Field {
    only(&["stack"], required(key, positive(dimension), doc))
}

/// A key of one of the two ways to give a stack's inertia.
const fn inertia(set: &'static str, field: Field) -> Field {
    one_way(Some("stack"), "the stack's inertia", set, field)
}

static DRIVE: [Field; 2] = [
    required("resistance", positive(Dimension::RESISTANCE), "Resistance between buffer and stack"),
    optional(
        "buffer_capacitance",
        positive(Dimension::CAPACITANCE),
        "Capacitance of the buffer, charged to `voltage`; absent = so large that its voltage stays",
    ),
];

/// A key of the bender (section 4.3 of the paper).
const fn bender(key: &'static str, dimension: Dimension, doc: &'static str) -> Field {
    only(&["bender"], required(key, positive(dimension), doc))
}

/// A key of one of the two ways to give the bender's beam.
const fn beam(set: &'static str, field: Field) -> Field {
    one_way(Some("bender"), "the beam's stiffness and mass", set, field)
}

/// A key of one of the ways to give how far the bender is bent before it is released.
const fn drive(set: &'static str, field: Field) -> Field {
    one_way(Some("bender"), "the drive", set, field)
}

/// A key of one of the ways to give how a bender is discharged.
const fn discharge(set: &'static str, field: Field) -> Field {
    only(&["bender"], one_way(Some("bender"), "the discharge", set, field))
}

/// A key of one of the ways to give how a magnet pulls.
const fn pull(set: &'static str, field: Field) -> Field {
    one_way(Some("magnet"), "the pull", set, field)
}

/// Most points of a magnet's curve.
const MOST_POINTS: usize = 1000;

/// A point of a magnet's curve.
static PULL: [Field; 3] = [
    required(
        "way",
        Kind::Quantity(Dimension::LENGTH, Bound::NOT_NEGATIVE),
        "Way of the plunger from its start",
    ),
    one_way(
        None,
        "the magnet's pull",
        "an inductance",
        required("inductance", positive(Dimension::INDUCTANCE), "Inductance there"),
    ),
    one_way(
        None,
        "the magnet's pull",
        "a force",
        required("force", positive(Dimension::FORCE), "Force there at a current of 1 A"),
    ),
];

/// A key of the lift magnet.
const fn magnet(key: &'static str, dimension: Dimension, doc: &'static str) -> Field {
    only(&["magnet"], required(key, positive(dimension), doc))
}

const FRICTION: Field = optional(
    "friction",
    pure(Bound::NOT_NEGATIVE),
    "Coulomb's coefficient of friction of this body's contact; absent = that above the first table",
);
const SPIN: Field = optional(
    "spin",
    Kind::Quantity(Dimension::SPIN, Bound::ANY),
    "Spin about y at t = 0, positive as of a ball that rolls towards +x on a floor",
)
.otherwise("0");
const MOMENT_OF_INERTIA: Field = only(
    &["compact"],
    optional(
        "moment_of_inertia",
        positive(Dimension::MOMENT_OF_INERTIA),
        "Moment of inertia about the centre of the tip, which is the centre of mass; needed where it turns",
    ),
);

/// Angles in rad at which a body can fly towards a plane.
const TOWARDS: Bound = Bound {
    low: Some((-std::f64::consts::FRAC_PI_2, false)),
    high: Some((std::f64::consts::FRAC_PI_2, false)),
};

pub(super) static OUTER: [Field; 40] = [
    required(
        "kind",
        Kind::Choice(&[
            choice("sphere"),
            choice("compact"),
            choice("bender"),
            choice("stack"),
            choice("magnet"),
        ]),
        SHAPE_KIND,
    ),
    SPHERE_RADIUS,
    COMPACT_MASS,
    only(&["compact", "bender", "stack", "magnet"], TIP_RADIUS),
    only(
        &["bender", "stack"],
        required("length", positive(Dimension::LENGTH), "Length of the beam or of the stack"),
    ),
    magnet("mass", Dimension::MASS, "Mass of the magnet's plunger"),
    magnet("voltage", Dimension::VOLTAGE, "Voltage that is switched on"),
    magnet("resistance", Dimension::RESISTANCE, "Resistance of the magnet's circuit"),
    magnet("inductance", Dimension::INDUCTANCE, "Inductance with the plunger at its start"),
    pull(
        "the inductance at the stop",
        magnet(
            "stop_inductance",
            Dimension::INDUCTANCE,
            "Inductance with the plunger at its stop (at the plate); 1/L falls linearly over the travel",
        ),
    ),
    pull(
        "a curve",
        only(
            &["magnet"],
            required(
                "curve",
                Kind::Tables(&PULL, MOST_POINTS),
                "Points of the pull, from the start to the stop",
            ),
        ),
    ),
    magnet("travel", Dimension::LENGTH, "Way of the plunger to its stop"),
    stack("area", Dimension::AREA, "Area of the stack's section"),
    stack("stroke", Dimension::LENGTH, "Growth of the free stack at `voltage`"),
    stack("blocked_force", Dimension::FORCE, "Force of the stack at constant length, at `voltage`"),
    stack("voltage", Dimension::VOLTAGE, "Voltage that is switched on"),
    stack("capacitance", Dimension::CAPACITANCE, "Capacitance of the free stack"),
    inertia("density", stack("density", Dimension::DENSITY, "Mass density of the stack")),
    inertia(
        "first frequency",
        stack("first_frequency", Dimension::FREQUENCY, "First frequency of the stack, fixed at its base"),
    ),
    // that of lead zirconate titanate is 0.29 to 0.34
    only(
        &["stack"],
        optional(
            "poisson_ratio",
            pure(Bound { low: Some((-1.0, false)), high: Some((0.5, false)) }),
            "Poisson's ratio of the stack",
        )
        .otherwise("0.3"),
    ),
    only(
        &["stack"],
        optional(
            "gap",
            Kind::Quantity(Dimension::LENGTH, Bound::NOT_NEGATIVE),
            "Distance of the stack's tip from the plate before it is switched on",
        )
        .otherwise("0"),
    ),
    only(
        &["stack"],
        optional("drive", Kind::Table(&DRIVE), "Supply of the stack; absent = a constant-voltage source"),
    ),
    bender("tip_mass", Dimension::MASS, "Point mass at the tip of the beam"),
    beam(
        "section",
        bender("bending_stiffness", Dimension::BENDING_STIFFNESS, "Bending stiffness E I of the beam"),
    ),
    beam("section", bender("line_mass", Dimension::LINE_MASS, "Mass of the beam per length, rho A")),
    beam(
        "measured",
        bender("first_frequency", Dimension::FREQUENCY, "Measured first frequency with the tip mass"),
    ),
    beam(
        "measured",
        bender("tip_stiffness", Dimension::STIFFNESS, "Measured force at the tip per deflection"),
    ),
    drive(
        "torque",
        bender("torque", Dimension::TORQUE, "Bending moment, uniform along the beam, before the release"),
    ),
    drive(
        "deflection",
        bender("tip_deflection", Dimension::LENGTH, "Deflection of the tip before the release"),
    ),
    only(
        &["bender"],
        optional(
            "offset",
            Kind::Quantity(Dimension::LENGTH, Bound::ANY),
            "Deflection of the bender's tip at contact with the plate, negative = beyond its straight position",
        )
        .otherwise("0"),
    ),
    discharge(
        "circuit",
        optional("capacitance", positive(Dimension::CAPACITANCE), "Capacitance of the bender"),
    ),
    discharge(
        "circuit",
        optional(
            "discharge_resistance",
            positive(Dimension::RESISTANCE),
            "Resistance through which the bender is discharged",
        ),
    ),
    discharge(
        "time",
        optional(
            "discharge_time",
            Kind::Quantity(Dimension::TIME, Bound::NOT_NEGATIVE),
            "Time constant with which the drive's moment decays after the release; 0 = it is gone at once",
        )
        .otherwise("0"),
    ),
    BODY_MATERIAL,
    only(
        &["sphere", "compact", "bender"],
        drive(
            "speed",
            required(
                "speed",
                positive(Dimension::SPEED),
                "Speed towards what it strikes; of a bender that of its tip",
            ),
        ),
    ),
    only(
        &["sphere", "compact"],
        optional(
            "offset",
            Kind::Quantity(Dimension::LENGTH, Bound::NOT_NEGATIVE),
            "Distance of the point of impact from the axis, along x",
        )
        .otherwise("0"),
    ),
    only(
        &["sphere", "compact"],
        optional(
            "angle",
            Kind::Quantity(Dimension::ANGLE, TOWARDS),
            "Angle of the velocity against the normal of what it strikes, positive = towards +x",
        )
        .otherwise("0"),
    ),
    only(&["sphere", "compact"], FRICTION),
    only(&["sphere", "compact"], SPIN),
    MOMENT_OF_INERTIA,
];

pub(super) static INNER: [Field; 10] = [
    required("kind", Kind::Choice(&[choice("sphere"), choice("compact")]), SHAPE_KIND),
    SPHERE_RADIUS,
    COMPACT_MASS,
    only(&["compact"], TIP_RADIUS),
    BODY_MATERIAL,
    optional(
        "gap",
        Kind::Quantity(Dimension::LENGTH, Bound::NOT_NEGATIVE),
        "Initial distance to the plate, which changes nothing where there is none",
    )
    .otherwise("0"),
    optional(
        "speed",
        Kind::Quantity(Dimension::SPEED, Bound::ANY),
        "Speed towards the plate, or towards the outer body without one, at its first contact; negative = away from it",
    )
    .otherwise("0"),
    FRICTION,
    SPIN,
    MOMENT_OF_INERTIA,
];

/// Most impacts of a series.
const MAX_IMPACTS: u64 = 200;

pub(super) static SERIES: [Field; 2] = [
    required("impacts", Kind::Count(1, MAX_IMPACTS), "Number of impacts at most"),
    optional(
        "sphere_spot",
        Kind::Choice(&[choice("same"), choice("fresh")]),
        "Whether outer and inner body meet the plate each time with the same spot or with one that has not yielded yet",
    )
    .otherwise("same"),
];
