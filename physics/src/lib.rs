//! The physics of impactcheck: scenes, bodies, contacts, fluid, their motion and its results.
//!
//! Data flows one way: [`scene`] -> [`body`], [`contact`], [`fluid`] -> [`dynamics`] -> [`result`]; [`kinds`] puts them
//! together for every kind of scene. Nothing here knows of reports, the command line or other processes.
//!
//! # Cookbook
//!
//! Run a reduced model of a scene file. All quantities are in SI units:
//!
//! ```
//! use impactcheck_physics::kinds::plate_impact::reduced::Reduced;
//! use impactcheck_physics::scene::{Model, Scene};
//!
//! let scene = Scene::read("../scenes/scaled-plate-r10.toml")?;
//! let summary = Reduced::new(&scene, Model::C, None)?.run(1e-7)?;
//! println!("efficiency {:?}", summary.value("efficiency"));
//! println!("modal truncation error about {:?}", summary.truncation_error);
//! for warning in &summary.warnings {
//!     eprintln!("warning: {warning}");
//! }
//! # Ok::<(), impactcheck_physics::Error>(())
//! ```
//!
//! Vary a number. The file is read once, and each value is checked against the bounds of its key:
//!
//! ```
//! use impactcheck_physics::kinds::plate_impact::reduced::Reduced;
//! use impactcheck_physics::scene::{Model, Template};
//!
//! let template = Template::read("../scenes/scaled-plate-r10.toml")?;
//! let thickness = template.field("plate.thickness")?;
//! for value in [1.5e-3, 2.0e-3, 2.5e-3] {
//!     let scene = template.with(&[(&thickness, value)]).expect("within the bounds");
//!     let efficiency = Reduced::new(&scene, Model::B, Some(16))?.point(1e-6)?.quantities.efficiency;
//!     println!("{value} m: {efficiency:.4}");
//! }
//! # Ok::<(), impactcheck_physics::Error>(())
//! ```
//!
//! Use an elastic body of your own: its modes at the two contact points, from any finite-element program. Here a free rigid block of
//! 10 g lies between the bodies of a scene, so momentum is conserved:
//!
//! ```
//! use impactcheck_physics::body::ModalBody;
//! use impactcheck_physics::dynamics::integration::Options;
//! use impactcheck_physics::dynamics::system::System;
//! use impactcheck_physics::dynamics::{MovingBody, integrate};
//! use impactcheck_physics::scene::Scene;
//!
//! let scene = Scene::read("../scenes/scaled-plate-r10.toml")?;
//! let setup = scene.plate_impact()?;
//! let bodies = MovingBody::both(&setup.outer, &setup.inner)?;
//! let block_mass = 0.01_f64;
//! let shape = block_mass.sqrt().recip();
//! let block = ModalBody {
//!     omega: vec![0.0],
//!     damping_ratio: vec![0.0],
//!     participation: vec![[shape, shape]],
//!     residual: None,
//! };
//! let system = System::of(&bodies, &block, &setup.plate.material, [0.0, 0.0]);
//! let result = integrate(&system, None, &Options::default())?;
//! assert!(result.momentum_residual < 1e-10);
//! println!("velocities {:?} m/s", result.velocity);
//! # Ok::<(), impactcheck_physics::Error>(())
//! ```
#![warn(missing_docs)]

pub mod actuator;
pub mod analytical;
pub mod body;
pub mod contact;
pub mod dynamics;
pub mod error;
pub mod file;
pub mod flight;
pub mod fluid;
pub mod kinds;
pub mod material;
pub mod numerics;
pub mod result;
pub mod scene;

pub use error::{Error, ExitStatus, Result};
