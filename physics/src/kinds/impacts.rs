//! One impact, or a series of them in which every one finds the dents of those before.

use crate::dynamics::StopReason;
use crate::dynamics::contact_balance::ContactBalance;
use crate::dynamics::error_control::{self, controlled};
use crate::dynamics::integration::{Integration, Options};
use crate::dynamics::memory::{self, ForceHistory, Memory, OnsetOfYield};
use crate::dynamics::system::System;
use crate::dynamics::wet::FluidForces;
use crate::error::{Error, Result};
use crate::kinds::rubbing::{Rubbing, is_settled};
use crate::result::{Impact, Table};
use crate::scene::Series;
use std::collections::BTreeMap;

/// Plastic work over the impact's energy below which nothing yields any more.
const SHAKEN_DOWN: f64 = 3e-4;

/// Samples of a course of forces per duration of a Hertz contact.
pub(super) const SAMPLES_PER_CONTACT: f64 = 400.0;

/// Runs after which no elastic limit is found, and the relative change from one to the next that is in order.
const MOST_RUNS: usize = 30;
const CONVERGED: f64 = 1e-5;
/// Speed of the outer body over the inner body's own below which the inner one decides what yields.
const OWN_SPEED: f64 = 0.01;

/// The impacts of a model.
pub(super) struct Impacts<'a> {
    pub(super) system: &'a System,
    /// Forces of the fluid; a dry impact has none and takes the dry integrator.
    pub(super) fluid: Option<&'a FluidForces>,
    /// What the materials remember; elastic ones nothing.
    pub(super) memory: Option<&'a Memory>,
    /// The bodies that move along the surfaces, if they do.
    pub(super) rubbing: Option<&'a Rubbing>,
    pub(super) series: Option<Series>,
    /// The values at the end of an integration.
    pub(super) values: &'a dyn Fn(&System, &Integration) -> Table,
}

/// What a series comes to.
pub(super) struct Done {
    /// The last impact.
    pub(super) last: Integration,
    /// What the materials remembered when it began.
    pub(super) memory: Option<Memory>,
    /// All impacts; none without a series.
    pub(super) impacts: Vec<Impact>,
    /// Said if the last of a series still yields, or a contact became too wide.
    pub(super) warnings: Vec<String>,
}

impl Impacts<'_> {
    /// All of them, without histories.
    ///
    /// # Errors
    /// As [`integrate`].
    pub(super) fn all(&self, options: &Options) -> Result<Done> {
        let (mut last, mut after) = self.one(options, self.memory)?;
        let Some(series) = self.series else {
            let warnings = after.iter().filter_map(Memory::too_wide).collect();
            return Ok(Done { last, memory: self.memory.cloned(), impacts: Vec::new(), warnings });
        };
        let mut before = self.memory.cloned();
        let mut impacts = vec![self.row(1, &last)];
        while impacts.len() < series.impacts as usize && !self.has_shaken_down(&last) {
            before = after.map(|memory| memory.next(series.sphere_spot));
            (last, after) = self.one(options, before.as_ref())?;
            impacts.push(self.row(impacts.len() as u64 + 1, &last));
        }
        let left = self.plastic_work(&last) / self.system.kinetic_energy();
        let warning = (!self.has_shaken_down(&last)).then(|| {
            format!(
                "the last of {} impacts still dissipates {left:.1e} of its energy plastically: shakedown (below {SHAKEN_DOWN:.0e}) is not reached",
                impacts.len()
            )
        });
        let warnings = warning.into_iter().chain(after.iter().filter_map(Memory::too_wide)).collect();
        Ok(Done { last, memory: before, impacts, warnings })
    }

    /// One impact, and what the materials remember after it. Where bodies rub its history is that of the forces along the way, unless the
    /// `options` request another one.
    ///
    /// # Errors
    /// As [`integrate`].
    pub(super) fn one(
        &self,
        options: &Options,
        memory: Option<&Memory>,
    ) -> Result<(Integration, Option<Memory>)> {
        let options = &self.rubbing.map_or(*options, |rubbing| rubbing.keeping_forces(self.system, options));
        let Some(memory) = memory else { return Ok((self.elastic(options)?, None)) };
        // virgin contacts below their onset of yield are elastic ones
        if memory.is_elastic() {
            let (result, loads) = self.loaded(options)?;
            if memory.is_elastic_under(self.system, &loads, result.contacts.map(|c| c.force_peak)) {
                return Ok((result, Some(memory.clone())));
            }
        }
        memory::integrate(self.system, memory, options).map(|(result, after)| (result, Some(after)))
    }

    fn elastic(&self, options: &Options) -> Result<Integration> {
        let run = |system: &System, options: &Options| controlled(options, system, self.fluid);
        match self.rubbing {
            None => run(self.system, options),
            Some(rubbing) => rubbing.settled(self.system, options, run),
        }
    }

    /// The elastic impact, and the course of its forces.
    fn loaded(&self, options: &Options) -> Result<(Integration, ForceHistory)> {
        let interval = self.system.hertz_impact().duration() / SAMPLES_PER_CONTACT;
        // nothing is loaded in flight
        let alone = Options { sample_interval: Some(interval), samples_between: 0, ..*options };
        let sampled = if options.sample_interval.is_some() { *options } else { alone };
        let mut result = self.elastic(&sampled)?;
        let loads = result.history.as_ref().and_then(ForceHistory::of);
        let loads = loads.ok_or_else(|| Error::Internal("a history was requested".into()))?;
        result.history = result.history.filter(|_| options.sample_interval.is_some());
        Ok((result, loads))
    }

    /// What the efficiency of a series whose bodies yield would be if they were elastic; `None` where they do not or that is not known.
    pub(super) fn elastic_efficiency(&self, options: &Options) -> Option<f64> {
        self.series?;
        self.memory.filter(|memory| memory.yields().contains(&true))?;
        let result = self.elastic(options).ok().filter(|result| result.stop != StopReason::Cut)?;
        (self.values)(self.system, &result).value("efficiency")
    }

    /// Largest speeds of the outer body in m/s at which outer and inner contact of virgin bodies stay below their `onset`; `None` where
    /// there is no such speed.
    ///
    /// On a rigid wall the peak of Hertz's force grows with the speed to the 6/5 (Johnson 1985, section 11.4), on a plate nearly so:
    /// that power, repeatedly.
    pub(super) fn elastic_speeds(&self, onset: &OnsetOfYield, options: &Options) -> [Option<f64>; 2] {
        [0, 1].map(|i| {
            let mut speed = self.system.speed;
            for _ in 0..MOST_RUNS {
                let system = &self.system.at_speed(speed);
                let (result, loads) = Impacts { system, rubbing: None, ..*self }.loaded(options).ok()?;
                if result.stop == StopReason::Cut {
                    return None;
                }
                let onset = onset.force(i, system, &loads)?;
                let growth = (onset / result.contacts[i].force_peak).powf(5.0 / 6.0);
                speed *= growth;
                if (growth - 1.0).abs() < CONVERGED {
                    return Some(speed);
                }
                if speed < OWN_SPEED * self.system.inner_speed.abs().max(f64::MIN_POSITIVE) {
                    return None;
                }
            }
            None
        })
    }

    fn has_shaken_down(&self, impact: &Integration) -> bool {
        impact.stop == StopReason::Cut
            || self.plastic_work(impact) < SHAKEN_DOWN * self.system.kinetic_energy()
    }

    /// Energy in J lost in contacts that yield.
    fn plastic_work(&self, impact: &Integration) -> f64 {
        let yields = self.memory.map_or([false; 2], Memory::yields);
        let losses = impact.losses.contacts.unwrap_or_default();
        (0..2).filter(|i| yields[*i]).map(|i| losses[i]).sum()
    }

    fn row(&self, number: u64, impact: &Integration) -> Impact {
        let table = (self.values)(self.system, impact);
        Impact {
            number,
            quantities: if impact.stop == StopReason::Cut { table.cut() } else { table },
            plastic_work: (impact.stop != StopReason::Cut).then(|| self.plastic_work(impact)),
            locked_in_energy: None,
            uncertainty: BTreeMap::new(),
        }
    }
}

/// Error of final velocities, over the impact speed, that `result` states: of the time integration, or of friction's effect on the normal
/// motion where that has not converged.
pub(super) fn stated_error(result: &Integration) -> Option<f64> {
    let unsettled = result.friction.as_ref().filter(|_| !is_settled(result, 0.0));
    let friction = unsettled.map(|friction| friction.error);
    result.error_estimate.into_iter().chain(friction).reduce(f64::max)
}

/// A sentence if the final velocities of steps of adapted length have not converged to `tolerance`.
pub(super) fn uncertain(result: &Integration, tolerance: f64) -> Option<String> {
    let adapted = result.least_tolerance == 0.0;
    let unsure = result.error_estimate.filter(|error| adapted && *error > error_control::ENOUGH * tolerance);
    unsure.map(|error| {
        format!(
            "final velocities are uncertain by {error:.0e} of the impact speed: the many contacts of this impact amplify every error"
        )
    })
}

/// Contacts that nearly join, part or touch once more, so that their number may be another.
pub(super) fn uncountable(result: &Integration, tolerance: f64) -> Vec<String> {
    let settled = result.friction.as_ref().map(|friction| friction.error).filter(|error| error.is_finite());
    let error = result.error_estimate.unwrap_or(0.0).max(tolerance).max(settled.unwrap_or(0.0));
    let near = |contact: &ContactBalance| contact.least_turn <= error_control::ENOUGH * error;
    let bodies = ["outer", "inner"].into_iter().zip(&result.contacts);
    bodies
        .filter(|(_, contact)| contact.contacts > 0 && near(contact))
        .map(|(body, contact)| {
            format!(
                "the number of contacts of the {body} body, {}, is uncertain: the surfaces separate or approach by only {:.0e} of the largest approach",
                contact.contacts, contact.least_turn
            )
        })
        .collect()
}
