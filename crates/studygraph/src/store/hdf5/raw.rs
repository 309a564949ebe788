//! The few calls of libhdf5 that its safe wrapper lacks: the bytes of a file in memory, and a write with a small buffer.
//!
//! Every call is under the library's one lock. Must not know: tables.

#![expect(unsafe_code, reason = "the library is C, and these calls have no safe wrapper")]

use std::ffi::c_void;
use std::ops::Range;
use std::{ptr, slice};

use hdf5_metno::sync::sync;
use hdf5_metno::types::VarLenUnicode;
use hdf5_metno::{Dataset, Datatype, File};
use hdf5_metno_sys::h5::H5garbage_collect;
use hdf5_metno_sys::h5d::H5Dwrite;
use hdf5_metno_sys::h5f::{H5F_SCOPE_GLOBAL, H5Fflush, H5Fget_file_image, H5Fget_vfd_handle};
use hdf5_metno_sys::h5p::{H5P_CLS_DATASET_XFER, H5P_DEFAULT, H5Pclose, H5Pcreate, H5Pset_buffer};
use hdf5_metno_sys::h5s::H5S_ALL;

/// Bytes that a word of variable length has in a file: length, place, number.
const WORD: usize = 16;
/// What libhdf5 takes, and clears, for each write unless it is told otherwise.
const USUAL_BUFFER: usize = 1 << 20;

/// Where a file says which version its first block has, and where, by that, that somebody has it open (HDF5 File Format
/// Specification 3.0, II.A).
const VERSION: usize = 8;
const OPEN_BEFORE_2: Range<usize> = 20..24;
const OPEN_FROM_2: Range<usize> = 11..12;

/// Hands on the bytes that the file would have on a disk, all of it being written through: those that the library holds, since
/// a copy would be as large as the file.
pub fn image<T>(file: &File, take: impl FnOnce(&[u8]) -> T) -> hdf5_metno::Result<T> {
    let id = file.id();
    // SAFETY: `file` is open, and the library's lock is held until `take` has come back, so nothing moves or changes its bytes.
    // The driver that keeps a file in memory gives the place where it says where they are; once the file was written through
    // they are at least as many as the file has.
    sync(|| unsafe {
        if H5Fflush(id, H5F_SCOPE_GLOBAL) < 0 {
            return Err("the file in memory cannot be brought up to date".into());
        }
        // Of many small pieces the library keeps as much as the file takes.
        H5garbage_collect();
        let size = H5Fget_file_image(id, ptr::null_mut(), 0);
        let size = usize::try_from(size).map_err(|_| hdf5_metno::Error::from("the file in memory has no size"))?;
        let mut place: *mut c_void = ptr::null_mut();
        if H5Fget_vfd_handle(id, H5P_DEFAULT, &raw mut place) < 0 || place.is_null() {
            return Err("the file in memory cannot be found".into());
        }
        let bytes = *place.cast::<*mut u8>();
        if bytes.is_null() {
            return Err("the file in memory has no bytes".into());
        }
        let bytes = slice::from_raw_parts_mut(bytes, size);
        // As the library does in a copy, and on closing.
        let open = if bytes.get(VERSION).is_some_and(|version| *version < 2) { OPEN_BEFORE_2 } else { OPEN_FROM_2 };
        bytes.get_mut(open).unwrap_or_default().fill(0);
        Ok(take(bytes))
    })
}

/// Fills a dataset of words. The library clears two buffers of 1 MiB for every such write, however few the words are;
/// most columns have some dozen.
pub fn write_words(dataset: &Dataset, words: &[VarLenUnicode]) -> hdf5_metno::Result<()> {
    let kind = Datatype::from_type::<VarLenUnicode>()?;
    let failed = |what: &str| Err(format!("words cannot be written: {what}").into());
    // SAFETY: all three are open for as long as this takes, the dataset has as many elements as `words`, and a
    // `VarLenUnicode` is the pointer that a string of variable length is in memory.
    sync(|| unsafe {
        let transfer = H5Pcreate(*H5P_CLS_DATASET_XFER);
        if transfer < 0 {
            return failed("no property list");
        }
        let buffer = (words.len() * WORD).clamp(WORD, USUAL_BUFFER);
        let sized = H5Pset_buffer(transfer, buffer, ptr::null_mut(), ptr::null_mut());
        let written = if sized < 0 {
            sized
        } else {
            H5Dwrite(dataset.id(), kind.id(), H5S_ALL, H5S_ALL, transfer, words.as_ptr().cast())
        };
        let closed = H5Pclose(transfer);
        if written < 0 || closed < 0 { failed("libhdf5 refuses") } else { Ok(()) }
    })
}

#[cfg(test)]
mod tests {
    use hdf5_metno::FileBuilder;

    use super::*;

    /// The library's own copy is what a file that is closed would have.
    #[test]
    fn the_bytes_in_memory_are_those_that_the_library_copies() {
        let mut builder = FileBuilder::new();
        builder.access_plist().core_filebacked(false);
        let file = builder.create("the bytes in memory.h5").unwrap();
        for columns in [0_u32, 1, 300] {
            for column in 0..columns {
                let name = format!("{columns} {column}");
                file.new_dataset_builder().with_data(&[column; 200]).create(name.as_str()).unwrap();
            }
            let held = image(&file, <[u8]>::to_vec).unwrap();
            let mut copied = vec![1; held.len()];
            // SAFETY: the file is open, the buffer has as many bytes as are asked for.
            let size = sync(|| unsafe { H5Fget_file_image(file.id(), copied.as_mut_ptr().cast(), copied.len()) });
            assert_eq!(usize::try_from(size), Ok(held.len()));
            assert!(held == copied, "{columns} columns");
        }
    }
}
