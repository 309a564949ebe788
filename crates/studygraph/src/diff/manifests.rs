//! The manifests of a side that a comparison needs.
//!
//! Must not know: what is compared.

use crate::history::side::Side;
use crate::store::manifest::Manifest;

/// The manifest in a folder of a side, or the reason for which it cannot be read; the study's name first.
pub type Read = (String, String, Result<Manifest, String>);

/// The `studies` of a side, all when empty, and those that are not `there` on the other side: one may have another name here.
///
/// # Errors
/// When the folders cannot be listed, or none has results.
pub fn read(side: &Side, there: &Side, studies: &[String]) -> Result<Vec<Read>, String> {
    let folders = side.studies()?;
    if folders.is_empty() {
        return Err(format!("there are no results at {}", side.label));
    }
    let others = there.studies()?;
    let is_wanted = |folder: &String| {
        studies.is_empty()
            || side.is_single()
            || studies.contains(folder)
            || !there.is_single() && !others.contains(folder)
    };
    let read = folders.into_iter().filter(is_wanted).filter_map(|folder| {
        let manifest = side.manifest(&folder).transpose()?;
        let name = match &manifest {
            Ok(manifest) if side.is_single() => manifest.study.clone(),
            _ => folder.clone(),
        };
        Some((name, folder, manifest))
    });
    Ok(read.collect())
}
