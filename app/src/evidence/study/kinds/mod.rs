//! The studies, by the kind of scene they are about.

pub mod auto;
pub mod plate_impact;
pub mod prediction;
pub mod seal_seat;
pub mod valve;

pub use plate_impact::*;
pub use seal_seat::*;

use super::Entry;

/// All studies there are.
pub const STUDIES: [Entry; 20] = [
    Entry::new("table2", |_, note| table2::run(note), "Table 2: first and first longitudinal eigenfrequency from plate to rod"),
    Entry::new("fig14", fig14::run, "Fig. 14: efficiency over Young's modulus of plate and spheres")
        .panels(&fig14::PANELS).with_models(),
    Entry::new("fig15", fig15::run, "Fig. 15: efficiency over the plate's thickness, clamped and free")
        .panels(&fig15::PANELS).with_models(),
    Entry::new("fig16", fig16::run, "Fig. 16: efficiency over the plate's radius, and the best radius")
        .panels(&fig16::PANELS).with_models(),
    Entry::new("fig17", fig17::run, "Fig. 17: efficiency over the tip radius")
        .panels(&fig17::PANELS).with_models(),
    Entry::new("half-period", half_period::run, "Section 4.1: best when the contact lasts half the plate's first period")
        .panels(&half_period::PANELS).with_models(),
    Entry::new("insensitivity", |_, note| insensitivity::run(note), "Model C with other numbers of modes, patch radii and meshes, both scenes of Table 1"),
    Entry::new("prediction", |_, note| prediction::run(note), "Prediction intervals on the validation base: how many hold, how wide they are, where model C is worst")
        .drawn(prediction::figure),
    Entry::new("auto", |_, note| auto::run(note), "The models that `auto` chooses on the validation base: predicted against true error"),
    Entry::new("actuators", actuators::run, "Section 2.2: energy of the inner sphere over the gap, from stack, bender and lift magnet")
        .panels(&actuators::PANELS).with_models(),
    Entry::new("rocker", |_, note| rocker::run(note), "Section 4.3: membrane between sapphire spheres, and struck by a piezo bender")
        .panels(&rocker::PANELS),
    Entry::new("shakedown", shakedown::run, "Section 3.4.2, Fig. 13: efficiency of repeated impacts, several yield strengths, same and fresh spots, rate")
        .panels(&shakedown::PANELS).with_models(),
    Entry::new("test-bed", test_bed::run, "Section 3.4.2, Figs. 12 and 13: whether its statements survive the tolerances of a test bed")
        .panels(&test_bed::PANELS).with_models(),
    Entry::new("flight", |_, note| flight::run(note), "Sections 5.1.1 to 5.1.3: flights and shocks of the sphere against MuJoCo, statements on the rocker"),
    Entry::new("valve", |_, note| valve::run(note), "Section 5: both demonstrators from the voltage to the seat, with workshop tolerances")
        .panels(&valve::PANELS),
    Entry::new("fluid", fluid::run, "Section 4.2.5: squeeze film, plate damping, added mass and drag, alone and together")
        .panels(&fluid::PANELS).with_models(),
    Entry::new("damping", |_, note| damping::run(note), "Section 4.2.4: what a polymer plate's damping takes, in its modes and in both contacts")
        .panels(&damping::PANELS),
    Entry::new("seal-seat", |_, note| launch::run(note), "Section 4.4: what decides the direction of the sphere out of the flexible seal seat")
        .panels(&launch::PANELS),
    Entry::new("seal-seat-direction", direction::run, "The direction out of the flexible seal seat with the band of many meshes")
        .panels(&direction::PANELS),
    Entry::new("seal-seat-cost", |_, note| cost::run(note), "Run times of the reduced seal seat and of the finite elements on the same mesh"),
];
