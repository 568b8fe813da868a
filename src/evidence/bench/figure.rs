//! Work-precision diagrams: run time over error, both logarithmic, one panel per problem and number of modes.

use super::{Bench, WorkPrecision};
use maud::{Markup, PreEscaped, html};

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
        svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height)
            viewBox=(format!("0 0 {width} {height}")) font-family="DejaVu Sans, sans-serif" font-size="11" role="img" {
            title { "Run time against error" }
            rect width=(width) height=(height) fill="#ffffff" {}
            @for (i, panel) in panels.iter().enumerate() {
                g transform=(format!("translate({} {})", (i % COLUMNS) as f64 * PANEL.0, (i / COLUMNS) as f64 * PANEL.1)) {
                    (draw(panel, &solvers))
                }
            }
            @for (i, solver) in solvers.iter().enumerate() {
                @let x = 20.0 + (i % COLUMNS) as f64 * PANEL.0;
                @let y = rows as f64 * PANEL.1 + 20.0 + (i / COLUMNS) as f64 * LEGEND_LINE;
                (mark(x, y - 4.0, 4.0, i))
                text x=(x + 12.0) y=(y) fill="#1a1a1a" { (solver) }
            }
            text x="20" y=(height - 8.0) fill="#555555" { (bench.machine) }
        }
    };
    drawing.into_string()
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
fn mark(x: f64, y: f64, radius: f64, solver: usize) -> Markup {
    let fill = if solver < COLOURS.len() { colour(solver) } else { "#ffffff" };
    html! {
        circle cx=(format!("{x:.1}")) cy=(format!("{y:.1}")) r=(radius) fill=(fill) stroke=(colour(solver))
            stroke-width="1.2" {}
    }
}

/// A decade axis that holds the values: from and to as powers of ten.
fn decades(values: impl Iterator<Item = f64>) -> (i32, i32) {
    let (low, high) = values
        .filter(|v| *v > 0.0)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v.log10()), high.max(v.log10())));
    if low > high { (-1, 0) } else { (low.floor() as i32, (high.ceil() as i32).max(low.floor() as i32 + 1)) }
}

fn draw(panel: &BenchPanel, solvers: &[String]) -> Markup {
    let (left, top, right, bottom) = MARGIN;
    let (wide, high) = (PANEL.0 - left - right, PANEL.1 - top - bottom);
    let errors = decades(panel.runs.iter().map(|r| r.relative_error.max(1e-13)));
    let times = decades(panel.runs.iter().map(|r| r.seconds));
    let x = |error: f64| {
        left + wide * (error.max(1e-13).log10() - f64::from(errors.0)) / f64::from(errors.1 - errors.0)
    };
    let y =
        |time: f64| top + high * (1.0 - (time.log10() - f64::from(times.0)) / f64::from(times.1 - times.0));
    html! {
        text x=(left) y=(top - 12.0) fill="#1a1a1a" { (panel.title) }
        @for decade in errors.0..=errors.1 {
            @let at = x(10_f64.powi(decade));
            line x1=(at) x2=(at) y1=(top) y2=(top + high) stroke="#e3e3e3" {}
            @if (decade - errors.0) % 2 == 0 {
                text x=(at) y=(top + high + 16.0) text-anchor="middle" fill="#1a1a1a" { (power(decade)) }
            }
        }
        @for decade in times.0..=times.1 {
            @let at = y(10_f64.powi(decade));
            line x1=(left) x2=(left + wide) y1=(at) y2=(at) stroke="#e3e3e3" {}
            text x=(left - 6.0) y=(at + 4.0) text-anchor="end" fill="#1a1a1a" { (power(decade)) }
        }
        rect x=(left) y=(top) width=(wide) height=(high) fill="none" stroke="#444444" {}
        text x=(left + 0.5 * wide) y=(top + high + 34.0) text-anchor="middle" fill="#1a1a1a" { "relative error of the efficiency" }
        text transform=(format!("translate(16 {}) rotate(-90)", top + 0.5 * high)) text-anchor="middle" fill="#1a1a1a" { "run time in s" }
        @for (i, solver) in solvers.iter().enumerate() {
            @let points: Vec<(f64, f64)> =
                panel.runs.iter().filter(|r| &r.solver == solver).map(|r| (x(r.relative_error), y(r.seconds))).collect();
            @if points.len() > 1 {
                polyline fill="none" stroke=(colour(i)) stroke-width="1.4"
                    points=(PreEscaped(points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect::<Vec<_>>().join(" "))) {}
            }
            @for (x, y) in &points {
                (mark(*x, *y, 2.6, i))
            }
        }
    }
}

/// 10^n as a mark.
fn power(n: i32) -> String {
    format!("1e{n}")
}
