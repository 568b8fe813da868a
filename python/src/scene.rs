//! Scenes: files, shipped ones, dictionaries.

use crate::raised;
use impactcheck::cli::in_process::Placed;
use impactcheck::scene::{self, Scene as Checked, Template};
use impactcheck::{Error, Result};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyList, PyMapping, PyString, PyTuple};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// One impact, read and checked.
///
/// `Scene(content)` takes the keys of a scene file as a dictionary, or its text; `Scene.read(path)` takes a file or the name of
/// a shipped scene. Quantities are texts with units ("33 mm") or numbers in SI. It can be copied and pickled.
#[pyclass(frozen, module = "impactcheck")]
pub struct Scene {
    /// Empty of a dictionary.
    file: PathBuf,
    /// Content of the file.
    text: String,
    pub scene: Checked,
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (content, file=None))]
    fn new(content: &Bound<'_, PyAny>, file: Option<PathBuf>) -> PyResult<Self> {
        if let Ok(text) = content.extract::<String>() {
            if text.ends_with(".toml") && !text.contains('\n') {
                let message = format!("{text:?} is the name of a file: use Scene.read({text:?})");
                return Err(raised(Error::Usage(message)));
            }
            return Self::parsed("text", text, file.unwrap_or_default());
        }
        let text = toml::to_string_pretty(&table(content.cast::<PyMapping>()?, "")?)
            .map_err(|e| raised(Error::Usage(format!("the dictionary can't be a scene file: {e}"))))?;
        Self::parsed("dictionary", text, file.unwrap_or_default())
    }

    /// What a copy is made from, in this process or another one.
    fn __getnewargs__(&self) -> (&str, Option<&Path>) {
        (&self.text, Some(self.file.as_path()).filter(|file| !file.as_os_str().is_empty()))
    }

    #[staticmethod]
    fn read(path: PathBuf) -> PyResult<Self> {
        let named = path.to_str().map_or_else(|| Ok(path.clone()), scene::resolve);
        let file = named.map_err(raised)?;
        let template = Template::read(&file).map_err(raised)?;
        Ok(Self { file, text: template.text().to_owned(), scene: template.scene().clone() })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.scene.name
    }

    #[getter]
    fn hash(&self) -> String {
        self.scene.hash()
    }

    fn __repr__(&self) -> String {
        format!("<impactcheck.Scene {}>", self.scene.name)
    }
}

impl Scene {
    fn parsed(name: &str, text: String, file: PathBuf) -> PyResult<Self> {
        let scene = Checked::parse(&place(&file, name), &text).map_err(raised)?;
        Ok(Self { file, text, scene })
    }

    /// Open to variation.
    pub fn template(&self) -> Result<Template> {
        Template::parse(&place(&self.file, &self.scene.name), &self.text)
    }

    pub fn placed(&self) -> Placed {
        (self.file.clone(), self.scene.clone())
    }
}

/// What a scene's text is read as the content of: files that it names lie beside that.
fn place(file: &Path, name: &str) -> String {
    if file.as_os_str().is_empty() { name.to_owned() } else { file.display().to_string() }
}

/// A mapping as TOML; `place` is its key ("plate.").
fn table(mapping: &Bound<'_, PyMapping>, place: &str) -> PyResult<Table> {
    let entry = |entry: Bound<'_, PyAny>| {
        let (key, content): (Bound<'_, PyAny>, Bound<'_, PyAny>) = entry.extract()?;
        let key = key.str()?.to_string();
        let content = value(&content, &format!("{place}{key}"))?;
        Ok((key, content))
    };
    mapping.items()?.iter().map(entry).collect()
}

/// A value as TOML. Whatever counts or measures is a number, NumPy's scalars too.
fn value(content: &Bound<'_, PyAny>, place: &str) -> PyResult<Value> {
    if content.is_instance_of::<PyBool>() {
        return content.extract().map(Value::Boolean);
    }
    if content.is_instance_of::<PyString>() {
        return content.extract().map(Value::String);
    }
    if let Ok(mapping) = content.cast::<PyMapping>() {
        return table(mapping, &format!("{place}.")).map(Value::Table);
    }
    if content.is_instance_of::<PyList>() || content.is_instance_of::<PyTuple>() {
        let elements = content.try_iter()?.map(|element| value(&element?, place));
        return elements.collect::<PyResult<_>>().map(Value::Array);
    }
    let number = content.extract().map(Value::Integer).or_else(|_| content.extract().map(Value::Float));
    number.map_err(|_| {
        let found = content.get_type();
        raised(Error::Scene(miette::miette!(
            "`{place}` is a {found}, but a scene has texts, numbers, lists and dictionaries only"
        )))
    })
}
