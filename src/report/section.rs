//! A section of a scene's page, and the list of them.

use maud::{Markup, html};

/// A section under its own heading; one without content is not shown.
pub(super) struct Section {
    id: String,
    title: String,
    /// What the list of contents calls it.
    link: String,
    /// What stands beside the title.
    mark: Markup,
    body: Markup,
}

impl Section {
    pub(super) fn new(id: &str, title: &str, body: Markup) -> Self {
        Section { id: id.to_owned(), title: title.to_owned(), link: title.to_owned(), mark: html! {}, body }
    }

    pub(super) fn linked_as(self, link: String) -> Self {
        Section { link, ..self }
    }

    pub(super) fn marked(self, mark: Markup) -> Self {
        Section { mark, ..self }
    }
}

/// Links to the other scenes and to the sections.
pub(super) fn contents(sections: &[Section]) -> Markup {
    html! {
        nav.contents aria-label="Contents" {
            ul { li { a href="index.html" { "all scenes" } } @for section in shown(sections) { li { a href=(format!("#{}", section.id)) { (section.link) } } } }
        }
    }
}

/// The sections, one below the other.
pub(super) fn sections(sections: &[Section]) -> Markup {
    html! {
        @for section in shown(sections) {
            section id=(section.id) { h2 { (section.title) @if !section.mark.0.is_empty() { " " (section.mark) } } (section.body) }
        }
    }
}

fn shown(sections: &[Section]) -> impl Iterator<Item = &Section> {
    sections.iter().filter(|section| !section.body.0.is_empty())
}
