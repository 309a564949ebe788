//! A disk that fails on order: `shim.c`, loaded in front of the C library of a run.
//!
//! Must not know: what is asked of the run.

use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

pub const ENOSPC: i32 = 28;
pub const EIO: i32 = 5;
pub const EINTR: i32 = 4;
pub const EROFS: i32 = 30;
/// No error: writes take half of their bytes.
pub const SHORT: i32 = 0;

/// The library; none, and said aloud, where there is no compiler.
pub fn library() -> Option<&'static Path> {
    static LIBRARY: OnceLock<Option<PathBuf>> = OnceLock::new();
    LIBRARY.get_or_init(build).as_deref()
}

fn build() -> Option<PathBuf> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/reliability/shim.c");
    // Made under a name of its own: another process of the tests may have the library in use.
    let library = Path::new(env!("CARGO_TARGET_TMPDIR")).join("shim.so");
    let new = library.with_extension(std::process::id().to_string());
    let compiler = Command::new("cc").args(["-shared", "-fPIC", "-O1", "-o"]).arg(&new).arg(source).output();
    match compiler {
        Ok(output) if output.status.success() => {
            fs::rename(&new, &library).unwrap();
            Some(library)
        }
        Ok(output) => panic!("{}", String::from_utf8_lossy(&output.stderr)),
        Err(error) => {
            // Past the test harness, which shows nothing of tests that pass.
            let _ = writeln!(std::io::stderr(), "SKIPPED: no failing disk is tried, since there is no `cc`: {error}");
            None
        }
    }
}

/// A folder in memory, where there is such a thing: nothing here needs a disk.
pub fn folder() -> tempfile::TempDir {
    let memory = Path::new("/dev/shm");
    let made = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
    made.unwrap()
}

/// How a run ended.
pub struct Ended {
    pub status: ExitStatus,
    pub out: String,
    pub error: String,
}

/// A study with results and cache below one folder, which is watched.
pub struct Place {
    pub root: PathBuf,
    pub disk: PathBuf,
}

impl Place {
    pub fn new(root: &Path) -> Self {
        fs::create_dir_all(root.join("disk")).unwrap();
        fs::create_dir_all(root.join("none")).unwrap();
        let root = root.canonicalize().unwrap();
        Self { disk: root.join("disk"), root }
    }

    /// Another place for studies, with the disk of this one.
    pub fn beside(&self, name: &str) -> Self {
        Self { disk: self.disk.clone(), ..Self::new(&self.root.join(name)) }
    }

    pub fn results(&self) -> PathBuf {
        self.disk.join("results/tiny")
    }

    pub fn words(&self, study: &str) -> Vec<String> {
        fs::write(self.root.join("tiny.yaml"), study).unwrap();
        let text = |path: PathBuf| path.to_string_lossy().into_owned();
        vec![
            "run".to_owned(),
            text(self.root.join("tiny.yaml")),
            "--quiet".to_owned(),
            "--results".to_owned(),
            text(self.disk.join("results")),
            "--cache".to_owned(),
            text(self.disk.join("cache")),
        ]
    }

    /// The program with the failing disk below it; no `git` is found, which would take longer than the run.
    pub fn command(&self, study: &str, orders: &[(&str, String)]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
        command.args(self.words(study)).args(["--jobs", "1"]).current_dir(&self.root);
        command.env_remove("GEARSTUDY_CACHE").env("PATH", self.root.join("none"));
        command.env("LD_PRELOAD", library().unwrap()).env("SHIM_FOLDER", &self.disk);
        command.envs(orders.iter().map(|(name, value)| (*name, value)));
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    pub fn run(&self, study: &str, orders: &[(&str, String)]) -> Ended {
        ended(self.command(study, orders), &format!("{orders:?}"))
    }

    /// A run on a disk that is well again, in this process.
    pub fn good_run(&self, study: &str) -> i32 {
        let words = std::iter::once("gearstudy".to_owned()).chain(self.words(study));
        gearstudy::cli::main(words.map(Into::into))
    }
}

/// Waits for a run, which must end by itself and as a program ends.
pub fn ended(mut command: Command, what: &str) -> Ended {
    let mut child = command.spawn().unwrap();
    let (mut stdout, mut stderr) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
    let began = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if began.elapsed() > Duration::from_mins(1) {
            child.kill().unwrap();
            panic!("it hangs: {what}");
        }
        std::thread::sleep(Duration::from_millis(1));
    };
    let (mut out, mut error) = (String::new(), String::new());
    stdout.read_to_string(&mut out).unwrap();
    stderr.read_to_string(&mut error).unwrap();
    Ended { status, out, error }
}
