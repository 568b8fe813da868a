//! Reads `[tolerances.<model>]`: bounds by quantity, per reduced model or program of the user's.

use super::check::Checker;
use super::fault::did_you_mean;
use super::grammar::{Bound, Choice, MODELS};
use super::place::Place;
use super::quantity::{Dimension, dimension_of};
use super::{Tolerance, Tolerances};
use crate::kinds::Kind;
use crate::result::Impact;
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The keys of one tolerance.
pub(super) const TERMS: [(&str, &str); 4] = [
    ("relative", "bound relative to the reference's value"),
    ("absolute", "bound in the quantity's unit"),
    ("relative_to_peak", "bound relative to the peak of the quantity's curve in the reference"),
    ("bias", "known discrepancy, in the terms of the bound"),
];

/// A quantity that can have a tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Gated {
    dimension: Dimension,
    /// Whether the history has a curve whose peak it can be related to.
    has_curve: bool,
    /// Whether it is a residual, which is zero in the ideal and has no relative bound.
    is_residual: bool,
}

/// The names that can have a tolerance in a scene of this kind.
pub(super) fn gated_names(kind: &dyn Kind) -> impl Iterator<Item = String> {
    let (quantities, curves) = (kind.quantities(), kind.curves());
    let scalars = quantities.iter().map(|quantity| quantity.name.to_owned());
    let curves =
        curves.iter().flat_map(|curve| ["rms", "max"].map(|distance| format!("{}_{distance}", curve.name)));
    let impacts = Impact::COMPARED.map(|(name, _)| format!("{OF_IMPACTS}{name}"));
    let impacts = impacts.into_iter().filter(|_| has_series(kind));
    scalars.chain(curves).chain(impacts).chain([LANDING_SHARE.to_owned()]).chain(RESIDUALS.map(str::to_owned))
}

/// Share of launches that end in the other seat, of model and reference, where there is a flight.
pub const LANDING_SHARE: &str = "landing_share";
const RESIDUALS: [&str; 2] = ["energy_residual", "momentum_residual"];
/// Before the quantities of all impacts of a series.
const OF_IMPACTS: &str = "impact_";

/// Whether impacts of this kind can come in series.
fn has_series(kind: &dyn Kind) -> bool {
    kind.quantities().iter().any(|quantity| quantity.name == Impact::COMPARED[0].0)
}

fn gated(name: &str, kind: &dyn Kind) -> Option<Gated> {
    let curves = kind.curves();
    if name == LANDING_SHARE {
        return Some(Gated { dimension: Dimension::NONE, has_curve: false, is_residual: false });
    }
    if RESIDUALS.contains(&name) {
        return Some(Gated { dimension: Dimension::NONE, has_curve: false, is_residual: true });
    }
    if let Some(name) = name.strip_prefix(OF_IMPACTS).filter(|_| has_series(kind)) {
        let (_, unit) = Impact::COMPARED.iter().find(|(known, _)| *known == name)?;
        return Some(Gated { dimension: dimension_of(unit)?, has_curve: false, is_residual: false });
    }
    if let Some(quantity) = kind.quantities().iter().find(|quantity| quantity.name == name) {
        let has_curve = curves.iter().any(|curve| name.starts_with(curve.name));
        return Some(Gated { dimension: dimension_of(quantity.unit)?, has_curve, is_residual: false });
    }
    // A difference of curves is given relative to the peak: a pure number.
    let curve = name.strip_suffix("_rms").or_else(|| name.strip_suffix("_max"))?;
    curves.iter().any(|known| known.name == curve).then_some(Gated {
        dimension: Dimension::NONE,
        has_curve: true,
        is_residual: false,
    })
}

/// The reduced models a scene of this kind has.
pub(super) fn models(kind: &dyn Kind) -> Vec<&'static Choice> {
    let has = |model: &&Choice| kind.models().iter().any(|own| own.to_string() == model.name);
    MODELS.iter().filter(has).collect()
}

impl Checker<'_> {
    /// Reads the table `[tolerances]`, noting every fault.
    pub(super) fn tolerances(&mut self, root: &DeTable, kind: &dyn Kind) -> BTreeMap<String, Tolerances> {
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
                "but it has to be a table",
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
                        "but it has to be a table",
                        "wrong type",
                        format!("write a table [{path}]"),
                    );
                }
            }
        }
        models
    }

    fn model(&mut self, place: &Place, quantities: &DeTable, kind: &dyn Kind) -> Tolerances {
        let mut tolerances = Tolerances::new();
        for (key, value) in quantities {
            let name = key.get_ref().as_ref();
            let path = place.key(name);
            let place = Place { path: &path, span: key.span() };
            let Some(gated) = gated(name, kind) else {
                let names: Vec<String> = gated_names(kind).collect();
                self.problems.add(
                    key.span(),
                    format!("`{path}`: `{name}` is not a quantity that can have a tolerance"),
                    "unknown quantity",
                    format!(
                        "{}there are: {}",
                        did_you_mean(name, names.iter().map(String::as_str)),
                        names.join(", ")
                    ),
                );
                continue;
            };
            if let Some(tolerance) = self.tolerance(&place, value, gated) {
                tolerances.insert(name.to_owned(), tolerance);
            }
        }
        tolerances
    }

    fn tolerance(&mut self, place: &Place, value: &Spanned<DeValue>, gated: Gated) -> Option<Tolerance> {
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
                "absolute" => (gated.dimension, Bound::NOT_NEGATIVE, &mut tolerance.absolute),
                "bias" if absolute_bias => (gated.dimension, Bound::ANY, &mut tolerance.bias),
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

    fn refuse_term(&mut self, term: &Place, name: &str, gated: Gated) {
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
