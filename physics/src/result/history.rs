//! The course of an impact over time: curves by name over one time axis.

use std::ops::{Index, IndexMut};

/// A curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name, as in the files of a history.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Whether it is of an elastic body, which swings on when nothing touches it any more.
    pub is_elastic: bool,
    /// Values in the unit. Shape (samples).
    pub values: Vec<f64>,
}

impl Curve {
    /// Of a rigid body or a force, without samples.
    pub const fn new(name: &'static str, unit: &'static str) -> Self {
        Curve { name, unit, is_elastic: false, values: Vec::new() }
    }

    /// Of an elastic body, without samples.
    pub const fn elastic(name: &'static str, unit: &'static str) -> Self {
        Curve { name, unit, is_elastic: true, values: Vec::new() }
    }
}

/// Curves over one time axis, in the order of their kind of scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    /// Time in s since the first touch, strictly increasing. Shape (samples).
    pub time: Vec<f64>,
    /// The curves.
    pub curves: Vec<Curve>,
}

impl History {
    /// These curves.
    pub fn new(curves: &[Curve]) -> Self {
        History { time: Vec::new(), curves: curves.to_vec() }
    }

    /// Adds a sample: its time in s and the values of all curves, in their order.
    pub fn push<const N: usize>(&mut self, time: f64, values: [f64; N]) {
        self.time.push(time);
        for (curve, value) in self.curves.iter_mut().zip(values) {
            curve.values.push(value);
        }
    }

    /// The curve called `name`.
    pub fn curve(&self, name: &str) -> Option<&[f64]> {
        self.curves.iter().find(|curve| curve.name == name).map(|curve| &curve.values[..])
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Whether there are at least two samples, every curve has a finite value at each, and time increases strictly.
    pub fn can_be_sampled(&self) -> bool {
        let whole = |values: &[f64]| values.len() == self.len() && values.iter().all(|v| v.is_finite());
        self.len() >= 2
            && whole(&self.time)
            && self.time.windows(2).all(|w| w[0] < w[1])
            && self.curves.iter().all(|curve| whole(&curve.values))
    }

    /// Rate at which the curve called `name` goes on after the last sample, in free flight; `None` if a contact is closed
    /// there, if the body's own contact force is not given, or if the curve is one of an elastic body.
    pub fn rate_after_end(&self, name: &str) -> Option<f64> {
        let curve = self.curves.iter().find(|curve| curve.name == name && !curve.is_elastic)?;
        let (body, _) = name.split_once('_')?;
        self.curve(&format!("{body}_force"))?;
        let mut forces = self.curves.iter().filter(|curve| curve.unit == "N");
        if !forces.all(|force| force.values.last() == Some(&0.0)) {
            return None;
        }
        // a displacement goes on with the velocity of the same name
        let rate = self.curve(&curve.name.replace("displacement", "velocity"))?;
        if curve.unit == "m" { rate.last().copied() } else { Some(0.0) }
    }
}

impl Index<&str> for History {
    type Output = Vec<f64>;

    /// # Panics
    /// If there is no curve of this name; [`History::curve`] asks.
    fn index(&self, name: &str) -> &Vec<f64> {
        let curve = self.curves.iter().find(|curve| curve.name == name);
        &curve.unwrap_or_else(|| panic!("a history without the curve `{name}`")).values
    }
}

impl IndexMut<&str> for History {
    /// # Panics
    /// As [`Index::index`].
    fn index_mut(&mut self, name: &str) -> &mut Vec<f64> {
        let curve = self.curves.iter_mut().find(|curve| curve.name == name);
        &mut curve.unwrap_or_else(|| panic!("a history without the curve `{name}`")).values
    }
}
