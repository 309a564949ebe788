//! What a site wants of jobs: a YAML file of declared fields.
//!
//! Must not know: how jobs are started.

use std::path::Path;

use super::super::Ending;
use declare::parameter::{Field, Shape};
use declare::record::{Record, Value};
use studygraph::study::profile;

static WORD: Shape = Shape::Text;

const PROGRAM: Field =
    Field::new("program", Shape::Text, "The program on the machines that compute, where it lies elsewhere.").optional();
const PROCESSORS: Field = Field::integer("processors", 1, 256, "Processors of one shard.").default("1");
const ATTEMPTS: Field =
    Field::integer("attempts", 1, 100, "How often a shard is started that leaves nothing.").default("3");
const ASK_EVERY: Field =
    Field::integer("ask_every", 1, 3600, "Seconds between two questions to the engine; files are seen at once.")
        .default("30");

const PATIENCE: Field = Field::integer(
    "patience",
    0,
    86_400,
    "Seconds for which an engine that does not answer, or refuses for the moment, is asked again.",
)
.default("600");

const ANSWER_TIME: Field = Field::integer(
    "answer_time",
    1,
    3600,
    "Seconds after which a command of the engine that does not end is given up, and counts as not answered.",
)
.default("120");

pub(super) static SLURM: &[Field] = &[
    PROGRAM,
    Field::new("partition", Shape::Text, "Partition of the jobs.").optional(),
    Field::new("account", Shape::Text, "Account that pays.").optional(),
    Field::new("time", Shape::Text, "Most time of a shard, as Slurm has it: `00:30:00`.").optional(),
    Field::new("memory", Shape::Text, "Memory of a shard, as Slurm has it: `2G`.").optional(),
    PROCESSORS,
    Field::integer("at_once", 1, 1_000_000, "The most shards that run at the same time.").optional(),
    Field::integer(
        "array_size",
        2,
        10_000_000,
        "The most elements of an array, where the site's answer is not to be trusted.",
    )
    .optional(),
    Field::new("options", Shape::List(&WORD), "More options of sbatch.").default("[]"),
    Field::new("before", Shape::Text, "A line of the shell before each shard, such as `module load hdf5`.").optional(),
    ATTEMPTS,
    ASK_EVERY,
    PATIENCE,
    ANSWER_TIME,
];

pub(super) static PARALLEL: &[Field] = &[
    PROGRAM,
    Field::integer("slots", 1, 100_000, "Shards at the same time on each host; without it one per processor.")
        .optional(),
    Field::new(
        "hosts",
        Shape::List(&WORD),
        "Hosts that ssh reaches and that see the folder, as GNU Parallel has them.",
    )
    .default("[]"),
    PROCESSORS,
    ATTEMPTS,
    ASK_EVERY,
];

/// Reads a profile; without one all is as by default.
pub(super) fn read(path: Option<&Path>, fields: &'static [Field]) -> Result<Record, Ending> {
    let read = match path {
        Some(path) => profile::record(path, fields, "the profile"),
        None => profile::record_text("{}", Path::new("--profile"), fields, "the profile"),
    };
    read.map_err(|error| Ending::Invalid(Box::new(error)))
}

/// Words of a list.
pub(super) fn words(profile: &Record, name: &str) -> Vec<String> {
    let word = |value: &Value| if let Value::Text(word) = value { Some(word.clone()) } else { None };
    profile.list(name).iter().filter_map(|entry| word(&entry.value)).collect()
}

/// A whole number that is not negative.
pub(super) fn number(profile: &Record, name: &str) -> usize {
    usize::try_from(profile.integer(name)).unwrap_or(1)
}

pub(super) fn maybe_number(profile: &Record, name: &str) -> Option<usize> {
    profile.maybe_integer(name).and_then(|number| usize::try_from(number).ok())
}

pub(super) fn attempts(profile: &Record) -> usize {
    number(profile, "attempts")
}
