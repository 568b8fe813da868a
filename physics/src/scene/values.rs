//! The checked values of a scene file, and typed access to them.

use crate::{Error, Result};
use std::collections::BTreeMap;

/// A value that has passed its checks; quantities are in SI.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Checked {
    Number(f64),
    Numbers(Vec<f64>),
    Count(u64),
    Text(String),
    Texts(Vec<String>),
    Flag(bool),
    Table(Values),
    Tables(Vec<Values>),
}

/// Key of a place in each of a list of them.
pub(crate) const PLACE: &str = "at";

/// The checked values of one table by key.
pub(crate) type Values = BTreeMap<String, Checked>;

/// Typed access to checked values. The specification has seen to presence and type, so
/// what is not found is a defect of the program.
pub(crate) struct Node<'a>(pub(crate) &'a Values);

impl<'a> Node<'a> {
    pub(crate) fn get(&self, key: &str) -> Result<&'a Checked> {
        self.0.get(key).ok_or_else(|| Error::Internal(format!("the scene's `{key}` was not checked")))
    }

    pub(crate) fn table(&self, key: &str) -> Result<Node<'a>> {
        match self.get(key)? {
            Checked::Table(values) => Ok(Node(values)),
            other => Err(mismatch(key, other)),
        }
    }

    pub(crate) fn optional_table(&self, key: &str) -> Result<Option<Node<'a>>> {
        self.0.contains_key(key).then(|| self.table(key)).transpose()
    }

    /// The tables of a list, none if it is not there.
    pub(crate) fn tables(&self, key: &str) -> Result<Vec<Node<'a>>> {
        match self.0.get(key) {
            None => Ok(Vec::new()),
            Some(Checked::Tables(tables)) => Ok(tables.iter().map(Node).collect()),
            Some(other) => Err(mismatch(key, other)),
        }
    }

    pub(crate) fn number(&self, key: &str) -> Result<f64> {
        match self.get(key)? {
            Checked::Number(number) => Ok(*number),
            other => Err(mismatch(key, other)),
        }
    }

    pub(crate) fn numbers(&self, key: &str) -> Result<Vec<f64>> {
        match self.get(key)? {
            Checked::Numbers(numbers) => Ok(numbers.clone()),
            other => Err(mismatch(key, other)),
        }
    }

    pub(crate) fn texts(&self, key: &str) -> Result<Vec<String>> {
        match self.get(key)? {
            Checked::Texts(texts) => Ok(texts.clone()),
            other => Err(mismatch(key, other)),
        }
    }

    pub(crate) fn count(&self, key: &str) -> Result<u64> {
        match self.get(key)? {
            Checked::Count(count) => Ok(*count),
            other => Err(mismatch(key, other)),
        }
    }

    pub(crate) fn optional_number(&self, key: &str) -> Result<Option<f64>> {
        self.0.contains_key(key).then(|| self.number(key)).transpose()
    }

    pub(crate) fn number_or(&self, key: &str, default: f64) -> Result<f64> {
        Ok(self.optional_number(key)?.unwrap_or(default))
    }

    pub(crate) fn text(&self, key: &str) -> Result<&'a str> {
        match self.get(key)? {
            Checked::Text(text) => Ok(text),
            other => Err(mismatch(key, other)),
        }
    }
}

fn mismatch(key: &str, found: &Checked) -> Error {
    Error::Internal(format!("the scene's `{key}` was checked as {found:?}"))
}

pub(crate) fn unknown(key: &str, word: &str) -> Error {
    Error::Internal(format!("the scene's `{key}` = `{word}` has no type"))
}

/// The order of the elements, if it is given.
pub(crate) fn element_order(settings: &Node) -> Option<u64> {
    match settings.0.get("element_order") {
        Some(Checked::Count(order)) => Some(*order),
        _ => None,
    }
}
