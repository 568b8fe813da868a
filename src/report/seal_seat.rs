//! How a seal seat is shown: flight of the sphere, curves, what model and reference have cost.

use super::attachments::instant_of_peak;
use super::chart::{CHART_WIDTH, ChartPanel, Series, chart_of_width};
use super::discrepancy_section::model_section;
use super::figure::PHONE_WIDTH;
use super::format::{model_name, prefixed, significant, with_unit};
use super::html::{detailed, named, page};
use super::page_data::PanelOf;
use super::presentation::{Column, Drawing, Presentation};
use super::run_times::marked;
use super::seal_seat_picture::{Arrow, seat_picture};
use super::{Attachments, SceneReport, interactive, page_end};
use crate::kinds::seal_seat::SeatQuantities;
use crate::project::project_root;
use crate::reference::Stored;
use crate::result::{Outcome, Summary};
use crate::scene::Setup;
use maud::{Markup, PreEscaped, html};
use std::path::{Path, PathBuf};

/// Name of the series of fields in the folder of a reference.
const ANIMATION: &str = "stress.pvd";

/// How a seal seat is shown.
pub(super) struct Seat;

impl Presentation for Seat {
    fn columns(&self) -> &'static [Column] {
        const COLUMNS: [Column; 4] = [
            Column { is_angle: true, ..Column::new("direction", "sphere_angle") },
            Column::new("speed", "sphere_speed"),
            Column::new("sphere peak", "sphere_force_peak"),
            Column::new("actuator peak", "actuator_force_peak"),
        ];
        &COLUMNS
    }

    fn attachments(&self, stored: &Stored) -> Attachments {
        let peak = instant_of_peak(&stored.outcome.history, "sphere_force");
        let animation = Some(stored.folder.join(ANIMATION)).filter(|file| file.is_file());
        // the same on every machine, so that equal results give equal reports
        let root = project_root().unwrap_or_default();
        let in_project = |file: PathBuf| file.strip_prefix(&root).map(Path::to_owned).unwrap_or(file);
        Attachments {
            section: stored.section().ok(),
            section_stress: stored.section_near(peak).ok().flatten(),
            animation: animation.map(in_project),
            ..Attachments::default()
        }
    }

    fn drawings(&self, report: &SceneReport) -> Vec<Drawing> {
        let section = section(report).map(|svg| Drawing {
            ending: "-section",
            caption: Some("Section with the directions of flight"),
            svg,
        });
        let svg = curves(report, CHART_WIDTH);
        let curves = Drawing { ending: "", caption: Some("Forces and velocities"), svg };
        section.into_iter().chain([curves]).collect()
    }

    fn page(&self, report: &SceneReport) -> String {
        page_of(report)
    }
}

/// Directions found and intended.
fn arrows(report: &SceneReport) -> Vec<Arrow> {
    let found = |summary: &Summary| SeatQuantities::of_table(&summary.quantities);
    let arrow = |name: String, q: SeatQuantities, colour, dashes| Arrow {
        name,
        velocity: [q.sphere_velocity_x, q.sphere_velocity_z],
        colour,
        dashes,
    };
    let mut arrows = Vec::new();
    if let Some(reference) = found(&report.comparison.reference) {
        if let Setup::SealSeat(setup) = &report.scene.setup {
            let (sin, cos) = setup.intended_angle.sin_cos();
            arrows.push(Arrow {
                name: "intended, drawn with the reference's speed".into(),
                velocity: [sin, cos].map(|c| c * reference.sphere_speed),
                colour: "#777777",
                dashes: "3 4",
            });
        }
        arrows.push(arrow("reference".into(), reference, "#1a1a1a", ""));
    }
    arrows.extend(report.comparison.models.iter().filter_map(|model| {
        let name = format!("model {}", model_name(&model.model, model.summary.modes));
        Some(arrow(name, found(&model.summary)?, "#009e73", "9 4"))
    }));
    arrows
}

/// The section with all arrows, as a stand-alone SVG; `None` for a scene of another kind.
fn section(report: &SceneReport) -> Option<String> {
    let Setup::SealSeat(setup) = &report.scene.setup else { return None };
    Some(seat_picture(setup, &arrows(report)))
}

/// Forces and velocities over time, as a stand-alone SVG.
fn curves(report: &SceneReport, width: f64) -> String {
    let panel = |quantity: &str, label: &str| {
        let series = |name: String, outcome: &Outcome| {
            let values = outcome.history.curve(quantity).unwrap_or_default();
            let points = outcome.history.time.iter().zip(values).map(|(t, v)| (1e6 * t, *v)).collect();
            Series { name, points, marks: false }
        };
        let models = report.comparison.models.iter().zip(report.reduced);
        let reduced = models.map(|(model, outcome)| series(format!("model {}", model.model), outcome));
        ChartPanel {
            x_label: "time, µs".into(),
            y_label: label.into(),
            series: std::iter::once(series("reference".into(), report.reference)).chain(reduced).collect(),
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

fn page_of(report: &SceneReport) -> String {
    let comparison = &report.comparison;
    let name = &comparison.scene;
    let body = html! {
        (page_end::head(report))
        h2 { "Flight of the sphere" }
        @if let Some(section) = section(report) { figure { (detailed("Section of the seat", &html! { (PreEscaped(section)) })) } }
        (directions(report))
        h2 { "Curves" }
        (interactive::panels(&curves(report, CHART_WIDTH), &curves(report, PHONE_WIDTH)))
        p.soft { "Displacement and velocity along x and z, and contact forces, of sphere and actuator; z points away from the "
            "actuator, forces are magnitudes. Shaded: the 95 % band of the reference. "
            a href=(format!("{name}.svg")) { "curves as SVG" } " · " a href=(format!("{name}.csv")) { "curves as CSV" } " · "
            a href=(format!("{name}-section.svg")) { "section as SVG" } }
        @if let Some(animation) = &report.attachments.animation {
            p { "Fields of the stored solution, for ParaView (`impactcheck reference SCENE --fields 40` makes a series): " code { (animation.display()) } }
        }
        @for model in &comparison.models { (model_section(model)) }
        h2 { "Cost" }
        (cost(report))
        h2 { "Mesh and solver" }
        (super::seal_seat_mesh::mesh_html(report))
        (page_end::numbers(comparison))
        (page_end::end(report))
    };
    let scripts = interactive::scripts(report, &panels());
    page(&format!("{name} · impactcheck"), &[interactive::STYLE], &body, &scripts)
}

/// Size and direction of the velocity, and how far it is from the intended direction.
fn directions(report: &SceneReport) -> Markup {
    let intended = match &report.scene.setup {
        Setup::SealSeat(setup) => setup.intended_angle,
        Setup::PlateImpact(_) => f64::NAN,
    };
    let row = |name: &str, summary: &Summary| {
        let Some(q) = SeatQuantities::of_table(&summary.quantities) else {
            return html! { tr { th scope="row" { (name) } td.left colspan="6" { "not determined" } } };
        };
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
                (row("reference", &report.comparison.reference))
                @for model in &report.comparison.models {
                    (row(&model_name(&model.model, model.summary.modes), &model.summary))
                }
            }
        } }
        p.soft { "Directions against the vertical, positive towards the intended side; impulses of the normal forces on either "
            "side of the seat's axis." }
    }
}

fn cost(report: &SceneReport) -> Markup {
    let reference = report.comparison.reference.solve_seconds;
    html! {
        @for (model, cost) in report.comparison.models.iter().zip(&report.attachments.cost) {
            @let own = model.summary.solve_seconds;
            p { "Time loop of the reference " (with_unit(reference, prefixed("s", reference), 3)) " when it was made; model "
                (model_name(&model.model, model.summary.modes)) " " (marked(&with_unit(own, prefixed("s", own), 3))) " when this page was made, after "
                (marked(&with_unit(cost.setup_seconds, prefixed("s", cost.setup_seconds), 3))) " of set-up on the same mesh ("
                (cost.dofs) " degrees of freedom; from the cache if it was there): " (marked(&significant(reference / own, 3)))
                " times as fast." }
        }
    }
}
