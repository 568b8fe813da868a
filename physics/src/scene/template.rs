//! A scene whose numbers can be changed one by one: what sweeps and optimisations vary.
//!
//! The scene file is read and checked once; every variation is checked against the same bounds as the file and
//! costs a few microseconds.

use super::collision::Collision;
use super::field::{fields_of, index, number_in, without_effect};
use super::material;
use super::read::Settings;
use super::values::Node;
use super::values::{Checked, Values};
use super::{Distribution, Field, Grammar, Rejected, Scene, unknown_name};
use crate::{Error, Result};
use std::sync::Arc;

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
    grammar: &'static Grammar,
    values: Values,
    settings: Settings,
    scene: Scene,
    text: String,
}

impl Template {
    /// Checks `text`, the content of a scene file, in the language `grammar`; `source_name` is what messages call the file.
    ///
    /// # Errors
    /// As [`Scene::parse`].
    pub(crate) fn new(grammar: &'static Grammar, source_name: &str, text: &str) -> Result<Self> {
        let (scene, values) = grammar.parse_values(source_name, text)?;
        let settings = Settings { tolerances: scene.tolerances.clone(), uncertainty: None };
        Ok(Template { grammar, values, settings, scene, text: text.to_owned() })
    }

    /// The scene as it stands in the file.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The content of the file.
    pub fn text(&self) -> &str {
        &self.text
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
        if let Some(why) = without_effect(&self.values, path) {
            return Err(Error::Usage(format!("`{path}` changes no reduced model: {why}")));
        }
        let names: Vec<&str> = fields.iter().map(|field| field.path.as_str()).collect();
        let message = format!("scene `{}` has no numeric field `{path}`", self.scene.name);
        Err(unknown_name(message, path, &names))
    }

    /// Every numeric field that the scene has or may have and a reduced model knows.
    pub fn fields(&self) -> Vec<Field> {
        fields_of(self.grammar.keys, &self.values)
    }

    /// What the scene file has in `field`, in SI; `None` if it printed nothing there.
    pub fn number(&self, field: &Field) -> Option<f64> {
        number_in(&self.values, field)
    }

    /// The scene with other numbers, in SI; later ones win. It is one of those that the file's uncertainties speak of, and has none itself.
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
        refused(material::collisions(&Node::new(&values, self.grammar.keys)).map_err(fault)?)?;
        let scene = self.grammar.assemble(&values, self.settings.clone()).map_err(fault)?;
        refused(scene.setup.bodies().collisions())?;
        Ok(scene)
    }

    /// The bounds between which `field` scatters if it is `value`, and the keys they stand under; `None` if it has none.
    fn moved_bounds(&self, field: &Field, value: f64) -> Option<(Vec<String>, toml::Value)> {
        let inputs = &self.scene.uncertainty.as_ref()?.inputs;
        let moved = inputs.iter().find(|input| input.field == field.path)?.about(value);
        let Distribution::Uniform { low, high } = moved.distribution else { return None };
        let table: toml::Table = self.text.parse().ok()?;
        let quoted = table.get("uncertainty").is_some_and(|table| table.get(&field.path).is_some());
        let names = if quoted { std::slice::from_ref(&field.path) } else { &field.keys[..] };
        let keys = ["uncertainty"].into_iter().chain(names.iter().map(String::as_str)).chain(["uniform"]);
        Some((keys.map(str::to_owned).collect(), vec![low, high].into()))
    }

    /// The scene file with another name and other numbers, in SI; bounds of what is uncertain move along. Comments are lost.
    ///
    /// # Errors
    /// [`Error::Internal`] if it can't be written.
    pub fn text_with(&self, name: &str, numbers: &[(&Field, f64)]) -> Result<String> {
        let failed = |e: String| Error::Internal(format!("writing the scene file: {e}"));
        let mut table: toml::Table = self.text.parse().map_err(|e: toml::de::Error| failed(e.to_string()))?;
        table.insert("name".into(), name.into());
        self.take_in_record(&mut table);
        if let Some(Checked::Table(body)) = self.values.get("body")
            && let Some(Checked::Text(file)) = body.get("file")
        {
            write(&mut table, &["body".into(), "file".into()], file.clone().into());
        }
        for (field, value) in numbers {
            let number = if field.is_count() { (*value as i64).into() } else { (*value).into() };
            write(&mut table, &field.keys, number);
            if let Some(moved) = self.moved_bounds(field, *value) {
                write(&mut table, &moved.0, moved.1);
            }
        }
        toml::to_string(&table).map_err(|e| failed(e.to_string()))
    }

    /// Puts the record that `table` names into it: what is written need not lie beside that file.
    fn take_in_record(&self, table: &mut toml::Table) {
        let Some(toml::Value::Table(vibration)) = table.get_mut("vibration") else { return };
        let Some(Checked::Table(values)) = self.values.get("vibration") else { return };
        if vibration.remove("file").is_none() {
            return;
        }
        for (key, value) in &**values {
            if let Checked::Numbers(samples) = value {
                vibration.insert(key.clone(), samples.clone().into());
            }
        }
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
            let inner = values.entry(key.clone()).or_insert_with(|| Checked::Table(Arc::default()));
            match (inner, value) {
                (Checked::Table(inner), value) => set(Arc::make_mut(inner), rest, value),
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
            ("plate.radius", -1e-3, "`plate.radius` is -0.001 m, but it must be greater than 0 m"),
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
            ("materials.steel.yield_strength", "without `hardening`"),
            ("reference.elements_per_contact_radius", "only the reference uses it"),
        ] {
            let refused = template.field(path).expect_err("refused");
            let said = format!("{refused} {}", refused.hints().join(" "));
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
