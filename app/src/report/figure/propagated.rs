//! How results scatter: histogram, shares of the variance and what one input alone changes, quantity below quantity.

use crate::format::{percent, prefixed, words};
use crate::plot::axis::{Plot, PlotAxis};
use crate::plot::chart::{CHART_WIDTH, LEFT};
use crate::plot::polyline::path;
use crate::plot::svg::{Svg, Theme, x2};
use crate::uncertainty::{PropagatedUncertainty, QuantityUncertainty, Share};
use maud::{Markup, html};

/// Most bars of a histogram.
const BINS: usize = 40;
/// Values that a bar has on the average, at least.
const PER_BIN: usize = 12;
const HISTOGRAM: f64 = 262.0;
const HEIGHT: f64 = 176.0;
const ROW: f64 = 38.0;
/// Room above a quantity's drawings, for its name and headings, and below.
const HEAD: f64 = 46.0;
const FOOT: f64 = 62.0;
/// Where the bars of both columns begin, and how long they can be.
const SHARES: f64 = 372.0;
const TORNADO: f64 = 574.0;
const COLUMN: f64 = 166.0;
const BAR: f64 = 13.0;
const SMALL: f64 = 11.5;
const BLUE: &str = "#0072b2";
const PALE: &str = "#a9cfe6";
const ORANGE: &str = "#d55e00";

/// The figure of the quantities called `quantities` as a stand-alone SVG.
pub fn propagation_figure(propagated: &PropagatedUncertainty, quantities: &[String]) -> String {
    let found = quantities.iter().filter_map(|name| Some((name, propagated.quantities.get(&**name)?)));
    let quantities: Vec<(&String, &QuantityUncertainty)> = found.collect();
    let block = HEAD + HEIGHT.max(ROW * propagated.inputs.len() as f64) + FOOT;
    let content = html! {
        @for (k, (name, of)) in quantities.iter().enumerate() {
            @let top = 8.0 + block * k as f64;
            text x=(8) y=(x2(top + 16.0)) font-weight="bold" { (words(name)) }
            (histogram(of, top + HEAD))
            (bars(of, top + HEAD))
        }
    };
    let title = format!("{}: propagated input uncertainty, model {}", propagated.scene, propagated.model);
    let size = [CHART_WIDTH, 8.0 + block * quantities.len() as f64];
    Svg::new(&title, size, Theme::Standalone).around(&content).into_string()
}

/// How often which values occur, with 95 % of them shaded and the nominal result marked.
fn histogram(of: &QuantityUncertainty, top: f64) -> Markup {
    let (Some(first), Some(last)) = (of.values.first(), of.values.last()) else { return html! {} };
    let to = prefixed(of.unit, of.mean);
    let bins = (of.values.len() / PER_BIN).clamp(1, BINS);
    let width = (last - first) / bins as f64;
    let mut counts = vec![0_usize; bins];
    for value in &of.values {
        counts[(((value - first) / width) as usize).min(bins - 1)] += 1;
    }
    let share = |count: usize| 100.0 * count as f64 / of.values.len() as f64;
    let highest = counts.iter().copied().max().unwrap_or(0);
    let x = PlotAxis::over([*first, *last].into_iter().chain(of.nominal).map(|v| v * to.factor), false)
        .widened(0.03);
    let y = PlotAxis::over([0.0, share(highest)].into_iter(), false).of_quantity();
    let plot = Plot { left: LEFT, top, width: HISTOGRAM, height: HEIGHT, x, y };
    let (x_marks, y_marks) = (x.marks(4), y.marks(4));
    let mut outline = vec![plot.at((first * to.factor, 0.0))];
    for (k, count) in counts.iter().enumerate() {
        for end in [k, k + 1] {
            outline.push(plot.at(((first + width * end as f64) * to.factor, share(*count))));
        }
    }
    outline.push(plot.at((last * to.factor, 0.0)));
    let [low, high] = of.interval().map(|v| plot.x(v * to.factor));
    let label = if to.unit.is_empty() { "value".to_owned() } else { format!("value in {}", to.unit) };
    html! {
        rect.fig-range x=(x2(low)) width=(x2(high - low)) y=(x2(top)) height=(HEIGHT) {}
        (plot.grid(&x_marks, &y_marks))
        path d=(path(&outline)) fill=(PALE) stroke=(BLUE) stroke-width="1.2" {}
        @if let Some(nominal) = of.nominal {
            @let x = plot.x(nominal * to.factor);
            line.fig-note x1=(x2(x)) x2=(x2(x)) y1=(x2(top)) y2=(x2(top + HEIGHT)) {}
        }
        text x=(x2(LEFT)) y=(x2(top - 8.0)) font-size=(SMALL) { "shaded: 95 % of the values; dashed: nominal" }
        (plot.frame(&x_marks, &y_marks, [&label, "share of values in %"]))
    }
}

/// Per input its share of the variance, and what it alone changes.
fn bars(of: &QuantityUncertainty, top: f64) -> Markup {
    let ranking = of.ranking();
    let relative = |inputs: &str| {
        let (local, nominal) = (of.local.get(inputs)?, of.nominal?);
        Some(local.results.map(|result| (result - nominal) / nominal.abs()))
    };
    let changes = ranking.iter().filter_map(|(inputs, _)| relative(inputs)).flatten();
    let reach = changes.map(f64::abs).filter(|v| v.is_finite()).fold(f64::MIN_POSITIVE, f64::max);
    let middle = TORNADO + 0.5 * COLUMN;
    let change = |value: f64| middle + 0.5 * COLUMN * value / reach;
    html! {
        text x=(SHARES) y=(x2(top - 8.0)) font-size=(SMALL) { "share of variance; pale: with interactions" }
        text x=(x2(middle)) y=(x2(top + 4.0)) font-size=(SMALL) text-anchor="middle" { "input by one standard deviation" }
        text x=(x2(middle)) y=(x2(top + 18.0)) font-size=(SMALL) text-anchor="middle" {
            tspan fill=(ORANGE) { "lower" } ", " tspan fill=(BLUE) { "higher" }
        }
        @for (k, (inputs, share)) in ranking.iter().enumerate() {
            @let y = top + 24.0 + ROW * k as f64;
            text x=(SHARES) y=(x2(y - 3.0)) font-size=(SMALL) { (inputs) }
            (share_bar(share, y))
            line.fig-frame x1=(x2(middle)) x2=(x2(middle)) y1=(x2(y - 2.0)) y2=(x2(y + BAR + 2.0)) {}
            @if let Some([low, high]) = relative(inputs) {
                @for (value, colour) in [(low, ORANGE), (high, BLUE)] {
                    @let (from, to) = (middle.min(change(value)), middle.max(change(value)));
                    rect x=(x2(from)) width=(x2(to - from)) y=(x2(y)) height=(BAR) fill=(colour) {}
                }
                text x=(x2(middle)) y=(x2(y + BAR + 12.0)) font-size=(SMALL - 1.0) text-anchor="middle" {
                    tspan fill=(ORANGE) { (percent(Some(low))) } ", " tspan fill=(BLUE) { (percent(Some(high))) }
                }
            }
        }
    }
}

fn share_bar(Share { first, total, first_interval, .. }: &Share, y: f64) -> Markup {
    let length = |share: f64| COLUMN * share.clamp(0.0, 1.0);
    let [low, high] = first_interval.map(|end| SHARES + length(end));
    html! {
        rect x=(SHARES) width=(x2(length(*total))) y=(x2(y)) height=(BAR) fill=(PALE) {}
        rect x=(SHARES) width=(x2(length(*first))) y=(x2(y)) height=(BAR) fill=(BLUE) {}
        line.fig-frame x1=(x2(low)) x2=(x2(high)) y1=(x2(y + 0.5 * BAR)) y2=(x2(y + 0.5 * BAR)) {}
        text x=(x2(SHARES + COLUMN + 4.0)) y=(x2(y + 0.8 * BAR)) font-size=(SMALL - 1.0) { (format!("{:.0} %", 100.0 * first)) }
        rect.fig-frame x=(SHARES) width=(COLUMN) y=(x2(y)) height=(BAR) {}
    }
}
