//! What a comparison found, in phrases that every format shares.
//!
//! Must not know: terminals, HTML, Markdown.

use super::model::{
    ChangedPart, ColumnDiff, Comparison, CurveColumn, Damage, Difference, Extreme, Flip, Key, Reason, StageDiff,
    StudyDiff, TableDiff, Value,
};
use declare::number::{significant, unit_symbol, with_unit};

/// Significant digits of differences.
const FEW: usize = 3;
/// Significant digits of values; more where two would look alike.
const DIGITS: usize = 6;

/// `1 row`, `2 rows`.
pub fn count(number: usize, what: &str) -> String {
    let plural = match what.strip_suffix('y') {
        Some(stem) => format!("{stem}ies"),
        None => format!("{what}s"),
    };
    format!("{number} {}", if number == 1 { what } else { &plural })
}

/// Two values with as many digits as it takes to tell them apart.
pub fn pair(before: &Value, after: &Value) -> (String, String) {
    if let (Value::Float(a), Value::Float(b)) = (before, after) {
        for digits in DIGITS..=17 {
            let shown = (significant(*a, digits), significant(*b, digits));
            if shown.0 != shown.1 {
                return shown;
            }
        }
    }
    (value(before), value(after))
}

pub fn value(value: &Value) -> String {
    match value {
        Value::Float(number) => significant(*number, DIGITS),
        Value::Integer(number) => number.to_string(),
        Value::Text(text) if text.is_empty() => "\"\"".to_owned(),
        Value::Text(text) => text.clone(),
        Value::Flag(flag) => flag.to_string(),
    }
}

/// `design=iso, torque=50 N m`.
pub fn key(key: &Key) -> String {
    let one = |(name, cell): &(String, Value)| match name.split_once(" [") {
        Some((name, unit)) => format!("{name}={}", with_unit(&value(cell), unit.trim_end_matches(']'))),
        None => format!("{name}={}", value(cell)),
    };
    key.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// `peak_to_peak [µm]`.
pub fn column(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} [{}]", unit_symbol(unit)) }
}

/// A difference with its sign.
pub fn difference(value: f64) -> String {
    let shown = significant(value, FEW);
    if value > 0.0 { format!("+{shown}") } else { shown }
}

/// A relative difference.
pub fn relative(value: f64) -> String {
    if value >= 1e-4 { with_unit(&significant(100.0 * value, FEW), "%") } else { significant(value, FEW) }
}

/// `2.1 → 2.3`.
pub fn change(extreme: &Extreme) -> String {
    let (before, after) = pair(&extreme.before, &extreme.after);
    format!("{before} → {after}")
}

/// `12 of 25, 3 beyond`; `12 of 25, all within`.
pub fn changed(column: &ColumnDiff) -> String {
    let beyond = match column.beyond {
        0 => "all within".to_owned(),
        all if all == column.changed => String::new(),
        some => format!("{some} beyond"),
    };
    let all = format!("{} of {}", column.changed, column.compared);
    if beyond.is_empty() { all } else { format!("{all}, {beyond}") }
}

/// `config pinion.face_width: 20 mm → 22 mm`. What the code was and is is said once for a study: [`program`].
fn reason(reason: &Reason) -> String {
    let what = if reason.from.is_empty() { reason.what.clone() } else { input(&reason.from) };
    let mut text = match reason.part {
        // A sentence of its own.
        ChangedPart::Unknown => what,
        part if what.is_empty() => part.word().to_owned(),
        part => format!("{} {what}", part.word()),
    };
    if reason.part == ChangedPart::Code {
        return text;
    }
    match (&reason.before, &reason.after) {
        (Some(before), Some(after)) => text += &format!(": {} → {}", short(before), short(after)),
        (Some(before), None) => text += &format!(": {} → gone", short(before)),
        (None, Some(after)) => text += &format!(": new: {}", short(after)),
        (None, None) => {}
    }
    text
}

/// `optimum (best, elements changed)`: the stage, and its tables that are others now; which of them are read is not known.
fn input(from: &[String]) -> String {
    let tables: Vec<&str> = from.iter().filter_map(|name| Some(name.split_once('.')?.1)).collect();
    let stage = from.first().map_or("", |name| name.split_once('.').map_or(name.as_str(), |(stage, _)| stage));
    if tables.is_empty() { stage.to_owned() } else { format!("{stage} ({} changed)", tables.join(", ")) }
}

/// All reasons of a stage: those without values in one phrase.
pub fn reasons(why: &[Reason]) -> Vec<String> {
    let tells = |why: &&Reason| why.part != ChangedPart::Code && (why.before.is_some() || why.after.is_some());
    let (told, bare): (Vec<&Reason>, Vec<&Reason>) = why.iter().partition(tells);
    let bare: Vec<String> = bare.into_iter().map(reason).collect();
    let bare = (!bare.is_empty()).then(|| bare.join(", "));
    told.into_iter().map(reason).chain(bare).collect()
}

/// `program: gearstudy 0.1.0 at 59b124e → gearstudy 0.1.0 at 0ccb5e2`, where the code of any stage changed with it.
pub fn program(study: &StudyDiff) -> Option<String> {
    let mut reasons = study.stages.iter().flat_map(|stage| &stage.why);
    let (before, after) = reasons.find_map(|why| {
        (why.part == ChangedPart::Code).then_some(Some((why.before.as_ref()?, why.after.as_ref()?)))?
    })?;
    Some(format!("program: {before} → {after}"))
}

/// What is said of a study as a whole.
pub fn remarks(study: &StudyDiff) -> Vec<String> {
    let renamed = study.renamed_from.as_ref().map(|name| format!("renamed from {name}"));
    renamed.into_iter().chain(study.remarks.iter().cloned()).chain(program(study)).collect()
}

/// Stages that are told one by one.
pub fn told(study: &StudyDiff) -> Vec<&StageDiff> {
    if matches!(study.state, Difference::Added | Difference::Removed) {
        return Vec::new();
    }
    let told = |stage: &&StageDiff| {
        stage.state != Difference::Same || stage.renamed_from.is_some() || (!stage.why.is_empty() && !is_brief(stage))
    };
    study.stages.iter().filter(told).collect()
}

/// Stages that were computed from something else and came out the same, all of a kind in one sentence: `code changed in
/// 14 stages, values the same`.
pub fn brief(study: &StudyDiff) -> Vec<String> {
    let mut groups: Vec<(String, Vec<&str>)> = Vec::new();
    for stage in study.stages.iter().filter(|stage| is_brief(stage)) {
        let mut parts: Vec<&str> = stage.why.iter().map(|why| why.part.word()).collect();
        parts.dedup();
        let parts = parts.join(" and ");
        match groups.iter_mut().find(|(of, _)| *of == parts) {
            Some((_, stages)) => stages.push(&stage.name),
            None => groups.push((parts, vec![&stage.name])),
        }
    }
    let sentence = |(parts, stages): (String, Vec<&str>)| match stages[..] {
        [one] => format!("{parts} changed in {one}, values the same"),
        _ => format!("{parts} changed in {}, values the same", count(stages.len(), "stage")),
    };
    groups.into_iter().map(sentence).collect()
}

/// A field that changed and did nothing is worth its own line; what came from outside the stage is not.
fn is_brief(stage: &StageDiff) -> bool {
    let outside = |why: &Reason| {
        matches!(why.part, ChangedPart::Code | ChangedPart::Input | ChangedPart::Seed | ChangedPart::Demand)
    };
    stage.state == Difference::Same
        && stage.renamed_from.is_none()
        && !stage.why.is_empty()
        && stage.why.iter().all(outside)
}

/// `changed`, `same, renamed from stiffness`.
pub fn state(stage: &StageDiff) -> String {
    let renamed = stage.renamed_from.as_ref().map(|name| format!(", renamed from {name}"));
    stage.state.word().to_owned() + &renamed.unwrap_or_default()
}

/// Long texts of a study, cut.
fn short(text: &str) -> String {
    const LONGEST: usize = 120;
    if text.chars().count() <= LONGEST {
        text.to_owned()
    } else {
        text.chars().take(LONGEST - 1).chain(['…']).collect()
    }
}

/// `reproduced → unexplained`.
pub fn flip(flip: &Flip) -> String {
    match (&flip.before, &flip.after) {
        (Some(before), Some(after)) => format!("{before} → {after}"),
        (None, Some(after)) => format!("new: {after}"),
        (Some(before), None) => format!("{before} → gone"),
        (None, None) => String::new(),
    }
}

/// What the entry is, and where the paper says it.
pub fn entry(flip: &Flip) -> String {
    let what = if flip.label.is_empty() { &flip.cell } else { &flip.label };
    if flip.location.is_empty() { what.clone() } else { format!("{what} ({})", flip.location) }
}

/// `published 2.316 µm, computed 2.31 → 2.41 µm`.
pub fn numbers(flip: &Flip) -> String {
    // A claim; one side alone where it is new or gone.
    let found: Vec<&str> = [&flip.found_before, &flip.found_after]
        .into_iter()
        .map(String::as_str)
        .filter(|found| !found.is_empty())
        .collect();
    if !found.is_empty() {
        return found.join(" → ");
    }
    let published = (!flip.published.is_empty()).then(|| format!("published {}", flip.published));
    let with = |text: &str| with_unit(text, &flip.unit);
    let computed = match (flip.computed_before, flip.computed_after) {
        (Some(a), Some(b)) if a.to_bits() == b.to_bits() => {
            Some(format!("computed {} as before", with(&significant(a, DIGITS))))
        }
        (Some(a), Some(b)) => {
            let (a, b) = pair(&Value::Float(a), &Value::Float(b));
            Some(format!("computed {a} → {}", with(&b)))
        }
        (None, Some(one)) | (Some(one), None) => Some(format!("computed {}", with(&significant(one, DIGITS)))),
        (None, None) => None,
    };
    published.into_iter().chain(computed).collect::<Vec<_>>().join(", ")
}

/// `results: quick/ste.summary.parquet holds other values than its manifest says`.
pub fn damage(damage: &Damage) -> String {
    format!("{}: {}/{} {}", damage.at, damage.study, damage.file, damage.problem)
}

/// Stands over files that are not what their manifest says.
pub fn damages(comparison: &Comparison) -> String {
    let files = &comparison.damaged;
    let (is, its, it) = if files.len() == 1 { ("is", "its", "it") } else { ("are", "their", "them") };
    let number = count(files.len(), "file");
    format!("{number} {is} not what {its} manifest says; `gearstudy run` writes {it} anew")
}

/// What a table's rows did: `25 rows`, `25 → 26 rows: 1 added`.
pub fn rows(table: &TableDiff) -> String {
    let TableDiff { rows_before, rows_after, rows_added, rows_removed, .. } = table;
    match table.state {
        Difference::Added => return count(*rows_after, "row"),
        Difference::Removed => return count(*rows_before, "row"),
        _ => {}
    }
    let mut text = if rows_before == rows_after {
        count(*rows_after, "row")
    } else {
        format!("{rows_before} → {}", count(*rows_after, "row"))
    };
    let moved = [(rows_added, "added"), (rows_removed, "removed")];
    let moved: Vec<String> =
        moved.iter().filter(|(number, _)| **number > 0).map(|(number, word)| format!("{number} {word}")).collect();
    if !moved.is_empty() {
        text += &format!(": {}", moved.join(", "));
    }
    text
}

/// `3 of 15 curves changed; largest vertical distance: transmission_error +0.012 µm (2.31 → 2.32) at cycle_position=3.2 mm,
/// design=short`.
pub fn curves(table: &TableDiff) -> Option<String> {
    let found = table.curves.as_ref()?;
    let beyond = match found.beyond {
        0 => ", all within tolerance".to_owned(),
        all if all == found.changed => String::new(),
        some => format!(", {some} beyond tolerance"),
    };
    let mut parts = vec![format!("{} of {} changed{beyond}", found.changed, count(found.compared, "curve"))];
    if let Some((column, largest)) = found.columns.first().and_then(|one| Some((one, one.largest.as_ref()?))) {
        let (before, after) = pair(&Value::Float(largest.before), &Value::Float(largest.after));
        let at = with_unit(&significant(largest.at, DIGITS), &found.along_unit);
        let key = if largest.key.is_empty() { String::new() } else { format!(", {}", key(&largest.key)) };
        parts.push(format!(
            "largest vertical distance: {} {} ({before} → {after}) at {}={at}{key}",
            column.name,
            with_unit(&difference(largest.difference), &column.unit),
            found.along
        ));
    }
    if let [_, others @ ..] = &found.columns[..]
        && !others.is_empty()
    {
        let apart = |column: &CurveColumn| {
            let by = column.largest.as_ref().map(|largest| with_unit(&difference(largest.difference), &column.unit));
            format!("{} {}", column.name, by.unwrap_or_default())
        };
        parts.push(format!("also {}", others.iter().map(apart).collect::<Vec<_>>().join(", ")));
    }
    for (number, what) in [(found.resampled, "sampled in other places"), (found.moved_ends, "with other ends")] {
        parts.extend((number > 0).then(|| format!("{number} {what}")));
    }
    for (keys, what) in [(&found.added, "added"), (&found.removed, "removed")] {
        parts.extend((!keys.is_empty()).then(|| format!("{what}: {}", self::keys(keys, keys.len()))));
    }
    Some(parts.join("; "))
}

/// The first few keys of many rows.
pub fn keys(keys: &[Key], all: usize) -> String {
    let mut shown: Vec<String> = keys.iter().map(key).collect();
    if all > shown.len() {
        shown.push(format!("and {} more", all - shown.len()));
    }
    shown.join("; ")
}

/// `3 stages changed, 1 within tolerance, 8 the same`.
pub fn sum(study: &StudyDiff) -> String {
    if study.state == Difference::Unknown {
        return study.state.word().to_owned();
    }
    let number = |state: Difference| study.stages.iter().filter(|stage| stage.state == state).count();
    let states =
        [Difference::Changed, Difference::Added, Difference::Removed, Difference::WithinTolerance, Difference::Same];
    let parts: Vec<String> = states
        .iter()
        .filter(|state| number(**state) > 0)
        .enumerate()
        .map(|(index, state)| {
            let many = if index == 0 { count(number(*state), "stage") } else { number(*state).to_string() };
            format!("{many} {}", if *state == Difference::Same { "the same" } else { state.word() })
        })
        .collect();
    parts.join(", ")
}

/// One sentence about everything.
pub fn verdict(comparison: &Comparison) -> String {
    let number = |state: Difference| comparison.studies.iter().filter(|study| study.state == state).count();
    let differing: usize = comparison.studies.iter().filter(|study| study.state.differs()).count();
    let flips = match comparison.verdicts.len() {
        0 => String::new(),
        many => format!("; {} flipped", count(many, "verdict")),
    };
    let studies = count(comparison.studies.len(), "study");
    let flips = match comparison.damaged.len() {
        0 => flips,
        many => format!("{flips}; {} damaged", count(many, "file")),
    };
    let unknown = number(Difference::Unknown);
    if unknown == comparison.studies.len() {
        let what = if unknown == 0 { "the results".to_owned() } else { studies };
        return format!("{what} could not be compared{flips}");
    }
    let flips = if unknown > 0 { format!("{flips}; {unknown} could not be compared") } else { flips };
    if differing > 0 {
        let verb = if differing == 1 { "differs" } else { "differ" };
        let of = if comparison.studies.len() == 1 { String::new() } else { format!("{differing} of ") };
        return format!("{of}{studies} {verb} beyond tolerance{flips}");
    }
    let studies = if unknown > 0 { format!("{} of {studies}", comparison.studies.len() - unknown) } else { studies };
    match number(Difference::WithinTolerance) {
        0 => format!("{studies}, no difference{flips}"),
        _ => format!("{studies}, every difference within tolerance{flips}"),
    }
}
