//! `impactcheck study sweep` and `impactcheck study merge`: sweeps of one's own.

use super::progress::Counter;
use super::{Context, JsonArgument};
use crate::error::{Error, ExitStatus, Result};
use crate::file::write_file;
use crate::format::measure;
use crate::report;
use crate::report::{Drawn, FigureFile, figure_format, sweep_figure};
use crate::sweep::{self, Plan, Shard, Table};
use crate::table_format::TableFormat;
use clap::Args;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What a sweep file looks like, for `--help`.
pub const EXAMPLE: &str = r#"A sweep file (TOML):
  scene     = "scaled-plate-r10"     # a file in this folder, or a shipped scene
  model     = "B"                    # A, B, C or several, ["B", "C"]; absent = the scene's, else B; a seal seat has C only
  modes     = 16                     # absent = the scene's, else the model's
  tolerance = 1e-4                   # relative error of efficiency, velocities, force peaks and times; absent = 1e-3
  mesh      = "seat.vtu"             # of a seal seat, in this folder; absent = a coarse one
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

Where one or two parameters vary, over 100 000 points at most, the folder gets sweep.svg: curves
over one parameter, a line per model; a map in colours over two, one per model. It has the
stored references (of shipped scenes and of those in the folder of the swept one) that differ from the
scene in the varied fields alone, with their bands, and where the paper's section 4.1 expects
the optimum. Several models number the points model after model and have a column `model`.

An interrupted sweep goes on where it stopped when it is started again. As the array job of a cluster:
  impactcheck study sweep FILE --out DIR --shard $SLURM_ARRAY_TASK_ID/16
  impactcheck study merge FILE --out DIR
RAYON_NUM_THREADS sets the number of threads. Bodies of model C are scaled from
those of one shape; where plate.radius, plate.thickness or a Poisson's ratio varies, from those of
some shapes, or if the points are few every one meshes its plate (0.1 s, 4 kB in the cache).
The mesh of a seal seat follows its dimensions; points of the same seat share its body."#;

/// Points up to which a sweep is drawn: each is a mark of its own.
const MOST_DRAWN: usize = 100_000;

#[derive(Debug, Args)]
pub struct Arguments {
    /// Sweep file, see below
    file: PathBuf,
    /// Folder of the results [default: the sweep file's name with `-sweep`]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Format of the table: csv or parquet
    #[arg(long, default_value = "csv")]
    format: TableFormat,
    /// Quantities to draw
    #[arg(long = "quantity", value_delimiter = ',', default_value = "efficiency", value_name = "NAME,…")]
    quantities: Vec<String>,
    /// Write the figure to this file (.svg, .pdf or .png)
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgument,
}

#[derive(Debug, Args)]
pub struct SweepArguments {
    #[command(flatten)]
    common: Arguments,
    /// Run part i of n only; `study merge` joins the parts
    #[arg(long, value_name = "i/n", conflicts_with = "figure")]
    shard: Option<Shard>,
}

impl Arguments {
    /// The plan, which can be drawn if a figure is asked for.
    fn plan(&self) -> Result<Plan> {
        let plan = Plan::read(&self.file)?;
        self.drawn(&plan)?;
        if let Some(file) = &self.figure {
            figure_format(file)?;
            if !is_drawn(&plan) {
                return Err(Error::Usage(format!(
                    "--figure {}: {} parameters vary over {} points; one or two can be drawn, over {MOST_DRAWN} points at most",
                    file.display(),
                    plan.parameters().len(),
                    plan.len()
                )));
            }
        }
        Ok(plan)
    }

    /// The quantities that are drawn.
    fn drawn(&self, plan: &Plan) -> Result<Vec<Drawn>> {
        self.quantities.iter().map(|name| Drawn::new(name, plan)).collect()
    }
}

fn is_drawn(plan: &Plan) -> bool {
    (1..=2).contains(&plan.parameters().len()) && plan.len() <= MOST_DRAWN
}

/// Writes the drawing into `dir` and where it is asked for.
fn draw(context: &Context, arguments: &Arguments, plan: &Plan, dir: &Path, table: &Table) -> Result<()> {
    let references = sweep::references(plan, &context.store());
    let svg = sweep_figure(table, &arguments.drawn(plan)?, &references)?;
    let path = dir.join("sweep.svg");
    write_file(&path, svg.as_bytes())?;
    context.note(format_args!("wrote {}", path.display()));
    match &arguments.figure {
        Some(file) => {
            let figure = FigureFile { title: plan.scene().to_owned(), svg };
            write_file(file, &figure_format(file)?.bytes(&figure)?)
        }
        None => Ok(()),
    }
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
    let plan = arguments.common.plan()?;
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
    finish(context, &arguments.common, (&plan, &dir), &table, arguments.shard.is_none())
}

/// Joins the records of all shards.
pub fn merge(context: &Context, arguments: &Arguments) -> Result<ExitStatus> {
    let plan = arguments.plan()?;
    let dir = folder(arguments);
    let table = Table::join(&plan, &dir, Shard::WHOLE)?;
    finish(context, arguments, (&plan, &dir), &table, true)
}

fn finish(
    context: &Context,
    arguments: &Arguments,
    (plan, dir): (&Plan, &Path),
    table: &Table,
    complete: bool,
) -> Result<ExitStatus> {
    if complete {
        context.note(format_args!("wrote {}", table.write(dir, "sweep", arguments.format)?.display()));
        if is_drawn(plan) {
            draw(context, arguments, plan, dir, table)?;
        }
    }
    if arguments.json.json {
        super::print_json(&table.document())?;
        return Ok(ExitStatus::Pass);
    }
    let [done, invalid, failed] = table.counts();
    let mut text = format!("{done} impacts, {invalid} scenes that are not valid, {failed} failures");
    let open = table.unconverged();
    if open > 0 {
        text += &format!(
            "\n{open} impacts did not converge to the tolerance: their column `converged` is 0, and their contacts amplify every error"
        );
    }
    // the most accurate model first
    let mut models = plan.models().to_vec();
    models.sort_by(|a, b| b.cmp(a));
    for model in models {
        let Some((record, efficiency)) = table.best(model) else { continue };
        text += &format!("\nmodel {model}: highest efficiency {efficiency:.4} at point {}", record.index);
        for (name, number, unit) in table.place(record) {
            text += &format!("\n  {name} = {}", measure(number, unit));
        }
    }
    super::print(&text)?;
    Ok(ExitStatus::Pass)
}
