//! What `reduced` prints of what a converged reference would find.

use crate::program::{flat, impactcheck, json};

/// Whatever model runs, and with how many modes, its scene is judged by model C as it is by default.
#[test]
fn the_prediction_does_not_depend_on_the_model_that_runs() {
    let of = |options: &[&str]| json(&[&["reduced", "scaled-plate-r6.35", "--json"], options].concat());
    let expected = of(&["--model", "C"]);
    let interval = &expected["prediction"]["efficiency"];
    assert!(interval["low"].as_f64() < interval["high"].as_f64());
    assert_eq!(expected["similarity"]["group"], "dry");
    assert!(expected["similarity"]["results"]["patch/thickness"].as_f64() > Some(0.05));
    for options in [&["--model", "A"][..], &["--model", "C", "--modes", "2"], &["--tolerance", "1e-3"]] {
        assert_eq!(of(options)["prediction"], expected["prediction"], "{options:?}");
    }
    let printed = impactcheck(&["reduced", "scaled-plate-r6.35"]).out;
    assert!(printed.contains("a converged reference would find (95 %, from "), "{printed}");
}

/// A scene unlike those of the base has no intervals, and the reason where details are wanted.
#[test]
fn a_scene_unlike_those_of_the_base_has_a_reason() {
    let scene = "scenes/validation/repeated-r10.toml";
    let found = json(&["reduced", scene, "--model", "A", "--json"]);
    let reason = found["prediction_reason"].as_str().expect("a reason");
    assert!(found["prediction"].is_null() && reason.contains("no repeated impacts"), "{reason}");
    assert!(
        !impactcheck(&["reduced", scene, "--model", "A"]).out.contains("a converged reference would find")
    );
    let verbose = impactcheck(&["-v", "reduced", scene, "--model", "A"]).error;
    assert!(flat(&verbose).contains(&flat(reason)), "{verbose}");
}
