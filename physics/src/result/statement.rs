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

    /// That `found` is at most `limit`, give or take `slack`; expected is the nearest value that is.
    pub fn at_most(about: impl Into<String>, unit: &'static str, found: f64, limit: f64, slack: f64) -> Self {
        Statement::new(about, unit, found, found.min(limit), slack)
    }

    /// That `found` is at least `limit`, as [`Statement::at_most`].
    pub fn at_least(
        about: impl Into<String>,
        unit: &'static str,
        found: f64,
        limit: f64,
        slack: f64,
    ) -> Self {
        Statement::new(about, unit, found, found.max(limit), slack)
    }

    /// Whether it holds; of a value that is not a number it does not.
    pub fn holds(&self) -> bool {
        (self.found - self.expected).abs() <= self.bound
    }
}

#[cfg(test)]
mod tests {
    use super::Statement;

    #[test]
    fn a_limit_holds_on_one_side() {
        for (found, holds) in [(-9.0, true), (1.0, true), (1.05, true), (1.2, false), (f64::NAN, false)] {
            assert_eq!(Statement::at_most("x", "m", found, 1.0, 0.1).holds(), holds, "{found}");
            assert_eq!(Statement::at_least("x", "m", -found, -1.0, 0.1).holds(), holds, "{found}");
        }
        assert_eq!(Statement::at_most("x", "m", 2.0, 1.0, 0.1).expected, 1.0);
    }
}
