//! The command line: one file per command, no physics.

mod bench;
mod calibrate;
mod compare;
mod compare_arguments;
mod compare_inputs;
mod comparison_job;
mod coverage;
mod diff;
mod doctor;
mod external;
mod fmu;
mod gate;
mod help;
pub mod in_process;
mod kinds;
mod live;
mod mesh;
mod new;
mod optimise;
mod predicted;
mod progress;
mod propagated;
mod record_map;
mod reduced;
mod reference;
mod requested_model;
mod schema;
mod second_program;
mod shell;
mod stored_references;
mod stress;
mod study;
mod sweep;
mod uncertainty;
mod validated_scenes;
mod watch;

use crate::error::{Error, ExitStatus, Result};
use crate::scene::{self, Scene};
use clap::{Args, Parser, Subcommand};
use serde::Serialize;
use std::ffi::OsString;
use std::path::PathBuf;

/// How far can a fast reduced model of an impact be trusted?
#[derive(Debug, Parser)]
#[command(name = "impactcheck", version, about, after_help = AFTER_HELP, max_term_width = 110)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Folder of the stored references [default: $IMPACTCHECK_STORE, or the user's data folder]
    #[arg(long, global = true, value_name = "DIR")]
    store: Option<PathBuf>,
    /// Print only results and errors
    #[arg(long, short, global = true)]
    quiet: bool,
    /// Print also what was reused or computed, with times
    #[arg(long, short, global = true, conflicts_with = "quiet")]
    verbose: bool,
}

const AFTER_HELP: &str = "Every command has these options; `impactcheck COMMAND --help` shows its own.\n\nExit status: 0 pass, 1 internal error, 2 usage, 3 invalid scene, \
10 a tolerance is exceeded (or undecided with --undecided fail), 11 reference missing, stale or damaged, 12 a solver failed.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a reduced model
    #[command(
        after_help = "Examples: impactcheck reduced scaled-plate-r10 --model B --modes 16\n          impactcheck reduced scaled-plate-r10 --model auto --tolerance 1%"
    )]
    Reduced(reduced::Arguments),
    /// Find or compute the finite-element reference
    #[command(after_help = "Example: impactcheck reference scaled-plate-r10 --resolution coarse")]
    Reference(reference::Arguments),
    /// Compare reduced models with the reference, write the report
    #[command(
        after_help = "Examples: impactcheck compare scaled-plate-r10 --models A,B --out my-report\n          impactcheck compare my-impact.toml --watch"
    )]
    Compare(compare::OwnArguments),
    /// Compare, and fail if a tolerance is exceeded (for CI)
    #[command(after_help = "Example: impactcheck gate --junit gate.xml")]
    Gate(gate::Arguments),
    /// List the features that have been compared, and how models differ
    #[command(after_help = "Example: impactcheck coverage --json")]
    Coverage(coverage::Arguments),
    /// List what changed between two comparisons
    #[command(after_help = "Example: impactcheck diff old-report new-report --above 0.1%")]
    Diff(diff::Arguments),
    /// Mesh the seat of a seal-seat scene, or the body of an impact
    #[command(after_help = "Example: impactcheck mesh my-seat.toml --out my-seat.vtu")]
    Mesh(mesh::Arguments),
    /// Run a parameter study of the paper, or your own sweep
    #[command(after_help = study::after_help())]
    Study(study::Arguments),
    /// Propagate input uncertainty through a reduced model
    #[command(
        after_help = "Example: impactcheck uncertainty examples/uncertainty/table1-r10.toml --out my-scatter"
    )]
    Uncertainty(uncertainty::Arguments),
    /// Identify scene parameters from measured histories
    #[command(
        after_help = "Example: impactcheck calibrate my-impact.toml --over plate.thickness --measured run1.csv,run2.csv"
    )]
    Calibrate(calibrate::Arguments),
    /// Find the design parameters that transmit most energy
    #[command(
        after_help = "Example: impactcheck optimise scaled-plate-r10 --over plate.radius=15mm..60mm --over plate.thickness=1mm..3mm"
    )]
    Optimise(optimise::Arguments),
    /// Measure run time against error
    #[command(after_help = "Example: impactcheck bench --modes 16 --out my-bench")]
    Bench(bench::Arguments),
    /// Test the time integration on random scenes
    #[command(after_help = "Example: impactcheck stress --cases 1000 --seed 1")]
    Stress(stress::Arguments),
    /// Write a scene as an FMU, a unit of a system simulation
    #[command(
        after_help = "Examples: impactcheck fmu scaled-plate-r10 -o plate.fmu\n          impactcheck fmu my-valve.toml --fmi 2 -o valve.fmu"
    )]
    Fmu(fmu::Arguments),
    /// Write a page in which the models answer while you change numbers
    #[command(
        after_help = "Examples: impactcheck live scaled-plate-r10 -o plate.html\n          impactcheck live my-impact.toml"
    )]
    Live(live::Arguments),
    /// Show what is installed and how to install what is missing
    #[command(after_help = "Example: impactcheck doctor")]
    Doctor(JsonArgument),
    /// Print the JSON schema of scene files, for editors
    #[command(after_help = "Example: impactcheck schema > impactcheck.schema.json")]
    Schema,
    /// Write a valid scene file to start from
    ///
    /// Writes impactcheck.schema.json too. Editors with a TOML language server (Taplo, Even Better TOML) use it to
    /// complete and check the file.
    #[command(after_help = "Example: impactcheck new my-impact && impactcheck reduced my-impact.toml")]
    New(new::Arguments),
    /// Print shell completions
    #[command(
        after_help = "Example: impactcheck completions bash > ~/.local/share/bash-completion/completions/impactcheck"
    )]
    Completions(shell::CompletionArguments),
    /// Print the manual page, or write one per command
    #[command(after_help = "Example: impactcheck man --out ~/.local/share/man/man1")]
    Man(shell::ManArguments),
}

/// The switch every command has that prints results.
#[derive(Debug, Clone, Copy, Args)]
struct JsonArgument {
    /// Print one JSON document and nothing else on standard output
    #[arg(long)]
    json: bool,
}

impl JsonArgument {
    /// Prints `document` as JSON if that is asked for, else what `table` says of it.
    fn print<D: Serialize>(self, document: &D, table: impl FnOnce(&D) -> String) -> Result<()> {
        if self.json { print_json(document) } else { print(&table(document)) }
    }
}

/// Options that all commands have.
#[derive(Debug, Clone)]
struct Context {
    store: Option<PathBuf>,
    quiet: bool,
    verbose: bool,
}

impl Context {
    fn store(&self) -> crate::reference::Store {
        crate::reference::Store::open(self.store.as_deref())
    }

    /// A line for people, on standard error.
    fn note(&self, text: impl std::fmt::Display) {
        if !self.quiet {
            notify(text);
        }
    }

    /// A line for people who want to know everything, on standard error.
    fn detail(&self, text: impl std::fmt::Display) {
        if self.verbose {
            notify(text);
        }
    }
}

/// The program: listens to Ctrl-C, runs with `arguments` (the first is its name) and gives the exit status.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    if let Err(error) = crate::interrupt::listen() {
        notify(format_args!("warning: Ctrl-C may leave files behind: {error}"));
    }
    run(arguments) as u8
}

/// Runs the program with `arguments` (the first is its name) and gives the exit status.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitStatus {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        Err(error) => {
            let error = with_help(error, &arguments);
            let status = if error.use_stderr() { ExitStatus::Usage } else { ExitStatus::Pass };
            // a closed pipe is no reason to fail
            let _ = error.print();
            return status;
        }
    };
    let context = Context { store: cli.store, quiet: cli.quiet, verbose: cli.verbose };
    let own = context.clone();
    crate::kinds::announce_set_ups(move |line| own.note(line));
    let result = match cli.command {
        Command::Reduced(arguments) => reduced::run(&context, &arguments),
        Command::Reference(arguments) => reference::run(&context, &arguments),
        Command::Compare(arguments) => compare::run(&context, arguments),
        Command::Coverage(arguments) => coverage::run(&context, &arguments),
        Command::Mesh(arguments) => mesh::run(&context, &arguments),
        Command::Gate(mut arguments) => {
            arguments.compare = arguments.compare.with_tables_measured();
            gate::run(&context, &arguments)
        }
        Command::Study(arguments) => study::run(&context, &arguments),
        Command::Uncertainty(arguments) => uncertainty::run(&context, &arguments),
        Command::Calibrate(arguments) => calibrate::run(&context, &arguments),
        Command::Optimise(arguments) => optimise::run(&context, &arguments),
        Command::Bench(arguments) => bench::run(&context, &arguments),
        Command::Diff(arguments) => diff::run(&arguments),
        Command::Stress(arguments) => stress::run(&context, &arguments),
        Command::Fmu(arguments) => fmu::run(&context, &arguments),
        Command::Live(arguments) => live::run(&context, &arguments),
        Command::Doctor(arguments) => doctor::run(&context, arguments),
        Command::Schema => schema::run(),
        Command::New(arguments) => new::run(&context, &arguments),
        Command::Completions(arguments) => shell::completions(&arguments),
        Command::Man(arguments) => shell::man(&arguments),
    };
    result.unwrap_or_else(|error| {
        notify(describe(&error));
        error.exit_status()
    })
}

/// `error` of the command line `arguments`; a request for help with the help as it is shown, which is costly to lay out.
fn with_help(error: clap::Error, arguments: &[OsString]) -> clap::Error {
    use clap::error::ErrorKind::{DisplayHelp, DisplayHelpOnMissingArgumentOrSubcommand};
    match error.kind() {
        DisplayHelp | DisplayHelpOnMissingArgumentOrSubcommand => {
            help::command().try_get_matches_from(arguments).err().unwrap_or(error)
        }
        _ => error,
    }
}

/// `file`, if a page can be written to it.
///
/// # Errors
/// [`Error::Usage`] if it does not end in `.html`.
fn html_file<'f>(option: &str, file: &'f std::path::Path) -> Result<&'f std::path::Path> {
    match file.extension().is_some_and(|kind| kind == "html") {
        true => Ok(file),
        false => {
            Err(Error::Usage(format!("{option} {}: a page is a file that ends in .html", file.display())))
        }
    }
}

/// The scene that `argument` names, and its file; `-` is standard input, which can be read only once.
fn read_scene(argument: &str) -> Result<(PathBuf, Scene)> {
    if argument == "-" {
        return Ok((
            PathBuf::from(argument),
            Scene::read_from("standard input", &mut std::io::stdin().lock())?,
        ));
    }
    let file = scene::resolve(argument)?;
    Scene::read(&file).map(|scene| (file, scene))
}

/// The error as a person reads it, with its hints; scene errors come with the place in the file.
fn describe(error: &Error) -> String {
    let text = match error {
        Error::Scene(report) => format!("{report:?}"),
        other => format!("error: {other}"),
    };
    error.hints().iter().fold(text, |text, hint| format!("{text}\nhint: {hint}"))
}

/// A line on standard error, its colours only where they can be seen; a reader that has gone away is no error.
fn notify(text: impl std::fmt::Display) {
    use std::io::Write;
    let _ = writeln!(anstream::stderr(), "{text}");
}

/// Prints `document` as JSON on standard output.
fn print_json(document: &impl Serialize) -> Result<()> {
    let text =
        serde_json::to_string_pretty(document).map_err(|e| Error::Internal(format!("writing JSON: {e}")))?;
    print(&text)
}

/// Prints a line on standard output, its colours only where they can be seen and are wanted (`NO_COLOR`); a reader that
/// has gone away is no error.
fn print(text: &str) -> Result<()> {
    use std::io::{ErrorKind, Write};
    match writeln!(anstream::stdout(), "{text}") {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::io("writing to", "standard output", e)),
        _ => Ok(()),
    }
}
