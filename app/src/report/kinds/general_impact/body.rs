//! The meshed body in 3D: its surface, contacts, stress and modes for the script that draws it.

use crate::body::solid::{BodyView, ContactInfo};
use crate::format::{prefixed, with_unit};
use crate::kinds::general_impact::body_view;
use crate::reference::SolidStress;
use crate::report::page::page_data::embedded;
use crate::result::Summary;
use crate::scene::Scene;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

const SCRIPT: &str = include_str!("../../page/assets/body_view.js");
const STYLE: &str = include_str!("../../page/assets/body_view.css");

/// The body of `scene` with its stress under the force peak of the result `model`, or 1 N, and with that of the reference at an instant in s;
/// nothing without a body from a mesh.
pub(crate) fn body_figure(
    scene: &Scene,
    model: Option<&Summary>,
    reference: Option<&(f64, SolidStress)>,
) -> Markup {
    let peak = model.and_then(|model| model.value("outer_force_peak"));
    match body_view(scene) {
        Ok(None) => html! {},
        Err(error) => html! { p.note { "The body can't be shown: " (error) } },
        Ok(Some((view, contacts))) => html! {
            style { (PreEscaped(STYLE)) }
            figure.body-view {
                script type="application/json" { (PreEscaped(embedded(&document(scene, &view, &contacts, peak, reference)))) }
                noscript { p.note { "The body in 3D needs JavaScript." } }
            }
            script type="text/javascript" { (PreEscaped(SCRIPT)) }
        },
    }
}

/// What the script reads.
fn document(
    scene: &Scene,
    view: &BodyView,
    contacts: &[ContactInfo],
    peak: Option<f64>,
    reference: Option<&(f64, SolidStress)>,
) -> Value {
    let low: [f64; 3] =
        std::array::from_fn(|c| view.points.iter().map(|p| p[c]).fold(f64::INFINITY, f64::min));
    let extent = |c: usize| view.points.iter().map(|p| p[c] - low[c]).fold(0.0, f64::max);
    let size = (0..3).map(extent).fold(f64::MIN_POSITIVE, f64::max);
    let place = |p: &[f64; 3]| -> [u16; 3] {
        std::array::from_fn(|c| (65535.0 * (p[c] - low[c]) / size).round() as u16)
    };
    let setup = scene.general_impact().ok();
    let tips = setup.map(|setup| {
        [Some(&setup.outer.shape), setup.inner.as_ref().map(|inner| &inner.shape)]
            .map(|shape| shape.map(|shape| shape.tip_radius()))
    });
    let names = ["outer", "inner"];
    let contacts = names.iter().zip(contacts).zip(tips.unwrap_or_default()).map(|((name, contact), radius)| {
        json!({ "name": name, "point": contact.point, "normal": contact.normal, "radius": radius })
    });
    let stress: Vec<f64> = view.stress.iter().map(|stress| stress * peak.unwrap_or(1.0) * 1e-6).collect();
    let force = peak.map_or("1 N".to_owned(), |peak| with_unit(peak, prefixed("N", peak), 3));
    let under = format!("von Mises stress under a static {force} at the outer contact");
    let mut fields = vec![field(&under, "MPa", &stress)];
    if let Some((time, stress)) = reference {
        let at = with_unit(*time, prefixed("s", *time), 3);
        let stress: Vec<f64> = stress.at(&view.points).iter().map(|stress| stress * 1e-6).collect();
        fields.insert(0, field(&format!("von Mises stress of the reference at {at}"), "MPa", &stress));
    }
    for (k, (frequency, shape)) in view.modes.iter().enumerate() {
        let name = format!("mode {}, {}", k + 1, with_unit(*frequency, prefixed("Hz", *frequency), 3));
        let lengths: Vec<f64> = shape.iter().map(|u| u.iter().map(|c| c * c).sum::<f64>().sqrt()).collect();
        let moved = shape.iter().flatten().map(|c| (127.0 * c).round() as i8 as u8).collect::<Vec<u8>>();
        let mut field = field(&name, "", &lengths);
        field["shape"] = json!(BASE64_STANDARD.encode(moved));
        fields.push(field);
    }
    json!({
        "low": low,
        "size": size,
        "points": bytes(view.points.iter().flat_map(place).map(u16::to_le_bytes)),
        "triangles": bytes(view.triangles.iter().flatten().map(|k| k.to_le_bytes())),
        "edges": bytes(view.edges.iter().flatten().map(|k| k.to_le_bytes())),
        "fixed": BASE64_STANDARD.encode(view.fixed.iter().map(|held| u8::from(*held)).collect::<Vec<u8>>()),
        "contacts": contacts.collect::<Vec<_>>(),
        "fields": fields,
    })
}

/// Values from 0 to their largest in 255 steps.
fn field(name: &str, unit: &str, values: &[f64]) -> Value {
    let high = values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let steps = values.iter().map(|value| (255.0 * value / high).round() as u8).collect::<Vec<u8>>();
    json!({ "name": name, "unit": unit, "low": 0.0, "high": high, "values": BASE64_STANDARD.encode(steps) })
}

fn bytes<const N: usize>(numbers: impl Iterator<Item = [u8; N]>) -> String {
    BASE64_STANDARD.encode(numbers.flatten().collect::<Vec<u8>>())
}
