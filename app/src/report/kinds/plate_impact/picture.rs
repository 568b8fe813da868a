//! A plate impact in section, to scale, and in numbers.

use crate::format::{measure, short};
use crate::kinds::plate_impact::PlateImpact;
use crate::plot::svg::{Svg, Theme, x2};
use crate::report::figure::scene_drawing::{DrawingScale, body, body_in_words, materials, shown_radius};
use crate::scene::Edge;
use maud::{Markup, html};

const WIDTH: f64 = 340.0;
/// Largest height of plate and bodies, px.
const HEIGHT: f64 = 210.0;
const MARGIN: f64 = 16.0;
/// Room above the outer body for its speed, below the inner one for the scale, px.
const ABOVE: f64 = 40.0;
const BELOW: f64 = 26.0;
/// Least thickness at which a plate is seen, px.
const THINNEST: f64 = 1.5;

pub(super) fn plate_picture(scene: &PlateImpact) -> Markup {
    let (plate, outer, inner) = (&scene.plate, &scene.outer, &scene.inner);
    let [r_outer, r_inner] = [&outer.shape, &inner.shape].map(|shape| shown_radius(shape, plate.radius));
    let half = plate.radius.max(outer.offset + r_outer).max(r_inner);
    let top = 0.5 * plate.thickness + 2.0 * r_outer;
    let bottom = -0.5 * plate.thickness - inner.gap - 2.0 * r_inner;
    let factor = ((WIDTH - 2.0 * MARGIN) / (2.0 * half)).min(HEIGHT / (top - bottom));
    let scale = DrawingScale {
        factor,
        left: -0.5 * (WIDTH - 2.0 * MARGIN) / factor,
        top: top + (ABOVE - MARGIN) / factor,
        margin: MARGIN,
    };
    let height = ABOVE + (top - bottom) * factor + BELOW;
    let (struck, surface) = (scale.x(outer.offset), scale.z(top));
    // about its tip, so that it points where the body goes
    let aslant = (outer.angle != 0.0)
        .then(|| format!("rotate({:.1} {} {})", -outer.angle.to_degrees(), x2(struck), x2(surface - 6.0)));
    let thickness = (plate.thickness * factor).max(THINNEST);
    let z_outer = 0.5 * plate.thickness + r_outer;
    let z_inner = -0.5 * plate.thickness - inner.gap - r_inner;
    let drawing = html! {
        (edge(plate.edge, plate.radius, thickness, &scale))
        rect.fig-body.plate x=(x2(scale.x(-plate.radius))) width=(x2(2.0 * plate.radius * factor))
            y=(x2(scale.z(0.0) - 0.5 * thickness)) height=(x2(thickness)) {}
        (body(&outer.shape, "outer", r_outer, [outer.offset, z_outer], 1.0, &scale))
        (body(&inner.shape, "inner", r_inner, [0.0, z_inner], -1.0, &scale))
        path.fig-frame transform=[aslant] d=(format!("M{0} {1}V{2}m-4-7l4 7l4-7", x2(struck), x2(surface - 34.0), x2(surface - 6.0))) {}
        text x=(x2(struck + 10.0)) y=(x2(surface - 18.0)) { (measure(outer.speed, "m/s")) }
        (scale.bar(MARGIN, height - 6.0))
    };
    Svg::new("The scene in section, to scale", [WIDTH, height], Theme::Inline).around(&drawing)
}

/// What holds the rim.
fn edge(edge: Edge, radius: f64, thickness: f64, scale: &DrawingScale) -> Markup {
    let (middle, half) = (scale.z(0.0), 0.5 * thickness);
    html! {
        @for side in [-1.0, 1.0] {
            @let x = scale.x(side * radius);
            @match edge {
                Edge::Clamped => rect.fig-clamp x=(x2(if side < 0.0 { x - 9.0 } else { x })) width="9" y=(x2(middle - half - 12.0)) height=(x2(thickness + 24.0)) {},
                Edge::SimplySupported => path.fig-clamp d=(format!("M{0} {1}l-7 12h14Z", x2(x - side * 4.0), x2(middle + half))) {},
                Edge::Free => {},
            }
        }
    }
}

/// The scene in numbers.
pub(super) fn measures(scene: &PlateImpact) -> Vec<(String, String)> {
    let (plate, outer, inner) = (&scene.plate, &scene.outer, &scene.inner);
    let length = |value: f64| measure(value, "m");
    let edge = match plate.edge {
        Edge::Clamped => "clamped",
        Edge::SimplySupported => "simply supported",
        Edge::Free => "free",
    };
    let damping = if plate.damping_ratio > 0.0 {
        format!(", damping ratio {}", short(plate.damping_ratio))
    } else {
        String::new()
    };
    let gap = if inner.gap > 0.0 { format!(", gap {}", length(inner.gap)) } else { String::new() };
    let own = if inner.speed == 0.0 { String::new() } else { format!(", {}", measure(inner.speed, "m/s")) };
    let aside = match (outer.offset, outer.angle) {
        (0.0, 0.0) => String::new(),
        (offset, 0.0) => format!(", {} off-centre", length(offset)),
        (0.0, angle) => format!(", at {}", measure(angle, "rad")),
        (offset, angle) => format!(", {} off-centre, at {}", length(offset), measure(angle, "rad")),
    };
    let mut facts = vec![
        (
            "outer".to_owned(),
            format!(
                "{}, {}{aside}",
                body_in_words(&outer.shape, &outer.material),
                measure(outer.speed, "m/s")
            ),
        ),
        (
            "plate".to_owned(),
            format!(
                "radius {}, thickness {}, {edge}, {}{damping}",
                length(plate.radius),
                length(plate.thickness),
                plate.material.name
            ),
        ),
        ("inner".to_owned(), body_in_words(&inner.shape, &inner.material) + &gap + &own),
    ];
    if let Some(fluid) = &scene.fluid {
        let viscosity = short(1e3 * fluid.viscosity);
        facts.push((
            "fluid".to_owned(),
            format!("viscosity {viscosity} mPa s, density {} kg/m³", short(fluid.density)),
        ));
    }
    facts.extend(materials([&plate.material, &outer.material, &inner.material]));
    facts
}
