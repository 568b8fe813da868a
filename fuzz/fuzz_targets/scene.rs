//! Any text as a scene file: a scene that can be identified and handed on, or an error that can be printed.
#![no_main]

use impactcheck::scene::{Scene, Template};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match Scene::parse("scene.toml", text) {
        Ok(scene) => {
            assert_eq!(scene.hash().len(), 64);
            let json = serde_json::to_value(&scene).expect("a scene can be written");
            finite(&json);
            // what one program writes for the other says the same again
            let again = Scene::parse("scene.toml", text).expect("it was read before");
            assert_eq!(again.hash(), scene.hash());
            Template::parse("scene.toml", text).expect("a scene is a template");
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});

/// JSON has no infinity: numbers that are not finite would be written as null where a number belongs.
fn finite(value: &serde_json::Value) {
    match value {
        serde_json::Value::Array(values) => values.iter().for_each(finite),
        serde_json::Value::Object(values) => {
            for name in ["youngs_modulus", "density", "poisson_ratio", "radius", "thickness", "speed", "mass", "gap"] {
                assert!(!values.get(name).is_some_and(serde_json::Value::is_null), "{name} is not finite");
            }
            values.values().for_each(finite);
        }
        _ => {}
    }
}
