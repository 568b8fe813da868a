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
/// Intervals in which such a step is searched: so many per radian of the quickest oscillator, within the range. A cubic polynomial through
/// its values and slopes a radian apart misses a vibration by 0.3 % of its amplitude.
const PER_RADIAN: f64 = 1.0;
const INTERVALS: (f64, f64) = (8.0, 256.0);

/// Second derivatives over those by differences that are believed.
const LIKELY: std::ops::Range<f64> = 0.8..1.25;

/// How far, over the force, a peak may rise between the points of a step.
const BETWEEN: f64 = 0.01;

/// Modal approaches of both contacts in m at a place of a step, with their first and second derivatives by the place.
pub(super) type Motion = [[f64; 2]; 3];

/// The same without second derivatives, at the ends of equal intervals of a step.
pub(super) type Samples = Vec<[[f64; 2]; 2]>;

/// A solved step, known at `P` points, of which the motion can be asked for anywhere.
pub(super) struct SolvedStep<'a, const P: usize, M: Fn(f64) -> Motion, S: Fn(usize) -> Samples> {
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
    /// The motion at the ends of so many equal intervals.
    pub(super) samples: S,
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

/// A peak that is about to be climbed: its force in N, its place and those around it.
struct Peak {
    force: f64,
    place: f64,
    between: [f64; 2],
}

/// Place from 0 to 1 and height of the maximum of the cubic polynomial with the value and slope at both `ends`; `None` where none is
/// between them.
fn cubic_peak([[low, rise], [high, fall]]: [[f64; 2]; 2]) -> Option<(f64, f64)> {
    if !(rise > 0.0 && fall < 0.0) {
        return None;
    }
    let polynomial = [low, rise, 3.0 * (high - low) - 2.0 * rise - fall, 2.0 * (low - high) + rise + fall];
    // the slope falls through zero once between the ends: the root without cancellation
    let [c, b, a] = [rise, 2.0 * polynomial[2], 3.0 * polynomial[3]];
    let place = 2.0 * c / (-b + (b * b - 4.0 * a * c).max(0.0).sqrt());
    Some((place, horner(&polynomial, place))).filter(|_| (0.0..=1.0).contains(&place))
}

impl<const P: usize, M: Fn(f64) -> Motion, S: Fn(usize) -> Samples> SolvedStep<'_, P, M, S> {
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
        let turned = self.system.highest_frequency() * self.h;
        let intervals = (PER_RADIAN * turned).clamp(INTERVALS.0, INTERVALS.1).ceil() as usize;
        let width = 1.0 / intervals as f64;
        // force, and its slope per interval
        let mut patches = None;
        let mut answer = |[approach, rate]: [[f64; 2]; 2]| {
            let near = patches.and_then(|patches| self.system.contact(approach, patches));
            let Some((local, force)) = near.or_else(|| self.system.contact(approach, approach)) else {
                return [0.0; 2];
            };
            patches = Some(local);
            [force[contact], width * self.system.force_rate(local, rate)[contact]]
        };
        let forces: Vec<[f64; 2]> = (self.samples)(intervals).into_iter().map(&mut answer).collect();
        let largest = |best: Peak, peak: Peak| if peak.force > best.force { peak } else { best };
        let at_sample =
            |(k, [force, _]): (f64, [f64; 2])| Peak { force, place: k, between: [k - 1.0, k + 1.0] };
        let within = |(k, ends): (f64, &[[f64; 2]])| {
            let (share, force) = cubic_peak([ends[0], ends[1]])?;
            Some(Peak { force, place: k + share, between: [k, k + 1.0] })
        };
        let ks = || (0..=intervals).map(|k| k as f64);
        let samples = ks().zip(forces.iter().copied()).map(at_sample);
        let none = Peak { force: f64::NEG_INFINITY, place: 0.0, between: [0.0, 1.0] };
        let peak = samples.chain(ks().zip(forces.windows(2)).filter_map(within)).fold(none, largest);
        let at = |k: f64| (k * width).clamp(0.0, 1.0);
        self.climb(contact, at(peak.place), peak.between.map(at))
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
