//! Table 2 of the paper: first and first longitudinal eigenfrequency of a fixed circular plate of radius 3 mm, from
//! plate (t = 0.1 mm) to rod (t = 24 mm), by two independent continuum discretisations.
//!
//! The paper does not name the material. Titanium (115 GPa, 0.37, 4430 kg/m^3; the plates of section 4.2.2), with
//! both displacements zero on the whole rim, reproduces its values; steel does not.

use super::parameter::{self, impact, titanium};
use crate::body::continuum::{self, PlateMode};
use crate::error::{Error, Result};
use crate::evidence::study::{Cell, Claim, Note, Study};
use crate::kinds::plate_impact::PlateImpact;
use crate::reference;
use crate::scene::{Edge, Plate, Scene};
use std::path::Path;

/// Radius of the plate, m.
const RADIUS: f64 = 3e-3;
/// Half of the last digit the paper prints (whole kHz), Hz.
const ROUNDING: f64 = 500.0;
/// Relative error that the paper's frequencies, from a mesh it does not describe, are granted beyond rounding; the
/// same that our two discretisations may differ by.
const AGREEMENT: f64 = 1e-3;
/// Most modes looked at for a longitudinal one.
const MOST_MODES: usize = 64;

/// First and first longitudinal eigenfrequency of a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frequencies {
    /// First eigenfrequency, Hz.
    pub first: f64,
    /// First longitudinal eigenfrequency, Hz.
    pub longitudinal: f64,
    /// Number of the first longitudinal one among all axisymmetric ones, from 1.
    pub number: usize,
}

impl Frequencies {
    /// From the lowest modes, ascending; `None` if there is no longitudinal one among them.
    pub fn of(modes: &[PlateMode]) -> Option<Self> {
        let index = modes.iter().position(|mode| mode.longitudinal)?;
        let [first, longitudinal] = [0, index].map(|i| modes[i].frequency);
        Some(Frequencies { first, longitudinal, number: index + 1 })
    }

    /// Largest relative difference of the two frequencies from those of `other`.
    pub fn difference(&self, other: &Frequencies) -> f64 {
        let relative = |a: f64, b: f64| (a / b - 1.0).abs();
        relative(self.first, other.first).max(relative(self.longitudinal, other.longitudinal))
    }
}

/// The paper's Table 2: thickness in m and what it gives for it.
pub const PAPER: [(f64, Frequencies); 6] = [
    (0.1e-3, Frequencies { first: 29e3, longitudinal: 1116e3, number: 7 }),
    (0.5e-3, Frequencies { first: 136e3, longitudinal: 1117e3, number: 4 }),
    (3e-3, Frequencies { first: 341e3, longitudinal: 869e3, number: 3 }),
    (6e-3, Frequencies { first: 368e3, longitudinal: 593e3, number: 2 }),
    (12e-3, Frequencies { first: 380e3, longitudinal: 444e3, number: 2 }),
    (24e-3, Frequencies { first: 386e3, longitudinal: 399e3, number: 2 }),
];

/// The plate of the table with `thickness` in m.
pub fn plate(thickness: f64) -> Plate {
    Plate { radius: RADIUS, thickness, edge: Edge::Clamped, material: titanium(), damping_ratio: 0.0 }
}

/// The table's frequencies from the continuum plate of model C.
///
/// # Errors
/// [`Error::Solver`] if the numerics fail.
pub fn reduced(thickness: f64) -> Result<Frequencies> {
    first_longitudinal(8, |count| continuum::eigenfrequencies(&plate(thickness), count))
}

/// The table's frequencies from FEniCSx and SLEPc, run by `python`.
///
/// # Errors
/// [`Error::Solver`] if the solver fails.
pub fn fenicsx(python: &Path, thickness: f64) -> Result<Frequencies> {
    let scene = scene(thickness);
    first_longitudinal(8, |count| reference::plate_modes(python, &scene, count))
}

/// The study.
///
/// # Errors
/// [`Error::Solver`] if one of the two solvers fails; a missing FEniCSx is no error.
pub fn run(note: &mut Note) -> Result<Study> {
    let python = reference::python()
        .inspect_err(|missing| note(&format!("the columns of FEniCSx stay empty: {missing}")))
        .ok();
    let mut rows = Vec::new();
    let mut claims = Vec::new();
    for (thickness, paper) in PAPER {
        let ours = reduced(thickness)?;
        if python.is_some() {
            note(&format!("t = {} mm: FEniCSx", millimetres(thickness)));
        }
        let theirs = python.as_ref().map(|python| fenicsx(python, thickness)).transpose()?;
        rows.push(row(thickness, &paper, &ours, theirs.as_ref()));
        claims.extend(paper_claims(thickness, &paper, &ours));
        claims.push(agreement(thickness, &ours, theirs.as_ref()));
    }
    Ok(Study::new(
        "table2",
        "Table 2 of the paper: first and first longitudinal axisymmetric eigenfrequency of a fixed \
                      titanium plate of radius 3 mm, by the continuum plate of model C (reduced) and by FEniCSx \
                      with SLEPc (fenicsx). A frequency of the paper is met within 0.5 kHz (it is printed in whole \
                      kHz) plus 0.1 %.",
        "thickness [m], first_paper [Hz], first_reduced [Hz], first_fenicsx [Hz], \
         longitudinal_paper [Hz], longitudinal_reduced [Hz], longitudinal_fenicsx [Hz], \
         number_paper, number_reduced, number_fenicsx",
        rows,
        claims,
    ))
}

fn row(thickness: f64, paper: &Frequencies, ours: &Frequencies, theirs: Option<&Frequencies>) -> Vec<Cell> {
    let columns = [Some(paper), Some(ours), theirs];
    let mut row = vec![Cell::Number(thickness)];
    row.extend(columns.map(|f| Cell::from(f.map(|f| f.first))));
    row.extend(columns.map(|f| Cell::from(f.map(|f| f.longitudinal))));
    row.extend(columns.map(|f| Cell::from(f.map(|f| f.number))));
    row
}

/// The three numbers of a row of the paper against ours.
fn paper_claims(thickness: f64, paper: &Frequencies, ours: &Frequencies) -> [Claim; 3] {
    let t = millimetres(thickness);
    let frequency = |what: &str, paper: f64, ours: f64| {
        let bound = ROUNDING + AGREEMENT * paper;
        Claim::new(format!("t = {t} mm: {what} eigenfrequency"), "Hz", Some(paper), Some(ours), bound)
    };
    [
        frequency("first", paper.first, ours.first),
        frequency("first longitudinal", paper.longitudinal, ours.longitudinal),
        Claim::new(
            format!("t = {t} mm: number of the first longitudinal one"),
            "1",
            Some(paper.number as f64),
            Some(ours.number as f64),
            0.0,
        ),
    ]
}

/// Our two discretisations against each other.
fn agreement(thickness: f64, ours: &Frequencies, theirs: Option<&Frequencies>) -> Claim {
    let difference = theirs.map(|theirs| {
        // another number of the longitudinal mode is no agreement, however close the frequencies are
        if ours.number == theirs.number { ours.difference(theirs) } else { 1.0 }
    });
    let claim = format!("t = {} mm: largest relative difference reduced - FEniCSx", millimetres(thickness));
    Claim::new(claim, "1", None, difference, AGREEMENT)
}

/// Asks for more modes until a longitudinal one is among them.
fn first_longitudinal(
    count: usize,
    mut modes: impl FnMut(usize) -> Result<Vec<PlateMode>>,
) -> Result<Frequencies> {
    match Frequencies::of(&modes(count)?) {
        Some(found) => Ok(found),
        None if count < MOST_MODES => first_longitudinal(2 * count, modes),
        None => Err(Error::Solver(format!("none of the {count} lowest modes of the plate is longitudinal"))),
    }
}

/// The plate as a scene: what the finite-element side reads. The bodies that strike do not enter the modes.
fn scene(thickness: f64) -> Scene {
    let plate = plate(thickness);
    let setup = impact(RADIUS, thickness, plate.edge, plate.material.clone(), RADIUS);
    parameter::scene("table2", PlateImpact { plate, ..setup })
}

/// A thickness in mm as the paper prints it.
fn millimetres(thickness: f64) -> f64 {
    (thickness * 1e4).round() / 10.0
}
