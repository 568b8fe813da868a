//! The section y = 0 of a seal seat: geometry, where it is struck, and the directions of the sphere's flight.

use super::summary_column::degrees;
use crate::scene::SealSeat;
use maud::{Markup, html};

const WIDTH: f64 = 760.0;
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
    /// Stroke colour.
    pub colour: &'static str,
    /// Dashes of the stroke; empty = none.
    pub dashes: &'static str,
}

/// From places in m to the drawing.
struct Scale {
    factor: f64,
    left: f64,
    top: f64,
}

impl Scale {
    fn point(&self, [x, z]: [f64; 2]) -> String {
        format!("{:.2},{:.2}", MARGIN + (x - self.left) * self.factor, MARGIN + (self.top - z) * self.factor)
    }

    fn points(&self, points: &[[f64; 2]]) -> String {
        points.iter().map(|p| self.point(*p)).collect::<Vec<_>>().join(" ")
    }

    fn x(&self, x: f64) -> String {
        format!("{:.2}", MARGIN + (x - self.left) * self.factor)
    }

    fn z(&self, z: f64) -> String {
        format!("{:.2}", MARGIN + (self.top - z) * self.factor)
    }
}

/// The section as a stand-alone SVG.
pub fn seat_picture(scene: &SealSeat, arrows: &[Arrow]) -> String {
    let (seat, sphere, actuator) = (&scene.seat, &scene.sphere, &scene.actuator);
    let [cx, cz] = scene.ring().sphere_centre;
    let reach = ARROW * sphere.radius;
    let top = cz + reach + 0.4 * sphere.radius;
    let bottom = -0.5 * actuator.tip_radius;
    let left = -1.02 * seat.membrane_radius;
    let factor = (WIDTH - 2.0 * MARGIN) / (-2.0 * left);
    let scale = Scale { factor, left, top };
    let legend = 24.0 * arrows.len() as f64 + 8.0;
    let section_height = 2.0 * MARGIN + (top - bottom) * factor;
    let height = section_height + legend;
    let fastest = arrows.iter().map(|a| a.velocity[0].hypot(a.velocity[1])).fold(f64::MIN_POSITIVE, f64::max);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {WIDTH} {height:.1}")) width=(WIDTH) height=(format!("{height:.1}"))
            font-family="DejaVu Sans, Verdana, sans-serif" font-size="13" role="img" {
            title { "Section of the seal seat with the directions of the sphere's flight" }
            rect width=(WIDTH) height=(format!("{height:.1}")) fill="#ffffff" {}
            (seat_body(scene, &scale))
            @for &x in &actuator.tip_positions {
                path d=(tip(x, actuator.tip_radius, bottom, &scale)) fill="#b9c4cf" stroke="#444" {}
            }
            circle cx=(scale.x(cx)) cy=(scale.z(cz)) r=(format!("{:.2}", sphere.radius * factor)) fill="#dfe5ea" stroke="#444" {}
            @for arrow in arrows { (draw_arrow(arrow, [cx, cz], reach / fastest, &scale)) }
            @for (k, arrow) in arrows.iter().enumerate() {
                @let y = section_height + 24.0 * k as f64 + 4.0;
                line x1="20" x2="60" y1=(y) y2=(y) stroke=(arrow.colour) stroke-width="3" stroke-dasharray=(dashes(arrow)) {}
                text x="70" y=(y + 4.5) fill="#1a1a1a" { (label(arrow)) }
            }
        }
    }
    .into_string()
}

fn dashes(arrow: &Arrow) -> &'static str {
    if arrow.dashes.is_empty() { "none" } else { arrow.dashes }
}

fn label(arrow: &Arrow) -> String {
    let [x, z] = arrow.velocity;
    let speed = x.hypot(z);
    format!("{}: {} against the vertical, {speed:.3} m/s", arrow.name, degrees(x.atan2(z)))
}

/// Membrane and island, with both seats and the notch taken out.
fn seat_body(scene: &SealSeat, scale: &Scale) -> Markup {
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
            polygon points=(scale.points(&outline)) fill="#f0dfb8" stroke="#9a7f3c" stroke-width="3" {}
            // the edges first: where one hollow runs into another there is none
            @for hollow in hollows() { polygon points=(scale.points(&hollow)) fill="none" stroke="#9a7f3c" stroke-width="3" {} }
            @for hollow in hollows() { polygon points=(scale.points(&hollow)) fill="#ffffff" stroke="none" {} }
        }
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
fn tip(x: f64, radius: f64, bottom: f64, scale: &Scale) -> String {
    let depth = -bottom;
    let half = (radius * radius - (radius - depth).powi(2)).max(0.0).sqrt();
    let r = radius * scale.factor;
    format!(
        "M {} A {r:.2} {r:.2} 0 0 1 {} Z",
        scale.point([x - half, bottom]),
        scale.point([x + half, bottom])
    )
}

fn draw_arrow(arrow: &Arrow, from: [f64; 2], length_per_speed: f64, scale: &Scale) -> Markup {
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
    let head = 0.08 * length;
    html! {
        polyline points=(scale.points(&[from, at(length - head, 0.0)])) fill="none" stroke=(arrow.colour) stroke-width="3"
            stroke-dasharray=(dashes(arrow)) {}
        polygon points=(scale.points(&[at(length, 0.0), at(length - 2.0 * head, 0.8 * head), at(length - 2.0 * head, -0.8 * head)]))
            fill=(arrow.colour) {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::path::Path;

    #[test]
    fn an_arrow_points_where_the_sphere_flies_and_is_as_long_as_it_is_fast() {
        let arrow = |velocity| Arrow { name: "a".into(), velocity, colour: "#000", dashes: "" };
        let scale = Scale { factor: 1.0, left: 0.0, top: 0.0 };
        let head = |velocity| {
            let svg = draw_arrow(&arrow(velocity), [0.0, 0.0], 10.0, &scale).into_string();
            let from = svg.find("polygon points=\"").expect("head") + 16;
            let first = svg[from..].split(' ').next().expect("point").to_owned();
            let (x, y) = first.split_once(',').expect("pair");
            [x.parse::<f64>().expect("x") - MARGIN, MARGIN - y.parse::<f64>().expect("y")]
        };
        assert_eq!(head([0.0, 2.0]), [0.0, 20.0]);
        assert_eq!(head([-3.0, 4.0]), [-30.0, 40.0]);
    }

    #[test]
    fn the_hollow_touches_the_sphere_along_the_cone_and_nowhere_deeper() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/seal-seat.toml");
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
