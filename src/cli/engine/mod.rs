//! `run --engine`: a study in pieces by a program that starts them elsewhere, watched by what they leave.
//!
//! An engine is told which shards are missing and starts `shard run` for each; whether one is done is seen by its file
//! alone. So it does not matter who started it, or how often, and the same command goes on from where it was. Must not
//! know: what a shard holds, how any engine is spoken to.

mod answer;
pub(super) mod kubernetes;
mod parallel;
mod profile;
mod slurm;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::arguments::{Elsewhere, Engine, Limits, Places, Selection};
use super::events::Lines;
use super::progress::{self, tell};
use super::shard::Told;
use super::signals::stop_flag;
use super::{Ending, shard};
use declare::number::counted;
use declare::record::Record;
use studygraph::runner::shard::{ShardPlan, State, failed_file, ranges, state};
use studygraph::study::Study;

/// How often it is looked for new files.
const LOOK: Duration = Duration::from_millis(300);
/// And, for many missing ones, what looking for one may cost a file system that others use too.
const LOOK_AT_ONE: Duration = Duration::from_millis(1);
/// Pieces, where nobody says how many.
const SHARDS: u32 = 64;

/// What starts shards.
trait Starter {
    /// Starts these shards; they are all of one level.
    ///
    /// # Errors
    /// When it refuses.
    fn start(&mut self, shards: &[usize]) -> Result<(), Ending>;

    /// The shards that it may still run, as far as it knows.
    ///
    /// # Errors
    /// When it does not answer.
    fn live(&mut self) -> Result<BTreeSet<usize>, Ending>;

    /// How long to wait before it is asked again.
    fn ask_every(&self) -> Duration;

    /// What to do when the user stops watching, and what to say of those that run on.
    fn leave(&mut self) -> String;
}

/// Runs every study in pieces, one after the other.
pub(super) fn run(
    studies: &[Study],
    places: &Places,
    selection: &Selection,
    limits: &Limits,
    jobs: Option<usize>,
    elsewhere: &Elsewhere,
    told: Told,
) -> Result<(), Ending> {
    let stop = stop_flag(None);
    for study in studies {
        let into = elsewhere.into.clone().unwrap_or_else(|| shard::default_folder(study));
        let shards = elsewhere.shards.unwrap_or(SHARDS) as usize;
        let plan = shard::planned(study, places, selection, shards, &into, Told::Nothing)?;
        let folder =
            std::path::absolute(&into).map_err(|error| Ending::Usage(format!("{}: {error}", into.display())))?;
        let job = Job { plan: &plan, folder, told };
        // Whatever failed before is tried again: it is the user who asks.
        for index in 0..plan.shards.len() {
            let _ = std::fs::remove_file(failed_file(&job.folder, index));
        }
        match elsewhere.engine {
            None => {}
            Some(Engine::Slurm) => {
                let profile = profile::read(elsewhere.profile.as_deref(), profile::SLURM)?;
                let mut slurm = slurm::Slurm::new(&job, &profile, &stop)?;
                if elsewhere.detach {
                    slurm.chain(places)?;
                    continue;
                }
                job.watch(&mut slurm, profile::attempts(&profile), &stop)?;
            }
            Some(Engine::Parallel) => {
                if elsewhere.detach {
                    return Err(Ending::Usage(
                        "`--detach` is for engines with a queue of their own; use nohup".to_owned(),
                    ));
                }
                let profile = profile::read(elsewhere.profile.as_deref(), profile::PARALLEL)?;
                let mut parallel = parallel::Parallel::new(&job, &profile)?;
                job.watch(&mut parallel, profile::attempts(&profile), &stop)?;
            }
        }
        shard::merge(&job.folder, places, limits, jobs, told)?;
    }
    Ok(())
}

/// A plan that is run elsewhere.
struct Job<'a> {
    plan: &'a ShardPlan,
    /// Absolute: jobs start in folders of their own.
    folder: PathBuf,
    told: Told,
}

impl Job<'_> {
    fn tell(&self, text: &str) {
        match self.told {
            Told::Nothing => {}
            Told::Words => tell(&format!("{}: {text}\n", self.plan.study)),
            Told::Json => Lines::named(&self.plan.study).note(text),
        }
    }

    /// Those that are not there; a message where a stage failed, which no other attempt changes.
    fn missing(&self, among: impl IntoIterator<Item = usize>) -> Result<Vec<usize>, Ending> {
        let mut missing = Vec::new();
        for index in among {
            match state(&self.folder, self.plan, index, false) {
                State::Sound => {}
                State::Missing | State::Damaged(_) => missing.push(index),
                State::Failed(message) => return Err(Ending::Failed(format!("shard {index}: {message}"))),
            }
        }
        Ok(missing)
    }

    /// Starts what is missing, level by level, until all is there. A shard that is neither there nor run by anybody any
    /// more was lost; it is started again, at most `attempts` times in all.
    fn watch(&self, starter: &mut dyn Starter, attempts: usize, stop: &AtomicBool) -> Result<(), Ending> {
        let watched = self.watched(starter, attempts, stop);
        watched.map_err(|ending| match ending {
            // What a stage or a shard says is not mended by waiting.
            Ending::Failed(_) => ending,
            ending => self.given_up(ending, &starter.leave()),
        })
    }

    /// An ending that says how to go on; `left` is a sentence about what goes on by itself.
    fn given_up(&self, ending: Ending, left: &str) -> Ending {
        let how = format!("{left}the same command goes on from here");
        match ending {
            Ending::Stopped => {
                progress::aside(None, &format!("gearstudy: {how}"));
                Ending::Stopped
            }
            Ending::Usage(problem) => Ending::Usage(format!("{}: {problem}; {how}", self.plan.study)),
            other => other,
        }
    }

    fn watched(&self, starter: &mut dyn Starter, attempts: usize, stop: &AtomicBool) -> Result<(), Ending> {
        let mut started: BTreeMap<usize, usize> = BTreeMap::new();
        for level in &self.plan.levels {
            loop {
                let missing = self.missing(level.first..level.end)?;
                if missing.is_empty() {
                    break;
                }
                let live = starter.live()?;
                let lost: Vec<usize> = missing.iter().copied().filter(|index| !live.contains(index)).collect();
                let hopeless: Vec<usize> = lost
                    .iter()
                    .copied()
                    .filter(|index| started.get(index).is_some_and(|times| *times >= attempts))
                    .collect();
                if !hopeless.is_empty() {
                    let (shards, were) = if hopeless.len() == 1 { ("shard", "was") } else { ("shards", "were") };
                    let message = format!(
                        "{shards} {} {were} started {} and left nothing; their output is in `{}`",
                        ranges(hopeless),
                        counted(attempts, "time"),
                        self.folder.join("logs").display()
                    );
                    return Err(Ending::Failed(message));
                }
                if !lost.is_empty() {
                    self.tell(&format!(
                        "starting {} of {} shards: {}",
                        lost.len(),
                        self.plan.shards.len(),
                        ranges(lost.iter().copied())
                    ));
                    for index in &lost {
                        *started.entry(*index).or_default() += 1;
                    }
                    starter.start(&lost)?;
                }
                self.wait(starter, level.end - level.first, missing, stop)?;
            }
        }
        Ok(())
    }

    /// Until all that is missing of a level of `count` shards is there, or some of it was lost. What is there is not looked
    /// at again.
    fn wait(
        &self,
        starter: &mut dyn Starter,
        count: usize,
        mut missing: Vec<usize>,
        stop: &AtomicBool,
    ) -> Result<(), Ending> {
        let mut asked = Instant::now();
        // A file may be seen on this machine a moment after its job has gone from the queue: lost is what is lost twice.
        let mut lost_before = false;
        while !missing.is_empty() {
            std::thread::sleep(LOOK.max(LOOK_AT_ONE * u32::try_from(missing.len()).unwrap_or(u32::MAX)));
            if stop.load(Ordering::Relaxed) {
                return Err(Ending::Stopped);
            }
            let before = missing.len();
            missing = self.missing(missing)?;
            if missing.len() < before {
                self.tell(&format!("{} of {count} shards are there", count - missing.len()));
            }
            if !missing.is_empty() && asked.elapsed() >= starter.ask_every() {
                asked = Instant::now();
                let live = starter.live()?;
                let lost = missing.iter().any(|index| !live.contains(index));
                if lost && lost_before {
                    return Ok(());
                }
                lost_before = lost;
            }
        }
        Ok(())
    }
}

/// The program itself, where the profile names no other.
fn program(profile: &Record) -> Result<String, Ending> {
    if let Some(named) = profile.maybe_text("program") {
        return Ok(quoted(named));
    }
    let own = std::env::current_exe()
        .map_err(|error| Ending::Usage(format!("where this program lies is not known: {error}")))?;
    Ok(quoted(&own.to_string_lossy()))
}

/// As a shell reads one word.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/-_.=:,@+".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

fn made(folder: &Path) -> Result<(), Ending> {
    std::fs::create_dir_all(folder)
        .map_err(|error| Ending::Usage(format!("cannot make `{}`: {error}", folder.display())))
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn words_survive_a_shell() {
        for word in ["", "plain/word-1.2", "two words", "it's", "a\"b", "$(false)", "`x`", "a\\b", "*"] {
            let output =
                std::process::Command::new("sh").arg("-c").arg(format!("printf %s {}", quoted(word))).output().unwrap();
            assert_eq!(String::from_utf8(output.stdout).unwrap(), word);
        }
    }
}
