//! What a column of a file is: the time or a curve, or what a curve is derived from.

use crate::result::Curve;
use crate::scene::{quantity_in, suggestion};
use serde::Deserialize;

/// Names of the time in files of instruments.
const TIMES: [&str; 12] = [
    "time",
    "t",
    "times",
    "zeit",
    "temps",
    "tiempo",
    "tempo",
    "x-axis",
    "x_value",
    "time stamp",
    "seconds",
    "x",
];
/// The unit of row numbers, as Rigol writes it.
pub(super) const ROW_NUMBERS: &str = "Sequence";
/// Names of units that instruments write out.
const WRITTEN_OUT: [(&str, &str); 18] = [
    ("second", "s"),
    ("seconds", "s"),
    ("sec", "s"),
    ("msec", "ms"),
    ("usec", "us"),
    ("µsec", "us"),
    ("nsec", "ns"),
    ("volt", "V"),
    ("volts", "V"),
    ("newton", "N"),
    ("newtons", "N"),
    ("metre", "m"),
    ("meter", "m"),
    ("m/s2", "m/s^2"),
    ("m/s²", "m/s^2"),
    ("m/(s*s)", "m/s^2"),
    ("m/s/s", "m/s^2"),
    ("strain", "1"),
];

/// What a column measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Measures {
    /// m.
    Displacement,
    /// m/s.
    Velocity,
    /// m/s^2; a velocity is its integral.
    Acceleration,
    /// N.
    Force,
    /// N s; a force is its rate.
    Impulse,
    /// A strain with a sensitivity: what the curve is.
    Strain,
    /// A voltage with a sensitivity: what the curve is.
    Voltage,
    /// Anything else as it is.
    Other,
}

impl Measures {
    /// What the curve or column called `name` is.
    pub(super) fn of(name: &str) -> Self {
        let endings = [
            ("displacement", Self::Displacement),
            ("velocity", Self::Velocity),
            ("acceleration", Self::Acceleration),
            ("force", Self::Force),
            ("impulse", Self::Impulse),
        ];
        endings
            .iter()
            .find(|(ending, _)| name.ends_with(ending))
            .map_or(Self::Other, |(_, measures)| *measures)
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Force => "force",
            Self::Impulse => "impulse",
            Self::Strain => "strain",
            Self::Voltage => "voltage",
            Self::Other => "other",
        }
    }

    /// Its SI unit, `si` where it is what the curve is.
    pub(super) fn unit(self, si: &'static str) -> &'static str {
        match self {
            Self::Acceleration => "m/s^2",
            Self::Impulse => "N*s",
            _ => si,
        }
    }

    /// Whether the curve called `name` follows from it.
    pub(super) fn require_for(self, name: &str) -> Result<(), String> {
        let own = Self::of(name);
        let follows = match self {
            Self::Strain | Self::Voltage => true,
            Self::Acceleration => own == Self::Velocity,
            Self::Impulse => own == Self::Force,
            other => other == own,
        };
        match follows {
            true => Ok(()),
            false => Err(format!("no {} follows from a column that measures {}", own.name(), self.name())),
        }
    }
}

/// A column that is wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name of the curve, or `time`.
    pub name: &'static str,
    /// Its place in a row.
    pub index: usize,
    /// Size of its unit in SI, negative if it counts the other way.
    pub factor: f64,
    /// What is added afterwards, SI.
    pub offset: f64,
    /// What it measures.
    pub measures: Measures,
    /// By which its channel is late, s.
    pub delay: f64,
    /// ColumnPlace of a column with its own times.
    pub clock: Option<usize>,
}

/// What a file says of its columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Titles {
    /// Name of each column; its number, counted from 1, where there is none.
    pub headings: Vec<String>,
    /// Unit of each column, where it stands apart from the heading; else empty.
    pub units: Vec<String>,
}

/// Most headings that a message lists.
const LISTED: usize = 40;

/// The first of the `names`, and how many more there are.
pub(super) fn listed<S: AsRef<str>>(names: &[S], between: &str) -> String {
    let first: Vec<&str> = names.iter().take(LISTED).map(AsRef::as_ref).collect();
    match names.len().saturating_sub(LISTED) {
        0 => first.join(between),
        more => format!("{}{between}and {more} more", first.join(between)),
    }
}

impl Titles {
    /// The headings, for a message.
    pub(super) fn listed(&self) -> String {
        listed(&self.headings, " | ")
    }

    /// The unit of a column: as it stands apart, or in its heading.
    pub(super) fn unit_of(&self, index: usize) -> Option<&str> {
        let stated = self.units.get(index).filter(|unit| !unit.is_empty());
        stated.map(String::as_str).or_else(|| split_heading(self.headings.get(index)?).ok()?.1)
    }
}

/// Name and unit of a heading: `outer_velocity [mm/s]`, `time (us)`, `time in s`.
fn split_heading(heading: &str) -> Result<(&str, Option<&str>), String> {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, unit)) = heading.split_once(open) {
            let unit = unit.trim_end().strip_suffix(close);
            let unit = unit.ok_or_else(|| format!("column `{heading}`: `{close}` is missing"))?;
            // `pair(1)` is the first column of a matrix
            if unit.trim().parse::<f64>().is_ok() {
                break;
            }
            return Ok((name.trim(), Some(unit.trim())));
        }
    }
    Ok(match heading.rsplit_once(" in ") {
        Some((name, unit)) if is_unit(unit.trim()) => (name.trim(), Some(unit.trim())),
        _ => (heading.trim(), None),
    })
}

/// The name of a curve or of the time without the groups before it that binary formats have; any other `name` as it is.
fn without_groups<'n>(name: &'n str, known: &[Curve]) -> &'n str {
    let last = name.rsplit(['/', '.']).next().unwrap_or(name).trim();
    let is_known =
        known.iter().any(|curve| curve.name == last) || TIMES.contains(&last.to_lowercase().as_str());
    if is_known { last } else { name }
}

/// The unit as this program writes it.
fn spelled(unit: &str) -> &str {
    let lower = unit.to_lowercase();
    WRITTEN_OUT.iter().find(|(other, _)| *other == lower).map_or(unit, |(_, symbol)| symbol)
}

/// Whether `unit` is one, of anything that can be measured.
pub(super) fn is_unit(unit: &str) -> bool {
    const OF: [&str; 7] = ["s", "m/s", "m", "m/s^2", "N", "N*s", "V"];
    OF.iter().any(|si| unit_in_si(unit, si).is_ok())
}

/// Size of `unit` in the SI unit `si`.
///
/// # Errors
/// One sentence.
pub fn unit_in_si(unit: &str, si: &str) -> Result<f64, String> {
    quantity_in(&format!("1 {}", spelled(unit)), si)
}

/// The columns that the headings among the `titles` name: the time and `known` curves. Others are left out, but for what looks like a slip.
pub(super) fn by_heading(titles: &Titles, known: &[Curve]) -> Result<Vec<Column>, String> {
    let mut found: Vec<Column> = Vec::new();
    for (index, heading) in titles.headings.iter().enumerate() {
        let (name, _) = split_heading(heading)?;
        let name = without_groups(name, known);
        let lower = name.to_lowercase();
        // "X" heads the numbers of the rows, too
        let is_time = TIMES.contains(&lower.as_str()) && titles.unit_of(index) != Some(ROW_NUMBERS);
        let Some((name, measures)) =
            (if is_time { Some(("time", Measures::Other)) } else { named(name, known)? })
        else {
            continue;
        };
        let (name, si) = known_column(name, known)?;
        let unit = titles.unit_of(index);
        let factor = unit.map_or(Ok(1.0), |unit| unit_in_si(unit, measures.unit(si)));
        let factor = factor.map_err(|reason| format!("column `{heading}`: {reason}"))?;
        if found.iter().any(|other| other.name == name) {
            return Err(format!("two columns are called `{name}`"));
        }
        found.push(Column { name, index, factor, offset: 0.0, measures, delay: 0.0, clock: None });
    }
    Ok(found)
}

/// The curve that the column called `name` is or gives, and what it measures; `None` if it is none of `known`.
fn named<'n>(name: &'n str, known: &[Curve]) -> Result<Option<(&'n str, Measures)>, String> {
    let is_known = |name: &str| known.iter().any(|curve| curve.name == name);
    if is_known(name) {
        return Ok(Some((name, Measures::of(name))));
    }
    let derived = [("acceleration", "velocity"), ("impulse", "force")];
    for (from, to) in derived {
        let Some(body) = name.strip_suffix(from) else { continue };
        let curve = known.iter().find(|curve| curve.name.strip_suffix(to) == Some(body));
        if let Some(curve) = curve {
            return Ok(Some((curve.name, Measures::of(name))));
        }
    }
    // a channel of something else is no slip of the pen
    let of_a_body =
        |curve: &Curve| curve.name.split_once('_').is_some_and(|(body, _)| name.starts_with(body));
    let is_slip = known.iter().any(of_a_body) || suggestion(name, names(known)).is_some();
    if is_slip { known_column(name, known).map(|_| None) } else { Ok(None) }
}

/// The column called `name` among the time and the `known` curves, and its SI unit.
///
/// # Errors
/// One sentence with those there are.
pub fn known_column(name: &str, known: &[Curve]) -> Result<(&'static str, &'static str), String> {
    let all = std::iter::once(("time", "s")).chain(known.iter().map(|curve| (curve.name, curve.unit)));
    all.clone().find(|(other, _)| *other == name).ok_or_else(|| {
        let names = names(known);
        let hint = suggestion(name, names.iter().copied()).map(|near| format!("; did you mean `{near}`?"));
        format!(
            "`{name}` is not a known column{} (there are: {})",
            hint.unwrap_or_default(),
            names.join(", ")
        )
    })
}

/// The names of the time and the `known` curves, each once: several kinds of scenes have curves of the same name.
pub(super) fn names(known: &[Curve]) -> Vec<&'static str> {
    let mut names = vec!["time"];
    for curve in known {
        if !names.contains(&curve.name) {
            names.push(curve.name);
        }
    }
    names
}
