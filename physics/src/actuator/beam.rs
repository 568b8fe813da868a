//! Piezo bender: Euler-Bernoulli beam finite elements, clamped at one end, with a point mass at the tip.
//!
//! Hermite cubics with consistent mass. A uniform bending moment (the piezo layer's) is a moment at the tip; its
//! deflection M x^2/(2 E I) is among the cubics, so that the statics are exact on any mesh.

use super::Bender;
use crate::error::{Error, Result};
use crate::numerics::eigenmodes;
use crate::numerics::root::first_fall;
use faer::Mat;

/// Modes of the beam that take part in an impact.
pub const MODES: usize = 16;
/// Elements per mode that is asked for: the highest frequency is then within 2 %, the others much closer.
const ELEMENTS_PER_MODE: usize = 2;

/// Time in radians of the first mode, and in time constants of the discharge, after which a tip that has not struck never will.
const SWINGS: f64 = 20.0;
const DECAYS: f64 = 20.0;

/// Modes of the beam with its tip mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Beam {
    /// Eigenfrequencies in rad/s, ascending. Shape (n).
    pub omega: Vec<f64>,
    /// Deflection of the tip along +z in each mass-normalised mode, kg^(-1/2). Shape (n).
    pub tip: Vec<f64>,
    /// Slope of the tip in each mode, kg^(-1/2)/m. Shape (n).
    pub slope: Vec<f64>,
}

impl Beam {
    /// The lowest `modes` modes of `bender`.
    ///
    /// # Errors
    /// [`crate::Error::Internal`] if the eigenproblem does not converge.
    pub fn new(bender: &Bender, modes: usize) -> Result<Self> {
        // in units of L, E I and rho A
        let (stiffness, mass) =
            assemble(ELEMENTS_PER_MODE * modes, bender.tip_mass / (bender.line_mass * bender.length));
        let (squares, shapes) = eigenmodes::lowest(&stiffness, &mass, 0.0, modes, "beam modes")?;
        let size = stiffness.nrows();
        let frequency = (bender.bending_stiffness / bender.line_mass).sqrt() / bender.length.powi(2);
        let amplitude = 1.0 / (bender.line_mass * bender.length).sqrt();
        let end = |k: usize, row: usize| {
            // deflection of the tip positive in every mode
            shapes[(row, k)] * shapes[(size - 2, k)].signum() * amplitude
        };
        Ok(Self {
            omega: squares.iter().map(|square| square.sqrt() * frequency).collect(),
            tip: (0..modes).map(|k| end(k, size - 2)).collect(),
            slope: (0..modes).map(|k| end(k, size - 1) / bender.length).collect(),
        })
    }

    /// Amplitudes of the modes under a uniform bending moment of 1 N m. Shape (n).
    pub fn bent(&self) -> Vec<f64> {
        self.omega.iter().zip(&self.slope).map(|(omega, slope)| slope / (omega * omega)).collect()
    }

    /// Amplitudes and rates of the modes at `time` > 0 s after the release from the amplitudes `bent`, when the moment
    /// decays with the time constant `decay` s: q'' + omega^2 q = omega^2 q_0 e^(-t/decay). Shapes (n).
    fn swing(&self, bent: &[f64], decay: f64, time: f64) -> (Vec<f64>, Vec<f64>) {
        let rest = (-time / decay).exp();
        let motion = |(omega, start): (&f64, &f64)| {
            let x = omega * decay;
            let share = start / (1.0 + x * x);
            let (sine, cosine) = (omega * time).sin_cos();
            (share * (cosine + x * sine + x * x * rest), share * omega * (x * cosine - sine - x * rest))
        };
        self.omega.iter().zip(bent).map(motion).unzip()
    }
}

/// Release from a uniform bending moment, and the strike: the tip's first passage of its straight position, or of one beside it. Per
/// 1 N m of moment; everything is proportional to it, and energies to its square.
#[derive(Debug, Clone, PartialEq)]
pub struct Release {
    /// Modes of the beam.
    pub beam: Beam,
    /// Time from the release to the strike in s.
    pub time: f64,
    /// Speed of the tip towards the plate at the strike, (m/s)/(N m).
    pub speed_per_moment: f64,
    /// Amplitudes of the modes at the strike, per N m. Shape (n).
    pub displacement: Vec<f64>,
    /// Their rates at the strike, per N m. Shape (n).
    pub velocity: Vec<f64>,
}

impl Release {
    /// Releases `bender`.
    ///
    /// # Errors
    /// As [`Beam::new`], [`Error::Solver`] if the tip does not come to where it is to strike.
    pub fn new(bender: &Bender) -> Result<Self> {
        Self::with_modes(bender, MODES)
    }

    /// As [`Release::new`], with the lowest `modes` modes of the beam.
    ///
    /// # Errors
    /// As [`Release::new`].
    pub fn with_modes(bender: &Bender, modes: usize) -> Result<Self> {
        let beam = Beam::new(bender, modes)?;
        let bent = beam.bent();
        let swing = |time| beam.swing(&bent, bender.discharge_time, time);
        let tip = |values: &[f64]| beam.tip.iter().zip(values).map(|(tip, value)| tip * value).sum::<f64>();
        // |u''| of the tip is bounded, as |q''| = omega^2 |q_0 e^(-t/decay) - q| <= 3 omega^2 |q_0|
        let bound: f64 =
            (0..modes).map(|k| 3.0 * (beam.tip[k] * bent[k]).abs() * beam.omega[k].powi(2)).sum();
        let (start, offset) = (tip(&bent), bender.strike_at * tip(&bent));
        let patience = SWINGS / beam.omega[0] + DECAYS * bender.discharge_time;
        let motion = |time: f64| {
            let (q, v) = swing(time);
            [tip(&q) - offset, tip(&v)]
        };
        let from = (2.0 * (start - offset) / bound).sqrt();
        let time = first_fall(motion, [from, patience], bound, 1e-14 * start).ok_or_else(|| {
            Error::Solver(format!(
                "the bender's tip does not swing as far as {} of its deflection before the release",
                bender.strike_at
            ))
        })?;
        let (displacement, velocity) = swing(time);
        let speed_per_moment = -tip(&velocity);
        Ok(Self { time, speed_per_moment, displacement, velocity, beam })
    }
}

/// Stiffness and mass of a beam of unit length, bending stiffness and mass on `elements` equal elements, clamped at 0,
/// with the point mass `tip_mass` at 1. The last two unknowns are deflection and slope of the tip.
fn assemble(elements: usize, tip_mass: f64) -> (Mat<f64>, Mat<f64>) {
    let h = 1.0 / elements as f64;
    let k = [
        [12.0, 6.0 * h, -12.0, 6.0 * h],
        [6.0 * h, 4.0 * h * h, -6.0 * h, 2.0 * h * h],
        [-12.0, -6.0 * h, 12.0, -6.0 * h],
        [6.0 * h, 2.0 * h * h, -6.0 * h, 4.0 * h * h],
    ];
    let m = [
        [156.0, 22.0 * h, 54.0, -13.0 * h],
        [22.0 * h, 4.0 * h * h, 13.0 * h, -3.0 * h * h],
        [54.0, 13.0 * h, 156.0, -22.0 * h],
        [-13.0 * h, -3.0 * h * h, -22.0 * h, 4.0 * h * h],
    ];
    let size = 2 * elements;
    let mut stiffness = Mat::<f64>::zeros(size, size);
    let mut mass = Mat::<f64>::zeros(size, size);
    for element in 0..elements {
        for i in 0..4 {
            for j in 0..4 {
                // the clamped node has no unknowns
                let (row, column) = (2 * element + i, 2 * element + j);
                if row >= 2 && column >= 2 {
                    stiffness[(row - 2, column - 2)] += k[i][j] / h.powi(3);
                    mass[(row - 2, column - 2)] += m[i][j] * h / 420.0;
                }
            }
        }
    }
    mass[(size - 2, size - 2)] += tip_mass;
    (stiffness, mass)
}
