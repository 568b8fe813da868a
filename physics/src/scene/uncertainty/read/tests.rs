use crate::Error;
use crate::kinds::schema;
use crate::scene::{Distribution, Scene, Spread, Template, Uncertainty, faults};

const BASE: &str = include_str!("../../../../../scenes/scaled-plate-r10.toml");

fn with(table: &str) -> String {
    format!("{BASE}\n[uncertainty]\n{table}\n")
}

fn read(table: &str) -> Uncertainty {
    let scene = Scene::parse("scene.toml", &with(table)).expect(table);
    scene.uncertainty.expect("a table")
}

/// Message and help of the only fault, and its line in the table.
fn refused(table: &str) -> (String, usize) {
    let Err(Error::Scene(report)) = Scene::parse("scene.toml", &with(table)) else {
        panic!("{table} is taken")
    };
    let all = faults(&report);
    assert_eq!(all.len(), 1, "{table}: {all:?}");
    let line = all[0].line - BASE.lines().count() - 2;
    (format!("{}; {}", all[0].message, all[0].help.clone().unwrap_or_default()), line)
}

#[test]
fn every_form_is_read_in_si() {
    let found = read(
        "\"plate.thickness\" = \"1 %\"\nplate.radius = { normal = \"20 um\" }\n\"outer.speed\" = { uniform = [\"540 mm/s\", 0.56] }\n\
        materials.steel.youngs_modulus = { lognormal = \"5 %\" }",
    );
    let of = |field: &str| found.inputs.iter().find(|input| input.field == field).expect(field);
    assert_eq!(of("plate.thickness").distribution, Distribution::Normal(Spread::Relative(0.01)));
    assert_eq!((of("plate.thickness").nominal, of("plate.thickness").unit), (2e-3, "m"));
    assert_eq!(of("plate.radius").distribution, Distribution::Normal(Spread::Absolute(20e-6)));
    assert_eq!(of("outer.speed").distribution, Distribution::Uniform { low: 0.54, high: 0.56 });
    let modulus = of("materials.steel.youngs_modulus");
    assert_eq!(modulus.distribution, Distribution::Lognormal(Spread::Relative(0.05)));
    assert_eq!(modulus.standard_deviation(), 0.05 * 210e9);
}

#[test]
fn correlations_are_of_two_inputs_of_the_table() {
    let inputs = "\"plate.thickness\" = \"1 %\"\n\"plate.radius\" = \"1 %\"\n\"outer.speed\" = \"1 %\"\n";
    let correlation = |pairs: &str| format!("{inputs}correlations = [{pairs}]");
    let found =
        read(&correlation("{ between = [\"plate.radius\", \"plate.thickness\"], coefficient = -0.5 }"));
    let names = found.correlations[0].between.map(|at| &*found.inputs[at].field);
    assert_eq!((names, found.correlations[0].coefficient), (["plate.radius", "plate.thickness"], -0.5));
    for (pairs, part) in [
        (
            "{ between = [\"plate.radius\", \"inner.radius\"], coefficient = 0.5 }",
            "no pair of uncertain inputs",
        ),
        (
            "{ between = [\"plate.radius\", \"plate.radius\"], coefficient = 0.5 }",
            "no pair of uncertain inputs",
        ),
        ("{ between = [\"plate.radius\", \"plate.thickness\"], coefficient = 1.5 }", "at most 1"),
        (
            "{ between = [\"plate.radius\", \"plate.thickness\"] }",
            "`uncertainty.correlations[1].coefficient` is missing",
        ),
        (
            "{ between = [\"plate.radius\", \"plate.thickness\"], coefficient = 1.0 }, \
            { between = [\"plate.radius\", \"outer.speed\"], coefficient = 1.0 }, \
            { between = [\"plate.thickness\", \"outer.speed\"], coefficient = -1.0 }",
            "contradict each other",
        ),
    ] {
        let (said, line) = refused(&correlation(pairs));
        assert!(said.contains(part) && line == 4, "{said}, line {line}");
    }
}

#[test]
fn an_invalid_distribution_is_reported_with_its_place() {
    for (table, parts) in [
        (
            "\n\"plate.thicknes\" = \"1 %\"",
            ["`uncertainty.plate.thicknes`", "did you mean `plate.thickness`?"],
        ),
        ("\nplate.thicknes = \"1 %\"", ["`uncertainty.plate.thicknes`", "did you mean `plate.thickness`?"]),
        ("\n\"plate.thickness\" = \"20 um\"", ["is \"20 um\"", "{ normal = \"20 um\" }"]),
        ("\n\"plate.thickness\" = 0.01", ["is 0.01", "must be a percentage or a distribution"]),
        ("\n\"plate.thickness\" = { normal = \"20 g\" }", ["`g` is not the unit of a length", "m is needed"]),
        ("\n\"plate.thickness\" = { normal = \"-1 %\" }", ["-1 %", "greater than 0"]),
        ("\n\"plate.thickness\" = \"0 %\"", ["0 %", "greater than 0"]),
        ("\n\"plate.thickness\" = { gaussian = \"1 %\" }", ["one distribution", "{ normal = \"20 um\" }"]),
        ("\n\"plate.thickness\" = { norml = \"1 %\" }", ["one distribution", "did you mean `normal`?"]),
        (
            "\n\"plate.thickness\" = { normal = \"1 %\", uniform = [1, 2] }",
            ["one distribution", "`uncertainty.plate.thickness`"],
        ),
        ("\n\"plate.thickness\" = { uniform = [\"2.1 mm\", \"1.9 mm\"] }", ["lower one first", "2.1 mm"]),
        ("\n\"plate.thickness\" = { uniform = [\"1.9 mm\"] }", ["two bounds", "1.9 mm"]),
        (
            "\n\"plate.thickness\" = { uniform = [\"2.1 mm\", \"2.2 mm\"] }",
            ["does not contain the nominal value 0.002 m", "must enclose"],
        ),
        (
            "\n\"inner.gap\" = { normal = \"1 um\" }",
            ["no nominal value `inner.gap`", "`gap = ...` under `[inner]`"],
        ),
        ("\n\"reduced.modes\" = \"1 %\"", ["takes whole numbers", "leave it out"]),
        (
            "\n\"reference.elements_per_contact_radius\" = \"1 %\"",
            ["only the reference uses it", "leave it out"],
        ),
        ("", ["names no input", "\"plate.thickness\" = \"1 %\""]),
    ] {
        let (said, line) = refused(table);
        for part in parts {
            assert!(said.contains(part), "{table}: {said}");
        }
        assert_eq!(line, if table.is_empty() { 0 } else { 2 }, "{table}: {said}");
    }
}

#[test]
fn a_distribution_that_reaches_out_of_bounds_is_refused() {
    for (table, part) in [
        (
            "\"plate.thickness\" = \"25 %\"",
            "reaches too far: `plate.thickness` is -0.0005 m, but it must be greater than 0 m",
        ),
        (
            "\"plate.thickness\" = { uniform = [\"-1 um\", \"3 mm\"] }",
            "reaches too far: `plate.thickness` is -0.000001 m",
        ),
        ("\"materials.steel.poisson_ratio\" = { lognormal = \"20 %\" }", "less than 0.5"),
    ] {
        let (said, _) = refused(table);
        assert!(said.contains(part), "{said}");
    }
    read("\"plate.thickness\" = \"19 %\"\n\"outer.speed\" = { lognormal = \"60 %\" }");
}

#[test]
fn a_scene_that_is_uncertain_is_the_same_scene() {
    let plain = Scene::parse("scene.toml", BASE).expect("shipped scene");
    let uncertain = Scene::parse("scene.toml", &with("\"plate.thickness\" = \"1 %\"")).expect("scene");
    assert_eq!(uncertain.hash(), plain.hash());
    assert_eq!(serde_json::to_string(&uncertain).unwrap(), serde_json::to_string(&plain).unwrap());
    let template = Template::parse("scene.toml", &with("\"plate.thickness\" = \"1 %\"")).expect("scene");
    assert_eq!(template.with(&[]).expect("valid"), plain);
}

#[test]
fn a_written_scene_keeps_its_distributions_about_the_new_numbers() {
    for table in [
        "plate.thickness = { uniform = [\"1.9 mm\", \"2.2 mm\"] }",
        "\"plate.thickness\" = { uniform = [\"1.9 mm\", \"2.2 mm\"] }",
    ] {
        let template = Template::parse("scene.toml", &with(table)).expect("scene");
        let thickness = template.field("plate.thickness").expect("there");
        let text = template.text_with("thicker", &[(&thickness, 3e-3)]).expect("text");
        let written = Scene::parse("written", &text).expect("valid").uncertainty.expect("kept");
        assert_eq!(written.inputs.len(), 1);
        let [low, high] = written.inputs[0].range();
        assert!((low - 2.9e-3).abs() < 1e-12 && (high - 3.2e-3).abs() < 1e-12, "{text}");
    }
}

#[test]
fn the_schema_knows_the_table() {
    // several kinds have it, each in its rule
    let schema = schema();
    let rules = schema["allOf"].as_array().expect("rules");
    let of_kind = |rule: &serde_json::Value| rule["then"]["properties"]["uncertainty"].clone();
    let table =
        &rules.iter().map(of_kind).find(|table| table["properties"].is_object()).expect("a kind has it");
    assert!(table["properties"]["correlations"].is_object(), "{table}");
    assert_eq!(table["additionalProperties"]["anyOf"].as_array().map(Vec::len), Some(5), "{table}");
}
