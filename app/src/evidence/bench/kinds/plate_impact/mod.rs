//! Integrators, models and series of plate impacts.

mod integrators;
mod models;
mod series;

pub use series::Series;

use crate::error::Result;
use crate::evidence::bench::{Bench, Settings};
use crate::reference::Store;

/// Adds what `settings` ask for to `bench`; `note` receives what is going on.
///
/// # Errors
/// As [`crate::evidence::bench::run`].
pub(in crate::evidence::bench) fn run(
    settings: &Settings,
    store: &Store,
    note: &dyn Fn(&str),
    bench: &mut Bench,
) -> Result<()> {
    for &modes in &settings.modes {
        note(&format!("integrators with {modes} modes"));
        integrators::run(modes, settings, bench)?;
    }
    if settings.models {
        note("models and meshes");
        models::run(store, bench)?;
    }
    if settings.series > 0 {
        note("impacts in series");
        series::run(settings, bench)?;
    }
    Ok(())
}
