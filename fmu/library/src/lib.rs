//! The C interfaces of FMI 2.0 and 3.0, as a dynamic library.

pub use impactcheck_fmu::{fmi2, fmi3};
