//! What a report shows besides the comparison, where there is any of it.

use crate::reference::CurveBands;

/// Nothing of this changes a verdict; all of it may be missing.
#[derive(Debug, Clone, Default)]
pub struct Attachments {
    /// 95 % bands of the reference's curves.
    pub bands: Option<CurveBands>,
}
