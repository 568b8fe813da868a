//! CalculiX's results as tables with headings: of what it prints (`.dat`) and of its fields (`.frd`).
//!
//! G. Dhondt, "CalculiX CrunchiX user's manual": \*NODE PRINT writes blocks `displacements (vx,vy,vz) for set N and time T`
//! with a node and its values per line, \*NODE FILE blocks of nodal values in fixed columns.

use super::rows::{number as value_of, packed};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Lines in which the first block begins of what CalculiX prints.
const HEAD: usize = 20;

/// Whether `text` is what CalculiX prints: other programs name tables of numbers `.dat`, too.
pub(super) fn is_dat(text: &str) -> bool {
    text.lines().take(HEAD).any(|line| line.contains(" set ") && line.contains(" and time "))
}

/// Values by heading at every time.
#[derive(Default)]
struct Rows {
    times: Vec<(f64, BTreeMap<String, f64>)>,
    /// Number of rows of every block, by its name and set.
    counts: BTreeMap<String, usize>,
}

impl Rows {
    /// The values at `time`, which comes after all others or is the last.
    fn at(&mut self, time: f64) -> &mut BTreeMap<String, f64> {
        if self.times.last().is_none_or(|(last, _)| *last != time) {
            self.times.push((time, BTreeMap::new()));
        }
        let last = self.times.len() - 1;
        &mut self.times[last].1
    }

    /// Adds the means of a block that has ended.
    ///
    /// # Errors
    /// One sentence if it has no rows, or not as many as before.
    fn close(&mut self, block: Option<PrintedBlock>) -> Result<(), String> {
        let Some(PrintedBlock { name, components, set, time, sums, rows }) = block else { return Ok(()) };
        let before = *self.counts.entry(format!("{name} {set}")).or_insert(rows);
        if rows == 0 || rows != before {
            return Err(format!(
                "there are {rows} rows of {name} for set {set} at {time} s, at first there were {before}"
            ));
        }
        let values = self.at(time);
        for (component, sum) in components.iter().zip(sums) {
            values.insert(format!("{name} {set} {component}"), sum / rows as f64);
        }
        Ok(())
    }

    /// As CSV, with the headings of the last time; the first column is `time`.
    fn table(&self) -> Result<String, String> {
        let headings: Vec<&String> =
            self.times.last().map(|(_, row)| row.keys().collect()).unwrap_or_default();
        let mut text = String::from("time");
        headings.iter().for_each(|heading| text += &format!(",{heading}"));
        for (time, row) in &self.times {
            let _ = write!(text, "\n{time:e}");
            for heading in &headings {
                let value = row.get(*heading).ok_or_else(|| format!("there is no {heading} at {time} s"))?;
                let _ = write!(text, ",{value:e}");
            }
        }
        Ok(text)
    }
}

/// A block of printed rows that belong to one set.
struct PrintedBlock<'t> {
    name: &'t str,
    components: Vec<&'t str>,
    set: String,
    time: f64,
    /// Sums of the components over the rows.
    sums: Vec<f64>,
    rows: usize,
}

impl<'t> PrintedBlock<'t> {
    fn new(name: &'t str, components: &'t str, set: String, time: f64) -> Self {
        let components: Vec<&str> = components.split(',').map(str::trim).collect();
        let sums = vec![0.0; components.len()];
        PrintedBlock { name, components, set, time, sums, rows: 0 }
    }

    /// The block that `line` is the heading of. A contact pair's heading is in two lines: `pair` keeps set and time of the first.
    fn of(line: &'t str, pair: &mut Option<(String, f64)>) -> Option<Self> {
        if let Some(statistics) = line.strip_prefix("statistics for ") {
            let (sets, time) = statistics.split_once(" and time")?;
            let sets = sets.split(',').filter_map(|set| set.split_once(" set "));
            let names: Vec<&str> = sets.map(|(_, name)| name.trim()).collect();
            *pair = Some((names.join(" "), value_of(time.trim())?));
            return None;
        }
        let (name, components, rest) = heading(line)?;
        if rest.starts_with("and moment") {
            let (set, time) = pair.clone()?;
            return Some(PrintedBlock::new(name, components, set, time));
        }
        let (set, time) = rest.strip_prefix("for set ")?.split_once(" and time")?;
        Some(PrintedBlock::new(name, components, set.trim().to_owned(), value_of(time.trim())?))
    }

    /// Adds a row: the numbers of nodes or elements, and one value of each component. A row of a contact pair goes on with its moments.
    fn add(&mut self, line: &str) -> Option<()> {
        let values: Vec<f64> = line.split_whitespace().map(value_of).collect::<Option<_>>()?;
        let count = self.components.len();
        let own = match values.len() {
            n if n == count || n == count + 1 => &values[n - count..],
            n if n == 2 * count && self.name.ends_with("surface force") => &values[..count],
            _ => return None,
        };
        self.sums.iter_mut().zip(own).for_each(|(sum, value)| *sum += value);
        self.rows += 1;
        own.iter().all(|value| value.is_finite()).then_some(())
    }
}

/// Name, components and the rest of `name (components) rest`.
fn heading(line: &str) -> Option<(&str, &str, &str)> {
    let (name, rest) = line.split_once('(')?;
    let (components, rest) = rest.split_once(')')?;
    Some((name.trim(), components, rest.trim()))
}

/// The table of a `.dat` file. A column is called by what is printed, its set (of contact forces both surfaces) and its component
/// (`velocities NOUTER vz`, `total surface force SLAVE MASTER fz`): the mean over the nodes of the set, or the set's own value
/// where there is one, such as a total force. A block ends where a line begins with a letter; those that belong to no set are
/// skipped.
///
/// # Errors
/// One sentence with the line.
pub(super) fn dat(text: &str) -> Result<String, String> {
    let mut rows = Rows::default();
    let (mut open, mut pair): (Option<PrintedBlock>, _) = (None, None);
    for (number, line) in text.lines().enumerate().map(|(k, line)| (k + 1, line.trim())) {
        if line.starts_with(char::is_alphabetic) {
            rows.close(open.take())?;
            open = PrintedBlock::of(line, &mut pair);
        } else if let Some(block) = open.as_mut().filter(|_| !line.is_empty()) {
            block.add(line).ok_or_else(|| format!("line {number}: `{line}` is no row of {}", block.name))?;
        }
    }
    rows.close(open)?;
    rows.table()
}

/// The table of a `.frd` file in text form: of its columns those that are `requested`, each called by field, node and component
/// (`DISP 12 D2`).
///
/// # Errors
/// One sentence with the line.
pub(super) fn frd(text: &str, requested: &[&str]) -> Result<String, String> {
    let mut rows = Rows::default();
    let (mut time, mut field, mut components) = (0.0, String::new(), Vec::new());
    for (number, line) in text.lines().enumerate() {
        let fault =
            || format!("line {}: `{}` is no line of a .frd file in text form", number + 1, line.trim_end());
        match line.get(..5).map(str::trim) {
            Some("100C") | Some("100") => {
                time = part(line, 12, 12).and_then(value_of).ok_or_else(fault)?;
                field.clear();
            }
            Some("-4") => {
                field = line.split_whitespace().nth(1).ok_or_else(fault)?.to_owned();
                components.clear();
            }
            // a magnitude that a viewer computes is no value of the file
            Some("-5") if line.trim_end().ends_with("ALL") => {}
            Some("-5") => components.push(line.split_whitespace().nth(1).ok_or_else(fault)?.to_owned()),
            Some("-1") if !field.is_empty() => {
                let node = part(line, 3, 10).ok_or_else(fault)?;
                let named =
                    components.iter().map(|component| format!("{field} {node} {component}")).enumerate();
                let own: Vec<_> =
                    named.filter(|(_, heading)| requested.contains(&heading.as_str())).collect();
                let values = match own.is_empty() {
                    true => Vec::new(),
                    false => line.get(13..).and_then(packed).ok_or_else(fault)?,
                };
                let count = components.len().min(PER_LINE);
                for (k, heading) in own {
                    let value = values.get(k).filter(|_| values.len() == count).ok_or_else(|| {
                        format!(
                            "{}: {} values of {count}; one runs into its neighbour",
                            fault(),
                            values.len()
                        )
                    })?;
                    rows.at(time).insert(heading, *value);
                }
            }
            Some("-3") => field.clear(),
            _ => {}
        }
    }
    rows.table()
}

/// Most values in a line of a `.frd` file.
const PER_LINE: usize = 6;

/// The text in `width` columns of a line from `start`.
fn part(line: &str, start: usize, width: usize) -> Option<&str> {
    line.get(start..(start + width).min(line.len())).map(str::trim)
}

#[cfg(test)]
mod tests {
    use super::{dat, frd, packed};

    // three steps of a cube on its base whose top moves downwards, as CalculiX 2.20 writes them
    const DAT: &str = include_str!("../../../tests/fixtures/calculix-box.dat");
    const FRD: &str = include_str!("../../../tests/fixtures/calculix-box.frd");

    #[test]
    fn what_is_printed_becomes_columns_with_means_over_their_sets() {
        let table = dat(DAT).expect("a table");
        let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
        let column = |name: &str| lines[0].iter().position(|heading| *heading == name).expect(name);
        let value = |row: usize, name: &str| lines[row][column(name)].parse::<f64>().expect(name);
        assert_eq!((lines.len(), value(1, "time"), value(3, "time")), (4, 1e-7, 3e-7));
        // four of the eight nodes move
        assert!((value(1, "displacements NALL vz") + 0.5 * 4.391813e-8).abs() < 1e-20);
        assert_eq!(value(2, "total force NFIX fz"), 1.177341e1);
        let half = DAT.find(" total force").expect("there");
        let cut = DAT[..half].to_owned()
            + &DAT[half..].replacen("       -1.110223E-16 -4.440892E-16  1.097562E+01", "", 1);
        assert!(dat(&cut).is_err_and(|reason| reason.contains("0 rows of total force for set NFIX")));
        // a run that was ended while it wrote
        let last = DAT.rfind("         8 ").expect("there");
        assert!(dat(&DAT[..last]).is_err_and(|reason| reason.contains("there are 7 rows of velocities")));
        let wide = DAT.replacen("-3.288653E-01", "*************", 1);
        assert!(
            dat(&wide).is_err_and(
                |reason| reason.starts_with("line 19: ") && reason.contains("no row of velocities")
            )
        );
    }

    /// Blocks of *CONTACT PRINT between those of *NODE PRINT: its forces are columns, its energies belong to no set.
    #[test]
    fn rows_of_contacts_are_no_rows_of_the_set_before() {
        let step = |time: f64, velocity: f64, force: f64| {
            format!(
                " velocities (vx,vy,vz) for set BALL and time  {time:.7E}

         1  0.000000E+00  0.000000E+00 {velocity:.6E}
         2  0.000000E+00  0.000000E+00 {velocity:.6E}

 contact print energy (slave element+face,energy)for all contact elements and time {time:.7E}

         2          1  2.668132E-09
         2          1  1.493433E-09

 total number of contact elements for time  {time:.7E}

                2

 statistics for slave set LOWER, master set UPPER and time  {time:.7E}

   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)

    0.000000E+00  0.000000E+00 {force:.6E}  1.000000E+00  2.000000E+00  3.000000E+00

   center of gravity and mean normal

             NaN           NaN           NaN           NaN           NaN           NaN

 internal energy (element, energy) for set EALL and time  {time:.7E}

         1  1.000000E+00
         2  3.000000E+00

 total internal energy for set EALL and time  {time:.7E}

        4.000000E+00

"
            )
        };
        let table = dat(&(step(1e-7, -1.0, -12.5) + &step(2e-7, -0.5, -25.0))).expect("a table");
        let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let headings = lines.next().expect("headings");
        let of = |name: &str| headings.iter().position(|heading| *heading == name).expect(name);
        for (line, [velocity, force]) in lines.zip([["-1e0", "-1.25e1"], ["-5e-1", "-2.5e1"]]) {
            assert_eq!(line[of("velocities BALL vz")], velocity);
            assert_eq!(line[of("total surface force LOWER UPPER fz")], force);
            assert_eq!(line[of("internal energy EALL energy")], "2e0");
        }
    }

    #[test]
    fn fields_become_columns_of_the_requested_nodes() {
        let table = frd(FRD, &["DISP 5 D3", "VELO 5 V3"]).expect("a table");
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines[..2], ["time,DISP 5 D3,VELO 5 V3", "1e-7,-4.39181e-8,-3.28865e-1"]);
        assert_eq!(lines.len(), 4);
        let damaged = FRD.replacen("-4.39181E-08", "-4.3918xE-08", 1);
        assert!(frd(&damaged, &["DISP 5 D3"]).is_err_and(|reason| reason.starts_with("line 37: ")));
        // three digits of an exponent, as some systems write them: negative values are wider than their columns
        let wide = FRD.replace("E-08", "E-008").replace("E-01", "E-001").replace("E+00", "E+000");
        assert_ne!(wide, FRD);
        assert_eq!(
            frd(&wide.replace(" 0.00000E+000", "0.00000E+000"), &["DISP 5 D3", "VELO 5 V3"]),
            Ok(table)
        );
        let glued = FRD.replacen("-5.94162E-09-4.39181E-08", "-5.94162E-094.39181E-08", 1);
        assert_eq!(packed(" 1.00000E-10-2.00000E-1003.00000E+01"), Some(vec![1e-10, -2e-100, 30.0]));
        assert!(frd(&glued, &["DISP 5 D3"]).is_ok());
        let incomplete = FRD.replacen("-5.94162E-09-4.39181E-08", "-4.39181E-08", 1);
        assert!(frd(&incomplete, &["DISP 5 D3"]).is_err_and(|reason| reason.contains("2 values of 3")));
    }
}
