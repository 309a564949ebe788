//! A system that starts no more threads (a limit on processes, on a job's tasks): one message and code 1, or the work is done
//! without them; never a panic.

use std::fs;
use std::io::Write;
use std::process::{Command, Output, Stdio};

use super::disk;
use crate::desk::Desk;

/// Runs a command of which the thread with this number, and those after it, cannot be started.
fn without(desk: &Desk, first: usize, words: &[&str], input: &[u8]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
    command.current_dir(desk.path("")).env_remove("GEARSTUDY_CACHE").args(words);
    command.env("LD_PRELOAD", disk::library().unwrap()).env("SHIM_FOLDER", "/nowhere");
    command.env("SHIM_THREAD", first.to_string()).env("SHIM_LASTING", "1");
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // Most read nothing.
    let _ = child.stdin.take().unwrap().write_all(input);
    child.wait_with_output().unwrap()
}

#[test]
fn no_command_panics_where_no_thread_can_be_started() {
    if disk::library().is_none() {
        return;
    }
    let desk = Desk::with("quick.yaml");
    desk.run(&["run", "quick.yaml", "--quiet"], 0);
    desk.run(&["archive", "quick.yaml", "-o", "a.zip"], 0);
    desk.run(&["shard", "plan", "quick.yaml", "--shards", "2", "--into", "plan", "--cache", "none"], 0);
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    fs::write(desk.path("other.yaml"), text.replace("amount: 12 um", "amount: 13 um")).unwrap();
    desk.run(&["run", "other.yaml", "--quiet", "--results", "others"], 0);
    let lsp: Vec<u8> = [
        "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"initialize\",\"params\":{}}".to_owned(),
        serde_json::json!({ "jsonrpc": "2.0", "method": "textDocument/didOpen", "params": { "textDocument": {
            "uri": "file:///quick.yaml", "text": text } } })
        .to_string(),
    ]
    .iter()
    .flat_map(|text| format!("Content-Length: {}\r\n\r\n{text}", text.len()).into_bytes())
    .collect();
    // What each may end with; a code of 1 says that threads are missing.
    let commands: [(&[&str], &[i32]); 18] = [
        (&["run", "quick.yaml"], &[0]),
        (&["run", "quick.yaml", "--force"], &[0, 1]),
        (&["run", "quick.yaml", "--cache", "none", "--results", "new"], &[0, 1]),
        (&["check", "quick.yaml"], &[0]),
        (&["plan", "quick.yaml"], &[0]),
        (&["status", "quick.yaml", "--check"], &[0]),
        (&["report", "quick.yaml"], &[0]),
        (&["report", "quick.yaml", "--check"], &[0]),
        (&["table", "quick.yaml", "ste.summary"], &[0]),
        (&["query", "SELECT COUNT(*) FROM quick.ste.summary"], &[0]),
        (&["diff", "results", "others"], &[4]),
        (&["archive", "quick.yaml", "-o", "b.zip"], &[0]),
        (&["verify", "a.zip"], &[0, 1]),
        (&["shard", "run", "plan", "0"], &[0, 1]),
        (&["shard", "status", "plan"], &[0]),
        (&["gc"], &[0]),
        (&["lsp"], &[0]),
        (&["watch", "quick.yaml"], &[1]),
    ];
    let mut refused = 0;
    for (words, codes) in commands {
        for first in 1..=3 {
            let output = without(&desk, first, words, &lsp);
            let said = String::from_utf8_lossy(&output.stderr);
            let code = output.status.code().unwrap_or_else(|| panic!("{words:?} {first}: {}: {said}", output.status));
            assert!(codes.contains(&code), "{words:?} {first}: {code}: {said}");
            assert!(code != 1 || said.contains("cannot start"), "{words:?} {first}: {said}");
            refused += usize::from(code == 1);
        }
    }
    assert!(refused > 4, "{refused}");
}
