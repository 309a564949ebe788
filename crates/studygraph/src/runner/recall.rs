//! What of a study need not be read again: stages whose lines are those of the last run, and that read from nothing that
//! changed. Of them keys, tables and what the manifest says are those of that run.
//!
//! Asked only where a note says that all its files are as that run left them (`note.rs`). Then a stage may depend on what its
//! own lines say, on the stages that they name, and on what its readers ask of it; names are looked for as words, be they meant
//! so or not. Whatever else changed, or is not plain, is a matter of reading the whole study. Must not know: how a run
//! publishes.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use serde::{Deserialize, Serialize};

use super::graph::{self, Graph};
use super::key;
use super::note::{self, Note, Where};
use super::options::{Options, Wanted};
use crate::program::Program;
use crate::stage::Want;
use crate::store::bundle::MANY;
use crate::store::manifest::{Manifest, StageRecord};
use crate::study::blocks::{Block, Blocks, mentions};
use crate::study::{Study, Unread, load_part, text_of};
use declare::digest::{Digest, Writer};

/// What is kept of a study beside the note of a run.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct Recalled {
    /// Of what stands in the text besides stages.
    #[serde(with = "crate::store::hexadecimal")]
    rest: Digest,
    kinds: Vec<String>,
    /// What stages ask of others, each once.
    asked: Vec<Vec<Want>>,
    /// In the order of the file.
    stages: Vec<Recollection>,
}

/// Other stages are named by their places in the file.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
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
    earlier: Recalled,
    /// All stages, each after those that it reads.
    order: Vec<String>,
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
fn places<'a>(names: impl Iterator<Item = &'a str>) -> Option<HashMap<&'a str, u32>> {
    let mut places = HashMap::new();
    for (place, name) in names.enumerate() {
        if places.insert(name, index(place)).is_some() {
            return None;
        }
    }
    Some(places)
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
    /// What is to be kept of a study that came to its end; of stages that were not read, what was kept before. None where its
    /// text is not plain.
    #[must_use]
    pub fn of(study: &Study, graph: &Graph, earlier: Option<&Self>) -> Option<Self> {
        let blocks = Blocks::cut(&study.text)?;
        let known = places(blocks.stages.iter().map(|block| block.name))?;
        let read: Vec<usize> = study.stages().enumerate().filter_map(|(at, stage)| stage.ok().map(|_| at)).collect();
        if !is_aligned(study, &blocks, &read) || read.len() + study.unread.len() != blocks.stages.len() {
            return None;
        }
        let before = earlier.map(|earlier| places(earlier.stages.iter().map(|stage| &*stage.name)));
        let before = before.flatten().unwrap_or_default();
        let mut recalled = Self { rest: rest(&blocks), kinds: Vec::new(), asked: Vec::new(), stages: Vec::new() };
        let (mut kinds, mut asked) = (HashMap::new(), HashMap::new());
        for (stage, block) in study.stages().zip(&blocks.stages) {
            let kind = match stage {
                Ok(node) => study.nodes[node].kind.name,
                Err(unread) => unread.kind,
            };
            let kind = *kinds.entry(kind).or_insert_with(|| {
                recalled.kinds.push(kind.to_owned());
                index(recalled.kinds.len() - 1)
            });
            let mut ask = |wants: &Vec<Want>| match asked.get(wants) {
                Some(&place) => place,
                None => {
                    recalled.asked.push(wants.clone());
                    *asked.entry(wants.clone()).or_insert(index(recalled.asked.len() - 1))
                }
            };
            let name = block.name.to_owned();
            recalled.stages.push(match stage {
                Ok(node) => {
                    let mut mentions = mentions(block.text, &known);
                    mentions.retain(|&other| known[block.name] != other);
                    let reads = graph.reads[node].iter().map(|&other| index(read[other])).collect();
                    let asks = graph.inputs[node].iter().map(|input| (index(read[input.node]), ask(&input.wants)));
                    let (asks, demand) = (asks.collect(), start(&key::demand(&graph.demands[node]).0));
                    Recollection { name, kind, lines: lines(block), mentions, reads, asks, demand }
                }
                Err(_) => {
                    let (earlier, own) = (earlier?, *before.get(block.name)?);
                    let own = &earlier.stages[own as usize];
                    let now = |other: &u32| known.get(&*earlier.stages[*other as usize].name).copied();
                    let all = |others: &[u32]| others.iter().map(now).collect::<Option<Vec<u32>>>();
                    let asks =
                        own.asks.iter().map(|(of, wants)| Some((now(of)?, ask(&earlier.asked[*wants as usize]))));
                    let asks = asks.collect::<Option<_>>()?;
                    let (mentions, reads) = (all(&own.mentions)?, all(&own.reads)?);
                    Recollection { name, kind, lines: own.lines, mentions, reads, asks, demand: own.demand }
                }
            });
        }
        recalled.names_what_it_reads().then_some(recalled)
    }

    /// Whether a stage reads from no other ones than its lines lead to.
    fn names_what_it_reads(&self) -> bool {
        self.stages.iter().all(|stage| {
            stage.reads.iter().all(|read| {
                stage.mentions.contains(read) || {
                    let mut met: BTreeSet<u32> = BTreeSet::new();
                    let mut open = stage.mentions.clone();
                    while let Some(next) = open.pop() {
                        if met.insert(next) {
                            open.extend(&self.stages[next as usize].mentions);
                        }
                    }
                    met.contains(read)
                }
            })
        })
    }

    /// How many stages there are of each kind.
    fn count(&self) -> BTreeMap<&str, usize> {
        let mut kinds = BTreeMap::new();
        for stage in &self.stages {
            *kinds.entry(&*self.kinds[stage.kind as usize]).or_default() += 1;
        }
        kinds
    }
}

/// Which stages of a text must be read.
struct Choice {
    /// Of each stage of the text, its place in what is recalled, where its lines are the same.
    same: Vec<Option<usize>>,
    /// Places in the text, ascending.
    read: Vec<usize>,
}

impl Choice {
    /// What changed, whatever speaks of it, and what all of these speak of, to the end.
    fn of(earlier: &Recalled, blocks: &Blocks) -> Option<Self> {
        let before = places(earlier.stages.iter().map(|stage| &*stage.name))?;
        let known = places(blocks.stages.iter().map(|block| block.name))?;
        let same = |block: &Block| {
            let place = *before.get(block.name)? as usize;
            (earlier.stages[place].lines == lines(block)).then_some(place)
        };
        let same: Vec<Option<usize>> = blocks.stages.iter().map(same).collect();
        // By places in what is recalled.
        let mut is_kept = vec![false; earlier.stages.len()];
        same.iter().flatten().for_each(|&place| is_kept[place] = true);
        let now = |place: u32| known.get(&*earlier.stages[place as usize].name).map(|&now| now as usize);
        let added: HashMap<&str, u32> =
            known.iter().filter(|(name, _)| !before.contains_key(*name)).map(|(name, at)| (*name, *at)).collect();
        let mut readers: Vec<Vec<u32>> = vec![Vec::new(); earlier.stages.len()];
        for (reader, stage) in earlier.stages.iter().enumerate() {
            stage.mentions.iter().for_each(|&read| readers[read as usize].push(index(reader)));
        }
        // What speaks of what changed, or may speak of what is new.
        let mut is_touched: Vec<bool> = is_kept.iter().map(|kept| !kept).collect();
        let mut open: Vec<u32> = (0..).zip(&is_kept).filter(|(_, kept)| !**kept).map(|(place, _)| place).collect();
        if !added.is_empty() {
            for (block, same) in blocks.stages.iter().zip(&same) {
                if let Some(place) = *same
                    && !mentions(block.text, &added).is_empty()
                {
                    is_touched[place] = true;
                    open.push(index(place));
                }
            }
        }
        while let Some(next) = open.pop() {
            for &reader in &readers[next as usize] {
                if !std::mem::replace(&mut is_touched[reader as usize], true) {
                    open.push(reader);
                }
            }
        }
        // What all of these speak of, or spoke of.
        let mut is_read = vec![false; blocks.stages.len()];
        let mut open: Vec<usize> = Vec::new();
        for (place, same) in same.iter().enumerate() {
            if same.is_none_or(|place| is_touched[place]) {
                open.push(place);
            }
        }
        for (place, stage) in earlier.stages.iter().enumerate().filter(|(place, _)| is_touched[*place]) {
            open.extend(now(index(place)));
            open.extend(stage.mentions.iter().filter_map(|&other| now(other)));
        }
        // A study has a stage.
        if open.is_empty() {
            open.push(0);
        }
        while let Some(next) = open.pop() {
            if std::mem::replace(&mut is_read[next], true) {
                continue;
            }
            match same[next] {
                Some(place) => open.extend(earlier.stages[place].mentions.iter().filter_map(|&other| now(other))),
                None => {
                    open.extend(mentions(blocks.stages[next].text, &known).into_iter().map(|other| other as usize));
                }
            }
        }
        let read = is_read.iter().enumerate().filter(|(_, read)| **read).map(|(place, _)| place).collect();
        Some(Self { same, read })
    }
}

/// The part of a study that must be read, where that is less than half of it; none where all of it is to be read.
#[must_use]
pub fn part(at: &Where<'_>, program: &'static Program, options: &Options) -> Option<Part> {
    let (note, earlier) = note::recalled(at, program.about.code, options)?;
    let text = text_of(at.study).ok()?;
    let blocks = Blocks::cut(&text)?;
    if rest(&blocks) != earlier.rest {
        return None;
    }
    let Choice { same, read } = Choice::of(&earlier, &blocks)?;
    if 2 * read.len() > blocks.stages.len() {
        return None;
    }
    let mut unread = Vec::with_capacity(blocks.stages.len() - read.len());
    let mut after = 0;
    for (place, block) in blocks.stages.iter().enumerate() {
        if read.get(after) == Some(&place) {
            after += 1;
            continue;
        }
        let kind = program.kind(&earlier.kinds[earlier.stages[same[place]?].kind as usize])?.name;
        unread.push(Unread { name: block.name.to_owned(), kind, after });
    }
    let study = load_part(&blocks, &read, unread, at.study, program)?;
    if study.name != note.study || !is_aligned(&study, &blocks, &read) || !is_shown_alike(&study, &earlier) {
        return None;
    }
    let mut options = options.clone();
    let mut is_asked = vec![false; blocks.stages.len()];
    let is_read = |place: usize| read.binary_search(&place).is_ok();
    let known = places(blocks.stages.iter().map(|block| block.name))?;
    let now = |place: u32| known.get(&*earlier.stages[place as usize].name).map(|&now| now as usize);
    let mut met = BTreeSet::new();
    for (place, same) in same.iter().enumerate().filter(|(place, _)| !is_read(*place)) {
        for &(of, wants) in &earlier.stages[(*same)?].asks {
            let of_now = now(of)?;
            if !is_read(of_now) || !met.insert((of, wants)) {
                continue;
            }
            debug_assert_ne!(of_now, place);
            is_asked[of_now] = true;
            let stage = || blocks.stages[of_now].name.to_owned();
            let wants = earlier.asked[wants as usize].iter();
            options.wanted.extend(wants.map(|want| Wanted { stage: stage(), want: want.clone() }));
        }
    }
    let graph = Graph::new(&study, &options.wanted).ok()?;
    for (node, &place) in read.iter().enumerate().filter(|(_, place)| is_asked[**place]) {
        let before = &earlier.stages[same[place]?];
        if before.demand != start(&key::demand(&graph.demands[node]).0) {
            return None;
        }
    }
    let reads = same.iter().enumerate().map(|(place, same)| match read.binary_search(&place) {
        Ok(node) => Some(graph.reads[node].iter().map(|&other| read[other]).collect()),
        Err(_) => earlier.stages[(*same)?].reads.iter().map(|&other| now(other)).collect(),
    });
    let order = graph::order(&reads.collect::<Option<Vec<Vec<usize>>>>()?).ok()?;
    let order = order.into_iter().map(|place| blocks.stages[place].name.to_owned()).collect();
    Some(Part { study, options, note, earlier, order })
}

/// Whether what a study shows by itself is asked of the same kinds of stages as before.
fn is_shown_alike(study: &Study, earlier: &Recalled) -> bool {
    let mut now: BTreeMap<&str, usize> = BTreeMap::new();
    let kinds = study.nodes.iter().map(|node| node.kind.name).chain(study.unread.iter().map(|stage| stage.kind));
    kinds.for_each(|kind| *now.entry(kind).or_default() += 1);
    let before = earlier.count();
    let of = |counts: &BTreeMap<&str, usize>, kind: &str| counts.get(kind).copied().unwrap_or(0);
    let is_same = |kind: &&str| (of(&now, kind) <= MANY) == (of(&before, kind) <= MANY);
    let reader = study.program.pictures.reader;
    now.keys().chain(before.keys()).all(is_same) && (of(&now, reader) == 0) == (of(&before, reader) == 0)
}

impl Part {
    /// What is to be kept after a run.
    #[must_use]
    pub fn recalled(&self, graph: &Graph) -> Option<Recalled> {
        Recalled::of(&self.study, graph, Some(&self.earlier))
    }

    /// The manifest of all stages, from that of those that were run and that of the last run; none where that one does not
    /// have them.
    #[must_use]
    pub fn whole(&self, part: Manifest, earlier: &Manifest) -> Option<Manifest> {
        let by_name = |stages: &[StageRecord]| -> HashMap<String, usize> {
            stages.iter().enumerate().map(|(place, stage)| (stage.name.clone(), place)).collect()
        };
        let before = by_name(&earlier.stages);
        let mut own: HashMap<String, StageRecord> =
            part.stages.into_iter().map(|stage| (stage.name.clone(), stage)).collect();
        let stages = self.order.iter().map(|name| {
            own.remove(name).or_else(|| {
                let stage = &earlier.stages[*before.get(name)?];
                let is_complete = matches!(stage.status.as_str(), "hit" | "ran");
                is_complete.then(|| StageRecord {
                    status: "hit".to_owned(),
                    why: "unchanged".to_owned(),
                    ..stage.clone()
                })
            })
        });
        Some(Manifest { stages: stages.collect::<Option<_>>()?, ..part })
    }
}
