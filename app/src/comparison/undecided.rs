//! What would decide a row that the reference leaves open: by its band, or because it has no value.

use super::discrepancy::Discrepancy;
use super::verdict::Verdict;
use crate::format::{prefixed, with_unit};
use crate::result::Summary;

/// Rounding error of a difference, relative.
const ROUNDING: f64 = 1e-9;
/// Smallest relative band that a reference can be asked for.
const SMALLEST_TARGET: f64 = 1e-4;

/// What would decide `row` if it is undecided.
pub(super) fn advice(row: &Discrepancy, reference: &Summary) -> Option<String> {
    (row.verdict == Verdict::Undecided).then(|| sentence(row, targeted_band(reference))).flatten()
}

/// Largest relative band of what `--target-error` is about: efficiency and force peaks.
fn targeted_band(reference: &Summary) -> Option<f64> {
    let targeted = |name: &str| name == "efficiency" || name.ends_with("_force_peak");
    let relative = |(name, band): (&String, &f64)| Some(band / reference.value(name)?.abs());
    let bands = reference.uncertainty.iter().filter(|(name, _)| targeted(name)).filter_map(relative);
    bands.filter(|band| band.is_finite()).reduce(f64::max)
}

/// With the band narrowed to the distance from the bound, the row is decided. All bands shrink alike with the mesh.
fn sentence(row: &Discrepancy, reached: Option<f64>) -> Option<String> {
    if row.has_no_reference() {
        return Some("the reference has no value of it: use one that has, or remove the tolerance".into());
    }
    let (tolerance, band) = (row.tolerance?, row.band()?);
    let needed = (tolerance - row.checked()).abs();
    let to = prefixed(&row.unit, row.reference.unwrap_or(band));
    let [needed_value, now] =
        [rounded_down(needed * (1.0 + ROUNDING)), band].map(|value| with_unit(value, to, 2));
    let uncertainty = format!("an uncertainty of at most {needed_value} is needed (now {now})");
    // what a target is about is the reference's own band
    let reached = reached.filter(|_| row.difference_uncertainty.is_none());
    let target = reached.map(|reached| reached * needed / band);
    Some(match target {
        Some(target) if target >= SMALLEST_TARGET => {
            let target = rounded_down(100.0 * target);
            format!(
                "{uncertainty}: compute the reference with --target-error {target}% and pass --resolution {target}%, or take a finer --resolution"
            )
        }
        None if band.is_finite() => format!("{uncertainty}: take a finer --resolution"),
        _ => format!("{uncertainty}, which no mesh gives: specify a tolerance wider than the uncertainty"),
    })
}

/// Two digits, not larger than `value`.
fn rounded_down(value: f64) -> f64 {
    let unit = 10_f64.powf(value.log10().floor() - 1.0);
    let rounded = (value / unit).floor() * unit;
    // the shortest number that reads the same
    format!("{rounded:.1e}").parse().unwrap_or(rounded)
}

#[cfg(test)]
mod tests {
    use super::{rounded_down, sentence};
    use crate::comparison::Verdict;
    use crate::comparison::discrepancy::{Discrepancy, Scales};
    use crate::format::{prefixed, with_unit};
    use crate::scene::Tolerance;

    fn row(reduced: f64, band: f64) -> Discrepancy {
        let tolerance = Tolerance { relative: Some(0.01), ..Tolerance::default() };
        let scales = Scales { value: 100.0, peak: 100.0 };
        Discrepancy::new(("x", "N"), (Some(reduced), Some(100.0)), scales, Some(&tolerance), Some(band))
    }

    #[test]
    fn the_requested_band_decides() {
        for (reduced, needed, verdict) in [(100.4, 0.6, Verdict::Pass), (101.4, 0.4, Verdict::Fail)] {
            let text = sentence(&row(reduced, 2.0), Some(0.05)).expect("undecided");
            assert!(
                text.starts_with(&format!(
                    "an uncertainty of at most {} is needed (now 2.0 N)",
                    with_unit(rounded_down(needed), prefixed("N", 1.0), 2)
                )),
                "{text}"
            );
            assert_eq!(row(reduced, 2.0).verdict, Verdict::Undecided);
            assert_eq!(row(reduced, 0.99 * needed).verdict, verdict);
            // all bands shrink alike
            let exactly: f64 = 1.0 - (reduced - 100.0_f64).abs();
            let target = rounded_down(100.0 * 0.05 * exactly.abs() / 2.0);
            assert!(
                text.contains(&format!("--target-error {target}% and pass --resolution {target}%")),
                "{text}"
            );
        }
        assert_eq!([0.129, 1.0, 0.0999].map(rounded_down), [0.12, 1.0, 0.099]);
    }

    #[test]
    fn what_no_mesh_gives_is_not_advised() {
        let text = sentence(&row(100.999, 2.0), Some(0.05)).expect("undecided");
        assert!(text.contains("which no mesh gives") && !text.contains("--target-error"), "{text}");
        let text = sentence(&row(100.4, 2.0), None).expect("undecided");
        assert!(text.ends_with(": take a finer --resolution"), "{text}");
    }
}
