//! The report where changes are reviewed: JUnit, annotations on GitHub, Markdown.

pub mod github;
pub(crate) mod junit;
pub(crate) mod markdown;
