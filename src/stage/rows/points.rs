//! The tables of a stage with other values in fields of it and of what it reads: at a few points, none of them foreseen.
//!
//! What of a chain does not change from point to point is computed once: the values of a stage's own fields and of those that
//! it reads are the key. Must not know: what is read off the tables.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;

use super::chain::{Chain, Tables, Trouble};
use super::{Class, Column};
use crate::stage::{Ahead, Context, Demand, Inputs, Port};
use declare::error::{Diagnostic, Failure};
use declare::record::varied::Varied;
use declare::work::Tally;
use studygraph::table::data::Table;
use studygraph::warning::Warning;

/// Entries of a stage that are kept from batch to batch.
const KEPT: usize = 64;

/// A stage's tables, or why there are none.
pub type Found = Result<Arc<Vec<Table>>, String>;
/// The tables of all stages of a chain, or why there are none.
pub type AllFound = Result<Vec<Arc<Vec<Table>>>, String>;

/// A point, and by link whether it is asked for there.
pub type Asked = (Vec<f64>, Vec<bool>);

/// A chain of stages with varied fields.
pub struct Points {
    chain: Chain,
    columns: Vec<Column>,
    /// By link, the links that it reads.
    reads: Vec<Vec<usize>>,
    /// By link, the columns that its tables depend on.
    depends: Vec<Vec<usize>>,
}

/// What was computed before.
#[derive(Default)]
pub struct Memory {
    /// By link and the bits of the values.
    known: Vec<BTreeMap<Vec<u64>, Found>>,
}

impl Points {
    /// `demands` are what is asked of each stage.
    ///
    /// # Errors
    /// What a kind refuses of the study as it is.
    pub fn new(varied: &Varied, demands: Vec<Demand>) -> Result<Self, Diagnostic> {
        let chain = Chain::new(varied, demands)?;
        let columns: Vec<Column> =
            varied.axes.iter().map(|axis| Column { axis: axis.clone(), class: Class::Upstream }).collect();
        let mut depends: Vec<Vec<usize>> = Vec::new();
        let count = varied.stages.len();
        let reads = (0..count).map(|link| (0..link).filter(|read| chain.reads(link, *read)).collect()).collect();
        for (link, stage) in varied.stages.iter().enumerate() {
            let read: Vec<&Vec<usize>> = stage.reads.iter().flatten().filter_map(|read| depends.get(*read)).collect();
            let does =
                |column: &usize| columns[*column].axis.stage == link || read.iter().any(|read| read.contains(column));
            depends.push((0..columns.len()).filter(does).collect());
        }
        Ok(Self { chain, columns, reads, depends })
    }

    /// What all stages take at a point, on one thread \[s\].
    pub fn seconds(&self) -> f64 {
        self.seconds_of_each().iter().sum()
    }

    /// The same of each stage.
    pub fn seconds_of_each(&self) -> Vec<f64> {
        let of_link = |link: &super::chain::Link| {
            let built = (link.kind.build)(&link.record).ok();
            built.map_or(0.0, |built| built.estimate(&link.demand, &Ahead::default()).seconds)
        };
        self.chain.links.iter().map(of_link).collect()
    }

    /// What the stages read of the study.
    pub fn ports(&self) -> &[Port] {
        &self.chain.outer
    }

    /// Whether any of them draws random numbers.
    pub fn uses_seed(&self) -> bool {
        self.chain.links.iter().any(|link| link.uses_seed)
    }

    /// The tables of all stages at some points, in SI and in the order of the columns.
    ///
    /// # Errors
    /// When the user stopped, or the stages cannot go on at all.
    pub fn tables(
        &self,
        points: &[Vec<f64>],
        memory: &mut Memory,
        given: (&Context, &Inputs),
    ) -> Result<Vec<AllFound>, Failure> {
        let all = vec![true; self.chain.links.len()];
        let asked: Vec<Asked> = points.iter().map(|point| (point.clone(), all.clone())).collect();
        Ok(self.each(&asked, memory, given)?.into_iter().map(|found| found.into_iter().collect()).collect())
    }

    /// The worst that stages report at a point of tip corners that they leave out.
    pub fn warning_of_corners(&self, point: &[f64], (context, inputs): (&Context, &Inputs)) -> Option<Warning> {
        // Work beside the points is not theirs.
        let aside = Tally::default();
        let context = &Context { work: &aside, ..*context };
        self.chain.warning_of_corners((&self.columns, point), (context, inputs))
    }

    /// The stages whose tables those of some stages depend on, themselves included.
    pub fn needed(&self, of: &[bool]) -> Vec<bool> {
        let mut needed = of.to_vec();
        for link in (0..needed.len()).rev().filter(|link| of[*link]) {
            let mut open = vec![link];
            while let Some(link) = open.pop() {
                needed[link] = true;
                open.extend(&self.reads[link]);
            }
        }
        needed
    }

    /// Whether the tables of a stage depend on a column.
    pub fn depends(&self, link: usize, column: usize) -> bool {
        self.depends[link].contains(&column)
    }

    /// The same of those stages alone that are asked for at each point, by link; with them goes all that they read. Of the
    /// others there is nothing.
    ///
    /// # Errors
    /// As [`Points::tables`].
    pub fn each(
        &self,
        points: &[Asked],
        memory: &mut Memory,
        (context, inputs): (&Context, &Inputs),
    ) -> Result<Vec<Vec<Found>>, Failure> {
        context.check_stop()?;
        memory.known.resize_with(self.chain.links.len(), BTreeMap::new);
        let key = |link: usize, point: &[f64]| -> Vec<u64> {
            self.depends[link].iter().map(|column| point[*column].to_bits()).collect()
        };
        for link in 0..self.chain.links.len() {
            let mut missing: BTreeMap<Vec<u64>, &Vec<f64>> = BTreeMap::new();
            for (point, _) in points.iter().filter(|(_, asked)| asked[link]) {
                let key = key(link, point);
                if !memory.known[link].contains_key(&key) {
                    missing.insert(key, point);
                }
            }
            let before = &memory.known[..link];
            let found: Vec<(Vec<u64>, Found)> = missing
                .into_par_iter()
                .map(|(own, point)| {
                    context.check_stop()?;
                    let mut tables: Tables = self.chain.links.iter().map(|_| None).collect();
                    for (read, known) in before.iter().enumerate() {
                        match known.get(&key(read, point)) {
                            Some(Ok(found)) => tables[read] = Some(found.as_ref().clone()),
                            Some(Err(reason)) if self.reads[link].contains(&read) => {
                                return Ok((own, Err(reason.clone())));
                            }
                            _ => {}
                        }
                    }
                    match self.chain.run(link, (&self.columns, point), &tables, (context, inputs)) {
                        Ok(found) => Ok((own, Ok(Arc::new(found)))),
                        Err(Trouble::Invalid(reason)) => Ok((own, Err(reason))),
                        Err(Trouble::Failed(failure)) => Err(failure),
                    }
                })
                .collect::<Result<_, Failure>>()?;
            memory.known[link].extend(found);
        }
        let of_point = |(point, asked): &Asked| -> Vec<Found> {
            let of_link = |(link, known): (usize, &BTreeMap<Vec<u64>, Found>)| match known.get(&key(link, point)) {
                Some(found) if asked[link] => found.clone(),
                _ => Ok(Arc::new(Vec::new())),
            };
            memory.known.iter().enumerate().map(of_link).collect()
        };
        let found = points.iter().map(of_point).collect();
        for (link, known) in memory.known.iter_mut().enumerate() {
            if known.len() > KEPT {
                let used: Vec<Vec<u64>> = points.iter().map(|(point, _)| key(link, point)).collect();
                known.retain(|key, _| used.contains(key));
            }
        }
        Ok(found)
    }
}
