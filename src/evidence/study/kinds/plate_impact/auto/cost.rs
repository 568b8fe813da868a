//! What a choice costs, and what a setting costs that was known to be right.

use super::truth::Setting;
use crate::body::cache::Cache;
use crate::error::Result;
use crate::kinds::plate_impact::choice::integration_tolerance;
use crate::kinds::plate_impact::reduced::Reduced;
use crate::scene::Scene;
use std::time::Instant;

/// Repetitions of what takes milliseconds at most; the shortest time counts.
const REPEATS: usize = 3;

/// Wall times in s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WallTimes {
    /// Set-up and run, nothing cached.
    pub(super) fresh: f64,
    /// The same with the bodies of model C from the cache.
    pub(super) cached: f64,
    /// The run alone.
    pub(super) run: f64,
}

impl WallTimes {
    /// Of `auto` at `tolerance`, its choice included.
    pub(super) fn of_auto(scene: &Scene, tolerance: f64, folder: &Cache) -> Result<Self> {
        Self::of(tolerance, folder, |cache| Reduced::auto_in(scene, tolerance, cache))
    }

    /// Of `setting`, integrated for `tolerance`.
    pub(super) fn of_setting(
        scene: &Scene,
        (model, modes): Setting,
        tolerance: f64,
        folder: &Cache,
    ) -> Result<Self> {
        Self::of(tolerance, folder, |cache| Reduced::new_in(scene, model, Some(modes), cache))
    }

    fn of(tolerance: f64, folder: &Cache, set_up: impl Fn(&Cache) -> Result<Reduced>) -> Result<Self> {
        let tolerance = integration_tolerance(tolerance);
        let run = |cache: &Cache| set_up(cache)?.point(tolerance);
        let (_, fresh) = timed(1, || run(&Cache::off()))?;
        run(folder)?;
        let (_, cached) = timed(REPEATS, || run(folder))?;
        let ready = set_up(folder)?;
        let (_, run) = timed(REPEATS, || ready.point(tolerance))?;
        Ok(Self { fresh, cached, run })
    }
}

/// Shortest wall time in s of `repeats` calls, and the last result.
fn timed<T>(repeats: usize, call: impl Fn() -> Result<T>) -> Result<(Option<T>, f64)> {
    let mut shortest = f64::INFINITY;
    let mut result = None;
    for _ in 0..repeats {
        let start = Instant::now();
        result = Some(call()?);
        shortest = shortest.min(start.elapsed().as_secs_f64());
    }
    Ok((result, shortest))
}
