//! The program: parse, call, exit status.

use impactcheck::{cli, interrupt, project};

static FILES: project::Embedded = impactcheck_embedded::files!();

fn main() -> std::process::ExitCode {
    project::embed(FILES);
    if let Err(error) = interrupt::listen() {
        eprintln!("warning: Ctrl-C may leave files behind: {error}");
    }
    std::process::ExitCode::from(cli::run(std::env::args_os()) as u8)
}
