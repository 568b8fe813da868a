//! How long a computation takes.

#[cfg(not(target_family = "wasm"))]
use std::time::Instant;

/// Runs from its start. In a web page, which has no clock for compiled code, it stays at 0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stopwatch {
    #[cfg(not(target_family = "wasm"))]
    start: Instant,
}

impl Stopwatch {
    /// Starts now.
    pub(crate) fn start() -> Self {
        Self {
            #[cfg(not(target_family = "wasm"))]
            start: Instant::now(),
        }
    }

    /// Time since the start, s.
    #[cfg(not(target_family = "wasm"))]
    pub(crate) fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// 0 s.
    #[cfg(target_family = "wasm")]
    pub(crate) fn seconds(&self) -> f64 {
        0.0
    }
}
