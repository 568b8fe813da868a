//! Programs of the user's as models: allowed, judged like any other, and unable to stop anything by whatever they do.

use assert_cmd::Command;
use serde_json::Value;
use std::path::{Path, PathBuf};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

struct Gated {
    status: Option<i32>,
    document: Value,
    messages: String,
}

/// `gate` on a scene file, with further arguments.
fn gate(scene: &Path, arguments: &[&str], allowed: Option<&str>) -> Gated {
    let out = tempfile::tempdir().unwrap();
    let mut command = Command::cargo_bin("impactcheck").unwrap();
    command.arg("gate").arg(scene).args(arguments).arg("--json").arg("--out").arg(out.path());
    command.current_dir(ROOT).env_remove("IMPACTCHECK_STORE").env_remove("IMPACTCHECK_ALLOW_EXTERNAL");
    // the python3 of `make setup` or of the system has SciPy
    command
        .env("PATH", format!("{ROOT}/target/python-tools/bin:/usr/bin:{}", std::env::var("PATH").unwrap()));
    command.envs(allowed.map(|value| ("IMPACTCHECK_ALLOW_EXTERNAL", value)));
    let output = command.output().unwrap();
    Gated {
        status: output.status.code(),
        document: serde_json::from_slice(&output.stdout).unwrap_or(Value::Null),
        messages: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

impl Gated {
    fn model(&self, name: &str) -> &Value {
        let models = self.document["scenes"][0]["models"].as_array();
        let models = models.unwrap_or_else(|| panic!("{}", self.messages));
        models.iter().find(|model| model["model"] == name).unwrap_or_else(|| panic!("no model {name}"))
    }
}

/// A scene of Table 1 with programs, name and shell line each, and more text.
fn scene(folder: &Path, programs: &[(&str, &str)], more: &str) -> PathBuf {
    let text = std::fs::read_to_string(format!("{ROOT}/scenes/scaled-plate-r10.toml")).unwrap();
    let entry = |(name, line): &(&str, &str)| {
        format!(
            "[[external]]\nname = \"{name}\"\ncommand = [\"sh\", \"-c\", '''{line}''']\ntimeout = \"300 s\"\n"
        )
    };
    let file = folder.join("scene.toml");
    let programs: String = programs.iter().map(entry).collect();
    std::fs::write(&file, text + "\n" + &programs + more).unwrap();
    file
}

#[test]
fn nothing_runs_unless_the_user_allows_it() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), &[("mine", "echo ran >> it-ran; echo \"{}\"")], "");
    for refused in [gate(&scene, &[], None), gate(&scene, &[], Some("0"))] {
        assert_eq!(refused.status, Some(2), "{}", refused.messages);
        assert!(
            refused.messages.contains("`sh -c echo ran") && refused.messages.contains("--allow-external")
        );
    }
    assert_eq!(gate(&scene, &["--models", "C"], None).status, Some(0));
    assert!(!folder.path().join("it-ran").exists());
    for allowed in [
        gate(&scene, &["--models", "C,external", "--allow-external"], None),
        gate(&scene, &["--models", "external"], Some("1")),
    ] {
        assert_eq!(allowed.status, Some(0), "{}", allowed.messages);
    }
    // in the scene's folder, once each
    assert_eq!(std::fs::read_to_string(folder.path().join("it-ran")).unwrap(), "ran\nran\n");
}

/// The examples of the guide are the paper's models B and A, and as far off.
#[test]
fn models_of_ones_own_are_judged_as_those_of_the_program() {
    let example = Path::new(ROOT).join("examples/external/scaled-plate-r10.toml");
    let judged = gate(&example, &["--models", "A,B,external", "--allow-external"], None);
    assert_eq!(judged.status, Some(0), "{}", judged.messages);
    for (name, own, gated) in [("scipy", "B", 12), ("awk", "A", 11)] {
        let (theirs, ours) = (judged.model(name), judged.model(own));
        let source = &theirs["summary"]["source"];
        assert_eq!((&theirs["verdict"], source), (&"pass".into(), &"external".into()));
        let rows = theirs["discrepancies"].as_array().unwrap();
        assert_eq!(rows.iter().filter(|row| row["verdict"] == "pass").count(), gated, "{name}");
        for quantity in ["efficiency", "outer_velocity_final", "outer_force_peak", "inner_force_peak"] {
            let [theirs, ours] = [theirs, ours].map(|model| model["summary"][quantity].as_f64().unwrap());
            assert!((theirs / ours - 1.0).abs() < 1e-3, "{name}: {quantity} {theirs} {ours}");
        }
    }
    // as far off is not right: the same program under a tolerance without its known error
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(&example).unwrap();
    std::fs::copy(example.with_file_name("model_a.awk"), folder.path().join("model_a.awk")).unwrap();
    let strict = folder.path().join("strict.toml");
    std::fs::write(&strict, text.replace("absolute = 0.002, bias = -0.1332", "absolute = 0.002")).unwrap();
    std::fs::write(folder.path().join("model_b.py"), "print('{}')").unwrap();
    assert_eq!(gate(&strict, &["--models", "external", "--allow-external"], None).status, Some(10));
}

/// Whatever a program does, the others have their results, and it is said what is wrong with this one.
#[test]
fn a_program_that_fails_is_reported_and_stops_nothing() {
    let failing = [
        ("fails", "echo broken >&2; exit 3", "it failed (exit status: 3); its last messages: broken"),
        ("hangs", "sleep 1000", "it was not done after 0.5 s (timeout) and was ended"),
        ("nan", "echo '{\"efficiency\": NaN}'", "JSON has no NaN and no infinity: write null"),
        (
            "unordered",
            "echo '{\"history\": {\"time\": [0, 2e-6, 1e-6], \"outer_velocity\": [1, 1, 1]}}'",
            "sample 3 is at 0.000001 s, not after 0.000002 s",
        ),
        ("half", "printf '{\"efficiency\": 0.6'", "it ends in the middle of a JSON document"),
        ("chatty", "echo loading; echo '{}'", "it begins with `loading`"),
        ("trailing", "echo '{}'; echo done", "messages belong on standard error"),
        ("huge", "head -c 70000000 /dev/zero", "it wrote more than 64 MiB to standard output"),
        ("silent", "true", "its answer can't be used: it is empty"),
        ("version", "echo '{\"schema_version\": 2}'", "its schema_version is 2; this program reads 1"),
        ("killed", "kill -9 $$", "it failed (signal: 9"),
        ("missing", "", "there is no program `no-such-program` on PATH"),
    ];
    // nothing is wrong with their form, but they contradict the scene or themselves
    let lying = [
        (
            "units",
            "echo '{\"history\": {\"time\": [0, 1e-6, 2e-6], \"outer_velocity\": [-550, -549, -548]}}'",
            "outer_velocity_start",
        ),
        ("lies", "echo '{\"efficiency\": 0.9, \"inner_velocity_final\": -0.1}'", "efficiency"),
    ];
    let fine = [
        ("forks", "sleep 1000 & echo '{\"efficiency\": 0.6947, \"efficency\": 1}'"),
        ("noisy", "yes noise | head -c 3000000 >&2; echo '{\"efficiency\": 0.6947}'"),
    ];
    let lines = failing.iter().chain(&lying).map(|(name, line, _)| (*name, *line)).chain(fine);
    let folder = tempfile::tempdir().unwrap();
    let bounds = fine.map(|(name, _)| format!("[tolerances.{name}]\nefficiency = 0.001\n")).concat();
    let file = scene(folder.path(), &lines.collect::<Vec<_>>(), &bounds);
    let text = std::fs::read_to_string(&file).unwrap();
    let text = text.replace("[\"sh\", \"-c\", '''''']", "[\"no-such-program\"]");
    let hangs = "'''sleep 1000''']\ntimeout = \"300 s\"";
    std::fs::write(&file, text.replace(hangs, &hangs.replace("300 s", "0.5 s"))).unwrap();

    let start = std::time::Instant::now();
    let judged = gate(&file, &["--models", "C,external", "--allow-external"], None);
    assert_eq!(judged.status, Some(12), "a program has failed: {}", judged.messages);
    assert!(start.elapsed().as_secs() < 900, "nobody waited for what was left behind");
    for (name, _, part) in failing {
        let model = judged.model(name);
        let failure = model["summary"]["failure"].as_str().unwrap_or_else(|| panic!("{name} has not failed"));
        assert!(failure.contains(part), "{name}: {failure}");
        assert!(judged.messages.contains(failure), "{name} is reported on standard error");
        assert_eq!((&model["verdict"], &model["summary"]["efficiency"]), (&"fail".into(), &Value::Null));
    }
    for (name, _, check) in lying {
        let model = judged.model(name);
        assert_eq!((&model["verdict"], &model["summary"]["failure"]), (&"fail".into(), &Value::Null));
        let checks = model["integrity"].as_array().unwrap();
        let caught = checks.iter().any(|c| c["check"] == check && c["verdict"] == "fail");
        assert!(caught, "{name}: {checks:?}");
    }
    for name in ["C", "forks", "noisy"] {
        assert_eq!(judged.model(name)["verdict"], "pass", "{name}");
    }
    let misspelt = judged.model("forks")["summary"]["warnings"][0].as_str().unwrap();
    assert!(misspelt.contains("did you mean `efficiency`?"), "{misspelt}");
}

/// What is possible in itself and not in this impact, a list in the place of a document, and one with a byte order mark.
#[test]
fn an_answer_has_to_be_a_document_that_mechanics_allows() {
    let programs = [
        (
            "sign",
            r#"echo '{"efficiency": 0.6947, "outer_velocity_final": -0.2957, "inner_velocity_final": 0.4584}'"#,
        ),
        (
            "microseconds",
            r#"echo '{"history": {"time": [0, 40, 80, 120, 160, 200], "outer_velocity": [-0.55, -0.4, -0.1, 0.1, 0.25, 0.2957]}}'"#,
        ),
        ("list", r#"echo '[{"efficiency": 0.6947}]'"#),
        ("mark", r#"printf '\357\273\277{"efficiency": 0.6947}'"#),
    ];
    let folder = tempfile::tempdir().unwrap();
    let file = scene(folder.path(), &programs, "[tolerances.mark]\nefficiency = 0.001\n");
    let judged = gate(&file, &["--models", "external", "--allow-external"], None);
    assert_eq!(judged.status, Some(12), "{}", judged.messages);
    for (name, laws) in [
        ("sign", &["inner_velocity_final_direction", "outer_velocity_final_direction"]),
        ("microseconds", &["outer_push_time", "outer_depth"]),
    ] {
        let model = judged.model(name);
        let checks = model["integrity"].as_array().unwrap();
        let broken = checks.iter().filter(|check| check["verdict"] == "fail");
        let broken: Vec<_> = broken.map(|check| check["check"].as_str().unwrap()).collect();
        let all = laws.iter().all(|law| broken.contains(law));
        assert!(model["verdict"] == "fail" && all, "{name}: {broken:?}");
    }
    let failure = judged.model("list")["summary"]["failure"].as_str().unwrap();
    assert!(failure.contains("it is a JSON list, not an object"), "{failure}");
    assert_eq!(judged.model("mark")["verdict"], "pass");
}
