//! Nested JSON as a table of the page.

use crate::format::{short, with_minus};
use crate::report::page::html::scrolled;
use maud::{Markup, html};
use serde_json::Value;

/// A table of what nested JSON says, a row per leaf.
pub(crate) fn facts(of: &[(&str, Option<&Value>)]) -> Markup {
    let mut rows = Vec::new();
    for (name, value) in of {
        if let Some(value) = value {
            flatten(name, value, &mut rows);
        }
    }
    html! {
        @if rows.is_empty() { p { "–" } } @else {
            (scrolled("Facts", &html! { table.facts { tbody {
                @for (name, value) in rows { tr { th scope="row" { (name) } td { (value) } } }
            } } }))
        }
    }
}

fn flatten(name: &str, value: &Value, rows: &mut Vec<(String, String)>) {
    match value {
        Value::Null => {}
        Value::Object(fields) => {
            for (key, value) in fields {
                let name = [name, key].into_iter().filter(|p| !p.is_empty()).collect::<Vec<_>>();
                flatten(&name.join(" · ").replace('_', " "), value, rows);
            }
        }
        Value::String(text) => rows.push((name.to_owned(), text.clone())),
        Value::Number(number) if number.is_f64() => {
            // as many digits as anyone reads; the files beside the report have all of them
            rows.push((name.to_owned(), with_minus(&short(number.as_f64().unwrap_or(f64::NAN)))));
        }
        other => rows.push((name.to_owned(), with_minus(&other.to_string()))),
    }
}
