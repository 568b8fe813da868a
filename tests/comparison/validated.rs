//! The validations that the project brings along are those of its scenes, of its models as they are and of its references.

use impactcheck::comparison::compare_scene;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::reference::{Lookup, Resolution, Store};
use impactcheck::scene::{Model, Scene, Shape, every};
use impactcheck::validated::{Place, SAME_SINCE, Validation, merge, of_store, shipped, update};

/// Share of the reference by which what is computed again may differ: a tenth of the smallest discrepancy told.
const SAME: f64 = 1e-4;

/// Its plate vibrates faster than the reference's history is sampled: the history contradicts the summary, and shows nothing.
const UNSOUND: &str = "wide-patch";

/// All scenes but the examples, some of which are for reduced models alone.
fn scenes() -> Vec<Scene> {
    let files = every().unwrap().into_iter().filter(|file| !file.parent().unwrap().ends_with("examples"));
    files.map(|file| Scene::read(file).unwrap()).collect()
}

fn recorded(known: &[Validation], scene: &str, model: Model) -> Option<Validation> {
    known.iter().find(|v| v.scene == scene && v.model == model.to_string()).cloned()
}

#[test]
fn what_is_recorded_is_what_scenes_models_and_stored_references_give_now() {
    let known = shipped().unwrap();
    let (scenes, mut compared, mut stored) = (scenes(), 0, 0);
    for entry in &known {
        let is_of = |scene: &Scene| entry.is_of(scene, entry.model.parse().unwrap());
        assert!(scenes.iter().any(is_of), "{} is no scene any more", entry.scene);
        assert!(entry.revision >= SAME_SINCE, "{}", entry.scene);
    }
    // dents and creep have no place on a map that is drawn by Hertz's patches: what is recorded of them is for the coverage alone
    let remembers = |s: &&Scene| s.plate_impact().is_ok_and(|p| p.yields() || p.relaxes());
    for scene in scenes.iter().filter(remembers) {
        let entry = recorded(&known, &scene.name, Model::C).unwrap_or_else(|| panic!("{}", scene.name));
        assert!(entry.place.is_none() && entry.rows.len() >= 3, "{}", scene.name);
    }
    // nor have impacts beside the centre or at an angle
    let aside = |s: &&Scene| s.plate_impact().is_ok_and(|p| !p.outer.is_centred());
    for scene in scenes.iter().filter(aside) {
        let mut models = 0;
        for model in [Model::A, Model::B, Model::C] {
            // beside the centre model C has no modes
            let Ok(reduced) = Reduced::new(scene, model, None) else { continue };
            let summary = reduced.run(1e-7).unwrap();
            let entry = recorded(&known, &scene.name, model).unwrap_or_else(|| panic!("{}", scene.name));
            assert!(entry.place.is_none() && entry.rows.len() >= 3, "{}", scene.name);
            for row in &entry.rows {
                let moved = (summary.value(&row.quantity).unwrap() - row.reduced).abs() / row.reference.abs();
                assert!(moved < SAME, "{} {model}, {}", scene.name, row.quantity);
            }
            models += 1;
        }
        assert!(models >= 2, "{}", scene.name);
    }
    let elastic = |s: &&Scene| s.plate_impact().is_ok() && s.name != UNSOUND && !remembers(s) && !aside(s);
    for scene in scenes.iter().filter(elastic) {
        for model in [Model::A, Model::B, Model::C] {
            let at = format!("{} {model}", scene.name);
            let entry =
                recorded(&known, &scene.name, model).unwrap_or_else(|| panic!("{at} is not recorded"));
            let reduced = Reduced::new(scene, model, None).unwrap().run_with_history(1e-7).unwrap();
            assert_eq!(reduced.summary.modes, entry.modes, "{at}");
            // a run that its end cuts during a contact says little, and a stack has no efficiency
            let is_cut = reduced.summary.value("efficiency").is_none();
            let is_stack = matches!(scene.plate_impact().unwrap().outer.shape, Shape::Stack(_));
            let least = if is_stack { 2 } else { 3 };
            assert!(entry.rows.len() >= least || (is_cut && model == Model::A), "{at}");
            for row in &entry.rows {
                let now = reduced.summary.value(&row.quantity).unwrap();
                let moved = (now - row.reduced).abs() / row.reference.abs();
                let how = "if that is right: impactcheck coverage --record";
                assert!(moved < SAME, "{at}, {}: {now}, recorded {}; {how}", row.quantity, row.reduced);
            }
            // a model that hits the reference lies where the reference lies
            let place = entry.place.unwrap();
            let own = Place::of(scene, &reduced.summary).filter(|_| model == Model::C);
            assert!(model != Model::C || own.unwrap().factor(&place) < 1.05, "{at}: {own:?} {place:?}");
            compared += 1;
            let found =
                [Resolution::Fine, Resolution::Paper].into_iter().find_map(
                    |resolution| match Store::shipped().unwrap().find(scene, resolution) {
                        Lookup::Found(stored) => Some(stored),
                        _ => None,
                    },
                );
            if let Some(reference) = found {
                let again = Validation::of(scene, &compare_scene(scene, &reference.outcome, &[reduced]));
                assert_eq!((again[0].place, again[0].dofs), (entry.place, entry.dofs), "{at}");
                for (row, recorded) in again[0].rows.iter().zip(&entry.rows) {
                    assert_eq!((row.reference, row.band), (recorded.reference, recorded.band), "{at}");
                }
                stored += 1;
            }
        }
    }
    assert_eq!((compared, stored), (known.iter().filter(|v| v.place.is_some()).count(), 6 * 3));
}

/// The centre of a plate that is struck off-centre does not sink under the outer body.
#[test]
fn the_centre_of_an_off_centre_impact_moves_as_in_finite_elements() {
    for scene in scenes().iter().filter(|scene| scene.name.starts_with("off-centre")) {
        let Lookup::Found(reference) = Store::shipped().unwrap().find(scene, Resolution::Paper) else {
            panic!("{} is not stored", scene.name)
        };
        let model = Reduced::new(scene, Model::B, None).unwrap().run_with_history(1e-7).unwrap();
        let compared = compare_scene(scene, &reference.outcome, &[model]);
        let row = compared.models[0].discrepancy("plate_displacement_rms").unwrap();
        assert!(row.relative.unwrap() < 0.05, "{}: {row:?}", scene.name);
    }
}

fn at(scene: &str, measures: [f64; 3], off: f64) -> Validation {
    let mut entry = recorded(&shipped().unwrap(), "scaled-plate-r10", Model::C).unwrap();
    let [patch_over_thickness, contact_over_period, mass_ratio] = measures;
    entry.place = Some(Place { patch_over_thickness, contact_over_period, mass_ratio, stokes_number: None });
    entry.rows.iter_mut().for_each(|row| row.reduced = row.reference * (1.0 + off));
    Validation { scene: scene.into(), scene_hash: scene.into(), ..entry }
}

#[test]
fn a_coarser_mesh_takes_no_finer_ones_place_unless_the_scene_is_another() {
    let dir = tempfile::tempdir().unwrap();
    let store = Store::open(Some(dir.path()));
    let fine = at("one", [0.1, 1.0, 1.0], 0.001);
    let coarse = Validation { dofs: Some(10), ..at("one", [0.1, 1.0, 1.0], 0.01) };
    update(&store, std::slice::from_ref(&fine)).unwrap();
    update(&store, std::slice::from_ref(&coarse)).unwrap();
    assert_eq!(of_store(&store).unwrap(), std::slice::from_ref(&fine));
    let changed = Validation { scene_hash: "changed".into(), ..coarse };
    update(&store, &[changed.clone(), at("other", [0.1, 1.0, 1.0], 0.0)]).unwrap();
    let names: Vec<(String, String)> =
        of_store(&store).unwrap().into_iter().map(|v| (v.scene, v.scene_hash)).collect();
    assert_eq!(names, [("one", "changed"), ("other", "other")].map(|(a, b)| (a.into(), b.into())));
    // what other models or another method of the reference gave is not believed
    for old in [
        Validation { program: "0.0.9".into(), ..changed.clone() },
        Validation { revision: SAME_SINCE - 1, ..changed },
    ] {
        update(&store, &[old]).unwrap();
        assert_eq!(of_store(&store).unwrap().len(), 1);
    }
    let mut known = vec![at("b", [1.0; 3], 0.0)];
    merge(&mut known, &[at("a", [1.0; 3], 0.0)]);
    assert_eq!(known[0].scene, "a");
}
