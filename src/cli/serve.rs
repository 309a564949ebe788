//! The pages of `gearstudy watch`, sent to browsers on this computer and to nobody else.
//!
//! Listens on the loopback address, answers only requests for that name (a page from elsewhere cannot ask), and sends only
//! files that the manifest lists. A thread serves a connection; their number and their time are limited. Where the system
//! has no descriptor or no thread to give, that is reported, and listening goes on. Must not know: how results are made.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;

use super::progress::told;
use crate::report;
use studygraph::store::archive::sha256_bytes;
use studygraph::store::results::{Folder, PAGE};

/// Connections at a time; others wait in the system's queue.
const MAX_CONNECTIONS: usize = 64;
/// Of these, connections that wait for news; others are answered at once, so that a page can always be loaded.
const MAX_WAITING: usize = 48;
/// Time for a browser to send its request.
const REQUEST_TIME: Duration = Duration::from_secs(5);
/// Time for a browser to take its answer.
const ANSWER_TIME: Duration = Duration::from_secs(30);
/// Time for which a browser waits for news.
const NEWS_TIME: Duration = Duration::from_secs(20);
/// Time until the system is asked again after it refused a connection or a thread.
const RETRY_TIME: Duration = Duration::from_millis(100);
/// Limits of a request.
const MAX_HEAD_BYTES: usize = 16 << 10;
const MAX_HEADERS: usize = 100;
/// Makes the page follow.
const SCRIPT: &str = include_str!("watch.js");
/// Before there are results.
const EMPTY: &str = "<!doctype html><meta charset=\"utf-8\"><title>gearstudy</title><p>There are no results yet.</p>";
/// Headers of every answer. Figures have styles of their own in every element, which no hash covers.
const HEADERS: &str = "Connection: close\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n\
    X-Frame-Options: DENY\r\nCross-Origin-Resource-Policy: same-origin\r\nCross-Origin-Opener-Policy: same-origin\r\n\
    Referrer-Policy: no-referrer\r\nContent-Security-Policy: default-src 'none'; style-src 'unsafe-inline'; \
    img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; script-src";

/// What the page is to show.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Shown {
    /// Grows with whatever is to be seen.
    pub version: u64,
    /// What is wrong with the study as it was saved last; empty where nothing is.
    pub message: String,
    /// The folder of the last results; none before the first.
    pub folder: Option<PathBuf>,
}

/// What is shown, and whoever waits for something else.
#[derive(Default)]
pub struct Board {
    shown: Mutex<Shown>,
    changed: Condvar,
}

impl Board {
    #[must_use]
    pub fn shown(&self) -> Shown {
        self.shown.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// What is shown as soon as it is not this version, or after a while.
    #[must_use]
    pub fn other_than(&self, version: u64, patience: Duration) -> Shown {
        let shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.changed.wait_timeout_while(shown, patience, |shown| shown.version == version);
        waited.unwrap_or_else(PoisonError::into_inner).0.clone()
    }

    pub fn show(&self, message: String, folder: Option<PathBuf>) {
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = folder.or_else(|| shown.folder.clone());
        *shown = Shown { version: shown.version + 1, message, folder };
        self.changed.notify_all();
    }
}

/// Listens until the program ends.
pub struct Server {
    port: u16,
}

impl Server {
    /// # Errors
    /// When nothing can listen there, or no thread can be started.
    pub fn start(port: u16, board: Arc<Board>) -> Result<Self, String> {
        let cannot = |error: io::Error| format!("cannot listen on port {port} of this computer: {error}");
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(cannot)?;
        let port = listener.local_addr().map_err(cannot)?.port();
        let listening = thread::Builder::new().name("pages".to_owned()).spawn(move || listen(&listener, port, &board));
        listening.map_err(|error| format!("cannot start a thread: {error}"))?;
        Ok(Self { port })
    }

    #[must_use]
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }
}

fn listen(listener: &TcpListener, port: u16, board: &Arc<Board>) {
    let (connections, waiting) = (Arc::new(Slots::new(MAX_CONNECTIONS)), Arc::new(Slots::new(MAX_WAITING)));
    let mut reported = String::new();
    loop {
        let slot = Slots::wait(&connections);
        let served = listener.accept().and_then(|(stream, _)| {
            let (board, waiting) = (Arc::clone(board), Arc::clone(&waiting));
            thread::Builder::new().name("page".to_owned()).spawn(move || {
                serve(stream, port, &board, &waiting);
                drop(slot);
            })
        });
        match served {
            Ok(_) => reported.clear(),
            // The browser went away before it was served.
            Err(error) if matches!(error.kind(), ErrorKind::ConnectionAborted | ErrorKind::Interrupted) => {}
            Err(error) => {
                let problem = error.to_string();
                if problem != reported {
                    told(&format!("warning: the page cannot be sent at the moment: {problem}"));
                    reported = problem;
                }
                thread::sleep(RETRY_TIME);
            }
        }
    }
}

/// A number of slots, and who waits for one.
struct Slots {
    free: Mutex<usize>,
    freed: Condvar,
}

/// A slot that is free again when it is dropped.
struct Slot(Arc<Slots>);

impl Slots {
    fn new(count: usize) -> Self {
        Self { free: Mutex::new(count), freed: Condvar::new() }
    }

    fn wait(this: &Arc<Self>) -> Slot {
        let free = this.free.lock().unwrap_or_else(PoisonError::into_inner);
        let mut free = this.freed.wait_while(free, |free| *free == 0).unwrap_or_else(PoisonError::into_inner);
        *free -= 1;
        Slot(Arc::clone(this))
    }

    fn take(this: &Arc<Self>) -> Option<Slot> {
        let mut free = this.free.lock().unwrap_or_else(PoisonError::into_inner);
        *free = free.checked_sub(1)?;
        Some(Slot(Arc::clone(this)))
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        *self.0.free.lock().unwrap_or_else(PoisonError::into_inner) += 1;
        self.0.freed.notify_one();
    }
}

/// A connection until a moment: every call gets the time that remains.
struct Timed {
    stream: TcpStream,
    until: Instant,
}

impl Timed {
    fn remaining(&self) -> io::Result<Option<Duration>> {
        let remaining = self.until.saturating_duration_since(Instant::now());
        if remaining.is_zero() { Err(ErrorKind::TimedOut.into()) } else { Ok(Some(remaining)) }
    }
}

impl Read for Timed {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(self.remaining()?)?;
        self.stream.read(bytes)
    }
}

impl Write for Timed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(self.remaining()?)?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// A request, as far as it matters here.
struct Request {
    is_get: bool,
    target: String,
    host: Vec<u8>,
}

/// The answer to a request.
struct Reply {
    status: &'static str,
    sort: &'static str,
    body: Body,
    /// Source of the script in the body, besides that of reports.
    script: String,
}

enum Body {
    Bytes(Vec<u8>),
    File(File, u64),
}

impl Reply {
    fn of(sort: &'static str, bytes: String) -> Self {
        Self { status: "200 OK", sort, body: Body::Bytes(bytes.into_bytes()), script: String::new() }
    }

    fn refusal(status: &'static str) -> Self {
        Self { status, ..Self::of("text/plain; charset=utf-8", status.to_owned()) }
    }
}

fn serve(stream: TcpStream, port: u16, board: &Board, waiting: &Arc<Slots>) {
    let mut stream = Timed { stream, until: Instant::now() + REQUEST_TIME };
    let answer = match request(&mut stream) {
        Ok(request) => answer(&request, port, board, waiting),
        Err(error) if error.kind() == ErrorKind::InvalidData => Reply::refusal("400 Bad Request"),
        // A browser that sends no request gets no answer.
        Err(_) => return,
    };
    stream.until = Instant::now() + ANSWER_TIME;
    // Nor does one that went away.
    let _ = send(&mut stream, answer);
}

fn request(stream: &mut impl Read) -> io::Result<Request> {
    let (mut head, mut block) = (Vec::new(), [0; 1 << 10]);
    loop {
        let read = stream.read(&mut block)?;
        if read == 0 {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        head.extend_from_slice(&block[..read]);
        let mut headers = [httparse::EMPTY_HEADER; MAX_HEADERS];
        let mut parsed = httparse::Request::new(&mut headers);
        let status = parsed.parse(&head).map_err(|_| ErrorKind::InvalidData)?;
        if status.is_complete() {
            let mut hosts = parsed.headers.iter().filter(|header| header.name.eq_ignore_ascii_case("host"));
            let (host, other) = (hosts.next().map(|header| header.value.to_vec()), hosts.next());
            // RFC 9112, section 3.2: no request has two, and none of version 1.1 has none.
            if other.is_some() || (host.is_none() && parsed.version == Some(1)) {
                return Err(ErrorKind::InvalidData.into());
            }
            let host = host.unwrap_or_default();
            let target = parsed.path.unwrap_or_default().to_owned();
            return Ok(Request { is_get: parsed.method == Some("GET"), target, host });
        }
        if head.len() > MAX_HEAD_BYTES {
            return Err(ErrorKind::InvalidData.into());
        }
    }
}

fn answer(request: &Request, port: u16, board: &Board, waiting: &Arc<Slots>) -> Reply {
    // Any name may lead to this computer, and the page behind it would be read by whoever owns that name.
    let hosts = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    if !hosts.iter().any(|own| request.host.eq_ignore_ascii_case(own.as_bytes())) {
        return Reply::refusal("403 Forbidden");
    }
    if !request.is_get {
        return Reply::refusal("405 Method Not Allowed");
    }
    let (path, query) = request.target.split_once('?').unwrap_or((&request.target, ""));
    match path {
        "/changes" => {
            let since = query.strip_prefix("since=").and_then(|since| since.parse().ok()).unwrap_or(0);
            let slot = Slots::take(waiting);
            let shown = board.other_than(since, slot.as_ref().map_or(Duration::ZERO, |_| NEWS_TIME));
            let text = json!({ "version": shown.version, "message": shown.message }).to_string();
            Reply::of("application/json", text)
        }
        "/" => page(board),
        path => file(board, path).unwrap_or_else(|| Reply::refusal("404 Not Found")),
    }
}

/// The page of the last results, with the script that follows.
fn page(board: &Board) -> Reply {
    let shown = board.shown();
    let page = shown.folder.and_then(|folder| {
        let mut text = String::new();
        opened(&folder, PAGE)?.0.read_to_string(&mut text).ok()?;
        Some(text)
    });
    let page = page.unwrap_or_else(|| EMPTY.to_owned());
    // `<` would end the script.
    let message = json!(shown.message).to_string().replace('<', "\\u003c");
    // In a scope of its own: the page has names too.
    let about = format!("{{ version: {}, message: {message} }}", shown.version);
    let follow = format!("(shown => {{\n{SCRIPT}}})({about});");
    let script = format!("<script>{follow}</script>\n");
    let text = match page.rfind("</body>") {
        Some(end) => format!("{}{script}{}", &page[..end], &page[end..]),
        None => page + &script,
    };
    Reply { script: follow, ..Reply::of("text/html; charset=utf-8", text) }
}

/// A file of the results, and what it is.
fn file(board: &Board, path: &str) -> Option<Reply> {
    let (folder, name) = (board.shown().folder?, path.strip_prefix('/')?);
    // Nothing is opened that has another name than a file of the last run.
    let manifest = Folder::at(&folder)?.manifest()?;
    manifest.files.iter().find(|listed| listed.file == name)?;
    let (file, size) = opened(&folder, name)?;
    let sort = match Path::new(name).extension().and_then(|ending| ending.to_str()) {
        Some("svg") => "image/svg+xml",
        Some("html") => "text/html; charset=utf-8",
        Some("json") => "application/json",
        Some("csv") => "text/csv; charset=utf-8",
        _ => "application/octet-stream",
    };
    Some(Reply { body: Body::File(file, size), ..Reply::of(sort, String::new()) })
}

/// A regular file that lies in a folder, wherever links lead, and its size.
fn opened(folder: &Path, name: &str) -> Option<(File, u64)> {
    let path = fs::canonicalize(folder.join(name)).ok()?;
    let is_inside = path.starts_with(fs::canonicalize(folder).ok()?);
    // A pipe would be waited for.
    let facts = fs::metadata(&path).ok().filter(|facts| is_inside && facts.is_file())?;
    Some((File::open(path).ok()?, facts.len()))
}

fn send(stream: &mut Timed, answer: Reply) -> io::Result<()> {
    let source = |script: &str| format!("'sha256-{}'", STANDARD.encode(sha256_bytes(script.as_bytes())));
    let (scripts, size) = ([source(report::SCRIPT), source(&answer.script)].join(" "), answer.body.size());
    let (status, sort) = (answer.status, answer.sort);
    let head =
        format!("HTTP/1.1 {status}\r\nContent-Type: {sort}\r\nContent-Length: {size}\r\n{HEADERS} {scripts}\r\n\r\n");
    stream.write_all(head.as_bytes())?;
    match answer.body {
        Body::Bytes(bytes) => stream.write_all(&bytes)?,
        Body::File(file, size) => drop(io::copy(&mut file.take(size), stream)?),
    }
    stream.flush()
}

impl Body {
    fn size(&self) -> u64 {
        match self {
            Self::Bytes(bytes) => bytes.len() as u64,
            Self::File(_, size) => *size,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_have_limits() {
        let kind = |text: &[u8]| request(&mut &*text).map(|request| request.target).map_err(|error| error.kind());
        assert_eq!(kind(b"GET /a?b HTTP/1.1\r\nHost: x\r\n\r\n").as_deref(), Ok("/a?b"));
        assert_eq!(kind(b"GET /a HTTP/1.1\r\nHost: x\r\n"), Err(ErrorKind::UnexpectedEof));
        for wrong in [&b"\0\0\0\0"[..], b"GET\r\n\r\n", b"GET / HTTP/1.1\r\nHo st: x\r\n\r\n"] {
            assert_eq!(kind(wrong), Err(ErrorKind::InvalidData), "{}", wrong.escape_ascii());
        }
        let long = [b"GET / HTTP/1.1\r\nX: ".to_vec(), vec![b'a'; MAX_HEAD_BYTES + (1 << 10)]].concat();
        assert_eq!(kind(&long), Err(ErrorKind::InvalidData));
        let many = format!("GET / HTTP/1.1\r\n{}\r\n", "A: b\r\n".repeat(MAX_HEADERS + 1));
        assert_eq!(kind(many.as_bytes()), Err(ErrorKind::InvalidData));
    }
}
