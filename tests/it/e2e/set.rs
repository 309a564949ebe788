//! `--set` and `--name` with every command that reads a study, and what a shell loop makes of them.

use std::fs;

use crate::desk::Desk;

const WIDER: &str = "pair.pinion.face_width=22 mm";

#[test]
fn what_is_set_is_run_under_a_name_of_its_own_and_shares_what_is_the_same() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml"], 0);
    let plain = fs::read(desk.path("results/quick/manifest.json")).unwrap();
    let (out, _) = desk.run(&["plan", "quick.yaml", "--set", "ste.torque=[50 N m, 150 N m]"], 0);
    assert!(out.contains("quick-"), "{out}");
    desk.run(&["run", "quick.yaml", "--set", "ste.torque=[50 N m, 150 N m]", "--name", "two"], 0);
    assert!(
        desk.ran("two").iter().all(|stage| stage != "pair" && stage != "stiffness"),
        "what is the same is not computed again"
    );
    assert_eq!(fs::read(desk.path("results/quick/manifest.json")).unwrap(), plain, "no other results are touched");
    let arguments = ["--set", "ste.torque=[50 N m, 150 N m]", "--name", "two"];
    let with = |words: &[&'static str]| words.iter().copied().chain(arguments).collect::<Vec<_>>();
    let (csv, _) =
        desk.run(&with(&["table", "quick.yaml", "ste.summary", "--columns", "torque", "--format", "csv"]), 0);
    let torques: std::collections::BTreeSet<&str> = csv.lines().skip(1).collect();
    assert_eq!(torques.into_iter().collect::<Vec<_>>(), ["150", "50"], "{csv}");
    let (out, _) = desk.run(&with(&["status", "quick.yaml"]), 0);
    assert!(out.contains("up to date"), "{out}");
    desk.run(&with(&["check", "quick.yaml"]), 0);
    desk.run(&with(&["report", "quick.yaml"]), 0);
    // An archive holds what was set, and is verified without being told.
    desk.run(&with(&["archive", "quick.yaml", "-o", "two.zip"]), 0);
    let (out, _) = desk.run(&["verify", "two.zip"], 0);
    assert!(out.contains(" 0 different"), "{out}");
}

/// As a loop of a shell over values: as many results, and the one that is what the file says is equal to it.
#[test]
fn a_loop_gives_one_folder_for_each_value() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--only", "ste"], 0);
    for width in ["20 mm", "22 mm", "24 mm"] {
        desk.run(
            &["run", "quick.yaml", "--only", "ste", "--quiet", "--set", &format!("pair.pinion.face_width={width}")],
            0,
        );
    }
    let mut names: Vec<String> = fs::read_dir(desk.path("results"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names.retain(|name| name.starts_with("quick"));
    assert_eq!(names.len(), 4, "{names:?}");
    let contents: Vec<_> = names.iter().map(|name| desk.contents(name)).collect();
    assert_eq!(contents.iter().filter(|content| **content == contents[0]).count(), 2, "20 mm is what the file says");
}

#[test]
fn slips_are_told_at_the_option() {
    let desk = Desk::with("quick.yaml");
    for (command, code) in [("check", 2), ("plan", 2), ("run", 2), ("report", 2), ("table", 2)] {
        let (_, error) = desk.run(&[command, "quick.yaml", "--set", "pair.pinion.face_widht=22 mm"], code);
        let expected = "--set pair.pinion.face_widht=22 mm:1:13: unknown field `face_widht` of `pinion`\n  help: did you mean `face_width`?";
        assert!(error.contains(expected), "{command}: {error}");
    }
    let (_, error) = desk.run(&["run", "quick.yaml", "--set", WIDER, "--name", "quick/../x"], 2);
    assert!(error.contains("cannot be the name of a study"), "{error}");
    fs::copy(desk.path("quick.yaml"), desk.path("other.yaml")).unwrap();
    let (_, error) = desk.run(&["plan", "quick.yaml", "other.yaml", "--set", WIDER, "--name", "both"], 1);
    assert!(error.contains("are both called `both`"), "{error}");
}

#[test]
fn templates_are_named() {
    let desk = Desk::with("quick.yaml");
    desk.run(&["new", "mine.yaml", "--template", "quick"], 0);
    desk.run(&["new", "swept.yaml", "--template", "sweep"], 0);
    assert!(desk.run(&["check", "swept.yaml"], 0).0.contains("`swept` is valid"));
    desk.run(&["check", "mine.yaml"], 0);
    let (_, error) = desk.run(&["new", "other.yaml", "--template", "quik"], 1);
    assert!(error.contains("there is no template `quik`; did you mean `quick`?"), "{error}");
}
