//! Ctrl-C, SIGTERM and a closed terminal: the solver ends with the program, and nothing half made is left.

use crate::store_fixture::SCENE;
use crate::waiting::wait_until;
use assert_cmd::cargo::cargo_bin;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};

fn is_running(pid: &str) -> bool {
    let state = Command::new("ps").args(["-o", "stat=", "-p", pid]).output().expect("ps").stdout;
    !state.is_empty() && state[0] != b'Z'
}

/// Interrupts a run of a solver that does `script`; its process number stands in `$here/pid`.
fn interrupted(signal: &str, number: i32, script: &str) {
    interrupted_in(":", &[signal], number, script);
}

/// The same in a shell that does `before` first.
fn interrupted_in(before: &str, signals: &[&str], number: i32, script: &str) {
    let folder = tempfile::tempdir().expect("folder");
    let here = folder.path();
    let python = here.join("python");
    let text = format!(
        "#!/bin/sh\nhere='{}'\n[ $3 = versions ] && {{ echo '{{\"python\": \"3\"}}'; exit; }}\nmkdir \"$7\"\n{script}\n",
        here.display()
    );
    fs::write(&python, text).expect("script");
    fs::set_permissions(&python, fs::Permissions::from_mode(0o755)).expect("executable");
    fs::write(here.join("mine.toml"), SCENE.replacen("scaled-plate-r10", "mine", 1)).expect("scene");
    fs::create_dir(here.join("temporary")).expect("folder");
    let mut program = Command::new("sh")
        .arg("-c")
        .arg(format!("{before}; exec \"$0\" reference mine.toml --store store"))
        .arg(cargo_bin("impactcheck"))
        .current_dir(here)
        .env("IMPACTCHECK_PYTHON", &python)
        .env("TMPDIR", here.join("temporary"))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("runs");
    wait_until(|| here.join("pid").exists(), || "the solver does not start".to_owned());
    let pid = fs::read_to_string(here.join("pid")).expect("pid");
    assert!(is_running(pid.trim()));
    let signal = signals.join(", ");
    for sent in signals {
        let kill = Command::new("kill").args([*sent, &program.id().to_string()]).status();
        assert!(kill.expect("kill").success());
    }
    let status = program.wait().expect("ends");
    assert_eq!(status.signal(), Some(number), "ends as the signal wants it to: {status}");
    assert!(!is_running(pid.trim()), "{signal}: the solver runs on");
    assert!(!here.join("store/mine").exists(), "{signal}: the scene's empty folder is left");
    let left: Vec<_> = fs::read_dir(here.join("temporary")).expect("folder").flatten().collect();
    assert!(left.is_empty(), "{signal}: {left:?}");
}

const LONG: &str = "echo $$ > \"$here/half\"; mv \"$here/half\" \"$here/pid\"; exec sleep 1000";

#[test]
fn ctrl_c_sigterm_and_a_closed_terminal_end_the_solver_and_leave_nothing() {
    interrupted("-HUP", 1, LONG);
    interrupted("-INT", 2, LONG);
    interrupted("-TERM", 15, LONG);
}

#[test]
fn a_solver_that_does_not_listen_is_ended_all_the_same() {
    let deaf = "trap '' TERM; echo $$ > \"$here/half\"; mv \"$here/half\" \"$here/pid\"; while :; do read x; done < /dev/zero";
    interrupted("-INT", 2, deaf);
}

#[test]
fn nohup_outlives_its_terminal() {
    interrupted_in("trap '' HUP", &["-HUP", "-TERM"], 15, LONG);
}
