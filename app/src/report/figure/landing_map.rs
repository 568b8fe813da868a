//! The map of landings: the seat reached over speed and angle of the launch, and the launches of the share in their bands.

use crate::flight::{Landing, Landscape, Launch, LaunchDeviation, Seat, Setup, map_of_landings};
use crate::plot::axis::{Plot, PlotAxis};
use crate::plot::chart::{CHART_WIDTH, LEFT, PANEL_GAP};
use crate::plot::svg::{Svg, Theme, x2};
use crate::result::FlightSummary;
use maud::{Markup, html};
use rayon::prelude::*;

/// Cells of the map.
const SPEEDS: usize = 151;
const ANGLES: usize = 91;
/// How far it goes from the launch: of the speed relative, of the angle in rad.
const REACH: [f64; 2] = [0.5, 0.35];
/// Heights of the map and of the bands' panel, room above them and on the right, px.
const HEIGHTS: [f64; 2] = [300.0, 190.0];
const TOP: f64 = 36.0;
const RIGHT: f64 = 16.0;
/// The bands' panel over their widths.
const ROOM: f64 = 0.15;

/// What the seats look like, and how they are called.
const LOOKS: [(Seat, &str, &str); 3] = [
    (Seat::Other, "#0072b2", "the other seat"),
    (Seat::Same, "#f0c987", "the same seat"),
    (Seat::None, "#8c8c8c", "neither"),
];

/// Both panels as a stand-alone SVG.
pub(crate) fn map_picture(
    setup: &Setup,
    landscape: &Landscape,
    flight: &FlightSummary,
    deviation: &LaunchDeviation,
) -> String {
    let centre = [flight.launch.speed, flight.launch.angle];
    let half = [centre[0] * REACH[0], REACH[1]];
    let [speeds, angles] = [(0, SPEEDS), (1, ANGLES)].map(|(k, count)| -> Vec<f64> {
        (0..count).map(|i| centre[k] + half[k] * (2.0 * i as f64 / (count - 1) as f64 - 1.0)).collect()
    });
    let row = |angle: &f64| map_of_landings(setup, landscape, [&speeds, &[*angle]], flight.launch.spin);
    let rows: Vec<Vec<Landing>> = angles.par_iter().map(row).collect();
    let bands = [centre[0] * deviation.speed, deviation.angle];
    let wide = plot(0, centre, half);
    // a band without width is drawn as if it had a little
    let near = plot(1, centre, [0, 1].map(|k| (1.0 + ROOM) * bands[k].max(1e-3 * half[k])));
    let height = TOP + HEIGHTS.iter().sum::<f64>() + 2.0 * PANEL_GAP;
    let content = html! {
        (legend())
        (cells(&wide, &rows, [half[0] / (SPEEDS - 1) as f64, half[1] / (ANGLES - 1) as f64]))
        (band(&wide, centre, bands))
        circle cx=(x2(wide.x(centre[0]))) cy=(x2(wide.y(centre[1].to_degrees()))) r="7" fill="none" stroke="#1a1a1a" stroke-width="1.6" {}
        (framed(&wide))
        @for landing in &flight.landings { (dot(&near, landing)) }
        (band(&near, centre, bands))
        (framed(&near))
    };
    Svg::new("Map of landings", [CHART_WIDTH, height], Theme::Standalone).around(&content).into_string()
}

/// Panel number `k`; speeds in m/s, angles in degrees.
fn plot(k: usize, centre: [f64; 2], half: [f64; 2]) -> Plot {
    let axis = |k: usize, factor: f64| {
        PlotAxis::over([-1.0, 1.0].into_iter().map(|side| factor * (centre[k] + side * half[k])), false)
    };
    let top = TOP + HEIGHTS[..k].iter().map(|height| height + PANEL_GAP).sum::<f64>();
    let width = CHART_WIDTH - LEFT - RIGHT;
    Plot { left: LEFT, top, width, height: HEIGHTS[k], x: axis(0, 1.0), y: axis(1, 1.0_f64.to_degrees()) }
}

fn framed(plot: &Plot) -> Markup {
    let marks = (plot.x.marks(9), plot.y.marks(6));
    plot.frame(&marks.0, &marks.1, ["Speed of the launch in m/s", "Angle in °"])
}

/// A path of rectangles per seat: neighbours of the same one are one.
fn cells(plot: &Plot, rows: &[Vec<Landing>], half: [f64; 2]) -> Markup {
    let edge = |launch: &Launch, side: f64| {
        let [low, high] = plot.x.ends();
        plot.x((launch.speed + side * half[0]).clamp(low, high))
    };
    let rectangle = |same: &[Landing]| {
        let (first, last) = (&same[0].launch, &same[same.len() - 1].launch);
        let [low, high] = plot.y.ends();
        let y = |side: f64| plot.y((first.angle + side * half[1]).to_degrees().clamp(low, high));
        format!(
            "M{:.1} {:.1}H{:.1}V{:.1}H{:.1}z",
            edge(first, -1.0),
            y(1.0),
            edge(last, 1.0),
            y(-1.0),
            edge(first, -1.0)
        )
    };
    html! {
        rect.fig-range x=(plot.left) y=(plot.top) width=(plot.width) height=(plot.height) {}
        @for (seat, colour, _) in LOOKS {
            @let runs = rows.iter().flat_map(|row| row.chunk_by(|a, b| a.seat == b.seat)).filter(|same| same[0].seat == seat);
            path d=(runs.map(rectangle).collect::<String>()) fill=(colour) stroke=(colour) stroke-width="0.3" {}
        }
    }
}

/// Where the launch may be by the scene's scatter.
fn band(plot: &Plot, centre: [f64; 2], half: [f64; 2]) -> Markup {
    let (x, y) = (plot.x(centre[0] - half[0]), plot.y((centre[1] + half[1]).to_degrees()));
    let (width, height) = (plot.x(centre[0] + half[0]) - x, plot.y((centre[1] - half[1]).to_degrees()) - y);
    html! { rect x=(x2(x)) y=(x2(y)) width=(x2(width)) height=(x2(height)) fill="none" stroke="#1a1a1a" stroke-width="1.2" {} }
}

fn dot(plot: &Plot, landing: &Landing) -> Markup {
    let (x, y) = plot.at((landing.launch.speed, landing.launch.angle.to_degrees()));
    let colour = LOOKS.iter().find(|look| look.0 == landing.seat).map_or("", |look| look.1);
    html! { circle cx=(x2(x)) cy=(x2(y)) r="3.2" fill=(colour) stroke="#1a1a1a" stroke-width="0.4" {} }
}

fn legend() -> Markup {
    html! {
        @for (k, (_, colour, name)) in LOOKS.iter().enumerate() {
            @let x = LEFT + 160.0 * k as f64;
            rect x=(x) y="10" width="14" height="14" fill=(colour) {}
            text x=(x + 20.0) y="21.5" { (name) }
        }
    }
}
