//! Quantities by name: the form in which the results of all kinds of scene and all partners are compared, shown and kept.

use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::Value;

/// The quantity that a body has by itself, whatever an impact on it comes to.
const OF_A_BODY: &str = "first_frequency";

/// A quantity of a result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// Name, as in the JSON of a summary.
    pub name: &'static str,
    /// What it is, in sentences.
    pub about: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// The curve of a history that it belongs to, as a peak or last value.
    pub curve: Option<&'static str>,
    /// Whether it counts something: a whole number, for which a difference in per cent says little.
    pub is_count: bool,
    /// Value in the unit; `None` if the result does not determine it.
    pub value: Option<f64>,
}

/// The quantities of a result, in the order of their kind of scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table(Vec<Quantity>);

impl Table {
    /// These quantities.
    pub fn new(quantities: &[Quantity]) -> Self {
        Table(quantities.to_vec())
    }

    /// Gives these quantities the values that the JSON object `document` has under their names.
    ///
    /// # Errors
    /// One sentence that names the quantity that is missing, or neither `null` nor a number as it should be.
    pub fn read(quantities: &[Quantity], document: &Value) -> Result<Self, String> {
        let read = |quantity: &Quantity| {
            let name = quantity.name;
            let found = document.get(name).ok_or_else(|| format!("missing field `{name}`"))?;
            let fits = |n: &f64| !quantity.is_count || (*n >= 0.0 && n.fract() == 0.0);
            match found.as_f64().filter(fits) {
                None if !found.is_null() => Err(format!("invalid value of `{name}`: {found}")),
                value => Ok(Quantity { value, ..*quantity }),
            }
        };
        quantities.iter().map(read).collect::<Result<_, String>>().map(Table)
    }

    /// What is left of the quantities if the run was cut while bodies touched: nothing of the impact is determined.
    pub fn cut(mut self) -> Self {
        let of_the_impact = self.0.iter_mut().filter(|quantity| quantity.name != OF_A_BODY);
        of_the_impact.for_each(|quantity| quantity.value = None);
        self
    }

    /// The quantity called `name`.
    pub fn get(&self, name: &str) -> Option<&Quantity> {
        self.0.iter().find(|quantity| quantity.name == name)
    }

    /// The value of the quantity called `name`; `None` if there is none, or it is not determined.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.get(name)?.value
    }

    /// Where the value of the quantity called `name` stands.
    pub fn value_mut(&mut self, name: &str) -> Option<&mut Option<f64>> {
        self.0.iter_mut().find(|quantity| quantity.name == name).map(|quantity| &mut quantity.value)
    }

    /// The quantities, in order.
    pub fn iter(&self) -> std::slice::Iter<'_, Quantity> {
        self.0.iter()
    }
}

impl Serialize for Table {
    /// Values by name; `null` for what is not determined.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for quantity in &self.0 {
            match quantity.value {
                // a count is a whole number, and small
                Some(count) if quantity.is_count => map.serialize_entry(quantity.name, &(count as u64))?,
                value => map.serialize_entry(quantity.name, &value)?,
            }
        }
        map.end()
    }
}

/// The curve among at most one.
pub(crate) const fn curve(names: &[&'static str]) -> Option<&'static str> {
    match names {
        [name] => Some(name),
        _ => None,
    }
}

/// What a field of a typed result can be.
pub(crate) trait Number: Copy {
    /// Whether it counts something.
    const IS_COUNT: bool;
    /// As a value of a table.
    fn value(self) -> f64;
    /// From a value of a table.
    fn from_value(value: f64) -> Self;
}

impl Number for f64 {
    const IS_COUNT: bool = false;
    fn value(self) -> f64 {
        self
    }
    fn from_value(value: f64) -> Self {
        value
    }
}

impl Number for u32 {
    const IS_COUNT: bool = true;
    fn value(self) -> f64 {
        f64::from(self)
    }
    fn from_value(value: f64) -> Self {
        value as u32
    }
}

/// Declares the typed results of a kind of scene, every field with its unit and the curve it belongs to: the view that the kind itself works with, and
/// the [`Table`] it becomes.
macro_rules! quantities {
    ($(#[$doc:meta])* $name:ident { $($(#[doc = $about:literal])+ $field:ident: $number:ty, $unit:literal $(, of $curve:ident)?;)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name {
            $($(#[doc = $about])+ pub $field: $number,)+
        }

        impl $name {
            /// The quantities, in order, without values.
            pub const ALL: &'static [$crate::result::Quantity] = &[$($crate::result::Quantity {
                name: stringify!($field),
                about: concat!($($about),+).trim_ascii(),
                unit: $unit,
                curve: $crate::result::table::curve(&[$(stringify!($curve))?]),
                is_count: <$number as $crate::result::table::Number>::IS_COUNT,
                value: None,
            }),+];

            /// Takes every quantity from `value` by its name, in order; `None` if one is not there.
            pub fn of(mut value: impl FnMut(&str) -> Option<f64>) -> Option<Self> {
                use $crate::result::table::Number;
                Some(Self { $($field: <$number>::from_value(value(stringify!($field))?),)+ })
            }

            /// The typed view of `table`; `None` if a quantity is not there, or not determined.
            pub fn of_table(table: &$crate::result::Table) -> Option<Self> {
                Self::of(|name| table.value(name))
            }

            /// The value of the quantity called `name`.
            pub fn get(&self, name: &str) -> Option<f64> {
                use $crate::result::table::Number;
                match name {
                    $(stringify!($field) => Some(self.$field.value()),)+
                    _ => None,
                }
            }

            /// As a table.
            pub fn table(&self) -> $crate::result::Table {
                let with_value = |quantity: &$crate::result::Quantity| $crate::result::Quantity {
                    value: self.get(quantity.name),
                    ..*quantity
                };
                $crate::result::Table::new(&Self::ALL.iter().map(with_value).collect::<Vec<_>>())
            }
        }
    };
}
pub(crate) use quantities;

#[cfg(test)]
mod tests {
    use super::Table;
    use serde_json::json;

    quantities! {
        /// Three quantities.
        Three {
            /// In m.
            length: f64, "m", of way;
            /// Of something.
            number: u32, "1";
            /// Of a body by itself.
            first_frequency: f64, "Hz";
        }
    }

    const ALL: Three = Three { length: 0.5, number: 2, first_frequency: 7.0 };

    #[test]
    fn a_table_is_written_and_read_by_name() {
        let document = serde_json::to_value(ALL.table()).expect("JSON");
        assert_eq!(document, json!({"length": 0.5, "number": 2, "first_frequency": 7.0}));
        let read = Table::read(Three::ALL, &document).expect("complete");
        assert_eq!(Three::of_table(&read), Some(ALL));
    }

    #[test]
    fn what_a_cut_run_does_not_determine_is_null_and_no_number() {
        let cut = ALL.table().cut();
        let document = serde_json::to_value(&cut).expect("JSON");
        assert_eq!(document, json!({"length": null, "number": null, "first_frequency": 7.0}));
        assert_eq!(Table::read(Three::ALL, &document), Ok(cut.clone()));
        assert_eq!(Three::of(|name| cut.value(name)), None);
    }

    #[test]
    fn what_is_missing_or_no_number_is_named() {
        for (document, word) in [
            (json!({"length": 1.0, "number": 1}), "missing field `first_frequency`"),
            (json!({"length": "1 m", "number": 1, "first_frequency": 1.0}), "`length`: \"1 m\""),
            (json!({"length": 1.0, "number": 1.5, "first_frequency": 1.0}), "`number`: 1.5"),
        ] {
            let error = Table::read(Three::ALL, &document).expect_err(word);
            assert!(error.contains(word), "{error}");
        }
    }
}
