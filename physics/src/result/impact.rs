//! One impact of a series.

use super::{Quantity, Table};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// Energy that the contacts keep.
const KEPT_ENERGY: &str = "kept_energy";

/// What one impact of a series comes to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Impact {
    /// Its number, from 1 on.
    pub number: u64,
    /// Its results.
    #[serde(flatten)]
    pub quantities: Table,
    /// Energy lost to yielding, J: of a reduced model all that the contacts keep, since its law does not tell what is locked in.
    pub plastic_work: Option<f64>,
    /// Elastic energy that the dents lock in, J; `None` of a reduced model.
    pub locked_in_energy: Option<f64>,
    /// Reference only: half width of the 95 % band of each of these, absolute, in its unit.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub uncertainty: BTreeMap<String, f64>,
}

impl Impact {
    /// What is compared of an impact, with its SI unit.
    pub const COMPARED: [(&'static str, &'static str); 4] =
        [("efficiency", "1"), ("outer_force_peak", "N"), ("inner_force_peak", "N"), (KEPT_ENERGY, "J")];

    /// The value of the quantity called `name`, or of `kept_energy`: plastic work and what is locked in.
    pub fn value(&self, name: &str) -> Option<f64> {
        if name == KEPT_ENERGY {
            return Some(self.plastic_work? + self.locked_in_energy.unwrap_or(0.0));
        }
        self.quantities.value(name)
    }

    /// Half width of its 95 % band, absolute, if it is known.
    pub fn band(&self, name: &str) -> Option<f64> {
        let known = |name: &str| self.uncertainty.get(name).copied();
        if name == KEPT_ENERGY {
            Some(known("plastic_work")? + known("locked_in_energy")?)
        } else {
            known(name)
        }
    }

    /// The impacts in the JSON `document` of a summary whose kind of scene has `quantities`.
    ///
    /// # Errors
    /// One sentence that says what is wrong.
    pub(super) fn read_all(quantities: &[Quantity], document: &Value) -> Result<Vec<Self>, String> {
        let read = |impact: &Value| {
            Ok(Self {
                number: impact["number"].as_u64().ok_or("missing field `number` of an impact")?,
                quantities: Table::read(quantities, impact)?,
                plastic_work: impact["plastic_work"].as_f64(),
                locked_in_energy: impact["locked_in_energy"].as_f64(),
                uncertainty: bands(&impact["uncertainty"]),
            })
        };
        document.as_array().into_iter().flatten().map(read).collect()
    }
}

fn bands(document: &Value) -> BTreeMap<String, f64> {
    let known = document.as_object().into_iter().flatten();
    known.filter_map(|(name, band)| Some((name.clone(), band.as_f64()?))).collect()
}
