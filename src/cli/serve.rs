//! The pages of `gearstudy watch`, sent to browsers on this computer and to nobody else.
//!
//! Listens on the loopback address, answers only those who call it by that name (a page from elsewhere cannot ask), and
//! sends only what lies in the folder of results. Must not know: how results are made.

use std::fs::File;
use std::path::{Component, Path};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use serde_json::json;
use tiny_http::{Header, Method, Request, Response};

use super::watch::Board;
use studygraph::store::results::PAGE;

/// How long a browser waits for news at a time.
const PATIENCE: Duration = Duration::from_secs(20);
/// Makes the page follow.
const SCRIPT: &str = include_str!("watch.js");
/// Before there are results.
const EMPTY: &str = "<!doctype html><meta charset=\"utf-8\"><title>gearstudy</title><p>There are no results yet.</p>";

/// Listens until the program ends.
pub struct Server {
    port: u16,
}

impl Server {
    /// # Errors
    /// When nothing can listen there.
    pub fn start(port: u16, board: Arc<Board>) -> Result<Self, String> {
        let cannot = |error: &dyn std::fmt::Display| format!("cannot listen on port {port} of this computer: {error}");
        let server = tiny_http::Server::http(("127.0.0.1", port)).map_err(|error| cannot(&error))?;
        let port = server.server_addr().to_ip().map(|address| address.port()).ok_or_else(|| cannot(&"no address"))?;
        thread::spawn(move || {
            for request in server.incoming_requests() {
                let board = Arc::clone(&board);
                // Some wait for news.
                thread::spawn(move || answer(request, port, &board));
            }
        });
        Ok(Self { port })
    }

    #[must_use]
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }
}

fn answer(request: Request, port: u16, board: &Board) {
    let hosts = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    let host = request.headers().iter().find(|header| header.field.equiv("Host"));
    let is_meant = host.is_some_and(|host| hosts.iter().any(|own| host.value == own.as_str()));
    let url = request.url().to_owned();
    let (path, query) = url.split_once('?').unwrap_or((&url, ""));
    // A browser that went away meanwhile needs no answer.
    let _ = match (is_meant && *request.method() == Method::Get, path) {
        (false, _) => request.respond(Response::empty(403)),
        (true, "/changes") => {
            let since = query.strip_prefix("since=").and_then(|since| since.parse().ok()).unwrap_or(0);
            let shown = board.other_than(since, PATIENCE);
            let text = json!({ "version": shown.version, "message": shown.message }).to_string();
            request.respond(Response::from_string(text).with_header(kind("application/json")))
        }
        (true, "/") => {
            request.respond(Response::from_string(page(board)).with_header(kind("text/html; charset=utf-8")))
        }
        (true, path) => match file(board, path) {
            Some((file, sort)) => request.respond(Response::from_file(file).with_header(kind(sort))),
            None => request.respond(Response::empty(404)),
        },
    };
}

/// The page of the last results, with the script that follows.
fn page(board: &Board) -> String {
    let shown = board.shown();
    let page = shown.folder.and_then(|folder| std::fs::read_to_string(folder.join(PAGE)).ok());
    let page = page.unwrap_or_else(|| EMPTY.to_owned());
    // `<` would end the script.
    let message = json!(shown.message).to_string().replace('<', "\\u003c");
    // In a scope of its own: the page has names too.
    let about = format!("{{ version: {}, message: {message} }}", shown.version);
    let script = format!("<script>(shown => {{\n{SCRIPT}}})({about});</script>\n");
    match page.rfind("</body>") {
        Some(end) => format!("{}{script}{}", &page[..end], &page[end..]),
        None => page + &script,
    }
}

/// A file in the folder of results, and what it is.
fn file(board: &Board, path: &str) -> Option<(File, &'static str)> {
    let inside = Path::new(path.strip_prefix('/')?);
    let is_inside = inside.components().all(|part| matches!(part, Component::Normal(_)));
    let path = board.shown().folder?.join(inside);
    let file = File::open(&path).ok().filter(|_| is_inside && path.is_file())?;
    let sort = match path.extension().and_then(|ending| ending.to_str()) {
        Some("svg") => "image/svg+xml",
        Some("html") => "text/html; charset=utf-8",
        Some("json") => "application/json",
        Some("csv") => "text/csv; charset=utf-8",
        _ => "application/octet-stream",
    };
    Some((file, sort))
}

fn kind(of: &str) -> Header {
    // Both are known here, and none has a character that no header can have.
    Header::from_bytes("Content-Type", of).unwrap_or_else(|()| unreachable!("a content type of this program"))
}
