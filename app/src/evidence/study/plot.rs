//! The figure of a study: curves over the columns of its table.

use super::{Cell, Study};
use crate::error::{Error, Result};
use crate::plot::{ChartPanel, Series, chart};

/// A column as it is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Name of the column.
    pub column: &'static str,
    /// Label with unit; of a series the unit behind its number.
    pub label: &'static str,
    /// SI value times this factor is drawn.
    pub factor: f64,
}

impl Axis {
    /// The column called `column`.
    pub const fn new(column: &'static str, label: &'static str, factor: f64) -> Self {
        Axis { column, label, factor }
    }
}

/// One coordinate system of the figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Panel {
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Rows with the same value in this column are one curve; `None` = all rows are.
    pub series: Option<Axis>,
    /// The rows that are drawn, in ascending order of the horizontal axis; `None` = all as they stand.
    pub only: Option<Only>,
    /// A band across the panel, in the units of the axis: middle and half width.
    pub band: Option<(f64, f64)>,
    /// What the paper says of a place on the horizontal axis, in the axis's units.
    pub paper: Option<(f64, &'static str)>,
}

impl Panel {
    /// All rows as one curve of `y` over `x`.
    pub const fn of(x: Axis, y: Axis) -> Self {
        Panel { x, y, series: None, only: None, band: None, paper: None }
    }

    /// With a curve for every value of `series`.
    pub const fn by(self, series: Axis) -> Self {
        Panel { series: Some(series), ..self }
    }
}

/// Rows with one of some texts in a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Only {
    /// Name of the column.
    pub column: &'static str,
    /// The texts.
    pub texts: &'static [&'static str],
}

/// The figure as a stand-alone SVG.
///
/// # Errors
/// [`Error::Internal`] if a panel names a column that is not there.
pub fn figure(study: &Study, panels: &[Panel]) -> Result<String> {
    let panels = panels.iter().map(|panel| drawn(study, panel)).collect::<Result<Vec<_>>>()?;
    Ok(chart(study.study, &panels))
}

fn drawn(study: &Study, panel: &Panel) -> Result<ChartPanel> {
    let index = |name: &str| {
        let found = study.columns.iter().position(|column| *column == name);
        found.ok_or_else(|| Error::Internal(format!("study {} has no column {name}", study.study)))
    };
    let (x, y) = (index(panel.x.column)?, index(panel.y.column)?);
    let by = panel.series.map(|axis| index(axis.column)).transpose()?;
    let mut rows: Vec<_> = study.rows.iter().collect();
    if let Some(only) = panel.only {
        let column = index(only.column)?;
        rows.retain(|row| matches!(row[column], Cell::Text(text) if only.texts.contains(&text)));
        rows.sort_by(|a, b| number(a[x]).total_cmp(&number(b[x])));
    }
    let mut series: Vec<Series> = Vec::new();
    for row in rows {
        let name = match (by.map(|by| row[by]), panel.series) {
            (Some(cell), Some(axis)) => name(cell, &axis),
            _ => String::new(),
        };
        let point = (number(row[x]) * panel.x.factor, number(row[y]) * panel.y.factor);
        match series.iter_mut().find(|series| series.name == name) {
            Some(series) => series.points.push(point),
            None => series.push(Series { name, points: vec![point], ..Series::default() }),
        }
    }
    // a row without a place on the axes (an impact without the varied quantity) makes no curve
    series.retain(|series| series.points.iter().any(|(x, y)| x.is_finite() && y.is_finite()));
    Ok(ChartPanel {
        x_label: panel.x.label.into(),
        y_label: panel.y.label.into(),
        series,
        band: panel.band,
        statements: panel.paper.iter().map(|(x, says)| (*x, (*says).to_owned())).collect(),
        ..ChartPanel::default()
    })
}

fn number(cell: Cell) -> f64 {
    match cell {
        Cell::Number(value) => value,
        Cell::Count(value) => value as f64,
        Cell::Text(_) | Cell::Missing => f64::NAN,
    }
}

fn name(cell: Cell, axis: &Axis) -> String {
    match cell {
        Cell::Text(text) => text.to_owned(),
        other => {
            // six digits hide what the factor's rounding leaves behind
            let value = (number(other) * axis.factor * 1e6).round() / 1e6;
            format!("{value} {}", axis.label).trim().to_owned()
        }
    }
}
