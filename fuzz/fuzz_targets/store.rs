//! Any content in one file of a stored solution, with right checksums or without: it is read, or the damage is said.
//!
//! The first byte of the input chooses the file and whether the checksums fit.
#![no_main]

#[path = "../../tests/support/store_fixture.rs"]
#[allow(dead_code)]
mod store_fixture;

use impactcheck::reference::{Lookup, Resolution, Store};
use libfuzzer_sys::fuzz_target;
use std::cell::RefCell;
use std::fs;
use std::path::Path;
use store_fixture::{scene, seal, write_entry};

const FILES: [&str; 5] = ["summary.json", "history.csv", "provenance.json", "mesh.vtu", "checksums.sha256"];

/// A store in memory where there is such a file system.
struct Workshop {
    root: tempfile::TempDir,
    scene: impactcheck::scene::Scene,
}

thread_local! {
    static WORKSHOP: RefCell<Option<Workshop>> = const { RefCell::new(None) };
}

impl Workshop {
    fn new() -> Self {
        let memory = Path::new("/dev/shm");
        let root = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
        let workshop = Self { root: root.expect("a folder"), scene: scene() };
        write_entry(&workshop.entry(), &workshop.scene, Resolution::Paper);
        workshop
    }

    fn entry(&self) -> std::path::PathBuf {
        self.root.path().join(&self.scene.name).join("paper")
    }

    fn look(&self, choice: u8, content: &[u8]) {
        let file = self.entry().join(FILES[usize::from(choice) % FILES.len()]);
        let intact = fs::read(&file).expect("the file");
        let checksums = fs::read(self.entry().join("checksums.sha256")).expect("checksums");
        fs::write(&file, content).expect("the file");
        if usize::from(choice) / FILES.len() % 8 > 0 && !file.ends_with("checksums.sha256") {
            seal(&self.entry());
        }
        match Store::open(Some(self.root.path())).find(&self.scene, Resolution::Paper) {
            Lookup::Found(stored) => {
                let history = &stored.outcome.history;
                assert!(!history.is_empty() && history.time.windows(2).all(|t| t[0] < t[1]));
                assert!(history["outer_force"].iter().all(|f| f.is_finite()));
                assert_eq!(stored.outcome.summary.scene_hash, self.scene.hash());
            }
            Lookup::Damaged { reason, .. } | Lookup::Stale { reason } => assert!(!reason.is_empty()),
            Lookup::Missing => panic!("the entry is there"),
        }
        fs::write(&file, intact).expect("the file");
        fs::write(self.entry().join("checksums.sha256"), checksums).expect("checksums");
    }
}

fuzz_target!(|data: &[u8]| {
    let Some((choice, content)) = data.split_first() else { return };
    WORKSHOP.with_borrow_mut(|workshop| workshop.get_or_insert_with(Workshop::new).look(*choice, content));
});
