//! How a plan is shown: what runs and why, what is left out, what it will take.
//!
//! Must not know: how any of it is decided.

use serde_json::json;

use super::format::{duration, rough};
use crate::stage::{Omission, RowCount, omission};
use studygraph::runner::foresee::Expected;
use studygraph::runner::plan::{Action, Plan};
use studygraph::runner::refuse::{grouped, size};
use studygraph::study::Study;

pub(super) fn plan_text(study: &Study, plan: &Plan) -> String {
    let width = plan.stages.iter().map(|stage| stage.name.chars().count()).max().unwrap_or(0);
    let mut text = format!("{}: {}\n", study.name, study.title);
    for stage in &plan.stages {
        let mut action = stage.action.phrase();
        if stage.chunks > 1 && matches!(stage.action, Action::Run(_)) {
            action += &format!(" ({} of {} chunks)", stage.missing, stage.chunks);
        }
        if let Some(seconds) = stage.again {
            action += &format!("; all of it is computed again, which took {} last time", duration(seconds));
        }
        text += format!("  {:width$}  {action}", stage.name).trim_end();
        text += "\n";
        for omission in omission::together(&stage.left_out) {
            let saved = omission
                .seconds(&stage.work, stage.seconds)
                .map_or_else(String::new, |seconds| format!("; saves about {}", duration(seconds)));
            text += &format!("  {:width$}    left out: {}: {}{saved}\n", "", omission.what, omission.why);
        }
    }
    text += &taken(plan, width);
    if let Some(refused) = &plan.refused {
        text += &format!("  `run` refuses it: {}\n", refused.message);
        text += &refused.help.as_ref().map_or_else(String::new, |help| format!("    help: {help}\n"));
    }
    text
}

/// What is to be computed, with what it takes, one line per stage and one for all.
fn taken(plan: &Plan, width: usize) -> String {
    let mut lines = vec![("takes".to_owned(), ["rows", "on disk", "memory", "time"].map(str::to_owned))];
    let line = |expected: &Expected| {
        let rows = rows(expected);
        [
            format!("{}{}", rows.certainty.sign(), grouped(rows.count)),
            format!("≤ {}", size(expected.bytes)),
            format!("≤ {}", size(expected.memory)),
            format!("~ {}", rough(expected.seconds)),
        ]
    };
    let running = || plan.stages.iter().filter_map(|stage| Some((&stage.name, stage.expected.as_ref()?)));
    let count = running().count();
    let shown = |expected: &Expected| count <= FEW || matters(expected, &plan.total);
    lines.extend(
        running().filter(|(_, expected)| shown(expected)).map(|(name, expected)| (name.clone(), line(expected))),
    );
    match count {
        0 => return String::new(),
        // More memory than the stage: the program itself, and what publishing takes.
        1 => lines.push(("the run".to_owned(), line(&plan.total))),
        _ => lines.push((format!("all {count}"), line(&plan.total))),
    }
    let widest = |column: usize| lines.iter().map(|(_, cells)| cells[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; 4] = std::array::from_fn(widest);
    let width = lines.iter().map(|(name, _)| name.chars().count()).fold(width, usize::max);
    let mut text = String::new();
    for (name, cells) in &lines {
        text += &format!("  {name:width$}");
        for (cell, width) in cells.iter().zip(widths) {
            text += &format!("  {cell:>width$}");
        }
        text += "\n";
    }
    text
}

/// So many stages are all shown.
const FEW: usize = 5;

/// Whether it takes a tenth of anything.
fn matters(expected: &Expected, total: &Expected) -> bool {
    rows(expected).count.saturating_mul(10) >= rows(total).count
        || expected.memory >= total.memory / 10
        || expected.bytes >= total.bytes / 10
        || 10.0 * expected.seconds >= total.seconds
}

/// Of all tables.
fn rows(expected: &Expected) -> RowCount {
    expected.tables.iter().fold(RowCount::NONE, |sum, (_, rows)| sum.and(*rows))
}

pub(super) fn plan_json(study: &Study, plan: &Plan) -> serde_json::Value {
    let stages: Vec<_> = plan
        .stages
        .iter()
        .map(|stage| {
            let omission = |omission: &Omission| {
                let saved = omission.seconds(&stage.work, stage.seconds);
                json!({ "what": *omission.what, "why": *omission.why, "saved_seconds": saved })
            };
            let left_out: Vec<_> = stage.left_out.iter().map(omission).collect();
            json!({
                "name": stage.name, "kind": stage.kind, "action": stage.action.phrase(),
                "again_seconds": stage.again, "chunks": stage.chunks, "missing_chunks": stage.missing, "work": stage.work.named(),
                "left_out": left_out, "expected": stage.expected.as_ref().map(expected_json),
            })
        })
        .collect();
    let refused = plan.refused.as_ref().map(|refused| json!({ "message": refused.message, "help": refused.help }));
    json!({
        "study": study.name, "file": study.path.to_string_lossy(), "up_to_date": plan.is_up_to_date(), "stages": stages,
        "expected": expected_json(&plan.total), "refused": refused,
    })
}

fn expected_json(expected: &Expected) -> serde_json::Value {
    let shown = |rows: RowCount| json!({ "count": rows.count, "certainty": rows.certainty.name() });
    let tables: serde_json::Map<_, _> = expected
        .tables
        .iter()
        .filter(|(name, _)| !name.is_empty())
        .map(|(name, rows)| (name.clone(), shown(*rows)))
        .collect();
    json!({
        "rows": shown(rows(expected)), "tables": tables, "bytes": expected.bytes, "memory_bytes": expected.memory,
        "seconds": expected.seconds,
    })
}
