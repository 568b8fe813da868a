//! Where the sphere flies after the impact: the chamber in section with its path, the launch's band and the seats, the energy
//! landscape below it, the map of landings and the thresholds of vibration.

use crate::flight::{Flight, Landscape, Launch, Setup, Vector, fly};
use crate::format;
use crate::format::{model_name, prefixed, with_unit};
use crate::kinds::flight::flight_of;
use crate::plot::svg::{Svg, Theme, x2};
use crate::report::SceneReport;
use crate::report::figure::landing_map::map_picture;
use crate::report::figure::scene_drawing::DrawingScale;
use crate::report::figure::vibration::vibration_chart;
use crate::report::page::html::scrolled;
use crate::result::{FlightSummary, Summary};
use crate::scene::Scene;
use maud::{Markup, PreEscaped, html};

/// Width of both pictures in px, and their margin.
const WIDTH: f64 = 640.0;
const MARGIN: f64 = 12.0;
/// Height of the landscape in px.
const LANDSCAPE: f64 = 150.0;
/// Length of the launch's band over the sphere's radius.
const BAND: f64 = 3.0;

/// [`flight_html`] of a comparison.
pub(crate) fn flights_html(report: &SceneReport) -> Markup {
    let models: Vec<&Summary> = report.reduced.iter().map(|outcome| &outcome.summary).collect();
    flight_html(report.scene, &models, report.comparison.reference.flight.as_ref())
}

/// Verdicts of the `models` and of the `reference`, pictures of the first model's flight, thresholds of vibration; empty if the scene asks for none.
pub(crate) fn flight_html(scene: &Scene, models: &[&Summary], reference: Option<&FlightSummary>) -> Markup {
    let models = models.iter().copied();
    let flown: Vec<(&Summary, &FlightSummary)> =
        models.clone().filter_map(|summary| Some((summary, summary.flight.as_ref()?))).collect();
    let shaken: Vec<_> = models.filter_map(|summary| Some((summary, summary.vibration?))).collect();
    let reference = reference.map(|flight| ("FE".to_owned(), flight));
    let launches =
        reference.into_iter().chain(flown.iter().map(|(summary, flight)| (model(summary), *flight)));
    let quantity = |value: Option<f64>, unit| {
        value.map_or_else(|| "none".to_owned(), |value| with_unit(value, prefixed(unit, value), 4))
    };
    html! {
        @if let Some(&(_, first)) = flown.first() {
        (scrolled("Where the sphere lands", &html! { table {
            thead { tr { th { "launched by" } th { "seat" } th { "certain after" } th { "margin of speed" } th { "share in the other seat" }
                th { "least speed to shift" } th { "restitution" } } }
            tbody { @for (name, flight) in launches { tr {
                th scope="row" { (name) }
                td { (flight.seat) }
                td { (quantity(Some(flight.time), "s")) }
                td { (flight.margin.map_or_else(|| "over 50 %".to_owned(), percent)) }
                td { (percent(flight.share)) }
                td { (quantity(Some(flight.least_speed), "m/s")) }
                td { (format::significant(flight.restitution, 3)) }
            } } }
        } }))
        @for (_, flight) in &flown { @if let Some(reason) = &flight.reason { p { (model_reason(reason)) } } }
        (pictures(scene, first))
        }
        @for (summary, vibration) in shaken {
            p { "Vibration, by the launch's chamber of model " (model(summary)) ": unseats at " (quantity(vibration.unseats, "m/s^2"))
                ", shifts at " (quantity(vibration.shifts, "m/s^2")) "; by energy it takes at least " (quantity(Some(vibration.energy_bound), "m/s^2")) "." }
        }
    }
}

fn model(summary: &Summary) -> String {
    model_name(summary.model.as_deref().unwrap_or("?"), summary.modes)
}

fn model_reason(reason: &str) -> String {
    let mut letters = reason.chars();
    letters.next().map_or_else(String::new, |first| format!("{}{}.", first.to_uppercase(), letters.as_str()))
}

fn percent(share: f64) -> String {
    format!("{} %", format::significant(100.0 * share, 3))
}

fn pictures(scene: &Scene, summary: &FlightSummary) -> Markup {
    let Ok((setup, landscape)) = flight_of(scene, summary.restitution) else { return html! {} };
    let flight = fly(&setup, &landscape, &summary.launch, true);
    let Some(deviation) = scene.flight.as_ref().map(|flight| flight.deviation) else { return html! {} };
    let shaken =
        scene.vibration.as_ref().and_then(|vibration| vibration_chart(&setup, &landscape, vibration));
    html! {
        figure {
            (section(&setup, &flight, &summary.launch, deviation.angle))
            (landscape_picture(&setup, &landscape, &summary.launch))
            figcaption { "The chamber in section with the path of the sphere's centre until its seat is certain, the seats (dashed) and the band of the launch's \
                angle. Below: the least energy with which the sphere can be at x, its saddle, and the energy of the launch (dashed)." }
        }
        figure {
            (PreEscaped(map_picture(&setup, &landscape, summary, &deviation)))
            figcaption { "Outcome over speed and angle of the release (ring: this release). Below: releases within the range of the share above." }
        }
        @if let Some(chart) = shaken {
            figure {
                (PreEscaped(chart))
                figcaption { "The least amplitude that shifts, over the frequency (of a half-sine that of the whole sine). Below the limit of statics the sphere stays in its \
                    seat; below that of energy, √(2ΔU/m) over the integral of the acceleration's magnitude, it can't pass the saddle." }
            }
        }
    }
}

/// The chamber up to what the path reaches.
fn section(setup: &Setup, flight: &Flight, launch: &Launch, deviation: f64) -> Markup {
    let [low, high] = setup.chamber.columns().map(|x| x * (1.0 + setup.radius / x.abs().max(1e-12)));
    let highest = flight.path.iter().map(|state| state.place.y).fold(setup.chamber.seats()[0].y, f64::max);
    let top = (highest + 1.2 * setup.radius).min(setup.chamber.ceiling() + setup.radius);
    let bottom = setup.chamber.corners().iter().map(|corner| corner.y).fold(f64::INFINITY, f64::min);
    let factor = (WIDTH - 2.0 * MARGIN) / (high - low);
    let scale = DrawingScale { factor, left: low, top, margin: MARGIN };
    let height = 2.0 * MARGIN + (top - bottom) * factor;
    // walls end where the picture does
    let corners: Vec<[f64; 2]> = setup.chamber.corners().iter().map(|c| [c.x, c.y.min(top)]).collect();
    let path: Vec<[f64; 2]> = flight.path.iter().map(|state| [state.place.x, state.place.y]).collect();
    let seats = setup.chamber.seats();
    let ray = |angle: f64| {
        let end = seats[0] + BAND * setup.radius * Vector::new(angle.sin(), angle.cos());
        [[seats[0].x, seats[0].y], [end.x, end.y]]
    };
    let drawing = html! {
        polygon.fig-hollow points=(scale.points(&corners)) stroke="#9a7f3c" stroke-width="1.5" {}
        @for side in [-1.0, 1.0] { polyline points=(scale.points(&ray(launch.angle + side * deviation))) fill="none" stroke="#777" stroke-width="1" {} }
        @for seat in seats {
            circle cx=(x2(scale.x(seat.x))) cy=(x2(scale.z(seat.y))) r=(x2(setup.radius * factor)) fill="none" stroke="#777" stroke-dasharray="4 3" {}
        }
        polyline points=(scale.points(&path)) fill="none" stroke="#009e73" stroke-width="2" stroke-linejoin="round" {}
    };
    Svg::new("Path of the sphere in the chamber", [WIDTH, height], Theme::Inline).around(&drawing)
}

/// Energy over x, on the same x as the section.
fn landscape_picture(setup: &Setup, landscape: &Landscape, launch: &Launch) -> Markup {
    let [low, high] = setup.chamber.columns().map(|x| x * (1.0 + setup.radius / x.abs().max(1e-12)));
    let kinetic = 0.5 * setup.mass * launch.speed.powi(2);
    let top = 1.15 * kinetic.max(landscape.saddle.energy);
    let bottom = landscape.energy.iter().copied().fold(0.0, f64::min).max(-top);
    let x = |x: f64| MARGIN + (x - low) / (high - low) * (WIDTH - 2.0 * MARGIN);
    let y = |energy: f64| {
        MARGIN + (top - energy.clamp(bottom, top)) / (top - bottom) * (LANDSCAPE - 2.0 * MARGIN)
    };
    let points: Vec<String> = landscape
        .x
        .iter()
        .zip(&landscape.energy)
        .map(|(at, energy)| format!("{},{}", x2(x(*at)), x2(y(*energy))))
        .collect();
    let saddle = landscape.saddle;
    let shown = |energy: f64| with_unit(energy, prefixed("J", energy), 3);
    let drawing = html! {
        polyline points=(points.join(" ")) fill="none" stroke="currentColor" stroke-width="1.5" {}
        line x1=(MARGIN) x2=(WIDTH - MARGIN) y1=(x2(y(kinetic))) y2=(x2(y(kinetic))) stroke="#009e73" stroke-dasharray="6 4" {}
        text x=(WIDTH - MARGIN) y=(x2(y(kinetic) - 5.0)) text-anchor="end" { "launch " (shown(kinetic)) }
        circle cx=(x2(x(saddle.x))) cy=(x2(y(saddle.energy))) r="4" fill="#d55e00" {}
        text x=(x2(x(saddle.x) + 8.0)) y=(x2(y(saddle.energy) - 6.0)) { "saddle " (shown(saddle.energy)) }
    };
    Svg::new("Energy landscape", [WIDTH, LANDSCAPE], Theme::Inline).around(&drawing)
}
