//! ISO-MME (ISO/TS 13499): a test is a folder with a header `TEST.mme` and a folder `Channel` with a list `TEST.chn` and one file per
//! channel, `TEST.001` and so on. A file consists of lines `Name :value`, a channel's of its values below them.

use super::channels::{ChannelClock, RawChannel};
use super::rows::{is_missing, number};
use super::text::decoded;
use std::path::{Path, PathBuf};

/// Fewest lines `Name :value` at the head of a file of this format.
const FEWEST: usize = 2;
/// A name, in lower case, that the head of each file has: of a channel, the list of channels and the test.
const CHANNEL: &str = "channel code";
const LIST: &str = "number of channels";
const TEST: &str = "data format edition number";
/// Most channels of a test.
const MOST_CHANNELS: usize = 2000;
/// What stands for no value.
const NO_VALUE: [&str; 2] = ["NOVALUE", "NONE"];

/// What a file of this format is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MmeFile {
    /// One channel.
    Channel,
    /// The list of channels, in the folder of the channels.
    List,
    /// The header of the test.
    Test,
}

impl MmeFile {
    /// The file that `text` is, by the names at its head.
    pub(super) fn of(text: &str) -> Option<Self> {
        let (head, _) = head(text);
        let is = |name: &str| head.iter().any(|(other, _)| other == name);
        let kinds = [(CHANNEL, Self::Channel), (LIST, Self::List), (TEST, Self::Test)];
        let found = kinds.iter().find(|(name, _)| is(name)).map(|(_, kind)| *kind);
        found.filter(|_| head.len() >= FEWEST)
    }

    /// The channels that the `file` with this `text` has or leads to; other files are in `encoding` too.
    ///
    /// # Errors
    /// One sentence with the channel or the file at fault.
    pub(super) fn channels(
        self,
        file: &Path,
        text: &str,
        encoding: Option<&str>,
    ) -> Result<Vec<RawChannel>, String> {
        let mut found = match self {
            Self::Channel => vec![MmeChannel::parse(text)?],
            Self::List | Self::Test => Vec::new(),
        };
        // a channel alone needs the others if one of them has its times
        if found.iter().all(|channel| channel.times.is_some()) {
            for other in neighbours(file, self == Self::Test)? {
                let name = other.file_name().unwrap_or_default().to_string_lossy().into_owned();
                let at = |reason: String| format!("its channel {name} {reason}");
                if self == Self::Channel && same_file(&other, file) {
                    continue;
                }
                let bytes = std::fs::read(&other).map_err(|e| at(format!("can't be read: {e}")))?;
                let channel = MmeChannel::parse(&decoded(&bytes, encoding).map_err(at)?).map_err(at)?;
                if self != Self::Channel || found[0].times.as_ref() == Some(&channel.code) {
                    found.push(channel);
                }
            }
        }
        if found.is_empty() {
            return Err(
                "has no channel: there is no file such as TEST.001 in its folder or in a folder Channel"
                    .into(),
            );
        }
        let codes: Vec<String> = found.iter().map(|channel| channel.code.clone()).collect();
        found.into_iter().map(|channel| channel.raw(&codes)).collect()
    }
}

/// One channel.
struct MmeChannel {
    code: String,
    name: String,
    unit: String,
    /// Start and interval, s.
    even: Option<[f64; 2]>,
    /// Code of the channel with its times.
    times: Option<String>,
    values: Vec<f64>,
}

impl MmeChannel {
    fn parse(text: &str) -> Result<Self, String> {
        let (head, lines) = head(text);
        let stated = |name: &str| {
            let value = head.iter().find(|(other, _)| other == name).map(|(_, value)| *value);
            value.filter(|value| !NO_VALUE.iter().any(|no| value.eq_ignore_ascii_case(no)))
        };
        let in_si = |name: &str| {
            let value = stated(name).map(|text| {
                let of = number(text).filter(|value| value.is_finite());
                of.ok_or_else(|| format!("{name} is `{text}`, not a finite number"))
            });
            value.transpose()
        };
        let even = match (in_si("time of first sample")?, in_si("sampling interval")?) {
            (_, Some(interval)) if interval <= 0.0 => {
                return Err(format!("sampling interval is {interval} s, but it must be above 0"));
            }
            (start, interval) => interval.map(|interval| [start.unwrap_or(0.0), interval]),
        };
        let is_explicit =
            stated("reference channel").is_some_and(|kind| kind.eq_ignore_ascii_case("explicit"));
        let values = text.lines().enumerate().skip(lines).filter(|(_, line)| !line.trim().is_empty());
        let values = values.map(|(k, line)| {
            let cell = line.trim();
            let missing = is_missing(cell) || NO_VALUE.iter().any(|no| cell.eq_ignore_ascii_case(no));
            number(cell)
                .filter(|value| value.is_finite())
                .or_else(|| missing.then_some(f64::NAN))
                .ok_or_else(|| format!("line {}: its value is `{cell}`, not a finite number", k + 1))
        });
        let values = values.collect::<Result<Vec<f64>, String>>()?;
        let stated_count = in_si("number of samples")?;
        if let Some(count) = stated_count.filter(|count| *count != values.len() as f64) {
            return Err(format!("has {} samples, its header states {count}", values.len()));
        }
        let text = |name: &str| stated(name).unwrap_or_default().to_owned();
        Ok(Self {
            code: text(CHANNEL),
            name: text("name of the channel").replace('/', " "),
            unit: text("unit"),
            even: even.filter(|_| !is_explicit),
            times: stated("reference channel name").filter(|_| is_explicit).map(str::to_owned),
            values,
        })
    }

    /// The channel among those with these `codes`, called `CODE/NAME`.
    fn raw(self, codes: &[String]) -> Result<RawChannel, String> {
        let clock =
            match (&self.times, self.even) {
                (Some(times), _) => {
                    let place = codes.iter().position(|code| code == times);
                    ChannelClock::Channel(place.ok_or_else(|| {
                        format!("there is no channel {times} with the times of {}", self.code)
                    })?)
                }
                (None, Some(even)) => ChannelClock::Even(even),
                (None, None) => ChannelClock::Unknown,
            };
        let parts = [self.code, self.name].into_iter().filter(|part| !part.is_empty());
        let name = parts.collect::<Vec<String>>().join("/");
        Ok(RawChannel { name, unit: self.unit, values: self.values, clock })
    }
}

/// The names, in lower case, and values at the head of a text, and the number of their lines.
fn head(text: &str) -> (Vec<(String, &str)>, usize) {
    let mut names = Vec::new();
    let mut count = 0;
    for line in text.lines() {
        if !line.trim().is_empty() {
            let Some((name, value)) = line.split_once(':') else { break };
            names.push((name.trim().to_lowercase(), value.trim()));
        }
        count += 1;
    }
    (names, count)
}

/// The files of the channels of a test in the order of their numbers: in the folder of `file`, or in its folder `Channel`.
fn neighbours(file: &Path, below: bool) -> Result<Vec<PathBuf>, String> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = |folder: &Path| -> Result<Vec<PathBuf>, String> {
        let read = std::fs::read_dir(folder).and_then(|entries| {
            entries.map(|entry| entry.map(|entry| entry.path())).collect::<std::io::Result<Vec<PathBuf>>>()
        });
        read.map_err(|e| format!("its folder {} can't be read: {e}", folder.display()))
    };
    let around = entries(folder)?;
    let is_channels = |path: &&PathBuf| {
        path.is_dir() && path.file_name().is_some_and(|name| name.eq_ignore_ascii_case("channel"))
    };
    let all = match around.iter().find(is_channels).filter(|_| below) {
        Some(channels) => entries(channels)?,
        None => around,
    };
    let stem = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().to_lowercase());
    let mut found: Vec<(u32, PathBuf)> = all
        .into_iter()
        .filter(|path| stem(path) == stem(file))
        .filter_map(|path| Some((path.extension()?.to_str()?.parse().ok()?, path)))
        .collect();
    if found.len() > MOST_CHANNELS {
        return Err(format!("its test has {} channels; at most {MOST_CHANNELS} are read", found.len()));
    }
    found.sort();
    Ok(found.into_iter().map(|(_, path)| path).collect())
}

fn same_file(one: &Path, other: &Path) -> bool {
    one.file_name() == other.file_name()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(code: &str, name: &str, rest: &str) -> String {
        format!(
            "Test object number          :1\nName of the channel         :{name}\nChannel code                :{code}\n\
             Unit                        :m/(s*s)\nReference channel           :implicit\nReference channel name      :NOVALUE\n\
             Sampling interval           :1.000000E-4\nTime of first sample        :-2.000000E-4\n\
             Number of samples           :3\n{rest}"
        )
    }

    #[test]
    fn a_channel_has_start_interval_and_unit() {
        let text = channel("11TIPX000000ACZA", "outer acceleration Z", "1.5E+0\r\nNOVALUE\r\n-2\r\n");
        assert_eq!(MmeFile::of(&text), Some(MmeFile::Channel));
        let found = MmeFile::Channel.channels(Path::new("x.001"), &text, None).expect("a channel");
        let [one] = &found[..] else { panic!("one channel") };
        assert_eq!(
            (one.name.as_str(), one.unit.as_str()),
            ("11TIPX000000ACZA/outer acceleration Z", "m/(s*s)")
        );
        assert_eq!(one.clock, ChannelClock::Even([-2e-4, 1e-4]));
        assert_eq!((one.values[0], one.values[1].is_nan(), one.values[2]), (1.5, true, -2.0));
        for (rest, part) in [
            ("1\n2\n", "has 2 samples, its header states 3"),
            ("1\nx\n3\n", "line 11: its value is `x`"),
            ("1\ninf\n3\n", "line 11: its value is `inf`"),
        ] {
            let text = channel("C", "a", rest);
            let said = MmeFile::Channel.channels(Path::new("x.001"), &text, None).expect_err("no channel");
            assert!(said.contains(part), "{said}");
        }
        assert_eq!(MmeFile::of("time: 3\nt,v\n0,1\n1,2\n"), None);
    }

    /// The test's header leads to its channels, by number; another test's are none of them. Times may be in a channel.
    #[test]
    fn a_test_has_the_channels_of_its_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        std::fs::create_dir(path("Channel")).expect("made");
        let times = channel("11TIRS000000TIRP", "time", "0\n1\n4\n").replace(":m/(s*s)", ":s");
        let explicit = channel("B", "b", "3\n4\n5\n")
            .replace(":implicit", ":explicit")
            .replace("Reference channel name      :NOVALUE", "Reference channel name      :11TIRS000000TIRP");
        for (name, text) in [
            ("Channel/mine.010", &explicit),
            ("Channel/mine.002", &times),
            ("Channel/Mine.001", &channel("A", "a", "0\n1\n2\n")),
            ("Channel/other.001", &channel("C", "c", "0\n1\n2\n")),
        ] {
            std::fs::write(path(name), text).expect("written");
        }
        let test = "Data format edition number  :1.6\nLaboratory name             :mine\n";
        assert_eq!(MmeFile::of(test), Some(MmeFile::Test));
        let found = MmeFile::Test.channels(&path("mine.mme"), test, None).expect("channels");
        let names: Vec<&str> = found.iter().map(|channel| channel.name.as_str()).collect();
        assert_eq!(names, ["A/a", "11TIRS000000TIRP/time", "B/b"]);
        assert_eq!(found[2].clock, ChannelClock::Channel(1));
        let list = "Instrumentation standard    :ISO 6487\nNumber of channels          :3\n";
        assert_eq!(MmeFile::of(list), Some(MmeFile::List));
        let listed = MmeFile::List.channels(&path("Channel/mine.chn"), list, None).expect("channels");
        assert_eq!(listed.len(), 3);
        // one channel with the one that has its times
        let one = MmeFile::Channel.channels(&path("Channel/mine.010"), &explicit, None).expect("channels");
        assert_eq!((one.len(), one[0].clock), (2, ChannelClock::Channel(1)));
        let alone = MmeFile::Test.channels(&path("nothing.mme"), test, None).expect_err("none");
        assert!(alone.contains("has no channel"), "{alone}");
    }
}
