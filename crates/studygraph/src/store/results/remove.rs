//! Removing what is published no more, so that it cannot come back.
//!
//! Must not know: which files those are.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::Path;

use super::Folder;
use crate::presence;
use crate::store::error::StoreError;

impl Folder {
    /// Removes files before the manifest is written that does not list them: should this run not get so far, the next one
    /// finds them in the list that is there. A file that is in no list stays for ever, so its folder must know that it is
    /// gone before it knows the new manifest: the one place where folders have to be written through.
    pub(super) fn remove(&self, files: &[String]) -> Result<(), StoreError> {
        let mut folders = BTreeSet::new();
        for path in files.iter().map(|name| self.path().join(name)) {
            match fs::remove_file(&path) {
                Err(error) if error.kind() != ErrorKind::NotFound => {
                    return Err(StoreError::io("remove", &path)(error));
                }
                _ => folders.extend(path.parent().map(Path::to_owned)),
            }
        }
        // Elsewhere folders cannot be opened.
        for folder in folders.iter().filter(|_| cfg!(unix)) {
            let sync = || if presence::is_folder(folder)? { File::open(folder)?.sync_all() } else { Ok(()) };
            sync().map_err(StoreError::io("write", folder))?;
        }
        Ok(())
    }
}
