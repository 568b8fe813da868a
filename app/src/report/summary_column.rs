//! The few quantities that tell a result in short, and how far a model is from the reference in them.

use crate::format::{minus, percent, prefixed, with_unit};
use crate::result::Summary;

/// A column of the table of a scene's results in short.
pub(crate) struct SummaryColumn {
    /// Neighbours of the same heading share it.
    pub(crate) heading: &'static str,
    /// Which of those with the same heading: `outer`; empty if there is one.
    pub(crate) place: &'static str,
    /// The quantity in a sentence, after "the".
    pub(crate) phrase: &'static str,
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
    pub(crate) const fn new(
        heading: &'static str,
        place: &'static str,
        phrase: &'static str,
        quantity: &'static str,
    ) -> Self {
        SummaryColumn { heading, place, phrase, quantity, is_angle: false }
    }

    /// Heading and place in one line.
    pub(crate) fn label(&self) -> String {
        if self.place.is_empty() {
            self.heading.to_owned()
        } else {
            format!("{}, {}", self.heading, self.place)
        }
    }

    /// The uncertainty (95 %) of the reference's value in the unit that its cell has.
    pub(crate) fn uncertainty(&self, reference: &Summary, band: f64) -> String {
        match (self.is_angle, reference.quantities.get(self.quantity)) {
            (true, _) => format!("{:.2}°", band.to_degrees()),
            (false, Some(quantity)) => {
                with_unit(band, prefixed(quantity.unit, quantity.value.unwrap_or(band)), 2)
            }
            (false, None) => String::new(),
        }
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
        let in_words = |off: f64| if self.is_angle { degrees(off) } else { percent(Some(off)) };
        Some(SummaryCell { value, off, off_in_words: off.map(in_words) })
    }
}

/// An angle with its sign, in degrees.
pub(crate) fn degrees(angle: f64) -> String {
    // no minus sign before what rounds to zero
    let rounded = (100.0 * angle.to_degrees()).round() / 100.0 + 0.0;
    minus(&format!("{rounded:+.2}°"))
}
