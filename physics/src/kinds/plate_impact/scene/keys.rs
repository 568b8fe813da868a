//! The keys of a plate impact.

use crate::kinds::body_keys::{CONTACT_ELEMENTS, INNER, OUTER, SERIES};
use crate::scene::flight::{FLIGHT, PLATE_FLIGHT};
use crate::scene::grammar::{
    Bound, Field, Kind, MODELS, choice, one_way, optional, positive, pure, required,
};
use crate::scene::quantity::Dimension;

const FRACTION: Bound = Bound { low: Some((0.0, false)), high: Some((1.0, true)) };

/// The keys that only a plate impact has.
pub(super) fn keys() -> Vec<Field> {
    vec![
        required("plate", Kind::Table(&PLATE), "Circular plate of constant thickness"),
        required("outer", Kind::Table(&OUTER), "The body that strikes the plate from above"),
        required("inner", Kind::Table(&INNER), "The body below the plate"),
        optional("fluid", Kind::Table(&FLUID), "Fluid on the inner side; absent = dry"),
        optional(
            "series",
            Kind::Table(&SERIES),
            "Repeated impacts, each with the plastic indentations of those before",
        ),
        optional("reduced", Kind::Table(&REDUCED), "Settings of the reduced model"),
        optional("reference", Kind::Table(&REFERENCE), "Settings of the finite-element reference"),
        optional(
            "uncertainty",
            Kind::Uncertainty,
            "How uncertain the scene's numbers are, by the names of their fields; changes no result",
        ),
        optional("flight", Kind::Table(&PLATE_FLIGHT), FLIGHT),
    ]
}

pub(in crate::kinds) static PLATE: [Field; 5] = [
    required("radius", positive(Dimension::LENGTH), "Radius R of the plate"),
    required("thickness", positive(Dimension::LENGTH), "Thickness t of the plate"),
    required(
        "edge",
        Kind::Choice(&[choice("clamped"), choice("simply-supported"), choice("free")]),
        "Support of the edge",
    ),
    required("material", Kind::Material, "Material of the plate, a name under [materials]"),
    optional("damping_ratio", pure(Bound::NOT_NEGATIVE), "Modal damping ratio of every mode").otherwise("0"),
];

/// A key of the shear-thinning viscosity law.
const fn thinning(key: &'static str, kind: Kind, doc: &'static str) -> Field {
    one_way(None, "shear thinning", "shear thinning", optional(key, kind, doc))
}

static FLUID: [Field; 10] = [
    required("viscosity", positive(Dimension::VISCOSITY), "Dynamic viscosity"),
    required("density", positive(Dimension::DENSITY), "Density of the fluid"),
    required("minimum_gap", positive(Dimension::LENGTH), "Minimal gap of eq. (4)"),
    optional("squeeze_film", Kind::Flag, "Whether the squeeze film of eq. (3) acts").otherwise("true"),
    optional(
        "added_mass_frequency_ratio",
        pure(FRACTION),
        "First wet over first dry eigenfrequency; 1 = no added mass",
    )
    .otherwise("1"),
    optional(
        "plate_damping_ratio",
        pure(Bound::NOT_NEGATIVE),
        "Modal damping ratio of the wet plate; absent = that of the dry plate",
    ),
    optional("drag_coefficient", pure(Bound::NOT_NEGATIVE), "c_W of eq. (2); 0 = no drag").otherwise("0"),
    thinning(
        "infinite_shear_viscosity",
        positive(Dimension::VISCOSITY),
        "Carreau's law: viscosity at high shear rates, `viscosity` being that at rest; absent = Newtonian",
    ),
    thinning("relaxation_time", positive(Dimension::TIME), "Carreau's law: time lambda"),
    thinning("power_index", pure(FRACTION), "Carreau's law: power n"),
];

/// Most modes of a plate that a model is built with: with so many the bodies of model C take a quarter of a minute, with twice as many ten
/// times as long.
pub const MAX_MODES: usize = 256;

static REDUCED: [Field; 2] = [
    optional("model", Kind::Choice(&MODELS), "The model to run when the command line names none"),
    optional("modes", Kind::Count(1, MAX_MODES as u64), "Number of modes of the plate"),
];

static REFERENCE: [Field; 5] = [
    optional(
        "geometry",
        Kind::Choice(&[choice("axisymmetric"), choice("solid")]),
        "Geometry of the elements; absent = axisymmetric, for an off-centre or oblique impact solid",
    ),
    optional(
        "elements_per_contact_radius",
        pure(CONTACT_ELEMENTS),
        "Elements across the contact radius at `paper` resolution; absent = 12, with solid geometry 3",
    ),
    optional(
        "elements_per_thickness",
        pure(THICKNESS_ELEMENTS),
        "Elements through the plate's thickness at `paper` resolution, of solid geometry (linear ones: four times as many); at the edges of a rim that is held they are smaller by this factor once more; absent = 2",
    ),
    optional(
        "element_order",
        Kind::Count(1, 2),
        "Order of the tetrahedra of solid geometry: 1 linear, 2 quadratic; absent = 2",
    ),
    optional(
        "rigid",
        Kind::Choice(&[choice("none"), choice("outer"), choice("inner"), choice("both")]),
        "Spheres that are rigid, of solid geometry",
    )
    .otherwise("none"),
];

/// Smallest and largest number of solid elements through a plate's thickness.
const THICKNESS_ELEMENTS: Bound = Bound { low: Some((1.0, true)), high: Some((16.0, true)) };

/// Default of `reference.elements_per_thickness`.
pub(super) const THROUGH: f64 = 2.0;
/// Default of `reference.elements_per_contact_radius` with axisymmetric geometry (bilinear elements).
pub(super) const DEFAULT_ELEMENTS: f64 = 12.0;
