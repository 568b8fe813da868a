//! Results over commits in the report: a line per number, with what the gate admits.

use crate::ci::trend::Trend;
use crate::format::{prefixed, significant, with_unit, words};
use crate::plot::polyline::path;
use crate::plot::svg::x2;
use crate::report::Attachments;
use crate::report::page::html::{badge, scrolled};
use maud::{Markup, html};

/// Size of a sparkline in px, and the most commits it shows.
const WIDTH: f64 = 150.0;
const HEIGHT: f64 = 30.0;
const COMMITS: usize = 100;
/// Characters of a hash that are shown.
const SHORT: usize = 9;

/// Section of a scene's page; nothing if nothing was recorded.
pub(crate) fn trends_html(attachments: &Attachments) -> Markup {
    let trends = &attachments.trends;
    if trends.is_empty() {
        return html! {};
    }
    let drifting = trends.iter().filter(|t| t.drifts_since.is_some()).count();
    html! {
        p.soft {
            "Gated numbers over the commits recorded, oldest first; shaded is what does not fail the gate now (darker: what passes, between them it is undecided), and for the reference its uncertainty (95 %). A number drifts "
            "since the commit from which on it is farther than a tenth of its tolerance from its first value. "
            strong { (drifting) " of " (trends.len()) @if drifting == 1 { " numbers drifts." } @else { " numbers drift." } }
        }
        (scrolled("Trends", &html! { table.trends {
            thead { tr {
                th scope="col" { "quantity" } th.left scope="col" { "of" } th.left scope="col" { "verdict" } th.left scope="col" { "course" }
                th scope="col" { "commits" } th scope="col" { "first" } th scope="col" { "last" } th scope="col" { "change" }
                th.left scope="col" { "drifts since" }
            } }
            tbody { @for trend in trends { (row(trend)) } }
        } }))
    }
}

fn row(trend: &Trend) -> Markup {
    let (first, last) = (trend.points.first(), trend.points.last());
    let value = |point: Option<&(String, f64)>| point.map_or(f64::NAN, |p| p.1);
    let to = prefixed(&trend.unit, value(last).abs().max(value(first).abs()));
    html! {
        tr data-model=(trend.model) data-quantity=(trend.quantity) {
            th scope="row" { (words(&trend.quantity)) }
            td.left { (trend.model) }
            td.left { (badge(trend.verdict)) }
            td.left { (sparkline(trend)) }
            td { (trend.points.len()) }
            td data-si=(value(first)) { (with_unit(value(first), to, 5)) }
            td data-si=(value(last)) { (with_unit(value(last), to, 5)) }
            td data-si=(trend.change()) { (with_unit(trend.change(), to, 2)) }
            td.left { @match trend.drifts_since.map(|k| &trend.points[k].0) {
                Some(commit) => code title=(commit) { (short(commit)) },
                None => "–",
            } }
        }
    }
}

fn short(commit: &str) -> String {
    let dirty = if commit.ends_with(crate::ci::commit::DIRTY) { "+" } else { "" };
    commit.chars().take(SHORT).chain(dirty.chars()).collect()
}

fn sparkline(trend: &Trend) -> Markup {
    let skipped = trend.points.len().saturating_sub(COMMITS);
    let values: Vec<f64> = trend.points[skipped..].iter().map(|p| p.1).collect();
    let edges = trend.admissible.map(|(low, high)| [low, high]);
    let all = || values.iter().copied().chain(edges.into_iter().flatten()).filter(|v| v.is_finite());
    let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    let span = if high > low { high - low } else { low.abs().max(1.0) };
    let (low, span) = (low - 0.1 * span, 1.2 * span);
    let y = |value: f64| HEIGHT * (1.0 - (value - low) / span);
    let step = WIDTH - 8.0;
    let x = |k: usize| 4.0 + step * k as f64 / values.len().saturating_sub(1).max(1) as f64;
    let points: Vec<_> = values.iter().enumerate().map(|(k, v)| (x(k), y(*v))).collect();
    let name = format!(
        "{} of {} over {} commits, last {} {}",
        words(&trend.quantity),
        trend.model,
        values.len(),
        values.last().map_or_else(String::new, |v| significant(*v, 5)),
        trend.unit
    );
    html! {
        svg.spark viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) width=(WIDTH) height=(HEIGHT) role="img" aria-label=(name) {
            @for (from, to) in [trend.admissible, trend.passing].into_iter().flatten() {
                rect.fig-band x="0" width=(WIDTH) y=(x2(y(to))) height=(x2(y(from) - y(to))) {}
            }
            path.fig-B d=(path(&points)) fill="none" stroke-width="1.6" stroke-linejoin="round" {}
            @if let Some(k) = trend.drifts_since.and_then(|k| k.checked_sub(skipped)) {
                circle.fig-A cx=(x2(points[k].0)) cy=(x2(points[k].1)) r="3.4" fill="none" stroke-width="1.6" {}
            }
            @if let Some(last) = points.last() { circle.fig-part cx=(x2(last.0)) cy=(x2(last.1)) r="2.4" {} }
        }
    }
}
