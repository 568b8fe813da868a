//! Reading of materials with memory, and what of them changes the hash of a scene.

use super::scene_reading::{edited, parse, plate_impact, refused};

/// The example scene with `keys` added to its material.
fn material_with(keys: &str) -> String {
    edited("density ", &format!("{keys}\ndensity "))
}

#[test]
fn materials_that_yield_or_relax_are_read_in_full() {
    let steel = |keys: &str| plate_impact(&parse(&material_with(keys))).plate.material.clone();
    let plastic = steel("yield_strength = \"600 MPa\"\nhardening = 0\nrate = { D = \"40.4 1/s\", q = 5 }");
    let rate = plastic.plasticity().unwrap().rate.unwrap();
    assert_eq!((plastic.hardening, rate.reference_rate, rate.exponent), (Some(0.0), 40.4, 5.0));
    assert_eq!(steel("yield_strength = \"600 MPa\"").plasticity(), None);
    let relaxing = steel("relaxation = [{ ratio = 0.1, time = \"10 us\" }, { ratio = 0.2, time = 1e-3 }]");
    let terms: Vec<_> = relaxing.relaxation.iter().map(|term| (term.ratio, term.time)).collect();
    assert_eq!((terms, relaxing.youngs_modulus), (vec![(0.1, 1e-5), (0.2, 1e-3)], 210e9));
    // the storage modulus at the frequency is the one given
    let lossy = steel("loss_factor = 0.05\nmodulus_frequency = \"10 kHz\"");
    let [storage, loss] = impactcheck::material::modulus_ratio(&lossy.relaxation, 1e4);
    assert!((lossy.youngs_modulus * storage / 210e9 - 1.0).abs() < 1e-12);
    assert!((loss / storage / 0.05 - 1.0).abs() < 0.02);
}

#[test]
fn materials_that_contradict_themselves_are_refused() {
    for (keys, words) in [
        ("hardening = 1e9", "yield_strength"),
        ("yield_strength = 6e8\nrate = { D = 40, q = 5 }", "hardening"),
        ("loss_factor = 0.02", "modulus_frequency"),
        ("modulus_frequency = 1e4", "loss_factor"),
        (
            "loss_factor = 0.02\nmodulus_frequency = 1e4\nrelaxation = [{ ratio = 0.1, time = 1e-5 }]",
            "specify the same",
        ),
        (
            "yield_strength = 6e8\nhardening = 0\nrelaxation = [{ ratio = 0.1, time = 1e-5 }]",
            "viscoelastic or plastic",
        ),
        ("relaxation = [{ ratio = 0.6, time = 1e-5 }, { ratio = 0.4, time = 1e-4 }]", "below 1"),
        ("loss_factor = 0.99\nmodulus_frequency = 1e4", "0.99"),
    ] {
        let text = material_with(keys);
        let [fault] = &refused(&text)[..] else { panic!("{keys}") };
        assert!(fault.message.contains(words), "{keys}: {fault}");
        let at = text.lines().nth(fault.line - 1).expect("a line");
        assert!(fault.message.contains(&format!(".{}", at.split(' ').next().unwrap())), "{at}: {fault}");
    }
    for keys in [
        "relaxation = []",
        "relaxation = [{ ratio = 0.1 }]",
        "relaxation = { ratio = 0.1, time = 1e-5 }",
        "rate = { D = 40 }",
    ] {
        assert!(!refused(&material_with(keys)).is_empty(), "{keys}");
    }
}

/// A scene's hash is that of its result: yield without hardening has no part in it, with it has.
#[test]
fn only_what_changes_a_result_changes_the_hash() {
    let hash = |keys: &str| parse(&material_with(keys)).hash();
    assert_eq!(hash("yield_strength = 6e8"), hash(""));
    let yielding = hash("yield_strength = 6e8\nhardening = 0");
    assert!(yielding != hash("") && yielding != hash("yield_strength = 7e8\nhardening = 0"));
    assert_ne!(hash("relaxation = [{ ratio = 0.1, time = 1e-5 }]"), hash(""));
}
