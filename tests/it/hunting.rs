//! Gears whose teeth deviate as a stage.

use std::f64::consts::TAU;
use std::fs;
use std::ops::RangeInclusive;

use studygraph::stage::{Ahead, Demand, RowCount};
use studygraph::table::data::Table;

use crate::desk::Desk;
use crate::registry::walk::{load, walk};

const TEETH: [u32; 2] = [19, 48];

fn study(of: &str, deviations: &[f64], list: &str) -> String {
    let list_of: Vec<String> = deviations.iter().map(|deviation| format!("{deviation} um")).collect();
    with(&format!("{of}: {{ {list}: [{}] }}", list_of.join(", ")))
}

/// A study of which `hunting` has these fields too.
fn with(fields: &str) -> String {
    format!(
        "study: t\nseed: 1\nstages:
  geometry:
    kind: geometry
    module: 3 mm
    pinion: {{ teeth: {}, face_width: 20 mm, bore_radius: 14 mm }}
    gear: {{ teeth: {}, face_width: 20 mm, bore_radius: 38 mm }}
  designs: {{ kind: modification, pair: geometry, designs: {{ plain: [] }} }}
  stiffness: {{ kind: stiffness, pair: geometry, method: energy }}
  hunting: {{ kind: hunting, stiffness: stiffness, designs: designs, torque: 500 N m, {fields} }}
",
        TEETH[0], TEETH[1]
    )
}

fn ran(text: &str, name: &str) -> Table {
    let ran = walk(&load(text));
    ran["hunting"].tables.iter().find(|table| table.name() == name).unwrap().clone()
}

/// Tier: closed form; a gear that runs out is off by A sin(2π i/z), and pairs of teeth that all carry load add up linearly: the error
/// has the order 1 of that gear, nearly A cos α, beside every multiple of the mesh frequency, and nothing else.
#[test]
fn an_eccentric_pinion_is_heard_once_a_turn() {
    for (index, of) in ["pinion", "gear"].into_iter().enumerate() {
        let amplitude = 5.0;
        let teeth = TEETH[index];
        let deviation = |tooth: u32| amplitude * (TAU * f64::from(tooth) / f64::from(teeth)).sin();
        let deviations: Vec<f64> = (0..teeth).map(deviation).collect();
        let table = ran(&study(of, &deviations, "cumulative"), "spectrum");
        let (orders, found) = (table.floats(&format!("{of}_order")), table.floats("amplitude"));
        let expected = amplitude * 20.0_f64.to_radians().cos();
        let mut beside = 0;
        for (order, found) in orders.iter().zip(found) {
            let whole = (order - order.round()).abs() < 1e-9;
            let from_mesh = order.round().rem_euclid(f64::from(teeth));
            if whole && from_mesh.min(f64::from(teeth) - from_mesh) <= 1.0 {
                beside += 1;
            } else {
                assert!(*found < 1e-9, "{of}, order {order}: {found} um");
            }
            if (order - 1.0).abs() < 1e-9 {
                assert!(*found > 0.95 * expected && *found < expected, "{of}: {found} of {expected}");
            }
        }
        // 1, and around both multiples of the mesh frequency: of the last not what is above it.
        assert_eq!(beside, 6, "{of}");
    }
}

/// Tier: arithmetic; total and single deviations of what was given, whichever way it was given.
#[test]
fn pitch_deviations_come_back() {
    let single: Vec<f64> = (0..TEETH[0]).map(|tooth| f64::from(tooth * tooth % 7) - 3.0).collect();
    let mean = single.iter().sum::<f64>() / f64::from(TEETH[0]);
    let mut sum = 0.0;
    let cumulative: Vec<f64> = single
        .iter()
        .map(|deviation| {
            sum += deviation - mean;
            sum
        })
        .collect();
    let [low, high] = [f64::min, f64::max].map(|pick| cumulative.iter().copied().reduce(pick).unwrap());
    let largest = single.iter().map(|deviation| (deviation - mean).abs()).fold(0.0, f64::max);
    // They count from the first tooth, wherever their zero is stated.
    let from_first: Vec<f64> = cumulative.iter().map(|deviation| deviation - cumulative[0]).collect();
    let tables = [(&single, "single"), (&cumulative, "cumulative"), (&from_first, "cumulative")]
        .map(|(given, list)| ran(&study("pinion", given, list), "summary"));
    let means = tables.each_ref().map(|table| table.floats("mean")[0]);
    assert!(means.iter().all(|mean| (mean - means[2]).abs() < 1e-9), "{means:?}");
    let [one, other, _] = &tables;
    for table in &tables {
        for (column, exact) in [("pinion_cumulative_deviation", high - low), ("pinion_single_deviation", largest)] {
            let found = table.floats(column)[0];
            assert!((found - exact).abs() < 1e-9, "{column}: {found} for {exact}");
        }
        assert_eq!(table.integers("pitches")[0], 912);
        assert!(table.floats("gear_single_deviation")[0] < 1e-300);
    }
    let [one, other] = [one, other].map(|table| table.floats("peak_to_peak")[0]);
    assert!((one - other).abs() < 1e-9, "{one} {other}");
    let without = ran(&study("pinion", &vec![0.0; TEETH[0] as usize], "single"), "summary");
    let [with, alone] = ["peak_to_peak", "peak_to_peak_without_deviations"].map(|column| without.floats(column)[0]);
    assert!(with <= alone && with > 0.99 * alone, "{with} of {alone}");
}

/// A straight profile, from −3 um at the start of the pinion's active flank to 5 um at its tip.
fn straight() -> String {
    let points = (0..=20).map(|at| (2.01 + 14.57 * f64::from(at) / 20.0, -3.0 + 8.0 * f64::from(at) / 20.0));
    let lines: Vec<String> = points.map(|(place, deviation)| format!("{place:.4};{deviation:.4}")).collect();
    format!("# teeth: 19\n# module: 3 mm\nroll_lengths [mm]; deviations [um]\n{}\n", lines.join("\n"))
}

const TRACED: &str = "pinion: { flanks: [{ tooth: [5, 2], file: traces/straight.csv }, { tooth: 2, face_positions: [-8 mm, 8 mm], \
                      deviations: [0 um, 4 um] }] }, gear: { single: [1 um], flanks: [] }";

fn desk(fields: &str) -> Desk {
    let desk = Desk::with("quick.yaml");
    fs::create_dir(desk.path("traces")).unwrap();
    fs::write(desk.path("traces/straight.csv"), straight()).unwrap();
    fs::write(desk.path("hunting.yaml"), with(fields)).unwrap();
    desk
}

/// Tier: closed form; a straight trace is all slope, and so it is whoever is asked: the slope is that over the whole of the active flank.
#[test]
fn traces_of_teeth_are_evaluated() {
    let lists = "roll_lengths: [2.1 mm, 16.1 mm], deviations: [-3 um, 4 um]";
    let fields =
        TRACED.replace("file: traces/straight.csv", lists).replace(", gear: { single: [1 um], flanks: [] }", "");
    let text = with(&fields);
    let (flanks, summary) = (ran(&text, "flanks"), ran(&text, "summary"));
    assert_eq!(flanks.texts("trace"), ["helix", "profile", "profile"]);
    assert_eq!(
        (flanks.integers("tooth"), flanks.texts("gear")),
        (&[2, 2, 5][..], &["pinion", "pinion", "pinion"].map(String::from)[..])
    );
    // 4 um over 16 mm of a face of 20 mm; 7 um over 14 mm.
    let lengths = [16.583_582_258_9 - 2.009_266_843_7, 20.0];
    for (row, (rate, length)) in [(0.25, lengths[1]), (0.5, lengths[0]), (0.5, lengths[0])].into_iter().enumerate() {
        assert!((flanks.floats("slope")[row] - rate * length).abs() < 1e-6, "{row}: {}", flanks.floats("slope")[row]);
        assert!(flanks.floats("form")[row].abs() < 1e-9 && flanks.floats("crowning")[row].abs() < 1e-9);
        let total = rate * (flanks.floats("end")[row] - flanks.floats("start")[row]);
        assert!((flanks.floats("total")[row] - total).abs() < 1e-9);
    }
    assert_eq!((summary.integers("pinion_flanks"), summary.integers("gear_flanks")), (&[2][..], &[0][..]));
    let [with, without] = ["peak_to_peak", "peak_to_peak_without_deviations"].map(|column| summary.floats(column)[0]);
    assert!(with > without + 1.0, "{with} {without}");
}

/// One clear message each, with its place: in the study, or in the file.
#[test]
fn what_is_wrong_with_a_tooth_has_its_place() {
    let desk = desk("");
    let file = straight();
    for (fields, file, message) in [
        (
            TRACED.to_owned(),
            file.clone(),
            "hunting.yaml:11:241: the gear has 48 teeth, but 1 pitch deviations are stated",
        ),
        (
            TRACED.replace(
                "single: [1 um], flanks: []",
                "flanks: [{ tooth: 49, diameters: [139 mm, 150 mm], deviations: [1 um, 1 um] }]",
            ),
            file.clone(),
            "hunting.yaml:11:251: the gear has 48 teeth, and no tooth 49",
        ),
        (
            "pinion: { flanks: { tooth: 3, file: traces/straight.csv } }".to_owned(),
            file.replace("# teeth: 19", "# teeth: 48"),
            "straight.csv:1:10: a flank of the pinion: a gear of 48 teeth was measured, and this one has 19",
        ),
        (
            "pinion: { flanks: { tooth: 3, file: traces/straight.csv } }".to_owned(),
            file.replace("# module: 3 mm", "# module: 4 mm"),
            "straight.csv:2:11: a flank of the pinion: a gear of module 4",
        ),
        (
            "gear: { flanks: { file: traces/straight.csv } }".to_owned(),
            file.replace("# teeth: 19", "# tooth: 1"),
            "straight.csv:3:1: a flank of the gear: the trace goes from 2.01",
        ),
        (
            "pinion: { flanks: { file: traces/straight.csv } }".to_owned(),
            file.replace("# teeth: 19", "# tooth: [1, 20]"),
            "straight.csv:1:10: the pinion has 19 teeth, and no tooth 20",
        ),
        (
            "pinion: { flanks: { file: traces/straight.csv } }".to_owned(),
            file.clone(),
            "hunting.yaml:11:96: `flanks` has no `tooth`",
        ),
    ] {
        fs::write(desk.path("hunting.yaml"), with(&fields)).unwrap();
        fs::write(desk.path("traces/straight.csv"), file).unwrap();
        let said = desk.run(&["check", "hunting.yaml"], 2).1;
        assert!(said.contains(message), "{message}\n{said}");
    }
}

/// Tier: invariant, to the last bit.
#[test]
fn any_number_of_threads_gives_the_same_curve() {
    let fields = TRACED.replace(", gear: { single: [1 um], flanks: [] }", "");
    let curves = ["1", "2"].map(|threads| {
        let desk = desk(&fields);
        desk.run(&["run", "hunting.yaml", "--want", "hunting.curve", "--quiet", "--jobs", threads], 0);
        desk.contents("t").into_iter().find(|(name, _)| name == "hunting.curve").unwrap().1
    });
    assert_eq!(curves[0], curves[1]);
}

/// Invariant: traces over all of the flank take a time for each slice and each tooth that has one, those across the face less, and
/// those along the profile the same whatever the slices are.
#[test]
fn slices_are_foreseen_where_traces_go_across_the_face() {
    let seconds = |places: &str, points: usize, teeth: RangeInclusive<usize>, slices: usize| {
        let (single, numbers) = (vec!["1 um"; TEETH[0] as usize].join(", "), vec!["1 um"; points].join(", "));
        let teeth = teeth.map(|tooth| tooth.to_string()).collect::<Vec<_>>().join(", ");
        let flank = format!("{{ tooth: [{teeth}], {places}, deviations: [{numbers}] }}");
        let text = with(&format!("slices: {slices}, pinion: {{ single: [{single}], flanks: [{flank}] }}"));
        let study = load(&text);
        let node = study.nodes.iter().find(|node| node.name == "hunting").unwrap();
        let mut ahead = Ahead::default();
        ahead.know("designs", "designs", RowCount::exact(1));
        node.stage.estimate(&Demand::default(), &ahead).seconds
    };
    let (along, across) = ("roll_lengths: [4 mm, 10 mm, 17 mm]", "face_positions: [-9 mm, 0 mm, 9 mm]");
    let both = format!("{along}, {across}");
    let profile = seconds(along, 3, 1..=19, 17);
    assert!(profile > 0.0 && profile.to_bits() == seconds(along, 3, 1..=19, 33).to_bits());
    // Measured: 49 times as long as with traces along the profile with 17 slices, 15 with 5, and 7 with lines across the face under the
    // contact that depends on the load.
    let times =
        |places: &str, points: usize, teeth: usize, slices: usize| seconds(places, points, 1..=teeth, slices) / profile;
    let found = [times(&both, 9, 19, 17), times(&both, 9, 19, 5), times(across, 3, 19, 17)];
    let measured = [49.0, 15.0, 7.0];
    assert!(found.into_iter().zip(measured).all(|(found, of)| (0.8..1.25).contains(&(found / of))), "{found:?}");
    let [one, all] = [1, 19].map(|teeth| times(&both, 9, teeth, 17) - 1.0);
    assert!((all / one - 19.0).abs() < 1e-9, "{one} {all}");
}
