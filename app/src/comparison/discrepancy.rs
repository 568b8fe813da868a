//! The difference of one quantity between reduced model and reference, against its bound.

use super::verdict::{GateRules, Verdict};
use crate::scene::Tolerance;
use crate::uncertainty::validation::Assessment;
use serde::Serialize;

/// One row of the comparison. Values are in `unit`, `None` if a run did not determine them; these and what is not finite are
/// `null` in JSON.
///
/// A row of a curve (`<curve>_rms`, `<curve>_max`) holds the distance of the curves: `reduced` is
/// the distance from the reference's curve, `reference` is 0 and `relative` is over the peak of the
/// reference's curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Discrepancy {
    /// Name of the quantity.
    pub quantity: String,
    /// SI unit.
    pub unit: String,
    /// Value of the reduced model.
    pub reduced: Option<f64>,
    /// Value of the reference.
    pub reference: Option<f64>,
    /// `reduced - reference`.
    pub difference: Option<f64>,
    /// `difference / |reference|`; `None` if the reference is 0.
    pub relative: Option<f64>,
    /// Half width of the reference's 95 % band, absolute, if known.
    pub uncertainty: Option<f64>,
    /// Half width of the 95 % band of the difference itself, absolute, where model and reference are solutions on the same mesh
    /// and have its error in common; the verdicts then rest on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub difference_uncertainty: Option<f64>,
    /// Whether the difference can be told from the reference's numerical error; `None` if its band is unknown.
    pub band_verdict: Option<BandVerdict>,
    /// Bound on `|difference - bias|`, absolute; `None` = not gated.
    pub tolerance: Option<f64>,
    /// Known discrepancy of the model, absolute; `None` = none stated.
    pub bias: Option<f64>,
    /// Whether the checked value is within the bound, wherever the truth lies in the reference's band. A band that is not
    /// known counts as none.
    pub verdict: Verdict,
    /// If it is undecided: what would decide it, in one sentence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub would_decide: Option<String>,
    /// What it shows if the inputs are as uncertain as the scene says; not gated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub validation: Option<Assessment>,
}

/// Comparison error |E| against the uncertainty u of the comparison (ASME V&V 20-2009, section 1-6). Here u is
/// the reference's 95 % band: both sides solve the same scene, so no input is uncertain, and the reduced model's own
/// numerical error is smaller by orders of magnitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum BandVerdict {
    /// |E| <= u: the model's error, if any, is hidden in the reference's.
    Within,
    /// |E| > u: the model differs, by about E.
    Beyond,
}

impl BandVerdict {
    /// `None` if one of them is not a number.
    pub(super) fn of(difference: f64, uncertainty: f64) -> Option<Self> {
        let comparable = difference.is_finite() && uncertainty.is_finite();
        let within = difference.abs() <= uncertainty;
        comparable.then_some(if within { BandVerdict::Within } else { BandVerdict::Beyond })
    }

    /// For people.
    pub fn words(self) -> &'static str {
        match self {
            BandVerdict::Within => "within the uncertainty",
            BandVerdict::Beyond => "beyond the uncertainty",
        }
    }
}

/// Magnitudes that relative bounds refer to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scales {
    /// Of the reference's value; of the peak of its curve for a row of a curve.
    pub(super) value: f64,
    /// Of the peak of the quantity's curve in the reference.
    pub(super) peak: f64,
}

/// Bound and bias of a [`Tolerance`] in the quantity's own unit.
struct ToleranceBound {
    /// The widest of the bounds given: being within any of them is enough.
    width: f64,
    bias: Option<f64>,
}

impl ToleranceBound {
    /// `None` if the tolerance gives no bound.
    fn of(tolerance: &Tolerance, scales: Scales) -> Option<Self> {
        let bounds = [
            (tolerance.relative, scales.value),
            (tolerance.absolute, 1.0),
            (tolerance.relative_to_peak, scales.peak),
        ];
        let mut given = bounds.into_iter().filter_map(|(bound, scale)| Some((bound?, scale)));
        let (first, scale) = given.next()?;
        let width = given.map(|(bound, scale)| bound * scale).fold(first * scale, f64::max);
        Some(ToleranceBound { width, bias: tolerance.bias.map(|bias| bias * scale) })
    }
}

impl Discrepancy {
    /// Row with `difference = reduced - reference`, gated if there is a bound.
    pub(super) fn new(
        (quantity, unit): (&str, &str),
        (reduced, reference): (Option<f64>, Option<f64>),
        scales: Scales,
        tolerance: Option<&Tolerance>,
        uncertainty: Option<f64>,
    ) -> Self {
        let difference = reduced.zip(reference).map(|(reduced, reference)| reduced - reference);
        let bound = tolerance.and_then(|t| ToleranceBound::of(t, scales));
        let bias = bound.as_ref().and_then(|b| b.bias);
        let checked = difference.map_or(f64::NAN, |difference| (difference - bias.unwrap_or(0.0)).abs());
        // what is no number fails, gated or not; what was not determined only if it is
        let verdict = match &bound {
            Some(bound) => Verdict::within(checked, uncertainty.unwrap_or(0.0), bound.width),
            None if difference.is_none_or(f64::is_finite) => Verdict::NotGated,
            None => Verdict::Fail,
        };
        Discrepancy {
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
            reduced,
            reference,
            difference,
            relative: difference.map(|difference| difference / scales.value).filter(|r| r.is_finite()),
            uncertainty,
            difference_uncertainty: None,
            band_verdict: difference.zip(uncertainty).and_then(|(error, band)| BandVerdict::of(error, band)),
            tolerance: bound.map(|b| b.width),
            bias,
            verdict,
            would_decide: None,
            validation: None,
        }
    }

    /// Row of a residual, which is small on both sides or wrong: each is gated by itself.
    pub(super) fn of_residual(
        quantity: &str,
        (reduced, reference): (Option<f64>, Option<f64>),
        tolerance: Option<&Tolerance>,
    ) -> Self {
        let scales = Scales { value: reference.map_or(f64::NAN, f64::abs), peak: 1.0 };
        let row = Discrepancy::new((quantity, "1"), (reduced, reference), scales, None, None);
        // A residual is relative already: whatever the bound is called, it is the bound of the number.
        let bound = tolerance.and_then(|t| ToleranceBound::of(t, Scales { value: 1.0, peak: 1.0 }));
        let width = bound.map(|b| b.width);
        let verdict = width.map_or(row.verdict, |width| {
            let of = |residual: Option<f64>| Verdict::within(residual.map_or(f64::NAN, f64::abs), 0.0, width);
            // a reference that states none is judged as to that by nobody
            Verdict::worst([Some(reduced), reference.map(Some)].into_iter().flatten().map(of))
        });
        Discrepancy { tolerance: width, verdict, ..row }
    }

    /// The row of a tolerance for which the reference has no value.
    pub(super) fn undecided(self) -> Self {
        Discrepancy { verdict: Verdict::Undecided, ..self }
    }

    /// Whether a tolerance is undecided because the reference has no value for it.
    pub fn has_no_reference(&self) -> bool {
        self.verdict == Verdict::Undecided && self.reference.is_none()
    }

    /// Whether the scene states a tolerance for it.
    pub fn is_gated(&self) -> bool {
        self.tolerance.is_some() || self.has_no_reference()
    }

    /// Whether the row stops at the gate: where tolerances are required, each needs a value to be compared with.
    pub fn is_refused(&self, rules: GateRules) -> bool {
        rules.refuse(self.verdict) || (rules.require_tolerances && self.has_no_reference())
    }

    /// The row judged by the 95 % band of the difference itself, of half width `band`.
    pub(super) fn judged_by(self, band: f64) -> Self {
        let verdict = self.tolerance.map(|tolerance| Verdict::within(self.checked(), band, tolerance));
        Discrepancy {
            difference_uncertainty: Some(band),
            band_verdict: self.difference.and_then(|error| BandVerdict::of(error, band)),
            verdict: verdict.unwrap_or(self.verdict),
            ..self
        }
    }

    /// Half width of the band that the verdicts rest on, absolute, if it is known.
    pub fn band(&self) -> Option<f64> {
        self.difference_uncertainty.or(self.uncertainty)
    }

    /// Magnitude that is compared with the tolerance: of the difference without the known bias; NaN if it is not determined.
    pub fn checked(&self) -> f64 {
        self.difference.map_or(f64::NAN, |difference| (difference - self.bias.unwrap_or(0.0)).abs())
    }

    /// The larger magnitude of the two sides, as far as they are determined: what a row is shown in the measure of.
    pub fn size(&self) -> f64 {
        [self.reference, self.reduced].into_iter().flatten().map(f64::abs).fold(0.0, f64::max)
    }

    /// What `relative` is relative to; `None` if that is not known.
    pub fn scale(&self) -> Option<f64> {
        let of_row =
            self.difference.zip(self.relative).map(|(difference, relative)| (difference / relative).abs());
        of_row.or(self.reference.map(f64::abs)).filter(|scale| scale.is_finite() && *scale > 0.0)
    }

    /// Whether a side has not determined its value.
    pub fn is_undetermined(&self) -> bool {
        self.difference.is_none()
    }

    /// Whether the row is about a conservation residual, each of whose sides is gated by itself.
    pub fn is_residual(&self) -> bool {
        self.quantity.ends_with("_residual")
    }

    /// Whether people have to be told of the row: it fails or is undecided.
    pub fn is_reported(&self) -> bool {
        matches!(self.verdict, Verdict::Fail | Verdict::Undecided)
    }

    /// How much of the tolerance is used, 1 = all of it; `None` if the row is not gated.
    pub fn used(&self) -> Option<f64> {
        let size = |side: Option<f64>| side.map_or(f64::NAN, f64::abs);
        let checked =
            if self.is_residual() { size(self.reduced).max(size(self.reference)) } else { self.checked() };
        self.tolerance.map(|tolerance| if checked == 0.0 { 0.0 } else { checked / tolerance })
    }
}

#[cfg(test)]
mod tests {
    use super::{BandVerdict, Discrepancy, Scales};
    use crate::comparison::Verdict;
    use crate::scene::Tolerance;

    fn row(reduced: f64, reference: f64, tolerance: Tolerance) -> Discrepancy {
        let scales = Scales { value: reference.abs(), peak: 200.0 };
        Discrepancy::new(("x", "N"), (Some(reduced), Some(reference)), scales, Some(&tolerance), None)
    }

    #[test]
    fn relative_bound_refers_to_the_magnitude_of_the_reference() {
        let tolerance = Tolerance { relative: Some(0.02), ..Tolerance::default() };
        assert_eq!(row(-101.9, -100.0, tolerance).verdict, Verdict::Pass);
        assert_eq!(row(-102.1, -100.0, tolerance).verdict, Verdict::Fail);
        assert_eq!(row(-102.0, -100.0, tolerance).relative, Some(-0.02));
    }

    #[test]
    fn bias_moves_the_centre_of_the_band() {
        let tolerance = Tolerance { relative: Some(0.01), bias: Some(-0.10), ..Tolerance::default() };
        assert_eq!(row(90.5, 100.0, tolerance).verdict, Verdict::Pass);
        assert_eq!(row(88.5, 100.0, tolerance).verdict, Verdict::Fail);
        // Without the model's known error the band is left on the other side.
        assert_eq!(row(100.0, 100.0, tolerance).verdict, Verdict::Fail);
    }

    #[test]
    fn near_zero_reference_passes_by_its_absolute_bound() {
        let relative = Tolerance { relative: Some(0.01), ..Tolerance::default() };
        assert_eq!(row(1e-9, 1e-12, relative).verdict, Verdict::Fail);
        let either = Tolerance { absolute: Some(1e-6), ..relative };
        let passed = row(1e-9, 1e-12, either);
        assert_eq!((passed.verdict, passed.tolerance), (Verdict::Pass, Some(1e-6)));
        assert_eq!(row(0.0, 0.0, relative).relative, None);
    }

    #[test]
    fn a_difference_smaller_than_the_band_of_the_reference_proves_no_error() {
        let scales = Scales { value: 100.0, peak: 100.0 };
        let verdict = |reduced, band| {
            Discrepancy::new(("x", "N"), (Some(reduced), Some(100.0)), scales, None, band).band_verdict
        };
        assert_eq!(verdict(100.4, Some(0.5)), Some(BandVerdict::Within));
        assert_eq!(verdict(99.4, Some(0.5)), Some(BandVerdict::Beyond));
        assert_eq!(verdict(100.4, None), None);
        assert_eq!(verdict(f64::NAN, Some(0.5)), None);
    }

    #[test]
    fn bound_relative_to_the_peak_of_the_curve() {
        let tolerance = Tolerance { relative_to_peak: Some(0.01), ..Tolerance::default() };
        assert_eq!(row(1.9, 0.0, tolerance).verdict, Verdict::Pass);
        assert_eq!(row(2.1, 0.0, tolerance).verdict, Verdict::Fail);
    }

    #[test]
    fn what_the_band_leaves_open_is_undecided() {
        let scales = Scales { value: 100.0, peak: 100.0 };
        let verdict = |reduced, bias, band| {
            let tolerance = Tolerance { relative: Some(0.01), bias, ..Tolerance::default() };
            Discrepancy::new(("x", "N"), (Some(reduced), Some(100.0)), scales, Some(&tolerance), band).verdict
        };
        // 5.66 +- 3.9 N against a tolerance of 0.17 N proves nothing, whatever the difference
        assert_eq!(verdict(100.0, None, Some(70.0)), Verdict::Undecided);
        assert_eq!(verdict(100.4, None, Some(0.5)), Verdict::Pass);
        assert_eq!(verdict(101.4, None, Some(0.5)), Verdict::Undecided);
        assert_eq!(verdict(101.6, None, Some(0.5)), Verdict::Fail);
        // the band lies about the known discrepancy as well
        assert_eq!(verdict(110.4, Some(0.1), Some(0.5)), Verdict::Pass);
        assert_eq!(verdict(110.6, Some(0.1), Some(0.5)), Verdict::Undecided);
        assert_eq!(verdict(100.0, Some(0.1), Some(0.5)), Verdict::Fail);
        let ungated = Discrepancy::new(("x", "N"), (Some(1.0), Some(2.0)), scales, None, Some(0.5));
        assert_eq!(ungated.verdict, Verdict::NotGated);
    }

    #[test]
    fn nan_fails_even_if_nothing_is_gated() {
        let scales = Scales { value: 1.0, peak: 1.0 };
        let row = Discrepancy::new(("x", "N"), (Some(f64::NAN), Some(1.0)), scales, None, None);
        assert_eq!(row.verdict, Verdict::Fail);
        let wide = Tolerance { absolute: Some(f64::INFINITY), ..Tolerance::default() };
        let row = Discrepancy::new(("x", "N"), (Some(1.0), Some(f64::NAN)), scales, Some(&wide), None);
        assert_eq!(row.verdict, Verdict::Fail);
    }

    #[test]
    fn residuals_are_gated_on_both_sides() {
        let tolerance = Tolerance { absolute: Some(1e-5), ..Tolerance::default() };
        let verdict = |a, b| Discrepancy::of_residual("r", (Some(a), Some(b)), Some(&tolerance)).verdict;
        assert_eq!(verdict(1e-6, 1e-6), Verdict::Pass);
        assert_eq!(verdict(1e-4, 1e-6), Verdict::Fail);
        assert_eq!(verdict(1e-6, -1e-4), Verdict::Fail);
        // Two equal residuals differ by nothing, and are wrong all the same.
        assert_eq!(verdict(1e-2, 1e-2), Verdict::Fail);
        assert_eq!(verdict(f64::NAN, 0.0), Verdict::Fail);
    }
}
