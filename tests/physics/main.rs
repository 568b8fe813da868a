//! Tests of bodies, contacts, fluids and impacts against closed forms, other discretisations and the paper.

mod auto_model;
mod bench_structure;
mod bender;
mod bounded_runs;
mod continuum_cache;
mod continuum_impact;
mod continuum_plate_flexibility;
mod continuum_plate_frequencies;
mod continuum_sphere;
mod even_steps;
mod friction;
mod friction_off_centre;
mod general_impact;
mod hertz_goldsmith;
mod integrator_runge_kutta;
mod materials_memory;
mod materials_yielding;
mod plate_frequencies_leissa;
mod plate_waves;
mod shared_bodies;
mod squeeze_film;
mod stack;
mod studies_paper;
mod sweep_accuracy;
mod table1_paper;
mod table2_paper;
mod truncation;
mod wet_impact;
mod zener_infinite_plate;

#[path = "../support/common.rs"]
mod common;
#[path = "../support/continuum_support.rs"]
mod continuum_support;
#[path = "../support/runge_kutta.rs"]
mod runge_kutta;
