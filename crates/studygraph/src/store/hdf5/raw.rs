//! The few calls of libhdf5 that its safe wrapper lacks: the bytes of a file in memory, and a write with a small buffer.
//!
//! Every call is under the library's one lock. Must not know: tables.

#![expect(unsafe_code, reason = "the library is C, and these calls have no safe wrapper")]

use std::ptr;

use hdf5_metno::sync::sync;
use hdf5_metno::types::VarLenUnicode;
use hdf5_metno::{Dataset, Datatype, File};
use hdf5_metno_sys::h5::H5garbage_collect;
use hdf5_metno_sys::h5d::H5Dwrite;
use hdf5_metno_sys::h5f::{H5F_SCOPE_GLOBAL, H5Fflush, H5Fget_file_image};
use hdf5_metno_sys::h5p::{H5P_CLS_DATASET_XFER, H5Pclose, H5Pcreate, H5Pset_buffer};
use hdf5_metno_sys::h5s::H5S_ALL;

/// Bytes that a word of variable length has in a file: length, place, number.
const WORD: usize = 16;
/// What libhdf5 takes, and clears, for each write unless it is told otherwise.
const USUAL_BUFFER: usize = 1 << 20;

/// The bytes that the file would have on a disk, all of it being written through.
pub fn image(file: &File) -> hdf5_metno::Result<Vec<u8>> {
    let id = file.id();
    // SAFETY: `file` is open; the first call asks for the size alone, the second has a buffer of that size.
    sync(|| unsafe {
        if H5Fflush(id, H5F_SCOPE_GLOBAL) < 0 {
            return Err("the file in memory cannot be brought up to date".into());
        }
        // Of many small pieces the library keeps as much as the file takes.
        H5garbage_collect();
        let size = H5Fget_file_image(id, ptr::null_mut(), 0);
        let size = usize::try_from(size).map_err(|_| hdf5_metno::Error::from("the file in memory has no size"))?;
        let mut bytes = vec![0_u8; size];
        if usize::try_from(H5Fget_file_image(id, bytes.as_mut_ptr().cast(), size)).is_ok_and(|read| read == size) {
            Ok(bytes)
        } else {
            Err("the file in memory cannot be read".into())
        }
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
