//! The checked values of a scene file, and typed access to them.

use super::grammar::{Field, Kind};
use super::quantity;
use crate::{Error, Result};
use serde::de::{DeserializeOwned, IntoDeserializer};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A value that has passed its checks; quantities are in SI.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Checked {
    Number(f64),
    Numbers(Vec<f64>),
    Count(u64),
    Text(String),
    Texts(Vec<String>),
    Flag(bool),
    /// Shared by the variants of a scene that do not change it.
    Table(Arc<Values>),
    Tables(Vec<Values>),
}

/// Key of a place in each of a list of them.
pub(crate) const PLACE: &str = "at";

/// The checked values of one table by key.
pub(crate) type Values = BTreeMap<String, Checked>;

/// Typed access to the checked values of a table, and to the defaults of its keys. The checks have seen to presence and type, so what is
/// not found is a defect of the program.
#[derive(Clone, Copy)]
pub(crate) struct Node<'a> {
    pub(crate) values: &'a Values,
    keys: Keys,
}

/// The keys that a table can have.
#[derive(Clone, Copy)]
enum Keys {
    Fixed(&'static [Field]),
    /// Names of the user's choice, each for a table with these keys.
    Names(&'static [Field]),
}

/// A table that a scene file does not have.
static EMPTY: Values = Values::new();

impl<'a> Node<'a> {
    pub(crate) fn new(values: &'a Values, keys: &'static [Field]) -> Self {
        Self { values, keys: Keys::Fixed(keys) }
    }

    /// Whether the file has the key.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.values.contains_key(key)
    }

    /// The form that the key has in a table of this kind.
    fn field(&self, key: &str) -> Result<&'static Field> {
        let Keys::Fixed(fields) = self.keys else { return Err(unchecked(key)) };
        let kind = match self.values.get("kind") {
            Some(Checked::Text(kind)) => Some(kind.as_str()),
            _ => None,
        };
        let named = || fields.iter().filter(|field| field.key == key);
        named().find(|field| field.belongs_to(kind)).or_else(|| named().next()).ok_or_else(|| unchecked(key))
    }

    /// What holds where the key is absent.
    fn default(&self, key: &str) -> Result<&'static str> {
        self.field(key)?.default.ok_or_else(|| unchecked(key))
    }

    fn below(&self, key: &str, values: &'a Values) -> Result<Node<'a>> {
        let keys = match self.keys {
            Keys::Names(fields) => Keys::Fixed(fields),
            Keys::Fixed(_) => match self.field(key)?.kind {
                Kind::Table(fields) | Kind::Tables(fields, _) => Keys::Fixed(fields),
                Kind::TableOf(fields) => Keys::Names(fields),
                _ => Keys::Fixed(&[]),
            },
        };
        Ok(Node { values, keys })
    }

    pub(crate) fn table(&self, key: &str) -> Result<Node<'a>> {
        match self.values.get(key) {
            Some(Checked::Table(values)) => self.below(key, values),
            found => Err(mismatch(key, found)),
        }
    }

    pub(crate) fn optional_table(&self, key: &str) -> Result<Option<Node<'a>>> {
        self.has(key).then(|| self.table(key)).transpose()
    }

    /// The table, without values if the file has none.
    pub(crate) fn table_or_defaults(&self, key: &str) -> Result<Node<'a>> {
        if self.has(key) { self.table(key) } else { self.below(key, &EMPTY) }
    }

    /// The tables of a list, none if it is not there.
    pub(crate) fn tables(&self, key: &str) -> Result<Vec<Node<'a>>> {
        match self.values.get(key) {
            None => Ok(Vec::new()),
            Some(Checked::Tables(tables)) => tables.iter().map(|table| self.below(key, table)).collect(),
            found => Err(mismatch(key, found)),
        }
    }

    pub(crate) fn number(&self, key: &str) -> Result<f64> {
        match self.values.get(key) {
            Some(Checked::Number(number)) => Ok(*number),
            None => self.default_number(key),
            found => Err(mismatch(key, found)),
        }
    }

    fn default_number(&self, key: &str) -> Result<f64> {
        let field = self.field(key)?;
        let text = field.default.ok_or_else(|| unchecked(key))?;
        // most have no unit, and a sweep reads them at every point
        if let Ok(number) = text.parse() {
            return Ok(number);
        }
        let Kind::Quantity(dimension, _) = field.kind else { return Err(unchecked(key)) };
        quantity::parse(text, dimension).map_err(|_| unchecked(key))
    }

    pub(crate) fn numbers(&self, key: &str) -> Result<Vec<f64>> {
        match self.values.get(key) {
            Some(Checked::Numbers(numbers)) => Ok(numbers.clone()),
            found => Err(mismatch(key, found)),
        }
    }

    pub(crate) fn texts(&self, key: &str) -> Result<Vec<String>> {
        match self.values.get(key) {
            Some(Checked::Texts(texts)) => Ok(texts.clone()),
            found => Err(mismatch(key, found)),
        }
    }

    pub(crate) fn count(&self, key: &str) -> Result<u64> {
        match self.values.get(key) {
            Some(Checked::Count(count)) => Ok(*count),
            None => self.default(key)?.parse().map_err(|_| unchecked(key)),
            found => Err(mismatch(key, found)),
        }
    }

    pub(crate) fn flag(&self, key: &str) -> Result<bool> {
        match self.values.get(key) {
            Some(Checked::Flag(flag)) => Ok(*flag),
            None => self.default(key)?.parse().map_err(|_| unchecked(key)),
            found => Err(mismatch(key, found)),
        }
    }

    pub(crate) fn text(&self, key: &str) -> Result<&'a str> {
        match self.values.get(key) {
            Some(Checked::Text(text)) => Ok(text),
            None => self.default(key),
            found => Err(mismatch(key, found)),
        }
    }

    /// One of the words that `T` is called in scene files.
    pub(crate) fn word<T: DeserializeOwned>(&self, key: &str) -> Result<T> {
        let word = self.text(key)?;
        let named: std::result::Result<T, serde::de::value::Error> = T::deserialize(word.into_deserializer());
        named.map_err(|_| unknown(key, word))
    }

    /// The number, if the file has it.
    pub(crate) fn optional_number(&self, key: &str) -> Result<Option<f64>> {
        self.has(key).then(|| self.number(key)).transpose()
    }

    /// The count, if the file has it.
    pub(crate) fn optional_count(&self, key: &str) -> Result<Option<u64>> {
        self.has(key).then(|| self.count(key)).transpose()
    }

    /// The word, if the file has it.
    pub(crate) fn optional_word<T: DeserializeOwned>(&self, key: &str) -> Result<Option<T>> {
        self.has(key).then(|| self.word(key)).transpose()
    }
}

fn unchecked(key: &str) -> Error {
    Error::Internal(format!("the scene's `{key}` was not checked"))
}

fn mismatch(key: &str, found: Option<&Checked>) -> Error {
    match found {
        None => unchecked(key),
        Some(found) => Error::Internal(format!("the scene's `{key}` was checked as {found:?}")),
    }
}

pub(crate) fn unknown(key: &str, word: &str) -> Error {
    Error::Internal(format!("the scene's `{key}` = `{word}` has no type"))
}
