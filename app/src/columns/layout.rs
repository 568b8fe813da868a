//! Where the numbers of a text begin, what separates them, and the headings above them.

use super::column::{ROW_NUMBERS, Titles};
use super::map::TableForm;
use super::rows::number;
use std::ops::Range;

/// Separators of columns that are tried, those first that are no part of a number.
const DELIMITERS: [char; 5] = ['\t', ';', ',', '|', ' '];
/// Lines at the head of a file in which its numbers have to begin.
const HEAD: usize = 500;
/// Lines in the last quarter of a file that show its form.
const SHOWN: usize = 25;
/// Lines above the numbers among which headings are looked for.
const ABOVE: usize = 6;

/// How a table of text is written.
#[derive(Debug, Clone, PartialEq)]
pub struct TextLayout {
    /// Between columns; a space stands for any number of them.
    pub delimiter: char,
    /// Decimal sign.
    pub decimal: char,
    /// Above the columns; the units are those of a line of units.
    pub titles: Titles,
    /// Lines before the first number.
    pub lines_before: usize,
    /// Where the lines with numbers are, in bytes.
    pub rows: Range<usize>,
}

/// The cells of a `line`, trimmed and without quotation marks.
pub(super) fn cells(line: &str, delimiter: char) -> Vec<String> {
    if delimiter == ' ' {
        return line.split_whitespace().map(|cell| cell.trim_matches('"').to_owned()).collect();
    }
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .delimiter(delimiter as u8)
        .trim(csv::Trim::All)
        .from_reader(line.as_bytes());
    let row = reader.records().next().and_then(Result::ok).unwrap_or_default();
    row.iter().map(str::to_owned).collect()
}

/// What a cell is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum CellKind {
    Number,
    /// Nothing, or what programs write for a missing value.
    Missing,
    Text,
}

fn kind(cell: &str, decimal: char) -> CellKind {
    match super::rows::is_missing(cell) {
        true => CellKind::Missing,
        false if value(cell, decimal).is_some() => CellKind::Number,
        false => CellKind::Text,
    }
}

/// The number in a cell with this `decimal` sign.
pub(super) fn value(cell: &str, decimal: char) -> Option<f64> {
    if decimal == '.' {
        return number(cell);
    }
    if cell.contains('.') { None } else { number(&cell.replacen(decimal, ".", 1)) }
}

/// Whether something is a unit.
pub type IsUnit = fn(&str) -> bool;

impl TextLayout {
    /// Of `text`, as far as `form` does not say it; `one` column of numbers is enough where the times are known otherwise.
    ///
    /// # Errors
    /// One sentence.
    pub fn of(text: &str, form: &TableForm, one: bool, is_unit: IsUnit) -> Result<Self, String> {
        let lines: Vec<(usize, &str)> = lines(text).take(HEAD + form.skip).collect();
        let after_skipped = lines.get(form.skip).map_or(text.len(), |line| line.0);
        let shown = shown(&text[after_skipped..]);
        let (delimiter, decimal) = separators(&shown, form, one)?;
        let rows: Vec<Vec<String>> = shown.iter().map(|line| cells(line, delimiter)).collect();
        let width = rows.iter().map(Vec::len).max().unwrap_or(0);
        // columns of numbers: no text in any line, a number in one at least
        let of =
            |k: usize| rows.iter().map(move |row| row.get(k).map_or(CellKind::Missing, |c| kind(c, decimal)));
        let numeric: Vec<usize> = (0..width)
            .filter(|k| of(*k).all(|c| c != CellKind::Text) && of(*k).any(|c| c == CellKind::Number))
            .collect();
        let begins = |(_, line): &(usize, &str)| {
            let row = cells(line, delimiter);
            let is = |k: &usize, cell: CellKind| {
                row.get(*k).map_or(CellKind::Missing, |c| kind(c, decimal)) == cell
            };
            numeric.iter().all(|k| !is(k, CellKind::Text)) && numeric.iter().any(|k| is(k, CellKind::Number))
        };
        let first = lines.iter().skip(form.skip).position(begins).map(|k| k + form.skip);
        let first = first.ok_or_else(|| format!("its numbers do not begin within {HEAD} lines"))?;
        let above: Vec<Vec<String>> = lines[form.skip.min(first)..first]
            .iter()
            .rev()
            .filter(|(_, line)| !line.trim().is_empty())
            .take(ABOVE)
            .map(|(_, line)| cells(line.trim_start_matches(COMMENTS), delimiter))
            .collect();
        let (headings, units) = match form.headings {
            true => headings(&above, &numeric, form.units_line, is_unit),
            false => (Vec::new(), Vec::new()),
        };
        // titles of programs are padded with spaces
        let close = |name: &String| name.split_whitespace().collect::<Vec<&str>>().join(" ");
        let name = |k: usize| headings.get(k).map(close).filter(|name| !name.is_empty());
        Ok(Self {
            delimiter,
            decimal,
            titles: Titles {
                headings: (0..width).map(|k| name(k).unwrap_or_else(|| (k + 1).to_string())).collect(),
                units: (0..width).map(|k| units.get(k).cloned().unwrap_or_default()).collect(),
            },
            lines_before: first,
            rows: lines[first].0..text.len(),
        })
    }
}

/// Characters that begin a comment.
const COMMENTS: [char; 3] = ['#', '%', '!'];

/// The lines of `text` with their places in bytes.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.split_inclusive('\n').scan(0, |at, line| {
        let place = *at;
        *at += line.len();
        Some((place, line.trim_end_matches(['\n', '\r'])))
    })
}

/// Lines from the last quarter of `text`, where numbers are even if much stands before them, at even distances, since values may be missing
/// in some part of it; of a short one the last line.
fn shown(text: &str) -> Vec<&str> {
    let from = text.len() / 4 * 3;
    let whole = |line: &&str| !line.trim().is_empty();
    let after = |k: usize| {
        let place = from + (text.len() - from) / SHOWN * k;
        let place = (place..text.len()).find(|place| text.is_char_boundary(*place))?;
        text[place..].lines().skip(1).find(whole)
    };
    let later: Vec<&str> = (0..SHOWN).filter_map(after).collect();
    if later.is_empty() { text.lines().rfind(whole).into_iter().collect() } else { later }
}

/// Delimiter and decimal sign: of those possible the ones with most lines of numbers, and of these with most columns.
fn separators(shown: &[&str], form: &TableForm, one: bool) -> Result<(char, char), String> {
    let delimiters: Vec<char> = match form.delimiter.as_deref() {
        None => DELIMITERS.to_vec(),
        Some("spaces") => vec![' '],
        Some("tab") => vec!['\t'],
        Some(named) => match named.chars().collect::<Vec<_>>()[..] {
            [delimiter] if delimiter.is_ascii() => vec![delimiter],
            _ => {
                return Err(format!(
                    "table.delimiter is `{named}`, but it must be one character, `tab` or `spaces`"
                ));
            }
        },
    };
    let decimals = match form.decimal.as_deref() {
        None => vec!['.', ','],
        Some(".") => vec!['.'],
        Some(",") => vec![','],
        Some(named) => return Err(format!("table.decimal is `{named}`, but it must be `.` or `,`")),
    };
    let least = if one { 1 } else { 2 };
    let mut best = ((0, 0), None);
    for delimiter in &delimiters {
        for decimal in &decimals {
            let counts = shown.iter().filter_map(|line| {
                let row = cells(line, *delimiter);
                let numbers = row.iter().filter(|cell| kind(cell, *decimal) == CellKind::Number).count();
                (numbers >= least).then_some(numbers)
            });
            let (rows, columns) = counts.fold((0, 0), |(rows, most), count| (rows + 1, most.max(count)));
            if (rows, columns) > best.0 {
                best = ((rows, columns), Some((*delimiter, *decimal)));
            }
        }
    }
    if best.1.is_none() && !one && separators(shown, form, true).is_ok() {
        return Err("has one column of numbers, but times and a signal are needed: state start and interval under [time] in a map".into());
    }
    best.1.ok_or_else(|| {
        let first = shown.first().map_or("nothing", |line| line.trim());
        let first: String = first.chars().take(60).collect();
        format!("has no columns of numbers: among its last lines stands `{first}`; name delimiter and decimal sign in a map")
    })
}

/// Names and units of the columns from the lines `above` the numbers, nearest first: a line of units may stand between.
fn headings(
    above: &[Vec<String>],
    numeric: &[usize],
    stated: Option<bool>,
    is_unit: IsUnit,
) -> (Vec<String>, Vec<String>) {
    let last = numeric.last().map_or(0, |k| k + 1);
    let cell = |row: &[String], k: usize| row.get(k).cloned().unwrap_or_default();
    let bare = |cell: &str| cell.trim_matches(['(', ')', '[', ']']).trim().to_owned();
    let has_units = |row: &Vec<String>| {
        let filled: Vec<String> =
            numeric.iter().map(|k| bare(&cell(row, *k))).filter(|unit| !unit.is_empty()).collect();
        !filled.is_empty() && filled.iter().all(|unit| is_unit(unit) || unit == ROW_NUMBERS)
    };
    let fits = |row: &&Vec<String>| {
        row.len() >= last && numeric.iter().any(|k| kind(&cell(row, *k), '.') == CellKind::Text)
    };
    let mut fitting = above.iter().filter(fits).peekable();
    let units = match (stated, fitting.peek()) {
        (Some(false), _) | (_, None) => Vec::new(),
        (Some(true), Some(row)) => row.iter().map(|cell| bare(cell)).collect(),
        (None, Some(row)) if has_units(row) => row.iter().map(|cell| bare(cell)).collect(),
        _ => Vec::new(),
    };
    if !units.is_empty() {
        fitting.next();
    }
    // names need not be text: channels 1 and 2
    let names = fitting.next().cloned().or_else(|| {
        let line = above.iter().filter(|row| row.len() >= last).nth(usize::from(!units.is_empty()))?;
        Some(line.clone())
    });
    (names.unwrap_or_default(), units)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(text: &str) -> TextLayout {
        let is_unit = |unit: &str| ["s", "second", "m/s", "us", "V", "Volt", "mV"].contains(&unit);
        TextLayout::of(text, &TableForm::default(), false, is_unit).expect("a layout")
    }

    /// Forms of exports of oscilloscopes and measuring programs.
    #[test]
    fn delimiter_decimal_sign_headings_and_units_are_found() {
        for (text, delimiter, decimal, headings, units, before) in [
            ("t,v\n0,1\n1,2\n", ',', '.', "t v", "", 1),
            ("t;v\n0,5;1,5\n1,5;2,5\n", ';', ',', "t v", "", 1),
            ("t\tv\n0,5\t1,5\n1,5\t2,5\n", '\t', ',', "t v", "", 1),
            ("t,v\n\"0,5\",\"1,5\"\n\"1,5\",\"2,5\"\n", ',', ',', "t v", "", 1),
            (
                "x-axis,1,2\nsecond,Volt,Volt\n0.5,1,2\n1.0,2,3\n",
                ',',
                '.',
                "x-axis 1 2",
                "second Volt Volt",
                2,
            ),
            ("Time\tChannel A\n(us)\t(mV)\n\n0.5\t1\n1.5\t2\n", '\t', '.', "Time Channel A", "us mV", 3),
            ("# made by x\n# t v\n 0.5   1\n 1.5  -2\n", ' ', '.', "t v", "", 2),
            (
                "LECROY,1,,\nSegments,1,SegmentSize,2\nTime,Ampl\n-1e-3,0.5\n1e-3,0.6\n",
                ',',
                '.',
                "Time Ampl",
                "",
                3,
            ),
            ("; a comment\nt,v\n0,1\n1,2\n", ',', '.', "t v", "", 2),
            ("0 1\n1 2\n", ' ', '.', "1 2", "", 0),
            (
                "X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,-1e-4,5e-7\n0,1.5,2.5,\n1,2.5,3.5,\n",
                ',',
                '.',
                "X CH1 CH2 Start",
                "Sequence Volt Volt -1e-4",
                2,
            ),
        ] {
            let found = layout(text);
            assert_eq!((found.delimiter, found.decimal), (delimiter, decimal), "{text}");
            assert_eq!(found.titles.headings.join(" "), headings, "{text}");
            assert_eq!(found.titles.units.join(" ").trim(), units, "{text}");
            assert_eq!(found.lines_before, before, "{text}");
        }
    }

    /// Tektronix writes its settings beside the first rows.
    #[test]
    fn settings_beside_the_numbers_are_no_column() {
        let text =
            "Record Length,4,,-0.2,1\nSample Interval,0.1,,-0.1,2\n,,,0.0,3\n,,,0.1,4\n,,,0.2,4\n,,,0.3,4\n";
        let found = layout(text);
        assert_eq!(found.lines_before, 0);
        assert_eq!(found.titles.headings[3..], ["4", "5"]);
    }

    #[test]
    fn values_that_are_missing_at_length_hide_no_columns() {
        let row = |k: usize| if (152..190).contains(&k) { format!("{k},,\n") } else { format!("{k},1,2\n") };
        let found = layout(&format!("t,v,w\n{}", (0..200).map(row).collect::<String>()));
        assert_eq!((found.delimiter, found.titles.headings.join(" ")), (',', "t v w".to_owned()));
    }

    #[test]
    fn what_is_no_table_is_said() {
        let refuse =
            |text: &str| TextLayout::of(text, &TableForm::default(), false, |_| false).expect_err("none");
        assert!(refuse("only words\nand more\n").contains("no columns of numbers"));
        assert!(refuse("").contains("no columns"));
        let form = TableForm { delimiter: Some("::".into()), ..TableForm::default() };
        assert!(TextLayout::of("1,2", &form, false, |_| false).expect_err("none").contains("one character"));
    }
}
