//! What is kept on disk: content-addressed objects, Parquet, HDF5, the manifest, locks.
//!
//! Must not know: stages, the graph.

pub mod manifest;
