//! The kinds of scene, each with its reduced models.

pub mod plate_impact;
pub mod seal_seat;
