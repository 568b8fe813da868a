//! The program: parse, call, exit status.

use impactcheck::{cli, fmu, project, reference, report};

static FILES: project::Embedded = impactcheck_embedded::files!();
static UNIT: &[u8] = impactcheck_embedded::unit!();
static LIVE: &[u8] = impactcheck_embedded::live!();

fn main() -> std::process::ExitCode {
    project::embed(FILES);
    fmu::embed(UNIT);
    report::embed_live(LIVE);
    reference::mesh_bodies();
    std::process::ExitCode::from(cli::main(std::env::args_os()))
}
