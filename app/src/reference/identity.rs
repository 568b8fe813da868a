//! What a reference solution was made from, and how that differs from what is asked for.

use super::Resolution;
use crate::kinds;
use crate::kinds::unit_of;
use crate::scene::Scene;
use crate::scene::hash::{canonical, drop_inelastic, sha256_hex};
use crate::{Error, Result};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

/// Revision of the method that the reference of `scene` is made with.
pub fn revision(scene: &Scene) -> u32 {
    kinds::of(scene).revision(scene.reference.geometry)
}

/// Keys of a scene that concern no reference.
const FOREIGN: [&str; 3] = ["reduced", "tolerances", "external"];
/// Other keys that no exact solution depends on, and the hashes beside them.
const NOT_HASHED: [&str; 6] =
    ["name", "description", "reference", "scene_hash", "geometry_hash", "settings_hash"];

/// SHA-256 (hexadecimal) of how the reference of `scene` is computed: its settings, the
/// resolution and the revision of the method.
pub fn settings_hash(scene: &Scene, resolution: Resolution) -> String {
    if resolution == Resolution::Imported {
        // whatever this program would do differently, another's result stays
        return sha256_hex(canonical(&json!({ "resolution": resolution })).as_bytes());
    }
    let revision = match resolution {
        Resolution::Calculix(_) => kinds::of(scene).calculix_revision(),
        _ => revision(scene),
    };
    let settings = json!({ "reference": scene.reference, "resolution": resolution, "revision": revision });
    sha256_hex(canonical(&settings).as_bytes())
}

/// The scene as `fem_reference` receives it: SI numbers, without what concerns reduced models.
pub(super) fn solver_document(scene: &Scene, resolution: Resolution) -> Result<Value> {
    let failed = |e: serde_json::Error| Error::Internal(format!("the scene as JSON: {e}"));
    let mut document = serde_json::to_value(scene).map_err(failed)?;
    let fields =
        document.as_object_mut().ok_or_else(|| Error::Internal("the scene is no JSON object".into()))?;
    for foreign in FOREIGN {
        fields.remove(foreign);
    }
    fields.insert("scene_hash".into(), scene.hash().into());
    if let Some(hash) = kinds::of(scene).geometry_hash(scene) {
        fields.insert("geometry_hash".into(), hash.into());
    }
    fields.insert("settings_hash".into(), settings_hash(scene, resolution).into());
    Ok(document)
}

/// Why a solution with this `provenance` is not one of `scene` at `resolution`; `None` if it is.
pub(super) fn staleness(provenance: &Value, scene: &Scene, resolution: Resolution) -> Result<Option<String>> {
    let present = solver_document(scene, resolution)?;
    let stored = &provenance["scene"];
    let mut reasons = Vec::new();
    if provenance["scene_hash"] != present["scene_hash"] {
        let mut changes = Vec::new();
        let [old, new] = [stored, &present].map(hashed);
        let keys: BTreeSet<&String> = old.keys().chain(new.keys()).collect();
        for key in keys {
            differences(key, member(&old, key), member(&new, key), &mut changes);
        }
        reasons.push(sentence("the scene has changed", &changes, "scene_hash", provenance, &present));
    }
    if provenance["settings_hash"] != present["settings_hash"] {
        let mut changes = Vec::new();
        differences("reference", &stored["reference"], &present["reference"], &mut changes);
        differences("resolution", &provenance["settings"]["resolution"], &json!(resolution), &mut changes);
        if changes.is_empty() {
            changes.push(format!("the method of the reference (its revision is now {})", revision(scene)));
        }
        reasons.push(sentence("the settings have changed", &changes, "settings_hash", provenance, &present));
    }
    Ok((!reasons.is_empty()).then(|| reasons.join("; ")))
}

/// What of `document`, the scene of a solver, is part of the scene's hash.
fn hashed(document: &Value) -> Map<String, Value> {
    let mut document = document.clone();
    drop_inelastic(&mut document);
    let mut fields = document.as_object().cloned().unwrap_or_default();
    fields.retain(|key, _| !FOREIGN.iter().chain(&NOT_HASHED).any(|other| other == key));
    fields
}

fn sentence(what: &str, changes: &[String], hash: &str, old: &Value, new: &Value) -> String {
    let short = |v: &Value| v[hash].as_str().map_or("none".to_owned(), |s| s.chars().take(12).collect());
    let hashes = format!("{hash} {} -> {}", short(old), short(new));
    if changes.is_empty() {
        return format!("{what}: {hashes}");
    }
    format!("{what}: {} ({hashes})", changes.join(", "))
}

/// Notes every leaf that differs as "outer.speed: 0.55 -> 0.6 m/s".
fn differences(path: &str, old: &Value, new: &Value, changes: &mut Vec<String>) {
    if let (Value::Object(old), Value::Object(new)) = (old, new) {
        let keys: BTreeSet<&String> = old.keys().chain(new.keys()).collect();
        for key in keys {
            differences(&format!("{path}.{key}"), member(old, key), member(new, key), changes);
        }
        return;
    }
    let same = match (old.as_f64(), new.as_f64()) {
        (Some(old), Some(new)) => old == new,
        _ => old == new,
    };
    if !same {
        let unit = unit_of(path).filter(|u| *u != "1").map(|u| format!(" {u}")).unwrap_or_default();
        changes.push(format!("{path}: {} -> {}{unit}", show(old), show(new)));
    }
}

fn member<'a>(map: &'a Map<String, Value>, key: &str) -> &'a Value {
    map.get(key).unwrap_or(&Value::Null)
}

fn show(value: &Value) -> String {
    match value {
        Value::Null => "none".to_owned(),
        Value::String(text) => text.clone(),
        other => canonical(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Also of a kind that this program does not know.
    #[test]
    fn every_part_of_the_hash_that_changed_is_named() {
        let text = include_str!("../../../tests/fixtures/plate-impact.toml");
        let scene = Scene::parse("plate-impact.toml", text).expect("valid");
        let mut document = solver_document(&scene, Resolution::Paper).expect("a document");
        let [settings, hash] = ["settings_hash", "scene_hash"].map(|key| document[key].clone());
        document["body"] = json!({ "mass": 2 });
        for other in ["name", "reduced", "tolerances"] {
            document[other] = json!("another");
        }
        let mut provenance = json!({ "scene": document, "scene_hash": hash, "settings_hash": settings });
        assert_eq!(staleness(&provenance, &scene, Resolution::Paper).expect("compared"), None);
        provenance["scene_hash"] = json!("other");
        let said = staleness(&provenance, &scene, Resolution::Paper).expect("compared").expect("stale");
        assert!(said.contains("body: {\"mass\":2} -> none") && !said.contains("another"), "{said}");
    }
}
