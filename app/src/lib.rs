//! impactcheck: how far can a fast reduced model of an impact be trusted?
//!
//! The physics (scenes, bodies, contacts, their motion and its results) is a crate of its own, `impactcheck-physics`,
//! shown here as [`scene`], [`body`], [`contact`], [`fluid`], [`dynamics`], [`result`] and [`kinds`]; the program
//! compares what comes out with a [`reference`](mod@reference) and reports it: [`comparison`] -> [`report`].
//!
//! # Cookbook
//!
//! Compare a model with the stored finite-element solution of the same scene. Models of your own, sweeps over a number: see the cookbook
//! of `impactcheck-physics`.
//!
//! ```
//! use impactcheck::comparison::compare_scene;
//! use impactcheck::kinds::plate_impact::reduced::Reduced;
//! use impactcheck::reference::{Lookup, Resolution, Store};
//! use impactcheck::scene::{Model, Scene, resolve};
//!
//! let scene = Scene::read(resolve("scaled-plate-r6.35")?)?;
//! let reduced = Reduced::new(&scene, Model::B, Some(16))?.run_with_history(1e-7)?;
//! println!("efficiency {:.4}", reduced.summary.value("efficiency").unwrap_or(f64::NAN));
//!
//! // the stored finite-element solution of exactly this scene
//! let Lookup::Found(stored) = Store::open(None).find(&scene, Resolution::Paper) else { panic!("not stored") };
//! let comparison = compare_scene(&scene, &stored.outcome, &[reduced]);
//! let row = comparison.models[0].largest().expect("a row");
//! println!("{} is {:.1} % off", row.quantity, 100.0 * row.relative.unwrap_or(f64::NAN));
//! # Ok::<(), impactcheck::Error>(())
//! ```
//!
//! Propagate uncertain inputs through a model:
//!
//! ```
//! use impactcheck::scene::{Model, Template};
//! use impactcheck::uncertainty::{Request, Samples, study};
//! use std::path::Path;
//!
//! let file = Path::new("../examples/uncertainty/table1-r10.toml");
//! let template = Template::read(file)?;
//! let request = Request { samples: Samples::Rows(64), ..Request::new(Model::B, 0.05) };
//! let result = study((file, &template), &request, None, &|_| ())?;
//! println!("efficiency {:?}", result.quantities["efficiency"]);
//! # Ok::<(), impactcheck::Error>(())
//! ```
#![warn(missing_docs)]
// `cli::tell` survives a reader that has gone away
#![warn(clippy::print_stderr)]

pub mod calibration;
pub mod ci;
pub mod cli;
pub mod columns;
pub mod comparison;
pub mod coverage;
pub mod curves;
pub mod evidence;
pub mod external;
pub mod fmu;
mod format;
pub mod interrupt;
pub mod kinds;
pub mod measured;
pub mod optimise;
pub mod plot;
mod process_output;
pub mod project;
pub mod reference;
pub mod report;
pub mod sampling;
pub mod scene;
pub mod sweep;
pub mod table_format;
pub mod uncertainty;
pub mod validated;

pub use impactcheck_physics::{Error, ExitStatus, Result};
pub use impactcheck_physics::{
    actuator, analytical, body, contact, dynamics, error, file, flight, fluid, material, numerics, result,
};
pub use impactcheck_prediction as prediction;
