//! The order in which a study states its designs: tables are sorted by name, a reader wants the order of the study.
//!
//! Found from the tables: one with a key column of words and an integer column `order` says it for that column. Must not
//! know: figures.

use std::collections::{BTreeMap, HashSet};

use super::Tables;
use super::spec::Spec;
use studygraph::store::bundle;
use studygraph::store::manifest::Manifest;
use studygraph::table::data::Data;

/// The values of columns, by the column's name, in their order.
#[derive(Default)]
pub struct Order(BTreeMap<String, Vec<String>>);

/// Words, each where it stood first.
#[derive(Default)]
struct Words {
    ordered: Vec<String>,
    met: HashSet<String>,
}

impl Words {
    fn add(&mut self, word: &str) {
        if self.met.insert(word.to_owned()) {
            self.ordered.push(word.to_owned());
        }
    }
}

impl Order {
    #[must_use]
    pub fn of(manifest: &Manifest, tables: Tables<'_>) -> Self {
        let mut found: BTreeMap<String, Words> = BTreeMap::new();
        // Of a bundle all rows are had at once.
        for (group, record) in bundle::published(manifest) {
            let mut keys = record.columns.iter().filter(|column| column.key);
            let (Some(key), None) = (keys.next(), keys.next()) else { continue };
            if key.kind != "text" || !record.columns.iter().any(|column| column.name == "order") {
                continue;
            }
            let Some(table) = tables(&format!("{group}.{}", record.table())) else { continue };
            let (Some(Data::Text(words)), Some(Data::Integer(places))) =
                (table.column(&key.name), table.column("order"))
            else {
                continue;
            };
            let mut rows: Vec<usize> = (0..table.rows()).collect();
            rows.sort_by_key(|&row| places[row]);
            let known = found.entry(key.name.clone()).or_default();
            for row in rows {
                known.add(&words[row]);
            }
        }
        let found = found.into_iter().map(|(column, words)| (column, words.ordered)).collect();
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
