//! Tests of the program as a user calls it.

#[cfg(unix)]
mod action;
mod bad_input;
mod coverage;
mod diff;
#[cfg(unix)]
mod elsewhere;
#[cfg(unix)]
mod external;
mod first_day;
mod guide;
#[cfg(target_os = "linux")]
mod interruption;
mod measured;
mod no_plate;
mod optimise;
mod prediction;
mod program;
mod record_formats;
mod scene_files;
#[path = "../support/sealed.rs"]
mod sealed;
mod second_program;
mod snapshots;
#[path = "../support/store_fixture.rs"]
mod store_fixture;
mod sweep_figures;
mod sweeps;
mod uncertainty;
mod units;
#[path = "../support/waiting.rs"]
mod waiting;
#[cfg(unix)]
mod watch;
