//! A real Slurm on this machine: two nodes on loopback.
//!
//! Must not know: how the program speaks to it.

use std::fs;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use super::{assert_as_local, installed, program, shards_there, skipped, swept};
use crate::desk::Desk;

/// Small, so that shards need several arrays.
const ARRAY_SIZE: &str = "10";

struct Slurm {
    folder: tempfile::TempDir,
}

impl Slurm {
    fn script(name: &str) -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/shards").join(name)
    }

    /// None, and said aloud, where there is no Slurm or nobody may start it.
    fn up() -> Option<Self> {
        if !installed("shards by Slurm", &["slurmctld", "slurmd", "sbatch", "munged"], "slurm-wlm munge") {
            return None;
        }
        let root = Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout == b"0\n");
        if !root {
            skipped("shards by Slurm: only root may start slurmd");
            return None;
        }
        let folder = tempfile::tempdir().unwrap();
        // Three ports that nobody else has, nor another copy of this test.
        let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port().clamp(2000, 65000);
        let slurm = Self { folder };
        let up = Command::new(Self::script("up.sh"))
            .arg(slurm.folder.path())
            .args([&port.to_string(), "3", ARRAY_SIZE])
            .stdout(Stdio::null())
            .output()
            .unwrap();
        assert!(up.status.success(), "{}", String::from_utf8_lossy(&up.stderr));
        Some(slurm)
    }

    fn command(&self, program: impl AsRef<std::ffi::OsStr>, words: &[&str]) -> Command {
        let mut command = Command::new(program);
        command.args(words).env("SLURM_CONF", self.folder.path().join("slurm.conf")).env_remove("GEARSTUDY_CACHE");
        command
    }

    /// How each job ended, and what the controller said of them.
    fn ended(&self) -> String {
        let file = |name: &str| fs::read_to_string(self.folder.path().join(name)).unwrap_or_default();
        format!("{}\n{}", file("jobcomp.txt"), file("log/slurmctld.log"))
    }

    fn ask(&self, program: &str, words: &[&str]) -> String {
        let output = self.command(program, words).output().unwrap();
        assert!(output.status.success(), "{program} {words:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        let _ = Command::new(Self::script("down.sh")).arg(self.folder.path()).status();
    }
}

fn until(what: &str, mut is: impl FnMut() -> bool) {
    let began = Instant::now();
    while !is() {
        assert!(began.elapsed() < Duration::from_secs(100), "it never came to this: {what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn told(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[test]
fn slurm_runs_the_pieces_whatever_becomes_of_its_jobs() {
    let Some(slurm) = Slurm::up() else { return };
    let desk = swept();
    fs::write(
        desk.path("site.yaml"),
        "partition: main\ntime: 00:10:00\nat_once: 4\nask_every: 1\noptions: [--no-requeue]\nbefore: echo begun\n",
    )
    .unwrap();
    lost_jobs(&slurm, &desk);
    lost_files(&slurm, &desk);
    detached(&slurm);
}

/// An element is cancelled while it waits, a node is drained: the missing shard is started again, and no other.
fn lost_jobs(slurm: &Slurm, desk: &Desk) {
    let words =
        ["run", "swept.yaml", "--engine", "slurm", "--shards", "24", "--into", "plan", "--profile", "site.yaml"];
    let child = slurm
        .command(program(), &words)
        .current_dir(desk.path(""))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    until("some shards are there", || fs::read_dir(desk.path("plan/shards")).is_ok_and(|files| files.count() > 1));
    slurm.ask("scontrol", &["update", "nodename=n2", "state=drain", "reason=test"]);
    let waiting = slurm.ask("squeue", &["--noheader", "--array", "--states=PENDING", "--format=%i %j %K"]);
    let last = waiting.lines().last().expect("some still wait").to_owned();
    let [element, name, task]: [&str; 3] = last.split_whitespace().collect::<Vec<_>>().try_into().unwrap();
    slurm.ask("scancel", &[element]);
    let lost = name.rsplit('-').next().unwrap().parse::<usize>().unwrap() + task.parse::<usize>().unwrap();
    let output = child.wait_with_output().unwrap();
    let said = told(&output);
    assert!(output.status.success(), "{said}");
    let starts: Vec<&str> = said.lines().filter(|line| line.contains("starting ")).collect();
    assert_eq!(
        starts,
        ["swept: starting 24 of 24 shards: 0-23", &format!("swept: starting 1 of 24 shards: {lost}")],
        "{said}"
    );
    assert!(
        slurm.ask("sinfo", &["--noheader", "--nodes=n2", "--format=%T"]).starts_with("drain"),
        "it is not used again"
    );
    assert!(said.contains("1 verdict: 1 holds"), "{said}");
    assert_as_local(desk);
    // 0-9, 10-19, 20-23, and the lost one.
    let arrays = fs::read_dir(desk.path("plan/logs")).unwrap().map(|file| {
        let name = file.unwrap().file_name().into_string().unwrap();
        name.split('_').next().unwrap().to_owned()
    });
    assert_eq!(arrays.collect::<std::collections::BTreeSet<_>>().len(), 4);
}

/// Files that are lost or damaged later are made again, one array for each; what is there is left.
fn lost_files(slurm: &Slurm, desk: &Desk) {
    fs::remove_file(desk.path("plan/shards/3.pack")).unwrap();
    fs::write(desk.path("plan/shards/17.pack"), "torn").unwrap();
    let before = fs::metadata(desk.path("plan/shards/5.pack")).unwrap().modified().unwrap();
    fs::remove_dir_all(desk.path("results")).unwrap();
    fs::remove_dir_all(desk.path(".gearstudy")).unwrap();
    let words = ["run", "swept.yaml", "--engine", "slurm", "--into", "plan", "--profile", "site.yaml"];
    let output = slurm.command(program(), &words).current_dir(desk.path("")).output().unwrap();
    let said = told(&output);
    assert!(output.status.success() && said.contains("starting 2 of 24 shards: 3,17"), "{said}");
    assert_eq!(fs::metadata(desk.path("plan/shards/5.pack")).unwrap().modified().unwrap(), before);
    assert_eq!(shards_there(desk, "plan"), 24);
    assert_as_local(desk);
}

/// Nobody watches: the merge is a job that waits for the others.
fn detached(slurm: &Slurm) {
    let desk = swept();
    let words = ["run", "swept.yaml", "--engine", "slurm", "--shards", "4", "--into", "plan", "--detach"];
    let output = slurm.command(program(), &words).current_dir(desk.path("")).output().unwrap();
    let said = told(&output);
    assert!(output.status.success() && said.contains("submitted: jobs ") && said.contains(" for the merge"), "{said}");
    until("the merge is done", || slurm.ask("squeue", &["--noheader"]).is_empty());
    let log = fs::read_to_string(desk.path("plan/logs/merge.log")).unwrap_or_default();
    assert!(desk.path("results/swept/report.html").exists(), "{log}\n{}", slurm.ended());
    assert_as_local(&desk);
}
