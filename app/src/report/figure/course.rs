//! The course of one number over the commits as a small picture.

use crate::ci::trend::Trend;
use crate::format::words;
use crate::plot::polyline::path;
use maud::{Markup, html};

/// Size in units of the drawing.
const SIZE: [f64; 2] = [24.0, 7.0];

/// The number that has come furthest of what the gate admits, as a path and its name; `None` if nothing was recorded.
pub(crate) fn course(trends: &[Trend]) -> Option<[String; 2]> {
    let span = |trend: &Trend| trend.admissible.map_or(f64::INFINITY, |(low, high)| high - low);
    let share = |trend: &Trend| Some(trend.change().abs() / span(trend)).filter(|share| share.is_finite());
    let furthest =
        trends.iter().max_by(|a, b| share(a).unwrap_or(0.0).total_cmp(&share(b).unwrap_or(0.0)))?;
    let (low, high) = furthest
        .points
        .iter()
        .map(|point| point.1)
        .chain(furthest.admissible.into_iter().flat_map(<[f64; 2]>::from))
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let height = if high > low { high - low } else { 1.0 };
    let last = furthest.points.len().saturating_sub(1).max(1) as f64;
    let place = |(k, (_, value)): (usize, &(String, f64))| {
        (SIZE[0] * k as f64 / last, SIZE[1] * (1.0 - (value - low) / height))
    };
    let points: Vec<_> = furthest.points.iter().enumerate().map(place).collect();
    Some([path(&points), format!("{} of {}", words(&furthest.quantity), furthest.model)])
}

/// The drawing of a [`course`].
pub(crate) fn drawn([line, name]: &[String; 2]) -> Markup {
    html! {
        svg.thumbnail viewBox=(format!("-0.3 -0.3 {} {}", SIZE[0] + 0.6, SIZE[1] + 0.6)) role="img" aria-label=(format!("Course of {name}")) {
            title { (name) }
            path.fig-B d=(line) {}
        }
    }
}
