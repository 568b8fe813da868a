//! What is wrong with a scene file, with the place in the file and what would be valid.

use miette::{Diagnostic, NamedSource, SourceSpan};
use std::ops::Range;
use std::sync::Arc;

/// One fault of a scene file.
#[derive(Debug, Clone, thiserror::Error, Diagnostic)]
#[error("{message}")]
pub struct Problem {
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
#[error("{name} has {} problems", problems.len())]
pub struct Problems {
    name: String,
    /// The faults.
    #[related]
    pub problems: Vec<Problem>,
}

/// Collects the faults of one file.
#[derive(Debug)]
pub(super) struct Collector {
    name: String,
    file: Arc<NamedSource<String>>,
    problems: Vec<Problem>,
}

impl Collector {
    pub(super) fn new(name: &str, text: &str) -> Self {
        let file = Arc::new(NamedSource::new(name, text.to_owned()));
        Collector { name: name.to_owned(), file, problems: Vec::new() }
    }

    /// Notes a fault at `span` (bytes of the text).
    pub(super) fn add(&mut self, span: Range<usize>, message: String, label: &str, help: String) {
        let text = self.file.inner();
        // Spans come from the parser, but one past the end must not make the message itself fail.
        let start = span.start.min(text.len());
        let line = 1 + text.as_bytes()[..start].iter().filter(|b| **b == b'\n').count();
        let length = span.end.min(text.len()).saturating_sub(start);
        self.problems.push(Problem {
            message,
            line,
            help: Some(help),
            span: (start, length).into(),
            label: label.to_owned(),
            file: Arc::clone(&self.file),
        });
    }

    pub(super) fn is_empty(&self) -> bool {
        self.problems.is_empty()
    }

    /// The report of all faults; a single one stands alone.
    pub(super) fn into_report(mut self) -> miette::Report {
        self.problems.sort_by_key(|p| p.span.offset());
        if self.problems.len() == 1 {
            return self.problems.remove(0).into();
        }
        Problems { name: self.name, problems: self.problems }.into()
    }
}

/// The faults a report of this module carries; empty for a report of another kind.
pub fn problems(report: &miette::Report) -> Vec<Problem> {
    if let Some(problem) = report.downcast_ref::<Problem>() {
        return vec![problem.clone()];
    }
    report.downcast_ref::<Problems>().map(|p| p.problems.clone()).unwrap_or_default()
}

/// The entry of `known` that `word` may have been meant to be.
pub fn suggestion<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let score = |k: &str| strsim::damerau_levenshtein(&word.to_lowercase(), &k.to_lowercase());
    let best = known.into_iter().map(|k| (score(k), k)).min()?;
    (best.0 <= 1 + word.chars().count() / 4).then_some(best.1)
}

/// "did you mean `x`? " or nothing.
pub(super) fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    suggestion(word, known).map(|s| format!("did you mean `{s}`? ")).unwrap_or_default()
}
