//! A file of a table that comes in pieces.
//!
//! Must not know: where they come from, where files lie.

use std::io::Write;
use std::sync::Arc;

use super::{Encoder, ROW_GROUP, guarded};
use crate::store::error::StoreError;
use crate::table::data::{Data, Table};
use crate::table::schema::Schema;

/// The file of a table that comes in pieces: byte for byte what [`super::write()`] makes of all of them together, but no more than
/// a row group is held.
pub struct Stream<W: Write + Send> {
    encoder: Encoder<W>,
    schema: Arc<Schema>,
    /// The rows of a group that is not full.
    waiting: Vec<Data>,
}

impl<W: Write + Send> Stream<W> {
    /// # Errors
    /// As [`super::write()`], and when `sink` takes nothing.
    pub fn new(sink: W, schema: &Arc<Schema>) -> Result<Self, StoreError> {
        let encoder = guarded(|| Encoder::new(sink, schema)).map_err(unwritten(schema))?;
        Ok(Self { encoder, schema: Arc::clone(schema), waiting: empty(schema) })
    }

    /// The next rows.
    ///
    /// # Errors
    /// As [`Stream::new`]; when it is another table.
    pub fn add(&mut self, table: &Table) -> Result<(), StoreError> {
        if table.schema() != &*self.schema {
            return Err(unwritten(&self.schema)("two parts have different columns".to_owned()));
        }
        let mut from = 0;
        while from < table.rows() {
            let held = self.waiting.first().map_or(0, Data::len);
            let to = table.rows().min(from + ROW_GROUP - held);
            for (waiting, data) in self.waiting.iter_mut().zip(table.columns()) {
                waiting.append(&mut data.slice(from..to));
            }
            from = to;
            if self.waiting.first().map_or(0, Data::len) == ROW_GROUP {
                self.flush()?;
            }
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), StoreError> {
        let waiting = std::mem::replace(&mut self.waiting, empty(&self.schema));
        let rows = waiting.first().map_or(0, Data::len);
        if rows == 0 {
            return Ok(());
        }
        guarded(|| self.encoder.group(&waiting, 0..rows)).map_err(unwritten(&self.schema))
    }

    /// # Errors
    /// As [`Stream::new`].
    pub fn finish(mut self) -> Result<(), StoreError> {
        self.flush()?;
        let Self { encoder, schema, .. } = self;
        guarded(|| encoder.close()).map_err(unwritten(&schema))
    }
}

fn empty(schema: &Schema) -> Vec<Data> {
    schema.columns.iter().map(|column| Data::empty(column.kind)).collect()
}

fn unwritten(schema: &Schema) -> impl Fn(String) -> StoreError + '_ {
    |problem| StoreError::Format { table: schema.name.clone(), problem }
}
