//! Studies of seal seats.

pub mod cost;
pub mod direction;
pub mod flight;
pub mod launch;
