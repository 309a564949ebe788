//! Warnings that are told whenever the same study is run, whether its tables are computed, up to date, or only noted to be.

use std::fs;

use crate::desk::Desk;

/// Tier: invariant; a run that has nothing to do repeats the warnings of the one that computed.
#[test]
fn every_run_of_a_study_has_the_same_warnings() {
    let desk = Desk::with("quick.yaml");
    let file = desk.path("quick.yaml");
    let text = fs::read_to_string(&file).unwrap();
    let other = "  other: { kind: modification, pair: pair, designs: { deep: [tip_relief: { gear: both, amount: 20 um ± 3 um, \
                 fraction: 0.5, curve: linear }] } }\n";
    fs::write(&file, text.replacen("  optimum:\n", &format!("{other}  optimum:\n"), 1)).unwrap();
    let of = |words: &[&str]| {
        let (out, error) = desk.run(words, 0);
        for part in ["an interval is an input that was printed rounded", "`scatter`", "half root angles"] {
            assert!(format!("{out}{error}").contains(part), "{words:?} lacks {part}: {out}{error}");
        }
        let mut warnings: Vec<String> = out
            .lines()
            .chain(error.lines())
            .filter(|line| line.contains("warning"))
            .map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "))
            .collect();
        warnings.sort_unstable();
        warnings
    };
    let first = of(&["run", "quick.yaml"]);
    // The second run finds that all is up to date, and the next ones find its note.
    for time in 2..=4 {
        assert_eq!(of(&["run", "quick.yaml"]), first, "run {time}");
    }
    // A stage whose text changed does not hide the warnings of those that are not read again.
    let text = fs::read_to_string(&file).unwrap();
    let changed = text.replacen("kind: report", "kind: report # changed", 1);
    assert_ne!(changed, text);
    fs::write(&file, changed).unwrap();
    assert_eq!(of(&["run", "quick.yaml"]), first, "after a change");
    // Without the interval the run reads only what changed, and still has the warnings of the stages.
    let plain = fs::read_to_string(&file).unwrap().replace(" ± 3 um", "");
    fs::write(&file, &plain).unwrap();
    desk.run(&["run", "quick.yaml"], 0);
    fs::write(&file, plain.replacen("# changed", "# changed again", 1)).unwrap();
    let (out, error) = desk.run(&["run", "quick.yaml"], 0);
    assert!(format!("{out}{error}").contains("half root angles"), "{out}{error}");
}
