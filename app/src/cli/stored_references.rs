//! The stored references of several scenes, for a comparison.

use super::{Context, compare_inputs, reference};
use crate::error::{Error, Result};

use crate::reference::{Lookup, Resolution, Store, Stored, Wish};
use crate::scene::{self, Scene};
use std::path::{Path, PathBuf};

/// The references of `scenes`, from the store or computed.
///
/// # Errors
/// [`Error::Reference`] that names every one that can't be used.
pub(super) fn look_up(
    context: &Context,
    resolution: Resolution,
    compute: bool,
    scenes: &[(PathBuf, Scene)],
) -> Result<Vec<Stored>> {
    let (mut found, mut problems, mut hints) = (Vec::new(), Vec::new(), Vec::new());
    for (file, scene) in scenes {
        let store = context.store().for_scene_in(file);
        match store.find_here_or_shipped(scene, resolution) {
            Lookup::Found(stored) => found.push(*stored),
            Lookup::Missing | Lookup::Stale { .. } if compute && resolution != Resolution::Imported => {
                let wish = Wish::default();
                found.push(reference::compute(context, scene, resolution, &store, &wish)?);
            }
            other => {
                problems.push(reference::problem(scene, resolution, &other));
                hints.push(advice(context, file, scene, resolution, &other));
                let shipped = Store::shipped().ok().filter(|shipped| *shipped != store);
                for store in [Some(&store), shipped.as_ref()].into_iter().flatten() {
                    let there: Vec<String> =
                        store.resolutions(scene).into_iter().map(Resolution::argument).collect();
                    if !there.is_empty() {
                        hints.push(format!(
                            "or compare with a stored one: add `--resolution {}` (in {})",
                            there.join("` or `--resolution "),
                            store.root().display()
                        ));
                    }
                }
            }
        }
    }
    if problems.is_empty() {
        return Ok(found);
    }
    hints.push("`impactcheck doctor` shows what a computation needs".into());
    Err(Error::Reference(problems.join("\n  ")).hint(hints))
}

/// The finest resolution that is stored of the only one of `scenes` if it has none at the default one; that it is used is printed.
///
/// # Errors
/// Those of reading the scenes.
pub(super) fn only_stored(context: &Context, scenes: &[String]) -> Result<Option<Resolution>> {
    let [(file, scene)] = &compare_inputs::scenes(scenes)?[..] else { return Ok(None) };
    let store = context.store().for_scene_in(file);
    if !matches!(store.find_here_or_shipped(scene, Resolution::Paper), Lookup::Missing) {
        return Ok(None);
    }
    let shipped = Store::shipped().ok().filter(|shipped| *shipped != store);
    let stores = std::iter::once(&store).chain(&shipped);
    let finest = stores.flat_map(|store| store.resolutions(scene)).max();
    if let Some(resolution) = finest {
        let argument = resolution.argument();
        context.note(format_args!(
            "{}: the finest stored reference is `{argument}` (as --resolution {argument})",
            scene.name
        ));
    }
    Ok(finest)
}

/// Where a reference comes from: that it is not from the store the caller named is always said.
pub(super) fn report_reused(context: &Context, stored: &Stored) {
    let scene = &stored.outcome.summary.scene;
    let made = stored.provenance["created"].as_str().map_or(String::new(), |when| format!(", made {when}"));
    let store = context.store();
    if !store.is_named() || stored.folder.starts_with(store.root()) {
        context.detail(format_args!("{scene}: reference from the store{made}"));
    } else {
        let folder = stored.folder.display();
        context.note(format_args!("{scene}: reference shipped with the project, {folder}{made}"));
    }
}

/// The command that makes a reference that can't be used one that can.
fn advice(context: &Context, file: &Path, scene: &Scene, resolution: Resolution, lookup: &Lookup) -> String {
    let is_shipped = file.is_absolute() && scene::resolve(&scene.name).is_ok_and(|shipped| shipped == file);
    let named = if is_shipped { scene.name.clone() } else { file.display().to_string() };
    let store = context.store.as_ref().map_or(String::new(), |root| format!(" --store {}", root.display()));
    let command = |rest: &str| format!("`impactcheck{store} reference {rest}`");
    let own = match resolution {
        Resolution::Paper => named.clone(),
        other => format!("{named} --resolution {}", other.argument()),
    };
    match lookup {
        _ if resolution == Resolution::Imported => {
            format!("import one with {}", command(&format!("import {named} --from FILE")))
        }
        Lookup::Damaged { .. } => format!("compute it again with {}", command(&format!("{own} --fresh"))),
        _ => format!("compute it (seconds to minutes) with {}, or add `--compute`", command(&own)),
    }
}
