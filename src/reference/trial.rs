//! A small reference, solved in a folder of its own to see whether references can be computed.

use super::{Resolution, Store, Wish, solve_with};
use crate::interrupt::Scratch;
use crate::scene::Scene;
use crate::{Error, Result};
use std::path::Path;
use std::time::{Duration, Instant};

/// Two seconds once its kernels are compiled: few elements, and an end during the first contact.
const SCENE: &str = r#"
name = "trial"
kind = "plate-impact"
materials.steel = { youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = "7780 kg/m^3" }
plate = { radius = "10 mm", thickness = "2 mm", edge = "clamped", material = "steel" }
outer = { kind = "sphere", radius = "5 mm", material = "steel", speed = "5 m/s" }
inner = { kind = "sphere", radius = "5 mm", material = "steel" }
run = { end_time = "5 us" }
reference = { elements_per_contact_radius = 4 }
"#;

/// Solves it with the interpreter `python`: meshes, assembly, time loop and files, as any reference; the time it took.
///
/// # Errors
/// As [`super::solve`].
pub(super) fn solve_trial(python: &Path) -> Result<Duration> {
    let temporary = std::env::temp_dir();
    let folder =
        Scratch::new_in(&temporary, "impactcheck-").map_err(|e| Error::io("writing into", &temporary, e))?;
    let scene = Scene::parse("trial", SCENE)?;
    let start = Instant::now();
    let store = Store::open(Some(folder.path()));
    solve_with(python, &scene, Resolution::Coarse, &store, &Wish::default(), &mut |_| ())?;
    Ok(start.elapsed())
}
