//! Studies of plate impacts.

pub mod actuators;
pub mod damping;
pub mod fig14;
pub mod fig15;
pub mod fig16;
pub mod fig17;
pub mod fluid;
pub mod half_period;
pub mod insensitivity;
pub mod parameter;
pub mod rocker;
pub mod shakedown;
pub mod table2;
pub mod test_bed;
