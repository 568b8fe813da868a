//! Apache Parquet.

use super::Export;
use super::csv::columns;
use crate::error::{Error, Result};
use crate::result::History;
use parquet::basic::{Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::Result as Written;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::sync::Arc;

/// A history with the units of its columns as metadata.
pub struct Parquet;

impl Export<History> for Parquet {
    fn ending(&self) -> &'static str {
        "parquet"
    }

    fn bytes(&self, history: &History) -> Result<Vec<u8>> {
        parquet(history).map_err(|e| Error::Internal(format!("writing Parquet: {e}")))
    }
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
