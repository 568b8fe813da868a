//! The physics of impactcheck: scenes, bodies, contacts, fluid, their motion and its results.
//!
//! Data flows one way: [`scene`] -> [`body`], [`contact`], [`fluid`] -> [`dynamics`] -> [`result`]; [`kinds`] puts them
//! together for every kind of scene. Nothing here knows of reports, the command line or other processes.
#![warn(missing_docs)]

pub mod actuator;
pub mod analytical;
pub mod body;
pub mod contact;
pub mod dynamics;
pub mod error;
pub mod file;
pub mod flight;
pub mod fluid;
pub mod kinds;
pub mod material;
pub mod numerics;
pub mod result;
pub mod scene;

pub use error::{Error, ExitStatus, Result};
