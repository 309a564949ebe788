//! The program in repositories of every kind: called by hooks and aliases, partial, shallow, bare, owned by somebody else, in
//! the midst of a merge, checked out with other line ends.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use super::diff::{committed, git, json};
use crate::desk::Desk;

const PROGRAM: &str = env!("CARGO_BIN_EXE_gearstudy");

/// Runs a program in a folder of the desk; its code and what it says.
fn told(desk: &Desk, at: &str, program: &str, words: &[&str], set: &[(&str, &str)]) -> (i32, String) {
    let mut command = Command::new(program);
    command.current_dir(desk.path(at)).env_remove("GEARSTUDY_CACHE").args(words).envs(set.iter().copied());
    let output = command.output().unwrap();
    let said = [output.stdout, output.stderr].concat();
    (output.status.code().unwrap_or(-1), String::from_utf8(said).unwrap())
}

/// Runs the program in a folder of the desk, where it must end with `code`.
fn ends(desk: &Desk, at: &str, words: &[&str], code: i32) -> String {
    let (ended, said) = told(desk, at, PROGRAM, words, &[]);
    assert_eq!(ended, code, "{words:?} in `{at}`: {said}");
    said
}

/// The same by a shell.
fn shell(desk: &Desk, at: &str, script: &str) -> String {
    let identity =
        "export GIT_AUTHOR_NAME=a GIT_AUTHOR_EMAIL=a@b GIT_COMMITTER_NAME=a GIT_COMMITTER_EMAIL=a@b; set -e; ";
    let (code, said) = told(desk, at, "sh", &["-c", &[identity, script].concat()], &[("GEARSTUDY", PROGRAM)]);
    assert_eq!(code, 0, "{script}: {said}");
    said
}

fn head(desk: &Desk, at: &str) -> String {
    shell(desk, at, "git rev-parse HEAD").trim().to_owned()
}

fn folder_of_study(desk: &Desk, results: &str) -> Value {
    let text = fs::read(desk.path(results).join("quick/manifest.json")).unwrap();
    let mut folder = serde_json::from_slice::<Value>(&text).unwrap()["study_folder"].clone();
    // Where the study lies is tested elsewhere.
    folder.as_object_mut().unwrap().remove("file");
    folder
}

fn edit(path: PathBuf, from: &str, to: &str) {
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "`{from}` is not in {}", path.display());
    fs::write(path, text.replacen(from, to, 1)).unwrap();
}

/// A second commit with other results.
fn committed_twice() -> Desk {
    let desk = committed();
    edit(desk.path("quick.yaml"), "face_width: 20 mm, bore_radius: 18 mm", "face_width: 22 mm, bore_radius: 18 mm");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    git(&desk, &["commit", "-qam", "two"]);
    desk
}

/// Hooks, aliases and `rebase --exec` of a linked work tree have `GIT_DIR` in their environment, and no `GIT_WORK_TREE`.
#[cfg(unix)]
#[test]
fn hooks_and_aliases_find_what_a_prompt_finds() {
    let desk = committed_twice();
    shell(
        &desk,
        "",
        "git tag one HEAD~1; git tag two; git init -q --bare remote; git worktree add -q wt -b wt; mkdir wt/sub",
    );
    let log = desk.path("log");
    let compare = |what: &str| {
        let note = format!("echo {what} ${{GIT_DIR:+set}} $? >> '{}'", log.display());
        format!(
            "\"$GEARSTUDY\" diff one two --quiet; {note}; \"$GEARSTUDY\" query \"SELECT 1 FROM 'one:quick.ste.summary'\" || exit 1"
        )
    };
    for hook in ["pre-commit", "post-commit", "post-checkout", "pre-push"] {
        self::hook(&desk.path(".git/hooks").join(hook), &compare(hook));
    }
    shell(
        &desk,
        "wt",
        "echo b > b; git add b; git commit -q -m b; git checkout -q -b other; git push -q ../remote other",
    );
    let config = format!("!{}", compare("alias"));
    git(&desk, &["config", "alias.gs", &config]);
    shell(&desk, "wt", "git gs; cd sub; git gs");
    fs::write(desk.path("wt/exec"), compare("exec")).unwrap();
    shell(&desk, "wt", "git rebase -q --exec '. ./exec' HEAD~1");
    let said = fs::read_to_string(&log).unwrap();
    for what in ["pre-commit", "post-commit", "post-checkout", "pre-push", "alias", "exec"] {
        assert!(said.contains(&format!("{what} set 4\n")), "{what} is not in\n{said}");
    }
    assert_eq!(said.matches("alias set 4\n").count(), 2, "{said}");
    assert!(said.lines().all(|line| line.ends_with(" 4")), "{said}");
}

/// Writes a hook.
#[cfg(unix)]
fn hook(path: &Path, script: &str) {
    use std::os::unix::fs::PermissionsExt;

    fs::write(path, format!("#!/bin/sh\n{script}\n")).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
}

/// Provenance is that of the repository around the study, whatever repository the caller works in.
#[test]
fn the_commit_is_that_of_the_study_s_own_repository() {
    let desk = committed();
    shell(
        &desk,
        "",
        "git init -q -b main other && cp quick.yaml other && cd other && git add -A && git commit -qm other",
    );
    let (own, other) = (head(&desk, ""), head(&desk, "other"));
    assert_ne!(own, other);
    let top = desk.path("").display().to_string();
    let run = ["run", "--quiet", "quick.yaml", "--results", "made", "--force"];
    for set in [
        vec![("GIT_DIR", format!("{top}/.git"))],
        vec![("GIT_DIR", format!("{top}/.git")), ("GIT_WORK_TREE", top.clone())],
        vec![("GIT_INDEX_FILE", ".git/index".to_owned()), ("GIT_PREFIX", String::new())],
        vec![("GIT_DIR", format!("{top}/.git")), ("GIT_OBJECT_DIRECTORY", format!("{top}/.git/objects"))],
    ] {
        let set: Vec<(&str, &str)> = set.iter().map(|(name, value)| (*name, value.as_str())).collect();
        let _ = fs::remove_dir_all(desk.path("other/made"));
        let (code, said) = told(&desk, "other", PROGRAM, &run, &set);
        assert_eq!(code, 0, "{said}");
        let found = folder_of_study(&desk, "other/made");
        assert_eq!(
            (&found["commit"], &found["uncommitted_changes"]),
            (&other.as_str().into(), &false.into()),
            "{set:?}"
        );
    }
    // Outside of any repository a variable alone says nothing of the study; a work tree that it lies in does.
    let outside = Desk::with("quick.yaml");
    let (code, said) = told(&outside, "", PROGRAM, &run, &[("GIT_DIR", &format!("{top}/.git"))]);
    assert_eq!((code, folder_of_study(&outside, "made")["commit"].clone()), (0, Value::Null), "{said}");
}

/// From a hook of the superproject: of its main work tree, where the index is named relative to it, and of a linked one.
#[cfg(unix)]
#[test]
fn a_submodule_s_study_has_the_submodule_s_commit() {
    let desk = committed();
    shell(
        &desk,
        "",
        "git init -q -b main super && cd super && git -c protocol.file.allow=always submodule add -q \"$PWD/..\" sub && git commit -qm super",
    );
    let script = "cd sub && \"$GEARSTUDY\" run --quiet quick.yaml --results made";
    hook(&desk.path("super/.git/hooks/pre-commit"), script);
    let own = head(&desk, "super/sub");
    shell(&desk, "super", "echo a > a; git add a; git commit -qm a");
    assert_eq!(folder_of_study(&desk, "super/sub/made")["commit"], own.as_str());
    shell(
        &desk,
        "super",
        "git worktree add -q ../linked && cd ../linked && git -c protocol.file.allow=always submodule update --init -q && echo b > b && git add b && git commit -qm b",
    );
    assert_eq!(folder_of_study(&desk, "linked/sub/made"), folder_of_study(&desk, "super/sub/made"));
}

#[cfg(unix)]
#[test]
fn a_run_changes_nothing_of_the_repository_and_its_results_are_no_change() {
    use std::os::unix::fs::MetadataExt;

    let desk = committed();
    git(&desk, &["add", "-A"]);
    let clean = serde_json::json!({ "commit": head(&desk, ""), "uncommitted_changes": false });
    // Another time of a tracked file, so that git would write its index anew; results and notes that nobody committed.
    shell(
        &desk,
        "",
        "sleep 1.1; touch .gitignore quick.yaml; echo a > notes.txt; git config core.fsmonitor 'echo called >> monitor; false'",
    );
    let index = || fs::metadata(desk.path(".git/index")).unwrap().ino();
    let before = index();
    fs::remove_dir_all(desk.path("results")).unwrap();
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    assert_eq!(folder_of_study(&desk, "results"), clean);
    desk.run(&["diff", "--quiet"], 0);
    desk.run(&["query", "SELECT 1 FROM 'HEAD:quick.ste.summary'"], 0);
    assert_eq!(index(), before);
    assert!(!desk.path("monitor").exists());
    // Neither do settings of the user count.
    git(&desk, &["config", "status.showUntrackedFiles", "no"]);
    git(&desk, &["config", "color.ui", "always"]);
    edit(desk.path("quick.yaml"), "face_width: 20 mm, bore_radius: 18 mm", "face_width: 22 mm, bore_radius: 18 mm");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    assert_eq!(folder_of_study(&desk, "results")["uncommitted_changes"], true);
}

/// Where nothing could be compared, nothing is said to be the same.
#[test]
fn what_could_not_be_compared_is_no_difference_nor_the_same() {
    let desk = committed_twice();
    shell(
        &desk,
        "",
        "git config uploadpack.allowFilter true && git clone -q --no-checkout --filter=blob:none \"file://$PWD\" part && mv .git gone",
    );
    for (format, headline) in [
        ("pretty", "1 study could not be compared"),
        ("markdown", "## 1 study could not be compared"),
        ("html", "<h1>1 study could not be compared</h1>"),
        ("json", "\"state\": \"unknown\""),
    ] {
        let said = ends(&desk, "part", &["diff", "HEAD~1", "HEAD", "--format", format], 1);
        assert!(said.contains(headline) && said.contains("git has no contents of"), "{format}: {said}");
        assert!(said.contains("fetch them first") && !said.contains("Broken pipe"), "{format}: {said}");
        assert!(!said.contains("no difference"), "{format}: {said}");
    }
    let said = ends(&desk, "part", &["query", "SELECT 1 FROM 'HEAD:quick.ste.summary'"], 1);
    assert!(said.contains("fetch them first"), "{said}");

    // The same of one study of two, which the other does not suffer from.
    fs::rename(desk.path("gone"), desk.path(".git")).unwrap();
    fs::create_dir(desk.path("results/broken")).unwrap();
    fs::write(desk.path("results/broken/manifest.json"), "<<<<<<< HEAD\n{\n=======\n{ \"a\": 1\n>>>>>>> f\n").unwrap();
    let diff = json(&desk, &[], 1);
    let states: Vec<&Value> = diff["studies"].as_array().unwrap().iter().map(|study| &study["state"]).collect();
    assert_eq!((&diff["state"], states), (&"unknown".into(), vec![&"unknown".into(), &"same".into()]));
    let said = ends(&desk, "", &["diff"], 1);
    assert!(said.contains("1 of 2 studies, no difference; 1 could not be compared"), "{said}");
    assert!(said.contains("holds a merge conflict in lines 1 to 5; `gearstudy run STUDY` writes it anew"), "{said}");
    desk.run(&["diff", "--", "quick"], 0);
    desk.run(&["query", "SELECT 1 FROM quick.ste.summary"], 0);
    for (query, code) in [("SELECT 1 FROM broken.ste.summary", 1), ("SELECT 1 FROM none.ste.summary", 2)] {
        let said = ends(&desk, "", &["query", query], code);
        assert!(said.contains("holds a merge conflict"), "{said}");
    }
    let (out, error) = desk.run(&["query"], 0);
    assert!(out.contains("quick.ste.summary") && error.contains("holds a merge conflict"), "{out}{error}");
    let said = ends(&desk, "", &["gc"], 1);
    assert!(said.contains("holds a merge conflict"), "{said}");
}

#[test]
fn a_merge_that_is_not_resolved_is_called_so() {
    let desk = committed();
    let study = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let at = study.find("stages:").unwrap();
    let line = study[..at].matches('\n').count() + 1;
    let (before, after) = study.split_at(at);
    fs::write(desk.path("quick.yaml"), format!("{before}<<<<<<< HEAD\nseed: 7\n=======\nseed: 8\n>>>>>>> f\n{after}"))
        .unwrap();
    for words in
        [&["check", "quick.yaml"][..], &["run", "quick.yaml"], &["plan", "quick.yaml"], &["status", "quick.yaml"]]
    {
        let said = ends(&desk, "", words, 2);
        let expected =
            format!("quick.yaml:{line}:1: a merge left both versions from line {line} to {}; keep one", line + 4);
        assert!(said.contains(&expected), "{said}");
    }
    fs::write(desk.path("quick.yaml"), study).unwrap();
    let manifest = desk.path("results/quick/manifest.json");
    let text = fs::read_to_string(&manifest).unwrap();
    let (first, rest) = text.split_once('\n').unwrap();
    fs::write(&manifest, format!("{first}\n<<<<<<< HEAD\n\"a\": 1,\n=======\n>>>>>>> f\n{rest}")).unwrap();
    for words in [
        &["status", "quick.yaml"][..],
        &["table", "quick.yaml", "ste.summary"],
        &["report", "quick.yaml"],
        &["archive", "quick.yaml", "-o", "a.zip"],
        &["diff"],
        &["gc"],
    ] {
        let said = ends(&desk, "", words, 1);
        assert!(said.contains("holds a merge conflict in lines 2 to 5; `gearstudy run"), "{words:?}: {said}");
    }
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    desk.run(&["status", "quick.yaml"], 0);
}

#[test]
fn a_shallow_clone_says_so_wherever_a_revision_is_looked_up() {
    let desk = committed_twice();
    shell(&desk, "", "git tag v0.1.0 HEAD~1; git clone -q --depth 1 --no-single-branch file://$PWD shallow");
    let hint = "this clone is shallow: fetch more of its history first";
    let old = head(&desk, "").replace(|c: char| c.is_ascii_digit(), "0");
    for word in ["HEAD~1", "HEAD^", "main~1", "origin/dev", "v0.2.0", &old, "main...HEAD~1", "HEAD~1..HEAD"] {
        let said = ends(&desk, "shallow", &["diff", word], 1);
        assert!(said.contains(hint), "{word}: {said}");
        assert!(word == "origin/dev" || word == "v0.2.0" || !said.contains("did you mean"), "{word}: {said}");
    }
    assert!(ends(&desk, "shallow", &["gc", "--keep", "HEAD~1"], 1).contains(hint));
    assert!(ends(&desk, "shallow", &["query", "SELECT 1 FROM 'HEAD~1:quick.ste.summary'"], 2).contains(hint));
    // Not in a whole one.
    let (_, said) = desk.run(&["diff", "HEAD~9"], 1);
    assert!(said.contains("`HEAD~9` is neither") && !said.contains("shallow"), "{said}");
}

#[test]
fn ranges_are_two_commits_as_in_git_diff() {
    let desk = committed_twice();
    let both = json(&desk, &["HEAD~1", "HEAD"], 4);
    for range in ["HEAD~1..HEAD", "HEAD~1..", "HEAD~1...HEAD"] {
        let found = json(&desk, &[range, "quick"], 4);
        assert_eq!(found["studies"], both["studies"], "{range}");
    }
    // From the common ancestor: a branch's own changes alone.
    shell(&desk, "", "git checkout -q -b side HEAD~1 && git commit -q --allow-empty -m side");
    assert_eq!(json(&desk, &["main...side"], 0)["state"], "same");
    assert_eq!(json(&desk, &["main..side"], 4)["state"], "changed");
    let (_, said) = desk.run(&["diff", "main..sude"], 1);
    assert!(said.contains("there is no revision `sude`; did you mean `side`?"), "{said}");
    let (_, said) = desk.run(&["gc", "--keep", "main..side"], 1);
    assert!(said.contains("it is a range, and one commit is expected"), "{said}");
    shell(&desk, "", "git checkout -q --orphan alone && git commit -qm alone");
    let (_, said) = desk.run(&["diff", "main...alone"], 1);
    assert!(said.contains("`main` and `alone` have no common ancestor"), "{said}");
}

#[cfg(unix)]
#[test]
fn a_bare_repository_has_commits_to_compare() {
    let desk = committed_twice();
    shell(
        &desk,
        "",
        "git clone -q --bare . b.git && mkdir layout && git clone -q --bare . layout/.bare && echo 'gitdir: ./.bare' > layout/.git",
    );
    for at in ["b.git", "layout"] {
        let said = ends(&desk, at, &["diff", "HEAD~1", "HEAD"], 4);
        assert!(said.contains("≠ quick"), "{at}: {said}");
        ends(&desk, at, &["diff", "HEAD~1..HEAD", "quick"], 4);
        ends(&desk, at, &["query", "SELECT 1 FROM 'HEAD:quick.ste.summary'"], 0);
        let said = ends(&desk, at, &["diff", "HEAD~1"], 1);
        assert!(said.contains("a bare repository has no results folder: name two revisions"), "{at}: {said}");
        assert!(ends(&desk, at, &["diff", "HEAD~9", "HEAD"], 1).contains("is neither a revision"));
    }
    // As a server does it, before and behind an accepted push.
    for name in ["pre-receive", "post-receive"] {
        let compare = "read old new name; \"$GEARSTUDY\" diff $old $new --quiet";
        hook(&desk.path("b.git/hooks").join(name), &format!("{compare}; echo {name} $? >> ../log"));
    }
    edit(desk.path("quick.yaml"), "face_width: 22 mm, bore_radius: 18 mm", "face_width: 23 mm, bore_radius: 18 mm");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    shell(&desk, "", "git commit -qam three && git push -q b.git main");
    assert_eq!(fs::read_to_string(desk.path("log")).unwrap(), "pre-receive 4\npost-receive 4\n");
}

#[test]
fn a_study_with_another_name_is_compared_with_what_it_was() {
    let desk = committed();
    shell(
        &desk,
        "",
        "git mv quick.yaml swift.yaml && git rm -rq results && sed -i 's/^study: quick/study: swift/' swift.yaml",
    );
    desk.run(&["run", "--quiet", "swift.yaml"], 0);
    shell(&desk, "", "git add -A && git commit -qm renamed");
    let same = json(&desk, &["HEAD~1", "HEAD"], 0);
    assert_eq!(same["studies"].as_array().unwrap().len(), 1);
    let (study, state) = (&same["studies"][0], &same["state"]);
    assert_eq!((&study["name"], &study["renamed_from"], state), (&"swift".into(), &"quick".into(), &"same".into()));
    for name in ["swift", "quick"] {
        assert_eq!(json(&desk, &["HEAD~1", "HEAD", name], 0)["studies"], same["studies"], "{name}");
    }
    // With a change besides it is what changed, and no study that came and another that went.
    edit(desk.path("swift.yaml"), "count: 5", "count: 9");
    desk.run(&["run", "--quiet", "swift.yaml"], 0);
    git(&desk, &["commit", "-qam", "changed"]);
    let changed = json(&desk, &["HEAD~2", "HEAD"], 4);
    assert_eq!((changed["studies"].as_array().unwrap().len(), &changed["studies"][0]["state"]), (1, &"changed".into()));
    for format in ["pretty", "markdown", "html"] {
        assert!(desk.run(&["diff", "HEAD~2", "HEAD", "--format", format], 4).0.contains("renamed from quick"));
    }
}

#[test]
fn line_ends_that_git_changed_are_called_so() {
    let desk = committed();
    shell(&desk, "", "sed -i '3a !results/*/figures/' .gitignore && git add -A && git commit -qm figures");
    shell(&desk, "", "git clone -q -c core.autocrlf=true . windows && ls windows/results/quick/figures/*.svg");
    let said = ends(&desk, "windows", &["diff"], 4);
    assert!(
        said.contains("only its line ends differ (git's autocrlf)") && !said.contains("bytes; its manifest"),
        "{said}"
    );
    let said = ends(&desk, "windows", &["status", "quick.yaml"], 0);
    assert!(!said.contains("the study's file has changed"), "{said}");
    let said = told(&desk, "windows", PROGRAM, &["status", "quick.yaml", "--check"], &[]).1;
    assert!(said.contains("only its line ends differ (git's autocrlf)"), "{said}");
    // With what the guide advises nothing of it happens.
    shell(&desk, "", "echo 'results/** -text' > .gitattributes && git add -A && git commit -qm attributes");
    shell(&desk, "", "git clone -q -c core.autocrlf=true . advised");
    ends(&desk, "advised", &["diff"], 0);
}

/// Somebody else's repository: git does not read it before its user says so, and says how.
#[cfg(target_os = "linux")]
#[test]
fn a_repository_of_somebody_else_is_told_with_git_s_remedy() {
    let desk = committed();
    let (code, _) = told(&desk, "", "chown", &["-R", "1234", "."], &[]);
    if code != 0 {
        // Only root can give a repository away.
        return;
    }
    let set = [("HOME", "/nonexistent")];
    let remedy = "git config --global --add safe.directory";
    for words in
        [&["diff", "HEAD~1"][..], &["query", "SELECT 1 FROM 'HEAD:quick.ste.summary'"], &["gc", "--keep", "HEAD"]]
    {
        let (_, said) = told(&desk, "", PROGRAM, words, &set);
        assert!(said.contains("detected dubious ownership") && said.contains(remedy), "{words:?}: {said}");
    }
    let (code, said) = told(&desk, "", PROGRAM, &["run", "--quiet", "quick.yaml", "--results", "made"], &set);
    assert!(code == 0 && said.contains("do not name the commit") && said.contains(remedy), "{said}");
    // A setting that the user gives by the environment holds.
    let trusted =
        [&set[..], &[("GIT_CONFIG_COUNT", "1"), ("GIT_CONFIG_KEY_0", "safe.directory"), ("GIT_CONFIG_VALUE_0", "*")]]
            .concat();
    assert_eq!(told(&desk, "", PROGRAM, &["diff", "--quiet"], &trusted).0, 0);
}

/// No file but one starts git: variables, locks and prompts are its business.
#[test]
fn git_is_started_in_one_place() {
    fn walk(folder: &Path, found: &mut Vec<String>) {
        for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if entry.is_dir() {
                walk(&entry, found);
            } else if entry.extension().is_some_and(|ending| ending == "rs")
                && fs::read_to_string(&entry).unwrap().contains("Command::new(\"git\")")
            {
                found.push(entry.display().to_string().replace('\\', "/"));
            }
        }
    }
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    walk(&top.join("src"), &mut found);
    walk(&top.join("crates"), &mut found);
    assert!(!fs::read_to_string(top.join("build.rs")).unwrap().contains("\"git\""));
    assert_eq!(found, [format!("{}/crates/studygraph/src/git.rs", top.display())]);
}
