//! How every drawing begins, and what drawings have in common: colours, type, coordinates, names beside vertical axes.

use maud::{Markup, PreEscaped, html};

/// Font size in px of a drawing.
pub(crate) const FONT_SIZE: f64 = 13.0;

/// Colours of a file of its own. Pages have the same classes, light and dark; there the rules hold inside the drawing alone.
const STYLE: &str = "\
.sheet text{fill:#1a1a1a}.sheet .fig-halo{stroke:#fff}.sheet .fig-frame{stroke:#444;fill:none}.sheet .fig-grid{stroke:#e3e3e3}\
.sheet .fig-box{fill:#ececec;stroke:#bdbdbd}.sheet .fig-band{fill:#d0d0d0}.sheet .fig-range{fill:#ececec}\
.sheet .fig-note{stroke:#666;stroke-dasharray:6 4}\
.sheet .fig-body{fill:#dfe5ea;stroke:#444}.sheet .fig-seat{fill:#f0dfb8;stroke:#9a7f3c}.sheet .fig-hollow{fill:#fff}\
.sheet .fig-intended{stroke:#777}.sheet .fig-reference{stroke:#1a1a1a}\
.sheet .fig-A{stroke:#d55e00}.sheet .fig-B{stroke:#0072b2}.sheet .fig-C{stroke:#009e73}.sheet .fig-measured{stroke:#cc79a7}\
.sheet .fig-other{stroke:#8a6d00}.sheet .fig-other-2{stroke:#6a3d9a}.sheet .fig-other-3{stroke:#9e1b4f}\
.sheet .fig-other-4{stroke:#5c5c5c}\
.sheet .size-small{fill:#12572e}.sheet .size-medium{fill:#b07300}.sheet .size-large{fill:#a11b1b}";

/// Where the colours come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Theme {
    /// White background, colours in the drawing: a file of its own.
    Standalone,
    /// No colours: the page it stands in gives them, light or dark.
    Inline,
}

/// A drawing that begins: title and size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Svg<'a> {
    /// What it shows, for screen readers.
    title: &'a str,
    /// Width and height in px.
    size: [f64; 2],
    theme: Theme,
    /// Millimetres of a px, of a printed drawing.
    millimetres: Option<f64>,
}

impl<'a> Svg<'a> {
    /// A drawing of so many px, width and height.
    pub fn new(title: &'a str, size: [f64; 2], theme: Theme) -> Self {
        Svg { title, size, theme, millimetres: None }
    }

    /// With its size in millimetres, so many a px.
    pub(crate) fn printed(self, millimetres: Option<f64>) -> Self {
        Svg { millimetres, ..self }
    }

    /// The drawing with its `content`.
    pub fn around(&self, content: &Markup) -> Markup {
        let alone = self.theme == Theme::Standalone;
        let [width, height] = self.size.map(tenth);
        let size = |px: f64| match self.millimetres {
            Some(mm) => format!("{:.3}mm", px * mm),
            None => tenth(px).to_string(),
        };
        let [wide, high] = self.size.map(|px| alone.then(|| size(px)));
        html! {
            svg xmlns="http://www.w3.org/2000/svg" class=[alone.then_some("sheet")] viewBox=(format!("0 0 {width} {height}"))
                width=[wide] height=[high]
                font-family="DejaVu Sans, Verdana, sans-serif" font-size=(FONT_SIZE) role="img" {
                title { (self.title) }
                @if alone {
                    style { (PreEscaped(STYLE)) }
                    rect width=(width) height=(height) fill="#ffffff" {}
                }
                (content)
            }
        }
    }
}

/// What a vertical axis shows, read upwards; the middle of its baseline is at (`x`, `y`) px.
pub(crate) fn upright(x: f64, y: f64, text: &str) -> Markup {
    html! { text transform=(format!("translate({x} {y:.2}) rotate(-90)")) text-anchor="middle" { (text) } }
}

/// Width in px of `text` in DejaVu Sans, estimated from above.
pub(crate) fn text_width(text: &str) -> f64 {
    0.62 * FONT_SIZE * text.chars().count() as f64
}

/// Coordinate with two decimals.
pub(crate) fn x2(value: f64) -> String {
    format!("{value:.2}")
}

/// With one decimal.
fn tenth(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}
