//! The stored references of several scenes, for a comparison.

use super::{Context, reference};
use crate::error::{Error, Result};
use crate::reference::{Lookup, Resolution, Store, Stored, Wish};
use crate::scene::Scene;
use std::path::PathBuf;

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
    let (mut found, mut problems) = (Vec::new(), Vec::new());
    for (file, scene) in scenes {
        let store = context.store().for_scene_in(file);
        match store.find_here_or_shipped(scene, resolution) {
            Lookup::Found(stored) => found.push(*stored),
            Lookup::Missing | Lookup::Stale { .. } if compute && resolution != Resolution::Imported => {
                let wish = Wish::default();
                found.push(reference::compute(context, scene, resolution, &store, &wish)?);
            }
            other => {
                let mut problem = reference::problem(scene, resolution, &other);
                let shipped = Store::shipped().ok().filter(|shipped| *shipped != store);
                for store in [Some(&store), shipped.as_ref()].into_iter().flatten() {
                    let there: Vec<String> =
                        store.resolutions(scene).into_iter().map(Resolution::argument).collect();
                    if !there.is_empty() {
                        problem += &format!(
                            "; there is one for `--resolution {}` in {}",
                            there.join("`, `--resolution "),
                            store.root().display()
                        );
                    }
                }
                problems.push(problem);
            }
        }
    }
    all_found(problems)?;
    Ok(found)
}

/// Where a reference comes from: that it is not from the store the caller named is always said.
pub(super) fn tell_reused(context: &Context, stored: &Stored) {
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

/// One error that names every reference that can't be used, if there is any.
fn all_found(mut problems: Vec<String>) -> Result<()> {
    if problems.is_empty() {
        return Ok(());
    }
    problems.push(
        "compute references with `impactcheck reference SCENE` or `--compute` (`impactcheck doctor` tells what that needs)"
            .into(),
    );
    Err(Error::Reference(problems.join("\n  ")))
}
