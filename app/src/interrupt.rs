//! Ctrl-C, SIGTERM and a closed terminal: what runs is ended, what is half made goes, then the program ends as the signal
//! wants it to.
//!
//! Nothing else is needed for children whose parent dies without a word: `fem_reference` asks the system to be told
//! (`fem_reference/common/parent.py`).

use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::TempDir;

/// What an interruption has to clear away.
struct Open {
    children: Vec<u32>,
    /// Folders and files.
    paths: Vec<PathBuf>,
    /// Folders that go if they are empty by then.
    parents: Vec<PathBuf>,
    /// The exit status of a program that ends in no other way; `None` = it ends by the signal.
    status: Option<u8>,
}

static OPEN: Mutex<Open> =
    Mutex::new(Open { children: Vec::new(), paths: Vec::new(), parents: Vec::new(), status: None });

fn open() -> MutexGuard<'static, Open> {
    OPEN.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Open {
    /// Removes all that is open.
    fn clear(&self) {
        for path in &self.paths {
            let _ = std::fs::remove_dir_all(path).or_else(|_| std::fs::remove_file(path));
        }
        for parent in &self.parents {
            let _ = std::fs::remove_dir(parent);
        }
    }
}

/// From now on Ctrl-C, SIGTERM and SIGHUP leave no child, no [`Scratch`] folder and no [`Temporary`] file behind. A SIGHUP that
/// is ignored (`nohup`) stays ignored. For programs, called once.
///
/// # Errors
/// What the system says if it refuses.
#[cfg(unix)]
pub fn listen() -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM])?;
    if !unix::is_ignored(SIGHUP) {
        signals.handle().add_signal(SIGHUP)?;
    }
    let end = move || {
        if let Some(signal) = signals.forever().next() {
            // Held until the end: whoever waits for a child that ends now does not get to say that it failed.
            let open = open();
            unix::end(&open.children);
            open.clear();
            if let Some(status) = open.status {
                std::process::exit(status.into());
            }
            let _ = signal_hook::low_level::emulate_default_handler(signal);
        }
    };
    std::thread::Builder::new().name("signals".into()).spawn(end).map(drop)
}

/// Ends the children that run now; whoever waits for one is told that it failed. For an interruption that does not end the
/// program.
pub fn end_children() {
    #[cfg(unix)]
    {
        let children = open().children.clone();
        unix::end(&children);
    }
}

/// From now on an interruption is how the program is meant to end, with `status`.
pub fn ends_with(status: u8) {
    open().status = Some(status);
}

/// Other systems end children with their console.
#[cfg(not(unix))]
pub fn listen() -> io::Result<()> {
    Ok(())
}

#[cfg(unix)]
mod unix {
    use rustix::process::{Pid, Signal, kill_process, kill_process_group, test_kill_process};
    use std::thread::sleep;
    use std::time::{Duration, Instant};

    /// Whether this process ignores a signal, as Linux tells; elsewhere no.
    pub(super) fn is_ignored(signal: i32) -> bool {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
            .is_some_and(|m| m >> (signal - 1) & 1 == 1)
    }

    /// How long a child may take to end its own.
    const PATIENCE: Duration = Duration::from_millis(300);

    /// Ends at once what is left of the group that the process with this number leads.
    pub(super) fn end_group(leader: u32) {
        if let Some(leader) = i32::try_from(leader).ok().and_then(Pid::from_raw) {
            let _ = kill_process_group(leader, Signal::KILL);
        }
    }

    /// Ends the processes with these numbers; their owners take their leave of them.
    pub(super) fn end(children: &[u32]) {
        let pids = || children.iter().filter_map(|pid| Pid::from_raw(i32::try_from(*pid).ok()?));
        let send = |signal| pids().for_each(|pid| _ = kill_process(pid, signal));
        send(Signal::TERM);
        let start = Instant::now();
        while start.elapsed() < PATIENCE && pids().any(|pid| test_kill_process(pid).is_ok()) {
            sleep(Duration::from_millis(5));
        }
        send(Signal::KILL);
    }
}

/// A child that does not outlive its owner, however that ends.
#[derive(Debug)]
pub struct Running(Child);

impl Running {
    /// Starts `command`.
    ///
    /// # Errors
    /// What the system says if the program can't be started.
    pub fn start(command: &mut Command) -> io::Result<Self> {
        // An interruption comes before the start or finds the child in the list.
        let mut open = open();
        let child = command.env("IMPACTCHECK_PARENT", std::process::id().to_string()).spawn()?;
        open.children.push(child.id());
        Ok(Running(child))
    }

    /// Starts `command` as the leader of a group, which [`Running::end_group`] ends as a whole.
    ///
    /// # Errors
    /// As [`Running::start`].
    pub fn start_group(command: &mut Command) -> io::Result<Self> {
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(command, 0);
        Self::start(command)
    }

    /// Ends the process, and whatever it has started that is still in its group.
    pub fn end_group(&mut self) {
        #[cfg(unix)]
        unix::end_group(self.0.id());
        let _ = self.0.kill();
    }

    /// The process itself.
    pub fn child(&mut self) -> &mut Child {
        &mut self.0
    }

    /// Waits for its end.
    ///
    /// # Errors
    /// What the system says if it can't be waited for.
    pub fn wait(&mut self) -> io::Result<ExitStatus> {
        self.0.wait()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // Both do nothing to a child that has ended and been waited for.
        let _ = self.0.kill();
        let _ = self.0.wait();
        open().children.retain(|pid| *pid != self.0.id());
    }
}

/// A folder for what is half made; it goes with its owner, or when the program is interrupted.
#[derive(Debug)]
pub struct Scratch(TempDir);

impl Scratch {
    /// A new folder in `parent` whose name begins with `prefix`.
    ///
    /// # Errors
    /// What the system says if it can't be made.
    pub fn new_in(parent: &Path, prefix: &str) -> io::Result<Self> {
        let mut open = open();
        let folder = tempfile::Builder::new().prefix(prefix).tempdir_in(parent)?;
        open.paths.push(folder.path().to_path_buf());
        Ok(Scratch(folder))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.0.path()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        forget(self.0.path());
    }
}

fn forget(path: &Path) {
    open().paths.retain(|other| other != path);
}

/// A file that goes with its owner, or when the program is interrupted.
#[derive(Debug)]
pub struct Temporary(PathBuf);

impl Temporary {
    /// The file at `path`, which is there.
    pub fn new(path: PathBuf) -> Self {
        open().paths.push(path.clone());
        Temporary(path)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
        forget(&self.0);
    }
}

/// A folder that goes with its owner, or when the program is interrupted, unless something is in it.
#[derive(Debug)]
pub struct Parent(PathBuf);

impl Parent {
    /// The folder at `path`, made if need be.
    ///
    /// # Errors
    /// What the system says if it can't be made.
    pub fn new(path: &Path) -> io::Result<Self> {
        let mut open = open();
        std::fs::create_dir_all(path)?;
        let path = path.canonicalize()?;
        open.parents.push(path.clone());
        Ok(Parent(path))
    }

    /// Where it is, absolute.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Parent {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir(&self.0);
        let mut open = open();
        if let Some(own) = open.parents.iter().position(|path| *path == self.0) {
            open.parents.swap_remove(own);
        }
    }
}
