//! The report as a whole: verdicts from the stage `report` on tables like those of a real study, then page and figures.
//!
//! Set `GEARSTUDY_REPORT_OUT` to a folder to keep what is rendered and look at it.

mod record;
mod study;
mod tables;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use declare::record::Value;
use gearstudy::report::{self, Rendered, RenderedFigure};
use record::{figures, group, item, list, published, text};
use study::{manifest, render, study};
use studygraph::store::manifest::OmissionRecord;
use studygraph::table::data::{Row, Table};
use tables::tables;

const VERDICTS: [&str; 7] = ["unexplained", "moved", "outdated", "explained", "refuted", "reproduced", "holds"];

/// The tags of a page or figure are nested properly; gives how many elements there are.
fn check_tags(markup: &str) -> usize {
    const VOID: [&str; 6] = ["meta", "link", "br", "hr", "input", "!DOCTYPE"];
    let (mut open, mut count): (Vec<String>, usize) = (Vec::new(), 0);
    let mut rest = markup;
    while let Some(start) = rest.find('<') {
        rest = &rest[start..];
        if let Some(comment) = rest.strip_prefix("<!--") {
            rest = &comment[comment.find("-->").expect("a comment ends")..];
            continue;
        }
        let end = rest.find('>').expect("a tag ends");
        let tag = &rest[1..end];
        assert!(!tag.contains('<'), "a tag inside a tag: {tag}");
        let name = tag.trim_start_matches('/').split([' ', '/', '\n']).next().unwrap().to_owned();
        if tag.starts_with('/') {
            assert_eq!(open.pop().as_deref(), Some(name.as_str()), "closed in the wrong order");
        } else if !tag.ends_with('/') && !VOID.contains(&name.as_str()) {
            assert_eq!(tag.matches('"').count() % 2, 0, "quotes in {tag}");
            count += 1;
            if name == "style" || name == "script" {
                let close = format!("</{name}>");
                rest = &rest[rest.find(&close).expect("style and script end") + close.len()..];
                continue;
            }
            open.push(name);
        }
        rest = &rest[end + 1..];
    }
    assert_eq!(open, Vec::<String>::new(), "left open");
    count
}

#[test]
fn the_page_shows_every_verdict_and_every_figure() {
    let (manifest, tables) = study(published(), figures());
    let Rendered { html, figures } = render(&manifest, &tables);
    if let Some(folder) = std::env::var_os("GEARSTUDY_REPORT_OUT") {
        let folder = std::path::PathBuf::from(folder);
        std::fs::create_dir_all(folder.join("figures")).unwrap();
        std::fs::write(folder.join("report.html"), &html).unwrap();
        for figure in &figures {
            std::fs::write(folder.join(format!("figures/{}.svg", figure.name)), &figure.svg).unwrap();
        }
        let text = report::text::verdicts(&tables["report.verdicts"], 120).unwrap();
        std::fs::write(folder.join("verdicts.txt"), text).unwrap();
    }
    assert!(check_tags(&html) > 200);
    let verdicts = &tables["report.verdicts"];
    let found: BTreeSet<&str> = verdicts.texts("verdict").iter().map(String::as_str).collect();
    assert_eq!(found, VERDICTS.into_iter().collect(), "the fixture has one of each");
    for (row, verdict) in verdicts.texts("verdict").iter().enumerate() {
        let label = verdicts.texts("label")[row].replace('\'', "&#x27;");
        let start = html.find(&format!("<tr data-verdict=\"{verdict}\"")).expect("a row of this verdict");
        let rows = html[start..].split("<tr ").map(|part| part.split("</tr>").next().unwrap());
        let rows = rows.filter(|row| row.contains(&label) && row.contains(&format!("badge v-{verdict}")));
        assert_eq!(rows.count(), 1, "{label}: {verdict}");
    }
    for shown in [
        "2.867\u{202f}µm &gt; 2.316\u{202f}µm",
        "2.738×10⁸\u{202f}N&#x2f;m",
        "holds in",
        // 0.2 % of the 68.5 % that were published.
        "± 0.137\u{202f}points",
        "outside the fitted range",
        "one slice stands for all",
    ] {
        assert!(html.contains(shown), "{shown}");
    }
    assert_eq!(figures.len(), 6);
    for RenderedFigure { name, svg, .. } in &figures {
        assert!(check_tags(svg) > 5 && html.contains(&format!("id=\"figure-{name}\"")), "{name}");
        assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\"") && !svg.contains("NaN"), "{name}");
    }
    for outside in ["http://", "https://", "src=", "@import", "url("] {
        let links = html.replace("http://www.w3.org/2000/svg", "");
        assert!(!links.contains(outside), "the page reaches outside: {outside}");
    }
}

#[test]
fn jumps_stay_jumps() {
    let (manifest, tables) = study(published(), figures());
    let figures: BTreeMap<String, String> =
        render(&manifest, &tables).figures.into_iter().map(|figure| (figure.name, figure.svg)).collect();
    // Declared by a column, and found by two points at one place: one interruption each in the unmodified curve.
    assert_eq!(figures["stiffness"].matches("class=\"jump\"").count(), 1);
    assert_eq!(figures["transmission_error"].matches("class=\"jump\"").count(), 1);
    assert_eq!(figures["torque_sweep"].matches("class=\"jump\"").count(), 0);
    assert_eq!(figures["torque_sweep"].matches("class=\"mark\"").count(), 6, "three points and three in the legend");
    assert_eq!(figures["stiffness"].matches("class=\"dashes\"").count(), 3, "two lines, one name");
}

#[test]
fn the_same_tables_give_the_same_bytes() {
    let (mut manifest, mut tables) = study(published(), figures());
    let first = render(&manifest, &tables);
    let again = render(&manifest, &tables);
    assert_eq!((&first.html, &first.figures), (&again.html, &again.figures));
    // Another day, another machine, other times: only the last section differs.
    manifest.written = "2027-01-01T00:00:00Z".to_owned();
    manifest.seconds = 3.0;
    manifest.machine.threads = 64;
    manifest.program.commit = None;
    for stage in &mut manifest.stages {
        (stage.seconds, stage.status, stage.why) = (1.0, "hit".to_owned(), "as before".to_owned());
    }
    let slower: Row = vec![2.738_2e8.into(), 4.727e8.into(), 5.0.into()];
    let schema = tables["stiffness.summary"].schema().clone();
    tables.insert("stiffness.summary".to_owned(), Table::from_rows(schema, vec![slower]).unwrap());
    let later = render(&manifest, &tables);
    let before_run = |html: &str| html.split("<!-- run:").next().unwrap().to_owned();
    assert_eq!(before_run(&first.html), before_run(&later.html));
    assert_ne!(first.html, later.html);
    assert_eq!(first.figures, later.figures);
}

#[test]
fn hostile_text_stays_text() {
    const HOSTILE: &str = "<script>alert('x')</script>\"><img src=x onerror=y>&\u{1}</svg>{{ 1234567*2 }}";
    let mut entries = published();
    entries.truncate(1);
    if let Value::Group(record) = &mut entries[0] {
        for field in ["label", "where", "note"] {
            record.fields.iter_mut().find(|(name, _)| *name == field).unwrap().1.value = text(HOSTILE);
        }
        record.fields.push(("because", item(text(HOSTILE))));
    }
    let mut drawn = figures();
    drawn.truncate(1);
    if let Value::Group(record) = &mut drawn[0] {
        for field in ["title", "note"] {
            record.fields.iter_mut().find(|(name, _)| *name == field).unwrap().1.value = text(HOSTILE);
        }
        for field in ["x_label", "y_label"] {
            record.fields.push((field, item(text(HOSTILE))));
        }
        let mark = group(&[("y", text("1 N/m")), ("label", text(HOSTILE))]);
        record.fields.iter_mut().find(|(name, _)| *name == "published").unwrap().1.value = list(vec![mark]);
    }
    let (mut manifest, tables) = study(entries, drawn);
    manifest.title = HOSTILE.to_owned();
    manifest.machine.processor = HOSTILE.to_owned();
    manifest.stages[0].warnings.push(HOSTILE.to_owned());
    manifest.stages[0].why = HOSTILE.to_owned();
    manifest.stages[0].left_out.push(OmissionRecord {
        what: HOSTILE.into(),
        why: HOSTILE.into(),
        saved_seconds: Some(1e-3),
    });
    manifest.stages[0].work.insert(HOSTILE.into(), 1);
    manifest.stages[3].tables[0].description = HOSTILE.into();
    std::sync::Arc::make_mut(&mut manifest.stages[3].tables[0].columns)[0].description = HOSTILE.to_owned();
    let Rendered { html, figures } = render(&manifest, &tables);
    for markup in figures.iter().map(|figure| &figure.svg).chain([&html]) {
        check_tags(markup);
        assert!(
            !markup.contains("<script>alert") && !markup.contains("<img") && !markup.contains("2469134"),
            "hostile text came through"
        );
    }
    assert_eq!(html.matches("<script>").count(), 1, "only the page's own script");
    assert!(html.matches("&lt;script&gt;alert").count() > 10);
}

#[test]
fn a_page_needs_no_report_stage_and_says_what_failed() {
    let tables = tables();
    let mut manifest = manifest(&tables);
    manifest.stages.truncate(4);
    manifest.stages[3].status = "failed".to_owned();
    manifest.stages[3].why = "torque 0 N m: no load to carry".to_owned();
    let Rendered { html, figures } = render(&manifest, &tables);
    assert!(html.contains("<b>ste</b> failed: torque 0 N m: no load to carry") && !figures.is_empty());
    assert!(!html.contains("id=\"verdicts\""));
    check_tags(&html);
}

#[test]
fn a_missing_table_is_named() {
    let (manifest, mut tables) = study(published(), figures());
    tables.remove("ste.curve");
    let error =
        report::render(&manifest, &|name| tables.get(name).cloned().map(Arc::new)).err().expect("it cannot be drawn");
    assert!(error.to_string().contains("`ste.curve`"), "{error}");
}

/// What a stage found may be nothing: the figure says so in its place, and the others are drawn.
#[test]
fn a_figure_without_rows_says_so() {
    let (manifest, mut tables) = study(published(), figures());
    let schema = tables["stiffness.curve"].schema().clone();
    tables.insert("stiffness.curve".to_owned(), Table::from_rows(schema, Vec::new()).unwrap());
    let Rendered { html, figures } = render(&manifest, &tables);
    check_tags(&html);
    let told = |text: &str| text.contains(": table stiffness.curve has no rows</text>");
    for RenderedFigure { name, svg, .. } in &figures {
        assert_eq!(told(svg), name == "stiffness", "{svg}");
    }
    let figure = html.split("id=\"figure-stiffness\"").nth(1).and_then(|rest| rest.split("</figure>").next()).unwrap();
    assert!(figures.len() == 6 && told(figure) && !figure.contains("data-do"), "{figure}");
}

#[test]
fn the_terminal_shows_the_same_in_any_width() {
    let (_, tables) = study(published(), figures());
    let verdicts = &tables["report.verdicts"];
    for width in [10, 60, 80, 120, 200] {
        let shown = report::text::verdicts(verdicts, width).unwrap();
        for verdict in VERDICTS {
            assert!(shown.contains(verdict), "{verdict} at {width}:\n{shown}");
        }
        for line in shown.lines() {
            assert!(
                line.chars().count() <= usize::from(width.max(60)),
                "{} characters at {width}: {line}",
                line.chars().count()
            );
        }
        assert!(!shown.contains('\u{1b}'), "no colours");
    }
}
