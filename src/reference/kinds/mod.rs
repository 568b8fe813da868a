//! What `fem_reference` makes of some kinds of scene besides solutions: modes of plates, meshes of seats.

mod plate_impact;
mod seal_seat;

pub use plate_impact::plate_modes;
pub use seal_seat::{SeatMeshInfo, make_seat_mesh, mesh_to_follow, seat_mesh, seat_mesh_with, seat_meshes};
