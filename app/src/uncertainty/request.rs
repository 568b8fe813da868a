//! What is asked of a study of scatter.

use crate::scene::Model;

/// Quantities whose scatter is wanted when nobody names others.
pub const DEFAULT_QUANTITIES: [&str; 3] = ["efficiency", "outer_force_peak", "inner_force_peak"];

/// How much to sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Samples {
    /// So many rows.
    Rows(usize),
    /// Doubled until the 95 % intervals of mean and standard deviation of the requested quantities are no wider than
    /// this share of the standard deviation to either side.
    Until(f64),
}

/// What is asked of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The reduced model.
    pub model: Model,
    /// Its number of modes; `None` = as `reduced`.
    pub modes: Option<usize>,
    /// How much to sample.
    pub samples: Samples,
    /// The quantities that `samples` is about.
    pub quantities: Vec<String>,
    /// Another one gives other samples.
    pub seed: u32,
}

impl Request {
    /// Of `model`, as [`DEFAULT_QUANTITIES`], to an `accuracy`.
    pub fn new(model: Model, accuracy: f64) -> Self {
        let quantities = DEFAULT_QUANTITIES.map(str::to_owned).into();
        Request { model, modes: None, samples: Samples::Until(accuracy), quantities, seed: 1 }
    }
}
