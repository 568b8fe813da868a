//! Functional Mock-up Units: a scene and the library that runs its reduced model, in one file that system simulations read.

use crate::error::{Error, Result};
use crate::kinds;
use crate::plot::png;
use crate::report::unit_page;
use crate::result::Outcome;
use crate::scene::Template;
use crate::scene::hash::sha256_hex;
use impactcheck_fmu::{
    Identity, SCENE, SETUP, UnitSetup, UnitVariable, Version, model_description, variables,
};
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use zip::write::{SimpleFileOptions, ZipWriter};

/// The dynamic library of `impactcheck-fmu`.
static LIBRARY: OnceLock<&[u8]> = OnceLock::new();
const ICON: &str = include_str!("icon.svg");
const LICENCES: &str = include_str!("licences.txt");
/// Width of the icon in pixels over that of its drawing.
const ICON_SCALE: f32 = 2.0;
/// Length of the default experiment over that of the impact.
const EXPERIMENT: f64 = 2.0;

/// Gives the program the library that it puts into units. For programs, called once.
pub fn embed(library: &'static [u8]) {
    LIBRARY.get_or_init(|| library);
}

/// What a unit is made of.
#[derive(Debug)]
pub struct UnitParts<'a> {
    /// The scene, [`launchable`].
    pub template: &'a Template,
    /// Its result with the numbers of the scene: which model, how long.
    pub outcome: &'a Outcome,
    /// Number of modes; `None` = the scene's or the model's own.
    pub modes: Option<usize>,
    /// Relative error of the time integration.
    pub tolerance: f64,
    /// Files that the model reads, with their names in the unit's resources.
    pub files: &'a [(String, PathBuf)],
    /// Version of the standard.
    pub version: Version,
}

/// The content of a unit's file.
#[derive(Debug)]
pub struct Packed {
    /// The file.
    pub bytes: Vec<u8>,
    /// The variables.
    pub variables: Vec<UnitVariable>,
}

/// The unit made of `parts`; the same parts give the same bytes.
///
/// # Errors
/// [`Error::Internal`] if this program was built without the library, [`Error::Usage`] if the standard has no name for this machine,
/// [`Error::Io`] of files that can't be read.
pub fn packed(parts: &UnitParts) -> Result<Packed> {
    let library = LIBRARY.get().copied().filter(|library| !library.is_empty()).ok_or_else(|| {
        Error::Internal(
            "this program was built without the library of units: build it with `cargo build`".into(),
        )
    })?;
    let scene = parts.template.scene();
    let identifier = identifier(&scene.name);
    let binary = binary(parts.version, &identifier)?;
    let summary = &parts.outcome.summary;
    let variables = variables(parts.template);
    let text = scene_file(parts.template)?;
    let mut setup = UnitSetup {
        token: String::new(),
        model: summary.model.clone().unwrap_or_default(),
        modes: parts.modes,
        tolerance: parts.tolerance,
    };
    let tool = format!("impactcheck {}", env!("CARGO_PKG_VERSION"));
    // what a state of the unit depends on
    let names: Vec<&str> = variables.iter().map(|variable| variable.name.as_str()).collect();
    setup.token = sha256_hex(format!("{tool}\n{setup:?}\n{names:?}\n{text}").as_bytes());
    let end = parts.outcome.history.time.last().copied().unwrap_or(0.0);
    let identity = Identity {
        name: &scene.name,
        identifier: &identifier,
        description: &scene.description,
        token: &setup.token,
        tool: &tool,
        stop: rounded_up(EXPERIMENT * (summary.strike_delay() + end)),
    };
    let icon = match parts.version {
        Version::Two => "model.png",
        Version::Three => "terminalsAndIcons/icon.png",
    };
    let mut unit = Archive(ZipWriter::new(Cursor::new(Vec::new())));
    unit.add("modelDescription.xml", model_description(parts.version, &identity, &variables).as_bytes())?;
    unit.add(&binary, library)?;
    unit.add(icon, &png(ICON, ICON_SCALE)?)?;
    unit.add(
        "documentation/index.html",
        unit_page(scene, summary, parts.version.number(), &variables).as_bytes(),
    )?;
    unit.add("documentation/licenses/license.txt", LICENCES.as_bytes())?;
    unit.add(&format!("resources/{SCENE}"), text.as_bytes())?;
    let json = serde_json::to_vec_pretty(&setup).map_err(|e| Error::Internal(e.to_string()))?;
    unit.add(&format!("resources/{SETUP}"), &json)?;
    let read = |path: &Path| std::fs::read(path).map_err(|e| Error::io("reading", path, e));
    for (name, path) in parts.files {
        unit.add(&format!("resources/{name}"), &read(path)?)?;
    }
    if let Some(file) = kinds::of(scene).body_file(scene) {
        unit.add(&format!("resources/{}", body_name(file)), &read(file)?)?;
    }
    Ok(Packed { bytes: unit.finish()?, variables })
}

/// A compressed archive.
struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    fn add(&mut self, name: &str, bytes: &[u8]) -> Result<()> {
        let failed = |e: &dyn std::fmt::Display| Error::Internal(format!("writing the unit: {e}"));
        self.0.start_file(name, SimpleFileOptions::default()).map_err(|e| failed(&e))?;
        self.0.write_all(bytes).map_err(|e| failed(&e))
    }

    fn finish(self) -> Result<Vec<u8>> {
        let done = self.0.finish().map_err(|e| Error::Internal(format!("writing the unit: {e}")))?;
        Ok(done.into_inner())
    }
}

/// What a unit does not need of a scene: programs and tolerances of comparisons, further impacts of a series, vibration of the valve.
const OMITTED: [&str; 4] = ["external", "tolerances", "series", "vibration"];

/// The scene of `template` as a unit launches it: a single impact.
///
/// # Errors
/// Those of a scene file.
pub fn launchable(template: &Template) -> Result<Template> {
    let name = &template.scene().name;
    let mut table = table(&template.text_with(name, &[])?)?;
    OMITTED.iter().for_each(|key| drop(table.remove(*key)));
    Template::parse(name, &text(&table)?)
}

/// The file of the scene of `template` as it lies in the unit, with its body's file in the same folder.
fn scene_file(template: &Template) -> Result<String> {
    let scene = template.scene();
    let mut table = table(template.text())?;
    if let (Some(file), Some(toml::Value::Table(body))) =
        (kinds::of(scene).body_file(scene), table.get_mut("body"))
    {
        body.insert("file".into(), body_name(file).into());
    }
    text(&table)
}

fn table(text: &str) -> Result<toml::Table> {
    text.parse().map_err(|e| Error::Internal(format!("the scene file: {e}")))
}

fn text(table: &toml::Table) -> Result<String> {
    toml::to_string(table).map_err(|e| Error::Internal(format!("writing the scene file: {e}")))
}

/// Name of the file of a body in the unit's resources.
fn body_name(file: &Path) -> String {
    let extension = file.extension().map_or_else(String::new, |kind| kind.to_string_lossy().to_lowercase());
    format!("body.{extension}")
}

/// `name` as an identifier of C.
fn identifier(name: &str) -> String {
    let valid = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let text: String = name.chars().map(valid).collect();
    if text.starts_with(|c: char| c.is_ascii_digit()) { format!("_{text}") } else { text }
}

/// Where the library lies in a unit for this machine.
fn binary(version: Version, identifier: &str) -> Result<String> {
    let (machine, system) = (std::env::consts::ARCH, std::env::consts::OS);
    let folder = match (version, machine, system) {
        (Version::Two, "x86_64", "linux") => "linux64".to_owned(),
        (Version::Two, "x86_64", "macos") => "darwin64".to_owned(),
        (Version::Two, "x86_64", "windows") => "win64".to_owned(),
        (Version::Two, ..) => {
            return Err(Error::Usage(format!(
                "--fmi 2: FMI 2.0 has no name for a machine of type {machine}; take --fmi 3"
            )));
        }
        (Version::Three, _, "macos") => format!("{machine}-darwin"),
        (Version::Three, ..) => format!("{machine}-{system}"),
    };
    Ok(format!("binaries/{folder}/{identifier}{}", std::env::consts::DLL_SUFFIX))
}

/// `time` in s with one significant digit, rounded up.
fn rounded_up(time: f64) -> f64 {
    let unit = 10.0_f64.powf(time.log10().floor());
    format!("{:.0e}", (time / unit).ceil() * unit).parse().unwrap_or(time)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_identifiers() {
        assert_eq!(identifier("scaled-plate-r6.35"), "scaled_plate_r6_35");
        assert_eq!(identifier("2 µm"), "_2__m");
    }

    #[test]
    fn experiments_have_round_lengths() {
        for (time, round) in [(3.71e-4, 4e-4), (1e-3, 1e-3), (9.2e-5, 1e-4)] {
            assert_eq!(rounded_up(time), round);
        }
    }
}
