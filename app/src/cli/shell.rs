//! `impactcheck completions` and `impactcheck man`: what shell and manual need to know of the commands.

use super::help;
use crate::error::{Error, ExitStatus, Result};
use crate::file::write_file;
use crate::report;
use clap::Args;
use clap_complete::Shell;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct CompletionArguments {
    /// Shell
    shell: Shell,
}

#[derive(Debug, Args)]
pub struct ManArguments {
    /// Folder for one page per command [default: the main page on standard output]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Prints the completions of a shell.
pub fn completions(arguments: &CompletionArguments) -> Result<ExitStatus> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut help::command(), "impactcheck", &mut script);
    super::print(String::from_utf8_lossy(&script).trim_end())?;
    Ok(ExitStatus::Pass)
}

/// Prints the manual page, or writes all of them.
pub fn man(arguments: &ManArguments) -> Result<ExitStatus> {
    let failed = |e: std::io::Error| Error::Internal(format!("making the manual pages: {e}"));
    let Some(folder) = &arguments.out else {
        let mut page = Vec::new();
        clap_mangen::Man::new(help::command()).render(&mut page).map_err(failed)?;
        super::print(String::from_utf8_lossy(&page).trim_end())?;
        return Ok(ExitStatus::Pass);
    };
    report::check_writable(folder)?;
    let made = tempfile::tempdir().map_err(failed)?;
    clap_mangen::generate_to(help::command(), made.path()).map_err(failed)?;
    for page in std::fs::read_dir(made.path()).map_err(failed)? {
        let page = page.map_err(failed)?;
        write_file(&folder.join(page.file_name()), &std::fs::read(page.path()).map_err(failed)?)?;
    }
    Ok(ExitStatus::Pass)
}
