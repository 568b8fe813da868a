//! A study: impacts until mean and scatter of the requested quantities are known well enough.

use super::design::{MOST_INPUTS, MOST_ROWS, REPLICATES};
use super::draw::Inputs;
use super::estimate::{Row, mean, standard_deviation};
use super::propagated::{PropagatedUncertainty, SampledImpacts};
use super::request::{Request, Samples};
use crate::error::{Error, Result};
use crate::kinds;
use crate::scene::{Field, Scene, Template, Uncertainty};
use crate::sweep::{Outcome, Plan, Progress, Record, Shard, Table, in_memory, run};
use crate::table_format::TableFormat;
use std::path::{Path, PathBuf};

/// Rows of the first look: 16 of each sequence.
const FIRST_ROWS: usize = 16 * REPLICATES;
/// Rows up to which accuracy is looked for.
const LARGEST_STUDY: usize = 1 << 16;
/// Relative error that the time integration may have in all results, far below any scatter worth a study.
const TOLERANCE: f64 = 4e-5;

/// What `scene` says of its inputs.
///
/// # Errors
/// [`Error::Usage`] if it printed nothing or names too many.
pub fn uncertainty_of(scene: &Scene) -> Result<&Uncertainty> {
    let uncertainty = scene.uncertainty.as_ref().ok_or_else(|| {
        Error::Usage(format!(
            "scene `{}` has no uncertain inputs: add a table such as [uncertainty] \"plate.thickness\" = \"1 %\"",
            scene.name
        ))
    })?;
    match uncertainty.inputs.len() {
        count if count > MOST_INPUTS => Err(Error::Usage(format!(
            "scene `{}` has {count} uncertain inputs; at most {MOST_INPUTS} can be sampled",
            scene.name
        ))),
        _ => Ok(uncertainty),
    }
}

/// The impacts of a study, which grow.
#[derive(Debug)]
struct Growing<'a> {
    plan: Plan,
    inputs: Inputs,
    /// Folder of the log; `None` = in memory.
    dir: Option<&'a Path>,
    records: Vec<Record>,
}

impl Growing<'_> {
    fn grow(&mut self, rows: usize, on_progress: &(dyn Fn(Progress) + Sync)) -> Result<()> {
        self.plan.grow(self.inputs.sampled(rows, 0));
        match self.dir {
            None => self.records.extend(in_memory(&self.plan, self.records.len(), on_progress)),
            Some(dir) => {
                run(&self.plan, dir, Shard::WHOLE, on_progress)?;
                self.records = Table::join(&self.plan, dir, Shard::WHOLE)?.records().to_vec();
            }
        }
        Ok(())
    }

    fn value(&self, index: usize, quantity: &str) -> Option<f64> {
        self.plan.value(&self.records[index], quantity).filter(|value| value.is_finite())
    }

    /// The rows of which every impact has a result.
    fn rows(&self, rows: usize, quantity: &str) -> Vec<Row> {
        let row = |number| {
            let value = |k| self.value(self.inputs.sampled(number, k), quantity);
            let mixed = (2..self.inputs.design.points()).map(value).collect::<Option<_>>()?;
            Some(Row { number, own: [value(0)?, value(1)?], mixed })
        };
        (0..rows).filter_map(row).collect()
    }

    /// Half width of the widest interval of mean and deviation of the requested quantities, over the deviation.
    fn accuracy(&self, rows: usize, quantities: &[String]) -> f64 {
        let of = |quantity: &String| {
            let rows = self.rows(rows, quantity);
            let (mean, deviation) = (mean(&rows), standard_deviation(&rows));
            let width = mean.half_width.max(deviation.half_width);
            if width == 0.0 { 0.0 } else { width / deviation.value }
        };
        // what is no number is as wide as can be
        quantities
            .iter()
            .map(of)
            .fold(0.0, |widest, width| if width > widest || width.is_nan() { width } else { widest })
    }
}

/// Runs the study that `request` asks for of the scene file `file`, in memory or in a `folder`, where its impacts are logged, so that it goes on if it
/// was interrupted, and become the table `samples`; `on_progress` hears of the progress.
///
/// # Errors
/// As [`uncertainty_of`]; [`Error::Usage`] for a number of rows that can't be, or a folder of another study; [`Error::Solver`] if the nominal
/// impact or most of the others have no result.
pub fn study(
    (file, template): (&Path, &Template),
    request: &Request,
    folder: Option<(&Path, TableFormat)>,
    on_progress: &(dyn Fn(Progress) + Sync),
) -> Result<PropagatedUncertainty> {
    let scene = template.scene();
    let uncertainty = uncertainty_of(scene)?;
    let inputs = Inputs::new(uncertainty, request.seed)
        .ok_or_else(|| Error::Internal("correlations that were checked contradict each other".into()))?;
    let first = match request.samples {
        Samples::Rows(rows) if (REPLICATES..=MOST_ROWS).contains(&rows) => rows,
        Samples::Rows(rows) => {
            return Err(Error::Usage(format!(
                "{rows} samples: {REPLICATES} to {MOST_ROWS} are possible, in {REPLICATES} independent sequences"
            )));
        }
        Samples::Until(_) => FIRST_ROWS,
    };
    let mut fields: Vec<(Field, [f64; 2])> = Vec::new();
    for input in &uncertainty.inputs {
        fields.push((template.field(&input.field)?, input.range()));
    }
    let plan = Plan::drawn(
        (PathBuf::from(file), template.clone()),
        (request.model, request.modes, TOLERANCE),
        fields,
        Box::new(inputs.clone()),
        inputs.sampled(first, 0),
    )?;
    let mut growing = Growing { plan, inputs, dir: folder.map(|(dir, _)| dir), records: Vec::new() };
    let mut rows = first;
    growing.grow(rows, on_progress)?;
    let reached = loop {
        let Samples::Until(accuracy) = request.samples else { break None };
        let reached = growing.accuracy(rows, &request.quantities);
        if reached <= accuracy || 2 * rows > LARGEST_STUDY {
            break Some(reached <= accuracy);
        }
        rows *= 2;
        growing.grow(rows, on_progress)?;
    };
    let Growing { inputs, records, plan, .. } = &growing;
    if let Outcome::Invalid(reason) | Outcome::Failed(reason) = &records[0].outcome {
        return Err(Error::Solver(format!("the impact with nominal inputs has no result: {reason}")));
    }
    let failure = records.iter().find(|record| record.outcome.status() != "ok");
    let lost = records.iter().filter(|record| record.outcome.status() != "ok").count();
    if 2 * lost > records.len() {
        let reason = failure.map_or("", |record| record.outcome.reason());
        return Err(Error::Solver(format!(
            "{lost} of {} impacts have no result, the first of them because: {reason}",
            records.len()
        )));
    }
    let of = |quantity: &str| SampledImpacts {
        nominal: growing.value(0, quantity),
        moved: (0..inputs.uncertainty.inputs.len())
            .map(|k| {
                [0, 1].map(|side| (inputs.shifted(k, side), growing.value(Inputs::moved(k, side), quantity)))
            })
            .collect(),
        rows: growing.rows(rows, quantity),
    };
    let kind = kinds::of(scene);
    let has = |name: &str| kind.has(scene, name);
    let quantities = kind.quantities().iter().filter(|quantity| !quantity.is_count && has(quantity.name));
    let mut propagated =
        PropagatedUncertainty::of(scene, request, inputs, quantities.map(|q| (q.name, q.unit, of(q.name))));
    (propagated.samples, propagated.impacts, propagated.failures, propagated.accurate) =
        (rows, plan.len(), lost, reached);
    propagated.notes.extend(failure.map(|record| {
        let reason = record.outcome.reason();
        format!(
            "{lost} of {} impacts have no result and their rows are omitted; the first: {reason}",
            plan.len()
        )
    }));
    let open = records.iter().filter(|record| plan.value(record, "converged") == Some(0.0)).count();
    if open > 0 {
        propagated.notes.push(format!(
            "the time integration of {open} of {} impacts did not converge to {TOLERANCE:.0e}: their contacts amplify every error, which adds to the standard deviations",
            plan.len()
        ));
    }
    if reached == Some(false) {
        propagated
            .notes
            .push(format!("{rows} samples do not reach the requested accuracy; this is the largest number"));
    }
    if let Some((dir, format)) = folder {
        Table::join(plan, dir, Shard::WHOLE)?.write(dir, "samples", format)?;
    }
    Ok(propagated)
}
