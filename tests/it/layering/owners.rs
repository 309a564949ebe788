//! Which libraries are named in which files alone.

/// A crate and the only files or folders that may name it.
pub const OWNERS: &[(&str, &[&str])] = &[
    ("petgraph", &["crates/studygraph/src/runner/graph.rs"]),
    ("faer", &["crates/cholesky/src/"]),
    ("minijinja", &["src/report/", "crates/studygraph/src/diff/"]),
    ("parquet", &["crates/studygraph/src/store/"]),
    ("hdf5_metno", &["crates/studygraph/src/store/hdf5"]),
    ("hdf5_metno_sys", &["crates/studygraph/src/store/hdf5/raw.rs"]),
    ("roxmltree", &["src/rexs"]),
    ("serde_saphyr", &["crates/studygraph/src/study/"]),
    ("clap", &["src/cli/"]),
    ("clap_complete", &["src/cli/complete.rs"]),
    ("clap_mangen", &["src/cli/help.rs"]),
    ("rusqlite", &["src/query/database.rs"]),
    ("sqlparser", &["src/query/names.rs", "src/query/kinds.rs"]),
    ("signal_hook", &["src/cli/"]),
    ("sha2", &["crates/studygraph/src/store/archive.rs"]),
    ("spdx", &["src/cli/rights.rs"]),
    ("miette", &["src/cli/"]),
    ("lsp_server", &["src/cli/lsp.rs", "src/cli/lsp/"]),
    ("notify", &["src/cli/watch.rs"]),
    ("httparse", &["src/cli/serve.rs"]),
];
