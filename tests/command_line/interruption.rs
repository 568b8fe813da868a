//! Ctrl-C, SIGTERM and a closed terminal: the solver ends with the program, and nothing half made is left.

use crate::store_fixture::SCENE;
use crate::waiting::wait_until;
use assert_cmd::cargo::cargo_bin;
use rustix::process::{Pid, Signal, kill_process, test_kill_process};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};

/// A zombie, which a container may not bury, is none.
fn is_running(pid: &str) -> bool {
    let number = Pid::from_raw(pid.parse().expect("number")).expect("pid");
    let is_zombie = fs::read_to_string(format!("/proc/{pid}/stat")).is_ok_and(|stat| stat.contains(") Z "));
    test_kill_process(number).is_ok() && !is_zombie
}

/// Interrupts a run of a solver that does `script`; its process number stands in `$here/pid`.
fn interrupted(signal: Signal, number: i32, script: &str) {
    interrupted_in(":", &[signal], number, script);
}

/// The same in a shell that does `before` first.
fn interrupted_in(before: &str, signals: &[Signal], number: i32, script: &str) {
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
    // a test run under nohup, which ignores SIGHUP, hands that on to its children
    let mut program = Command::new("env")
        .args(["--default-signal=HUP", "sh", "-c"])
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
    let signal = format!("{signals:?}");
    for sent in signals {
        kill_process(Pid::from_child(&program), *sent).expect("runs");
    }
    let status = program.wait().expect("ends");
    assert_eq!(status.signal(), Some(number), "ends as the signal wants it to: {status}");
    // a signal takes its time on a busy machine
    wait_until(|| !is_running(pid.trim()), || format!("{signal}: the solver runs on"));
    assert!(!here.join("store/mine").exists(), "{signal}: the scene's empty folder is left");
    let left: Vec<_> = fs::read_dir(here.join("temporary")).expect("folder").flatten().collect();
    assert!(left.is_empty(), "{signal}: {left:?}");
}

const LONG: &str = "echo $$ > \"$here/half\"; mv \"$here/half\" \"$here/pid\"; exec sleep 1000";

#[test]
fn ctrl_c_sigterm_and_a_closed_terminal_end_the_solver_and_leave_nothing() {
    interrupted(Signal::HUP, 1, LONG);
    interrupted(Signal::INT, 2, LONG);
    interrupted(Signal::TERM, 15, LONG);
}

#[test]
fn a_solver_that_does_not_listen_is_ended_all_the_same() {
    let deaf = "trap '' TERM; echo $$ > \"$here/half\"; mv \"$here/half\" \"$here/pid\"; while :; do read x; done < /dev/zero";
    interrupted(Signal::INT, 2, deaf);
}

#[test]
fn nohup_outlives_its_terminal() {
    interrupted_in("trap '' HUP", &[Signal::HUP, Signal::TERM], 15, LONG);
}
