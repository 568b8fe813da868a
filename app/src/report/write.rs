//! The report's files, complete or not at all.

use crate::error::{Error, Result};
use crate::interrupt::Scratch;
use crate::measured::Measured;
use crate::report::ci::junit::JUnit;
use crate::report::ci::markdown::Markdown;
use crate::report::existing::{self, ExistingScene, Folder};
use crate::report::export::{Csv, Export, Json};
use crate::report::kinds::Drawing;
use crate::report::page::coverage;
use crate::report::page::index::Index;
use crate::report::page::live::{self, LiveScene};
use crate::report::page::measured::measured_page;
use crate::report::page::scene::Page;
use crate::report::page::validated_map::{self, ValidatedMap};
use crate::report::run_times::same_but_for_run_times;
use crate::report::{Report, SceneReport, kinds};
use crate::result::Outcome;
use crate::scene::Scene;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// What the page of a measurement without a reference adds to the name of the scene.
const MEASURED: &str = "-measured";

/// A format of what stands in a folder.
type OfFolder = dyn for<'f> Export<Folder<'f>>;

/// Files of all scenes, and their names without ending.
const OF_ALL: [(&str, &OfFolder); 4] =
    [("index", &Index), ("comparison", &Json), ("comparison", &Markdown), ("junit", &JUnit)];
/// Files of each scene, of its name.
const OF_SCENE: [&dyn for<'s> Export<SceneReport<'s>>; 2] = [&Csv, &Page];

/// Writes `index.html`, `coverage.html`, `live.html` (if the program has the models for pages), `comparison.json`, `comparison.md`, `junit.xml`, the map of validated scenes (SVG) and, per scene, its
/// page, figure (SVG, PNG) and curves (CSV) into `dir`, which is made if it does not exist.
///
/// Index, JSON and Markdown are of all scenes whose results stand in the folder: a scene that an earlier run has compared
/// and this one has not is kept as long as its page is there, and marked with its date. `junit.xml` is of this run alone.
///
/// Everything is made in a temporary folder inside `dir` first and then renamed into place; on an error
/// before that, no file of the report has changed. If all files of an earlier report say the same but for run times, they
/// stay as they are, run times included, and only what is missing is written: equal results leave a working tree clean.
/// Returns the paths of the report's files, sorted.
///
/// # Errors
/// [`Error::Io`] naming the folder or file; [`Error::Usage`] for scenes whose names can't be file
/// names or are the same.
pub fn write(report: &Report, dir: &Path) -> Result<Vec<PathBuf>> {
    let existing = existing::in_folder(report, dir);
    let mut files = files(report, &existing)?;
    files.extend(live_page_of(report, &existing, dir)?);
    write_files(files, dir)
}

/// Writes what records of `scene` show of its models, without a reference, into `dir`: `NAME-measured.html` and its figures, which no
/// list of scenes names. Returns the page's path.
///
/// # Errors
/// As [`write()`].
pub fn write_measured(scene: &Scene, models: &[Outcome], measured: &Measured, dir: &Path) -> Result<PathBuf> {
    let name = &scene.name;
    require_file_name(name)?;
    let page = format!("{name}{MEASURED}.html");
    let mut files = vec![(page.clone(), measured_page(scene, models, measured).into_bytes())];
    for drawing in Drawing::of_records(name, measured) {
        files.extend(drawing.files(name)?);
    }
    write_files(files, dir)?;
    Ok(dir.join(page))
}

/// The live page of the scenes of `report`, and of those that its page in `dir` had and that are kept.
fn live_page_of(
    report: &Report,
    existing: &[ExistingScene],
    dir: &Path,
) -> Result<Option<(String, Vec<u8>)>> {
    let mut scenes: Vec<LiveScene> =
        report.scenes.iter().filter_map(|scene| scene.attachments.live.clone()).collect();
    if scenes.is_empty() {
        return Ok(None);
    }
    let is_kept = |scene: &LiveScene| {
        existing.iter().any(|other| other.is_earlier() && other.overview.scene == scene.name())
    };
    scenes.extend(LiveScene::all_in(dir).into_iter().filter(is_kept));
    Ok(Some((live::FILE.to_owned(), live::live_page(&scenes, report.validated())?.into_bytes())))
}

fn write_files(files: Vec<(String, Vec<u8>)>, dir: &Path) -> Result<Vec<PathBuf>> {
    for (name, _) in &files {
        let target = dir.join(name);
        if target.is_dir() {
            return Err(Error::io("writing", target, io::Error::from(io::ErrorKind::IsADirectory)));
        }
    }
    fs::create_dir_all(dir).map_err(|e| Error::io("creating", dir, e))?;
    let there: BTreeMap<String, Vec<u8>> =
        files.iter().filter_map(|(name, _)| Some((name.clone(), fs::read(dir.join(name)).ok()?))).collect();
    let differs = |(name, bytes): &(String, Vec<u8>)| {
        there.get(name).is_some_and(|old| !same_but_for_run_times(old, bytes))
    };
    let keep_old = !files.iter().any(differs);
    let mut written: Vec<PathBuf> = files.iter().map(|(name, _)| dir.join(name)).collect();
    written.sort();
    let files = files.into_iter().filter(|(name, _)| !(keep_old && there.contains_key(name)));
    let files: Vec<_> = files.collect();
    let partial = Scratch::new_in(dir, ".partial-").map_err(|e| Error::io("writing into", dir, e))?;
    for (name, bytes) in &files {
        fs::write(partial.path().join(name), bytes).map_err(|e| Error::io("writing", dir.join(name), e))?;
    }
    for (name, _) in files {
        let target = dir.join(&name);
        fs::rename(partial.path().join(&name), &target).map_err(|e| Error::io("writing", &target, e))?;
    }
    Ok(written)
}

/// Checks, leaving nothing behind, that [`write()`] can write into `dir` or create it.
///
/// # Errors
/// [`Error::Io`] naming the folder.
pub fn check_writable(dir: &Path) -> Result<()> {
    let fail = |e| Error::io("writing (choose another folder?) into", dir, e);
    // The nearest folder that exists takes the test file; a file in the way is no folder.
    let start = if dir.as_os_str().is_empty() { Path::new(".") } else { dir };
    let mut existing = start;
    loop {
        match fs::metadata(existing) {
            Ok(data) if data.is_dir() => break,
            Ok(_) => return Err(fail(io::Error::from(io::ErrorKind::NotADirectory))),
            Err(e) if e.kind() == io::ErrorKind::NotFound => {
                existing = match existing.parent() {
                    Some(parent) if parent.as_os_str().is_empty() => Path::new("."),
                    Some(parent) => parent,
                    None => return Err(fail(e)),
                };
            }
            Err(e) => return Err(fail(e)),
        }
    }
    tempfile::Builder::new().prefix(".partial-").tempfile_in(existing).map(drop).map_err(fail)
}

/// Name and content of every file.
fn files(report: &Report, existing: &[ExistingScene]) -> Result<Vec<(String, Vec<u8>)>> {
    let mut names = BTreeSet::new();
    let folder = Folder { report, scenes: existing };
    let file = |(stem, format): (&str, &OfFolder)| {
        Ok((format!("{stem}.{}", format.ending()), format.bytes(&folder)?))
    };
    let mut files: Vec<(String, Vec<u8>)> = OF_ALL.into_iter().map(file).collect::<Result<_>>()?;
    if let Some(map) = ValidatedMap::of(report.validated(), None) {
        files.push((validated_map::FILE.to_owned(), map.svg().into_bytes()));
    }
    if let Some(coverage) = report.coverage() {
        files.push((coverage::FILE.to_owned(), coverage::of(coverage, existing).into_bytes()));
    }
    for scene in &report.scenes {
        let name = &scene.comparison.scene;
        require_file_name(name)?;
        if !names.insert(name) || ["index", "live", coverage::NAME].contains(&&**name) {
            return Err(Error::Usage(format!("scene name `{name}` occurs twice in the report")));
        }
        for drawing in kinds::of(scene.scene).drawings(scene) {
            files.extend(drawing.files(name)?);
        }
        for format in OF_SCENE {
            files.push((format!("{name}.{}", format.ending()), format.bytes(scene)?));
        }
    }
    Ok(files)
}

fn require_file_name(name: &str) -> Result<()> {
    let refused = || Error::Usage(format!("scene name `{name}` can't be used as a file name"));
    if is_file_name(name) { Ok(()) } else { Err(refused()) }
}

/// Whether `name` is one plain component of a path.
fn is_file_name(name: &str) -> bool {
    let mut components = Path::new(name).components();
    matches!(components.next(), Some(Component::Normal(c)) if c == name) && components.next().is_none()
}
