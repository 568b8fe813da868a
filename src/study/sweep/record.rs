//! Results of a sweep in an append-only log, one line each with a checksum.
//!
//! A process that is killed leaves at most one line torn. Lines whose checksum is wrong are ignored, so that their
//! points run again; nothing that is in the log is ever changed. Numbers are written so that they come back bit
//! by bit.

use crate::kinds::plate_impact::PlateQuantities;
use crate::kinds::plate_impact::reduced::Point;
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
    /// The impact ran.
    Done(Point),
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

    /// The numbers of `NUMBERS`.
    pub fn numbers(&self) -> Option<[f64; NUMBERS.len()]> {
        let Outcome::Done(point) = self else { return None };
        let values = PlateQuantities::ALL.iter().filter_map(|quantity| point.quantities.get(quantity.name));
        let rest = [point.energy_residual, point.momentum_residual, point.steps as f64];
        let mut numbers = [0.0; NUMBERS.len()];
        for (number, value) in numbers.iter_mut().zip(values.chain(rest)) {
            *number = value;
        }
        Some(numbers)
    }
}

/// Name and unit of the numbers of a result.
pub const NUMBERS: [(&str, &str); PlateQuantities::ALL.len() + 3] = {
    let quantities = PlateQuantities::ALL;
    let mut numbers = [("energy_residual", "1"); PlateQuantities::ALL.len() + 3];
    let mut k = 0;
    while k < quantities.len() {
        numbers[k] = (quantities[k].name, quantities[k].unit);
        k += 1;
    }
    numbers[k + 1] = ("momentum_residual", "1");
    numbers[k + 2] = ("steps", "1");
    numbers
};

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

    /// The record in a line without its line break; `None` if the line is damaged.
    pub fn parse(line: &[u8]) -> Option<Self> {
        let line = std::str::from_utf8(line).ok()?;
        let (checksum, body) = line.split_once(' ')?;
        if checksum.len() != 8 || u32::from_str_radix(checksum, 16).ok()? != crc32fast::hash(body.as_bytes())
        {
            return None;
        }
        let mut parts = body.splitn(3, ' ');
        let (index, status, rest) = (parts.next()?.parse().ok()?, parts.next()?, parts.next()?);
        let outcome = match status {
            "ok" => Outcome::Done(point(rest)?),
            "invalid" => Outcome::Invalid(rest.to_owned()),
            "failed" => Outcome::Failed(rest.to_owned()),
            _ => return None,
        };
        Some(Record { index, outcome })
    }
}

fn point(text: &str) -> Option<Point> {
    let mut numbers = text.split(' ').map(|number| number.parse().ok());
    let quantities = PlateQuantities::of(|_| numbers.next()?)?;
    let mut number = || numbers.next()?;
    let (energy_residual, momentum_residual, steps): (f64, f64, f64) = (number()?, number()?, number()?);
    numbers.next().is_none().then_some(Point {
        quantities,
        energy_residual,
        momentum_residual,
        steps: steps as u64,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn done() -> Record {
        let numbers: Vec<String> =
            (0..NUMBERS.len()).map(|k| format!("{:e}", (k as f64 + 0.1) / 3.0)).collect();
        let mut point = point(&numbers.join(" ")).expect("numbers");
        // counts are whole
        (point.quantities.outer_contacts, point.quantities.inner_contacts, point.steps) = (3, 1, 42);
        Record { index: 7, outcome: Outcome::Done(point) }
    }

    #[test]
    fn records_come_back_bit_by_bit() {
        let invalid = Record { index: 8, outcome: Outcome::Invalid("`plate.radius` is -1 m,\nbut".into()) };
        let mut text = String::new();
        done().append_to(&mut text);
        invalid.append_to(&mut text);
        let lines: Vec<Option<Record>> = text.lines().map(|line| Record::parse(line.as_bytes())).collect();
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
            assert!(same || Record::parse(&changed).is_none(), "byte {k}");
            assert!(Record::parse(&line[..k]).is_none(), "cut at {k}");
        }
        for foreign in [&b""[..], b"\xff\xfe", b"00000000 ", b"impactcheck-sweep 1 abc"] {
            assert!(Record::parse(foreign).is_none());
        }
    }
}
