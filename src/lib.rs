//! impactcheck: how far can a fast reduced model of an impact be trusted?
//!
//! Data flows one way: [`scene`] -> [`body`] -> [`impact`] -> [`comparison`] -> [`report`].
//!
//! ```
//! use impactcheck::comparison::compare_scene;
//! use impactcheck::impact::reduced::Reduced;
//! use impactcheck::reference::{Lookup, Resolution, Store};
//! use impactcheck::scene::{Model, Scene, resolve};
//!
//! let scene = Scene::read(resolve("scaled-plate-r6.35")?)?;
//! let reduced = Reduced::new(&scene, Model::B, Some(16))?.run_with_history(1e-7)?;
//! println!("efficiency {:.4}", reduced.summary.quantities.efficiency);
//!
//! // the stored finite-element solution of exactly this scene
//! let Lookup::Found(stored) = Store::open(None).find(&scene, Resolution::Paper) else { panic!("not stored") };
//! let comparison = compare_scene(&scene, &stored.outcome, &[reduced]);
//! let row = comparison.models[0].largest().expect("a row");
//! println!("{} is {:.1} % off", row.quantity, 100.0 * row.relative.unwrap_or(f64::NAN));
//! # Ok::<(), impactcheck::Error>(())
//! ```
#![warn(missing_docs)]

pub mod analytical;
pub mod bench;
pub mod body;
pub mod ci;
pub mod cli;
pub mod comparison;
pub mod contact;
pub mod error;
pub mod fluid;
pub mod impact;
pub mod measured;
pub mod optimise;
pub mod project;
pub mod reference;
pub mod report;
pub mod sampling;
pub mod scene;
pub mod stress;
pub mod study;

pub use error::{Error, ExitStatus, Result};
