//! Pages.

pub(crate) mod coverage;
mod discrepancy_picture;
mod facts;
mod first_screen;
pub(crate) mod html;
pub(crate) mod index;
mod interactive;
pub(crate) mod live;
pub(super) mod measured;
pub(crate) mod model;
pub(crate) mod moves;
pub(super) mod page_data;
mod prose;
pub(crate) mod scene;
pub(crate) mod section;
pub(crate) mod unit;
pub(crate) mod validated_map;
