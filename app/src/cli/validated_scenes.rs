//! What is known of the models' errors when a report is written.

use super::Context;
use crate::coverage::{self, Coverage};
use crate::error::Result;
use crate::reference::Stored;
use crate::scene::{self, Scene};
use crate::validated::{self, Validation};

/// What the project and the user's store know, and what was `found` now, which is kept in that store if its reference lies
/// there. A file that can't be used is told of: the comparison stands without it.
pub(super) fn known(context: &Context, found: &[(&Stored, Vec<Validation>)]) -> Vec<Validation> {
    let store = context.store();
    let or_warning = |result: Result<Vec<Validation>>| {
        result.unwrap_or_else(|error| {
            context.note(format_args!("the map of compared scenes is not complete: {error}"));
            Vec::new()
        })
    };
    let own: Vec<Validation> = found
        .iter()
        .filter(|(stored, _)| stored.folder.starts_with(store.root()))
        .flat_map(|(_, validations)| validations.clone())
        .collect();
    let mut known = or_warning(validated::shipped());
    validated::merge(
        &mut known,
        &or_warning(validated::update(&store, &own).and_then(|()| validated::of_store(&store))),
    );
    for (_, validations) in found {
        validated::merge(&mut known, validations);
    }
    known
}

/// Which features of the project's scenes are compared with what, as far as is `known`; without a project, or where a scene of
/// it can't be read, that is told and the report stands without it.
pub(super) fn coverage(context: &Context, known: &[Validation]) -> Option<Coverage> {
    let found = scene::every().and_then(|files| {
        let scenes = files.iter().map(Scene::read).collect::<Result<Vec<Scene>>>()?;
        coverage::recorded(&scenes, known)
    });
    found.inspect_err(|error| context.note(format_args!("the report has no coverage: {error}"))).ok()
}
