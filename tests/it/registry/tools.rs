//! Every kind of tool from end to end: the pair that stages read back has its roots, in outlines, stiffness, rating and curves.

use std::collections::BTreeMap;

use super::walk::{Ran, load, walk};
use gearstudy::stage::pair;
use studygraph::table::data::Table;

/// What is said of the tool of both gears, and by how much the mean transmission error under load is larger than with the plain rack.
const TOOLS: &[(&str, &str, std::ops::Range<f64>)] = &[
    ("plain", "rack: { dedendum: 1.4, tip_radius: 0.3 }", 0.999_999..1.000_001),
    (
        "protuberance",
        "rack: { dedendum: 1.4, tip_radius: 0.3, protuberance: 0.05, machining_allowance: 0.03 }",
        1.001..1.1,
    ),
    (
        "allowance covered",
        "rack: { dedendum: 1.4, tip_radius: 0.3, protuberance: 0.05, machining_allowance: 0.05 }",
        0.999_999..1.000_001,
    ),
    ("notch", "rack: { dedendum: 1.4, tip_radius: 0.3, machining_allowance: 0.05, notch_radius: 0.15 }", 0.97..0.99),
    ("cutter", "pinion_cutter: { teeth: 23, profile_shift: 0.1, addendum: 1.4, tip_radius: 0.15 }", 0.97..0.99),
    // The rack cuts the other gears of the pair; of it a shaped gear has nothing.
    (
        "cutter beside a rack with protuberance",
        "rack: { protuberance: 0.05, machining_allowance: 0.02 }, \
         pinion_cutter: { teeth: 23, profile_shift: 0.1, addendum: 1.4, tip_radius: 0.15 }",
        0.97..0.99,
    ),
];

const METHODS: [&str; 4] = ["energy", "weber_banaschek", "iso6336", "{ finite_element: { elements_across: 8 } }"];

fn study(tool: &str) -> String {
    let gear = |name: &str, teeth: u32| {
        format!("    {name}: {{ teeth: {teeth}, face_width: 9 mm, bore_radius: 10 mm, profile_shift: 0.1, {tool} }}\n")
    };
    let mut text = format!(
        "study: t\nseed: 1\nstages:\n  pair:\n    kind: geometry\n    module: 2 mm\n{}{}    outline: {{ points: 40 }}\n",
        gear("pinion", 24),
        gear("gear", 31)
    );
    for (index, method) in METHODS.iter().enumerate() {
        let torque = if method.contains("finite_element") { ", torque: 50 N m" } else { "" };
        text += &format!("  k{index}: {{ kind: stiffness, pair: pair, method: {method}{torque} }}\n");
    }
    text += "  designs: { kind: modification, pair: pair, designs: { plain: [] } }\n";
    text + "  ste: { kind: ste, stiffness: k0, designs: [designs], torque: 50 N m }\n"
}

fn table<'a>(ran: &'a BTreeMap<String, Ran>, stage: &str, name: &str) -> &'a Table {
    ran[stage].tables.iter().find(|table| table.name() == name).unwrap()
}

/// Tier: round trip, second way; the tables say the tool in full, and the static transmission error follows what it takes off.
#[test]
fn every_tool_goes_from_end_to_end() {
    let mut plain = None;
    for (name, tool, range) in TOOLS {
        let ran = walk(&load(&study(tool)));
        let (gears, inspection) = (table(&ran, "pair", "gears"), table(&ran, "pair", "inspection"));
        let read = pair::read(gears, table(&ran, "pair", "pair")).unwrap();
        for (row, which) in gears.texts("gear").iter().enumerate() {
            let gear = if which == "pinion" { &read.pinion } else { &read.gear };
            let near = |column: &str, exact: f64| {
                let shown = gears.floats(column)[row];
                assert!((shown / (1e3 * exact) - 1.0).abs() < 1e-13, "{name}: {column} {shown}");
            };
            near("form_radius", gear.form_radius);
            near("root_radius", gear.root_radius);
            let depth = inspection.floats("notch_depth")[row];
            let undercut = inspection.floats("residual_undercut")[row];
            assert!((depth - if *name == "notch" { 0.1 } else { 0.0 }).abs() < 1e-12, "{name}: {depth}");
            assert!((undercut - if *name == "protuberance" { 0.04 } else { 0.0 }).abs() < 1e-12, "{name}: {undercut}");
        }
        let junctions = table(&ran, "pair", "junctions");
        assert!(junctions.floats("position_jump").iter().all(|jump| *jump < 1e-9), "{name}");
        assert!(
            table(&ran, "pair", "validity").floats("root_distance").iter().all(|distance| *distance > 0.0),
            "{name}"
        );
        let mean = table(&ran, "ste", "summary").floats("mean")[0];
        let of_plain = *plain.get_or_insert(mean);
        assert!(range.contains(&(mean / of_plain)), "{name}: {}", mean / of_plain);
    }
}

/// Tier: invariant; `stability` takes every tool: all that it checks holds or is refused, and digits are told of the plain racks alone.
#[test]
fn every_tool_is_stable() {
    for (name, tool, _) in TOOLS {
        let text = study(tool);
        let pair = text.split("  k0:").next().unwrap();
        let checks = "  stable: { kind: stability, pair: pair, relief: 8 um, relief_length: 3 mm, traps: false, axes: { torque: [1e-6 N m, 50 N m], pinion_teeth: [20, 60] } }\n";
        let ran = walk(&load(&format!("{pair}{checks}")));
        let checks = table(&ran, "stable", "checks");
        let verdicts = checks.texts("verdict");
        let broken: Vec<_> = (0..checks.rows()).filter(|row| verdicts[*row] == "broken").collect();
        let said: Vec<_> =
            broken.iter().map(|row| (&checks.texts("case")[*row], &checks.texts("invariant")[*row])).collect();
        assert!(broken.is_empty() && checks.rows() > 30, "{name}: {said:?}");
        let is_known = ["plain", "allowance covered"].contains(name);
        assert_eq!(table(&ran, "stable", "digits").rows() > 0, is_known, "{name}");
    }
}
