//! A small stored solution, written as `fem_reference` writes it.
#![allow(dead_code)] // each test file uses its part

use crate::sealed::seal;
use impactcheck::reference::{Resolution, settings_hash};
use impactcheck::scene::Scene;
use serde_json::{Value, json};
use std::path::Path;

pub const SCENE: &str = include_str!("../../scenes/scaled-plate-r10.toml");

pub const HISTORY: &str = "time,outer_displacement,outer_velocity,outer_force,plate_displacement,plate_velocity,inner_displacement,inner_velocity,inner_force
0,0,-0.55,0,0,0,0,0,0
1e-07,-5.5e-08,-0.5499,12.5,-1e-09,-0.01,0,-1e-05,0.25
2e-07,-1.1e-07,-0.5498,25,-2e-09,-0.02,-1e-12,-2e-05,0.5
";

pub const MESH: &str = "<VTKFile type=\"UnstructuredGrid\"><Piece NumberOfPoints=\"4\"/></VTKFile>\n";

pub fn scene() -> Scene {
    scene_with("", "")
}

/// The scene with `from` replaced by `to`.
pub fn scene_with(from: &str, to: &str) -> Scene {
    Scene::parse("scene.toml", &SCENE.replacen(from, to, 1)).expect("valid scene")
}

pub fn summary(scene: &Scene) -> Value {
    json!({
        "schema_version": 1, "scene": scene.name, "scene_hash": scene.hash(), "source": "reference",
        "model": null, "modes": null, "efficiency": 0.7, "outer_velocity_final": -0.3,
        "inner_velocity_final": -0.46, "outer_force_peak": 25.0, "inner_force_peak": 0.5,
        "outer_contact_end": 1.8e-4, "inner_contact_end": 8.5e-5, "outer_contacts": 1,
        "inner_contacts": 1, "first_frequency": 4655.0, "energy_residual": 1e-8,
        "momentum_residual": 1e-11, "steps": 44000, "solve_seconds": 2.0,
        "uncertainty": { "efficiency": 0.0002 }, "samples": 3, "sample_interval": 1e-7,
        "convergence": { "meshes": [{ "dofs": 8 }] },
    })
}

pub fn provenance(scene: &Scene, resolution: Resolution) -> Value {
    json!({
        "scene": scene, "scene_hash": scene.hash(), "settings_hash": settings_hash(scene, resolution),
        "settings": { "resolution": resolution }, "created": "2024-01-01T00:00:00+00:00",
    })
}

/// Writes a complete, intact entry into `folder`.
pub fn write_entry(folder: &Path, scene: &Scene, resolution: Resolution) {
    std::fs::create_dir_all(folder).expect("folder");
    let write = |name: &str, text: String| std::fs::write(folder.join(name), text).expect("file");
    write("summary.json", summary(scene).to_string());
    write("provenance.json", provenance(scene, resolution).to_string());
    write("history.csv", HISTORY.to_owned());
    write("mesh.vtu", MESH.to_owned());
    seal(folder);
}
