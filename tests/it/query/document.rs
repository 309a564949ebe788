//! Every command in `docs/comparing.md` does what the text says, on this repository's results in a repository made for it.

use std::fs;
use std::path::Path;
use std::process::Command;

/// Command lines of the fenced shell blocks; one in quotes may go over several lines.
fn commands(text: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let (mut shell, mut open) = (false, false);
    for line in text.lines() {
        if let Some(language) = line.strip_prefix("```") {
            shell = language == "sh";
        } else if shell {
            match found.last_mut().filter(|_| open) {
                Some(command) => *command += &format!("\n{line}"),
                None => found.push(line.to_owned()),
            }
            open ^= line.matches('\'').count() % 2 == 1;
        }
    }
    found
}

/// The committed results of one study under two commits, a branch, a tag and two folders.
fn repository(folder: &Path) {
    let source = Path::new(env!("CARGO_MANIFEST_DIR"));
    for results in ["results", "old/results"] {
        for study in ["energy_ga", "quick"] {
            let to = folder.join(results).join(study);
            fs::create_dir_all(&to).unwrap();
            for entry in fs::read_dir(source.join("results/energy_ga")).unwrap().map(Result::unwrap) {
                if entry.path().is_file() {
                    fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
                }
            }
        }
    }
    let git = |words: &[&str]| {
        let identity = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"];
        let output = Command::new("git").arg("-C").arg(folder).args(identity).args(words).output().unwrap();
        assert!(output.status.success(), "{words:?}");
    };
    git(&["init", "-q", "-b", "main"]);
    git(&["add", "results"]);
    git(&["commit", "-qm", "one"]);
    git(&["tag", "v0.1.0"]);
    git(&["commit", "-q", "--allow-empty", "-m", "two"]);
}

#[test]
fn the_commands_of_the_document_give_what_it_says() {
    let document = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/comparing.md");
    let commands = commands(&fs::read_to_string(document).unwrap());
    let desk = tempfile::tempdir().unwrap();
    repository(desk.path());
    let program = Path::new(env!("CARGO_BIN_EXE_gearstudy")).parent().unwrap().display().to_string();
    let path = format!("{program}:{}", std::env::var("PATH").unwrap());
    let [mut diffs, mut queries] = [0, 0];
    for command in &commands {
        let output =
            Command::new("sh").args(["-ec", command]).current_dir(desk.path()).env("PATH", &path).output().unwrap();
        let (out, error) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(0), "{command}\n{out}\n{error}");
        if command.starts_with("gearstudy diff") {
            diffs += 1;
            assert!(out.contains("no difference"), "{command}\n{out}");
        } else {
            assert!(command.starts_with("gearstudy query"), "{command}");
            queries += 1;
            // The list of tables has some without rows.
            let empty = command != "gearstudy query" && (out.contains(", 0 rows") || out.ends_with("\n0 rows\n"));
            assert!(!empty, "{command}\n{out}");
        }
    }
    assert!(diffs >= 6 && queries >= 4, "{commands:#?}");
}
