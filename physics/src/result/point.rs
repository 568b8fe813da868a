//! What one impact of a series gives.

/// The results without what only identifies them; `Q` are the quantities of the kind of scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Point<Q> {
    /// The physical results.
    pub quantities: Q,
    /// As in [`super::Summary`].
    pub energy_residual: f64,
    /// As in [`super::Summary`].
    pub momentum_residual: f64,
    /// Time steps taken.
    pub steps: u64,
    /// Whether the time integration met its tolerance, as far as that is known.
    pub converged: bool,
}

impl<Q> Point<Q> {
    /// The same with other quantities.
    pub fn map<R>(self, of: impl FnOnce(Q) -> R) -> Point<R> {
        let Self { quantities, energy_residual, momentum_residual, steps, converged } = self;
        Point { quantities: of(quantities), energy_residual, momentum_residual, steps, converged }
    }
}
