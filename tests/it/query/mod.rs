//! `gearstudy query`: what SQL gives, against counts by hand and the program's other ways to the same tables; and what it
//! refuses.

mod document;
mod hostile;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use serde_json::Value;
use tempfile::TempDir;

use crate::desk::Desk;
use gearstudy::query::tables::Tables;
use gearstudy::query::{Answer, ask};
use studygraph::history::side::Side;
use studygraph::store::entry::StoredTable;
use studygraph::store::manifest::{FORMAT, Manifest, StageRecord, TableRecord};
use studygraph::store::parquet;
use studygraph::store::results::Folder;
use studygraph::table::data::{Cell, Table};
use studygraph::table::schema::{Column, Schema};

/// Results of two studies, `small` with the tables `s.rows` and `s.more`, `other` with `s.rows`.
struct Shop(TempDir);

impl Shop {
    fn new() -> Self {
        let rows = |scale: f64| {
            let columns = vec![
                Column::text("design", "").key(),
                Column::integer("point", "").key(),
                Column::float("x", "um", "").allows_nan(),
                Column::flag("inside", ""),
            ];
            let row = |design: &str, point: i64, x: f64, inside: bool| {
                vec![Cell::from(design), point.into(), (scale * x).into(), inside.into()]
            };
            let rows = vec![
                row("b", 1, 1.0, true),
                row("b", 2, 2.0, false),
                row("a", 1, 0.1 + 0.2, true),
                row("a", 2, f64::NAN, true),
                row("a", 3, -4.5, false),
            ];
            Table::from_rows(Schema::new("rows", "Some rows.", columns), rows).unwrap()
        };
        let columns = vec![Column::text("design", "").key(), Column::text("words", "")];
        let more = vec![vec![Cell::from("b"), "é | <b>".into()], vec!["c".into(), "".into()]];
        let more = Table::from_rows(Schema::new("more", "", columns), more).unwrap();
        let shop = Self(tempfile::tempdir().unwrap());
        shop.publish("small", &[&rows(1.0), &more]);
        shop.publish("other", &[&rows(10.0)]);
        shop
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn publish(&self, study: &str, tables: &[&Table]) {
        let folder = self.path().join(study);
        fs::create_dir(&folder).unwrap();
        let record = |table: &&Table| {
            let record = TableRecord::new("s", table.schema(), &StoredTable::describe(table).unwrap());
            fs::write(folder.join(&record.file), parquet::write(table).unwrap()).unwrap();
            record
        };
        let stage = StageRecord {
            name: "s".to_owned(),
            kind: "ste".to_owned(),
            version: 1,
            keys: Vec::new(),
            config: Value::Null.into(),
            status: "ran".to_owned(),
            why: String::new(),
            seconds: 0.0,
            work: std::collections::BTreeMap::new(),
            warnings: Vec::new(),
            left_out: Vec::new(),
            tables: tables.iter().map(record).collect(),
        };
        let manifest = Manifest { format: FORMAT, study: study.to_owned(), stages: vec![stage], ..Manifest::default() };
        fs::write(folder.join("manifest.json"), serde_json::to_vec(&manifest).unwrap()).unwrap();
    }

    fn ask(&self, query: &str) -> Result<Answer, String> {
        let open = |revision: Option<&str>| match revision {
            None => Side::folder(self.path(), "the shop"),
            Some(revision) => Err(format!("there is no revision `{revision}`")),
        };
        ask(query, &mut Tables::new(&open, &|_, _| None, Some("small"), None), Duration::from_mins(1))
    }

    /// The rows as text, cells with a space between, NULL as a dash.
    #[track_caller]
    fn rows(&self, query: &str) -> Vec<String> {
        let answer = self.ask(query).unwrap_or_else(|problem| panic!("{query}: {problem}"));
        let rows = answer.columns.first().map_or(0, |column| column.cells.len());
        let cell = |cell: &Option<Cell>| cell.as_ref().map_or("-".to_owned(), Cell::to_string);
        let row =
            |row: usize| answer.columns.iter().map(|column| cell(&column.cells[row])).collect::<Vec<_>>().join(" ");
        (0..rows).map(row).collect()
    }
}

/// While a run publishes, a file may be newer than the manifest: who reads waits for the end of it.
#[test]
fn a_query_waits_for_a_run_that_publishes() {
    let shop = Shop::new();
    let folder = Folder::at(&shop.path().join("small")).unwrap();
    let file = folder.path().join("s.rows.parquet");
    let whole = fs::read(&file).unwrap();
    let lock = folder.lock().unwrap();
    fs::write(&file, "half of it").unwrap();
    let count = std::thread::scope(|scope| {
        let asked = scope.spawn(|| shop.rows("SELECT COUNT(*) FROM s.rows"));
        std::thread::sleep(std::time::Duration::from_millis(300));
        assert!(!asked.is_finished(), "it did not wait");
        fs::write(&file, whole).unwrap();
        drop(lock);
        asked.join().unwrap()
    });
    assert_eq!(count, ["5"]);
    fs::write(&file, "half of it").unwrap();
    assert!(shop.ask("SELECT * FROM s.rows").unwrap_err().contains("is damaged"));
}

#[test]
fn answers_are_those_counted_by_hand() {
    let shop = Shop::new();
    let check = |query: &str, wanted: &[&str]| assert_eq!(shop.rows(query), wanted, "{query}");
    // The table as it is: sorted by key, NaN as NULL, the last bit of a sum kept.
    let all = ["a 1 0.30000000000000004 true", "a 2 - true", "a 3 -4.5 false", "b 1 1 true", "b 2 2 false"];
    check("SELECT * FROM s.rows", &all);
    check("SELECT design, point FROM s.rows WHERE x > 0.5 AND NOT inside", &["b 2"]);
    // NULL counts as nothing: 5 rows, 4 numbers; their sum is −1.2.
    check("SELECT COUNT(*), COUNT(x) AS n, ROUND(SUM(x), 12), MIN(point) FROM s.rows", &["5 4 -1.2 1"]);
    // Groups come in the order of their values, at every run.
    for _ in 0..20 {
        check(
            "SELECT design, COUNT(*) AS n, MAX(x) FROM s.rows GROUP BY design",
            &["a 3 0.30000000000000004", "b 2 2"],
        );
        check("SELECT DISTINCT inside FROM s.rows", &["false", "true"]);
    }
    check("SELECT point FROM s.rows ORDER BY x DESC NULLS LAST LIMIT 2", &["2", "1"]);
    let joined = "SELECT r.point, m.words FROM s.rows AS r JOIN s.more AS m ON r.design = m.design";
    check(joined, &["1 é | <b>", "2 é | <b>"]);
    check(&joined.replace("JOIN", "FULL JOIN"), &["1 é | <b>", "1 -", "2 é | <b>", "2 -", "3 -", "- "]);
    check("SELECT words FROM s.more WHERE design IN (SELECT design FROM s.rows)", &["é | <b>"]);
    check("WITH big AS (SELECT * FROM s.rows WHERE x >= 1) SELECT COUNT(*) FROM big", &["2"]);
    check("SELECT design FROM s.more UNION SELECT design FROM s.rows", &["a", "b", "c"]);
    check("SELECT 1 + 1 AS a, 'a' || 'b' AS b, 7 / 2 AS c, ABS(-3) AS d, 5.5 % 2, 7 / 2 / 2", &["2 ab 3.5 3 1.5 1.75"]);
    check("SELECT point / 2, point % 2 FROM s.rows WHERE design = 'b'", &["0.5 1", "1 0"]);
    check(
        "SELECT COUNT(*) FROM s.rows AS r WHERE EXISTS (SELECT 1 FROM s.more AS m WHERE m.design = r.design)",
        &["2"],
    );
    // What is called so by the query holds what it says.
    check("SELECT design + 1 AS n FROM (SELECT point AS design FROM s.rows) AS t ORDER BY n DESC LIMIT 1", &["4"]);
    // Kinds mix in one column: a whole number beside others is one of them, beside a text it is one.
    check("SELECT COALESCE(x, 0) FROM s.rows WHERE design = 'a'", &["0.30000000000000004", "0", "-4.5"]);
    check("SELECT CASE WHEN inside THEN point ELSE 'no' END FROM s.rows WHERE design = 'b'", &["1", "no"]);
    // By hand: 1, 2, 0.3 and −4.5 have the median 0.65, 1 and 2 the variance 1/2; one value has none.
    check("SELECT ROUND(MEDIAN(x), 12), MEDIAN(point) FROM s.rows", &["0.65 2"]);
    check("SELECT VARIANCE(x), ROUND(STDDEV(x), 9) FROM s.rows WHERE design = 'b'", &["0.5 0.707106781"]);
    check("SELECT -7 % 3, 1 / 0, -2 - -3 FROM s.more LIMIT 1", &["-1 - 1"]);
    check("SELECT STDDEV(x) FROM s.rows WHERE x > 1.5", &["-"]);
    check("SELECT SQRT(POW(3, 2) + 16), ROUND(COS(RADIANS(60)), 12), LN(-1) FROM s.more", &["5 0.5 -", "5 0.5 -"]);
    let rank = "SELECT design, point, ROW_NUMBER() OVER (PARTITION BY design ORDER BY point DESC) AS n FROM s.rows";
    check(&format!("{rank} ORDER BY design, n"), &["a 3 1", "a 2 2", "a 1 3", "b 2 1", "b 1 2"]);
}

#[test]
fn a_table_has_one_name_however_it_is_written() {
    let shop = Shop::new();
    let names =
        ["s.rows", "small.s.rows", "\"s.rows\"", "\"small.s.rows\"", "\"small\".s.\"rows\"", "small.\"s.rows\""];
    for name in names {
        let query = format!("SELECT COUNT(*) FROM {name} WHERE inside");
        assert_eq!(shop.rows(&query), ["3"], "{name}");
        assert_eq!(shop.rows(&query.replace("small", "other")), ["3"], "{name}");
    }
    // Before a column it is written the same way; two studies side by side.
    let ratio = "SELECT DISTINCT ROUND(other.s.rows.x / small.s.rows.x, 9) FROM small.s.rows JOIN other.s.rows ON \
                 small.s.rows.design = other.s.rows.design AND small.s.rows.point = other.s.rows.point \
                 WHERE small.s.rows.x IS NOT NULL";
    assert_eq!(shop.rows(ratio), ["10"]);
    assert_eq!(shop.ask("SELECT s.rows.* FROM s.rows").unwrap().columns.len(), 4);
    // A column called like a part of a table's name is that column.
    assert_eq!(
        shop.rows("SELECT rows.point FROM s.more AS s JOIN s.rows AS rows ON s.design = rows.design"),
        ["1", "2"]
    );
}

#[test]
fn what_is_wrong_is_said_in_one_sentence_with_the_nearest_name() {
    let shop = Shop::new();
    for (query, wanted) in [
        ("SELEC * FROM s.rows", "the query is no SQL: "),
        ("", "a query is one SELECT"),
        ("SELECT 1; SELECT 2", "a query is one SELECT"),
        ("DROP TABLE s.rows", "a query is one SELECT"),
        ("DELETE FROM s.rows", "a query is one SELECT"),
        ("WITH a AS (SELECT 1) DELETE FROM s.rows RETURNING design", "a query is one SELECT"),
        ("WITH a AS (SELECT 1) UPDATE s.rows SET x = 0 RETURNING x", "a query is one SELECT"),
        ("WITH a AS (SELECT 1) INSERT INTO s.more VALUES ('a', 'b')", "a query is one SELECT"),
        ("CREATE TABLE a AS SELECT * FROM s.rows", "a query is one SELECT"),
        ("SELECT * FROM s.row", "there is no table `s.row` in the shop; did you mean `s.rows`?"),
        ("SELECT * FROM small.s.mor", "did you mean `small.s.more`?"),
        ("SELECT * FROM smal.s.rows", "did you mean `small.s.rows`?"),
        ("SELECT * FROM rows", "there is no table `rows`"),
        ("SELECT * FROM a.b.c.d.e", "there is no table `a.b.c.d.e`"),
        ("SELECT * FROM \"HEAD~9:small.s.rows\"", "there is no revision `HEAD~9`"),
        ("SELECT desing FROM s.rows", "there is no column `desing`; did you mean `design`?"),
        ("SELECT r.desing FROM s.rows AS r", "`desing`"),
        ("SELECT design FROM s.rows WHERE pointt > 1", "did you mean `point`?"),
        ("SELECT x, x FROM s.rows", "two columns of the answer are called `x`; give one another name"),
        ("SELECT nonsense(x) FROM s.rows", "the query cannot be answered: no such function: nonsense"),
        ("SELECT \"desing\" FROM s.rows", "there is no column `desing`; did you mean `design`?"),
        ("SELECT * FROM read_csv('/etc/passwd')", "`read_csv` cannot be called"),
        ("SELECT * FROM read_parquet('x.parquet')", "`read_parquet` cannot be called"),
        ("SELECT 0x1F", "`1F` is hexadecimal"),
        ("SELECT x'00ff'", "`00ff` is hexadecimal"),
        ("SELECT * FROM s.rows WHERE x = ?", "`?` stands for a value that nobody gives"),
        ("SELECT rows.x FROM s.rows", "`rows` is not a table of this query that has a column `x`"),
        ("SELECT s.rowz.x FROM s.rows", "`s.rowz` is not a table of this query; did you mean `s.rows`?"),
        ("SELECT ZEROBLOB(900000000) AS x", "the query cannot be answered: string or blob too big"),
        ("SELECT * FROM sqlite_master", "there is no table `sqlite_master`"),
        ("SELECT load_extension('x')", "the query cannot be answered: "),
    ] {
        let problem = shop.ask(query).expect_err(query);
        assert!(problem.contains(wanted) && !problem.contains('\n'), "{query}: {problem}");
    }
    fs::remove_file(shop.path().join("small/s.more.parquet")).unwrap();
    let problem = shop.ask("SELECT * FROM s.more").unwrap_err();
    let wanted = "`s.more` is not there in the shop, and the cache does not have it; `gearstudy run` computes it again";
    assert_eq!(problem, wanted);
}

/// However it is written: SQLite itself would take every text for 0 and for more than any number.
#[test]
fn text_is_never_taken_for_a_number() {
    let shop = Shop::new();
    let (number, kinds) = ("and the query takes it for a number", "they cannot be compared");
    for (term, wanted) in [
        ("design + 1", number),
        ("DESIGN + 1", number),
        ("(design) * 2", number),
        ("2 - -design", number),
        ("-design", number),
        ("design / 2", number),
        ("design % 2", number),
        ("design & 1", number),
        ("design << 1", number),
        ("CAST(design || '' AS REAL) + (design || 'x')", number),
        ("'a' + 1", number),
        ("ABS('abc')", number),
        ("ROUND('7z')", number),
        ("SQRT(design)", number),
        ("NOT design", number),
        ("design AND inside", number),
        ("SUM(design)", number),
        ("AVG(r.Design)", number),
        ("MEDIAN(design)", number),
        ("SUM(design) OVER ()", number),
        ("x < '1'", kinds),
        ("(x) < '1'", kinds),
        ("X * 1 < '1'", kinds),
        ("'1' >= x", kinds),
        ("inside = 'true'", kinds),
        ("design > 1", kinds),
        ("design > point", kinds),
        ("design <> -5", kinds),
        ("MAX(x) < '1'", kinds),
        ("point BETWEEN 'a' AND 'b'", kinds),
        ("point NOT BETWEEN 0 AND 'b'", kinds),
        ("design BETWEEN 1 AND 5", kinds),
        ("design IN (1, 2)", kinds),
        ("point IN ('1')", kinds),
        ("MAX(x) NOT IN (1, 'a')", kinds),
    ] {
        let problem = shop.ask(&format!("SELECT {term} AS n FROM s.rows AS r")).expect_err(term);
        assert!(problem.ends_with(wanted) && problem.contains(" is text"), "{term}: {problem}");
    }
    for (query, wanted) in [
        ("SELECT design + 1 FROM s.rows", "`design` (`a`) is text, and the query takes it for a number"),
        ("SELECT 1 FROM s.rows WHERE x < '50 um'", "`50 um` is text and `x` (`0.30000000000000004`) a number: they"),
        ("SELECT SUM(d) FROM (SELECT design AS d FROM s.rows)", "`d` (`a`) is text, and"),
        ("SELECT point AS point FROM s.rows WHERE point < '1'", "`1` is text and `point` (`1`) a number"),
        ("SELECT design FROM s.rows GROUP BY design HAVING MAX(point) < '2'", "`2` is text and `3` a number"),
        ("SELECT 1 FROM s.rows AS a JOIN s.rows AS b ON a.x * 1 = b.design", "is text"),
    ] {
        let problem = shop.ask(query).expect_err(query);
        assert!(problem.contains(wanted), "{query}: {problem}");
    }
    // What fits is answered, by whatever name.
    let check = |query: &str, wanted: &[&str]| assert_eq!(shop.rows(query), wanted, "{query}");
    check("WITH c(design) AS (SELECT point FROM s.rows) SELECT MAX(design + 1) FROM c", &["4"]);
    check("WITH Best AS (SELECT MAX(x) AS m FROM s.rows) SELECT m FROM best WHERE m BETWEEN 1 AND 2", &["2"]);
    check("WITH \"s.rows\" AS (SELECT 1 AS one) SELECT one FROM s.rows", &["1"]);
    check("SELECT point FROM s.rows WHERE design IN ('a', 'c') AND x IN (-4.5, 7) AND NOT inside", &["3"]);
    check("SELECT COUNT(*) FROM s.rows WHERE design < 'b' AND point > 1.5 AND inside = 1", &["1"]);
    check("SELECT COUNT(*) FROM s.rows WHERE x = NULL OR x <> x", &["0"]);
    // NULL, where it matters: neither in nor out.
    check("SELECT 1 IN (1, NULL), 2 IN (1, NULL), 2 NOT IN (1, 3), NULL IN (1)", &["1 - 1 -"]);
    check("SELECT 1 BETWEEN 2 AND NULL, 3 BETWEEN 2 AND NULL, 3 NOT BETWEEN 1 AND 2, 3 BETWEEN 3 AND 3", &["0 - 1 1"]);
    check("SELECT 2 NOT IN (1) IS NULL, 1 NOT BETWEEN 0 AND 2 IS NULL", &["0 0"]);
    let many = format!("SELECT COUNT(*) FROM s.rows WHERE point IN ({}3)", "7, ".repeat(500));
    check(&many, &["1"]);
    check("SELECT 9007199254740993 > 9007199254740992, 'a' < 'B', 2 < 2.5", &["1 0 1"]);
    check("SELECT COUNT(*) FROM s.rows WHERE (design, point) = ('a', 3)", &["1"]);
    check("SELECT SUM(inside), SUM(DISTINCT point), COUNT(DISTINCT design) FROM s.rows", &["3 6 2"]);
    // A name may be a word of SQL.
    check("SELECT point AS \"order\" FROM s.rows WHERE x = 2 ORDER BY \"order\"", &["2"]);
}

fn git(desk: &Desk, words: &[&str]) {
    let identity = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"];
    let output = Command::new("git").arg("-C").arg(desk.path("")).args(identity).args(words).output().unwrap();
    assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
}

fn json(desk: &Desk, words: &[&str]) -> Vec<BTreeMap<String, Value>> {
    serde_json::from_str(&desk.run(words, 0).0).unwrap()
}

/// As a user does it: over commits, from the cache, into files.
#[test]
fn queries_reach_studies_and_commits() {
    let desk = Desk::with("quick.yaml");
    git(&desk, &["init", "-q", "-b", "main"]);
    fs::write(desk.path(".gitignore"), ".gearstudy/\nresults/*/*.curve.parquet\n").unwrap();
    let (_, error) = desk.run(&["query", "SELECT 1 FROM ste.summary"], 2);
    assert!(error.contains("there is no results folder `results`"), "{error}");
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    git(&desk, &["add", "-A"]);
    git(&desk, &["commit", "-qm", "one"]);
    let text = fs::read_to_string(desk.path("quick.yaml")).unwrap();
    fs::write(desk.path("quick.yaml"), text.replace("bore_radius: 18 mm", "bore_radius: 17 mm")).unwrap();
    desk.run(&["run", "--quiet", "quick.yaml"], 0);
    git(&desk, &["commit", "-qam", "two"]);

    // The program's own way to the same table.
    let own = json(&desk, &["table", "quick.yaml", "ste.summary", "--format", "json"]);
    let asked = json(&desk, &["query", "SELECT * FROM quick.ste.summary", "--format", "json"]);
    assert!(!own.is_empty() && own == asked);
    let mean = json(&desk, &["query", "SELECT AVG(mean) AS m FROM ste.summary", "--format", "json"]);
    let values: Vec<f64> = own.iter().map(|row| row["mean"].as_f64().unwrap()).collect();
    let by_hand = values.iter().sum::<f64>() / values.len() as f64;
    assert!((mean[0]["m"].as_f64().unwrap() / by_hand - 1.0).abs() < 1e-14);

    // Across commits: what `diff` says of them.
    let across = "SELECT MAX(ABS(new.mean - old.mean)) AS most FROM \"main:quick.ste.summary\" AS new \
                  JOIN \"HEAD~1:quick.ste.summary\" AS old ON new.design = old.design AND new.torque = old.torque";
    let maximum = json(&desk, &["query", across, "--format", "json"])[0]["most"].as_f64().unwrap();
    let diff: Value = serde_json::from_str(&desk.run(&["diff", "HEAD~1", "HEAD", "--format", "json"], 4).0).unwrap();
    let stages = diff["studies"][0]["stages"].as_array().unwrap();
    let tables = stages.iter().flat_map(|stage| stage["tables"].as_array().unwrap());
    let summary = tables.clone().find(|table| table["name"] == "ste.summary").unwrap();
    let column = summary["columns"].as_array().unwrap().iter().find(|column| column["name"] == "mean").unwrap();
    let told = column["largest_absolute"]["difference"].as_f64().unwrap().abs();
    assert!(maximum > 0.0 && maximum.to_bits() == told.to_bits());
    let count = |words: &[&str]| json(&desk, &[&["query", "--format", "json"], words].concat())[0]["n"].clone();
    let bore = "SELECT bore_radius AS n FROM pair.gears WHERE gear = 'pinion'";
    assert_eq!((count(&[bore]), count(&[bore, "--at", "HEAD~1"])), (17.0.into(), 18.0.into()));
    assert_eq!(count(&[bore, "--at", "results/quick"]), 17.0);
    // Not kept in git: from the cache; without one, said.
    let curve = "SELECT COUNT(*) AS n FROM \"HEAD~1:quick.ste.curve\"";
    assert!(count(&[curve]).as_u64().unwrap() > 100);
    let (_, error) = desk.run(&["query", curve, "--cache", "none"], 2);
    assert!(error.contains("`quick.ste.curve` is not kept at HEAD~1 (") && error.contains("the cache"), "{error}");
    for (words, wanted) in [
        (["--at", "mian"], "there is no revision `mian`; did you mean `main`?"),
        (["--study", "quik"], "there is no study `quik` in results; did you mean `quick`?"),
    ] {
        let (out, error) = desk.run(&[&["query", bore][..], &words].concat(), 2);
        assert!(out.is_empty() && error.contains(wanted) && error.lines().count() == 1, "{error}");
    }

    // Formats and files hold the same cells.
    let few = "SELECT gear, bore_radius AS b FROM pair.gears ORDER BY b";
    let (pretty, _) = desk.run(&["query", few], 0);
    assert!(pretty.contains("gear") && pretty.contains("17") && pretty.ends_with("2 rows\n"), "{pretty}");
    let (csv, _) = desk.run(&["query", few, "--format", "csv"], 0);
    assert_eq!(csv, "gear,b\npinion,17\ngear,28\n");
    let (markdown, _) = desk.run(&["query", few, "--format", "markdown"], 0);
    assert_eq!(markdown, "| gear | b |\n| --- | ---: |\n| pinion | 17 |\n| gear | 28 |\n");
    desk.run(&["query", few, "-o", "few.csv"], 0);
    assert_eq!(fs::read_to_string(desk.path("few.csv")).unwrap(), csv);
    desk.run(&["query", few, "-o", "few.parquet", "--quiet"], 0);
    let table = parquet::read(fs::read(desk.path("few.parquet")).unwrap()).unwrap();
    assert_eq!(
        (table.texts("gear"), table.floats("b")),
        (&["pinion".to_owned(), "gear".into()][..], &[17.0, 28.0][..])
    );
    assert!(desk.run(&["query", few, "-o", "few.txt"], 1).1.contains("ends in none of"));
    // Without rows columns hold what they did with them.
    let none = "SELECT gear, teeth, bore_radius AS b FROM pair.gears WHERE bore_radius > 1000";
    desk.run(&["query", none, "-o", "none.parquet", "--quiet"], 0);
    let table = parquet::read(fs::read(desk.path("none.parquet")).unwrap()).unwrap();
    assert!(table.texts("gear").is_empty() && table.integers("teeth").is_empty() && table.floats("b").is_empty());
    let (_, error) = desk.run(&["query", "SELECT 1e999 AS i", "-o", "few.parquet"], 2);
    assert!(error.contains("`i` has inf, which a Parquet file"), "{error}");
    let (_, error) = desk.run(&["query", "-o", "few.csv"], 1);
    assert!(error.contains("[SQL]") || error.contains("<SQL>"), "{error}");
    // Whose name is whole needs no study of that name.
    let whole = "SELECT COUNT(*) AS n FROM \"HEAD~1:quick.pair.gears\"";
    assert_eq!(count(&[whole, "--study", "other"]), 2);
    let (listed, _) = desk.run(&["query"], 0);
    assert!(listed.contains("quick.ste.summary  ") && listed.contains("  peak_to_peak [um]: "), "{listed}");
}
