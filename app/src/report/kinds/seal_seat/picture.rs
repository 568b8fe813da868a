//! The section y = 0 of a seal seat: geometry, where it is struck, and the directions of the sphere's flight.

use crate::format::{measure, short};
use crate::kinds::seal_seat::{SealSeat, SphereBody};
use crate::plot::svg::{Svg, x2};
use crate::report::Theme;
use crate::report::figure::scene_drawing::{DrawingScale, materials};
use crate::report::summary_column::degrees;
use maud::{Markup, html};

const WIDTH: f64 = 760.0;
/// Width in px where the page decides on the rest.
const INLINE_WIDTH: f64 = 340.0;
const MARGIN: f64 = 12.0;
/// Length of the longest arrow over the sphere's radius.
const ARROW: f64 = 2.2;

/// A direction of flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Arrow {
    /// Who says so.
    pub name: String,
    /// Velocity (x, z) in m/s.
    pub velocity: [f64; 2],
    /// Class of the stroke.
    pub class: &'static str,
    /// Dashes of the stroke; empty = none.
    pub dashes: &'static str,
}

/// The section with names and directions of flight: a file of its own, with a legend, or as a page shows it.
pub fn seat_picture(scene: &SealSeat, arrows: &[Arrow], theme: Theme) -> String {
    let (seat, sphere, actuator) = (&scene.seat, &scene.sphere, &scene.actuator);
    let alone = theme == Theme::Standalone;
    let width = if alone { WIDTH } else { INLINE_WIDTH };
    let [cx, cz] = scene.ring().sphere_centre;
    let reach = ARROW * sphere.radius;
    let top = cz + reach + 0.4 * sphere.radius;
    let bottom = -0.5 * actuator.tip_radius;
    let left = -1.02 * seat.membrane_radius;
    let factor = (width - 2.0 * MARGIN) / (-2.0 * left);
    let scale = DrawingScale { factor, left, top, margin: MARGIN };
    let legend = if alone { 24.0 * arrows.len() as f64 + 8.0 } else { 0.0 };
    let section_height = 2.0 * MARGIN + (top - bottom) * factor;
    let height = section_height + legend;
    let fastest = arrows.iter().map(|a| a.velocity[0].hypot(a.velocity[1])).fold(f64::MIN_POSITIVE, f64::max);
    let name = |name: &str, anchor: &str, x: f64, z: f64| html! { text x=(x2(scale.x(x))) y=(x2(scale.z(z) + 4.5)) text-anchor=(anchor) { (name) } };
    let stroke = if alone { 3.0 } else { 2.0 };
    let drawing = html! {
        (seat_body(scene, &scale))
        @for &x in &actuator.tip_positions {
            path.fig-body d=(tip(x, actuator.tip_radius, bottom, &scale)) {}
            (name("actuator", "middle", x, 0.5 * bottom))
        }
        circle.fig-body.sphere cx=(x2(scale.x(cx))) cy=(x2(scale.z(cz))) r=(x2(sphere.radius * factor)) {}
        (name("sphere ", "end", cx - 1.1 * sphere.radius, cz))
        (name("seat", "middle", 0.5 * seat.island_length - 0.6 * sphere.radius, 0.5 * seat.membrane_thickness + 0.25 * seat.island_height))
        @for arrow in arrows { (draw_arrow(arrow, [cx, cz], reach / fastest, stroke, &scale)) }
        (scale.bar(width - 120.0, 24.0))
        @if alone { @for (k, arrow) in arrows.iter().enumerate() {
            @let y = section_height + 24.0 * k as f64 + 4.0;
            line class=(arrow.class) x1="20" x2="60" y1=(y) y2=(y) stroke-width="3" stroke-dasharray=(dashes(arrow)) {}
            text x="70" y=(y + 4.5) { (label(arrow)) }
        } }
    };
    let title = "Section of the seal seat with the directions of the sphere's flight";
    Svg::new(title, [width, height], theme).around(&drawing).into_string()
}

/// The legend of the section on a page.
pub(super) fn arrow_legend(arrows: &[Arrow]) -> Markup {
    html! { ul.legend { @for arrow in arrows { li {
        svg viewBox="0 0 30 10" aria-hidden="true" { path class=(arrow.class) d="M0 5H30" stroke-width="2" stroke-dasharray=(dashes(arrow)) {} }
        " " (label(arrow))
    } } } }
}

fn dashes(arrow: &Arrow) -> &'static str {
    if arrow.dashes.is_empty() { "none" } else { arrow.dashes }
}

fn label(arrow: &Arrow) -> String {
    let [x, z] = arrow.velocity;
    let speed = x.hypot(z);
    format!("{}: {}, {speed:.3} m/s", arrow.name, degrees(x.atan2(z)))
}

/// Membrane and island, with both seats and the notch taken out.
fn seat_body(scene: &SealSeat, scale: &DrawingScale) -> Markup {
    let seat = &scene.seat;
    let (r, t) = (seat.membrane_radius, seat.membrane_thickness);
    let (half, h) = (0.5 * seat.island_length, seat.island_height);
    let outline = [[-r, 0.0], [r, 0.0], [r, t], [half, t], [half, h], [-half, h], [-half, t], [-r, t]];
    let notch = seat.notch.map(|n| {
        let (w, above) = (0.5 * n.width, 1.1 * h);
        [[-w, n.floor], [w, n.floor], [w, above], [-w, above]]
    });
    let hollows =
        || [-1.0, 1.0].map(|side| hollow(scene, side).to_vec()).into_iter().chain(notch.map(|n| n.to_vec()));
    html! {
        clipPath id="seat" { polygon points=(scale.points(&outline)) {} }
        g clip-path="url(#seat)" {
            polygon.fig-seat points=(scale.points(&outline)) stroke-width="3" {}
            // the edges first: where one hollow runs into another there is none
            @for hollow in hollows() { polygon.fig-seat points=(scale.points(&hollow)) stroke-width="3" {} }
        }
        // not clipped: nothing is above, and no edge shines through
        @for hollow in hollows() { polygon.fig-hollow points=(scale.points(&hollow)) {} }
    }
}

/// Cone and bore of the seat at the side `side` (-1 or 1), mirrored about its axis, as a polygon (x, z) in m.
fn hollow(scene: &SealSeat, side: f64) -> Vec<[f64; 2]> {
    let (seat, ring) = (&scene.seat, scene.ring());
    let tan = (0.5 * seat.aperture_angle).tan();
    let high = seat.island_height;
    let at_bore = ring.offset - (ring.radius - seat.bore_radius) / tan;
    let profile = [
        (seat.bore_radius, -seat.bore_depth),
        (seat.bore_radius, at_bore),
        (ring.radius + (high - ring.offset) * tan, high),
    ];
    let [sin, cos] = ring.axis;
    let place = |(rho, s): (f64, f64), sign: f64| {
        let x = ring.sphere_centre[0] + s * sin + sign * rho * cos;
        [-side * x, ring.sphere_centre[1] + s * cos - sign * rho * sin]
    };
    let right = profile.iter().map(|p| place(*p, 1.0));
    let left = profile.iter().rev().map(|p| place(*p, -1.0));
    right.chain(left).collect()
}

/// The round end of the actuator that touches the underside at `x`, down to `bottom`.
fn tip(x: f64, radius: f64, bottom: f64, scale: &DrawingScale) -> String {
    let depth = -bottom;
    let half = (radius * radius - (radius - depth).powi(2)).max(0.0).sqrt();
    let r = radius * scale.factor;
    format!(
        "M {} A {r:.2} {r:.2} 0 0 1 {} Z",
        scale.point([x - half, bottom]),
        scale.point([x + half, bottom])
    )
}

fn draw_arrow(
    arrow: &Arrow,
    from: [f64; 2],
    length_per_speed: f64,
    width: f64,
    scale: &DrawingScale,
) -> Markup {
    let speed = arrow.velocity[0].hypot(arrow.velocity[1]);
    // at rest, or not a number
    if speed.is_nan() || speed == 0.0 {
        return html! {};
    }
    let direction = arrow.velocity.map(|v| v / speed);
    let length = speed * length_per_speed;
    let at = |along: f64, across: f64| {
        [
            from[0] + along * direction[0] + across * direction[1],
            from[1] + along * direction[1] - across * direction[0],
        ]
    };
    let head = 0.12 * length;
    html! {
        polyline class=(arrow.class) points=(scale.points(&[from, at(length, 0.0)])) fill="none" stroke-width=(width)
            stroke-dasharray=(dashes(arrow)) {}
        polyline class=(arrow.class) points=(scale.points(&[at(length - head, 0.5 * head), at(length, 0.0), at(length - head, -0.5 * head)]))
            fill="none" stroke-width=(width) {}
    }
}

/// The scene in numbers.
pub(super) fn measures(scene: &SealSeat) -> Vec<(String, String)> {
    let (seat, sphere, actuator) = (&scene.seat, &scene.sphere, &scene.actuator);
    let length = |value: f64| measure(value, "m");
    let grams = |mass: f64| format!("{} g", short(format!("{:.3e}", 1e3 * mass).parse().unwrap_or(f64::NAN)));
    let angle = |value: f64| measure(value, "rad");
    let body = if sphere.body == SphereBody::Rigid { "rigid" } else { "elastic" };
    let tips: Vec<String> = actuator.tip_positions.iter().map(|x| length(*x)).collect();
    let notch =
        seat.notch.map(|n| format!("; notch {} wide, floor at z = {}", length(n.width), length(n.floor)));
    let mut facts = vec![
        (
            "sphere".to_owned(),
            format!(
                "radius {}, {}, {}, {body}",
                length(sphere.radius),
                grams(sphere.mass),
                sphere.material.name
            ),
        ),
        (
            "seat".to_owned(),
            format!(
                "membrane of radius {}, {} thick, clamped; island {} long, {} wide, {} high{}; {}",
                length(seat.membrane_radius),
                length(seat.membrane_thickness),
                length(seat.island_length),
                length(seat.island_width),
                length(seat.island_height),
                notch.unwrap_or_default(),
                seat.material.name
            ),
        ),
        (
            "cones".to_owned(),
            format!(
                "centres {} apart at z = {}, tilt {}, aperture {}, bore radius {}",
                length(seat.seat_distance),
                length(seat.seated_height),
                angle(seat.tilt),
                angle(seat.aperture_angle),
                length(seat.bore_radius)
            ),
        ),
        (
            "actuator".to_owned(),
            format!(
                "{}, {}, tip radius {}, at x = {}",
                grams(actuator.mass),
                measure(actuator.speed, "m/s"),
                length(actuator.tip_radius),
                tips.join(" and ")
            ),
        ),
    ];
    if scene.friction > 0.0 {
        facts.push(("friction".to_owned(), format!("{} in all contacts", scene.friction)));
    }
    facts.extend(materials([&seat.material, &sphere.material]));
    facts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::path::Path;

    #[test]
    fn an_arrow_points_where_the_sphere_flies_and_is_as_long_as_it_is_fast() {
        let arrow = |velocity| Arrow { name: "a".into(), velocity, class: "fig-C", dashes: "" };
        let scale = DrawingScale { factor: 1.0, left: 0.0, top: 0.0, margin: MARGIN };
        let head = |velocity| {
            let svg = draw_arrow(&arrow(velocity), [0.0, 0.0], 10.0, 3.0, &scale).into_string();
            let shaft = svg.split("points=\"").nth(1).expect("shaft").split('"').next().expect("end");
            let first = shaft.split(' ').nth(1).expect("point").to_owned();
            let (x, y) = first.split_once(',').expect("pair");
            [x.parse::<f64>().expect("x") - MARGIN, MARGIN - y.parse::<f64>().expect("y")]
        };
        assert_eq!(head([0.0, 2.0]), [0.0, 20.0]);
        assert_eq!(head([-3.0, 4.0]), [-30.0, 40.0]);
    }

    #[test]
    fn the_hollow_meets_the_sphere_along_the_cone_and_nowhere_deeper() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures/seal-seat.toml");
        let scene = Scene::read(path).expect("scene");
        let scene = scene.seal_seat().expect("seal seat");
        let outline = hollow(scene, -1.0);
        let [cx, cz] = scene.ring().sphere_centre;
        let mut nearest = f64::INFINITY;
        for (a, b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            for k in 0..=1000 {
                let t = f64::from(k) / 1000.0;
                let p = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
                nearest = nearest.min((p[0] - cx).hypot(p[1] - cz));
            }
        }
        assert!((nearest / scene.sphere.radius - 1.0).abs() < 1e-4, "{nearest}");
    }
}
