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
use studygraph::table::data::Table;

/// Entries of a stage that are kept from batch to batch.
const KEPT: usize = 64;

/// A stage's tables, or why there are none.
type Found = Result<Arc<Vec<Table>>, String>;
/// The tables of all stages of a chain, or why there are none.
pub type AllFound = Result<Vec<Arc<Vec<Table>>>, String>;

/// A chain of stages with varied fields.
pub struct Points {
    chain: Chain,
    columns: Vec<Column>,
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
        for (link, stage) in varied.stages.iter().enumerate() {
            let read: Vec<&Vec<usize>> = stage.reads.iter().flatten().filter_map(|read| depends.get(*read)).collect();
            let does =
                |column: &usize| columns[*column].axis.stage == link || read.iter().any(|read| read.contains(column));
            depends.push((0..columns.len()).filter(does).collect());
        }
        Ok(Self { chain, columns, depends })
    }

    /// What all stages take at a point, on one thread \[s\].
    pub fn seconds(&self) -> f64 {
        let of_link = |link: &super::chain::Link| {
            let built = (link.kind.build)(&link.record).ok()?;
            Some(built.estimate(&link.demand, &Ahead::default()).seconds)
        };
        self.chain.links.iter().filter_map(of_link).sum()
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
        (context, inputs): (&Context, &Inputs),
    ) -> Result<Vec<AllFound>, Failure> {
        context.check_stop()?;
        memory.known.resize_with(self.chain.links.len(), BTreeMap::new);
        let key = |link: usize, point: &[f64]| -> Vec<u64> {
            self.depends[link].iter().map(|column| point[*column].to_bits()).collect()
        };
        for link in 0..self.chain.links.len() {
            let mut missing: BTreeMap<Vec<u64>, &Vec<f64>> = BTreeMap::new();
            for point in points {
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
                        match &known[&key(read, point)] {
                            Ok(found) => tables[read] = Some(found.as_ref().clone()),
                            Err(reason) => return Ok((own, Err(reason.clone()))),
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
        let of_point = |point: &Vec<f64>| -> AllFound {
            memory.known.iter().enumerate().map(|(link, known)| known[&key(link, point)].clone()).collect()
        };
        let found = points.iter().map(of_point).collect();
        for (link, known) in memory.known.iter_mut().enumerate() {
            if known.len() > KEPT {
                let used: Vec<Vec<u64>> = points.iter().map(|point| key(link, point)).collect();
                known.retain(|key, _| used.contains(key));
            }
        }
        Ok(found)
    }
}
