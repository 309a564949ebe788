//! What is wrong with which stage, so that what is sound can go on.
//!
//! Must not know: what is wrong.

use std::collections::{BTreeMap, BTreeSet};

use super::Node;
use declare::error::Diagnostic;

/// A stage that was built, or its name.
pub type Built = Result<Node, String>;

/// Everything that was found so far.
#[derive(Default)]
pub struct Blame {
    pub wrong: Vec<Diagnostic>,
    /// Stages, by their place among all.
    unsound: BTreeSet<usize>,
    /// Whether a stage has a name that no stage can have: what is called otherwise elsewhere may be that one.
    pub is_misnamed: bool,
}

impl Blame {
    pub fn put(&mut self, stage: usize, found: Diagnostic) {
        self.wrong.push(found);
        self.unsound.insert(stage);
    }

    /// That something is wrong with a stage which is told elsewhere.
    pub fn doubt(&mut self, stage: usize) {
        self.unsound.insert(stage);
    }

    pub fn is_unsound(&self, stage: usize) -> bool {
        self.unsound.contains(&stage)
    }

    pub fn put_on_all(&mut self, stages: impl IntoIterator<Item = usize>, found: Diagnostic) {
        self.wrong.push(found);
        self.unsound.extend(stages);
    }

    /// The stages with which nothing is wrong, nor with any that they read from.
    pub fn sound(&self, built: Vec<Built>) -> Vec<Node> {
        if self.unsound.is_empty() {
            return built.into_iter().flatten().collect();
        }
        let index: BTreeMap<&str, usize> =
            built.iter().enumerate().filter_map(|(at, one)| Some((one.as_ref().ok()?.name.as_str(), at))).collect();
        let mut readers = vec![Vec::new(); built.len()];
        let mut spoilt: Vec<usize> = self.unsound.iter().copied().collect();
        for (at, node) in built.iter().enumerate().filter_map(|(at, one)| Some((at, one.as_ref().ok()?))) {
            for port in node.stage.inputs() {
                match index.get(port.stage.as_str()) {
                    Some(&read) => readers[read].push(at),
                    None => spoilt.push(at),
                }
            }
        }
        let mut is_sound = vec![true; built.len()];
        while let Some(at) = spoilt.pop() {
            if std::mem::replace(&mut is_sound[at], false) {
                spoilt.append(&mut readers[at]);
            }
        }
        built.into_iter().zip(is_sound).filter_map(|(one, is_sound)| one.ok().filter(|_| is_sound)).collect()
    }
}
