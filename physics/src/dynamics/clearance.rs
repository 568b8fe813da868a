//! Whether a contact that is open at all points of a step touches in between.
//!
//! The forces at the points of a step are all it knows of a contact: a short touch between two of them would be passed
//! without a trace. The approach's polynomial through the points shows it.

use super::collocation::{Collocation, POINTS, Points, crossing, horner};
use std::sync::LazyLock;

/// Weights of the values at all points in the polynomial's values halfway between them. Shape (POINTS, POINTS - 1).
static MIDDLES: LazyLock<[[f64; POINTS - 1]; POINTS]> = LazyLock::new(|| {
    let collocation = Collocation::default();
    let points = collocation.points;
    std::array::from_fn(|l| {
        let polynomial = collocation.through(&std::array::from_fn(|p| if p == l { 1.0 } else { 0.0 }));
        std::array::from_fn(|m| horner(&polynomial, 0.5 * (points[m] + points[m + 1])))
    })
});

/// A touch between the points of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StepContact {
    /// Where in the step (0..1) it begins.
    pub(super) place: f64,
    /// Its depth in m.
    pub(super) depth: f64,
}

/// The touch, if any, of a contact whose approaches at start, Gauss points and end of a step are `approach` in m, none of
/// them positive but, by a rounding error, that at the start.
#[inline]
pub(super) fn contact_between(collocation: &Collocation, approach: &Points) -> Option<StepContact> {
    let mut middles = [0.0; POINTS - 1];
    for (weights, value) in MIDDLES.iter().zip(approach) {
        for (middle, weight) in middles.iter_mut().zip(weights) {
            *middle += weight * value;
        }
    }
    let depth = middles.iter().fold(0.0, |depth: f64, a| depth.max(*a));
    if depth <= 0.0 {
        return None;
    }
    let before = middles.iter().position(|a| *a > 0.0)?;
    let [low, high] = [before, before + 1].map(|p| collocation.points[p]);
    let polynomial = collocation.through(approach);
    let place = crossing(&polynomial, [low, 0.5 * (low + high)], [approach[before], middles[before]]);
    Some(StepContact { place, depth })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A parabola that is positive on 0.4..0.6, between the second and the third Gauss point.
    #[test]
    fn a_contact_between_two_points_is_found_with_place_and_depth() {
        let collocation = Collocation::default();
        let approach = collocation.points.map(|u| 0.01 - (u - 0.5_f64).powi(2));
        let contact = contact_between(&collocation, &approach).unwrap();
        assert_relative_eq!(contact.place, 0.4, epsilon = 1e-9);
        assert_relative_eq!(contact.depth, 0.01, epsilon = 1e-12);
    }

    #[test]
    fn a_gap_that_stays_open_has_no_contact() {
        let collocation = Collocation::default();
        for open in [|u: f64| -u, |u: f64| u - 1.0, |u: f64| -1e-3 - (u - 0.5).powi(2)] {
            assert_eq!(contact_between(&collocation, &collocation.points.map(open)), None);
        }
    }
}
