//! Shards as elements of Slurm's job arrays.
//!
//! An element is a shard: element t of an array that begins at f is shard f + t, and f is in the job's name, so the queue
//! itself says who is at work, whoever submitted it. Must not know: what a shard computes.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::super::Ending;
use super::super::arguments::Places;
use super::answer::{NO_ANSWER, is_passing, job_number};
use super::profile::{maybe_number, number, words};
use super::{Job, Starter, made, program, quoted};
use declare::record::Record;
use studygraph::runner::shard::ranges;

/// What Slurm has when nobody says.
const ARRAY_SIZE: usize = 1001;
/// The name of the job that merges, behind that of the plan.
const MERGE: &str = "merge";

/// The first pause before Slurm is asked again, and the longest; each is twice the one before.
const FIRST_PAUSE: Duration = Duration::from_secs(1);
const LONGEST_PAUSE: Duration = Duration::from_mins(1);
/// How often a pause looks whether somebody asked to stop.
const LOOK: Duration = Duration::from_millis(100);
/// How often it is looked whether a command has ended.
const ENDED: Duration = Duration::from_millis(10);
/// Characters of an answer that is shown.
const SHOWN: usize = 200;
pub(super) struct Slurm<'a> {
    job: &'a Job<'a>,
    profile: &'a Record,
    /// Elements count from 0 to one less.
    array_size: usize,
    program: String,
    stop: &'a AtomicBool,
    /// The shards that were in the queue when it was seen last, or were submitted since.
    queued: BTreeSet<usize>,
    /// Their jobs and that of the merge: what their names have behind that of the plan, and the numbers that are known.
    jobs: BTreeSet<(String, Option<String>)>,
}

/// An element of a job in the queue.
struct Element {
    /// What the name of the job has behind that of the plan: its first shard, or `merge`.
    name: String,
    index: Option<usize>,
    /// The number of the job.
    job: Option<String>,
}

impl Element {
    fn shard(&self) -> Option<usize> {
        Some(self.name.parse::<usize>().ok()? + self.index?)
    }
}

/// Why a command of Slurm gave no answer.
enum Unanswered {
    /// It may give one later.
    Passing(String),
    Final(Ending),
}

impl<'a> Slurm<'a> {
    /// # Errors
    /// When there is no Slurm that answers.
    pub(super) fn new(job: &'a Job<'a>, profile: &'a Record, stop: &'a AtomicBool) -> Result<Self, Ending> {
        made(&job.folder.join("logs"))?;
        let program = program(profile)?;
        let (queued, jobs) = (BTreeSet::new(), BTreeSet::new());
        let mut slurm = Self { job, profile, array_size: ARRAY_SIZE, program, stop, queued, jobs };
        let said = slurm.patiently(|slurm| slurm.ask("scontrol", &["show".into(), "config".into()], None))?;
        let site =
            said.lines().find_map(|line| line.strip_prefix("MaxArraySize")?.split('=').nth(1)?.trim().parse().ok());
        slurm.array_size = maybe_number(profile, "array_size").or(site).unwrap_or(ARRAY_SIZE).max(2);
        Ok(slurm)
    }

    fn prefix(&self) -> String {
        format!("gs-{}-", &self.job.plan.digest[..12])
    }

    /// Asks until there is an answer, with longer and longer pauses, as long as the profile says.
    fn patiently<T>(&self, mut ask: impl FnMut(&Self) -> Result<T, Unanswered>) -> Result<T, Ending> {
        let (began, patience) = (Instant::now(), Duration::from_secs(number(self.profile, "patience") as u64));
        let mut pause = FIRST_PAUSE.min(self.ask_every());
        loop {
            let problem = match ask(self) {
                Ok(answer) => return Ok(answer),
                Err(Unanswered::Final(ending)) => return Err(ending),
                Err(Unanswered::Passing(problem)) => problem,
            };
            if began.elapsed() + pause > patience {
                return Err(Ending::Usage(problem));
            }
            self.job.tell(&format!("{problem}; asking again in {} s", pause.as_secs()));
            let until = Instant::now() + pause;
            while Instant::now() < until {
                if self.stop.load(Ordering::Relaxed) {
                    return Err(Ending::Stopped);
                }
                std::thread::sleep(LOOK);
            }
            pause = (2 * pause).min(LONGEST_PAUSE);
        }
    }

    /// Submits a script for these shards; the number of its job. `is_there` finds it in the queue: sbatch may have failed after
    /// the job was taken.
    fn submit(
        &mut self,
        name: &str,
        (options, script): (&[String], &str),
        shards: &[usize],
        is_there: &dyn Fn(&Element) -> bool,
    ) -> Result<String, Ending> {
        let mut all = vec!["--parsable".to_owned(), format!("--job-name={}{name}", self.prefix())];
        for (field, option) in [("partition", "partition"), ("account", "account"), ("time", "time"), ("memory", "mem")]
        {
            all.extend(self.profile.maybe_text(field).map(|value| format!("--{option}={value}")));
        }
        all.push(format!("--cpus-per-task={}", number(self.profile, "processors")));
        all.extend(words(self.profile, "options"));
        all.extend_from_slice(options);
        let before = self.profile.maybe_text("before").map(|line| format!("{line}\n")).unwrap_or_default();
        let script = format!("#!/bin/sh\n{before}{script}\n");
        let mut is_first = true;
        let taken = self.patiently(|slurm| {
            if !std::mem::take(&mut is_first)
                && let Some(found) = slurm.queue_once()?.into_iter().find(is_there)
            {
                return Ok(Ok(found.job.unwrap_or_default()));
            }
            let said = match slurm.ask("sbatch", &all, Some(&script)) {
                // What is wrong with the job is so every time.
                Err(Unanswered::Passing(problem)) if !is_passing(&problem) => {
                    return Err(Unanswered::Final(Ending::Usage(problem)));
                }
                said => said?,
            };
            if let Some(job) = job_number(&said) {
                return Ok(Ok(job.to_owned()));
            }
            // The job was taken, so another one is not sent for it.
            if let Some(job) = slurm.queue_once()?.into_iter().find(is_there).and_then(|found| found.job) {
                return Ok(Ok(job));
            }
            let said: String = said.trim().escape_debug().take(SHOWN).collect();
            Ok(Err(format!("`sbatch` did not say the number of its job as its last line, but `{said}`")))
        })?;
        self.queued.extend(shards);
        self.jobs.insert((name.to_owned(), taken.clone().ok().filter(|job| !job.is_empty())));
        taken.map_err(Ending::Usage)
    }

    /// Submits arrays for these shards; the numbers of the jobs.
    fn arrays(&mut self, shards: &[usize], after: &str) -> Result<Vec<String>, Ending> {
        let mut jobs = Vec::new();
        let size = self.array_size;
        for block in shards.chunk_by(|one, next| one / size == next / size) {
            let first = block[0] / size * size;
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
            let is_there = |found: &Element| found.shard().is_some_and(|shard| block.contains(&shard));
            jobs.push(self.submit(&first.to_string(), (&options, &script), block, &is_there)?);
        }
        Ok(jobs)
    }

    /// Submits all levels and the merge, each after the one before, or what is not in the queue yet of a chain that was
    /// begun; nobody watches them.
    ///
    /// # Errors
    /// When Slurm refuses; when all is in the queue already.
    pub(super) fn chain(&mut self, places: &Places) -> Result<(), Ending> {
        let job = self.job;
        let queue = self.queue().map_err(|ending| job.given_up(ending, ""))?;
        if let Some(merge) = queue.iter().find(|found| found.name == MERGE) {
            return Err(Ending::Usage(format!("{}: {}", job.plan.study, self.with_merge(merge))));
        }
        let chained = self.chained(places, &queue);
        let has_merge = self.jobs.iter().any(|(name, _)| name == MERGE);
        chained.map_err(|ending| job.given_up(ending, &self.in_queue(if has_merge { "" } else { " without a merge" })))
    }

    /// That a chain is in the queue to its end.
    fn with_merge(&self, merge: &Element) -> String {
        let number = merge.job.as_deref().map(|job| format!(", job {job},")).unwrap_or_default();
        let (shards, is, go, them) = match &self.queued {
            none if none.is_empty() => (String::new(), "is", "goes", "it"),
            some => (format!("shards {} and ", ranges(some.iter().copied())), "are", "go", "them"),
        };
        let cancel = self.cancel();
        format!("{shards}the merge{number} {is} in the queue already and {go} on (`{cancel}` ends {them})")
    }

    fn chained(&mut self, places: &Places, queue: &[Element]) -> Result<(), Ending> {
        let live: BTreeSet<usize> = queue.iter().filter_map(Element::shard).collect();
        if let Some(nameless) = queue.iter().find(|found| found.shard().is_some() && found.job.is_none()) {
            let shard = nameless.shard().unwrap_or_default();
            return Err(Ending::Usage(format!(
                "shard {shard} is in the queue already, and Slurm does not say in which job"
            )));
        }
        let mut after = String::new();
        let mut all = Vec::new();
        for level in &self.job.plan.levels {
            let missing = self.job.missing(level.first..level.end)?;
            let (begun, missing): (Vec<usize>, Vec<usize>) =
                missing.into_iter().partition(|shard| live.contains(shard));
            let of_level = |found: &&Element| found.shard().is_some_and(|shard| begun.contains(&shard));
            let begun: BTreeSet<String> = queue.iter().filter(of_level).filter_map(|found| found.job.clone()).collect();
            let mut jobs: Vec<String> = begun.into_iter().collect();
            if !missing.is_empty() {
                jobs.extend(self.arrays(&missing, &after)?);
            }
            if jobs.iter().any(String::is_empty) {
                return Err(Ending::Usage("`squeue` did not say the numbers of the jobs".to_owned()));
            }
            if !jobs.is_empty() {
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
        let is_there = |found: &Element| found.name == MERGE;
        let merge = self.submit(MERGE, (&options, &script), &[], &is_there)?;
        let shards = if all.is_empty() { String::new() } else { format!("jobs {} for the shards, ", all.join(", ")) };
        self.job.tell(&format!("submitted: {shards}job {merge} for the merge; `{}`", self.job.folder.display()));
        Ok(())
    }

    /// What is in the queue of this plan.
    fn queue(&mut self) -> Result<Vec<Element>, Ending> {
        let queue = self.patiently(Self::queue_once)?;
        self.queued = queue.iter().filter_map(Element::shard).collect();
        self.jobs = queue.iter().map(|found| (found.name.clone(), found.job.clone())).collect();
        Ok(queue)
    }

    fn queue_once(&self) -> Result<Vec<Element>, Unanswered> {
        let words = ["--noheader", "--array", "--me", "--format=%j|%K|%F"].map(str::to_owned);
        let said = self.ask("squeue", &words, None)?;
        let prefix = self.prefix();
        let element = |line: &str| {
            let mut fields = line.trim().split('|');
            let name = fields.next()?.strip_prefix(&prefix)?.to_owned();
            let index = fields.next()?.parse().ok();
            Some(Element { name, index, job: fields.next().and_then(job_number).map(str::to_owned) })
        };
        Ok(said.lines().filter_map(element).collect())
    }

    /// What a command of Slurm says.
    fn ask(&self, command: &str, words: &[String], input: Option<&str>) -> Result<String, Unanswered> {
        let wrong = |problem: String| format!("`{command}`: {problem}");
        let passing = |error: io::Error| Unanswered::Passing(wrong(error.to_string()));
        // Files and not pipes: what the command has started may have the other end of a pipe for ever.
        let (mut said, mut problems) = (tempfile::tempfile().map_err(passing)?, tempfile::tempfile().map_err(passing)?);
        let stdin = if input.is_some() { Stdio::piped() } else { Stdio::null() };
        let mut called = Command::new(command);
        called.args(words).stdin(stdin).stdout(said.try_clone().map_err(passing)?);
        let child = called.stderr(problems.try_clone().map_err(passing)?).spawn();
        let mut child = child.map_err(|error| match error.kind() {
            ErrorKind::NotFound | ErrorKind::PermissionDenied => {
                Unanswered::Final(Ending::Usage(wrong(format!("{error}; is Slurm on this machine?"))))
            }
            // This machine has no process to give at the moment.
            _ => passing(error),
        })?;
        if let (Some(input), Some(mut stdin)) = (input, child.stdin.take()) {
            // Whoever does not read it says why when it ends.
            let _ = stdin.write_all(input.as_bytes());
        }
        let limit = Duration::from_secs(number(self.profile, "answer_time") as u64);
        let began = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().map_err(passing)? {
                break status;
            }
            // A job that is being submitted is waited for, since it would be in the queue without a number.
            let is_stopped = input.is_none() && self.stop.load(Ordering::Relaxed);
            if is_stopped || began.elapsed() >= limit {
                // What has ended in this moment cannot be ended.
                let _ = child.kill();
                let _ = child.wait();
                return Err(if is_stopped {
                    Unanswered::Final(Ending::Stopped)
                } else {
                    Unanswered::Passing(wrong(format!("{NO_ANSWER} {} s", limit.as_secs())))
                });
            }
            std::thread::sleep(ENDED);
        };
        if status.success() {
            return written(&mut said).map_err(passing);
        }
        let said = written(&mut problems).map_err(passing)?;
        let lines: Vec<&str> = said.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        let said = if lines.is_empty() { status.to_string() } else { lines.join("; ") };
        Err(Unanswered::Passing(wrong(said)))
    }

    /// Which jobs are in the queue, with their shards, and what ends them.
    fn in_queue(&self, how: &str) -> String {
        if self.jobs.is_empty() {
            return String::new();
        }
        let named = |(name, job): &(String, Option<String>)| match job {
            Some(job) => job.clone(),
            None => format!("`{}{name}`", self.prefix()),
        };
        let jobs: Vec<String> = self.jobs.iter().map(named).collect();
        let (jobs, cancel) = (jobs.join(", "), self.cancel());
        let (is, go, them) = if self.jobs.len() == 1 { ("job", "goes", "it") } else { ("jobs", "go", "them") };
        let shards = match &self.queued {
            none if none.is_empty() => String::new(),
            some => format!("shards {} are in the queue{how}: ", ranges(some.iter().copied())),
        };
        format!("{shards}{is} {jobs} {go} on (`{cancel}` ends {them}); ")
    }

    /// The command that ends all jobs in the queue: by their numbers, and by name where these are not known.
    fn cancel(&self) -> String {
        let numbers: Vec<&str> = self.jobs.iter().filter_map(|(_, job)| job.as_deref()).collect();
        let by_number = (!numbers.is_empty()).then(|| format!("scancel {}", numbers.join(" ")));
        let nameless = self.jobs.iter().filter(|(_, job)| job.is_none());
        let by_name = nameless.map(|(name, _)| format!("scancel --me --name={}{name}", self.prefix()));
        by_number.into_iter().chain(by_name).collect::<Vec<_>>().join("; ")
    }
}

/// All that a command wrote into a file.
fn written(file: &mut File) -> io::Result<String> {
    let mut bytes = Vec::new();
    file.rewind()?;
    file.read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

impl Starter for Slurm<'_> {
    fn start(&mut self, shards: &[usize]) -> Result<(), Ending> {
        self.arrays(shards, "").map(drop)
    }

    fn live(&mut self) -> Result<BTreeSet<usize>, Ending> {
        Ok(self.queue()?.iter().filter_map(Element::shard).collect())
    }

    fn ask_every(&self) -> Duration {
        Duration::from_secs(number(self.profile, "ask_every") as u64)
    }

    fn leave(&mut self) -> String {
        self.in_queue("")
    }
}
