//! What drawings of scenes to scale share: places, the bar that gives the scale, materials in numbers.

use crate::format::{measure, short};
use crate::plot::svg::x2;
use crate::plot::ticks::round_below;
use crate::scene::Material;
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
