//! Shards as elements of Slurm's job arrays.
//!
//! An element is a shard: element t of an array that begins at f is shard f + t, and f is in the job's name, so the queue
//! itself says who is at work, whoever submitted it. Must not know: what a shard computes.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use super::super::Ending;
use super::super::arguments::Places;
use super::profile::{maybe_number, number, words};
use super::{Job, Starter, made, program, quoted};
use declare::record::Record;
use studygraph::runner::shard::ranges;

/// What Slurm has when nobody says.
const ARRAY_SIZE: usize = 1001;

pub(super) struct Slurm<'a> {
    job: &'a Job<'a>,
    profile: &'a Record,
    /// Elements count from 0 to one less.
    array_size: usize,
    program: String,
}

impl<'a> Slurm<'a> {
    /// # Errors
    /// When there is no Slurm that answers.
    pub(super) fn new(job: &'a Job<'a>, profile: &'a Record) -> Result<Self, Ending> {
        let said = ask("scontrol", &["show".into(), "config".into()], None)?;
        let site =
            said.lines().find_map(|line| line.strip_prefix("MaxArraySize")?.split('=').nth(1)?.trim().parse().ok());
        let array_size = maybe_number(profile, "array_size").or(site).unwrap_or(ARRAY_SIZE).max(2);
        made(&job.folder.join("logs"))?;
        Ok(Self { job, profile, array_size, program: program(profile)? })
    }

    fn prefix(&self) -> String {
        format!("gs-{}-", &self.job.plan.digest[..12])
    }

    /// Submits a script; the number of its job.
    fn submit(&self, name: &str, options: &[String], script: &str) -> Result<String, Ending> {
        let mut all = vec!["--parsable".to_owned(), format!("--job-name={name}")];
        for (field, option) in [("partition", "partition"), ("account", "account"), ("time", "time"), ("memory", "mem")]
        {
            all.extend(self.profile.maybe_text(field).map(|value| format!("--{option}={value}")));
        }
        all.push(format!("--cpus-per-task={}", number(self.profile, "processors")));
        all.extend(words(self.profile, "options"));
        all.extend_from_slice(options);
        let before = self.profile.maybe_text("before").map(|line| format!("{line}\n")).unwrap_or_default();
        let said = ask("sbatch", &all, Some(&format!("#!/bin/sh\n{before}{script}\n")))?;
        // `number` or `number;cluster`.
        Ok(said.trim().split(';').next().unwrap_or_default().to_owned())
    }

    /// Submits arrays for these shards; the numbers of the jobs.
    fn arrays(&self, shards: &[usize], after: &str) -> Result<Vec<String>, Ending> {
        let mut jobs = Vec::new();
        for block in shards.chunk_by(|one, next| one / self.array_size == next / self.array_size) {
            let first = block[0] / self.array_size * self.array_size;
            let elements = ranges(block.iter().map(|shard| shard - first));
            let throttle = maybe_number(self.profile, "at_once").map(|most| format!("%{most}")).unwrap_or_default();
            let mut options = vec![
                format!("--array={elements}{throttle}"),
                format!("--output={}", self.job.folder.join("logs").join("%A_%a.log").display()),
            ];
            if !after.is_empty() {
                options.extend([format!("--dependency=afterok:{after}"), "--kill-on-invalid-dep=yes".to_owned()]);
            }
            let script = format!(
                "exec {} shard run {} $(({first} + SLURM_ARRAY_TASK_ID)) --jobs {}",
                self.program,
                quoted(&self.job.folder.to_string_lossy()),
                number(self.profile, "processors")
            );
            jobs.push(self.submit(&format!("{}{first}", self.prefix()), &options, &script)?);
        }
        Ok(jobs)
    }

    /// Submits all levels and the merge, each after the one before; nobody watches them.
    ///
    /// # Errors
    /// When Slurm refuses.
    pub(super) fn chain(&self, places: &Places) -> Result<(), Ending> {
        let live = self.elements()?;
        if !live.is_empty() {
            return Err(Ending::Usage(format!("shards {} are in the queue already", ranges(live))));
        }
        let mut after = String::new();
        let mut all = Vec::new();
        for level in &self.job.plan.levels {
            let missing = self.job.missing(level.first..level.end)?;
            if !missing.is_empty() {
                let jobs = self.arrays(&missing, &after)?;
                after = jobs.join(":");
                all.extend(jobs);
            }
        }
        let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let script = format!(
            "exec {} shard merge {} --results {} --cache {} --jobs {}",
            self.program,
            quoted(&self.job.folder.to_string_lossy()),
            quoted(&absolute(&places.results).to_string_lossy()),
            quoted(&absolute(&places.cache).to_string_lossy()),
            number(self.profile, "processors")
        );
        let mut options = vec![format!("--output={}", self.job.folder.join("logs/merge.log").display())];
        if !after.is_empty() {
            options.extend([format!("--dependency=afterok:{after}"), "--kill-on-invalid-dep=yes".to_owned()]);
        }
        let merge = self.submit(&format!("{}merge", self.prefix()), &options, &script)?;
        let shards = if all.is_empty() { String::new() } else { format!("jobs {} for the shards, ", all.join(", ")) };
        self.job.tell(&format!("submitted: {shards}job {merge} for the merge; `{}`", self.job.folder.display()));
        Ok(())
    }

    /// The shards that wait or run.
    fn elements(&self) -> Result<BTreeSet<usize>, Ending> {
        let words = ["--noheader", "--array", "--me", "--format=%j|%K"].map(str::to_owned);
        let said = ask("squeue", &words, None)?;
        let mut shards = BTreeSet::new();
        for line in said.lines() {
            let Some((name, element)) = line.trim().split_once('|') else { continue };
            let Some(Ok(first)) = name.strip_prefix(&self.prefix()).map(str::parse::<usize>) else { continue };
            shards.extend(element.parse::<usize>().map(|element| first + element));
        }
        Ok(shards)
    }
}

impl Starter for Slurm<'_> {
    fn start(&mut self, shards: &[usize]) -> Result<(), Ending> {
        self.arrays(shards, "").map(drop)
    }

    fn live(&mut self) -> Result<BTreeSet<usize>, Ending> {
        self.elements()
    }

    fn ask_every(&self) -> Duration {
        Duration::from_secs(number(self.profile, "ask_every") as u64)
    }

    fn leave(&mut self) -> String {
        format!("the jobs go on (`scancel --me --name={}…` ends them); ", self.prefix())
    }
}

/// What a command of Slurm says.
fn ask(command: &str, words: &[String], input: Option<&str>) -> Result<String, Ending> {
    let wrong = |problem: String| Ending::Usage(format!("`{command}`: {problem}"));
    let stdin = if input.is_some() { Stdio::piped() } else { Stdio::null() };
    let child = Command::new(command).args(words).stdin(stdin).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut child = child.map_err(|error| wrong(format!("{error}; is Slurm on this machine?")))?;
    if let (Some(input), Some(mut stdin)) = (input, child.stdin.take()) {
        // Whoever does not read it says why when it ends.
        let _ = stdin.write_all(input.as_bytes());
    }
    let output = child.wait_with_output().map_err(|error| wrong(error.to_string()))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    Err(wrong(said.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join("; ")))
}
