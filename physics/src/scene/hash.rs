//! Identity of a scene: a hash over its physical content.

use super::Scene;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

impl Scene {
    /// SHA-256 (hexadecimal) of what is physical in the scene: bodies, motion, fluid, length of the run.
    ///
    /// Name, description, names of materials and the yield strengths of those that stay elastic, tolerances and the settings of models and
    /// reference are omitted: two scenes with the same hash have the same exact solution.
    pub fn hash(&self) -> String {
        let mut physical = json!({ "setup": self.setup, "run": self.run });
        drop_inelastic(&mut physical);
        sha256_hex(canonical(&physical).as_bytes())
    }
}

/// Takes out of all materials below `value` what changes no result: names, and yield strengths without hardening.
pub fn drop_inelastic(value: &mut Value) {
    let Value::Object(map) = value else { return };
    for (key, child) in map.iter_mut() {
        match (key.as_str(), &mut *child) {
            ("material", material) => drop_names(material),
            ("materials", Value::Object(groups)) => groups.values_mut().for_each(drop_names),
            _ => {}
        }
        drop_inelastic(child);
    }
}

fn drop_names(material: &mut Value) {
    let Value::Object(material) = material else { return };
    material.remove("name");
    if !material.contains_key("hardening") {
        material.remove("yield_strength");
    }
}

/// JSON without spaces, keys sorted: the same for equal values whatever the order of their keys.
pub fn canonical(value: &Value) -> String {
    match value {
        Value::Object(map) => {
            let mut entries: Vec<(&String, &Value)> = map.iter().collect();
            entries.sort_by_key(|(key, _)| *key);
            let entries: Vec<String> =
                entries.iter().map(|(key, v)| format!("{}:{}", json!(key), canonical(v))).collect();
            format!("{{{}}}", entries.join(","))
        }
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(canonical).collect();
            format!("[{}]", items.join(","))
        }
        other => other.to_string(),
    }
}

/// SHA-256 of `bytes` in hexadecimal.
pub fn sha256_hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sha256_of_the_standard() {
        // FIPS 180-2, appendix B.1.
        assert_eq!(sha256_hex(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }

    #[test]
    fn canonical_form_sorts_keys_at_every_level() {
        let value: Value =
            serde_json::from_str(r#"{"b": [1, {"z": null, "a": "\""}], "a": 0.033}"#).expect("JSON");
        assert_eq!(canonical(&value), r#"{"a":0.033,"b":[1,{"a":"\"","z":null}]}"#);
    }
}
