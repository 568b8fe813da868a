//! Impacts of a series per second on one core, with models B and C, cold and warm, with their errors against model C on a mesh for
//! every impact.

use crate::body::cache::Cache;
use crate::body::continuum::MeshOptions;
use crate::error::{Error, Result};
use crate::evidence::bench::{Bench, Settings};
use crate::kinds::plate_impact::PlateQuantities;
use crate::kinds::plate_impact::errors::largest_error;
use crate::kinds::plate_impact::reduced::{Point, Reduced};
use crate::kinds::plate_impact::shared::SharedBodies;
use crate::kinds::plate_impact::variants::{ContinuumSetup, Simplification, Variants};
use crate::sampling::latin_hypercube;
use crate::scene::{self, DEFAULT_MODES, Field, Model, Scene, Template};
use crate::sweep::DEFAULT_TOLERANCE;
use rayon::prelude::*;
use serde::Serialize;
use std::time::Instant;

/// The scene around which is varied.
const SCENE: &str = "scaled-plate-r10";
/// What varies first: all that leaves the shapes alone.
const SIZES: [(&str, f64, f64); 5] = [
    ("outer.speed", 0.3, 0.9),
    ("outer.radius", 6e-3, 14e-3),
    ("inner.radius", 6e-3, 14e-3),
    ("materials.steel.youngs_modulus", 150e9, 250e9),
    ("materials.steel.density", 5000.0, 9000.0),
];
/// And then the shapes too.
const SHAPES: [(&str, f64, f64); 2] =
    [("plate.thickness", 1.4e-3, 2.6e-3), ("materials.steel.poisson_ratio", 0.25, 0.35)];
/// Relative error of the integration of the impacts that the others are compared with.
const EXACT: f64 = 1e-7;

/// Of so many impacts one has its bodies meshed once more, finer by so much in every direction.
const REFINED: (usize, f64) = (10, 1.6);

/// What 99 % of the impacts keep, and the largest, of relative errors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Errors {
    /// Of the efficiency.
    pub efficiency: [f64; 2],
    /// Of the larger error of both force peaks.
    pub force_peaks: [f64; 2],
}

impl Errors {
    /// Of pairs of what is compared with what.
    fn of(pairs: &[(PlateQuantities, PlateQuantities)]) -> Self {
        let miss = |ours: f64, exact: f64| (ours / exact - 1.0).abs();
        let of = |error: &dyn Fn(&PlateQuantities, &PlateQuantities) -> f64| {
            most_and_largest(pairs.iter().map(|(ours, exact)| error(ours, exact)).collect())
        };
        Self {
            efficiency: of(&|ours, exact| miss(ours.efficiency, exact.efficiency)),
            force_peaks: of(&|ours, exact| {
                miss(ours.outer_force_peak, exact.outer_force_peak)
                    .max(miss(ours.inner_force_peak, exact.inner_force_peak))
            }),
        }
    }
}

/// A series of impacts with one model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Series {
    /// Name of the model.
    pub model: String,
    /// The fields that vary.
    pub varied: Vec<&'static str>,
    /// How many impacts.
    pub impacts: usize,
    /// Impacts per second on one core, bodies being made on the way.
    pub per_second_cold: f64,
    /// The same with the bodies of a series before.
    pub per_second_warm: f64,
    /// Largest error of velocities, force peaks and efficiency against model C, its bodies meshed for every impact and integrated to 1e-7:
    /// that which 99 % of the impacts keep, and the largest.
    pub error: [f64; 2],
    /// The same of the efficiency, relative.
    pub efficiency_error: [f64; 2],
    /// Of model C's shared bodies against those meshed for every impact, both integrated to 1e-7.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shared: Option<Errors>,
    /// Of bodies meshed for every impact against finer meshes with as many modes, both integrated to 1e-7; of every tenth impact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub meshed: Option<Errors>,
}

/// Runs `settings.series` impacts of each series.
pub(super) fn run(settings: &Settings, bench: &mut Bench) -> Result<()> {
    let template = Template::read(scene::resolve(SCENE)?)?;
    let all: Vec<(&str, f64, f64)> = SIZES.into_iter().chain(SHAPES).collect();
    for varied in [&SIZES[..], &all] {
        let scenes = scenes(&template, varied, settings.series)?;
        let exact: Vec<(usize, Point)> = scenes
            .par_iter()
            .map(|scene| {
                let exact = Reduced::new_in(scene, Model::C, None, &Cache::off())?;
                Ok((exact.system().modes, exact.point(EXACT)?))
            })
            .collect::<Result<_>>()?;
        for model in [Model::B, Model::C] {
            bench.series.push(series(&template, varied, model, &scenes, &exact)?);
        }
    }
    Ok(())
}

/// Random scenes within the ranges `varied`.
fn scenes(template: &Template, varied: &[(&str, f64, f64)], count: usize) -> Result<Vec<Scene>> {
    let fields: Vec<Field> = varied.iter().map(|(name, ..)| template.field(name)).collect::<Result<_>>()?;
    let scene = |place: &Vec<f64>| {
        let value = |(s, (_, from, to)): (&f64, &(&str, f64, f64))| from + (to - from) * s;
        let numbers: Vec<(&Field, f64)> = fields.iter().zip(place.iter().zip(varied).map(value)).collect();
        template.with(&numbers).map_err(|rejected| Error::Internal(rejected.to_string()))
    };
    latin_hypercube(count, varied.len(), 1).iter().map(scene).collect()
}

fn series(
    template: &Template,
    varied: &[(&'static str, f64, f64)],
    model: Model,
    scenes: &[Scene],
    exact: &[(usize, Point)],
) -> Result<Series> {
    let setup = template.scene().plate_impact()?;
    let ranges = varied.iter().map(|(name, from, to)| (*name, [*from, *to]));
    let bodies = SharedBodies::for_varied(ranges, setup, scenes.len());
    let run =
        |scene: &Scene, tolerance| Reduced::in_series(scene.clone(), model, None, &bodies)?.point(tolerance);
    let pass = || -> Result<(Vec<Point>, f64)> {
        let start = Instant::now();
        let points = scenes.iter().map(|scene| run(scene, DEFAULT_TOLERANCE)).collect::<Result<_>>()?;
        Ok((points, scenes.len() as f64 / start.elapsed().as_secs_f64()))
    };
    let (points, per_second_cold) = pass()?;
    let (_, per_second_warm) = pass()?;
    let (mut errors, mut efficiencies) = (Vec::new(), Vec::new());
    for ((scene, ours), (_, exact)) in scenes.iter().zip(&points).zip(exact) {
        let (ours, exact) = (&ours.quantities, &exact.quantities);
        errors.push(largest_error(ours, exact, scene.plate_impact()?.outer.speed).0);
        efficiencies.push((ours.efficiency / exact.efficiency - 1.0).abs());
    }
    let (mut shared, mut meshed) = (Vec::new(), Vec::new());
    if model == Model::C {
        let pair = |(scene, (_, exact)): (&Scene, &(usize, Point))| {
            Ok((run(scene, EXACT)?.quantities, exact.quantities))
        };
        shared = scenes.par_iter().zip(exact).map(pair).collect::<Result<_>>()?;
        let tenth: Vec<_> = scenes.iter().zip(exact).step_by(REFINED.0).collect();
        let pair = |(scene, (modes, _)): (&Scene, &(usize, Point))| {
            let on = |mesh: MeshOptions| {
                let setup = ContinuumSetup { mesh, ..ContinuumSetup::default() };
                Variants::new(scene, [1, *modes], DEFAULT_MODES, &setup)?.run(
                    Simplification::None,
                    *modes,
                    EXACT,
                )
            };
            Ok((on(MeshOptions::default())?, on(MeshOptions::default().refined(REFINED.1))?))
        };
        meshed = tenth.into_par_iter().map(pair).collect::<Result<_>>()?;
    }
    let errors_of = |pairs: &[_]| (!pairs.is_empty()).then(|| Errors::of(pairs));
    Ok(Series {
        shared: errors_of(&shared),
        meshed: errors_of(&meshed),
        model: model.to_string(),
        varied: varied.iter().map(|(name, ..)| *name).collect(),
        impacts: scenes.len(),
        per_second_cold,
        per_second_warm,
        error: most_and_largest(errors),
        efficiency_error: most_and_largest(efficiencies),
    })
}

/// What 99 % of the values keep, and the largest.
fn most_and_largest(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[((share * values.len() as f64) as usize).min(values.len() - 1)];
    [at(0.99), at(1.0)]
}
