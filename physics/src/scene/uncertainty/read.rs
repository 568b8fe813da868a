//! The table `[uncertainty]` of a scene file.

use super::{Correlation, Distribution, Spread, UncertainInput, Uncertainty};
use crate::scene::check::Checker;
use crate::scene::fault::did_you_mean;
use crate::scene::field::{Field, fields_of, number_in, without_effect};
use crate::scene::grammar::{self, Bound, Kind, pure, required};
use crate::scene::place::Place;
use crate::scene::quantity::Dimension;
use crate::scene::values::{Checked, Values};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The key that is no field's name.
const CORRELATED: &str = "correlations";
/// Most pairs of inputs.
const MOST_PAIRS: usize = 256;
const COEFFICIENT: Bound = Bound { low: Some((-1.0, true)), high: Some((1.0, true)) };
const HELP: &str = "write a percentage of the nominal value (a normal standard deviation) such as \"1 %\", or one of \
    { normal = \"20 um\" }, { lognormal = \"5 %\" }, { uniform = [\"1.95 mm\", \"2.05 mm\"] }";

/// The distributions there are, and what stands behind them.
pub(in crate::scene) const DISTRIBUTIONS: [(&str, &str); 3] = [
    ("normal", "Standard deviation, with its unit or in percent of the nominal value"),
    ("lognormal", "Standard deviation likewise; the nominal value is the mean"),
    ("uniform", "Both bounds"),
];

static PAIR: [grammar::Field; 2] = [
    required("between", Kind::Texts(2), "The names of two uncertain fields"),
    required("coefficient", pure(COEFFICIENT), "Coefficient of correlation of their normal scores"),
];

/// The entry for correlations.
pub(in crate::scene) static CORRELATIONS: grammar::Field =
    grammar::optional(CORRELATED, Kind::Tables(&PAIR, MOST_PAIRS), "Pairs of correlated inputs");

/// A value of the table: under the name it has there, which dots may take apart.
struct RawEntry<'t> {
    field: String,
    place: std::ops::Range<usize>,
    value: &'t Spanned<DeValue<'t>>,
}

impl RawEntry<'_> {
    fn place<'p>(&self, path: &'p str) -> Place<'p> {
        Place { path, span: self.place.clone() }
    }
}

/// The entries of `table`, those of tables within it (`plate.thickness` without quotes) included.
fn entries<'t>(table: &'t DeTable<'t>, prefix: &str, fields: &[Field], found: &mut Vec<RawEntry<'t>>) {
    for (key, value) in table {
        let field = format!("{prefix}{}", key.get_ref());
        let within = format!("{field}.");
        match value.get_ref() {
            DeValue::Table(inner) if fields.iter().any(|f| f.path().starts_with(&within)) => {
                entries(inner, &within, fields, found);
            }
            _ => found.push(RawEntry { field, place: key.span(), value }),
        }
    }
}

impl Checker<'_> {
    /// Reads the table `[uncertainty]` of a file with these checked `values` of its `keys`, noting every fault; `None` without that table.
    pub(in crate::scene) fn uncertainty(
        &mut self,
        root: &DeTable,
        keys: &'static [grammar::Field],
        values: &Values,
    ) -> Option<Uncertainty> {
        let (key, value) = root.get_key_value("uncertainty")?;
        let table = value.get_ref().as_table()?;
        let fields = fields_of(keys, values);
        let mut found = Vec::new();
        entries(table, "", &fields, &mut found);
        let (pairs, entries): (Vec<_>, Vec<_>) =
            found.into_iter().partition(|entry| entry.field == CORRELATED);
        let mut inputs = Vec::new();
        for entry in &entries {
            inputs.extend(self.input(entry, &fields, values));
        }
        if entries.is_empty() {
            let help = format!(
                "name a field and its standard deviation, for example \"plate.thickness\" = \"1 %\"; {HELP}"
            );
            self.problems.add(key.span(), "[uncertainty] names no input".into(), "empty", help);
        }
        inputs.sort_by(|a, b| a.field.cmp(&b.field));
        let mut uncertainty = Uncertainty { inputs, correlations: Vec::new() };
        if let Some(pairs) = pairs.first() {
            self.correlations(pairs, &mut uncertainty);
        }
        Some(uncertainty)
    }

    fn input(&mut self, entry: &RawEntry, fields: &[Field], values: &Values) -> Option<UncertainInput> {
        let path = format!("uncertainty.{}", entry.field);
        let place = entry.place(&path);
        let field = self.field(entry, fields, values)?;
        let Some(nominal) = number_in(values, field) else {
            // a number that is there and wrong is told of at its own place
            if self.problems.is_empty() {
                let message = format!("`{path}`: the scene file has no nominal value `{}`", entry.field);
                let help = match entry.field.rsplit_once('.') {
                    Some((table, key)) => {
                        format!("write the field in its table: `{key} = ...` under `[{table}]`")
                    }
                    None => format!("write the field at the top of the file: `{} = ...`", entry.field),
                };
                self.problems.add(entry.place.clone(), message, "no nominal value", help);
            }
            return None;
        };
        let distribution = self.distribution(&place, entry.value, field)?;
        let input = UncertainInput { field: entry.field.clone(), unit: field.unit(), nominal, distribution };
        if input.standard_deviation() <= 0.0
            || (matches!(distribution, Distribution::Lognormal(_)) && nominal <= 0.0)
        {
            let message = format!(
                "which is not a standard deviation about the nominal value {nominal}{}",
                field.dimension().suffix()
            );
            let help = "give a standard deviation with its unit; a lognormal number is positive";
            return self.fault(&place, entry.value, &message, "no scatter", help.to_owned());
        }
        let [low, high] = input.range();
        if !(low..=high).contains(&nominal) {
            let message =
                format!("which does not contain the nominal value {nominal}{}", field.dimension().suffix());
            let help = "the bounds must enclose the value in the scene file";
            return self.fault(&place, entry.value, &message, "not about the nominal value", help.to_owned());
        }
        for end in [low, high] {
            if let Err(rejected) = field.check(end) {
                let message = format!("which reaches too far: {rejected}");
                let help = "a normal number is taken to reach five standard deviations from its mean, a lognormal one as far by its \
                    logarithm: specify a smaller deviation, { lognormal = ... } for what is positive, or { uniform = [...] } with bounds";
                return self.fault(&place, entry.value, &message, "reaches too far", help.to_owned());
            }
        }
        Some(input)
    }

    /// The field that an entry names.
    fn field<'f>(&mut self, entry: &RawEntry, fields: &'f [Field], values: &Values) -> Option<&'f Field> {
        let name = &entry.field;
        let (message, help) = match fields.iter().find(|field| field.path() == name) {
            Some(field) if !field.is_count() => return Some(field),
            Some(_) => {
                ("takes whole numbers, which cannot be uncertain".to_owned(), "leave it out".to_owned())
            }
            None if without_effect(values, name).is_some() => {
                let why = without_effect(values, name).unwrap_or_default();
                (format!("changes no reduced model: {why}"), "leave it out".to_owned())
            }
            None => {
                let names = || fields.iter().filter(|field| !field.is_count()).map(Field::path);
                let help = format!(
                    "{}there are: {}",
                    did_you_mean(name, names()),
                    names().collect::<Vec<_>>().join(", ")
                );
                ("is not a numeric field of the scene".to_owned(), help)
            }
        };
        let message = format!("`uncertainty.{name}`: `{name}` {message}");
        self.problems.add(entry.place.clone(), message, "not an uncertain input", help);
        None
    }

    fn distribution(
        &mut self,
        place: &Place,
        value: &Spanned<DeValue>,
        field: &Field,
    ) -> Option<Distribution> {
        let table = match value.get_ref() {
            DeValue::String(text) if text.trim_end().ends_with('%') => {
                return self.spread(place, value, field).map(Distribution::Normal);
            }
            DeValue::Table(table) => table,
            found => {
                let message =
                    format!("but it must be a percentage or a distribution; found: {}", found.type_str());
                return self.fault(place, value, &message, "not a distribution", HELP.to_owned());
            }
        };
        let only = table.iter().next().filter(|_| table.len() == 1);
        match only.map(|(key, value)| (key.get_ref().as_ref(), value)) {
            Some(("normal", value)) => self.spread(place, value, field).map(Distribution::Normal),
            Some(("lognormal", value)) => self.spread(place, value, field).map(Distribution::Lognormal),
            Some(("uniform", value)) => self.uniform(place, value, field),
            _ => {
                let unknown = table.keys().map(|key| key.get_ref().as_ref());
                let meant: String =
                    unknown.map(|key| did_you_mean(key, DISTRIBUTIONS.map(|(name, _)| name))).collect();
                let message = "but it must be one distribution";
                self.fault(place, value, message, "not a distribution", format!("{meant}{HELP}"))
            }
        }
    }

    /// A standard deviation, positive: a share of the nominal value, or in the unit of the field.
    fn spread(&mut self, place: &Place, value: &Spanned<DeValue>, field: &Field) -> Option<Spread> {
        let percentage = |text: &str| text.trim_end().ends_with('%');
        if matches!(value.get_ref(), DeValue::String(text) if percentage(text)) {
            return self.quantity(place, value, Dimension::NONE, Bound::POSITIVE).map(Spread::Relative);
        }
        self.quantity(place, value, field.dimension(), Bound::POSITIVE).map(Spread::Absolute)
    }

    fn uniform(&mut self, place: &Place, value: &Spanned<DeValue>, field: &Field) -> Option<Distribution> {
        if let Some([low, high]) = value.get_ref().as_array().map(|list| &list[..]) {
            let mut bound = |value| self.quantity(place, value, field.dimension(), Bound::ANY);
            let (low, high) = (bound(low)?, bound(high)?);
            if low < high {
                return Some(Distribution::Uniform { low, high });
            }
        }
        let sample = field.dimension().describe().2;
        let help = format!(
            "write the lower bound and a higher one, for example {{ uniform = [\"{sample}\", ...] }}"
        );
        self.fault(
            place,
            value,
            "but a uniform distribution has two bounds, the lower one first",
            "no bounds",
            help,
        )
    }

    fn correlations(&mut self, entry: &RawEntry, uncertainty: &mut Uncertainty) {
        let path = format!("uncertainty.{CORRELATED}");
        let place = entry.place(&path);
        let Some(items) = entry.value.get_ref().as_array() else {
            let help = "write correlations = [{ between = [\"plate.thickness\", \"plate.radius\"], coefficient = 0.5 }]";
            self.fault::<()>(
                &place,
                entry.value,
                "but it must be a list of tables",
                "wrong type",
                help.to_owned(),
            );
            return;
        };
        let before = self.problems.is_empty();
        let Some(Checked::Tables(pairs)) = self.list(&place, entry.value, items, &PAIR, MOST_PAIRS) else {
            return;
        };
        if before != self.problems.is_empty() {
            return;
        }
        for (values, item) in pairs.iter().zip(items) {
            let (Some(Checked::Texts(names)), Some(Checked::Number(coefficient))) =
                (values.get("between"), values.get("coefficient"))
            else {
                continue;
            };
            let at = |name: &String| uncertainty.inputs.iter().position(|input| input.field == *name);
            let between = names.iter().map(at).collect::<Option<Vec<usize>>>();
            let known = |pair: &[usize; 2]| {
                let is_same = |c: &Correlation| c.between == *pair || c.between == [pair[1], pair[0]];
                uncertainty.correlations.iter().any(is_same)
            };
            match between.and_then(|between| <[usize; 2]>::try_from(between).ok()) {
                Some(between) if between[0] != between[1] && !known(&between) => {
                    uncertainty.correlations.push(Correlation { between, coefficient: *coefficient });
                }
                _ => {
                    let there: Vec<&str> = uncertainty.inputs.iter().map(|input| &*input.field).collect();
                    let help = format!(
                        "name two different inputs of [uncertainty], each pair once; there are: {}",
                        there.join(", ")
                    );
                    self.fault::<()>(&place, item, "which is no pair of uncertain inputs", "no pair", help);
                }
            }
        }
        if uncertainty.factor().is_none() {
            let help = "two inputs that go with a third go with each other: lower the coefficients or add the missing pair";
            self.fault::<()>(
                &place,
                entry.value,
                "which contradict each other",
                "no such inputs",
                help.to_owned(),
            );
        }
    }
}

#[cfg(test)]
mod tests;
