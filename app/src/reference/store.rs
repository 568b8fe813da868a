//! The store: one folder per scene and resolution under a root.
//!
//! Entries appear by renaming a complete folder, so a reader never sees half of one. Work in
//! progress lies in `.partial-*` folders that hold a locked file while their maker lives.
//! A solution of another scene of the same name, or with other settings, is not replaced: it moves to a folder beside that
//! is named after its hashes (`paper.0123abcd-4567ef89`), where it is found when its scene is asked for again.

use super::entry::{self, Damage, Origin, Stored};
use super::turn::Turn;
use super::{Resolution, identity};
use crate::interrupt::{Parent, Scratch};
use crate::project;
use crate::scene::Scene;
use crate::{Error, Result};
use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// Environment variable that names the root of the store.
const STORE_VARIABLE: &str = "IMPACTCHECK_STORE";
const PARTIAL_PREFIX: &str = ".partial-";
const LOCK: &str = "lock";
/// A leftover whose lock can't be asked about goes after this time.
const LEFTOVER_AGE: Duration = Duration::from_secs(24 * 3600);
/// A folder this young may not have its lock yet.
const LOCK_GRACE: Duration = Duration::from_secs(10);

/// Where reference solutions are kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Store {
    root: PathBuf,
    /// Not the default one.
    named: bool,
}

/// What the store has for a scene at a resolution.
#[derive(Debug, Clone, PartialEq)]
pub enum Lookup {
    /// A solution of exactly this scene with exactly these settings.
    Found(Box<Stored>),
    /// There is none.
    Missing,
    /// There is one of another scene or with other settings.
    Stale {
        /// What changed, with old and new value.
        reason: String,
    },
    /// There is one that can't be used.
    Damaged {
        /// The file at fault.
        file: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
}

impl Lookup {
    /// The solution, if there is one.
    pub fn found(self) -> Option<Stored> {
        match self {
            Lookup::Found(stored) => Some(*stored),
            _ => None,
        }
    }
}

impl From<Damage> for Lookup {
    fn from(damage: Damage) -> Self {
        Lookup::Damaged { file: damage.file, reason: damage.reason }
    }
}

impl Store {
    /// The store at `root`, else at the environment variable `IMPACTCHECK_STORE`, else in the user's data folder; what is
    /// not in that one is looked for among the project's own solutions too. Nothing is created.
    pub fn open(root: Option<&Path>) -> Store {
        let variable = || std::env::var_os(STORE_VARIABLE).filter(|v| !v.is_empty()).map(PathBuf::from);
        match root.map(Path::to_path_buf).or_else(variable) {
            Some(root) => Store { root, named: true },
            None => {
                let folder =
                    project::data_folder().unwrap_or_else(|| std::env::temp_dir().join("impactcheck"));
                Store { root: folder.join("solutions"), named: false }
            }
        }
    }

    /// Whether somebody named this store.
    pub fn is_named(&self) -> bool {
        self.named
    }

    /// Where a new solution of the scene in `file` belongs: here, but if nobody named a store and the scene is one of a
    /// checkout's own, into the checkout.
    pub fn for_scene_in(&self, file: &Path) -> Store {
        let own = |root: &Path| {
            let file = file.canonicalize().unwrap_or_default();
            project::is_checkout(root)
                && root.join("scenes").canonicalize().is_ok_and(|own| file.starts_with(own))
        };
        match project::project_root() {
            Ok(root) if !self.named && own(&root) => Store::of_project(&root),
            _ => self.clone(),
        }
    }

    /// The folder all entries lie in.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The folder of the entry of `scene` at `resolution`, whether it exists or not.
    pub fn folder(&self, scene: &Scene, resolution: Resolution) -> PathBuf {
        self.root.join(&scene.name).join(resolution.to_string())
    }

    /// Where the states of an unfinished run of this entry lie, so that it can go on; absolute.
    ///
    /// # Errors
    /// [`Error::Io`] if the store can't be found.
    pub(super) fn checkpoint_folder(&self, scene: &Scene, resolution: Resolution) -> Result<PathBuf> {
        let parent = self.root.join(&scene.name);
        let parent = parent.canonicalize().map_err(|e| Error::io("finding", &parent, e))?;
        Ok(parent.join(format!(".checkpoint-{}", resolution)))
    }

    /// The project's own solutions.
    ///
    /// # Errors
    /// As [`project::project_root`].
    pub fn shipped() -> Result<Store> {
        Ok(Store::of_project(&project::project_root()?))
    }

    fn of_project(root: &Path) -> Store {
        Store { root: root.join("fem_reference/solutions"), named: true }
    }

    /// Looks for the solution of `scene` at `resolution`. Every file is verified by its checksum.
    pub fn find(&self, scene: &Scene, resolution: Resolution) -> Lookup {
        if self.named {
            self.find_here(scene, resolution)
        } else {
            self.find_here_or_shipped(scene, resolution)
        }
    }

    pub(super) fn find_here(&self, scene: &Scene, resolution: Resolution) -> Lookup {
        let lookup = settled(&self.folder(scene, resolution), scene, resolution);
        if matches!(lookup, Lookup::Found(_)) {
            return lookup;
        }
        match settled(&self.earlier_folder(scene, resolution), scene, resolution) {
            Lookup::Found(stored) => Lookup::Found(stored),
            _ => lookup,
        }
    }

    /// As [`Store::find`]; what is missing or stale here is looked for in the project's own store too, which is only read.
    pub fn find_here_or_shipped(&self, scene: &Scene, resolution: Resolution) -> Lookup {
        let lookup = self.find_here(scene, resolution);
        if !matches!(lookup, Lookup::Missing | Lookup::Stale { .. }) {
            return lookup;
        }
        match Store::shipped().map(|shipped| shipped.find_here(scene, resolution)) {
            Ok(Lookup::Found(stored)) => Lookup::Found(stored),
            // why the only one there is can't be used
            Ok(other) if !self.named && lookup == Lookup::Missing => other,
            _ => lookup,
        }
    }

    /// The folder the solution of `scene` at `resolution` moves to when that of another scene takes its place.
    fn earlier_folder(&self, scene: &Scene, resolution: Resolution) -> PathBuf {
        let name =
            earlier_name(resolution, scene.hash().as_ref(), &identity::settings_hash(scene, resolution));
        self.folder(scene, resolution).with_file_name(name)
    }

    /// The turn to compute the entry of `scene` at `resolution`; `waiting` is called while another run computes it.
    pub(super) fn turn(&self, scene: &Scene, resolution: Resolution, waiting: &mut dyn FnMut()) -> Turn {
        Turn::take(&self.earlier_folder(scene, resolution), waiting)
    }

    /// Resolutions at which there is a solution of exactly this scene, coarse to fine.
    pub fn resolutions(&self, scene: &Scene) -> Vec<Resolution> {
        let folders = fs::read_dir(self.root.join(&scene.name)).into_iter().flatten().flatten();
        let mut found: Vec<Resolution> = folders
            .filter_map(|folder| {
                let name = folder.file_name().to_string_lossy().into_owned();
                Resolution::of_folder(name.split('.').next().unwrap_or(&name))
            })
            .filter(|resolution| matches!(self.find(scene, *resolution), Lookup::Found(_)))
            .collect();
        found.sort();
        found.dedup();
        found
    }

    /// A new work folder on the file system of the entry, after removing what dead runs left.
    pub(super) fn work_folder(&self, scene: &Scene) -> Result<WorkFolder> {
        let parent = self.root.join(&scene.name);
        // Others' solvers get an absolute path: they run in another folder.
        let parent = Parent::new(&parent).map_err(|e| Error::io("creating", &parent, e))?;
        remove_leftovers(parent.path());
        let failed = |e| Error::io("creating a work folder in", parent.path(), e);
        let folder = Scratch::new_in(parent.path(), PARTIAL_PREFIX).map_err(failed)?;
        let lock = File::create(folder.path().join(LOCK)).map_err(failed)?;
        // Where locks don't work, leftovers go by their age.
        let _ = lock.lock();
        Ok(WorkFolder { folder, _lock: lock, _parent: parent })
    }

    /// Puts the complete folder `made` in the place of the entry of `scene` at `resolution`.
    /// An older entry of the same goes only now, and two that do this at once leave one complete entry; one of another
    /// scene or with other settings is kept beside it.
    pub(super) fn install(
        &self,
        work: &WorkFolder,
        made: &Path,
        scene: &Scene,
        resolution: Resolution,
    ) -> Result<Installed> {
        let folder = self.folder(scene, resolution);
        let failed = |e| Error::io("putting the solution into", &folder, e);
        let mut earlier = None;
        for attempt in 0..100 {
            let aside = work.path().join(format!("replaced-{attempt}"));
            match fs::rename(&folder, &aside) {
                Err(e) if e.kind() != ErrorKind::NotFound => return Err(failed(e)),
                Err(_) => {}
                Ok(()) => {
                    let earlier_path = self.keep(work, &aside, scene, resolution, attempt).map_err(|e| {
                        let _ = fs::rename(&aside, &folder);
                        failed(e)
                    })?;
                    earlier = earlier_path.or(earlier);
                }
            }
            // What an earlier change of the scene has left is older. Moved before the new entry is there: another run
            // may move that one to the same place at once.
            let (left, superseded) =
                (self.earlier_folder(scene, resolution), work.path().join(format!("superseded-{attempt}")));
            let _ = fs::rename(&left, &superseded);
            match fs::rename(made, &folder) {
                Ok(()) => return Ok(Installed { folder, earlier }),
                // Another run was faster: its entry goes aside as well.
                Err(e) if matches!(e.kind(), ErrorKind::DirectoryNotEmpty | ErrorKind::AlreadyExists) => {}
                Err(e) => {
                    // What was there is better than nothing.
                    let _ = fs::rename(&aside, &folder);
                    let _ = fs::rename(&superseded, &left);
                    return Err(failed(e));
                }
            }
        }
        Err(Error::Internal(format!("{} is replaced again and again by others", folder.display())))
    }

    /// Moves the entry in `aside` to where it will be found, unless it is one of `scene` at `resolution` itself or says
    /// not of what it is. Where it went.
    fn keep(
        &self,
        work: &WorkFolder,
        aside: &Path,
        scene: &Scene,
        resolution: Resolution,
        attempt: usize,
    ) -> std::io::Result<Option<PathBuf>> {
        let Some((scene_hash, settings_hash)) = entry::hashes(aside) else { return Ok(None) };
        let name = earlier_name(resolution, &scene_hash, &settings_hash);
        let earlier_path = self.folder(scene, resolution).with_file_name(name);
        if earlier_path == self.earlier_folder(scene, resolution) {
            return Ok(None);
        }
        let older = work.path().join(format!("older-{attempt}"));
        match fs::rename(&earlier_path, older) {
            Err(e) if e.kind() != ErrorKind::NotFound => return Err(e),
            _ => {}
        }
        fs::rename(aside, &earlier_path)?;
        Ok(Some(earlier_path))
    }
}

/// Where a new entry lies, and where the one went that lay there before.
pub(super) struct Installed {
    pub(super) folder: PathBuf,
    pub(super) earlier: Option<PathBuf>,
}

/// Name of the folder of a solution that had to make room: the resolution and the beginnings of its hashes.
fn earlier_name(resolution: Resolution, scene_hash: &str, settings_hash: &str) -> String {
    let short = |hash: &str| hash.chars().take(8).collect::<String>();
    format!("{resolution}.{}-{}", short(scene_hash), short(settings_hash))
}

/// As [`examine`], of one and the same version of the entry.
fn settled(folder: &Path, scene: &Scene, resolution: Resolution) -> Lookup {
    loop {
        let before = entry::fingerprint(folder);
        let lookup = examine(folder, scene, resolution);
        // An entry that is replaced while it is read looks damaged or gone, but is neither.
        let replaced = before.is_some() && entry::fingerprint(folder) != before;
        if !replaced || matches!(lookup, Lookup::Found(_)) {
            return lookup;
        }
    }
}

fn examine(folder: &Path, scene: &Scene, resolution: Resolution) -> Lookup {
    match fs::metadata(folder) {
        Err(e) if e.kind() == ErrorKind::NotFound => return Lookup::Missing,
        Err(e) => return Damage { file: folder.to_path_buf(), reason: format!("can't be read: {e}") }.into(),
        Ok(metadata) if !metadata.is_dir() => {
            return Damage { file: folder.to_path_buf(), reason: "is not a folder".to_owned() }.into();
        }
        Ok(_) => {}
    }
    let stored = match entry::load(scene, folder, Origin::of(resolution)) {
        Ok(stored) => stored,
        Err(damage) => return damage.into(),
    };
    match identity::staleness(&stored.provenance, scene, resolution) {
        Ok(None) => Lookup::Found(Box::new(stored)),
        Ok(Some(reason)) => Lookup::Stale { reason },
        Err(error) => Damage { file: folder.to_path_buf(), reason: error.to_string() }.into(),
    }
}

/// A `.partial-*` folder that goes when it is dropped or the program is interrupted, or, if its process is killed, at the
/// next run.
#[derive(Debug)]
pub(super) struct WorkFolder {
    folder: Scratch,
    _lock: File,
    // goes last
    _parent: Parent,
}

impl WorkFolder {
    pub(super) fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// Removes work folders whose maker is gone. What can't be removed stays: it harms nothing.
fn remove_leftovers(parent: &Path) {
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().starts_with(PARTIAL_PREFIX) && is_abandoned(&entry.path()) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

fn is_abandoned(folder: &Path) -> bool {
    let modified = fs::metadata(folder).and_then(|m| m.modified());
    let age = modified.ok().and_then(|m| SystemTime::now().duration_since(m).ok()).unwrap_or_default();
    match File::open(folder.join(LOCK)).map(|lock| lock.try_lock()) {
        Ok(Ok(())) => age > LOCK_GRACE,
        Ok(Err(TryLockError::WouldBlock)) => false,
        Ok(Err(TryLockError::Error(_))) | Err(_) => age > LEFTOVER_AGE,
    }
}
