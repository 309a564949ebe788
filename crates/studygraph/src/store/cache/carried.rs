//! Entries as they are carried from one cache to another.
//!
//! Must not know: who carries them.

use std::io::Cursor;

use super::{Cache, Lookup};
use crate::store::entry::{Body, CacheEntry};
use crate::store::error::StoreError;
use declare::digest::Digest;

impl Cache {
    /// All bytes of an entry, checked.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] also when there is no such entry.
    pub fn entry_bytes(&self, key: Digest) -> Result<Vec<u8>, StoreError> {
        let damaged = |problem: String| StoreError::Damaged { path: format!("entry {key}"), problem };
        let mut entry = match self.look_up(key) {
            Lookup::Found(entry) => entry,
            Lookup::Missing => return Err(damaged("it is missing".to_owned())),
            Lookup::Damaged(problem) => return Err(damaged(problem)),
        };
        let mut bodies = Vec::new();
        for table in &mut entry.tables {
            let Some(body) = &mut table.body else { continue };
            // In a pack a table is not the Parquet that it is elsewhere.
            let bytes = self.bytes(key, &table.name)?;
            *body = Body { bytes: bytes.len() as u64, digest: Digest(*blake3::hash(&bytes).as_bytes()) };
            bodies.extend(bytes);
        }
        entry.file(&bodies)
    }

    /// Keeps an entry that [`Cache::entry_bytes`] gave, every byte of it checked; one that is here already is left.
    ///
    /// # Errors
    /// [`StoreError::Damaged`] when it is not what was given; [`StoreError::NotDeterministic`] as [`Cache::put`].
    pub fn take_entry(&self, key: Digest, bytes: Vec<u8>) -> Result<(), StoreError> {
        let damaged = |problem: String| StoreError::Damaged { path: format!("entry {key}"), problem };
        let size = bytes.len() as u64;
        let mut file = Cursor::new(&bytes);
        let entry = CacheEntry::read(&mut file, size, key).map_err(damaged)?;
        let start = file.position();
        for table in entry.tables.iter().filter(|table| table.body.is_some()) {
            file.set_position(start);
            entry.body(&mut file, &table.name).map_err(damaged)?;
        }
        if let Lookup::Found(earlier) = self.look_up(key) {
            earlier.agree(&entry)?;
            if self.is_sound(key) {
                return Ok(());
            }
        }
        self.keep(&entry, bytes)
    }
}
