//! `kind: scatter` against the stages it stands for, closed forms, and what holds for samples and what is made of them.

mod cases;
mod messages;
mod parts;
mod rows;
mod statistics;

use crate::registry::walk::{load, walk};
use studygraph::table::data::Table;

const PAIR: &str = "
  pair:
    kind: geometry
    module: 3 mm
    pinion: { teeth: 19, face_width: 20 mm, bore_radius: 14.079 mm }
    gear: { teeth: 48, face_width: 18 mm, bore_radius: 38.823 mm }
";
const STIFFNESS: &str = "  stiffness: { kind: stiffness, pair: pair, coupling: none }\n";
const DESIGN: &str = "
  designs:
    kind: modification
    pair: pair
    designs:
      long:
        - lead_crowning: { gear: pinion, amount: 6 um }
        - tip_relief: { gear: both, amount: 8 um, length: 5 mm, curve: parabolic }
        - profile_slope: { gear: pinion, amount: 0 um }
";
const STE: &str =
    "  ste: { kind: ste, stiffness: stiffness, designs: designs, torque: 50 N m, harmonics: 3, positions: 16 }\n";

const AMOUNT: &str = "amount: { field: \"designs.designs.long[1].tip_relief.amount\", within: ± 2 um }";
const TILT: &str = "tilt: { field: ste.helix_slope, normal: 5 um }";
const TORQUES: &str = "torque: { field: ste.torque, values: [25 N m, 50 N m, 100 N m] }";

/// A study of these stages.
fn study(stages: &[&str]) -> String {
    format!("study: t\nseed: 3\nstages:{}", stages.concat())
}

/// The same with a scatter of `ste` that varies these columns and has these fields.
fn scattered(vary: &[&str], fields: &str) -> String {
    let vary = vary.iter().fold(String::new(), |text, column| text + "      " + column + "\n");
    let fields = format!("    {}\n", fields.trim().replace('\n', "\n    "));
    let scatter = format!("  scatter:\n    kind: scatter\n    of: ste\n    vary:\n{vary}");
    study(&[PAIR, STIFFNESS, DESIGN, STE, &scatter, &fields])
}

/// The tables of the scatter of a study, and what it warned of.
fn ran(text: &str) -> (impl Fn(&str) -> Table, Vec<String>) {
    let mut ran = walk(&load(text));
    let scatter = ran.remove("scatter").unwrap();
    let tables = scatter.tables;
    let of = move |name: &str| tables.iter().find(|table| table.name() == name).unwrap().clone();
    (of, scatter.warnings)
}
