//! Scene files in the language of all kinds.

use super::{KINDS, Kind};
use crate::error::Result;
use crate::result::Impact;
use crate::scene::read::{read_text, stream_text};
use crate::scene::tolerances::{Gated, LANDING_SHARE};
use crate::scene::{Dialect, Grammar, Scene, Template};
use std::io::Read;
use std::path::Path;
use std::sync::LazyLock;

static GRAMMAR: LazyLock<Grammar> = LazyLock::new(|| {
    let dialect = |kind: &'static dyn Kind| Dialect {
        name: kind.name(),
        models: kind.models(),
        gated: gated(kind),
        language: kind,
    };
    Grammar::new(KINDS.iter().copied().map(dialect).collect())
});

/// The JSON schema (draft 2020-12) of scene files.
///
/// It refuses what can be told without arithmetic: unknown and missing keys, wrong types, bare numbers out of range. Products of units
/// and names of materials are checked by [`Scene::parse`].
pub fn schema() -> serde_json::Value {
    GRAMMAR.schema()
}

/// The SI unit of the quantity at `path` in a scene's JSON form, such as `plate.material.density`.
pub fn unit_of(path: &str) -> Option<&'static str> {
    GRAMMAR.unit_of(path)
}

impl Scene {
    /// Reads and checks the scene file at `path`.
    ///
    /// # Errors
    /// [`crate::Error::Usage`] if there is no such file, [`crate::Error::Scene`] if it is not a valid scene, [`crate::Error::Io`] if the
    /// system refuses to read it.
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        Self::parse(&path.display().to_string(), &read_text(path)?)
    }

    /// Reads and checks a scene file from a stream; `source_name` is what messages call it.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn read_from(source_name: &str, stream: &mut dyn Read) -> Result<Self> {
        Self::parse(source_name, &stream_text(source_name, stream)?)
    }

    /// Checks `text`, the content of a scene file; `source_name` is what messages call the file.
    ///
    /// # Errors
    /// [`crate::Error::Scene`] with every fault, its place and what would be valid.
    pub fn parse(source_name: &str, text: &str) -> Result<Self> {
        GRAMMAR.parse(source_name, text)
    }
}

impl Template {
    /// Reads and checks the scene file at `path`.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        Self::parse(&path.display().to_string(), &read_text(path)?)
    }

    /// Checks `text`, the content of a scene file; `source_name` is what messages call the file.
    ///
    /// # Errors
    /// As [`Scene::parse`].
    pub fn parse(source_name: &str, text: &str) -> Result<Self> {
        Self::new(&GRAMMAR, source_name, text)
    }
}

/// What can have a tolerance in scenes of `kind`: quantities, differences of curves, those of all impacts of a series, the share of
/// landings, residuals.
fn gated(kind: &dyn Kind) -> Vec<Gated> {
    let of = |name: String, unit: &'static str, has_curve: bool| Gated {
        name,
        unit,
        has_curve,
        is_residual: false,
    };
    let quantities = kind.quantities();
    let mut all: Vec<Gated> =
        quantities.iter().map(|q| of(q.name.to_owned(), q.unit, q.curve.is_some())).collect();
    // a difference of curves is given relative to the peak: a pure number
    for curve in kind.curves() {
        all.extend(["rms", "max"].map(|distance| of(format!("{}_{distance}", curve.name), "1", true)));
    }
    // of those kinds whose impacts can come in series
    if quantities.iter().any(|quantity| quantity.name == Impact::COMPARED[0].0) {
        all.extend(Impact::COMPARED.map(|(name, unit)| of(format!("impact_{name}"), unit, false)));
    }
    all.push(of(LANDING_SHARE.to_owned(), "1", false));
    let residual = |name: &str| Gated { is_residual: true, ..of(name.to_owned(), "1", false) };
    all.extend(["energy_residual", "momentum_residual"].map(residual));
    all
}

#[cfg(test)]
mod tests {
    use super::GRAMMAR;
    use crate::scene::grammar::{Field, Kind};
    use crate::scene::quantity;

    /// Number of defaults of these keys and those below them, each a value that its key takes.
    fn valid_defaults(fields: &[Field]) -> usize {
        let valid = |field: &Field, default: &str| match field.kind {
            Kind::Quantity(dimension, bound) => {
                quantity::parse(default, dimension).is_ok_and(|value| bound.holds(value))
            }
            Kind::Count(low, high) => default.parse().is_ok_and(|count| (low..=high).contains(&count)),
            Kind::Choice(choices) => choices.iter().any(|choice| choice.name == default),
            Kind::Flag => default.parse::<bool>().is_ok(),
            _ => false,
        };
        let of = |field: &Field| {
            let below = match field.kind {
                Kind::Table(fields) | Kind::TableOf(fields) | Kind::Tables(fields, _) => {
                    valid_defaults(fields)
                }
                _ => 0,
            };
            let Some(default) = field.default else { return below };
            assert!(!field.required && valid(field, default), "{}: {default}", field.key);
            below + 1
        };
        fields.iter().map(of).sum()
    }

    /// Nothing but this checks a default before a scene without its key is read.
    #[test]
    fn defaults_are_values_of_their_keys() {
        assert!(valid_defaults(GRAMMAR.keys) > 30);
    }
}
