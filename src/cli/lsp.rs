//! `gearstudy lsp`: studies in an editor, by the Language Server Protocol over standard input and output.
//!
//! Mistakes are those of `check`; what stands at the cursor, where it is declared and what else could stand there comes from
//! the declarations that read a study. Messages are JSON (LSP 3.17). Must not know: what is wrong, or what anything means.

mod messages;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use serde_json::{Value, json};

use self::messages::Received;
use super::{Ending, show};
use crate::program::{PROGRAM, examine_text};
use declare::error::{Diagnostic, Place};
use studygraph::study::cursor;

/// Texts by their URI, as the editor has them.
type Open = BTreeMap<String, String>;

/// The code of a request that comes before `initialize` or after `shutdown`.
fn out_of_turn(id: RequestId, is_after: bool) -> Response {
    let (code, when) = if is_after {
        (ErrorCode::InvalidRequest, "after `shutdown`")
    } else {
        (ErrorCode::ServerNotInitialized, "before `initialize`")
    };
    Response::new_err(id, code as i32, format!("this came {when}"))
}

pub(super) fn lsp() -> Result<(), Ending> {
    let (mut input, mut output) = (std::io::stdin().lock(), std::io::stdout().lock());
    let (mut open, mut is_initialized, mut is_shut_down) = (Open::new(), false, false);
    loop {
        let received = messages::receive(&mut input);
        let received = received.map_err(|error| Ending::Usage(format!("the editor was not understood: {error}")))?;
        let answer = match received {
            None => return Ok(()),
            Some(Received::Refused(answer)) => Some(answer),
            Some(Received::Message(Message::Response(_))) => None,
            Some(Received::Message(Message::Notification(told))) => match told.method.as_str() {
                "exit" => return Ok(()),
                _ if is_initialized && !is_shut_down => hear(&mut open, &told).map(|told| as_json(&told)),
                _ => None,
            },
            Some(Received::Message(Message::Request(request))) => Some(as_json(&match request.method.as_str() {
                "initialize" if !is_initialized => {
                    is_initialized = true;
                    Response::new_ok(request.id, json!({ "capabilities": capabilities() }))
                }
                _ if !is_initialized || is_shut_down => out_of_turn(request.id, is_shut_down),
                "shutdown" => {
                    is_shut_down = true;
                    Response::new_ok(request.id, Value::Null)
                }
                _ => answer(&open, request),
            })),
        };
        if let Some(answer) = answer
            && messages::send(&mut output, &answer).is_err()
        {
            // The editor is gone.
            return Ok(());
        }
    }
}

fn capabilities() -> Value {
    json!({
        // The whole text with each change: a study is small.
        "textDocumentSync": 1,
        "hoverProvider": true,
        "definitionProvider": true,
        "completionProvider": { "triggerCharacters": [" ", ":", ".", "[", "=", ","] },
    })
}

/// A message with the version that every message states.
fn as_json(message: &impl serde::Serialize) -> Value {
    let mut value = json!(message);
    value["jsonrpc"] = "2.0".into();
    value
}

/// What is wrong with a text that the editor tells of.
fn hear(open: &mut Open, told: &Notification) -> Option<Notification> {
    let document = &told.params["textDocument"];
    let uri = document["uri"].as_str()?.to_owned();
    let text = match told.method.as_str() {
        "textDocument/didOpen" => document["text"].as_str()?,
        "textDocument/didChange" => told.params["contentChanges"].as_array()?.last()?["text"].as_str()?,
        "textDocument/didClose" => {
            open.remove(&uri);
            return Some(diagnostics(&uri, &Value::Array(Vec::new())));
        }
        _ => return None,
    };
    let wrong = mistakes(&uri, text);
    open.insert(uri.clone(), text.to_owned());
    Some(diagnostics(&uri, &wrong))
}

fn diagnostics(uri: &str, all: &Value) -> Notification {
    let params = json!({ "uri": uri, "diagnostics": all });
    Notification { method: "textDocument/publishDiagnostics".to_owned(), params }
}

fn mistakes(uri: &str, text: &str) -> Value {
    let path = PathBuf::from(uri.strip_prefix("file://").unwrap_or(uri));
    let Err(error) = show::rehearsed(examine_text(text, &path)) else { return json!([]) };
    // What is wrong with a file beside the study is told where the study names it.
    let elsewhere = (error.path != path).then(|| named_at(text, &error.path));
    let one = |found: &Diagnostic| {
        let help = found.help.as_ref().map_or_else(String::new, |help| format!("\n{help}"));
        let place = found.place.unwrap_or_default();
        let before = match elsewhere {
            Some(_) => format!("{}:{}:{}: ", error.path.display(), place.line, place.column),
            None => String::new(),
        };
        let message = before + &found.message + &help;
        json!({
            "range": range(text, elsewhere.unwrap_or(place)),
            "severity": 1,
            "source": "gearstudy",
            "message": message,
        })
    };
    error.each().map(one).collect()
}

/// Where a study names a file.
fn named_at(text: &str, file: &Path) -> Place {
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    text.find(&name).map_or_else(Place::default, |offset| Place { offset, length: name.len(), ..Place::default() })
}

fn answer(open: &Open, request: Request) -> Response {
    let result = match request.method.as_str() {
        "textDocument/hover" => hover(open, &request.params),
        "textDocument/definition" => definition(open, &request.params),
        "textDocument/completion" => completion(open, &request.params),
        unknown => {
            let message = format!("there is no `{unknown}` here");
            return Response::new_err(request.id, ErrorCode::MethodNotFound as i32, message);
        }
    };
    Response::new_ok(request.id, result.unwrap_or(Value::Null))
}

/// The text that is meant, and the byte in it.
fn place<'a>(open: &'a Open, params: &'a Value) -> Option<(&'a str, &'a str, usize)> {
    let uri = params["textDocument"]["uri"].as_str()?;
    let text = open.get(uri)?;
    let number = |name: &str| usize::try_from(params["position"][name].as_u64()?).ok();
    Some((uri, text, byte(text, number("line")?, number("character")?)))
}

fn hover(open: &Open, params: &Value) -> Option<Value> {
    let (_, text, offset) = place(open, params)?;
    let found = cursor::at(text, offset, &PROGRAM)?;
    Some(json!({ "contents": { "kind": "plaintext", "value": found.described } }))
}

fn definition(open: &Open, params: &Value) -> Option<Value> {
    let (uri, text, offset) = place(open, params)?;
    let declared = cursor::at(text, offset, &PROGRAM)?.declared?;
    Some(json!({ "uri": uri, "range": range(text, declared) }))
}

fn completion(open: &Open, params: &Value) -> Option<Value> {
    /// `CompletionItemKind.Field`.
    const FIELD: u32 = 5;
    let (_, text, offset) = place(open, params)?;
    let cursor::Offers { range, all } = cursor::offers(text, offset, &PROGRAM);
    let range = json!({ "start": position(text, range.start), "end": position(text, range.end) });
    let item = |(order, offer): (usize, cursor::Offer)| {
        json!({
            "label": offer.label,
            "detail": offer.detail,
            // What is replaced is said: to editors a word ends elsewhere.
            "textEdit": { "range": range, "newText": offer.text },
            "kind": FIELD,
            // Editors sort by letters otherwise.
            "sortText": format!("{order:03}"),
        })
    };
    Some(all.into_iter().enumerate().map(item).collect())
}

/// From the first byte of a place to behind its last.
fn range(text: &str, place: Place) -> Value {
    json!({ "start": position(text, place.offset), "end": position(text, place.offset + place.length.max(1)) })
}

/// A byte as an editor counts: lines, and in them units of UTF-16.
fn position(text: &str, offset: usize) -> Value {
    let offset = (0..=offset.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
    let before = &text[..offset];
    let line = before.rfind('\n').map_or(0, |at| at + 1);
    json!({ "line": before.matches('\n').count(), "character": before[line..].encode_utf16().count() })
}

/// The byte of a line and of units of UTF-16 in it; the end of the line where there are fewer.
fn byte(text: &str, line: usize, character: usize) -> usize {
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let inside = text[start..].lines().next().unwrap_or("");
    let mut units = 0;
    let end = inside.char_indices().find(|(_, c)| {
        let is_there = units >= character;
        units += c.len_utf16();
        is_there
    });
    start + end.map_or(inside.len(), |(at, _)| at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_counted_as_editors_count() {
        let text = "a: µ\n𝄞b: c\n";
        // The clef is two units of UTF-16 and four bytes.
        let b = text.find('b').unwrap();
        assert_eq!(position(text, b), json!({ "line": 1, "character": 2 }));
        assert_eq!((byte(text, 1, 2), byte(text, 0, 99), byte(text, 7, 0)), (b, 5, text.len()));
        assert_eq!(position(text, 4), json!({ "line": 0, "character": 3 }), "in the middle of a letter");
    }
}
