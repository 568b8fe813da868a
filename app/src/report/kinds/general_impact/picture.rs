//! An impact on a wall, an elastic body or another body in section, to scale but for an elastic body, and in numbers.

use crate::format::measure;
use crate::kinds::general_impact::{GeneralImpact, Struck};
use crate::plot::svg::{Svg, Theme, x2};
use crate::report::figure::scene_drawing::{DrawingScale, body, body_in_words, materials, shown_radius};
use crate::scene::Material;
use maud::{Markup, html};

const WIDTH: f64 = 340.0;
/// Largest height of the bodies, px.
const HEIGHT: f64 = 210.0;
const MARGIN: f64 = 16.0;
/// Room above the outer body for its speed, below for the scale, px.
const ABOVE: f64 = 40.0;
const BELOW: f64 = 26.0;
/// Depth of a wall that is shown, px.
const WALL: f64 = 26.0;
/// Largest radius of a tip over the other body's that is drawn as it is.
const LARGEST: f64 = 20.0;

pub(super) fn picture(scene: &GeneralImpact) -> Markup {
    let outer = &scene.outer;
    let tips = [Some(&outer.shape), scene.inner.as_ref().map(|inner| &inner.shape)];
    let least = tips.iter().flatten().map(|shape| shape.tip_radius()).fold(f64::INFINITY, f64::min);
    let [above, below] = tips.map(|shape| shape.map_or(0.0, |shape| shown_radius(shape, LARGEST * least)));
    let half = above.max(below);
    let height = 2.0 * (above + below);
    let factor = ((WIDTH - 2.0 * MARGIN) / (2.0 * half)).min(HEIGHT / height);
    let top = 2.0 * above;
    let scale = DrawingScale {
        factor,
        left: -0.5 * (WIDTH - 2.0 * MARGIN) / factor,
        top: top + (ABOVE - MARGIN) / factor,
        margin: MARGIN,
    };
    // what lies between is not to scale: a strip
    let strip = if scene.struck.is_some() { WALL } else { 0.0 };
    let full = ABOVE + height * factor + BELOW + strip;
    let (axis, surface) = (scale.x(0.0), scale.z(top));
    let drawing = html! {
        @if let Some(struck) = &scene.struck {
            rect.fig-body.plate x=(x2(MARGIN)) width=(x2(WIDTH - 2.0 * MARGIN)) y=(x2(scale.z(0.0))) height=(x2(WALL)) {}
            text x=(x2(axis)) y=(x2(scale.z(0.0) + 0.5 * WALL + 4.5)) text-anchor="middle" { (name_of(struck)) }
        }
        @if let Some(inner) = &scene.inner {
            (body(&inner.shape, "inner", below, [0.0, -below - strip / factor], -1.0, &scale))
        }
        (body(&outer.shape, "outer", above, [0.0, above], 1.0, &scale))
        path.fig-frame d=(format!("M{0} {1}V{2}m-4-7l4 7l4-7", x2(axis), x2(surface - 34.0), x2(surface - 6.0))) {}
        text x=(x2(axis + 10.0)) y=(x2(surface - 18.0)) { (measure(outer.speed, "m/s")) }
        (scale.bar(MARGIN, full - 6.0))
    };
    Svg::new("The scene in section, to scale", [WIDTH, full], Theme::Inline).around(&drawing)
}

/// The scene in numbers.
pub(super) fn measures(scene: &GeneralImpact) -> Vec<(String, String)> {
    let outer = &scene.outer;
    let aslant =
        if outer.angle == 0.0 { String::new() } else { format!(", at {}", measure(outer.angle, "rad")) };
    let moving = |speed: f64| format!(", {}", measure(speed, "m/s"));
    let material =
        |material: Option<&Material>| material.map_or("rigid", |material| &material.name).to_owned();
    let struck = scene.struck.as_ref().map(|struck| match struck {
        Struck::Wall(wall) => ("wall".to_owned(), material(wall.material.as_ref())),
        Struck::Plate(plate) => {
            let [radius, thickness] = [plate.radius, plate.thickness].map(|length| measure(length, "m"));
            let of = format!("radius {radius}, thickness {thickness}, {}", plate.material.name);
            ("plate".to_owned(), of)
        }
        Struck::Body(body) => {
            let held = if body.fixed.is_empty() { ", free" } else { "" };
            let names: Vec<&str> = body.materials.all().iter().map(|material| &*material.name).collect();
            ("body".to_owned(), format!("{}, {}{held}", name_of(struck), names.join(" and ")))
        }
    });
    let inner = scene.inner.as_ref().map(|inner| {
        let own = if inner.speed == 0.0 { String::new() } else { moving(inner.speed) };
        ("inner".to_owned(), body_in_words(&inner.shape, &inner.material) + &own)
    });
    let outer = body_in_words(&outer.shape, &outer.material) + &moving(outer.speed) + &aslant;
    let mut found = vec![("outer".to_owned(), outer)];
    found.extend(struck.into_iter().chain(inner));
    found.extend(materials(scene.materials()));
    found
}

/// What the outer body strikes, in words.
fn name_of(struck: &Struck) -> String {
    match struck {
        Struck::Wall(wall) => if wall.material.is_some() { "wall" } else { "rigid wall" }.to_owned(),
        Struck::Plate(_) => "plate".to_owned(),
        Struck::Body(body) => {
            let name = body.file.file_name().unwrap_or(body.file.as_os_str());
            name.to_string_lossy().into_owned()
        }
    }
}
