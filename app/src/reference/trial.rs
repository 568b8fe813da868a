//! A small reference, solved in a folder of its own to see whether references can be computed.

use super::{Resolution, Store, Wish, solve_with};
use crate::interrupt::Scratch;
use crate::scene::Scene;
use crate::{Error, Result};
use std::path::Path;
use std::time::{Duration, Instant};

/// Two seconds once its kernels are compiled: few elements, and an end during the first contact.
const SCENE: &str = include_str!("trial.toml");

/// Solves it with the interpreter `python`: meshes, assembly, time loop and files, as any reference; the time it took.
///
/// # Errors
/// As [`super::solve`].
pub(super) fn solve_trial(python: &Path) -> Result<Duration> {
    let temporary = std::env::temp_dir();
    let folder =
        Scratch::new_in(&temporary, "impactcheck-").map_err(|e| Error::io("writing into", &temporary, e))?;
    let scene = Scene::parse("trial", SCENE)?;
    let start = Instant::now();
    let store = Store::open(Some(folder.path()));
    solve_with(python, &scene, Resolution::Coarse, &store, &Wish::default(), &mut |_| ())?;
    Ok(start.elapsed())
}
