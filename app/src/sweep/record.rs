//! Results of a sweep in an append-only log, one line each with a checksum.
//!
//! A process that is killed leaves at most one line torn. Lines whose checksum is wrong are ignored, so that their
//! points run again; nothing that is in the log is ever changed. Numbers are written so that they come back bit
//! by bit.

use crate::kinds::Kind;
use crate::result::{Point, Table};
use std::fmt::Write;

/// What became of one point.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Number of the point.
    pub index: usize,
    /// Its result.
    pub outcome: Outcome,
}

/// Result of one point.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// The impact ran, with these numbers, those of `results`.
    Done(Box<[f64]>),
    /// The scene is not valid, for this reason.
    Invalid(String),
    /// The solver failed, for this reason.
    Failed(String),
}

impl Outcome {
    /// "ok", "invalid" or "failed".
    pub fn status(&self) -> &'static str {
        match self {
            Outcome::Done(_) => "ok",
            Outcome::Invalid(_) => "invalid",
            Outcome::Failed(_) => "failed",
        }
    }

    /// Why there is no result; empty if there is one.
    pub fn reason(&self) -> &str {
        match self {
            Outcome::Done(_) => "",
            Outcome::Invalid(reason) | Outcome::Failed(reason) => reason,
        }
    }

    /// The numbers of `results`, if there are any.
    pub fn numbers(&self) -> Option<&[f64]> {
        if let Outcome::Done(numbers) = self { Some(numbers) } else { None }
    }
}

impl From<Point<Table>> for Outcome {
    fn from(point: Point<Table>) -> Self {
        let values = point.quantities.iter().map(|quantity| quantity.value.unwrap_or(f64::NAN));
        let converged = f64::from(u8::from(point.converged));
        let rest = [point.energy_residual, point.momentum_residual, point.steps as f64, converged];
        Outcome::Done(values.chain(rest).collect())
    }
}

/// Name and unit of the numbers of a result of `kind`.
pub(super) fn results(kind: &dyn Kind) -> Vec<(&'static str, &'static str)> {
    let quantities = kind.quantities().iter().map(|quantity| (quantity.name, quantity.unit));
    quantities
        .chain(["energy_residual", "momentum_residual", "steps", "converged"].map(|name| (name, "1")))
        .collect()
}

/// First line of a log of the sweep with the identity `hash`.
pub fn header(hash: &str) -> String {
    format!("impactcheck-sweep 1 {hash}")
}

impl Record {
    /// Appends the record to `text` as a line: checksum, index, status, numbers or reason.
    pub fn append_to(&self, text: &mut String) {
        let mut body = format!("{} {}", self.index, self.outcome.status());
        match self.outcome.numbers() {
            // the shortest text that gives the same double; writing into a string can't fail
            Some(numbers) => numbers.iter().for_each(|number| {
                let _ = write!(body, " {number:e}");
            }),
            None => {
                body.push(' ');
                body.extend(self.outcome.reason().chars().map(|c| if c.is_control() { ' ' } else { c }));
            }
        }
        let _ = writeln!(text, "{:08x} {body}", crc32fast::hash(body.as_bytes()));
    }

    /// The record in a line without its line break, a result with so many `numbers`; `None` if the line is damaged.
    pub fn parse(line: &[u8], numbers: usize) -> Option<Self> {
        let line = std::str::from_utf8(line).ok()?;
        let (checksum, body) = line.split_once(' ')?;
        if checksum.len() != 8 || u32::from_str_radix(checksum, 16).ok()? != crc32fast::hash(body.as_bytes())
        {
            return None;
        }
        let mut parts = body.splitn(3, ' ');
        let (index, status, rest) = (parts.next()?.parse().ok()?, parts.next()?, parts.next()?);
        let outcome = match status {
            "ok" => {
                let found = rest.split(' ').map(|number| number.parse().ok());
                let found: Box<[f64]> = found.collect::<Option<_>>()?;
                Outcome::Done(Some(found).filter(|found| found.len() == numbers)?)
            }
            "invalid" => Outcome::Invalid(rest.to_owned()),
            "failed" => Outcome::Failed(rest.to_owned()),
            _ => return None,
        };
        Some(Record { index, outcome })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NUMBERS: usize = 13;

    fn done() -> Record {
        Record { index: 7, outcome: Outcome::Done((0..NUMBERS).map(|k| (k as f64 + 0.1) / 3.0).collect()) }
    }

    #[test]
    fn records_come_back_bit_by_bit() {
        let invalid = Record { index: 8, outcome: Outcome::Invalid("`plate.radius` is -1 m,\nbut".into()) };
        let mut text = String::new();
        done().append_to(&mut text);
        invalid.append_to(&mut text);
        let lines: Vec<Option<Record>> =
            text.lines().map(|line| Record::parse(line.as_bytes(), NUMBERS)).collect();
        assert_eq!(lines[0], Some(done()));
        let back = lines[1].clone().expect("one line");
        assert_eq!((back.index, back.outcome.reason()), (8, "`plate.radius` is -1 m, but"));
    }

    #[test]
    fn no_changed_cut_or_foreign_line_is_believed() {
        let mut text = String::new();
        done().append_to(&mut text);
        let line = text.trim_end().as_bytes();
        for k in 0..line.len() {
            let mut changed = line.to_vec();
            changed[k] ^= 1;
            // the checksum's own letters may change case only
            let same = changed.eq_ignore_ascii_case(line);
            assert!(same || Record::parse(&changed, NUMBERS).is_none(), "byte {k}");
            assert!(Record::parse(&line[..k], NUMBERS).is_none(), "cut at {k}");
        }
        for foreign in [&b""[..], b"\xff\xfe", b"00000000 ", b"impactcheck-sweep 1 abc"] {
            assert!(Record::parse(foreign, NUMBERS).is_none());
        }
        // and none of another kind of scene
        assert!(Record::parse(line, NUMBERS).is_some() && Record::parse(line, NUMBERS + 1).is_none());
    }
}
