//! Results as files that other programs read.

pub(crate) mod csv;
pub(crate) mod figure;
pub(crate) mod history;
pub(crate) mod json;
