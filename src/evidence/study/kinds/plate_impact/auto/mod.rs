//! The estimate of `auto` checked: random scenes against converged solutions of model C, and scenes with stored references
//! against these.

mod cost;
mod draw;
mod figure;
mod truth;

pub use figure::figure;

use crate::body::cache::Cache;
use crate::error::{Error, Result};
use crate::evidence::study::{Cell, Claim, Note, Settings, Study, columns};
use crate::kinds::plate_impact::PlateQuantities;
use crate::kinds::plate_impact::choice::{COVERAGE, integration_tolerance};
use crate::kinds::plate_impact::errors::{COVERED, error_scale, largest_error};
use crate::kinds::plate_impact::reduced::Reduced;
use crate::reference::{Resolution, Store};
use crate::result::Summary;
use crate::sampling::latin_hypercube;
use crate::scene::{self, Model, Scene};
use cost::WallTimes;
use draw::{DIMENSIONS, draw};
use rayon::prelude::*;
use truth::{Setting, Truth};

/// Tolerances asked for.
pub const TOLERANCES: [f64; 3] = [0.003, 0.01, 0.03];
/// Random scenes of the study, and the seed they are drawn with. The estimate was calibrated on seeds 1 and 2.
const SCENES: (usize, u64) = (1000, 3);
/// Random scenes whose costs are measured.
const COSTED: usize = 100;
/// Draws per scene: of some the speed is out of proportion.
const DRAWS: usize = 3;
/// Scenes between two notes of the progress.
const PORTION: usize = 20;
/// Largest band of a reference that counts.
const SHARP: f64 = 0.01;
/// How many times as much as the cheapest admissible choice `auto` may cost.
const DEARER: f64 = 2.0;
/// Share of the scenes that may cost more.
const DEAR: f64 = 0.05;

/// Names of the columns of the table, with their units.
const COLUMNS: &str = "scene, exact, thickness_over_radius, patch_over_thickness, efficiency, tolerance, model, modes, \
     promised, estimated_error, true_error, cheapest_model, cheapest_modes, seconds [s], \
     seconds_cached [s], seconds_run [s], cost_ratio, cost_ratio_cached, cost_ratio_run";

/// What is checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Extent {
    /// Number of random scenes.
    pub random: usize,
    /// Seed they are drawn with.
    pub seed: u64,
    /// Whether scenes with a stored reference are looked at as well.
    pub references: bool,
    /// Number of random scenes whose costs are measured.
    pub costed: usize,
}

/// The study.
///
/// # Errors
/// If the scenes can't be read.
pub fn run(settings: &Settings, note: &mut Note) -> Result<Study> {
    let extent = Extent {
        random: settings.cases.unwrap_or(SCENES.0),
        seed: settings.seed.unwrap_or(SCENES.1),
        references: true,
        costed: COSTED,
    };
    check(&extent, &Store::open(settings.store.as_deref()), note)
}

/// The part of the study that `extent` names, with the references in `store`.
///
/// # Errors
/// As [`run`].
pub fn check(extent: &Extent, store: &Store, note: &mut Note) -> Result<Study> {
    let Extent { random: count, seed, costed, .. } = *extent;
    let mut cases = if extent.references { references(store)? } else { Vec::new() };
    let known = cases.len();
    note(&format!("{known} scenes with a stored reference, {count} random ones from seed {seed}"));
    cases.extend(random(count, seed, costed));
    let folder = tempfile::tempdir().map_err(|e| Error::io("making", std::env::temp_dir(), e))?;
    let cache = Cache::at(folder.path());
    let mut rows = Vec::new();
    for (k, portion) in cases.chunks(PORTION).enumerate() {
        note(&format!("scene {} of {}", k * PORTION + 1, cases.len()));
        let judged: Result<Vec<_>> = portion.par_iter().map(|case| judged(case, &cache)).collect();
        for (i, (case, judged)) in portion.iter().zip(judged?).enumerate() {
            let cheapest = match (&judged.truth, case.costed) {
                (Some(truth), true) => truth.cheapest(&case.scene)?,
                _ => [None; TOLERANCES.len()],
            };
            for (auto, cheapest) in judged.autos.iter().zip(cheapest) {
                rows.push(row(k * PORTION + i, case, auto, cheapest, &cache)?);
            }
        }
    }
    let claims = claims(&rows, known);
    let names: Vec<&str> = cases[..known].iter().map(|case| case.scene.name.as_str()).collect();
    Ok(Study::new(
        "auto",
        format!(
            "The model that auto chooses for a tolerance, its estimated and its true error (the largest of efficiency, final \
             velocity of the outer body and both peak forces), and its cost over that of the least expensive setting within the tolerance. \
             {known} scenes are compared with their stored finite-element reference ({}; without those whose uncertainty is above 1 %). {} random \
             scenes over the permitted range (seed {seed}) are compared with model C, converged to a third of the tolerance by doubling the modes. \
             promised = 0: auto states that no model is within the tolerance. true_error is missing there, and where no converged solution is \
             known. Costs are wall times on this machine, of {costed} random scenes.",
            if names.is_empty() { "none".to_owned() } else { names.join(", ") },
            cases.len() - known,
        ),
        COLUMNS,
        rows,
        claims,
    ))
}

/// A scene to be judged.
struct AutoCase {
    scene: Scene,
    /// What counts as exact, if it is known beforehand: the reference.
    reference: Option<PlateQuantities>,
    /// Whether its costs are measured.
    costed: bool,
}

/// What auto made of a scene, and what is true.
struct JudgedScene {
    /// One for each tolerance.
    autos: Vec<Auto>,
    truth: Option<Truth>,
}

/// What auto made of a scene for a tolerance.
struct Auto {
    tolerance: f64,
    /// The model chosen; `None` if no model can be set up.
    reduced: Option<Reduced>,
    promised: bool,
    /// Wider patch over the plate's thickness.
    patch: f64,
    efficiency: f64,
    /// Of a promise, if the truth is known well enough.
    true_error: Option<f64>,
}

/// Lets auto choose, and looks for the truth where it makes a promise or costs are measured.
fn judged(case: &AutoCase, cache: &Cache) -> Result<JudgedScene> {
    let speed = case.scene.plate_impact()?.outer.speed;
    let chosen = TOLERANCES.map(|tolerance| Reduced::auto_in(&case.scene, tolerance, cache).ok());
    let promises =
        |auto: &Option<Reduced>| auto.as_ref().and_then(Reduced::choice).is_some_and(|choice| choice.met);
    let promised = TOLERANCES.iter().zip(&chosen).filter(|(_, auto)| promises(auto) || case.costed);
    let strictest = promised.map(|(tolerance, _)| *tolerance).reduce(f64::min);
    let modes =
        chosen.iter().flatten().filter(|auto| auto.model() == Model::C).map(|auto| auto.system().modes);
    let truth = match (&case.reference, strictest) {
        (Some(exact), _) => Some(Truth::of_reference(*exact)),
        (None, Some(tolerance)) => Truth::new(&case.scene, modes.max().unwrap_or(1), tolerance)?,
        (None, None) => None,
    };
    let auto = |(reduced, tolerance): (Option<Reduced>, f64)| {
        let run = |reduced: &Reduced| Some(reduced.point(integration_tolerance(tolerance)).ok()?.quantities);
        let ours = reduced.as_ref().and_then(run);
        let exact = truth.as_ref().filter(|truth| truth.decides(tolerance)).map(|truth| &truth.exact);
        let error = |ours: &PlateQuantities| Some(largest_error(ours, exact?, speed).0);
        let patch = |ours: &PlateQuantities| {
            let laws = reduced.as_ref()?.system().laws;
            let radius = |i: usize| laws[i].contact_radius([ours.outer_force_peak, ours.inner_force_peak][i]);
            Some(radius(0).max(radius(1)) / case.scene.plate_impact().ok()?.plate.thickness)
        };
        Auto {
            tolerance,
            promised: promises(&reduced),
            patch: ours.as_ref().and_then(patch).unwrap_or(f64::NAN),
            efficiency: ours.as_ref().map_or(f64::NAN, |ours| ours.efficiency),
            // a promise without a result is broken
            true_error: ours.as_ref().map_or(Some(f64::INFINITY), error),
            reduced,
        }
    };
    let autos = chosen.into_iter().zip(TOLERANCES).map(auto).collect();
    Ok(JudgedScene { autos, truth })
}

/// The plate impacts among the project's scenes that have a stored reference with narrow bands.
fn references(store: &Store) -> Result<Vec<AutoCase>> {
    let mut cases = Vec::new();
    for file in scene::every()? {
        let scene = Scene::read(&file)?;
        if scene.plate_impact().is_err() {
            continue;
        }
        let mut resolutions = [Resolution::Fine, Resolution::Paper].into_iter();
        let found = resolutions.find_map(|resolution| store.find(&scene, resolution).found());
        if let Some(reference) = found.map(|stored| stored.outcome.summary)
            && let Some(exact) = PlateQuantities::of_table(&reference.quantities)
            && is_sharp(&reference, &exact, scene.plate_impact()?.outer.speed)
        {
            cases.push(AutoCase { scene, reference: Some(exact), costed: false });
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

/// `count` random scenes, the costs of the first `costed` to be measured.
fn random(count: usize, seed: u64, costed: usize) -> Vec<AutoCase> {
    let points = latin_hypercube(DRAWS * count, DIMENSIONS, seed);
    let scenes = points.iter().enumerate().filter_map(|(k, x)| draw(&format!("random-{k}"), x));
    let case = |(k, scene)| AutoCase { scene, reference: None, costed: k < costed };
    scenes.take(count).enumerate().map(case).collect()
}

/// One scene at one tolerance.
fn row(
    index: usize,
    case: &AutoCase,
    auto: &Auto,
    cheapest: Option<Setting>,
    cache: &Cache,
) -> Result<Vec<Cell>> {
    let AutoCase { scene, reference, costed } = case;
    let plate = &scene.plate_impact()?.plate;
    let tolerance = auto.tolerance;
    let own = costed.then(|| WallTimes::of_auto(scene, tolerance, cache).ok()).flatten();
    let least = cheapest.and_then(|setting| WallTimes::of_setting(scene, setting, tolerance, cache).ok());
    let ratio = |part: fn(&WallTimes) -> f64| Some(part(own.as_ref()?) / part(least.as_ref()?));
    let estimated = auto.reduced.as_ref().and_then(Reduced::choice).and_then(|choice| choice.estimated_error);
    let text = |model: Model| Cell::Text(name(model));
    Ok(vec![
        index.into(),
        Cell::Text(if reference.is_some() { "reference" } else { "model C" }),
        (plate.thickness / plate.radius).into(),
        auto.patch.into(),
        auto.efficiency.into(),
        tolerance.into(),
        auto.reduced.as_ref().map_or(Cell::Missing, |auto| text(auto.model())),
        auto.reduced.as_ref().map(|auto| auto.system().modes).into(),
        usize::from(auto.promised).into(),
        estimated.into(),
        auto.true_error.into(),
        cheapest.map_or(Cell::Missing, |(model, _)| text(model)),
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
    let place = columns(COLUMNS).position(|(name, _)| name == column);
    match place.map(|k| row[k]) {
        Some(Cell::Number(value)) => value,
        Some(Cell::Count(value)) => value as f64,
        _ => f64::NAN,
    }
}

/// Shares of promises that are broken, and what the choice costs; `known` scenes have a reference.
fn claims(rows: &[Vec<Cell>], known: usize) -> Vec<Claim> {
    let mut claims = Vec::new();
    for tolerance in TOLERANCES {
        let of_tolerance = |row: &&Vec<Cell>| number(row, "tolerance") == tolerance;
        let percent = 100.0 * tolerance;
        for (what, with_reference) in [("random scenes", false), ("scenes with a reference", true)] {
            let kind = |row: &&Vec<Cell>| (number(row, "scene") < known as f64) == with_reference;
            let of: Vec<_> = rows.iter().filter(of_tolerance).filter(kind).collect();
            let promised = of.iter().filter(|row| number(row, "promised") == 1.0);
            let errors: Vec<f64> = promised.map(|row| number(row, "true_error")).collect();
            let decided = errors.iter().filter(|error| !error.is_nan()).count();
            let broken = errors.iter().filter(|error| **error > tolerance).count();
            if decided > 0 {
                let text = format!(
                    "{percent} %: share not within the tolerance among {decided} on {what} ({} statements on {} scenes, {} of which no converged solution decides)",
                    errors.len(),
                    of.len(),
                    errors.len() - decided
                );
                let share = broken as f64 / decided as f64;
                claims.push(Claim::new(text, "1", None, Some(share), 1.0 - COVERAGE));
            }
        }
        let measured: Vec<_> =
            rows.iter().filter(of_tolerance).filter(|row| number(row, "cost_ratio").is_finite()).collect();
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
            ("share of scenes above 2", dearer, DEAR),
        ] {
            let text = format!(
                "{percent} %: cost of auto over that of the cheapest admissible choice, {what}: {how}"
            );
            claims.push(Claim::new(text, "1", None, Some(ours), bound));
        }
    }
    claims
}
