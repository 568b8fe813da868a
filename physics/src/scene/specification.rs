//! Every key a scene file may have: one table that drives reading, checking and the JSON schema.

use super::quantity::Dimension;
use super::seat_specification::{ACTUATOR, INTENDED, SEAT, SEAT_REDUCED, SEAT_REFERENCE, SEATED_SPHERE};

/// Valid range of a number, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bound {
    /// Lower end and whether it is valid itself.
    pub(super) low: Option<(f64, bool)>,
    /// Upper end and whether it is valid itself.
    pub(super) high: Option<(f64, bool)>,
}

impl Bound {
    const POSITIVE: Bound = Bound { low: Some((0.0, false)), high: None };
    pub(super) const NOT_NEGATIVE: Bound = Bound { low: Some((0.0, true)), high: None };
    pub(super) const ANY: Bound = Bound { low: None, high: None };

    /// Whether `value` is valid.
    pub(super) fn holds(&self, value: f64) -> bool {
        let above = self.low.is_none_or(|(b, valid)| value > b || (valid && value == b));
        let below = self.high.is_none_or(|(b, valid)| value < b || (valid && value == b));
        value.is_finite() && above && below
    }

    /// The same range of an angle in degrees; rounding is left out.
    pub(super) fn in_degrees(&self) -> Self {
        let of =
            |end: Option<(f64, bool)>| end.map(|(b, valid)| ((b.to_degrees() * 1e9).round() / 1e9, valid));
        Self { low: of(self.low), high: of(self.high) }
    }

    /// "greater than 0 m", "at least 0 and less than 1".
    pub(super) fn describe(&self, unit: &str) -> String {
        let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
        let word = |at: Option<(f64, bool)>, valid: &str, open: &str| {
            at.map(|(b, v)| format!("{} {b}{unit}", if v { valid } else { open }))
        };
        let ends = [word(self.low, "at least", "greater than"), word(self.high, "at most", "less than")];
        let ends: Vec<String> = ends.into_iter().flatten().collect();
        if ends.is_empty() { format!("finite{unit}") } else { ends.join(" and ") }
    }
}

/// One value of a key that has a fixed set of them.
#[derive(Debug)]
pub(super) struct Choice {
    pub(super) name: &'static str,
}

pub(super) const fn choice(name: &'static str) -> Choice {
    Choice { name }
}

/// What stands behind a key.
#[derive(Debug)]
pub(super) enum Kind {
    /// Any text.
    Text,
    /// A text that can name a folder.
    Name,
    /// One of a few words.
    Choice(&'static [Choice]),
    /// A number with a unit.
    Quantity(Dimension, Bound),
    /// A list of numbers with units, of at least one and at most so many.
    Quantities(Dimension, Bound, usize),
    /// A whole number in a range, both ends valid.
    Count(u64, u64),
    /// true or false.
    Flag,
    /// The name of a table under `[materials]`.
    Material,
    /// A table with fixed keys.
    Table(&'static [Field]),
    /// A table of tables with fixed keys under names of the user's choice.
    TableOf(&'static [Field]),
    /// `[tolerances.<model>]`, see `tolerances.rs`.
    Tolerances,
}

/// One key.
#[derive(Debug)]
pub(super) struct Field {
    pub(super) key: &'static str,
    pub(super) kind: Kind,
    pub(super) required: bool,
    /// The key belongs to these `kind`s (or `geometry`s) of its table only; empty = to all.
    pub(super) only: &'static [&'static str],
    /// The key is part of one of several ways to say a thing.
    pub(super) alternative: Option<Alternative>,
    pub(super) doc: &'static str,
}

/// Several sets of keys say the same thing: one set has to be there and complete, no other may be. If the keys are
/// optional, all sets may be absent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Alternative {
    /// The `kind` of the table for which this holds; `None` = for any.
    pub(super) kind: Option<&'static str>,
    /// What the sets say.
    pub(super) group: &'static str,
    /// The set the key belongs to.
    pub(super) set: &'static str,
}

impl Field {
    /// The alternative the key is part of in a table of this `kind`.
    pub(super) fn alternative(&self, kind: Option<&str>) -> Option<Alternative> {
        self.alternative.filter(|a| a.kind.is_none() || a.kind == kind)
    }

    /// Whether the key has to be there by itself in a table of this `kind`.
    pub(super) fn is_needed(&self, kind: Option<&str>) -> bool {
        self.required && self.alternative(kind).is_none() && self.belongs_to(kind)
    }

    /// Whether the key is one of a table of this `kind`.
    pub(super) fn belongs_to(&self, kind: Option<&str>) -> bool {
        self.only.is_empty() || kind.is_some_and(|k| self.only.contains(&k))
    }
}

pub(super) const fn required(key: &'static str, kind: Kind, doc: &'static str) -> Field {
    Field { key, kind, required: true, only: &[], alternative: None, doc }
}

pub(super) const fn optional(key: &'static str, kind: Kind, doc: &'static str) -> Field {
    Field { key, kind, required: false, only: &[], alternative: None, doc }
}

const fn only(kinds: &'static [&'static str], field: Field) -> Field {
    Field { only: kinds, ..field }
}

pub(super) const fn one_way(
    kind: Option<&'static str>,
    group: &'static str,
    set: &'static str,
    field: Field,
) -> Field {
    Field { alternative: Some(Alternative { kind, group, set }), ..field }
}

pub(super) const fn positive(dimension: Dimension) -> Kind {
    Kind::Quantity(dimension, Bound::POSITIVE)
}

pub(super) const fn pure(bound: Bound) -> Kind {
    Kind::Quantity(Dimension::NONE, bound)
}

/// Smallest and largest number of elements across the contact radius.
const ELEMENTS: Bound = Bound { low: Some((2.0, true)), high: Some((64.0, true)) };
const POISSON: Bound = Bound { low: Some((-1.0, false)), high: Some((0.5, false)) };
const FRACTION: Bound = Bound { low: Some((0.0, false)), high: Some((1.0, true)) };

/// The names of the reduced models.
pub(super) const MODELS: [Choice; 3] = [choice("A"), choice("B"), choice("C")];

const PLATE_IMPACT: &[&str] = &["plate-impact"];
const SEAL_SEAT: &[&str] = &["seal-seat"];

/// The keys of a scene file. A key whose table depends on the scene's kind stands here once per kind.
pub(super) static SCENE: [Field; 17] = [
    required("name", Kind::Name, "Name of the scene in the store and in reports"),
    optional("description", Kind::Text, "One line for people"),
    required("kind", Kind::Choice(&[choice("plate-impact"), choice("seal-seat")]), "What strikes what"),
    required("materials", Kind::TableOf(&MATERIAL), "Materials by name"),
    only(PLATE_IMPACT, required("plate", Kind::Table(&PLATE), "Circular plate of constant thickness")),
    only(PLATE_IMPACT, required("outer", Kind::Table(&OUTER), "The body that strikes the plate from above")),
    only(PLATE_IMPACT, required("inner", Kind::Table(&INNER), "The body that rests below the plate")),
    only(PLATE_IMPACT, optional("fluid", Kind::Table(&FLUID), "Fluid on the inner side; absent = dry")),
    only(
        SEAL_SEAT,
        required("seat", Kind::Table(&SEAT), "Membrane and island with the two seats, one piece"),
    ),
    only(
        SEAL_SEAT,
        required("sphere", Kind::Table(&SEATED_SPHERE), "The sphere, at rest in the seat at x < 0"),
    ),
    only(
        SEAL_SEAT,
        required(
            "actuator",
            Kind::Table(&ACTUATOR),
            "Strikes the underside from below; rigid, guided along z",
        ),
    ),
    only(SEAL_SEAT, required("intended", Kind::Table(&INTENDED), "Where the sphere is meant to fly")),
    optional("run", Kind::Table(&RUN), "Length of the run"),
    only(PLATE_IMPACT, optional("reduced", Kind::Table(&REDUCED), "Settings of the reduced model")),
    only(SEAL_SEAT, optional("reduced", Kind::Table(&SEAT_REDUCED), "Settings of the reduced model")),
    only(
        PLATE_IMPACT,
        optional("reference", Kind::Table(&REFERENCE), "Settings of the finite-element reference"),
    ),
    only(
        SEAL_SEAT,
        optional("reference", Kind::Table(&SEAT_REFERENCE), "Settings of the finite-element reference"),
    ),
];

/// Stands apart from [`SCENE`] because its shape is checked by its own reader.
pub(super) static TOLERANCES: Field =
    optional("tolerances", Kind::Tolerances, "Tolerances of the gate, by reduced model and quantity");

static MATERIAL: [Field; 4] = [
    required("youngs_modulus", positive(Dimension::PRESSURE), "Young's modulus E"),
    required("poisson_ratio", pure(POISSON), "Poisson's ratio nu"),
    required("density", positive(Dimension::DENSITY), "Density rho"),
    optional(
        "yield_strength",
        positive(Dimension::PRESSURE),
        "Yield strength in uniaxial tension, beyond which contacts are warned of; absent = not checked",
    ),
];

static PLATE: [Field; 5] = [
    required("radius", positive(Dimension::LENGTH), "Radius R of the plate"),
    required("thickness", positive(Dimension::LENGTH), "Thickness t of the plate"),
    required(
        "edge",
        Kind::Choice(&[choice("clamped"), choice("simply-supported"), choice("free")]),
        "Support of the rim",
    ),
    required("material", Kind::Material, "Material of the plate, a name under [materials]"),
    optional("damping_ratio", pure(Bound::NOT_NEGATIVE), "Modal damping ratio of every mode; 0 = undamped"),
];

const SHAPE_KIND: &str = "Shape of the body";
const SPHERE_RADIUS: Field =
    only(&["sphere"], required("radius", positive(Dimension::LENGTH), "Radius of the sphere"));
const COMPACT_MASS: Field =
    only(&["compact"], required("mass", positive(Dimension::MASS), "Mass of the body"));
pub(super) const TIP_RADIUS: Field =
    required("tip_radius", positive(Dimension::LENGTH), "Radius of the spherical tip");
pub(super) const BODY_MATERIAL: Field =
    required("material", Kind::Material, "Material of the body, a name under [materials]");

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

static OUTER: [Field; 15] = [
    required("kind", Kind::Choice(&[choice("sphere"), choice("compact"), choice("bender")]), SHAPE_KIND),
    SPHERE_RADIUS,
    COMPACT_MASS,
    only(&["compact", "bender"], TIP_RADIUS),
    bender("length", Dimension::LENGTH, "Length of the beam"),
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
            "discharge_time",
            Kind::Quantity(Dimension::TIME, Bound::NOT_NEGATIVE),
            "Time constant with which the drive's moment decays after the release; absent = it is gone at once",
        ),
    ),
    BODY_MATERIAL,
    drive(
        "speed",
        required("speed", positive(Dimension::SPEED), "Speed towards the plate; of a bender that of its tip"),
    ),
];

static INNER: [Field; 6] = [
    required("kind", Kind::Choice(&[choice("sphere"), choice("compact")]), SHAPE_KIND),
    SPHERE_RADIUS,
    COMPACT_MASS,
    only(&["compact"], TIP_RADIUS),
    BODY_MATERIAL,
    optional(
        "gap",
        Kind::Quantity(Dimension::LENGTH, Bound::NOT_NEGATIVE),
        "Initial distance to the plate; absent = 0",
    ),
];

/// A key of the shear-thinning viscosity law.
const fn thinning(key: &'static str, kind: Kind, doc: &'static str) -> Field {
    one_way(None, "shear thinning", "shear thinning", optional(key, kind, doc))
}

static FLUID: [Field; 10] = [
    required("viscosity", positive(Dimension::VISCOSITY), "Dynamic viscosity"),
    required("density", positive(Dimension::DENSITY), "Density of the fluid"),
    required("minimum_gap", positive(Dimension::LENGTH), "Minimal gap of eq. (4)"),
    optional("squeeze_film", Kind::Flag, "Whether the squeeze film of eq. (3) acts; absent = true"),
    optional(
        "added_mass_frequency_ratio",
        pure(FRACTION),
        "First wet over first dry eigenfrequency; absent = 1, no added mass",
    ),
    optional(
        "plate_damping_ratio",
        pure(Bound::NOT_NEGATIVE),
        "Modal damping ratio of the wet plate; absent = that of the dry plate",
    ),
    optional("drag_coefficient", pure(Bound::NOT_NEGATIVE), "c_W of eq. (2); absent = 0, no drag"),
    thinning(
        "infinite_shear_viscosity",
        positive(Dimension::VISCOSITY),
        "Carreau's law: viscosity at high shear rates, `viscosity` being that at rest; absent = Newtonian",
    ),
    thinning("relaxation_time", positive(Dimension::TIME), "Carreau's law: time lambda"),
    thinning("power_index", pure(FRACTION), "Carreau's law: power n"),
];

static RUN: [Field; 1] = [optional(
    "end_time",
    positive(Dimension::TIME),
    "End time after the first touch; absent = until no further contact is possible",
)];

/// Most modes of a plate that a model is built with: with so many the bodies of model C take a quarter of a minute, with twice as many ten
/// times as long.
pub const MAX_MODES: usize = 256;

static REDUCED: [Field; 2] = [
    optional("model", Kind::Choice(&MODELS), "The model to run when the command line names none"),
    optional("modes", Kind::Count(1, MAX_MODES as u64), "Number of modes of the plate"),
];

static REFERENCE: [Field; 4] = [
    optional(
        "geometry",
        Kind::Choice(&[choice("axisymmetric"), choice("solid")]),
        "Geometry of the elements; absent = axisymmetric",
    ),
    optional(
        "elements_per_contact_radius",
        pure(ELEMENTS),
        "Elements across the contact radius at `paper` resolution; absent = 12, with solid geometry 3",
    ),
    only(
        &["solid"],
        optional(
            "element_order",
            Kind::Count(1, 2),
            "Order of the tetrahedra: 1 linear, 2 quadratic; absent = 2",
        ),
    ),
    only(
        &["solid"],
        optional(
            "rigid",
            Kind::Choice(&[choice("none"), choice("outer"), choice("inner"), choice("both")]),
            "Spheres that are rigid; absent = none",
        ),
    ),
];

/// Default of `reference.geometry`.
pub(super) const DEFAULT_GEOMETRY: &str = "axisymmetric";
/// Default of `reference.elements_per_contact_radius` with axisymmetric geometry (bilinear elements).
pub(super) const DEFAULT_ELEMENTS: f64 = 12.0;
/// The same with solid geometry (quadratic elements).
pub(super) const DEFAULT_SOLID_ELEMENTS: f64 = 3.0;

/// The SI unit of the quantity at `path` in a scene's JSON form, such as `plate.material.density`.
pub fn unit_of(path: &str) -> Option<&'static str> {
    fn find(fields: &[Field], path: &str) -> Option<&'static str> {
        let (key, rest) = path.split_once('.').map_or((path, None), |(key, rest)| (key, Some(rest)));
        // A key may stand here several times, once per kind of the scene.
        fields.iter().filter(|f| f.key == key).find_map(|field| match (&field.kind, rest) {
            (Kind::Table(inner), Some(rest)) => find(inner, rest),
            // In JSON a material stands where it is used.
            (Kind::Material, Some(rest)) => find(&MATERIAL, rest),
            (Kind::Quantity(dimension, _) | Kind::Quantities(dimension, ..), None) => {
                Some(dimension.describe().1)
            }
            _ => None,
        })
    }
    // Two things have another name in JSON than in the file.
    let path = path.replace("seat.notch.", "seat.notch_").replace("intended_angle", "intended.angle");
    find(&SCENE, &path)
}
