//! What is kept on disk: the cache, Parquet, HDF5, CSV, the results folder with manifest and index, the facts of a run,
//! archives, the packs of shards.
//!
//! Must not know: stages, the graph.

pub mod archive;
pub mod bundle;
pub mod cache;
pub mod csv;
pub mod entry;
pub mod error;
pub mod facts;
pub mod file;
#[cfg(feature = "hdf5")]
pub mod hdf5;
pub(crate) mod hexadecimal;
pub mod index;
pub mod journal;
pub mod key_record;
pub mod lock;
pub mod manifest;
pub mod owner;
pub mod parquet;
pub mod results;
pub mod shards;
mod shared;
