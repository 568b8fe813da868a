//! The program: parse, call, exit status.

fn main() -> std::process::ExitCode {
    std::process::ExitCode::from(impactcheck::cli::run(std::env::args_os()) as u8)
}
