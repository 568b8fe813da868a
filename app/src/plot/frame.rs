//! Frame of a picture in section: axes in mm and, for a field, the scale of its colours.

use crate::plot::colours::cividis;
use crate::plot::svg::{Svg, Theme, upright, x2};
use crate::plot::ticks::{tick_label, ticks};
use maud::{Markup, html};

/// Width of the drawing, and margins around the picture in it, in px of the drawing.
const WIDTH: f64 = 400.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 8.0;

/// What is shown, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    /// From left to right.
    pub(crate) across: [f64; 2],
    /// From below to above, along z.
    pub(crate) up: [f64; 2],
}

/// Scale of the colours of a field.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ColourScale {
    /// Value at its end, in the unit of the label.
    largest: f64,
    label: &'static str,
    /// Of a picture with it.
    pub(crate) name: &'static str,
}

impl ColourScale {
    /// Up to `largest` Pa.
    pub(crate) fn von_mises(largest: f64) -> Self {
        Self {
            largest: 1e-6 * largest,
            label: "von Mises stress in MPa",
            name: "Von Mises stress in section",
        }
    }

    /// Up to `largest`.
    pub(crate) fn plastic_strain(largest: f64) -> Self {
        Self { largest: 1e2 * largest, label: "plastic strain in %", name: "Plastic strain in section" }
    }
}

/// What stands around a picture.
pub(crate) struct Frame<'a> {
    pub(crate) bounds: Bounds,
    /// Height over width of the picture; `None` = that of the bounds.
    pub(crate) aspect: Option<f64>,
    /// Label of the horizontal axis.
    pub(crate) across: &'static str,
    pub(crate) scale: Option<ColourScale>,
    pub(crate) name: &'static str,
    /// Unique on the page.
    pub(crate) id: &'a str,
}

/// From places in m to the drawing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    bounds: Bounds,
    height: f64,
}

impl Place {
    /// Left, top, width and height of the picture.
    pub(crate) fn rectangle(&self) -> [String; 4] {
        [LEFT, TOP, WIDTH - LEFT - RIGHT, self.height].map(x2)
    }

    pub(crate) fn x(&self, across: f64) -> f64 {
        let [left, right] = self.bounds.across;
        LEFT + (WIDTH - LEFT - RIGHT) * (across - left) / (right - left)
    }

    pub(crate) fn y(&self, up: f64) -> f64 {
        let [low, high] = self.bounds.up;
        TOP + self.height * (high - up) / (high - low)
    }
}

impl Frame<'_> {
    /// The drawing with `content` in the frame.
    pub(crate) fn around(&self, content: impl FnOnce(&Place) -> Markup) -> Markup {
        let Bounds { across: [left, right], up: [low, high] } = self.bounds;
        let width = WIDTH - LEFT - RIGHT;
        let height = width * self.aspect.unwrap_or((high - low) / (right - left));
        let place = Place { bounds: self.bounds, height };
        let bottom = TOP + height;
        let marks = ticks(left * 1e3, right * 1e3, 5);
        let marks_up = ticks(low * 1e3, high * 1e3, ((height / 50.0) as usize).max(2));
        let total = bottom + if self.scale.is_some() { 92.0 } else { 44.0 };
        let [x, y, w, h] = place.rectangle();
        let drawing = html! {
            (content(&place))
            rect.fig-frame x=(x) y=(y) width=(w) height=(h) {}
            @for mark in &marks {
                @let x = x2(place.x(mark * 1e-3));
                line.fig-frame x1=(x) x2=(x) y1=(x2(bottom)) y2=(x2(bottom + 4.0)) {}
                text x=(x) y=(x2(bottom + 18.0)) text-anchor="middle" { (tick_label(*mark, &marks)) }
            }
            text x=(x2(LEFT + 0.5 * width)) y=(x2(bottom + 36.0)) text-anchor="middle" { (self.across) }
            @for mark in &marks_up {
                @let y = place.y(mark * 1e-3);
                line.fig-frame x1=(LEFT - 4.0) x2=(LEFT) y1=(x2(y)) y2=(x2(y)) {}
                text x=(LEFT - 7.0) y=(x2(y + 4.7)) text-anchor="end" { (tick_label(*mark, &marks_up)) }
            }
            (upright(13.0, TOP + 0.5 * height, "z in mm"))
            @if let Some(scale) = self.scale { (colour_scale(scale, bottom + 46.0, self.id)) }
        };
        Svg::new(self.name, [WIDTH, total], Theme::Inline).around(&drawing)
    }
}

fn colour_scale(scale: ColourScale, top: f64, id: &str) -> Markup {
    const STOPS: usize = 12;
    let width = WIDTH - LEFT - RIGHT;
    let to = scale.largest;
    let marks = ticks(0.0, to, 5);
    html! {
        defs { linearGradient id=(format!("{id}-scale")) {
            @for k in 0..=STOPS {
                @let share = k as f64 / STOPS as f64;
                @let [r, g, b] = cividis(share);
                stop offset=(x2(share)) stop-color=(format!("rgb({r},{g},{b})")) {}
            }
        } }
        rect.fig-edge x=(LEFT) y=(x2(top)) width=(x2(width)) height="10" fill=(format!("url(#{id}-scale)")) {}
        @for mark in &marks {
            @let x = LEFT + if to > 0.0 { width * mark / to } else { 0.0 };
            text x=(x2(x)) y=(x2(top + 24.0)) text-anchor="middle" { (tick_label(*mark, &marks)) }
        }
        text x=(x2(LEFT + 0.5 * width)) y=(x2(top + 41.0)) text-anchor="middle" { (scale.label) }
    }
}
