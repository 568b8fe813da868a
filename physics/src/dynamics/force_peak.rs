//! The largest force of a contact in a step, from the bodies' own motion.
//!
//! The force polynomials of a step are as exact as its impulse and its energy have to be. For a peak that is too little: a
//! kink or a vibration quicker than the step goes into none of them. The bodies' answer to the polynomials is known
//! exactly at any time, and as the forces' double integral it is far more exact than they are; what the contacts answer
//! to it is the force whose peak is meant.

use super::collocation::{Collocation, crossing, derivative, horner};
use super::step_bounds::argmax;
use super::system::{System, dot};

/// Gain of a further Newton step, over the force, at which the peak is found.
const FOUND: f64 = 1e-11;
/// Newton steps at most.
const MAX_ITERATIONS: usize = 20;
/// Difference, over the approach, between motion and polynomial from which on the step has vibrations quicker than itself.
const QUICK: f64 = 1e-8;
/// Places at which such a step is looked at: so many per radian of the quickest oscillator, within the range.
const PER_RADIAN: f64 = 2.0;
const PLACES: (f64, f64) = (16.0, 512.0);

/// Second derivatives over those by differences that are believed.
const LIKELY: std::ops::Range<f64> = 0.8..1.25;

/// How far, over the force, a peak may rise between the points of a step.
const BETWEEN: f64 = 0.01;

/// Modal approaches of both contacts in m at a place of a step, with their first and second derivatives by the place.
pub(super) type Motion = [[f64; 2]; 3];

/// A solved step, known at `P` points, of which the motion can be asked for anywhere.
pub(super) struct SolvedStep<'a, const P: usize, M: Fn(f64) -> Motion> {
    pub(super) system: &'a System,
    pub(super) collocation: &'a Collocation<P>,
    /// Length in s.
    pub(super) h: f64,
    /// Modal approaches at its points, m.
    pub(super) approach: &'a [[f64; P]; 2],
    /// Forces there, N.
    pub(super) force: &'a [[f64; P]; 2],
    /// Error that a peak may have, relative.
    pub(super) error: f64,
    /// The motion at a place from 0 to 1.
    pub(super) motion: M,
}

/// Force in N and its first and second derivative by the place, of the second only what matters where the first is zero.
type Force = [f64; 3];

/// The second derivative of a force: `bend`, unless the slopes at two places contradict it. It leaves out that the law itself
/// changes, which counts where the other contact's patch does: there the force turns while its own approach still grows.
fn turning(bend: f64, before: Option<(f64, f64)>, (place, slope): (f64, f64)) -> f64 {
    let Some((earlier, steeper)) = before else { return bend };
    let secant = (slope - steeper) / (place - earlier);
    if !secant.is_finite() || LIKELY.contains(&(bend / secant)) { bend } else { secant }
}

impl<const P: usize, M: Fn(f64) -> Motion> SolvedStep<'_, P, M> {
    /// Largest force of `contact` in N, if it may exceed `before` N; `rising` tells whether the force rises at the start
    /// (0) or the end (1).
    pub(super) fn peak(&self, contact: usize, before: f64, rising: impl Fn(usize) -> bool) -> f64 {
        let force = &self.force[contact];
        let (highest, largest) = argmax(force);
        if largest <= 0.0 || largest * (1.0 + BETWEEN) + 4.0 * self.defect(contact) <= before {
            return before;
        }
        let points = &self.collocation.points;
        let [low, high] = match highest {
            0 if rising(0) => [points[0], points[1]],
            _ if highest == P - 1 && !rising(1) => [points[P - 2], points[P - 1]],
            _ if highest == 0 || highest == P - 1 => return before.max(largest),
            _ => [points[highest - 1], points[highest + 1]],
        };
        let polynomial = self.collocation.through(&self.approach[contact]);
        let slope = derivative(&polynomial);
        let ends = [low, high];
        let guess = crossing(&slope, ends, ends.map(|u| horner(&slope, u))).clamp(low, high);
        let expected = horner(&polynomial, guess);
        let quick =
            ((self.motion)(guess)[0][contact] - expected).abs() > QUICK.max(self.error) * expected.abs();
        let found = if quick { self.search(contact) } else { self.climb(contact, guess, ends) };
        before.max(largest).max(found)
    }

    /// Distance in N between the force at the end (the start) and the polynomial through the nodes.
    fn defect(&self, contact: usize) -> f64 {
        let force = &self.force[contact];
        let nodes = &force[1..=crate::numerics::stages::STAGES];
        let [start, end] = self.collocation.ends.map(|weights| dot(&weights, nodes));
        (force[0] - start).abs().max((force[P - 1] - end).abs())
    }

    /// The highest of the peaks in the whole step.
    fn search(&self, contact: usize) -> f64 {
        let places = (PER_RADIAN * self.system.highest_frequency() * self.h).clamp(PLACES.0, PLACES.1).ceil();
        let at = |k: f64| (k / places).clamp(0.0, 1.0);
        let forces: Vec<f64> =
            (0..=places as usize).map(|k| self.force_at(contact, at(k as f64))[0]).collect();
        let (highest, _) = argmax(&forces);
        let k = highest as f64;
        self.climb(contact, at(k), [at(k - 1.0), at(k + 1.0)])
    }

    /// The peak between the places `low` and `high`, from `place` on, by Newton's method.
    fn climb(&self, contact: usize, mut place: f64, [mut low, mut high]: [f64; 2]) -> f64 {
        let (mut best, mut before) = (0.0, None);
        for _ in 0..MAX_ITERATIONS {
            let [force, slope, bend] = self.force_at(contact, place);
            best = force.max(best);
            let bend = turning(bend, before, (place, slope));
            before = Some((place, slope));
            if slope * slope <= 2.0 * FOUND.max(self.error) * force * bend.abs() {
                break;
            }
            if slope > 0.0 {
                low = place
            } else {
                high = place
            }
            let newton = place - slope / bend;
            // false for NaN also
            let inside = bend < 0.0 && newton >= low && newton <= high;
            place = if inside { newton } else { 0.5 * (low + high) };
        }
        best
    }

    /// What `contact` answers to the motion at `place`; nothing where the contacts have no equilibrium.
    fn force_at(&self, contact: usize, place: f64) -> Force {
        let [approach, rate, acceleration] = (self.motion)(place);
        let Some((local, force)) = self.system.contact(approach, approach) else { return [0.0; 3] };
        let along = |motion: [f64; 2]| self.system.force_rate(local, motion)[contact];
        [force[contact], along(rate), along(acceleration)]
    }
}
