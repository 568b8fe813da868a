//! What must hold of a result by itself.

/// Something found in a result, and what it has to be whatever the tolerances are.
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// What it is about.
    pub about: String,
    /// Unit of the values.
    pub unit: &'static str,
    /// Value found.
    pub found: f64,
    /// Value that it should have.
    pub expected: f64,
    /// Largest admissible |found - expected|.
    pub bound: f64,
}

impl Statement {
    /// That `found` is `expected` to within `bound`.
    pub fn new(about: impl Into<String>, unit: &'static str, found: f64, expected: f64, bound: f64) -> Self {
        Statement { about: about.into(), unit, found, expected, bound }
    }

    /// Whether it holds; of a value that is not a number it does not.
    pub fn holds(&self) -> bool {
        (self.found - self.expected).abs() <= self.bound
    }
}
