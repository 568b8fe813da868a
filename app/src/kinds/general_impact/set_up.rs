//! What the set-up of an elastic body takes, stated before it begins.

use crate::kinds::general_impact::set_announcer;
use crate::{Error, Result};
use std::path::Path;

/// Bytes per unknown of a thin body, and besides, of the Cholesky factor of a bulky one, per unknown to the power of 4/3. Measured: plates of
/// 44 000 and 102 000 unknowns 0.29 and 0.58 GB; blocks of 75 000, fine at the contact alone, 0.68 GB, and of 154 000, fine throughout, 3.1 GB.
const PER_UNKNOWN: f64 = 5.5e3;
const FACTOR: f64 = 270.0;
/// Seconds per unknown, and besides, of the factorisation of a bulky body, per unknown squared, on one core: 3.3 and 5.3 s of these plates, 7
/// and 61 s of these blocks.
const SECONDS: [f64; 2] = [5e-5, 2.2e-9];
/// Unknowns from which on a set-up takes longer than a moment.
const NOTABLE: f64 = 30_000.0;
/// Share of the available memory that may be used.
const SHARE: f64 = 0.9;

/// From now on `note` gets a line about each longer set-up of a body, before it begins; one that needs more memory than there is, is refused.
pub fn announce_set_ups(note: impl Fn(String) + Send + Sync + 'static) {
    set_announcer(Box::new(move |unknowns| announce(unknowns, &note)));
}

/// Gives `note` a line about the set-up of a body of so many unknowns.
///
/// # Errors
/// [`Error::Scene`] if the machine's memory does not suffice.
fn announce(unknowns: usize, note: impl Fn(String)) -> Result<()> {
    announce_with(unknowns, available(Path::new("/")), note)
}

fn announce_with(unknowns: usize, available: Option<f64>, note: impl Fn(String)) -> Result<()> {
    let n = unknowns as f64;
    let (least, quick) = (PER_UNKNOWN * n, SECONDS[0] * n);
    let (most, slow) = (least + FACTOR * n.powf(4.0 / 3.0), quick + SECONDS[1] * n * n);
    let unknowns = thousands(unknowns);
    if let Some(free) = available.map(|bytes| SHARE * bytes).filter(|free| least > *free) {
        return Err(Error::Scene(miette::miette!(
            help = "set `body.element_size` to a larger one, give a coarser mesh, or use a machine with more memory",
            "the set-up of the body needs too much memory: {unknowns} unknowns, at least {:.1} GB, but {:.1} GB are available",
            least / 1e9,
            free / 1e9
        )));
    }
    if n >= NOTABLE {
        note(format!(
            "set-up of the body: {unknowns} unknowns; thin {:.1} GB, {quick:.0} s, bulky up to {:.1} GB, {slow:.0} s",
            least / 1e9,
            most / 1e9
        ));
    }
    Ok(())
}

/// "118 000".
fn thousands(number: usize) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{} {:03}", thousands(number / 1000), number % 1000),
    }
}

/// Bytes that the machine and the control group of this process leave, the lesser of both; `None` where the system does not say. `root` is
/// the system's folder.
fn available(root: &Path) -> Option<f64> {
    let read = |path: &str| std::fs::read_to_string(root.join(path)).ok();
    let number = |text: String| text.trim().parse::<f64>().ok();
    let machine = read("proc/meminfo").and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
        line.trim().trim_end_matches("kB").trim().parse::<f64>().ok()
    });
    let group = read("sys/fs/cgroup/memory.max").and_then(number);
    let used = read("sys/fs/cgroup/memory.current").and_then(number);
    let left = group.zip(used).map(|(most, used)| (most - used).max(0.0));
    [machine.map(|kilobytes| 1024.0 * kilobytes), left].into_iter().flatten().reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;

    #[test]
    fn a_set_up_is_announced_and_refused_where_memory_lacks() {
        let said = RefCell::new(Vec::new());
        let announced =
            |unknowns, available| announce_with(unknowns, available, |line| said.borrow_mut().push(line));
        announced(118_000, Some(8e9)).expect("enough");
        announced(118_000, None).expect("not known");
        announced(20_000, Some(8e9)).expect("a moment");
        assert_eq!(said.borrow().len(), 2);
        assert!(
            said.borrow()[0]
                .starts_with("set-up of the body: 118 000 unknowns; thin 0.6 GB, 6 s, bulky up to "),
            "{said:?}"
        );
        let refused = announced(118_000, Some(5.5e8)).expect_err("too much");
        assert_eq!(refused.exit_status() as u8, 3);
        assert!(
            refused.to_string().contains("0.5 GB are available") || refused.to_string().contains("0.4 GB")
        );
        assert_eq!(said.borrow().len(), 2);
    }

    #[test]
    fn the_control_group_may_leave_less_than_the_machine() {
        let root = tempfile::tempdir().expect("folder");
        assert_eq!(available(root.path()), None);
        let write = |path: &str, text: &str| {
            let path = root.path().join(path);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            std::fs::write(path, text).expect("written");
        };
        write("proc/meminfo", "MemTotal: 9000 kB\nMemAvailable:    2000 kB\n");
        assert_eq!(available(root.path()), Some(2_048_000.0));
        write("sys/fs/cgroup/memory.current", "400000\n");
        write("sys/fs/cgroup/memory.max", "max\n");
        assert_eq!(available(root.path()), Some(2_048_000.0));
        write("sys/fs/cgroup/memory.max", "1000000\n");
        assert_eq!(available(root.path()), Some(600_000.0));
    }
}
