//! The results of a sweep as a table: CSV, Parquet, JSON.

use super::plan::Plan;
use super::record::{NUMBERS, Outcome, Record};
use super::run::{Shard, read_all};
use crate::error::{Error, Result};
use crate::file::write_file;
use crate::report::TableFormat;
use crate::study::SCHEMA_VERSION;
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

    /// Number of points that ended with "ok", "invalid" and "failed".
    pub fn counts(&self) -> [usize; 3] {
        ["ok", "invalid", "failed"]
            .map(|status| self.records.iter().filter(|record| record.outcome.status() == status).count())
    }

    /// The point with the highest efficiency.
    pub fn best(&self) -> Option<(&Record, f64)> {
        let efficiency = |record: &'_ Record| match &record.outcome {
            Outcome::Done(point) => Some(point.quantities.efficiency),
            _ => None,
        };
        let rated = self.records.iter().filter_map(|record| Some((record, efficiency(record)?)));
        rated.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Name, number and unit (none for pure numbers) of the varied fields at a point.
    pub fn place(&self, record: &Record) -> Vec<(&str, f64, &'static str)> {
        let unit = |unit| if unit == "1" { "" } else { unit };
        let numbers = self.plan.numbers(record.index);
        self.plan.fields().zip(numbers).map(|(field, n)| (field.path(), n, unit(field.unit()))).collect()
    }

    /// Names and units of all columns.
    fn columns(&self) -> Vec<(String, &'static str)> {
        let field = |field: &crate::scene::Field| (field.path().to_owned(), field.unit());
        let named = |(name, unit): (&str, &'static str)| (name.to_owned(), unit);
        [named(("index", "1"))]
            .into_iter()
            .chain(self.plan.fields().map(field))
            .chain([named(("status", "1"))])
            .chain(NUMBERS.into_iter().map(named))
            .chain([named(("reason", "1"))])
            .collect()
    }

    /// The table as the JSON document of a study.
    pub fn document(&self) -> Document {
        let row = |record: &Record| {
            let mut row = vec![json!(record.index)];
            row.extend(self.plan.numbers(record.index).into_iter().map(Value::from));
            row.push(record.outcome.status().into());
            match record.outcome.numbers() {
                Some(numbers) => row.extend(numbers.map(Value::from)),
                None => row.extend(NUMBERS.map(|_| Value::Null)),
            }
            let reason = record.outcome.reason();
            row.push(if reason.is_empty() { Value::Null } else { reason.into() });
            row
        };
        let (columns, units) = self.columns().into_iter().unzip();
        Document {
            schema_version: SCHEMA_VERSION,
            study: "sweep",
            description: format!(
                "Sweep of scene {} with model {}, {} points; identity {}",
                self.plan.scene(),
                self.plan.model(),
                self.plan.len(),
                self.plan.hash()
            ),
            columns,
            units,
            rows: self.records.iter().map(row).collect(),
            claims: [],
        }
    }

    /// Writes `sweep.csv` or `sweep.parquet` into `dir` by way of a temporary file and returns its path.
    ///
    /// # Errors
    /// [`Error::Io`] naming the file.
    pub fn write(&self, dir: &Path, format: TableFormat) -> Result<PathBuf> {
        let path = dir.join(format!("sweep.{}", format.extension()));
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
        let mut writer = csv::Writer::from_writer(Vec::new());
        let heading =
            |(name, unit): (String, &str)| if unit == "1" { name } else { format!("{name} [{unit}]") };
        writer.write_record(self.columns().into_iter().map(heading)).map_err(failed)?;
        for record in &self.records {
            let mut cells = vec![record.index.to_string()];
            cells.extend(self.plan.numbers(record.index).iter().map(f64::to_string));
            cells.push(record.outcome.status().into());
            match record.outcome.numbers() {
                Some(numbers) => cells.extend(numbers.map(|number| number.to_string())),
                None => cells.extend(NUMBERS.map(|_| String::new())),
            }
            cells.push(record.outcome.reason().into());
            writer.write_record(cells).map_err(failed)?;
        }
        writer.into_inner().map_err(|e| Error::Internal(format!("writing CSV: {e}")))
    }

    fn parquet(&self) -> parquet::errors::Result<Vec<u8>> {
        let columns = self.columns();
        let kind = |name: &str| match name {
            "index" => Physical::INT64,
            "status" | "reason" => Physical::BYTE_ARRAY,
            _ => Physical::DOUBLE,
        };
        let result = |name: &str| NUMBERS.iter().any(|(number, _)| *number == name);
        let field = |(name, _): &(String, &str)| {
            let text = kind(name) == Physical::BYTE_ARRAY;
            Type::primitive_type_builder(name, kind(name))
                .with_logical_type(text.then_some(LogicalType::String))
                // a point without result has none of its numbers
                .with_repetition(if result(name) { Repetition::OPTIONAL } else { Repetition::REQUIRED })
                .build()
                .map(Arc::new)
        };
        let fields = columns.iter().map(field).collect::<parquet::errors::Result<_>>()?;
        let schema = Arc::new(Type::group_type_builder("sweep").with_fields(fields).build()?);
        let units =
            columns.iter().map(|(name, unit)| KeyValue::new(format!("unit:{name}"), (*unit).to_owned()));
        let identity = KeyValue::new("sweep".to_owned(), self.plan.hash().to_owned());
        let properties = WriterProperties::builder()
            .set_key_value_metadata(Some(units.chain([identity]).collect()))
            .build();
        let mut bytes = Vec::new();
        let mut writer = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties))?;
        for rows in self.records.chunks(ROW_GROUP) {
            let numbers: Vec<Vec<f64>> = rows.iter().map(|record| self.plan.numbers(record.index)).collect();
            let results: Vec<Option<[f64; NUMBERS.len()]>> =
                rows.iter().map(|r| r.outcome.numbers()).collect();
            let present: Vec<i16> = results.iter().map(|result| i16::from(result.is_some())).collect();
            let mut group = writer.next_row_group()?;
            let mut column = 0;
            while let Some(mut to) = group.next_column()? {
                let fields = columns.len() - NUMBERS.len() - 3;
                let texts = |text: fn(&Outcome) -> &str| -> Vec<ByteArray> {
                    rows.iter().map(|record| ByteArray::from(text(&record.outcome))).collect()
                };
                if column == 0 {
                    let values: Vec<i64> = rows.iter().map(|record| record.index as i64).collect();
                    to.typed::<Int64Type>().write_batch(&values, None, None)?;
                } else if column <= fields {
                    let values: Vec<f64> = numbers.iter().map(|numbers| numbers[column - 1]).collect();
                    to.typed::<DoubleType>().write_batch(&values, None, None)?;
                } else if column == fields + 1 {
                    to.typed::<ByteArrayType>().write_batch(&texts(|o| o.status()), None, None)?;
                } else if column < columns.len() - 1 {
                    let values: Vec<f64> =
                        results.iter().flatten().map(|result| result[column - fields - 2]).collect();
                    to.typed::<DoubleType>().write_batch(&values, Some(&present), None)?;
                } else {
                    to.typed::<ByteArrayType>().write_batch(&texts(Outcome::reason), None, None)?;
                }
                to.close()?;
                column += 1;
            }
            group.close()?;
        }
        writer.close()?;
        Ok(bytes)
    }
}
