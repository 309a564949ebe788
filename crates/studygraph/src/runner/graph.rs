//! Who reads what from whom: resolved ports, order, demand. The only file that names petgraph.
//!
//! Demand is that of the whole study plus what the user asks for, also when only some stages are run: otherwise
//! `--only` would change keys. Must not know: the cache, states.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

use petgraph::algo::tarjan_scc;
use petgraph::graph::{DiGraph, NodeIndex};
use petgraph::visit::DfsPostOrder;

use super::options::Wanted;
use crate::stage::{Ahead, Demand, Kind, Omission, Port, Stage, Want};
use crate::store::bundle::MANY;
use crate::study::{Node, Study};
use crate::table::schema::Schema;
use declare::digest::{Digest, Writer};
use declare::error::{Diagnostic, suggest};

/// A port with its source found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    pub port: String,
    /// The node the tables come from, after following `through`.
    pub node: usize,
    pub wants: Vec<Want>,
}

/// The graph of a study; nodes are counted as in the study.
#[derive(Debug)]
pub struct Graph {
    /// Every node after all it reads; otherwise as in the study.
    pub order: Vec<usize>,
    pub inputs: Vec<Vec<Input>>,
    /// The nodes that read from each node, ascending.
    pub readers: Vec<Vec<usize>>,
    /// Nodes of which no more is asked than of all that can give the same share it.
    pub demands: Vec<Arc<Demand>>,
    pub outputs: Vec<Arc<[Schema]>>,
    /// What is asked of each node, of what it can give; nodes of which the same is asked share it.
    pub demanded: Vec<Demanded>,
    /// The digest of the code that each node depends on.
    pub codes: Vec<Digest>,
}

/// What a node can give.
type Outputs = Arc<[Schema]>;
/// What of it is asked.
pub type Demanded = Arc<[Arc<Schema>]>;

/// The nodes of a study by their names.
struct Names<'a> {
    study: &'a Study,
    nodes: HashMap<&'a str, usize>,
}

impl Names<'_> {
    fn find(&self, name: &str) -> Result<usize, Diagnostic> {
        self.nodes.get(name).copied().map_or_else(|| find(self.study, name), Ok)
    }
}

impl Graph {
    /// # Errors
    /// A port whose stage, table or column does not exist; a cycle.
    pub fn new(study: &Study, wanted: &[Wanted]) -> Result<Self, Diagnostic> {
        let nodes = study.nodes.iter().enumerate().map(|(index, node)| (node.name.as_str(), index)).collect();
        let names = Names { study, nodes };
        let ports: Vec<Vec<Port>> = study.nodes.iter().map(|node| node.stage.inputs()).collect();
        let mut inputs = Vec::new();
        for (node, of_node) in study.nodes.iter().zip(&ports) {
            let resolved = of_node.iter().map(|port| {
                let source = source(&names, &ports, node, port, 0)?;
                Ok(Input { port: port.name.clone(), node: source, wants: port.wants.clone() })
            });
            inputs.push(resolved.collect::<Result<Vec<_>, Diagnostic>>().map_err(|error| error.or_at(node.place))?);
        }
        let order = order(&inputs).map_err(|members| cycle(study, &inputs, &members))?;
        let outputs = outputs(study);
        let demands = demand(&names, wanted, (&order, &ports, &outputs), &mut inputs)?;
        let mut readers = vec![Vec::new(); study.nodes.len()];
        for (reader, of_reader) in inputs.iter().enumerate() {
            for input in of_reader {
                if readers[input.node].last() != Some(&reader) {
                    readers[input.node].push(reader);
                }
            }
        }
        let (demanded, codes) = (demanded(&outputs, &demands), codes(study));
        Ok(Self { order, inputs, readers, demands, outputs, demanded, codes })
    }

    /// Which nodes are needed for these.
    ///
    /// # Errors
    /// A name that is not a stage.
    pub fn needed(&self, study: &Study, only: &[String]) -> Result<Vec<bool>, Diagnostic> {
        let mut needed = vec![only.is_empty(); study.nodes.len()];
        for name in only {
            needed[find(study, name)?] = true;
        }
        for &node in self.order.iter().rev() {
            if needed[node] {
                self.inputs[node].iter().for_each(|input| needed[input.node] = true);
            }
        }
        Ok(needed)
    }

    /// Tables and columns on demand of a node that nobody asks for.
    #[must_use]
    pub fn unasked(&self, node: usize, stage: &dyn Stage) -> Vec<Omission> {
        let demand = &self.demands[node];
        let why = "no stage reads it and nobody asked for it";
        let mut omissions = Vec::new();
        for schema in self.outputs[node].iter() {
            if !demand.table(&schema.name) {
                let omission = Omission::new(format!("table `{}`", schema.name), why);
                omissions.push(omission.saving(stage.saved(demand, &schema.name, None)));
                continue;
            }
            let columns = schema.columns.iter();
            for column in columns.filter(|column| column.on_demand && !demand.column(&schema.name, &column.name)) {
                let omission = Omission::new(format!("column `{}.{}`", schema.name, column.name), why);
                omissions.push(omission.saving(stage.saved(demand, &schema.name, Some(&column.name))));
            }
        }
        omissions
    }
}

/// The node called `name`.
///
/// # Errors
/// The nearest known name.
pub fn find(study: &Study, name: &str) -> Result<usize, Diagnostic> {
    study.nodes.iter().position(|node| node.name == name).ok_or_else(|| {
        let known = study.nodes.iter().map(|node| node.name.as_str());
        Diagnostic::new(format!("there is no stage `{name}`")).help(suggest(name, known))
    })
}

/// What each node can give; nodes of one kind that can give the same share it.
fn outputs(study: &Study) -> Vec<Arc<[Schema]>> {
    let mut last: HashMap<&str, Arc<[Schema]>> = HashMap::new();
    let of_node = |node: &Node| {
        if let Some(known) = last.get(node.kind.name).filter(|_| node.stage.gives_what_its_kind_does()) {
            return Arc::clone(known);
        }
        let own = node.stage.outputs();
        let known = last.entry(node.kind.name).or_insert_with(|| own.as_slice().into());
        if **known != *own {
            *known = own.into();
        }
        Arc::clone(known)
    };
    study.nodes.iter().map(of_node).collect()
}

/// The demanded tables with the demanded columns.
fn demanded(outputs: &[Arc<[Schema]>], demands: &[Arc<Demand>]) -> Vec<Demanded> {
    // What can be given and what is asked, last of all nodes that can give the same.
    let mut last: HashMap<*const Schema, (&Demand, Demanded)> = HashMap::new();
    let of_node = |(outputs, demand): (&Arc<[Schema]>, &Demand)| {
        outputs
            .iter()
            .filter(|schema| demand.table(&schema.name))
            .map(|schema| Arc::new(demand.narrowed(schema.clone())))
            .collect::<Arc<[_]>>()
    };
    let mut all = Vec::with_capacity(outputs.len());
    for (outputs, demand) in outputs.iter().zip(demands.iter().map(Arc::as_ref)) {
        let known = last.get(&outputs.as_ptr()).filter(|(asked, _)| *asked == demand);
        let own = known.map_or_else(|| of_node((outputs, demand)), |(_, own)| Arc::clone(own));
        last.insert(outputs.as_ptr(), (demand, Arc::clone(&own)));
        all.push(own);
    }
    all
}

/// Follows `through`, port by port.
fn source(names: &Names, ports: &[Vec<Port>], node: &Node, port: &Port, depth: usize) -> Result<usize, Diagnostic> {
    let study = names.study;
    let index = names.find(&port.stage).map_err(|error| error.or_at(node.place))?;
    let Some(through) = port.through else { return Ok(index) };
    let via = &study.nodes[index];
    if depth > study.nodes.len() {
        let message = format!("stage `{}` reads through `{}`, which leads back to itself", node.name, via.name);
        return Err(Diagnostic::new(message).at(node.place));
    }
    let Some(next) = ports[index].iter().find(|candidate| candidate.name == through) else {
        let known = ports[index].iter().map(|port| port.name.as_str());
        let message = format!(
            "stage `{}` needs what `{}` reads as `{through}`, but `{}` reads no such thing",
            node.name, via.name, via.name
        );
        return Err(Diagnostic::new(message).at(node.place).help(suggest(through, known)));
    };
    source(names, ports, via, next, depth + 1)
}

/// What is asked of each node by the user, by nodes that read it, and by what a study shows that says nothing of it. Inputs that nothing asked of their reader needs are
/// taken out.
fn demand(
    names: &Names,
    wanted: &[Wanted],
    (order, ports, outputs): (&[usize], &[Vec<Port>], &[Outputs]),
    inputs: &mut [Vec<Input>],
) -> Result<Vec<Arc<Demand>>, Diagnostic> {
    let study = names.study;
    let mut usual: HashMap<*const Schema, Arc<Demand>> = HashMap::new();
    let of_all = |outputs: &Outputs| {
        let always = outputs.iter().filter(|schema| !schema.on_demand);
        Arc::new(Demand { tables: always.map(|schema| (schema.name.clone(), BTreeSet::new())).collect() })
    };
    let usual = |outputs: &Outputs| Arc::clone(usual.entry(outputs.as_ptr()).or_insert_with(|| of_all(outputs)));
    let mut demands: Vec<Arc<Demand>> = outputs.iter().map(usual).collect();
    for Wanted { stage, want } in wanted {
        let index = names.find(stage)?;
        add(&mut demands[index], &study.nodes[index], &outputs[index], want)?;
    }
    let pictures = study.program.pictures;
    if study.nodes.iter().all(|node| node.kind.name != pictures.reader) {
        let mut stages: HashMap<&str, usize> = HashMap::new();
        study.nodes.iter().for_each(|node| *stages.entry(node.kind.name).or_default() += 1);
        // Nobody looks at thousands of figures; drawing them took forty times what all else did.
        let drawn = study.nodes.iter().enumerate().filter(|(_, node)| stages[node.kind.name] <= MANY);
        for (index, node) in drawn {
            // One gear alone has no mesh to draw; and what nobody asked for must not make a run long.
            let is_there = |table: &&&str| outputs[index].iter().any(|schema| schema.name == **table);
            let pictured = pictures.tables.iter().filter(|(kind, _)| *kind == node.kind.name);
            let shown = pictured.filter_map(|(_, tables)| tables.iter().find(is_there).copied());
            for table in shown.filter(|table| rows_of(node, table) <= MOST_PICTURED) {
                Arc::make_mut(&mut demands[index]).tables.entry(table.to_owned()).or_default();
            }
        }
    }
    // All that is asked of a reader is known before what it reads itself.
    for &reader in order.iter().rev() {
        let node = &study.nodes[reader];
        let wanted: Vec<&Port> = ports[reader].iter().filter(|port| port.is_wanted(&demands[reader])).collect();
        inputs[reader].retain(|input| wanted.iter().any(|port| port.name == input.port));
        for (port, input) in wanted.into_iter().zip(&inputs[reader]) {
            for want in &input.wants {
                let added = add(&mut demands[input.node], &study.nodes[input.node], &outputs[input.node], want);
                added.map_err(|error| {
                    let message = match port.only_for {
                        [] => error.message.clone(),
                        _ => format!("what is asked of `{}` cannot be computed: {}", node.name, error.message),
                    };
                    Diagnostic { message, ..error }.or_at(node.place)
                })?;
            }
        }
    }
    Ok(demands)
}

/// Rows of a picture: a drawing has no use for more.
const MOST_PICTURED: u64 = 20_000;

/// How many rows a table will have, as far as its stage knows by itself.
fn rows_of(node: &Node, table: &str) -> u64 {
    let alone = Demand { tables: [(table.to_owned(), BTreeSet::new())].into() };
    let foreseen = node.stage.estimate(&alone, &Ahead::default()).tables;
    foreseen.iter().filter(|(name, _)| name == table).map(|(_, rows)| rows.count).sum()
}

fn add(demand: &mut Arc<Demand>, node: &Node, outputs: &[Schema], want: &Want) -> Result<(), Diagnostic> {
    let Some(schema) = outputs.iter().find(|schema| schema.name == want.table) else {
        let known = outputs.iter().map(|schema| schema.name.as_str());
        let message = format!("stage `{}` ({}) has no table `{}`", node.name, node.kind.name, want.table);
        let help = node.stage.lacks(&want.table).map_or_else(|| suggest(&want.table, known), str::to_owned);
        return Err(Diagnostic::new(message).help(help));
    };
    if !demand.table(&want.table) {
        Arc::make_mut(demand).tables.insert(want.table.clone(), BTreeSet::new());
    }
    for name in &want.columns {
        let Some(column) = schema.column(name) else {
            let message = format!("table `{}.{}` has no column `{name}`", node.name, want.table);
            let known = schema.columns.iter().map(|column| column.name.as_str());
            return Err(Diagnostic::new(message).help(suggest(name, known)));
        };
        // The others come in any case: naming them must not change a key.
        if column.on_demand && !demand.column(&want.table, name) {
            let tables = &mut Arc::make_mut(demand).tables;
            tables.entry(want.table.clone()).or_default().insert(name.clone());
        }
    }
    Ok(())
}

/// Nodes after all that they read, otherwise as they stand.
///
/// # Errors
/// The members of a circle.
fn order(inputs: &[Vec<Input>]) -> Result<Vec<usize>, Vec<usize>> {
    let mut graph = DiGraph::<(), ()>::new();
    let nodes: Vec<NodeIndex> = inputs.iter().map(|_| graph.add_node(())).collect();
    for (reader, of_reader) in inputs.iter().enumerate() {
        for input in of_reader {
            graph.update_edge(nodes[reader], nodes[input.node], ());
        }
    }
    let circular = |component: &Vec<NodeIndex>| component.len() > 1 || graph.contains_edge(component[0], component[0]);
    if let Some(component) = tarjan_scc(&graph).into_iter().find(circular) {
        return Err(component.iter().map(|node| node.index()).collect());
    }
    let mut order = Vec::new();
    let mut visit = DfsPostOrder::empty(&graph);
    for node in nodes {
        visit.move_to(node);
        while let Some(next) = visit.next(&graph) {
            order.push(next.index());
        }
    }
    Ok(order)
}

/// Names a way round: from the first stage in the study, always to the first input that leads on.
fn cycle(study: &Study, inputs: &[Vec<Input>], members: &[usize]) -> Diagnostic {
    let mut path: Vec<usize> = members.iter().min().copied().into_iter().collect();
    let start = loop {
        let last = path[path.len() - 1];
        let next = inputs[last].iter().map(|input| input.node).find(|next| members.contains(next)).unwrap_or(last);
        if let Some(start) = path.iter().position(|&seen| seen == next) {
            break start;
        }
        path.push(next);
    };
    let round = &path[start..];
    let name = |position: usize| format!("`{}`", study.nodes[round[position % round.len()]].name);
    let steps: Vec<String> = (0..round.len()).map(|at| format!("{} reads {}", name(at), name(at + 1))).collect();
    let place = study.nodes[round[0]].place;
    Diagnostic::new(format!("stages read each other in a circle: {}", steps.join(", "))).at(place)
}

/// The digest of the code that each stage depends on: that of its kind, and of the kinds of which it runs variants.
fn codes(study: &Study) -> Vec<Digest> {
    let program = study.program;
    let mut known: BTreeMap<(&str, BTreeSet<&str>), Digest> = BTreeMap::new();
    let of_node = |node: &Node| {
        let nested = node.record.kinds();
        *known.entry((node.kind.name, nested)).or_insert_with_key(|(kind, nested)| {
            let text = nested.iter().fold((program.code_of)(kind), |all, nested| {
                let version = program.kind(nested).map_or(0, |kind| kind.version);
                format!("{all} {nested} {version} {}", (program.code_of)(nested))
            });
            code(node.kind, &text)
        })
    };
    study.nodes.iter().map(of_node).collect()
}

/// The digest of a kind whose sources have this one.
#[must_use]
pub fn code(kind: &Kind, sources: &str) -> Digest {
    Writer::new("gearstudy 1 kind").text(kind.name).integer(kind.version.into()).text(sources).finish()
}
