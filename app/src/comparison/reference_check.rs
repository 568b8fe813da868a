//! One reference of a scene beside another program's: whether two independent solvers say the same, as far as each is sure.

use super::discrepancy::BandVerdict;
use crate::result::Summary;
use serde::Serialize;

/// Another program's solution of a scene beside the reference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReferenceCheck {
    /// Name of the other program.
    pub program: String,
    /// Whether all rows are within their joint uncertainties.
    pub verdict: BandVerdict,
    /// One entry per quantity that both determine with a band.
    pub rows: Vec<ReferenceRow>,
    /// The other program's summary.
    pub summary: Summary,
}

/// A quantity of both; values and half widths in `unit`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReferenceRow {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Value of the reference.
    pub reference: f64,
    /// Half width of its 95 % band.
    pub uncertainty: f64,
    /// Value of the other program.
    pub other: f64,
    /// Half width of its 95 % band.
    pub other_uncertainty: f64,
    /// `other - reference`.
    pub difference: f64,
    /// `difference / |reference|`; `None` if the reference is 0.
    pub relative: Option<f64>,
    /// Half width of the 95 % band of the difference: both bands, added as independent.
    pub joint_band: f64,
    /// Whether the difference can be told from the errors of both.
    pub verdict: BandVerdict,
}

impl ReferenceCheck {
    /// `other` beside `reference`, both of the same scene. Numbers of contacts, which have no band, are omitted.
    pub fn of(reference: &Summary, other: &Summary) -> Self {
        let rows: Vec<ReferenceRow> = reference
            .quantities
            .iter()
            .filter_map(|quantity| ReferenceRow::of((quantity.name, quantity.unit), reference, other))
            .collect();
        let verdict = rows.iter().map(|row| row.verdict).max().unwrap_or(BandVerdict::Within);
        let program = other.model.clone().unwrap_or_default();
        ReferenceCheck { program, verdict, rows, summary: other.clone() }
    }

    /// For people.
    pub fn words(&self) -> &'static str {
        match self.verdict {
            BandVerdict::Within => "agrees",
            BandVerdict::Beyond => "differs",
        }
    }
}

impl ReferenceRow {
    fn of(
        (quantity, unit): (&'static str, &'static str),
        reference: &Summary,
        other: &Summary,
    ) -> Option<Self> {
        let (value, uncertainty) = (reference.value(quantity)?, reference.band(quantity)?);
        let (second, other_uncertainty) = (other.value(quantity)?, other.band(quantity)?);
        let difference = second - value;
        let joint_band = uncertainty.hypot(other_uncertainty);
        Some(ReferenceRow {
            quantity,
            unit,
            reference: value,
            uncertainty,
            other: second,
            other_uncertainty,
            difference,
            relative: Some(difference / value.abs()).filter(|relative| relative.is_finite()),
            joint_band,
            // what is no number agrees with nothing
            verdict: BandVerdict::of(difference, joint_band).unwrap_or(BandVerdict::Beyond),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{BandVerdict, ReferenceCheck};
    use crate::reference::{Resolution, Store};
    use crate::result::Summary;
    use crate::scene::{Scene, resolve};

    fn stored() -> Summary {
        let scene = Scene::read(resolve("scaled-plate-r6.35").expect("shipped")).expect("valid");
        let found = Store::shipped().expect("a project").find(&scene, Resolution::Paper).found();
        found.expect("stored").outcome.summary
    }

    fn set(summary: &mut Summary, quantity: &str, value: f64, band: f64) {
        *summary.quantities.value_mut(quantity).expect(quantity) = Some(value);
        summary.uncertainty.insert(quantity.to_owned(), band);
    }

    /// 3 and 4 make 5, a difference is within that or beyond it; what one side leaves open is no row.
    #[test]
    fn uncertainties_are_combined_as_independent_and_one_row_beyond_decides() {
        let (mut own, mut other) = (stored(), stored());
        other.model = Some("elsewhere".into());
        assert_eq!(ReferenceCheck::of(&own, &other).verdict, BandVerdict::Within);
        set(&mut own, "outer_force_peak", 100.0, 3.0);
        set(&mut other, "outer_force_peak", 104.9, 4.0);
        let within = ReferenceCheck::of(&own, &other);
        let row = within.rows.iter().find(|row| row.quantity == "outer_force_peak").expect("a row");
        assert_eq!(
            (row.joint_band, row.verdict, within.verdict),
            (5.0, BandVerdict::Within, BandVerdict::Within)
        );
        set(&mut other, "outer_force_peak", 94.9, 4.0);
        let beyond = ReferenceCheck::of(&own, &other);
        assert_eq!((beyond.verdict, beyond.words()), (BandVerdict::Beyond, "differs"));
        *other.quantities.value_mut("outer_force_peak").expect("there") = None;
        let open = ReferenceCheck::of(&own, &other);
        assert_eq!((open.rows.len(), open.verdict), (beyond.rows.len() - 1, BandVerdict::Within));
    }
}
