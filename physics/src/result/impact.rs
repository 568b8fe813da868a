//! One impact of a series.

use super::{Quantity, Table};
use serde::Serialize;
use serde_json::Value;

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
}

impl Impact {
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
            })
        };
        document.as_array().into_iter().flatten().map(read).collect()
    }
}
