//! Keys that are several ways to say one thing: exactly one way has to be taken, and in full.

use super::check::Checker;
use super::grammar::{Alternative, Field};
use super::place::Place;
use toml::de::DeTable;

/// The groups of alternatives among `fields` for a table of this `kind`: per group its sets, per set its fields.
pub(super) fn groups<'f>(fields: &'f [Field], kind: Option<&str>) -> Vec<Vec<(Alternative, Vec<&'f Field>)>> {
    let mut groups: Vec<Vec<(Alternative, Vec<&Field>)>> = Vec::new();
    for (field, alternative) in fields.iter().filter_map(|f| Some((f, f.alternative(kind)?))) {
        let index = groups.iter().position(|sets| sets[0].0.group == alternative.group);
        let index = index.unwrap_or_else(|| {
            groups.push(Vec::new());
            groups.len() - 1
        });
        match groups[index].iter_mut().find(|(a, _)| *a == alternative) {
            Some((_, set)) => set.push(field),
            None => groups[index].push((alternative, vec![field])),
        }
    }
    groups
}

/// Names the keys of a set: "`a` and `b`".
fn keys(place: &Place, set: &[&Field]) -> String {
    set.iter().map(|f| format!("`{}`", place.key(f.key))).collect::<Vec<_>>().join(" and ")
}

impl Checker<'_> {
    /// Notes groups of alternatives of which none, more than one or a part is there.
    pub(super) fn alternatives(
        &mut self,
        place: &Place,
        table: &DeTable,
        fields: &[Field],
        kind: Option<&str>,
    ) {
        for sets in groups(fields, kind) {
            let found: Vec<_> =
                sets.iter().filter(|(_, set)| set.iter().any(|f| table.contains_key(f.key))).collect();
            let group = sets[0].0.group;
            match found[..] {
                [] if sets.iter().any(|(_, set)| set.iter().any(|f| f.required)) => {
                    let ways: Vec<String> = sets.iter().map(|(_, set)| keys(place, set)).collect();
                    self.problems.add(
                        place.span.clone(),
                        format!("{group} is missing in {}", place.name()),
                        "incomplete",
                        format!("give {}", ways.join(", or ")),
                    );
                }
                [] => {}
                [(_, set)] => {
                    for field in set.iter().filter(|f| !table.contains_key(f.key)) {
                        self.missing(place, field);
                    }
                }
                [(_, first), (_, second), ..] => {
                    let span = second.iter().find_map(|f| Some(table.get_key_value(f.key)?.0.span()));
                    self.problems.add(
                        span.unwrap_or(place.span.clone()),
                        format!(
                            "{} and {} both give {group} of {}",
                            keys(place, first),
                            keys(place, second),
                            place.name()
                        ),
                        "one too many",
                        "remove one of the two".to_owned(),
                    );
                }
            }
        }
    }
}
