//! Tables as Parquet: one file holds the rows and everything the schema says about them.
//!
//! Unit, description, key, tolerance and flags are metadata of the fields, name and description of the table metadata
//! of the schema; units are also what pandas, Polars and DuckDB find them as (`PANDAS_ATTRS`). Reading back gives the identical table. The same table gives
//! the same bytes: no time, no host, one row-group size, metadata in sorted order. Must not know: where files lie.

use std::cell::Cell;
use std::collections::HashMap;
use std::io::Write;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Metadata, Schema as ArrowSchema};
use bytes::Bytes;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::arrow::{ArrowWriter, ProjectionMask};
use parquet::basic::{Compression, ZstdLevel};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use serde_json::{Map, Value, json};

use super::error::StoreError;
use crate::table::data::{Data, Table};
use crate::table::schema::{Column, Schema, Tolerance, Type};

mod stream;

pub use stream::Stream;

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Whether a panic of this thread is told as an error, and need not be told by itself.
#[must_use]
pub fn is_guarded() -> bool {
    GUARDED.get()
}

/// The library trusts its files more than those deserve that a disk, or anybody, may have changed; and it panics where
/// there is no memory.
fn guarded<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    let before = GUARDED.replace(true);
    let done = catch_unwind(AssertUnwindSafe(work));
    GUARDED.set(before);
    done.unwrap_or_else(|panic| {
        let words = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        Err(format!("Parquet error: {}", words.unwrap_or("it cannot be read")))
    })
}

/// The key of a file's metadata that pandas reads as `attrs`, in JSON.
const ATTRS: &str = "PANDAS_ATTRS";
const LEVEL: i32 = 3;
/// Rows of a group: so many are held when a table is written in pieces, and read at once by those who read in parallel.
pub const ROW_GROUP: usize = if cfg!(test) { 1 << 10 } else { 1 << 17 };

/// # Errors
/// [`StoreError::Format`]; no table known makes it fail.
pub fn write(table: &Table) -> Result<Vec<u8>, StoreError> {
    guarded(|| encode(table)).map_err(|problem| StoreError::Format { table: table.name().to_owned(), problem })
}

fn encode(table: &Table) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, table.schema())?;
    for first in (0..table.rows()).step_by(ROW_GROUP) {
        encoder.group(table.columns(), first..table.rows().min(first + ROW_GROUP))?;
    }
    encoder.close()?;
    Ok(bytes)
}

/// A file that is written row group by row group.
struct Encoder<W: Write + Send> {
    writer: ArrowWriter<W>,
    schema: Arc<ArrowSchema>,
}

impl<W: Write + Send> Encoder<W> {
    fn new(sink: W, schema: &Schema) -> Result<Self, String> {
        let failed = |error: ParquetError| error.to_string();
        // Beside the metadata of the schema, which Arrow alone reads.
        let attrs = KeyValue::new(ATTRS.to_owned(), attrs(schema));
        let schema = Arc::new(arrow_schema(schema));
        let level = ZstdLevel::try_new(LEVEL).map_err(failed)?;
        let properties = WriterProperties::builder().set_compression(Compression::ZSTD(level));
        let properties = properties.set_key_value_metadata(Some(vec![attrs]));
        let properties = properties.set_max_row_group_row_count(Some(ROW_GROUP)).build();
        let writer = ArrowWriter::try_new(sink, Arc::clone(&schema), Some(properties)).map_err(failed)?;
        Ok(Self { writer, schema })
    }

    /// Where the pages of a group end depends on how its rows are handed over: all of them at once.
    fn group(&mut self, columns: &[Data], rows: Range<usize>) -> Result<(), String> {
        self.writer.write(&batch(&self.schema, columns, rows)?).map_err(|error| error.to_string())
    }

    fn close(self) -> Result<(), String> {
        self.writer.close().map(|_| ()).map_err(|error| error.to_string())
    }
}

/// Some rows as Arrow has them.
fn batch(schema: &Arc<ArrowSchema>, columns: &[Data], rows: Range<usize>) -> Result<RecordBatch, String> {
    let options = arrow_array::RecordBatchOptions::new().with_row_count(Some(rows.len()));
    let columns = columns.iter().map(|data| array(data, rows.clone())).collect();
    RecordBatch::try_new_with_options(Arc::clone(schema), columns, &options).map_err(|error| error.to_string())
}

/// A table as Arrow has it, with the metadata that its Parquet file has.
///
/// # Errors
/// No table known makes it fail.
pub fn in_memory(table: &Table) -> Result<RecordBatch, String> {
    batch(&Arc::new(arrow_schema(table.schema())), table.columns(), 0..table.rows())
}

/// # Errors
/// A sentence, when the bytes are not a table written by [`write()`].
pub fn read(bytes: Vec<u8>) -> Result<Table, String> {
    guarded(|| decode(bytes))
}

/// One column of a table alone.
///
/// # Errors
/// As [`read`]; when there is no such column.
pub fn read_column(bytes: Vec<u8>, position: usize) -> Result<Data, String> {
    guarded(|| {
        let builder =
            ParquetRecordBatchReaderBuilder::try_new(Bytes::from(bytes)).map_err(|error| error.to_string())?;
        let schema = table_schema(builder.schema())?;
        let kind = schema.columns.get(position).ok_or("it has fewer columns")?.kind;
        let mask = ProjectionMask::leaves(builder.parquet_schema(), [position]);
        let mut found = Data::empty(kind);
        for batch in builder.with_projection(mask).build().map_err(|error| error.to_string())? {
            extend(&mut found, batch.map_err(|error| error.to_string())?.column(0))?;
        }
        Ok(found)
    })
}

fn decode(bytes: Vec<u8>) -> Result<Table, String> {
    let builder = ParquetRecordBatchReaderBuilder::try_new(Bytes::from(bytes)).map_err(|error| error.to_string())?;
    let schema = table_schema(builder.schema())?;
    let mut columns: Vec<Data> = schema.columns.iter().map(|column| Data::empty(column.kind)).collect();
    for batch in builder.build().map_err(|error| error.to_string())? {
        let batch = batch.map_err(|error| error.to_string())?;
        for (data, array) in columns.iter_mut().zip(batch.columns()) {
            extend(data, array)?;
        }
    }
    Table::from_columns(schema, columns).map_err(|error| error.to_string())
}

fn array(data: &Data, rows: Range<usize>) -> ArrayRef {
    match data {
        Data::Float(values) => Arc::new(Float64Array::from(values[rows].to_vec())),
        Data::Integer(values) => Arc::new(Int64Array::from(values[rows].to_vec())),
        Data::Text(values) => Arc::new(StringArray::from_iter_values(&values[rows])),
        Data::Flag(values) => Arc::new(BooleanArray::from(values[rows].to_vec())),
    }
}

fn extend(data: &mut Data, array: &ArrayRef) -> Result<(), String> {
    if array.null_count() > 0 {
        return Err("a cell is empty".to_owned());
    }
    let wrong = || format!("a column holds {}", array.data_type());
    match data {
        Data::Float(values) => {
            values.extend_from_slice(array.as_primitive_opt::<Float64Type>().ok_or_else(wrong)?.values());
        }
        Data::Integer(values) => {
            values.extend_from_slice(array.as_primitive_opt::<Int64Type>().ok_or_else(wrong)?.values());
        }
        Data::Text(values) => {
            let texts = array.as_string_opt::<i32>().ok_or_else(wrong)?;
            values.extend((0..texts.len()).map(|row| texts.value(row).to_owned()));
        }
        Data::Flag(values) => {
            let flags = array.as_boolean_opt().ok_or_else(wrong)?;
            values.extend((0..flags.len()).map(|row| flags.value(row)));
        }
    }
    Ok(())
}

/// The units of the columns that have one, for readers that pass over the metadata of fields.
fn attrs(schema: &Schema) -> String {
    let with_unit = schema.columns.iter().filter(|column| !column.unit.is_empty());
    let units: Map<String, Value> = with_unit.map(|column| (column.name.clone(), json!(column.unit))).collect();
    let mut attrs = json!({ "table": schema.name, "units": units });
    let beside =
        schema.columns.iter().filter_map(|column| Some((column.name.clone(), json!(unit_beside(schema, column)?))));
    let beside: Map<String, Value> = beside.collect();
    if !beside.is_empty() {
        attrs["unit_columns"] = Value::Object(beside);
    }
    attrs.to_string()
}

/// The column that has the unit of each row of another one: `unit` that of `value`, which has none of its own.
#[must_use]
pub fn unit_beside(schema: &Schema, column: &Column) -> Option<&'static str> {
    const UNIT: &str = "unit";
    let is_value = column.name == "value" && column.kind == Type::Float && column.unit.is_empty();
    let unit = schema.column(UNIT).filter(|unit| is_value && unit.kind == Type::Text);
    unit.map(|_| UNIT)
}

fn arrow_schema(schema: &Schema) -> ArrowSchema {
    let fields: Vec<Field> = schema.columns.iter().map(arrow_field).collect();
    let mut metadata = HashMap::from([
        ("table".to_owned(), schema.name.clone()),
        ("description".to_owned(), schema.description.clone()),
        (ATTRS.to_owned(), attrs(schema)),
    ]);
    if schema.on_demand {
        metadata.insert("on_demand".to_owned(), "true".to_owned());
    }
    ArrowSchema::new_with_metadata(fields, metadata)
}

fn arrow_field(column: &Column) -> Field {
    let kind = match column.kind {
        Type::Float => DataType::Float64,
        Type::Integer => DataType::Int64,
        Type::Text => DataType::Utf8,
        Type::Flag => DataType::Boolean,
    };
    let mut metadata = HashMap::from([
        ("unit".to_owned(), column.unit.clone()),
        ("description".to_owned(), column.description.clone()),
    ]);
    for (name, set) in flags(column) {
        if set {
            metadata.insert(name.to_owned(), "true".to_owned());
        }
    }
    for (name, tolerance) in
        [("absolute_tolerance", column.tolerance.absolute), ("relative_tolerance", column.tolerance.relative)]
    {
        if tolerance != 0.0 {
            metadata.insert(name.to_owned(), tolerance.to_string());
        }
    }
    Field::new(&column.name, kind, false).with_metadata(metadata)
}

/// What a column can be besides its type, under the names used in every file.
pub fn flags(column: &Column) -> [(&'static str, bool); 4] {
    [
        ("key", column.key),
        ("volatile", column.volatile),
        ("allows_nan", column.allows_nan),
        ("on_demand", column.on_demand),
    ]
}

fn table_schema(schema: &ArrowSchema) -> Result<Schema, String> {
    let text = |metadata: &Metadata, name: &str| metadata.get(name).cloned().unwrap_or_default();
    let name = schema.metadata().get("table").cloned().ok_or("it does not say which table it is")?;
    let columns = schema.fields().iter().map(|field| table_column(field)).collect::<Result<_, _>>()?;
    Ok(Schema {
        name,
        description: text(schema.metadata(), "description"),
        columns,
        on_demand: schema.metadata().contains_key("on_demand"),
        files: Vec::new(),
    })
}

fn table_column(field: &Field) -> Result<Column, String> {
    let kind = match field.data_type() {
        DataType::Float64 => Type::Float,
        DataType::Int64 => Type::Integer,
        DataType::Utf8 => Type::Text,
        DataType::Boolean => Type::Flag,
        other => return Err(format!("column `{}` holds {other}", field.name())),
    };
    let metadata = field.metadata();
    let text = |name: &str| metadata.get(name).cloned().unwrap_or_default();
    let set = |name: &str| metadata.contains_key(name);
    let number = |name: &str| {
        let parsed = metadata.get(name).map_or(Ok(0.0), |text| text.parse());
        parsed.map_err(|_| format!("column `{}`: {name} is not a number", field.name()))
    };
    Ok(Column {
        name: field.name().clone(),
        kind,
        unit: text("unit"),
        description: text("description"),
        key: set("key"),
        tolerance: Tolerance { absolute: number("absolute_tolerance")?, relative: number("relative_tolerance")? },
        volatile: set("volatile"),
        allows_nan: set("allows_nan"),
        on_demand: set("on_demand"),
    })
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// Every type, every flag, NaN, signed zero, extremes, words of several alphabets, empty words.
    pub fn everything(rows: usize) -> Table {
        let columns = vec![
            Column::text("design", "Name, ε_α").key(),
            Column::integer("position", "Count").key(),
            Column::float("te", "um", "Transmission error δ, \"quoted\"").tolerance(1e-3, 0.25).allows_nan(),
            Column::float("stiffness", "N/(mm um)", "c_γ").on_demand(),
            Column::flag("inside", "Whether"),
            Column::float("seconds", "s", "Time").volatile().tolerance(0.0, 0.0),
        ];
        let words = ["", "iso", "Ünïcode – 齿轮 ⚙", "a,b\"c\n"];
        let floats = [0.1, -0.0, f64::NAN, f64::MIN_POSITIVE / 4.0, f64::MAX, -1.0 / 3.0];
        let row = |index: usize| {
            vec![
                words[index % 4].into(),
                i64::try_from(index).unwrap().wrapping_mul(i64::MAX / 3).into(),
                floats[index % 6].into(),
                (1.0 / (index as f64 + 3.0)).into(),
                index.is_multiple_of(3).into(),
                (index as f64).into(),
            ]
        };
        let schema = Schema::new("curve", "All that a table can hold", columns).on_demand();
        Table::from_rows(schema, (0..rows).map(row).collect()).unwrap()
    }

    /// As `==`, but bit for bit: NaN equals NaN, −0 does not equal 0.
    pub fn assert_identical(a: &Table, b: &Table) {
        assert_eq!(a.schema(), b.schema());
        for (x, y) in a.columns().iter().zip(b.columns()) {
            match (x, y) {
                (Data::Float(x), Data::Float(y)) => {
                    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
                    assert_eq!(bits(x), bits(y));
                }
                _ => assert_eq!(x, y),
            }
        }
    }

    #[test]
    fn every_table_comes_back_identical() {
        for rows in [0, 1, 7, 3000] {
            let table = everything(rows);
            let bytes = write(&table).unwrap();
            let back = read(bytes).unwrap();
            assert_identical(&table, &back);
            assert_eq!(table.content_hash(), back.content_hash());
        }
    }

    #[test]
    fn attrs_say_where_a_unit_of_each_row_stands() {
        let said =
            |columns: Vec<Column>| -> Value { serde_json::from_str(&attrs(&Schema::new("t", "", columns))).unwrap() };
        let [value, unit] = [Column::float("value", "", ""), Column::text("unit", "")];
        let beside = json!({ "table": "t", "units": {}, "unit_columns": { "value": "unit" } });
        assert_eq!(said(vec![value.clone(), unit.clone()]), beside);
        assert_eq!(
            said(vec![Column::float("value", "m", ""), unit]),
            json!({ "table": "t", "units": { "value": "m" } })
        );
        assert_eq!(said(vec![value]), json!({ "table": "t", "units": {} }));
    }

    /// Tier: second way; wherever a table of several row groups is cut.
    #[test]
    fn pieces_give_the_bytes_of_the_whole() {
        for (rows, cuts) in [
            (0, vec![]),
            (9, vec![0, 4, 4]),
            (ROW_GROUP, vec![1]),
            (2 * ROW_GROUP + 5, vec![3, ROW_GROUP, ROW_GROUP + 1, 2 * ROW_GROUP + 4]),
            (2 * ROW_GROUP + 5, vec![2 * ROW_GROUP + 1]),
        ] {
            let table = everything(rows);
            let mut bytes = Vec::new();
            let mut stream = Stream::new(&mut bytes, table.shared_schema()).unwrap();
            let borders: Vec<usize> = [0].into_iter().chain(cuts).chain([rows]).collect();
            for ends in borders.windows(2) {
                let columns = table.columns().iter().map(|data| data.slice(ends[0]..ends[1])).collect();
                stream.add(&Table::from_columns(table.shared_schema().clone(), columns).unwrap()).unwrap();
            }
            stream.finish().unwrap();
            assert!(bytes == write(&table).unwrap(), "{rows} rows cut at {borders:?}");
        }
        let schema = Arc::new(everything(0).schema().clone());
        let mut stream = Stream::new(Vec::new(), &schema).unwrap();
        let other = Table::from_rows(Schema::new("other", "", vec![Column::text("a", "")]), vec![]).unwrap();
        assert!(stream.add(&other).is_err());
    }

    #[test]
    fn a_column_alone_is_that_of_the_table() {
        let table = everything(70);
        let bytes = write(&table).unwrap();
        for (position, data) in table.columns().iter().enumerate() {
            assert_eq!(format!("{:?}", read_column(bytes.clone(), position).unwrap()), format!("{data:?}"));
        }
        assert!(read_column(bytes, table.columns().len()).is_err());
    }

    #[test]
    fn the_same_table_gives_the_same_bytes() {
        // Metadata pass through a hash map, which has another order in each instance.
        let bytes = write(&everything(50)).unwrap();
        for _ in 0..20 {
            assert_eq!(write(&everything(50)).unwrap(), bytes);
        }
    }

    #[test]
    fn what_is_no_table_is_refused() {
        assert!(read(Vec::new()).is_err());
        assert!(read(b"PAR1 nonsense PAR1".to_vec()).is_err());
        let mut bytes = write(&everything(50)).unwrap();
        bytes.truncate(bytes.len() / 2);
        assert!(read(bytes).is_err());
    }
}
