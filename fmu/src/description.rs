//! `modelDescription.xml`: what a simulation reads of a unit before it loads it.

use crate::instance::CATEGORIES;
use crate::variables::{Output, Role, Type, UnitVariable};
use impactcheck_physics::scene::{Dimension, dimension_of};
use std::collections::BTreeSet;
use std::fmt::Write;

/// A version of the standard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

impl Version {
    /// As the standard numbers it.
    pub fn number(self) -> &'static str {
        match self {
            Version::Two => "2.0",
            Version::Three => "3.0",
        }
    }
}

/// What a unit is called.
#[derive(Debug, Clone)]
pub struct Identity<'a> {
    /// Name for people.
    pub name: &'a str,
    /// Name of the binary's file: letters, digits and underscores.
    pub identifier: &'a str,
    /// One line for people.
    pub description: &'a str,
    /// What tells it from others.
    pub token: &'a str,
    /// The program that wrote it.
    pub tool: &'a str,
    /// Time in s within which the impact of the start values is over.
    pub stop: f64,
}

/// Steps of the default experiment.
const STEPS: f64 = 1000.0;

/// The document of a unit with these `variables`.
pub fn model_description(version: Version, of: &Identity, variables: &[UnitVariable]) -> String {
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let [token, state] = match version {
        Version::Two => ["guid", "FMUstate"],
        Version::Three => ["instantiationToken", "FMUState"],
    };
    let head = attributes(&[
        ("fmiVersion", version.number().into()),
        ("modelName", of.name.into()),
        (token, of.token.into()),
        ("description", of.description.into()),
        ("generationTool", of.tool.into()),
    ]);
    let _ = writeln!(xml, "<fmiModelDescription{head}>");
    let yes = || "true".to_owned();
    let mut abilities = vec![
        ("modelIdentifier", of.identifier.to_owned()),
        ("canHandleVariableCommunicationStepSize", yes()),
    ];
    let [get_and_set, serialize] = [format!("canGetAndSet{state}"), format!("canSerialize{state}")];
    abilities.extend([(get_and_set.as_str(), yes()), (serialize.as_str(), yes())]);
    match version {
        Version::Two => abilities.push(("canNotUseMemoryManagementFunctions", yes())),
        Version::Three => abilities.push(("mightReturnEarlyFromDoStep", yes())),
    }
    let _ = writeln!(xml, "  <CoSimulation{}/>", attributes(&abilities));
    units(&mut xml, variables);
    xml.push_str("  <LogCategories>\n");
    for (name, description) in CATEGORIES {
        let of = attributes(&[("name", name.into()), ("description", description.into())]);
        let _ = writeln!(xml, "    <Category{of}/>");
    }
    xml.push_str("  </LogCategories>\n");
    let experiment = attributes(&[
        ("startTime", "0".into()),
        ("stopTime", number(of.stop)),
        ("stepSize", format!("{:.3e}", of.stop / STEPS)),
    ]);
    let _ = writeln!(xml, "  <DefaultExperiment{experiment}/>\n  <ModelVariables>");
    for (reference, variable) in variables.iter().enumerate() {
        variable_element(&mut xml, version, reference, variable);
    }
    xml.push_str("  </ModelVariables>\n  <ModelStructure>\n");
    structure(&mut xml, version, variables);
    xml.push_str("  </ModelStructure>\n</fmiModelDescription>\n");
    xml
}

/// Definitions of the units that occur.
fn units(xml: &mut String, variables: &[UnitVariable]) {
    let names: BTreeSet<&str> = variables.iter().map(|variable| variable.unit).collect();
    xml.push_str("  <UnitDefinitions>\n");
    for name in names.into_iter().filter(|name| *name != "1") {
        let bases = dimension_of(name).into_iter().flat_map(Dimension::bases);
        let bases: Vec<_> = bases.map(|(base, exponent)| (base, exponent.to_string())).collect();
        let name = attributes(&[("name", name.into())]);
        let _ = writeln!(xml, "    <Unit{name}><BaseUnit{}/></Unit>", attributes(&bases));
    }
    xml.push_str("  </UnitDefinitions>\n");
}

/// Causality and variability.
fn nature(variable: &UnitVariable) -> [&'static str; 2] {
    match (&variable.role, variable.kind) {
        (Role::Time, _) => ["independent", "continuous"],
        (Role::Field(_), _) => ["parameter", "tunable"],
        (Role::Voltage(_), _) => ["input", "continuous"],
        (Role::Arm | Role::Launch, _) => ["input", "discrete"],
        (Role::Output(Output::Curve(_) | Output::Impulse(_)), _) => ["output", "continuous"],
        (Role::Output(_), _) => ["output", "discrete"],
    }
}

/// What is stated of the values: unit, bounds, start.
fn values(variable: &UnitVariable) -> Vec<(&'static str, String)> {
    let mut stated = Vec::new();
    if variable.unit != "1" && variable.kind == Type::Real {
        stated.push(("unit", variable.unit.to_owned()));
    }
    if let Role::Field(field) = &variable.role {
        let [low, high] = field.limits();
        // a kind of field that admits 0 below its least number has this one in its file
        stated.extend(
            [("min", low.min(variable.start)), ("max", high)].map(|(k, v)| (k, typed(variable.kind, v))),
        );
    }
    if matches!(variable.role, Role::Field(_) | Role::Voltage(_) | Role::Arm | Role::Launch) {
        stated.push(("start", typed(variable.kind, variable.start)));
    }
    stated
}

/// A value as its type is written.
fn typed(kind: Type, value: f64) -> String {
    match kind {
        Type::Real => number(value),
        Type::Integer => (value as i32).to_string(),
        Type::Boolean => (value != 0.0).to_string(),
    }
}

/// A number, with an exponent where it is very large or small.
fn number(value: f64) -> String {
    format!("{value:?}")
}

fn variable_element(xml: &mut String, version: Version, reference: usize, variable: &UnitVariable) {
    let element = match (version, variable.kind) {
        (Version::Two, Type::Real) => "Real",
        (Version::Two, Type::Integer) => "Integer",
        (Version::Three, Type::Real) => "Float64",
        (Version::Three, Type::Integer) => "Int32",
        (_, Type::Boolean) => "Boolean",
    };
    let [causality, variability] = nature(variable);
    let of = attributes(&[
        ("name", variable.name.clone()),
        ("valueReference", reference.to_string()),
        ("description", variable.description.clone()),
        ("causality", causality.into()),
        ("variability", variability.into()),
    ]);
    let values = attributes(&values(variable));
    let _ = match version {
        Version::Two => writeln!(xml, "    <ScalarVariable{of}><{element}{values}/></ScalarVariable>"),
        Version::Three => writeln!(xml, "    <{element}{of}{values}/>"),
    };
}

/// Outputs depend on nothing at a communication point.
fn structure(xml: &mut String, version: Version, variables: &[UnitVariable]) {
    let outputs = || variables.iter().enumerate().filter(|(_, variable)| variable.is_output());
    let none = || ("dependencies", String::new());
    match version {
        Version::Two => {
            for list in ["Outputs", "InitialUnknowns"] {
                let _ = writeln!(xml, "    <{list}>");
                for (reference, _) in outputs() {
                    let of = attributes(&[("index", (reference + 1).to_string()), none()]);
                    let _ = writeln!(xml, "      <Unknown{of}/>");
                }
                let _ = writeln!(xml, "    </{list}>");
            }
        }
        Version::Three => {
            for element in ["Output", "InitialUnknown"] {
                for (reference, _) in outputs() {
                    let of = attributes(&[("valueReference", reference.to_string()), none()]);
                    let _ = writeln!(xml, "    <{element}{of}/>");
                }
            }
        }
    }
}

/// Attributes of an element, with a space before each.
fn attributes(list: &[(&str, String)]) -> String {
    list.iter().fold(String::new(), |mut text, (name, value)| {
        let _ = write!(text, " {name}=\"{}\"", escaped(value));
        text
    })
}

/// `text` as an attribute has it; what XML forbids is a space.
fn escaped(text: &str) -> String {
    let plain = text.replace(|c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}'), " ");
    plain.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::variables::variables;
    use impactcheck_physics::scene::Template;

    /// No unit of a shipped scene lacks its definition.
    #[test]
    fn every_unit_is_defined() {
        let mut scenes = 0;
        for folder in ["../scenes", "../scenes/examples", "../scenes/validation"] {
            for file in
                std::fs::read_dir(folder).expect("scenes").map(|entry| entry.expect("an entry").path())
            {
                if file.extension().is_none_or(|kind| kind != "toml") {
                    continue;
                }
                let template = Template::read(&file).expect("a scene");
                for variable in variables(&template) {
                    let unit = variable.unit;
                    assert!(dimension_of(unit).is_some(), "{unit} of {}", variable.name);
                }
                scenes += 1;
            }
        }
        assert!(scenes > 20);
    }
}
