//! The words of runs in pieces. Must not know: what any of them does.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use super::{Changes, Limits, Output};

/// Who computes, if not this process.
#[derive(Args, Debug, Clone, Default)]
pub struct Elsewhere {
    /// Run in pieces by Slurm or by GNU Parallel, and merge them.
    #[arg(long, value_enum, value_name = "ENGINE", conflicts_with_all = ["force", "explain", "keep_going"])]
    pub engine: Option<Engine>,
    /// At most so many pieces [default: 64].
    #[arg(long, value_name = "N", requires = "engine", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub shards: Option<u32>,
    /// Folder for the plan and what the pieces leave; every machine must see it [default: one below .gearstudy/shards].
    #[arg(long, value_name = "DIR", requires = "engine")]
    pub into: Option<PathBuf>,
    /// YAML file with what the site wants: partition, account, time, hosts …
    #[arg(long, value_name = "FILE", requires = "engine")]
    pub profile: Option<PathBuf>,
    /// Only submit: pieces and merge are jobs that wait for each other.
    #[arg(long, requires = "engine")]
    pub detach: bool,
}

#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    Slurm,
    Parallel,
}

#[derive(Subcommand, Debug)]
pub enum Sharding {
    /// Divide a study up: writes DIR/plan.json.
    Plan {
        study: PathBuf,
        #[command(flatten)]
        changes: Changes,
        /// Only these stages, and what they need.
        #[arg(long, value_name = "STAGE,…", value_delimiter = ',')]
        only: Vec<String>,
        /// Also what is computed on demand only: tables (`stage.table`) and columns (`stage.table.column`).
        #[arg(long, value_name = "TABLE,…", value_delimiter = ',')]
        want: Vec<String>,
        /// At most so many pieces.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
        shards: u32,
        /// Folder for the plan and what the pieces leave; every machine must see it.
        #[arg(long, value_name = "DIR")]
        into: PathBuf,
        /// Also write DIR/job.yaml: indexed Kubernetes jobs with this image.
        #[arg(long, value_name = "IMAGE")]
        manifest: Option<String>,
        #[command(flatten)]
        output: Output,
    },
    /// Compute one piece: leaves DIR/shards/I.pack.
    Run {
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        #[arg(value_name = "I")]
        shard: usize,
        #[command(flatten)]
        limits: Limits,
        /// How many threads to use [default: one per processor].
        #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
        jobs: Option<u16>,
        #[command(flatten)]
        output: Output,
    },
    /// Say which pieces are there.
    Status {
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        /// Read every byte of them; what is damaged ends with code 4.
        #[arg(long)]
        check: bool,
        /// Only the numbers of those that are not there, one a line.
        #[arg(long, conflicts_with_all = ["json", "format"])]
        missing: bool,
        #[command(flatten)]
        output: Output,
    },
    /// Take all pieces into the cache, compute what is left, and write results as a run does.
    Merge {
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        #[command(flatten)]
        limits: Limits,
        /// How many threads to use [default: one per processor].
        #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
        jobs: Option<u16>,
        #[command(flatten)]
        output: Output,
    },
}
