//! Tests of the program as a user calls it.

mod bad_input;
mod guide;
mod scene_files;
mod snapshots;
mod studies;
