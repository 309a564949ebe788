//! Numbers in the documentation that come from studies are those of the committed results, to their printed digits.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::layering::rust_files;
use studygraph::store::manifest::Manifest;
use studygraph::store::results::Folder;
use studygraph::table::data::Table;

/// The committed tables of a study.
struct Results {
    folder: Folder,
    manifest: Manifest,
}

impl Results {
    fn of(study: &str) -> Self {
        let folder = Folder::new(&Path::new(env!("CARGO_MANIFEST_DIR")).join("results"), study);
        let manifest = folder.manifest().unwrap();
        Self { folder, manifest }
    }

    fn table(&self, name: &str) -> Table {
        let record = self.manifest.stages.iter().flat_map(|stage| &stage.tables).find(|record| record.name == name);
        self.folder.table(record.unwrap_or_else(|| panic!("no table `{name}`"))).unwrap()
    }

    /// A number of a table with one row, as the table has it.
    fn only(&self, table: &str, column: &str) -> f64 {
        let table = self.table(table);
        assert_eq!(table.rows(), 1, "{}", table.name());
        table.floats(column)[0]
    }

    /// A number of a design under a torque \[N m\].
    fn of_design(&self, table: &str, (design, torque): (&str, f64), column: &str) -> f64 {
        let table = self.table(table);
        let is_it =
            |row: &usize| table.texts("design")[*row] == design && (table.floats("torque")[*row] - torque).abs() < 1e-9;
        let row = (0..table.rows()).find(is_it).unwrap_or_else(|| panic!("no `{design}` at {torque} N m"));
        table.floats(column)[row]
    }
}

/// Percent by which one number exceeds another one, with its sign.
fn beyond(one: f64, other: f64) -> String {
    let percent = 100.0 * (one / other - 1.0);
    let sign = if percent < 0.0 { '−' } else { '+' };
    format!("{sign}{:.1}", percent.abs())
}

/// The same without its sign.
fn apart(one: f64, other: f64) -> String {
    beyond(one, other).chars().skip(1).collect()
}

/// Whether a document has these words, however its lines are broken.
fn assert_said(document: &str, words: &str) {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(document)).unwrap();
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains(words), "{document} has other numbers than the results, which say: {words}");
}

const PAIRS: [(&str, &str); 2] = [("19_48", "19/48"), ("30_40", "30/40")];

/// Single, double, mean stiffness, and the peak-to-peak, of a method on a pair.
fn of_method(results: &Results, method: &str, pair: &str) -> [f64; 4] {
    let stiffness = |column: &str| results.only(&format!("{method}_{pair}.summary"), column);
    let peak_to_peak = results.only(&format!("ste_{method}_{pair}.summary"), "peak_to_peak");
    [stiffness("single_max"), stiffness("double_max"), stiffness("mean"), peak_to_peak]
}

#[test]
fn methods_beside_finite_elements_are_the_study_s() {
    let results = Results::of("methods");
    let methods = [
        ("energy_formula", "energy, Sainsot"),
        ("energy_ring", "energy, ring"),
        ("weber_banaschek", "Weber and Banaschek"),
        ("iso6336", "ISO 6336"),
        ("finite_element_weber", "finite elements, Weber's law"),
    ];
    for (pair, name) in PAIRS {
        let reference = of_method(&results, "reference", pair);
        for (method, words) in methods {
            let found = of_method(&results, method, pair);
            let cells: Vec<String> =
                (0..4).map(|index| format!("{} %", beyond(found[index], reference[index]))).collect();
            assert_said("docs/methods.md", &format!("| {name} | {words} | {} |", cells.join(" | ")));
        }
    }
    let [one, two] = PAIRS.map(|(pair, _)| {
        let [found, reference] = ["finite_element_weber", "reference"].map(|method| of_method(&results, method, pair));
        [2, 3].map(|index| apart(found[index], reference[index]))
    });
    assert_said(
        "docs/methods.md",
        &format!(
            "the mean stiffness is {} and {} % too large, the peak-to-peak of unmodified gears {} and {} % too small",
            one[0], two[0], one[1], two[1]
        ),
    );
    let [one, two] = PAIRS.map(|(pair, _)| {
        let [found, ring] = ["iso6336", "energy_ring"].map(|method| of_method(&results, method, pair));
        [0, 1, 2, 3].map(|index| (beyond(found[index], ring[index]), 100.0 * (found[index] / ring[index] - 1.0)))
    });
    assert_said(
        "docs/methods.md",
        &format!(
            "19/48 single contact {} %, double {} %, mean {} %; 30/40 {} %, {} %, {} %. The peak-to-peak of the unmodified \
             pair is {:.0} and {:.0} % larger",
            one[0].0, one[1].0, one[2].0, two[0].0, two[1].0, two[2].0, one[3].1, two[3].1
        ),
    );
}

#[test]
fn crowned_faces_are_the_study_s() {
    let results = Results::of("crowned_face");
    let changed = |design: &str, column: &str| {
        let [coupled, independent] = ["coupled", "independent"]
            .map(|stage| results.of_design(&format!("{stage}.summary"), (design, 100.0), column));
        beyond(coupled, independent)
    };
    assert_said(
        "docs/methods.md",
        &format!(
            "crown of 20 µm, mean {} %, peak-to-peak {} %, largest pressure {} %; tilt of 20 µm {}, {} and {} %; crown of 5 µm, \
             mean {} %",
            changed("crown_20um", "mean"),
            changed("crown_20um", "peak_to_peak"),
            changed("crown_20um", "largest_pressure"),
            changed("tilt_20um", "mean"),
            changed("tilt_20um", "peak_to_peak"),
            changed("tilt_20um", "largest_pressure"),
            changed("crown_5um", "mean"),
        ),
    );
}

#[test]
fn searches_and_coupling_of_the_article_s_pair_are_the_study_s() {
    let results = Results::of("energy_ga");
    let thousands = |count: i64| format!("{},{:03}", count / 1000, count % 1000);
    let [genetic, evolution] = ["optimum", "optimum_de"].map(|stage| {
        let table = results.table(&format!("{stage}.best"));
        (table.floats("objective")[0], thousands(table.integers("evaluations")[0]))
    });
    assert_said(
        "docs/methods.md",
        &format!(
            "the genetic algorithm reaches {:.4} µm in {} evaluations, differential evolution with a simplex {:.4} µm in {}",
            genetic.0, genetic.1, evolution.0, evolution.1
        ),
    );
    let [summed, coupled] = ["ste", "ste_coupled"]
        .map(|stage| results.of_design(&format!("{stage}.summary"), ("unmodified", 50.0), "peak_to_peak"));
    let change = beyond(coupled, summed);
    let [before, after] =
        ["stiffness", "stiffness_coupled"].map(|stage| results.only(&format!("{stage}.summary"), "double_max"));
    assert_said(
        "docs/methods.md",
        &format!(
            "Measured: {:.3}e8 summed, {:.3}e8 N/m coupled (−{:.0} %); peak-to-peak of the unmodified pair {summed:.3} and \
             {coupled:.3} µm ({}{:.0} %)",
            before / 1e8,
            after / 1e8,
            100.0 * (1.0 - after / before),
            change.chars().next().unwrap(),
            100.0 * (1.0 - coupled / summed),
        ),
    );
}

#[test]
fn roots_with_the_least_tension_are_the_study_s() {
    let results = Results::of("root_search");
    let [rack, arc] = ["rack", "arc"].map(|root| results.only(&format!("{root}_stress.best"), "objective"));
    assert_said("docs/methods.md", &format!("has the least tension, σ m b/F = {rack:.3},"));
    assert_said("docs/methods.md", &format!("has {arc:.3}. The fully"));
}

/// What Weber's law costs over torque, relief and plane, as the guide of the results tells it.
#[test]
fn what_weber_s_law_costs_is_the_study_s() {
    let results = Results::of("contact");
    for (plane, suffix) in [("strain", ""), ("stress", "_stress")] {
        for (design, words) in [("unmodified", "none"), ("relief_10um", "10 µm"), ("relief_25um", "25 µm")] {
            let mut cells = Vec::new();
            for torque in [20.0, 100.0, 300.0] {
                let [weber, resolved] = ["weber", "resolved"].map(|law| {
                    let table = format!("ste_{law}{suffix}.summary");
                    ["mean", "peak_to_peak"].map(|column| results.of_design(&table, (design, torque), column))
                });
                cells.extend([beyond(weber[0], resolved[0]), beyond(weber[1], resolved[1])]);
            }
            assert_said("docs/methods.md", &format!("| {plane} | {words} | {} |", cells.join(" | ")));
        }
    }
}

/// A printout takes at most six lines for five numbers, names and reasons included, and as many as the guide says.
#[test]
fn printouts_are_as_short_as_said() {
    let mut said = Vec::new();
    for study in ["rating", "sun_planet", "undercut", "fzg_c"] {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies").join(study).with_extension("yaml");
        let text = fs::read_to_string(file).unwrap();
        let report = text.lines().skip_while(|line| line.trim() != "kind: report");
        let lines = report.take_while(|line| !matches!(*line, "    compare:" | "    published:")).count();
        let numbers =
            Results::of(study).table("report.verdicts").texts("kind").iter().filter(|kind| *kind == "value").count();
        assert!(5 * lines <= 6 * numbers, "{study}: {lines} lines for {numbers} numbers");
        said.push((numbers, lines));
    }
    let [rating, sun_planet, undercut, fzg_c] = said[..] else { unreachable!() };
    let words = format!("is a printout of {} numbers in {} lines, `sun_planet.yaml` of", rating.0, rating.1);
    assert_said("docs/guide.md", &format!("{words} {} in {}.", sun_planet.0, sun_planet.1));
    let words = format!("`undercut.yaml` ({} numbers in {} lines) and", undercut.0, undercut.1);
    assert_said("docs/guide.md", &format!("{words} `fzg_c.yaml` ({} in {}) have", fzg_c.0, fzg_c.1));
}

/// The words of code that stand in backquotes.
fn code_words(text: &str) -> impl Iterator<Item = &str> {
    let is_name = |word: &&str| word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    text.split('`').skip(1).step_by(2).filter(is_name)
}

/// Names of the glossary that no source has.
fn missing_names(glossary: &str) -> Vec<&str> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = ["crates", "src"].into_iter().flat_map(|folder| rust_files(&top.join(folder)));
    let sources: String = files.map(|file| fs::read_to_string(file).unwrap()).collect();
    let words: BTreeSet<&str> = sources.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').collect();
    code_words(glossary).filter(|name| !words.contains(name)).collect()
}

#[test]
fn names_of_the_glossary_are_in_the_source() {
    let glossary = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/glossary.md")).unwrap();
    assert!(code_words(&glossary).count() > 60);
    assert_eq!(missing_names(&glossary), Vec::<&str>::new());
    assert_eq!(missing_names("| span | `span`, `neither_type_nor_column` |"), ["neither_type_nor_column"]);
}

/// A document with another number, or none, is found.
#[test]
#[should_panic(expected = "has other numbers than the results")]
fn other_numbers_are_found() {
    assert_said("docs/methods.md", "the mean stiffness is 99.9 and 99.9 % too large");
}
