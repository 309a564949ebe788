//! A folder in which the program is run as a user runs it.

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// An empty folder with one study in it.
pub struct Desk {
    folder: TempDir,
}

impl Desk {
    pub fn with(study: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies").join(study);
        fs::copy(source, folder.path().join(study)).unwrap();
        Self { folder }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
        command.current_dir(self.folder.path()).env_remove("GEARSTUDY_CACHE").args(words);
        command
    }

    /// Runs a command that must end with `code`; its standard output and standard error.
    pub fn run(&self, words: &[&str], code: i32) -> (String, String) {
        let output = self.command(words).output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        assert_eq!(output.status.code(), Some(code), "{words:?}\n{out}\n{err}");
        (out, err)
    }

    pub fn manifest(&self, study: &str) -> Value {
        let path = self.path("results").join(study).join("manifest.json");
        serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
    }

    /// `stage.table` and its content hash, for every table of the last run.
    pub fn contents(&self, study: &str) -> Vec<(String, String)> {
        let manifest = self.manifest(study);
        let stages = manifest["stages"].as_array().unwrap();
        let tables = stages.iter().flat_map(|stage| stage["tables"].as_array().unwrap().clone());
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        tables.map(|table| (text(&table["name"]), text(&table["content"]))).collect()
    }

    /// Every stage of the last run and how it ended.
    pub fn statuses(&self, study: &str) -> Vec<(String, String)> {
        Self::statuses_of(&self.manifest(study))
    }

    /// The stages that the last run computed.
    pub fn ran(&self, study: &str) -> Vec<String> {
        self.statuses(study).into_iter().filter(|(_, status)| status == "ran").map(|(name, _)| name).collect()
    }

    fn statuses_of(manifest: &Value) -> Vec<(String, String)> {
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        manifest["stages"]
            .as_array()
            .unwrap()
            .iter()
            .map(|stage| (text(&stage["name"]), text(&stage["status"])))
            .collect()
    }
}
