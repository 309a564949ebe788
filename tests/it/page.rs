//! Pages in a browser: `tests/python/page.py` opens them in headless Chromium, from the disk and without a network.
//!
//! Without Chromium or the Python environment the test says so, loudly, and is skipped.

use std::ffi::OsStr;
use std::fs;
use std::path::Path;

use crate::desk::Desk;
use crate::python;

/// A study as in the README, with nothing said of figures.
const PLAIN: &str = "\
study: plain
title: Tip relief for a torque range
stages:
  pair:
    kind: geometry
    module: 3 mm
    material: { youngs_modulus: 206 GPa, poisson_ratio: 0.3 }
    pinion: { teeth: 24, face_width: 20 mm, bore_radius: 18 mm }
    gear: { teeth: 36, face_width: 20 mm, bore_radius: 28 mm }
  stiffness: { kind: stiffness, pair: pair, method: energy, root: trochoid, contact: linear, coupling: body }
  designs:
    kind: modification
    pair: pair
    designs:
      unmodified: []
      relieved:
        - tip_relief: { gear: both, amount: 12 um, length: 4 mm, curve: parabolic }
        - lead_crowning: { gear: pinion, amount: 4 um }
  ste: { kind: ste, stiffness: stiffness, designs: designs, torque: { from: 50 N m, to: 250 N m, count: 5 } }
";

/// Results beside others: one that agrees, one that differs with a reason and one without, one without a tolerance.
const COMPARE: &str = "  report:
    kind: report
    compare:
      - { label: Relief raises the mean, cell: 'ste.summary[design=relieved].mean', against: 'ste.summary[design=unmodified].mean' }
      - { cell: 'ste.summary[design=relieved, torque=250 N m].mean', against: 'ste.summary[design=relieved, torque=250 N m].mean', tolerance: 1 % }
      - { cell: stiffness.summary.single_max, against: stiffness.summary.double_max, tolerance: 10 %, because: two pairs carry }
      - { cell: stiffness.summary.single_min, against: stiffness.summary.double_min, tolerance: 10 % }
    figures:
      - name: torque
        title: Peak-to-peak over torque
        table: ste.summary
        x: torque
        y: peak_to_peak
        series: design
        labels: { relieved: With relief, unmodified: As cut }
        width: column
      - name: contact
        title: Pressure on the flank at 150 N m
        kind: map
        table: ste.pressure
        x: path_position
        y: z
        value: pressure
        where: { design: relieved, torque: 150 N m }
      - { name: mesh, title: In mesh, kind: drawing, table: pair.mesh_drawing, x: x, y: y, series: curve, segments: run }
";

/// As many series as nobody can read at once, and points that a logarithmic axis has no place for.
const MANY: &str = "  report:
    kind: report
    figures:
      - { name: curves, title: Over the cycle, table: ste.curve, x: cycle_position, y: transmission_error, series: torque, where: { design: relieved } }
      - { name: amplitude, title: Over torque, table: ste.summary, x: torque, y: peak_to_peak, series: design, log: both }
";

/// The text between two others.
fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    text.split(from).nth(1).and_then(|rest| rest.split(to).next()).unwrap_or_else(|| panic!("no {from}"))
}

#[test]
fn a_study_that_says_nothing_has_figures_and_a_data_sheet() {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("plain.yaml"), PLAIN).unwrap();
    desk.run(&["run", "--quiet", "plain.yaml"], 0);
    let read = |file: &str| fs::read_to_string(desk.path("results/plain").join(file)).unwrap();
    let page = read("report.html");
    for figure in [
        "ste_transmission_error",
        "ste_torque",
        "ste_load_share",
        "stiffness_mesh",
        "designs_profile_pinion",
        "designs_profile_gear",
        "designs_lead_pinion",
        "pair_teeth",
    ] {
        assert!(page.contains(&format!("id=\"figure-{figure}\"")), "{figure}");
        assert!(read(&format!("figures/{figure}.svg")).starts_with("<svg"), "{figure}");
    }
    // Only the pinion is crowned: a flat line says less than a sentence.
    assert!(!page.contains("id=\"figure-designs_lead_gear\""));
    let chart = between(&page, "id=\"figure-designs_profile_pinion\"", "<div class=\"legend\"");
    assert!(chart.contains("unmodified in every design: the lead of the gear"), "{chart}");
    // The points of the path of contact have their names on the drawing, and are explained above it.
    let mesh = between(&page, "id=\"figure-pair_teeth\"", "</figure>");
    assert!(["A", "B", "C", "D", "E"].iter().all(|point| mesh.contains(&format!(">{point}</text>"))), "{mesh}");
    assert!(mesh.contains("D: inner and outer point of single pair contact"), "{mesh}");
    let sheet = between(&page, "<section id=\"pair\">", "</section>");
    for cell in
        ["3\u{202f}mm", ">24<", ">36<", "ε<sub>α</sub>", "206\u{202f}GPa", "5 from 50\u{202f}N·m to 250\u{202f}N·m"]
    {
        assert!(sheet.contains(cell), "{cell}: {sheet}");
    }
    // Altair reads every figure, by the schema of Vega-Lite.
    let said = python::run("vega.py", &[desk.path("results/plain/figures").as_os_str()]);
    assert!(said.is_none_or(|said| said.starts_with("8 figures")), "all figures");
    // The contact ratio is that of the closed form, by radii alone.
    let (tip, base, pitch): (fn(f64) -> f64, f64, f64) =
        (|z| 3.0 * (z + 2.0) / 2.0, 20f64.to_radians().cos(), std::f64::consts::PI * 3.0 * 20f64.to_radians().cos());
    let reach = |z: f64| (tip(z).powi(2) - (1.5 * z * base).powi(2)).sqrt();
    let ratio = (reach(24.0) + reach(36.0) - 90.0 * 20f64.to_radians().sin()) / pitch;
    assert!(sheet.contains(&format!(">{ratio:.5}")), "{ratio}: {sheet}");
    let length = between(sheet, "<td>g<sub>α</sub></td>", "</td>");
    assert!(length.contains(&format!(">{:.3}\u{202f}mm", ratio * pitch)), "{}: {length}", ratio * pitch);
    // The order of the study, not of the alphabet.
    let legend = between(&page, "id=\"figure-ste_torque\"", "<div class=\"canvas\">");
    assert!(legend.find("unmodified").unwrap() < legend.find("relieved").unwrap(), "{legend}");
    // A depth is exaggerated by a factor that is said, and by which it is drawn: 12 µm at the tip.
    let chart = read("figures/designs_profile_pinion.svg");
    assert!(between(&chart, "Depth (µm), ", "</text>").ends_with(" : 1"), "{chart}");
}

/// A gear has the tool that cut it, and nothing of the other's.
#[test]
fn a_data_sheet_has_each_gear_s_own_tool() {
    let desk = Desk::with("quick.yaml");
    let tools = "study: tools\nseed: 1\nstages:\n  pair:\n    kind: geometry\n    module: 3 mm\n    rack: { dedendum: 1.4, tip_radius: 0.3, \
                 protuberance: 0.1, machining_allowance: 0.08 }\n    pinion: { teeth: 24, face_width: 20 mm, bore_radius: 15 mm }\n    gear: { \
                 teeth: 36, face_width: 20 mm, bore_radius: 20 mm, pinion_cutter: { teeth: 23, profile_shift: 0.17 } }\n";
    fs::write(desk.path("tools.yaml"), tools).unwrap();
    desk.run(&["run", "--quiet", "tools.yaml"], 0);
    let page = fs::read_to_string(desk.path("results/tools/report.html")).unwrap();
    let sheet = between(&page, "<section id=\"pair\">", "</section>");
    let values = |what: &str| -> Vec<String> {
        let line = between(sheet, &format!(">{what}</span></th>"), "</tr>");
        line.split("<td").skip(2).map(|cell| cell.split(['>', '<']).nth(1).unwrap_or_default().to_owned()).collect()
    };
    assert_eq!(values("Dedendum of the rack"), ["1.4", ""]);
    assert_eq!(values("Protuberance of the rack"), ["0.1", ""]);
    assert_eq!(values("Teeth of the cutter"), ["", "23"]);
    assert_eq!(values("Profile shift coefficient of the cutter"), ["", "0.17"]);
    assert!(!sheet.contains("Thickness allowance"), "{sheet}");
}

#[test]
fn a_gear_alone_has_a_picture() {
    let desk = Desk::with("quick.yaml");
    let stages = PLAIN.split_inclusive('\n').take(8).collect::<String>();
    for (teeth, title) in [("", "A tooth of the gear"), ("    outline: { teeth: all }\n", "The gear")] {
        fs::write(desk.path("plain.yaml"), format!("{stages}{teeth}")).unwrap();
        desk.run(&["run", "--quiet", "plain.yaml"], 0);
        let read = |file: &str| fs::read_to_string(desk.path("results/plain").join(file)).unwrap();
        let page = read("report.html");
        assert!(page.contains("<h2>The gear</h2>") && page.contains(">Gear</a>"), "{page}");
        let figure = between(&page, "id=\"figure-pair_profile\"", "</figure>");
        assert!(figure.contains(title), "{figure}");
        // Round a tooth, from the middle of a space to the next one: at least as many points as are asked for.
        let drawing = read("figures/pair_profile.svg");
        let line = between(&drawing, "class=\"series\"", "/>");
        assert!(line.matches('L').count() >= if teeth.is_empty() { 199 } else { 24 * 199 }, "{line}");
    }
}

/// On a logarithmic axis there is no 0: the figure, the page and the run say how many points are not to be seen.
#[test]
fn points_that_are_not_drawn_are_told() {
    let (desk, told) = (Desk::with("quick.yaml"), "2 points at or below 0 are not drawn");
    fs::write(desk.path("plain.yaml"), format!("{PLAIN}{MANY}").replace("from: 50 N m", "from: 0 N m")).unwrap();
    let (said, _) = desk.run(&["run", "plain.yaml"], 0);
    assert!(said.contains(&format!("figure `amplitude`: {told}: an axis is logarithmic")), "{said}");
    let read = |file: &str| fs::read_to_string(desk.path("results/plain").join(file)).unwrap();
    let page = read("report.html");
    let caption = between(&page, "id=\"figure-amplitude\"", "</figcaption>");
    assert!(caption.contains(&format!(">{told}<")), "{caption}");
    assert!(read("figures/amplitude.svg").contains(&format!(">{told}</text>")));
    assert!(!read("figures/curves.svg").contains("not drawn"));
}

#[test]
fn results_stand_beside_results() {
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("plain.yaml"), format!("{PLAIN}{COMPARE}")).unwrap();
    desk.run(&["run", "--quiet", "plain.yaml"], 0);
    let (json, _) = desk.run(&["table", "plain.yaml", "report.comparisons", "--format", "json"], 0);
    let rows: serde_json::Value = serde_json::from_str(&json).unwrap();
    let verdicts: Vec<&str> = rows.as_array().unwrap().iter().map(|row| row["verdict"].as_str().unwrap()).collect();
    assert_eq!(verdicts, ["stated", "agrees", "explained", "differs"]);
    assert_eq!((rows[0]["rows"].as_i64(), rows[0]["row"].as_str()), (Some(5), Some("torque 50\u{202f}N·m")));
    // Against the tables that they come from.
    let (json, _) =
        desk.run(&["table", "plain.yaml", "ste.summary", "--where", "torque=50 N m", "--format", "json"], 0);
    let means: serde_json::Value = serde_json::from_str(&json).unwrap();
    let mean = |design: &str| {
        let row = means.as_array().unwrap().iter().find(|row| row["design"] == design).unwrap();
        row["mean"].as_f64().unwrap()
    };
    let expected = mean("relieved") / mean("unmodified") - 1.0;
    assert!((rows[0]["relative_difference"].as_f64().unwrap() / expected - 1.0).abs() < 1e-9);
    let page = fs::read_to_string(desk.path("results/plain/report.html")).unwrap();
    assert!(page.contains("1 comparison needs attention"));
    let (said, error) = desk.run(&["report", "plain.yaml", "--check"], 4);
    assert!(said.contains("!  differs: ") && said.contains("4 comparisons: 1 differs, 1 stated, 1 agrees"), "{said}");
    assert_eq!(error, "gearstudy: plain: 1 comparison needs attention\n");
    let (json, _) = desk.run(&["report", "plain.yaml", "--format", "json"], 0);
    let told: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!((&told[0]["needs_attention"], told[0]["comparisons"].as_array().map(Vec::len)), (&1.into(), Some(4)));
    let section = between(&page, "<section id=\"comparisons\">", "</section>");
    let places: Vec<usize> =
        ["> differs<", "> explained<", "> stated<"].iter().map(|word| section.find(word).unwrap()).collect();
    assert!(places.is_sorted(), "what needs attention is first: {places:?}");
    // Bodies are solid and what helps to read them is narrow, whatever their order.
    let mesh = between(&page, "id=\"figure-mesh\"", "<div class=\"canvas\"");
    for (curve, line) in [
        ("pinion", "\""),
        ("gear", "\""),
        ("path of contact", "\""),
        ("line of action", ";stroke-width:1.1\""),
        ("tip circles", ";stroke-width:1.1\""),
        ("base circles", ";stroke-dasharray:7 4;stroke-width:1.1\""),
        ("pitch circles", ";stroke-dasharray:14 3 1 3;stroke-width:1.1\""),
    ] {
        let swatch = mesh.split("<button").find(|button| button.contains(&format!("</svg>{curve}</button>"))).unwrap();
        let style = between(swatch, "stroke:var(--s", " d=");
        assert_eq!(&style[1..], format!("){line}"), "{curve}: {swatch}");
    }
    // A column of a journal: 90 mm, with the names of the study.
    let column = fs::read_to_string(desk.path("results/plain/figures/torque.svg")).unwrap();
    assert!(column.contains("width=\"89.96mm\"") && column.contains(">With relief<"), "{column}");
    let order = column.find(">With relief<").unwrap() < column.find(">As cut<").unwrap();
    assert!(order && !column.contains("class=\"title\""));
    for (wrong, message) in [
        ("kind: map\n        table", "kind: line\n        table"),
        ("value: pressure\n", "\n"),
        ("against: stiffness.summary.double_max", "against: ste.summary.mean"),
    ]
    .into_iter()
    .zip(["`value` is the column that a map shows", "a map needs `value`", "is compared with a length"])
    .map(|((from, to), message)| (COMPARE.replacen(from, to, 1), message))
    {
        fs::write(desk.path("plain.yaml"), format!("{PLAIN}{wrong}")).unwrap();
        let output = desk.command(&["run", "--quiet", "plain.yaml"]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && said.contains(message), "{message}: {said}");
    }
}

#[test]
fn pages_hold_in_a_browser() {
    if !Path::new("/usr/bin/chromium").exists() {
        eprintln!("\nSKIPPED: pages_hold_in_a_browser: no chromium; `make setup` installs it\n");
        return;
    }
    let desk = Desk::with("quick.yaml");
    fs::write(desk.path("plain.yaml"), format!("{PLAIN}{COMPARE}")).unwrap();
    let many = format!("{PLAIN}{MANY}").replace("study: plain", "study: many").replace("count: 5", "count: 41");
    fs::write(desk.path("many.yaml"), many).unwrap();
    desk.run(&["run", "--quiet", "quick.yaml", "plain.yaml", "many.yaml"], 0);
    let page = |study: &str| desk.path(&format!("results/{study}/report.html")).into_os_string();
    let arguments = [page("plain"), "--quick".into(), page("quick"), "--many".into(), page("many")];
    let said = python::run("page.py", &arguments.each_ref().map(|argument| argument.as_ref() as &OsStr));
    assert!(said.is_none_or(|said| said.contains("2 pages, ")));
}
