//! A touch: velocities change at once.

use super::track::tangent;
use super::{Setup, State, Vector};

/// Velocity and spin after a touch with the surface of this `normal`: Newton's restitution along it, and along the surface
/// Coulomb's impulse, at most what stops the sliding (then the sphere rolls).
pub(super) fn rebound(setup: &Setup, state: &State, normal: Vector) -> (Vector, f64) {
    let along = tangent(normal);
    let approach = state.velocity.dot(&normal);
    let slip = state.velocity.dot(&along) + setup.radius * state.spin;
    // per unit of mass; 1/m + r^2/I is 7/2 of 1/m for a full sphere
    let pressed = (-(1.0 + setup.restitution) * approach).max(0.0);
    let stopping = slip / 3.5;
    let dragged = -stopping.clamp(-setup.friction * pressed, setup.friction * pressed);
    let velocity = state.velocity + pressed * normal + dragged * along;
    (velocity, state.spin + 2.5 * dragged / setup.radius)
}
