//! A section of a scene's page, and the list of them.

pub(crate) mod acceptance;
pub(crate) mod budget;
pub(crate) mod dents;
pub(crate) mod discrepancy;
pub(crate) mod flight;
pub(crate) mod impacts;
pub(crate) mod limits;
pub(crate) mod measured;
pub(crate) mod mesh;
pub(crate) mod reference_check;
pub(crate) mod trend;
pub(crate) mod validation;

use maud::{Markup, html};

/// A section under its own heading; one without content is not shown.
pub(crate) struct Section {
    id: String,
    title: String,
    /// What the list of contents calls it.
    link: String,
    /// What stands beside the title.
    mark: Markup,
    body: Markup,
}

impl Section {
    pub(crate) fn new(id: &str, title: &str, body: Markup) -> Self {
        Section { id: id.to_owned(), title: title.to_owned(), link: title.to_owned(), mark: html! {}, body }
    }

    pub(crate) fn linked_as(self, link: String) -> Self {
        Section { link, ..self }
    }

    pub(crate) fn marked(self, mark: Markup) -> Self {
        Section { mark, ..self }
    }
}

/// Links to the other scenes and to the sections.
pub(crate) fn contents(sections: &[Section]) -> Markup {
    html! {
        nav.contents aria-label="Contents" {
            ul { li { a href="index.html" { "all scenes" } } @for section in shown(sections) { li { a href=(format!("#{}", section.id)) { (section.link) } } } }
        }
    }
}

/// The sections, one below the other.
pub(crate) fn sections(sections: &[Section]) -> Markup {
    html! {
        @for section in shown(sections) {
            section id=(section.id) { h2 { (section.title) @if !section.mark.0.is_empty() { " " (section.mark) } } (section.body) }
        }
    }
}

fn shown(sections: &[Section]) -> impl Iterator<Item = &Section> {
    sections.iter().filter(|section| !section.body.0.is_empty())
}
