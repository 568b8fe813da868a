//! The unit: its variables, its state, its steps.

use crate::impact::LaunchedImpact;
use crate::source::UnitSource;
use crate::variables::{Output, Role, Type, UnitVariable, variables};
use impactcheck_physics::kinds::{self, Series};
use impactcheck_physics::scene::Field;
use impactcheck_physics::{Error, Result};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Numbers of a stack that are those at its voltage, and grow with it.
const AT_THE_VOLTAGE: [&str; 2] = ["outer.stroke", "outer.blocked_force"];
/// Difference of two times over the communication step that is taken as rounding.
const ROUNDING: f64 = 1e-6;

/// Why a call is not carried out, in a sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Refusal {
    /// The value or the scene is not possible. The unit is as before, and other values may do.
    Discard(String),
    /// The call itself is wrong.
    Error(String),
}

type Done<T = ()> = std::result::Result<T, Refusal>;

fn wrong<T>(reason: impl Into<String>) -> Done<T> {
    Err(Refusal::Error(reason.into()))
}

/// An impact that was launched.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Launched {
    /// Simulation times of the first contact and the last release, s.
    events: [f64; 2],
    /// Values of all variables at the launch.
    values: Vec<f64>,
    /// What came of it; computed again where a state comes from a file.
    #[serde(skip)]
    impact: Option<Arc<LaunchedImpact>>,
}

/// All that changes of a unit.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct UnitState {
    /// Token of the unit that it belongs to.
    token: String,
    /// Values of parameters and inputs, by value reference.
    values: Vec<f64>,
    /// Simulation time, s.
    time: f64,
    /// Whether the next edge of `launch` launches.
    armed: bool,
    /// `arm` and `launch` at the last step.
    before: [bool; 2],
    launched: Option<Launched>,
}

impl UnitState {
    /// At rest at time 0, of the unit with this `token` and these `variables`.
    fn new(token: &str, variables: &[UnitVariable]) -> Self {
        Self {
            token: token.to_owned(),
            values: variables.iter().map(|variable| variable.start).collect(),
            time: 0.0,
            armed: false,
            before: [false; 2],
            launched: None,
        }
    }
}

/// Where a step ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Reached {
    /// Simulation time, s.
    pub time: f64,
    /// Whether that is before the end of the step, at a first contact or a last release.
    pub early: bool,
    /// What the user has to know: the warnings of an impact that was launched, a launch that was ignored.
    pub remarks: Vec<String>,
}

/// A scene's reduced model that a simulation steps through time.
#[derive(Debug)]
pub struct ImpactUnit {
    source: UnitSource,
    series: Box<dyn Series>,
    variables: Vec<UnitVariable>,
    state: UnitState,
}

impl ImpactUnit {
    /// The unit of `source`, at rest at time 0.
    ///
    /// # Errors
    /// Those of a seat's mesh.
    pub fn new(source: UnitSource) -> Result<Self> {
        let variables = variables(&source.template);
        let state = UnitState::new(&source.setup.token, &variables);
        let series = kinds::series([], source.template.scene(), source.mesh.as_ref(), 1)?;
        Ok(Self { source, series, variables, state })
    }

    /// Its variables, by value reference.
    pub fn variables(&self) -> &[UnitVariable] {
        &self.variables
    }

    /// Its state.
    pub fn state(&self) -> &UnitState {
        &self.state
    }

    /// Puts it into a `state` that it, or another instance of the same unit, was in.
    ///
    /// # Errors
    /// [`Refusal::Error`] of a state of another unit, or of one whose impact can't be computed.
    pub fn set_state(&mut self, mut state: UnitState) -> Done {
        let launched = state.launched.as_ref().map_or(self.variables.len(), |launched| launched.values.len());
        let lengths = [state.values.len(), launched];
        if state.token != self.state.token || lengths != [self.variables.len(); 2] {
            return wrong(format!(
                "the state belongs to another unit: its token is {}, that of this unit {}",
                state.token, self.state.token
            ));
        }
        if let Some(launched) = state.launched.as_mut().filter(|launched| launched.impact.is_none()) {
            launched.impact = Some(Arc::new(self.impact_of(&launched.values)?));
        }
        self.state = state;
        Ok(())
    }

    /// Begins at `time` s.
    ///
    /// # Errors
    /// [`Refusal::Error`] if it is not finite.
    pub fn begin(&mut self, time: f64) -> Done {
        if !time.is_finite() {
            return wrong(format!("the start time is {time}, but it must be finite"));
        }
        self.state.time = time;
        Ok(())
    }

    /// Back to the values of the start, at rest at time 0.
    pub fn reset(&mut self) {
        self.state = UnitState::new(&self.state.token, &self.variables);
    }

    fn variable(&self, reference: u32, kind: Type) -> Done<&UnitVariable> {
        let Some(variable) = self.variables.get(reference as usize) else {
            let last = self.variables.len() - 1;
            return wrong(format!(
                "there is no variable with the value reference {reference}; they are 0 to {last}"
            ));
        };
        match variable.kind == kind {
            true => Ok(variable),
            false => wrong(format!(
                "`{}` (value reference {reference}) is of type {:?}, not {kind:?}",
                variable.name, variable.kind
            )),
        }
    }

    /// The value of a variable, a truth as 0 or 1.
    ///
    /// # Errors
    /// [`Refusal::Error`] if there is no such variable of this type.
    pub fn get(&self, reference: u32, kind: Type) -> Done<f64> {
        Ok(match self.variable(reference, kind)?.role {
            Role::Time => self.state.time,
            Role::Output(output) => self.output(output),
            _ => self.state.values[reference as usize],
        })
    }

    fn output(&self, output: Output) -> f64 {
        let Some(launched) = &self.state.launched else { return 0.0 };
        let Some(impact) = &launched.impact else { return 0.0 };
        let models = (&self.source, &*self.series);
        impact.value(models, output, launched.events, self.state.time)
    }

    /// Sets a parameter or an input, a truth as 0 or 1.
    ///
    /// # Errors
    /// [`Refusal::Error`] if there is no such parameter or input of this type; [`Refusal::Discard`] of a number out of bounds.
    pub fn set(&mut self, reference: u32, kind: Type, value: f64) -> Done {
        let variable = self.variable(reference, kind)?;
        match &variable.role {
            Role::Time => return wrong("`time` can't be set: steps advance it"),
            Role::Output(_) => return wrong(format!("`{}` is an output and can't be set", variable.name)),
            Role::Field(field) => {
                field.check(value).map_err(|rejected| Refusal::Discard(rejected.to_string()))?;
            }
            // an input may pass through what a launch can't have
            Role::Voltage(_) if !value.is_finite() => {
                return Err(Refusal::Discard(format!(
                    "`{}` is {value} V, but it must be finite",
                    variable.name
                )));
            }
            Role::Voltage(_) | Role::Arm | Role::Launch => {}
        }
        self.state.values[reference as usize] = value;
        Ok(())
    }

    /// Steps from `time` by `step` s. With `may_stop` the step ends at a first contact or a last release within it.
    ///
    /// # Errors
    /// [`Refusal::Error`] of a step that is not positive, does not begin where the last one ended, or launches an impact that can't be
    /// computed. The unit is as before.
    pub fn step(&mut self, time: f64, step: f64, may_stop: bool) -> Done<Reached> {
        if !(step > 0.0 && step.is_finite()) {
            return wrong(format!("the communication step is {step:?} s, but it must be greater than 0 s"));
        }
        let own = self.state.time;
        let is_there = (time - own).abs() <= ROUNDING * step + 4.0 * f64::EPSILON * own.abs();
        if !is_there {
            return wrong(format!(
                "the communication point is {time:?} s, but the unit is at {own:?} s: a step begins where the last one ended"
            ));
        }
        let (mut next, remarks) = self.with_edges(time)?;
        let end = time + step;
        let events = next.launched.as_ref().map_or([f64::NAN; 2], |launched| launched.events);
        let event = events.into_iter().find(|event| time < *event && *event < end);
        let early = event.filter(|_| may_stop);
        next.time = early.unwrap_or(end);
        self.state = next;
        Ok(Reached { time: self.state.time, early: early.is_some(), remarks })
    }

    /// Ends the initialization: a launch that is set already begins now. What the user has to know of it.
    ///
    /// # Errors
    /// [`Refusal::Error`] of an impact that can't be computed.
    pub fn start(&mut self) -> Done<Vec<String>> {
        let (next, remarks) = self.with_edges(self.state.time)?;
        self.state = next;
        Ok(remarks)
    }

    /// The state after the edges of `arm` and `launch` at `time` s, and what the user has to know of them.
    fn with_edges(&self, time: f64) -> Done<(UnitState, Vec<String>)> {
        let mut next = self.state.clone();
        let mut remarks = Vec::new();
        let on = |role: fn(&Role) -> bool| {
            let found = self.variables.iter().position(|variable| role(&variable.role));
            found.is_some_and(|reference| next.values[reference] != 0.0)
        };
        let now = [on(|role| matches!(role, Role::Arm)), on(|role| matches!(role, Role::Launch))];
        let [arms, launches] = [0, 1].map(|k| now[k] && !next.before[k]);
        next.before = now;
        next.armed &= now[0];
        if arms {
            (next.armed, next.launched) = (true, None);
        }
        if launches && next.armed {
            let impact = self.impact_of(&next.values)?;
            remarks.extend(impact.remarks());
            let contact = time + impact.summary().strike_delay();
            let (events, values) = ([contact, contact + impact.duration()], next.values.clone());
            next.launched = Some(Launched { events, values, impact: Some(Arc::new(impact)) });
            next.armed = false;
        } else if launches {
            remarks
                .push("the launch is ignored: set `arm` to false and to true again after an impact".into());
        }
        Ok((next, remarks))
    }

    /// The impact of the scene with these `values` of the variables.
    fn impact_of(&self, values: &[f64]) -> Done<LaunchedImpact> {
        let scene = self.source.template.with(&self.numbers(values));
        let scene =
            scene.map_err(|rejected| Refusal::Error(format!("the impact can't be launched: {rejected}")))?;
        let failed = |error: Error| Refusal::Error(format!("the impact can't be computed: {error}"));
        LaunchedImpact::new(&self.source, &*self.series, scene).map_err(failed)
    }

    /// The fields that differ from the scene file's, with their numbers.
    fn numbers(&self, values: &[f64]) -> Vec<(&Field, f64)> {
        let factor = self.variables.iter().zip(values).find_map(|(variable, value)| match variable.role {
            Role::Voltage(_) if variable.start != 0.0 => Some(value / variable.start),
            _ => None,
        });
        self.variables
            .iter()
            .zip(values)
            .filter_map(|(variable, value)| match &variable.role {
                Role::Field(field) | Role::Voltage(field) => {
                    let grows = AT_THE_VOLTAGE.contains(&field.path());
                    Some((field, value * factor.filter(|_| grows).unwrap_or(1.0), variable.start))
                }
                _ => None,
            })
            .filter(|(_, value, start)| value != start)
            .map(|(field, value, _)| (field, value))
            .collect()
    }
}
