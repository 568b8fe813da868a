//! From the text of a scene file to a [`Scene`].

use super::check::Checker;
use super::collision::Collision;
use super::external::external;
use super::fault::Collector;
use super::flight::{flight, vibration, with_record};
use super::place::Place;
use super::values::{Checked, Node, Values, unknown};
use super::*;
use crate::{Error, Result};
use std::io::Read;
use std::path::Path;
use toml::de::DeTable;

/// Largest scene file in bytes; a real one has about a thousand.
pub const MAX_FILE_BYTES: u64 = 1 << 20;

impl Grammar {
    /// Checks `text`, the content of a scene file; `source_name` is what messages call the file.
    ///
    /// # Errors
    /// [`Error::Scene`] with every fault, its place and what would be valid.
    pub(crate) fn parse(&self, source_name: &str, text: &str) -> Result<Scene> {
        Ok(self.parse_values(source_name, text)?.0)
    }

    /// As [`Self::parse`], with the checked values of the file.
    ///
    /// # Errors
    /// As [`Self::parse`].
    pub(super) fn parse_values(&self, source_name: &str, text: &str) -> Result<(Scene, Values)> {
        let tree = DeTable::parse(text).map_err(|e| syntax(source_name, text, &e))?;
        let root = &*self.resolved(tree.get_ref());
        let (values, settings) = self.checked(source_name, text, root)?;
        let scene = self.assemble(&values, settings)?;
        let mut problems = Collector::new(source_name, text);
        note(collisions(&scene), root, &mut problems);
        match problems.is_empty() {
            true => Ok((scene, values)),
            false => Err(Error::Scene(problems.into_report())),
        }
    }

    /// The checked values of the table `root`, and its tables that have readers of their own.
    ///
    /// # Errors
    /// As [`Self::parse`].
    fn checked(&self, source_name: &str, text: &str, root: &DeTable) -> Result<(Values, Settings)> {
        if root.is_empty() {
            return Err(refused(
                &format!("{source_name}, line 1: the scene file has no content"),
                "copy a file of the folder scenes/ and change it",
            ));
        }
        let mut checker = Checker::new(source_name, text, root);
        let place = Place { path: "", span: 0..0 };
        let mut values = checker.table(&place, root, self.keys);
        let kind = values.get("kind").and_then(|kind| match kind {
            Checked::Text(name) => self.dialect(name),
            _ => None,
        });
        let tolerances = checker.tolerances(root, kind.unwrap_or(&self.dialects[0]));
        let uncertainty = checker.uncertainty(root, self.keys, &values);
        if checker.problems.is_empty() {
            note(material::collisions(&Node::new(&values, self.keys))?, root, &mut checker.problems);
            let own =
                kind.map_or_else(Vec::new, |kind| kind.language.collisions(&Node::new(&values, self.keys)));
            note(own, root, &mut checker.problems);
            let record = with_record(&mut values, source_name).map_err(|message| FileFault {
                field: "vibration.file",
                message,
                help: "name a table in the folder of the scene file",
            });
            let own = kind.map_or(Ok(()), |kind| kind.language.find_files(&mut values, source_name));
            for fault in [record, own].into_iter().filter_map(std::result::Result::err) {
                let place = span_of(root, fault.field).unwrap_or(0..0);
                checker.problems.add(place, fault.message, "not usable", fault.help.to_owned());
            }
        }
        match checker.problems.is_empty() {
            true => Ok((values, Settings { tolerances, uncertainty })),
            false => Err(Error::Scene(checker.problems.into_report())),
        }
    }

    /// The scene that checked values describe.
    pub(super) fn assemble(&self, values: &Values, settings: Settings) -> Result<Scene> {
        let root = &Node::new(values, self.keys);
        let materials = root.table("materials")?;
        let name = root.text("kind")?;
        let dialect = self.dialect(name).ok_or_else(|| unknown("kind", name))?;
        let (setup, reference) = dialect.language.read(root, &materials)?;
        let end_time = root.optional_table("run")?.filter(|r| r.has("end_time"));
        Ok(Scene {
            name: root.text("name")?.to_owned(),
            description: root.optional_word("description")?.unwrap_or_default(),
            setup,
            run: RunSettings { end_time: end_time.map(|r| r.number("end_time")).transpose()? },
            reduced: reduced(root.optional_table("reduced")?)?,
            reference,
            tolerances: settings.tolerances,
            uncertainty: settings.uncertainty,
            flight: flight(root)?,
            vibration: vibration(root)?,
            external: root.tables("external")?.iter().map(external).collect::<Result<_>>()?,
        })
    }
}

/// The text of the scene file at `path`.
///
/// # Errors
/// As [`Scene::read`].
pub(crate) fn read_text(path: &Path) -> Result<String> {
    let name = path.display().to_string();
    let system = |source: std::io::Error| match source.kind() {
        std::io::ErrorKind::NotFound => Error::Usage(format!("there is no scene file {name}")),
        _ => Error::io("reading", path, source),
    };
    let metadata = std::fs::metadata(path).map_err(system)?;
    if metadata.is_dir() {
        return Err(refused(
            &format!("{name} is a folder, not a scene file"),
            "name the .toml file inside it",
        ));
    }
    if metadata.is_file() && metadata.len() > MAX_FILE_BYTES {
        return Err(too_large(&name, metadata.len().to_string()));
    }
    stream_text(&name, &mut std::fs::File::open(path).map_err(system)?)
}

/// The text of a stream called `name`: a pipe or a device has no size to check beforehand.
pub(crate) fn stream_text(name: &str, stream: &mut dyn Read) -> Result<String> {
    let mut bytes = Vec::new();
    let read = stream.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|e| Error::io("reading", name, e))?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(too_large(name, format!("more than {MAX_FILE_BYTES}")));
    }
    decode(name, bytes)
}

fn too_large(name: &str, size: String) -> Error {
    refused(
        &format!("{name} has {size} bytes; a scene file has at most {MAX_FILE_BYTES} (1 MiB)"),
        "give a scene file, such as one of the folder scenes/",
    )
}

/// Settings of a scene file that are no part of the impact; their tables have readers of their own.
#[derive(Debug, Clone)]
pub(super) struct Settings {
    pub(super) tolerances: BTreeMap<String, Tolerances>,
    pub(super) uncertainty: Option<Uncertainty>,
}

/// Features of `scene` that collide.
fn collisions(scene: &Scene) -> Vec<Collision> {
    let collisions = scene.setup.bodies().collisions();
    // a chamber made of bodies that can't be means nothing
    if collisions.is_empty() { super::flight::collisions(scene) } else { collisions }
}

/// Notes `collisions` at the first of their fields that the file has.
fn note(collisions: Vec<Collision>, root: &DeTable, problems: &mut Collector) {
    for collision in collisions {
        let place = collision.fields.iter().find_map(|field| span_of(root, field));
        problems.add(place.unwrap_or(0..0), collision.message, "collides", collision.help.to_owned());
    }
}

/// Where the key `path` ("seat.tilt") stands in the file.
fn span_of(table: &DeTable, path: &str) -> Option<std::ops::Range<usize>> {
    let (key, rest) = path.split_once('.').map_or((path, None), |(key, rest)| (key, Some(rest)));
    let (found, value) = table.get_key_value(key)?;
    match rest {
        Some(rest) => span_of(value.get_ref().as_table()?, rest),
        None => Some(found.span()),
    }
}

pub(crate) fn refused(message: &str, help: &str) -> Error {
    Error::Scene(miette::miette!(help = help.to_owned(), "{message}"))
}

/// Bytes to text; says where they stop being text.
fn decode(name: &str, bytes: Vec<u8>) -> Result<String> {
    let line = |at: usize| 1 + bytes[..at].iter().filter(|b| **b == b'\n').count();
    if let Some(at) = bytes.iter().position(|b| *b == 0) {
        let message = format!("{name}, line {}: not a text file (byte {at} is zero)", line(at));
        return Err(refused(&message, "a scene file is TOML, a text in UTF-8; see the folder scenes/"));
    }
    if let Err(error) = std::str::from_utf8(&bytes) {
        let at = error.valid_up_to();
        let message =
            format!("{name}, line {}: not valid UTF-8 (byte {at} is 0x{:02x})", line(at), bytes[at]);
        return Err(refused(&message, "save the file as UTF-8"));
    }
    String::from_utf8(bytes).map_err(|e| Error::Internal(e.to_string()))
}

fn syntax(name: &str, text: &str, error: &toml::de::Error) -> Error {
    let mut problems = Collector::new(name, text);
    let help =
        "a scene file is TOML (https://toml.io): `key = value` lines under [table] headers, each key once";
    let message = format!("not valid TOML: {}", error.message());
    problems.add(error.span().unwrap_or(0..0), message, "here", help.to_owned());
    Error::Scene(problems.into_report())
}

fn reduced(settings: Option<Node>) -> Result<ReducedSettings> {
    let mut reduced = ReducedSettings { model: None, modes: None, frequencies: None };
    let Some(settings) = settings else { return Ok(reduced) };
    if settings.has("model") {
        reduced.model = Some(settings.text("model")?.parse().map_err(Error::Internal)?);
    }
    for (key, value) in [("modes", &mut reduced.modes), ("frequencies", &mut reduced.frequencies)] {
        *value = settings.optional_count(key)?.and_then(|count| usize::try_from(count).ok());
    }
    Ok(reduced)
}
