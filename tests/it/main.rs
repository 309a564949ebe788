//! All integration tests, in one binary: one link instead of a dozen.

#![allow(clippy::disallowed_methods, reason = "a test fails where it cannot read a file or start a thread")]
#![allow(clippy::float_cmp, reason = "tests say where a value must be met exactly")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the numbers are the tests' own")]

mod accuracy;
mod archive;
mod bad;
mod calculix;
mod desk;
mod determinism;
mod documented;
mod e2e;
mod estimates;
mod export;
mod extremes;
mod fit;
mod fronts;
mod fuzz;
mod hints;
mod hunting;
mod inspection;
mod layering;
mod limit;
mod neglected_corners;
mod numbers;
mod page;
mod pressure;
mod properties;
mod python;
mod query;
mod rating;
mod recall;
mod reference;
mod registry;
mod reliability;
mod report;
mod results;
mod rexs;
mod root_stress;
mod rounded;
mod scatter;
mod schema;
mod settings;
mod shards;
mod sizing;
mod support;
mod sweep;
mod traces;

// What `estimates` shares with the kernels' own tests names it as they do.
use gearmesh::gear;
