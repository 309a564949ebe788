//! CalculiX as a program: where it is, one run in a folder of its own, and the tables it prints.
//!
//! `$GEARSTUDY_CCX` or `ccx` on the path. Where there is none the check is skipped, loudly, except in continuous
//! integration (`$CI`): there, and where one is named that does not work, that is a failure.

use std::env;
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::Command;

fn program() -> Option<PathBuf> {
    if let Some(named) = env::var_os("GEARSTUDY_CCX").filter(|named| !named.is_empty()) {
        return Some(named.into());
    }
    env::split_paths(&env::var_os("PATH")?).map(|folder| folder.join("ccx")).find(|program| program.is_file())
}

/// Runs a deck, which must end well; what its PRINT cards print.
pub fn run(check: &str, deck: &str) -> Option<Printed> {
    let Some(program) = program() else {
        let missing =
            format!("{check}: no `ccx` and no $GEARSTUDY_CCX; `make setup` installs it (Debian: calculix-ccx)");
        assert!(env::var_os("CI").is_none_or(|set| set.is_empty()), "{missing}");
        // Past the capture of a test that passes: nobody shall take this for a check that was made.
        std::io::stderr().write_all(format!("\nSKIPPED: {missing}\n").as_bytes()).unwrap();
        return None;
    };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("deck.inp"), deck).unwrap();
    let output = Command::new(&program)
        .arg("deck")
        .current_dir(folder.path())
        .env("OMP_NUM_THREADS", env::var_os("OMP_NUM_THREADS").unwrap_or_else(|| "2".into()))
        .output()
        .unwrap_or_else(|error| panic!("{}: {error}", program.display()));
    let log = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && log.contains("Job finished"), "{check}:\n{log}");
    Some(Printed(fs::read_to_string(folder.path().join("deck.dat")).unwrap()))
}

/// The `.dat` file.
pub struct Printed(String);

impl Printed {
    /// The rows of the last table whose heading starts with `heading`: all their numbers.
    pub fn table(&self, heading: &str) -> Vec<Vec<f64>> {
        (self.after(heading).lines().skip(1).skip_while(|line| line.trim().is_empty()))
            .take_while(|line| !line.trim().is_empty())
            .map(numbers)
            .collect()
    }

    /// The row under `words` in what follows `heading`.
    pub fn total(&self, heading: &str, words: &str) -> Vec<f64> {
        let text = self.after(heading);
        let row = text[text.find(words).unwrap()..].lines().skip(1).find(|line| !line.trim().is_empty());
        numbers(row.unwrap())
    }

    fn after(&self, heading: &str) -> &str {
        &self.0[self.0.rfind(heading).unwrap_or_else(|| panic!("no `{heading}` in\n{}", self.0))..]
    }
}

fn numbers(row: &str) -> Vec<f64> {
    row.split_whitespace().map(|word| word.parse().unwrap_or_else(|_| panic!("{row}"))).collect()
}
