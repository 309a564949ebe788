//! Gears, materials, loads and modifications at the ends of what can be asked for, through whole studies: a clear refusal
//! or a right answer. What a kernel alone does there is tested beside it.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use serde_json::Value;

use crate::desk::Desk;
use crate::registry::walk::{Ran, demand, load, walk};
use declare::seed::Seed;
use declare::work::Tally;
use gearstudy::stage::{Context, Inputs};

const FINITE_ELEMENT: &str = "{ finite_element: { elements_across: 6 } }";
const RING: &str = "{ energy: { body: ring } }";
const METHODS: [&str; 4] = [FINITE_ELEMENT, RING, "weber_banaschek", "iso6336"];

/// What a study is made of; the rest is the same for all.
struct Case<'a> {
    material: &'a str,
    bore: &'a str,
    method: &'a str,
    contact: &'a str,
    torque: &'a str,
}

const PLAIN: Case = Case { material: "", bore: "20 mm", method: RING, contact: "linear", torque: "20 N m" };

impl Case<'_> {
    fn text(&self) -> String {
        let Self { material, bore, method, contact, torque } = self;
        format!(
            "
study: t
stages:
  pair:
    kind: geometry
    module: 3 mm
    material: {{ {material} }}
    pinion: {{ teeth: 24, face_width: 20 mm, bore_radius: {bore} }}
    gear: {{ teeth: 36, face_width: 20 mm, bore_radius: 28 mm }}
  k: {{ kind: stiffness, pair: pair, method: {method}, contact: {contact}, torque: {torque}, positions: 8 }}
  none: {{ kind: modification, pair: pair, designs: {{ none: [] }} }}
  te: {{ kind: ste, stiffness: k, designs: none, torque: {torque}, positions: 8 }}
"
        )
    }

    fn ran(&self) -> std::collections::BTreeMap<String, Ran> {
        walk(&load(&self.text()))
    }

    /// Largest stiffness of one pair \[N/m\] and mean transmission error \[m\].
    fn numbers(&self) -> [f64; 2] {
        let ran = self.ran();
        let of = |stage: &str, column: &str| {
            ran[stage].tables.iter().find(|table| table.name() == "summary").unwrap().floats(column)[0]
        };
        let found = [of("k", "single_max"), of("te", "mean") * 1e-6];
        assert!(found.iter().all(|value| *value > 0.0 && value.is_finite()), "{found:?}");
        found
    }

    /// What the stage `k` fails with.
    fn failure(&self) -> String {
        let study = load(&self.text());
        let pair = walk(&load(&Case { method: "iso6336", contact: "linear", ..*self }.text()));
        let stage = study.nodes.iter().find(|node| node.name == "k").unwrap().stage.as_ref();
        let mut inputs = Inputs::default();
        inputs.ports.insert("pair".to_owned(), pair["pair"].tables.iter().collect());
        let (stop, wanted, warnings) = (AtomicBool::new(false), demand(stage, false), Mutex::new(Vec::new()));
        let context = Context {
            seed: Seed::of_stage(0, "k"),
            demand: &wanted,
            stop: &stop,
            progress: &|_| {},
            warn: &|text| warnings.lock().unwrap().push(text),
            is_heard: true,
            work: &Tally::default(),
        };
        stage.run(&context, &inputs).err().map_or_else(|| panic!("nothing failed"), |failure| failure.to_string())
    }
}

/// What a study is refused with.
fn refused(text: &str) -> String {
    gearstudy::program::load_text(text, Path::new("t.yaml")).err().map_or_else(String::new, |error| error.to_string())
}

fn near(found: f64, exact: f64, relative: f64, what: &str) {
    assert!((found / exact - 1.0).abs() <= relative, "{what}: {found:e} is not {exact:e}");
}

/// Tier: invariant; a displacement is the load over E, exactly, whatever E is.
#[test]
fn displacement_is_inverse_to_the_modulus() {
    for method in METHODS {
        let with = |modulus: &str| Case { material: &format!("youngs_modulus: {modulus}"), method, ..PLAIN }.numbers();
        let [stiffness, error] = with("206 GPa");
        for (modulus, pascal) in [("1 Pa", 1.0), ("1e15 Pa", 1e15)] {
            let found = with(modulus);
            near(found[0], stiffness * pascal / 206e9, 1e-12, method);
            near(found[1], error * 206e9 / pascal, 1e-11, method);
        }
    }
    for modulus in ["0.9 Pa", "1.1e15 Pa", "0 Pa", "-1 GPa"] {
        let text = Case { material: &format!("youngs_modulus: {modulus}"), ..PLAIN }.text();
        let error = refused(&text);
        assert!(error.contains("`youngs_modulus` must be between 1 Pa and 1000000 GPa"), "{error}");
    }
}

/// Tier: invariant; with linear contact the error is proportional to the torque, from 1e-9 to 1e9 N·m. Under the
/// load-dependent law it grows less than the torque, and the stiffness with it. What no tooth survives is told.
#[test]
fn torques_vanish_and_become_absurd() {
    for method in METHODS {
        let with = |torque: &str, contact: &str| Case { method, contact, torque, ..PLAIN }.numbers();
        let [_, unit] = with("1 N m", "linear");
        for (torque, value) in [("1e-9 N m", 1e-9), ("1e9 N m", 1e9)] {
            near(with(torque, "linear")[1], unit * value, 1e-11, method);
        }
        if method != "iso6336" {
            let found = ["1e-9 N m", "1 N m", "1e9 N m"].map(|torque| with(torque, "load_dependent"));
            assert!(found[0][0] < found[1][0] && found[1][0] < found[2][0], "{method}: {found:?}");
            assert!(found[0][1] > 1e-9 * found[1][1] && found[2][1] < 1e9 * found[1][1], "{method}: {found:?}");
        }
    }
    for (torque, told) in [("20 N m", false), ("1e9 N m", true)] {
        let ran = Case { torque, ..PLAIN }.ran();
        assert_eq!(ran["te"].warnings.iter().any(|warning| warning.contains("no longer linear")), told, "{torque}");
    }
}

/// Tier: closed form; how wide Hertz' contact is in the middle of the path, where its radius is the largest. From where on the
/// law is off by more than a thousandth it is said by how much, and from where on it is no longer followed that too; once,
/// of the worst torque.
#[test]
fn a_contact_too_wide_for_half_planes_is_said() {
    let half_width = |torque: f64| {
        let (angle, modulus) = (20_f64.to_radians(), 206e9 / (2.0 * 0.91));
        let [one, two] = [24.0, 36.0].map(|teeth| 1.5e-3 * teeth * angle.sin());
        let load = torque / (36e-3 * angle.cos()) / 20e-3;
        1e3 * (4.0 * load * (one * two / (one + two)) / (PI * modulus)).sqrt()
    };
    let material = "youngs_modulus: 206 GPa, poisson_ratio: 0.3";
    let mut before = 0.0;
    for (torque, told, beyond) in [(50.0, false, false), (2500.0, true, false), (10_000.0, true, true)] {
        let written = format!("[10 N m, {torque} N m, 5 N m]");
        let stiff = Case { material, method: FINITE_ELEMENT, contact: "resolved", torque: "50 N m", ..PLAIN }.text();
        let ran =
            walk(&load(&stiff.replace("designs: none, torque: 50 N m", &format!("designs: none, torque: {written}"))));
        let found: Vec<_> = ran["te"]
            .warnings
            .iter()
            .filter(|warning| warning.contains("law of contact") || warning.contains("the flanks touch"))
            .collect();
        assert_eq!(found.len(), usize::from(told), "{torque}: {:?}", ran["te"].warnings);
        if let [warning] = found[..] {
            let (_, text) = warning.split_once("the flanks touch ").unwrap();
            assert_eq!(text.contains("but are half planes up to 0.750000 mm only"), beyond, "{text}");
            let half: f64 = text.split(' ').next().unwrap().parse().unwrap();
            assert!(half < 1.05 * half_width(torque) && half > 0.95 * half_width(torque), "{half} {torque}");
            assert!(
                warning.contains(&format!("design `none` at {torque} N m")) && text.contains("of the peak-to-peak")
            );
            let (_, share) = text.split_once("um, ").unwrap();
            let percent: f64 = share.split(' ').next().unwrap().parse().unwrap();
            assert!(percent > 0.1 + before && percent < 20.0, "{text}");
            before = percent;
        }
    }
}

/// Tier: invariant; a search says of the design that it found what the transmission error of that design says, and no more
/// often.
#[test]
fn a_search_says_what_its_best_design_is_in_doubt_about() {
    let material = "youngs_modulus: 206 GPa, poisson_ratio: 0.3";
    for (torque, told) in [("20 N m", false), ("4000 N m", true)] {
        let text = Case { material, method: FINITE_ELEMENT, contact: "resolved", torque, ..PLAIN }.text();
        let search = format!(
            "  best: {{ kind: optimizer, stiffness: k, method: {{ grid: {{ levels: 2 }} }}, minimize: peak_to_peak, at: {{ torque: [10 N m, {torque}] }}, positions: 8, design: [tip_relief: {{ gear: both, amount: [1 um, 2 um], length: 3 mm }}] }}\n  best_te: {{ kind: ste, stiffness: k, designs: best, torque: {torque}, positions: 8 }}\n"
        );
        let ran = walk(&load(&format!("{text}{search}")));
        let of = |stage: &str| {
            let all = ran[stage].warnings.iter().filter(|warning| warning.contains("may be off by"));
            all.cloned().collect::<Vec<_>>()
        };
        assert_eq!(of("best").len(), usize::from(told), "{torque}: {:?}", ran["best"].warnings);
        assert_eq!(of("best"), of("best_te"), "{torque}");
    }
}

/// Tier: closed form; on a bore that all but vanishes the gear turns as a ring, r_b²/(4πGb)(1/r_bore² − 1/r_f²), by every
/// method that has a body. At the root circle there is no body left.
#[test]
fn bores_vanish_and_reach_the_root() {
    let (base, root, width, shear) = (36.0 * libm::cos(20f64.to_radians()), 32.25, 20e-3, 206e9 / 2.6);
    let wound = |bore: f64| base * base / (4.0 * PI * shear * width) * (1.0 / (bore * bore) - 1.0 / (root * root));
    for method in &METHODS[..3] {
        let with = |bore: &str| Case { bore, method, ..PLAIN }.numbers()[0];
        // All that the two bores differ in is the wind-up.
        let [small, smaller] = [with("0.3 mm"), with("0.0325 mm")];
        near(1.0 / smaller - 1.0 / small, wound(0.0325) - wound(0.3), 2e-3, method);
        near(1.0 / smaller, wound(0.0325), 3e-3, method);
    }
    let iso = |bore: &str| Case { bore, method: "iso6336", ..PLAIN }.numbers()[0];
    near(iso("0.0325 mm"), iso("32.24 mm"), 1e-15, "the standard knows no bore");
    let failed = |bore: &str| Case { bore, method: "energy", ..PLAIN }.failure();
    for bore in ["0.0325 mm", "1.6 mm", "32.24 mm"] {
        let message = failed(bore);
        assert!(message.contains("must be 1.2 to 20 times it") && message.contains("the body `ring`"), "{message}");
    }
    // A body of 10 µm is as good as none. Weber and Banaschek's is a half plane whatever the bore, and says so.
    for method in &METHODS[..3] {
        let with = |bore: &str| Case { bore, method, ..PLAIN }.numbers()[0];
        near(with("32.2499 mm"), with("32.24 mm"), 2e-3, method);
        let half_plane = *method == "weber_banaschek";
        assert_eq!(with("32.24 mm") > 1.2 * with("20 mm"), !half_plane, "{method}");
        let ran = Case { bore: "32.24 mm", method, ..PLAIN }.ran();
        assert_eq!(ran["k"].warnings.iter().any(|warning| warning.contains("taken for a half plane")), half_plane);
    }
    for bore in ["32.25 mm", "40 mm", "0.032 mm", "0 mm"] {
        let text = Case { bore, ..PLAIN }.text();
        let error = refused(&text);
        assert!(error.contains("must be at least 0.03225 mm and below the root radius 32.25 mm"), "{error}");
    }
}

/// Tier: closed form; G = E/2(1 + ν) softens shear and wind-up, and linear contact goes with 1 − ν². Elements in plane strain
/// lock, and say so.
#[test]
fn an_incompressible_material_is_right_or_refused() {
    let with =
        |method: &str, ratio: f64| Case { material: &format!("poisson_ratio: {ratio}"), method, ..PLAIN }.numbers()[0];
    for method in [RING, "weber_banaschek", "{ finite_element: { elements_across: 6, plane: stress } }"] {
        let [compressible, incompressible] = [0.0, 0.4999].map(|ratio| with(method, ratio));
        let ratio = compressible / incompressible;
        assert!((0.75..1.35).contains(&ratio), "{method}: {ratio}");
    }
    near(with("iso6336", 0.4999), with("iso6336", 0.3), 1e-15, "the standard knows no Poisson's ratio");
    let failed = Case { material: "poisson_ratio: 0.4999", method: FINITE_ELEMENT, ..PLAIN }.failure();
    assert!(failed.contains("must be 0 to 0.49 in plane strain") && failed.contains("`plane: stress`"), "{failed}");
}

/// The rows of a table, as `gearstudy table … --format json` prints them.
fn rows(desk: &Desk, table: &str) -> Vec<Value> {
    let (json, _) = desk.run(&["table", "chain.yaml", table, "--format", "json"], 0);
    serde_json::from_str::<Value>(&json).unwrap().as_array().unwrap().clone()
}

/// Few and many teeth, from the geometry to the report: finite elements, coupled, load-dependent contact, corner contact.
#[test]
fn few_and_many_teeth_go_through_the_whole_chain() {
    let cases = [
        (
            "20 deg",
            0.38,
            "teeth: 6, profile_shift: 0.5, tip_radius: 13 mm, face_width: 20 mm, bore_radius: 3 mm",
            "teeth: 30, tip_radius: 47.4 mm, face_width: 20 mm, bore_radius: 25 mm",
            13.0,
            6.0,
        ),
        (
            "25 deg",
            0.3,
            "teeth: 5, profile_shift: 0.5, tip_radius: 11.5 mm, face_width: 20 mm, bore_radius: 3 mm",
            "teeth: 60, tip_radius: 92.6 mm, face_width: 20 mm, bore_radius: 60 mm",
            11.5,
            5.0,
        ),
        (
            "20 deg",
            0.38,
            "teeth: 17, profile_shift: 0.2, face_width: 20 mm, bore_radius: 14 mm",
            "teeth: 1000, face_width: 20 mm, bore_radius: 1000 mm",
            29.1,
            17.0,
        ),
    ];
    for (angle, round, pinion, gear, tip, teeth) in cases {
        let desk = Desk::with("quick.yaml");
        let text = format!(
            "
study: chain
stages:
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: {angle}
    rack: {{ tip_radius: {round} }}
    pinion: {{ {pinion} }}
    gear: {{ {gear} }}
  k: &k {{ kind: stiffness, pair: pair, method: {FINITE_ELEMENT}, contact: load_dependent, torque: 20 N m }}
  finer: {{ <<: *k, method: {{ finite_element: {{ elements_across: 10 }} }} }}
  designs:
    kind: modification
    pair: pair
    designs: {{ none: [], relieved: [tip_relief: {{ gear: both, amount: 3 um, length: 1 mm }}] }}
  te: &te {{ kind: ste, stiffness: k, designs: designs, torque: 20 N m, positions: 24, corner_contact: exact }}
  path: {{ <<: *te, corner_contact: none }}
  report:
    kind: report
    published:
      - {{ cell: \"pair.gears[gear=pinion].tip_radius\", value: {tip} mm }}
      - label: Relief lets the gears approach further
        claim: \"none < relieved\"
        with: {{ none: \"path.summary[design=none].mean\", relieved: \"path.summary[design=relieved].mean\" }}
      - label: Corners share the load
        claim: \"corners <= path && corners > 0.8 * path\"
        with: {{ corners: \"te.summary[design=none].mean\", path: \"path.summary[design=none].mean\" }}
"
        );
        fs::write(desk.path("chain.yaml"), text).unwrap();
        desk.run(&["run", "chain.yaml"], 0);
        assert!(desk.statuses("chain").iter().all(|(_, status)| status == "ran"), "{:?}", desk.statuses("chain"));
        let page = fs::read_to_string(desk.path("results/chain/report.html")).unwrap();
        assert!(page.contains("Corners share the load"));
        let verdicts: Vec<_> = rows(&desk, "report.verdicts").iter().map(|row| row["verdict"].to_string()).collect();
        assert_eq!(verdicts, ["\"reproduced\"", "\"holds\"", "\"holds\""], "z {teeth}");

        let number = |row: &Value, column: &str| row[column].as_f64().unwrap();
        let [coarse, fine] = ["k.summary", "finer.summary"].map(|table| rows(&desk, table)[0].clone());
        for column in ["single_min", "single_max", "mean"] {
            near(number(&coarse, column), number(&fine, column), 0.01, column);
        }
        // Where flanks touch from A to E only, the error is the force over the stiffness.
        let radius = number(
            &rows(&desk, "pair.gears").iter().find(|row| row["gear"] == "pinion").unwrap().clone(),
            "base_radius",
        );
        let force = 20.0 / (radius * 1e-3);
        let path = rows(&desk, "path.summary");
        near(number(&path[0], "maximum") * 1e-6, force / number(&coarse, "single_min"), 1e-6, "largest");
        near(number(&path[0], "minimum") * 1e-6, force / number(&coarse, "double_max"), 1e-6, "smallest");
        // Loads balance at every position: the stiffness times the approach under load is the force.
        let curve = rows(&desk, "te.curve");
        assert!(curve.len() > 40);
        for row in &curve {
            let approach = number(row, "transmission_error") - number(row, "unloaded_transmission_error");
            near(number(row, "secant_stiffness") * approach * 1e-6, force, 1e-9, "the load");
            assert!((0.0..=1.0).contains(&number(row, "newest_load_share")));
        }
    }
}

/// A relief larger than the tooth fails its stage, and nothing behind it runs.
#[test]
fn a_relief_larger_than_the_tooth_is_refused() {
    let desk = Desk::with("quick.yaml");
    for (relief, says) in [
        ("tip_relief: { gear: pinion, amount: 4 mm, length: 3 mm }", "would lose 4.000000 mm"),
        ("root_relief: { gear: gear, amount: 4.9 mm, length: 3 mm }", "would lose 4.900000 mm"),
        ("lead_crowning: { gear: both, amount: 3 mm }", "would lose 3.000000 mm"),
        ("arc: { gear: pinion, tip_amount: 4 mm, length_share: 0.3 }", "half of the tip leaves 0 to"),
    ] {
        let text = PLAIN.text().replace("study: t", "study: chain").replace("none: []", &format!("none: [{relief}]"));
        fs::write(desk.path("chain.yaml"), text).unwrap();
        let (out, error) = desk.run(&["run", "chain.yaml"], 3);
        let said = out + &error;
        assert!(said.contains("design `none`") && said.contains(says), "{said}");
        let statuses = desk.statuses("chain");
        assert!(statuses.contains(&("te".to_owned(), "skipped".to_owned())), "{statuses:?}");
    }
}
