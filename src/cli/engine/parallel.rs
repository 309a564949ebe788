//! Shards as jobs of GNU Parallel, on this machine or on hosts that ssh reaches.
//!
//! Must not know: what a shard computes.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::Write;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use super::super::Ending;
use super::profile::{maybe_number, number, words};
use super::{Job, Starter, made, program, quoted};
use declare::record::Record;

/// How often it is seen whether it has ended.
const ENDING: usize = 100;

pub(super) struct Parallel<'a> {
    job: &'a Job<'a>,
    profile: &'a Record,
    program: String,
    /// What runs, and the shards that it was given.
    running: Option<(Child, Vec<usize>)>,
}

impl<'a> Parallel<'a> {
    /// # Errors
    /// When there is no GNU Parallel: another program has the same name.
    pub(super) fn new(job: &'a Job<'a>, profile: &'a Record) -> Result<Self, Ending> {
        let missing = |why: &str| Ending::Usage(format!("GNU Parallel is not on this machine: {why}"));
        let output = Command::new("parallel").arg("--version").output().map_err(|error| missing(&error.to_string()))?;
        if !String::from_utf8_lossy(&output.stdout).contains("GNU parallel") {
            return Err(missing("`parallel` is another program"));
        }
        made(&job.folder.join("logs"))?;
        Ok(Self { job, profile, program: program(profile)?, running: None })
    }
}

impl Starter for Parallel<'_> {
    fn start(&mut self, shards: &[usize]) -> Result<(), Ending> {
        let log = self.job.folder.join("logs/parallel.log");
        let wrong = |error: std::io::Error| Ending::Usage(format!("`parallel`: {error}"));
        let said = File::create(&log).map_err(wrong)?;
        let mut command = Command::new("parallel");
        // A shard that fails says so in its own file; the others go on.
        command.args(["--halt", "never", "--joblog"]).arg(self.job.folder.join("logs/joblog"));
        if let Some(slots) = maybe_number(self.profile, "slots") {
            command.arg("--jobs").arg(slots.to_string());
        }
        let hosts = words(self.profile, "hosts");
        if !hosts.is_empty() {
            command.arg("--sshlogin").arg(hosts.join(","));
        }
        let folder = quoted(&self.job.folder.to_string_lossy());
        let processors = number(self.profile, "processors");
        command.arg(format!("{} --quiet shard run {folder} {{}} --jobs {processors}", self.program));
        let also = said.try_clone().map_err(wrong)?;
        let mut child = command.stdin(Stdio::piped()).stdout(also).stderr(said).spawn().map_err(wrong)?;
        if let Some(mut stdin) = child.stdin.take() {
            for shard in shards {
                writeln!(stdin, "{shard}").map_err(wrong)?;
            }
        }
        self.running = Some((child, shards.to_vec()));
        Ok(())
    }

    fn live(&mut self) -> Result<BTreeSet<usize>, Ending> {
        let Some((child, shards)) = &mut self.running else { return Ok(BTreeSet::new()) };
        match child.try_wait() {
            Ok(None) => Ok(shards.iter().copied().collect()),
            Ok(Some(_)) => {
                self.running = None;
                Ok(BTreeSet::new())
            }
            Err(error) => Err(Ending::Usage(format!("`parallel`: {error}"))),
        }
    }

    /// It is asked without a message to anybody.
    fn ask_every(&self) -> Duration {
        Duration::from_secs(number(self.profile, "ask_every") as u64).min(Duration::from_secs(1))
    }

    fn leave(&mut self) -> String {
        // What it has started ends by itself; whoever starts that again does no harm.
        if let Some((mut child, _)) = self.running.take() {
            let _ = child.kill();
            let _ = child.wait();
        }
        String::new()
    }
}

impl Drop for Parallel<'_> {
    /// When all packs are there it only has to end.
    fn drop(&mut self) {
        let Some((mut child, _)) = self.running.take() else { return };
        for _ in 0..ENDING {
            if !matches!(child.try_wait(), Ok(None)) {
                return;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        let _ = child.kill();
        let _ = child.wait();
    }
}
