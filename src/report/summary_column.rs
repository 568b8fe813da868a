//! The few quantities that tell a result in short, and how far a model is from the reference in them.

use crate::format::{minus, percent, prefixed, with_unit};
use crate::result::Summary;

/// A column of the table of a scene's results in short.
pub(crate) struct SummaryColumn {
    pub(crate) heading: &'static str,
    /// What it is told with, in one phrase: neighbours of the same name are told together.
    pub(crate) group: &'static str,
    pub(crate) quantity: &'static str,
    /// Whether it is shown in degrees, with differences in degrees, rather than with its unit and differences in per cent.
    pub(crate) is_angle: bool,
}

/// A result in a column.
pub(crate) struct SummaryCell {
    pub(crate) value: String,
    /// How far it is from the reference, signed: relatively, or in rad.
    pub(crate) off: Option<f64>,
    /// The same in words.
    pub(crate) off_in_words: Option<String>,
}

impl SummaryColumn {
    pub(crate) const fn new(heading: &'static str, group: &'static str, quantity: &'static str) -> Self {
        SummaryColumn { heading, group, quantity, is_angle: false }
    }

    /// What `summary` says, beside `reference`; `None` if it does not know the quantity.
    pub(crate) fn cell(&self, summary: &Summary, reference: Option<&Summary>) -> Option<SummaryCell> {
        let quantity = summary.quantities.get(self.quantity)?;
        let Some(own) = quantity.value else {
            return Some(SummaryCell { value: "not determined".into(), off: None, off_in_words: None });
        };
        let other = reference.and_then(|reference| reference.value(self.quantity));
        let value = match self.is_angle {
            true => degrees(own),
            false => with_unit(own, prefixed(quantity.unit, own), 4),
        };
        let off = match self.is_angle {
            true => other.map(|other| own - other),
            false => other.filter(|other| *other != 0.0).map(|other| (own - other) / other.abs()),
        };
        let told = |off: f64| if self.is_angle { degrees(off) } else { percent(Some(off)) };
        Some(SummaryCell { value, off, off_in_words: off.map(told) })
    }
}

/// An angle with its sign, in degrees.
pub(crate) fn degrees(angle: f64) -> String {
    // no minus sign before what rounds to zero
    let rounded = (100.0 * angle.to_degrees()).round() / 100.0 + 0.0;
    minus(&format!("{rounded:+.2}°"))
}
