//! The finite-element reference: the store of solutions and the runner of `fem_reference`.
//!
//! A solution is used only when its files are intact and it was made for exactly this scene
//! with exactly these settings; everything else is said to be missing, stale or damaged.

mod child;
mod curve_bands;
mod dents;
mod doctor;
mod entry;
mod fields;
mod history_file;
mod identity;
mod import;
mod kinds;
mod python;
mod records;
mod section;
mod solid_stress;
mod solve;
mod store;
mod trial;
mod turn;

pub use child::Progress;
pub use curve_bands::CurveBands;
pub use dents::Dents;
pub use doctor::{Check, INDEPENDENT_SOLVER, doctor};
pub use entry::Stored;
pub use fields::FieldMesh;
pub use identity::{revision, settings_hash};
pub use import::{Imported, read_import};
pub use kinds::*;
pub use python::{prefer_python, python, unit_runner};
pub use records::{record_bytes, record_source};
pub use section::MeshSection;
pub use solid_stress::SolidStress;
pub use solve::{Wish, solve, solve_with};
pub use store::{Lookup, Store};

/// Size of the elements over that of the next finer fixed resolution.
pub const COARSER: f64 = 1.5;

/// Fineness of the reference's mesh, relative to `reference.elements_per_contact_radius`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Resolution {
    /// Two thirds of the elements in each direction.
    Coarse,
    /// The elements the scene asks for.
    Paper,
    /// Three halves of the elements in each direction.
    Fine,
    /// As many as bring the uncertainty (95 %) of efficiency and peak forces down to an error.
    Within(TargetError),
    /// CalculiX's, on its own series of meshes.
    Calculix(CalculixMesh),
    /// None of this program's: another program's result.
    Imported,
}

/// Fineness of CalculiX's mesh, as of [`Resolution`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CalculixMesh {
    /// Two thirds of the elements and time steps.
    Coarse,
    /// Those that stand for what the scene asks for.
    Paper,
    /// Three halves of them.
    Fine,
}

/// What the name of an entry of CalculiX's begins with.
const CALCULIX: &str = "calculix-";

impl Resolution {
    /// The fixed resolutions, coarse to fine.
    pub const ALL: [Resolution; 3] = [Resolution::Coarse, Resolution::Paper, Resolution::Fine];

    /// The resolution the solver begins with, by its name on the command line.
    pub fn first(self) -> &'static str {
        match self {
            Resolution::Coarse | Resolution::Within(_) | Resolution::Calculix(CalculixMesh::Coarse) => {
                "coarse"
            }
            Resolution::Paper | Resolution::Calculix(CalculixMesh::Paper) => "paper",
            Resolution::Fine | Resolution::Calculix(CalculixMesh::Fine) => "fine",
            Resolution::Imported => "imported",
        }
    }

    /// The same fineness by CalculiX, which has fixed ones only.
    pub fn by_calculix(self) -> Option<Self> {
        match self {
            Resolution::Coarse => Some(Resolution::Calculix(CalculixMesh::Coarse)),
            Resolution::Paper => Some(Resolution::Calculix(CalculixMesh::Paper)),
            Resolution::Fine => Some(Resolution::Calculix(CalculixMesh::Fine)),
            Resolution::Calculix(_) => Some(self),
            Resolution::Within(_) | Resolution::Imported => None,
        }
    }

    /// Whether it is of another program's finite elements.
    pub fn is_of_another_program(self) -> bool {
        matches!(self, Resolution::Calculix(_) | Resolution::Imported)
    }
}

impl Resolution {
    /// The one of a fixed name.
    fn named(name: &str) -> Option<Self> {
        if let Some(mesh) = name.strip_prefix(CALCULIX) {
            return Resolution::named(mesh).filter(|own| !own.is_of_another_program())?.by_calculix();
        }
        Resolution::ALL.into_iter().chain([Resolution::Imported]).find(|r| r.first() == name)
    }

    /// The resolution of the entry called `name` in the store.
    fn of_folder(name: &str) -> Option<Self> {
        let millionths = name.strip_prefix("error-").and_then(|rest| rest.strip_suffix("ppm"));
        match millionths {
            Some(number) => {
                let parts_per_million = number.parse().ok()?;
                Some(Resolution::Within(TargetError { parts_per_million }))
            }
            None => Resolution::named(name),
        }
    }

    /// The next coarser fixed resolution, whose elements are [`COARSER`] times as large.
    pub fn coarser(self) -> Option<Self> {
        match self {
            Resolution::Paper => Some(Resolution::Coarse),
            Resolution::Fine => Some(Resolution::Paper),
            Resolution::Coarse | Resolution::Within(_) | Resolution::Calculix(_) | Resolution::Imported => {
                None
            }
        }
    }

    /// As it is written on the command line.
    pub fn argument(self) -> String {
        match self {
            Resolution::Within(error) => format!("{}%", f64::from(error.parts_per_million) * 1e-4),
            fixed => fixed.to_string(),
        }
    }
}

impl std::fmt::Display for Resolution {
    /// Its name in the store; of a fixed resolution also that on the command line.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Resolution::Within(error) => f.pad(&format!("error-{}ppm", error.parts_per_million)),
            Resolution::Calculix(_) => f.pad(&format!("{CALCULIX}{}", self.first())),
            fixed => f.pad(fixed.first()),
        }
    }
}

impl serde::Serialize for Resolution {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl std::str::FromStr for Resolution {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Resolution::named(text);
        let within = || text.contains('%').then(|| text.parse().map(Resolution::Within));
        let unknown = || {
            format!(
                "`{text}` is not a resolution; there are coarse, paper, fine, errors such as 0.2% (as of --target-error), calculix-paper \
                 (or -coarse, -fine), and imported"
            )
        };
        found.map(Ok).or_else(within).unwrap_or_else(|| Err(unknown()))
    }
}

/// A relative error asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TargetError {
    parts_per_million: u32,
}

impl TargetError {
    /// The error as a share.
    pub fn share(self) -> f64 {
        f64::from(self.parts_per_million) * 1e-6
    }
}

impl std::str::FromStr for TargetError {
    type Err = String;

    /// Reads `0.2%` or `0.002`, to one part in a million.
    fn from_str(text: &str) -> Result<Self, String> {
        let (number, scale) = text.strip_suffix('%').map_or((text, 1e6), |number| (number, 1e4));
        let parts = number.trim().parse::<f64>().map(|n| (n * scale).round());
        // At least 0.01 %: more is beyond what explicit time integration can show. NaN fails as well.
        match parts {
            Ok(parts) if (100.0..=500_000.0).contains(&parts) => {
                // In the range checked, a whole number.
                Ok(TargetError { parts_per_million: parts as u32 })
            }
            _ => Err(format!("`{text}` is not an error from 0.01% to 50%, like 0.2% or 0.002")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{CalculixMesh, Resolution, TargetError};

    #[test]
    fn an_error_is_read_as_percent_or_share_and_names_its_entry() {
        let read = |text: &str| text.parse::<TargetError>();
        assert_eq!(read("0.2%"), read("0.002"));
        let error = read("0.25%").expect("valid");
        assert_eq!(error.share(), 0.0025);
        assert_eq!(Resolution::Within(error).to_string(), "error-2500ppm");
        assert_eq!(Resolution::of_folder("error-2500ppm"), Some(Resolution::Within(error)));
        assert_eq!(Resolution::Within(error).argument().parse(), Ok(Resolution::Within(error)));
        assert_eq!("coarse".parse(), Ok(Resolution::Coarse));
        let calculix = Resolution::Calculix(CalculixMesh::Fine);
        assert_eq!((calculix.to_string().parse(), calculix.first()), (Ok(calculix), "fine"));
        assert_eq!(Resolution::of_folder("calculix-fine"), Some(calculix));
        assert!("calculix-imported".parse::<Resolution>().is_err());
        assert!("0.2".parse::<Resolution>().is_err(), "a share without % could be a slip");
        for bad in ["", "0", "-1%", "NaN", "inf", "60%", "0.001%", "x%"] {
            assert!(read(bad).is_err(), "{bad}");
        }
    }
}
