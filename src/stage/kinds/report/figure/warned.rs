//! What a figure cannot show of its tables: no mistake of the study, but its reader must know.
//!
//! Must not know: how anything is drawn.

use super::Figure;
use crate::stage::Inputs;

impl Figure {
    /// Sentences about it.
    pub fn warned(&self, inputs: &Inputs) -> Vec<String> {
        let is_empty = |(stage, table): &&(String, String)| inputs.table(stage, table).is_ok_and(|found| found.rows() == 0);
        let empty = self.tables.iter().filter(is_empty);
        empty.map(|(stage, table)| format!("figure `{}`: table `{stage}.{table}` has no rows", self.name)).collect()
    }
}
