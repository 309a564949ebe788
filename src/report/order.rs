//! The order in which a study states its designs: tables are sorted by name, a reader wants the order of the study.
//!
//! Found from the tables: one with a key column of words and an integer column `order` says it for that column. Must not
//! know: figures.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::figure::Tables;
use super::spec::Spec;
use studygraph::store::bundle;
use studygraph::store::manifest::Manifest;
use studygraph::table::data::{Data, Table};

/// The values of columns, by the column's name, in their order.
#[derive(Default)]
pub struct Order(BTreeMap<String, Vec<String>>);

impl Order {
    #[must_use]
    pub fn of(manifest: &Manifest, tables: Tables<'_>) -> Self {
        let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let mut bundles: BTreeMap<&str, Option<Arc<Table>>> = BTreeMap::new();
        for record in manifest.stages.iter().flat_map(|stage| &stage.tables) {
            let mut keys = record.columns.iter().filter(|column| column.key);
            let (Some(key), None) = (keys.next(), keys.next()) else { continue };
            if key.kind != "text" || !record.columns.iter().any(|column| column.name == "order") {
                continue;
            }
            // Of a bundle all rows are had at once.
            let all = bundles.entry(&record.file).or_insert_with(|| {
                let name = record.file.strip_suffix(".parquet").filter(|_| bundle::is_bundle(&record.file));
                name.and_then(tables)
            });
            let own = if all.is_none() { tables(&record.name) } else { None };
            let Some(table) = all.as_ref().or(own.as_ref()) else { continue };
            let rows = match &*all {
                Some(all) => bundle::rows_of(all, record.stage()).unwrap_or_default(),
                None => 0..table.rows(),
            };
            let (Some(Data::Text(words)), Some(Data::Integer(places))) =
                (table.column(&key.name), table.column("order"))
            else {
                continue;
            };
            let mut rows: Vec<usize> = rows.collect();
            rows.sort_by_key(|&row| places[row]);
            let known = found.entry(key.name.clone()).or_default();
            for row in rows {
                if !known.contains(&words[row]) {
                    known.push(words[row].clone());
                }
            }
        }
        Self(found)
    }

    /// Of a value of a figure's series: as the figure lists its labels, then as the study has it, then as the table.
    #[must_use]
    pub fn rank(&self, spec: &Spec, value: &str) -> usize {
        self.rank_in(&spec.series, spec, value)
    }

    /// The same of a value of another column.
    #[must_use]
    pub fn rank_in(&self, column: &str, spec: &Spec, value: &str) -> usize {
        let labels = spec.labels.len();
        if let Some(place) = spec.labels.iter().position(|(known, _)| known == value) {
            return place;
        }
        let known = self.0.get(column).map_or(&[][..], Vec::as_slice);
        labels + known.iter().position(|known| known == value).unwrap_or(known.len())
    }
}
