//! What a series of impacts has made so far, for its other threads and impacts.

use crate::error::Result;
use std::sync::{Arc, PoisonError, RwLock};

/// Most entries that are kept: a series that needs many more is better off without.
const MOST: usize = 64;

/// A list of values that take long to make, each made when it is first asked for.
#[derive(Debug)]
pub(crate) struct MemoList<T>(RwLock<Vec<Arc<T>>>);

impl<T> Default for MemoList<T> {
    fn default() -> Self {
        Self(RwLock::default())
    }
}

impl<T> MemoList<T> {
    /// The entry that `fits`, made if there is none. Threads that want it at the same time make it each: so nobody waits for
    /// one that somebody else wants.
    pub(crate) fn find_or(
        &self,
        fits: impl Fn(&T) -> bool,
        make: impl FnOnce() -> Result<T>,
    ) -> Result<Arc<T>> {
        let find = |list: &[Arc<T>]| list.iter().find(|entry| fits(entry)).cloned();
        // the list is whole after every change, whatever became of the thread that made it
        if let Some(known) = find(&self.0.read().unwrap_or_else(PoisonError::into_inner)) {
            return Ok(known);
        }
        let made = Arc::new(make()?);
        let mut memo = self.0.write().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = find(&memo) {
            return Ok(known);
        }
        if memo.len() >= MOST {
            memo.remove(0);
        }
        memo.push(Arc::clone(&made));
        Ok(made)
    }

    /// All that there are.
    pub(crate) fn all(&self) -> Vec<Arc<T>> {
        self.0.read().unwrap_or_else(PoisonError::into_inner).clone()
    }

    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.0.read().unwrap_or_else(PoisonError::into_inner).len()
    }
}
