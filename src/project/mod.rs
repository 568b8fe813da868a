//! Where the project's own files are: scenes, the finite-element package, stored references.

mod find;

pub use find::{resolve, shipped};

use std::path::{Path, PathBuf};

/// The project's folder: the nearest one, from the current directory upwards, that holds both
/// `scenes/` and `fem_reference/`, else the folder the program was built in.
pub fn project_root() -> PathBuf {
    let current = std::env::current_dir().unwrap_or_default();
    let found = current.ancestors().find(|f| f.join("scenes").is_dir() && f.join("fem_reference").is_dir());
    found.unwrap_or(Path::new(env!("CARGO_MANIFEST_DIR"))).to_path_buf()
}
