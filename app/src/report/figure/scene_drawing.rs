//! What drawings of scenes to scale share: places, the bar that gives the scale, bodies, materials in numbers.

use crate::format::{measure, short};
use crate::plot::svg::x2;
use crate::plot::ticks::round_below;
use crate::scene::{Material, Shape};
use maud::{Markup, html};

/// From places (x, z) in m to the drawing.
pub(crate) struct DrawingScale {
    /// Px per m.
    pub(crate) factor: f64,
    /// What stands at the left and upper margin.
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) margin: f64,
}

impl DrawingScale {
    pub(crate) fn x(&self, x: f64) -> f64 {
        self.margin + (x - self.left) * self.factor
    }

    pub(crate) fn z(&self, z: f64) -> f64 {
        self.margin + (self.top - z) * self.factor
    }

    pub(crate) fn point(&self, [x, z]: [f64; 2]) -> String {
        format!("{:.2},{:.2}", self.x(x), self.z(z))
    }

    pub(crate) fn points(&self, points: &[[f64; 2]]) -> String {
        points.iter().map(|p| self.point(*p)).collect::<Vec<_>>().join(" ")
    }

    /// A bar of a round length beside which lengths can be read, from (`x`, `y`) px on.
    pub(crate) fn bar(&self, x: f64, y: f64) -> Markup {
        const SCALE_BAR: f64 = 70.0;
        let length = round_below(SCALE_BAR / self.factor);
        let end = x + length * self.factor;
        html! {
            path.fig-frame data-scale=(self.factor) d=(format!("M{0} {1}V{2}H{3}V{1}", x2(x), x2(y - 5.0), x2(y), x2(end))) {}
            text x=(x2(end + 5.0)) y=(x2(y)) { (measure(length, "m")) }
        }
    }
}

/// The materials of a scene, each once.
pub(crate) fn materials<'a>(of: impl IntoIterator<Item = &'a Material>) -> Vec<(String, String)> {
    let mut facts: Vec<(String, String)> = Vec::new();
    for material in of {
        if facts.iter().all(|(name, _)| *name != material.name) {
            let yielding = material
                .yield_strength
                .map(|y| format!(", yield strength {}", measure(y, "Pa")))
                .unwrap_or_default();
            facts.push((
                material.name.clone(),
                format!(
                    "E {}, ν {}, ρ {} kg/m³{yielding}",
                    measure(material.youngs_modulus, "Pa"),
                    short(material.poisson_ratio),
                    short(material.density)
                ),
            ));
        }
    }
    facts
}

/// Of a body of which the tip alone is known that of the tip, as far as it can be drawn: at most `largest`.
pub(crate) fn shown_radius(shape: &Shape, largest: f64) -> f64 {
    match shape {
        Shape::Sphere { radius } => *radius,
        Shape::Compact { .. } | Shape::Bender(_) | Shape::Stack(_) => shape.tip_radius().min(largest),
    }
}

/// A sphere, or the tip of another body, about `centre`; `side` is 1 above what lies between and -1 below it.
pub(crate) fn body(
    shape: &Shape,
    name: &str,
    radius: f64,
    centre: [f64; 2],
    side: f64,
    scale: &DrawingScale,
) -> Markup {
    let (x, y, r) = (scale.x(centre[0]), scale.z(centre[1]), radius * scale.factor);
    let sweep = if side > 0.0 { 0 } else { 1 };
    let inside = r > 24.0;
    let label = if inside {
        (x, y + if matches!(shape, Shape::Sphere { .. }) { 4.5 } else { side * 14.0 + 4.5 })
    } else {
        (x + r + 26.0, y - side * 4.0 + 4.5)
    };
    html! {
        @match shape {
            Shape::Sphere { .. } => circle class=(format!("fig-body {name}")) cx=(x2(x)) cy=(x2(y)) r=(x2(r)) {},
            Shape::Compact { .. } | Shape::Bender(_) | Shape::Stack(_) => {
                path class=(format!("fig-body {name}")) d=(format!("M{} {}A{r:.2} {r:.2} 0 0 {sweep} {} {}", x2(x - r), x2(y), x2(x + r), x2(y))) {}
                path.fig-frame stroke-dasharray="3 3" d=(format!("M{} {}V{}H{}V{}", x2(x - r), x2(y), x2(y - side * r), x2(x + r), x2(y))) {}
            },
        }
        text x=(x2(label.0)) y=(x2(label.1)) text-anchor="middle" { (name) }
    }
}

/// A body in words and numbers.
pub(crate) fn body_in_words(shape: &Shape, material: &Material) -> String {
    let grams = |mass: f64| format!("{} g", short(1e3 * mass));
    let tip = measure(shape.tip_radius(), "m");
    match shape {
        Shape::Sphere { radius } => format!("sphere, radius {}, {}", measure(*radius, "m"), material.name),
        Shape::Compact { mass, .. } => {
            format!("compact body, {}, tip radius {tip}, {}", grams(*mass), material.name)
        }
        Shape::Bender(bender) => format!(
            "bender, length {}, tip mass {}, tip radius {tip}, {}",
            measure(bender.length, "m"),
            grams(bender.tip_mass),
            material.name
        ),
        Shape::Stack(stack) => format!(
            "stack, length {}, stroke {}, blocked force {}, {}, tip radius {tip}, {}",
            measure(stack.length, "m"),
            measure(stack.stroke, "m"),
            measure(stack.blocked_force, "N"),
            measure(stack.voltage, "V"),
            material.name
        ),
    }
}
