//! Bodies of model C through the cache on disk.

use super::{ContinuumPlate, MeshOptions, ModesAlong, WEIGHTED};
use crate::body::cache::Cache;
use crate::error::Result;
use crate::scene::hash::drop_inelastic;
use crate::scene::{Material, Plate};
use serde_json::{Value, json};

/// Number of the method that makes the bodies, part of every key: raise it when one comes out otherwise.
const REVISION: u32 = 1;

/// [`ContinuumPlate::new`] through the user's cache.
///
/// # Errors
/// As [`ContinuumPlate::new`].
pub fn plate(
    plate: &Plate,
    patch_radius: [f64; 2],
    modes: usize,
    mesh: &MeshOptions,
) -> Result<ContinuumPlate> {
    plate_in(&Cache::from_environment(), plate, patch_radius, modes, mesh)
}

/// [`ContinuumPlate::new`] through `cache`.
///
/// # Errors
/// As [`ContinuumPlate::new`].
pub fn plate_in(
    cache: &Cache,
    plate: &Plate,
    patch_radius: [f64; 2],
    modes: usize,
    mesh: &MeshOptions,
) -> Result<ContinuumPlate> {
    cache.get_or_build(&plate_inputs(plate, patch_radius, modes, mesh), || {
        ContinuumPlate::new(plate, patch_radius, modes, mesh)
    })
}

/// [`ModesAlong::new`] through the user's cache.
///
/// # Errors
/// As [`ModesAlong::new`].
pub fn modes_along(plate: &Plate, mesh: &MeshOptions) -> Result<ModesAlong> {
    modes_along_in(&Cache::from_environment(), plate, mesh)
}

/// [`ModesAlong::new`] through `cache`.
///
/// # Errors
/// As [`ModesAlong::new`].
pub fn modes_along_in(cache: &Cache, plate: &Plate, mesh: &MeshOptions) -> Result<ModesAlong> {
    let content = inputs(json!({ "body": "plate along its faces", "plate": plate, "mesh": mesh }));
    cache.get_or_build(&content, || ModesAlong::new(plate, mesh))
}

/// [`super::face_shapes`] through the user's cache.
///
/// # Errors
/// As [`super::face_shapes`].
pub fn face_shapes(
    plate: &Plate,
    patch_radius: [f64; 2],
    modes: usize,
    mesh: &MeshOptions,
    radii: &[f64],
) -> Result<Vec<Vec<f64>>> {
    let mut content = plate_inputs(plate, patch_radius, modes, mesh);
    content["body"] = "inner face of a plate".into();
    content["radii"] = radii.into();
    Cache::from_environment()
        .get_or_build(&content, || super::face_shapes(plate, patch_radius, modes, mesh, radii))
}

/// [`super::sphere_residual`] through the user's cache.
///
/// # Errors
/// As [`super::sphere_residual`].
pub fn sphere_residual(
    radius: f64,
    material: &Material,
    patch_radius: f64,
    mesh: &MeshOptions,
) -> Result<f64> {
    sphere_residual_in(&Cache::from_environment(), radius, material, patch_radius, mesh)
}

/// [`super::sphere_residual`] through `cache`.
///
/// # Errors
/// As [`super::sphere_residual`].
pub fn sphere_residual_in(
    cache: &Cache,
    radius: f64,
    material: &Material,
    patch_radius: f64,
    mesh: &MeshOptions,
) -> Result<f64> {
    cache.get_or_build(&sphere_inputs(radius, material, patch_radius, mesh), || {
        super::sphere_residual(radius, material, patch_radius, mesh)
    })
}

fn plate_inputs(plate: &Plate, patch_radius: [f64; 2], modes: usize, mesh: &MeshOptions) -> Value {
    inputs(json!({
        "body": "plate", "plate": plate, "patch_radius": patch_radius, "weighted": WEIGHTED, "modes": modes, "mesh": mesh,
    }))
}

fn sphere_inputs(radius: f64, material: &Material, patch_radius: f64, mesh: &MeshOptions) -> Value {
    inputs(json!({
        "body": "sphere", "radius": radius, "material": material, "patch_radius": patch_radius, "mesh": mesh,
    }))
}

/// `content` without what does not matter, with the revision of the method.
fn inputs(mut content: Value) -> Value {
    drop_inelastic(&mut content);
    content["revision"] = REVISION.into();
    content
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Edge;
    use std::collections::BTreeSet;
    use std::path::Path;

    const PATCH: [f64; 2] = [0.3e-3, 0.2e-3];

    fn steel() -> Material {
        Material::elastic("steel", 210e9, 0.3, 7780.0)
    }

    fn table1() -> Plate {
        let (radius, thickness) = (33e-3, 2e-3);
        Plate { radius, thickness, edge: Edge::Clamped, material: steel(), damping_ratio: 0.0 }
    }

    fn entries(folder: &Path) -> Vec<std::path::PathBuf> {
        std::fs::read_dir(folder).expect("folder").map(|e| e.expect("entry").path()).collect()
    }

    /// Bodies of [`REVISION`] 1.
    const BODIES: [f64; 20] = [
        1.803505757894987e-10,
        411899.1773036435,
        16.143217839735893,
        6.466139331076667e-11,
        5.8792728672665336e-9,
        39926.56378762074,
        50.37206383444963,
        1.158906971261618e-7,
        5.466494863949406e-6,
        430815.6162485273,
        1.351033203065091,
        2.7934217679139244e-14,
        7.980290336227326e-12,
        509520.7560066813,
        2.416628219206018,
        2.934278606696406e-14,
        1.5513591976125725e-11,
        9.57788744580403,
        10.479988139245613,
        8.977277519763879,
    ];

    #[test]
    fn bodies_that_come_out_otherwise_have_a_new_revision() {
        let mesh = MeshOptions::default();
        let mut found = vec![sphere_residual_in(&Cache::off(), 10e-3, &steel(), PATCH[0], &mesh).unwrap()];
        for (edge, thickness) in [
            (Edge::Clamped, 2e-3),
            (Edge::SimplySupported, 0.2e-3),
            (Edge::Free, 40e-3),
            (Edge::Clamped, 80e-3),
        ] {
            let plate = Plate { edge, thickness, ..table1() };
            let body = plate_in(&Cache::off(), &plate, PATCH, 4, &mesh).unwrap();
            let modal = body.modal_body(3, 0.0);
            found.extend([body.omega_next(3), modal.participation[2][0]]);
            found.extend(modal.residual.map(|residual| [residual.own[0][1], residual.mutual[0][0]]).unwrap());
        }
        let shapes = super::super::face_shapes(&table1(), PATCH, 3, &mesh, &[0.0, 5e-3]).unwrap();
        found.extend(shapes.iter().map(|shape| shape[1].abs()));
        // the sign of a mode is free
        let same = |(found, known): (&f64, &f64)| (found.abs() / known - 1.0).abs() < 1e-6;
        assert!(
            found.len() == BODIES.len() && found.iter().zip(&BODIES).all(same),
            "raise REVISION, and put here what its bodies come to: {found:?}"
        );
    }

    #[test]
    fn the_second_plate_and_sphere_equal_the_first_bit_by_bit_and_come_from_the_entry() {
        let folder = tempfile::tempdir().expect("folder");
        let cache = Cache::at(folder.path());
        let mesh = MeshOptions::default();
        let plate = |cache: &Cache| plate_in(cache, &table1(), PATCH, 6, &mesh).expect("plate");
        let sphere =
            |cache: &Cache| sphere_residual_in(cache, 10e-3, &steel(), PATCH[0], &mesh).expect("sphere");
        let bits = |plate: &ContinuumPlate| -> Vec<u64> {
            let table = plate.flexibility.own.iter().chain(&plate.flexibility.mutual).flatten();
            let shapes = plate.participation.iter().flatten().flatten();
            plate.omega.iter().chain(shapes).chain(table).map(|value| value.to_bits()).collect()
        };
        let computed = bits(&plate(&Cache::off()));
        assert_eq!(computed.len(), 7 * (1 + 2 * 5) + 6 * 4);
        for _ in 0..2 {
            assert_eq!(bits(&plate(&cache)), computed);
            assert_eq!(sphere(&cache).to_bits(), sphere(&Cache::off()).to_bits());
        }
        assert_eq!(entries(folder.path()).len(), 2);

        // An entry that is damaged gives way to the right numbers, and is mended.
        for path in entries(folder.path()) {
            let mut bytes = std::fs::read(&path).expect("entry");
            let last = bytes.iter().rposition(u8::is_ascii_digit).expect("a number");
            bytes[last] = if bytes[last] == b'1' { b'2' } else { b'1' };
            std::fs::write(&path, &bytes).expect("entry");
        }
        assert_eq!(bits(&plate(&cache)), computed);
        assert_eq!(sphere(&cache).to_bits(), sphere(&Cache::off()).to_bits());
    }

    #[test]
    fn every_input_has_its_own_key_and_names_of_materials_have_none() {
        let mesh = MeshOptions::default();
        let mut keys = BTreeSet::new();
        let mut count = 0;
        let mut add = |inputs: Value| {
            assert!(keys.insert(inputs.to_string()), "no key of its own: {inputs}");
            count += 1;
        };
        // the next double is another input
        let next = |value: f64| value.next_up();
        let meshes = [
            mesh,
            MeshOptions { order: 4, ..mesh },
            MeshOptions { patch_elements: next(mesh.patch_elements), ..mesh },
            MeshOptions { growth: next(mesh.growth), ..mesh },
            MeshOptions { depth_growth: next(mesh.depth_growth), ..mesh },
            MeshOptions { nodes_per_wavelength: next(mesh.nodes_per_wavelength), ..mesh },
            MeshOptions { thickness_elements: next(mesh.thickness_elements), ..mesh },
        ];
        let materials = [
            steel(),
            Material { youngs_modulus: next(210e9), ..steel() },
            Material { poisson_ratio: next(0.3), ..steel() },
            Material { density: next(7780.0), ..steel() },
        ];
        let p = table1();
        for mesh in &meshes {
            add(plate_inputs(&p, PATCH, 16, mesh));
            add(sphere_inputs(10e-3, &steel(), PATCH[0], mesh));
        }
        for material in &materials[1..] {
            add(plate_inputs(&Plate { material: material.clone(), ..table1() }, PATCH, 16, &mesh));
            add(sphere_inputs(10e-3, material, PATCH[0], &mesh));
        }
        for changed in [
            Plate { radius: next(p.radius), ..table1() },
            Plate { thickness: next(p.thickness), ..table1() },
            Plate { edge: Edge::Free, ..table1() },
            Plate { edge: Edge::SimplySupported, ..table1() },
            Plate { damping_ratio: 0.01, ..table1() },
        ] {
            add(plate_inputs(&changed, PATCH, 16, &mesh));
        }
        add(plate_inputs(&p, [next(PATCH[0]), PATCH[1]], 16, &mesh));
        add(plate_inputs(&p, [PATCH[0], next(PATCH[1])], 16, &mesh));
        add(plate_inputs(&p, [PATCH[1], PATCH[0]], 16, &mesh));
        add(plate_inputs(&p, PATCH, 15, &mesh));
        add(sphere_inputs(next(10e-3), &steel(), PATCH[0], &mesh));
        add(sphere_inputs(10e-3, &steel(), next(PATCH[0]), &mesh));
        assert_eq!(count, 14 + 6 + 5 + 6);

        let renamed = Material { name: "other".into(), ..steel() };
        assert_eq!(
            plate_inputs(&Plate { material: renamed.clone(), ..table1() }, PATCH, 16, &mesh),
            plate_inputs(&p, PATCH, 16, &mesh)
        );
        assert_eq!(
            sphere_inputs(10e-3, &renamed, PATCH[0], &mesh),
            sphere_inputs(10e-3, &steel(), PATCH[0], &mesh)
        );
    }
}
