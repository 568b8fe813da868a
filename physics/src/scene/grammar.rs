//! What a key of a scene file may be: its kind, its bounds, the ways to say a thing.

use super::quantity::Dimension;
use std::borrow::Cow;

/// Valid range of a number, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bound {
    /// Lower end and whether it is valid itself.
    pub(crate) low: Option<(f64, bool)>,
    /// Upper end and whether it is valid itself.
    pub(crate) high: Option<(f64, bool)>,
}

impl Bound {
    pub(crate) const POSITIVE: Bound = Bound { low: Some((0.0, false)), high: None };
    pub(crate) const NOT_NEGATIVE: Bound = Bound { low: Some((0.0, true)), high: None };
    pub(crate) const ANY: Bound = Bound { low: None, high: None };

    /// Whether `value` is valid.
    pub(crate) fn holds(&self, value: f64) -> bool {
        let above = self.low.is_none_or(|(b, valid)| value > b || (valid && value == b));
        let below = self.high.is_none_or(|(b, valid)| value < b || (valid && value == b));
        value.is_finite() && above && below
    }

    /// The same range of an angle in degrees; rounding is left out.
    pub(crate) fn in_degrees(&self) -> Self {
        let of =
            |end: Option<(f64, bool)>| end.map(|(b, valid)| ((b.to_degrees() * 1e9).round() / 1e9, valid));
        Self { low: of(self.low), high: of(self.high) }
    }

    /// "greater than 0 m", "at least 0 and less than 1".
    pub(crate) fn describe(&self, unit: &str) -> String {
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
#[derive(Debug, Clone, Copy)]
pub(crate) struct Choice {
    pub(crate) name: &'static str,
}

pub(crate) const fn choice(name: &'static str) -> Choice {
    Choice { name }
}

/// What stands behind a key.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    /// Any text.
    Text,
    /// A text that can name a folder.
    Name,
    /// A list of texts, of at least one and at most so many.
    Texts(usize),
    /// One of a few words.
    Choice(&'static [Choice]),
    /// A number with a unit.
    Quantity(Dimension, Bound),
    /// A list of numbers with units, of at least one and at most so many.
    Quantities(Dimension, Bound, usize),
    /// A place on a body: a name, or its three coordinates.
    Place,
    /// A list of places, of at most so many.
    Places(usize),
    /// A whole number in a range, both ends valid.
    Count(u64, u64),
    /// true or false.
    Flag,
    /// The name of a table under `[materials]`.
    Material,
    /// A table of values like this field's under names of the user's choice, at least one.
    Named(&'static Field),
    /// A number without unit, true or false, or the path of a number of the scene.
    Start,
    /// A table with fixed keys.
    Table(&'static [Field]),
    /// A table of tables with fixed keys under names of the user's choice.
    TableOf(&'static [Field]),
    /// A list of tables with fixed keys, of at least one and at most so many.
    Tables(&'static [Field], usize),
    /// `[tolerances.<model>]`, see `tolerances.rs`.
    Tolerances,
    /// `[uncertainty]`, see `uncertainty/read.rs`.
    Uncertainty,
}

/// One key.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Field {
    pub(crate) key: &'static str,
    pub(crate) kind: Kind,
    pub(crate) required: bool,
    /// The key belongs to these `kind`s (or `geometry`s) of its table only; empty = to all.
    pub(crate) only: &'static [&'static str],
    /// The key is part of one of several ways to say a thing.
    pub(crate) alternative: Option<Alternative>,
    /// What holds where the key is absent, as a scene file would say it; `None` if the key has no value then, or one that other keys decide.
    pub(crate) default: Option<&'static str>,
    pub(crate) doc: &'static str,
}

/// Several sets of keys say the same thing: one set has to be there and complete, no other may be. If the keys are
/// optional, all sets may be absent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Alternative {
    /// The `kind` of the table for which this holds; `None` = for any.
    pub(crate) kind: Option<&'static str>,
    /// What the sets say.
    pub(crate) group: &'static str,
    /// The set the key belongs to.
    pub(crate) set: &'static str,
}

impl Field {
    /// The optional key with the value that holds where it is absent.
    pub(crate) const fn otherwise(self, default: &'static str) -> Field {
        Field { default: Some(default), ..self }
    }

    /// What the key is, with its default.
    pub(crate) fn described(&self) -> Cow<'static, str> {
        match self.default {
            Some(default) => format!("{}; absent = {default}", self.doc).into(),
            None => self.doc.into(),
        }
    }

    /// The alternative the key is part of in a table of this `kind`.
    pub(crate) fn alternative(&self, kind: Option<&str>) -> Option<Alternative> {
        self.alternative.filter(|a| a.kind.is_none() || a.kind == kind)
    }

    /// Whether the key has to be there by itself in a table of this `kind`.
    pub(crate) fn is_needed(&self, kind: Option<&str>) -> bool {
        self.required && self.alternative(kind).is_none() && self.belongs_to(kind)
    }

    /// Whether the key is one of a table of this `kind`.
    pub(crate) fn belongs_to(&self, kind: Option<&str>) -> bool {
        self.only.is_empty() || kind.is_some_and(|k| self.only.contains(&k))
    }
}

pub(crate) const fn required(key: &'static str, kind: Kind, doc: &'static str) -> Field {
    Field { key, kind, required: true, only: &[], alternative: None, default: None, doc }
}

pub(crate) const fn optional(key: &'static str, kind: Kind, doc: &'static str) -> Field {
    Field { key, kind, required: false, only: &[], alternative: None, default: None, doc }
}

pub(crate) const fn only(kinds: &'static [&'static str], field: Field) -> Field {
    Field { only: kinds, ..field }
}

pub(crate) const fn one_way(
    kind: Option<&'static str>,
    group: &'static str,
    set: &'static str,
    field: Field,
) -> Field {
    Field { alternative: Some(Alternative { kind, group, set }), ..field }
}

pub(crate) const fn positive(dimension: Dimension) -> Kind {
    Kind::Quantity(dimension, Bound::POSITIVE)
}

pub(crate) const fn pure(bound: Bound) -> Kind {
    Kind::Quantity(Dimension::NONE, bound)
}

/// Geometry of a reference that names none.
pub(crate) const DEFAULT_GEOMETRY: &str = "axisymmetric";

/// The names of the reduced models.
pub(crate) const MODELS: [Choice; 3] = [choice("A"), choice("B"), choice("C")];

/// Stands apart from the table of keys because its shape is checked by its own reader.
pub(crate) static TOLERANCES: Field =
    optional("tolerances", Kind::Tolerances, "Tolerances of the gate, by model and quantity");

pub(crate) const TIP_RADIUS: Field =
    required("tip_radius", positive(Dimension::LENGTH), "Radius of the spherical tip");
pub(crate) const BODY_MATERIAL: Field =
    required("material", Kind::Material, "Material of the body, a name under [materials]");
