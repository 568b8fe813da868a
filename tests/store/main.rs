//! Tests of what is read: scenes, stored solutions, and random input to both.

mod import;
mod random_input;
mod scene_actuators;
mod scene_materials;
mod scene_reading;
mod scene_schema;
mod store_lookup;
mod store_solve;

#[path = "../support/sealed.rs"]
mod sealed;
#[path = "../support/store_fixture.rs"]
mod store_fixture;
#[path = "../support/waiting.rs"]
mod waiting;
