//! Optimisation: the numbers of a scene that transmit most.

pub mod search;
