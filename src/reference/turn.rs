//! One computation of a solution at a time: who asks for the same one meanwhile waits for it.

use super::store::Parent;
use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::PathBuf;
use std::time::Duration;

/// Between two looks at a lock that someone else holds.
const LOOK: Duration = Duration::from_millis(100);

/// The right to compute a solution; the file that stands for it goes when it is dropped, its lock with the process.
#[derive(Debug)]
pub(super) struct Turn {
    _lock: File,
    file: PathBuf,
    /// Whether someone else had it before.
    pub(super) waited: bool,
    // goes last
    _parent: Parent,
}

impl Turn {
    /// Takes the turn whose lock is `file`; `waiting` is called as long as someone else has it.
    ///
    /// # Errors
    /// What the system says if the file can't be made.
    pub(super) fn take(file: PathBuf, waiting: &mut dyn FnMut()) -> std::io::Result<Self> {
        let folder = file.parent().map(PathBuf::from).unwrap_or_default();
        let lock = loop {
            fs::create_dir_all(&folder)?;
            match File::create(&file) {
                // a run that has just ended took its empty folder along
                Err(e) if e.kind() == ErrorKind::NotFound => {}
                made => break made?,
            }
        };
        let mut waited = false;
        // where locks don't work, everyone computes
        while let Err(TryLockError::WouldBlock) = lock.try_lock() {
            waited = true;
            waiting();
            std::thread::sleep(LOOK);
        }
        Ok(Self { _lock: lock, file, waited, _parent: Parent(folder) })
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.file);
    }
}
