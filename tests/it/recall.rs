//! A run after an edit gives the results that a first run of the same text gives: random edits of random studies.
//!
//! Must not know: which stages a run computes again.

use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

use rand_core::Rng;
use serde_json::Value;

use crate::reliability::published::{Published, differences, published};
use declare::seed::Seed;

/// The exit code for a text that is not a study.
const NO_STUDY: i32 = 2;

/// A stage: its name and its lines.
type Sheet = (String, String);

#[derive(Clone)]
struct Book {
    title: usize,
    sheets: Vec<Sheet>,
    /// The next unused amount; no two stages have the same key.
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

fn crowned(pair: &str, amount: usize) -> String {
    let amount = format!("{}.{:03} um", 1 + amount / 1000, amount % 1000);
    format!("kind: modification\npair: {pair}\ndesigns: {{ a: [lead_crowning: {{ gear: pinion, amount: {amount} }}] }}")
}

/// A report with one verdict; its figure reads a table on demand of another stage.
fn report(pair: &str, figure: Option<&str>) -> String {
    let cell = format!("{pair}.pair.contact_ratio");
    let mut text =
        format!("kind: report\npublished:\n  - cell: {cell}\n    value: 1.6\n    tolerance: 10 %\n    where: by hand");
    if let Some(stage) = figure {
        let axes = "x: roll_angle\n    y: depth\n    series: gear";
        write!(text, "\nfigures:\n  - name: f\n    title: F\n    table: {stage}.profile\n    {axes}").unwrap();
    }
    text
}

/// Most modifications are of the first pair.
const PAIRS: [&str; 5] = ["pair", "other", "pair", "third", "pair"];

impl Book {
    fn new(crowned: usize, generator: &mut impl Rng) -> Self {
        let pairs = PAIRS[1..4].iter().enumerate().map(|(number, name)| ((*name).to_owned(), pair(20 + 10 * number)));
        let mut book = Self { title: 0, sheets: pairs.collect(), next: 0 };
        for _ in 0..crowned {
            book.add(generator);
        }
        book
    }

    fn crowned(&mut self, generator: &mut impl Rng) -> String {
        self.next += 1;
        crowned(PAIRS[below(generator, PAIRS.len())], self.next)
    }

    fn add(&mut self, generator: &mut impl Rng) {
        let text = self.crowned(generator);
        self.sheets.insert(below(generator, self.sheets.len() + 1), (format!("m{}", self.next), text));
    }

    fn text(&self) -> String {
        let mut text = format!("study: tiny\ntitle: Number {}\nstages:\n", self.title);
        for (name, own) in &self.sheets {
            writeln!(text, "  {name}:\n    {}", own.replace('\n', "\n    ")).unwrap();
        }
        text
    }

    fn any<'a>(&'a mut self, generator: &mut impl Rng, kind: &str) -> &'a mut Sheet {
        let mut of_kind: Vec<&mut Sheet> =
            self.sheets.iter_mut().filter(|(_, text)| text.starts_with(&format!("kind: {kind}\n"))).collect();
        of_kind.swap_remove(below(generator, of_kind.len()))
    }

    /// One edit; some leave a text that is not a study, or a stage that fails.
    fn edit(&mut self, generator: &mut impl Rng) {
        let any = below(generator, self.sheets.len());
        let replace = |sheet: &mut Sheet, old: &str, new: &str| sheet.1 = sheet.1.replacen(old, new, 1);
        match below(generator, 24) {
            0 => self.title += 1,
            1 => self.add(generator),
            2 => drop(self.sheets.remove(any)),
            3 => self.sheets[any].0 += "x",
            4 => self.sheets.swap(any, 0),
            5 => self.sheets[any].1 += "\n# a remark",
            6 => replace(self.any(generator, "modification"), " um", " xm"),
            7 => replace(self.any(generator, "modification"), "{ a: [", "{ b: ["),
            8 => replace(self.any(generator, "modification"), "designs: { ", "designs: { c: [], "),
            9 | 10 => {
                let too_long = "tip_relief: { gear: pinion, length: 99 mm, amount";
                replace(self.any(generator, "modification"), "lead_crowning: { gear: pinion, amount", too_long);
            }
            11..=13 => {
                let width = below(generator, 40);
                self.any(generator, "geometry").1 = pair(20 + width);
            }
            14..=16 => {
                let figure = self.any(generator, "modification").0.clone();
                let text = report(PAIRS[below(generator, 5)], Some(&*figure).filter(|_| !self.next.is_multiple_of(3)));
                self.sheets.retain(|(name, _)| name != "verdicts");
                self.sheets.insert(any.min(self.sheets.len()), ("verdicts".to_owned(), text));
            }
            _ => {
                let text = self.crowned(generator);
                self.any(generator, "modification").1 = text;
            }
        }
    }
}

/// A folder in which a text is run.
struct Home(tempfile::TempDir);

impl Home {
    fn new() -> Self {
        Self(crate::reliability::disk::folder())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn run(&self, text: &str) -> i32 {
        fs::write(self.path("tiny.yaml"), text).unwrap();
        let word = |name: &str| self.path(name).to_string_lossy().into_owned();
        // Without `--keep-going`, which stages finish before one fails depends on the threads.
        let words = ["gearstudy", "run", "--quiet", "--keep-going", "--results"].map(str::to_owned);
        let places = [word("results"), "--cache".to_owned(), word("cache"), word("tiny.yaml")];
        gearstudy::cli::main(words.into_iter().chain(places).map(Into::into))
    }

    fn published(&self) -> Published {
        published(&self.path("results/tiny"))
    }

    /// The stages of the manifest that the last run computed.
    fn computed(&self) -> Vec<String> {
        let bytes = fs::read(self.path("results/tiny/manifest.json")).unwrap();
        let manifest: Value = serde_json::from_slice(&bytes).unwrap();
        let ran = manifest["stages"].as_array().unwrap().iter().filter(|stage| stage["status"] == "ran");
        ran.map(|stage| stage["name"].as_str().unwrap().to_owned()).collect()
    }

    /// Runs a text here and in an empty folder; both end alike, and with the same files where no stage fails.
    fn agrees_with_a_first_run(&self, text: &str, told: &str) -> i32 {
        let (code, first) = (self.run(text), Home::new());
        assert_eq!(code, first.run(text), "{told}\n{text}");
        // A stage that fails keeps the tables of its last success here, and has none there.
        if code == 0 {
            assert_eq!(differences(&self.published(), &first.published()), Vec::<String>::new(), "{told}\n{text}");
        }
        code
    }
}

fn edits(seed: u64, count: usize) {
    let mut generator = Seed::of_stage(seed, "edits").generator(0);
    let mut book = Book::new([34, 5, 12][usize::try_from(seed % 3).unwrap()], &mut generator);
    let home = Home::new();
    for number in 0..count {
        let before = book.clone();
        for _ in 0..usize::from(number > 0) + below(&mut generator, 6) / 5 {
            book.edit(&mut generator);
        }
        if home.agrees_with_a_first_run(&book.text(), &format!("edit {number} of {seed}")) == NO_STUDY {
            book = before;
        }
    }
}

/// `GEARSTUDY_EDITS=1000` tries as many studies.
#[test]
fn a_run_after_an_edit_gives_what_a_first_run_gives() {
    let studies = std::env::var("GEARSTUDY_EDITS").ok().and_then(|text| text.parse().ok()).unwrap_or(2);
    (0..studies).for_each(|seed| edits(seed, 8));
}

/// A file of the results or of the cache that is damaged before the edit is mended by the run after it.
#[test]
fn one_edited_stage_is_computed_alone_and_damaged_files_are_mended() {
    let mut generator = Seed::of_stage(1, "edits").generator(0);
    let mut book = Book::new(40, &mut generator);
    let home = Home::new();
    assert_eq!(home.run(&book.text()), 0);
    let mut edited = |damaged: &str| {
        let text = book.crowned(&mut generator);
        let sheet = book.any(&mut generator, "modification");
        sheet.1 = text;
        let name = sheet.0.clone();
        assert_eq!(home.agrees_with_a_first_run(&book.text(), damaged), 0);
        name
    };
    assert_eq!([edited("")], *home.computed());
    let bundle = "results/tiny/_modification.designs.parquet";
    for file in [bundle, "results/tiny/tiny.h5", "results/tiny/manifest.json", "results/tiny/report.html"] {
        let bytes = fs::read(home.path(file)).unwrap();
        fs::write(home.path(file), &bytes[..bytes.len() / 2]).unwrap();
        assert_eq!([edited(file)], *home.computed(), "{file}");
    }
}
