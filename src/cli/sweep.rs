//! `impactcheck study sweep` and `impactcheck study merge`: sweeps of one's own.

use super::progress::Counter;
use super::{Context, JsonArgument};
use crate::error::{ExitStatus, Result};
use crate::report;
use crate::report::TableFormat;
use crate::study::sweep::{self, Plan, Shard, Table};
use clap::Args;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What a sweep file looks like, for `--help`.
pub const EXAMPLE: &str = r#"A sweep file (TOML):
  scene     = "scaled-plate-r10"     # a file beside this one, or a shipped scene
  model     = "B"                    # A, B or C; absent = the scene's, else B
  modes     = 16                     # absent = the scene's, else the model's
  tolerance = 1e-4                   # relative error of the efficiency; absent = 1e-4
  sampling  = "grid"                 # or "latin-hypercube", with samples = 10000 and seed = 1

  [[vary]]
  fields = ["outer.radius", "inner.radius"]   # take the same value; or field = "..."
  from   = "5 mm"
  to     = "12 mm"
  count  = 50                        # of a grid
  scale  = "linear"                  # or "log"

  [[vary]]
  field  = "materials.steel.youngs_modulus"
  values = ["100 GPa", "210 GPa"]

An interrupted sweep goes on where it stopped when it is started again. As the array job of a cluster:
  impactcheck study sweep FILE --out DIR --shard $SLURM_ARRAY_TASK_ID/16
  impactcheck study merge FILE --out DIR
RAYON_NUM_THREADS sets the number of threads. With model C every point meshes its plate (some 0.1 s) and leaves 4 kB in
the cache; IMPACTCHECK_CACHE= (empty) keeps them out."#;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Sweep file, see below
    file: PathBuf,
    /// Folder of the records and of the table [default: the file's name without .toml, in this folder, with `-sweep`]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Format of the table: csv or parquet
    #[arg(long, default_value = "csv")]
    format: TableFormat,
    #[command(flatten)]
    json: JsonArgument,
}

#[derive(Debug, Args)]
pub struct SweepArguments {
    #[command(flatten)]
    common: Arguments,
    /// Run only part i of n; `study merge` joins the parts
    #[arg(long, value_name = "i/n")]
    shard: Option<Shard>,
}

fn folder(arguments: &Arguments) -> PathBuf {
    arguments.out.clone().unwrap_or_else(|| {
        let stem = arguments.file.file_stem().unwrap_or_default().to_string_lossy();
        PathBuf::from(format!("{stem}-sweep"))
    })
}

/// Runs what has no record yet, and writes the table when nothing is missing.
pub fn run(context: &Context, arguments: &SweepArguments) -> Result<ExitStatus> {
    let start = Instant::now();
    let plan = Plan::read(&arguments.common.file)?;
    let dir = folder(&arguments.common);
    report::check_writable(&dir)?;
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let counter = Counter::new(context, plan.scene());
    sweep::run(&plan, &dir, shard, &|progress| counter.show(progress))?;
    let (points, fresh) = counter.finish();
    let seconds = start.elapsed().as_secs_f64();
    let rate = fresh as f64 / seconds;
    context.note(format_args!(
        "{points} points, {fresh} of them run now, in {seconds:.2} s ({rate:.0} per second)"
    ));
    let table = Table::join(&plan, &dir, shard)?;
    finish(context, &arguments.common, &dir, &table, arguments.shard.is_none())
}

/// Joins the records of all shards.
pub fn merge(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let plan = Plan::read(&arguments.file)?;
    let dir = folder(arguments);
    let table = Table::join(&plan, &dir, Shard::WHOLE)?;
    finish(context, arguments, &dir, &table, true)
}

fn finish(
    context: &Context,
    arguments: &Arguments,
    dir: &Path,
    table: &Table,
    complete: bool,
) -> Result<ExitStatus> {
    if complete {
        context.note(format_args!("wrote {}", table.write(dir, arguments.format)?.display()));
    }
    if arguments.json.json {
        super::print_json(&table.document())?;
        return Ok(ExitStatus::Pass);
    }
    let [done, invalid, failed] = table.counts();
    let mut text = format!("{done} impacts, {invalid} scenes that are not valid, {failed} failures");
    if let Some((record, efficiency)) = table.best() {
        text += &format!("\nhighest efficiency {efficiency:.4} at point {}", record.index);
        for (name, number, unit) in table.place(record) {
            text += &format!("\n  {name} = {number:.6e}{}{unit}", if unit.is_empty() { "" } else { " " });
        }
    }
    super::print(&text)?;
    Ok(ExitStatus::Pass)
}
