//! How a seal seat is shown: flight of the sphere, curves, what model and reference have cost.

mod mesh;
mod picture;

pub use picture::{Arrow, seat_picture};

use super::{Drawing, Presentation};
use crate::format::{model_name, prefixed, significant, with_unit};
use crate::kinds::seal_seat::SeatQuantities;
use crate::reference::Stored;
use crate::report::attachments::instant_of_peak;
use crate::report::figure::geometry::PanelOf;
use crate::report::page::html::{named, scrolled};
use crate::report::page::section::Section;
use crate::report::page::section::flight;
use crate::report::page::section::mesh::paraview;
use crate::report::run_times::marked;
use crate::report::summary_column::{SummaryColumn, degrees};
use crate::report::{Attachments, SceneReport, Theme};
use crate::result::Summary;
use crate::scene::Scene;
use maud::{Markup, PreEscaped, html};
use picture::arrow_legend;

pub(super) struct Seat;

const PANELS: [PanelOf; 3] = [
    PanelOf {
        label: "Displacement in µm",
        factor: 1e6,
        curves: &[
            ("sphere x", "sphere_displacement_x"),
            ("sphere z", "sphere_displacement_z"),
            ("actuator", "actuator_displacement"),
        ],
        boxes: false,
    },
    PanelOf {
        label: "Velocity in mm/s",
        factor: 1e3,
        curves: &[
            ("sphere x", "sphere_velocity_x"),
            ("sphere z", "sphere_velocity_z"),
            ("actuator", "actuator_velocity"),
        ],
        boxes: false,
    },
    PanelOf {
        label: "Contact force in N",
        factor: 1.0,
        curves: &[("actuator", "actuator_force"), ("sphere", "sphere_force")],
        boxes: false,
    },
];

impl Presentation for Seat {
    fn columns(&self) -> &'static [SummaryColumn] {
        const COLUMNS: [SummaryColumn; 5] = [
            SummaryColumn {
                is_angle: true,
                ..SummaryColumn::new("direction", "", "direction of the sphere", "sphere_angle")
            },
            SummaryColumn::new("speed", "", "speed of the sphere", "sphere_speed"),
            SummaryColumn::new("efficiency", "", "efficiency", "efficiency"),
            SummaryColumn::new("peak force", "sphere", "peak force on the sphere", "sphere_force_peak"),
            SummaryColumn::new("peak force", "actuator", "peak force on the actuator", "actuator_force_peak"),
        ];
        &COLUMNS
    }

    fn panels(&self) -> &'static [PanelOf] {
        &PANELS
    }

    fn curves_caption(&self) -> &'static str {
        "Displacement and velocity along x and z, and contact forces, of sphere and actuator; z points away from the \
         actuator, forces are magnitudes."
    }

    fn attachments(&self, stored: &Stored) -> Attachments {
        let peak = instant_of_peak(&stored.outcome.history, "sphere_force");
        Attachments {
            section: stored.section().ok(),
            section_stress: stored.section_near(peak).ok().flatten(),
            ..Attachments::default()
        }
    }

    fn drawings(&self, report: &SceneReport) -> Vec<Drawing> {
        let section = report.scene.seal_seat().ok().map(|setup| Drawing {
            ending: "-section",
            caption: Some("Section with the directions of flight"),
            svg: seat_picture(setup, &arrows(report), Theme::Standalone),
        });
        section.into_iter().chain([Drawing::curves(report)]).collect()
    }

    fn scene_drawing(&self, report: &SceneReport) -> Markup {
        let Ok(setup) = report.scene.seal_seat() else { return html! {} };
        let arrows = arrows(report);
        html! { (PreEscaped(seat_picture(setup, &arrows, Theme::Inline))) (arrow_legend(&arrows)) }
    }

    fn measures(&self, scene: &Scene) -> Vec<(String, String)> {
        scene.seal_seat().map_or_else(|_| Vec::new(), picture::measures)
    }

    fn sections(&self, report: &SceneReport) -> Vec<Section> {
        vec![
            Section::new("flight", "Flight of the sphere", flight(report)),
            Section::new("landing", "Landing", flight::flights_html(report)),
            Section::new("cost", "Cost", cost(report)),
        ]
    }

    fn mesh(&self, report: &SceneReport) -> Markup {
        html! {
            (mesh::mesh_html(report))
            (paraview(report))
        }
    }
}

/// Directions found and intended.
fn arrows(report: &SceneReport) -> Vec<Arrow> {
    let found = |summary: &Summary| SeatQuantities::of_table(&summary.quantities);
    let arrow = |name: String, q: SeatQuantities, class, dashes| Arrow {
        name,
        velocity: [q.sphere_velocity_x, q.sphere_velocity_z],
        class,
        dashes,
    };
    let mut arrows = Vec::new();
    if let Some(reference) = found(&report.comparison.reference) {
        if let Ok(setup) = report.scene.seal_seat() {
            let (sin, cos) = setup.intended_angle.sin_cos();
            arrows.push(Arrow {
                name: "intended, with the reference's speed".into(),
                velocity: [sin, cos].map(|c| c * reference.sphere_speed),
                class: "fig-intended",
                dashes: "3 4",
            });
        }
        arrows.push(arrow("reference".into(), reference, "fig-reference", ""));
    }
    arrows.extend(report.comparison.models.iter().filter_map(|model| {
        let name = format!("model {}", model_name(&model.model, model.summary.modes));
        Some(arrow(name, found(&model.summary)?, "fig-C", "9 4"))
    }));
    arrows
}

/// Size and direction of the velocity, and how far it is from the intended direction.
fn flight(report: &SceneReport) -> Markup {
    let setup = report.scene.seal_seat().ok();
    let intended = setup.map_or(f64::NAN, |setup| setup.intended_angle);
    let turns = setup.is_some_and(|setup| setup.friction > 0.0);
    let row = |name: &str, summary: &Summary| {
        let Some(q) = SeatQuantities::of_table(&summary.quantities) else {
            return html! { tr { th scope="row" { (name) } td.left colspan=(6 + usize::from(turns)) { "not determined" } } };
        };
        html! { tr {
            th scope="row" { (name) }
            td { (with_unit(q.sphere_speed, prefixed("m/s", q.sphere_speed), 4)) }
            td data-si=(q.sphere_angle) { (degrees(q.sphere_angle)) }
            td { (degrees(q.sphere_angle - intended)) }
            td { (significant(100.0 * q.efficiency, 4)) " %" }
            td { (significant(1e6 * q.left_flank_impulse, 4)) } td { (significant(1e6 * q.right_flank_impulse, 4)) }
            @if turns { td { (summary.sphere_spin.map_or_else(|| "–".to_owned(), |spin| with_unit(spin, prefixed("rad/s", spin), 4))) } }
        } }
    };
    html! {
        (scrolled("Flight of the sphere", &html! { table {
            thead { tr {
                @for heading in ["", "speed", "direction", "from the intended", "efficiency", "left flank, µN·s", "right flank, µN·s"] {
                    th scope="col" { (named(heading)) }
                }
                @if turns { th scope="col" { "spin" } }
            } }
            tbody {
                (row("reference", &report.comparison.reference))
                @for model in &report.comparison.models {
                    (row(&model_name(&model.model, model.summary.modes), &model.summary))
                }
            }
        } }))
        p.soft { "Directions against the vertical, positive towards the intended side; impulses of the normal forces on either "
            "side of the seat's axis. " a href=(format!("{}-section.svg", report.comparison.scene)) { "Section as SVG" } }
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
