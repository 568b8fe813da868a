//! Scenes: what the physics knows of them, and where a command line finds them.

pub use crate::project::{every, resolve, shipped};
pub use impactcheck_physics::scene::*;
