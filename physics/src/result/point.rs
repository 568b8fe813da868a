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
}
