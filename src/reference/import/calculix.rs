//! CalculiX's results as tables with headings: of what it prints (`.dat`) and of its fields (`.frd`).
//!
//! G. Dhondt, "CalculiX CrunchiX user's manual": \*NODE PRINT writes blocks `displacements (vx,vy,vz) for set N and time T`
//! with a node and its values per line, \*NODE FILE blocks of nodal values in fixed columns.

use std::collections::BTreeMap;
use std::fmt::Write;

/// Values by heading at every time.
#[derive(Default)]
struct Rows(Vec<(f64, BTreeMap<String, f64>)>);

impl Rows {
    /// The values at `time`, which comes after all others or is the last.
    fn at(&mut self, time: f64) -> &mut BTreeMap<String, f64> {
        if self.0.last().is_none_or(|(last, _)| *last != time) {
            self.0.push((time, BTreeMap::new()));
        }
        let last = self.0.len() - 1;
        &mut self.0[last].1
    }

    /// As CSV, with the headings of the last time; the first column is `time`.
    fn table(&self) -> Result<String, String> {
        let headings: Vec<&String> = self.0.last().map(|(_, row)| row.keys().collect()).unwrap_or_default();
        let mut text = String::from("time");
        headings.iter().for_each(|heading| text += &format!(",{heading}"));
        for (time, row) in &self.0 {
            let _ = write!(text, "\n{time:e}");
            for heading in &headings {
                let value = row.get(*heading).ok_or_else(|| format!("there is no {heading} at {time} s"))?;
                let _ = write!(text, ",{value:e}");
            }
        }
        Ok(text)
    }
}

/// The table of a `.dat` file. A column is called by what is printed, its set and its component (`velocities NOUTER vz`):
/// the mean over the nodes of the set, or the set's own value where there is one, such as a total force.
///
/// # Errors
/// One sentence with the line.
pub(super) fn dat(text: &str) -> Result<String, String> {
    let mut rows = Rows::default();
    let mut lines = text.lines().enumerate().peekable();
    while let Some((_, line)) = lines.next() {
        let Some((name, components, set, time)) = block(line) else { continue };
        let (mut sums, mut count) = (vec![0.0; components.len()], 0);
        while let Some((number, line)) = lines.next_if(|(_, line)| block(line).is_none()) {
            let values: Option<Vec<f64>> = line.split_whitespace().map(|word| word.parse().ok()).collect();
            // what is printed between the blocks is no row of this one
            let Some(values) = values.filter(|values| values.len() >= components.len()) else { continue };
            let own = &values[values.len() - components.len()..];
            if values.len() > components.len() + 1 || own.iter().any(|value| !value.is_finite()) {
                return Err(format!("line {}: `{}` is no row of {name}", number + 1, line.trim()));
            }
            sums.iter_mut().zip(own).for_each(|(sum, value)| *sum += value);
            count += 1;
        }
        if count == 0 {
            return Err(format!("there are no values of {name} for set {set} at {time} s"));
        }
        let row = rows.at(time);
        for (component, sum) in components.iter().zip(sums) {
            row.insert(format!("{name} {set} {component}"), sum / f64::from(count));
        }
    }
    rows.table()
}

/// Name, components, set and time of a block's first line.
fn block(line: &str) -> Option<(&str, Vec<&str>, &str, f64)> {
    let (what, rest) = line.trim().split_once(") for set ")?;
    let (name, components) = what.split_once(" (")?;
    let (set, time) = rest.split_once(" and time")?;
    Some((name, components.split(',').collect(), set.trim(), time.trim().parse().ok()?))
}

/// The table of a `.frd` file in text form: of its columns those that are `wanted`, each called by field, node and component
/// (`DISP 12 D2`).
///
/// # Errors
/// One sentence with the line.
pub(super) fn frd(text: &str, wanted: &[&str]) -> Result<String, String> {
    let mut rows = Rows::default();
    let (mut time, mut field, mut components) = (0.0, String::new(), Vec::new());
    for (number, line) in text.lines().enumerate() {
        let fault =
            || format!("line {}: `{}` is no line of a .frd file in text form", number + 1, line.trim_end());
        match line.get(..5).map(str::trim) {
            Some("100C") | Some("100") => {
                time = part(line, 12, 12).and_then(|text| text.parse().ok()).ok_or_else(fault)?;
                field.clear();
            }
            Some("-4") => {
                field = line.split_whitespace().nth(1).ok_or_else(fault)?.to_owned();
                components.clear();
            }
            Some("-5") => components.push(line.split_whitespace().nth(1).ok_or_else(fault)?.to_owned()),
            Some("-1") if !field.is_empty() => {
                let node = part(line, 3, 10).ok_or_else(fault)?;
                for (k, component) in components.iter().enumerate() {
                    let heading = format!("{field} {node} {component}");
                    if wanted.contains(&heading.as_str()) {
                        let value = part(line, 13 + 12 * k, 12).and_then(|text| text.parse().ok());
                        rows.at(time).insert(heading, value.ok_or_else(fault)?);
                    }
                }
            }
            Some("-3") => field.clear(),
            _ => {}
        }
    }
    rows.table()
}

/// The text in `width` columns of a line from `start`.
fn part(line: &str, start: usize, width: usize) -> Option<&str> {
    line.get(start..(start + width).min(line.len())).map(str::trim)
}

#[cfg(test)]
mod tests {
    use super::{dat, frd};

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
        let cut = DAT[..half].to_owned() + &DAT[half..].replacen("1.097562E+01", "", 1);
        assert!(dat(&cut).is_err_and(|reason| reason.contains("no values of total force for set NFIX")));
    }

    #[test]
    fn fields_become_columns_of_the_nodes_wanted() {
        let table = frd(FRD, &["DISP 5 D3", "VELO 5 V3"]).expect("a table");
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines[..2], ["time,DISP 5 D3,VELO 5 V3", "1e-7,-4.39181e-8,-3.28865e-1"]);
        assert_eq!(lines.len(), 4);
        let damaged = FRD.replacen("-4.39181E-08", "-4.3918xE-08", 1);
        assert!(frd(&damaged, &["DISP 5 D3"]).is_err_and(|reason| reason.starts_with("line 37: ")));
    }
}
