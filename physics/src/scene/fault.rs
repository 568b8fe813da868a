//! What is wrong with a scene file, with the place in the file and what would be valid.

use crate::error::Error;
use miette::{Diagnostic, NamedSource, SourceSpan};
use std::ops::Range;
use std::sync::Arc;

/// One fault of a scene file.
#[derive(Debug, Clone, thiserror::Error, Diagnostic)]
#[error("{message}")]
pub struct Fault {
    /// Field, value and what is wrong with it.
    pub message: String,
    /// Line in the file, counted from 1.
    pub line: usize,
    /// What to do.
    #[help]
    pub help: Option<String>,
    #[label("{label}")]
    span: SourceSpan,
    label: String,
    #[source_code]
    file: Arc<NamedSource<String>>,
}

/// Several faults of one scene file, in the order of the file.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("{name} has {} problems", faults.len())]
pub struct Faults {
    name: String,
    /// The faults.
    #[related]
    pub faults: Vec<Fault>,
}

/// Collects the faults of one file.
#[derive(Debug)]
pub(super) struct Collector {
    name: String,
    file: Arc<NamedSource<String>>,
    faults: Vec<Fault>,
}

impl Collector {
    pub(super) fn new(name: &str, text: &str) -> Self {
        let file = Arc::new(NamedSource::new(name, text.to_owned()));
        Collector { name: name.to_owned(), file, faults: Vec::new() }
    }

    /// Notes a fault at `span` (bytes of the text).
    pub(super) fn add(&mut self, span: Range<usize>, message: String, label: &str, help: String) {
        let text = self.file.inner();
        // Spans come from the parser, but one past the end must not make the message itself fail.
        let start = span.start.min(text.len());
        let line = 1 + text.as_bytes()[..start].iter().filter(|b| **b == b'\n').count();
        let length = span.end.min(text.len()).saturating_sub(start);
        self.faults.push(Fault {
            message,
            line,
            help: Some(help),
            span: (start, length).into(),
            label: label.to_owned(),
            file: Arc::clone(&self.file),
        });
    }

    pub(super) fn is_empty(&self) -> bool {
        self.faults.is_empty()
    }

    /// The report of all faults; a single one stands alone.
    pub(super) fn into_report(mut self) -> miette::Report {
        self.faults.sort_by_key(|p| p.span.offset());
        if self.faults.len() == 1 {
            return self.faults.remove(0).into();
        }
        Faults { name: self.name, faults: self.faults }.into()
    }
}

/// The faults a report of this module carries; empty for a report of another kind.
pub fn faults(report: &miette::Report) -> Vec<Fault> {
    if let Some(fault) = report.downcast_ref::<Fault>() {
        return vec![fault.clone()];
    }
    report.downcast_ref::<Faults>().map(|p| p.faults.clone()).unwrap_or_default()
}

/// The entry of `known` that `word` may have been meant to be.
pub fn suggestion<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let score = |k: &str| strsim::damerau_levenshtein(&word.to_lowercase(), &k.to_lowercase());
    let best = known.into_iter().map(|k| (score(k), k)).min()?;
    (best.0 <= 1 + word.chars().count() / 4).then_some(best.1)
}

/// [`Error::Usage`] of a `name` that is none of `known`, as `message` says: the hints are a similar name, and all.
pub fn unknown_name(message: String, name: &str, known: &[&str]) -> Error {
    let similar = suggestion(name, known.iter().copied()).map(|near| format!("did you mean `{near}`?"));
    let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
    Error::Usage(message).hint(similar).hint([format!("available: {known}")])
}

/// "did you mean `x`? " or nothing.
pub(super) fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    suggestion(word, known).map(|s| format!("did you mean `{s}`? ")).unwrap_or_default()
}
