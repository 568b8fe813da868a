//! Numbers of a scene file, with their units and bounds.

use super::check::Checker;
use super::grammar::Bound;
use super::place::Place;
use super::quantity::{self, Dimension, QuantityError};
use super::values::Checked;
use toml::Spanned;
use toml::de::DeValue;

impl Checker<'_> {
    /// Reads a whole number.
    pub(super) fn count(
        &mut self,
        place: &Place,
        value: &Spanned<DeValue>,
        low: u64,
        high: u64,
    ) -> Option<Checked> {
        let number = value.get_ref().as_integer();
        let count =
            number.and_then(|n| u64::from_str_radix(n.as_str().trim_start_matches('+'), n.radix()).ok());
        if let Some(count) = count.filter(|c| (low..=high).contains(c)) {
            return Some(Checked::Count(count));
        }
        let message = format!("but it must be a whole number from {low} to {high}");
        self.fault(
            place,
            value,
            &message,
            "out of range",
            format!("write a whole number from {low} to {high}, for example 16"),
        )
    }

    /// Reads a list of numbers or texts with units, in SI.
    pub(super) fn quantities(
        &mut self,
        place: &Place,
        value: &Spanned<DeValue>,
        items: &[Spanned<DeValue>],
        (dimension, bound): (Dimension, Bound),
        most: usize,
    ) -> Option<Checked> {
        if items.is_empty() || items.len() > most {
            let message = format!("but it has to have 1 to {most} entries; found: {}", items.len());
            let help = format!("write a list like [\"{}\"]", dimension.describe().2);
            return self.fault(place, value, &message, "wrong length", help);
        }
        let mut read = |item| {
            let number = self.quantity(place, item, dimension, bound)?;
            self.plausible(place, item, dimension, number)
        };
        let numbers: Vec<Option<f64>> = items.iter().map(&mut read).collect();
        Some(Checked::Numbers(numbers.into_iter().collect::<Option<_>>()?))
    }

    /// `number` if anybody can mean it.
    pub(super) fn plausible(
        &mut self,
        place: &Place,
        value: &Spanned<DeValue>,
        dimension: Dimension,
        number: f64,
    ) -> Option<f64> {
        if dimension.is_plausible(number) {
            return Some(number);
        }
        let ([low, high], (what, ..)) = (dimension.span(), dimension.describe());
        let message = format!("but {what} has to lie between {low:e} and {high:e}{}", dimension.suffix());
        let help = "a number that is much larger or smaller than anything that is struck is a slip: is it the right unit, the right power of ten?";
        self.fault(place, value, &message, "out of range", help.to_owned())
    }

    /// Reads a number or a text with unit, in SI.
    pub(super) fn quantity(
        &mut self,
        place: &Place,
        value: &Spanned<DeValue>,
        dimension: Dimension,
        bound: Bound,
    ) -> Option<f64> {
        let (needed, (what, unit, sample)) = (dimension.in_words(), dimension.describe());
        let in_degrees = dimension == Dimension::ANGLE
            && matches!(value.get_ref(), DeValue::String(text) if text.trim_end().ends_with("deg"));
        let (unit, range) = if in_degrees {
            ("deg", bound.in_degrees().describe("deg"))
        } else {
            (unit, bound.describe(unit))
        };
        let help = if dimension == Dimension::NONE {
            format!("write a number that is {range}, for example {sample}")
        } else {
            format!(
                "write {what} that is {range}: a number in {unit} or a text with its unit, for example \"{sample}\""
            )
        };
        let outcome = match value.get_ref() {
            DeValue::Float(number) => number.as_str().parse().map_err(|_| QuantityError::NotANumber),
            DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix())
                .map(|n| n as f64)
                .map_err(|_| QuantityError::OutOfRange),
            DeValue::String(text) => quantity::parse(text, dimension),
            found => {
                let message = format!("but it must be {needed}; found: {}", found.type_str());
                return self.fault(place, value, &message, "wrong type", help);
            }
        };
        let number = match outcome {
            Ok(number) => number + 0.0,
            Err(error) => {
                let message = match error {
                    QuantityError::NotANumber => {
                        format!("which is not a number with a unit; {needed} is needed")
                    }
                    QuantityError::UnknownUnit(u) if u.starts_with(',') => {
                        format!("but the decimal separator is a point, not a comma; {needed} is needed")
                    }
                    QuantityError::UnknownUnit(u) => {
                        format!(
                            "but `{u}` is not a known unit; {needed} is needed (units are written as symbols: mm, um, kg, ms)"
                        )
                    }
                    QuantityError::MalformedUnit(u) => {
                        format!("but `{u}` is not a product of units; {needed} is needed")
                    }
                    QuantityError::WrongDimension(u) => {
                        let unit = if dimension == Dimension::NONE { "none" } else { unit };
                        format!("but `{u}` is not the unit of {what}; {unit} is needed, with any prefix")
                    }
                    QuantityError::OutOfRange => "which double precision can't hold".to_owned(),
                };
                return self.fault(place, value, &message, "not a valid quantity", help);
            }
        };
        if !bound.holds(number) {
            let finite = if number.is_finite() { "" } else { "finite and " };
            let message = format!("but it must be {finite}{range}");
            return self.fault(place, value, &message, "out of range", help);
        }
        Some(number)
    }
}
