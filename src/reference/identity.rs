//! What a reference solution was made from, and how that differs from what is asked for.

use super::Resolution;
use crate::kinds;
use crate::scene::hash::{canonical, drop_inelastic, sha256_hex};
use crate::scene::{Scene, unit_of};
use crate::{Error, Result};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

/// Revision of the method that the reference of `scene` is made with.
pub fn revision(scene: &Scene) -> u32 {
    kinds::of(scene).revision(scene.reference.geometry)
}

/// The same of the results by CalculiX.
const CALCULIX_REVISION: u32 = 1;

/// SHA-256 (hexadecimal) of how the reference of `scene` is computed: its settings, the
/// resolution and the revision of the method.
pub fn settings_hash(scene: &Scene, resolution: Resolution) -> String {
    if resolution == Resolution::Imported {
        // whatever this program would do differently, another's result stays
        return sha256_hex(canonical(&json!({ "resolution": resolution })).as_bytes());
    }
    let revision = match resolution {
        Resolution::Calculix(_) => CALCULIX_REVISION,
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
    for foreign in ["reduced", "tolerances", "external"] {
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
        let physical = [
            "kind",
            "plate",
            "outer",
            "inner",
            "friction",
            "fluid",
            "seat",
            "sphere",
            "actuator",
            "series",
            "intended_angle",
            "run",
        ];
        let mut changes = Vec::new();
        // what is no part of the hash made no difference
        let [mut old, mut new] = [stored.clone(), present.clone()];
        [&mut old, &mut new].into_iter().for_each(drop_inelastic);
        for key in physical {
            differences(key, &old[key], &new[key], &mut changes);
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
