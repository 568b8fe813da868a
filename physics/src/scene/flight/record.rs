//! The record of an acceleration in a file of its own: `vibration.file`.

use super::keys::MOST_SAMPLES;
use crate::scene::quantity::{Dimension, in_unit};
use crate::scene::read::MAX_FILE_BYTES;
use crate::scene::values::{Checked, Values};
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

/// Its columns with their SI units, in any order.
const COLUMNS: [(&str, Dimension); 2] =
    [("time", Dimension::TIME), ("acceleration", Dimension::ACCELERATION)];

/// Puts what the file named by `vibration.file` says in the place of `vibration.time` and `vibration.acceleration`; a relative name is one
/// beside the scene file `source_name`.
///
/// # Errors
/// A clause about the file, with line and value.
pub(in crate::scene) fn with_record(values: &mut Values, source_name: &str) -> Result<(), String> {
    let Some(Checked::Table(vibration)) = values.get_mut("vibration") else { return Ok(()) };
    let vibration = Arc::make_mut(vibration);
    let Some(Checked::Text(name)) = vibration.remove("file") else { return Ok(()) };
    let path = Path::new(source_name).parent().unwrap_or(Path::new("")).join(&name);
    let text = text_of(&path).map_err(|why| format!("`vibration.file` is \"{name}\", {why}"))?;
    let samples = samples(&text).map_err(|why| format!("`vibration.file` is \"{name}\", {why}"))?;
    for ((key, _), samples) in COLUMNS.iter().zip(samples) {
        vibration.insert((*key).to_owned(), Checked::Numbers(samples));
    }
    Ok(())
}

fn text_of(path: &Path) -> Result<String, String> {
    let refused = |error: std::io::Error| format!("but \"{}\" can't be read: {error}", path.display());
    // before it is opened, for which a pipe would wait
    let metadata = std::fs::metadata(path).map_err(refused)?;
    if !metadata.is_file() {
        return Err(format!("but \"{}\" is no file", path.display()));
    }
    if metadata.len() > MAX_FILE_BYTES {
        return Err(format!("which has {} bytes; a record has at most {MAX_FILE_BYTES}", metadata.len()));
    }
    let mut text = String::new();
    File::open(path).map_err(refused)?.take(MAX_FILE_BYTES).read_to_string(&mut text).map_err(refused)?;
    Ok(text)
}

/// Times and accelerations in SI of a table in CSV with a heading like `time [ms],acceleration [m/s^2]`; without unit a column is in SI.
fn samples(text: &str) -> Result<[Vec<f64>; 2], String> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let heading: Vec<&str> = lines.next().map_or_else(Vec::new, |(_, line)| line.split(',').collect());
    let columns = [column(&heading, COLUMNS[0])?, column(&heading, COLUMNS[1])?];
    let mut samples = [Vec::new(), Vec::new()];
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        for (samples, (index, factor, dimension)) in samples.iter_mut().zip(columns) {
            let cell = cells.get(index).copied().unwrap_or_default();
            let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
            let value = value.ok_or_else(|| format!("line {}: `{cell}` is not a number", number + 1))?;
            let value = factor * value;
            if !dimension.is_plausible(value) {
                let ([low, high], (what, unit, _)) = (dimension.span(), dimension.describe());
                return Err(format!(
                    "line {}: `{cell}` is {value:e} {unit}, but {what} has to lie between {low:e} and {high:e} {unit}",
                    number + 1
                ));
            }
            samples.push(value);
        }
        if samples[0].len() > MOST_SAMPLES {
            return Err(format!("which has more samples than {MOST_SAMPLES}"));
        }
    }
    Ok(samples)
}

/// Where the column called `name` stands in a `heading`, and the size of its unit in SI.
fn column(heading: &[&str], (name, dimension): (&str, Dimension)) -> Result<(usize, f64, Dimension), String> {
    let si = dimension.describe().1;
    let split = |heading: &&str| {
        // spreadsheets put headings into quotes, and a mark of the byte order before the first
        let heading = heading.trim_start_matches('\u{feff}').trim().trim_matches('"');
        match heading.split_once('[') {
            Some((name, unit)) => (name.trim().to_owned(), unit.trim_end_matches(']').trim().to_owned()),
            None => (heading.trim().to_owned(), si.to_owned()),
        }
    };
    let mut found = heading.iter().map(split).enumerate().filter(|(_, (found, _))| found == name);
    let (index, (_, unit)) = found.next().ok_or_else(|| {
        format!("line 1: there is no column `{name}`; the heading is like `time [ms],acceleration [m/s^2]`")
    })?;
    if found.next().is_some() {
        return Err(format!("line 1: there are two columns `{name}`"));
    }
    let factor =
        in_unit(&format!("1 {unit}"), si).map_err(|why| format!("line 1: column `{name}`: {why}"))?;
    Ok((index, factor, dimension))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Scene, Template};

    #[test]
    fn columns_have_their_units_in_any_order() {
        let found = samples("acceleration [km/s^2], time [ms]\n 0,0\n-1.5,0.25\n\n3,1\n").unwrap();
        assert_eq!(found, [vec![0.0, 0.25e-3, 1e-3], vec![0.0, -1.5e3, 3e3]]);
        let of_a_spreadsheet = "\u{feff}\"time [ms]\",\"acceleration\"\n0,1\n2e3,3";
        assert_eq!(samples(of_a_spreadsheet).unwrap(), [vec![0.0, 2.0], vec![1.0, 3.0]]);
        assert_eq!(samples("time,acceleration\n0,1\n2,3").unwrap(), [vec![0.0, 2.0], vec![1.0, 3.0]]);
    }

    /// A file beside the scene is what the lists are, and a fault of it has its place in the scene.
    #[test]
    fn a_scene_names_its_record() {
        let folder = tempfile::tempdir().unwrap();
        let scene = |record: &str| {
            let text = include_str!("../../../../scenes/examples/valve-flight.toml");
            let text = text.replace("kind     = \"half-sine\"\nduration = \"2 ms\"", record);
            let path = folder.path().join("shaken.toml");
            std::fs::write(&path, text).unwrap();
            Scene::read(&path)
        };
        std::fs::write(folder.path().join("shock.csv"), "time [ms],acceleration\n0,0\n1,3\n2,0\n").unwrap();
        let of_file = scene("kind = \"record\"\nfile = \"shock.csv\"").unwrap();
        let lists = "kind = \"record\"\ntime = [0, \"1 ms\", \"2 ms\"]\nacceleration = [0, 3, 0]";
        assert_eq!(of_file.vibration, scene(lists).unwrap().vibration);
        let message = |record: &str| scene(record).unwrap_err().to_string();
        // what is written anew elsewhere takes the record with it
        scene("kind = \"record\"\nfile = \"shock.csv\"").unwrap();
        let template = Template::read(folder.path().join("shaken.toml")).unwrap();
        let speed = template.field("actuator.speed").unwrap();
        let elsewhere = template.text_with("faster", &[(&speed, 2.0)]).unwrap();
        assert_eq!(Scene::parse("nowhere/else.toml", &elsewhere).unwrap().vibration, of_file.vibration);
        let still = message("kind = \"record\"\ntime = [0, 1]\nacceleration = [0, 0]");
        assert!(still.contains("`vibration.acceleration` is 0 m/s^2 throughout"), "{still}");
        let both = message(&format!("{lists}\nfile = \"shock.csv\""));
        assert!(both.contains("one too many"), "{both}");
        let missing = message("kind = \"record\"\nfile = \"other.csv\"");
        assert!(
            missing.contains("`vibration.file` is \"other.csv\"") && missing.contains("read"),
            "{missing}"
        );
        std::fs::write(folder.path().join("back.csv"), "time,acceleration\n0,0\n2,1\n1,0\n").unwrap();
        let back = message("kind = \"record\"\nfile = \"back.csv\"");
        assert!(back.contains("ascend"), "{back}");
    }

    #[test]
    fn an_invalid_record_is_reported_with_its_line() {
        for (text, expected) in [
            ("", "line 1: there is no column `time`"),
            ("time,force\n0,1", "there is no column `acceleration`"),
            ("time [mm],acceleration\n0,1", "column `time`: `mm` is the unit of something else"),
            ("time,acceleration\n0,1\n1,fast", "line 3: `fast` is not a number"),
            ("time,acceleration\n0,1\n1", "line 3: `` is not a number"),
            ("time,acceleration,time\n0,1,2", "line 1: there are two columns `time`"),
            ("time,acceleration [km/s^2]\n0,1e306", "line 2: `1e306` is inf m/s^2, but"),
            ("time,acceleration\n1e-15,1", "a time has to lie between 1e-12 and 1e6 s"),
            ("time,acceleration\n0,NaN", "line 2: `NaN` is not a number"),
        ] {
            let error = samples(text).unwrap_err();
            assert!(error.contains(expected), "{text:?}: {error}");
        }
        assert!(text_of(Path::new("/nowhere/shock.csv")).unwrap_err().contains("can't be read"));
        assert!(text_of(Path::new("/")).unwrap_err().contains("no file"));
    }
}
