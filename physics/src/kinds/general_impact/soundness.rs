//! Impacts that can't be, and numbers that are hardly meant.

use super::{GeneralImpact, NAME};
use crate::kinds::plate_impact::slenderness;
use crate::kinds::rubbing::moves_along;
use crate::scene::Bodies;
use crate::scene::collision::{Collision, Rule, broken};
use crate::scene::plausibility::{material, outside};
use crate::scene::values::Node;

/// Sizes of what was measured with these methods, in m.
const LENGTH: [f64; 2] = [1e-6, 1.0];
/// Outer bodies that are clamped at one end.
const MOUNTED: [&str; 2] = ["bender", "stack"];

/// Tables and keys of a scene that exclude or need each other.
pub(super) fn key_collisions(root: &Node) -> Vec<Collision> {
    let has = |key: &str| root.has(key);
    let table = |key: &str| root.optional_table(key).ok().flatten();
    let (wall, outer, run) = (table("wall"), table("outer"), table("run"));
    let is_rigid = wall.as_ref().is_some_and(|wall| matches!(wall.flag("rigid"), Ok(true)));
    let has_material = wall.as_ref().is_some_and(|wall| wall.has("material"));
    let is_mounted = outer.is_some_and(|outer| outer.text("kind").is_ok_and(|kind| MOUNTED.contains(&kind)));
    let place = |name: &str| table(name).is_some_and(|table| table.has("at"));
    let ends = run.is_some_and(|run| run.has("end_time"));
    broken(vec![
        Rule {
            fields: vec!["wall", "body"],
            holds: ["plate", "body", "wall"].into_iter().filter(|name| has(name)).count() < 2,
            message:
                "the scene has two of [plate], [body] and [wall], but the outer body strikes one of them"
                    .into(),
            help: "keep one of them",
        },
        Rule {
            fields: vec!["outer.at", "inner.at"],
            holds: has("body") || !(place("outer") || place("inner")),
            message: "`at` is a place on [body], but the scene has no [body]".into(),
            help: "remove `at`",
        },
        Rule {
            fields: vec!["outer"],
            holds: !has("body") || place("outer"),
            message: "`outer.at` is missing: where on [body] the outer body strikes".into(),
            help: "add `at` to [outer]: the name of a point, set or face, or three coordinates",
        },
        Rule {
            fields: vec!["inner"],
            holds: !(has("body") && has("inner")) || place("inner"),
            message: "`inner.at` is missing: where on [body] the inner body lies".into(),
            help: "add `at` to [inner]: the name of a point, set or face, or three coordinates",
        },
        Rule {
            fields: vec!["inner"],
            holds: !(has("wall") && has("inner")),
            message: "the scene has [wall] and [inner], but nothing lies behind a wall".into(),
            help: "remove [inner] or [wall]",
        },
        Rule {
            fields: vec!["kind"],
            holds: ["plate", "wall", "body", "inner"].into_iter().any(has),
            message:
                "`inner` is missing: without [plate], [body] and [wall] the outer body strikes the inner one"
                    .into(),
            help: "add [inner] with kind, radius and material; or [wall], [body] or [plate]",
        },
        Rule {
            fields: vec!["wall.rigid"],
            holds: !(has_material && is_rigid),
            message: "`wall.material` and `wall.rigid` exclude each other: a rigid wall does not deform"
                .into(),
            help: "remove one of them",
        },
        Rule {
            fields: vec!["wall"],
            holds: wall.is_none() || has_material || is_rigid,
            message: "`wall.material` is missing: the wall is of a material or rigid".into(),
            help: "add `material = \"...\"`, a name under [materials], or `rigid = true`",
        },
        Rule {
            fields: vec!["outer.kind"],
            holds: !is_mounted || has("inner") || ends,
            message: "`run.end_time` is missing: a bender or stack is clamped and strikes repeatedly what does not fly away"
                .into(),
            help: "add [run] with `end_time`, the time in which its strikes count",
        },
    ])
}

impl Bodies for GeneralImpact {
    fn kind(&self) -> &'static str {
        NAME
    }

    fn collisions(&self) -> Vec<Collision> {
        let materials = self.materials();
        let is_elastic = materials.iter().all(|material| material.is_elastic());
        let yields = materials.iter().any(|material| material.plasticity().is_some());
        let relaxes = materials.iter().any(|material| !material.relaxation.is_empty());
        let closing = self.closing_speed();
        let mut rules = vec![
            Rule {
                fields: vec!["outer.offset"],
                holds: self.outer.offset == 0.0,
                message: format!(
                    "`outer.offset` is {} m, but without [plate] and [inner] the outer body strikes where it is",
                    self.outer.offset
                ),
                help: "remove `outer.offset`",
            },
            Rule {
                fields: vec!["inner.speed", "outer.speed"],
                holds: closing > 0.0,
                message: format!(
                    "`inner.speed` is {} m/s, but it must be greater than {} m/s: the inner body moves away faster than the outer one follows",
                    self.struck_velocity(),
                    -self.outer.normal_speed()
                ),
                help: "raise `inner.speed` or `outer.speed`; both are positive towards the other body",
            },
            Rule {
                fields: vec!["friction"],
                holds: !self.rubs() || !moves_along(&self.outer, self.inner.as_ref()) || self.has_inertia(),
                message: "`friction` makes the bodies turn: a compact body needs a `moment_of_inertia`".into(),
                help: "add `moment_of_inertia`, or remove `friction`",
            },
            Rule {
                fields: vec!["outer.spin", "inner.spin", "series"],
                holds: self.series.is_none() || !self.spins(),
                message: "`spin`: bodies that turn strike another spot each time in a series".into(),
                help: "remove `outer.spin` and `inner.spin`, or [series]",
            },
            Rule {
                fields: vec!["outer.angle", "series"],
                holds: self.outer.angle == 0.0 || self.series.is_none(),
                message: "`outer.angle`: oblique impacts in series strike another place each time".into(),
                help: "remove `outer.angle` or [series]",
            },
            Rule {
                fields: vec!["outer.kind"],
                holds: is_elastic || !self.outer.shape.is_mounted(),
                message:
                    "`outer.kind` is \"bender\" or \"stack\": it is not supported with a plastic or viscoelastic material"
                        .into(),
                help: "use a sphere or a compact body, or remove `hardening`, `relaxation` and `loss_factor` of the materials",
            },
            Rule {
                fields: vec!["series"],
                holds: self.series.is_none() || !self.outer.shape.is_mounted(),
                message: "`outer.kind` is \"bender\" or \"stack\": it is not covered in series".into(),
                help: "remove [series], or use another outer body",
            },
            Rule {
                fields: vec!["body.material", "body.materials"],
                holds: self.body().is_none_or(|body| body.materials.all().iter().all(|m| m.relaxation.is_empty())),
                message: "the material of [body] is viscoelastic, which is not supported for a body from a mesh".into(),
                help: "remove `relaxation` and `loss_factor` of the material, or use `damping_ratio`",
            },
            Rule {
                fields: vec!["body.materials"],
                holds: is_elastic || self.body().is_none_or(|body| !body.materials.is_by_group()),
                message:
                    "`body.materials`: contacts with a body of several materials are elastic, but a material of the scene has `hardening`, `relaxation` or `loss_factor`"
                        .into(),
                help: "remove `hardening`, `relaxation` and `loss_factor`, or use `body.material`",
            },
            Rule {
                fields: vec!["outer.material"],
                holds: !(yields && relaxes),
                message: "the contact joins a plastic and a viscoelastic material, which is not supported".into(),
                help: "remove `hardening` of the one or the relaxation of the other",
            },
        ];
        rules.extend(self.plate().map(slenderness));
        broken(rules)
    }

    fn doubts(&self) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        for doubt in self.materials().into_iter().flat_map(material) {
            if !found.contains(&doubt) {
                found.push(doubt);
            }
        }
        let inner = self.inner.as_ref().map(|inner| ("inner's tip radius", inner.shape.tip_radius()));
        let lengths = [("outer's tip radius", self.outer.shape.tip_radius())].into_iter().chain(inner);
        found.extend(lengths.filter_map(|(name, value)| outside(name, value, LENGTH, "m")));
        if self.struck_inner().is_some_and(|inner| inner.gap > 0.0) {
            found.push("inner.gap changes no result: nothing lies between the bodies, and t = 0 is their first contact".into());
        }
        if self.series.is_some() && self.materials().iter().all(|material| material.plasticity().is_none()) {
            found.push(
                "series: no material yields, so that all impacts are equal; specify `yield_strength` and `hardening` of one".into(),
            );
        }
        found
    }
}
