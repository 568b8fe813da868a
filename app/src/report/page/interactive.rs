//! The interactive panels of a scene's page, their data and scripts; the page stays whole without scripts and on paper.

use crate::report::SceneReport;
use crate::report::figure::geometry::PanelOf;
use crate::report::page::html::detailed;
use crate::report::page::page_data::{curves, embedded};
use maud::{Markup, PreEscaped, html};

/// uPlot by Leon Sorokin, MIT.
const PLOTTING: &str = include_str!("assets/uPlot.iife.min.js");
const PLOTTING_LICENCE: &str = include_str!("assets/LICENSE.uPlot");
const PANELS: &str = include_str!("assets/panels.js");
/// Style sheet of the panels.
pub(crate) const STYLE: &str = include_str!("assets/uPlot.min.css");

/// The place of the panels: a `drawing` (SVG) for print and without scripts, made interactive by the script.
pub(crate) fn panels(drawing: String) -> Markup {
    html! {
        div.live {
            div #controls role="group" aria-label="Curves shown" {}
            div #panels {}
            div #time role="group" aria-label="Time axis of all panels" {}
            p.soft { "Drag across a panel to zoom all of them, double-click to see everything again." }
        }
        figure.drawn { (detailed("Curves", &PreEscaped(drawing))) }
    }
}

/// The comparison and the curves as the page carries them, and the scripts that show them.
pub(crate) fn scripts(report: &SceneReport, panels: &[PanelOf]) -> Markup {
    html! {
        script type="application/json" id="comparison" { (PreEscaped(embedded(&report.comparison))) }
        @if report.comparison.window.is_some() {
            script type="application/json" id="curves" { (PreEscaped(embedded(&curves(report, panels)))) }
            script type="text/javascript" { (PreEscaped(plotting())) }
            script type="text/javascript" { (PreEscaped(PANELS)) }
        }
    }
}

/// The plotting library with its licence in place of the line that names its address.
pub(crate) fn plotting() -> String {
    let code = PLOTTING.split_once('\n').map_or(PLOTTING, |(_, code)| code);
    format!("/*! uPlot 1.6.32\n{PLOTTING_LICENCE}*/\n{code}")
}
