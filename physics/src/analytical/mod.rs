//! Closed forms and one-line equations of the field: independent checks of the program's own results.

pub mod circular_plate;
pub mod hertz;
pub mod lamb_wave;
pub mod mindlin_plate;
pub mod zener;
