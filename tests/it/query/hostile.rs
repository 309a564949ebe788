//! Queries made to break something: an answer or one sentence, never a crash.

use chacha20::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

use super::Shop;
use gearstudy::query::Answer;

fn ask(shop: &Shop, query: &str) -> Result<Answer, String> {
    let answer = shop.ask(query);
    if let Err(problem) = &answer {
        assert!(!problem.is_empty() && !problem.contains('\n'), "{query}: {problem}");
        for inside in ["sqlite", "Ident", "Span", "Some(", "::"] {
            assert!(query.contains(inside) || !problem.contains(inside), "{query}: {problem}");
        }
    }
    answer
}

#[test]
fn deep_and_long_queries_are_refused_or_answered() {
    let shop = Shop::new();
    let chain = |terms: usize| format!("SELECT point{} FROM s.rows", " + 1".repeat(terms));
    assert_eq!(ask(&shop, &chain(190)).unwrap().columns[0].cells[0], Some(191_i64.into()));
    assert!(ask(&shop, &chain(2000)).unwrap_err().contains("more than 200 terms within each other"));
    assert!(ask(&shop, &chain(5000)).unwrap_err().contains("the longest has 16384"));
    let nested = format!("SELECT {}1{}", "(".repeat(3000), ")".repeat(3000));
    assert!(ask(&shop, &nested).unwrap_err().contains("no SQL"));
    let within =
        |depth: usize| (0..depth).fold("s.more".to_owned(), |inner, _| format!("(SELECT * FROM {inner}) AS a"));
    assert!(ask(&shop, &format!("SELECT * FROM {}", within(10))).is_ok());
    assert!(ask(&shop, &format!("SELECT * FROM {}", within(500))).is_err());
    // What is asked of a term is not written out for each of its limits: that would be 3^40 of them.
    let among = |depth: usize| format!("SELECT {}1{} AS a", "(".repeat(depth), " IN (0, 1, 2))".repeat(depth));
    let between = |depth: usize| format!("SELECT {}1{} AS a", "(".repeat(depth), " BETWEEN 0 AND 1)".repeat(depth));
    for query in [among(20), between(20)] {
        assert_eq!(ask(&shop, &query).unwrap().columns[0].cells[0], Some(1_i64.into()), "{query}");
    }
    // As long as a text may be.
    let union = |more: usize| format!("SELECT 1{}", " UNION SELECT 1".repeat(more));
    assert!(ask(&shop, &union(63)).is_ok());
    assert!(ask(&shop, &union(1000)).is_err());
    let _ = ask(&shop, &format!("SELECT {} 1 FROM s.rows", "x AS x, ".repeat(1500)));
    let _ = ask(&shop, &format!("SELECT * FROM s.rows WHERE point IN ({})", "1,".repeat(8000)));
    let cases = |depth: usize| {
        format!("SELECT {}1{} AS a FROM s.rows", "CASE WHEN x > 0 THEN 0 ELSE ".repeat(depth), " END".repeat(depth))
    };
    for depth in [8, 20] {
        assert_eq!(ask(&shop, &cases(depth)).unwrap().columns[0].cells.len(), 5, "{depth}");
    }
    // Deeper ones the parser itself refuses.
    assert!(ask(&shop, &cases(400)).is_err());
    assert!(ask(&shop, &format!("SELECT {}x FROM s.rows", "-".repeat(3000))).is_err());
    assert!(ask(&shop, &format!("SELECT {}inside FROM s.rows", "NOT ".repeat(3000))).is_err());
}

#[test]
fn mutated_queries_never_crash() {
    let shop = Shop::new();
    let seeds = [
        "SELECT design, COUNT(*) AS n, MAX(x) FROM s.rows WHERE x > 0.5 GROUP BY design HAVING n > 1 ORDER BY n LIMIT 3",
        "SELECT r.point, m.words FROM s.rows AS r LEFT JOIN s.more AS m ON r.design = m.design WHERE inside OR x IS NULL",
        "WITH a AS (SELECT * FROM s.rows) SELECT CASE WHEN x < 0 THEN 'low' ELSE 'high' END, x * point FROM a",
        "SELECT design || 'x', ROUND(x, 2), CAST(point AS TEXT), SUBSTR(design, 1, 1) FROM s.rows UNION ALL SELECT 1, 2, 3, 4",
        "SELECT x, SUM(x) OVER (PARTITION BY design ORDER BY point) FROM s.rows",
    ];
    let words: Vec<&str> =
        seeds.iter().flat_map(|seed| seed.split(' ')).chain(["NULL", "-1", "''", "1e999", "*"]).collect();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut below = |limit: usize| usize::try_from(random.next_u64() % (limit.max(1) as u64)).unwrap();
    let (mut answered, mut problems) = (0, std::collections::BTreeSet::new());
    for round in 0..400 {
        let mut query: Vec<&str> = seeds[round % seeds.len()].split(' ').collect();
        for _ in 0..=below(2) / 2 {
            let at = below(query.len());
            match below(3) {
                0 => query[at] = words[below(words.len())],
                1 => drop(query.remove(at)),
                _ => query.insert(at, words[below(words.len())]),
            }
        }
        match ask(&shop, &query.join(" ")) {
            Ok(_) => answered += 1,
            Err(problem) => drop(problems.insert(problem)),
        }
    }
    assert!(answered > 20 && problems.len() > 50, "{answered} {}", problems.len());
}

/// A join without a condition of a table with itself, again and again: 5^12 rows in groups, 5^24 in an answer.
#[test]
fn no_query_takes_all_memory() {
    let shop = Shop::new();
    let joined = |times: usize| {
        let tables: Vec<String> = (1..=times).map(|at| format!("s.rows AS t{at}")).collect();
        tables.join(" CROSS JOIN ")
    };
    let command = |query: &str| {
        let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_gearstudy"));
        let results = shop.path().display().to_string();
        command.args(["--results", &results, "query", "--study", "small", query]);
        let output = command.timeout(std::time::Duration::from_mins(2)).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let columns: Vec<String> = (1..=300).map(|at| format!("t1.x AS x{at}")).collect();
    let wide = format!("SELECT {} FROM {{}}", columns.join(", "));
    let long = "SELECT PRINTF('%.1000000c', 'x') AS a FROM {}".to_owned();
    let held = "SELECT t1.x FROM {} ORDER BY HEX(ZEROBLOB(500000)) || t1.point || t2.point".to_owned();
    for (query, times, wanted) in [
        (&wide, 12, "more than 20000000 values"),
        (&wide, 24, "more than 20000000 values"),
        (&held, 9, "takes more than 2048 MiB"),
        (&long, 6, "the answer takes more than 2048 MiB"),
    ] {
        let (code, said) = command(&query.replace("{}", &joined(times)));
        assert_eq!(code, Some(2), "{query} {times}: {said}");
        assert!(said.contains(wanted) && said.lines().count() == 1, "{times}: {said}");
    }
}
