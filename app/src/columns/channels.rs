//! Records that consist of channels with names, units and clocks: binary formats, as `fem_reference` hands them on, and some of text.

use super::column::{Column, Titles};
use super::no_time;
use super::series::{self, Columns, MOST, ReadSignal};

/// One channel.
#[derive(Debug, Clone, PartialEq)]
pub struct RawChannel {
    /// Its name.
    pub name: String,
    /// Its unit; empty if the file states none.
    pub unit: String,
    /// Not a number where they are missing.
    pub values: Vec<f64>,
    /// When they were taken.
    pub clock: ChannelClock,
}

impl RawChannel {
    /// The place of the channel with its times.
    pub(super) fn times(&self) -> Option<usize> {
        if let ChannelClock::Channel(place) = self.clock { Some(place) } else { None }
    }
}

/// When the samples of a channel were taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ChannelClock {
    /// Start and interval, s.
    Even([f64; 2]),
    /// At the times in another channel, by its place.
    Channel(usize),
    /// Nothing is said.
    Unknown,
}

/// First bytes of TDMS, HDF5, MATLAB, Parquet and WAV files.
const BEGINNINGS: [&[u8]; 6] = [b"TDSm", b"\x89HDF", b"MATLAB 5.0", b"MATLAB 7.3", b"PAR1", b"RIFF"];

/// Whether a file that begins with `bytes` has a format that is not read as text here: one of these, or UFF.
pub fn is_binary(bytes: &[u8]) -> bool {
    BEGINNINGS.iter().any(|beginning| bytes.starts_with(beginning)) || is_universal(bytes)
}

/// Whether it is a universal file: a line with -1, below it the number of a data set.
fn is_universal(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]);
    let mut lines = head.lines().map(str::trim).filter(|line| !line.is_empty());
    lines.next() == Some("-1")
        && lines.next().is_some_and(|line| line.starts_with(|c: char| c.is_ascii_digit()))
}

pub(super) fn titles(channels: &[RawChannel]) -> Titles {
    Titles {
        headings: channels.iter().map(|channel| channel.name.clone()).collect(),
        units: channels.iter().map(|channel| channel.unit.clone()).collect(),
    }
}

/// The curves of the `wanted` channels at the times that a map states (`even`: start and interval), those of the channel `times`, or the
/// first one's own; others are moved to these.
///
/// # Errors
/// One sentence with the channel.
pub(super) fn read(
    channels: &[RawChannel],
    even: Option<[f64; 2]>,
    times: Option<&Column>,
    wanted: &[&Column],
    fewest: usize,
) -> Result<Columns, String> {
    let first = wanted.first().ok_or_else(|| no_time(&titles(channels)))?;
    let scaled = |column: &Column, values: &[f64]| {
        values.iter().map(|value| value * column.factor + column.offset).collect::<Vec<f64>>()
    };
    // times in another channel are in the unit that the map or its title gives, else in s
    let of_channel = |k: usize| match times.filter(|times| times.index == k) {
        Some(times) => scaled(times, &channels[k].values),
        None => channels[k].values.clone(),
    };
    let own = |column: &Column| -> Option<Vec<f64>> {
        let channel = &channels[column.index];
        match (column.clock, channel.clock) {
            (Some(k), _) | (None, ChannelClock::Channel(k)) => Some(of_channel(k)),
            (None, ChannelClock::Even([start, interval])) => {
                Some(evenly(start, interval, channel.values.len()))
            }
            (None, ChannelClock::Unknown) => None,
        }
    };
    let count = channels[first.index].values.len();
    let time = match (even, times) {
        (Some([start, interval]), _) => evenly(start, interval, count),
        (None, Some(times)) => scaled(times, &channels[times.index].values),
        (None, None) => own(first).ok_or_else(|| no_time(&titles(channels)))?,
    };
    let signals = wanted.iter().map(|column| {
        let values = scaled(column, &channels[column.index].values);
        let stated = column.clock.is_some() || (even.is_none() && times.is_none());
        let clock = if stated { own(column).filter(|clock| *clock != time) } else { None };
        let expected = clock.as_ref().map_or(time.len(), Vec::len);
        match values.len() == expected {
            true => Ok(ReadSignal { column, values, clock }),
            false => Err(format!("{} has {} samples, its times are {expected}", column.name, values.len())),
        }
    });
    let signals = signals.collect::<Result<Vec<ReadSignal>, String>>()?;
    if time.len() > MOST {
        return Err(format!("has {} samples; {MOST} are the most", time.len()));
    }
    let (time, signals) = increasing(time, signals)?;
    series::columns(time, signals, fewest)
}

fn evenly(start: f64, interval: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| start + interval * k as f64).collect()
}

/// Of samples at the same time the last one stays: programs write the state before and after an event.
fn increasing<'c>(
    time: Vec<f64>,
    mut signals: Vec<ReadSignal<'c>>,
) -> Result<(Vec<f64>, Vec<ReadSignal<'c>>), String> {
    if let Some(k) = time.iter().position(|t| t.is_nan()) {
        return Err(format!("sample {}: time is missing", k + 1));
    }
    if let Some(k) = (1..time.len()).find(|k| time[*k] < time[k - 1]) {
        return Err(format!(
            "sample {}: time is {} s, not after {} s of the one before",
            k + 1,
            time[k],
            time[k - 1]
        ));
    }
    let keep: Vec<usize> = (0..time.len()).filter(|k| time.get(k + 1) != Some(&time[*k])).collect();
    if keep.len() < time.len() {
        for signal in signals.iter_mut().filter(|signal| signal.clock.is_none()) {
            signal.values = keep.iter().map(|k| signal.values[*k]).collect();
        }
    }
    Ok((keep.iter().map(|k| time[*k]).collect(), signals))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::{Map, read_channels};
    use crate::kinds::KINDS;
    use crate::result::Curve;

    fn channel(
        name: &str,
        unit: &str,
        clock: ChannelClock,
        count: usize,
        value: fn(f64) -> f64,
    ) -> RawChannel {
        let values = (0..count).map(|k| value(k as f64)).collect();
        RawChannel { name: name.into(), unit: unit.into(), values, clock }
    }

    fn read(channels: &[RawChannel], map: &str) -> Result<Columns, String> {
        let known: Vec<Curve> = KINDS.iter().flat_map(|kind| kind.curves()).cloned().collect();
        read_channels(channels, &Map::parse(map).expect("a map"), &known, 32).map(|read| read.columns)
    }

    /// Channels of two sampling rates, one late, meet on the first one's clock; units and sensors count.
    #[test]
    fn channels_with_clocks_of_their_own_are_one_record() {
        let fast = ChannelClock::Even([-1e-5, 1e-6]);
        let slow = ChannelClock::Even([-2e-5, 4e-6]);
        let channels = [
            channel("LDV/outer_velocity", "mm/s", fast, 100, |k| k),
            channel("LDV 2", "V", slow, 60, |k| 4.0 * k),
            channel("trigger", "V", ChannelClock::Unknown, 3, |k| k),
        ];
        let map = "[columns]\nouter_velocity = { column = \"LDV/outer_velocity\" }\n\
                   inner_velocity = { column = 2, sensitivity = \"0.5 m/s/V\", delay = \"3 us\", sign = -1 }";
        let columns = read(&channels, map).expect("a record");
        assert!((columns.time[0] + 1e-5).abs() < 1e-18);
        let value =
            |name: &str, k: usize| columns.values.iter().find(|(n, _)| *n == name).expect("there").1[k];
        assert!((value("outer_velocity", 50) - 0.05).abs() < 1e-15);
        // at 40 us the late sensor has what it shows at 43 us: 63 us after its start, 1 V/us
        assert!((value("inner_velocity", 50) + 0.5 * 63.0).abs() < 1e-9);
    }

    #[test]
    fn times_in_a_channel_are_in_its_unit_and_increase() {
        let mut channels = vec![
            channel("time", "us", ChannelClock::Unknown, 50, |k| k),
            // groups of a file stand before the name
            channel("vibrometer/inner_velocity", "", ChannelClock::Channel(0), 50, |k| k),
            channel("pair(1)", "", ChannelClock::Channel(0), 50, |k| k),
        ];
        assert!((read(&channels, "").expect("a record").time[7] - 7e-6).abs() < 1e-18);
        // both states of an event: the later one stays
        channels[0].values[11] = 10.0;
        let columns = read(&channels, "").expect("a record");
        assert_eq!((columns.time.len(), columns.values[0].1[10]), (49, 11.0));
        channels[0].values[3] = f64::NAN;
        assert!(read(&channels, "").expect_err("a gap").contains("sample 4: time is missing"));
        (channels[0].values[3], channels[0].values[11]) = (3.0, 9.0);
        assert!(read(&channels, "").expect_err("back in time").contains("sample 12: time is"));
    }

    #[test]
    fn what_no_record_can_be_made_of_is_said() {
        let even = ChannelClock::Even([0.0, 1e-6]);
        for (channels, part) in [
            (
                vec![channel("outer_velocity", "", ChannelClock::Unknown, 50, |k| k)],
                "there is no column `time`",
            ),
            (vec![channel("a", "", even, 50, |k| k)], "no column is called as a curve (there are: a)"),
            (vec![channel("outer_velocity", "", even, 5, |k| k)], "has 5 samples"),
            (vec![channel("outer_velocity", "N", even, 50, |k| k)], "`N` is the unit of something else"),
            (
                vec![
                    channel("time", "", ChannelClock::Unknown, 40, |k| k),
                    channel("outer_velocity", "", even, 50, |k| k),
                ],
                "outer_velocity has 50 samples, its times are 40",
            ),
        ] {
            let said = read(&channels, "").expect_err("no record");
            assert!(said.contains(part), "{said}");
        }
    }

    #[test]
    fn formats_are_known_by_their_first_bytes() {
        for bytes in [&b"TDSm\x0e\0"[..], b"    -1\n    58\nNONE\n", b"    -1\r\n    58b     1\r\n"] {
            assert!(is_binary(bytes));
        }
        for text in ["-1,58\n0,1\n", "time,v\n0,1\n"] {
            assert!(!is_binary(text.as_bytes()));
        }
    }
}
