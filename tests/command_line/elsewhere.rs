//! The program away from the place it was built in: where it finds scenes and solver, and where solutions go.

use crate::store_fixture::{SCENE, write_entry};
use assert_cmd::cargo::cargo_bin;
use impactcheck::reference::Resolution;
use impactcheck::scene::Scene;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// A folder with a copy of the program, an empty home and a Python that plays the solver.
struct Elsewhere(TempDir);

impl Elsewhere {
    fn new() -> Self {
        let elsewhere = Elsewhere(tempfile::tempdir().expect("folder"));
        for folder in ["bin", "home", "here"] {
            fs::create_dir(elsewhere.path(folder)).expect("folder");
        }
        fs::copy(cargo_bin("impactcheck"), elsewhere.path("bin/impactcheck")).expect("a copy of the program");
        // It solves nothing, but it is started where the package is, as Python finds it.
        let script = format!(
            "#!/bin/sh\n[ -f fem_reference/__main__.py ] || exit 7\ncase $3 in\n\
             versions) pwd > {0}/seen; echo '{{\"python\": \"3\", \"fem_reference\": \"here\"}}' ;;\n\
             solve) cp -r {0}/prepared \"$7\" ;;\nesac\n",
            elsewhere.0.path().display()
        );
        fs::write(elsewhere.path("python"), script).expect("script");
        fs::set_permissions(elsewhere.path("python"), fs::Permissions::from_mode(0o755)).expect("executable");
        elsewhere
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// A scene file called `name`, and the solution that the solver will find for it.
    fn scene(&self, file: &str, name: &str) {
        let text = SCENE.replacen("scaled-plate-r10", name, 1);
        fs::create_dir_all(self.path(file).parent().expect("folder")).expect("folder");
        fs::write(self.path(file), &text).expect("scene");
        let _ = fs::remove_dir_all(self.path("prepared"));
        write_entry(&self.path("prepared"), &Scene::parse(file, &text).expect("valid"), Resolution::Paper);
    }

    /// A folder that is a project, with one scene.
    fn project(&self, folder: &str, name: &str) {
        self.scene(&format!("{folder}/scenes/{name}.toml"), name);
        fs::create_dir_all(self.path(folder).join("fem_reference")).expect("folder");
        fs::write(self.path(folder).join("fem_reference/__main__.py"), "").expect("package");
    }

    /// What the copy of the program does in the folder `current`.
    fn run(&self, current: &str, arguments: &[&str], variables: &[(&str, &Path)]) -> Output {
        let mut command = Command::new(self.path("bin/impactcheck"));
        command.env_clear().env("PATH", "/usr/bin:/bin").env("HOME", self.path("home"));
        command.env("IMPACTCHECK_PYTHON", self.path("python")).envs(variables.iter().copied());
        command.args(arguments).current_dir(self.path(current)).output().expect("runs")
    }

    #[track_caller]
    fn does(&self, current: &str, arguments: &[&str], variables: &[(&str, &Path)]) -> String {
        let output = self.run(current, arguments, variables);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {said}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// Where the solver was started.
    fn solver_ran_in(&self) -> PathBuf {
        let seen = fs::read_to_string(self.path("seen")).expect("the solver ran");
        PathBuf::from(seen.trim()).canonicalize().expect("a folder")
    }
}

#[test]
fn the_program_alone_brings_scenes_solutions_and_solver_along() {
    let elsewhere = Elsewhere::new();
    elsewhere.does("here", &["compare", "scaled-plate-r6.35", "--models", "A", "--out", "report"], &[]);
    assert!(elsewhere.path("here/report/index.html").is_file());
    elsewhere.scene("here/mine.toml", "mine");
    elsewhere.does("here", &["reference", "mine.toml"], &[]);
    let data = elsewhere.path("home/.local/share/impactcheck");
    assert!(data.join("solutions/mine/paper/summary.json").is_file());
    assert!(elsewhere.solver_ran_in().starts_with(data.canonicalize().expect("data")));
    // what is embedded is the package as it stands in the source tree
    let package = elsewhere.solver_ran_in().join("fem_reference");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("fem_reference");
    for file in ["explicit/kernel.c", "common/versions.py", "solid/meshing.py", "seal_seat/meshing.py"] {
        let bytes = |folder: &Path| fs::read(folder.join(file)).unwrap_or_else(|e| panic!("{file}: {e}"));
        assert_eq!(bytes(&package), bytes(&source), "{file}");
    }
    assert!(!package.join("tests").exists());
    // another time they lie ready, and the solution is found; this solver's contradicts itself
    let none = [("IMPACTCHECK_PYTHON", Path::new("/none"))];
    let output = elsewhere.run("here", &["reference", "mine.toml"], &none);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(11), "{said}");
    assert!(said.contains("found ") && said.contains("contradicts itself"), "{said}");
    let names = fs::read_dir(&data)
        .expect("data")
        .map(|e| e.expect("entry").file_name().into_string().expect("name"));
    let mut names: Vec<String> = names.collect();
    names.sort();
    assert!(names.len() == 2 && names[0].starts_with("project-") && names[1] == "solutions", "{names:?}");
}

#[test]
fn solutions_go_to_the_users_data_folder_or_to_the_store_named() {
    let elsewhere = Elsewhere::new();
    elsewhere.scene("here/mine.toml", "mine");
    let (data, store) = (elsewhere.path("data"), elsewhere.path("store"));
    elsewhere.does("here", &["reference", "mine.toml"], &[("XDG_DATA_HOME", &data)]);
    assert!(data.join("impactcheck/solutions/mine/paper").is_dir());
    assert!(!elsewhere.path("home/.local").exists());
    elsewhere.does("here", &["reference", "mine.toml"], &[("IMPACTCHECK_STORE", &store)]);
    assert!(store.join("mine/paper").is_dir());
}

#[test]
fn the_folder_that_impactcheck_home_names_comes_first() {
    let elsewhere = Elsewhere::new();
    elsewhere.project("named", "only-here");
    let named = elsewhere.path("named");
    elsewhere.does("here", &["reduced", "only-here", "--model", "A"], &[("IMPACTCHECK_HOME", &named)]);
    elsewhere.does("here", &["reference", "only-here"], &[("IMPACTCHECK_HOME", &named)]);
    assert_eq!(elsewhere.solver_ran_in(), named.canonicalize().expect("named"));
    assert!(
        !named.join("fem_reference/solutions").exists(),
        "a copy without source tree is not written into"
    );
    let output =
        elsewhere.run("here", &["reduced", "only-here"], &[("IMPACTCHECK_HOME", &elsewhere.path("bin"))]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("IMPACTCHECK_HOME") && said.contains("fem_reference"), "{said}");
}

#[test]
fn files_next_to_the_program_are_found() {
    let elsewhere = Elsewhere::new();
    elsewhere.project("share/impactcheck", "installed");
    elsewhere.does("here", &["reduced", "installed", "--model", "A"], &[]);
    assert!(!elsewhere.path("home/.local").exists(), "nothing is unpacked");
}

#[test]
fn a_checkout_takes_new_solutions_of_its_own_scenes_only() {
    let elsewhere = Elsewhere::new();
    elsewhere.project("checkout", "its-own");
    fs::write(elsewhere.path("checkout/Cargo.toml"), "").expect("source tree");
    elsewhere.does("checkout", &["reference", "its-own"], &[]);
    let solutions = elsewhere.path("checkout/fem_reference/solutions");
    assert!(solutions.join("its-own/paper").is_dir());
    elsewhere.scene("checkout/mine.toml", "mine");
    elsewhere.does("checkout", &["reference", "mine.toml"], &[]);
    assert!(!solutions.join("mine").exists(), "never into the source tree");
    assert!(elsewhere.path("home/.local/share/impactcheck/solutions/mine/paper").is_dir());
    let compared = ["compare", "mine.toml", "its-own", "--models", "A", "--out", "report"];
    elsewhere.does("checkout", &compared, &[("IMPACTCHECK_PYTHON", Path::new("/none"))]);
}

#[test]
fn doctor_lists_what_the_solver_cannot_import_and_where_the_files_are() {
    let elsewhere = Elsewhere::new();
    let answer = r#"echo '{"python": "3.11", "fem_reference": null, "dolfinx": "0.5.2", "meshio": null}'"#;
    fs::write(elsewhere.path("python"), format!("#!/bin/sh\n{answer}\n")).expect("script");
    let checks = |variables: &[(&str, &Path)]| -> Vec<serde_json::Value> {
        let output = elsewhere.run("here", &["doctor", "--json"], variables);
        assert_eq!(output.status.code(), Some(12), "ill");
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let listed = checks(&[]);
    let check = |name: &str| listed.iter().find(|c| c["name"] == name).unwrap_or_else(|| panic!("{name}"));
    assert!(check("meshio")["found"].is_null() && check("fem_reference")["found"].is_null());
    let install = check("meshio")["install"].as_str().expect("text");
    assert!(
        install.contains("python -m pip install meshio") && install.contains("python3-meshio"),
        "{install}"
    );
    assert_eq!(check("dolfinx")["found"], "0.5.2");
    assert!(check("Python")["found"].as_str().expect("text").contains("IMPACTCHECK_PYTHON"));
    assert!(
        check("small reference")["needed_for"]
            .as_str()
            .expect("text")
            .contains("it has no fem_reference, meshio")
    );
    let root = check("project files")["found"].as_str().expect("text").to_owned();
    assert!(Path::new(&root).starts_with(elsewhere.path("home")), "{root}");
    let lost = checks(&[("IMPACTCHECK_HOME", Path::new("/none"))]);
    let files = lost.iter().find(|c| c["name"] == "project files").expect("a check");
    assert!(files["found"].is_null() && files["needed_for"].as_str().expect("text").contains("/none"));
    assert!(lost.iter().any(|c| c["name"] == "Python" && c["found"].is_null()));
}

/// All modules are there, but the solver does not run: versions alone would not show it.
#[test]
fn doctor_solves_a_small_reference() {
    let elsewhere = Elsewhere::new();
    let script = "#!/bin/sh\ncase $3 in\nversions) echo '{\"python\": \"3.12\", \"dolfinx\": \"0.11.0\"}' ;;\n\
                  solve) echo '{\"phase\": \"error\", \"message\": \"unexpected TypeError in create_mesh\"}'; exit 1 ;;\nesac\n";
    fs::write(elsewhere.path("python"), script).expect("script");
    let output = elsewhere.run("here", &["doctor", "--json"], &[]);
    assert_eq!(output.status.code(), Some(12), "ill");
    let checks: Vec<serde_json::Value> = serde_json::from_slice(&output.stdout).expect("JSON");
    let trial = checks.iter().find(|c| c["name"] == "small reference").expect("a check");
    assert!(trial["found"].is_null());
    let why = trial["needed_for"].as_str().expect("text");
    assert!(why.contains("unexpected TypeError in create_mesh"), "{why}");
    assert!(!elsewhere.path("home/.local/share/impactcheck/solutions").exists(), "nothing is stored");
}
