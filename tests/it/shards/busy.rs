//! A scheduler that is busy, refuses for the moment, or prints more than it is asked for. Stand-ins take the place of Slurm's
//! commands: an array is run by `sbatch` itself, or with `HOLD` only put into the queue.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::{assert_as_local, swept};
use crate::desk::Desk;

/// `FAIL_sbatch` and so on: the calls that fail, by their numbers; `HANG_sbatch`: those that never end; `TAKEN`: sbatch takes the job before it fails; `WRONG`: it
/// says that the job is wrong; `BANNER`: it prints one; `WORDS`: it says the number in words, and the queue does not show the job yet.
const STAND_IN: &str = r#"#!/bin/sh
called=$(basename "$0"); cd "$QUEUE" || exit 9
n=$(($(cat $called.count 2>/dev/null || echo 0) + 1)); echo $n > $called.count; echo "$@" >> $called.log
eval fails=\"\$FAIL_$called\"
eval hangs=\"\$HANG_$called\"
case " $hangs " in *" $n "*) sleep 120;; esac
fail() {
    case " $fails " in *" $n "*|" all ")
        if [ -n "$WRONG" ]; then echo "$called: error: invalid account" >&2
        else echo "$called: error: Socket timed out on send/recv operation" >&2; fi
        exit 1;; esac
}
case $called in
scontrol) fail; echo "MaxArraySize            = 100";;
squeue) fail; cat queue 2>/dev/null; true;;
sbatch)
    cat > script.$n
    [ -n "$TAKEN" ] || fail
    for word; do case $word in --job-name=*) name=${word#*=};; --array=*) array=${word#*=};; esac; done
    for part in $(echo "$array" | tr , ' '); do for i in $(seq ${part%-*} ${part#*-}); do
        if [ -n "$WORDS" ]; then :; elif [ -n "$HOLD" ]; then echo "$name|$i|$((100 + n))" >> queue
        else SLURM_ARRAY_TASK_ID=$i sh script.$n > log.$n.$i 2>&1; fi
    done; done
    [ -n "$array" ] || echo "$name|N/A|$((100 + n))" >> queue
    fail
    [ -z "$BANNER" ] || printf -- '-----------\n  Welcome to job 7\n-----------\n'
    if [ -n "$WORDS" ]; then echo "Submitted batch job $((100 + n))"; else echo $((100 + n)); fi;;
esac
"#;

struct Site(Desk);

impl Site {
    fn new() -> Self {
        let desk = swept();
        fs::create_dir(desk.path("bin")).unwrap();
        for name in ["sbatch", "squeue", "scontrol"] {
            let path = desk.path("bin").join(name);
            fs::write(&path, STAND_IN).unwrap();
            assert!(Command::new("chmod").arg("755").arg(&path).status().unwrap().success());
        }
        fs::write(desk.path("site.yaml"), "ask_every: 1\npatience: 20\n").unwrap();
        fs::write(desk.path("hasty.yaml"), "ask_every: 1\npatience: 0\n").unwrap();
        fs::create_dir(desk.path("queue")).unwrap();
        Self(desk)
    }

    /// Runs the study; code and everything that was said.
    fn run(&self, words: &[&str], set: &[(&str, &str)]) -> (Option<i32>, String) {
        let path = format!("{}:{}", self.0.path("bin").display(), std::env::var("PATH").unwrap());
        let all = ["run", "swept.yaml", "--engine", "slurm", "--shards", "4", "--into", "plan"];
        let mut command = self.0.command(&[&all[..], words].concat());
        command.env("PATH", path).env("QUEUE", self.0.path("queue")).envs(set.iter().copied());
        let output = command.output().unwrap();
        let said = [output.stdout, output.stderr].concat();
        (output.status.code(), String::from_utf8(said).unwrap())
    }

    fn lines(&self, log: &str) -> Vec<String> {
        let text = fs::read_to_string(self.0.path("queue").join(log)).unwrap_or_default();
        text.lines().map(str::to_owned).collect()
    }
}

fn site_yaml(detach: bool) -> Vec<&'static str> {
    if detach { vec!["--profile", "site.yaml", "--detach"] } else { vec!["--profile", "site.yaml"] }
}

#[test]
fn a_scheduler_that_is_busy_once_is_asked_again() {
    let site = Site::new();
    let set = [("FAIL_sbatch", "1"), ("FAIL_squeue", "1 2"), ("FAIL_scontrol", "1")];
    let (code, said) = site.run(&site_yaml(false), &set);
    assert!(code == Some(0) && said.contains("asking again in 1 s"), "{said}");
    assert_eq!(site.lines("sbatch.log").len(), 2, "{said}");
    assert_as_local(&site.0);
}

#[test]
fn a_banner_is_not_the_number_of_a_job() {
    let site = Site::new();
    let (code, said) = site.run(&site_yaml(true), &[("HOLD", "1"), ("BANNER", "1")]);
    assert!(code == Some(0) && said.contains("submitted: jobs 101 for the shards, job 102 for the merge"), "{said}");
    assert!(site.lines("sbatch.log")[1].contains("--dependency=afterok:101 "), "{:?}", site.lines("sbatch.log"));
}

/// A job that was taken is named, with the command that ends it, also where its number is not known.
#[test]
fn jobs_that_are_queued_are_named_when_the_number_of_the_next_is_not() {
    for detach in [true, false] {
        let site = Site::new();
        let (code, said) = site.run(&site_yaml(detach), &[("WORDS", "1")]);
        let name =
            site.lines("sbatch.log")[0].split("--job-name=").nth(1).unwrap().split(' ').next().unwrap().to_owned();
        let queued = if detach { "shards 0-3 are in the queue without a merge" } else { "shards 0-3 are in the queue" };
        let ends =
            format!("{queued}: job `{name}` goes on (`scancel --me --name={name}` ends it); the same command goes on");
        assert!(code == Some(1) && said.contains("but `Submitted batch job 101`") && said.contains(&ends), "{said}");
    }
    // The merge alone, after the shards said theirs.
    let site = Site::new();
    let stand_in = STAND_IN.replace("$WORDS", "$(echo \"$name\" | grep merge)");
    fs::write(site.0.path("bin/sbatch"), stand_in.replace("|N/A|", "|N/A|none")).unwrap();
    let (code, said) = site.run(&site_yaml(true), &[("HOLD", "1")]);
    assert!(code == Some(1) && said.contains("`Submitted batch job 102`"), "{said}");
    assert!(said.contains("shards 0-3 are in the queue: jobs 101, `gs-") && said.contains("-merge`"), "{said}");
    assert!(said.contains("(`scancel 101; scancel --me --name=gs-") && !said.contains("without a merge"), "{said}");
}

/// The answer was lost, the job was not: another one would do the work twice.
#[test]
fn a_job_whose_answer_was_lost_is_not_submitted_again() {
    let site = Site::new();
    let (code, said) = site.run(&site_yaml(true), &[("HOLD", "1"), ("TAKEN", "1"), ("FAIL_sbatch", "1 2")]);
    assert!(code == Some(0) && said.contains("job 102 for the merge"), "{said}");
    let submitted = site.lines("sbatch.log");
    assert!(submitted.len() == 2 && submitted[1].contains("--dependency=afterok:101 "), "{submitted:?}");
}

#[test]
fn a_chain_that_was_begun_is_completed_by_the_same_command() {
    let site = Site::new();
    let hold = ("HOLD", "1");
    let (code, said) = site.run(&site_yaml(true), &[hold, ("FAIL_sbatch", "2"), ("WRONG", "1")]);
    assert!(code == Some(1) && said.contains("invalid account"), "{said}");
    assert!(
        said.contains("shards 0-3 are in the queue without a merge") && said.contains("the same command goes on"),
        "{said}"
    );
    let (code, said) = site.run(&site_yaml(true), &[hold]);
    assert_eq!(code, Some(0), "{said}");
    let submitted = site.lines("sbatch.log");
    assert!(
        submitted.len() == 3 && submitted[2].contains("-merge") && submitted[2].contains("afterok:101 "),
        "{submitted:?}"
    );
    let (code, said) = site.run(&site_yaml(true), &[hold]);
    assert!(code == Some(1) && said.contains("shards 0-3 and the merge, job 103, are in the queue already"), "{said}");
    assert!(!said.contains("without a merge") && !said.contains("the same command goes on"), "{said}");
    // The merge alone.
    let merge = site.lines("queue").into_iter().filter(|line| line.contains("-merge|")).collect::<String>();
    fs::write(site.0.path("queue/queue"), merge + "\n").unwrap();
    let (code, said) = site.run(&site_yaml(true), &[hold]);
    assert!(code == Some(1) && said.contains("swept: the merge, job 103, is in the queue already"), "{said}");
}

/// A call that never ends is given up, and made again as one that failed.
#[test]
fn a_scheduler_that_hangs_is_asked_again() {
    let site = Site::new();
    fs::write(site.0.path("short.yaml"), "ask_every: 1\npatience: 20\nanswer_time: 2\n").unwrap();
    let began = std::time::Instant::now();
    let set = [("HANG_sbatch", "1"), ("HANG_squeue", "1"), ("HANG_scontrol", "1")];
    let (code, said) = site.run(&["--profile", "short.yaml", "--detach"], &[&set[..], &[("HOLD", "1")]].concat());
    assert!(code == Some(0) && said.contains("job 103 for the merge"), "{said}");
    for command in ["scontrol", "squeue", "sbatch"] {
        assert!(said.contains(&format!("`{command}`: no answer in 2 s; asking again")), "{command}: {said}");
    }
    assert!(began.elapsed() < std::time::Duration::from_mins(1));
}

#[test]
fn a_scheduler_that_never_answers_is_given_up_with_the_way_on() {
    let site = Site::new();
    let words = ["--profile", "hasty.yaml"];
    let (code, said) = site.run(&words, &[("FAIL_squeue", "all")]);
    assert!(
        code == Some(1) && said.contains("Socket timed out") && said.contains("the same command goes on"),
        "{said}"
    );
    // It failed after hours: what is in the queue is said.
    let (code, said) = site.run(&words, &[("HOLD", "1"), ("FAIL_squeue", "3 4 5 6")]);
    assert!(
        code == Some(1) && said.contains("shards 0-3 are in the queue: job 101 goes on (`scancel 101` ends it)"),
        "{said}"
    );
    assert!(Path::new(&site.0.path("plan/plan.json")).exists());
}
