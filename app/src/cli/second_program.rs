//! CalculiX's solutions, which a comparison checks the references with.

use super::Context;
use super::compare_arguments::Arguments;
use super::reference::require_sound;
use super::stored_references::look_up;
use crate::error::Result;
use crate::kinds;
use crate::reference::Stored;
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// CalculiX's solution of `scene`, whose file is `file`, as fine as the references of a comparison with these `arguments`; `None` if
/// CalculiX does not take the scene or has no such fineness. Unless `--reference-check` requires it, it is shown where it is stored
/// and sound.
///
/// # Errors
/// Of one that is required: as [`look_up`], and if it contradicts itself.
pub(super) fn independent(
    context: &Context,
    file: &Path,
    scene: &Scene,
    arguments: &Arguments,
) -> Result<Option<Stored>> {
    let taken = kinds::of(scene).calculix_takes(scene);
    let Some(resolution) = arguments.resolution().by_calculix().filter(|_| taken) else { return Ok(None) };
    if !arguments.reference_check {
        let found = context.store().for_scene_in(file).find_here_or_shipped(scene, resolution).found();
        return Ok(found.filter(|stored| require_sound(scene, stored).is_ok()));
    }
    let scenes: [(PathBuf, Scene); 1] = [(file.to_path_buf(), scene.clone())];
    let found = look_up(context, resolution, arguments.compute, &scenes)?.pop();
    found.iter().try_for_each(|stored| require_sound(scene, stored))?;
    Ok(found)
}
