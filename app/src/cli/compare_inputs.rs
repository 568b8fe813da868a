//! What a comparison is asked to use, checked before anything is computed.

use super::Context;
use super::record_map::RecordMap;
use crate::ci::acceptance::Acceptance;
use crate::ci::tolerance_watch;
use crate::comparison::ChangedTolerance;
use crate::error::{Error, Result};
use crate::kinds::{self, Use};
use crate::measured::Record;
use crate::project::project_root;
use crate::report::{Export, FIGURE_WIDTHS, FigureFile, figure_format};
use crate::scene::{self, Scene};
use std::path::{Path, PathBuf};

/// The scenes named, or all shipped ones.
pub(super) fn scenes(names: &[String]) -> Result<Vec<(PathBuf, Scene)>> {
    scenes_or(names, scene::shipped)
}

/// The files of the scenes named, or of all shipped ones.
pub(super) fn files(names: &[String]) -> Result<Vec<PathBuf>> {
    if names.is_empty() { scene::shipped() } else { names.iter().map(|name| scene::resolve(name)).collect() }
}

/// The scenes named, or those of `all`.
pub(super) fn scenes_or(
    names: &[String],
    all: fn() -> Result<Vec<PathBuf>>,
) -> Result<Vec<(PathBuf, Scene)>> {
    let paths = if names.is_empty() { all()? } else { files(names)? };
    let read = |path: PathBuf| Scene::read(&path).map(|scene| (path, scene));
    let scenes = paths.into_iter().map(read).collect::<Result<Vec<_>>>()?;
    named_apart(&scenes)?;
    Ok(scenes)
}

/// Refuses two scenes of one name.
pub(super) fn named_apart(scenes: &[(PathBuf, Scene)]) -> Result<()> {
    for (i, (_, scene)) in scenes.iter().enumerate() {
        if scenes[..i].iter().any(|(_, other)| other.name == scene.name) {
            return Err(Error::Usage(format!(
                "two scenes are called `{}`; a report needs different names",
                scene.name
            )));
        }
    }
    Ok(())
}

/// The file of every scene's figure; none if none is asked for. Refused before anything is computed.
pub(super) fn figures(
    file: Option<&PathBuf>,
    scenes: &[(PathBuf, Scene)],
) -> Result<Vec<(PathBuf, &'static dyn Export<FigureFile>)>> {
    let Some(file) = file else { return Ok(Vec::new()) };
    let format = figure_format(file)?;
    if scenes.len() == 1 {
        return Ok(vec![(file.clone(), format)]);
    }
    let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, ending) = (part(file.file_stem()), part(file.extension()));
    let named = |(_, scene): &(PathBuf, Scene)| {
        (file.with_file_name(format!("{stem}-{}.{ending}", scene.name)), format)
    };
    Ok(scenes.iter().map(named).collect())
}

/// The folder of a scene `file` within the project or the folder of the run; by its own name if it is elsewhere.
pub(super) fn folder(file: &Path) -> String {
    let folder = file.parent().unwrap_or(Path::new(""));
    let roots = [project_root().ok(), std::env::current_dir().ok()];
    let inside = roots.iter().flatten().find_map(|root| folder.strip_prefix(root).ok());
    let elsewhere = || if folder.is_absolute() { folder.file_name().map(Path::new) } else { Some(folder) };
    inside.or_else(elsewhere).unwrap_or(folder).display().to_string()
}

/// Parses the width of a figure, in mm.
pub(super) fn figure_width(text: &str) -> std::result::Result<f64, String> {
    let width = 1e3 * scene::quantity_in(text, "m")?;
    if FIGURE_WIDTHS.contains(&width) {
        Ok(width)
    } else {
        Err(format!(
            "{width} mm is not within {} to {} mm (a number without unit is in m)",
            FIGURE_WIDTHS.start(),
            FIGURE_WIDTHS.end()
        ))
    }
}

/// The measured files; they belong to one scene.
pub(super) fn records(
    context: &Context,
    files: &[PathBuf],
    scenes: &[(PathBuf, Scene)],
    how: &RecordMap,
) -> Result<Vec<Record>> {
    if files.is_empty() {
        return Ok(Vec::new());
    }
    let [(_, scene)] = scenes else {
        return Err(Error::Usage(format!(
            "--measured needs exactly one scene, to which the files belong; there are {}",
            scenes.len()
        )));
    };
    kinds::serving(scene, Use::Records)?;
    how.records(context, files)
}

/// Parses a bandwidth that a filter can be made for.
pub(super) fn bandwidth(text: &str) -> std::result::Result<f64, String> {
    let value = scene::quantity_in(text, "Hz")?;
    if (1e3..=1e8).contains(&value) {
        Ok(value)
    } else {
        Err(format!("{value} Hz is not within 1 kHz to 100 MHz"))
    }
}

/// Tolerances in the scene `file` that are not those accepted last.
pub(super) fn changed_tolerances(file: &Path, record: &[Acceptance]) -> Result<Vec<ChangedTolerance>> {
    if record.is_empty() {
        // a scene without a file has none
        return Ok(Vec::new());
    }
    let text = std::fs::read_to_string(file).map_err(|e| Error::io("reading", file, e))?;
    tolerance_watch::changed(record, file, &text)
}
