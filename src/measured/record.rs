//! A record from a CSV file: times and signals with their units in the header.

use super::filter::SIGNALS;
use crate::curves::table::{self, Columns};
use crate::error::{Error, Result};
use crate::kinds::KINDS;
use crate::result::Curve;
use std::path::{Path, PathBuf};

/// Fewest samples of a record.
const FEWEST: usize = 32;

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
}

impl Record {
    /// Reads a CSV file whose header names quantity and unit, such as `time [us]`, `outer_velocity [mm/s]`; without unit a
    /// column is in SI. Lines that begin with `#` are skipped.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no such file, [`Error::Scene`] if it is no record.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).map_err(|e| match e.kind() {
            std::io::ErrorKind::NotFound => {
                Error::Usage(format!("there is no measured file {}", path.display()))
            }
            _ => Error::io("reading", path, e),
        })?;
        Self::parse(path, &bytes).map_err(|reason| {
            Error::Scene(miette::miette!(
                help = "a measured file is CSV with a header such as `time [us],outer_velocity [mm/s],inner_velocity [mm/s]`",
                "{}: {reason}",
                path.display()
            ))
        })
    }

    fn parse(path: &Path, bytes: &[u8]) -> std::result::Result<Self, String> {
        let curves = KINDS.iter().flat_map(|kind| kind.curves());
        let known: Vec<Curve> = curves.filter(|curve| SIGNALS.contains(&curve.name)).cloned().collect();
        let mut reader = table::csv_reader(bytes, b',');
        let header = reader.headers().map_err(|e| format!("line 1: {e}"))?.clone();
        let columns = table::by_heading(&header, &known)?;
        let Columns { time, values } = table::read(&mut reader, &columns, FEWEST)?;
        let channels = values.into_iter().map(|(quantity, values)| Channel { quantity, values }).collect();
        Ok(Record { file: path.to_path_buf(), time, channels })
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
        Record::parse(Path::new("r.csv"), text.as_bytes())
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

    #[test]
    fn an_invalid_record_is_reported_with_its_place() {
        let good = "time [us],outer_velocity [mm/s],inner_velocity [mm/s]";
        let row = |k: usize, text: &str| {
            let text = text.to_owned();
            rows().enumerate().map(move |(i, row)| if i == k { text.clone() } else { row })
        };
        for (file, part) in [
            (text("time [us],outer_speed,inner_velocity", rows()), "`outer_speed` is not a known column"),
            (text("time [us];outer_velocity [mm/s]", rows()), "the columns are separated by `;`"),
            (
                text("time [um],outer_velocity,inner_velocity", rows()),
                "`um` is the unit of something else; a time in s is needed",
            ),
            (text("time [us,outer_velocity,inner_velocity", rows()), "`]` is missing"),
            (text("outer_displacement,outer_velocity,inner_velocity", rows()), "no column `time`"),
            (text("time,time,inner_velocity", rows()), "two columns"),
            (text(good, rows().take(5)), "has 5 samples"),
            (text(good, row(3, "3,nan,0")), "line 5: outer_velocity is `nan`"),
            (text(good, row(3, "2,0,0")), "line 5: time is"),
            (text(good, row(3, "3,0")), "line"),
            (String::new(), "no column `time`"),
            ("time\n1\n2".into(), "no signal"),
        ] {
            let said = parse(&file).expect_err("no record");
            assert!(said.contains(part), "{said}");
        }
    }
}
