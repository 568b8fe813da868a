//! `impactcheck live`: writes a page in which the reduced models answer while a reader changes the scene's numbers.

use super::requested_model::ModelRequest;
use super::{Context, JsonArgument, compare_inputs, kinds, validated_scenes};
use crate::error::{ExitStatus, Result};
use crate::file::write_file;
use crate::reference::{Resolution, Stored};
use crate::report::{LiveScene, has_live, live_page};
use crate::scene::{Scene, Template};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene files, or names of shipped scenes [default: all shipped scenes]
    scenes: Vec<String>,
    /// File of the page (.html)
    #[arg(long, short, value_name = "FILE", default_value = "live.html")]
    out: PathBuf,
    #[command(flatten)]
    json: JsonArgument,
}

/// Writes the page, with the stored references of its scenes.
pub fn run(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let (mut scenes, mut refused) = (Vec::new(), None);
    for (file, scene) in compare_inputs::scenes(&arguments.scenes)? {
        let stored = finest(context, &file, &scene);
        match of_scene(context, &file, &scene, stored.as_ref()) {
            Ok(of_scene) => scenes.push(of_scene),
            // the others still have a page
            Err(error) => {
                context.note(format_args!("not in the page: {error}"));
                refused.get_or_insert(error);
                continue;
            }
        }
        if stored.is_none() {
            context
                .note(format_args!("{}: no stored reference, the page shows the models alone", scene.name));
        }
    }
    if let (true, Some(error)) = (scenes.is_empty(), refused) {
        return Err(error);
    }
    let page = live_page(&scenes, &validated_scenes::known(context, &[]))?;
    write_file(&arguments.out, page.as_bytes())?;
    let megabytes = page.len() as f64 / 1e6;
    let document = json!({"file": arguments.out, "scenes": scenes.len(), "bytes": page.len()});
    arguments.json.print(&document, |_| {
        let count = match scenes.len() {
            1 => "1 scene".to_owned(),
            count => format!("{count} scenes"),
        };
        format!("{}: {count}, {megabytes:.1} MB", arguments.out.display())
    })?;
    Ok(ExitStatus::Pass)
}

/// The same of a scene of a report; `None` where the program has no models for pages, or the scene none that run there.
pub(super) fn of_report(context: &Context, file: &Path, scene: &Scene, stored: &Stored) -> Option<LiveScene> {
    has_live().then(|| of_scene(context, file, scene, Some(stored)).ok()).flatten()
}

/// A scene of the page with its `stored` reference.
fn of_scene(context: &Context, file: &Path, scene: &Scene, stored: Option<&Stored>) -> Result<LiveScene> {
    let (models, request) = (kinds::of(scene), ModelRequest::default());
    let mesh = match models.shares_mesh() {
        true => models.files(context, scene, &request)?.into_iter().next().map(|(_, path)| path),
        false => None,
    };
    LiveScene::new(&Template::read(file)?, stored, mesh.as_deref(), models.tolerance(&request)?)
}

/// The finest stored reference.
fn finest(context: &Context, file: &Path, scene: &Scene) -> Option<Stored> {
    let store = context.store().for_scene_in(file);
    let resolutions = [Resolution::Paper, Resolution::Fine, Resolution::Coarse];
    resolutions.into_iter().find_map(|resolution| store.find_here_or_shipped(scene, resolution).found())
}
