//! The program: parse, call, exit status.

use impactcheck::{cli, fmu, project, reference};

static FILES: project::Embedded = impactcheck_embedded::files!();
static UNIT: &[u8] = impactcheck_embedded::unit!();

fn main() -> std::process::ExitCode {
    project::embed(FILES);
    fmu::embed(UNIT);
    reference::mesh_bodies();
    std::process::ExitCode::from(cli::main(std::env::args_os()))
}
