//! One launch: the whole impact, computed, and what it shows at any time.

use crate::course::{integrals, motion};
use crate::source::UnitSource;
use crate::variables::Output;
use impactcheck_physics::Result;
use impactcheck_physics::flight::Seat;
use impactcheck_physics::kinds::Series;
use impactcheck_physics::result::{Outcome, Summary};
use impactcheck_physics::scene::{Model, Scene};
use impactcheck_prediction::{Prediction, predict_of_any};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// An impact that was computed.
#[derive(Debug)]
pub struct LaunchedImpact {
    scene: Scene,
    outcome: Outcome,
    /// By name of the force.
    impulses: BTreeMap<&'static str, Vec<f64>>,
    /// 95 % intervals, as soon as someone asks.
    prediction: OnceLock<Prediction>,
}

impl LaunchedImpact {
    /// Computes the impact of `scene` with the model of `source`, one of a `series`.
    ///
    /// # Errors
    /// Those of the model.
    pub fn new(source: &UnitSource, series: &dyn Series, scene: Scene) -> Result<Self> {
        let model = series.model(scene.clone(), source.model, source.setup.modes)?;
        let outcome = model.run_with_history(source.setup.tolerance)?;
        let history = &outcome.history;
        let forces = history.curves.iter().filter(|curve| curve.unit == "N");
        let impulses = forces.map(|curve| (curve.name, integrals(&history.time, &curve.values))).collect();
        Ok(Self { scene, outcome, impulses, prediction: OnceLock::new() })
    }

    /// Its results.
    pub fn summary(&self) -> &Summary {
        &self.outcome.summary
    }

    /// Time in s from the first contact to the last release, or to the end of a run that was cut before.
    pub fn duration(&self) -> f64 {
        let end = self.outcome.history.time.last().copied().unwrap_or(0.0);
        self.summary().last_contact().unwrap_or(end)
    }

    /// Whether nothing that the run leaves open is wanted: it was not cut, but a stack presses on for ever.
    fn is_whole(&self) -> bool {
        self.summary().last_contact().is_some() || self.summary().stack.is_some()
    }

    /// What the user has to know of it, in sentences.
    pub fn remarks(&self) -> Vec<String> {
        let (summary, kind) = (self.summary(), impactcheck_physics::kinds::of(&self.scene));
        let open: Vec<&str> = summary.undetermined().filter(|name| kind.has(&self.scene, name)).collect();
        let open = (!open.is_empty()).then(|| format!("the run does not determine {}", open.join(", ")));
        summary.warnings.iter().cloned().chain(open).collect()
    }

    /// Value of `output` at `time` s, with the first contact and the last release at `events`, all times of the simulation; `series` shares
    /// bodies with the model that predictions need.
    pub fn value(
        &self,
        (source, series): (&UnitSource, &dyn Series),
        output: Output,
        events: [f64; 2],
        time: f64,
    ) -> f64 {
        let [contact, release] = events;
        let is_over = time >= release;
        let once_over = |value: f64| if is_over { value } else { 0.0 };
        let truth = |is_true: bool| f64::from(u8::from(is_over && is_true));
        let summary = self.summary();
        match output {
            Output::Contact | Output::Curve(_) | Output::Impulse(_) if time < contact => 0.0,
            Output::Curve(name) => self.curve(name, time - contact),
            Output::Impulse(force) => self.impulse(force, time - contact),
            Output::Over => truth(true),
            Output::Contact => contact,
            Output::Release => once_over(summary.last_contact().map_or(f64::NAN, |_| release)),
            Output::Quantity(quantity) => once_over(summary.value(quantity.name).unwrap_or(f64::NAN)),
            Output::Valid => truth(self.is_whole() && summary.warnings.is_empty()),
            Output::Warnings => once_over(summary.warnings.len() as f64),
            Output::Predicted if is_over => truth(self.prediction(source, series).is_ok()),
            Output::Low(name) if is_over => self.interval(source, series, name)[0],
            Output::High(name) if is_over => self.interval(source, series, name)[1],
            Output::Predicted | Output::Low(_) | Output::High(_) => 0.0,
            Output::Shifts => truth(summary.flight.as_ref().is_some_and(|flight| flight.seat == Seat::Other)),
            Output::Landing => {
                once_over(summary.flight.as_ref().map_or(f64::NAN, |flight| release + flight.time))
            }
        }
    }

    /// Displacement or velocity `t` s after the first contact.
    fn curve(&self, name: &str, t: f64) -> f64 {
        let history = &self.outcome.history;
        let of = |what: &str| {
            let displacement = history.curve(&name.replace(what, "displacement"))?;
            let velocity = history.curve(&name.replace(what, "velocity"))?;
            Some(motion(&history.time, displacement, velocity, t))
        };
        let found = if name.contains("velocity") {
            of("velocity").map(|[_, v]| v)
        } else {
            of("displacement").map(|[u, _]| u)
        };
        found.unwrap_or(f64::NAN)
    }

    /// Integral of a force from the first contact to `t` s after it.
    fn impulse(&self, force: &str, t: f64) -> f64 {
        let history = &self.outcome.history;
        match (self.impulses.get(force), history.curve(force)) {
            (Some(impulse), Some(force)) => {
                let last = history.time.last().copied().unwrap_or(0.0);
                motion(&history.time, impulse, force, t.clamp(0.0, last))[0]
            }
            _ => f64::NAN,
        }
    }

    /// The 95 % interval of the quantity `name`.
    fn interval(&self, source: &UnitSource, series: &dyn Series, name: &str) -> [f64; 2] {
        let intervals = self.prediction(source, series).as_ref().ok();
        let found = intervals.and_then(|intervals| intervals.get(name));
        found.map_or([f64::NAN; 2], |interval| [interval.low, interval.high])
    }

    /// What a converged reference would find: model C runs for it, as it is by default, unless this is its result.
    fn prediction(&self, source: &UnitSource, series: &dyn Series) -> &Prediction {
        self.prediction.get_or_init(|| {
            let is_default = source.setup.modes.or(self.scene.reduced.modes).is_none();
            let is_continuum = source.model == Model::C && is_default;
            predict_of_any(&self.scene, (self.summary(), is_continuum), |scene| {
                series.model(scene.clone(), Model::C, None)?.run(source.setup.tolerance)
            })
        })
    }
}
