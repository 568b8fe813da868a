//! Evidence that the program is right and fast: commands of their own, imported by nothing but the command line.

pub mod bench;
pub mod stress;
pub mod study;
