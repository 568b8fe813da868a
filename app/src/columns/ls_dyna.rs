//! Time histories that LS-DYNA writes as text: `nodout`, `rcforc`, `matsum` and `glstat`.
//!
//! They come in blocks, one per time. The numbers have no units: a map names them.

use super::blocks::Blocks;
use super::channels::RawChannel;
use super::rows::{number, packed};

/// Lines in which the first block has to begin; titles of parts and contacts stand before it.
const HEAD: usize = 5000;
/// Beginnings of a line of `rcforc`: both sides of a contact, in older and newer versions.
const SIDES: [&str; 4] = ["slave", "master", "surfa", "surfb"];

/// A file of LS-DYNA.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DynaFile {
    /// Motion of nodes.
    Nodout,
    /// Forces of contacts.
    Rcforc,
    /// Energies, momenta and rigid-body velocities of parts.
    Matsum,
    /// Energies and velocities of the model.
    Glstat,
}

impl DynaFile {
    /// The file that `text` is, by the form of its first block.
    pub(super) fn of(text: &str) -> Option<Self> {
        text.lines().take(HEAD).find_map(|line| match line.trim_start() {
            _ if is_nodes(line) => Some(Self::Nodout),
            _ if contact(line).is_some() => Some(Self::Rcforc),
            line if line.starts_with("mat.#=") => Some(Self::Matsum),
            line if line.starts_with("time...") => Some(Self::Glstat),
            _ => None,
        })
    }

    /// Its name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Nodout => "LS-DYNA nodout",
            Self::Rcforc => "LS-DYNA rcforc",
            Self::Matsum => "LS-DYNA matsum",
            Self::Glstat => "LS-DYNA glstat",
        }
    }

    /// The time and the channels in `text`: `node 5 z-vel`, `slave 1 z`, `part 2 z-rbv`, `global z velocity`.
    ///
    /// # Errors
    /// One sentence with the line.
    pub(super) fn channels(self, text: &str) -> Result<Vec<RawChannel>, String> {
        let mut blocks = Blocks::default();
        let mut state = BlockState::default();
        for (k, line) in text.lines().enumerate() {
            let read = match self {
                Self::Nodout => state.node(line, &mut blocks),
                Self::Rcforc => of_contact(line, &mut blocks),
                Self::Matsum => state.part(line, &mut blocks),
                Self::Glstat => of_model(line, &mut blocks),
            };
            read.map_err(|reason| format!("line {}: {reason}", k + 1))?;
        }
        blocks.channels()
    }
}

/// What the lines before say of the next one.
#[derive(Default)]
struct BlockState {
    /// Headings of the numbers of a node.
    headings: Vec<String>,
    /// Number of the part.
    part: String,
}

/// Whether a line begins a block of nodes: "n o d a l   p r i n t   o u t   f o r   t i m e  s t e p", however it is spaced.
fn is_nodes(line: &str) -> bool {
    let close: String = line.chars().filter(|c| !c.is_whitespace()).take(24).collect();
    close.starts_with("nodalprintoutfortimestep")
}

/// Side and number of the contact, and what follows, in a line of `rcforc`.
fn contact(line: &str) -> Option<(&str, &str, impl Iterator<Item = &str>)> {
    let mut cells = line.split_whitespace();
    let side = cells.next().filter(|side| SIDES.contains(side))?;
    let number = cells.next().filter(|number| number.bytes().all(|b| b.is_ascii_digit()))?;
    cells.next().filter(|word| *word == "time")?;
    Some((side, number, cells))
}

fn of_contact(line: &str, blocks: &mut Blocks) -> Result<(), String> {
    let Some((side, contact, mut cells)) = contact(line) else { return Ok(()) };
    blocks.at(required(cells.next().unwrap_or_default(), "time")?)?;
    while let (Some(name), Some(cell)) = (cells.next(), cells.next()) {
        blocks.set(&format!("{side} {contact} {name}"), required(cell, name)?);
    }
    Ok(())
}

/// "name......   value".
fn of_model(line: &str, blocks: &mut Blocks) -> Result<(), String> {
    let Some((name, rest)) = line.split_once("...") else { return Ok(()) };
    let Some(value) = number(rest.trim_start_matches('.').trim()) else { return Ok(()) };
    match name.trim() {
        "time" => blocks.at(value),
        name => {
            blocks.set(name, value);
            Ok(())
        }
    }
}

impl BlockState {
    fn node(&mut self, line: &str, blocks: &mut Blocks) -> Result<(), String> {
        if is_nodes(line) {
            let time = line.rsplit_once("at time").map(|(_, time)| time.trim_matches([' ', ')']));
            return blocks.at(required(time.unwrap_or_default(), "time")?);
        }
        if let Some((_, headings)) = line.split_once("nodal point") {
            self.headings = headings.split_whitespace().map(str::to_owned).collect();
            return Ok(());
        }
        let Some((node, rest)) = line.trim_start().split_once(char::is_whitespace) else { return Ok(()) };
        if self.headings.is_empty() || !node.bytes().all(|byte| byte.is_ascii_digit()) {
            return Ok(());
        }
        let values = packed(rest).ok_or_else(|| format!("node {node} has `{}`, not numbers", rest.trim()))?;
        if values.len() != self.headings.len() {
            return Err(format!("node {node} has {} values of {}", values.len(), self.headings.len()));
        }
        for (heading, value) in self.headings.iter().zip(values) {
            blocks.set(&format!("node {node} {heading}"), value);
        }
        Ok(())
    }

    /// "name=   value", several in a line.
    fn part(&mut self, line: &str, blocks: &mut Blocks) -> Result<(), String> {
        let mut parts = line.split('=');
        let mut name = parts.next().unwrap_or_default().trim();
        for part in parts {
            let (value, next) = part.trim().split_once(char::is_whitespace).unwrap_or((part.trim(), ""));
            match name {
                "time" => blocks.at(required(value, name)?)?,
                "mat.#" => value.clone_into(&mut self.part),
                _ if self.part.is_empty() => {}
                _ => blocks.set(&format!("part {} {name}", self.part), required(value, name)?),
            }
            name = next.trim();
        }
        Ok(())
    }
}

/// The number in a cell.
fn required(cell: &str, name: &str) -> Result<f64, String> {
    number(cell)
        .filter(|number| number.is_finite())
        .ok_or_else(|| format!("{name} is `{cell}`, not a finite number"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str, file: DynaFile, name: &str, k: usize) -> (f64, f64) {
        assert_eq!(DynaFile::of(text), Some(file));
        let channels = file.channels(text).expect("channels");
        let names: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).collect();
        let found = channels.iter().find(|channel| channel.name == name);
        let found = found.unwrap_or_else(|| panic!("{name} of {names:?}"));
        assert_eq!(names[0], "time");
        (channels[0].values[k], found.values[k])
    }

    /// Two nodes and a block of rotations, whose time is that of the one before; numbers without a space between them.
    #[test]
    fn nodes_are_read() {
        let block = |step: u32, time: &str, velocity: &str| {
            format!(
                "\n\n n o d a l   p r i n t   o u t   f o r   t i m e  s t e p{step:8}                              ( at time {time} )\n\n \
                 nodal point  x-disp     y-disp      z-disp      x-vel       y-vel       z-vel\n        \
                 5  0.0000E+00  0.0000E+00-1.0000E-04  0.0000E+00-1.5000-101{velocity}\n       \
                 12  0.0000E+00  0.0000E+00  2.0000E-04  0.0000E+00  0.0000E+00  3.0000E+00\n\n\n \
                 n o d a l   p r i n t   o u t   f o r   t i m e  s t e p{step:8}                              ( at time {time} )\n\n \
                 nodal point  x-rot      y-rot       z-rot\n        5  1.0000E+00  2.0000E+00  4.0000E+00\n"
            )
        };
        let text = format!(
            " ls-dyna of mine\n ls-dyna smp\n{{BEGIN LEGEND}}\n{{END LEGEND}}{}{}",
            block(1, "0.0000000E+00", " -5.5000E-01"),
            block(2, "1.0000000E-06", "-5.4000E-01")
        );
        assert_eq!(value(&text, DynaFile::Nodout, "node 5 z-vel", 1), (1e-6, -0.54));
        assert_eq!(value(&text, DynaFile::Nodout, "node 5 y-vel", 0), (0.0, -1.5e-101));
        assert_eq!(value(&text, DynaFile::Nodout, "node 12 z-disp", 0), (0.0, 2e-4));
        assert_eq!(value(&text, DynaFile::Nodout, "node 5 z-rot", 1), (1e-6, 4.0));
        let cut = text.replace("  3.0000E+00", "");
        let refused = DynaFile::Nodout.channels(&cut).expect_err("a value less");
        assert!(refused.contains("line 10: node 12 has 5 values of 6"), "{refused}");
    }

    #[test]
    fn contacts_of_old_and_new_versions_are_read() {
        for side in ["slave", "surfa"] {
            let text = format!(
                "{{BEGIN LEGEND}}\n  Entity #        Title\n         1     tip\n{{END LEGEND}}\n\n \
                 {side}          1 time  0.00000E+00  x   0.00000E+00  y   0.00000E+00  z   1.00000E+00  mass  0.00000E+00\n \
                 master         1 time  0.00000E+00  x   0.00000E+00  y   0.00000E+00  z  -1.00000E+00  mass  0.00000E+00\n \
                 {side}          1 time  2.00000E-06  x   0.00000E+00  y   0.00000E+00  z   7.50000E+02  mass  0.00000E+00\n"
            );
            assert_eq!(value(&text, DynaFile::Rcforc, &format!("{side} 1 z"), 1), (2e-6, 750.0));
            // a side that ends early has no values then
            assert!(value(&text, DynaFile::Rcforc, "master 1 z", 1).1.is_nan());
        }
    }

    #[test]
    fn parts_and_the_model_are_read() {
        let text = " {BEGIN LEGEND}\n  1  ball\n {END LEGEND}\n\n time =   0.0000E+00\n \
                    mat.#=    1             inten=   8.0000E+02     kinen=   1.5000E+00     eroded_ie=   0.0000E+00\n \
                    x-mom=   0.0000E+00     y-mom=   0.0000E+00     z-mom=  -1.0000E-02\n \
                    x-rbv=   0.0000E+00     y-rbv=   0.0000E+00     z-rbv=  -5.5000E-01\n                          \
                    hgeng=   0.0000E+00     +mass=   0.0000E+00\n\n time =   1.0000E-03\n \
                    mat.#=    1             inten=   8.0000E+02     kinen=   1.5000E+00\n \
                    x-rbv=   0.0000E+00     y-rbv=   0.0000E+00     z-rbv=  -2.5000E-01\n";
        assert_eq!(value(text, DynaFile::Matsum, "part 1 z-rbv", 1), (1e-3, -0.25));
        assert_eq!(value(text, DynaFile::Matsum, "part 1 kinen", 0), (0.0, 1.5));
        let text = " dt of cycle        1 is controlled by solid         7\n\n \
                    time...........................   0.00000E+00\n time step......................   1.00000E-08\n \
                    kinetic energy.................   4.90000E-03\n global z velocity..............  -5.50000E-01\n\n \
                    dt of cycle       99 is controlled by solid         7\n\n \
                    time...........................   1.00000E-06\n global z velocity..............  -5.25000E-01\n";
        assert_eq!(value(text, DynaFile::Glstat, "global z velocity", 1), (1e-6, -0.525));
    }

    #[test]
    fn other_texts_are_no_files_of_ls_dyna() {
        for text in ["time,v\n0,1\n1,2\n", "time = 3\nt v\n0 1\n", "master plan\n1 2\n", "nodal point  x\n"] {
            assert_eq!(DynaFile::of(text), None, "{text}");
        }
    }
}
