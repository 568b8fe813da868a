//! Touches between the points of a step, at all of which a contact is open.
//!
//! The forces at the points are all that a step knows of a contact, and vibrations quicker than the step go into none of its
//! polynomials: the bodies' own motion, known exactly under the forces of the step, is looked at wherever they come near.

use crate::dynamics::collocation::RADAU_POINTS;
use crate::dynamics::system::System;

/// Places that are looked at: so many per radian of the quickest oscillator, within the range.
const PER_RADIAN: f64 = 2.0;
const PLACES: (f64, f64) = (8.0, 512.0);

/// Largest forces of both contacts in N, 0 where they stay open, in a step of `h` s from the state `start` (coordinates and their
/// rates); `points` are the local approaches at the points of the step of a contact that is open at all of them, and `motion`
/// gives both modal approaches at a place from 0 to 1.
pub(super) fn forces(
    system: &System,
    h: f64,
    start: [&[f64]; 2],
    points: [Option<[f64; RADAU_POINTS]>; 2],
    motion: impl Fn(f64) -> [f64; 2],
) -> [f64; 2] {
    let is_near = |i: usize| {
        let Some(points) = points[i] else { return false };
        let nearest = points.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b));
        let change = points.windows(2).fold(0.0, |a: f64, pair| a.max((pair[1] - pair[0]).abs()));
        let [q, v] = start;
        let quick = system.oscillators.iter().enumerate().filter(|(_, o)| o.omega * h > 1.0);
        let unseen: f64 =
            quick.map(|(k, o)| (system.approach[i][k] * q[k].hypot(v[k] / o.omega)).abs()).sum();
        nearest + change + 2.0 * unseen > 0.0
    };
    let near = [0, 1].map(is_near);
    let mut largest = [0.0; 2];
    if near == [false; 2] {
        return largest;
    }
    let places = (PER_RADIAN * system.highest_frequency() * h).clamp(PLACES.0, PLACES.1).ceil();
    for place in 1..places as u32 {
        let approach = motion(f64::from(place) / places);
        let Some((_, force)) = system.contact(approach, approach) else { continue };
        for i in (0..2).filter(|i| near[*i]) {
            largest[i] = force[i].max(largest[i]);
        }
    }
    largest
}
