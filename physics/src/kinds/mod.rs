//! The kinds of scene, each with its reduced models.

pub mod plate_impact;
pub mod seal_seat;

use crate::result::{Curve, Quantity};
use crate::scene::{Scene, Setup};

/// What everything that compares, shows or keeps results has to know of a kind of scene.
pub trait Kind: Sync {
    /// The quantities of its results, in order, without values.
    fn quantities(&self) -> &'static [Quantity];

    /// The curves of its histories, in order, without samples.
    fn curves(&self) -> &'static [Curve];
}

/// The kind of `scene`.
pub fn of(scene: &Scene) -> &'static dyn Kind {
    match scene.setup {
        Setup::PlateImpact(_) => &plate_impact::Kind,
        Setup::SealSeat(_) => &seal_seat::Kind,
    }
}
