//! One study, one set of contents: whatever the number of threads and whatever the processor can do; and keys that change
//! only when they are meant to.

#[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
mod emulated;
#[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
mod processor;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use crate::support::with_code;
use gearstudy::program;
use studygraph::runner::events::Silent;
use studygraph::runner::execute::execute;
use studygraph::runner::options::Options;
use studygraph::runner::outcome::Outcome;
use studygraph::store::cache::Cache;
use studygraph::store::manifest::Short;
use studygraph::study::Study;

fn quick() -> Study {
    program::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("studies/quick.yaml")).unwrap()
}

fn run(study: &Study, options: &Options) -> Outcome {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::open(folder.path()).unwrap();
    let outcome = execute(study, &cache, options, &Silent, &AtomicBool::new(false)).unwrap();
    assert_eq!(outcome.faults().count(), 0);
    outcome
}

fn contents(outcome: &Outcome) -> BTreeMap<String, String> {
    let tables = outcome.stages.iter().flat_map(|stage| {
        stage
            .tables
            .iter()
            .map(|(schema, table)| (format!("{}.{}", stage.name, schema.name), table.content.to_string()))
    });
    tables.collect()
}

#[test]
fn any_number_of_threads_gives_the_same_contents() {
    let study = quick();
    let with = |jobs| contents(&run(&study, &Options { jobs, ..Options::default() }));
    let one = with(1);
    assert!(one.len() >= 20, "{}", one.len());
    for jobs in [2, 3, 8] {
        assert_eq!(one, with(jobs), "{jobs} threads");
    }
}

/// The seed reaches what draws random numbers, and what reads that; nothing else.
#[test]
fn another_seed_changes_only_what_draws_from_it() {
    let (first, mut other) = (quick(), quick());
    other.seed += 1;
    let (first, other) = (run(&first, &Options::default()), run(&other, &Options::default()));
    let (first, other) = (contents(&first), contents(&other));
    let changed: Vec<_> =
        first.iter().filter(|(name, content)| other[*name] != **content).map(|(name, _)| name).collect();
    let drawn = |name: &str| ["optimum.", "ste.", "report."].iter().any(|stage| name.starts_with(stage));
    assert!(changed.contains(&&"optimum.history".to_owned()), "{changed:?}");
    assert!(changed.iter().all(|name| drawn(name)), "{changed:?}");
}

/// If this fails, the caches of everybody who runs the quick study are void. When that is meant (a field or a default
/// was added, a demand has changed), put the new digests here; when it is not, something has got into a key that should
/// not be there. What comes in through ports is left out: those digests are results, and change with the kernels.
#[test]
fn golden_parts_of_keys_of_the_quick_study() {
    let outcome = run(&with_code(quick(), |_| "code".to_owned()), &Options::default());
    let mut found = Vec::new();
    for stage in &outcome.stages {
        let record = &stage.keys[0];
        let short = |part: Option<Short>| part.map_or_else(String::new, |part| part.to_string()[..8].to_owned());
        let (code, config, demand) = (Some(record.code), Some(record.config), Some(record.demand));
        let parts = [code, config, record.axis, record.seed, demand].map(short).join(" ");
        let ports: Vec<_> = record.inputs.iter().map(|(port, _)| port.as_str()).collect();
        found.push(format!("{} {} {parts} {}", stage.name, stage.keys.len(), ports.join(",")));
    }
    let golden = [
        "pair 1 2e8baee4 e5325153   57866b65 ",
        "stiffness 1 356aea1e 1131e36c   962a9226 pair",
        "designs 1 22814846 ab93967f   6f955979 pair",
        "optimum 1 1b8876b5 ad7a9180  d2243232 4866e557 pair,stiffness",
        "ste 5 c46fabaa 56a9f616 8dec8e6f  2221bda4 pair,stiffness,designs_1,designs_2",
        "report 1 aa3bad51 778fee4b   9385dcdd ste,stiffness",
    ];
    assert_eq!(found, golden, "\n{}", found.join("\n"));
    // A stage that reads nothing has a key without results in it.
    assert_eq!(outcome.stage("pair").unwrap().keys[0].key.short(), "34da62f5f404");
}
