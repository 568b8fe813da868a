//! What another program answers: a JSON document with quantities and curves, or a table of curves.

use crate::columns::{self, Columns};
use crate::kinds::{self, Kind};
use crate::result::{Curve, History, SCHEMA_VERSION, Source, Summary, Table};
use crate::scene::{Scene, suggestion};
use serde_json::{Map, Value};

/// Most samples of a history.
const MOST_SAMPLES: usize = 2_000_000;
/// Fewest of them.
const FEWEST_SAMPLES: usize = 2;
/// The numbers of an answer besides its quantities.
pub(super) const NUMBERS: [&str; 4] = ["energy_residual", "momentum_residual", "steps", "modes"];
/// Characters of a text that are shown.
const SHOWN: usize = 60;

/// Reads what the program `name` answered to `scene`: a summary without wall time, and the curves it gives.
///
/// # Errors
/// One sentence that says what is wrong with it.
pub fn read(scene: &Scene, name: &str, text: &[u8]) -> Result<(Summary, History), String> {
    let kind = kinds::of(scene);
    let text = std::str::from_utf8(text).map_err(|e| format!("it is no text in UTF-8: {e}"))?;
    let text = text.trim_start_matches('\u{feff}').trim();
    if text.is_empty() {
        return Err("it is empty".into());
    }
    if text.starts_with('{') {
        return document(scene, name, text);
    }
    if let Some(what) = not_an_object(text) {
        return Err(format!("it is a JSON {what}, not an object"));
    }
    let history = rows(kind, text)?;
    Ok((summary(scene, name, Table::new(kind.quantities()), &history), history))
}

/// A summary with the quantities `stated`, and those that the curves show where nothing is stated.
pub fn summary(scene: &Scene, name: &str, stated: Table, history: &History) -> Summary {
    let mut table = kinds::of(scene).shown(scene, history);
    for quantity in stated.iter() {
        if let (Some(slot), Some(_)) = (table.value_mut(quantity.name), quantity.value) {
            *slot = quantity.value;
        }
    }
    Summary::new(scene, (Source::External, Some(name.to_owned())), table)
}

/// What a JSON document is that is no object; `None` of what is no document.
fn not_an_object(text: &str) -> Option<&'static str> {
    match serde_json::from_str(text).ok()? {
        Value::Array(_) => Some("list"),
        Value::String(_) => Some("string"),
        Value::Null => Some("null"),
        Value::Bool(_) => Some("boolean"),
        Value::Number(_) => Some("number"),
        Value::Object(_) => None,
    }
}

fn document(scene: &Scene, name: &str, text: &str) -> Result<(Summary, History), String> {
    let document: Value = serde_json::from_str(text).map_err(|error| syntax(text, &error))?;
    match &document["schema_version"] {
        Value::Null => {}
        version if *version == SCHEMA_VERSION => {}
        version => {
            return Err(format!("its schema_version is {version}; this program reads {SCHEMA_VERSION}"));
        }
    }
    if let Some(Value::String(hash)) = document.get("scene_hash")
        && *hash != scene.hash()
    {
        return Err(format!("its scene_hash is {hash}, that of the scene is {}", scene.hash()));
    }
    let kind = kinds::of(scene);
    let history = match &document["history"] {
        Value::Null => History::default(),
        Value::Object(curves) => history(kind, curves)?,
        other => return Err(format!("its history is {}, not an object of curves", shown(other))),
    };
    let missing_is_null = |quantity: &&str| document.get(*quantity).is_none();
    let mut whole = document.clone();
    for quantity in kind.quantities().iter().map(|quantity| quantity.name).filter(missing_is_null) {
        whole[quantity] = Value::Null;
    }
    let summary = summary(scene, name, Table::read(kind.quantities(), &whole)?, &history);
    let number = |key: &str| match &document[key] {
        Value::Null => Ok(None),
        value => {
            value.as_f64().map(Some).ok_or_else(|| format!("its {key} is {}, not a number", shown(value)))
        }
    };
    let [energy_residual, momentum_residual, steps, modes] = NUMBERS.map(number);
    let summary = Summary {
        energy_residual: energy_residual?,
        momentum_residual: momentum_residual?,
        steps: steps?.map(|steps| steps as u64),
        modes: modes?.map(|modes| modes as usize),
        warnings: warnings(kind, &document),
        ..summary
    };
    Ok((summary, history))
}

/// What the program warns of, and what of its answer is not used although it looks as if it should be.
fn warnings(kind: &dyn Kind, document: &Value) -> Vec<String> {
    let own = document["warnings"].as_array().into_iter().flatten();
    let own = own.filter_map(Value::as_str).map(str::to_owned);
    let known: Vec<&str> =
        kind.quantities().iter().map(|q| q.name).chain(NUMBERS).chain(["history", "warnings"]).collect();
    let keys = document.as_object().into_iter().flat_map(Map::keys);
    let near = keys.filter(|key| !known.contains(&key.as_str())).filter_map(|key| {
        let near = suggestion(key, known.iter().copied())?;
        Some(format!("`{key}` is not known and is not used; did you mean `{near}`?"))
    });
    own.chain(near).collect()
}

/// The curves of a document's `history`.
fn history(kind: &dyn Kind, curves: &Map<String, Value>) -> Result<History, String> {
    for name in curves.keys() {
        columns::known_column(name, kind.curves()).map_err(|reason| format!("its history: {reason}"))?;
    }
    let values = |name: &str| -> Result<Option<Vec<f64>>, String> {
        let Some(found) = curves.get(name) else { return Ok(None) };
        let list = found.as_array().ok_or_else(|| format!("its history: {name} is no list of numbers"))?;
        let number = |(k, value): (usize, &Value)| {
            value.as_f64().ok_or_else(|| {
                format!("its history: sample {} of {name} is {}, not a number", k + 1, shown(value))
            })
        };
        list.iter().enumerate().map(number).collect::<Result<_, _>>().map(Some)
    };
    let time = values("time")?.ok_or("its history has no `time`")?;
    let mut given = Vec::new();
    for curve in kind.curves() {
        if let Some(values) = values(curve.name)? {
            given.push((curve.name, values));
        }
    }
    assembled(kind, Columns { time, values: given, gaps: Vec::new(), integrals: Vec::new() })
        .map_err(|reason| format!("its history: {reason}"))
}

/// The curves of a table.
fn rows(kind: &dyn Kind, text: &str) -> Result<History, String> {
    let first = text.lines().next().unwrap_or_default();
    if !first.contains(',') {
        return Err(format!(
            "it begins with `{}`, which is neither a JSON document nor a table of curves; messages belong on standard error",
            first.chars().take(SHOWN).collect::<String>()
        ));
    }
    assembled(kind, columns::read(text, &columns::Map::default(), kind.curves(), FEWEST_SAMPLES)?.columns)
}

/// A history of these columns that can be sampled, its curves in the order of their kind.
///
/// # Errors
/// One sentence that says what is wrong with them.
pub fn assembled(kind: &dyn Kind, Columns { time, values, gaps, .. }: Columns) -> Result<History, String> {
    let samples = time.len();
    if let Some((name, [from, _])) = gaps.first() {
        return Err(format!("{name} has no value at {from} s"));
    }
    if !(FEWEST_SAMPLES..=MOST_SAMPLES).contains(&samples) {
        return Err(format!(
            "there are {samples} samples; there have to be {FEWEST_SAMPLES} to {MOST_SAMPLES}"
        ));
    }
    if let Some(k) = (1..samples).find(|&k| time[k] <= time[k - 1]) {
        let (before, now) = (time[k - 1], time[k]);
        return Err(format!("sample {} is at {now} s, not after {before} s of the one before", k + 1));
    }
    if let Some((name, values)) = values.iter().find(|(_, values)| values.len() != samples) {
        return Err(format!("{name} has {} samples, time has {samples}", values.len()));
    }
    let of = |curve: &Curve| {
        let (_, values) = values.iter().find(|(name, _)| *name == curve.name)?;
        Some(Curve { values: values.clone(), ..curve.clone() })
    };
    Ok(History { curves: kind.curves().iter().filter_map(of).collect(), time })
}

fn syntax(text: &str, error: &serde_json::Error) -> String {
    if error.is_eof() {
        return "it ends in the middle of a JSON document".into();
    }
    let line = text.lines().nth(error.line().saturating_sub(1)).unwrap_or_default();
    let at: String = line.chars().skip(error.column().saturating_sub(1)).take(SHOWN).collect();
    let help = match ["NaN", "aN", "Inf", "-Inf", "nan", "inf"].iter().any(|word| at.starts_with(word)) {
        true => "; JSON has no NaN and no infinity: write null for what is not determined",
        false => "; the document must be all of the standard output, messages belong on standard error",
    };
    format!("it is no JSON document: {error}, at `{at}`{help}")
}

fn shown(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() > SHOWN {
        format!("{}...", text.chars().take(SHOWN).collect::<String>())
    } else {
        text
    }
}
