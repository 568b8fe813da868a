//! A scene whose numbers can be changed one by one: what sweeps and optimisations vary.
//!
//! The scene file is read and checked once; every variation is checked against the same bounds as the file and
//! costs a few microseconds.

use super::check::{Checked, Values};
use super::collision::Collision;
use super::material;
use super::quantity::{self, Dimension, QuantityError};
use super::read::{Node, assemble, checked, read_text, refuse_collisions};
use super::specification::{self, Kind, SCENE};
use super::{Scene, Tolerances, suggestion};
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::path::Path;

/// A checked scene file, open to variation.
///
/// ```
/// use impactcheck_physics::scene::Template;
///
/// let template = Template::read("../scenes/scaled-plate-r10.toml")?;
/// let thickness = template.field("plate.thickness")?;
/// let thinner = template.with(&[(&thickness, 1e-3)]).expect("a valid plate");
/// assert_eq!(thinner.plate_impact()?.plate.thickness, 1e-3);
/// # Ok::<(), impactcheck_physics::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Template {
    values: Values,
    tolerances: BTreeMap<String, Tolerances>,
    scene: Scene,
    text: String,
}

/// A numeric field of a scene file, such as `plate.thickness` or `materials.steel.density`.
#[derive(Debug, Clone)]
pub struct Field {
    path: String,
    keys: Vec<String>,
    kind: &'static Kind,
}

/// Why a value can't stand in a field.
#[derive(Debug, Clone, PartialEq)]
pub struct Rejected(pub String);

impl std::fmt::Display for Rejected {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl Field {
    /// Its name, keys joined by dots.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Its SI unit; "1" for a pure number.
    pub fn unit(&self) -> &'static str {
        self.dimension().describe().1
    }

    /// Whether it takes whole numbers only.
    pub fn is_count(&self) -> bool {
        matches!(self.kind, Kind::Count(..))
    }

    fn dimension(&self) -> Dimension {
        match self.kind {
            Kind::Quantity(dimension, _) | Kind::Quantities(dimension, ..) => *dimension,
            _ => Dimension::NONE,
        }
    }

    /// Reads a number with unit, or a bare one in SI.
    ///
    /// # Errors
    /// [`Error::Usage`] with the text and what is needed.
    pub fn parse(&self, text: &str) -> Result<f64> {
        let (what, _, sample) = self.dimension().describe();
        let fault = |reason: String| {
            let like =
                if self.dimension() == Dimension::NONE { sample.to_owned() } else { format!("\"{sample}\"") };
            Error::Usage(format!("`{}` = `{text}`: {reason}; write {what}, for example {like}", self.path))
        };
        let number = quantity::parse(text, self.dimension()).map_err(|error| {
            fault(match error {
                QuantityError::NotANumber => "that is not a number with a unit".into(),
                QuantityError::UnknownUnit(u) => format!("`{u}` is not a known unit"),
                QuantityError::MalformedUnit(u) => format!("`{u}` is not a product of units"),
                QuantityError::WrongDimension(u) => {
                    format!("`{u}` is not the unit of {}", self.dimension().in_words())
                }
                QuantityError::OutOfRange => "double precision can't hold it".into(),
            })
        })?;
        Ok(number)
    }

    /// Whether `value`, in SI, may stand in the field.
    ///
    /// # Errors
    /// [`Rejected`] with field, value, bound and unit.
    pub fn check(&self, value: f64) -> std::result::Result<(), Rejected> {
        let unit = self.unit();
        let shown = self.dimension().suffix();
        let rejected =
            |range: String| Rejected(format!("`{}` is {value}{shown}, but it has to be {range}", self.path));
        match self.kind {
            Kind::Quantity(_, bound) | Kind::Quantities(_, bound, _) if !bound.holds(value) => {
                Err(rejected(bound.describe(unit)))
            }
            Kind::Quantity(dimension, _) | Kind::Quantities(dimension, ..)
                if !dimension.is_plausible(value) =>
            {
                let [low, high] = dimension.span();
                Err(rejected(format!("between {low:e} and {high:e}{shown}")))
            }
            Kind::Quantity(..) | Kind::Quantities(..) => Ok(()),
            Kind::Count(low, high) => {
                let whole = value.fract() == 0.0 && value >= *low as f64 && value <= *high as f64;
                if whole { Ok(()) } else { Err(rejected(format!("a whole number from {low} to {high}"))) }
            }
            _ => Err(rejected("a number".into())),
        }
    }
}

/// Why the field called `path` changes no reduced model, if it does not; `there` says whether the scene file has a field.
fn without_effect(path: &str, there: impl Fn(&str) -> bool) -> Option<&'static str> {
    let of_material = |key: &str| path.strip_suffix(key).filter(|rest| rest.starts_with("materials."));
    if path == "friction" || path.starts_with("reference.") {
        return Some("it is the reference's alone");
    }
    if of_material(".hardening").is_some() {
        return Some("their contact law knows no hardening, which is the reference's alone");
    }
    let material = of_material(".yield_strength")?;
    (!there(&format!("{material}.hardening"))).then_some("without `hardening` the material stays elastic")
}

impl Template {
    /// Reads and checks the scene file at `path`.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        Self::parse(&path.display().to_string(), &read_text(path)?)
    }

    /// Checks `text`, the content of a scene file; `source_name` is what messages call the file.
    ///
    /// # Errors
    /// As [`Scene::parse`].
    pub fn parse(source_name: &str, text: &str) -> Result<Self> {
        let (values, tolerances) = checked(source_name, text)?;
        let scene = assemble(&values, tolerances.clone())?;
        refuse_collisions(&scene, source_name, text)?;
        Ok(Template { values, tolerances, scene, text: text.to_owned() })
    }

    /// The scene as it stands in the file.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The numeric field called `path`.
    ///
    /// # Errors
    /// [`Error::Usage`] if the scene has none of that name; it lists those there are.
    pub fn field(&self, path: &str) -> Result<Field> {
        let fields = self.fields();
        if let Some(field) = fields.iter().find(|field| field.path == path) {
            return Ok(field.clone());
        }
        if let Some(why) = without_effect(path, |key| self.has(key)) {
            return Err(Error::Usage(format!("`{path}` changes no reduced model: {why}")));
        }
        let names: Vec<&str> = fields.iter().map(|field| field.path.as_str()).collect();
        let hint = suggestion(path, names.iter().copied()).map(|s| format!("; did you mean `{s}`?"));
        Err(Error::Usage(format!(
            "scene `{}` has no numeric field `{path}`{} (there: {})",
            self.scene.name,
            hint.unwrap_or_default(),
            names.join(", ")
        )))
    }

    /// Every numeric field that the scene has or may have and a reduced model knows.
    pub fn fields(&self) -> Vec<Field> {
        let mut fields = Vec::new();
        collect(&SCENE, Some(&self.values), &mut Vec::new(), &mut fields);
        fields.retain(|field: &Field| without_effect(&field.path, |key| self.has(key)).is_none());
        fields
    }

    /// Whether the scene file has a value at `path`.
    fn has(&self, path: &str) -> bool {
        let (tables, key) = path.rsplit_once('.').unwrap_or(("", path));
        tables
            .split_terminator('.')
            .try_fold(&self.values, |values, table| match values.get(table) {
                Some(Checked::Table(inner)) => Some(inner),
                _ => None,
            })
            .is_some_and(|values| values.contains_key(key))
    }

    /// What the scene file has in `field`, in SI; `None` if it says nothing there.
    pub fn number(&self, field: &Field) -> Option<f64> {
        let (last, tables) = field.keys.split_last()?;
        let mut values = &self.values;
        for key in tables {
            match values.get(key)? {
                Checked::Table(inner) => values = inner,
                Checked::Numbers(list) => return list.get(index(std::slice::from_ref(last))?).copied(),
                _ => return None,
            }
        }
        match values.get(last)? {
            Checked::Number(number) => Some(*number),
            Checked::Count(count) => Some(*count as f64),
            _ => None,
        }
    }

    /// The scene with other numbers, in SI; later ones win.
    ///
    /// # Errors
    /// [`Rejected`] for the first number that is out of bounds, or the first two features that collide.
    pub fn with(&self, numbers: &[(&Field, f64)]) -> std::result::Result<Scene, Rejected> {
        let mut values = self.values.clone();
        for (field, value) in numbers {
            field.check(*value)?;
            let checked =
                if field.is_count() { Checked::Count(*value as u64) } else { Checked::Number(*value + 0.0) };
            set(&mut values, &field.keys, checked);
        }
        let fault = |e: Error| Rejected(e.to_string());
        let refused = |collisions: Vec<Collision>| match collisions.into_iter().next() {
            Some(collision) => Err(Rejected(collision.message)),
            None => Ok(()),
        };
        refused(material::collisions(&Node(&values)).map_err(fault)?)?;
        let scene = assemble(&values, self.tolerances.clone()).map_err(fault)?;
        refused(scene.setup.part().collisions())?;
        Ok(scene)
    }

    /// The scene file with another name and other numbers, in SI. Comments are lost.
    ///
    /// # Errors
    /// [`Error::Internal`] if it can't be written.
    pub fn text_with(&self, name: &str, numbers: &[(&Field, f64)]) -> Result<String> {
        let failed = |e: String| Error::Internal(format!("writing the scene file: {e}"));
        let mut table: toml::Table = self.text.parse().map_err(|e: toml::de::Error| failed(e.to_string()))?;
        table.insert("name".into(), name.into());
        for (field, value) in numbers {
            let number = if field.is_count() { (*value as i64).into() } else { (*value).into() };
            write(&mut table, &field.keys, number);
        }
        toml::to_string(&table).map_err(|e| failed(e.to_string()))
    }
}

/// Puts `number` under `keys` of a TOML table, making tables that are not there.
fn write(table: &mut toml::Table, keys: &[String], number: toml::Value) {
    match keys {
        [] => {}
        [key] => {
            table.insert(key.clone(), number);
        }
        [key, rest @ ..] => match table.entry(key.clone()).or_insert_with(|| toml::Table::new().into()) {
            toml::Value::Table(inner) => write(inner, rest, number),
            toml::Value::Array(list) => {
                if let Some(entry) = index(rest).and_then(|i| list.get_mut(i)) {
                    *entry = number;
                }
            }
            _ => {}
        },
    }
}

/// Puts `value` under `keys`, making tables that are not there.
fn set(values: &mut Values, keys: &[String], value: Checked) {
    match keys {
        [] => {}
        [key] => {
            values.insert(key.clone(), value);
        }
        [key, rest @ ..] => {
            let inner = values.entry(key.clone()).or_insert_with(|| Checked::Table(Values::new()));
            match (inner, value) {
                (Checked::Table(inner), value) => set(inner, rest, value),
                (Checked::Numbers(list), Checked::Number(number)) => {
                    if let Some(entry) = index(rest).and_then(|i| list.get_mut(i)) {
                        *entry = number;
                    }
                }
                _ => {}
            }
        }
    }
}

/// The place in a list that the last key names, counted from 1.
fn index(keys: &[String]) -> Option<usize> {
    let [key] = keys else { return None };
    key.parse::<usize>().ok()?.checked_sub(1)
}

/// The numeric fields below a table with the keys of `specification`; `values` is what the file has there.
fn collect(
    specification: &'static [specification::Field],
    values: Option<&Values>,
    keys: &mut Vec<String>,
    found: &mut Vec<Field>,
) {
    let text = |key: &str| match values.and_then(|v| v.get(key)) {
        Some(Checked::Text(text)) => Some(text.as_str()),
        _ => None,
    };
    let table = |values: Option<&'_ Values>, key: &str| match values.and_then(|v| v.get(key)) {
        Some(Checked::Table(inner)) => Some(inner.clone()),
        _ => None,
    };
    let kind = text("kind").map(str::to_owned);
    for field in specification {
        // of several ways to say a thing only the one the file takes
        let absent = !values.is_some_and(|v| v.contains_key(field.key));
        if !field.belongs_to(kind.as_deref()) || (field.alternative(kind.as_deref()).is_some() && absent) {
            continue;
        }
        keys.push(field.key.to_owned());
        match &field.kind {
            Kind::Quantity(..) | Kind::Count(..) => {
                found.push(Field { path: keys.join("."), keys: keys.clone(), kind: &field.kind });
            }
            // the entries of a list that the file has, counted from 1
            Kind::Quantities(..) => {
                let list = values.and_then(|v| v.get(field.key));
                let count = if let Some(Checked::Numbers(list)) = list { list.len() } else { 0 };
                for entry in 1..=count {
                    keys.push(entry.to_string());
                    found.push(Field { path: keys.join("."), keys: keys.clone(), kind: &field.kind });
                    keys.pop();
                }
            }
            Kind::Table(inner) => {
                let there = table(values, field.key);
                // one number alone does not make a table that has to have others
                if there.is_some() || inner.iter().all(|f| !f.required) {
                    collect(inner, there.as_ref(), keys, found);
                }
            }
            Kind::TableOf(inner) => {
                for (name, entry) in table(values, field.key).unwrap_or_default() {
                    if let Checked::Table(entry) = entry {
                        keys.push(name);
                        collect(inner, Some(&entry), keys, found);
                        keys.pop();
                    }
                }
            }
            _ => {}
        }
        keys.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASE: &str = include_str!("../../../scenes/scaled-plate-r10.toml");
    const BENDER: &str = include_str!("../../../scenes/examples/rocker-bender.toml");

    #[test]
    fn only_the_way_the_file_takes_can_be_varied() {
        let template = Template::parse("bender", BENDER).expect("shipped scene");
        for there in ["outer.speed", "outer.first_frequency", "outer.discharge_time"] {
            template.field(there).expect(there);
        }
        for absent in ["outer.torque", "outer.tip_deflection", "outer.line_mass", "outer.radius"] {
            assert!(template.field(absent).is_err(), "{absent}");
        }
    }

    fn template() -> Template {
        Template::parse("base", BASE).expect("shipped scene")
    }

    #[test]
    fn numbers_change_and_nothing_else_does() {
        let template = template();
        let gap = template.field("inner.gap").expect("optional, absent");
        let modulus = template.field("materials.steel.youngs_modulus").expect("a material's");
        let modes = template.field("reduced.modes").expect("a count");
        let scene = template.with(&[(&gap, 1e-5), (&modulus, 100e9), (&modes, 7.0)]).expect("valid");
        let setup = scene.plate_impact().expect("a plate");
        assert_eq!((setup.inner.gap, scene.reduced.modes), (1e-5, Some(7)));
        assert_eq!([&setup.plate.material, &setup.outer.material].map(|m| m.youngs_modulus), [100e9; 2]);
        assert_eq!(template.with(&[]).expect("unchanged"), *template.scene());
        assert_eq!(*template.scene(), Scene::parse("base", BASE).expect("shipped scene"));
        let text =
            template.text_with("other", &[(&gap, 1e-5), (&modulus, 100e9), (&modes, 7.0)]).expect("text");
        assert_eq!(Scene::parse("written", &text).expect("valid"), Scene { name: "other".into(), ..scene });
    }

    #[test]
    fn bounds_are_those_of_the_file() {
        let template = template();
        for (path, value, part) in [
            ("plate.radius", -1e-3, "`plate.radius` is -0.001 m, but it has to be greater than 0 m"),
            ("materials.steel.poisson_ratio", 0.5, "less than 0.5"),
            ("reduced.modes", 2.5, "a whole number from 1"),
            ("outer.speed", f64::NAN, "NaN"),
        ] {
            let field = template.field(path).expect("there");
            let said = template.with(&[(&field, value)]).expect_err("rejected").to_string();
            assert!(said.contains(part), "{said}");
        }
    }

    #[test]
    fn fields_that_the_scene_cannot_have_are_refused_with_the_nearest_name() {
        let template = template();
        for (path, part) in [
            ("plate.thicknes", "did you mean `plate.thickness`?"),
            ("outer.mass", "no numeric field `outer.mass`"),
            ("fluid.viscosity", "no numeric field"),
            ("plate.edge", "no numeric field"),
            ("friction", "it is the reference's alone"),
            ("materials.steel.hardening", "knows no hardening"),
            ("materials.steel.yield_strength", "without `hardening`"),
            ("reference.elements_per_contact_radius", "it is the reference's alone"),
        ] {
            let said = template.field(path).expect_err("refused").to_string();
            assert!(said.contains(part), "{said}");
        }
        let yielding = BASE.replace("density ", "yield_strength = 6e8\nhardening = 0\ndensity ");
        let yielding = Template::parse("yielding", &yielding).expect("valid");
        let strength = yielding.field("materials.steel.yield_strength").expect("now it counts");
        assert!(yielding.with(&[(&strength, 5e8)]).is_ok());
        let field = template.field("plate.radius").expect("there");
        assert_eq!(field.parse("33mm").expect("a length"), 0.033);
        let said = field.parse("33 kg").expect_err("a mass").to_string();
        assert!(said.contains("plate.radius") && said.contains("33 kg") && said.contains(" m"), "{said}");
    }
}
