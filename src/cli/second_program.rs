//! CalculiX's solutions for a comparison, beside the references.

use super::Context;
use super::reference::require_sound;
use super::stored_references::look_up;
use crate::error::Result;
use crate::kinds;
use crate::reference::{Resolution, Stored};
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// How CalculiX's solutions are asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CalculixRequest {
    /// They are shown where they are stored and sound.
    Shown,
    /// They have to be there.
    Required {
        /// Those that are missing are computed.
        compute: bool,
    },
}

impl CalculixRequest {
    /// Of `--reference-check` and `--compute`.
    pub(super) fn of(required: bool, compute: bool) -> Self {
        if required { CalculixRequest::Required { compute } } else { CalculixRequest::Shown }
    }
}

/// CalculiX's solution of `scene`, whose file is `file`, as fine as a reference at `resolution`; `None` if CalculiX does not take
/// the scene or has no such fineness.
///
/// # Errors
/// Of one that has to be there: as [`look_up`], and if it contradicts itself.
pub(super) fn beside(
    context: &Context,
    file: &Path,
    scene: &Scene,
    resolution: Resolution,
    asked: CalculixRequest,
) -> Result<Option<Stored>> {
    let Some(resolution) = resolution.by_calculix().filter(|_| kinds::of(scene).calculix_takes(scene)) else {
        return Ok(None);
    };
    let CalculixRequest::Required { compute } = asked else {
        let found = context.store().for_scene_in(file).find_here_or_shipped(scene, resolution).found();
        return Ok(found.filter(|stored| require_sound(scene, stored).is_ok()));
    };
    let scenes: [(PathBuf, Scene); 1] = [(file.to_path_buf(), scene.clone())];
    let found = look_up(context, resolution, compute, &scenes)?.pop();
    found.iter().try_for_each(|stored| require_sound(scene, stored))?;
    Ok(found)
}
