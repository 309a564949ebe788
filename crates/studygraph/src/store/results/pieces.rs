//! Writing a Parquet file whose table comes in pieces: neither the table nor the file is ever in memory.
//!
//! Must not know: where the pieces come from.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::{Folder, Pieces};
use crate::store::error::StoreError;
use crate::store::file::{self, Durability};
use crate::store::index::{Seen, Stamp};
use crate::store::parquet::Stream;

/// Bytes that are handed to the system at once.
const BUFFER: usize = 1 << 18;

/// A file that knows the digest of what went into it, and why it took no more.
struct Sink<'f> {
    file: BufWriter<&'f mut File>,
    hasher: blake3::Hasher,
    bytes: u64,
    fault: Option<io::Error>,
}

impl Sink<'_> {
    /// The Parquet library tells no more of an error than its words.
    fn told<T>(&mut self, done: io::Result<T>) -> io::Result<T> {
        done.map_err(|error| {
            let same = error.raw_os_error().map_or_else(|| error.kind().into(), io::Error::from_raw_os_error);
            self.fault.get_or_insert(error);
            same
        })
    }
}

impl Write for Sink<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes);
        let written = self.told(written)?;
        self.hasher.update(&bytes[..written]);
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.file.flush();
        self.told(flushed)
    }
}

impl Folder {
    /// Writes the file of a table piece by piece.
    pub(super) fn put_pieces(&self, name: &str, pieces: Pieces<'_>) -> Result<Seen, StoreError> {
        let path = self.path().join(name);
        let (bytes, digest) = file::write_by(&path, Durability::Lazy, |file| {
            let file = BufWriter::with_capacity(BUFFER, file);
            let mut sink = Sink { file, hasher: blake3::Hasher::new(), bytes: 0, fault: None };
            let done = put(pieces, &mut sink);
            match (done, sink.fault.take()) {
                (Err(_), Some(fault)) => Err(StoreError::io("write", &path)(fault)),
                (done, _) => done.map(|()| (sink.bytes, sink.hasher.finalize().to_string())),
            }
        })?;
        let metadata = fs::metadata(&path).map_err(StoreError::io("read", &path))?;
        Ok(Seen { file: name.to_owned(), bytes, digest, stamp: Some(Stamp::of(&metadata)) })
    }
}

fn put(pieces: Pieces<'_>, sink: &mut Sink<'_>) -> Result<(), StoreError> {
    let mut stream: Option<Stream<&mut Sink<'_>>> = None;
    let mut free = Some(&mut *sink);
    for piece in pieces {
        let piece = piece?;
        if let Some(sink) = free.take() {
            stream = Some(Stream::new(sink, piece.shared_schema())?);
        }
        if let Some(stream) = &mut stream {
            stream.add(&piece)?;
        }
    }
    stream.map_or(Ok(()), Stream::finish)?;
    sink.flush().map_err(StoreError::io("write", Path::new("")))
}
