//! Values that come in blocks, one per time, each with its name.

use super::channels::{ChannelClock, RawChannel};
use super::series::MOST;
use std::collections::HashMap;

/// Most values of all channels together, 1.6 GB.
const MOST_VALUES: usize = 200_000_000;

/// The blocks so far.
#[derive(Default)]
pub(super) struct Blocks {
    time: Vec<f64>,
    places: HashMap<String, usize>,
    /// Names and values of the channels, shorter than the times if the last ones are missing.
    channels: Vec<(String, Vec<f64>)>,
}

impl Blocks {
    /// A block at `time` begins, or the last one goes on if it was at the same time.
    ///
    /// # Errors
    /// One sentence: it is before the last one, or there are too many.
    pub(super) fn at(&mut self, time: f64) -> Result<(), String> {
        match self.time.last() {
            Some(last) if time < *last => {
                return Err(format!("time is {time}, not after {last} of the block before"));
            }
            Some(last) if time == *last => return Ok(()),
            _ => self.time.push(time),
        }
        if self.time.len() > MOST {
            return Err(format!("there are more than {MOST} times"));
        }
        Ok(())
    }

    /// The value of the channel `name` in this block; none before the first block.
    pub(super) fn set(&mut self, name: &str, value: f64) {
        let Some(last) = self.time.len().checked_sub(1) else { return };
        let place = match self.places.get(name) {
            Some(place) => *place,
            None => {
                self.places.insert(name.to_owned(), self.channels.len());
                self.channels.push((name.to_owned(), Vec::new()));
                self.channels.len() - 1
            }
        };
        let values = &mut self.channels[place].1;
        values.resize(last, f64::NAN);
        values.push(value);
    }

    /// The time, without a unit, and the channels over it.
    ///
    /// # Errors
    /// One sentence: there is no channel, or there are too many values.
    pub(super) fn channels(self) -> Result<Vec<RawChannel>, String> {
        let count = self.time.len();
        if self.channels.is_empty() {
            return Err("has no values".into());
        }
        if count * (self.channels.len() + 1) > MOST_VALUES {
            return Err(format!(
                "has {} channels of {count} samples; at most {MOST_VALUES} values are read",
                self.channels.len()
            ));
        }
        let channel = |name: String, mut values: Vec<f64>, clock| {
            values.resize(count, f64::NAN);
            RawChannel { name, unit: String::new(), values, clock }
        };
        let time = channel("time".to_owned(), self.time, ChannelClock::Unknown);
        let others = self.channels.into_iter();
        let others = others.map(|(name, values)| channel(name, values, ChannelClock::Channel(0)));
        Ok(std::iter::once(time).chain(others).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_go_on_and_missing_values_are_not_numbers() {
        let mut blocks = Blocks::default();
        blocks.set("before the first time", 1.0);
        for (time, name) in [(0.0, "a"), (0.0, "b"), (1.0, "a"), (2.0, "b")] {
            blocks.at(time).expect("later");
            blocks.set(name, 10.0 + time);
        }
        assert!(blocks.at(1.5).expect_err("back in time").contains("time is 1.5, not after 2"));
        let channels = blocks.channels().expect("channels");
        let names: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).collect();
        assert_eq!(names, ["time", "a", "b"]);
        assert_eq!(channels[2].values.iter().map(|v| v.is_nan()).collect::<Vec<_>>(), [false, true, false]);
        assert_eq!((channels[1].values[1], channels[1].values.len()), (11.0, 3));
        assert!(Blocks::default().channels().is_err());
    }
}
