//! A quantity over two parameters, in colours: cells of a grid, or dots where points are scattered.

use crate::plot::axis::{Plot, PlotAxis};
use crate::plot::chart::{CHART_WIDTH, LEFT, LEGEND_ROW, PANEL_GAP};
use crate::plot::colours::{cividis, hex};
use crate::plot::polyline::Point;
use crate::plot::svg::{Svg, Theme, upright, x2};
use maud::{Markup, html};

/// Room on the right for the scale of colours, px.
const RIGHT: f64 = 112.0;
const HEIGHT: f64 = 400.0;
/// Colours that are told apart: neighbours of the same one are one rectangle.
const COLOURS: usize = 64;

/// Values over two parameters, all in the units of the labels.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ColourMap {
    /// Names of the parameters, with unit.
    pub labels: [String; 2],
    /// Whether their axes are logarithmic.
    pub logarithmic: [bool; 2],
    /// Name of the value, with unit.
    pub value_label: String,
    /// Both parameters and the value, not finite where there is none.
    pub points: Vec<([f64; 2], f64)>,
    /// Whether the points are all of a grid.
    pub is_grid: bool,
    /// Points of another origin, ringed, and what they are.
    pub marks: (String, Vec<([f64; 2], f64)>),
    /// A function at the points, of a grid, whose contour at 1 is drawn, and what it is.
    pub line: Option<(String, Vec<f64>)>,
}

/// The maps, one below the other, as a stand-alone SVG.
pub fn colour_maps(title: &str, maps: &[ColourMap]) -> String {
    let marks = maps.iter().map(|map| &map.marks).find(|(_, marks)| !marks.is_empty()).map(|(name, _)| name);
    let line = maps.iter().find_map(|map| map.line.as_ref()).map(|(name, _)| name);
    let top = 14.0 + LEGEND_ROW * [marks, line].iter().flatten().count() as f64;
    let height = top + maps.len() as f64 * (HEIGHT + PANEL_GAP);
    let content = html! {
        (legend(marks, line))
        @for (k, map) in maps.iter().enumerate() { (draw(map, top + k as f64 * (HEIGHT + PANEL_GAP))) }
    };
    Svg::new(title, [CHART_WIDTH, height], Theme::Standalone).around(&content).into_string()
}

fn legend(marks: Option<&String>, line: Option<&String>) -> Markup {
    let below = 16.0 + if marks.is_some() { LEGEND_ROW } else { 0.0 };
    html! {
        @if let Some(name) = marks {
            (ring((LEFT + 15.0, 16.0), "#ffffff"))
            text x=(LEFT + 37.0) y="20.5" { (name) }
        }
        @if let Some(name) = line {
            (contour(&format!("M{LEFT} {below}H{}", LEFT + 30.0)))
            text x=(LEFT + 37.0) y=(below + 4.5) { (name) }
        }
    }
}

fn draw(map: &ColourMap, top: f64) -> Markup {
    let values = map.points.iter().chain(&map.marks.1).map(|(_, value)| *value);
    let scale = PlotAxis::over(values, false);
    let axis = |k: usize| {
        PlotAxis::over(map.points.iter().chain(&map.marks.1).map(|(at, _)| at[k]), map.logarithmic[k])
    };
    let grid = map.is_grid.then(|| Grid::of(map));
    let room = |k: usize| grid.as_ref().map_or(0.04, |grid| 0.5 / (grid.values[k].len().max(2) - 1) as f64);
    let (width, height) = (CHART_WIDTH - LEFT - RIGHT, HEIGHT);
    let plot =
        Plot { left: LEFT, top, width, height, x: axis(0).widened(room(0)), y: axis(1).widened(room(1)) };
    let (x_marks, y_marks) = (plot.x.marks((width / 70.0) as usize), plot.y.marks(6));
    html! {
        rect.fig-range x=(LEFT) y=(top) width=(width) height=(HEIGHT) {}
        @match &grid {
            Some(grid) => (grid.cells(&plot, &scale)),
            None => @for (at, value) in map.points.iter().filter(|(_, v)| v.is_finite()) { (dot(plot.at((at[0], at[1])), &colour(*value, &scale))) },
        }
        @if let (Some(grid), Some((_, function))) = (&grid, &map.line) { (contour(&grid.contour(&plot, function))) }
        @for (at, value) in &map.marks.1 { (ring(plot.at((at[0], at[1])), &colour(*value, &scale))) }
        (plot.frame(&x_marks, &y_marks, [&map.labels[0], &map.labels[1]]))
        (colour_bar(&map.value_label, &scale, top))
    }
}

/// Points of a grid in the order of their parameters.
struct Grid {
    /// Values of both parameters, rising.
    values: [Vec<f64>; 2],
    /// Number of the point at each pair of them, if there is one. Shape (second, first).
    points: Vec<Vec<Option<usize>>>,
    of: Vec<f64>,
}

impl Grid {
    fn of(map: &ColourMap) -> Self {
        let values = [0, 1].map(|k| {
            let mut values: Vec<f64> = map.points.iter().map(|(at, _)| at[k]).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        });
        let mut points = vec![vec![None; values[0].len()]; values[1].len()];
        for (k, (at, _)) in map.points.iter().enumerate() {
            let [i, j] = [0, 1].map(|a| values[a].partition_point(|v| *v < at[a]));
            points[j][i] = Some(k);
        }
        Grid { values, points, of: map.points.iter().map(|(_, value)| *value).collect() }
    }

    /// Rectangles that reach half way to the neighbours; cells of the same colour beside each other are one.
    fn cells(&self, plot: &Plot, scale: &PlotAxis) -> Markup {
        let x = edges(&self.values[0], &plot.x).into_iter().map(|v| plot.x(v)).collect::<Vec<_>>();
        let y = edges(&self.values[1], &plot.y).into_iter().map(|v| plot.y(v)).collect::<Vec<_>>();
        let coloured = |point: &Option<usize>| {
            point.map(|k| self.of[k]).filter(|v| v.is_finite()).map(|v| colour(v, scale))
        };
        html! {
            @for (j, row) in self.points.iter().enumerate() {
                @let colours: Vec<Option<String>> = row.iter().map(coloured).collect();
                @for (from, to, colour) in runs(&colours) {
                    rect x=(x2(x[from])) width=(x2(x[to] - x[from])) y=(x2(y[j + 1])) height=(x2(y[j] - y[j + 1])) fill=(colour)
                        stroke=(colour) stroke-width="0.4" {}
                }
            }
        }
    }

    /// The path where `function` is 1, by marching squares.
    fn contour(&self, plot: &Plot, function: &[f64]) -> String {
        let corner = |i: usize, j: usize| {
            let place = plot.at((self.values[0][i], self.values[1][j]));
            (place, self.points[j][i].map_or(f64::NAN, |k| function[k] - 1.0))
        };
        let mut data = String::new();
        for j in 1..self.points.len() {
            for i in 1..self.points[j].len() {
                let square = [corner(i - 1, j - 1), corner(i, j - 1), corner(i, j), corner(i - 1, j)];
                let crossings: Vec<Point> =
                    (0..4).filter_map(|k| crossing(square[k], square[(k + 1) % 4])).collect();
                for ends in crossings.chunks_exact(2) {
                    data += &format!("M{:.2} {:.2}L{:.2} {:.2}", ends[0].0, ends[0].1, ends[1].0, ends[1].1);
                }
            }
        }
        data
    }
}

/// Neighbours of the same colour: from which to before which.
fn runs(colours: &[Option<String>]) -> impl Iterator<Item = (usize, usize, &String)> {
    let same = colours.chunk_by(|a, b| a == b);
    let placed = same.scan(0, |to, same| {
        let from = std::mem::replace(to, *to + same.len());
        Some((from, *to, same[0].as_ref()))
    });
    placed.filter_map(|(from, to, colour)| Some((from, to, colour?)))
}

/// Where a function that has these values at two places is zero, if it is between them.
fn crossing((a, from): (Point, f64), (b, to): (Point, f64)) -> Option<Point> {
    let s = from / (from - to);
    ((from < 0.0) != (to < 0.0) && s.is_finite()).then_some((a.0 + s * (b.0 - a.0), a.1 + s * (b.1 - a.1)))
}

/// The ends of the axis, and the middles between neighbours.
fn edges(values: &[f64], axis: &PlotAxis) -> Vec<f64> {
    let [low, high] = axis.ends();
    let middles = values.windows(2).map(|pair| axis.between(pair[0], pair[1]));
    std::iter::once(low).chain(middles).chain([high]).collect()
}

fn colour(value: f64, scale: &PlotAxis) -> String {
    let step = (scale.place(value) * COLOURS as f64).floor().min(COLOURS as f64 - 1.0);
    hex(cividis(step / (COLOURS - 1) as f64))
}

fn dot((x, y): Point, fill: &str) -> Markup {
    html! { circle cx=(x2(x)) cy=(x2(y)) r="3.5" fill=(fill) {} }
}

fn ring((x, y): Point, fill: &str) -> Markup {
    html! {
        circle cx=(x2(x)) cy=(x2(y)) r="7" fill="#ffffff" stroke="#1a1a1a" stroke-width="1.4" {}
        circle cx=(x2(x)) cy=(x2(y)) r="4.6" fill=(fill) {}
    }
}

/// Dark on light ground and light on dark.
fn contour(data: &str) -> Markup {
    html! {
        path d=(data) fill="none" stroke="#ffffff" stroke-width="4" {}
        path d=(data) fill="none" stroke="#1a1a1a" stroke-width="1.6" {}
    }
}

fn colour_bar(label: &str, scale: &PlotAxis, top: f64) -> Markup {
    let x = CHART_WIDTH - RIGHT + 22.0;
    let step = HEIGHT / COLOURS as f64;
    let marks = scale.marks(6);
    let [low, _] = scale.ends();
    html! {
        @for k in 0..COLOURS {
            @let fill = hex(cividis(k as f64 / (COLOURS - 1) as f64));
            rect x=(x) width="14" y=(x2(top + HEIGHT - step * (k + 1) as f64)) height=(x2(step)) fill=(fill) stroke=(fill) stroke-width="0.4" {}
        }
        rect.fig-frame x=(x) y=(top) width="14" height=(HEIGHT) {}
        @for mark in marks.iter().filter(|mark| **mark >= low) {
            text x=(x + 19.0) y=(x2(top + HEIGHT * (1.0 - scale.place(*mark)) + 4.7)) { (scale.label(*mark, &marks)) }
        }
        (upright(CHART_WIDTH - 10.0, top + 0.5 * HEIGHT, label))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane() -> ColourMap {
        let at = (0..5).flat_map(|i| (0..4).map(move |j| [1.0 + f64::from(i), 10.0 * f64::from(j)]));
        let points: Vec<([f64; 2], f64)> = at.map(|at| (at, at[0])).collect();
        let line = points.iter().map(|(at, _)| at[0] / 2.5).collect();
        ColourMap {
            points,
            is_grid: true,
            line: Some(("said".into(), line)),
            marks: ("reference".into(), vec![([3.0, 10.0], 3.0)]),
            labels: ["first".into(), "second".into()],
            value_label: "value in %".into(),
            ..ColourMap::default()
        }
    }

    /// A value that is the first parameter: a column per colour, from the darkest to the lightest.
    #[test]
    fn cells_have_the_colours_of_their_values_and_the_contour_lies_where_the_function_is_one() {
        let svg = colour_maps("plane", &[plane()]);
        let [dark, light] = [0.0, 1.0].map(cividis).map(|colour| format!("fill=\"{}\"", hex(colour)));
        // 4 rows, and the scale's own end
        assert_eq!(svg.matches(&dark).count(), 4 + 1, "{svg}");
        assert_eq!(svg.matches(&light).count(), 4 + 1);
        let width = (CHART_WIDTH - LEFT - RIGHT) / 5.0;
        let x = LEFT + width * 2.0;
        assert!(
            svg.contains(&format!("M{x:.2}")),
            "the contour at 2.5, between the second and the third column: {svg}"
        );
        for word in ["first", "second", "value in %", "said", "reference"] {
            assert!(svg.contains(word), "{word}");
        }
        assert!(crate::plot::png(&svg, 1.0).expect("PNG").starts_with(b"\x89PNG"));
    }

    #[test]
    fn a_point_without_a_value_is_omitted_and_irregular_points_are_dots() {
        let mut map = plane();
        map.points[0].1 = f64::NAN;
        map.is_grid = false;
        let svg = colour_maps("dots", &[map]);
        assert_eq!(svg.matches("r=\"3.5\"").count(), 19);
        assert!(!svg.contains("NaN"), "{svg}");
    }
}
