//! One computation of a solution at a time: who asks for the same one meanwhile waits for it.

use crate::scene::hash::sha256_hex;
use std::fs::{File, TryLockError};
use std::path::Path;
use std::time::Duration;

/// Between two looks at a lock that someone else holds.
const LOOK: Duration = Duration::from_millis(100);

/// The right to compute a solution, until it is dropped or its process ends.
#[derive(Debug)]
pub(super) struct Turn {
    _lock: Option<File>,
    /// Whether someone else had it before.
    pub(super) waited: bool,
}

impl Turn {
    /// Takes the turn for `entry` of a store; `waiting` is called as long as someone else has it. Where nothing can be locked,
    /// everyone computes.
    pub(super) fn take(entry: &Path, waiting: &mut dyn FnMut()) -> Self {
        // among the system's temporary files, which may stay: a lock that is removed is one that two can have
        let entry = std::path::absolute(entry).unwrap_or_else(|_| entry.to_owned());
        let name = format!("impactcheck-{}.lock", &sha256_hex(entry.as_os_str().as_encoded_bytes())[..16]);
        let file = File::options().create(true).append(true).open(std::env::temp_dir().join(name));
        let Ok(lock) = file else { return Self { _lock: None, waited: false } };
        let mut waited = false;
        while let Err(TryLockError::WouldBlock) = lock.try_lock() {
            waited = true;
            waiting();
            std::thread::sleep(LOOK);
        }
        Self { _lock: Some(lock), waited }
    }
}
