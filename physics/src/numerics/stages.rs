//! The nodes of a step: how many there are, and powers of time up to as many.

/// Gauss (or Radau) points of a step, its nodes.
pub const STAGES: usize = 4;

/// Values at the nodes.
pub type Stages = [f64; STAGES];

/// t^p / p! for p < STAGES.
#[inline(always)]
pub(crate) fn powers(t: f64) -> [f64; STAGES] {
    let mut powers = [1.0; STAGES];
    for p in 1..STAGES {
        powers[p] = powers[p - 1] * t / p as f64;
    }
    powers
}
