//! Messages of the Language Server Protocol (LSP 3.17, base protocol): headers, then JSON of the length that they state.
//!
//! A message that is not understood is answered with an error; the next one is read. Must not know: what messages mean.

use std::io::{self, BufRead, ErrorKind, Read, Write};

use lsp_server::{ErrorCode, Message};
use serde_json::{Value, json};

/// Bytes of a message; the text of a study has less than one million.
const MAX_MESSAGE_BYTES: u64 = 64 << 20;
/// Bytes of one header.
const MAX_HEADER_BYTES: u64 = 4 << 10;

/// What an editor sent.
#[derive(Debug)]
pub(super) enum Received {
    Message(Message),
    /// The answer to what is no message: an error, in JSON.
    Refused(Value),
}

/// The next message; none at the end.
///
/// # Errors
/// When no end of the message can be found: headers that are none, a length beyond the limit, an input that ends within.
pub(super) fn receive(input: &mut impl BufRead) -> io::Result<Option<Received>> {
    let Some(length) = length(input)? else { return Ok(None) };
    // Room is made for what arrives, not for what is announced.
    let mut bytes = Vec::new();
    if input.take(length).read_to_end(&mut bytes)? as u64 != length {
        return Err(invalid(format!("the input ended within a message of {length} bytes")));
    }
    Ok(Some(understood(&bytes)))
}

/// Sends one JSON text.
///
/// # Errors
/// When the editor is gone.
pub(super) fn send(output: &mut impl Write, message: &Value) -> io::Result<()> {
    let text = message.to_string();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}

fn length(input: &mut impl BufRead) -> io::Result<Option<u64>> {
    let (mut length, mut is_first) = (None, true);
    loop {
        let mut line = Vec::new();
        input.take(MAX_HEADER_BYTES).read_until(b'\n', &mut line)?;
        if line.is_empty() && is_first {
            return Ok(None);
        }
        is_first = false;
        let header = line.strip_suffix(b"\r\n").map(String::from_utf8_lossy);
        let header = header.ok_or_else(|| invalid(format!("`{}` is no header", shown(&line))))?;
        if header.is_empty() {
            return length.map(Some).ok_or_else(|| invalid("a message without Content-Length".to_owned()));
        }
        let (name, value) =
            header.split_once(':').ok_or_else(|| invalid(format!("`{}` is no header", shown(&line))))?;
        if name.eq_ignore_ascii_case("Content-Length") {
            let bytes: u64 = value.trim().parse().map_err(|_| invalid(format!("`{}` is no length", shown(&line))))?;
            if bytes > MAX_MESSAGE_BYTES {
                let most = MAX_MESSAGE_BYTES >> 20;
                return Err(invalid(format!("a message of {bytes} bytes, more than {most} MiB")));
            }
            length = Some(bytes);
        }
    }
}

fn invalid(problem: String) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, problem)
}

/// The beginning of a line, for messages.
fn shown(line: &[u8]) -> String {
    const SHOWN: usize = 60;
    line[..line.len().min(SHOWN)].trim_ascii_end().escape_ascii().to_string()
}

fn understood(bytes: &[u8]) -> Received {
    // Characters that are none become U+FFFD, which has the length of a lone surrogate: places in a text stay right.
    let text = String::from_utf8_lossy(bytes);
    let parsed = serde_json::from_str::<Value>(&text)
        .or_else(|error| serde_json::from_str(&without_lone_surrogates(&text)).map_err(|_| error));
    let refused = |id: Value, code: ErrorCode, message: String| {
        let error = json!({ "code": code as i32, "message": message });
        Received::Refused(json!({ "jsonrpc": "2.0", "id": id, "error": error }))
    };
    let value = match parsed {
        Ok(value) => value,
        Err(error) => return refused(Value::Null, ErrorCode::ParseError, format!("this is not JSON: {error}")),
    };
    let id = Some(value["id"].clone()).filter(|id| id.is_string() || id.is_number()).unwrap_or_default();
    serde_json::from_value(value).map_or_else(
        |_| refused(id, ErrorCode::InvalidRequest, "this is neither a request nor a notification".to_owned()),
        Received::Message,
    )
}

/// JSON in which every `\uD800` to `\uDFFF` that is not half of a pair is `\uFFFD`.
fn without_lone_surrogates(text: &str) -> String {
    let mut whole = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('\\') {
        whole += &rest[..at];
        rest = &rest[at..];
        let taken = match (unit(rest), rest.get(6..).and_then(unit)) {
            (Some(0xD800..=0xDBFF), Some(0xDC00..=0xDFFF)) => 12,
            (Some(0xD800..=0xDFFF), _) => {
                whole += "\\uFFFD";
                rest = &rest[6..];
                continue;
            }
            (Some(_), _) => 6,
            // The character behind the backslash, which may be another backslash.
            (None, _) => 1 + rest[1..].chars().next().map_or(0, char::len_utf8),
        };
        whole += &rest[..taken];
        rest = &rest[taken..];
    }
    whole + rest
}

/// The unit of UTF-16 that an escape at the beginning of a text stands for.
fn unit(text: &str) -> Option<u32> {
    let digits = text.strip_prefix("\\u")?.get(..4)?;
    u32::from_str_radix(digits, 16).ok().filter(|_| digits.bytes().all(|byte| byte.is_ascii_hexdigit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lone_surrogates_are_replaced_and_pairs_kept() {
        for (given, expected) in [
            (r#""\ud800""#, r#""\uFFFD""#),
            (r#""\ud834\udd1e\udd1e""#, r#""\ud834\udd1e\uFFFD""#),
            (r#""\\ud800 \u00b5 µ\n\dc""#, r#""\\ud800 \u00b5 µ\n\dc""#),
            (r#""\ud834\ud834\udd1e\ud8"#, r#""\uFFFD\ud834\udd1e\ud8"#),
            ("\\", "\\"),
            ("\\µ\\u", "\\µ\\u"),
        ] {
            assert_eq!(without_lone_surrogates(given), expected);
        }
    }

    #[test]
    fn what_is_no_message_is_refused_or_ends_the_input() {
        let framed = |body: &[u8]| [format!("Content-Length: {}\r\n\r\n", body.len()).as_bytes(), body].concat();
        let code = |body: &[u8]| match receive(&mut &framed(body)[..]).unwrap().unwrap() {
            Received::Refused(answer) => (answer["error"]["code"].as_i64(), answer["id"].clone()),
            Received::Message(_) => (None, Value::Null),
        };
        assert_eq!(code(b"{"), (Some(-32700), Value::Null));
        assert_eq!(code("[".repeat(100_000).as_bytes()), (Some(-32700), Value::Null));
        assert_eq!(code(b"[]"), (Some(-32600), Value::Null));
        assert_eq!(code(b"{\"id\":7}"), (Some(-32600), json!(7)));
        assert_eq!(code(b"{\"id\":7,\"method\":\"a\",\"params\":[\"\\ud800\", \"\xff\"]}"), (None, Value::Null));
        let failed = |bytes: &[u8]| receive(&mut &*bytes).unwrap_err().to_string();
        assert_eq!(failed(b"Content-Length: 99999999999\r\n\r\n"), "a message of 99999999999 bytes, more than 64 MiB");
        assert!(failed(b"Content-Length: -1\r\n\r\n").contains("is no length"));
        assert!(failed(b"Content-Length: 99999999999999999999\r\n\r\n").contains("is no length"));
        assert!(failed(b"Content-Length: 60000000\r\n\r\n{}").contains("the input ended within"));
        assert!(failed(b"Content-Type: x\r\n\r\n").contains("without Content-Length"));
        assert!(failed(b"hello\r\n\r\n").contains("`hello` is no header"));
        assert!(failed(&[b'a'; 10_000]).contains("is no header"));
        assert!(receive(&mut &b""[..]).unwrap().is_none());
    }
}
