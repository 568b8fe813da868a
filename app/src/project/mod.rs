//! Where the project's own files are: scenes, the finite-element package, stored solutions, meshes; and where the user's are.

mod find;

pub use find::{every, resolve, shipped};

use crate::interrupt::Scratch;
use crate::{Error, Result};
use etcetera::base_strategy::{BaseStrategy, choose_base_strategy};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Environment variable that names the folder of the project's files.
const HOME_VARIABLE: &str = "IMPACTCHECK_HOME";

/// Files a program brings along: a word that changes with them, and paths relative to the project with contents.
pub type Embedded = (&'static str, &'static [(&'static str, &'static [u8])]);

static EMBEDDED: OnceLock<Embedded> = OnceLock::new();

/// What this program brings along for when the project's files are nowhere else. For programs, called once.
pub fn embed(files: Embedded) {
    EMBEDDED.get_or_init(|| files);
}

/// The folder that holds `scenes/`, `fem_reference/` and `meshes/`: the one the environment variable `IMPACTCHECK_HOME` names,
/// else the nearest from the current directory upwards, else beside the program (in the folders above it or in their
/// `share/impactcheck`), else in the user's data folder, where the files the program brings along are unpacked once.
///
/// # Errors
/// [`Error::Usage`] if the variable names another folder, or if there is none at all; [`Error::Io`] if nothing can be
/// unpacked.
pub fn project_root() -> Result<PathBuf> {
    if let Some(named) = std::env::var_os(HOME_VARIABLE).filter(|v| !v.is_empty()).map(PathBuf::from) {
        return if is_project(&named) { Ok(named) } else { Err(no_project(&named)) };
    }
    let current = std::env::current_dir().unwrap_or_default();
    let program = std::env::current_exe().and_then(|path| path.canonicalize()).unwrap_or_default();
    let near_program =
        program.ancestors().skip(1).flat_map(|f| [f.to_path_buf(), f.join("share/impactcheck")]);
    let found =
        current.ancestors().map(Path::to_path_buf).chain(near_program).find(|folder| is_project(folder));
    found.map_or_else(unpacked, Ok)
}

/// Whether the project in `root` is its source tree, to which new solutions of its own scenes belong.
pub fn is_checkout(root: &Path) -> bool {
    root.join("Cargo.toml").is_file()
}

/// The folder for what a user computes; `None` if the system knows no home.
pub fn data_folder() -> Option<PathBuf> {
    choose_base_strategy().ok().map(|folders| folders.data_dir().join("impactcheck"))
}

fn is_project(folder: &Path) -> bool {
    folder.join("scenes").is_dir() && folder.join("fem_reference/__main__.py").is_file()
}

fn no_project(named: &Path) -> Error {
    Error::Usage(format!(
        "{HOME_VARIABLE} is {}, but a folder that holds scenes/ and fem_reference/ is needed: a checkout of the project or a copy of the two",
        named.display()
    ))
}

/// The embedded files, in a folder that appears complete.
fn unpacked() -> Result<PathBuf> {
    let nowhere = |why: &str| {
        Error::Usage(format!(
            "the project's scenes and its package fem_reference are nowhere to be found ({why}); name the folder that holds them in {HOME_VARIABLE}"
        ))
    };
    let (version, files) = EMBEDDED.get().ok_or_else(|| nowhere("this program brings none along"))?;
    let data = data_folder().ok_or_else(|| nowhere("there is no home to unpack them into"))?;
    let folder = data.join(format!("project-{version}"));
    if folder.is_dir() {
        return Ok(folder);
    }
    let failed = |e| {
        Error::io("unpacking the project's files (IMPACTCHECK_HOME names another place) into", &folder, e)
    };
    std::fs::create_dir_all(&data).map_err(failed)?;
    let partial = Scratch::new_in(&data, ".partial-").map_err(failed)?;
    let made = partial.path().join("project");
    for (name, bytes) in *files {
        let path = made.join(name);
        path.parent().map_or(Ok(()), std::fs::create_dir_all).map_err(failed)?;
        std::fs::write(&path, bytes).map_err(failed)?;
    }
    match std::fs::rename(&made, &folder) {
        // another run was faster
        Err(e) if !folder.is_dir() => Err(failed(e)),
        _ => Ok(folder),
    }
}
