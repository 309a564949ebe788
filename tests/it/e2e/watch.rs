//! `gearstudy watch`: the page follows what is saved, and a mistake stands over the last good one.

use std::ffi::OsStr;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use serde_json::Value;

use crate::desk::Desk;
use crate::python;

/// A program that watches, ended with the test.
struct Watching {
    child: Child,
    port: u16,
}

impl Watching {
    fn start(desk: &Desk) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gearstudy"));
        command.current_dir(desk.path(".")).env_remove("GEARSTUDY_CACHE").args(["watch", "quick.yaml"]);
        Self::of(command)
    }

    /// The same by a command that starts it.
    fn of(mut command: Command) -> Self {
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let first = lines.next().unwrap().unwrap();
        let port = first.split("127.0.0.1:").nth(1).and_then(|rest| rest.split('/').next()).unwrap().parse().unwrap();
        // What nobody reads would stop it.
        std::thread::spawn(move || lines.for_each(drop));
        Self { child, port }
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
        stream
    }

    /// Code and body of an answer.
    fn get(&self, path: &str, host: &str) -> (u16, String) {
        let mut stream = self.connect();
        write!(stream, "GET {path} HTTP/1.0\r\nHost: {host}\r\n\r\n").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        let (head, body) = answer.split_once("\r\n\r\n").unwrap();
        (head.split(' ').nth(1).unwrap().parse().unwrap(), body.to_owned())
    }

    fn ask(&self, path: &str) -> (u16, String) {
        self.get(path, &format!("127.0.0.1:{}", self.port))
    }

    /// What is shown once it is not this version: version and message.
    fn after(&self, version: u64) -> (u64, String) {
        loop {
            let shown: Value = serde_json::from_str(&self.ask(&format!("/changes?since={version}")).1).unwrap();
            let (now, message) = (shown["version"].as_u64().unwrap(), shown["message"].as_str().unwrap().to_owned());
            if now != version {
                return (now, message);
            }
        }
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Two stages with a table beside them.
const TRACED: &str = "\
study: quick
stages:
  pair: { kind: geometry, module: 3 mm, pinion: { teeth: 19, face_width: 20 mm, bore_radius: 10 mm }, gear: { teeth: 48, face_width: 18 mm, bore_radius: 20 mm } }
  designs: { kind: modification, pair: pair, designs: { made: [measured: { gear: pinion, file: below/trace.csv }] } }
";

#[test]
fn a_table_that_the_study_names_is_watched_too() {
    let desk = Desk::with("quick.yaml");
    let trace = "roll_lengths [mm], deviations [um]\n4,-2\n8,0\n12,1\n16,-4\n";
    fs::create_dir(desk.path("below")).unwrap();
    fs::write(desk.path("quick.yaml"), TRACED).unwrap();
    fs::write(desk.path("below/trace.csv"), trace).unwrap();
    let watching = Watching::start(&desk);
    assert_eq!(watching.after(0), (1, String::new()));
    fs::write(desk.path("below/trace.csv"), trace.replace("12,1", "12,x")).unwrap();
    let (version, message) = watching.after(1);
    assert!(version == 2 && message.starts_with("below/trace.csv:4:4: `x um` is not a number"), "{message}");
    fs::write(desk.path("below/trace.csv"), trace.replace("12,1", "12,2")).unwrap();
    assert_eq!(watching.after(2), (3, String::new()));
}

#[test]
fn the_page_follows_what_is_saved() {
    let desk = Desk::with("quick.yaml");
    let watching = Watching::start(&desk);
    assert_eq!(watching.after(0), (1, String::new()));
    let (code, page) = watching.ask("/");
    assert_eq!(code, 200);
    assert!(page.contains("Tip relief for a torque range") && page.contains("version: 1, message: \"\""), "{page}");
    assert_eq!(watching.ask("/figures/torque.svg").0, 200);

    let quick = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let relieved = quick.replace("title: Tip relief for a torque range", "title: Another <title>");
    fs::write(desk.path("quick.yaml"), relieved).unwrap();
    assert_eq!(watching.after(1), (2, String::new()));
    assert!(watching.ask("/").1.contains("Another &lt;title&gt;"));

    // A mistake stands over the last good page; put right, with a new file in the place of the old one, it goes.
    fs::write(desk.path("quick.yaml"), quick.replace("fraction: 0.5", "fractoin</script>: 0.5")).unwrap();
    let (version, message) = watching.after(2);
    assert_eq!(version, 3);
    assert!(message.contains("quick.yaml:24:52: unknown field `fractoin</script>`"), "{message}");
    let page = watching.ask("/").1;
    assert!(
        page.contains("Another &lt;title&gt;") && page.contains("unknown field `fractoin\\u003c/script>`"),
        "{page}"
    );
    fs::write(desk.path("other.yaml"), &quick).unwrap();
    fs::rename(desk.path("other.yaml"), desk.path("quick.yaml")).unwrap();
    assert_eq!(watching.after(3), (4, String::new()));

    fs::remove_file(desk.path("quick.yaml")).unwrap();
    let (version, message) = watching.after(4);
    assert!(version == 5 && message.contains("there is no such file"), "{message}");
    fs::write(desk.path("quick.yaml"), "").unwrap();
    let (version, message) = watching.after(5);
    assert!(version == 6 && message.contains("empty"), "{message}");
    fs::write(desk.path("quick.yaml"), &quick).unwrap();
    assert_eq!(watching.after(6), (7, String::new()));
}

/// A busy system empties the file and writes it much later.
#[test]
fn a_save_is_awaited_to_its_end() {
    let desk = Desk::with("quick.yaml");
    let watching = Watching::start(&desk);
    assert_eq!(watching.after(0), (1, String::new()));
    let quick = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    let mut file = fs::File::create(desk.path("quick.yaml")).unwrap();
    std::thread::sleep(Duration::from_millis(300));
    file.write_all(quick.replace("title: Tip relief for a torque range", "title: Another").as_bytes()).unwrap();
    drop(file);
    assert_eq!(watching.after(1), (2, String::new()));
    assert!(watching.ask("/").1.contains("Another"));
}

#[test]
fn what_is_not_there_is_not_waited_for() {
    let desk = Desk::with("quick.yaml");
    let said = desk.run(&["watch", "quik.yaml"], 1).1;
    assert!(said.contains("there is no such file") && said.contains("quick.yaml"), "{said}");
    assert!(desk.run(&["watch", "."], 2).1.contains("this is a directory"));
}

/// The same in a browser, whose page has a script of its own beside the one that follows.
#[test]
fn a_browser_shows_what_is_saved_and_what_is_wrong() {
    if !Path::new("/usr/bin/chromium").exists() {
        eprintln!(
            "\nSKIPPED: a_browser_shows_what_is_saved_and_what_is_wrong: no chromium; `make setup` installs it\n"
        );
        return;
    }
    let desk = Desk::with("quick.yaml");
    let program = OsStr::new(env!("CARGO_BIN_EXE_gearstudy"));
    let said = python::run("watch.py", &[program, desk.path(".").as_os_str()]);
    assert!(said.is_none_or(|said| said.contains(" s at least, ")));
}

#[test]
fn nobody_else_is_answered_and_nothing_else_is_sent() {
    let desk = Desk::with("quick.yaml");
    let watching = Watching::start(&desk);
    watching.after(0);
    // As a browser asks for a page from elsewhere that claims to be here.
    assert_eq!(watching.get("/", "evil.example").0, 403);
    // RFC 9112, section 3.2: one host, no less and no more.
    let own = format!("Host: 127.0.0.1:{}\r\n", watching.port);
    for (version, hosts, code) in [
        ("1.1", own.repeat(2), 400),
        ("1.1", format!("{own}host: evil.example\r\n"), 400),
        ("1.0", own.repeat(2), 400),
        ("1.1", String::new(), 400),
        ("1.0", String::new(), 403),
        ("1.1", own.clone(), 200),
    ] {
        let mut stream = watching.connect();
        write!(stream, "GET / HTTP/{version}\r\n{hosts}\r\n").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        assert!(answer.starts_with(&format!("HTTP/1.1 {code} ")), "{version} {hosts:?}: {:?}", answer.lines().next());
    }
    for path in ["/../quick.yaml", "/..%2fquick.yaml", "//etc/passwd", "/figures/../../../quick.yaml", "/figures"] {
        assert_eq!(watching.ask(path).0, 404, "{path}");
    }
    let address = format!("http://127.0.0.1:{}", watching.port);
    let taken = desk.run(&["watch", "quick.yaml", "--port", &watching.port.to_string()], 1).1;
    assert!(taken.contains(&format!("cannot listen on port {}", watching.port)), "{address}: {taken}");
}

#[test]
fn every_answer_says_what_a_browser_may_do_with_it() {
    let desk = Desk::with("quick.yaml");
    let watching = Watching::start(&desk);
    watching.after(0);
    for path in ["/", "/figures/torque.svg", "/changes?since=0", "/nothing"] {
        let mut stream = watching.connect();
        write!(stream, "GET {path} HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", watching.port).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        let head = answer.split("\r\n\r\n").next().unwrap();
        for header in [
            "X-Content-Type-Options: nosniff",
            "X-Frame-Options: DENY",
            "Cross-Origin-Resource-Policy: same-origin",
            "Content-Security-Policy: default-src 'none';",
            "frame-ancestors 'none'",
        ] {
            assert!(head.contains(header), "{path}: {head}");
        }
        assert!(!head.contains("script-src 'unsafe-inline'") && head.contains("script-src 'sha256-"), "{head}");
    }
}

/// Neither followed nor opened: links out of the folder, files that no manifest lists, pipes.
#[test]
fn only_files_of_the_results_are_opened() {
    let desk = Desk::with("quick.yaml");
    let watching = Watching::start(&desk);
    watching.after(0);
    let results = desk.path("results/quick");
    fs::write(results.join("notes.txt"), "private").unwrap();
    fs::write(desk.path("private"), "private").unwrap();
    assert_eq!(watching.ask("/figures/torque.svg").0, 200);
    for path in ["//dev/watchdog", "//dev/zero", "/notes.txt", "/./figures/torque.svg", "/figures//torque.svg"] {
        assert_eq!(watching.ask(path).0, 404, "{path}");
    }
    #[cfg(unix)]
    {
        fs::remove_file(results.join("figures/torque.svg")).unwrap();
        std::os::unix::fs::symlink(desk.path("private"), results.join("figures/torque.svg")).unwrap();
        assert_eq!(watching.ask("/figures/torque.svg").0, 404, "a link out of the folder");
        fs::remove_file(results.join("figures/torque.svg")).unwrap();
        assert!(Command::new("mkfifo").arg(results.join("figures/torque.svg")).status().unwrap().success());
        assert_eq!(watching.ask("/figures/torque.svg").0, 404, "a pipe");
    }
}

/// Connections that send nothing, or a byte now and then, take no place for long; nor do many that wait for news.
#[test]
fn the_page_is_sent_again_after_a_crowd() {
    let desk = Desk::with("quick.yaml");
    let mut command = Command::new("sh");
    let line = "ulimit -n 128; exec \"$0\" watch quick.yaml";
    command.args(["-c", line, env!("CARGO_BIN_EXE_gearstudy")]);
    command.current_dir(desk.path(".")).env_remove("GEARSTUDY_CACHE");
    let watching = Watching::of(command);
    watching.after(0);
    let mut half_open: Vec<TcpStream> = (0..130).map(|_| watching.connect()).collect();
    for stream in &mut half_open {
        stream.write_all(b"GET / ").unwrap();
    }
    // While they last it is sent, when the first of them have had their time.
    assert_eq!(watching.ask("/").0, 200);
    drop(half_open);
    assert_eq!(watching.ask("/").0, 200);
    let waiting: Vec<TcpStream> = (0..100)
        .map(|_| {
            let mut stream = watching.connect();
            write!(stream, "GET /changes?since=1 HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", watching.port).unwrap();
            stream
        })
        .collect();
    let began = std::time::Instant::now();
    assert_eq!(watching.ask("/").0, 200);
    assert!(began.elapsed() < Duration::from_secs(10), "{:?}", began.elapsed());
    drop(waiting);
    // A byte a second does not make a request last.
    let mut slow = watching.connect();
    slow.set_read_timeout(Some(Duration::from_millis(500))).unwrap();
    let began = std::time::Instant::now();
    let ended = (0..60).any(|_| {
        let sent = slow.write_all(b"G");
        sent.is_err() || slow.read(&mut [0; 64]).is_ok()
    });
    assert!(ended && began.elapsed() < Duration::from_secs(20), "{:?}", began.elapsed());
}
