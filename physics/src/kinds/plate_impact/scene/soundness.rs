//! Plate impacts that can't be, and numbers that are hardly meant.

use super::super::NAME;
use super::PlateImpact;
use super::read::geometry;
use crate::flight::Chamber;
use crate::scene::collision::{Collision, Rule, broken};
use crate::scene::plausibility::{material, outside};
use crate::scene::values::Node;
use crate::scene::{Bodies, Flight, Fluid, Flyer, Geometry, Material, Plate, Shape};

/// Least and largest thickness of a plate over its radius. Of a longer rod next to nothing reaches the far face before all is over.
const SLENDERNESS: [f64; 2] = [1e-6, 10.0];
/// Sizes of what is struck and measured with these methods, in m.
const LENGTH: [f64; 2] = [1e-6, 1.0];
/// Longest time in which a stack charges, in radians of its slowest vibration: charged more slowly it presses on the plate and does not
/// strike it.
const SLOWEST_CHARGE: f64 = 1e5;

/// Share of a film's force that lubrication theory may neglect without a word.
const NEGLECTED: f64 = 0.01;

/// Keys of `reference` that solid elements alone have.
const SOLID_KEYS: [&str; 3] = ["elements_per_thickness", "element_order", "rigid"];

/// That a plate is one: the waves and contacts of any other live on scales that no run brings together.
pub(in crate::kinds) fn slenderness(plate: &Plate) -> Rule {
    let ratio = plate.thickness / plate.radius;
    let [least, most] = SLENDERNESS;
    let times = if ratio < 1.0 { format!("{ratio:.1e}") } else { format!("{ratio:.1}") };
    Rule {
        fields: vec!["plate.thickness", "plate.radius"],
        holds: (least..=most).contains(&ratio),
        message: format!(
            "`plate.thickness` is {times} times `plate.radius`; it must be between {least:e} and {most} times"
        ),
        help: "is one of them in the wrong unit?",
    }
}

/// Settings of solid elements where the reference is axisymmetric.
pub(super) fn key_collisions(root: &Node) -> Vec<Collision> {
    let Some(reference) = root.optional_table("reference").ok().flatten() else { return Vec::new() };
    let outer = root.table("outer").ok();
    let is_beside =
        |key: &str| outer.as_ref().is_some_and(|outer| outer.number(key).is_ok_and(|value| value != 0.0));
    let is_centred = !(is_beside("offset") || is_beside("angle"));
    let is_axisymmetric =
        geometry(&reference, is_centred).is_ok_and(|geometry| geometry == Geometry::Axisymmetric);
    let refused = |key: &&str| Collision {
        fields: vec![format!("reference.{key}").into()],
        message: format!("`reference.{key}` belongs to solid geometry, but the reference is axisymmetric"),
        help: "remove it, or set `reference.geometry` to \"solid\"",
    };
    SOLID_KEYS.iter().filter(|key| is_axisymmetric && reference.has(key)).map(refused).collect()
}

impl Bodies for PlateImpact {
    fn kind(&self) -> &'static str {
        NAME
    }

    fn collisions(&self) -> Vec<Collision> {
        let plate = &self.plate;
        let elastic = self.materials().iter().all(|material| material.is_elastic());
        let pair = |body: &Material| {
            let yields = body.plasticity().or(plate.material.plasticity()).is_some();
            !(yields && !(body.relaxation.is_empty() && plate.material.relaxation.is_empty()))
        };
        let single = self.fluid.is_none() && self.series.is_none();
        let dry = single && plate.damping_ratio == 0.0;
        let turn = (self.outer.shape.is_mounted() || self.outer.turning.has_inertia(&self.outer.shape))
            && self.inner.turning.has_inertia(&self.inner.shape);
        let straight = self.outer.is_centred() && !self.spins();
        let (resistance, striking) = strongest_drive(&self.outer.shape);
        broken(vec![
            slenderness(plate),
            Rule {
                fields: vec!["outer.offset", "plate.radius"],
                holds: self.outer.offset < plate.radius,
                message: format!(
                    "`outer.offset` is {} m, but it must be less than `plate.radius`, {} m",
                    self.outer.offset, plate.radius
                ),
                help: "it is the distance of the point of impact from the centre of the plate",
            },
            Rule {
                fields: vec!["outer.offset"],
                holds: self.outer.offset == 0.0 || (elastic && dry),
                message: "an off-centre impact needs elastic bodies, no fluid, an undamped plate and one impact".into(),
                help: "remove `outer.offset`, or fluid, damping, `hardening`, `relaxation`, `loss_factor` and series",
            },
            Rule {
                fields: vec!["outer.angle"],
                holds: self.outer.angle == 0.0 || single,
                message: "an oblique impact needs one impact without a fluid".into(),
                help: "remove `outer.angle`, or fluid and series",
            },
            Rule {
                fields: vec!["friction"],
                holds: straight || !self.rubs() || turn,
                message: "`friction` makes the bodies turn in an off-centre or oblique impact, or with `spin`: both must be spheres, or have a `moment_of_inertia`".into(),
                help: "use spheres, add `moment_of_inertia` to a compact body, or remove `friction`",
            },
            Rule {
                fields: vec!["outer.spin", "inner.spin"],
                holds: !self.spins() || single,
                message: "`spin` needs one impact without a fluid".into(),
                help: "remove `outer.spin` and `inner.spin`, or fluid and series",
            },
            Rule {
                fields: vec!["fluid"],
                holds: elastic || self.fluid.is_none(),
                message: "`fluid`: a plastic or viscoelastic material in a fluid is not supported".into(),
                help: "leave the fluid out, or `hardening`, `relaxation` and `loss_factor` of the materials",
            },
            Rule {
                fields: vec!["outer.kind"],
                holds: elastic || !self.outer.shape.is_mounted(),
                message:
                    "`outer.kind` is \"bender\" or \"stack\": it is not supported with a plastic or viscoelastic material"
                        .into(),
                help: "use a sphere or a compact body, or remove `hardening`, `relaxation` and `loss_factor` of the materials",
            },
            Rule {
                fields: vec!["outer.kind"],
                holds: dry || !matches!(self.outer.shape, Shape::Stack(_)),
                message: "`outer.kind` is \"stack\": in a fluid, on a damped plate or in series it is not covered".into(),
                help: "remove `fluid`, `plate.damping_ratio` and `series`, or use another outer body",
            },
            Rule {
                fields: vec!["outer.drive.resistance"],
                holds: resistance <= striking,
                message: format!(
                    "`outer.drive.resistance` is {resistance} Ohm, but it must be at most {striking:.1e} Ohm: the stack charges so slowly that its tip presses on the plate and does not strike it"
                ),
                help: "use a smaller resistance, or remove `outer.drive` for an ideal source",
            },
            Rule {
                fields: vec!["plate.material"],
                holds: pair(&self.outer.material) && pair(&self.inner.material),
                message: format!(
                    "a contact of `plate.material` `{}` joins a plastic and a viscoelastic material, which is not supported",
                    plate.material.name
                ),
                help: "remove `hardening` of the one or the relaxation of the other",
            },
        ])
    }

    /// Over the rocker the inner body flies between two walls.
    fn flyer(&self, flight: &Flight) -> Result<Flyer, String> {
        let Shape::Sphere { radius } = self.inner.shape else {
            return Err("the body that flies must be a sphere: `inner.kind` is not".into());
        };
        let chamber = Chamber::over_rocker(flight.travel.unwrap_or_default(), flight.chamber_height, radius);
        let mass = self.inner.shape.mass(&self.inner.material);
        Ok(Flyer { mass, radius, chamber: chamber.map_err(|error| error.0)? })
    }

    fn doubts(&self) -> Vec<String> {
        let Self { plate, outer, inner, .. } = self;
        let mut found: Vec<String> = Vec::new();
        for doubt in self.materials().into_iter().flat_map(material) {
            if !found.contains(&doubt) {
                found.push(doubt);
            }
        }
        let lengths = [
            ("plate.radius", plate.radius),
            ("plate.thickness", plate.thickness),
            ("outer's tip radius", outer.shape.tip_radius()),
            ("inner's tip radius", inner.shape.tip_radius()),
        ];
        found.extend(lengths.into_iter().filter_map(|(name, value)| outside(name, value, LENGTH, "m")));
        if self.series.is_some() && self.materials().iter().all(|material| material.plasticity().is_none()) {
            found.push(
                "series: no material yields, so that all impacts are equal; specify `yield_strength` and `hardening` of one".into(),
            );
        }
        if plate.thickness > 4.0 * plate.radius {
            found.push(format!(
                "plate.thickness is {:.3} times plate.radius: a rod rather than a plate; is one of them a diameter?",
                plate.thickness / plate.radius
            ));
        }
        found.extend(self.fluid.as_ref().and_then(|fluid| wide_gap(fluid, inner.shape.tip_radius())));
        found
    }
}

/// A doubt about a film that is too wide at its `minimum_gap` for lubrication theory over a tip of `tip_radius` m.
fn wide_gap(fluid: &Fluid, tip_radius: f64) -> Option<String> {
    let width = fluid.minimum_gap / tip_radius;
    // what follows the leading term of Stokes flow between a sphere and a plane (Cooley and O'Neill, Mathematika 16, 1969)
    let neglected = width * (0.9713 - 0.2 * width.min(1.0).ln());
    (fluid.squeeze_film && neglected > NEGLECTED).then(|| {
        format!(
            "fluid.minimum_gap = {:e} m is {width:.2e} times the inner tip's radius: lubrication theory needs a narrow gap and neglects forces of about {:.0} % of the film's force here",
            fluid.minimum_gap,
            100.0 * neglected
        )
    })
}

/// Resistance of the drive in Ohm of a body of the `shape`, and the largest with which it strikes; 0 and infinite without a drive.
fn strongest_drive(shape: &Shape) -> (f64, f64) {
    let Shape::Stack(stack) = shape else { return (0.0, f64::INFINITY) };
    let Some(drive) = stack.drive else { return (0.0, f64::INFINITY) };
    (drive.resistance, SLOWEST_CHARGE / stack.modes(1)[0].omega / stack.charging_time_per_resistance())
}
