//! A tolerance that is not the one that was accepted with a reason.

use serde::Serialize;

/// One tolerance of a scene file that was changed since it was accepted, without a reason.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ChangedTolerance {
    /// Name of the reduced model.
    pub model: String,
    /// Name of the quantity.
    pub quantity: String,
    /// TOML that was accepted.
    pub accepted: String,
    /// TOML that stands in the scene file; `None` if the tolerance was removed.
    pub now: Option<String>,
}

impl ChangedTolerance {
    /// In one sentence.
    pub fn sentence(&self) -> String {
        let ChangedTolerance { model, quantity, accepted, now } = self;
        let now = now.as_deref().map_or("is not there any more".to_owned(), |now| format!("is now {now}"));
        format!(
            "tolerances.{model}.{quantity} was accepted as {accepted} and {now}: changed without a reason"
        )
    }
}
