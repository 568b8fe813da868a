//! Section 3.4.2 and Fig. 13 of the paper: the efficiency of repeated impacts on plates of steel that yields.

use super::parameter::{impact, scene, steel};
use crate::error::{Error, Result};
use crate::evidence::study::{Axis, Cell, Claim, Note, Only, Panel, Settings, Study, of_project};
use crate::kinds::plate_impact::reduced::Reduced;
use crate::material::RateHardening;
use crate::reference::{Resolution, Store};
use crate::result::{Impact, Summary};
use crate::scene::{Edge, Model, Series, Spot};
use rayon::prelude::*;

/// Table 1's plates: text, radius of the spheres in m, speed in m/s, and the scene whose stored reference is shown.
const PLATES: [(&str, f64, f64, &str); 2] = [
    ("10 mm", 10e-3, 0.55, "validation/repeated-r10"),
    ("6.35 mm", 6.35e-3, 0.437, "validation/repeated-r6.35"),
];
/// Radius and thickness of both, m.
const PLATE: (f64, f64) = (33e-3, 2e-3);
/// Text, yield strength in Pa, spot on the spheres, rate.
type Case = (&'static str, f64, Spot, Option<RateHardening>);
/// The paper does not tell its yield strength.
const CASES: [Case; 5] = [
    ("350 MPa", 350e6, Spot::Same, None),
    (SHOWN, 600e6, Spot::Same, None),
    ("1000 MPa", 1000e6, Spot::Same, None),
    ("600 MPa, fresh spots", 600e6, Spot::Fresh, None),
    ("350 MPa, rate of mild steel", 350e6, Spot::Same, Some(MILD_STEEL)),
];
/// The case whose reference is stored.
const SHOWN: &str = "600 MPa";
const ELASTIC: &str = "elastic";
const REFERENCE: &str = "600 MPa, FE";
/// Cowper and Symonds 1957.
const MILD_STEEL: RateHardening = RateHardening { reference_rate: 40.4, exponent: 5.0 };
/// E / 100.
const HARDENING: f64 = 2.1e9;
const MOST_IMPACTS: u64 = 20;
/// Relative error of the efficiency that the time integration may have.
const TOLERANCE: f64 = 1e-5;

/// How it is drawn: a panel per plate.
pub const PANELS: [Panel; 2] = [panel(&[PLATES[0].0]), panel(&[PLATES[1].0])];

const fn panel(spheres: &'static [&'static str]) -> Panel {
    Panel {
        only: Some(Only { column: "spheres", texts: spheres }),
        ..Panel::of(
            Axis::new("impact", "Number of the impact", 1.0),
            Axis::new("efficiency", "Efficiency in %", 100.0),
        )
        .by(Axis::new("case", "", 1.0))
    }
}

/// A course of the efficiency: number of the impact, efficiency, half width of its band.
struct EfficiencyCurve {
    case: &'static str,
    points: Vec<(u64, Option<f64>, Option<f64>)>,
}

impl EfficiencyCurve {
    fn of(case: &'static str, impacts: &[Impact]) -> Self {
        let point = |i: &Impact| (i.number, i.value("efficiency"), i.band("efficiency"));
        EfficiencyCurve { case, points: impacts.iter().map(point).collect() }
    }

    fn first(&self) -> Option<f64> {
        self.points.first()?.1
    }

    fn steady(&self) -> Option<f64> {
        self.points.last()?.1
    }

    /// Impacts until the efficiency is within 1 % of the steady one.
    fn impacts_needed(&self) -> Option<f64> {
        let steady = self.steady()?;
        let near = |efficiency: Option<f64>| efficiency.is_some_and(|e| (e - steady).abs() <= 0.01 * steady);
        self.points.iter().find(|(_, efficiency, _)| near(*efficiency)).map(|(number, ..)| *number as f64)
    }
}

/// The study.
///
/// # Errors
/// As [`Reduced::new`] and [`Reduced::run`].
pub fn run(settings: &Settings, note: &mut Note) -> Result<Study> {
    let model = settings.model.unwrap_or(Model::C);
    let store = Store::open(settings.store.as_deref());
    let (mut rows, mut claims) = (Vec::new(), Vec::new());
    for (spheres, radius, speed, stored) in PLATES {
        note(&format!("{} series with model {model}, spheres of {spheres}", CASES.len()));
        let mut courses = courses(radius, speed, model)?;
        claims.extend(claims_of(spheres, &model.to_string(), &courses));
        match of_reference(stored, &store) {
            Ok(course) => courses.push(course),
            Err(error) => note(&format!("without finite elements: {error}")),
        }
        for course in &courses {
            rows.extend(course.points.iter().map(|(number, efficiency, band)| {
                let [spheres, case] = [spheres, course.case].map(Cell::Text);
                vec![spheres, case, Cell::Count(*number as usize), (*efficiency).into(), (*band).into()]
            }));
        }
    }
    Ok(Study::new(
        "shakedown",
        format!(
            "Section 3.4.2 and Fig. 13 of the paper: efficiency of repeated impacts, model {model}, all bodies of steel with a \
             hardening of E/100. The paper does not specify the yield strength, so several are shown; it names a low start, a \
             rise to a steady state, and that this is often above the efficiency without yielding."
        ),
        "spheres, case, impact, efficiency, efficiency_band",
        rows,
        claims,
    ))
}

/// The courses of all cases, and the elastic value as one.
fn courses(radius: f64, speed: f64, model: Model) -> Result<Vec<EfficiencyCurve>> {
    let summary = |(_, strength, sphere_spot, rate): &Case| {
        let mut setup = impact(PLATE.0, PLATE.1, Edge::Clamped, steel(), radius);
        setup.outer.speed = speed;
        for material in [&mut setup.plate.material, &mut setup.outer.material, &mut setup.inner.material] {
            (material.yield_strength, material.hardening) = (Some(*strength), Some(HARDENING));
            material.rate = *rate;
        }
        setup.series = Some(Series { impacts: MOST_IMPACTS, sphere_spot: *sphere_spot });
        Reduced::new(&scene("shakedown", setup), model, None)?.run(TOLERANCE)
    };
    let summaries = CASES.par_iter().map(summary).collect::<Result<Vec<_>>>()?;
    let of_case = |(case, summary): (&Case, &Summary)| EfficiencyCurve::of(case.0, &summary.impacts);
    let mut courses: Vec<EfficiencyCurve> = CASES.iter().zip(&summaries).map(of_case).collect();
    let longest = courses.iter().filter_map(|course| Some(course.points.last()?.0)).max().unwrap_or(1);
    let elastic = summaries[0].elastic_efficiency;
    courses
        .push(EfficiencyCurve { case: ELASTIC, points: vec![(1, elastic, None), (longest, elastic, None)] });
    Ok(courses)
}

/// The stored reference of a validation scene, the finest there is.
///
/// # Errors
/// [`Error::Reference`] if there is none; as [`Scene::read`].
fn of_reference(name: &str, store: &Store) -> Result<EfficiencyCurve> {
    let scene = of_project(name)?;
    let mut resolutions = [Resolution::Fine, Resolution::Paper, Resolution::Coarse].into_iter();
    let missing = || {
        Error::Reference(format!("none is stored; `impactcheck reference scenes/{name}.toml` computes it"))
    };
    let stored =
        resolutions.find_map(|resolution| store.find(&scene, resolution).found()).ok_or_else(missing)?;
    Ok(EfficiencyCurve::of(REFERENCE, &stored.outcome.summary.impacts))
}

/// What the paper says of Fig. 13, by `model`; its numbers are in a picture only, so that the bounds are on the signs.
fn claims_of(spheres: &str, model: &str, courses: &[EfficiencyCurve]) -> Vec<Claim> {
    let find = |case| courses.iter().find(|course: &&EfficiencyCurve| course.case == case);
    let shown = find(SHOWN);
    let elastic = find(ELASTIC).and_then(EfficiencyCurve::first);
    let share = |top: Option<f64>, bottom: Option<f64>| Some(top? / bottom?);
    let claim = |text: &str| format!("{spheres} spheres, {SHOWN}, model {model}: {text}");
    let (first, steady) = (shown.and_then(EfficiencyCurve::first), shown.and_then(EfficiencyCurve::steady));
    let holds = |text: &str, value: Option<bool>| {
        let value = value.map(|holds| f64::from(u8::from(holds)));
        Claim::new(claim(text), "1", Some(1.0), value, 0.0)
    };
    let rises = shown.map(|course| {
        let efficiencies: Vec<f64> =
            course.points.iter().filter_map(|(_, efficiency, _)| *efficiency).collect();
        // a steady state is steady to a tenth of a per cent
        efficiencies.windows(2).all(|pair| pair[1] > pair[0] - 1e-3 * pair[0])
    });
    vec![
        holds("the first impact is below the elastic efficiency", share(first, elastic).map(|s| s < 1.0)),
        holds("efficiency rises with each impact to a steady state", rises),
        holds("the steady state lies above the elastic efficiency", share(steady, elastic).map(|s| s > 1.0)),
        holds(
            "the steady state is nearer to the elastic efficiency than the first impact",
            first.zip(steady).zip(elastic).map(|((f, s), e)| (s - e).abs() < (f - e).abs()),
        ),
        holds(
            "a lower yield strength needs more impacts to come within 1 % of the steady state",
            find(CASES[0].0)
                .and_then(EfficiencyCurve::impacts_needed)
                .zip(shown.and_then(EfficiencyCurve::impacts_needed))
                .map(|(weak, strong)| weak > strong),
        ),
    ]
}
