//! What a step may be wrong by for the tolerance asked for.

/// Defects that a step may have, as impulses over the momentum.
pub(super) struct Bounds {
    /// Where the force is smooth.
    pub(super) smooth: f64,
    /// Where a contact touches or opens at the start or the end of the step.
    pub(super) edge: f64,
    /// Where a contact touches or opens within the step.
    pub(super) kinked: f64,
    /// Energy made from nothing per duration of a Hertz contact, over the energy of the impact.
    pub(super) energy: f64,
    /// Error of a step's impulses from ending the sweeps.
    pub(super) impulse: f64,
    /// Relative error of its forces from the same.
    pub(super) force: f64,
}

impl Bounds {
    /// For a relative error `tolerance` of the efficiency. The error of a step is of about twice the order of its
    /// defect where the forces are smooth, so that the bound may fall more slowly than the tolerance; factors and
    /// exponents are measured over scenes and numbers of modes (tests/integrator_runge_kutta.rs).
    pub(super) fn new(tolerance: f64) -> Self {
        let smooth = 0.6 * tolerance.powf(0.7);
        let kinked = 1e-3 * tolerance.powf(0.95);
        // a force that is off makes energy however short the step is
        let force = (0.5 * tolerance).clamp(1e-11, 1e-5);
        Self {
            smooth,
            kinked,
            edge: 10.0 * kinked,
            energy: (5.0 * tolerance).max(1e-9),
            impulse: 0.02 * smooth,
            force,
        }
    }
}
