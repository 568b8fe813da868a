//! How an impact on a mass on a spring is shown.

use super::Presentation;
use crate::report::figure::geometry::PanelOf;
use crate::report::summary_column::SummaryColumn;

pub(super) struct Spring;

impl Presentation for Spring {
    fn columns(&self) -> &'static [SummaryColumn] {
        const COLUMNS: [SummaryColumn; 4] = [
            SummaryColumn::new("efficiency", "", "efficiency", "efficiency"),
            SummaryColumn::new("velocity", "", "final velocity of the sphere", "sphere_velocity_final"),
            SummaryColumn::new("peak force", "", "peak force", "sphere_force_peak"),
            SummaryColumn::new("contact ends", "", "end of the contact", "sphere_contact_end"),
        ];
        &COLUMNS
    }

    fn panels(&self) -> &'static [PanelOf] {
        const PANELS: [PanelOf; 2] = [
            PanelOf {
                label: "Velocity in mm/s",
                factor: 1e3,
                curves: &[("sphere", "sphere_velocity"), ("mass", "mass_velocity")],
                boxes: false,
            },
            PanelOf {
                label: "Contact force in N",
                factor: 1.0,
                curves: &[("sphere", "sphere_force")],
                boxes: false,
            },
        ];
        &PANELS
    }

    fn curves_caption(&self) -> &'static str {
        "Velocities of sphere and mass, and the contact force."
    }
}
