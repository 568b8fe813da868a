//! An outer body strikes a plate, the plate passes the blow to an inner body: reduced models A, B and C.

pub mod choice;
pub mod errors;
pub mod reduced;
mod rough;
mod trials;
mod truncation;
mod validity;
pub mod variants;
