//! Lays a record over a model: offset, drift and shift in time, by [`super::RULE`].

use super::duplicate;
use super::filter::Filtered;
use super::finding::{Finding, FindingKind};
use super::flight::{FEWEST, FreeFlight, FreeFlightFit};
use super::judge::{JudgedRecord, Seen};
use super::record::{Channel, Record};
use super::screen::{resolution, screened};
use super::shortened::shortened;
use super::structure::Disturbance;
use crate::error::{Error, Result};
use crate::format::quantity;
use crate::kinds::Approach;
use crate::result::Summary;
use serde::Serialize;
use std::path::PathBuf;

/// Rounds of looking for the shift: the first may end on the edge of its reach.
const ROUNDS: usize = 2;
/// How much later than the model's the measured contact may end before its end counts as free flight.
const LONGER_CONTACT: f64 = 1.1;
/// Distance from the model, root mean square over the span, beyond which a record does not show the scene's impact.
const WORST_MISFIT: f64 = 0.25;
/// Further impacts that are cut off the free flight of a signal, one before the other, and vibrations that are taken out.
const DISTURBANCES: usize = 4;

/// Where the outer body's speed before the impact comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Speed {
    /// The scene: the offset of the signal is unknown.
    Scene,
    /// The signal, which is trusted to have no offset.
    Measured,
}

impl std::str::FromStr for Speed {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        match text {
            "scene" => Ok(Speed::Scene),
            "measured" => Ok(Speed::Measured),
            _ => Err(format!("`{text}` is no source of the speed; there are scene and measured")),
        }
    }
}

/// What was taken out of a signal: `offset + drift * t`, t from the first touch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChannelCorrection {
    /// Name of the signal.
    pub quantity: &'static str,
    /// In the unit of the signal.
    pub offset: f64,
    /// In the unit of the signal per second.
    pub drift: f64,
}

/// A record on the time axis of the impact, without offset and drift.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AlignedRecord {
    /// Where it comes from.
    pub file: PathBuf,
    /// Number of samples.
    pub samples: usize,
    /// Time of the first touch on the record's own clock, s.
    pub shift: f64,
    /// What was taken out of every signal.
    pub channels: Vec<ChannelCorrection>,
    /// Velocity of the outer body before the impact, m/s.
    pub outer_velocity_initial: f64,
    /// Velocity of the inner body after the last contact, m/s.
    pub inner_velocity_final: Option<f64>,
    /// Eq. (1) from the measured velocities; `None` if the record does not show the inner body's free flight.
    pub efficiency: Option<f64>,
    /// Half width of its 95 % interval from the noise of the signals, whose samples are not independent.
    pub efficiency_uncertainty: Option<f64>,
    /// Velocity of the outer body after the impact over that before it, of a scene whose outer body strikes what is held, with no inner body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// Half width of its 95 % interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution_uncertainty: Option<f64>,
    /// What is wrong with the record.
    pub findings: Vec<Finding>,
    /// Whether it repeats an earlier record.
    #[serde(skip)]
    pub is_copy: bool,
    /// Standard deviation of every signal in free flight. Shape (signals).
    #[serde(skip)]
    pub noise: Vec<f64>,
    /// Time in s from the first contact at which something else than the impact acts on a signal; infinite without. Shape (signals).
    #[serde(skip)]
    pub ends: Vec<f64>,
    /// Time in s from the first touch. Shape (samples).
    #[serde(skip)]
    pub time: Vec<f64>,
    /// The signals without offset and drift.
    #[serde(skip)]
    pub signals: Vec<Channel>,
    /// The same as they were measured. Shape (signals, samples).
    #[serde(skip)]
    pub raw: Vec<Vec<f64>>,
    /// What the fits of the free flights leave of each signal, over the time in s from the first touch. Shape (signals, samples in flight).
    #[serde(skip)]
    pub residuals: Vec<Vec<(f64, f64)>>,
}

impl AlignedRecord {
    /// The efficiency, or without an inner body the restitution.
    pub fn key(&self) -> Option<f64> {
        self.efficiency.or(self.restitution)
    }

    /// Half width of its 95 % interval.
    pub fn key_uncertainty(&self) -> Option<f64> {
        self.efficiency_uncertainty.or(self.restitution_uncertainty)
    }
}

/// Contact of a body: the instants between which it may not fly freely.
#[derive(Debug, Clone, Copy)]
pub(super) struct ContactSpan {
    pub start: f64,
    pub end: f64,
}

/// Ends of the contacts of the model that a record is laid over, s from the first touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactEnds {
    /// Of the outer body.
    pub outer: f64,
    /// Of the inner body.
    pub inner: f64,
}

impl ContactEnds {
    /// Those of a result after the `approach`; `None` if it was cut during a contact.
    pub fn of(summary: &Summary, approach: &Approach) -> Option<Self> {
        // bodies that meet have one contact
        let own = if approach.has_inner_contact { "inner_contact_end" } else { "outer_contact_end" };
        let [outer, inner] = ["outer_contact_end", own].map(|name| summary.value(name));
        Some(ContactEnds { outer: outer?, inner: inner? })
    }
}

/// A record that is laid over a model.
pub(super) struct Alignment<'a> {
    pub record: Record,
    pub model: &'a Filtered,
    pub ends: ContactEnds,
    pub approach: &'a Approach,
    pub bandwidth: f64,
    pub speed: Speed,
}

/// Lays `record` over `model`, the filtered history of a model or reference with the contacts' `ends` after the `approach`.
///
/// # Errors
/// [`Error::Scene`] if the record shows no free flight before the impact, no impact like that of the scene, or more energy after
/// it than before.
pub fn align(
    record: &Record,
    model: &Filtered,
    ends: ContactEnds,
    approach: &Approach,
    (bandwidth, speed): (f64, Speed),
) -> Result<AlignedRecord> {
    let (record, findings) = screened(record, bandwidth);
    let record = shortened(record, bandwidth, ends.outer.max(ends.inner));
    Alignment { record, model, ends, approach, bandwidth, speed }.run(findings)
}

/// [`align`] of several records, with the findings that take them together.
///
/// # Errors
/// As [`align`].
pub fn align_all(
    records: &[Record],
    model: &Filtered,
    ends: ContactEnds,
    approach: &Approach,
    how: (f64, Speed),
) -> Result<Vec<AlignedRecord>> {
    let aligned = records.iter().map(|record| align(record, model, ends, approach, how));
    let mut aligned = aligned.collect::<Result<Vec<_>>>()?;
    duplicate::mark(&mut aligned, how.0);
    Ok(aligned)
}

impl Alignment<'_> {
    fn run(&self, mut findings: Vec<Finding>) -> Result<AlignedRecord> {
        let all: Vec<usize> = (0..self.record.channels.len()).collect();
        let mut shift = self.matching(&all)?;
        for round in 0..ROUNDS {
            let flights = self.flights(shift)?;
            // the search narrows as the shift settles
            let reach = 2.0 / self.bandwidth * 0.5_f64.powi(round as i32);
            shift = self.refined(&all, shift, reach, &flights)?.0;
        }
        let seen = all.iter().map(|k| self.seen(*k, shift)).collect::<Result<Vec<Seen>>>()?;
        let time: Vec<f64> = self.record.time.iter().map(|t| t - shift).collect();
        let corrected = |(channel, seen): (&Channel, &Seen)| Channel {
            quantity: channel.quantity,
            values: channel.values.iter().zip(&time).map(|(y, t)| y - seen.taken_out(*t)).collect(),
        };
        let signals = self.record.channels.iter().zip(&seen).map(corrected).collect();
        let JudgedRecord { outer_velocity_initial, inner, efficiency, restitution, findings: further } =
            self.judged(shift, &seen)?;
        // a signal at its limit differs from every scene, and is named once
        let is_clipped = findings.iter().any(|finding| finding.kind == FindingKind::Clipped);
        let follows = |f: &Finding| matches!(f.kind, FindingKind::OtherScene | FindingKind::Clipped);
        findings.extend(further.into_iter().filter(|f| !(is_clipped && follows(f))));
        Ok(AlignedRecord {
            file: self.record.file.clone(),
            samples: self.record.time.len(),
            shift,
            noise: seen.iter().map(|seen| seen.flight.noise).collect(),
            ends: seen.iter().map(|seen| seen.ends).collect(),
            residuals: seen.iter().map(|seen| seen.free.residuals()).collect(),
            raw: self.record.channels.iter().map(|channel| channel.values.clone()).collect(),
            channels: seen.into_iter().map(|seen| seen.correction).collect(),
            outer_velocity_initial,
            inner_velocity_final: inner,
            efficiency: efficiency.map(|(value, _)| value),
            efficiency_uncertainty: efficiency.map(|(_, uncertainty)| uncertainty),
            restitution: restitution.map(|(value, _)| value),
            restitution_uncertainty: restitution.map(|(_, uncertainty)| uncertainty),
            findings,
            is_copy: false,
            time,
            signals,
        })
    }

    /// The shift about which the record resembles the model.
    fn matching(&self, all: &[usize]) -> Result<f64> {
        let refused = |help: String, reason: String| {
            Err(Error::Scene(miette::miette!(help = help, "{}: {reason}", self.record.file.display())))
        };
        for k in all {
            let quantity = self.record.channels[*k].quantity;
            let [as_is, negated] = [1.0, -1.0].map(|sign| self.coarse(&[*k], sign));
            if negated.is_clearly_better(&as_is, WORST_MISFIT) {
                let share = [as_is, negated].map(|found| 100.0 * found.misfit);
                return refused(
                    format!(
                        "negate {quantity} in the file: z points from the inner to the outer side, so that an outer body that strikes and an inner body that flies off have negative velocities"
                    ),
                    format!(
                        "`{quantity}` has the wrong sign: it differs from the scene's impact by {:.0} % of its range; with the sign reversed, by {:.0} %",
                        share[0], share[1]
                    ),
                );
            }
        }
        let found = self.coarse(all, 1.0);
        if found.misfit > WORST_MISFIT {
            return refused(
                "check columns, units, signs (z points from the inner to the outer side) and that the file belongs to this scene".into(),
                format!(
                    "nowhere in the record is an impact like that of the scene: the signals differ from it by {:.0} % of their span at best; the limit for a match is {:.0} %",
                    100.0 * found.misfit,
                    100.0 * WORST_MISFIT
                ),
            );
        }
        Ok(found.shift)
    }

    /// The contact of the body that the signal `quantity` belongs to, widened by what the instrument smears.
    pub fn contact(&self, quantity: &str) -> ContactSpan {
        let end = if quantity.starts_with("outer") { self.ends.outer } else { self.ends.inner };
        let smear = 1.0 / self.bandwidth;
        ContactSpan { start: -smear, end: LONGER_CONTACT * end + smear }
    }

    /// Offset, drift and step of every signal, from its free flight if the first touch is at `shift`.
    fn flights(&self, shift: f64) -> Result<Vec<FreeFlightFit>> {
        (0..self.record.channels.len()).map(|k| self.fitted(k, &self.free_flight(k, shift)?)).collect()
    }

    fn fitted(&self, k: usize, free: &FreeFlight) -> Result<FreeFlightFit> {
        free.fitted().ok_or_else(|| {
            Error::Scene(miette::miette!(
                "{}: the free flight of {} can't be fitted",
                self.record.file.display(),
                self.record.channels[k].quantity
            ))
        })
    }

    /// The samples of signal number `k` outside its contact.
    fn free_flight(&self, k: usize, shift: f64) -> Result<FreeFlight> {
        let channel = &self.record.channels[k];
        let ContactSpan { start, end } = self.contact(channel.quantity);
        let samples = || self.record.time.iter().map(|t| t - shift).zip(channel.values.iter().copied());
        let before: Vec<(f64, f64)> = samples().filter(|(t, _)| *t < start).collect();
        let mut after: Vec<(f64, f64)> = samples().filter(|(t, _)| *t > end).collect();
        if before.len() < FEWEST {
            let early = samples().take_while(|(t, _)| *t < 0.0).count();
            return Err(Error::Scene(miette::miette!(
                help = "record at least one period of the bandwidth and some samples more of free flight before the first contact",
                "{}: `{}` has {early} samples before the first contact, {} of them earlier than {} before it (bandwidth {}); at least {FEWEST} of these are needed to determine the offset",
                self.record.file.display(),
                channel.quantity,
                before.len(),
                quantity(-start, "s", 3),
                quantity(self.bandwidth, "Hz", 3)
            )));
        }
        if after.len() < FEWEST {
            after.clear();
        }
        Ok(FreeFlight { is_level: !channel.quantity.ends_with("displacement"), before, after })
    }

    /// What signal number `k` shows, its free flight ending with the first further impact.
    fn seen(&self, k: usize, shift: f64) -> Result<Seen> {
        let Channel { quantity, values } = &self.record.channels[k];
        let (quantity, resolution) = (*quantity, resolution(values));
        let mut free = self.free_flight(k, shift)?;
        let (mut events, mut hums, mut disturbance, mut ends) = (Vec::new(), Vec::new(), None, f64::INFINITY);
        for _ in 0..DISTURBANCES {
            match free.disturbance(self.bandwidth) {
                Some(Disturbance::Event { time, change, earliest }) => {
                    events.push((time, change));
                    // the instrument smears it
                    let end = earliest - 1.0 / self.bandwidth;
                    free.after.retain(|(t, _)| *t < end);
                    ends = end;
                    if free.after.len() < FEWEST {
                        free.after.clear();
                    }
                }
                Some(Disturbance::Hum(found)) => {
                    free.subtract(&found);
                    hums.push(found);
                }
                other => {
                    disturbance = other;
                    break;
                }
            }
        }
        let (flight, errors) = (self.fitted(k, &free)?, free.errors(self.bandwidth, resolution));
        let outer = quantity.starts_with("outer");
        let is_force = quantity.ends_with("force");
        let known = match outer {
            _ if is_force => 0.0,
            true => -self.approach.outer_speed,
            false => self.approach.inner_velocity,
        };
        let trusted = outer && !is_force && self.speed == Speed::Measured;
        // the part of the fit that the motion leaves
        let measured = if free.is_level { flight.level } else { flight.slope };
        let (before, left) = if trusted { (measured, 0.0) } else { (known, measured - known) };
        let (offset, drift) = if free.is_level { (left, flight.slope) } else { (flight.level, left) };
        let correction = ChannelCorrection { quantity, offset, drift };
        Ok(Seen { correction, flight, errors, free, before, events, ends, hums, disturbance })
    }
}
