//! Waiting for another process, however busy the machine is.

use std::time::{Duration, Instant};

/// Looks again and again until `holds`.
///
/// # Panics
/// After five minutes, with what is `missing`: only a fault takes so long.
#[track_caller]
pub fn wait_until(holds: impl Fn() -> bool, missing: impl Fn() -> String) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < Duration::from_secs(300), "{}", missing());
        std::thread::sleep(Duration::from_millis(5));
    }
}
