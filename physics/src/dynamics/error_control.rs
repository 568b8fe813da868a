//! Impacts that may amplify errors: solved again with a smaller tolerance until the result stands.
//!
//! Every touch and release amplifies what was wrong before it: when it comes a little later, or grazes where it would have
//! missed, everything after it is another. So does a light inner body, which takes the momentum that the outer one hardly
//! misses, and so do the phases of quick vibrations between the contacts, step after step. A bound on the error of
//! single steps can't know that. Two solutions with tolerances apart can: their difference is the error of the less exact of
//! the two.

use super::contact_balance::ContactBalance;
use super::even_steps;
use super::integrate;
use super::integration::{Converged, Integration, Options};
use super::step_bounds::{StepBounds, least_force, least_impulse};
use super::system::System;
use super::wet::FluidForces;
use crate::error::Result;

/// Touches of both contacts, steps and defects of the forces, over what they may be, up to which, and share of the outer impulse from
/// which on that the inner body takes, an impact amplifies no errors: of 3 700 random ones none was then off by more than
/// 31 times the tolerance, one in 150 by more than ten times.
const FEW_CONTACTS: u32 = 2;
const FEW_STEPS: u64 = 160;
const SMALL_DEFECT: f64 = 1.0 / 6.0;
/// The same for the sum of all defects where modes are damped: there the energy, which else betrays forces that are a little wrong step
/// after step, says nothing of vibrations quicker than the step.
const SMALL_DEFECTS: f64 = 0.8;
/// And where none is: a plate so light that both forces are nearly one trembles between its contacts by what is wrong step after
/// step, with less energy than a ledger tells.
const SMALL_UNDAMPED_DEFECTS: f64 = 3.0;
/// Damping ratio of modes from which on no impact is simple: approaches that follow the forces at once hide a part of the defect.
const STRONG_DAMPING: f64 = 0.1;
const FULL_SHARE: f64 = 0.2;
/// Factor between the tolerances of two solutions. By chance two agree and are both off: of 5 000 that are ten times apart the second was
/// then off by up to 26 times the first's tolerance, with this factor, which takes a seventh more steps, by 7 times.
const TIGHTER: f64 = 0.03;
/// Tightest tolerance that is tried.
const TIGHTEST: f64 = 1e-12;
/// Steps of a solution after which no further one follows, but for the second: it would take ten seconds, and the results state how far they
/// have converged.
const LONG: u64 = 100_000;
/// Tolerances above this ask for a rough answer: it is not looked whether the impact amplifies errors.
pub const LOW_ACCURACY: f64 = 1e-4;
/// Difference of velocities and force peaks that is in order, in tolerances.
pub const ENOUGH: f64 = 10.0;

/// Largest relative difference of the times of release where two solutions have the same contacts. They have to have the same ones
/// only where strong damping lets forces die away slowly, or bodies part slowly: where a graze comes and goes, no tolerance settles it.
const RELEASED: f64 = 3e-4;
/// The same where the error of the force decides on it: such times converge slowly, so that the second solution is hardly better than the
/// first.
const SLOWLY_RELEASED: f64 = 3e-5;
/// Sensitivity of a time of release from which on bodies part slowly, see [`ContactBalance::end_sensitivity`]; of a half-sine it is 1/pi.
const SLOW_SEPARATION: f64 = 5.0;
/// The same up to which they part so quickly that a vibration on the contact decides when: steps of the first solution do not follow it,
/// although forces and impulses are right. Of 795 random impacts with few contacts and steps the times of release then differed by up to
/// 3.8e-4, of the others by 1.4e-5.
const QUICK_SEPARATION: f64 = 0.1;
/// The same of solutions in steps of one length, of which two agree: of 144 random impacts with 0.08 to 0.12 all were within 4e-4, of 209 with
/// less three were wrong by up to 2.2e-3, with 0.06 and 0.07.
const QUICK_IN_EVEN_STEPS: f64 = 0.08;
/// Error of a time of release, as that of the force lets expect it, from which on an impact is no simple one, where bodies part with at least
/// such a sensitivity. Where it was 6.0e-4, with 0.59, the time was off by 4.7e-4.
const UNCERTAIN_RELEASE: f64 = 4e-4;
const SENSITIVE: f64 = 0.5;

/// Tolerance of the first solution over the error that all results may have ([`Options::results`]), and its least value. Of 3000 random
/// impacts around Table 1 force peaks and times of separation then had up to 0.6 of that error.
const FIRST_SOLUTION: (f64, f64) = (3e-3, 1e-7);
/// Such a solution has all results right with at most so many contacts of both bodies and steps, and at least such a share of the outer
/// impulse at the inner contact, if no contact is nearly missed: of 2117 such impacts over the whole permitted range all had; with up to
/// 30 contacts and 1500 steps 16 of 2550 had not, of most of which the time of the last release was wrong.
const CLEAR_CONTACTS: u32 = 4;
const CLEAR_STEPS: u64 = 200;
const CLEAR_SHARE: f64 = 1e-2;
/// Distance from zero, over the peak and the error, up to which a turn of an approach is a near miss.
const NEARLY_MISSED: f64 = 3.0;
/// The same over the difference of two solutions, which may be small by chance.
const NEARLY_MISSED_IN_BOTH: f64 = 10.0;
/// Contacts of both bodies that can be counted: of more, two solutions agree by chance.
const COUNTABLE: u32 = 60;

/// `options` for results with the relative `error` at most: velocities over the impact speed, force peaks, times of separation; and with
/// the right numbers of contacts. An error below 3e-5 is that of the velocities alone, as [`Options::tolerance`] has it.
pub fn all_within(error: f64, options: Options) -> Options {
    let (share, least) = FIRST_SOLUTION;
    Options {
        tolerance: (share * error).max(least).min(error),
        results: (error >= least / share).then_some(error),
        ..options
    }
}

/// Smallest tolerance, and smallest error of all results, for which steps of one length are tried: of smaller ones steps of adapted length
/// are the quicker.
pub const SMALLEST_TOLERANCE_IN_EVEN_STEPS: f64 = 2e-4;
const SMALLEST_ERROR_IN_EVEN_STEPS: f64 = 5e-5;
/// How much shorter the steps of the second and the third solution are than those of the one before. With halved steps six of 420 random
/// impacts agreed by chance, and were wrong by more than the error; with these none of 1326, over the whole permitted range.
const SHORTER: [f64; 2] = [3.0, 2.0];
/// Least order of their error, which gives the error that is left from a difference.
const LEAST_ORDER: f64 = 1.25;
/// Difference, in errors, from which on shorter steps are of no use.
const HOPELESS: f64 = 20.0;
/// Contacts of both bodies beyond which two solutions agree by chance.
const FEW_IN_EVEN_STEPS: u32 = 10;

/// Integrates the impact of `system`, in a `fluid` or without, unless it is a simple one with smaller and smaller tolerances until final
/// velocities, force peaks and impulses differ by at most ten times the tolerance of `options` and no contact is nearly missed; where
/// these name an error of all results, until times of separation and numbers of contacts agree, too. The last one is the result, its
/// [`Integration::error_estimate`] the difference to the one before, infinite where numbers of contacts differ. Where only
/// results of moderate accuracy are needed and no history, steps of one length come first.
///
/// # Errors
/// Those of [`integrate`] at the tolerance of `options`.
pub fn controlled(options: &Options, system: &System, fluid: Option<&FluidForces>) -> Result<Integration> {
    let run = |options: &Options| integrate(system, fluid, options);
    if let Some(Converged::Tolerance(tolerance)) = options.converged {
        return run(&Options { tolerance, ..*options });
    }
    if fluid.is_none()
        && let Some(found) = in_even_steps(options, system)
    {
        return Ok(found);
    }
    let best = repeated(&Options { heat: false, ..*options }, system, run)?;
    let Some(Converged::Tolerance(tolerance)) =
        best.converged.filter(|_| options.heat && system.circuit.is_some())
    else {
        return Ok(best);
    };
    // the heat takes longer than all else, and changes nothing but the balance
    let Integration { error_estimate, converged, .. } = best;
    Ok(Integration { error_estimate, converged, ..run(&Options { tolerance, ..*options })? })
}

/// The impact in steps of one length, shortened until all results of two solutions agree and the energy is kept; `None` where these steps
/// do not serve, or not soon.
fn in_even_steps(options: &Options, system: &System) -> Option<Integration> {
    let (error, smallest) = match options.results {
        Some(error) => (error, SMALLEST_ERROR_IN_EVEN_STEPS),
        None => (options.tolerance, SMALLEST_TOLERANCE_IN_EVEN_STEPS),
    };
    if error < smallest || !even_steps::serve(system, options) || is_strongly_damped(system) {
        return None;
    }
    let solve = |h: f64| even_steps::integrate(system, options, h).ok();
    let mut h = even_steps::first_length(system, error);
    let mut before = solve(h)?;
    for shorter in SHORTER {
        let moving = even_steps::moving(system, h);
        h /= shorter;
        let next = solve(h)?;
        let change = larger(difference(system, &before, &next), difference_of_contacts(&before, &next));
        let [outer, inner] = next.contacts.map(|contact| contact.contacts);
        if outer + inner > FEW_IN_EVEN_STEPS || change.is_finite() && change > HOPELESS * error {
            return None;
        }
        let left = change / (shorter.powf(LEAST_ORDER) - 1.0);
        // modes that move in neither solution leave no difference between them
        let now_moving = even_steps::moving(system, h);
        let comparable = now_moving == system.size() || now_moving > moving;
        let quickly = separates_quickly(&next, QUICK_IN_EVEN_STEPS);
        let clear = !separates_slowly(&next) && !quickly && !may_be_missed(&next, left);
        if comparable && clear && left.max(next.energy_residual) <= error {
            return Some(Integration { error_estimate: Some(left), ..next });
        }
        before = next;
    }
    None
}

/// Solutions with smaller and smaller tolerances, the last one.
fn repeated(
    options: &Options,
    system: &System,
    run: impl Fn(&Options) -> Result<Integration>,
) -> Result<Integration> {
    let at = |tolerance: f64| -> Result<Integration> {
        let result = run(&Options { tolerance, ..*options })?;
        Ok(Integration { converged: Some(Converged::Tolerance(tolerance)), ..result })
    };
    let mut best = at(options.tolerance)?;
    let right = match options.results {
        Some(error) => is_clear(system, &best, error),
        None => options.tolerance > LOW_ACCURACY || is_simple(system, &best, options.tolerance),
    };
    if right {
        return Ok(best);
    }
    let mut tolerance = options.tolerance;
    let enough = options.results.unwrap_or(ENOUGH * options.tolerance);
    while tolerance * TIGHTER >= TIGHTEST {
        tolerance *= TIGHTER;
        let Ok(next) = at(tolerance) else {
            let unknown = options.results.map(|_| f64::INFINITY);
            best.error_estimate = best.error_estimate.or(unknown);
            break;
        };
        let mut change = difference(system, &best, &next);
        let contacts = difference_of_contacts(&best, &next);
        if options.results.is_some() {
            change = larger(change, contacts);
        }
        let released = options.results.is_some()
            || contacts <= if separates_uncertainly(&best) { SLOWLY_RELEASED } else { RELEASED }
            || contacts.is_infinite() && !(is_strongly_damped(system) || separates_slowly(&next));
        best = Integration { error_estimate: Some(change), ..next };
        let open = is_countable(&best) && may_be_missed(&best, change);
        if (change <= enough && !open && released) || best.steps > LONG {
            break;
        }
    }
    if options.results.is_some()
        && best.error_estimate.is_some_and(|change| !is_countable(&best) || may_be_missed(&best, change))
    {
        best.error_estimate = Some(f64::INFINITY);
    }
    Ok(best)
}

fn is_countable(result: &Integration) -> bool {
    let [outer, inner] = &result.contacts;
    outer.contacts + inner.contacts <= COUNTABLE
}

/// Whether a contact of two solutions with the difference `change` may be one too many or be missed.
fn may_be_missed(result: &Integration, change: f64) -> bool {
    result.contacts.iter().any(|contact| contact.least_turn <= NEARLY_MISSED_IN_BOTH * change)
}

fn is_strongly_damped(system: &System) -> bool {
    system.oscillators.iter().any(|o| o.omega > 0.0 && o.alpha >= STRONG_DAMPING * o.omega)
}

/// Whether a small error of the motion is a large one of a time of release.
fn separates_slowly(result: &Integration) -> bool {
    result.contacts.iter().any(|contact| contact.end_sensitivity > SLOW_SEPARATION)
}

/// Whether a vibration on the contact decides when the bodies part.
fn separates_quickly(result: &Integration, sensitivity: f64) -> bool {
    let quickly = |contact: &ContactBalance| contact.contacts > 0 && contact.end_sensitivity < sensitivity;
    result.contacts.iter().any(quickly)
}

/// Whether the error of the force, small against its peak, matters when the bodies part: by Hertz's law that of the approach is its power 2/3.
fn separates_uncertainly(result: &Integration) -> bool {
    let error = |contact: &ContactBalance| {
        contact.end_sensitivity * (contact.force_defect / contact.force_peak).powf(2.0 / 3.0)
    };
    let is_uncertain = |contact: &ContactBalance| {
        contact.contacts > 0 && contact.end_sensitivity > SENSITIVE && error(contact) > UNCERTAIN_RELEASE
    };
    result.contacts.iter().any(is_uncertain)
}

fn is_simple(system: &System, result: &Integration, tolerance: f64) -> bool {
    let [outer, inner] = &result.contacts;
    let bound = StepBounds::new(tolerance).force_defect;
    let sum = if system.is_damped() { SMALL_DEFECTS } else { SMALL_UNDAMPED_DEFECTS };
    let small = |c: &ContactBalance| {
        let within = |defect: f64, share: f64| defect <= share * bound * c.force_peak;
        within(c.force_defect, SMALL_DEFECT) && within(c.force_defect_sum, sum)
    };
    !is_strongly_damped(system)
        && outer.contacts + inner.contacts <= FEW_CONTACTS
        && result.steps <= FEW_STEPS
        && result.contacts.iter().all(small)
        && !separates_slowly(result)
        && !separates_quickly(result, QUICK_SEPARATION)
        && !separates_uncertainly(result)
        && (inner.contacts == 0 || inner.impulse >= FULL_SHARE * outer.impulse)
}

/// Whether all results of the first solution are right to `error`: it has few contacts, the inner one is not negligible, no contact is
/// nearly missed, and neither strong damping nor a slow or quick separation makes the time of release uncertain.
fn is_clear(system: &System, result: &Integration, error: f64) -> bool {
    let [outer, inner] = &result.contacts;
    !is_strongly_damped(system)
        && outer.contacts + inner.contacts <= CLEAR_CONTACTS
        && result.steps <= CLEAR_STEPS
        && (inner.contacts == 0 || inner.impulse >= CLEAR_SHARE * outer.impulse)
        && !separates_slowly(result)
        && !separates_quickly(result, QUICK_SEPARATION)
        && result.contacts.iter().all(|contact| contact.least_turn > NEARLY_MISSED * error)
}

/// Largest relative difference of the times of separation; infinite if the numbers of contacts differ.
fn difference_of_contacts(a: &Integration, b: &Integration) -> f64 {
    let of = |i: usize| {
        let [a, b] = [a, b].map(|result| &result.contacts[i]);
        if a.contacts != b.contacts {
            return f64::INFINITY;
        }
        (a.end - b.end).abs() / b.end.max(f64::MIN_POSITIVE)
    };
    larger(of(0), of(1))
}

/// Largest difference between two results. Their impulses are witnesses too: that velocity and peak of a light body agree can be
/// chance.
fn difference(system: &System, a: &Integration, b: &Integration) -> f64 {
    let peaks = [a, b].map(|result| result.contacts.map(|c| c.force_peak));
    let [velocity, force] = differences(system, [a.velocity, b.velocity], peaks);
    let impulse = |i: usize| {
        let [first, second] = [a, b].map(|result| result.contacts[i].impulse);
        let matters = (peaks[1][i] / negligible_force(system)).min(1.0);
        matters * (first - second).abs() / second.max(f64::MIN_POSITIVE)
    };
    [force, impulse(0), impulse(1)].into_iter().fold(velocity, larger)
}

/// Force in N whose contact hardly moves even the lighter body.
fn negligible_force(system: &System) -> f64 {
    least_force(least_impulse(system), system.hertz_impact().duration())
}

/// Largest difference of the `velocities` in m/s of two results, over the impact speed, and of their force `peaks` in N,
/// relative; a contact that hardly moves even the lighter body counts as if its peak were the least that could. A value that is no
/// number comes out as one.
pub fn differences(system: &System, velocities: [[f64; 2]; 2], peaks: [[f64; 2]; 2]) -> [f64; 2] {
    let least = negligible_force(system);
    let velocity = |i: usize| (velocities[0][i] - velocities[1][i]).abs() / system.speed;
    let peak = |i: usize| (peaks[0][i] - peaks[1][i]).abs() / peaks[1][i].max(least);
    [larger(velocity(0), velocity(1)), larger(peak(0), peak(1))]
}

/// The larger value; one that is no number comes out.
fn larger(first: f64, second: f64) -> f64 {
    if first >= second || first.is_nan() { first } else { second }
}
