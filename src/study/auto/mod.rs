//! The estimate of `auto` checked: random scenes against converged solutions of model C, and scenes with stored references
//! against these.

mod cost;
mod draw;
mod figure;
mod truth;

pub use figure::figure;

use super::{Cell, Claim, Note, SCHEMA_VERSION, Settings, Study};
use crate::body::cache::Cache;
use crate::error::{Error, Result};
use crate::kinds::plate_impact::PlateQuantities;
use crate::kinds::plate_impact::choice::{COVERED, error_scale, integration_tolerance, largest_error};
use crate::kinds::plate_impact::reduced::Reduced;
use crate::project::project_root;
use crate::reference::{Lookup, Resolution, Store};
use crate::result::Summary;
use crate::sampling::latin_hypercube;
use crate::scene::{self, Model, Scene, Setup};
use cost::Cost;
use draw::{DIMENSIONS, draw};
use rayon::prelude::*;
use truth::{Setting, Truth};

/// Tolerances asked for.
pub const TOLERANCES: [f64; 3] = [0.003, 0.01, 0.03];
/// Random scenes of the study, and the seed they are drawn with.
const SCENES: (usize, u64) = (200, 7);
/// Draws per scene: some are out of proportion, some have no converged solution.
const DRAWS: usize = 4;
/// Share of the scenes that may miss the tolerance asked for.
const MISSED: f64 = 0.05;
/// Largest band of a reference that counts.
const SHARP: f64 = 0.01;
/// How many times as much as the cheapest admissible choice `auto` may cost.
const DEARER: f64 = 2.0;

/// Names of the columns of the table, with their units.
const COLUMNS: [(&str, &str); 19] = [
    ("scene", "1"),
    ("exact", "1"),
    ("thickness_over_radius", "1"),
    ("patch_over_thickness", "1"),
    ("efficiency", "1"),
    ("tolerance", "1"),
    ("model", "1"),
    ("modes", "1"),
    ("promised", "1"),
    ("estimated_error", "1"),
    ("true_error", "1"),
    ("cheapest_model", "1"),
    ("cheapest_modes", "1"),
    ("seconds", "s"),
    ("seconds_cached", "s"),
    ("seconds_run", "s"),
    ("cost_ratio", "1"),
    ("cost_ratio_cached", "1"),
    ("cost_ratio_run", "1"),
];

/// What is checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Extent {
    /// Number of random scenes.
    pub random: usize,
    /// Seed they are drawn with.
    pub seed: u64,
    /// Whether scenes with a stored reference are looked at as well.
    pub references: bool,
    /// Whether costs are measured.
    pub costs: bool,
}

/// The study.
///
/// # Errors
/// If the scenes can't be read; a scene that can't be solved is left out.
pub fn run(settings: &Settings, note: &mut Note) -> Result<Study> {
    let (random, seed) = SCENES;
    let extent = Extent { random, seed, references: true, costs: true };
    check(&extent, &Store::open(settings.store.as_deref()), note)
}

/// The part of the study that `extent` names, with the references in `store`.
///
/// # Errors
/// As [`run`].
pub fn check(extent: &Extent, store: &Store, note: &mut Note) -> Result<Study> {
    let Extent { random: count, seed, .. } = *extent;
    let mut cases = if extent.references { references(store)? } else { Vec::new() };
    let known = cases.len();
    note(&format!("{known} scenes with a stored reference, {count} random ones from seed {seed}"));
    let (random, refused) = random(count, seed)?;
    cases.extend(random);
    let folder = tempfile::tempdir().map_err(|e| Error::io("making", std::env::temp_dir(), e))?;
    let cache = Cache::at(folder.path());
    let mut rows = Vec::new();
    for (k, case) in cases.iter().enumerate() {
        if k % 20 == 0 {
            note(&format!("scene {} of {}", k + 1, cases.len()));
        }
        for tolerance in TOLERANCES {
            rows.push(row(k, case, tolerance, &cache, extent.costs)?);
        }
    }
    let claims = claims(&rows, known);
    let names: Vec<&str> = cases[..known].iter().map(|case| case.scene.name.as_str()).collect();
    Ok(Study {
        schema_version: SCHEMA_VERSION,
        study: "auto",
        description: format!(
            "The model that auto chooses for a tolerance, its estimated and its true error (the largest of efficiency, final \
             velocity of the outer body and both force peaks), and its cost against the cheapest setting that meets the tolerance. \
             {known} scenes against their stored finite-element reference ({}; those with 95 % bands above 1 % are left \
             out), {} random ones (seed {seed}, {refused} draws left out because no converged solution is known) against model C with so many modes that twice as many change nothing. Where no \
             model is estimated to meet the tolerance (promised = 0), auto says so. Times are wall times on this machine.",
            if names.is_empty() { "none".to_owned() } else { names.join(", ") },
            cases.len() - known,
        ),
        columns: COLUMNS.map(|(name, _)| name).to_vec(),
        units: COLUMNS.map(|(_, unit)| unit).to_vec(),
        rows,
        claims,
    })
}

/// A scene and what its models are off by.
struct Case {
    scene: Scene,
    truth: Truth,
    /// What counts as exact, in words.
    exact: &'static str,
}

/// The plate impacts among the project's scenes that have a stored reference with narrow bands.
fn references(store: &Store) -> Result<Vec<Case>> {
    let mut files = scene::shipped()?;
    let further = project_root().join("scenes/validation");
    if let Ok(folder) = std::fs::read_dir(&further) {
        let mut more: Vec<_> = folder.filter_map(|entry| Some(entry.ok()?.path())).collect();
        more.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
        more.sort();
        files.extend(more);
    }
    let mut cases = Vec::new();
    for file in files {
        let scene = Scene::read(&file)?;
        if matches!(scene.setup, Setup::SealSeat(_)) {
            continue;
        }
        let found = [Resolution::Fine, Resolution::Paper].into_iter().find_map(|resolution| {
            match store.find(&scene, resolution) {
                Lookup::Found(stored) => Some(stored.outcome.summary),
                _ => None,
            }
        });
        if let Some(reference) = found
            && let Some(exact) = PlateQuantities::of_table(&reference.quantities)
            && is_sharp(&reference, &exact, scene.plate_impact()?.outer.speed)
            && let Some(truth) = Truth::new(&scene, Some(exact))?
        {
            cases.push(Case { scene, truth, exact: "reference" });
        }
    }
    Ok(cases)
}

/// Whether a reference of an impact at `speed` m/s can tell an error from its own: the 95 % bands of what is compared are at
/// most [`SHARP`].
fn is_sharp(reference: &Summary, exact: &PlateQuantities, speed: f64) -> bool {
    COVERED
        .iter()
        .all(|name| reference.band(name).is_some_and(|band| band <= SHARP * error_scale(name, exact, speed)))
}

/// `count` random scenes with a converged solution, and how many draws before the last of them had none.
fn random(count: usize, seed: u64) -> Result<(Vec<Case>, usize)> {
    let points = latin_hypercube(DRAWS * count, DIMENSIONS, seed);
    let scenes: Vec<Scene> =
        points.iter().enumerate().filter_map(|(k, x)| draw(&format!("random-{k}"), x)).collect();
    let mut cases = Vec::new();
    let mut refused = 0;
    // in portions, so that no more are solved than are needed
    for portion in scenes.chunks(4) {
        let truths: Result<Vec<_>> = portion.par_iter().map(|scene| Truth::new(scene, None)).collect();
        for (scene, truth) in portion.iter().zip(truths?) {
            match truth {
                _ if cases.len() == count => return Ok((cases, refused)),
                Some(truth) => cases.push(Case { scene: scene.clone(), truth, exact: "model C" }),
                None => refused += 1,
            }
        }
    }
    Ok((cases, refused))
}

/// One scene at one tolerance.
fn row(index: usize, case: &Case, tolerance: f64, cache: &Cache, costs: bool) -> Result<Vec<Cell>> {
    let Case { scene, truth, exact } = case;
    let setup = scene.plate_impact()?;
    let auto = Reduced::auto_in(scene, tolerance, cache)?;
    let choice = auto.choice().ok_or_else(|| Error::Internal("auto makes a choice".into()))?;
    let result = auto.point(integration_tolerance(tolerance));
    let error = result
        .as_ref()
        .map_or(f64::NAN, |point| largest_error(&point.quantities, &truth.exact, setup.outer.speed).0);
    let cheapest = truth.cheapest(tolerance);
    let own = costs.then(|| Cost::of_auto(scene, tolerance, cache).ok()).flatten();
    let least = cheapest.filter(|_| costs);
    let least = least.and_then(|setting| Cost::of_setting(scene, setting, tolerance, cache).ok());
    let ratio = |part: fn(&Cost) -> f64| Some(part(own.as_ref()?) / part(least.as_ref()?));
    let laws = &auto.system().laws;
    let patch = [0, 1].map(|i| {
        let peak = [truth.exact.outer_force_peak, truth.exact.inner_force_peak][i];
        laws[i].contact_radius(peak)
    });
    Ok(vec![
        index.into(),
        Cell::Text(exact),
        (setup.plate.thickness / setup.plate.radius).into(),
        (patch[0].max(patch[1]) / setup.plate.thickness).into(),
        truth.exact.efficiency.into(),
        tolerance.into(),
        Cell::Text(name(auto.model())),
        auto.system().modes.into(),
        usize::from(choice.met).into(),
        choice.estimated_error.into(),
        error.into(),
        cheapest.map_or(Cell::Missing, |(model, _): Setting| Cell::Text(name(model))),
        cheapest.map(|(_, modes)| modes).into(),
        own.map(|cost| cost.fresh).into(),
        own.map(|cost| cost.cached).into(),
        own.map(|cost| cost.run).into(),
        ratio(|cost| cost.fresh).into(),
        ratio(|cost| cost.cached).into(),
        ratio(|cost| cost.run).into(),
    ])
}

fn name(model: Model) -> &'static str {
    match model {
        Model::A => "A",
        Model::B => "B",
        Model::C => "C",
    }
}

/// The number in the column called `column`; NaN if there is none.
fn number(row: &[Cell], column: &str) -> f64 {
    let place = COLUMNS.iter().position(|(name, _)| *name == column);
    match place.map(|k| row[k]) {
        Some(Cell::Number(value)) => value,
        Some(Cell::Count(value)) => value as f64,
        _ => f64::NAN,
    }
}

/// Shares of scenes that miss, and what the choice costs; `known` scenes have a reference.
fn claims(rows: &[Vec<Cell>], known: usize) -> Vec<Claim> {
    let mut claims = Vec::new();
    let share = |rows: &[&Vec<Cell>], misses: &dyn Fn(&[Cell]) -> bool| {
        (!rows.is_empty()).then(|| rows.iter().filter(|row| misses(row)).count() as f64 / rows.len() as f64)
    };
    let missed = |row: &[Cell]| {
        let error = number(row, "true_error");
        error.is_nan() || error > number(row, "tolerance")
    };
    for tolerance in TOLERANCES {
        let asked = |row: &&Vec<Cell>| number(row, "tolerance") == tolerance;
        let percent = 100.0 * tolerance;
        let of = |with_reference: bool| -> Vec<&Vec<Cell>> {
            let kind = |row: &&Vec<Cell>| (number(row, "scene") < known as f64) == with_reference;
            rows.iter().filter(asked).filter(kind).collect()
        };
        let claim = |text: String, ours, bound| Claim::new(text, "1", None, ours, bound);
        for (what, rows) in [("random scenes", of(false)), ("scenes with a reference", of(true))] {
            if rows.is_empty() {
                continue;
            }
            claims.push(claim(
                format!("{percent} %: share of the {what} in which the true error exceeds the tolerance"),
                share(&rows, &missed),
                MISSED,
            ));
            let promised: Vec<_> =
                rows.iter().copied().filter(|row| number(row, "promised") == 1.0).collect();
            claims.push(claim(
                format!(
                    "{percent} %: the same among the {} of {} for which auto promises it",
                    promised.len(),
                    rows.len()
                ),
                share(&promised, &missed),
                MISSED,
            ));
        }
        let measured: Vec<_> =
            rows.iter().filter(asked).filter(|row| number(row, "cost_ratio").is_finite()).collect();
        if !measured.is_empty() {
            claims.extend(costs(percent, &measured));
        }
    }
    claims
}

/// What the choice costs over the cheapest admissible one, in the `rows` of one tolerance.
fn costs(percent: f64, rows: &[&Vec<Cell>]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for (what, part) in
        [("nothing cached", ""), ("bodies of model C cached", "_cached"), ("the run alone", "_run")]
    {
        let mut ratios: Vec<f64> = rows.iter().map(|row| number(row, &format!("cost_ratio{part}"))).collect();
        ratios.sort_by(f64::total_cmp);
        let seconds = |row: &[Cell]| number(row, &format!("seconds{part}"));
        let own: f64 = rows.iter().map(|row| seconds(row)).sum();
        let cheapest: f64 =
            rows.iter().map(|row| seconds(row) / number(row, &format!("cost_ratio{part}"))).sum();
        let dearer = ratios.iter().filter(|ratio| **ratio > DEARER).count() as f64 / ratios.len() as f64;
        for (how, ours, bound) in [
            ("median", ratios[ratios.len() / 2], DEARER),
            ("all scenes together", own / cheapest, DEARER),
            ("share of scenes above 2", dearer, MISSED),
        ] {
            let text = format!(
                "{percent} %: cost of auto over that of the cheapest admissible choice, {what}: {how}"
            );
            claims.push(Claim::new(text, "1", None, Some(ours), bound));
        }
    }
    claims
}
