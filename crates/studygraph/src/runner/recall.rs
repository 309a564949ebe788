//! What of a study need not be read again: stages whose lines are those of the last run, and that have nothing to do with any
//! that changed. Of them keys, tables and what the manifest says stay as that run left them.
//!
//! Asked only where a note says that all its files are as that run left them (`note.rs`), and where the stages are the same
//! ones as then, in the same order, of the same kinds, and read from the same ones. Then a stage may depend on what its own
//! lines say, on the stages that they name, and on what its readers ask of it; names are looked for as words, be they meant so
//! or not. Whatever else changed, or is not plain, is a matter of reading the whole study. Must not know: how a run publishes.

use std::collections::{BTreeSet, HashMap, HashSet};

use serde::{Deserialize, Serialize};

use super::graph::Graph;
use super::key;
use super::note::{self, Note, Where};
use super::options::{Options, Wanted};
use crate::program::Program;
use crate::stage::Want;
use crate::store::manifest::{Manifest, StageRecord};
use crate::study::blocks::{Block, Blocks, mentions};
use crate::study::{MOST_VALUES, Study, Unread, load_part, text_of};
use declare::digest::{Digest, Writer};

/// What is kept of a study beside the note of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recalled {
    /// Of what stands in the text besides stages.
    #[serde(with = "crate::store::hexadecimal")]
    rest: Digest,
    /// At least as many values as the text has.
    values: usize,
    kinds: Vec<String>,
    /// What stages ask of others, each once.
    asked: Vec<Vec<Want>>,
    /// In the order of the file.
    stages: Vec<Recollection>,
}

/// Other stages are named by their places in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Recollection {
    name: String,
    kind: u32,
    /// The start of a digest of its lines.
    lines: [u8; 16],
    mentions: Vec<u32>,
    /// As [`Graph::reads`].
    reads: Vec<u32>,
    /// Of which stage what is asked.
    asks: Vec<(u32, u32)>,
    /// Of what is asked of it.
    demand: [u8; 16],
}

/// A study of which only some stages are read.
pub struct Part {
    pub study: Study,
    /// With what the stages that are not read ask of those that are.
    pub options: Options,
    pub(super) note: Note,
    /// With what is to be kept of the stages that are read.
    recalled: Recalled,
}

fn start(digest: &[u8; 32]) -> [u8; 16] {
    std::array::from_fn(|at| digest[at])
}

fn lines(block: &Block) -> [u8; 16] {
    start(blake3::hash(block.text.as_bytes()).as_bytes())
}

fn rest(blocks: &Blocks) -> Digest {
    let [head, tail] = blocks.rest();
    Writer::new("gearstudy 1 rest of a study").text(head).text(tail).finish()
}

fn index(place: usize) -> u32 {
    u32::try_from(place).unwrap_or(u32::MAX)
}

/// The places of stages by their names; none where a name stands twice.
fn places<'a>(blocks: &Blocks<'a>) -> Option<HashMap<&'a str, u32>> {
    let places: HashMap<&str, u32> =
        blocks.stages.iter().enumerate().map(|(place, block)| (block.name, index(place))).collect();
    (places.len() == blocks.stages.len()).then_some(places)
}

/// Whether those that were read are what was cut, each where it was.
fn is_aligned(study: &Study, blocks: &Blocks, read: &[usize]) -> bool {
    let alike = |(node, &block): (&crate::study::Node, &usize)| {
        let block = &blocks.stages[block];
        (node.name.as_str(), node.place.offset) == (block.name, block.offset)
    };
    study.nodes.len() == read.len() && study.nodes.iter().zip(read).all(alike)
}

impl Recalled {
    /// What is to be kept of a study that came to its end. None where its text is not plain.
    #[must_use]
    pub fn of(study: &Study, options: &Options) -> Option<Self> {
        // Notes on the text, such as of intervals without effect, are known of a study that is read as a whole.
        if !study.notes.is_empty() {
            return None;
        }
        let graph = Graph::new(study, &options.wanted).ok()?;
        let blocks = Blocks::cut(&study.text)?;
        let all: Vec<usize> = (0..blocks.stages.len()).collect();
        let nothing = |block: &Block| Recollection {
            name: block.name.to_owned(),
            kind: 0,
            lines: [0; 16],
            mentions: Vec::new(),
            reads: Vec::new(),
            asks: Vec::new(),
            demand: [0; 16],
        };
        let stages = blocks.stages.iter().map(nothing).collect();
        let known = places(&blocks).filter(|_| is_aligned(study, &blocks, &all))?;
        let (rest, kinds, asked) = (rest(&blocks), Vec::new(), Vec::new());
        let nothing = Self { rest, values: 0, kinds, asked, stages };
        nothing.with(study, (&blocks, &known), &graph, &all)
    }

    /// The same with what is to be kept of the stages that were read.
    fn with(
        mut self,
        study: &Study,
        (blocks, known): (&Blocks, &HashMap<&str, u32>),
        graph: &Graph,
        read: &[usize],
    ) -> Option<Self> {
        self.values += study.values;
        let mut kinds: HashMap<String, u32> =
            (0..).zip(&self.kinds).map(|(place, kind)| (kind.clone(), place)).collect();
        let mut asked: HashMap<Vec<Want>, u32> =
            (0..).zip(&self.asked).map(|(place, wants)| (wants.clone(), place)).collect();
        for (node, &place) in read.iter().enumerate() {
            let (kind, block) = (study.nodes[node].kind.name, &blocks.stages[place]);
            let kind = *kinds.entry(kind.to_owned()).or_insert_with(|| {
                self.kinds.push(kind.to_owned());
                index(self.kinds.len() - 1)
            });
            let mut mentions = mentions(block.text, known);
            mentions.retain(|&other| other != index(place));
            let asks = graph.inputs[node].iter().map(|input| {
                let wants = *asked.entry(input.wants.clone()).or_insert_with(|| {
                    self.asked.push(input.wants.clone());
                    index(self.asked.len() - 1)
                });
                (index(read[input.node]), wants)
            });
            let asks = asks.collect();
            self.stages[place] = Recollection {
                name: block.name.to_owned(),
                kind,
                lines: lines(block),
                mentions,
                reads: graph.reads[node].iter().map(|&other| index(read[other])).collect(),
                asks,
                demand: start(&key::demand(&graph.demands[node]).0),
            };
        }
        read.iter().all(|&place| self.names_what_it_reads(place)).then_some(self)
    }

    /// Whether a stage reads from no other ones than its lines lead to.
    fn names_what_it_reads(&self, place: usize) -> bool {
        let mentions = |place: usize| self.stages[place].mentions.iter().map(|&other| other as usize);
        let led_to = reached(mentions(place).collect(), self.stages.len(), mentions);
        self.stages[place].reads.iter().all(|&read| led_to.contains(&(read as usize)))
    }

    /// The places of the stages that must be read: what changed, whatever speaks of it, and what all of these speak of, to the
    /// end; none where there are others than before.
    fn to_be_read(&self, blocks: &Blocks, known: &HashMap<&str, u32>) -> Option<Vec<usize>> {
        let is_same = |(block, stage): (&Block, &Recollection)| block.name == stage.name;
        if blocks.stages.len() != self.stages.len() || !blocks.stages.iter().zip(&self.stages).all(is_same) {
            return None;
        }
        let mut readers: Vec<Vec<u32>> = vec![Vec::new(); self.stages.len()];
        for (reader, stage) in self.stages.iter().enumerate() {
            stage.mentions.iter().for_each(|&read| readers[read as usize].push(index(reader)));
        }
        let changed = blocks.stages.iter().zip(&self.stages).map(|(block, stage)| lines(block) != stage.lines);
        let changed: Vec<bool> = changed.collect();
        let mut is_read = vec![false; self.stages.len()];
        let mut open: Vec<usize> = (0..changed.len()).filter(|&place| changed[place]).collect();
        let touched = reached(open.clone(), self.stages.len(), |place| readers[place].iter().map(|&at| at as usize));
        open.extend(touched);
        // A study has a stage.
        if open.is_empty() {
            open.push(0);
        }
        let speaks_of = |place: usize| -> Vec<u32> {
            let before = &self.stages[place].mentions;
            if !changed[place] {
                return before.clone();
            }
            mentions(blocks.stages[place].text, known).into_iter().chain(before.iter().copied()).collect()
        };
        for place in reached(open, self.stages.len(), |place| speaks_of(place).into_iter().map(|at| at as usize)) {
            is_read[place] = true;
        }
        Some((0..is_read.len()).filter(|&place| is_read[place]).collect())
    }
}

/// What some places lead to, themselves among it.
fn reached<I: Iterator<Item = usize>>(from: Vec<usize>, count: usize, next: impl Fn(usize) -> I) -> Vec<usize> {
    let (mut met, mut found, mut open) = (vec![false; count], Vec::new(), from);
    while let Some(place) = open.pop() {
        if !std::mem::replace(&mut met[place], true) {
            found.push(place);
            open.extend(next(place));
        }
    }
    found
}

/// The part of a study that must be read, where that is less than half of it; none where all of it is to be read.
#[must_use]
pub fn part(at: &Where<'_>, program: &'static Program, options: &Options) -> Option<Part> {
    let (note, earlier) = note::recalled(at, program.about.code, options)?;
    let text = text_of(at.study).ok()?;
    let blocks = Blocks::cut(&text).filter(|blocks| rest(blocks) == earlier.rest)?;
    let known = places(&blocks)?;
    let read = earlier.to_be_read(&blocks, &known)?;
    if 2 * read.len() > blocks.stages.len() {
        return None;
    }
    let mut unread = Vec::with_capacity(blocks.stages.len() - read.len());
    let mut after = 0;
    for (place, stage) in earlier.stages.iter().enumerate() {
        if read.get(after) == Some(&place) {
            after += 1;
            continue;
        }
        let kind = program.kind(&earlier.kinds[stage.kind as usize])?.name;
        unread.push(Unread { name: stage.name.clone(), kind, after });
    }
    let study = load_part(&blocks, &read, unread, at.study, program)?;
    // That it is too much for a study is said of the whole.
    let is_too_much = earlier.values + study.values > MOST_VALUES;
    if is_too_much || study.name != note.study || !is_aligned(&study, &blocks, &read) {
        return None;
    }
    let options = earlier.asking(&read, options);
    let graph = Graph::new(&study, &options.wanted).ok()?;
    if !earlier.is_alike(&study, &graph, &read) {
        return None;
    }
    let recalled = earlier.with(&study, (&blocks, &known), &graph, &read)?;
    Some(Part { study, options, note, recalled })
}

impl Recalled {
    /// Options with what the stages that are not read ask of those that are.
    fn asking(&self, read: &[usize], options: &Options) -> Options {
        let mut options = options.clone();
        let is_read = |place: usize| read.binary_search(&place).is_ok();
        let mut met = BTreeSet::new();
        for stage in self.stages.iter().enumerate().filter(|(place, _)| !is_read(*place)).map(|(_, stage)| stage) {
            for &(of, wants) in &stage.asks {
                if is_read(of as usize) && met.insert((of, wants)) {
                    let stage = || self.stages[of as usize].name.clone();
                    let wants = self.asked[wants as usize].iter();
                    options.wanted.extend(wants.map(|want| Wanted { stage: stage(), want: want.clone() }));
                }
            }
        }
        options
    }

    /// Whether the stages that were read are of the kinds that they were of, read from the stages that they read from, and are
    /// asked for the same where others ask too.
    fn is_alike(&self, study: &Study, graph: &Graph, read: &[usize]) -> bool {
        let is_read = |place: u32| read.binary_search(&(place as usize)).is_ok();
        let others = self.stages.iter().enumerate().filter(|(place, _)| !is_read(index(*place)));
        let asked: BTreeSet<u32> = others.flat_map(|(_, stage)| stage.asks.iter().map(|(of, _)| *of)).collect();
        read.iter().enumerate().all(|(node, &place)| {
            let before = &self.stages[place];
            let reads = graph.reads[node].iter().map(|&other| index(read[other]));
            let demand = start(&key::demand(&graph.demands[node]).0);
            self.kinds[before.kind as usize] == study.nodes[node].kind.name
                && reads.eq(before.reads.iter().copied())
                && (demand == before.demand || !asked.contains(&index(place)))
        })
    }
}

impl Part {
    /// What is to be kept after a run.
    #[must_use]
    pub fn recalled(&self) -> &Recalled {
        &self.recalled
    }

    /// The manifest of all stages, from that of those that were run and that of the last run; none where that has others.
    #[must_use]
    pub fn whole(&self, part: Manifest, earlier: Manifest) -> Option<Manifest> {
        let names = self.recalled.stages.iter().map(|stage| stage.name.as_str());
        let known: HashSet<&str> = earlier.stages.iter().map(|stage| stage.name.as_str()).collect();
        if known.len() != self.stages() || !names.into_iter().all(|name| known.contains(name)) {
            return None;
        }
        let mut own: HashMap<String, StageRecord> =
            part.stages.into_iter().map(|stage| (stage.name.clone(), stage)).collect();
        let stages =
            earlier.stages.into_iter().map(|stage| own.remove(&stage.name).unwrap_or_else(|| stage.unchanged()));
        Some(Manifest { stages: stages.collect(), ..part })
    }

    /// How many stages the study has, read or not.
    #[must_use]
    pub fn stages(&self) -> usize {
        self.recalled.stages.len()
    }
}
