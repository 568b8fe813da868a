//! How true and how wide the prediction intervals are, and the errors of the models in the validation base.

use crate::error::Result;
use crate::evidence::study::{Cell, Claim, Note, Study};
use crate::format::percent_above;
use crate::plot::axis::{Plot, PlotAxis};
use crate::plot::colours::{MODELS, hex};
use crate::plot::polyline::path;
use crate::plot::{Svg, Theme};
use crate::prediction::held_out::{HALVED, HeldOut, JudgedValue, expected, held_out, quantities, strata};
use crate::prediction::{MEASURES, SolvedScene, error, refused, solved};
use crate::scene::Model;
use maud::{Markup, html};

const COLUMNS: &str = "group, quantity, values, within, within_alone, expected_from, expected_to, median_half_width, median_error, \
     bias_a, deviation_a, bias_b, deviation_b, bias_c, deviation_c";
const EVERY: [Model; 3] = [Model::A, Model::B, Model::C];
/// Largest median half width that is aimed at, in the group without features, by quantity.
const AIMS: [(&str, f64); 3] =
    [("efficiency", 0.002), ("outer_force_peak", 0.005), ("inner_force_peak", 0.005)];
const PLAIN: &str = "dry";
/// A finer reference decides where its error (95 %) is at most this share of the half width.
const DECISIVE: f64 = 0.5;
/// Share of all values that may lie outside of their intervals.
const OUTSIDE: f64 = 0.07;
/// Scenes that are listed where model C is worst.
const WORST: usize = 10;

/// The study.
///
/// # Errors
/// None.
pub fn run(_: &mut Note) -> Result<Study> {
    let held = held_out();
    let mut rows = Vec::new();
    for stratum in strata() {
        let own: Vec<&HeldOut> = held.iter().filter(|held| held.scene.stratum == stratum).collect();
        let scenes: Vec<&'static SolvedScene> =
            solved().iter().filter(|scene| scene.stratum == stratum).collect();
        rows.extend(quantities(&scenes).into_iter().map(|quantity| row(stratum, quantity, &own, &scenes)));
    }
    Ok(Study::new("prediction", description(&held), COLUMNS, rows, claims(&held)))
}

fn row(
    stratum: &'static str,
    quantity: &'static str,
    held: &[&HeldOut],
    scenes: &[&SolvedScene],
) -> Vec<Cell> {
    let judged: Vec<&JudgedValue> = held.iter().filter_map(|held| held.quantities.get(quantity)).collect();
    let count = judged.len();
    let within = judged.iter().filter(|judged| judged.is_within()).count();
    let [from, to] = expected(count);
    let share = |n: usize| if count > 0 { Cell::Number(n as f64 / count as f64) } else { Cell::Missing };
    let mut row = vec![Cell::Text(stratum), Cell::Text(quantity), count.into()];
    let alone = judged.iter().filter(|judged| judged.seen.error <= judged.half_width).count();
    row.extend([share(within), share(alone), share(from), share(to)]);
    row.push(median(judged.iter().map(|judged| judged.half_width)).into());
    row.push(median(judged.iter().map(|judged| judged.seen.error)).into());
    for model in EVERY {
        let errors: Vec<f64> =
            scenes.iter().filter_map(|scene| Some(error(scene, model, quantity)?.0)).collect();
        let moments = moments(&errors);
        row.extend([moments.map(|m| m.0), moments.map(|m| m.1)].map(Cell::from));
    }
    row
}

/// Mean and standard deviation; `None` of fewer than two.
fn moments(values: &[f64]) -> Option<(f64, f64)> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (values.len() > 1).then_some((mean, square.sqrt()))
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

fn description(held: &[HeldOut]) -> String {
    let mut text = format!(
        "Prediction intervals of 95 % on the {} solved random scenes of the validation base: in groups of at least {HALVED} scenes one half \
         predicts the other one, both ways; in smaller ones each scene is predicted by all others. `within`: share of the references' values that lie in their interval, the square of the reference's error added to that of its half width (`within_alone`: not added); \
         it is expected between the two shares that follow in 95 of 100 such studies. Errors and half widths are relative to the value; of velocities to the impact \
         speed; of an efficiency below 5 % and an inner force below 5 % of the outer one to these. Bias and standard deviation are those of \
         models A, B and C, the reference's own error included.",
        solved().len()
    );
    text += "\n\nModel C has its largest errors, beyond that of the reference, in:\n";
    for (scene, quantity, judged) in worst(held) {
        let (error, noise) = (percent_above(judged.seen.error), percent_above(judged.seen.noise));
        text += &format!("\n- {scene}: {quantity} {error} (error of the reference {noise})");
    }
    if !refused().is_empty() {
        text += "\n\nNot solved:\n";
        for scene in refused() {
            text += &format!("\n- {}: {}", scene.scene, scene.refused);
        }
    }
    text
}

/// The scenes where model C is worst, each with its worst quantity, the worst first.
fn worst(held: &[HeldOut]) -> Vec<(&str, &'static str, &JudgedValue)> {
    let mut found: Vec<(&str, &'static str, &JudgedValue)> = held
        .iter()
        .filter_map(|held| {
            let all = held.quantities.iter().map(|(name, judged)| (held.scene.scene.as_str(), *name, judged));
            all.max_by(|a, b| a.2.seen.excess().total_cmp(&b.2.seen.excess()))
        })
        .collect();
    found.sort_by(|a, b| b.2.seen.excess().total_cmp(&a.2.seen.excess()));
    found.truncate(WORST);
    found
}

fn claims(held: &[HeldOut]) -> Vec<Claim> {
    let all: Vec<&JudgedValue> = held.iter().flat_map(|held| held.quantities.values()).collect();
    let share = |judged: &[&JudgedValue]| {
        let outside = judged.iter().filter(|judged| !judged.is_within()).count();
        (!judged.is_empty()).then(|| outside as f64 / judged.len() as f64)
    };
    let finer: Vec<HeldOut> = held.iter().filter_map(HeldOut::on_finer_meshes).collect();
    let on_finer: Vec<&JudgedValue> = finer.iter().flat_map(|held| held.quantities.values()).collect();
    // the error of the finer reference hardly matters there
    let decides = |judged: &&&JudgedValue| judged.seen.noise <= DECISIVE * judged.half_width;
    let deciding: Vec<&JudgedValue> = on_finer.iter().filter(decides).copied().collect();
    let outside = |judged: &[&JudgedValue], meshes: &str| {
        let text = format!("share of {} values{meshes} outside of their intervals of 95 %", judged.len());
        Claim::new(text, "1", None, share(judged), OUTSIDE)
    };
    let meshes = format!(" on finer meshes of {} random scenes", finer.len());
    let exact = format!("{meshes}, where their own error is at most half of the half width,");
    let mut claims = vec![outside(&all, ""), outside(&on_finer, &meshes), outside(&deciding, &exact)];
    for (quantity, aim) in AIMS {
        let plain = held.iter().filter(|held| held.scene.stratum == PLAIN);
        let widths = plain.filter_map(|held| Some(held.quantities.get(quantity)?.half_width));
        let text = format!("median half width of the interval of {quantity}, group `{PLAIN}`");
        claims.push(Claim::new(text, "1", None, median(widths), aim));
    }
    claims
}

/// A coordinate system of the figure.
struct ParityPlot {
    quantity: &'static str,
    label: &'static str,
    /// Logarithmic; else over the impact's speed, or as it is.
    logarithmic: bool,
    /// Whether it is relative to the impact's speed.
    over_speed: bool,
}

const PARITIES: [ParityPlot; 6] = [
    ParityPlot { quantity: "efficiency", label: "efficiency", logarithmic: false, over_speed: false },
    ParityPlot {
        quantity: "outer_force_peak",
        label: "outer force peak in N",
        logarithmic: true,
        over_speed: false,
    },
    ParityPlot {
        quantity: "inner_force_peak",
        label: "inner force peak in N",
        logarithmic: true,
        over_speed: false,
    },
    ParityPlot {
        quantity: "outer_velocity_final",
        label: "outer velocity over impact speed",
        logarithmic: false,
        over_speed: true,
    },
    ParityPlot {
        quantity: "outer_contact_end",
        label: "outer contact end in s",
        logarithmic: true,
        over_speed: false,
    },
    ParityPlot {
        quantity: "first_frequency",
        label: "first frequency in Hz",
        logarithmic: true,
        over_speed: false,
    },
];
const PANEL: f64 = 330.0;
const MARGIN: (f64, f64, f64, f64) = (72.0, 34.0, 14.0, 54.0);
const LEGEND: f64 = 54.0;
const ACROSS: usize = 3;
/// Ends of the axis of model C's errors.
const ERRORS: [f64; 2] = [1e-6, 1.0];

/// Model against reference by quantity, and the errors of model C over the contact patch, as SVG.
pub fn figure(_: &Study) -> String {
    let panels: Vec<Markup> =
        PARITIES.iter().map(parity).chain(AIMS.iter().map(|(q, _)| over_patch(q))).collect();
    let size = [ACROSS as f64 * PANEL, panels.len().div_ceil(ACROSS) as f64 * PANEL + LEGEND];
    let place = |k: usize| ((k % ACROSS) as f64 * PANEL, (k / ACROSS) as f64 * PANEL);
    let drawing = html! {
        @for (k, panel) in panels.iter().enumerate() {
            @let (x, y) = place(k);
            g transform=(format!("translate({x} {y})")) { (panel) }
        }
        @for (k, (model, colour)) in MODELS.iter().enumerate() {
            circle cx=(70.0 + 110.0 * k as f64) cy=(size[1] - 14.0) r="4" fill=(hex(*colour)) {}
            text x=(80.0 + 110.0 * k as f64) y=(size[1] - 10.0) { "model " (model) }
        }
        text x="400" y=(size[1] - 30.0) { "lines of each model: mean, and 95 % of all scenes (dashed)" }
        text x="400" y=(size[1] - 10.0) { "open circles: not more than the error of the reference (95 %)" }
    };
    Svg::new("Models against references of the validation base", size, Theme::Standalone)
        .around(&drawing)
        .into_string()
}

fn plot(x: PlotAxis, y: PlotAxis) -> Plot {
    let (left, top, right, bottom) = MARGIN;
    Plot { left, top, width: PANEL - left - right, height: PANEL - top - bottom, x, y }
}

/// Model over reference.
fn parity(shown: &ParityPlot) -> Markup {
    let of = |scene: &SolvedScene, value: Option<f64>| {
        let scale = if shown.over_speed { scene.speed } else { 1.0 };
        value.map(|value| value / scale).filter(|value| !shown.logarithmic || *value > 0.0)
    };
    let pairs: Vec<(usize, f64, f64)> = solved()
        .iter()
        .flat_map(|scene| {
            let exact = of(scene, scene.values.get(shown.quantity).and_then(|values| values.reference));
            EVERY.into_iter().enumerate().filter_map(move |(k, model)| {
                Some((k, exact?, of(scene, scene.of_model(model, shown.quantity))?))
            })
        })
        .collect();
    let axis = PlotAxis::over(pairs.iter().flat_map(|(_, x, y)| [*x, *y]), shown.logarithmic).widened(0.03);
    let plot = plot(axis, axis);
    let marks = axis.marks(5);
    let ends = axis.ends();
    let measure = |value: f64| if shown.logarithmic { value.ln() } else { value };
    let value = |measure: f64| if shown.logarithmic { measure.exp() } else { measure };
    let line = |shift: f64| {
        let shifted = ends.map(|x| (x, value(measure(x) + shift).clamp(ends[0], ends[1])));
        path(&shifted.map(|end| plot.at(end)))
    };
    html! {
        text x=(plot.left) y=(plot.top - 12.0) { (shown.label) }
        (plot.grid(&marks, &marks))
        @for (k, (_, colour)) in MODELS.iter().enumerate() {
            @let off: Vec<f64> = pairs.iter().filter(|pair| pair.0 == k).map(|(_, x, y)| measure(*y) - measure(*x)).collect();
            @if let Some((mean, deviation)) = moments(&off) {
                path d=(line(mean)) stroke=(hex(*colour)) fill="none" {}
                @for side in [-1.96, 1.96] {
                    path d=(line(mean + side * deviation)) stroke=(hex(*colour)) fill="none" stroke-dasharray="4 3" {}
                }
            }
        }
        (plot.frame(&marks, &marks, ["reference", "model"]))
        @for (k, x, y) in &pairs {
            @let (x, y) = plot.at((*x, *y));
            circle cx=(format!("{x:.1}")) cy=(format!("{y:.1}")) r="2" fill=(hex(MODELS[*k].1)) {}
        }
    }
}

/// Errors of model C over the contact patch; open: not more than the error of the reference.
fn over_patch(quantity: &str) -> Markup {
    let points: Vec<(f64, f64, bool)> = solved()
        .iter()
        .filter_map(|scene| {
            let (_, seen) = error(scene, Model::C, quantity)?;
            let shown = seen.error.clamp(ERRORS[0], ERRORS[1]);
            Some((*scene.results.get(MEASURES[0])?, shown, seen.error > seen.noise))
        })
        .collect();
    let x = PlotAxis::over(points.iter().map(|point| point.0), true).widened(0.03);
    let plot = plot(x, PlotAxis::over(ERRORS.into_iter(), true));
    let (x_marks, y_marks) = (x.marks(5), plot.y.marks(7));
    let colour = hex(MODELS[2].1);
    html! {
        text x=(plot.left) y=(plot.top - 12.0) { "model C: " (quantity.replace('_', " ")) }
        (plot.grid(&x_marks, &y_marks))
        (plot.frame(&x_marks, &y_marks, ["contact radius over thickness", "relative error"]))
        @for (x, y, is_certain) in &points {
            @let (x, y) = plot.at((*x, *y));
            circle cx=(format!("{x:.1}")) cy=(format!("{y:.1}")) r="2.5" stroke=(colour) fill=(if *is_certain { &*colour } else { "none" }) {}
        }
    }
}
