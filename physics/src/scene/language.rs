//! The scene language of some kinds of scene: the keys of every scene, and those of each kind.

use super::collision::Collision;
use super::external::EXTERNAL;
use super::flight::VIBRATION;
use super::grammar::{Bound, Choice, Field, Kind, choice, optional, positive, pure, required};
use super::material::MATERIAL;
use super::quantity::Dimension;
use super::tolerances::Gated;
use super::values::{Node, Values};
use super::{Model, ReferenceSettings, Setup};
use crate::error::Result;
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What a kind of scene adds to the language.
pub(crate) trait Language: Sync {
    /// The keys that only scenes of this kind have, also those that others have in another form.
    fn keys(&self) -> Vec<Field>;

    /// Those scenes of this kind that are another's, if there are such.
    fn alias(&self) -> Option<Alias> {
        None
    }

    /// Keys of checked values that exclude or need each other.
    fn collisions(&self, _: &Node) -> Vec<Collision> {
        Vec::new()
    }

    /// Puts what other files say into the checked `values` of the scene file `source_name`.
    ///
    /// # Errors
    /// What is wrong with a file.
    fn find_files(&self, _values: &mut Values, _source_name: &str) -> std::result::Result<(), FileFault> {
        Ok(())
    }

    /// The bodies that checked values describe, and the settings of their reference.
    ///
    /// # Errors
    /// [`crate::Error::Scene`] for values that do not go together.
    fn read(&self, root: &Node, materials: &Node) -> Result<(Setup, ReferenceSettings)>;
}

/// What is wrong with a file that a field of a scene names.
#[derive(Debug)]
pub(crate) struct FileFault {
    pub(crate) field: &'static str,
    pub(crate) message: String,
    pub(crate) help: &'static str,
}

/// Scenes that are read as those of another kind: those with some keys and without another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Alias {
    pub(crate) with: &'static [&'static str],
    pub(crate) without: &'static str,
    /// Name of the kind that they are read as.
    pub(crate) kind: &'static str,
}

impl Alias {
    fn is_meant(&self, root: &DeTable) -> bool {
        self.with.iter().all(|key| root.contains_key(*key)) && !root.contains_key(self.without)
    }
}

/// A kind of scene as the language knows it.
pub(crate) struct Dialect {
    /// Its name in scene files.
    pub(crate) name: &'static str,
    /// The reduced models it has.
    pub(crate) models: &'static [Model],
    /// What can have a tolerance.
    pub(crate) gated: Vec<Gated>,
    pub(crate) language: &'static dyn Language,
}

/// The language of all kinds.
pub(crate) struct Grammar {
    pub(crate) dialects: Vec<Dialect>,
    /// Every key of a scene file; one whose form depends on the kind stands here once per kind.
    pub(crate) keys: &'static [Field],
}

impl Grammar {
    /// The language of these kinds; made once for the whole run of the program.
    pub(crate) fn new(dialects: Vec<Dialect>) -> Self {
        let names: &'static [Choice] =
            dialects.iter().map(|dialect| choice(dialect.name)).collect::<Vec<_>>().leak();
        let mut keys = vec![
            required("name", Kind::Name, "Name of the scene in the store and in reports"),
            optional("description", Kind::Text, "One line for people"),
            required("kind", Kind::Choice(names), "What strikes what"),
            required("materials", Kind::TableOf(&MATERIAL), "Materials by name"),
        ];
        for dialect in &dialects {
            let only: &'static [&'static str] = vec![dialect.name].leak();
            keys.extend(dialect.language.keys().into_iter().map(|key| Field { only, ..key }));
        }
        keys.extend([
            optional(
                "friction",
                pure(Bound::NOT_NEGATIVE),
                "Coulomb's coefficient of friction of all contacts; model C of a seal seat takes at most 3",
            )
            .otherwise("0"),
            optional("run", Kind::Table(&RUN), "Length of the run"),
            optional(
                "vibration",
                Kind::Table(&VIBRATION),
                "Vibration of the valve; absent = none. Does not change the impact",
            ),
            optional(
                "external",
                Kind::Tables(&EXTERNAL, 16),
                "Your own programs that solve the scene too; they run only with --allow-external",
            ),
        ]);
        Self { dialects, keys: keys.leak() }
    }

    /// The kind called `name`.
    pub(crate) fn dialect(&self, name: &str) -> Option<&Dialect> {
        self.dialects.iter().find(|dialect| dialect.name == name)
    }

    /// `root` with the name of the kind that it is read as, see [`Language::alias`].
    pub(crate) fn resolved<'a, 'r>(&self, root: &'r DeTable<'a>) -> Cow<'r, DeTable<'a>> {
        let Some((key, value)) = root.get_key_value("kind") else { return Cow::Borrowed(root) };
        let dialect = value.get_ref().as_str().and_then(|name| self.dialect(name));
        let alias = dialect.and_then(|dialect| dialect.language.alias());
        let Some(alias) = alias.filter(|alias| alias.is_meant(root)) else { return Cow::Borrowed(root) };
        let mut resolved = root.clone();
        let kind = DeValue::String(alias.kind.into());
        resolved.insert(key.clone(), Spanned::new(value.span(), kind));
        Cow::Owned(resolved)
    }

    /// The SI unit of the quantity at `path` in a scene's JSON form, such as `plate.material.density`.
    pub(crate) fn unit_of(&self, path: &str) -> Option<&'static str> {
        // two things have another name in JSON than in the file
        let path = path.replace("seat.notch.", "seat.notch_").replace("intended_angle", "intended.angle");
        unit_below(self.keys, &path)
    }
}

static RUN: [Field; 1] = [optional(
    "end_time",
    positive(Dimension::TIME),
    "End time after the first contact; absent = until no further contact is possible",
)];

fn unit_below(fields: &[Field], path: &str) -> Option<&'static str> {
    let (key, rest) = path.split_once('.').map_or((path, None), |(key, rest)| (key, Some(rest)));
    // a key may stand here several times, once per kind of the scene
    fields.iter().filter(|f| f.key == key).find_map(|field| match (&field.kind, rest) {
        (Kind::Table(inner), Some(rest)) => unit_below(inner, rest),
        // in JSON a material stands where it is used
        (Kind::Material, Some(rest)) => unit_below(&MATERIAL, rest),
        (Kind::Named(Field { kind: Kind::Material, .. }), Some(rest)) => {
            unit_below(&MATERIAL, rest.split_once('.')?.1)
        }
        (Kind::Quantity(dimension, _) | Kind::Quantities(dimension, ..), None) => {
            Some(dimension.describe().1)
        }
        _ => None,
    })
}

impl std::fmt::Debug for Grammar {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.dialects.iter().map(|dialect| dialect.name)).finish()
    }
}
