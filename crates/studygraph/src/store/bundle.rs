//! Small tables of many stages of one kind, published as one: `_<kind>.<table>.parquet`, the rows of all stages with a column
//! `stage` before the others. Thousands of files of one row each would help nobody.
//!
//! A stage's own table is the rows that have its name, without that column; its digest is that of those rows. No stage can be
//! called as a bundle is: names do not begin with `_`. Must not know: where files lie.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::manifest::{Manifest, TableRecord, own_file};
use crate::table::data::{Data, Table, TableError};
use crate::table::schema::{Column, Schema};

/// Up to so many stages that have such a table each has its file.
pub const MANY: usize = 32;
/// A table of more rows has its own file.
const MOST_ROWS: usize = 4096;
/// A table of more rows is not in the HDF5 file, which is made in memory: its Parquet file alone has them.
pub const LONG: usize = 1 << 18;

/// Whether a table of so many rows is not in the HDF5 file.
#[must_use]
pub fn is_long(rows: usize) -> bool {
    rows > LONG
}

/// The column that says whose a row is.
pub const STAGE: &str = "stage";

/// Whether a file holds the tables of many stages.
#[must_use]
pub fn is_bundle(file: &str) -> bool {
    file.starts_with('_')
}

/// Decides which file each table of a manifest goes into: a question of kinds, columns and rows alone.
pub fn assign(manifest: &mut Manifest) {
    let bundles = bundles(manifest);
    for table in manifest.stages.iter_mut().flat_map(|stage| &mut stage.tables) {
        if is_bundle(&table.file) {
            table.file = own_file(&table.name);
        }
    }
    for (file, members) in bundles {
        for (stage, table) in members {
            manifest.stages[stage].tables[table].file.clone_from(&file);
        }
    }
}

/// Whether that is done.
#[must_use]
pub fn is_assigned(manifest: &Manifest) -> bool {
    let bundles = bundles(manifest);
    let tables = manifest.stages.iter().flat_map(|stage| &stage.tables);
    let bundled = tables.filter(|table| is_bundle(&table.file)).count();
    let of_file = |file: &str, at: &(usize, usize)| manifest.stages[at.0].tables[at.1].file == file;
    bundled == bundles.iter().map(|(_, members)| members.len()).sum::<usize>()
        && bundles.iter().all(|(file, members)| members.iter().all(|at| of_file(file, at)))
}

/// A file, and the places of stages and their tables that go into it.
type Bundle = (String, Vec<(usize, usize)>);

fn bundles(manifest: &Manifest) -> Vec<Bundle> {
    let mut groups: HashMap<(&str, &str), Vec<(usize, usize)>> = HashMap::new();
    for (stage, record) in manifest.stages.iter().enumerate() {
        for (table, own) in record.tables.iter().enumerate().filter(|(_, own)| fits(own)) {
            let group = groups.entry((&record.kind, own.table())).or_default();
            let alike = group.first().is_none_or(|&(stage, table): &(usize, usize)| {
                let first = &manifest.stages[stage].tables[table];
                (Arc::ptr_eq(&first.columns, &own.columns) || first.columns == own.columns)
                    && first.description == own.description
            });
            if alike {
                group.push((stage, table));
            }
        }
    }
    groups
        .into_iter()
        .filter(|(_, members)| members.len() > MANY)
        .map(|((kind, table), members)| (format!("_{kind}.{table}.parquet"), members))
        .collect()
}

/// Whether a table may be one of a bundle.
fn fits(table: &TableRecord) -> bool {
    let columns = &table.columns;
    let keyed = columns.iter().any(|column| column.key) && columns.iter().all(|column| column.name != STAGE);
    keyed && table.files.is_empty() && table.rows <= MOST_ROWS
}

/// The rows of one stage, or of several that follow each other in a bundle that is there already.
pub enum Rows<'a> {
    Own(&'a str, Table),
    Of(Range<usize>),
}

/// The tables of stages as one, in the order of their names; all have one schema. `earlier` is the bundle that some rows are
/// taken from.
///
/// # Errors
/// When a part has other columns; as [`Table::from_columns`].
pub fn together(earlier: Option<&Table>, parts: &[Rows]) -> Result<Table, TableError> {
    let of_own = parts.iter().find_map(|part| if let Rows::Own(_, table) = part { Some(table.schema()) } else { None });
    let schema = match (earlier, of_own) {
        (Some(earlier), _) => Arc::clone(earlier.shared_schema()),
        (None, Some(own)) => {
            let column = Column::text(STAGE, "Name of the stage.").key();
            let columns = [column].into_iter().chain(own.columns.iter().cloned()).collect();
            Arc::new(Schema { columns, ..own.clone() })
        }
        (None, None) => return Table::from_rows(Schema::new("", "", Vec::new()), Vec::new()),
    };
    let rows = |part: &Rows| match part {
        Rows::Own(_, table) => table.rows(),
        Rows::Of(rows) => rows.len(),
    };
    let count = parts.iter().map(rows).sum();
    let mut columns: Vec<Data> = schema.columns.iter().map(|column| Data::with_room(column.kind, count)).collect();
    for part in parts {
        match (part, earlier) {
            (Rows::Of(rows), Some(earlier)) => {
                for (all, data) in columns.iter_mut().zip(earlier.columns()) {
                    all.append(&mut data.slice(rows.clone()));
                }
            }
            (Rows::Own(stage, table), _) if table.schema().columns == schema.columns[1..] => {
                columns[0].append(&mut Data::Text(vec![(*stage).to_owned(); table.rows()]));
                for (all, data) in columns[1..].iter_mut().zip(table.columns()) {
                    all.append(&mut data.clone());
                }
            }
            _ => {
                let (table, column) = (schema.name.clone(), String::new());
                return Err(TableError::Column {
                    table,
                    column,
                    problem: "two parts have different columns".to_owned(),
                });
            }
        }
    }
    Table::from_columns(schema, columns)
}

/// The rows of a stage in a bundle.
#[must_use]
pub fn rows_of(bundle: &Table, stage: &str) -> Option<Range<usize>> {
    let (Some(Data::Text(names)), Some(0)) = (bundle.column(STAGE), bundle.schema().position(STAGE)) else {
        return None;
    };
    let start = names.partition_point(|name| name.as_str() < stage);
    Some(start..start + names[start..].partition_point(|name| name == stage))
}

/// The table of one stage; empty where no row has its name.
///
/// # Errors
/// When it is no bundle.
pub fn part(bundle: &Table, stage: &str) -> Result<Table, String> {
    let rows = rows_of(bundle, stage).ok_or("it has no column `stage` before the others")?;
    let schema = Schema { columns: bundle.schema().columns[1..].to_vec(), ..bundle.schema().clone() };
    let columns = bundle.columns()[1..].iter().map(|data| data.slice(rows.clone())).collect();
    Table::from_columns(schema, columns).map_err(|error| error.to_string())
}

/// Tables that were read, so that each file is read once for all who ask for what it holds.
#[derive(Debug, Default)]
pub struct Opened(Mutex<HashMap<String, Arc<Table>>>);

impl Opened {
    /// The table of a record, from the table that its file holds.
    ///
    /// # Errors
    /// Those of `read`; `damaged` makes one of a sentence.
    pub fn table<E>(
        &self,
        record: &TableRecord,
        place: &str,
        read: impl FnOnce() -> Result<Table, E>,
        damaged: impl FnOnce(String) -> E,
    ) -> Result<Table, E> {
        if !is_bundle(&record.file) {
            return read();
        }
        part(&*self.whole(place, read)?, record.stage()).map_err(damaged)
    }

    /// All that a file holds.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn whole<E>(&self, place: &str, read: impl FnOnce() -> Result<Table, E>) -> Result<Arc<Table>, E> {
        let known = self.all().get(place).cloned();
        match known {
            Some(known) => Ok(known),
            None => Ok(self.put(place, read()?)),
        }
    }

    /// Notes what a file holds.
    pub fn put(&self, place: &str, table: Table) -> Arc<Table> {
        let table = Arc::new(table);
        self.all().insert(place.to_owned(), Arc::clone(&table));
        table
    }

    /// Files may be others by now.
    pub fn clear(&self) {
        self.all().clear();
    }

    fn all(&self) -> MutexGuard<'_, HashMap<String, Arc<Table>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The tables as they are published: each by itself, and the tables of a bundle as one under the name `_kind`, with the first
/// of its records.
pub fn published(manifest: &Manifest) -> impl Iterator<Item = (&str, &TableRecord)> {
    let mut met = std::collections::HashSet::new();
    manifest.stages.iter().flat_map(|stage| &stage.tables).filter_map(move |table| {
        if !is_bundle(&table.file) {
            return Some((table.stage(), table));
        }
        let (kind, _) = table.file.split_once('.')?;
        met.insert(table.file.as_str()).then_some((kind, table))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::parquet::tests::{assert_identical, everything};

    #[test]
    fn the_parts_of_a_bundle_are_what_went_into_it() {
        let names: Vec<String> = (0..40).map(|index| format!("m{index}")).collect();
        let own = |index: usize| everything(index % 4);
        let mut ordered: Vec<(&str, Table)> =
            names.iter().enumerate().map(|(index, name)| (&**name, own(index))).collect();
        ordered.sort_by_key(|(name, _)| *name);
        let parts: Vec<Rows> = ordered.iter().map(|(name, table)| Rows::Own(name, table.clone())).collect();
        let bundle = together(None, &parts).unwrap();
        assert_eq!(bundle.rows(), 60);
        let bytes = crate::store::parquet::write(&bundle).unwrap();
        let bundle = crate::store::parquet::read(bytes).unwrap();
        for (index, name) in names.iter().enumerate() {
            assert_identical(&part(&bundle, name).unwrap(), &own(index));
        }
        assert_eq!(part(&bundle, "absent").unwrap().rows(), 0);
        assert!(part(&everything(3), "m1").unwrap_err().contains("stage"));
        // All rows but those of one stage from the bundle that is there, and in its place another table.
        let at = rows_of(&bundle, "m11").unwrap();
        let mixed = [Rows::Of(0..at.start), Rows::Own("m11", everything(2)), Rows::Of(at.end..bundle.rows())];
        let mixed = together(Some(&bundle), &mixed).unwrap();
        for (index, name) in names.iter().enumerate() {
            let expected = if name == "m11" { everything(2) } else { own(index) };
            assert_identical(&part(&mixed, name).unwrap(), &expected);
        }
        assert!(together(Some(&everything(3)), &[Rows::Own("m1", everything(1))]).is_err());
    }
}
