//! Files of an archive that are not tables: page, figures, drawings, HDF5. Each is made again from the archived tables.
//!
//! Nothing runs: what is asked is whether the archive shows what its tables hold. Must not know: how anything is drawn.

use std::collections::BTreeMap;
use std::io::{Read, Seek};
use std::path::Path;
use std::sync::Arc;

use super::{Agreement, VerifiedFile, VerifyError, archived};
#[cfg(feature = "hdf5")]
use crate::runner::execute::RunError;
use crate::store::archive::open::Archive;
use crate::store::archive::{self, ArchiveError};
use crate::store::bundle::{Opened, is_bundle};
#[cfg(feature = "hdf5")]
use crate::store::bundle::{is_long, published};
#[cfg(feature = "hdf5")]
use crate::store::error::StoreError;
#[cfg(feature = "hdf5")]
use crate::store::hdf5;
use crate::store::index::{self, INDEX, Index};
use crate::store::manifest::{Manifest, TableRecord};
use crate::store::parquet;
#[cfg(feature = "hdf5")]
use crate::store::results::hdf5_bytes;
use crate::store::results::{Draw, Drawn, MANIFEST, PAGE, held_text, is_drawn};
use crate::table::data::Table;

/// The results in an archive.
struct Files<'a, R> {
    archive: &'a Archive<R>,
    manifest: &'a Manifest,
    /// By their names in the results folder.
    bytes: BTreeMap<String, Vec<u8>>,
    opened: Opened,
}

/// Compares digests with those in the manifest and the index, then makes every file that is not a table again, with
/// `draw`, whose code has a digest.
///
/// # Errors
/// A file that is not there, or not the one that is listed.
pub fn check<R: Read + Seek>(
    archive: &mut Archive<R>,
    manifest: &Manifest,
    (draw, code): (Draw<'_>, &str),
    work: &Path,
) -> Result<Vec<VerifiedFile>, VerifyError> {
    let inside = archive::results(&manifest.study);
    let mut bytes = BTreeMap::new();
    for record in &manifest.files {
        bytes.insert(record.file.clone(), archive.bytes(&format!("{inside}{}", record.file))?);
    }
    let index = archive.names().any(|name| name == format!("{inside}{INDEX}"));
    let index = if index { Index::parse(&archive.bytes(&format!("{inside}{INDEX}"))?) } else { None };
    let digest = index::manifest_digest(&archive.bytes(&format!("{inside}{MANIFEST}"))?);
    let index = index.filter(|index| index.manifest == digest).unwrap_or_default();
    for record in &manifest.files {
        let noted = index.find(&record.file).filter(|_| record.varies).map(|seen| &seen.digest);
        if record.digest.as_ref().or(noted).is_some_and(|expected| *expected != index::digest(&bytes[&record.file])) {
            let problem = "it is not the file that was written with the manifest";
            return Err(archive.damaged(&format!("{inside}{}", record.file), problem).into());
        }
    }
    let drawn_by = if index.drawn_by.is_empty() { &manifest.program.code } else { &index.drawn_by };
    let files = Files { archive, manifest, bytes, opened: Opened::default() };
    let mut made = files.drawn(draw, drawn_by == code);
    made.extend(files.held()?);
    made.extend(files.hdf5(work)?);
    Ok(made)
}

impl<R: Read + Seek> Files<'_, R> {
    fn records(&self) -> impl Iterator<Item = &TableRecord> {
        self.manifest.stages.iter().flat_map(|stage| &stage.tables)
    }

    fn table(&self, record: &TableRecord) -> Result<Table, ArchiveError> {
        let entry = format!("{}{}", archive::results(&self.manifest.study), record.file);
        let bytes = self.bytes.get(&record.file).cloned();
        let bytes = bytes.ok_or_else(|| self.archive.damaged(&entry, "its manifest does not list it"))?;
        archived(self.archive, &entry, record, bytes, &self.opened)
    }

    /// All that a Parquet file holds.
    fn whole(&self, file: &str) -> Result<Table, ArchiveError> {
        let damaged = |problem: &str| self.archive.damaged(file, problem);
        let bytes = self.bytes.get(file).ok_or_else(|| damaged("its manifest does not list it"))?;
        parquet::read(bytes.clone()).map_err(|problem| damaged(&problem))
    }

    fn compared(&self, file: &str, bytes: &[u8], otherwise: impl FnOnce() -> Agreement) -> VerifiedFile {
        let agreement = match self.bytes.get(file) {
            Some(archived) if archived == bytes => Agreement::Identical,
            Some(_) => otherwise(),
            None => Agreement::Different("the archive has no such file".to_owned()),
        };
        VerifiedFile { file: file.to_owned(), agreement }
    }

    /// Page and figures. Another build may draw them otherwise.
    fn drawn(&self, draw: Draw<'_>, same_build: bool) -> Vec<VerifiedFile> {
        let other = |why: &str| {
            if same_build {
                Agreement::Different(why.to_owned())
            } else {
                Agreement::Otherwise(format!("{why}; another build drew it"))
            }
        };
        let listed = self.bytes.keys().filter(|file| is_drawn(file));
        let table = |name: &str| {
            if is_bundle(name) {
                return self.whole(&format!("{name}.parquet")).ok().map(Arc::new);
            }
            self.table(self.records().find(|record| record.name == name)?).ok().map(Arc::new)
        };
        match draw(self.manifest, &table) {
            Err(problem) => vec![VerifiedFile { file: PAGE.to_owned(), agreement: other(&problem) }],
            Ok(drawn) => {
                let gone = listed.filter(|file| !drawn.iter().any(|one| one.file == **file));
                let gone = gone.map(|file| VerifiedFile {
                    file: file.clone(),
                    agreement: other("the tables give no such figure"),
                });
                let same = |Drawn { file, bytes, .. }: &Drawn| {
                    self.compared(file, bytes, || other("it is not what its tables show"))
                };
                drawn.iter().map(same).chain(gone).collect()
            }
        }
    }

    /// Files that tables hold line by line.
    fn held(&self) -> Result<Vec<VerifiedFile>, ArchiveError> {
        let mut made = Vec::new();
        for record in self.records().filter(|record| !record.files.is_empty()) {
            let table = self.table(record)?;
            for file in &record.files {
                let text = held_text(&table, file).unwrap_or_default();
                let otherwise = || Agreement::Different(format!("it is not what the table `{}` holds", record.name));
                made.push(self.compared(file, text.as_bytes(), otherwise));
            }
        }
        Ok(made)
    }

    /// Another version of libhdf5 writes other bytes, so tables tell.
    #[cfg(feature = "hdf5")]
    fn hdf5(&self, work: &Path) -> Result<Option<VerifiedFile>, VerifyError> {
        let name = format!("{}.h5", self.manifest.study);
        let Some(archived) = self.bytes.get(&name) else { return Ok(None) };
        let mut tables = Vec::new();
        let is_there = |record: &TableRecord| record.files.is_empty() && !is_long(record.rows);
        for (group, record) in published(self.manifest).filter(|(_, record)| is_there(record)) {
            let table = if is_bundle(&record.file) { self.whole(&record.file)? } else { self.table(record)? };
            tables.push((group, record, Arc::new(table)));
        }
        let found = |wanted: &TableRecord| {
            let (_, _, table) = tables.iter().find(|(_, record, _)| record.file == wanted.file).ok_or_else(|| {
                StoreError::Format { table: wanted.file.clone(), problem: "it is missing".to_owned() }
            })?;
            Ok(Arc::clone(table))
        };
        // A manifest may list what no file can hold; its tables are looked at all the same.
        let is_same = hdf5_bytes(&name, self.manifest, &found, |bytes| *archived == *bytes);
        if is_same.is_ok_and(|is_same| is_same) {
            return Ok(Some(VerifiedFile { file: name, agreement: Agreement::Identical }));
        }
        let path = work.join("archived.h5");
        std::fs::write(&path, archived).map_err(|error| RunError::from(StoreError::io("write", &path)(error)))?;
        let other = tables.iter().find_map(|(stage, record, table)| {
            // The same table gives the same Parquet file, NaN and signs of zero as well.
            let same = hdf5::read(&path, stage, record.table())
                .is_ok_and(|read| matches!((parquet_of(&read), parquet_of(table)), (Some(a), Some(b)) if a == b));
            (!same).then(|| format!("it does not hold the table `{}` as the Parquet file does", record.name))
        });
        let agreement = other.map_or_else(
            || Agreement::Otherwise("the same tables; another version of libhdf5 wrote it".to_owned()),
            Agreement::Different,
        );
        Ok(Some(VerifiedFile { file: name, agreement }))
    }

    #[cfg(not(feature = "hdf5"))]
    #[allow(clippy::unused_self, clippy::unnecessary_wraps)] // the same shape with and without the feature
    fn hdf5(&self, _work: &Path) -> Result<Option<VerifiedFile>, VerifyError> {
        Ok(None)
    }
}

#[cfg(feature = "hdf5")]
fn parquet_of(table: &Table) -> Option<Vec<u8>> {
    crate::store::parquet::write(table).ok()
}
