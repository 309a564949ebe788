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
