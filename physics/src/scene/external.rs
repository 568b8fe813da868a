//! `[[external]]`: programs and units of the user's that solve the scene too.

use super::check::Checker;
use super::grammar::{Choice, Field, Kind, MODELS, choice, one_way, optional, positive, required};
use super::place::Place;
use super::quantity::Dimension;
use super::values::{Checked, Node, Values};
use crate::{Error, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toml::de::DeTable;

/// Most words of a command.
const MOST_WORDS: usize = 64;
/// Names, besides those of reduced models, that mean something else among models.
const TAKEN: [&str; 3] = ["auto", "external", "reference"];

/// A program or a unit that is a model of the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct External {
    /// The model's name in results, reports and tolerances.
    pub name: String,
    /// What runs.
    #[serde(flatten)]
    pub program: ExternalProgram,
    /// Time in s after which the program is ended.
    pub timeout: f64,
}

/// What solves the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ExternalProgram {
    /// A program that reads the scene as JSON and answers with a result.
    Command {
        /// The program and its arguments; never a shell's line.
        command: Vec<String>,
    },
    /// A Functional Mock-up Unit.
    Unit {
        /// Its file.
        fmu: String,
        /// Its variables by the quantities and curves of the scene that they are.
        variables: BTreeMap<String, String>,
        /// What its variables are at the start, by their names.
        start: BTreeMap<String, StartValue>,
        /// Which of its interfaces runs; `None` = co-simulation if it has that.
        interface: Option<UnitInterface>,
    },
}

/// An interface of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UnitInterface {
    /// The unit integrates.
    CoSimulation,
    /// FMPy integrates the unit's equations (CVODE), and stops at its events.
    ModelExchange,
}

/// Names of the interfaces.
static INTERFACES: [Choice; 2] = [choice("co-simulation"), choice("model-exchange")];

/// What a variable of a unit is at the start.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum StartValue {
    /// This number, in the variable's own unit.
    Number(f64),
    /// True or false.
    Flag(bool),
    /// The number of the scene at this path, SI.
    Path(String),
}

impl ExternalProgram {
    /// What runs, as messages show it.
    pub fn in_words(&self) -> String {
        match self {
            ExternalProgram::Command { command } => format!("program `{}`", command.join(" ")),
            ExternalProgram::Unit { fmu, .. } => format!("unit `{fmu}`"),
        }
    }
}

/// What the keys of a program and those of a unit say.
const WHAT: &str = "what runs";
/// Name of a variable of a unit.
static VARIABLE: Field = required("name", Kind::Text, "Name of the unit's variable");
/// Value of a variable of a unit.
static START: Field = required("value", Kind::Start, "Value of the unit's variable at the start");

/// The keys of one entry.
pub(super) static EXTERNAL: [Field; 7] = [
    required("name", Kind::Name, "Name of the model in results, reports and [tolerances.<name>]"),
    one_way(
        None,
        WHAT,
        "program",
        required(
            "command",
            Kind::Texts(MOST_WORDS),
            "The program and its arguments, run in the scene file's folder and only with --allow-external",
        ),
    ),
    one_way(
        None,
        WHAT,
        "unit",
        required(
            "fmu",
            Kind::Text,
            "File of a Functional Mock-up Unit, run with FMPy and only with --allow-external",
        ),
    ),
    one_way(
        None,
        WHAT,
        "unit",
        required(
            "variables",
            Kind::Named(&VARIABLE),
            "The unit's variables by the scene's curves and quantities that they are",
        ),
    ),
    optional(
        "start",
        Kind::Named(&START),
        "Values of the unit's variables at the start: numbers, true or false, or paths of numbers of the scene",
    ),
    optional(
        "interface",
        Kind::Choice(&INTERFACES),
        "Interface of the unit that runs; absent = co-simulation if it has that",
    ),
    optional("timeout", positive(Dimension::TIME), "Time after which the program is ended").otherwise("60 s"),
];

/// The entry that checked values describe.
pub(super) fn external(node: &Node) -> Result<External> {
    let program = match node.has("fmu") {
        true => ExternalProgram::Unit {
            fmu: node.text("fmu")?.to_owned(),
            variables: entries(node, "variables", |value| match value {
                Checked::Text(name) => Some(name.clone()),
                _ => None,
            })?,
            start: entries(node, "start", |value| match value {
                Checked::Number(number) => Some(StartValue::Number(*number)),
                Checked::Flag(flag) => Some(StartValue::Flag(*flag)),
                Checked::Text(path) => Some(StartValue::Path(path.clone())),
                _ => None,
            })?,
            interface: node.optional_word("interface")?,
        },
        false => ExternalProgram::Command { command: node.texts("command")? },
    };
    Ok(External { name: node.text("name")?.to_owned(), program, timeout: node.number("timeout")? })
}

/// The entries of the table `key` of `node`; none if there is no such table.
fn entries<T>(node: &Node, key: &str, of: impl Fn(&Checked) -> Option<T>) -> Result<BTreeMap<String, T>> {
    let none = Values::new();
    let table = node.optional_table(key)?.map_or(&none, |table| table.values);
    let entry = |(name, value): (&String, &Checked)| {
        let value = of(value).ok_or_else(|| Error::Internal(format!("`{key}.{name}` was not checked")))?;
        Ok((name.clone(), value))
    };
    table.iter().map(entry).collect()
}

impl Checker<'_> {
    /// The names that the scene's programs have, noting every one that something else has already.
    pub(super) fn external_names(&mut self, root: &DeTable) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        let entries =
            || root.get("external").and_then(|list| list.get_ref().as_array()).into_iter().flatten();
        for entry in entries().filter_map(|entry| entry.get_ref().as_table()) {
            let of_units = ["start", "interface"].into_iter().filter(|_| !entry.contains_key("fmu"));
            for (key, value) in of_units.filter_map(|key| entry.get_key_value(key)) {
                let path = format!("external.{}", key.get_ref());
                let place = Place { path: &path, span: key.span() };
                let help = "remove it, or name a unit with `fmu`".to_owned();
                self.fault::<()>(&place, value, "but only a unit has it", "of a unit", help);
            }
        }
        for value in entries().filter_map(|entry| entry.get_ref().get("name")) {
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
    use super::*;
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
        let command = ["python3", "my model.py"].map(String::from).to_vec();
        assert_eq!(mine.program, ExternalProgram::Command { command });
        assert!(scene.tolerances["mine"].contains_key("efficiency"));
        let json = |scene: &Scene| serde_json::to_value(scene).expect("JSON");
        assert!(
            json(&scene).get("external").is_some()
                && json(&with("").expect("valid")).get("external").is_none()
        );
    }

    #[test]
    fn a_unit_has_a_map_and_start_values() {
        let text = "[[external]]\nname = \"theirs\"\nfmu = \"their.fmu\"\nstart = { go = true, v = \"outer.speed\", e = 1 }\n[external.variables]\nouter_velocity = \"ball.v\"";
        let scene = with(text).expect("valid");
        let [External { program: ExternalProgram::Unit { fmu, variables, start, interface: None }, .. }] =
            &scene.external[..]
        else {
            panic!("one unit: {:?}", scene.external)
        };
        assert_eq!((fmu.as_str(), variables["outer_velocity"].as_str()), ("their.fmu", "ball.v"));
        let values =
            [StartValue::Number(1.0), StartValue::Flag(true), StartValue::Path("outer.speed".into())];
        assert!(start.values().eq(&values), "{start:?}");
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
            (entry("mine") + "interface = \"co-simulation\"", "only a unit has it"),
            ("[[external]]\nname = \"mine\"".into(), "what runs is missing"),
            (entry("mine") + "fmu = \"a.fmu\"\nvariables = { efficiency = \"e\" }", "both give what runs"),
            (entry("mine").replace("command = [\"true\"]", "fmu = \"a.fmu\""), "variables"),
            (entry("mine").replace("command = [\"true\"]", "fmu = \"a.fmu\"\nvariables = {}"), "no entry"),
        ] {
            let crate::Error::Scene(report) = with(&text).expect_err(part) else { panic!("{part}") };
            let said =
                format!("{report:?}").replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(said.contains(part), "{said}");
        }
    }
}
