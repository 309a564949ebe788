//! Which study a name means, and whose results a run may replace.

use std::fs;

use crate::desk::Desk;

/// The text of a study that no other test has, by another name and with another relief.
fn study(desk: &Desk, name: &str, amount: &str) -> String {
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let other = text.replace("study: quick", &format!("study: {name}")).replace("amount: 12 um", amount);
    assert!(other.contains(&format!("study: {name}\n")), "{other}");
    other
}

fn peak_to_peak(desk: &Desk, words: &[&str]) -> String {
    let words = [words, &["--format", "csv"]].concat();
    desk.run(&words, 0).0.lines().last().unwrap().to_owned()
}

/// Files and studies with each other's names: table, query and archive mean the same study.
#[test]
fn a_studys_own_name_decides() {
    let desk = Desk::with("quick.yaml");
    fs::create_dir(desk.path("studies")).unwrap();
    fs::write(desk.path("studies/q.yaml"), study(&desk, "other", "amount: 20 um")).unwrap();
    fs::write(desk.path("studies/other.yaml"), study(&desk, "q", "amount: 12 um")).unwrap();
    let (out, _) = desk.run(&["run", "q"], 0);
    assert!(out.contains("\nq: ") && desk.path("results/q").exists() && !desk.path("results/other").exists(), "{out}");
    desk.run(&["run", "--quiet", "studies/q.yaml"], 0);
    let table = peak_to_peak(&desk, &["table", "q", "ste.summary", "--columns", "peak_to_peak"]);
    let query = peak_to_peak(&desk, &["query", "select peak_to_peak from q.ste.summary"]);
    assert_eq!(table, query);
    assert!(desk.run(&["archive", "q", "-o", "a.zip"], 0).0.starts_with("q: "));
    assert_eq!(desk.run(&["status", "q"], 0).0, "q: up to date\n");
    // A file whose study has another name is still found by its own, where no study has it.
    fs::rename(desk.path("studies/q.yaml"), desk.path("studies/file.yaml")).unwrap();
    assert_eq!(desk.run(&["status", "file"], 0).0, "other: up to date\n");
}

#[test]
fn two_files_with_one_name_are_refused_by_whatever_takes_a_name_or_publishes() {
    let desk = Desk::with("quick.yaml");
    fs::create_dir(desk.path("studies")).unwrap();
    fs::write(desk.path("studies/a.yaml"), study(&desk, "q", "amount: 12 um")).unwrap();
    fs::write(desk.path("studies/b.yaml"), study(&desk, "q", "amount: 20 um")).unwrap();
    for words in [
        &["run", "q"][..],
        &["run", "studies/a.yaml"],
        &["run", "studies/a.yaml", "--dry-run"],
        &["plan", "studies/b.yaml"],
        &["table", "q"],
        &["archive", "q", "-o", "a.zip"],
        &["report", "q"],
        &["watch", "q"],
        &["status", "q"],
        &["shard", "plan", "studies/a.yaml", "--shards", "2", "--into", "plan"],
    ] {
        let (_, error) = desk.run(words, 1);
        let both = error.contains("studies/a.yaml") && error.contains("studies/b.yaml");
        assert!(both && error.contains("`q`") && error.contains("--name"), "{words:?}: {error}");
    }
    assert!(!desk.path("results").exists());
    // The remedies.
    desk.run(&["run", "--quiet", "studies/b.yaml", "--name", "b"], 0);
    fs::write(desk.path("studies/b.yaml"), study(&desk, "b", "amount: 20 um")).unwrap();
    desk.run(&["run", "--quiet", "q"], 0);
}

/// A copy whose name was not changed: the earlier results stay.
#[test]
fn results_of_another_file_are_not_replaced() {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("a.yaml"), study(&desk, "q", "amount: 12 um")).unwrap();
    fs::write(desk.path("b.yaml"), study(&desk, "q", "amount: 20 um")).unwrap();
    desk.run(&["run", "--quiet", "a.yaml"], 0);
    let before = desk.contents("q");
    assert_eq!(desk.manifest("q")["study_folder"]["file"], "../../a.yaml");
    for words in [&["run", "b.yaml"][..], &["plan", "b.yaml"], &["run", "b.yaml", "--dry-run"]] {
        let (_, error) = desk.run(words, 1);
        assert!(error.contains("a.yaml") && error.contains("b.yaml") && error.contains("--name"), "{words:?}: {error}");
    }
    assert_eq!(desk.contents("q"), before);
    desk.run(&["run", "--quiet", "b.yaml", "--name", "other"], 0);
    // The same file by other paths, and a copy that is the same study.
    desk.run(&["run", "./a.yaml"], 0);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("a.yaml", desk.path("link.yaml")).unwrap();
        desk.run(&["run", "link.yaml"], 0);
    }
    fs::copy(desk.path("a.yaml"), desk.path("copy.yaml")).unwrap();
    desk.run(&["run", "copy.yaml"], 0);
    // A study that has moved, and one whose file has become another study.
    fs::rename(desk.path("a.yaml"), desk.path("moved.yaml")).unwrap();
    fs::write(desk.path("moved.yaml"), study(&desk, "q", "amount: 13 um")).unwrap();
    desk.run(&["run", "--quiet", "moved.yaml"], 0);
    fs::write(desk.path("moved.yaml"), study(&desk, "r", "amount: 13 um")).unwrap();
    desk.run(&["run", "--quiet", "b.yaml"], 0);
}

/// A study that was moved without a change keeps its results, whatever study is put in its old place.
#[test]
fn a_moved_study_keeps_its_results() {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("a.yaml"), study(&desk, "q", "amount: 12 um")).unwrap();
    desk.run(&["run", "--quiet", "a.yaml"], 0);
    // A copy is the same study; the first file stays the recorded one.
    fs::copy(desk.path("a.yaml"), desk.path("copy.yaml")).unwrap();
    desk.run(&["run", "copy.yaml"], 0);
    assert_eq!(desk.manifest("q")["study_folder"]["file"], "../../a.yaml");
    // As soon as the copy differs it is another study.
    fs::write(desk.path("copy.yaml"), study(&desk, "q", "amount: 20 um")).unwrap();
    let (_, error) = desk.run(&["run", "copy.yaml"], 1);
    assert!(error.contains("are those of a.yaml"), "{error}");

    let before = desk.manifest("q");
    fs::rename(desk.path("a.yaml"), desk.path("moved.yaml")).unwrap();
    let (said, _) = desk.run(&["run", "moved.yaml"], 0);
    assert!(said.contains("nothing to do"), "{said}");
    let after = desk.manifest("q");
    assert_eq!(after["study_folder"]["file"], "../../moved.yaml");
    for field in ["written", "seconds", "program", "stages"] {
        assert_eq!(after[field], before[field], "{field}");
    }
    let text = fs::read(desk.path("results/q/manifest.json")).unwrap();
    desk.run(&["run", "moved.yaml"], 0);
    assert_eq!(fs::read(desk.path("results/q/manifest.json")).unwrap(), text);
    desk.run(&["status", "moved.yaml", "--check"], 0);
    fs::write(desk.path("a.yaml"), study(&desk, "q", "amount: 13 um")).unwrap();
    let (_, error) = desk.run(&["run", "a.yaml"], 1);
    assert!(error.contains("are those of moved.yaml"), "{error}");
}

/// A copy that ran, and of which the next run reads the changed stages only.
#[test]
fn a_changed_part_of_a_copy_does_not_replace_the_results() {
    let desk = Desk::with("quick.yaml");
    let pair = |number: u32, teeth: u32| {
        format!(
            "  p{number}: {{ kind: geometry, module: 2 mm, pressure_angle: 20 deg, pinion: {{ teeth: {teeth}, face_width: \
             20 mm, bore_radius: 8 mm }}, gear: {{ teeth: 30, face_width: 20 mm, bore_radius: 8 mm }}, material: {{ \
             youngs_modulus: 206 GPa, poisson_ratio: 0.3 }} }}\n"
        )
    };
    let text = |teeth: u32| {
        let others: String = (2..9).map(|number| pair(number, 25)).collect();
        format!("study: q\nseed: 1\n\nstages:\n{}{others}", pair(1, teeth))
    };
    fs::write(desk.path("a.yaml"), text(24)).unwrap();
    fs::write(desk.path("copy.yaml"), text(24)).unwrap();
    desk.run(&["run", "--quiet", "a.yaml"], 0);
    desk.run(&["run", "--quiet", "copy.yaml"], 0);
    let before = desk.contents("q");
    // Stamps of this moment are not trusted.
    std::thread::sleep(std::time::Duration::from_millis(50));
    fs::write(desk.path("copy.yaml"), text(26)).unwrap();
    let (_, error) = desk.run(&["run", "copy.yaml"], 1);
    assert!(error.contains("are those of a.yaml"), "{error}");
    assert_eq!(desk.contents("q"), before);
}

/// Two studies that are given the same name on the command line are two studies.
#[test]
fn names_given_to_runs_do_not_make_two_studies_one() {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("a.yaml"), study(&desk, "a", "amount: 12 um")).unwrap();
    fs::write(desk.path("b.yaml"), study(&desk, "b", "amount: 20 um")).unwrap();
    fs::write(desk.path("x.yaml"), study(&desk, "x", "amount: 21 um")).unwrap();
    desk.run(&["run", "--quiet", "a.yaml", "--name", "x"], 0);
    let before = desk.contents("x");
    for words in [
        &["run", "b.yaml", "--name", "x"][..],
        &["plan", "b.yaml", "--name", "x"],
        &["run", "x.yaml"],
        &["run", "--dry-run", "x.yaml"],
    ] {
        let (_, error) = desk.run(words, 1);
        assert!(error.contains("are those of a.yaml") && error.contains("--name"), "{words:?}: {error}");
    }
    assert_eq!(desk.contents("x"), before);
    // The same study, with other values.
    desk.run(&["run", "--quiet", "a.yaml", "--name", "x", "--set", "seed=2"], 0);
    // Once it has another name, or is gone, its results are those of no study.
    fs::write(desk.path("a.yaml"), study(&desk, "c", "amount: 12 um")).unwrap();
    desk.run(&["run", "--quiet", "b.yaml", "--name", "x"], 0);
    fs::remove_file(desk.path("b.yaml")).unwrap();
    desk.run(&["run", "--quiet", "x.yaml"], 0);
}

/// A file in the current folder does not hide the study that its word names.
#[test]
fn a_file_without_ending_does_not_hide_a_study() {
    let desk = Desk::with("quick.yaml");
    fs::create_dir(desk.path("studies")).unwrap();
    fs::write(desk.path("studies/a.yaml"), study(&desk, "q", "amount: 12 um")).unwrap();
    fs::write(desk.path("q"), "notes\n").unwrap();
    desk.run(&["run", "--quiet", "q"], 0);
    assert_eq!(desk.run(&["status", "q"], 0).0, "q: up to date\n");
    // A path means the file.
    assert!(desk.run(&["check", "./q"], 2).1.contains("./q"));
    // Two studies of one name are a clash in this form too; a link to the same one is none.
    fs::write(desk.path("q"), study(&desk, "q", "amount: 20 um")).unwrap();
    let (_, error) = desk.run(&["run", "q"], 1);
    assert!(error.contains("studies/a.yaml and q are both called `q`"), "{error}");
    // A file whose name no study has is the file.
    fs::write(desk.path("r"), study(&desk, "other", "amount: 20 um")).unwrap();
    assert!(desk.run(&["status", "r"], 0).0.starts_with("other: no results"));
}

#[cfg(unix)]
#[test]
fn a_link_to_a_study_is_the_same_study() {
    let desk = Desk::with("quick.yaml");
    fs::create_dir(desk.path("studies")).unwrap();
    fs::write(desk.path("studies/m.yaml"), study(&desk, "q", "amount: 12 um")).unwrap();
    std::os::unix::fs::symlink("m.yaml", desk.path("studies/lnk.yaml")).unwrap();
    fs::hard_link(desk.path("studies/m.yaml"), desk.path("studies/hard.yaml")).unwrap();
    desk.run(&["run", "--quiet", "q"], 0);
    for words in [&["run", "lnk"][..], &["run", "hard"], &["run", "m", "lnk", "hard", "m"], &["plan", "q", "lnk"]] {
        desk.run(words, 0);
    }
    // Once, whatever the word.
    for words in [&["status"][..], &["status", "q"], &["status", "lnk", "m", "hard"]] {
        assert_eq!(desk.run(words, 0).0, "q: up to date\n", "{words:?}");
    }
    let named = desk.run(&["check", "lnk", "m"], 0);
    assert_eq!((named.0 + &named.1).matches("is valid").count(), 1);
    // A study outside that a link here and one elsewhere lead to.
    fs::write(desk.path("far.yaml"), study(&desk, "far", "amount: 12 um")).unwrap();
    for link in ["studies/x.yaml", "studies/y.yaml"] {
        std::os::unix::fs::symlink("../far.yaml", desk.path(link)).unwrap();
    }
    desk.run(&["run", "--quiet", "far"], 0);
    assert_eq!(desk.run(&["status"], 0).0, "q: up to date\nfar: up to date\n");
}
