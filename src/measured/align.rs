//! Lays a record over a model: offset, drift and shift in time, by [`super::RULE`].

use super::filter::Filtered;
use super::record::{Channel, Record};
use crate::error::{Error, Result};
use crate::kinds::plate_impact::PlateQuantities;
use crate::numerics::least_squares::fit;
use crate::scene::PlateImpact;
use argmin::core::{CostFunction, Executor, State};
use argmin::solver::brent::BrentOpt;
use serde::Serialize;
use std::path::PathBuf;

/// Fewest samples of a stretch of free flight.
const FEWEST: usize = 8;
/// Most samples of a signal in the coarse search.
const COARSE_SAMPLES: usize = 300;
/// Rounds of looking for the shift: the first may end on the edge of its reach.
const ROUNDS: usize = 2;
/// How much later than the model's the measured contact may end before its end counts as free flight.
const LONGER_CONTACT: f64 = 1.1;

/// Part of a contact that the record has to show.
const RISE: f64 = 0.4;
/// Distance from the model, root mean square over the span, beyond which a record does not show the scene's impact.
const WORST_MISFIT: f64 = 0.25;
/// Noise of a signal, relative to its span, that is assumed at least: models are not better than that.
const LEAST_NOISE: f64 = 0.01;

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
    /// Half width of its 95 % band from the noise of the inner body's signal.
    pub efficiency_uncertainty: Option<f64>,
    /// Time in s from the first touch. Shape (samples).
    #[serde(skip)]
    pub time: Vec<f64>,
    /// The signals without offset and drift.
    #[serde(skip)]
    pub signals: Vec<Channel>,
}

/// Contact of a body: the instants between which it may not fly freely.
#[derive(Debug, Clone, Copy)]
struct Contact {
    start: f64,
    end: f64,
}

/// Free flight of one signal.
#[derive(Debug, Clone, Copy)]
struct Flight {
    offset: f64,
    drift: f64,
    /// Standard deviation of the signal about its fit.
    noise: f64,
    /// Velocity before the impact and after it, with its standard error.
    before: f64,
    after: Option<(f64, f64)>,
}

struct Alignment<'a> {
    record: &'a Record,
    model: &'a Filtered,
    quantities: &'a PlateQuantities,
    setup: &'a PlateImpact,
    bandwidth: f64,
    speed: Speed,
}

/// Lays `record` over `model`, the filtered history of a partner with the results `quantities` in the impact `setup`.
///
/// # Errors
/// [`Error::Scene`] if the record shows no free flight before the impact.
pub fn align(
    record: &Record,
    model: &Filtered,
    quantities: &PlateQuantities,
    setup: &PlateImpact,
    (bandwidth, speed): (f64, Speed),
) -> Result<AlignedRecord> {
    Alignment { record, model, quantities, setup, bandwidth, speed }.run()
}

impl Alignment<'_> {
    fn run(&self) -> Result<AlignedRecord> {
        let (mut shift, misfit) = self.coarse();
        if misfit > WORST_MISFIT {
            return Err(Error::Scene(miette::miette!(
                help = "check columns, units, signs (z points from the inner to the outer side) and that the file belongs to this scene",
                "{}: nowhere in the record is an impact like that of the scene: the signals are off by {:.0} % of their span at best, at most {:.0} % is taken for a match",
                self.record.file.display(),
                100.0 * misfit,
                100.0 * WORST_MISFIT
            )));
        }
        for round in 0..ROUNDS {
            let flights = self.flights(shift)?;
            // the search narrows as the shift settles
            let reach = 2.0 / self.bandwidth * 0.5_f64.powi(round as i32);
            shift = self.refined(shift, reach, &flights)?;
        }
        let flights = self.flights(shift)?;
        let time: Vec<f64> = self.record.time.iter().map(|t| t - shift).collect();
        let corrected = |(channel, flight): (&Channel, &Flight)| Channel {
            quantity: channel.quantity,
            values: channel
                .values
                .iter()
                .zip(&time)
                .map(|(y, t)| y - flight.offset - flight.drift * t)
                .collect(),
        };
        let channels = self.record.channels.iter().zip(&flights);
        let signals = channels.clone().map(corrected).collect();
        let corrections = channels.map(|(channel, flight)| ChannelCorrection {
            quantity: channel.quantity,
            offset: flight.offset,
            drift: flight.drift,
        });
        // a velocity is the better witness of a velocity
        let of = |body: &str| {
            ["velocity", "displacement"].into_iter().find_map(|kind| {
                let name = format!("{body}_{kind}");
                let k = self.record.channels.iter().position(|channel| channel.quantity == name)?;
                Some(flights[k])
            })
        };
        let outer_velocity_initial = of("outer").map_or(-self.setup.outer.speed, |flight| flight.before);
        let inner = of("inner").and_then(|flight| flight.after);
        let masses = [
            self.setup.outer.shape.mass(&self.setup.outer.material),
            self.setup.inner.shape.mass(&self.setup.inner.material),
        ];
        let efficiency =
            |velocity: f64| masses[1] * velocity.powi(2) / (masses[0] * outer_velocity_initial.powi(2));
        Ok(AlignedRecord {
            file: self.record.file.clone(),
            samples: self.record.time.len(),
            shift,
            channels: corrections.collect(),
            outer_velocity_initial,
            inner_velocity_final: inner.map(|(velocity, _)| velocity),
            efficiency: inner.map(|(velocity, _)| efficiency(velocity)),
            efficiency_uncertainty: inner
                .map(|(velocity, error)| 1.96 * 2.0 * efficiency(velocity) * (error / velocity).abs()),
            time,
            signals,
        })
    }

    /// The contact of the body that the signal `quantity` belongs to, widened by what the instrument smears.
    fn contact(&self, quantity: &str) -> Contact {
        let end = if quantity.starts_with("outer") {
            self.quantities.outer_contact_end
        } else {
            self.quantities.inner_contact_end
        };
        let smear = 1.0 / self.bandwidth;
        Contact { start: -smear, end: LONGER_CONTACT * end + smear }
    }

    /// Span of the model's curve over its contact: what distances are measured by.
    fn span(&self, quantity: &str) -> f64 {
        let Some(curve) = self.model.curve(quantity) else { return 1.0 };
        let Contact { start, end } = self.contact(quantity);
        let values = (0..=200).map(|k| curve(start + (end - start) * f64::from(k) / 200.0));
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        (high - low).max(f64::MIN_POSITIVE)
    }

    /// The shift on a grid that fits best when every signal may have any offset, and the distance that is left, root
    /// mean square over the signals' spans. A drift could make up for an impact that is not there.
    fn coarse(&self) -> (f64, f64) {
        let time = &self.record.time;
        let (first, last) = (time[0], time[time.len() - 1]);
        let step = 1.0 / (8.0 * self.bandwidth);
        let count = ((last - first) / step).ceil() as usize;
        let spans: Vec<f64> = self.record.channels.iter().map(|c| self.span(c.quantity)).collect();
        // distance with and without what is missing, shift
        let mut best = (f64::INFINITY, 1.0, first);
        for k in 1..count {
            let shift = first + step * k as f64;
            let (mut misfit, mut missing) = (0.0, 0.0);
            for (channel, span) in self.record.channels.iter().zip(&spans) {
                let Some(curve) = self.model.curve(channel.quantity) else { continue };
                let end = self.contact(channel.quantity).end;
                // samples around the impact, some before and some after
                let window = time.partition_point(|t| *t < shift - end)
                    ..time.partition_point(|t| *t < shift + 2.0 * end);
                let stride = window.len().div_ceil(COARSE_SAMPLES).max(1);
                let rows: Vec<([f64; 1], f64)> = window
                    .step_by(stride)
                    .map(|i| ([1.0], channel.values[i] - curve(time[i] - shift)))
                    .collect();
                misfit += fit(&rows).map_or(1.0, |found| (found.scatter / span).powi(2));
                // without its rise an impact looks like free flight, of which there is plenty
                missing += 1.0 - ((last - shift) / (RISE * end)).min(1.0);
            }
            if misfit + missing < best.0 {
                best = (misfit + missing, misfit, shift);
            }
        }
        (best.2, (best.1 / self.record.channels.len() as f64).sqrt())
    }

    /// Offset, drift and velocities of every signal, from its free flight if the first touch is at `shift`.
    fn flights(&self, shift: f64) -> Result<Vec<Flight>> {
        self.record.channels.iter().map(|channel| self.flight(channel, shift)).collect()
    }

    fn flight(&self, channel: &Channel, shift: f64) -> Result<Flight> {
        let Contact { start, end } = self.contact(channel.quantity);
        let samples = || self.record.time.iter().map(|t| t - shift).zip(channel.values.iter().copied());
        let early = samples().take_while(|(t, _)| *t < 0.0).count();
        let before: Vec<(f64, f64)> = samples().filter(|(t, _)| *t < start).collect();
        let after: Vec<(f64, f64)> = samples().filter(|(t, _)| *t > end).collect();
        if before.len() < FEWEST {
            return Err(Error::Scene(miette::miette!(
                help = "record from before the first touch, at least some periods of the bandwidth",
                "{}: {} has {early} samples before the first touch, {} of them earlier than {:.3e} s before it, as far as the bandwidth of {:.3e} Hz smears the impact; at least {FEWEST} are needed there for its offset",
                self.record.file.display(),
                channel.quantity,
                before.len(),
                -start,
                self.bandwidth
            )));
        }
        let outer = channel.quantity.starts_with("outer");
        let known = if outer { -self.setup.outer.speed } else { self.setup.inner.speed };
        let trusted = outer && self.speed == Speed::Measured;
        let singular = || {
            Error::Scene(miette::miette!(
                "{}: the free flight of {} can't be fitted",
                self.record.file.display(),
                channel.quantity
            ))
        };
        if channel.quantity.ends_with("velocity") {
            let (level, drift, step, noise) = if after.len() < FEWEST {
                // without free flight on the other side drift and contact can't be told apart
                let rows: Vec<([f64; 1], f64)> = before.iter().map(|(_, y)| ([1.0], *y)).collect();
                let found = fit(&rows).ok_or_else(singular)?;
                (found.coefficients[0], 0.0, None, found.scatter)
            } else {
                let row = |jump: f64| move |(t, y): &(f64, f64)| ([1.0, *t, jump], *y);
                let rows: Vec<([f64; 3], f64)> =
                    before.iter().map(row(0.0)).chain(after.iter().map(row(1.0))).collect();
                let found = fit(&rows).ok_or_else(singular)?;
                let [level, drift, step] = found.coefficients;
                (level, drift, Some((step, found.errors[2])), found.scatter)
            };
            let (velocity, offset) = if trusted { (level, 0.0) } else { (known, level - known) };
            let after = step.map(|(step, error)| (velocity + step, error));
            return Ok(Flight { offset, drift, noise, before: velocity, after });
        }
        let line = |side: &[(f64, f64)]| {
            let rows: Vec<([f64; 2], f64)> = side.iter().map(|(t, y)| ([1.0, *t], *y)).collect();
            fit(&rows)
        };
        let found = line(&before).ok_or_else(singular)?;
        let [offset, slope] = found.coefficients;
        let (velocity, drift) = if trusted { (slope, 0.0) } else { (known, slope - known) };
        let later = (after.len() >= FEWEST).then(|| line(&after)).flatten();
        let after = later.map(|l| (l.coefficients[1] - drift, l.errors[1].hypot(found.errors[1])));
        Ok(Flight { offset, drift, noise: found.scatter, before: velocity, after })
    }

    /// The shift within `reach` of `shift` that fits best when every signal may have any offset, drift and amplitude.
    fn refined(&self, shift: f64, reach: f64, flights: &[Flight]) -> Result<f64> {
        let time = &self.record.time;
        let mut signals = Vec::new();
        for (channel, flight) in self.record.channels.iter().zip(flights) {
            let end = self.contact(channel.quantity).end;
            let window =
                time.partition_point(|t| *t < shift - end)..time.partition_point(|t| *t < shift + 2.0 * end);
            let points: Vec<(f64, f64)> = window.map(|i| (time[i] - shift, channel.values[i])).collect();
            let scale = flight.noise.hypot(LEAST_NOISE * self.span(channel.quantity));
            signals.push(Signal { quantity: channel.quantity, scale, points });
        }
        let misfit = Misfit { model: self.model, signals: &signals };
        let solver = BrentOpt::new(-reach, reach).set_tolerance(1e-9, 1e-12);
        let result = Executor::new(misfit, solver)
            .configure(|state| state.max_iters(60))
            .run()
            .map_err(|e| Error::Internal(format!("Brent's method: {e}")))?;
        Ok(shift + result.state().get_best_param().copied().unwrap_or(0.0))
    }
}

/// One signal around the impact.
struct Signal {
    quantity: &'static str,
    /// What its distances are measured by.
    scale: f64,
    /// Time from the shift that is tried around, and value.
    points: Vec<(f64, f64)>,
}

/// Squared distance of all signals from the model as a function of a further shift.
struct Misfit<'a> {
    model: &'a Filtered,
    signals: &'a [Signal],
}

impl CostFunction for Misfit<'_> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, further: &f64) -> std::result::Result<f64, argmin::core::Error> {
        let mut total = 0.0;
        for Signal { quantity, scale, points } in self.signals {
            let Some(curve) = self.model.curve(quantity) else { continue };
            let row = |(t, y): &(f64, f64)| ([1.0, *t, curve(t - further)], *y);
            let rows: Vec<([f64; 3], f64)> = points.iter().map(row).collect();
            total += fit(&rows)
                .map_or(rows.len() as f64, |found| (rows.len() - 3) as f64 * (found.scatter / scale).powi(2));
        }
        Ok(total)
    }
}
