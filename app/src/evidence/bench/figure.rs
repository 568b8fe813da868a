//! Work-precision diagrams: run time over error, both logarithmic, one panel per problem and number of modes.

use super::{Bench, WorkPrecision};
use crate::plot::axis::{Plot, PlotAxis};
use crate::plot::polyline::{Point, path};
use crate::plot::{Svg, Theme};
use maud::{Markup, html};

const PANEL: (f64, f64) = (400.0, 300.0);
const MARGIN: (f64, f64, f64, f64) = (70.0, 34.0, 14.0, 52.0);
const COLUMNS: usize = 2;
const LEGEND_LINE: f64 = 18.0;
/// Okabe and Ito's colours, which colour-blind readers can tell apart.
const COLOURS: [&str; 8] =
    ["#1a1a1a", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f"];

/// One panel: title and runs.
struct BenchPanel<'a> {
    title: String,
    runs: Vec<&'a WorkPrecision>,
}

/// The document's runs as SVG.
pub fn figure(bench: &Bench) -> String {
    let panels = panels(bench);
    let solvers = names(&bench.work_precision);
    let rows = panels.len().div_ceil(COLUMNS);
    let legend_rows = solvers.len().div_ceil(COLUMNS) as f64;
    let width = COLUMNS as f64 * PANEL.0;
    let height = rows as f64 * PANEL.1 + legend_rows * LEGEND_LINE + 30.0;
    let drawing = html! {
        @for (i, panel) in panels.iter().enumerate() {
            g transform=(format!("translate({} {})", (i % COLUMNS) as f64 * PANEL.0, (i / COLUMNS) as f64 * PANEL.1)) {
                (draw(panel, &solvers))
            }
        }
        @for (i, solver) in solvers.iter().enumerate() {
            @let x = 20.0 + (i % COLUMNS) as f64 * PANEL.0;
            @let y = rows as f64 * PANEL.1 + 20.0 + (i / COLUMNS) as f64 * LEGEND_LINE;
            (mark((x, y - 4.0), 4.0, i))
            text x=(x + 12.0) y=(y) { (solver) }
        }
        text x="20" y=(height - 8.0) { (bench.machine) ", " (bench.compiler) }
    };
    Svg::new("Run time against error", [width, height], Theme::Standalone).around(&drawing).into_string()
}

fn panels(bench: &Bench) -> Vec<BenchPanel<'_>> {
    let mut panels: Vec<BenchPanel> = Vec::new();
    for run in &bench.work_precision {
        // integrators: a panel per number of modes; models: one for all
        let title = match (run.tolerance, run.modes) {
            (Some(_), Some(1)) => format!("{}, 1 mode", run.problem),
            (Some(_), Some(modes)) => format!("{}, {modes} modes", run.problem),
            _ => run.problem.clone(),
        };
        match panels.iter_mut().find(|panel| panel.title == title) {
            Some(panel) => panel.runs.push(run),
            None => panels.push(BenchPanel { title, runs: vec![run] }),
        }
    }
    panels
}

fn names(runs: &[WorkPrecision]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for run in runs {
        if !names.contains(&run.solver) {
            names.push(run.solver.clone());
        }
    }
    names
}

fn colour(solver: usize) -> &'static str {
    COLOURS[solver % COLOURS.len()]
}

/// The mark of a solver's run; hollow where the colours are used a second time.
fn mark((x, y): Point, radius: f64, solver: usize) -> Markup {
    let fill = if solver < COLOURS.len() { colour(solver) } else { "#ffffff" };
    html! {
        circle cx=(format!("{x:.1}")) cy=(format!("{y:.1}")) r=(radius) fill=(fill) stroke=(colour(solver))
            stroke-width="1.2" {}
    }
}

fn draw(panel: &BenchPanel, solvers: &[String]) -> Markup {
    let (left, top, right, bottom) = MARGIN;
    // an exact result has a place too
    let error = |run: &WorkPrecision| run.relative_error.max(1e-13);
    let axis = |values: &mut dyn Iterator<Item = f64>| PlotAxis::over(values, true).widened(0.04);
    let plot = Plot {
        left,
        top,
        width: PANEL.0 - left - right,
        height: PANEL.1 - top - bottom,
        x: axis(&mut panel.runs.iter().map(|run| error(run))),
        y: axis(&mut panel.runs.iter().map(|run| run.seconds)),
    };
    let (x_marks, y_marks) = (plot.x.marks(7), plot.y.marks(9));
    html! {
        text x=(left) y=(top - 12.0) { (panel.title) }
        (plot.grid(&x_marks, &y_marks))
        (plot.frame(&x_marks, &y_marks, ["relative error of the efficiency", "run time in s"]))
        @for (i, solver) in solvers.iter().enumerate() {
            @let own = panel.runs.iter().filter(|run| run.solver == *solver);
            @let points: Vec<Point> = own.map(|run| plot.at((error(run), run.seconds))).collect();
            @if points.len() > 1 { path d=(path(&points)) fill="none" stroke=(colour(i)) stroke-width="1.4" {} }
            @for point in &points { (mark(*point, 2.6, i)) }
        }
    }
}
