//! One computation of a solution at a time: who asks for the same one meanwhile waits for it.

use crate::interrupt::Temporary;
use crate::scene::hash::sha256_hex;
use std::fs::{File, TryLockError};
use std::path::Path;
use std::time::Duration;

/// Between two looks at a lock that someone else holds.
const LOOK: Duration = Duration::from_millis(100);

/// How files of locks are named.
const PREFIX: &str = "impactcheck-";
const SUFFIX: &str = ".lock";

/// The right to compute a solution, until it is dropped or its process ends.
#[derive(Debug)]
pub(super) struct Turn {
    // goes before it is unlocked, see `lock`
    _file: Option<Temporary>,
    _lock: Option<File>,
    /// Whether someone else had it before.
    pub(super) waited: bool,
}

impl Turn {
    /// Takes the turn for `entry` of a store; `waiting` is called as long as someone else has it. Where nothing can be locked,
    /// everyone computes.
    pub(super) fn take(entry: &Path, waiting: &mut dyn FnMut()) -> Self {
        let entry = std::path::absolute(entry).unwrap_or_else(|_| entry.to_owned());
        let name = format!("{PREFIX}{}{SUFFIX}", &sha256_hex(entry.as_os_str().as_encoded_bytes())[..16]);
        let folder = std::env::temp_dir();
        remove_leftovers(&folder);
        let path = folder.join(name);
        let mut waited = false;
        let lock = lock(&path, &mut || {
            waited = true;
            waiting();
        });
        Self { _file: lock.is_some().then(|| Temporary::new(path)), _lock: lock, waited }
    }
}

/// The locked file at `path`, made if need be; `None` where it can't be locked.
///
/// Its owner removes it before it is unlocked: a lock of a file that is no longer at `path` is one that two can have, and is
/// taken again.
fn lock(path: &Path, waiting: &mut dyn FnMut()) -> Option<File> {
    loop {
        let file = File::options().create(true).append(true).open(path).ok()?;
        loop {
            match file.try_lock() {
                Ok(()) if is_at(&file, path) => return Some(file),
                Ok(()) => break,
                Err(TryLockError::WouldBlock) => {
                    waiting();
                    std::thread::sleep(LOOK);
                }
                Err(TryLockError::Error(_)) => return None,
            }
        }
    }
}

/// Removes the files in `folder` that killed runs left: no one holds their locks.
fn remove_leftovers(folder: &Path) {
    let is_lock = |name: &str| name.starts_with(PREFIX) && name.ends_with(SUFFIX);
    for path in std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        if path.file_name().and_then(|name| name.to_str()).is_some_and(is_lock)
            && let Ok(file) = File::options().append(true).open(&path)
            && file.try_lock().is_ok()
            && is_at(&file, &path)
        {
            let _ = std::fs::remove_file(&path);
        }
    }
}

/// Whether `file` is what lies at `path`.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |m: std::fs::Metadata| (m.dev(), m.ino());
    let (own, there) = (file.metadata().map(identity), path.metadata().map(identity));
    own.ok().zip(there.ok()).is_some_and(|(own, there)| own == there)
}

/// Other systems remove no file that is open.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::{Temporary, Turn, lock, remove_leftovers};
    use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};

    #[test]
    fn a_turn_is_had_by_one_at_a_time_and_leaves_no_file() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("lock");
        let inside = AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    for _ in 0..20 {
                        let file = lock(&path, &mut || {}).expect("locked");
                        let turn = Turn {
                            _file: Some(Temporary::new(path.clone())),
                            _lock: Some(file),
                            waited: false,
                        };
                        assert_eq!(inside.fetch_add(1, SeqCst), 0, "two have the turn");
                        inside.fetch_sub(1, SeqCst);
                        drop(turn);
                    }
                });
            }
        });
        assert_eq!(std::fs::read_dir(folder.path()).expect("folder").count(), 0);
    }

    #[test]
    fn what_a_killed_run_left_is_removed_and_what_is_held_stays() {
        let folder = tempfile::tempdir().expect("folder");
        let [left, held, other] =
            ["impactcheck-1.lock", "impactcheck-2.lock", "another.lock"].map(|name| folder.path().join(name));
        for path in [&left, &other] {
            std::fs::write(path, "").expect("written");
        }
        let _held = lock(&held, &mut || {}).expect("locked");
        remove_leftovers(folder.path());
        assert_eq!([&left, &held, &other].map(|path| path.exists()), [false, true, true]);
    }
}
