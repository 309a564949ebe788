//! `gearstudy lsp` as an editor drives it: over the studies, and over broken ones.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde_json::{Value, json};

use crate::desk::Desk;

/// A program that serves, and its two ends.
struct Editor {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    requests: u64,
}

const URI: &str = "file:///desk/study.yaml";

impl Editor {
    fn start() -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
        let mut child = command.arg("lsp").stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let (to, from) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()));
        let mut editor = Self { child, to, from, requests: 0 };
        let able = editor.ask("initialize", &json!({ "capabilities": {} }));
        assert_eq!(able["capabilities"]["hoverProvider"], true);
        editor.tell("initialized", &json!({}));
        editor
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        write!(self.to, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
        self.to.flush().unwrap();
    }

    fn receive(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.from.read_line(&mut line).unwrap() > 0, "it has ended");
            match line.trim_end().split_once(": ") {
                Some(("Content-Length", value)) => length = value.parse().unwrap(),
                Some(_) => {}
                None => break,
            }
        }
        let mut bytes = vec![0; length];
        self.from.read_exact(&mut bytes).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    fn tell(&mut self, method: &str, params: &Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    fn ask(&mut self, method: &str, params: &Value) -> Value {
        self.requests += 1;
        self.send(&json!({ "jsonrpc": "2.0", "id": self.requests, "method": method, "params": params }));
        let answer = self.receive();
        assert_eq!(answer["id"], self.requests, "{answer}");
        answer["result"].clone()
    }

    /// What is wrong with a text that is opened.
    fn open(&mut self, text: &str) -> Vec<Value> {
        let document = json!({ "uri": URI, "languageId": "yaml", "version": 1, "text": text });
        self.tell("textDocument/didOpen", &json!({ "textDocument": document }));
        let told = self.receive();
        assert_eq!(told["method"], "textDocument/publishDiagnostics");
        told["params"]["diagnostics"].as_array().unwrap().clone()
    }

    /// Asks about the place of `|` in a text, which is opened without it.
    fn at(&mut self, method: &str, marked: &str) -> Value {
        let (before, after) = marked.split_once('|').unwrap();
        self.open(&format!("{before}{after}"));
        let line = before.rfind('\n').map_or(0, |at| at + 1);
        let position =
            json!({ "line": before.matches('\n').count(), "character": before[line..].encode_utf16().count() });
        self.ask(method, &json!({ "textDocument": { "uri": URI }, "position": position }))
    }

    fn offered(&mut self, marked: &str) -> Vec<String> {
        let all = self.at("textDocument/completion", marked);
        all.as_array().unwrap().iter().map(|item| item["label"].as_str().unwrap().to_owned()).collect()
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn quick() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("studies/quick.yaml")).unwrap()
}

#[test]
fn an_editor_is_told_what_check_says_where_it_is() {
    let mut editor = Editor::start();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    for entry in fs::read_dir(folder.join("studies")).unwrap() {
        let path = entry.unwrap().path();
        assert_eq!(editor.open(&fs::read_to_string(&path).unwrap()), Vec::<Value>::new(), "{}", path.display());
    }
    let desk = Desk::with("quick.yaml");
    for entry in fs::read_dir(folder.join("tests/bad")).unwrap() {
        let path = entry.unwrap().path();
        let Ok(text) = fs::read_to_string(&path) else { continue };
        if path.extension().is_none_or(|ending| ending != "yaml") {
            continue;
        }
        let found = editor.open(&text);
        let said = desk.run(&["check", path.to_str().unwrap()], 2).1;
        let heads: Vec<&str> = said.lines().filter(|line| !line.starts_with("  help: ")).collect();
        assert_eq!(found.len(), heads.len(), "{said}");
        for (one, head) in found.iter().zip(heads) {
            let message = one["message"].as_str().unwrap().lines().next().unwrap();
            assert!(head.ends_with(message), "{head:?} {message:?}");
            let line = one["range"]["start"]["line"].as_u64().unwrap() + 1;
            assert!(head.contains(&format!("yaml:{line}:")), "{head:?} {one}");
        }
    }
    // Put right, it is told so.
    assert_eq!(editor.open(&quick()), Vec::<Value>::new());
    assert_eq!(editor.ask("shutdown", &Value::Null), Value::Null);
    editor.tell("exit", &Value::Null);
    assert!(editor.child.wait().unwrap().success());
}

#[test]
fn an_editor_is_offered_what_can_stand_there() {
    let mut editor = Editor::start();
    let quick = quick();
    let marked = |old: &str, new: &str| {
        assert!(quick.contains(old), "{old}");
        quick.replacen(old, new, 1)
    };
    // Stages that fit, the words of a choice, kinds.
    assert_eq!(editor.offered(&marked("designs: [designs, optimum]", "designs: [designs, |]")), ["designs", "optimum"]);
    assert_eq!(
        editor.offered(&marked("    stiffness: stiffness\n    designs", "    stiffness: st|\n    designs")),
        ["stiffness"]
    );
    let offered = editor.offered(&marked("contact: linear", "contact: |"));
    assert!(offered.contains(&"resolved".to_owned()) && offered.contains(&"linear".to_owned()), "{offered:?}");
    assert!(editor.offered(&marked("kind: modification", "kind: |")).contains(&"ste".to_owned()));
    // Fields that are not there yet, what must be there first.
    let offered = editor.offered(&marked("    minimize: peak_to_peak\n", "    |\n"));
    assert!(!offered.contains(&"stiffness".to_owned()) && offered.contains(&"minimize".to_owned()), "{offered:?}");
    let offered = editor.offered(&marked("bore_radius: 18 mm }", "|}"));
    assert_eq!(offered[0], "bore_radius", "{offered:?}");
    assert!(!offered.contains(&"teeth".to_owned()), "{offered:?}");
    // Members of a family, and their fields.
    let offered = editor.offered(&marked("        - lead_crowning: { gear: pinion, amount: 4 um }", "        - |"));
    assert!(offered.contains(&"tip_relief".to_owned()), "{offered:?}");
    let offered = editor.offered(&marked("amount: 12 um, fraction: 1.0, curve: linear", "amount: 12 um, |"));
    assert!(offered.contains(&"length".to_owned()) && !offered.contains(&"gear".to_owned()), "{offered:?}");
    // Quantities of the size of the field, with other units; behind a number its units.
    assert_eq!(editor.offered(&marked("face_width: 20 mm", "face_width: |")), ["20 mm", "20000 um", "0.02 m"]);
    assert_eq!(editor.offered(&marked("amount: 12 um", "amount: |"))[0], "12 um");
    assert_eq!(editor.offered(&marked("amount: 12 um", "amount: 12.5 |")), ["mm", "um", "m"]);
    assert_eq!(editor.offered(&marked("amount: 12 um", "amount: 12.5 u|")), ["mm", "um", "m"]);
    assert_eq!(editor.offered(&marked("teeth: 24", "teeth: |")), ["24"]);
    // In a text that is no YAML there is nothing to offer, and nothing goes wrong.
    assert!(editor.offered("study: a\nstages: [{\n  |").is_empty());
}

#[test]
fn an_editor_is_told_what_stands_there_and_where_it_is_declared() {
    let mut editor = Editor::start();
    let quick = quick();
    let mut hover = |old: &str, new: &str| {
        let found = editor.at("textDocument/hover", &quick.replacen(old, new, 1));
        found["contents"]["value"].as_str().unwrap_or_default().to_owned()
    };
    let torque = hover("    torque: { from", "    tor|que: { from");
    assert!(
        torque.starts_with("torque: ")
            && torque.contains("one value, a list")
            && torque.contains("Torque on the pinion"),
        "{torque}"
    );
    assert!(hover("teeth: 24", "teeth: 2|4").contains("between 4 and 10000"));
    assert!(hover("bore_radius: 18", "bore_|radius: 18").contains("for example `18 mm`"));
    assert!(hover("kind: ste", "kind: s|te").starts_with("ste: Static transmission error"));
    assert!(hover("- tip_relief", "- tip_|relief").starts_with("tip_relief: "));
    assert!(hover("method: energy", "method: en|ergy").starts_with("energy: "));
    assert_eq!(hover("unmodified: []", "unmo|dified: []"), "", "a name of the user's own");
    let declared =
        editor.at("textDocument/definition", &quick.replacen("designs: [designs, opt", "designs: [designs, o|pt", 1));
    let line = quick.lines().position(|line| line == "  optimum:").unwrap();
    assert_eq!(declared["range"]["start"], json!({ "line": line, "character": 2 }));
}

/// A text is no study while a cell in it is written: what the other stages have is known all the same.
#[test]
fn an_editor_is_offered_the_tables_columns_and_keys_of_the_study() {
    let mut editor = Editor::start();
    let quick = quick();
    let cell = "short: ste.summary[design=short, torque=150 N m].peak_to_peak";
    let mut at = |written: &str| editor.offered(&quick.replacen(cell, &format!("short: {written}"), 1));
    assert_eq!(at("|"), ["pair", "stiffness", "designs", "optimum", "ste"]);
    assert_eq!(at("st|"), at("|"), "an editor picks those that begin so");
    let tables = at("ste.summ|");
    assert!(["summary", "curve", "harmonics"].iter().all(|name| tables.contains(&(*name).to_owned())), "{tables:?}");
    assert_eq!(at("ste.summary[|")[..2], ["design", "torque"]);
    assert_eq!(at("ste.summary[design=|"), ["unmodified", "short", "long", "optimum"]);
    assert_eq!(at("ste.summary[design=short, torque=1|"), ["50 N m", "100 N m", "150 N m", "200 N m", "250 N m"]);
    let columns = at("ste.summary[design=short, torque=150 N m].|");
    assert!(columns.contains(&"peak_to_peak".to_owned()) && !columns.contains(&"design".to_owned()), "{columns:?}");
    assert_eq!(at("\"ste.summary[design=short, torque=150 N m].pea|\""), columns);
    assert_eq!(at("ste.harmonics[order=|").len(), 8);
    for unknown in ["nothing.|", "ste.curve[point=|"] {
        assert!(at(unknown).is_empty(), "{unknown}");
    }

    // What is replaced, and what is said of a column.
    let marked = quick.replacen(cell, "short: ste.summary[design=short, torque=1|50 N m].peak_to_peak", 1);
    let one = editor.at("textDocument/completion", &marked)[2].clone();
    let line = marked.lines().find(|line| line.contains('|')).unwrap();
    let from = line.find("1|50").unwrap();
    assert_eq!(one["textEdit"]["newText"], "150 N m");
    assert_eq!(one["textEdit"]["range"]["start"]["character"], from);
    assert_eq!(one["textEdit"]["range"]["end"]["character"], from + "150 N m".len());
    let found = editor.at("textDocument/completion", &quick.replacen(cell, "short: ste.summary.|", 1));
    let column = found.as_array().unwrap().iter().find(|one| one["label"] == "peak_to_peak").unwrap().clone();
    assert!(column["detail"].as_str().unwrap().starts_with("[um] "), "{column}");

    // Figures: tables, columns of theirs, conditions and values.
    let mut figure = |old: &str, new: &str| {
        let (before, after) = quick.split_once("      - name: transmission_error").unwrap();
        assert!(after.contains(old), "{old}");
        editor.offered(&format!("{before}      - name: transmission_error{}", after.replacen(old, new, 1)))
    };
    assert!(figure("table: ste.curve", "table: |").contains(&"stiffness".to_owned()));
    assert!(figure("table: ste.curve", "table: ste.|").contains(&"curve".to_owned()));
    let columns = figure("x: cycle_position", "x: |");
    assert!(["cycle_position", "design", "pairs"].iter().all(|name| columns.contains(&(*name).to_owned())));
    assert_eq!(figure("y: transmission_error", "y: [transmission_error, |]"), columns);
    assert_eq!(figure("series: design", "series: d|"), columns);
    assert_eq!(figure("{ torque: 150 N m }", "{ | }"), columns);
    let others: Vec<&String> = columns.iter().filter(|name| *name != "torque").collect();
    assert_eq!(figure("{ torque: 150 N m }", "{ torque: 150 N m, | }").iter().collect::<Vec<_>>(), others);
    assert_eq!(figure("{ torque: 150 N m }", "{ design: | }"), ["unmodified", "short", "long", "optimum"]);
    assert_eq!(figure("{ torque: 150 N m }", "{ torque: 1| }").len(), 5);

    // Of stages that are named beside; of the kind that a search asks.
    let sweep = "\n  swept: { kind: sweep, of: ste, outputs: [|] }\n";
    let offered = editor.offered(&(quick.clone() + sweep));
    assert!(offered.contains(&"peak_to_peak".to_owned()) && offered.contains(&"harmonics".to_owned()), "{offered:?}");
    let offered = editor.offered(&(quick.clone() + &sweep.replace("[|]", "[harmonics.|]")));
    assert!(offered.contains(&"amplitude".to_owned()), "{offered:?}");
    let offered = editor.offered(&quick.replacen("minimize: peak_to_peak", "minimize: |", 1));
    assert!(offered.contains(&"largest_pressure".to_owned()), "{offered:?}");

    // Whatever else is wrong with the text.
    let broken = quick.replacen("module: 3 mm", "module: 3", 1).replacen(cell, "short: ste.summary[design=|", 1);
    assert_eq!(editor.offered(&broken), ["unmodified", "short", "long", "optimum"]);
    let without = quick.replacen("title: Mesh", "titel: Mesh", 1).replacen(cell, "short: ste.|", 1);
    assert!(editor.offered(&without).contains(&"summary".to_owned()));
    // Stages that would ask each other without end.
    let circle = "  a: { kind: ste, stiffness: stiffness, designs: [a, a], torque: 1 N m }\n  ste:";
    let circle = quick.replacen("  ste:", circle, 1);
    assert!(!editor.offered(&circle.replacen(cell, "short: ste.summary[design=|", 1)).is_empty());
}

#[test]
fn an_editor_is_told_what_a_cell_is() {
    let mut editor = Editor::start();
    let quick = quick();
    let cell = "short: ste.summary[design=short, torque=150 N m].peak_to_peak";
    let mut hover = |marked: &str, new: &str| {
        let found = editor.at("textDocument/hover", &quick.replacen(marked, new, 1));
        found["contents"]["value"].as_str().unwrap_or_default().to_owned()
    };
    let column = hover(cell, "short: ste.summary[design=short, torque=150 N m].peak_|to_peak");
    assert!(column.starts_with("ste.summary.peak_to_peak [um]\n") && column.len() > 40, "{column}");
    assert!(hover(cell, "short: s|te.summary.peak_to_peak").starts_with("ste: Static transmission error"));
    assert!(hover(cell, "short: ste.su|mmary.peak_to_peak").starts_with("ste.summary\n"));
    let torque = hover(cell, "short: ste.summary[design=short, tor|que=150 N m].peak_to_peak");
    assert!(torque.starts_with("ste.summary.torque [N m]\n"), "{torque}");
    assert_eq!(hover(cell, "short: ste.summary[design=short, torque=1|50 N m].peak_to_peak"), torque);
    assert!(hover(cell, "short: 3 u|m").starts_with("with: "));
    assert!(hover("y: stiffness", "y: sti|ffness").starts_with("stiffness.curve.stiffness ["));
    assert!(hover("where: { torque", "where: { tor|que").starts_with("ste.curve.torque [N m]\n"));
    let declared = editor.at("textDocument/definition", &quick.replacen(cell, &cell.replacen("peak_", "pe|ak_", 1), 1));
    let line = quick.lines().position(|line| line == "  ste:").unwrap();
    assert_eq!(declared["range"]["start"], json!({ "line": line, "character": 2 }));
}

/// What is no message is answered, and the next one is understood; a text with half a character is one.
#[test]
fn what_an_editor_sends_amiss_does_not_end_it() {
    let mut editor = Editor::start();
    let raw = |editor: &mut Editor, body: &[u8]| {
        editor.to.write_all(&[format!("Content-Length: {}\r\n\r\n", body.len()).as_bytes(), body].concat()).unwrap();
    };
    for body in [&b"{"[..], b"[]", b"{\"id\":1}", b"\xff\xfe", b"[[[[[", b""] {
        raw(&mut editor, body);
        assert!(editor.receive()["error"]["code"].as_i64().is_some_and(|code| code < 0), "{}", body.escape_ascii());
    }
    let text = quick().replace("title: Tip", "title: LONE Tip");
    let message = json!({ "jsonrpc": "2.0", "method": "textDocument/didOpen",
        "params": { "textDocument": { "uri": URI, "text": text } } });
    raw(&mut editor, message.to_string().replace("LONE", "\\ud800").as_bytes());
    assert_eq!(editor.receive()["method"], "textDocument/publishDiagnostics");
    assert_eq!(editor.ask("shutdown", &Value::Null), Value::Null);

    let ended = |head: &str, wanted: &str| {
        let mut child = Command::new(env!("CARGO_BIN_EXE_gearstudy"))
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        child.stdin.take().unwrap().write_all(head.as_bytes()).unwrap();
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(1) && said.contains(wanted), "{}: {said}", output.status);
    };
    ended("Content-Length: 999999999999999\r\n\r\n", "a message of 999999999999999 bytes, more than 64 MiB");
    ended("Content-Length: 60000000\r\n\r\n{}", "the input ended within a message");
    ended("hello\r\n", "`hello` is no header");
}
