//! Results of other programs as stored references: read once from a file, checked as every reference is, kept with where
//! they come from.

use super::entry::{self, Origin, Stored};
use super::record_source;
use super::store::Installed;
use super::{Resolution, Store, identity};
use crate::columns::{Columns, Map, RecordSource};
use crate::external;
use crate::kinds;
use crate::result::{History, Outcome, Summary, Table};
use crate::scene::Scene;
use crate::scene::hash::sha256_hex;
use crate::{Error, Result};
use serde_json::json;
use std::fmt::Write;
use std::path::Path;

/// Fewest samples of a reference.
const FEWEST: usize = 16;
/// Name of a program that nobody states.
const UNKNOWN: &str = "another program";

/// A result of another program that was read and is not stored yet.
#[derive(Debug)]
pub struct Imported {
    /// The result.
    pub outcome: Outcome,
    provenance: String,
}

/// Reads the result in `file` as a reference of `scene`; `map` says how it is to be read.
///
/// # Errors
/// [`Error::Io`] if a file can't be read, [`Error::Reference`] if it can't be used: the file, line or column at fault.
pub fn read_import(scene: &Scene, file: &Path, map: Option<&Path>) -> Result<Imported> {
    let read = |path: &Path| std::fs::read(path).map_err(|e| Error::io("reading", path, e));
    let bytes = read(file)?;
    let map_text = map.map(read).transpose()?.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    let unusable = |path: &Path, reason: String| Error::Reference(format!("{}: {reason}", path.display()));
    let of_map = |reason| unusable(map.unwrap_or(file), reason);
    let mapping = Map::parse(map_text.as_deref().unwrap_or_default()).map_err(of_map)?;
    let stated = mapping.stated(kinds::of(scene).quantities()).map_err(of_map)?;
    let source = record_source(file, &bytes, &mapping).map_err(|error| match error {
        Error::Scene(reason) => Error::Reference(reason.to_string()),
        other => other,
    })?;
    let history = history(scene, &source, &mapping).map_err(|reason| unusable(file, reason))?;
    let outcome = outcome(scene, &mapping, stated, history);
    let provenance = json!({
        "scene": identity::solver_document(scene, Resolution::Imported)?,
        "scene_hash": scene.hash(),
        "settings_hash": identity::settings_hash(scene, Resolution::Imported),
        "settings": { "resolution": Resolution::Imported },
        "created": chrono::Utc::now().to_rfc3339(),
        "program": outcome.summary.model,
        "version": mapping.provenance.version,
        "who": mapping.provenance.who,
        "mesh": mapping.provenance.mesh,
        "uncertainty": if outcome.summary.uncertainty.is_empty() { "none stated" } else { "as stated" },
        "file": file.file_name().map(|name| name.to_string_lossy()),
        "file_sha256": sha256_hex(&bytes),
        "map": map_text,
    });
    Ok(Imported { outcome, provenance: format!("{provenance:#}\n") })
}

impl Imported {
    /// Puts it into `store` as the imported reference of `scene`.
    ///
    /// # Errors
    /// [`Error::Io`] if it can't be written.
    pub fn install(&self, scene: &Scene, store: &Store) -> Result<Stored> {
        install(scene, store, &self.outcome, &self.provenance)
    }
}

/// The curves of a file, from the first touch on.
fn history(scene: &Scene, source: &RecordSource, mapping: &Map) -> std::result::Result<History, String> {
    let kind = kinds::of(scene);
    let found = source.read(mapping, kind.curves(), FEWEST)?;
    external::assembled(kind, from_first_contact(found.columns)?)
}

/// The columns from t = 0 on, where a sample is put if there is none.
fn from_first_contact(columns: Columns) -> std::result::Result<Columns, String> {
    let Columns { time, values, gaps, integrals } = columns;
    let first = time.partition_point(|t| *t < 0.0);
    if first == time.len() || (first == 0 && time[0] > 0.0) {
        return Err(format!(
            "its times are from {} s to {} s; t = 0 must be the first contact (columns.time.offset shifts them)",
            time[0],
            time[time.len() - 1]
        ));
    }
    if time[first] == 0.0 {
        let values = values.into_iter().map(|(name, values)| (name, values[first..].to_vec())).collect();
        return Ok(Columns { time: time[first..].to_vec(), values, gaps, integrals });
    }
    let share = -time[first - 1] / (time[first] - time[first - 1]);
    let from_zero =
        |at_zero: f64, rest: &[f64]| std::iter::once(at_zero).chain(rest.iter().copied()).collect();
    let cut = |(name, values): (&'static str, Vec<f64>)| {
        let at_zero = values[first - 1] + share * (values[first] - values[first - 1]);
        (name, from_zero(at_zero, &values[first..]))
    };
    Ok(Columns {
        time: from_zero(0.0, &time[first..]),
        values: values.into_iter().map(cut).collect(),
        gaps,
        integrals,
    })
}

type Numbers = std::collections::BTreeMap<String, f64>;

fn outcome(
    scene: &Scene,
    mapping: &Map,
    [quantities, uncertainty]: [Numbers; 2],
    history: History,
) -> Outcome {
    let mut table = Table::new(kinds::of(scene).quantities());
    for (name, value) in quantities {
        if let Some(slot) = table.value_mut(&name) {
            *slot = Some(value);
        }
    }
    let program = mapping.provenance.program.as_deref().unwrap_or(UNKNOWN);
    let summary = external::summary(scene, program, table, &history);
    let summary = Summary { uncertainty, samples: Some(history.len()), ..summary };
    Outcome { summary, history }
}

/// Writes the entry and puts it into the store.
fn install(scene: &Scene, store: &Store, outcome: &Outcome, provenance: &str) -> Result<Stored> {
    let work = store.work_folder(scene)?;
    let made = work.path().join("result");
    std::fs::create_dir(&made).map_err(|e| Error::io("creating", &made, e))?;
    let summary = serde_json::to_string_pretty(&outcome.summary)
        .map_err(|e| Error::Internal(format!("a summary as JSON: {e}")))?;
    let files = [
        ("history.csv", csv(&outcome.history)),
        ("provenance.json", provenance.to_owned()),
        ("summary.json", summary),
    ];
    let mut sums = String::new();
    for (name, text) in &files {
        sums += &format!("{}  {name}\n", sha256_hex(text.as_bytes()));
    }
    for (name, text) in files.iter().map(|(name, text)| (*name, text)).chain([("checksums.sha256", &sums)]) {
        let path = made.join(name);
        std::fs::write(&path, text).map_err(|e| Error::io("writing", &path, e))?;
    }
    let stored = entry::load(scene, &made, Origin::Imported).map_err(|damage| {
        Error::Internal(format!("the import's {}: {}", damage.file.display(), damage.reason))
    })?;
    let Installed { folder, earlier } = store.install(&work, &made, scene, Resolution::Imported)?;
    Ok(Stored { folder, earlier, ..stored })
}

fn csv(history: &History) -> String {
    let mut text = String::from("time");
    history.curves.iter().for_each(|curve| text += &format!(",{}", curve.name));
    for (k, time) in history.time.iter().enumerate() {
        let _ = write!(text, "\n{time:e}");
        for curve in &history.curves {
            let _ = write!(text, ",{:e}", curve.values[k]);
        }
    }
    text + "\n"
}
