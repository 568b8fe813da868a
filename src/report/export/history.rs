//! A history as a file: CSV or Parquet, with the columns of a reference's history.

use crate::error::{Error, Result};
use crate::result::History;
use crate::table_format::TableFormat;
use parquet::basic::{Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::Result as Written;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::sync::Arc;

/// `history` as the content of a file.
///
/// # Errors
/// [`Error::Internal`] if it can't be written.
pub fn history_file(history: &History, format: TableFormat) -> Result<Vec<u8>> {
    match format {
        TableFormat::Csv => csv(history).map_err(|e| Error::Internal(format!("writing CSV: {e}"))),
        TableFormat::Parquet => {
            parquet(history).map_err(|e| Error::Internal(format!("writing Parquet: {e}")))
        }
    }
}

/// Name, unit and values of every column.
fn columns(history: &History) -> Vec<(&'static str, &'static str, &[f64])> {
    let curves = history.curves.iter().map(|curve| (curve.name, curve.unit, &curve.values[..]));
    std::iter::once(("time", "s", &history.time[..])).chain(curves).collect()
}

fn csv(history: &History) -> std::result::Result<Vec<u8>, csv::Error> {
    let columns = columns(history);
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns.iter().map(|(name, ..)| name))?;
    for i in 0..history.len() {
        writer.serialize(columns.iter().map(|(.., values)| values[i]).collect::<Vec<f64>>())?;
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}

fn parquet(history: &History) -> Written<Vec<u8>> {
    let columns = columns(history);
    let field = |name| {
        let field = Type::primitive_type_builder(name, Physical::DOUBLE);
        field.with_repetition(Repetition::REQUIRED).build().map(Arc::new)
    };
    let fields = columns.iter().map(|(name, ..)| field(name)).collect::<Written<_>>()?;
    let schema = Arc::new(Type::group_type_builder("history").with_fields(fields).build()?);
    let units =
        columns.iter().map(|(name, unit, _)| KeyValue::new(format!("unit:{name}"), (*unit).to_owned()));
    let properties = WriterProperties::builder().set_key_value_metadata(Some(units.collect())).build();
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for (.., values) in columns {
        if let Some(mut column) = group.next_column()? {
            column.typed::<DoubleType>().write_batch(values, None, None)?;
            column.close()?;
        }
    }
    group.close()?;
    writer.close()?;
    Ok(bytes)
}
