//! Answers of the commands of Slurm: the number of a job, and whether a refusal may pass.
//!
//! Must not know: what is submitted.

/// What is said of a command that does not end.
pub(super) const NO_ANSWER: &str = "no answer in";
/// What sbatch says where it, or the site's limit on jobs, refuses for the moment. All else is wrong with the job.
const PASSING: [&str; 13] = [
    NO_ANSWER,
    "timed out",
    "timeout",
    "unable to contact",
    "connection refused",
    "connection reset",
    "communication connection failure",
    "temporarily unavailable",
    "temporarily disabled",
    "zero bytes were transmitted",
    "slurm backup controller in standby mode",
    "too many",
    "limit",
];

/// The number of the job that sbatch has taken: the last line that is `number` or `number;cluster`. Sites print more before.
pub(super) fn job_number(said: &str) -> Option<&str> {
    let number = |line: &str| {
        let (number, cluster) = line.split_once(';').unwrap_or((line, "-"));
        let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
        (is_number && !cluster.is_empty() && !cluster.contains(char::is_whitespace)).then_some(number.len())
    };
    said.lines().rev().map(str::trim).find_map(|line| number(line).map(|length| &line[..length]))
}

pub(super) fn is_passing(problem: &str) -> bool {
    let problem = problem.to_ascii_lowercase();
    PASSING.iter().any(|words| problem.contains(words))
}

#[cfg(test)]
mod tests {
    use super::{is_passing, job_number};

    /// sbatch(1), `--parsable`: the number, and behind a semicolon the cluster if there is one.
    #[test]
    fn the_number_of_a_job_is_the_last_line_that_is_one() {
        for (said, expected) in [
            ("101\n", Some("101")),
            ("101;ci\n", Some("101")),
            ("-----\n  Welcome to the site\n-----\n101\n", Some("101")),
            ("No reservation 7\n 101;ci \n\nbye\n", Some("101")),
            ("-----\n", None),
            ("", None),
            ("Submitted batch job 101\n", None),
            ("101;\n", None),
            ("101; two words\n", None),
        ] {
            assert_eq!(job_number(said), expected, "{said:?}");
        }
    }

    #[test]
    fn a_busy_service_is_told_from_a_wrong_job() {
        for passing in [
            "`sbatch`: sbatch: error: Batch job submission failed: Socket timed out on send/recv operation",
            "`sbatch`: sbatch: error: AssocMaxSubmitJobLimit; Job violates accounting/QOS policy (job submit limit, …)",
            "`sbatch`: Unable to contact slurm controller (connect failure)",
        ] {
            assert!(is_passing(passing), "{passing}");
        }
        assert!(!is_passing("`sbatch`: error: invalid partition specified: no_such"));
    }
}
