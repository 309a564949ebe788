//! A run that reads only what changed of a study comes to what a run of all of it does: random edits of random studies.
//!
//! Each text is run in three places: where the run before left its note, where that note is taken away before each run, so that
//! all is read, and, now and then, in an empty folder. Must not know: how it is found what changed.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use rand_core::Rng;
use serde_json::Value;

use crate::reliability::published::{differences, published};
use declare::seed::Seed;
use gearstudy::program::PROGRAM;
use studygraph::runner::note::Where;
use studygraph::runner::options::Options;
use studygraph::runner::recall;
use studygraph::store::cache::Cache;
use studygraph::study;

/// What the program ends with where a text is no study.
const NO_STUDY: i32 = 2;

/// A stage of a study to be.
#[derive(Clone)]
struct Sheet {
    name: String,
    text: String,
    /// What stands before it.
    remark: String,
    is_folded: bool,
}

struct Book {
    title: usize,
    sheets: Vec<Sheet>,
    next: usize,
}

fn below(generator: &mut impl Rng, limit: usize) -> usize {
    (generator.next_u64() % limit as u64) as usize
}

fn pair(width: usize) -> String {
    format!(
        "kind: geometry\nmodule: 3 mm\npressure_angle: 20 deg\nmaterial: {{ youngs_modulus: 206 GPa, poisson_ratio: 0.3 }}\n\
         pinion: {{ teeth: 24, face_width: {width} mm, bore_radius: 18 mm }}\n\
         gear: {{ teeth: 36, face_width: 20 mm, bore_radius: 28 mm }}"
    )
}

/// Amounts that differ: of two stages with one key, who computes it is a matter of threads.
fn crowned(pair: &str, amount: usize) -> String {
    let amount = format!("{}.{:03} um", 1 + amount / 1000, amount % 1000);
    format!("kind: modification\npair: {pair}\ndesigns: {{ a: [lead_crowning: {{ gear: pinion, amount: {amount} }}] }}")
}

/// The same of another amount, and without a length that does not fit.
fn with_amount(text: &str, amount: usize) -> String {
    crowned(text.lines().nth(1).and_then(|line| line.strip_prefix("pair: ")).unwrap(), amount)
}

/// A report whose figure wants a table that nobody else does.
fn report(cell: &str, figure: Option<&str>) -> String {
    let mut text =
        format!("kind: report\npublished:\n  - cell: {cell}\n    value: 1.6\n    tolerance: 10 %\n    where: by hand");
    if let Some(stage) = figure {
        write!(
            text,
            "\nfigures:\n  - name: f\n    title: F\n    table: {stage}.profile\n    x: roll_angle\n    y: depth\n    \
             series: gear"
        )
        .unwrap();
    }
    text
}

/// One that most modifications are of, and two that few are of.
const PAIRS: [&str; 5] = ["pair", "other", "pair", "third", "pair"];
const REPORTS: [&str; 2] = ["verdicts", "more"];

impl Book {
    /// `crowned`: stages of one kind.
    fn new(crowned: usize, generator: &mut impl Rng) -> Self {
        let mut book = Self { title: 0, sheets: Vec::new(), next: 0 };
        for (number, name) in PAIRS[1..4].iter().enumerate() {
            book.add(0, (*name).to_owned(), pair(20 + 10 * number));
        }
        for _ in 0..crowned {
            book.add_crowned(generator);
        }
        book
    }

    fn add(&mut self, at: usize, name: String, text: String) {
        self.sheets.insert(at, Sheet { name, text, remark: String::new(), is_folded: false });
    }

    fn add_crowned(&mut self, generator: &mut impl Rng) {
        let (pair, at) = (PAIRS[below(generator, 5)], below(generator, self.sheets.len() + 1));
        self.next += 1;
        self.add(at, format!("m{}", self.next), crowned(pair, self.next));
    }

    fn text(&self) -> String {
        let mut text = format!("study: tiny\ntitle: Number {}\nstages:\n", self.title);
        for Sheet { name, text: own, remark, is_folded } in &self.sheets {
            text += remark;
            let own = if *is_folded { own.replace(": { ", ":\n  { ") } else { own.clone() };
            writeln!(text, "  {name}:\n    {}", own.replace('\n', "\n    ")).unwrap();
        }
        text
    }

    fn any<'a>(&'a mut self, generator: &mut impl Rng, kind: &str) -> Option<&'a mut Sheet> {
        let mut of_kind: Vec<&mut Sheet> =
            self.sheets.iter_mut().filter(|sheet| sheet.text.contains(&format!("kind: {kind}"))).collect();
        (!of_kind.is_empty()).then(|| of_kind.swap_remove(below(generator, of_kind.len())))
    }

    /// One edit; some make no study of it.
    fn edit(&mut self, generator: &mut impl Rng) {
        let any = below(generator, self.sheets.len());
        match below(generator, 40) {
            // Another name of a design, another number of them: all is written.
            36 => {
                if let Some(sheet) = self.any(generator, "modification") {
                    sheet.text = sheet.text.replace("{ a: [", "{ b: [");
                }
            }
            37 | 38 => {
                if let Some(sheet) = self.any(generator, "modification") {
                    sheet.text = sheet.text.replace("designs: { ", "designs: { c: [], ");
                }
            }
            39 => {
                if let Some(sheet) = self.any(generator, "report") {
                    sheet.text = sheet.text.replace("value: 1.6", "value: 1.7");
                }
            }
            // Most edits are of one amount.
            20..=35 => {
                self.next += 1;
                let amount = self.next;
                if let Some(sheet) = self.any(generator, "modification") {
                    sheet.text = with_amount(&sheet.text, amount);
                }
            }
            18 => {
                if let Some(sheet) = self.any(generator, "modification") {
                    sheet.text = sheet.text.replace(
                        "lead_crowning: { gear: pinion, amount",
                        "tip_relief: { gear: pinion, length: 99 mm, amount",
                    );
                }
            }
            0 | 1 | 19 => {
                self.next += 1;
                let (pair, amount) = (PAIRS[below(generator, 5)], self.next);
                if let Some(sheet) = self.any(generator, "modification") {
                    sheet.text = crowned(pair, amount);
                }
            }
            2 => self.add_crowned(generator),
            3 => {
                let name = self.any(generator, "modification").map(|sheet| sheet.name.clone());
                self.sheets.retain(|sheet| Some(&sheet.name) != name.as_ref());
            }
            4 => {
                self.next += 1;
                let name = format!("m-{}", self.next);
                if let Some(sheet) = self.any(generator, "modification") {
                    sheet.name = name;
                }
            }
            5 => {
                let other = below(generator, self.sheets.len());
                self.sheets.swap(any, other);
            }
            6 => self.sheets[any].remark += ["  # a remark\n", "\n", "# m1\n", "    # deep\n"][below(generator, 4)],
            7 => self.sheets[any].is_folded ^= true,
            8..=10 => {
                let width = below(generator, 9);
                if let Some(sheet) = self.any(generator, "geometry") {
                    let number = PAIRS[1..4].iter().position(|name| sheet.name.starts_with(name)).unwrap_or(0);
                    sheet.text = pair(20 + 10 * number + width);
                }
            }
            11..=13 => {
                let figure = self.any(generator, "modification").map(|sheet| sheet.name.clone());
                let figure = figure.filter(|_| below(generator, 3) > 0);
                let text = report(&format!("{}.pair.contact_ratio", PAIRS[below(generator, 5)]), figure.as_deref());
                let name = REPORTS[below(generator, 2)];
                match self.sheets.iter_mut().find(|sheet| sheet.name == name) {
                    Some(sheet) => sheet.text = text,
                    None => self.add(any, name.to_owned(), text),
                }
            }
            14 => self.sheets.retain(|sheet| sheet.name != REPORTS[1]),
            15 => self.title += 1,
            // No study: an unknown unit, or a stage that others read under another name.
            16 => self.sheets[any].text = self.sheets[any].text.replacen(" um", " xm", 1),
            _ => self.sheets[any].name += "x",
        }
    }
}

/// A folder in which a text is run.
struct Home(tempfile::TempDir);

impl Home {
    fn new() -> Self {
        Self(crate::reliability::disk::folder())
    }

    fn path(&self, name: &str) -> std::path::PathBuf {
        self.0.path().join(name)
    }

    fn run(&self, text: &str) -> i32 {
        fs::write(self.path("tiny.yaml"), text).unwrap();
        let word = |name: &str| self.path(name).to_string_lossy().into_owned();
        // What is finished before a stage fails is a matter of threads.
        let words = ["gearstudy", "run", "--quiet", "--keep-going", "--results"].map(str::to_owned);
        let places = [word("results"), "--cache".to_owned(), word("cache"), word("tiny.yaml")];
        gearstudy::cli::main(words.into_iter().chain(places).map(Into::into))
    }

    /// Whether a run of this text would read only a part of it; what it reads is what a reader of all finds, in its place.
    fn reads_a_part(&self, text: &str) -> bool {
        let path = self.path("tiny.yaml");
        fs::write(&path, text).unwrap();
        let (results, cache) = (self.path("results"), self.path("cache"));
        let at = Where { study: &path, results: &results, cache: &cache };
        let Some(part) = recall::part(&at, &PROGRAM, &Options::default()) else { return false };
        let whole = study::load(&path, &PROGRAM).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let names: Vec<&str> = part
            .study
            .stages()
            .map(|stage| match stage {
                Ok(node) => part.study.nodes[node].name.as_str(),
                Err(unread) => unread.name.as_str(),
            })
            .collect();
        assert_eq!(names, whole.nodes.iter().map(|node| &*node.name).collect::<Vec<_>>(), "{text}");
        for node in &part.study.nodes {
            let same = whole.nodes.iter().find(|other| other.name == node.name).unwrap();
            assert_eq!((node.place, &node.record), (same.place, &same.record), "{text}");
        }
        assert_eq!((&part.study.text, &part.study.title), (&whole.text, &whole.title));
        true
    }

    fn forget(&self) {
        for entry in fs::read_dir(self.path("cache/notes")).into_iter().flatten() {
            fs::remove_file(entry.unwrap().path()).unwrap();
        }
    }

    /// The manifest without times and who ran it.
    fn manifest(&self) -> Value {
        let bytes = fs::read(self.path("results/tiny/manifest.json")).unwrap();
        let mut manifest: Value = serde_json::from_slice(&bytes).unwrap();
        for name in ["program", "machine", "study_folder", "written", "seconds"] {
            manifest[name] = Value::Null;
        }
        for stage in manifest["stages"].as_array_mut().unwrap() {
            stage["seconds"] = Value::Null;
            for left in stage["left_out"].as_array_mut().into_iter().flatten() {
                left["saved_seconds"] = Value::Null;
            }
        }
        manifest
    }
}

fn edits(seed: u64, count: usize) -> usize {
    let mut generator = Seed::of_stage(seed, "recall").generator(0);
    let mut book = Book::new([34, 5, 12][usize::try_from(seed % 3).unwrap()], &mut generator);
    let (quick, whole) = (Home::new(), Home::new());
    let mut parts = 0;
    for number in 0..count {
        let before = (book.title, book.sheets.clone());
        for _ in 0..usize::from(number > 0) + below(&mut generator, 6) / 5 {
            book.edit(&mut generator);
        }
        let text = book.text();
        let is_part = quick.reads_a_part(&text);
        whole.forget();
        let code = quick.run(&text);
        assert_eq!(code, whole.run(&text), "{text}");
        if code == NO_STUDY {
            assert!(!is_part, "{text}");
            (book.title, book.sheets) = before;
            continue;
        }
        parts += usize::from(is_part);
        assert_eq!(quick.manifest(), whole.manifest(), "after edit {number} of {seed}\n{text}");
        let found = [&quick, &whole].map(|home| published(&home.path("results/tiny")));
        assert_eq!(differences(&found[0], &found[1]), Vec::<String>::new(), "after edit {number} of {seed}\n{text}");
        let journal = |home: &Home| Cache::open(&home.path("cache")).unwrap().journal("tiny");
        assert_eq!(journal(&quick), journal(&whole), "after edit {number} of {seed}\n{text}");
        if number % 4 == 3 {
            let empty = Home::new();
            // What failed has the tables of its last success elsewhere, and nothing here.
            if empty.run(&text) == 0 {
                let fresh = published(&empty.path("results/tiny"));
                assert_eq!(
                    differences(&found[0], &fresh),
                    Vec::<String>::new(),
                    "after edit {number} of {seed}\n{text}"
                );
            }
        }
    }
    parts
}

/// `GEARSTUDY_EDITS=1000` tries as many studies.
#[test]
fn a_run_of_what_changed_comes_to_what_a_run_of_all_does() {
    let studies = std::env::var("GEARSTUDY_EDITS").ok().and_then(|text| text.parse().ok()).unwrap_or(2);
    let parts: usize = (0..studies).map(|seed| edits(seed, 8)).sum();
    assert!(parts as u64 >= 3 * studies, "{parts} of {studies} studies");
}

type Edit = fn(&mut Vec<Sheet>);

fn seventh(sheets: &mut [Sheet]) -> &mut Sheet {
    sheets.iter_mut().find(|sheet| sheet.name == "m7").unwrap()
}

/// One more stage, one less, another place, name or kind of one, or another one that it reads from is a matter of all of them.
#[test]
fn only_where_the_stages_are_the_same_ones() {
    let mut generator = Seed::of_stage(2, "recall").generator(0);
    let book = Book::new(40, &mut generator);
    let home = Home::new();
    assert_eq!(home.run(&book.text()), 0);
    let changed = |edit: Edit| {
        let mut sheets = book.sheets.clone();
        edit(&mut sheets);
        home.reads_a_part(&Book { title: 0, sheets, next: 0 }.text())
    };
    assert!(changed(|sheets| seventh(sheets).text = with_amount(&seventh(sheets).text, 77)));
    assert!(changed(|sheets| seventh(sheets).remark = "  # a remark\n".to_owned()));
    for edit in [
        (|sheets: &mut Vec<Sheet>| sheets.retain(|sheet| sheet.name != "m7")) as Edit,
        |sheets| {
            let seventh = seventh(sheets).clone();
            sheets.push(Sheet { name: "m99".to_owned(), ..seventh });
        },
        |sheets| sheets.reverse(),
        |sheets| seventh(sheets).name = "seventh".to_owned(),
        |sheets| seventh(sheets).text = pair(33),
        |sheets| {
            let other = if seventh(sheets).text.contains("pair: third") { "other" } else { "third" };
            seventh(sheets).text = crowned(other, 7);
        },
    ] {
        assert!(!changed(edit));
    }
}

/// Whatever happened to a file since, all of the study is read.
#[test]
fn only_where_all_is_as_the_run_before_left_it() {
    let mut generator = Seed::of_stage(1, "recall").generator(0);
    let mut book = Book::new(20, &mut generator);
    let home = Home::new();
    assert_eq!(home.run(&book.text()), 0);
    let changed = |book: &mut Book| {
        let amount = 1 + below(&mut Seed::of_stage(book.next as u64, "amount").generator(0), 900);
        book.next += 1;
        let sheet = book.sheets.iter_mut().find(|sheet| sheet.text.contains("um")).unwrap();
        sheet.text = with_amount(&sheet.text, amount);
        book.text()
    };
    let text = changed(&mut book);
    assert!(home.reads_a_part(&text));
    assert_eq!(home.run(&text), 0);
    // Results, entries of the cache and the journal; what is empty cannot be halved.
    let noted = || -> Vec<std::path::PathBuf> {
        let notes = fs::read_dir(home.path("cache/notes")).unwrap().map(|entry| entry.unwrap().path());
        let note = notes.into_iter().find(|path| path.extension().is_some_and(|ending| ending == "json")).unwrap();
        let note: Value = serde_json::from_slice(&fs::read(note).unwrap()).unwrap();
        let paths =
            note["files"].as_array().unwrap().iter().map(|file| Path::new(file[0].as_str().unwrap()).to_owned());
        paths.filter(|path| fs::metadata(path).unwrap().len() > 0).collect()
    };
    for sixth in 0..6 {
        let noted = noted();
        assert!(noted.len() > 20, "{}", noted.len());
        let path = &noted[sixth * (noted.len() - 1) / 5];
        let text = changed(&mut book);
        assert!(home.reads_a_part(&text), "before {}", path.display());
        let bytes = fs::read(path).unwrap();
        fs::write(path, &bytes[..bytes.len() / 2]).unwrap();
        assert!(!home.reads_a_part(&text), "{}", path.display());
        assert_eq!(home.run(&text), 0);
    }
}
