//! The boxes with the efficiencies in the figure's velocity panel, as in Fig. 10.

use crate::format::significant;
use crate::plot::labels::Rect;
use crate::plot::svg::x2;
use crate::report::figure::lines::{Line, stroke};
use maud::{Markup, html};

const WIDTH: f64 = 122.0;
const HEIGHT: f64 = 22.0;
const GAP: f64 = 4.0;

/// A box per result, below or beside each other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EfficiencyBoxes {
    count: f64,
    /// Offset of the first box from the corner, for the heading.
    first: (f64, f64),
    /// Offset of each box from the one before.
    step: (f64, f64),
    corner: (f64, f64),
}

impl EfficiencyBoxes {
    /// Below each other, the heading above them.
    pub(crate) fn column(count: usize) -> Self {
        let (first, step) = ((0.0, 18.0), (0.0, HEIGHT + GAP));
        EfficiencyBoxes { count: count as f64, first, step, corner: (0.0, 0.0) }
    }

    /// Beside each other, the heading on their left if there is room for it.
    pub(crate) fn row(count: usize) -> Self {
        let heading = if count <= 4 { 76.0 } else { 0.0 };
        let (first, step) = ((heading, 0.0), (WIDTH + GAP, 0.0));
        EfficiencyBoxes { count: count as f64, first, step, corner: (0.0, 0.0) }
    }

    /// Width in px.
    pub(crate) fn width(&self) -> f64 {
        self.first.0 + WIDTH + self.step.0 * (self.count - 1.0).max(0.0)
    }

    /// Height in px.
    pub(crate) fn height(&self) -> f64 {
        self.first.1 + HEIGHT + self.step.1 * (self.count - 1.0).max(0.0)
    }

    pub(crate) fn at(self, place: Rect) -> Self {
        EfficiencyBoxes { corner: (place.x, place.y), ..self }
    }

    pub(crate) fn draw(&self, lines: &[Line]) -> Markup {
        let (left, top) = self.corner;
        let heading = if self.first.1 > 0.0 { 12.0 } else { 15.6 };
        html! {
            @if !lines.is_empty() && self.first != (0.0, 0.0) {
                text x=(x2(left)) y=(x2(top + heading)) { "Efficiency" }
            }
            @for (k, line) in lines.iter().enumerate() {
                @let x = left + self.first.0 + k as f64 * self.step.0;
                @let y = top + self.first.1 + k as f64 * self.step.1;
                rect.fig-box x=(x2(x)) y=(x2(y)) width=(WIDTH) height=(HEIGHT) rx="2" {}
                (stroke(line, &format!("M{:.2} {:.2}L{:.2} {:.2}", x + 7.0, y + 11.0, x + 29.0, y + 11.0)))
                text x=(x2(x + 35.0)) y=(x2(y + 15.6)) { (line.short) }
                text x=(x2(x + WIDTH - 7.0)) y=(x2(y + 15.6)) text-anchor="end" {
                    (significant(100.0 * line.efficiency, 3)) " %"
                }
            }
        }
    }
}
