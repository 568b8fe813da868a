//! Tolerances that were changed in the scene file since they were accepted with a reason.

use super::acceptance::{Acceptance, Standing};
use super::tolerance_edit::shown;
use crate::comparison::ChangedTolerance;
use crate::error::{Error, Result};
use crate::scene::Scene;
use std::path::Path;
use toml_edit::{DocumentMut, Item, Table};

/// The tolerances in the text of a scene file.
///
/// # Errors
/// [`Error::Usage`] if it is not TOML.
pub fn standing(text: &str) -> Result<Standing> {
    let document = parsed(text)?;
    let models = document.get("tolerances").and_then(Item::as_table_like);
    let of_model = |(model, item): (&str, &Item)| {
        let table = item.as_table_like()?;
        let tolerances = table.iter().map(|(quantity, item)| (quantity.to_owned(), shown(item)));
        Some((model.to_owned(), tolerances.collect()))
    };
    Ok(models.into_iter().flat_map(|models| models.iter().filter_map(of_model)).collect())
}

/// The tolerances accepted last, oldest record first.
fn accepted(record: &[Acceptance]) -> Standing {
    let mut accepted = Standing::new();
    for entry in record {
        // records of earlier versions of this program name only what was changed
        if !entry.standing.is_empty() {
            accepted.clone_from(&entry.standing);
        }
        for change in &entry.tolerances {
            let of_model = accepted.entry(change.model.clone()).or_default();
            match &*change.to {
                REMOVED => drop(of_model.remove(&change.quantity)),
                to => drop(of_model.insert(change.quantity.clone(), to.to_owned())),
            }
        }
    }
    accepted
}

/// What is recorded in the place of a tolerance that was removed.
pub const REMOVED: &str = "none";

/// The tolerances of the scene file `text`, which is that of `file`, that mean something else than those accepted last. How a number is written
/// does not count; tolerances that were never accepted are new, not changed.
///
/// # Errors
/// [`Error::Usage`] if `text` is not TOML, [`Error::Scene`] if it is no scene.
pub fn changed(record: &[Acceptance], file: &Path, text: &str) -> Result<Vec<ChangedTolerance>> {
    let accepted = accepted(record);
    if accepted.is_empty() {
        return Ok(Vec::new());
    }
    let (scene, standing) = (Scene::parse(&file.display().to_string(), text)?, standing(text)?);
    let mut found = Vec::new();
    for (model, tolerances) in &accepted {
        for (quantity, before) in tolerances {
            let now = standing.get(model).and_then(|of_model| of_model.get(quantity));
            let meant = |scene: &Scene| {
                scene.tolerances.get(model).and_then(|tolerances| tolerances.get(quantity).copied())
            };
            // one at a time: another that can't be read any more must not hide this one
            let same = now.is_some_and(|now| {
                now == before
                    || with(text, model, quantity, before)
                        .and_then(|text| Scene::parse(&file.display().to_string(), &text))
                        .is_ok_and(|old| meant(&old) == meant(&scene))
            });
            if !same {
                found.push(ChangedTolerance {
                    model: model.clone(),
                    quantity: quantity.clone(),
                    accepted: before.clone(),
                    now: now.cloned(),
                });
            }
        }
    }
    Ok(found)
}

/// The text with another tolerance.
fn with(text: &str, model: &str, quantity: &str, tolerance: &str) -> Result<String> {
    let mut document = parsed(text)?;
    let value: toml_edit::Value =
        tolerance.parse().map_err(|e| Error::Usage(format!("`{tolerance}` is no tolerance: {e}")))?;
    let models = document.entry("tolerances").or_insert(Item::Table(Table::new()));
    let of_model = models.as_table_like_mut().and_then(|models| models.get_mut(model)?.as_table_like_mut());
    if let Some(of_model) = of_model {
        of_model.insert(quantity, Item::Value(value));
    }
    Ok(document.to_string())
}

fn parsed(text: &str) -> Result<DocumentMut> {
    text.parse().map_err(|e| Error::Usage(format!("the scene file can't be read as TOML: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ci::acceptance::{AcceptedReference, ToleranceChange};
    use std::collections::BTreeMap;

    const SCENE: &str = include_str!("../../../scenes/scaled-plate-r10.toml");

    fn entry(standing: Standing, tolerances: Vec<ToleranceChange>) -> Acceptance {
        let reference = AcceptedReference {
            scene_hash: String::new(),
            resolution: "paper".to_owned(),
            quantities: BTreeMap::new(),
        };
        Acceptance {
            date: "2026-01-01".to_owned(),
            reason: "test".to_owned(),
            tolerances,
            reference,
            standing,
        }
    }

    fn with_c(text: &str) -> String {
        let (before, _) = SCENE.split_once("[tolerances.A]").expect("tolerances");
        format!("{before}[tolerances.C]\n{text}")
    }

    #[test]
    fn what_means_the_same_is_no_change() {
        let first =
            with_c("efficiency = { absolute = 0.002 }\nouter_contact_end = { absolute = \"0.5 us\" }\n");
        let record = [entry(standing(&first).expect("TOML"), Vec::new())];
        assert_eq!(changed(&record, Path::new("scene"), &first).expect("scene"), []);
        let rewritten = with_c(
            "outer_contact_end = { absolute = \"500 ns\" } # the same\nefficiency = { absolute = 2e-3 }\n\
             inner_force_peak = 0.01\n",
        );
        assert_eq!(changed(&record, Path::new("scene"), &rewritten).expect("scene"), []);
        let looser = with_c("efficiency = { absolute = 0.02 }\n");
        let found = changed(&record, Path::new("scene"), &looser).expect("scene");
        let words: Vec<_> = found.iter().map(|c| (&*c.quantity, &*c.accepted, c.now.as_deref())).collect();
        assert_eq!(
            words,
            [
                ("efficiency", "{ absolute = 0.002 }", Some("{ absolute = 0.02 }")),
                ("outer_contact_end", "{ absolute = \"0.5 us\" }", None),
            ]
        );
    }

    #[test]
    fn the_last_acceptance_counts() {
        let change = |to: &str| ToleranceChange {
            model: "C".to_owned(),
            quantity: "efficiency".to_owned(),
            from: "1".to_owned(),
            to: to.to_owned(),
        };
        let now = with_c("efficiency = { absolute = 0.02 }\n");
        let changes = |tos: &[&str]| {
            let record: Vec<_> = tos.iter().map(|to| entry(Standing::new(), vec![change(to)])).collect();
            changed(&record, Path::new("scene"), &now).expect("scene").len()
        };
        assert_eq!(changes(&["{ absolute = 0.01 }"]), 1);
        assert_eq!(changes(&["{ absolute = 0.01 }", "{ absolute = 0.02 }"]), 0);
        assert_eq!(changes(&["{ absolute = 0.01 }", REMOVED]), 0, "put back is new");
        assert_eq!(changes(&[]), 0);
        assert_eq!(changes(&["{ absolute = }"]), 1, "a record that can't be read is not the same");
    }
}
