//! A record from a file: times and signals.

use super::filter::SIGNALS;
use crate::columns::{Columns, Map, ReadTable, RecordSource};
use crate::curves::MonotoneCubic;
use crate::error::{Error, Result};
use crate::kinds::{self, KINDS};
use crate::result::Curve;
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// Fewest samples of a record.
const FEWEST: usize = 32;

/// Samples of a free flight that is added to a computed history, as long as the history.
const FLIGHT: usize = 400;

/// One measured signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Its name among the curves: `outer_velocity`, `inner_displacement`, ...
    pub quantity: &'static str,
    /// Values in SI. Shape of the record's time.
    pub values: Vec<f64>,
}

/// Measured signals over one time axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Where they come from.
    pub file: PathBuf,
    /// Time in s, strictly increasing, with any zero.
    pub time: Vec<f64>,
    /// The signals, one at least.
    pub channels: Vec<Channel>,
    /// Where a signal has no values, which are interpolated: its name, first and last time in s.
    pub gaps: Vec<(&'static str, [f64; 2])>,
    /// Signals that are integrals of what was measured, with any offset.
    pub integrals: Vec<&'static str>,
}

/// A record, and how its file was read.
#[derive(Debug, Clone)]
pub struct ReadRecord {
    /// The record.
    pub record: Record,
    /// A map that reads its file so.
    pub map: String,
    /// What was inferred, in words; `None` of a plain table.
    pub how: Option<String>,
}

impl Record {
    /// The record in `file`, which consists of `source`: its headings name quantity and unit, such as `time [us]`, `outer_velocity [mm/s]`, or
    /// `map` describes them; without unit a column is in SI.
    ///
    /// # Errors
    /// [`Error::Scene`] if it is no record.
    pub fn of(file: &Path, source: &RecordSource, map: &Map) -> Result<ReadRecord> {
        Self::parse(file, source, map).map_err(|reason| {
            Error::Scene(miette::miette!(
                help = "headings such as `time [us],outer_velocity [mm/s],inner_velocity [mm/s]` need no map; for others name a map with --map",
                "{}: {reason}",
                file.display()
            ))
        })
    }

    fn parse(file: &Path, source: &RecordSource, map: &Map) -> std::result::Result<ReadRecord, String> {
        let known: Vec<Curve> = KINDS.iter().flat_map(|kind| kind.curves()).cloned().collect();
        let ReadTable { columns, map, how } = source.read(map, &known, FEWEST)?;
        // histories of this program have more curves than instruments show
        let Columns { time, values, gaps, integrals } = columns;
        let measured = values.into_iter().filter(|(name, _)| SIGNALS.contains(name));
        let channels: Vec<_> = measured.map(|(quantity, values)| Channel { quantity, values }).collect();
        if channels.is_empty() {
            return Err(format!("it has none of the signals {}", SIGNALS.join(", ")));
        }
        let record = Record { file: file.to_path_buf(), time, channels, gaps, integrals };
        let record = if record.is_computed() { record.with_flights() } else { record };
        Ok(ReadRecord { record, map, how })
    }

    /// Whether it is a history that a program has computed from the first touch on: no instrument begins with zeros of time, displacements
    /// and forces, but not of the velocity.
    fn is_computed(&self) -> bool {
        let first = |name: &str| self.channel(name).map(|channel| channel.values[0]);
        let [outer, inner] = ["outer", "inner"]
            .map(|body| ["displacement", "force"].map(|what| first(&format!("{body}_{what}"))));
        let moves = first("outer_velocity").is_some_and(|velocity| velocity != 0.0);
        // without an inner body, or without a contact of its own, these are missing
        let is_inner = inner.into_iter().flatten().all(|value| value == 0.0);
        self.time[0] == 0.0 && moves && outer == [Some(0.0); 2] && is_inner
    }

    /// A computed history with the free flights that it leaves out: before the first touch, and behind its end if no force acts there.
    fn with_flights(self) -> Self {
        let last = self.time.len() - 1;
        let ended = self.channels.iter().all(|c| !c.quantity.ends_with("force") || c.values[last] == 0.0);
        let interval = self.time[last] / FLIGHT as f64;
        let before: Vec<f64> = (1..=FLIGHT).rev().map(|k| -interval * k as f64).collect();
        let after = if ended { FLIGHT } else { 0 };
        let after: Vec<f64> = (1..=after).map(|k| self.time[last] + interval * k as f64).collect();
        let channels = self.channels.iter().map(|channel| {
            let speed = |k: usize| {
                let body = channel.quantity.strip_suffix("displacement")?;
                Some(self.channel(&format!("{body}velocity"))?.values[k])
            };
            let flown = |k: usize, times: &[f64]| -> Vec<f64> {
                let slope = speed(k).unwrap_or(0.0);
                times.iter().map(|t| channel.values[k] + slope * (t - self.time[k])).collect()
            };
            let values = [flown(0, &before), channel.values.clone(), flown(last, &after)].concat();
            Channel { values, ..*channel }
        });
        let channels = channels.collect();
        Record { channels, time: [&before[..], &self.time, &after].concat(), ..self.without_samples() }
    }

    /// This record with the channels of `other` too, which has the same clock: both over the times that they share, at this one's instants.
    ///
    /// # Errors
    /// [`Error::Scene`] if a signal is in both, or they share too few samples.
    pub fn joined(&self, other: &Record) -> Result<Record> {
        let refused = |reason: String| {
            let files = format!("{} and {}", self.file.display(), other.file.display());
            Err(Error::Scene(miette::miette!("{files}: {reason}")))
        };
        if let Some(twice) = other.channels.iter().find(|channel| self.channel(channel.quantity).is_some()) {
            return refused(format!("{} is in both files of one impact", twice.quantity));
        }
        let [first, last] = [other.time[0], other.time[other.time.len() - 1]];
        let shared = self.time.partition_point(|t| *t < first)..self.time.partition_point(|t| *t <= last);
        if shared.len() < FEWEST {
            return refused(format!(
                "they are of one impact, but only {} samples are at times that both have; at least {FEWEST} are needed",
                shared.len()
            ));
        }
        let time = self.time[shared.clone()].to_vec();
        let own = self.channels.iter().map(|channel| Channel {
            quantity: channel.quantity,
            values: channel.values[shared.clone()].to_vec(),
        });
        let others = other.channels.iter().map(|channel| {
            let curve = MonotoneCubic::new(&other.time, &channel.values);
            Channel { quantity: channel.quantity, values: time.iter().map(|t| curve.at(*t)).collect() }
        });
        let channels = own.chain(others).collect();
        let mut joined = Record { time, channels, ..self.without_samples() };
        joined.gaps.extend(&other.gaps);
        joined.integrals.extend(&other.integrals);
        Ok(joined)
    }

    /// What is known of it besides times and signals.
    pub(super) fn without_samples(&self) -> Self {
        Record {
            file: self.file.clone(),
            time: Vec::new(),
            channels: Vec::new(),
            gaps: self.gaps.clone(),
            integrals: self.integrals.clone(),
        }
    }

    /// Refuses a signal that results of `scene` do not have: of an inner body where there is none, or of a contact of its own.
    ///
    /// # Errors
    /// [`Error::Scene`] with the signal.
    pub fn require_in(&self, scene: &Scene) -> Result<()> {
        let kind = kinds::of(scene);
        let unknown = self.channels.iter().find(|channel| !kind.has(scene, channel.quantity));
        unknown.map_or(Ok(()), |channel| {
            let known = SIGNALS.into_iter().filter(|name| kind.has(scene, name));
            Err(Error::Scene(miette::miette!(
                help =
                    "leave the column out of the map, or compare the record with a scene that has this body",
                "{}: `{}` is measured, but scene `{}` has only {}",
                self.file.display(),
                channel.quantity,
                scene.name,
                known.collect::<Vec<_>>().join(", ")
            )))
        })
    }

    /// The signal called `quantity`.
    pub fn channel(&self, quantity: &str) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.quantity == quantity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(header: &str, rows: impl Iterator<Item = String>) -> String {
        std::iter::once(header.to_owned()).chain(rows).collect::<Vec<_>>().join("\n")
    }

    fn rows() -> impl Iterator<Item = String> {
        (0..40).map(|k| format!("{k}, {}, {}", -550 + k, 2 * k))
    }

    fn parse(text: &str) -> std::result::Result<Record, String> {
        Record::parse(Path::new("r.csv"), &RecordSource::Text(text.into()), &Map::default())
            .map(|read| read.record)
    }

    #[test]
    fn units_of_the_header_are_applied() {
        let header = "# a comment\ntime [us], outer_velocity [mm/s], inner_displacement [um]";
        let record = parse(&text(header, rows())).expect("record");
        assert!((record.time[7] - 7e-6).abs() < 1e-18);
        assert!((record.channel("outer_velocity").expect("there").values[0] + 0.55).abs() < 1e-15);
        assert!((record.channel("inner_displacement").expect("there").values[3] - 6e-6).abs() < 1e-18);
        let plain = parse(&text("time,outer_velocity,inner_velocity", rows())).expect("SI");
        assert_eq!(plain.time[7], 7.0);
    }

    /// Values that are missing are interpolated and listed; repeated times are one; columns of something else are left out.
    #[test]
    fn what_instruments_write_is_read() {
        let gap = |k: usize, row: String| if (5..8).contains(&k) { format!("{k}, , {}", 2 * k) } else { row };
        let with_gap = rows().enumerate().map(|(k, row)| gap(k, row));
        let record = parse(&text("time [us],outer_velocity,inner_velocity", with_gap)).expect("record");
        assert!((record.channel("outer_velocity").expect("there").values[6] + 544.0).abs() < 1e-9);
        let [(name, [from, to])] = record.gaps[..] else { panic!("one gap") };
        assert_eq!((name, (from * 1e6).round(), (to * 1e6).round()), ("outer_velocity", 5.0, 7.0));

        let twice = rows().flat_map(|row| [row.clone(), row]);
        assert_eq!(parse(&text("time,outer_velocity,inner_velocity", twice)).expect("record").time.len(), 40);

        let more = rows().map(|row| format!("{row}, 7"));
        let record = parse(&text("time,outer_velocity,inner_velocity,trigger [V]", more)).expect("record");
        assert_eq!(record.channels.len(), 2);
    }

    /// A velocity from an acceleration, a force from its impulse; times by start and interval; sensitivity, sign, delay and a clock of its own.
    #[test]
    fn a_map_says_what_a_file_does_not() {
        let read = |map: &str, text: &str| {
            let map = Map::parse(map).expect("a map");
            Record::parse(Path::new("r.csv"), &RecordSource::Text(text.into()), &map)
                .map(|read| read.record)
                .expect("a record")
        };
        let numbers =
            |of: fn(f64) -> String| (0..50).map(|k| of(f64::from(k))).collect::<Vec<_>>().join("\n");
        let constant = numbers(|k| format!("{k};2,5;{}", 0.5 * k).replace('.', ","));
        let record = read(
            "[time]\ninterval = \"1 ms\"\n[columns]\nouter_velocity = { column = 2, quantity = \"acceleration\" }\n\
             outer_force = { column = 3, quantity = \"impulse\", sign = -1 }",
            &constant,
        );
        assert!((record.time[49] - 0.049).abs() < 1e-12);
        let last = |name: &str| *record.channel(name).expect("there").values.last().expect("one");
        assert!((last("outer_velocity") - 2.5 * 0.049).abs() < 1e-12);
        assert!((last("outer_force") + 500.0).abs() < 1e-9);

        let volts = numbers(|k| format!("{k}\t{}\t{}", 2.0 * k, 10.0 * k + 5.0));
        let record = read(
            "[columns]\ntime = { column = 1, unit = \"us\" }\n\
             outer_velocity = { column = 2, unit = \"mV\", sensitivity = \"5 mm/s/V\", delay = \"2 us\" }\n\
             inner_velocity = { column = 3, offset = 1, time = 3 }",
            &volts,
        );
        let value = |name: &str, k: usize| record.channel(name).expect("there").values[k];
        // late by two samples
        assert!((value("outer_velocity", 10) - 2.0 * 12.0 * 1e-3 * 5e-3).abs() < 1e-12);
        // at its own time 10 k + 5 us it is 10 k + 6 m/s: at 25 us 26
        assert!((value("inner_velocity", 25) - 26.0).abs() < 1e-9);
    }

    /// The map that comes with a record reads its file in the same way.
    #[test]
    fn the_map_of_what_was_inferred_reads_the_same() {
        let lines = (0..40).map(|k| format!("{k},5;{};{}", -k, k)).collect::<Vec<_>>().join("\n");
        let text = format!("; made by x\ntime;outer_acceleration;inner_displacement\nus;m/s2;mm\n{lines}\n");
        let first =
            Record::parse(Path::new("r.csv"), &RecordSource::Text(text.as_str().into()), &Map::default())
                .expect("a record");
        let map = Map::parse(&first.map).expect("a map");
        let again =
            Record::parse(Path::new("r.csv"), &RecordSource::Text(text.into()), &map).expect("a record");
        assert_eq!(first.record, again.record);
        assert!((first.record.time[1] - 1.5e-6).abs() < 1e-18, "{}", first.map);
    }

    #[test]
    fn an_invalid_record_is_reported_with_its_place() {
        let good = "time [us],outer_velocity [mm/s],inner_velocity [mm/s]";
        let row = |k: usize, text: &str| {
            let text = text.to_owned();
            rows().enumerate().map(move |(i, row)| if i == k { text.clone() } else { row })
        };
        for (file, part) in [
            (text("time [us],outer_speed,inner_velocity", rows()), "`outer_speed` is not a known column"),
            (
                text("time [um],outer_velocity,inner_velocity", rows()),
                "`um` is the unit of something else; a time in s is needed",
            ),
            (text("time [us,outer_velocity,inner_velocity", rows()), "`]` is missing"),
            (text("outer_displacement,outer_velocity,inner_velocity", rows()), "no column `time`"),
            (text("time,time,inner_velocity", rows()), "two columns are called `time`"),
            (text("a,b,c", rows()), "there is no column `time` (there are: a | b | c)"),
            (text("time,b,c", rows()), "name them in a map"),
            (text(good, rows().take(5)), "has 5 samples"),
            (text(good, row(3, "3,inf,0")), "line 5: outer_velocity is `inf`"),
            (text(good, row(3, ",1,0")), "line 5: time is missing"),
            (text(good, row(3, "1,0,0")), "line 5: time is"),
            (text(good, row(3, "3,x,0")), "line 5: outer_velocity is `x`"),
            (String::new(), "no columns of numbers"),
        ] {
            let said = parse(&file).expect_err("no record");
            assert!(said.contains(part), "{said}");
        }
    }
}
