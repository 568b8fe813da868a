//! A sweep drawn: curves over one parameter, maps over two, with the references that lie in it and what the paper says.

use crate::error::{Error, Result};
use crate::format::{prefixed, words};
use crate::kinds;
use crate::plot::{ChartPanel, ColourMap, Series, chart, colour_maps};
use crate::scene::{Model, unknown_name};
use crate::sweep::{Known, Plan, Record, Table};

/// The paper's rule for the optimum (section 4.1), which results can be compared with.
const RULE: &str = "paper: best where contact ≈ half the first period";
/// Name of the references' marks.
const REFERENCE: &str = "reference (uncertainty 95 %)";
/// Looks of models A, B, C and of the reference, as in the other figures.
const LOOKS: [usize; 4] = [1, 0, 2, 4];

/// A number as it is drawn: SI value times a factor.
#[derive(Debug, Clone)]
struct DrawnNumber {
    label: String,
    factor: f64,
}

impl DrawnNumber {
    fn new(name: &str, unit: &str, values: impl Iterator<Item = f64>) -> Self {
        let to = prefixed(unit, values.filter(|v| v.is_finite()).fold(0.0, |most, v| v.abs().max(most)));
        match to.unit {
            "" if unit == "1" => DrawnNumber { label: name.to_owned(), factor: 1.0 },
            "" => DrawnNumber { label: format!("{name} in {unit}"), factor: 1.0 },
            unit => DrawnNumber { label: format!("{name} in {unit}"), factor: to.factor },
        }
    }
}

/// A result that is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Drawn {
    /// Place among the [`Plan::results`].
    place: usize,
    name: &'static str,
    unit: &'static str,
}

impl Drawn {
    /// The number called `name` of the results of `plan`.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none.
    pub fn new(name: &str, plan: &Plan) -> Result<Self> {
        let results = || plan.results().iter().copied();
        let found = results().enumerate().find(|(_, (known, _))| *known == name);
        found.map(|(place, (name, unit))| Drawn { place, name, unit }).ok_or_else(|| {
            let names: Vec<&str> = results().map(|(known, _)| known).collect();
            unknown_name(format!("--quantity {name}: a sweep has no such quantity"), name, &names)
        })
    }

    fn of(self, record: &Record) -> f64 {
        record.outcome.numbers().map_or(f64::NAN, |numbers| numbers[self.place])
    }

    /// Whether the rule is about it, and the inner contact begins at the start, so that its end is how long it lasts.
    fn follows_rule(self, table: &Table) -> bool {
        let plan = table.plan();
        let scene = plan.template().scene();
        let in_contact = kinds::of(scene).starts_in_contact(scene);
        self.name == "efficiency" && in_contact && plan.fields().all(|field| field.path() != "inner.gap")
    }

    fn shown(self, table: &Table) -> DrawnNumber {
        if self.name == "efficiency" {
            return DrawnNumber { label: "Efficiency in %".into(), factor: 100.0 };
        }
        DrawnNumber::new(&words(self.name), self.unit, table.records().iter().map(|record| self.of(record)))
    }
}

/// The figure of `quantities`, of each model, as a stand-alone SVG.
///
/// # Errors
/// [`Error::Usage`] if neither one nor two parameters vary.
pub fn sweep_figure(table: &Table, quantities: &[Drawn], known: &[Known]) -> Result<String> {
    let (plan, title) = (table.plan(), format!("{}: sweep", table.plan().scene()));
    match plan.parameters().len() {
        1 => Ok(chart(&title, &quantities.iter().map(|q| panel(table, *q, known)).collect::<Vec<_>>())),
        2 => {
            let each = quantities.iter().flat_map(|q| plan.models().iter().map(move |model| (*q, *model)));
            Ok(colour_maps(&title, &each.map(|(q, model)| map(table, q, model, known)).collect::<Vec<_>>()))
        }
        count => Err(Error::Usage(format!("{count} parameters vary: a figure shows one or two"))),
    }
}

/// Values and name of parameter number `k` of the plan.
fn parameter(table: &Table, k: usize) -> (DrawnNumber, bool, impl Fn(&Record) -> f64) {
    let plan = table.plan();
    let (fields, logarithmic) = plan.parameters().swap_remove(k);
    let names: Vec<&str> = plan.fields().map(|field| field.path()).collect();
    let unit = plan.fields().nth(fields.start).map_or("1", |field| field.unit());
    let of = move |record: &Record| plan.numbers(record.index)[fields.start];
    let name = names[plan.parameters()[k].0.clone()].join(", ");
    (DrawnNumber::new(&name, unit, table.records().iter().map(&of)), logarithmic, of)
}

fn of_model<'a>(table: &'a Table, model: Model) -> impl Iterator<Item = &'a Record> {
    table.records().iter().filter(move |record| table.plan().model(record.index) == model)
}

fn panel(table: &Table, quantity: Drawn, known: &[Known]) -> ChartPanel {
    let (x, logarithmic, x_of) = parameter(table, 0);
    let y = quantity.shown(table);
    let sorted = |model: Model, value: &dyn Fn(&Record) -> f64| {
        let mut points: Vec<(f64, f64)> =
            of_model(table, model).map(|record| (x.factor * x_of(record), value(record))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let curve = |model: &Model| Series {
        name: format!("model {model}"),
        points: sorted(*model, &|record| y.factor * quantity.of(record)),
        look: Some(LOOKS[*model as usize]),
        ..Series::default()
    };
    let name = quantity.name;
    let there: Vec<(&Known, f64)> = known.iter().filter_map(|k| Some((k, k.summary.value(name)?))).collect();
    let references = (!there.is_empty()).then(|| Series {
        name: REFERENCE.into(),
        points: there.iter().map(|(k, value)| (x.factor * k.parameters[0], y.factor * value)).collect(),
        marks: true,
        half_widths: there.iter().map(|(k, _)| y.factor * k.summary.band(name).unwrap_or(0.0)).collect(),
        look: Some(LOOKS[3]),
    });
    let best = table.plan().models().iter().max().filter(|_| quantity.follows_rule(table));
    let ratio = best.map_or_else(Vec::new, |model| sorted(*model, &|record| over_half_period(table, record)));
    ChartPanel {
        statements: crossings(&ratio).into_iter().map(|x| (x, RULE.to_owned())).collect(),
        series: table.plan().models().iter().map(curve).chain(references).collect(),
        x_label: x.label,
        y_label: y.label,
        logarithmic,
        ..ChartPanel::default()
    }
}

fn map(table: &Table, quantity: Drawn, model: Model, known: &[Known]) -> ColourMap {
    let [(x, x_log, x_of), (y, y_log, y_of)] = [0, 1].map(|k| parameter(table, k));
    let shown = quantity.shown(table);
    let point = |record: &Record| {
        ([x.factor * x_of(record), y.factor * y_of(record)], shown.factor * quantity.of(record))
    };
    let mark = |k: &Known| {
        let at = [x.factor * k.parameters[0], y.factor * k.parameters[1]];
        Some((at, shown.factor * k.summary.value(quantity.name)?))
    };
    let several = table.plan().models().len() > 1;
    let is_grid = table.plan().is_grid();
    let rule = (is_grid && quantity.follows_rule(table)).then(|| {
        (RULE.to_owned(), of_model(table, model).map(|record| over_half_period(table, record)).collect())
    });
    ColourMap {
        points: of_model(table, model).map(point).collect(),
        is_grid,
        marks: ("reference".to_owned(), known.iter().filter_map(mark).collect()),
        line: rule,
        value_label: if several { format!("{}, model {model}", shown.label) } else { shown.label.clone() },
        labels: [x.label, y.label],
        logarithmic: [x_log, y_log],
    }
}

fn over_half_period(table: &Table, record: &Record) -> f64 {
    let plan = table.plan();
    let kind = kinds::of(plan.template().scene());
    kind.contact_over_half_period(&|name| plan.value(record, name)).unwrap_or(f64::NAN)
}

/// Where a curve is 1, linearly between its points.
fn crossings(curve: &[(f64, f64)]) -> Vec<f64> {
    let between = |pair: &[(f64, f64)]| {
        let [(a, from), (b, to)] = [pair[0], pair[1]];
        ((from < 1.0) != (to < 1.0) && from.is_finite() && to.is_finite())
            .then(|| a + (b - a) * (1.0 - from) / (to - from))
    };
    curve.windows(2).filter_map(between).collect()
}
