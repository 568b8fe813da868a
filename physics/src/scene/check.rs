//! Walks the tree of a TOML file along the specification and notes every fault.

use super::advice::{alternatives, chosen, example, half_of_it, needed};
use super::fault::{Collector, did_you_mean};
use super::grammar::{Bound, DEFAULT_GEOMETRY, Field, Kind, pure, required};
use super::place::Place;
use super::quantity::Dimension;
use super::values::{Checked, PLACE, Values};
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A number without unit.
static NUMBER: Field = required("number", pure(Bound::ANY), "A number");

/// Checks one file.
pub(super) struct Checker<'a> {
    text: &'a str,
    materials: Vec<String>,
    pub(super) problems: Collector,
}

impl<'a> Checker<'a> {
    pub(super) fn new(name: &str, text: &'a str, root: &DeTable) -> Self {
        let materials = root.get("materials").and_then(|m| m.get_ref().as_table());
        let materials = materials.map(|t| t.keys().map(|k| k.get_ref().to_string()).collect());
        Checker { text, materials: materials.unwrap_or_default(), problems: Collector::new(name, text) }
    }

    /// The text of a value as it stands in the file, cut to what fits a message.
    pub(super) fn written(&self, value: &Spanned<DeValue>) -> String {
        let text = self.text.get(value.span()).unwrap_or_default().trim();
        let line = text.lines().next().unwrap_or_default();
        let mut short: String = line.chars().take(60).collect();
        if short.len() < text.len() {
            short.push_str("...");
        }
        short
    }

    /// Checks `table` against `fields`; what is returned holds only values without fault.
    pub(super) fn table(&mut self, place: &Place, table: &DeTable, fields: &[Field]) -> Values {
        let mut values = Values::new();
        // What some keys belong to: the kind of a body, or the geometry of the reference.
        let selector = fields.iter().find(|f| f.key == "kind" || f.key == "geometry");
        let word = selector.map_or("kind", |f| f.key);
        let kind = selector.zip(table.get(word));
        let absent = (word == "geometry" && kind.is_none()).then_some(DEFAULT_GEOMETRY);
        let kind = kind.and_then(|(field, value)| Some(chosen(field, value)?.name)).or(absent);
        // A key that has a form for this kind is not told about its other forms, and one that has none is told of once.
        let elsewhere = |(index, field): (usize, &Field)| {
            let same = |f: &Field| f.key == field.key;
            !field.belongs_to(kind)
                && (fields[..index].iter().any(same) || fields.iter().any(|f| same(f) && f.belongs_to(kind)))
        };
        for (_, field) in fields.iter().enumerate().filter(|place| !elsewhere(*place)) {
            match table.get_key_value(field.key) {
                Some((key, _)) if kind.is_some() && !field.belongs_to(kind) => {
                    let owners = fields.iter().filter(|f| f.key == field.key).flat_map(|f| f.only);
                    let owners: Vec<&str> = owners.copied().collect();
                    let kind = kind.unwrap_or_default();
                    self.problems.add(
                        key.span(),
                        format!(
                            "`{}` does not belong to {word} `{kind}`, only to `{}`",
                            place.key(field.key),
                            owners.join("` and `")
                        ),
                        &format!("not for this {word}"),
                        format!("remove it, or set {word} = \"{}\"", owners.join("\" or \"")),
                    );
                }
                Some((key, value)) => {
                    let path = place.key(field.key);
                    let place = Place { path: &path, span: key.span() };
                    if let Some(value) = self.value(&place, value, field) {
                        values.insert(field.key.to_owned(), value);
                    }
                }
                None if field.is_needed(kind) => self.missing(place, field),
                None => {}
            }
        }
        self.alternatives(place, table, fields, kind);
        self.refuse_unknown(
            place,
            table,
            fields.iter().filter(|f| kind.is_none() || f.belongs_to(kind)).map(|f| f.key),
            fields,
        );
        values
    }

    /// Notes that a key is not there.
    pub(super) fn missing(&mut self, place: &Place, field: &Field) {
        self.problems.add(
            place.span.clone(),
            format!("`{}` is missing in {}", place.key(field.key), place.name()),
            "incomplete",
            format!("add {}", example(place, field)),
        );
    }

    /// Notes the keys of `table` that are in none of `fields`, and names `valid` ones.
    fn refuse_unknown<'k>(
        &mut self,
        place: &Place,
        table: &DeTable,
        valid: impl Iterator<Item = &'k str>,
        fields: &[Field],
    ) {
        let mut valid: Vec<&str> = valid.collect();
        if place.path.is_empty() {
            valid.push(super::grammar::TOLERANCES.key);
        }
        for key in table.keys() {
            let name = key.get_ref().as_ref();
            if valid.contains(&name) || fields.iter().any(|f| f.key == name) {
                continue;
            }
            self.problems.add(
                key.span(),
                format!("`{}` is not a key of {}", place.key(name), place.name()),
                "unknown key",
                format!(
                    "{}{} has: {}",
                    half_of_it(name, table, &valid)
                        .unwrap_or_else(|| did_you_mean(name, valid.iter().copied())),
                    place.name(),
                    valid.join(", ")
                ),
            );
        }
    }

    fn value(&mut self, place: &Place, value: &Spanned<DeValue>, field: &Field) -> Option<Checked> {
        match (&field.kind, value.get_ref()) {
            (Kind::Text, DeValue::String(text)) => Some(Checked::Text(text.to_string())),
            (Kind::Name, DeValue::String(text)) => self.name(place, value, text),
            (Kind::Choice(choices), DeValue::String(text)) => {
                if choices.iter().any(|c| c.name == text) {
                    return Some(Checked::Text(text.to_string()));
                }
                let help = did_you_mean(text, choices.iter().map(|c| c.name)) + &alternatives(field);
                self.fault(place, value, "which is not one of its values", "not valid", help)
            }
            (Kind::Quantity(dimension, bound), _) => {
                let number = self.quantity(place, value, *dimension, *bound)?;
                self.plausible(place, value, *dimension, number).map(Checked::Number)
            }
            (Kind::Count(low, high), _) => self.count(place, value, *low, *high),
            (Kind::Flag, DeValue::Boolean(flag)) => Some(Checked::Flag(*flag)),
            (Kind::Material, DeValue::String(text)) => self.material(place, value, text),
            (Kind::Named(field), DeValue::Table(names)) => self.named(place, value, names, field),
            (Kind::Start, DeValue::Boolean(flag)) => Some(Checked::Flag(*flag)),
            (Kind::Start, DeValue::String(path)) => Some(Checked::Text(path.to_string())),
            (Kind::Start, DeValue::Integer(_) | DeValue::Float(_)) => self.value(place, value, &NUMBER),
            (Kind::Quantities(dimension, bound, most), DeValue::Array(items)) => {
                self.quantities(place, value, items, (*dimension, *bound), *most)
            }
            (Kind::Place, _) => self.place(place, value),
            (Kind::Places(most), DeValue::Array(items)) if items.len() <= *most => {
                let places = items
                    .iter()
                    .map(|item| Some(Values::from([(PLACE.to_owned(), self.place(place, item)?)])));
                Some(Checked::Tables(places.collect::<Option<_>>()?))
            }
            (Kind::Texts(most), DeValue::Array(items)) => self.texts(place, value, items, *most),
            (Kind::Table(fields), DeValue::Table(table)) => {
                Some(Checked::Table(Arc::new(self.table(place, table, fields))))
            }
            (Kind::Tables(fields, most), DeValue::Array(items)) => {
                self.list(place, value, items, fields, *most)
            }
            (Kind::TableOf(fields), DeValue::Table(tables)) => self.tables(place, tables, fields),
            // has a reader of its own, once the numbers are known
            (Kind::Uncertainty, DeValue::Table(_)) => None,
            (kind, found) => {
                let (needed, help) = needed(kind, place.path);
                let message = format!("but it must be {needed}; found: {}", found.type_str());
                self.fault(place, value, &message, "wrong type", help)
            }
        }
    }

    /// Notes "`path` is <value>, <message>".
    pub(super) fn fault<T>(
        &mut self,
        place: &Place,
        value: &Spanned<DeValue>,
        message: &str,
        label: &str,
        help: String,
    ) -> Option<T> {
        let written = self.written(value);
        let message = format!("`{}` is {written}, {message}", place.path);
        self.problems.add(value.span(), message, label, help);
        None
    }

    fn tables(&mut self, place: &Place, tables: &DeTable, fields: &[Field]) -> Option<Checked> {
        let mut values = Values::new();
        for (key, value) in tables {
            let path = place.key(key.get_ref());
            let inner = Place { path: &path, span: key.span() };
            match value.get_ref() {
                DeValue::Table(table) => {
                    let checked = self.table(&inner, table, fields);
                    values.insert(key.get_ref().to_string(), Checked::Table(Arc::new(checked)));
                }
                found => {
                    let message = format!("but it must be a table; found: {}", found.type_str());
                    self.fault::<()>(
                        &inner,
                        value,
                        &message,
                        "wrong type",
                        format!("write a table [{path}]"),
                    );
                }
            }
        }
        Some(Checked::Table(Arc::new(values)))
    }

    pub(super) fn list(
        &mut self,
        place: &Place,
        value: &Spanned<DeValue>,
        items: &[Spanned<DeValue>],
        fields: &[Field],
        most: usize,
    ) -> Option<Checked> {
        let keys: Vec<&str> = fields.iter().map(|f| f.key).collect();
        let help = format!("write a list of tables like [{{ {} = ... }}]", keys.join(" = ..., "));
        if items.is_empty() || items.len() > most {
            let message = format!("but it has to have 1 to {most} entries; found: {}", items.len());
            return self.fault(place, value, &message, "wrong length", help);
        }
        let mut tables = Vec::new();
        for (k, item) in items.iter().enumerate() {
            let path = format!("{}[{}]", place.path, k + 1);
            let place = Place { path: &path, span: item.span() };
            match item.get_ref() {
                DeValue::Table(table) => tables.push(self.table(&place, table, fields)),
                found => {
                    let message = format!("but it must be a table; found: {}", found.type_str());
                    return self.fault(&place, item, &message, "wrong type", help);
                }
            }
        }
        Some(Checked::Tables(tables))
    }

    fn name(&mut self, place: &Place, value: &Spanned<DeValue>, text: &str) -> Option<Checked> {
        let plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
        if (1..=MAX_NAME).contains(&text.len()) && text.chars().all(plain) && !text.starts_with(['.', '-']) {
            return Some(Checked::Text(text.to_owned()));
        }
        let help = format!(
            "it names a folder: 1 to {MAX_NAME} of the characters A-Z a-z 0-9 . _ -, not starting with a dot or a dash"
        );
        self.fault(place, value, "which can't be a name", "not a valid name", help)
    }

    fn material(&mut self, place: &Place, value: &Spanned<DeValue>, text: &str) -> Option<Checked> {
        if self.materials.iter().any(|m| m == text) {
            return Some(Checked::Text(text.to_owned()));
        }
        let known = self.materials.join(", ");
        let known =
            if known.is_empty() { "there is no material".to_owned() } else { format!("there is: {known}") };
        let help = format!(
            "{}{known}; a material is a table [materials.{text}] with youngs_modulus, poisson_ratio, density",
            did_you_mean(text, self.materials.iter().map(String::as_str))
        );
        self.fault(place, value, "which is not a material of this scene", "unknown material", help)
    }

    fn named(
        &mut self,
        place: &Place,
        value: &Spanned<DeValue>,
        entries: &DeTable,
        field: &'static Field,
    ) -> Option<Checked> {
        if entries.is_empty() {
            let help = needed(&Kind::Named(field), "").1;
            let message = match field.kind {
                Kind::Material => "but it names no group",
                _ => "but it has no entry",
            };
            return self.fault(place, value, message, "empty", help);
        }
        let mut found = Values::new();
        for (key, entry) in entries {
            let path = place.key(key.get_ref());
            let checked = self.value(&Place { path: &path, span: key.span() }, entry, field);
            found.extend(checked.map(|checked| (key.get_ref().to_string(), checked)));
        }
        Some(Checked::Table(Arc::new(found)))
    }

    /// Reads a name, or three coordinates in m.
    fn place(&mut self, place: &Place, value: &Spanned<DeValue>) -> Option<Checked> {
        match value.get_ref() {
            DeValue::String(name) if !name.trim().is_empty() => Some(Checked::Text(name.to_string())),
            DeValue::Array(items) if items.len() == 3 => {
                self.quantities(place, value, items, (Dimension::LENGTH, Bound::ANY), 3)
            }
            _ => {
                let (needed, help) = needed(&Kind::Place, place.path);
                self.fault(place, value, &format!("but it must be {needed}"), "no place", help)
            }
        }
    }

    /// Reads a list of texts, the first of which says something.
    fn texts(
        &mut self,
        place: &Place,
        value: &Spanned<DeValue>,
        items: &[Spanned<DeValue>],
        most: usize,
    ) -> Option<Checked> {
        let texts: Option<Vec<String>> =
            items.iter().map(|item| item.get_ref().as_str().map(str::to_owned)).collect();
        let valid =
            |texts: &Vec<String>| texts.len() <= most && texts.first().is_some_and(|text| !text.is_empty());
        if let Some(texts) = texts.filter(valid) {
            return Some(Checked::Texts(texts));
        }
        let message = format!("but it must be a list of 1 to {most} texts, the first not empty");
        let help = "write a list in square brackets, for example [\"python3\", \"my_model.py\"]";
        self.fault(place, value, &message, "wrong entries", help.to_owned())
    }
}

/// Longest name of a scene: it is a folder's name, and report files add an ending.
pub(super) const MAX_NAME: usize = 100;
