//! `modelDescription.xml`: what a simulation reads of a unit before it loads it.

use crate::instance::CATEGORIES;
use crate::variables::{Output, Role, Type, UnitVariable};
use std::fmt::Write;

/// A version of the standard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
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

/// SI units of variables: name and exponents of kg, m, s, A, rad.
const UNITS: [(&str, [i32; 5]); 26] = [
    ("m", [0, 1, 0, 0, 0]),
    ("m^2", [0, 2, 0, 0, 0]),
    ("kg", [1, 0, 0, 0, 0]),
    ("s", [0, 0, 1, 0, 0]),
    ("m/s", [0, 1, -1, 0, 0]),
    ("m/s^2", [0, 1, -2, 0, 0]),
    ("Pa", [1, -1, -2, 0, 0]),
    ("Pa*s", [1, -1, -1, 0, 0]),
    ("kg/m^3", [1, -3, 0, 0, 0]),
    ("kg/m", [1, -1, 0, 0, 0]),
    ("kg*m^2", [1, 2, 0, 0, 0]),
    ("N", [1, 1, -2, 0, 0]),
    ("N*s", [1, 1, -1, 0, 0]),
    ("N*m", [1, 2, -2, 0, 0]),
    ("N*m^2", [1, 3, -2, 0, 0]),
    ("N/m", [1, 0, -2, 0, 0]),
    ("Hz", [0, 0, -1, 0, 0]),
    ("rad", [0, 0, 0, 0, 1]),
    ("rad/s", [0, 0, -1, 0, 1]),
    ("V", [1, 2, -3, -1, 0]),
    ("F", [-1, -2, 4, 2, 0]),
    ("Ohm", [1, 2, -3, -2, 0]),
    ("H", [1, 2, -2, -2, 0]),
    ("J", [1, 2, -2, 0, 0]),
    ("W", [1, 2, -3, 0, 0]),
    ("A", [0, 0, 0, 1, 0]),
];
const BASES: [&str; 5] = ["kg", "m", "s", "A", "rad"];
/// Steps of the default experiment.
const STEPS: f64 = 1000.0;

/// The document of a unit with these `variables`.
pub fn model_description(version: Version, of: &Identity, variables: &[UnitVariable]) -> String {
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let [standard, token, state] = match version {
        Version::Two => ["2.0", "guid", "FMUstate"],
        Version::Three => ["3.0", "instantiationToken", "FMUState"],
    };
    let head = attributes(&[
        ("fmiVersion", standard.into()),
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
        match version {
            Version::Two => variable_of_2(&mut xml, reference, variable),
            Version::Three => variable_of_3(&mut xml, reference, variable),
        }
    }
    xml.push_str("  </ModelVariables>\n  <ModelStructure>\n");
    structure(&mut xml, version, variables);
    xml.push_str("  </ModelStructure>\n</fmiModelDescription>\n");
    xml
}

/// Definitions of the units that occur.
fn units(xml: &mut String, variables: &[UnitVariable]) {
    xml.push_str("  <UnitDefinitions>\n");
    for (name, exponents) in UNITS.iter().filter(|(name, _)| variables.iter().any(|v| v.unit == *name)) {
        let bases: Vec<(&str, String)> =
            BASES.iter().zip(exponents).filter(|(_, e)| **e != 0).map(|(b, e)| (*b, e.to_string())).collect();
        let name = attributes(&[("name", (*name).into())]);
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

fn variable_of_3(xml: &mut String, reference: usize, variable: &UnitVariable) {
    let element = match variable.kind {
        Type::Real => "Float64",
        Type::Integer => "Int32",
        Type::Boolean => "Boolean",
    };
    let [causality, variability] = nature(variable);
    let mut of = vec![
        ("name", variable.name.clone()),
        ("valueReference", reference.to_string()),
        ("causality", causality.into()),
        ("variability", variability.into()),
        ("description", variable.description.clone()),
    ];
    of.extend(values(variable));
    let _ = writeln!(xml, "    <{element}{}/>", attributes(&of));
}

fn variable_of_2(xml: &mut String, reference: usize, variable: &UnitVariable) {
    let element = match variable.kind {
        Type::Real => "Real",
        Type::Integer => "Integer",
        Type::Boolean => "Boolean",
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
    let _ = writeln!(xml, "    <ScalarVariable{of}><{element}{values}/></ScalarVariable>");
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
                    let known = variable.unit == "1" || UNITS.iter().any(|(name, _)| *name == variable.unit);
                    assert!(known, "{} of {}", variable.unit, variable.name);
                }
                scenes += 1;
            }
        }
        assert!(scenes > 20);
    }
}
