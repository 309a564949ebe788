//! What a page shows of a manifest with thousands of stages.
//!
//! Must not know: how it is shown.

use std::collections::BTreeMap;

use super::{Manifest, StageRecord};
use crate::store::bundle::MANY;

/// Stages of a kind that are shown where there are more than their tables have files for.
const SHOWN: usize = 8;

/// What a manifest stands for that has not all of its stages.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct More {
    /// How many stages there are besides, by kind.
    pub stages: BTreeMap<String, usize>,
    /// How much was left out in them.
    pub omissions: usize,
}

impl Manifest {
    /// The same with the stages that a page shows: all if there is a stage of the kind `reader`, otherwise the first ones of a
    /// kind with very many stages, those that warn, and those that did not come to their end.
    #[must_use]
    pub fn shown(&self, reader: &str) -> Self {
        let mut counts: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
        for stage in &self.stages {
            counts.entry(&stage.kind).or_default().0 += 1;
        }
        let is_all = counts.contains_key(reader);
        let (mut stages, mut more) = (Vec::new(), self.more.clone());
        for stage in &self.stages {
            let (all, met) = counts.entry(&stage.kind).or_default();
            *met += 1;
            if is_all || *all <= MANY || *met <= SHOWN || !stage.is_complete() || !stage.warnings.is_empty() {
                stages.push(stage.clone());
            } else {
                *more.stages.entry(stage.kind.clone()).or_default() += 1;
                more.omissions += stage.left_out.len();
            }
        }
        Self { stages, more, ..self.without_stages() }
    }

    /// What it says besides stages.
    #[must_use]
    pub fn without_stages(&self) -> Self {
        Self {
            format: self.format,
            study: self.study.clone(),
            title: self.title.clone(),
            seed: self.seed,
            source: self.source.clone(),
            study_digest: self.study_digest.clone(),
            program: self.program.clone(),
            study_folder: self.study_folder.clone(),
            machine: self.machine.clone(),
            written: self.written.clone(),
            seconds: self.seconds,
            stages: Vec::new(),
            tolerances: self.tolerances.clone(),
            files: self.files.clone(),
            more: self.more.clone(),
        }
    }
}

impl StageRecord {
    /// Whether it came to its end: its tables are there.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        matches!(self.status.as_str(), "hit" | "ran")
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::sample;
    use super::*;

    #[test]
    fn of_very_many_stages_the_first_ones_are_shown_and_those_that_are_told_of() {
        let one = sample();
        let stage = |number: usize| {
            let mut stage = StageRecord { name: format!("m{number}"), ..one.stages[0].clone() };
            if number != 20 {
                stage.warnings.clear();
            }
            if number == 33 {
                stage.status = "failed".to_owned();
            }
            stage
        };
        let all = Manifest { stages: (0..MANY + 8).map(stage).collect(), ..one.clone() };
        let shown = all.shown("report");
        let names: Vec<&str> = shown.stages.iter().map(|stage| stage.name.as_str()).collect();
        assert_eq!(names, ["m0", "m1", "m2", "m3", "m4", "m5", "m6", "m7", "m20", "m33"]);
        assert_eq!(shown.more, More { stages: [("ste".to_owned(), 30)].into(), omissions: 30 });
        assert_eq!(Manifest { stages: all.stages.clone(), more: More::default(), ..shown.clone() }, all);
        assert_eq!(shown.shown("report"), shown, "there is nothing more to leave out");
        assert_eq!(all.shown("ste"), all, "a stage says what is shown");
        let few = Manifest { stages: (0..MANY).map(stage).collect(), ..one };
        assert_eq!(few.shown("report"), few);
    }
}
