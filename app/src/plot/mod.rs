//! Drawings: axes and their marks, charts, colour maps, rasters, and their files (SVG, PNG, PDF).
//!
//! Nothing here knows what is drawn: values come as numbers with a label. No other room of the program is imported, only
//! the format of numbers and errors.

pub(crate) mod axis;
pub(crate) mod chart;
mod colour_map;
pub mod colours;
pub(crate) mod frame;
pub(crate) mod labels;
pub(crate) mod pdf;
mod pdf_text;
pub(crate) mod png;
pub(crate) mod polyline;
pub(crate) mod raster;
pub(crate) mod svg;
pub(crate) mod symmetric_log;
pub(crate) mod ticks;

pub use chart::{ChartPanel, Series, chart};
pub use colour_map::{ColourMap, colour_maps};
pub use png::png;
pub use svg::{Svg, Theme};
