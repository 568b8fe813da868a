//! The JSON schema for editors: it accepts the shipped scenes and refuses what the reader refuses.

use impactcheck::kinds::schema;
use impactcheck::scene::{Scene, shipped};
use regex::Regex;
use serde_json::{Map, Value, json};

/// Whether `schema` accepts `value`: the keywords of draft 2020-12 that the schema uses. A keyword it does not know fails
/// the test.
fn accepts(schema: &Value, value: &Value) -> bool {
    if let Some(flag) = schema.as_bool() {
        return flag;
    }
    let schema = schema.as_object().expect("a schema is an object or a boolean");
    schema.iter().all(|(keyword, rule)| accepts_keyword(schema, keyword, rule, value))
}

fn accepts_keyword(schema: &Map<String, Value>, keyword: &str, rule: &Value, value: &Value) -> bool {
    let all = |rule: &Value| rule.as_array().expect("array").clone();
    let number = |check: fn(f64, f64) -> bool| {
        value.as_f64().is_none_or(|v| check(v, rule.as_f64().expect("numeric bound")))
    };
    match keyword {
        "$schema" | "title" | "description" | "examples" | "then" => true,
        "type" => match rule.as_str().expect("type") {
            "object" => value.is_object(),
            "string" => value.is_string(),
            "array" => value.is_array(),
            "boolean" => value.is_boolean(),
            "number" => value.is_number(),
            "integer" => value.is_u64() || value.is_i64(),
            other => panic!("unknown type {other}"),
        },
        "pattern" => value.as_str().is_none_or(|text| {
            Regex::new(rule.as_str().expect("pattern")).expect("a regular expression").is_match(text)
        }),
        "const" => value == rule,
        "enum" => all(rule).contains(value),
        "minimum" => number(|v, bound| v >= bound),
        "maximum" => number(|v, bound| v <= bound),
        "exclusiveMinimum" => number(|v, bound| v > bound),
        "exclusiveMaximum" => number(|v, bound| v < bound),
        "items" => value.as_array().is_none_or(|items| items.iter().all(|item| accepts(rule, item))),
        "minItems" => {
            value.as_array().is_none_or(|items| items.len() as u64 >= rule.as_u64().expect("count"))
        }
        "maxItems" => {
            value.as_array().is_none_or(|items| items.len() as u64 <= rule.as_u64().expect("count"))
        }
        "maxLength" => value.as_str().is_none_or(|s| s.len() as u64 <= rule.as_u64().expect("length")),
        "anyOf" => all(rule).iter().any(|s| accepts(s, value)),
        "allOf" => all(rule).iter().all(|s| accepts(s, value)),
        "if" => !accepts(rule, value) || accepts(&schema["then"], value),
        "required" => all(rule).iter().all(|k| value.get(k.as_str().expect("key")).is_some()),
        "properties" => rule
            .as_object()
            .expect("object")
            .iter()
            .all(|(key, s)| value.get(key).is_none_or(|v| accepts(s, v))),
        "additionalProperties" => value.as_object().is_none_or(|map| {
            let known = schema.get("properties");
            map.iter()
                .filter(|(k, _)| known.and_then(|p| p.get(k.as_str())).is_none())
                .all(|(_, v)| accepts(rule, v))
        }),
        // a value that the key itself takes
        "default" => {
            let mut form = schema.clone();
            form.remove("default");
            accepts(&Value::Object(form), rule)
        }
        other => panic!("the schema uses `{other}`, which this test does not check"),
    }
}

fn scene_json(text: &str) -> Value {
    let value: toml::Value = toml::from_str(text).expect("TOML");
    serde_json::to_value(value).expect("JSON")
}

const VALID: &str = include_str!("../fixtures/plate-impact.toml");

#[test]
fn schema_accepts_the_shipped_scenes() {
    let schema = schema();
    assert_eq!(schema["$schema"], json!("https://json-schema.org/draft/2020-12/schema"));
    for path in shipped().expect("scenes") {
        let text = std::fs::read_to_string(&path).expect("scene");
        assert!(accepts(&schema, &scene_json(&text)), "{}", path.display());
    }
}

#[test]
fn schema_and_reader_agree() {
    let schema = schema();
    let compact = "kind = \"compact\"\nmass = 0.1\ntip_radius = 0.01";
    let fluid = "[fluid]\nviscosity = 1e-3\ndensity = 1e3\nminimum_gap = 1e-6\n[reduced]";
    let tolerances = "[tolerances.B]\nefficiency = 0.1\nouter_force_rms = { relative_to_peak = 0.1, bias = -1 }\n[reduced]";
    let sphere = "kind     = \"sphere\"\nradius   = \"10 mm\"";
    let bender = "kind = \"bender\"\nlength = 0.01\ntip_mass = 1e-4\ntip_radius = 4e-3\nfirst_frequency = 500\ntip_stiffness = 2500";
    let two_beams = format!("{bender}\nline_mass = 0.1");
    let two_drives = format!("{bender}\ntorque = 1e-3");
    let half_a_beam = bender.replace("\ntip_stiffness = 2500", "");
    let whole_law = "infinite_shear_viscosity = 1e-4\nrelaxation_time = 1\npower_index = 0.5\n[reduced]";
    let thinning = fluid.replace("[reduced]", whole_law);
    let half_a_law = fluid.replace("[reduced]", "power_index = 0.5\n[reduced]");
    for (from, to, valid) in [
        (sphere, bender, true),
        (sphere, two_beams.as_str(), false),
        (sphere, two_drives.as_str(), false),
        (sphere, half_a_beam.as_str(), false),
        ("[reduced]", thinning.as_str(), true),
        ("[reduced]", half_a_law.as_str(), false),
        ("modes", "modes", true),
        ("\"33 mm\"", "0.033", true),
        ("\"33 mm\"", "\"33mm\"", true),
        ("\"33 mm\"", "\"3.3e4 \u{b5}m\"", true),
        ("\"33 mm\"", "\" +33 mm \"", true),
        ("\"33 mm\"", "\".033\"", true),
        ("\"33 mm\"", "\"33 N mm/N\"", true),
        ("\"33 mm\"", "\"3.3e4 mm^2 m^-1\"", true),
        ("\"33 mm\"", "\"33 mN\"", false),
        ("\"33 mm\"", "\"33 kg\"", false),
        ("\"33 mm\"", "\"33 inch\"", false),
        ("\"33 mm\"", "\"33,5 mm\"", false),
        ("\"33 mm\"", "\"-33 mm\"", false),
        ("\"33 mm\"", "\"mm\"", false),
        ("\"33 mm\"", "33000", false),
        ("\"550 mm/s\"", "\"550 mm\"", false),
        ("\"210 GPa\"", "\"210 kN/mm\u{b2}\"", true),
        ("0.3", "\"30 %\"", true),
        ("0.3", "\"0.3 mm\"", false),
        (sphere, compact, true),
        ("[reduced]", fluid, true),
        ("[reduced]", tolerances, true),
        ("[reduced]", "[run]\nend_time = 1\n[reduced]", true),
        ("description", "#", true),
        ("\"33 mm\"", "-0.033", false),
        ("\"33 mm\"", "0", false),
        ("\"33 mm\"", "true", false),
        ("0.3", "0.5", false),
        ("modes = 16", "modes = 0", false),
        ("modes = 16", "modes = 1025", false),
        ("radius = 12", "radius = 1", false),
        ("radius = 12", "radius = 65", false),
        ("clamped", "glued", false),
        ("plate-impact", "seal-seat", false),
        ("\"sphere\"", "\"bender\"", false),
        ("\"sphere\"", "\"compact\"", false),
        ("model = \"B\"", "model = \"D\"", false),
        ("speed ", "mass = 1\nspeed ", false),
        ("speed ", "sped ", false),
        ("name ", "nmae ", false),
        ("youngs_modulus", "youngs", false),
        ("[reduced]", "[runs]\n[reduced]", false),
        ("[reduced]", "[run]\nend = 1\n[reduced]", false),
        ("[reduced]", "[tolerances.D]\n[reduced]", false),
        ("[reduced]", "[tolerances.B]\nefficency = 0.1\n[reduced]", false),
        ("[reduced]", "[tolerances.B]\nefficiency = { bias = 0.1 }\n[reduced]", false),
        ("[reduced]", "[tolerances.B]\nefficiency = { absolut = 0.1 }\n[reduced]", false),
    ] {
        assert!(VALID.contains(from), "`{from}` is not in the scene");
        let text = VALID.replacen(from, to, 1);
        assert_eq!(Scene::parse("scene.toml", &text).is_ok(), valid, "reader, {to}");
        assert_eq!(accepts(&schema, &scene_json(&text)), valid, "schema, {to}");
    }
}

const SEAT: &str = include_str!("../fixtures/seal-seat.toml");

#[test]
fn schema_and_reader_agree_on_seal_seats() {
    let schema = schema();
    let tolerances =
        "[tolerances.C]\nsphere_angle = { absolute = \"0.5 deg\" }\nsphere_force_rms = 0.1\n[reduced]";
    for (from, to, valid) in [
        ("modes", "modes", true),
        ("\"15 deg\"      # alpha", "0.2      # alpha", true),
        ("[\"-4.5 mm\", \"4.5 mm\"]", "[0.001]", true),
        ("[reduced]", tolerances, true),
        ("[reduced]", "[reference]\nelement_order = 1\nelements_per_ring_radius = 4\n[reduced]", true),
        ("notch_width        = \"1.4 mm\"", "", false),
        ("[\"-4.5 mm\", \"4.5 mm\"]", "[]", false),
        ("[\"-4.5 mm\", \"4.5 mm\"]", "0.001", false),
        ("[\"-4.5 mm\", \"4.5 mm\"]", "[true]", false),
        ("[\"-4.5 mm\", \"4.5 mm\"]", "[0,1e-3,2e-3,3e-3,4e-3,5e-3,6e-3,7e-3,-1e-3]", false),
        ("\"120 deg\"", "3.2", false),
        ("\"15 deg\"      # alpha", "-0.1      # alpha", false),
        ("seal-seat\"\n", "plate-impact\"\n", false),
        ("[reduced]", "[fluid]\nviscosity = 1e-3\ndensity = 1e3\nminimum_gap = 1e-6\n[reduced]", false),
        ("[reduced]", "[reference]\ngeometry = \"solid\"\n[reduced]", false),
        ("[reduced]", "[tolerances.B]\nsphere_angle = 1\n[reduced]", false),
        ("[reduced]", "[tolerances.C]\nouter_force_peak = 1\n[reduced]", false),
        ("modes = 16", "model = \"B\"", false),
        ("tip_radius", "tip_raduis", false),
    ] {
        assert!(SEAT.contains(from), "`{from}` is not in the scene");
        let text = SEAT.replacen(from, to, 1);
        assert_eq!(Scene::parse("scene.toml", &text).is_ok(), valid, "reader, {to}");
        assert_eq!(accepts(&schema, &scene_json(&text)), valid, "schema, {to}");
    }
}
