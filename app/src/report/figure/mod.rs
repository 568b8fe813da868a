//! Drawings of results.

pub(crate) mod budget;
pub(crate) mod convergence;
pub(crate) mod course;
pub(crate) mod curves;
mod efficiency_boxes;
pub(crate) mod geometry;
pub(crate) mod landing_map;
pub(crate) mod lines;
mod panel;
pub(crate) mod propagated;
mod residuals;
pub(crate) mod scene;
pub(crate) mod scene_drawing;
pub(crate) mod sweep;
pub(crate) mod thumbnail;
pub(crate) mod vibration;
