//! Starts the program `git`: the only place that does, so that every call is protected in the same way.
//!
//! Must not know: what git is asked. `build.rs` of the program includes this file.

use std::ffi::OsStr;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Variables that bind git to one repository: the output of `git rev-parse --local-env-vars` (git 2.47), and one of earlier
/// versions. Hooks, aliases and `git rebase --exec` set them; a program that asks about another folder must clear them
/// (githooks(5), "Description"). `GIT_CONFIG_PARAMETERS` and `GIT_CONFIG_COUNT` of that list stay, as git keeps them for submodules
/// (`prepare_submodule_repo_env` in its submodule.c): they carry settings of the user such as `safe.directory`.
const LOCAL: [&str; 14] = [
    "GIT_ALTERNATE_OBJECT_DIRECTORIES",
    "GIT_COMMON_DIR",
    "GIT_CONFIG",
    "GIT_DIR",
    "GIT_GRAFT_FILE",
    "GIT_IMPLICIT_WORK_TREE",
    "GIT_INDEX_FILE",
    "GIT_INTERNAL_SUPER_PREFIX",
    "GIT_NO_REPLACE_OBJECTS",
    "GIT_OBJECT_DIRECTORY",
    "GIT_PREFIX",
    "GIT_REPLACE_REF_BASE",
    "GIT_SHALLOW_FILE",
    "GIT_WORK_TREE",
];
/// Of these, the objects of a push that a hook has not accepted yet (githooks(5), `pre-receive`).
const OBJECTS: [&str; 2] = ["GIT_ALTERNATE_OBJECT_DIRECTORIES", "GIT_OBJECT_DIRECTORY"];
/// Of these, paths that git reads relative to the folder of `-C`.
const PATHS: [&str; 5] = ["GIT_COMMON_DIR", "GIT_DIR", "GIT_INDEX_FILE", "GIT_OBJECT_DIRECTORY", "GIT_WORK_TREE"];
/// Variables that change how git reads a path: it takes all of them literally.
const PATHSPECS: [&str; 3] = ["GIT_GLOB_PATHSPECS", "GIT_ICASE_PATHSPECS", "GIT_NOGLOB_PATHSPECS"];
/// Lines of a message of git that are passed on: the remedy stands behind the fault.
const MOST_LINES: usize = 6;

/// Words of git where a command needs a work tree and the repository is bare.
pub const NO_WORK_TREE: &str = "must be run in a work tree";

/// Stands for the message of git where it gave none.
pub const NO_REASON: &str = "git gave no reason";

/// A call of git in a folder. It takes no lock that it could do without, fetches nothing, prompts for nothing, starts no
/// monitor of the file system, reads paths literally, and answers in English.
#[must_use]
pub fn command(folder: &Path) -> Command {
    let mut command = Command::new("git");
    command.args(["-c", "core.fsmonitor=false", "-c", "maintenance.auto=false", "-C"]).arg(named(folder));
    for (name, value) in [
        ("GIT_LITERAL_PATHSPECS", "1"),
        ("GIT_NO_LAZY_FETCH", "1"),
        ("GIT_OPTIONAL_LOCKS", "0"),
        ("GIT_TERMINAL_PROMPT", "0"),
        ("LC_ALL", "C"),
    ] {
        command.env(name, value);
    }
    for name in PATHSPECS {
        command.env_remove(name);
    }
    if let Some(own) = surrounding(folder) {
        let is_same = std::env::var_os("GIT_DIR").is_some_and(|named| is_one(Path::new(&named), &own));
        for name in LOCAL.into_iter().filter(|name| !(is_same && OBJECTS.contains(name))) {
            command.env_remove(name);
        }
    } else {
        let given = PATHS.into_iter().filter_map(|name| Some((name, std::env::var_os(name)?)));
        for (name, path) in given.filter(|(_, path)| !path.is_empty()) {
            if let Ok(path) = std::path::absolute(path) {
                command.env(name, path);
            }
        }
    }
    command
}

/// The same, but git may fetch objects that a partial clone lacks, unless the user forbids it.
#[must_use]
pub fn fetching(folder: &Path) -> Command {
    let mut command = command(folder);
    if std::env::var_os("GIT_NO_LAZY_FETCH").is_none() {
        command.env_remove("GIT_NO_LAZY_FETCH");
    }
    command
}

/// Standard output of a call in a folder.
///
/// # Errors
/// As [`answer`].
pub fn ask<S: AsRef<OsStr>>(folder: &Path, words: &[S]) -> Result<Vec<u8>, String> {
    answer(&mut command(folder), words)
}

/// Standard output of a call that succeeds.
///
/// # Errors
/// The message of git with its remedy, on one line.
pub fn answer<S: AsRef<OsStr>>(command: &mut Command, words: &[S]) -> Result<Vec<u8>, String> {
    let output = output(command, words)?;
    if output.status.success() { Ok(output.stdout) } else { Err(reason(&String::from_utf8_lossy(&output.stderr))) }
}

/// Whether a call that decides something says yes: it ends with 0 then, and with 1 for no.
///
/// # Errors
/// As [`answer`], for any other ending.
pub fn decide<S: AsRef<OsStr>>(command: &mut Command, words: &[S]) -> Result<bool, String> {
    let output = output(command, words)?;
    match output.status.code() {
        Some(0) => Ok(true),
        Some(1) => Ok(false),
        _ => Err(reason(&String::from_utf8_lossy(&output.stderr))),
    }
}

fn output<S: AsRef<OsStr>>(command: &mut Command, words: &[S]) -> Result<Output, String> {
    command.args(words).output().map_err(|error| format!("`git` cannot be started: {error}"))
}

/// The message of git on one line, from its `fatal:` on: traces and warnings may stand before it.
fn reason(message: &str) -> String {
    let lines: Vec<&str> = message.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let from = lines.iter().position(|line| line.starts_with("fatal: ")).unwrap_or(0);
    let mut text = String::new();
    for line in lines.iter().skip(from).take(MOST_LINES) {
        let line = ["fatal: ", "error: ", "hint: "].iter().find_map(|lead| line.strip_prefix(lead)).unwrap_or(line);
        if !text.is_empty() {
            text.push_str(if text.ends_with(':') { " " } else { "; " });
        }
        text.push_str(line);
    }
    if text.is_empty() { NO_REASON.to_owned() } else { text }
}

/// The current folder by a name: the parent of a plain file name has none.
fn named(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

/// Whether git may find a repository for a folder: one surrounds it, or a variable names one and its work tree.
#[must_use]
pub fn may_know(folder: &Path) -> bool {
    surrounding(folder).is_some() || ["GIT_DIR", "GIT_WORK_TREE"].iter().all(|name| std::env::var_os(name).is_some())
}

/// The git directory of the repository that surrounds a folder, found in the order of git (`setup_git_directory_gently` in its
/// setup.c): `.git`, a file that names another place, or a bare repository.
fn surrounding(folder: &Path) -> Option<PathBuf> {
    let folder = named(folder).canonicalize().ok()?;
    folder.ancestors().find_map(|folder| {
        let inside = folder.join(".git");
        if let Ok(text) = fs::read_to_string(&inside) {
            let named = text.strip_prefix("gitdir:").map_or("", str::trim);
            return Some(folder.join(named));
        }
        if is_there(&inside.join("HEAD")) {
            return Some(inside);
        }
        ["HEAD", "objects", "refs"].iter().all(|name| is_there(&folder.join(name))).then(|| folder.to_owned())
    })
}

/// A path that cannot be looked at may be there: git says why.
fn is_there(path: &Path) -> bool {
    let absent = |kind| matches!(kind, ErrorKind::NotFound | ErrorKind::NotADirectory);
    !fs::metadata(path).is_err_and(|error| absent(error.kind()))
}

fn is_one(first: &Path, second: &Path) -> bool {
    first.canonicalize().is_ok_and(|first| second.canonicalize().is_ok_and(|second| first == second))
}
