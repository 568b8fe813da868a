//! Scene files as files: what is no scene is refused before it is believed, names find the
//! shipped scenes, and the hash of a scene is its physics.

use impactcheck::scene::{self, MAX_FILE_BYTES, Scene};
use impactcheck::{Error, ExitStatus};

const VALID: &str = include_str!("../fixtures/plate-impact.toml");

fn parse(text: &str) -> Scene {
    Scene::parse("scene.toml", text).expect("valid scene")
}

/// The valid scene with `from` replaced once; fails if there is nothing to replace.
fn edited(from: &str, to: &str) -> String {
    assert!(VALID.contains(from), "`{from}` is not in the scene");
    VALID.replacen(from, to, 1)
}

/// What reading `bytes` from a file says.
fn read_error(bytes: &[u8]) -> String {
    let file = tempfile::NamedTempFile::new().expect("temporary file");
    std::fs::write(file.path(), bytes).expect("written");
    let error = Scene::read(file.path()).expect_err("refused");
    assert_eq!(error.exit_status(), ExitStatus::InvalidScene);
    flat(&error)
}

/// The message without the line breaks and frames of the terminal.
fn flat(error: &Error) -> String {
    let text = error.to_string().replace(['\u{2502}', '\u{d7}', '|'], " ");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn files_that_are_no_scene_are_refused() {
    assert!(read_error(b"").contains("no content"));
    assert!(read_error(b"# only a comment\n").contains("no content"));
    assert!(read_error(b"name = \"x\"\n\0\x01ELF").contains("line 2: not a text file"));
    assert!(read_error(b"name = \"x\"\n# \xff\n").contains("line 2: not valid UTF-8 (byte 13 is 0xff)"));

    let folder = tempfile::tempdir().expect("temporary folder");
    let error = Scene::read(folder.path()).expect_err("a folder");
    assert_eq!(error.exit_status(), ExitStatus::InvalidScene);
    assert!(flat(&error).contains("is a folder, not a scene file"));

    let missing = folder.path().join("missing.toml");
    let error = Scene::read(&missing).expect_err("no file");
    assert_eq!(error.exit_status(), ExitStatus::Usage);
    assert!(flat(&error).contains("there is no scene file") && flat(&error).contains("missing.toml"));
}

#[test]
fn a_file_of_100_mb_is_refused_by_its_size() {
    let file = tempfile::NamedTempFile::new().expect("temporary file");
    file.as_file().set_len(100_000_000).expect("sparse file");
    let error = Scene::read(file.path()).expect_err("too large");
    assert_eq!(error.exit_status(), ExitStatus::InvalidScene);
    let said = flat(&error);
    assert!(said.contains("100000000 bytes") && said.contains("at most 1048576"), "{said}");
    assert_eq!(MAX_FILE_BYTES, 1_048_576);
}

#[test]
#[cfg(target_os = "linux")]
fn an_endless_device_is_not_read_to_its_end() {
    let said = flat(&Scene::read("/dev/zero").expect_err("endless"));
    assert!(said.contains("more than 1048576 bytes"), "{said}");
}

#[test]
fn an_unknown_name_lists_the_shipped_scenes() {
    let error = scene::resolve("scaled-plate-r1O").expect_err("no such scene");
    assert_eq!(error.exit_status(), ExitStatus::Usage);
    assert_eq!(error.hints()[0], "did you mean `scaled-plate-r10`?");
    assert!(error.hints()[1].contains("scaled-plate-r6.35"), "{error:?}");
    assert!(scene::resolve("").is_err() && scene::resolve("../nothing").is_err());
}

#[test]
fn hash_is_the_physics_and_nothing_else() {
    let hash = |text: &str| parse(text).hash();
    let original = hash(VALID);
    assert_eq!(original.len(), 64);
    for (from, to) in [
        ("scaled-plate-r10", "other"),
        ("10 mm spheres", "ten"),
        ("\"33 mm\"", "0.033"),
        ("modes = 16", "modes = 8"),
        ("radius = 12", "radius = 6"),
        ("[reduced]", "gap = \"-0 mm\"\n[reduced]"),
    ] {
        assert_eq!(hash(&edited(from, to)), original, "{from}");
    }
    assert_eq!(hash(&VALID.replace("steel", "iron")), original, "a material's name");
    assert_eq!(hash(&format!("{VALID}[tolerances.B]\nefficiency = 1\n")), original);
    for (from, to) in [
        ("33 mm", "33.000001 mm"),
        ("0.3\n", "0.31\n"),
        ("clamped", "free"),
        ("550", "551"),
        ("[reduced]", "gap = \"1 um\"\n[reduced]"),
        ("[reduced]", "[run]\nend_time = \"1 ms\"\n[reduced]"),
        ("[reduced]", "[fluid]\nviscosity = 1e-3\ndensity = 1e3\nminimum_gap = 1e-6\n[reduced]"),
    ] {
        assert_ne!(hash(&edited(from, to)), original, "{from}");
    }
}
