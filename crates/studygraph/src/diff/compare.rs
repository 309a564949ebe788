//! Two sides, study by study, stage by stage, table by table.
//!
//! Must not know: how the outcome is shown.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::manifests::{Read, read};
use super::model::{Comparison, Damage, Difference, Flip, StageDiff, StudyDiff, TableDiff};
use super::renamed::ManifestPair;
use super::{curves, renamed, table, verdict, why};
use crate::history::side::{Got, Odd, Side, is_cached};
use crate::store::cache::Cache;
use crate::store::manifest::{FORMAT, Manifest, StageRecord, TableRecord};
use crate::table::schema::{Column, Type};
use crate::table::tolerance::{Allowance, find};
use crate::threads;
use declare::error::suggest;

/// Columns that one tolerance is meant for and that are named; of more only their number is said.
const MOST_MEANT: usize = 6;

/// Of a kind of stage and its table, where that holds sampled curves: the column over which they are sampled, and the one that
/// is told first.
pub type Curves<'a> = &'a dyn Fn(&str, &str) -> Option<(&'static str, &'static str)>;

/// Decides something of a name; a sentence where the answer is not known.
pub type Decides<'a, T> = &'a dyn Fn(&T) -> Result<bool, String>;

/// What is asked for besides the two sides.
#[derive(Default)]
pub struct Options<'a> {
    /// Only these studies; all when empty.
    pub studies: &'a [String],
    /// They come before those of the studies, which come before those of the columns.
    pub tolerances: &'a [Allowance],
    /// Where tables may be found that are not kept with the results.
    pub cache: Option<&'a Cache>,
    /// Whether a study that only the later side has is left out on purpose.
    pub leaves_out: Option<Decides<'a, str>>,
    /// Which tables hold sampled curves.
    pub curves: Option<Curves<'a>>,
    /// Whether a file of a folder of results is one that is not kept there on purpose.
    pub not_kept: Option<Decides<'a, Path>>,
}

/// Compares everything that both sides hold.
///
/// # Errors
/// One sentence: a side without results, an unknown study, a tolerance for no column.
pub fn compare(before: &Side, after: &Side, options: &Options<'_>) -> Result<Comparison, String> {
    let mut comparison = Comparison {
        before: before.label.clone(),
        after: after.label.clone(),
        state: Difference::Same,
        damaged: Vec::new(),
        verdicts: Vec::new(),
        studies: Vec::new(),
        problems: Vec::new(),
        stale: Vec::new(),
        remarks: Vec::new(),
    };
    let pairs = pairs(before, after, options, &mut comparison)?;
    comparison.remarks.extend(check_tolerances(&pairs, options.tolerances)?);
    for pair in &pairs {
        if !pair.unread.is_empty() {
            comparison.problems.extend(pair.unread.iter().cloned());
            comparison.studies.push(unknown(&pair.name, &pair.unread));
            continue;
        }
        let (damaged, remarks) = damaged(pair, before, after, options);
        comparison.damaged.extend(damaged);
        comparison.remarks.extend(remarks);
        let study = match (&pair.before, &pair.after) {
            (Some(old), Some(new)) => {
                let own = new.1.tolerances.iter().map(|(name, value)| Allowance::new(name, value));
                let own = own.collect::<Result<Vec<_>, _>>();
                let own =
                    own.map_err(|problem| format!("{}, in the manifest of {}: {problem}", pair.name, after.label))?;
                let renamed_from = pair.renamed_from.as_deref();
                let task = Task { before, after, old, new, renamed_from, own, options };
                let (study, found) = task.study(&pair.name);
                comparison.verdicts.extend(found.flips);
                replace(&mut comparison.damaged, found.damaged);
                study
            }
            (Some((folder, only)), None) => {
                let stages = only.stages.iter();
                let gone = stages.flat_map(|stage| gone(before, folder, &pair.name, stage, options));
                comparison.verdicts.extend(gone);
                one_sided(&pair.name, only, Difference::Removed)
            }
            (None, Some((_, only))) => one_sided(&pair.name, only, Difference::Added),
            (None, None) => continue,
        };
        comparison.studies.push(study);
    }
    if comparison.studies.is_empty() {
        comparison.problems.push(format!("{} and {} have no study to compare", before.label, after.label));
    }
    verdict::sort(&mut comparison.verdicts);
    let unknown = (!comparison.problems.is_empty()).then_some(Difference::Unknown);
    let damaged = (!comparison.damaged.is_empty()).then_some(Difference::Changed);
    comparison.state =
        Difference::of_parts(comparison.studies.iter().map(|study| study.state).chain(damaged).chain(unknown));
    Ok(comparison)
}

/// Of a table that is compared, its values tell more than its bytes.
fn replace(told: &mut Vec<Damage>, found: Vec<Damage>) {
    for damage in found {
        let same = |one: &Damage| (&one.at, &one.study, &one.file) == (&damage.at, &damage.study, &damage.file);
        if let Some(position) = told.iter().position(same) {
            told.remove(position);
        }
        told.push(damage);
    }
}

/// Files that are not what their manifests say, but for values of tables that will be compared; a remark on files that other
/// runs left there.
fn damaged(pair: &ManifestPair, before: &Side, after: &Side, options: &Options<'_>) -> (Vec<Damage>, Vec<String>) {
    let tables = |side: &Option<(String, Manifest)>| -> BTreeSet<(String, String)> {
        let manifest = side.iter().flat_map(|(_, manifest)| &manifest.stages);
        manifest.flat_map(|stage| &stage.tables).map(|table| (table.name.clone(), table.content.clone())).collect()
    };
    let both = tables(&pair.before).into_iter().chain(tables(&pair.after));
    let mut contents = BTreeMap::<String, BTreeSet<String>>::new();
    for (name, content) in both {
        contents.entry(name).or_default().insert(content);
    }
    let compared = |table: &TableRecord| contents.get(&table.name).is_some_and(|contents| contents.len() > 1);
    let (mut found, mut remarks) = (Vec::new(), Vec::new());
    for (side, held, other, there) in
        [(before, &pair.before, after, &pair.after), (after, &pair.after, before, &pair.before)]
    {
        let Some((folder, manifest)) = held else { continue };
        let mut tell = |file: String, problem: String| {
            found.push(Damage { at: side.label.clone(), study: pair.name.clone(), file, problem });
        };
        let Odd { damaged, other_run } = side.damage(folder, manifest, &compared);
        for (file, problem) in damaged {
            tell(file, problem);
        }
        if let [first, more @ ..] = &other_run[..] {
            let more = if more.is_empty() { String::new() } else { format!(" and {} more", more.len()) };
            let is_cached = other_run.iter().all(|file| is_cached(options.cache, manifest, file));
            let how = if is_cached { "takes the right ones from the cache" } else { "computes the right ones again" };
            remarks.push(format!(
                "{}: {}: `{first}`{more} of another run, as `git checkout` leaves them; `gearstudy run` {how}",
                pair.name, side.label
            ));
        }
        // Git seldom keeps all; what the other side has of the same study should be here too.
        let (Some(path), Some((there, theirs))) = (side.path(), there) else { continue };
        let listed = manifest.files.iter().filter(|listed| theirs.files.iter().any(|other| other.file == listed.file));
        for listed in listed.filter(|listed| !side.has(folder, &listed.file) && other.has(there, &listed.file)) {
            let not_kept =
                options.not_kept.map_or(Ok(false), |not_kept| not_kept(&path.join(folder).join(&listed.file)));
            let why = match not_kept {
                Ok(true) => continue,
                Ok(false) => String::new(),
                Err(problem) => format!("; {problem}"),
            };
            tell(listed.file.clone(), format!("is not there; {} has it{why}", other.label));
        }
    }
    (found, remarks)
}

fn pairs(
    before: &Side,
    after: &Side,
    options: &Options<'_>,
    comparison: &mut Comparison,
) -> Result<Vec<ManifestPair>, String> {
    let (mut old, new) = (read(before, after, options.studies)?, read(after, before, options.studies)?);
    if let (true, true, [old], [new]) = (before.is_single(), after.is_single(), &mut old[..], &new[..]) {
        // Two folders of one study each are meant for each other, whatever they are called.
        old.0.clone_from(&new.0);
    }
    let mut names: Vec<String> = old.iter().chain(&new).map(|(name, ..)| name.clone()).collect();
    names.sort();
    names.dedup();
    // A single folder whose manifest cannot be read is that of any study.
    let is_any = |side: &[Read]| side.iter().any(|(name, _, read)| name.is_empty() && read.is_err());
    let is_known = |wanted: &String| names.contains(wanted) || is_any(&old) || is_any(&new);
    if let Some(unknown) = options.studies.iter().find(|wanted| !is_known(wanted)) {
        // What was read in case that it has another name here counts too.
        let mut known: BTreeSet<String> = names.iter().cloned().collect();
        known.extend(before.studies()?.into_iter().chain(after.studies()?).filter(|name| !name.is_empty()));
        let help = suggest(unknown, known.iter().map(String::as_str).collect::<Vec<_>>());
        return Err(format!("neither {} nor {} has results of a study `{unknown}`; {help}", before.label, after.label));
    }
    let take = |side: &[Read], wanted: &str, unread: &mut Vec<String>| {
        let (_, folder, read) = side.iter().find(|(name, ..)| name == wanted)?;
        match read {
            Ok(manifest) => Some((folder.clone(), manifest.clone())),
            Err(problem) => {
                unread.push(problem.clone());
                None
            }
        }
    };
    let pair = |name: String| {
        let mut unread = Vec::new();
        let (before, after) = (take(&old, &name, &mut unread), take(&new, &name, &mut unread));
        ManifestPair { name, renamed_from: None, before, after, unread }
    };
    let (mut left_out, mut pairs) = (Vec::new(), Vec::new());
    for mut pair in names.into_iter().map(pair) {
        let only_there = pair.before.is_none() && pair.after.is_some() && pair.unread.is_empty();
        let is_left_out = options.leaves_out.filter(|_| only_there).map(|leaves_out| leaves_out(&pair.name));
        let is_left_out = is_left_out.unwrap_or(Ok(false)).unwrap_or_else(|problem| {
            pair.unread.push(problem);
            false
        });
        if is_left_out { left_out.push(pair) } else { pairs.push(pair) }
    }
    let is_asked = |name: &String| options.studies.is_empty() || options.studies.contains(name);
    let left_out = left_out.into_iter().filter(|pair| is_asked(&pair.name));
    let remark = |pair: ManifestPair| format!("{} is left out: git is told to ignore its results", pair.name);
    comparison.remarks.extend(left_out.map(remark));
    renamed::join(&mut pairs);
    // The folder of one study whose manifest cannot be read may be that of any.
    let is_meant = |pair: &ManifestPair| {
        is_asked(&pair.name) || pair.renamed_from.as_ref().is_some_and(is_asked) || pair.name.is_empty()
    };
    pairs.retain(is_meant);
    Ok(pairs)
}

/// Every tolerance of the command line must be meant for some column, and fit it; where a name means several, it is said
/// which.
fn check_tolerances(pairs: &[ManifestPair], tolerances: &[Allowance]) -> Result<Vec<String>, String> {
    let mut remarks = Vec::new();
    for allowance in tolerances {
        let mut meant = BTreeSet::new();
        let mut known: Vec<String> = Vec::new();
        let mut found = false;
        let manifests = pairs.iter().flat_map(|pair| [&pair.before, &pair.after]).flatten();
        for table in manifests.flat_map(|(_, manifest)| &manifest.stages).flat_map(|stage| &stage.tables) {
            let (stage, name) = table.name.split_once('.').unwrap_or((&table.name, ""));
            for record in table.columns.iter().filter(|record| !record.volatile) {
                if allowance.means(stage, name, &record.name) {
                    found = true;
                    meant.insert(format!("{}.{}", table.name, record.name));
                    let kind = Type::from_name(&record.kind).unwrap_or(Type::Text);
                    allowance.of(&Column { kind, ..Column::float(&record.name, &record.unit, "") })?;
                } else if table::is_number(record) {
                    let full = format!("{}.{}", table.name, record.name);
                    let parts = allowance.name.split('.').count();
                    known.push(full.splitn(4 - parts, '.').last().unwrap_or(&full).to_owned());
                }
            }
        }
        // A manifest that cannot be read may have it.
        if !found && pairs.iter().all(|pair| pair.unread.is_empty()) {
            known.sort();
            known.dedup();
            let help = suggest(&allowance.name, known.iter().map(String::as_str).collect::<Vec<_>>());
            return Err(format!("there is no column `{}`; {help}", allowance.name));
        }
        if meant.len() > 1 {
            let more = meant.len().saturating_sub(MOST_MEANT);
            let mut names: Vec<String> = meant.iter().take(MOST_MEANT).cloned().collect();
            names.extend((more > 0).then(|| format!("{more} more")));
            let (name, number) = (&allowance.name, meant.len());
            remarks.push(format!("the tolerance of `{name}` is that of {number} columns: {}", names.join(", ")));
        }
    }
    Ok(remarks)
}

/// A study of which a manifest could not be read.
fn unknown(name: &str, why: &[String]) -> StudyDiff {
    // The folder of one study, whose manifest would have its name.
    let name = if name.is_empty() { "a study without a name" } else { name };
    let (remarks, state) = (why.to_vec(), Difference::Unknown);
    StudyDiff { name: name.to_owned(), renamed_from: None, state, remarks, stages: Vec::new() }
}

fn one_sided(name: &str, manifest: &Manifest, state: Difference) -> StudyDiff {
    let stages = manifest.stages.iter().map(|stage| one_sided_stage(stage, state)).collect();
    StudyDiff { name: name.to_owned(), renamed_from: None, state, remarks: Vec::new(), stages }
}

fn one_sided_stage(stage: &StageRecord, state: Difference) -> StageDiff {
    let tables = stage.tables.iter().map(|record| one_sided_table(record, state)).collect();
    StageDiff { name: stage.name.clone(), kind: stage.kind.clone(), renamed_from: None, state, why: Vec::new(), tables }
}

fn one_sided_table(record: &TableRecord, state: Difference) -> TableDiff {
    let (rows_before, rows_after) = if state == Difference::Added { (0, record.rows) } else { (record.rows, 0) };
    TableDiff { name: record.name.clone(), state, rows_before, rows_after, ..TableDiff::default() }
}

/// The verdicts of a stage that is no more.
fn gone(side: &Side, folder: &str, study: &str, stage: &StageRecord, options: &Options<'_>) -> Vec<Flip> {
    let tables = stage.tables.iter().filter(|table| stage.kind == "report" && table.table() == verdict::TABLE);
    let flips = tables.map(|record| match side.table(folder, stage, record, options.cache).0 {
        Got::Table(table) => verdict::gone(study, &stage.name, &table),
        Got::Without(_) => Vec::new(),
    });
    flips.flatten().collect()
}

/// Whether a stage is one that is gone, under another name: names are in no key, so nothing else need have changed.
fn is_renamed(gone: &StageRecord, new: &StageRecord) -> bool {
    let contents = |stage: &StageRecord| -> BTreeMap<String, String> {
        stage.tables.iter().map(|table| (table.table().to_owned(), table.content.clone())).collect()
    };
    gone.kind == new.kind && !new.tables.is_empty() && contents(gone) == contents(new)
}

/// What is told apart from the stage it was found in.
#[derive(Default)]
struct Found {
    flips: Vec<Flip>,
    damaged: Vec<Damage>,
}

/// One study that both sides have.
struct Task<'a> {
    before: &'a Side,
    after: &'a Side,
    old: &'a (String, Manifest),
    new: &'a (String, Manifest),
    renamed_from: Option<&'a str>,
    /// Tolerances of the study itself.
    own: Vec<Allowance>,
    options: &'a Options<'a>,
}

impl Task<'_> {
    fn study(&self, name: &str) -> (StudyDiff, Found) {
        let (old, new) = (&self.old.1, &self.new.1);
        let (mut stages, mut found) = (Vec::new(), Found::default());
        let is_in = |manifest: &Manifest, name: &str| manifest.stages.iter().any(|stage| stage.name == name);
        let mut gone: Vec<&StageRecord> = old.stages.iter().filter(|stage| !is_in(new, &stage.name)).collect();
        for stage in &new.stages {
            let same_name = old.stages.iter().find(|earlier| earlier.name == stage.name);
            let renamed = || Some(gone.remove(gone.iter().position(|earlier| is_renamed(earlier, stage))?));
            stages.push(match same_name.or_else(renamed) {
                None => one_sided_stage(stage, Difference::Added),
                Some(earlier) => self.stage(name, earlier, stage, &mut found),
            });
        }
        for stage in &gone {
            found.flips.extend(self::gone(self.before, &self.old.0, name, stage, self.options));
        }
        stages.extend(gone.into_iter().map(|stage| one_sided_stage(stage, Difference::Removed)));
        let state = Difference::of_parts(stages.iter().map(|stage| stage.state));
        let renamed_from = self.renamed_from.map(str::to_owned);
        (StudyDiff { name: name.to_owned(), renamed_from, state, remarks: self.remarks(), stages }, found)
    }

    /// What is to be known of the results themselves.
    fn remarks(&self) -> Vec<String> {
        let sides = [(self.before, &self.old.1), (self.after, &self.new.1)];
        let earlier = sides.into_iter().filter(|(_, manifest)| manifest.format < FORMAT).map(|(side, manifest)| {
            let (format, version) = (manifest.format, &manifest.program.version);
            format!("{}: results of format {format}, which gearstudy {version} wrote; now it is {FORMAT}", side.label)
        });
        let other = self.old.1.study_digest != self.new.1.study_digest;
        let text = other.then(|| "the two are from different texts of the study".to_owned());
        earlier.chain(text).collect()
    }

    fn stage(&self, study: &str, old: &StageRecord, new: &StageRecord, found: &mut Found) -> StageDiff {
        let mut tables = Vec::new();
        for record in &new.tables {
            let Some(earlier) = old.tables.iter().find(|earlier| earlier.table() == record.table()) else {
                tables.push(one_sided_table(record, Difference::Added));
                continue;
            };
            tables.push(self.table(study, (old, earlier), (new, record), found));
        }
        let gone = old.tables.iter().filter(|table| !new.tables.iter().any(|other| other.table() == table.table()));
        tables.extend(gone.map(|table| one_sided_table(table, Difference::Removed)));
        // What sums up comes before the points that it sums up.
        tables.sort_by_key(|table| table.curves.is_some());
        let mut why = why::reasons((&self.old.1, old), (&self.new.1, new));
        let mut state = Difference::of_parts(tables.iter().map(|table| table.state));
        if old.is_complete() && !new.is_complete() {
            state = Difference::Changed;
        }
        if state.differs() && why.is_empty() {
            why.push(why::unknown(&self.old.1, &self.new.1));
        }
        let renamed_from = (old.name != new.name).then(|| old.name.clone());
        StageDiff { name: new.name.clone(), kind: new.kind.clone(), renamed_from, state, why, tables }
    }

    fn table(
        &self,
        study: &str,
        (old, before): (&StageRecord, &TableRecord),
        (new, after): (&StageRecord, &TableRecord),
        found: &mut Found,
    ) -> TableDiff {
        if before.content == after.content {
            return table::by_record(before, after, String::new());
        }
        let cache = self.options.cache;
        let (first, second) = threads::with_all(|| {
            rayon::join(
                || self.before.table(&self.old.0, old, before, cache),
                || self.after.table(&self.new.0, new, after, cache),
            )
        });
        let (stage, name) = after.name.split_once('.').unwrap_or((&after.name, ""));
        for (side, file, problem) in [(self.before, &before.file, first.1), (self.after, &after.file, second.1)] {
            found.damaged.extend(problem.map(|problem| Damage {
                at: side.label.clone(),
                study: study.to_owned(),
                file: file.clone(),
                problem,
            }));
        }
        let (first, second) = match (first.0, second.0) {
            (Got::Table(first), Got::Table(second)) => (first, second),
            (Got::Without(note), Got::Table(_)) | (Got::Table(_), Got::Without(note)) => {
                return table::by_record(before, after, note);
            }
            (Got::Without(one), Got::Without(other)) => {
                let note = if one == other { one } else { format!("{one}, and {other}") };
                return table::by_record(before, after, note);
            }
        };
        let of_verdicts = new.kind == "report" && name == verdict::TABLE;
        if of_verdicts {
            found.flips.extend(verdict::flips(study, stage, &first, &second));
        }
        let tolerances = |column: &Column| {
            let flagged = find(self.options.tolerances, stage, name, &column.name);
            let meant = flagged.or_else(|| find(&self.own, stage, name, &column.name))?;
            meant.of(column).ok()
        };
        let compared = |key| table::compare(&after.name, &first, &second, key, &tolerances);
        let keys = if of_verdicts { &verdict::KEYS[..] } else { &[] };
        let by_words = keys.iter().map(|key| compared(Some(key))).find(|diff| diff.note.is_empty());
        let mut diff = by_words.unwrap_or_else(|| compared(None));
        if let Some(declared) = self.options.curves.and_then(|curves| curves(&new.kind, name)) {
            curves::told(&mut diff, (&first, &second), declared, &tolerances);
        }
        diff
    }
}
