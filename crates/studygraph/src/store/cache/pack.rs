//! One file that many small entries share: segments, one for each group that was written through together.
//!
//! ```text
//! "gearstudy pack 1\n" · segments
//! segment: length of contents (u64, little endian) · length of bodies · BLAKE3 of both and of the contents ·
//!          contents · headers · bodies
//! ```
//!
//! Contents, headers and bodies are postcard, an encoding whose wire format is written down and kept. A schema stands once in
//! a pack, before the first table that has it; a body is the columns of a table. A segment that is cut short, or whose digest
//! is not that of its contents, ends the pack: what a killed run was at. Headers have a digest in the contents, bodies one in
//! their header. Must not know: which packs there are, what a key is made of.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::store::entry::{Body, CacheEntry, OfRun, StoredTable};
use crate::store::error::StoreError;
use crate::table::data::{Data, Table};
use crate::table::schema::Schema;
use declare::digest::Digest;

pub(super) const MAGIC: &[u8; 17] = b"gearstudy pack 1\n";
const PREFIX_BYTES: usize = 8 + 8 + 32;
const PREFIX: u64 = PREFIX_BYTES as u64;
/// Contents longer than this are not ours: a group has far fewer.
const LONGEST: u64 = 1 << 28;

/// Bytes of an entry's columns up to which it goes into a pack.
pub(super) const SMALL: usize = 1 << 16;

/// What a segment holds.
#[derive(Default, Serialize, Deserialize)]
struct Contents {
    /// Schemas that no segment before has.
    schemas: Vec<Schema>,
    entries: Vec<Listed>,
    /// Keys whose entries before this are damaged.
    gone: Vec<Key>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
struct Key(#[serde(with = "crate::store::hexadecimal")] Digest);

/// An entry in the list of a segment.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Listed {
    key: Key,
    /// Bytes of its header and of its bodies.
    header: u32,
    bodies: u32,
    /// Of the header.
    digest: Key,
}

/// What is known of an entry besides its key.
#[derive(Deserialize)]
struct Header {
    of_run: OfRun,
    tables: Vec<StoredTable>,
    /// Places of the tables' schemas in the pack.
    schemas: Vec<u32>,
}

/// The same, borrowed.
#[derive(Serialize)]
struct HeaderOf<'a> {
    of_run: &'a OfRun,
    tables: &'a [StoredTable],
    schemas: Vec<u32>,
}

/// An entry that is not in a segment yet.
pub(super) struct Small {
    pub(super) entry: CacheEntry,
    schemas: Vec<Arc<Schema>>,
    pub(super) bodies: Vec<u8>,
}

/// About how many bytes the columns of a table take.
pub(super) fn size(table: &Table) -> usize {
    let of = |data: &Data| match data {
        Data::Text(values) => values.iter().map(|text| text.len() + 1).sum(),
        Data::Flag(values) => values.len(),
        numbers => 8 * numbers.len(),
    };
    table.columns().iter().map(of).sum()
}

impl Small {
    /// # Errors
    /// When a table cannot be encoded, which cannot be.
    pub(super) fn new(key: Digest, tables: &[&Table], of_run: OfRun) -> Result<Self, StoreError> {
        let (mut stored, mut schemas, mut bodies) = (Vec::new(), Vec::new(), Vec::new());
        for table in tables {
            let body = encoded(table.name(), &table.columns())?;
            let digest = Digest(*blake3::hash(&body).as_bytes());
            let described = StoredTable::describe(table)?;
            stored.push(StoredTable { body: Some(Body { bytes: body.len() as u64, digest }), ..described });
            schemas.push(Arc::clone(table.shared_schema()));
            bodies.extend(body);
        }
        Ok(Self { entry: CacheEntry { key, tables: stored, of_run }, schemas, bodies })
    }

    /// # Errors
    /// A sentence that says what is damaged.
    pub(super) fn table(&self, name: &str) -> Result<Option<Table>, String> {
        let schemas: Vec<&Arc<Schema>> = self.schemas.iter().collect();
        table_in(&self.entry.tables, &schemas, &self.bodies, name)
    }
}

fn encoded<T: Serialize>(name: &str, value: &T) -> Result<Vec<u8>, StoreError> {
    postcard::to_stdvec(value)
        .map_err(|error| StoreError::Format { table: name.to_owned(), problem: error.to_string() })
}

/// A table among the bodies of an entry, checked.
fn table_in(
    tables: &[StoredTable],
    schemas: &[&Arc<Schema>],
    bodies: &[u8],
    name: &str,
) -> Result<Option<Table>, String> {
    let mut rest = bodies;
    for (table, schema) in tables.iter().zip(schemas) {
        let Some(body) = &table.body else { continue };
        let length = usize::try_from(body.bytes).map_err(|error| error.to_string())?;
        let (own, others) = rest.split_at_checked(length).ok_or("it is cut short")?;
        rest = others;
        if table.name == name {
            if blake3::hash(own).as_bytes() != &body.digest.0 {
                return Err(format!("table `{name}` is not what was written"));
            }
            let columns: Vec<Data> = postcard::from_bytes(own).map_err(|error| error.to_string())?;
            return Table::from_columns(Arc::clone(schema), columns).map(Some).map_err(|error| error.to_string());
        }
    }
    Ok(None)
}

/// Where an entry lies.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) header_at: u64,
    header: u32,
    digest: Digest,
    bodies_at: u64,
    bodies: u32,
}

impl Place {
    pub(super) fn bytes(&self) -> u64 {
        u64::from(self.header) + u64::from(self.bodies)
    }
}

/// A pack as it was read or written so far.
#[derive(Default)]
pub(super) struct Pack {
    schemas: Vec<Arc<Schema>>,
    /// The end of the last whole segment.
    pub(super) end: u64,
}

/// What a segment says of a key.
pub(super) enum Said {
    Entry(Place),
    Gone,
}

/// Why a pack was not read to the end of its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ending {
    Whole,
    /// A run was killed, or is at it.
    Cut,
    /// Bytes are other ones than were written.
    Damaged,
}

impl Pack {
    /// One that holds nothing but its first bytes.
    pub(super) fn begun() -> Self {
        Self { schemas: Vec::new(), end: MAGIC.len() as u64 }
    }

    /// Reads what is in a pack, but for headers and bodies.
    ///
    /// # Errors
    /// What the system says.
    pub(super) fn read(file: &mut File, mut each: impl FnMut(Digest, Said)) -> io::Result<(Self, Ending)> {
        let size = file.metadata()?.len();
        let mut pack = Self::default();
        let mut magic = [0; MAGIC.len()];
        if size < MAGIC.len() as u64 {
            return Ok((pack, Ending::Cut));
        }
        file.seek(SeekFrom::Start(0))?;
        file.read_exact(&mut magic)?;
        if magic != *MAGIC {
            return Ok((pack, Ending::Damaged));
        }
        pack.end = MAGIC.len() as u64;
        while pack.end < size {
            if pack.end + PREFIX > size {
                return Ok((pack, Ending::Cut));
            }
            file.seek(SeekFrom::Start(pack.end))?;
            let mut prefix = [0; PREFIX_BYTES];
            file.read_exact(&mut prefix)?;
            let number =
                |at: usize| prefix[at..at + 8].iter().rev().fold(0_u64, |all, byte| all << 8 | u64::from(*byte));
            let (length, rest) = (number(0), number(8));
            let start = pack.end + PREFIX;
            let end = start.checked_add(length).and_then(|end| end.checked_add(rest));
            let Some(end) = end.filter(|_| length <= LONGEST) else { return Ok((pack, Ending::Damaged)) };
            if end > size {
                return Ok((pack, Ending::Cut));
            }
            let mut contents = vec![0; usize::try_from(length).unwrap_or(0)];
            file.read_exact(&mut contents)?;
            let digest = blake3::Hasher::new().update(&prefix[..16]).update(&contents).finalize();
            let known = (digest.as_bytes()[..] == prefix[16..]).then(|| postcard::from_bytes::<Contents>(&contents));
            let Some(Ok(contents)) = known else { return Ok((pack, Ending::Damaged)) };
            pack.take(&contents, start + length, &mut each);
            pack.end = end;
        }
        Ok((pack, Ending::Whole))
    }

    /// Tells what is in a segment whose headers begin at `headers`.
    fn take(&mut self, contents: &Contents, headers: u64, each: &mut impl FnMut(Digest, Said)) {
        self.schemas.extend(contents.schemas.iter().cloned().map(Arc::new));
        contents.gone.iter().for_each(|Key(key)| each(*key, Said::Gone));
        let mut header_at = headers;
        let mut bodies_at = headers + contents.entries.iter().map(|listed| u64::from(listed.header)).sum::<u64>();
        for Listed { key: Key(key), header, bodies, digest: Key(digest) } in contents.entries.iter().copied() {
            each(key, Said::Entry(Place { header_at, header, digest, bodies_at, bodies }));
            header_at += u64::from(header);
            bodies_at += u64::from(bodies);
        }
    }

    /// A segment of these entries and of keys that are gone, to be written at the end; `each` hears where entries will lie.
    ///
    /// # Errors
    /// When something cannot be encoded, which cannot be.
    pub(super) fn segment(
        &mut self,
        entries: &[Arc<Small>],
        gone: &[Digest],
        mut each: impl FnMut(Digest, Said),
    ) -> Result<Vec<u8>, StoreError> {
        let known = self.schemas.len();
        let mut contents = Contents { gone: gone.iter().copied().map(Key).collect(), ..Contents::default() };
        let (mut headers, mut bodies) = (Vec::new(), Vec::new());
        for small in entries {
            let schemas = small.schemas.iter().map(|schema| {
                let same = |other: &Arc<Schema>| Arc::ptr_eq(other, schema) || other == schema;
                let place = self.schemas.iter().position(same).unwrap_or_else(|| {
                    self.schemas.push(Arc::clone(schema));
                    self.schemas.len() - 1
                });
                u32::try_from(place).unwrap_or(u32::MAX)
            });
            let CacheEntry { key, tables, of_run } = &small.entry;
            let header = encoded("", &HeaderOf { of_run, tables, schemas: schemas.collect() })?;
            let length = |bytes: usize| u32::try_from(bytes).unwrap_or(u32::MAX);
            contents.entries.push(Listed {
                key: Key(*key),
                header: length(header.len()),
                bodies: length(small.bodies.len()),
                digest: Key(Digest(*blake3::hash(&header).as_bytes())),
            });
            headers.extend(header);
            bodies.extend_from_slice(&small.bodies);
        }
        contents.schemas = self.schemas[known..].iter().map(|schema| (**schema).clone()).collect();
        self.schemas.truncate(known);
        let written = encoded("", &contents)?;
        let mut segment = Vec::with_capacity(PREFIX_BYTES + written.len() + headers.len() + bodies.len());
        segment.extend((written.len() as u64).to_le_bytes());
        segment.extend(((headers.len() + bodies.len()) as u64).to_le_bytes());
        let digest = blake3::Hasher::new().update(&segment).update(&written).finalize();
        segment.extend(digest.as_bytes());
        self.take(&contents, self.end + PREFIX + written.len() as u64, &mut each);
        segment.extend(written);
        segment.extend(headers);
        segment.extend(bodies);
        self.end += segment.len() as u64;
        Ok(segment)
    }

    /// The header of an entry, and the schemas of its tables.
    fn header(&self, file: &File, place: &Place, key: Digest) -> Result<(CacheEntry, Vec<&Arc<Schema>>), String> {
        let bytes = bytes_at(file, place.header_at, place.header)?;
        if *blake3::hash(&bytes).as_bytes() != place.digest.0 {
            return Err("its header is not what was written".to_owned());
        }
        let Header { of_run, tables, schemas } = postcard::from_bytes(&bytes).map_err(|error| error.to_string())?;
        let schema = |place: &u32| self.schemas.get(*place as usize).ok_or("it names a schema that is not there");
        let schemas = schemas.iter().map(schema).collect::<Result<_, _>>()?;
        Ok((CacheEntry { key, tables, of_run }, schemas))
    }

    /// # Errors
    /// A sentence that says what is damaged.
    pub(super) fn entry(&self, file: &File, place: &Place, key: Digest) -> Result<CacheEntry, String> {
        self.header(file, place, key).map(|(entry, _)| entry)
    }

    /// A table of an entry, checked.
    ///
    /// # Errors
    /// A sentence that says what is damaged.
    pub(super) fn table(&self, file: &File, place: &Place, name: &str) -> Result<Option<Table>, String> {
        let (entry, schemas) = self.header(file, place, place.digest)?;
        table_in(&entry.tables, &schemas, &bytes_at(file, place.bodies_at, place.bodies)?, name)
    }

    /// All of an entry, checked.
    ///
    /// # Errors
    /// A sentence that says what is damaged.
    pub(super) fn small(&self, file: &File, place: &Place, key: Digest) -> Result<Small, String> {
        let (entry, schemas) = self.header(file, place, key)?;
        let bodies = bytes_at(file, place.bodies_at, place.bodies)?;
        for table in &entry.tables {
            table_in(&entry.tables, &schemas, &bodies, &table.name)?;
        }
        let schemas = schemas.into_iter().cloned().collect();
        Ok(Small { entry, schemas, bodies })
    }
}

fn bytes_at(file: &File, at: u64, length: u32) -> Result<Vec<u8>, String> {
    let mut bytes = vec![0; length as usize];
    #[cfg(unix)]
    std::os::unix::fs::FileExt::read_exact_at(file, &mut bytes, at).map_err(|error| error.to_string())?;
    #[cfg(not(unix))]
    {
        // Clones share one position, so only under the lock that whoever calls holds.
        let mut file = file;
        file.seek(SeekFrom::Start(at)).and_then(|_| file.read_exact(&mut bytes)).map_err(|error| error.to_string())?;
    }
    Ok(bytes)
}
