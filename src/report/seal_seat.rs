//! The report of a seal-seat scene: page, row of the index, lines for the terminal, Markdown, curves.

use super::attachments::Attachments;
use super::chart::{CHART_WIDTH, ChartPanel, Series, chart_of_width};
use super::discrepancy_section::model_section;
use super::figure::PHONE_WIDTH;
use super::format::{model_name, percent, prefixed, significant, with_unit};
use super::html::{detailed, named, page};
use super::page_data::{PanelOf, Shown};
use super::run_times::marked;
use super::seal_seat_picture::{Arrow, seat_picture};
use super::terminal::{findings, headline, of_model};
use super::{interactive, page_end};
use crate::comparison::{SceneComparison, align};
use crate::error::{Error, Result};
use crate::reference::MeshSection;
use crate::result::Curves;
use crate::result::Outcome;
use crate::result::SEAT_CURVES;
use crate::result::SeatQuantities;
use crate::scene::{Scene, Setup};
use maud::{Markup, PreEscaped, html};

/// What reduced model and reference have cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Mesh to modes and flexibility, or from the cache, s.
    pub setup_seconds: f64,
    /// Degrees of freedom of the mesh without those that supports hold.
    pub dofs: usize,
}

/// One seal-seat scene of the report.
#[derive(Debug, Clone)]
pub struct SeatReport {
    /// The scene.
    pub scene: Scene,
    /// Its comparison.
    pub comparison: SceneComparison<SeatQuantities>,
    /// Result of the reference.
    pub reference: Outcome<SeatQuantities>,
    /// Results of the reduced models, in the order of `comparison.models`.
    pub reduced: Vec<Outcome<SeatQuantities>>,
    /// Cost of each reduced model, in the same order.
    pub cost: Vec<Cost>,
    /// How the reference was made, as its store says.
    pub provenance: serde_json::Value,
    /// Section of the reference's mesh in the plane of symmetry.
    pub section: Option<MeshSection>,
    /// The same with the stress at an instant (s), if the reference has kept one.
    pub stress: Option<(f64, MeshSection)>,
    /// The series of deformed states that ParaView plays, if the reference has one.
    pub animation: Option<std::path::PathBuf>,
    /// Command line that makes this comparison again.
    pub command: String,
    /// What else there is to show: trends and accepted changes.
    pub attachments: Attachments,
}

/// Directions found and intended.
fn arrows(report: &SeatReport) -> Vec<Arrow> {
    let of = |q: &SeatQuantities| [q.sphere_velocity_x, q.sphere_velocity_z];
    let reference = &report.comparison.reference.quantities;
    let mut arrows = Vec::new();
    if let Setup::SealSeat(setup) = &report.scene.setup {
        let (sin, cos) = setup.intended_angle.sin_cos();
        let velocity = [sin, cos].map(|c| c * reference.sphere_speed);
        arrows.push(Arrow {
            name: "intended, drawn with the reference's speed".into(),
            velocity,
            colour: "#777777",
            dashes: "3 4",
        });
    }
    arrows.push(Arrow { name: "reference".into(), velocity: of(reference), colour: "#1a1a1a", dashes: "" });
    for model in &report.comparison.models {
        let name = format!("model {}", model_name(&model.model, model.summary.modes));
        arrows.push(Arrow {
            name,
            velocity: of(&model.summary.quantities),
            colour: "#009e73",
            dashes: "9 4",
        });
    }
    arrows
}

/// The section with both arrows, as a stand-alone SVG; `None` for a scene of another kind.
pub fn seat_section(report: &SeatReport) -> Option<String> {
    let Setup::SealSeat(setup) = &report.scene.setup else { return None };
    Some(seat_picture(setup, &arrows(report)))
}

/// Forces and velocities over time, as a stand-alone SVG.
pub fn seat_curves(report: &SeatReport) -> String {
    curves(report, CHART_WIDTH)
}

fn curves(report: &SeatReport, width: f64) -> String {
    let panel = |quantity: &str, label: &str| {
        let series = |name: String, outcome: &Outcome<SeatQuantities>| {
            let values = outcome.history.values(quantity).unwrap_or_default();
            let points = outcome.history.time().iter().zip(values).map(|(t, v)| (1e6 * t, *v)).collect();
            Series { name, points, marks: false }
        };
        let models = report.comparison.models.iter().zip(&report.reduced);
        let reduced = models.map(|(model, outcome)| series(format!("model {}", model.model), outcome));
        ChartPanel {
            x_label: "time, µs".into(),
            y_label: label.into(),
            series: std::iter::once(series("reference".into(), &report.reference)).chain(reduced).collect(),
            ..ChartPanel::default()
        }
    };
    chart_of_width(
        width,
        "Forces and velocities of sphere and actuator",
        &[
            panel("sphere_force", "force on the sphere, N"),
            panel("actuator_force", "force of the actuator, N"),
            panel("sphere_velocity_x", "velocity of the sphere along x, m/s"),
            panel("sphere_velocity_z", "velocity of the sphere along z, m/s"),
        ],
    )
}

/// The panels of a seal seat's page.
fn panels() -> Vec<PanelOf> {
    let panel = |label, factor, curves: &[(&'static str, &str)]| PanelOf {
        label,
        factor,
        curves: curves.iter().map(|(body, name)| (*body, (*name).to_owned())).collect(),
    };
    vec![
        panel(
            "Displacement in µm",
            1e6,
            &[
                ("sphere x", "sphere_displacement_x"),
                ("sphere z", "sphere_displacement_z"),
                ("actuator", "actuator_displacement"),
            ],
        ),
        panel(
            "Velocity in mm/s",
            1e3,
            &[
                ("sphere x", "sphere_velocity_x"),
                ("sphere z", "sphere_velocity_z"),
                ("actuator", "actuator_velocity"),
            ],
        ),
        panel("Contact force in N", 1.0, &[("actuator", "actuator_force"), ("sphere", "sphere_force")]),
    ]
}

/// The page of one scene.
pub fn seat_page(report: &SeatReport) -> String {
    let comparison = &report.comparison;
    let name = &comparison.scene;
    let body = html! {
        (page_end::head(&report.scene, comparison))
        h2 { "Flight of the sphere" }
        @if let Some(section) = seat_section(report) { figure { (detailed("Section of the seat", &html! { (PreEscaped(section)) })) } }
        (directions(report))
        h2 { "Curves" }
        (interactive::panels(&seat_curves(report), &curves(report, PHONE_WIDTH)))
        p.soft { "Displacement and velocity along x and z, and contact forces, of sphere and actuator; z points away from the "
            "actuator, forces are magnitudes. Shaded: the 95 % band of the reference. "
            a href=(format!("{name}.svg")) { "curves as SVG" } " · " a href=(format!("{name}.csv")) { "curves as CSV" } " · "
            a href=(format!("{name}-section.svg")) { "section as SVG" } }
        @if let Some(animation) = &report.animation {
            p { "Fields of the stored solution, for ParaView (`impactcheck reference SCENE --fields 40` makes a series): " code { (animation.display()) } }
        }
        @for model in &comparison.models { (model_section(model)) }
        h2 { "Cost" }
        (cost(report))
        h2 { "Mesh and solver" }
        (super::seal_seat_mesh::mesh_html(report))
        (page_end::numbers(comparison))
        (page_end::end(comparison, &report.attachments, &report.provenance, &report.command))
    };
    let shown = Shown {
        window: comparison.window,
        reference: &report.reference,
        reduced: &report.reduced,
        bands: report.attachments.bands.as_ref(),
    };
    let scripts = interactive::scripts(comparison, &shown, &panels());
    page(&format!("{name} · impactcheck"), &[interactive::STYLE], &body, &scripts)
}

/// Size and direction of the velocity, and how far it is from the intended direction.
fn directions(report: &SeatReport) -> Markup {
    let intended = match &report.scene.setup {
        Setup::SealSeat(setup) => setup.intended_angle,
        Setup::PlateImpact(_) => f64::NAN,
    };
    let row = |name: &str, q: &SeatQuantities| {
        html! { tr {
            th scope="row" { (name) }
            td { (with_unit(q.sphere_speed, prefixed("m/s", q.sphere_speed), 4)) }
            td data-si=(q.sphere_angle) { (format!("{:+.2}°", q.sphere_angle.to_degrees())) }
            td { (format!("{:+.2}°", (q.sphere_angle - intended).to_degrees())) }
            td { (significant(100.0 * q.efficiency, 4)) " %" }
            td { (significant(1e6 * q.left_flank_impulse, 4)) } td { (significant(1e6 * q.right_flank_impulse, 4)) }
        } }
    };
    html! {
        div.scroll role="region" tabindex="0" aria-label="Flight of the sphere" { table {
            thead { tr {
                @for heading in ["", "speed", "direction", "from the intended", "efficiency", "left flank, µN·s", "right flank, µN·s"] {
                    th scope="col" { (named(heading)) }
                }
            } }
            tbody {
                (row("reference", &report.comparison.reference.quantities))
                @for model in &report.comparison.models {
                    (row(&model_name(&model.model, model.summary.modes), &model.summary.quantities))
                }
            }
        } }
        p.soft { "Directions against the vertical, positive towards the intended side; impulses of the normal forces on either "
            "side of the seat's axis." }
    }
}

fn cost(report: &SeatReport) -> Markup {
    let reference = report.comparison.reference.solve_seconds;
    html! {
        @for (model, cost) in report.comparison.models.iter().zip(&report.cost) {
            @let own = model.summary.solve_seconds;
            p { "Time loop of the reference " (with_unit(reference, prefixed("s", reference), 3)) " when it was made; model "
                (model_name(&model.model, model.summary.modes)) " " (marked(&with_unit(own, prefixed("s", own), 3))) " when this page was made, after "
                (marked(&with_unit(cost.setup_seconds, prefixed("s", cost.setup_seconds), 3))) " of set-up on the same mesh ("
                (cost.dofs) " degrees of freedom; from the cache if it was there): " (marked(&significant(reference / own, 3)))
                " times as fast." }
        }
    }
}

/// Lines for the terminal: values of the reference and of each model, and what failed.
pub(super) fn terminal(report: &SeatReport) -> String {
    let comparison = &report.comparison;
    let reference = &comparison.reference.quantities;
    let mut text = headline(comparison);
    text += &format!(
        "  {:<10}{:>20}{:>22}{:>22}{:>22}  verdict\n",
        "", "direction", "speed, m/s", "sphere peak, N", "actuator peak, N"
    );
    let line = |name: &str, q: &SeatQuantities, verdict: &str| {
        let cell = |own: f64, m: f64| match name {
            "reference" => format!("{:>22}", significant(own, 4)),
            _ => {
                format!("{:>22}", format!("{} ({})", significant(own, 4), percent(Some((own - m) / m.abs()))))
            }
        };
        let angle = match name {
            "reference" => format!("{:+.2}°", q.sphere_angle.to_degrees()),
            _ => format!(
                "{:+.2}° ({:+.2}°)",
                q.sphere_angle.to_degrees(),
                (q.sphere_angle - reference.sphere_angle).to_degrees()
            ),
        };
        format!(
            "  {name:<10}{angle:>20}{}{}{}  {verdict}\n",
            cell(q.sphere_speed, reference.sphere_speed),
            cell(q.sphere_force_peak, reference.sphere_force_peak),
            cell(q.actuator_force_peak, reference.actuator_force_peak)
        )
    };
    text += &line("reference", reference, "");
    for model in &comparison.models {
        text += &line(&model.model, &model.summary.quantities, &of_model(model));
    }
    text + &findings(comparison) + "\n"
}

/// Both histories on the reference's time axis as CSV.
///
/// # Errors
/// [`Error::Internal`] if it can't be written.
pub fn seat_curves_csv(report: &SeatReport) -> Result<Vec<u8>> {
    let internal = |e: csv::Error| Error::Internal(format!("writing CSV: {e}"));
    let mut writer = csv::Writer::from_writer(Vec::new());
    let sources = || report.comparison.models.iter().map(|m| m.model.clone());
    let names = |source: String| SEAT_CURVES.iter().map(move |(curve, _)| format!("{source}_{curve}"));
    let header = std::iter::once("time".to_owned()).chain(names("reference".into()));
    writer.write_record(header.chain(sources().flat_map(names))).map_err(internal)?;
    if let Some(axis) = report.comparison.window {
        let aligned: Vec<_> =
            report.reduced.iter().map(|r| align(axis, &report.reference.history, &r.history)).collect();
        for k in 0..axis.samples {
            let reference = aligned.first().into_iter().flatten().map(|curve| curve.reference[k]);
            let reduced = aligned.iter().flatten().map(|curve| curve.reduced[k]);
            let row: Vec<f64> = std::iter::once(axis.time(k)).chain(reference).chain(reduced).collect();
            writer.serialize(row).map_err(internal)?;
        }
    }
    writer.into_inner().map_err(|e| internal(e.into_error().into()))
}
