//! Every key a scene file may have: one table that drives reading, checking and the JSON schema.

use super::external::EXTERNAL;
use super::flight::{PLATE_FLIGHT, SEAT_FLIGHT, VIBRATION};
use super::grammar::{Bound, Field, Kind, choice, only, optional, positive, pure, required};
use super::material::MATERIAL;
use super::plate_impact::{FLUID, INNER, OUTER, PLATE, REDUCED, REFERENCE, SERIES};
use super::quantity::Dimension;
use super::seal_seat::{ACTUATOR, INTENDED, SEAT, SEAT_REDUCED, SEAT_REFERENCE, SEATED_SPHERE};
use super::{PLATE_IMPACT, SEAL_SEAT};

const OF_PLATE_IMPACT: &[&str] = &[PLATE_IMPACT];
const OF_SEAL_SEAT: &[&str] = &[SEAL_SEAT];

/// The keys of a scene file. A key whose table depends on the scene's kind stands here once per kind.
pub(super) static SCENE: [Field; 24] = [
    required("name", Kind::Name, "Name of the scene in the store and in reports"),
    optional("description", Kind::Text, "One line for people"),
    required("kind", Kind::Choice(&[choice(PLATE_IMPACT), choice(SEAL_SEAT)]), "What strikes what"),
    required("materials", Kind::TableOf(&MATERIAL), "Materials by name"),
    only(OF_PLATE_IMPACT, required("plate", Kind::Table(&PLATE), "Circular plate of constant thickness")),
    only(
        OF_PLATE_IMPACT,
        required("outer", Kind::Table(&OUTER), "The body that strikes the plate from above"),
    ),
    only(OF_PLATE_IMPACT, required("inner", Kind::Table(&INNER), "The body below the plate")),
    optional(
        "friction",
        pure(Bound::NOT_NEGATIVE),
        "Coulomb's coefficient of friction between plate or seat and bodies, which the reference has; absent = 0",
    ),
    only(OF_PLATE_IMPACT, optional("fluid", Kind::Table(&FLUID), "Fluid on the inner side; absent = dry")),
    only(
        OF_PLATE_IMPACT,
        optional(
            "series",
            Kind::Table(&SERIES),
            "The impact repeated, each time with the dents of those before",
        ),
    ),
    only(
        OF_SEAL_SEAT,
        required("seat", Kind::Table(&SEAT), "Membrane and island with the two seats, one piece"),
    ),
    only(
        OF_SEAL_SEAT,
        required("sphere", Kind::Table(&SEATED_SPHERE), "The sphere, at rest in the seat at x < 0"),
    ),
    only(
        OF_SEAL_SEAT,
        required(
            "actuator",
            Kind::Table(&ACTUATOR),
            "Strikes the underside from below; rigid, guided along z",
        ),
    ),
    only(OF_SEAL_SEAT, required("intended", Kind::Table(&INTENDED), "Where the sphere is meant to fly")),
    optional("run", Kind::Table(&RUN), "Length of the run"),
    only(OF_PLATE_IMPACT, optional("reduced", Kind::Table(&REDUCED), "Settings of the reduced model")),
    only(OF_SEAL_SEAT, optional("reduced", Kind::Table(&SEAT_REDUCED), "Settings of the reduced model")),
    only(
        OF_PLATE_IMPACT,
        optional("reference", Kind::Table(&REFERENCE), "Settings of the finite-element reference"),
    ),
    only(
        OF_SEAL_SEAT,
        optional("reference", Kind::Table(&SEAT_REFERENCE), "Settings of the finite-element reference"),
    ),
    only(
        OF_PLATE_IMPACT,
        optional(
            "uncertainty",
            Kind::Uncertainty,
            "How uncertain the scene's numbers are, by the names of their fields; changes no result",
        ),
    ),
    only(OF_PLATE_IMPACT, optional("flight", Kind::Table(&PLATE_FLIGHT), FLIGHT)),
    only(OF_SEAL_SEAT, optional("flight", Kind::Table(&SEAT_FLIGHT), FLIGHT)),
    optional(
        "vibration",
        Kind::Table(&VIBRATION),
        "How the valve is shaken; absent = not asked for. Changes nothing of the impact",
    ),
    optional(
        "external",
        Kind::Tables(&EXTERNAL, 16),
        "Programs of one's own that solve the scene too; they run only with --allow-external",
    ),
];

const FLIGHT: &str = "The flight of the sphere after the impact, to its seat; absent = not asked for. Changes nothing of the impact";

static RUN: [Field; 1] = [optional(
    "end_time",
    positive(Dimension::TIME),
    "End time after the first touch; absent = until no further contact is possible",
)];

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
