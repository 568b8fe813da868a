//! Where a table of a scene file stands.

use std::ops::Range;

/// Where a table stands: its full name and the place a missing key is reported at.
pub(super) struct Place<'a> {
    pub(super) path: &'a str,
    pub(super) span: Range<usize>,
}

impl Place<'_> {
    pub(super) fn key(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    pub(super) fn name(&self) -> String {
        if self.path.is_empty() { "a scene".to_owned() } else { format!("[{}]", self.path) }
    }
}
