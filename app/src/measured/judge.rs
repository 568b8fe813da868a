//! What the aligned signals of a record show, and whether that can be.

use super::align::{Alignment, ChannelCorrection, Speed};
use super::finding::{Finding, FindingKind};
use super::flight::{FlightErrors, FreeFlight, FreeFlightFit};
use super::screen::{independent, resolution, roughness};
use super::structure::{Disturbance, Hum};
use crate::error::{Error, Result};
use crate::format;
use crate::kinds::Approach;
use crate::numerics::stationary_noise::NORMAL_95;

/// Standard errors from which on a drift counts as found, and what it makes up over the record, over the step of the impact.
const SIGNIFICANT_DRIFT: f64 = 5.0;
const LARGE_DRIFT: f64 = 0.01;
/// Offset over the span of a signal beyond which the signal is hardly that of the scene.
const LARGE_OFFSET: f64 = 0.5;
/// Distance from the model over the contact beyond the noise, root mean square over the span: more than experiments of the scene
/// differ from it.
const OTHER_SCENE: f64 = 0.05;
/// Delay of a signal over the period of the bandwidth that counts, and the part of the squares that it has to take away.
const DELAY: f64 = 0.1;
const DELAY_EXPLAINS: f64 = 0.5;
/// Roughness of a free flight over that of the other one below which its signal is held at a limit; steps of the resolution that the larger
/// one has to exceed; and independent samples that each flight has to have.
const HELD: f64 = 0.5;
const ROUGH_STEPS: f64 = 1.5;
const ROUGH_SAMPLES: usize = 30;
/// Roughness over the span of a signal up to which it is rounding, as of values in single precision, and no noise of an instrument.
const ROUNDED: f64 = f32::EPSILON as f64;

/// Half widths of the 95 % interval by which an excess of energy is hardly chance, and by which it is none.
const EXCESS: f64 = 1.5;
const IMPOSSIBLE: f64 = 2.0;

/// What one signal shows.
pub(super) struct Seen {
    pub correction: ChannelCorrection,
    pub flight: FreeFlightFit,
    pub errors: Option<FlightErrors>,
    /// Up to the first further impact.
    pub free: FreeFlight,
    /// Velocity before the impact, m/s.
    pub before: f64,
    /// Further impacts: time in s from the first touch, change of the velocity in m/s.
    pub events: Vec<(f64, f64)>,
    /// Time in s from the first touch of what ends the free flight; infinite without.
    pub ends: f64,
    /// Vibrations of the mains that were taken out.
    pub hums: Vec<Hum>,
    /// What else disturbs the free flight.
    pub disturbance: Option<Disturbance>,
}

/// What a record shows.
pub(super) struct JudgedRecord {
    pub outer_velocity_initial: f64,
    /// Final velocity of the inner body.
    pub inner: Option<f64>,
    /// Efficiency and the half width of its 95 % interval.
    pub efficiency: Option<(f64, f64)>,
    /// The same of the restitution, of an outer body that strikes what is held, with no inner body.
    pub restitution: Option<(f64, f64)>,
    pub findings: Vec<Finding>,
}

impl Seen {
    /// What the signal has at `time`, s from the first touch, besides the motion.
    pub fn taken_out(&self, time: f64) -> f64 {
        let hums: f64 = self.hums.iter().map(|hum| hum.at(time)).sum();
        self.correction.offset + self.correction.drift * time + hums
    }

    /// Standard error of offset and drift at `time`.
    fn error(&self, time: f64) -> f64 {
        let Some(errors) = self.errors else { return 0.0 };
        // without free flight after the impact no drift is taken out
        let drift = if errors.slope.is_finite() { errors.slope * time } else { 0.0 };
        if self.free.is_level { errors.before.hypot(drift) } else { drift }
    }

    /// Velocity after the impact with its standard error.
    fn after(&self) -> Option<(f64, f64)> {
        self.flight.step.zip(self.errors).map(|(step, errors)| (self.before + step, errors.step))
    }
}

impl Alignment<'_> {
    /// Velocities and efficiency of a record whose first touch is at `shift`, and what is wrong with them.
    pub fn judged(&self, shift: f64, seen: &[Seen]) -> Result<JudgedRecord> {
        // a velocity is the better witness of a velocity
        let of = |body: &str| {
            ["velocity", "displacement"].into_iter().find_map(|kind| {
                let name = format!("{body}_{kind}");
                seen.iter().find(|seen| seen.correction.quantity == name)
            })
        };
        let outer_velocity_initial = of("outer").map_or(-self.approach.outer_speed, |seen| seen.before);
        let trusted = of("outer").filter(|_| self.speed == Speed::Measured);
        let initial_error = trusted.and_then(|seen| seen.errors).map_or(0.0, |errors| errors.before);
        let [inner, outer] = ["inner", "outer"].map(|body| of(body).and_then(Seen::after));
        let inner = inner.or_else(|| self.pushed(shift, seen));
        let Approach { outer_mass, inner_mass, is_held, .. } = *self.approach;
        // kinetic energy over that of the outer body before the impact, and the half width of its 95 % interval
        let share = |mass: f64, (velocity, error): (f64, f64)| {
            let ratio = velocity / outer_velocity_initial;
            let error = error.hypot(ratio * initial_error) / outer_velocity_initial;
            let scale = mass / outer_mass;
            (scale * ratio.powi(2), NORMAL_95 * 2.0 * scale * (ratio * error).abs())
        };
        let efficiency = inner.zip(inner_mass).map(|(after, mass)| share(mass, after));
        let restitution = outer.filter(|_| inner_mass.is_none() && is_held).map(|(velocity, error)| {
            let ratio = -velocity / outer_velocity_initial;
            let error = error.hypot(ratio * initial_error) / outer_velocity_initial;
            (ratio, NORMAL_95 * error.abs())
        });
        let mut findings: Vec<Finding> = seen.iter().flat_map(|seen| self.of_signal(shift, seen)).collect();
        findings.extend(self.delay(shift, seen)?);
        findings.extend(self.energy(shift, efficiency, outer.map(|after| share(outer_mass, after)))?);
        Ok(JudgedRecord {
            outer_velocity_initial,
            inner: inner.map(|(velocity, _)| velocity),
            efficiency,
            restitution,
            findings,
        })
    }

    /// Velocity of the inner body after the impact with its standard error, by the impulse of the force on it; `None` without its force,
    /// or if something else acts on it too.
    fn pushed(&self, shift: f64, seen: &[Seen]) -> Option<(f64, f64)> {
        let force = seen.iter().find(|seen| seen.correction.quantity == "inner_force")?;
        let errors = force.errors.filter(|errors| errors.slope.is_finite() && self.approach.inner_is_free)?;
        let channel = self.record.channels.iter().find(|c| c.quantity == "inner_force")?;
        let contact = self.contact("inner_force");
        let time = || self.record.time.iter().map(|t| t - shift);
        let points: Vec<(f64, f64)> = time()
            .zip(&channel.values)
            .filter(|(t, _)| (contact.start..contact.end).contains(t))
            .map(|(t, y)| (t, y - force.taken_out(t)))
            .collect();
        let impulse: f64 = points.windows(2).map(|p| 0.5 * (p[1].0 - p[0].0) * (p[1].1 + p[0].1)).sum();
        // of the offset, of the drift, and of the noise over the contact: by its density, as the offset's error shows it over the free flight
        let length = contact.end - contact.start;
        let drift = errors.slope * 0.5 * (contact.end.powi(2) - contact.start.powi(2));
        let before = &force.free.before;
        let flight = before.last().map_or(0.0, |last| last.0 - before[0].0);
        let noise = errors.before * (flight * length).sqrt();
        let error = (errors.before * length).hypot(drift).hypot(noise);
        let mass = self.approach.inner_mass?;
        Some((self.approach.inner_velocity - impulse / mass, error / mass))
    }

    /// Begin and end of the record on its own clock, s.
    fn whole(&self) -> [f64; 2] {
        let time = &self.record.time;
        [time[0], time[time.len() - 1]]
    }

    fn of_signal(&self, shift: f64, seen: &Seen) -> Vec<Finding> {
        let Seen { correction: ChannelCorrection { quantity, offset, drift }, flight, .. } = seen;
        let mut findings = Vec::new();
        let [_, end] = self.whole();
        let rest = if flight.step.is_some() {
            "its free flight is used up to there alone"
        } else {
            "too little free flight is left to read its velocity from"
        };
        for (time, change) in &seen.events {
            if quantity.ends_with("force") {
                let effect = format!(
                    "{quantity}: it changes by {} {} after the first contact, where nothing should act any more; {rest}",
                    format::quantity(*change, "N", 3),
                    format::quantity(*time, "s", 3)
                );
                findings.push(Finding::new(FindingKind::SecondStrike, [time + shift, end], effect));
                continue;
            }
            // a push away from the plate is a strike, one back is a stop
            let strike = if quantity.starts_with("inner") { *change < 0.0 } else { *change > 0.0 };
            let (kind, what) = if strike {
                (FindingKind::SecondStrike, "is struck again")
            } else {
                (FindingKind::EndStop, "is stopped or returned")
            };
            let effect = format!(
                "{quantity}: the body {what} {} after the first contact, where its velocity changes by {}; {rest}",
                format::quantity(*time, "s", 3),
                format::quantity(*change, "m/s", 3)
            );
            findings.push(Finding::new(kind, [time + shift, end], effect));
        }
        let unit = match quantity {
            name if name.ends_with("force") => "N",
            _ if seen.free.is_level => "m/s",
            _ => "m",
        };
        findings.extend(seen.hums.iter().map(|hum| {
            let effect = format!(
                "{quantity}: a hum of {} Hz with an amplitude of {} is taken out; what its fit leaves enters the velocities",
                hum.frequency,
                format::quantity(hum.parts[0].hypot(hum.parts[1]), unit, 2)
            );
            Finding::new(FindingKind::Hum, self.whole(), effect)
        }));
        let of_disturbance = seen.disturbance.and_then(|disturbance| match disturbance {
            Disturbance::Event { .. } | Disturbance::Hum(_) => None,
            Disturbance::AcCoupled { time_constant } => Some((
                FindingKind::AcCoupled,
                format!("{quantity}: the signal decays with a time constant of {}, as an AC-coupled sensor's does; its velocities and the efficiency from them are wrong", format::quantity(time_constant, "s", 2)),
            )),
            Disturbance::Curved { change } => Some((
                FindingKind::Drift,
                format!("{quantity}: the free flight is curved, its slope changes by {} {unit}/s; a constant drift is taken out, the rest enters its velocities", format::significant(change, 3)),
            )),
        });
        findings.extend(of_disturbance.map(|(kind, effect)| Finding::new(kind, self.whole(), effect)));
        if seen.disturbance.is_none() && self.drifts(seen) {
            let effect = format!(
                "{quantity}: a drift of {drift:.3} {unit}/s is taken out; if it is not constant, the velocities after the impact are wrong"
            );
            findings.push(Finding::new(FindingKind::Drift, self.whole(), effect));
        }
        if self.is_held(seen) {
            let effect = format!(
                "{quantity}: where it is largest its noise is less than half of that on the other side of the impact: an amplifier holds it at its limit, velocities and efficiency from this signal are wrong"
            );
            findings.push(Finding::new(FindingKind::Clipped, self.whole(), effect));
        }
        let span = self.span(quantity);
        let misfit = self.misfit(shift, seen) / span;
        let may_be_any = self.record.integrals.contains(quantity);
        if seen.free.is_level && !may_be_any && offset.abs() > LARGE_OFFSET * span {
            let effect = format!(
                "{quantity}: an offset of {offset:.3} {unit} was taken out, {:.0} % of the span of the scene's signal; check sign, unit and scene",
                100.0 * offset.abs() / span
            );
            findings.push(Finding::new(FindingKind::OtherScene, self.whole(), effect));
        } else if misfit > OTHER_SCENE {
            let effect = format!(
                "{quantity}: it differs from the scene by {:.1} % of its span during the contact (root mean square beyond its noise); the record may be that of another scene",
                100.0 * misfit
            );
            findings.push(Finding::new(FindingKind::OtherScene, self.whole(), effect));
        }
        findings
    }

    /// Whether the free flight with the larger values of a level has much less noise than the other one.
    fn is_held(&self, seen: &Seen) -> bool {
        let quantity = seen.correction.quantity;
        let channel = self.record.channels.iter().find(|channel| channel.quantity == quantity);
        let (Some(step), Some(channel), true) = (seen.flight.step, channel, seen.free.is_level) else {
            return false;
        };
        let sides = [&seen.free.before, &seen.free.after];
        let spacing = independent(&self.record.time, self.bandwidth);
        if sides.iter().any(|side| side.len() < ROUGH_SAMPLES * spacing) {
            return false;
        }
        let [before, after] = sides.map(|side| {
            let values: Vec<f64> = side.iter().map(|(_, value)| *value).collect();
            roughness(&values, spacing)
        });
        let level = seen.flight.level;
        let (large, other) =
            if level.abs() > (level + step).abs() { (before, after) } else { (after, before) };
        // a computed signal has values next to zero, whose smallest distance is far below its rounding
        let rounding = (ROUGH_STEPS * resolution(&channel.values)).max(ROUNDED * self.span(quantity));
        large < HELD * other && other > rounding
    }

    /// Whether the drift of a velocity is large and no chance.
    fn drifts(&self, seen: &Seen) -> bool {
        let [start, end] = self.whole();
        let found = seen.flight.step.zip(seen.errors).filter(|_| seen.free.is_level);
        let Some((step, errors)) = found else { return false };
        let drift = seen.flight.slope.abs();
        drift * (end - start) > LARGE_DRIFT * step.abs() && drift > SIGNIFICANT_DRIFT * errors.slope
    }

    /// Distance of a signal from the model over the contact beyond its noise and the errors of offset and drift, root mean square.
    fn misfit(&self, shift: f64, seen: &Seen) -> f64 {
        let quantity = seen.correction.quantity;
        let channel = self.record.channels.iter().find(|channel| channel.quantity == quantity);
        let (Some(curve), Some(channel)) = (self.model.curve(quantity), channel) else { return 0.0 };
        let contact = self.contact(quantity);
        let squares: Vec<f64> = self
            .record
            .time
            .iter()
            .map(|t| t - shift)
            .zip(&channel.values)
            .filter(|(t, _)| (contact.start..contact.end).contains(t))
            .map(|(t, y)| (y - seen.taken_out(t) - curve(t)).powi(2) - (NORMAL_95 * seen.error(t)).powi(2))
            .collect();
        let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        (mean - seen.flight.noise.powi(2)).max(0.0).sqrt()
    }

    /// Signals whose first touch is later than that of the first one.
    fn delay(&self, shift: f64, seen: &[Seen]) -> Result<Vec<Finding>> {
        if seen.len() < 2 {
            return Ok(Vec::new());
        }
        let flights: Vec<FreeFlightFit> = seen.iter().map(|seen| seen.flight).collect();
        let period = 1.0 / self.bandwidth;
        let mut own = Vec::new();
        for k in 0..seen.len() {
            let coarse = self.coarse(&[k], 1.0).shift;
            let (found, [_, squares]) = self.refined(&[k], coarse, period, &flights)?;
            let (_, [joint, _]) = self.refined(&[k], shift, period, &flights)?;
            own.push((found, squares, joint));
        }
        let explained = own.iter().map(|(_, squares, _)| squares).sum::<f64>()
            < DELAY_EXPLAINS * own.iter().map(|(_, _, joint)| joint).sum::<f64>();
        let late = |(seen, (found, ..)): (&Seen, &(f64, f64, f64))| {
            let delay = found - own[0].0;
            (explained && delay.abs() > DELAY * period).then(|| {
                let effect = format!(
                    "{} is {} {} relative to {}; one shift for both fits neither, the time of the first contact is wrong by a part of that",
                    seen.correction.quantity,
                    format::quantity(delay.abs(), "s", 2),
                    if delay > 0.0 { "late" } else { "early" },
                    self.record.channels[0].quantity
                );
                Finding::new(FindingKind::Delay, self.whole(), effect)
            })
        };
        Ok(seen.iter().zip(&own).skip(1).filter_map(late).collect())
    }

    /// Refuses an inner body, or an outer one without an inner one, with more kinetic energy than both had before; a finding if the
    /// uncertainty leaves that open, or if both bodies together have more.
    fn energy(
        &self,
        shift: f64,
        inner: Option<(f64, f64)>,
        outer: Option<(f64, f64)>,
    ) -> Result<Option<Finding>> {
        // an elastic outer body has energy besides that of its motion, a driven one gets more
        let Approach { outer_speed, inner_velocity, outer_mass, inner_mass, .. } = *self.approach;
        let single = if inner_mass.is_some() { inner } else { outer };
        let Some(single) = single.filter(|_| self.approach.outer_is_rigid) else { return Ok(None) };
        let outer = outer.filter(|_| inner_mass.is_some()).unwrap_or((0.0, 0.0));
        let brought =
            1.0 + inner_mass.map_or(0.0, |mass| mass / outer_mass * (inner_velocity / outer_speed).powi(2));
        let (share, uncertainty) = (single.0 + outer.0, single.1.hypot(outer.1));
        if share - EXCESS * uncertainty < brought && single.0 <= brought {
            return Ok(None);
        }
        let percent = |share: f64| format!("{:.1} %", 100.0 * share / brought);
        let (all, own, band) = (percent(share), percent(single.0), percent(single.1));
        let shares = match inner_mass {
            Some(_) => format!(
                "the bodies have {all} of the energy after the impact that they had before, the inner one {own} (95 % interval ±{band})"
            ),
            None => format!(
                "the outer body has {own} of the energy after the impact that it had before (95 % interval ±{band})"
            ),
        };
        let effect = format!(
            "{shares}; check scale and sign of the signals, and the masses and the outer body's speed in the scene"
        );
        if single.0 - IMPOSSIBLE * single.1 > brought {
            return Err(Error::Scene(miette::miette!(
                help = "something else than the impact may act on the body too: a stop, a further strike, a sensor that drifts",
                "{}: no impact gives energy: {effect}",
                self.record.file.display()
            )));
        }
        Ok(Some(Finding::new(FindingKind::Energy, [shift, self.whole()[1]], effect)))
    }
}
