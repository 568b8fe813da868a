//! The program: parse, call, exit status.

use impactcheck::{cli, project, reference};

static FILES: project::Embedded = impactcheck_embedded::files!();

fn main() -> std::process::ExitCode {
    project::embed(FILES);
    reference::mesh_bodies();
    std::process::ExitCode::from(cli::main(std::env::args_os()))
}
