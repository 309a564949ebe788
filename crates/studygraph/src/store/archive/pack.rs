//! Writing a zip file whose bytes depend on nothing but the names and contents of its entries.
//!
//! Entries are sorted, times are the first that the format can name, modes are fixed. The compressor is pure Rust and
//! uses no instruction that some processors lack. Must not know: what the entries are.

use std::collections::BTreeMap;
use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Entries by name.
pub type Entries = BTreeMap<String, Vec<u8>>;

/// # Errors
/// A sentence, when an entry is larger than the format can hold.
pub fn pack(entries: &Entries) -> Result<Vec<u8>, String> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        // Tables are compressed already.
        let stored = name.ends_with(".parquet");
        let method = if stored { CompressionMethod::Stored } else { CompressionMethod::Deflated };
        let options = SimpleFileOptions::default()
            .compression_method(method)
            .last_modified_time(DateTime::default())
            .unix_permissions(0o644)
            .large_file(bytes.len() >= u32::MAX as usize);
        writer.start_file(name.as_str(), options).map_err(|error| format!("`{name}`: {error}"))?;
        writer.write_all(bytes).map_err(|error| format!("`{name}`: {error}"))?;
    }
    writer.finish().map(Cursor::into_inner).map_err(|error| error.to_string())
}
