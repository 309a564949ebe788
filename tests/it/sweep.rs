//! `kind: sweep` against the stages it stands for, and what holds for rows, parts and summaries.

mod bits;
#[cfg(target_os = "linux")]
mod kills;
mod messages;
mod parts;
mod readers;
mod summaries;

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
      other: [profile_crowning: { gear: both, amount: 3 um }]
      long:
        - lead_crowning: { gear: pinion, amount: 6 um }
        - tip_relief: { gear: both, amount: 8 um, length: 5 mm, curve: parabolic }
";
const STE: &str =
    "  ste: { kind: ste, stiffness: stiffness, designs: designs, torque: 50 N m, harmonics: 3, positions: 16 }\n";

/// A study of these stages.
fn study(stages: &[&str]) -> String {
    format!("study: t\nseed: 3\nstages:{}", stages.concat())
}

/// The same with a sweep of `ste` that has these fields.
fn swept(fields: &str) -> String {
    let fields = format!("    {}\n", fields.trim().replace('\n', "\n    "));
    study(&[PAIR, STIFFNESS, DESIGN, STE, "  sweep:\n    kind: sweep\n    of: ste\n", &fields])
}

fn table(text: &str, stage: &str, name: &str) -> Table {
    let ran = walk(&load(text));
    ran[stage].tables.iter().find(|table| table.name() == name).unwrap().clone()
}

/// The rows of the sweep of a study.
fn rows(text: &str) -> Table {
    table(text, "sweep", "rows")
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}
