//! The results of a sweep as a table: CSV, Parquet, JSON.

use super::plan::Plan;
use super::record::Record;
use super::run::{Shard, read_all};
use crate::error::{Error, Result};
use crate::file::write_file;
use crate::scene::Model;
use crate::table_format::TableFormat;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use serde::Serialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Version of the document.
const SCHEMA_VERSION: u32 = 1;
/// Rows of a row group of a Parquet file.
const ROW_GROUP: usize = 100_000;

/// Points and results of a sweep.
#[derive(Debug)]
pub struct Table<'a> {
    plan: &'a Plan,
    records: Vec<Record>,
}

/// The document of `study sweep --json`: a study with its table and no claims.
#[derive(Debug, Serialize)]
pub struct Document {
    schema_version: u32,
    study: &'static str,
    description: String,
    columns: Vec<String>,
    units: Vec<&'static str>,
    rows: Vec<Vec<Value>>,
    claims: [Value; 0],
}

impl<'a> Table<'a> {
    /// Joins the logs in `dir`: all points of `shard`, in their order, each once.
    ///
    /// # Errors
    /// [`Error::Usage`] if points have no record yet or a log belongs to another sweep, [`Error::Io`] if one can't be read.
    pub fn join(plan: &'a Plan, dir: &Path, shard: Shard) -> Result<Self> {
        let (mut records, mut missing) = (Vec::new(), Vec::new());
        for (index, record) in read_all(plan, dir)?.into_iter().enumerate() {
            match record {
                _ if !shard.contains(index) => {}
                Some(record) => records.push(record),
                None => missing.push(index),
            }
        }
        if let Some(first) = missing.first() {
            return Err(Error::Usage(format!(
                "the sweep in {} is not complete: {} of {} points have no record, the first is number {first}; run its shards to their end",
                dir.display(),
                missing.len(),
                missing.len() + records.len()
            )));
        }
        Ok(Table { plan, records })
    }

    /// The plan whose points these are.
    pub fn plan(&self) -> &Plan {
        self.plan
    }

    /// The points and their results.
    pub fn records(&self) -> &[Record] {
        &self.records
    }

    /// Number of points that ended with "ok", "invalid" and "failed".
    pub fn counts(&self) -> [usize; 3] {
        ["ok", "invalid", "failed"]
            .map(|status| self.records.iter().filter(|record| record.outcome.status() == status).count())
    }

    /// Number of impacts whose time integration did not converge to the tolerance.
    pub fn unconverged(&self) -> usize {
        self.records.iter().filter(|record| self.plan.value(record, "converged") == Some(0.0)).count()
    }

    /// The point with the highest efficiency.
    pub fn best(&self, model: Model) -> Option<(&Record, f64)> {
        let own = self.records.iter().filter(|record| self.plan.model(record.index) == model);
        let rated = own.filter_map(|r| Some((r, self.plan.value(r, "efficiency")?)));
        rated.filter(|(_, efficiency)| efficiency.is_finite()).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Name, number and unit (none for pure numbers) of the varied fields at a point.
    pub fn place(&self, record: &Record) -> Vec<(&str, f64, &'static str)> {
        let unit = |unit| if unit == "1" { "" } else { unit };
        let numbers = self.plan.numbers(record.index);
        self.plan.fields().zip(numbers).map(|(field, n)| (field.path(), n, unit(field.unit()))).collect()
    }

    /// What the table has, with names and units.
    fn columns(&self) -> Vec<(SweepColumn, String, &'static str)> {
        let named = |column, name: &str| (column, name.to_owned(), "1");
        let model = (self.plan.models().len() > 1).then(|| named(SweepColumn::Model, "model"));
        let fields = self.plan.fields().enumerate();
        let results = self.plan.results().iter().enumerate();
        [named(SweepColumn::Index, "index")]
            .into_iter()
            .chain(model)
            .chain(fields.map(|(k, field)| (SweepColumn::Field(k), field.path().to_owned(), field.unit())))
            .chain([named(SweepColumn::Status, "status")])
            .chain(results.map(|(k, (name, unit))| (SweepColumn::Number(k), (*name).to_owned(), *unit)))
            .chain([named(SweepColumn::Reason, "reason")])
            .collect()
    }

    /// The cells of a row under `columns`.
    fn cells(&self, record: &Record, columns: &[SweepColumn]) -> Vec<SweepCell> {
        let (fields, numbers) = (self.plan.numbers(record.index), record.outcome.numbers());
        let cell = |column: &SweepColumn| match *column {
            SweepColumn::Index => SweepCell::Count(record.index),
            SweepColumn::Model => SweepCell::Text(self.plan.model(record.index).to_string()),
            SweepColumn::Field(k) => SweepCell::Number(fields[k]),
            SweepColumn::Status => SweepCell::Text(record.outcome.status().to_owned()),
            SweepColumn::Number(k) => {
                numbers.map_or(SweepCell::Missing, |numbers| SweepCell::Number(numbers[k]))
            }
            SweepColumn::Reason => SweepCell::Text(record.outcome.reason().to_owned()),
        };
        columns.iter().map(cell).collect()
    }

    /// The table as the JSON document of a study.
    pub fn document(&self) -> Document {
        let columns = self.columns();
        let kinds: Vec<SweepColumn> = columns.iter().map(|(column, ..)| *column).collect();
        let value = |cell| match cell {
            SweepCell::Count(count) => json!(count),
            SweepCell::Number(number) => json!(number),
            SweepCell::Text(text) if !text.is_empty() => json!(text),
            SweepCell::Text(_) | SweepCell::Missing => Value::Null,
        };
        let row = |record| self.cells(record, &kinds).into_iter().map(value).collect();
        let models: Vec<String> = self.plan.models().iter().map(ToString::to_string).collect();
        Document {
            schema_version: SCHEMA_VERSION,
            study: "sweep",
            description: format!(
                "Sweep of scene {} with model {}, {} points; identity {}",
                self.plan.scene(),
                models.join(", "),
                self.plan.len(),
                self.plan.hash()
            ),
            columns: columns.iter().map(|(_, name, _)| name.clone()).collect(),
            units: columns.iter().map(|(.., unit)| *unit).collect(),
            rows: self.records.iter().map(row).collect(),
            claims: [],
        }
    }

    /// Writes it into `dir`, called `name` with the ending of the format, by way of a temporary file and returns its path.
    ///
    /// # Errors
    /// [`Error::Io`] naming the file.
    pub fn write(&self, dir: &Path, name: &str, format: TableFormat) -> Result<PathBuf> {
        let path = dir.join(format!("{name}.{}", format.extension()));
        let bytes = match format {
            TableFormat::Csv => self.csv()?,
            TableFormat::Parquet => {
                self.parquet().map_err(|e| Error::Internal(format!("writing Parquet: {e}")))?
            }
        };
        write_file(&path, &bytes)?;
        Ok(path)
    }

    fn csv(&self) -> Result<Vec<u8>> {
        let failed = |e: csv::Error| Error::Internal(format!("writing CSV: {e}"));
        let columns = self.columns();
        let kinds: Vec<SweepColumn> = columns.iter().map(|(column, ..)| *column).collect();
        let heading = |(_, name, unit): &(_, String, &str)| match *unit {
            "1" => name.clone(),
            unit => format!("{name} [{unit}]"),
        };
        let text = |cell| match cell {
            SweepCell::Count(count) => count.to_string(),
            SweepCell::Number(number) => number.to_string(),
            SweepCell::Text(text) => text,
            SweepCell::Missing => String::new(),
        };
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(columns.iter().map(heading)).map_err(failed)?;
        for record in &self.records {
            writer.write_record(self.cells(record, &kinds).into_iter().map(text)).map_err(failed)?;
        }
        writer.into_inner().map_err(|e| Error::Internal(format!("writing CSV: {e}")))
    }

    fn parquet(&self) -> parquet::errors::Result<Vec<u8>> {
        let columns = self.columns();
        let kinds: Vec<SweepColumn> = columns.iter().map(|(column, ..)| *column).collect();
        let field = |(column, name, _): &(SweepColumn, String, &str)| {
            let (kind, text) = match column {
                SweepColumn::Index => (Physical::INT64, None),
                SweepColumn::Field(_) | SweepColumn::Number(_) => (Physical::DOUBLE, None),
                _ => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            };
            // a point without result has none of its numbers
            let optional = matches!(column, SweepColumn::Number(_));
            Type::primitive_type_builder(name, kind)
                .with_logical_type(text)
                .with_repetition(if optional { Repetition::OPTIONAL } else { Repetition::REQUIRED })
                .build()
                .map(Arc::new)
        };
        let fields = columns.iter().map(field).collect::<parquet::errors::Result<_>>()?;
        let schema = Arc::new(Type::group_type_builder("sweep").with_fields(fields).build()?);
        let units =
            columns.iter().map(|(_, name, unit)| KeyValue::new(format!("unit:{name}"), (*unit).to_owned()));
        let identity = KeyValue::new("sweep".to_owned(), self.plan.hash().to_owned());
        let properties = WriterProperties::builder()
            .set_key_value_metadata(Some(units.chain([identity]).collect()))
            .build();
        let mut bytes = Vec::new();
        let mut writer = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties))?;
        for rows in self.records.chunks(ROW_GROUP) {
            let mut group = writer.next_row_group()?;
            let rows: Vec<Vec<SweepCell>> = rows.iter().map(|record| self.cells(record, &kinds)).collect();
            for (k, column) in kinds.iter().enumerate() {
                let Some(mut to) = group.next_column()? else { break };
                let cells = || rows.iter().map(|row| &row[k]);
                let present: Vec<i16> = cells().map(|cell| i16::from(*cell != SweepCell::Missing)).collect();
                let present = matches!(column, SweepColumn::Number(_)).then_some(&present[..]);
                match column {
                    SweepColumn::Index => to.typed::<Int64Type>().write_batch(
                        &cells().filter_map(SweepCell::count).collect::<Vec<_>>(),
                        None,
                        None,
                    )?,
                    SweepColumn::Field(_) | SweepColumn::Number(_) => to.typed::<DoubleType>().write_batch(
                        &cells().filter_map(SweepCell::number).collect::<Vec<_>>(),
                        present,
                        None,
                    )?,
                    _ => to.typed::<ByteArrayType>().write_batch(
                        &cells().filter_map(SweepCell::text).collect::<Vec<_>>(),
                        None,
                        None,
                    )?,
                };
                to.close()?;
            }
            group.close()?;
        }
        writer.close()?;
        Ok(bytes)
    }
}

/// What a column of the table has.
#[derive(Debug, Clone, Copy, PartialEq)]
enum SweepColumn {
    Index,
    Model,
    /// The varied field of this number.
    Field(usize),
    Status,
    /// The number of [`Plan::results`] at this place.
    Number(usize),
    Reason,
}

#[derive(Debug, PartialEq)]
enum SweepCell {
    Count(usize),
    Number(f64),
    Text(String),
    Missing,
}

impl SweepCell {
    fn count(&self) -> Option<i64> {
        if let SweepCell::Count(count) = self { Some(*count as i64) } else { None }
    }

    fn number(&self) -> Option<f64> {
        if let SweepCell::Number(number) = self { Some(*number) } else { None }
    }

    fn text(&self) -> Option<ByteArray> {
        if let SweepCell::Text(text) = self { Some(ByteArray::from(text.as_str())) } else { None }
    }
}
