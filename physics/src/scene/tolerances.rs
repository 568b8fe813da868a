//! Reads `[tolerances.<model>]`: bounds by quantity, per reduced model or program of the user's.

use super::check::Checker;
use super::fault::did_you_mean;
use super::grammar::{Bound, Choice, MODELS};
use super::place::Place;
use super::quantity::{Dimension, dimension_of};
use super::{Dialect, Tolerance, Tolerances};
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The keys of one tolerance.
pub(super) const TERMS: [(&str, &str); 4] = [
    ("relative", "bound relative to the reference's value"),
    ("absolute", "bound in the quantity's unit"),
    ("relative_to_peak", "bound relative to the peak of the quantity's curve in the reference"),
    ("bias", "declared bias, in the terms of the bound"),
];

/// Share of launches that end in the other seat, of model and reference, where there is a flight.
pub const LANDING_SHARE: &str = "landing_share";

/// A quantity that can have a tolerance.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Gated {
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    /// Whether the history has a curve whose peak it can be related to.
    pub(crate) has_curve: bool,
    /// Whether it is a residual, which is zero in the ideal and has no relative bound.
    pub(crate) is_residual: bool,
}

impl Gated {
    fn dimension(&self) -> Dimension {
        dimension_of(self.unit).unwrap_or(Dimension::NONE)
    }
}

/// The reduced models a scene of this kind has.
pub(super) fn models(kind: &Dialect) -> Vec<&'static Choice> {
    let has = |model: &&Choice| kind.models.iter().any(|own| own.to_string() == model.name);
    MODELS.iter().filter(has).collect()
}

impl Checker<'_> {
    /// Reads the table `[tolerances]`, noting every fault.
    pub(super) fn tolerances(&mut self, root: &DeTable, kind: &Dialect) -> BTreeMap<String, Tolerances> {
        let external = self.external_names(root);
        let own = models(kind);
        let known: Vec<&str> =
            own.iter().map(|m| m.name).chain(external.iter().map(String::as_str)).collect();
        let mut models = BTreeMap::new();
        let Some((key, value)) = root.get_key_value("tolerances") else { return models };
        let place = Place { path: "tolerances", span: key.span() };
        let DeValue::Table(table) = value.get_ref() else {
            self.fault::<()>(
                &place,
                value,
                "but it must be a table",
                "wrong type",
                "write a table [tolerances.B]".into(),
            );
            return models;
        };
        for (key, value) in table {
            let path = place.key(key.get_ref());
            let place = Place { path: &path, span: key.span() };
            match (known.iter().find(|name| **name == *key.get_ref()), value.get_ref()) {
                (None, _) => {
                    let example = own[own.len() / 2].name;
                    self.problems.add(
                        key.span(),
                        format!("`{path}`: `{}` is not a reduced model of this kind of scene", key.get_ref()),
                        "unknown model",
                        format!("there are {}: write for example [tolerances.{example}]", known.join(", ")),
                    );
                }
                (Some(model), DeValue::Table(quantities)) => {
                    let tolerances = self.model(&place, quantities, kind);
                    models.insert((*model).to_owned(), tolerances);
                }
                (Some(_), _) => {
                    self.fault::<()>(
                        &place,
                        value,
                        "but it must be a table",
                        "wrong type",
                        format!("write a table [{path}]"),
                    );
                }
            }
        }
        models
    }

    fn model(&mut self, place: &Place, quantities: &DeTable, kind: &Dialect) -> Tolerances {
        let mut tolerances = Tolerances::new();
        for (key, value) in quantities {
            let name = key.get_ref().as_ref();
            let path = place.key(name);
            let place = Place { path: &path, span: key.span() };
            let Some(gated) = kind.gated.iter().find(|gated| gated.name == name) else {
                let names: Vec<&str> = kind.gated.iter().map(|gated| gated.name.as_str()).collect();
                self.problems.add(
                    key.span(),
                    format!("`{path}`: `{name}` is not a quantity that can have a tolerance"),
                    "unknown quantity",
                    format!("{}there are: {}", did_you_mean(name, names.iter().copied()), names.join(", ")),
                );
                continue;
            };
            if let Some(tolerance) = self.tolerance(&place, value, gated) {
                tolerances.insert(name.to_owned(), tolerance);
            }
        }
        tolerances
    }

    fn tolerance(&mut self, place: &Place, value: &Spanned<DeValue>, gated: &Gated) -> Option<Tolerance> {
        let DeValue::Table(terms) = value.get_ref() else {
            // A residual is relative already, so a bare number bounds it as it is.
            let bound = Some(self.quantity(place, value, Dimension::NONE, Bound::NOT_NEGATIVE)?);
            return Some(match gated.is_residual {
                true => Tolerance { absolute: bound, ..Tolerance::default() },
                false => Tolerance { relative: bound, ..Tolerance::default() },
            });
        };
        let mut tolerance = Tolerance::default();
        let mut sound = true;
        // The bias stands with the first bound there is: relative, absolute, relative to the peak.
        let absolute_bias = !terms.contains_key("relative") && terms.contains_key("absolute");
        for (key, value) in terms {
            let path = place.key(key.get_ref());
            let term = Place { path: &path, span: key.span() };
            let (dimension, bound, slot) = match key.get_ref().as_ref() {
                "relative" if !gated.is_residual => {
                    (Dimension::NONE, Bound::NOT_NEGATIVE, &mut tolerance.relative)
                }
                "relative_to_peak" if gated.has_curve => {
                    (Dimension::NONE, Bound::NOT_NEGATIVE, &mut tolerance.relative_to_peak)
                }
                "absolute" => (gated.dimension(), Bound::NOT_NEGATIVE, &mut tolerance.absolute),
                "bias" if absolute_bias => (gated.dimension(), Bound::ANY, &mut tolerance.bias),
                "bias" => (Dimension::NONE, Bound::ANY, &mut tolerance.bias),
                other => {
                    sound = false;
                    self.refuse_term(&term, other, gated);
                    continue;
                }
            };
            *slot = self.quantity(&term, value, dimension, bound);
            sound &= slot.is_some();
        }
        if sound && tolerance == (Tolerance { bias: tolerance.bias, ..Tolerance::default() }) {
            let help =
                "give at least one of relative, absolute, relative_to_peak, for example { relative = 0.01 }";
            return self.fault(place, value, "which bounds nothing", "no bound", help.to_owned());
        }
        sound.then_some(tolerance)
    }

    fn refuse_term(&mut self, term: &Place, name: &str, gated: &Gated) {
        let why = match name {
            "relative" => "a residual has no relative bound",
            "relative_to_peak" => "the quantity has no curve whose peak it could be related to",
            _ => "there is no such bound",
        };
        let valid: Vec<&str> = TERMS
            .iter()
            .map(|(name, _)| *name)
            .filter(|n| {
                !(gated.is_residual && *n == "relative") && (gated.has_curve || *n != "relative_to_peak")
            })
            .collect();
        let help = format!("{}it can have: {}", did_you_mean(name, valid.iter().copied()), valid.join(", "));
        self.problems.add(term.span.clone(), format!("`{}`: {why}", term.path), "unknown key", help);
    }
}
