//! The finite-element reference: the store of solutions and the runner of `fem_reference`.
//!
//! A solution is used only when its files are intact and it was made for exactly this scene
//! with exactly these settings; everything else is said to be missing, stale or damaged.

mod child;
mod doctor;
mod entry;
mod history_file;
mod identity;
mod modes;
mod python;
mod solve;
mod store;

pub use child::Progress;
pub use doctor::{Check, doctor};
pub use entry::Stored;
pub use identity::settings_hash;
pub use modes::plate_modes;
pub use python::{python, versions};
pub use solve::{Wish, solve, solve_with};
pub use store::{Lookup, Store};

/// Fineness of the reference's mesh, relative to `reference.elements_per_contact_radius`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Resolution {
    /// Two thirds of the elements in each direction.
    Coarse,
    /// The elements the scene asks for.
    Paper,
    /// Three halves of the elements in each direction.
    Fine,
}

impl Resolution {
    /// All resolutions, coarse to fine.
    pub const ALL: [Resolution; 3] = [Resolution::Coarse, Resolution::Paper, Resolution::Fine];

    /// Its name on the command line and in the store.
    pub fn name(self) -> &'static str {
        match self {
            Resolution::Coarse => "coarse",
            Resolution::Paper => "paper",
            Resolution::Fine => "fine",
        }
    }
}

impl std::fmt::Display for Resolution {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

impl std::str::FromStr for Resolution {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Resolution::ALL.into_iter().find(|r| r.name() == text);
        found.ok_or_else(|| format!("`{text}` is not a resolution; there are coarse, paper and fine"))
    }
}
