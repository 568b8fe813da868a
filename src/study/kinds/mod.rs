//! The studies, by the kind of scene they are about.

pub mod plate_impact;
pub mod seal_seat;
pub mod valve;

pub use plate_impact::*;
pub use seal_seat::*;

use super::Entry;

/// All studies there are.
pub const STUDIES: [Entry; 19] = [
    Entry {
        name: "table2",
        about: "Table 2: first and first longitudinal eigenfrequency from plate to rod",
        takes_model: false,
        run: |_, note| table2::run(note),
        panels: &[],
        drawing: None,
    },
    Entry {
        name: "fig14",
        about: "Fig. 14: efficiency over Young's modulus of plate and spheres",
        takes_model: true,
        run: fig14::run,
        panels: &fig14::PANELS,
        drawing: None,
    },
    Entry {
        name: "fig15",
        about: "Fig. 15: efficiency over the plate's thickness, clamped and free",
        takes_model: true,
        run: fig15::run,
        panels: &fig15::PANELS,
        drawing: None,
    },
    Entry {
        name: "fig16",
        about: "Fig. 16: efficiency over the plate's radius, and the best radius",
        takes_model: true,
        run: fig16::run,
        panels: &fig16::PANELS,
        drawing: None,
    },
    Entry {
        name: "fig17",
        about: "Fig. 17: efficiency over the tip radius",
        takes_model: true,
        run: fig17::run,
        panels: &fig17::PANELS,
        drawing: None,
    },
    Entry {
        name: "half-period",
        about: "Section 4.1: best when the contact lasts half the plate's first period",
        takes_model: true,
        run: half_period::run,
        panels: &half_period::PANELS,
        drawing: None,
    },
    Entry {
        name: "insensitivity",
        about: "Model C with other numbers of modes, patch radii and meshes, both scenes of Table 1",
        takes_model: false,
        run: |_, note| insensitivity::run(note),
        panels: &[],
        drawing: None,
    },
    Entry {
        name: "auto",
        about: "The models that `auto` chooses: estimated against true error, and their cost",
        takes_model: false,
        run: auto::run,
        panels: &[],
        drawing: Some(auto::figure),
    },
    Entry {
        name: "actuators",
        about: "Section 2.2: energy of the inner sphere over the gap, from stack, bender and lift magnet",
        takes_model: true,
        run: actuators::run,
        panels: &actuators::PANELS,
        drawing: None,
    },
    Entry {
        name: "rocker",
        about: "Section 4.3: membrane between sapphire spheres, and struck by a piezo bender",
        takes_model: false,
        run: |_, note| rocker::run(note),
        panels: &rocker::PANELS,
        drawing: None,
    },
    Entry {
        name: "shakedown",
        about: "Section 3.4.2, Fig. 13: efficiency of repeated impacts, several yield strengths, same and fresh spots, rate",
        takes_model: true,
        run: shakedown::run,
        panels: &shakedown::PANELS,
        drawing: None,
    },
    Entry {
        name: "test-bed",
        about: "Section 3.4.2, Figs. 12 and 13: whether its statements survive the tolerances of a test bed",
        takes_model: true,
        run: test_bed::run,
        panels: &test_bed::PANELS,
        drawing: None,
    },
    Entry {
        name: "flight",
        about: "Sections 5.1.1 to 5.1.3: flights and shocks of the sphere against MuJoCo, statements on the rocker",
        takes_model: false,
        run: |_, note| flight::run(note),
        panels: &[],
        drawing: None,
    },
    Entry {
        name: "valve",
        about: "Section 5: both demonstrators from the voltage to the seat, with the scatter of a workshop",
        takes_model: false,
        run: |_, note| valve::run(note),
        panels: &valve::PANELS,
        drawing: None,
    },
    Entry {
        name: "fluid",
        about: "Section 4.2.5: squeeze film, plate damping, added mass and drag, alone and together",
        takes_model: true,
        run: fluid::run,
        panels: &fluid::PANELS,
        drawing: None,
    },
    Entry {
        name: "damping",
        about: "Section 4.2.4: what a polymer plate's damping takes, in its modes and in both contacts",
        takes_model: false,
        run: |_, note| damping::run(note),
        panels: &damping::PANELS,
        drawing: None,
    },
    Entry {
        name: "seal-seat",
        about: "Section 4.4: what decides the direction of the sphere out of the flexible seal seat",
        takes_model: false,
        run: |_, note| launch::run(note),
        panels: &launch::PANELS,
        drawing: None,
    },
    Entry {
        name: "seal-seat-direction",
        about: "The direction out of the flexible seal seat with the band of many meshes",
        takes_model: false,
        run: direction::run,
        panels: &direction::PANELS,
        drawing: None,
    },
    Entry {
        name: "seal-seat-cost",
        about: "Run times of the reduced seal seat and of the finite elements on the same mesh",
        takes_model: false,
        run: |_, note| cost::run(note),
        panels: &[],
        drawing: None,
    },
];
