//! `[[external]]`: programs of the user's that solve the scene too.

use super::check::Checker;
use super::grammar::{Field, Kind, MODELS, optional, positive, required};
use super::place::Place;
use super::quantity::Dimension;
use super::values::Node;
use crate::Result;
use serde::Serialize;
use toml::de::DeTable;

/// Most words of a command.
const MOST_WORDS: usize = 64;
/// Time limit in s of a program whose scene states none.
const DEFAULT_TIMEOUT: f64 = 60.0;
/// Names, besides those of reduced models, that mean something else among models.
const TAKEN: [&str; 3] = ["auto", "external", "reference"];

/// A program that is a model of the scene: it reads the scene as JSON and answers with a result.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct External {
    /// The model's name in results, reports and tolerances.
    pub name: String,
    /// The program and its arguments; never a shell's line.
    pub command: Vec<String>,
    /// Time in s after which the program is ended.
    pub timeout: f64,
}

/// The keys of one entry.
pub(super) static EXTERNAL: [Field; 3] = [
    required("name", Kind::Name, "Name of the model in results, reports and [tolerances.<name>]"),
    required(
        "command",
        Kind::Texts(MOST_WORDS),
        "The program and its arguments, run in the scene file's folder and only with --allow-external",
    ),
    optional("timeout", positive(Dimension::TIME), "Time after which the program is ended; absent = 60 s"),
];

/// The entry that checked values describe.
pub(super) fn external(node: &Node) -> Result<External> {
    Ok(External {
        name: node.text("name")?.to_owned(),
        command: node.texts("command")?,
        timeout: node.number_or("timeout", DEFAULT_TIMEOUT)?,
    })
}

impl Checker<'_> {
    /// The names that the scene's programs have, noting every one that something else has already.
    pub(super) fn external_names(&mut self, root: &DeTable) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        let entries = root.get("external").and_then(|list| list.get_ref().as_array());
        for value in entries.into_iter().flatten().filter_map(|entry| entry.get_ref().get("name")) {
            let Some(name) = value.get_ref().as_str() else { continue };
            let is_taken = |taken: &str| taken.eq_ignore_ascii_case(name);
            let of_models = MODELS.iter().map(|model| model.name).chain(TAKEN);
            if of_models.into_iter().any(is_taken) || names.iter().any(|other| is_taken(other)) {
                let place = Place { path: "external.name", span: value.span() };
                let help = format!(
                    "every model needs a name of its own, which is not {} or {}",
                    MODELS.map(|model| model.name).join(", "),
                    TAKEN.join(", ")
                );
                self.fault::<()>(&place, value, "which is taken", "taken", help);
            }
            names.push(name.to_owned());
        }
        names
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;

    const SCENE: &str = include_str!("../../../tests/fixtures/plate-impact.toml");

    fn with(text: &str) -> crate::Result<Scene> {
        Scene::parse("scene.toml", &format!("{SCENE}\n{text}"))
    }

    #[test]
    fn a_program_is_no_part_of_the_physics_and_has_tolerances_under_its_name() {
        let text = "[[external]]\nname = \"mine\"\ncommand = [\"python3\", \"my model.py\"]\n[tolerances.mine]\nefficiency = 0.1";
        let scene = with(text).expect("valid");
        assert_eq!(scene.hash(), with("").expect("valid").hash());
        let [mine] = &scene.external[..] else { panic!("one program: {:?}", scene.external) };
        assert_eq!((&*mine.name, mine.timeout), ("mine", 60.0));
        assert_eq!(mine.command, ["python3", "my model.py"]);
        assert!(scene.tolerances["mine"].contains_key("efficiency"));
        let json = |scene: &Scene| serde_json::to_value(scene).expect("JSON");
        assert!(
            json(&scene).get("external").is_some()
                && json(&with("").expect("valid")).get("external").is_none()
        );
    }

    #[test]
    fn what_is_no_program_is_refused_with_what_would_be() {
        let entry = |name: &str| format!("[[external]]\nname = \"{name}\"\ncommand = [\"true\"]\n");
        for (text, part) in [
            (entry("b"), "which is taken"),
            (entry("reference"), "which is taken"),
            (entry("mine") + &entry("Mine"), "which is taken"),
            (entry("../mine"), "can't be a name"),
            (entry("-rf"), "can't be a name"),
            (entry("mine") + "[tolerances.yours]\nefficiency = 0.1", "there are A, B, C, mine"),
            (entry("mine").replace("[\"true\"]", "\"true\""), "but it must be a list"),
            (entry("mine").replace("\"true\"", "\"\""), "1 to 64 texts, the first not empty"),
            (entry("mine") + "timeout = \"0 s\"", "greater than 0 s"),
            ("[[external]]\nname = \"mine\"".into(), "`external[1].command` is missing"),
        ] {
            let crate::Error::Scene(report) = with(&text).expect_err(part) else { panic!("{part}") };
            let said =
                format!("{report:?}").replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(said.contains(part), "{said}");
        }
    }
}
