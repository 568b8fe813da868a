//! impactcheck: how far can a fast reduced model of an impact be trusted?
//!
//! Data flows one way: [`scene`] -> [`body`] -> [`impact`] -> [`comparison`] -> [`report`].
#![warn(missing_docs)]

pub mod analytical;
pub mod bench;
pub mod body;
pub mod ci;
pub mod cli;
pub mod comparison;
pub mod contact;
pub mod error;
pub mod fluid;
pub mod impact;
pub mod measured;
pub mod optimise;
pub mod project;
pub mod reference;
pub mod report;
pub mod sampling;
pub mod scene;
pub mod stress;
pub mod study;

pub use error::{Error, ExitStatus, Result};
