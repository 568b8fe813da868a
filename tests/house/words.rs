//! The field's words: what the house said once instead of them is in no sentence that a user reads.

use super::source::{Language, Source, sources};
use regex::Regex;
use std::path::Path;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Words and what they are called: the first is looked for in sentences.
const WORDS: [(&str, &str); 25] = [
    (r"told|tells?|untold", "report, print, show; not identifiable"),
    (r"says?|said", "states, prints"),
    (r"asked|asks", "requested, requires"),
    (r"besides?", "with, in addition to; off-centre"),
    (r"partners?", "reference solution, comparator"),
    (r"(?:held|holds?) (?:\w+ ){0,4}against", "compared with"),
    (r"off by", "differs by"),
    (r"near by", "similar"),
    (r"booked|ledgers?", "balance"),
    (r"dear|dearer|dearest", "expensive"),
    (r"promises|broken promise", "stated accuracy, met or not"),
    (r"trembles?|rattles?", "contact chatter"),
    (r"beneath", "below the contact"),
    (r"crept", "viscoelastic displacement"),
    (r"as many again", "doubling the number of modes"),
    (r"wish(?:es)?", "option"),
    (r"by hand", "delete"),
    (r"of one's own", "custom, your own"),
    (r"leaves? out|left out", "omits, omitted"),
    (r"range of validity", "assumptions"),
    (r"validated scenes?|validated range", "compared scenes, similar scenes"),
    (r"known discrepancy", "declared bias"),
    (r"first touch", "first contact"),
    (r"knows? no", "does not include"),
    (r"modes left", "truncated modes"),
];

/// Sentences of the program: texts in its sources with a space, without their placeholders; unit tests are the last of a file.
fn sentences(source: &Source) -> Vec<String> {
    let code = std::fs::read_to_string(Path::new(ROOT).join(&source.path)).unwrap_or_default();
    let product = code.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    // comments, raw texts and characters first: their quotes begin no text
    let text =
        Regex::new(r##"(?s)//[^\n]*|\br#".*?"#|\br"[^"]*"|'\\?.'|"((?:[^"\\]|\\.)*)""##).expect("expression");
    let placeholder = Regex::new(r"\{[^}]*\}").expect("expression");
    let found = text.captures_iter(product).filter_map(|found| found.get(1));
    let found =
        found.map(|text| placeholder.replace_all(&text.as_str().replace("\\\n", " "), "").into_owned());
    found.filter(|text| text.trim().contains(' ')).collect()
}

/// Pages of the guide: what is no code.
fn prose(text: &str) -> String {
    let code = Regex::new(r"(?s)```.*?```|`[^`\n]*`|<!--.*?-->|\]\([^)]*\)").expect("expression");
    code.replace_all(text, " ").into_owned()
}

fn pages(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            pages(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "md") {
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            let name = path.strip_prefix(ROOT).expect("below the root").display().to_string();
            found.push((name, prose(&text)));
        }
    }
}

#[test]
fn sentences_have_the_fields_words() {
    let mut texts = Vec::new();
    for source in sources().filter(|source| source.language == Language::Rust) {
        let is_test = source.path.contains("/tests");
        texts.extend(
            sentences(&source).into_iter().filter(|_| !is_test).map(|text| (source.path.clone(), text)),
        );
    }
    pages(&Path::new(ROOT).join("guide/src"), &mut texts);
    for name in ["README.md", "COMPARE.md"] {
        if let Ok(text) = std::fs::read_to_string(Path::new(ROOT).join(name)) {
            texts.push((name.to_owned(), prose(&text)));
        }
    }
    assert!(texts.len() > 1000, "{} sentences", texts.len());
    let mut found = Vec::new();
    for (word, instead) in WORDS {
        let pattern = Regex::new(&format!(r"(?i)\b(?:{word})\b")).expect("expression");
        for (path, text) in &texts {
            for at in pattern.find_iter(text) {
                let around: String = text
                    .chars()
                    .skip(text[..at.start()].chars().count().saturating_sub(30))
                    .take(80)
                    .collect();
                found.push(format!(
                    "{path}: `{}`, better: {instead}: {}",
                    at.as_str(),
                    around.replace('\n', " ")
                ));
            }
        }
    }
    assert!(found.is_empty(), "{} words:\n{}", found.len(), found.join("\n"));
}
