//! An outer body strikes a plate, the plate passes the blow to an inner body: reduced models A, B and C.

pub mod choice;
pub mod reduced;
mod rough;
mod validity;
pub mod variants;
