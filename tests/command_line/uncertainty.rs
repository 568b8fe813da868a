//! How results scatter with the inputs, from the command line.

use super::program::{impactcheck, json, text};
use serde_json::Value;
use std::fs;

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/uncertainty/table1-r10.toml");

#[test]
fn the_input_uncertainty_of_a_scene_is_propagated_and_a_study_resumes() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let study = |samples: &str| {
        json(&["uncertainty", SCENE, "--model", "B", "--samples", samples, "--out", text(&out), "--json"])
    };
    let first = study("64");
    let efficiency = &first["quantities"]["efficiency"];
    let of = |name: &str| efficiency[name].as_f64().unwrap_or_else(|| panic!("{name}: {efficiency}"));
    assert!((of("mean") - 0.696).abs() < 0.002, "{efficiency}");
    let slopes = of("linear_standard_deviation") / of("standard_deviation");
    assert!((slopes - 1.0).abs() < 0.05, "{efficiency}");
    let shares = efficiency["sobol"].as_object().expect("inputs");
    let sum: f64 = shares.values().map(|share| share["first"].as_f64().unwrap()).sum();
    // of 64 samples the indices are known as far as their intervals say
    let half = |share: &Value| 0.5 * (share[1].as_f64().unwrap() - share[0].as_f64().unwrap());
    let known: f64 = shares.values().map(|share| half(&share["first_interval"]).powi(2)).sum::<f64>().sqrt();
    assert!(shares.len() == 7 && (sum - 1.0).abs() < known && known < 0.5, "{efficiency}");
    let quantile = |name: &str| efficiency["quantiles"][name].as_f64().unwrap();
    assert!(quantile("0.025") < quantile("0.5") && quantile("0.5") < quantile("0.975"));
    for file in ["samples.parquet", "uncertainty.json", "uncertainty.svg", "uncertainty.png"] {
        assert!(out.join(file).is_file(), "{file}");
    }
    // the log is that of the first 64 samples, whatever comes after
    let log = out.join("1-of-1.records");
    let before = fs::read(&log).unwrap();
    let more = study("128");
    let after = fs::read(&log).unwrap();
    assert!(after.starts_with(&before) && after.len() > before.len());
    assert_eq!(study("64"), first);
    assert_eq!(fs::read(&log).unwrap(), after);
    assert_eq!(more["impacts"], Value::from(128 * 9 + 15));
}

#[test]
fn what_can_t_be_sampled_is_refused() {
    for (arguments, part) in [
        (&["uncertainty", "scaled-plate-r10"][..], "has no uncertain inputs"),
        (&["uncertainty", SCENE, "--samples", "8"], "8 samples: 16 to"),
        (&["uncertainty", SCENE, "--samples", "many"], "neither a number nor auto"),
        (&["uncertainty", SCENE, "--quantity", "eficiency"], "did you mean `efficiency`?"),
    ] {
        let ended = impactcheck(arguments);
        assert_eq!(ended.status, 2, "{}", ended.error);
        assert!(ended.error.contains(part), "{}", ended.error);
    }
}

#[test]
fn differences_are_compared_with_the_input_uncertainty() {
    let folder = tempfile::tempdir().unwrap();
    let compared = |scene: &str, out: &str| {
        json(&["compare", scene, "--models", "B,C", "--json", "--out", text(&folder.path().join(out))])
    };
    let (plain, uncertain) = (compared("scaled-plate-r10", "plain"), compared(SCENE, "uncertain"));
    let rows =
        |document: &Value| document["scenes"][0]["models"][0]["discrepancies"].as_array().unwrap().clone();
    let (plain, uncertain) = (rows(&plain), rows(&uncertain));
    for (plain, uncertain) in plain.iter().zip(&uncertain) {
        assert!(plain.get("validation").is_none(), "{plain}");
        assert_eq!(plain["difference"], uncertain["difference"]);
    }
    let row =
        |name: &str| uncertain.iter().find(|row| row["quantity"] == name).expect(name)["validation"].clone();
    // B is off by 10 % in the inner force and by 0.2 % in the efficiency; the inputs scatter them by 1.7 % and 0.7 %
    assert_eq!(row("inner_force_peak")["verdict"], "model error shown");
    assert_eq!(row("efficiency")["verdict"], "within");
    let parts = &row("efficiency")["parts"];
    let square = |value: &Value| value.as_f64().map_or(0.0, |u| u * u);
    let sum = ["u_num", "u_input", "u_D"].iter().map(|name| square(&parts[name])).sum::<f64>();
    assert!((sum / square(&row("efficiency")["u_val"]) - 1.0).abs() < 1e-9, "{parts}");
    let page = fs::read_to_string(folder.path().join("uncertain/scaled-plate-r10.html")).unwrap();
    assert!(page.contains("Uncertain inputs") && page.contains("2 u_val, inputs included"));
}
