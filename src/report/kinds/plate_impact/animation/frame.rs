//! One frame of an animation as a drawing; the field of its left half is filled in afterwards.

use super::stage::{Stage, WIDTH};
use crate::plot::axis::{Plot, PlotAxis};
use crate::plot::colours::cividis;
use crate::plot::colours::{BODIES, hex};
use crate::plot::polyline::path;
use crate::plot::svg::x2;
use crate::plot::ticks::{tick_label, ticks};
use crate::report::figure::scene_drawing::DrawingScale;
use crate::scene::Shape;
use maud::{Markup, PreEscaped, html};

const FONT_SIZE: f64 = 13.0;
/// Heights of what stands below the picture: scales, forces with their axis, px.
const SCALES: f64 = 58.0;
const FORCES: f64 = 110.0;
const AXIS: f64 = 48.0;
const STYLE: &str = "text{fill:#1a1a1a}.frame,.fig-frame{stroke:#444;fill:none}.grid{stroke:#e3e3e3}\
.body{stroke:#5a5a5a;stroke-width:1}";

/// Height of a frame, px.
pub(super) fn height(stage: &Stage) -> f64 {
    let [_, top, _, height] = stage.picture();
    // of which a whole number of pixels is made
    (0.25 * (top + height + SCALES + FORCES + AXIS)).ceil() / 0.25
}

pub(super) fn svg(stage: &Stage, k: usize) -> String {
    let (height, time) = (height(stage), 1e6 * stage.movement.times[k]);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {WIDTH} {height}")) width=(WIDTH) height=(height)
            font-family="DejaVu Sans, Verdana, sans-serif" font-size=(FONT_SIZE) {
            style { (PreEscaped(STYLE)) }
            rect width=(WIDTH) height=(height) fill="#ffffff" {}
            text x="12" y="20" font-size="15" { (stage.scene.name) }
            text x=(WIDTH - 12) y="20" font-size="15" text-anchor="end" { "t = " (format!("{time:.1}")) " µs" }
            (halves(stage))
            (picture(stage, k))
            (scales(stage))
            (forces(stage, time))
        }
    }
    .into_string()
}

/// What is on which side.
fn halves(stage: &Stage) -> Markup {
    let [left, _, width, _] = stage.picture();
    html! {
        @if stage.movement.fields.is_empty() {
            text x="12" y="43" { (stage.model) ", alone: no fields of the reference are stored" }
        } @else {
            text x=(left + 0.25 * width) y="43" text-anchor="middle" { "reference" }
            text x=(left + 0.75 * width) y="43" text-anchor="middle" style=(format!("fill:{}", stage.colour)) { (stage.model) }
        }
    }
}

/// The model's plate and bodies on the right, without fields on the left too.
fn picture(stage: &Stage, k: usize) -> Markup {
    let [left, top, width, height] = stage.picture();
    let alone = stage.movement.fields.is_empty();
    let scale = DrawingScale {
        factor: width / (2.0 * stage.view.radius),
        left: -stage.view.radius,
        top: stage.view.high,
        margin: 0.0,
    };
    let middle = 0.5 * width;
    html! {
        clipPath id="half" { rect x=(if alone { 0.0 } else { middle }) y="0" width=(width) height=(height) {} }
        clipPath id="all" { rect x="0" y="0" width=(width) height=(height) {} }
        g transform=(format!("translate({left} {top})")) {
            g clip-path="url(#all)" { g clip-path="url(#half)" { (bodies(stage, k, &scale)) } }
            line x1=(middle) x2=(middle) y1="0" y2=(height) stroke="#777777" stroke-dasharray="3 4" {}
            rect.frame x="0" y="0" width=(width) height=(height) {}
        }
    }
}

fn bodies(stage: &Stage, k: usize, scale: &DrawingScale) -> Markup {
    let (setup, movement, by) = (stage.setup, stage.movement, stage.exaggeration);
    let half = 0.5 * setup.plate.thickness;
    let face = |side: f64| {
        let deflected = movement.radii.iter().zip(&movement.deflection[k]);
        deflected.map(move |(r, w)| [*r, side * half + by * w])
    };
    // from the left along the upper face to the right, and back along the lower one
    let side = |side: f64| {
        let right: Vec<[f64; 2]> = face(side).collect();
        right.iter().rev().map(|[r, z]| [-r, *z]).chain(right.clone()).collect::<Vec<_>>()
    };
    let plate: Vec<[f64; 2]> = side(1.0).into_iter().chain(side(-1.0).into_iter().rev()).collect();
    let outer = half + setup.outer.shape.tip_radius() + by * movement.bodies[0][k];
    let inner = -half - setup.inner.gap - setup.inner.shape.tip_radius() + by * movement.bodies[1][k];
    html! {
        polygon.body points=(scale.points(&plate)) fill=(&hex(BODIES[1])) {}
        (body(&setup.outer.shape, outer, &hex(BODIES[0]), scale))
        (body(&setup.inner.shape, inner, &hex(BODIES[2]), scale))
    }
}

/// A sphere, or the sphere that a tip is part of.
fn body(shape: &Shape, z: f64, fill: &str, scale: &DrawingScale) -> Markup {
    html! {
        circle.body cx=(x2(scale.x(0.0))) cy=(x2(scale.z(z))) r=(x2(shape.tip_radius() * scale.factor)) fill=(fill) {}
    }
}

/// The bar of lengths, how far displacements are exaggerated, and the colours of the stress.
fn scales(stage: &Stage) -> Markup {
    let [left, top, width, height] = stage.picture();
    let bottom = top + height;
    let scale = DrawingScale { factor: width / (2.0 * stage.view.radius), left: 0.0, top: 0.0, margin: 0.0 };
    let (bar, count) = (0.4 * width, 60);
    let to = 1e-6 * stage.largest;
    let marks = ticks(0.0, to, 4);
    html! {
        (scale.bar(left + 0.55 * width, bottom + 20.0))
        text x=(left + width) y=(bottom + 20.0) text-anchor="end" { (stage.scale_told()) }
        @if !stage.movement.fields.is_empty() {
            @for k in 0..count {
                @let [r, g, b] = cividis(k as f64 / (count - 1) as f64);
                rect x=(x2(left + bar * k as f64 / count as f64)) width=(x2(bar / count as f64 + 0.5)) y=(bottom + 9.0) height="11"
                    fill=(format!("rgb({r},{g},{b})")) {}
            }
            @for mark in &marks {
                text x=(x2(left + bar * mark / to)) y=(bottom + 35.0) text-anchor=(if *mark > 0.0 { "middle" } else { "start" }) {
                    (tick_label(*mark, &marks))
                }
            }
            text x=(left + bar + 28.0) y=(bottom + 38.0) { "von Mises stress in MPa (contacts: more)" }
        }
    }
}

/// Both contact forces with a marker at `time` (µs).
fn forces(stage: &Stage, time: f64) -> Markup {
    let [_, top, _, height] = stage.picture();
    let [reference, model] = &stage.forces.curves;
    let all = reference.iter().chain(model).flatten().map(|p| p.1);
    let plot = Plot {
        left: 74.0,
        top: top + height + SCALES,
        width: WIDTH as f64 - 74.0 - 12.0,
        height: FORCES,
        x: PlotAxis::over([0.0, stage.forces.end].into_iter(), false),
        y: PlotAxis::over(all, false).of_quantity(),
    };
    let (x_marks, y_marks) = (plot.x.marks(8), plot.y.marks(3));
    let line = |points: &[(f64, f64)]| path(&points.iter().map(|p| plot.at(*p)).collect::<Vec<_>>());
    let x = x2(plot.x(time));
    let largest =
        |points: &[(f64, f64)]| points.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
    html! {
        (plot.grid(&x_marks, &y_marks))
        @for curve in reference { path d=(line(curve)) fill="none" stroke="#1a1a1a" stroke-width="1.8" {} }
        @for curve in model { path d=(line(curve)) fill="none" stroke=(stage.colour) stroke-width="1.8" stroke-dasharray="6 4" {} }
        @for (curve, name, aside, below) in [(&reference[0], "outer", 40.0, 6.0), (&reference[1], "inner", 0.0, 20.0)] {
            @let (x, y) = plot.at(largest(curve));
            text x=(x2(x + aside)) y=(x2(y + below)) text-anchor="middle" { (name) }
        }
        line x1=(x) x2=(x) y1=(plot.top) y2=(plot.top + plot.height) stroke="#1a1a1a" stroke-width="1" {}
        @for (curves, colour) in [(reference, "#1a1a1a"), (model, &*stage.colour)] {
            @for curve in curves {
                @let (x, y) = plot.at(stage.forces.at(curve, time));
                circle cx=(x2(x)) cy=(x2(y)) r="3.5" fill=(colour) {}
            }
        }
        (plot.frame(&x_marks, &y_marks, ["Time in µs", "Force in N"], FONT_SIZE))
    }
}
