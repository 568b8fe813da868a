//! impactcheck: how far can a fast reduced model of an impact be trusted?
//!
//! Data flows one way: [`scene`] -> `body` -> [`impact`] -> `comparison` -> `report`.
#![warn(missing_docs)]

pub mod body;
pub mod comparison;
pub mod error;
pub mod impact;
pub mod report;
pub mod scene;

pub use error::{Error, ExitStatus, Result};
