//! Which setting meets a wanted accuracy cheapest, as the page says it, from the tables `choice` of accuracy stages.
//!
//! Must not know: how it was found.

use serde::Serialize;

use super::{ReportError, Tables, flags, floats, seconds, texts};
use declare::number::significant;
use studygraph::store::manifest::Manifest;

/// A row of the page.
#[derive(Serialize)]
pub struct Choice {
    stage: String,
    quantity: String,
    wanted: String,
    met: bool,
    ladder: String,
    setting: String,
    error: String,
    seconds: String,
}

/// # Errors
/// When a table is of another shape.
pub fn choices(manifest: &Manifest, tables: Tables<'_>) -> Result<Vec<Choice>, ReportError> {
    let mut all = Vec::new();
    for stage in manifest.stages.iter().filter(|stage| stage.kind == "accuracy") {
        // What is left of an earlier run is shown, and nothing is where there is none.
        let Some(table) = tables(&format!("{}.choice", stage.name)) else { continue };
        let (quantity, ladder, setting) =
            (texts(&table, "quantity")?, texts(&table, "ladder")?, texts(&table, "setting")?);
        let (wanted, error) = (floats(&table, "wanted")?, floats(&table, "relative_error")?);
        let (met, time) = (flags(&table, "met")?, floats(&table, "seconds")?);
        all.extend((0..table.rows()).map(|row| Choice {
            stage: stage.name.clone(),
            quantity: quantity[row].clone(),
            wanted: percent(wanted[row]),
            met: met[row],
            ladder: ladder[row].clone(),
            setting: setting[row].clone(),
            error: percent(error[row]),
            seconds: seconds(time[row]),
        }));
    }
    Ok(all)
}

fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 2))
}
