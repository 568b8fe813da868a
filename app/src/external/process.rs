//! One run of a program that nobody can vouch for: bounded in time and output, ended with all that it has started.

use crate::interrupt::Running;
use crate::process_output::tail;
use std::io::{Read, Write};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread::{sleep, spawn};
use std::time::{Duration, Instant};

/// Most bytes of an answer that are read.
pub(super) const MOST_BYTES: u64 = 64 << 20;
/// How long after its end the output of a program may take to be read.
const PATIENCE: Duration = Duration::from_secs(5);
/// Longest time between two looks at a running program.
const LONGEST_LOOK: Duration = Duration::from_millis(20);

/// What a program has said and how it ended.
#[derive(Debug)]
pub(super) struct Said {
    /// Its standard output, of which more than [`MOST_BYTES`] is left out.
    pub(super) output: Vec<u8>,
    /// The last lines of its standard error.
    pub(super) log: String,
    /// How it ended; `None`: it was ended after its time.
    pub(super) status: Option<ExitStatus>,
}

/// Runs `command` with `input` on its standard input, for at most `limit`.
///
/// # Errors
/// What the system says if the program can't be started or waited for; [`std::io::ErrorKind::TimedOut`] if its output does
/// not end with it, because something that it has started and that is no longer in its group holds it open.
pub(super) fn run(mut command: Command, input: Vec<u8>, limit: Duration) -> std::io::Result<Said> {
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut running = Running::start_group(&mut command)?;
    let (stdin, stdout, stderr) =
        (running.child().stdin.take(), running.child().stdout.take(), running.child().stderr.take());
    // a program may answer before it has read its question, or without
    spawn(move || stdin.map(|mut stdin| stdin.write_all(&input)));
    let output = answer(move || {
        let mut bytes = Vec::new();
        let read = stdout.map(|stdout| stdout.take(MOST_BYTES + 1).read_to_end(&mut bytes));
        read.transpose().map(|_| bytes)
    });
    let log = answer(move || stderr.map(tail).unwrap_or_default());
    let status = wait(&mut running, limit)?;
    // what it has left behind would hold its output open
    running.end_group();
    let output = output.recv_timeout(PATIENCE).map_err(|_| std::io::ErrorKind::TimedOut)??;
    Ok(Said { output, log: log.recv_timeout(PATIENCE).unwrap_or_default(), status })
}

/// What `read` gives, in a thread of its own that nobody has to wait for.
fn answer<T: Send + 'static>(read: impl FnOnce() -> T + Send + 'static) -> Receiver<T> {
    let (done, wait) = channel();
    spawn(move || done.send(read()));
    wait
}

/// Waits for the end of a program; `None` if that does not come in time.
fn wait(running: &mut Running, limit: Duration) -> std::io::Result<Option<ExitStatus>> {
    let start = Instant::now();
    let mut look = Duration::from_millis(1);
    loop {
        if let Some(status) = running.child().try_wait()? {
            return Ok(Some(status));
        }
        let left = limit.saturating_sub(start.elapsed());
        if left.is_zero() {
            return Ok(None);
        }
        sleep(look.min(left));
        look = (2 * look).min(LONGEST_LOOK);
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::io::ErrorKind;

    fn shell(line: &str) -> std::io::Result<Said> {
        let mut command = Command::new("sh");
        command.args(["-c", line]);
        run(command, Vec::new(), Duration::from_secs(20))
    }

    /// What is in the program's group ends with it; what is not can hold its output, and nobody waits for that.
    #[test]
    fn whatever_a_program_leaves_behind_is_not_waited_for() {
        let start = Instant::now();
        assert_eq!(shell("sleep 600 & echo done").expect("an answer").output, b"done\n");
        // ends once what it has started has left the group
        let line =
            r#"trap 'echo done; exit' USR1; setsid sh -c "kill -USR1 $$; exec sleep 60" & sleep 20 & wait"#;
        let failed = shell(line).expect_err("its output is open");
        assert_eq!(failed.kind(), ErrorKind::TimedOut);
        assert!(start.elapsed() < Duration::from_secs(50));
    }
}
