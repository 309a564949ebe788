//! What the benches measure on: the study `energy_ga`, its stages run one by one, its pair and its design `ga`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use declare::seed::Seed;
use declare::work::Tally;
use gearmesh::gear::compliance::energy::Energy;
use gearmesh::gear::compliance::{Assumptions, ContactLaw, Method, PairCompliance};
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::geometry::root::RootShape;
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::gear::modification::{self, Design};
use gearstudy::program;
use gearstudy::stage::{Context, Demand, Inputs, designs, pair};
use studygraph::study::{Node, Study};
use studygraph::table::data::Table;

/// \[N m\], the load of the article's Table 2.
pub const TORQUE: f64 = 50.0;

/// Where the study lies.
pub fn path() -> PathBuf {
    study_path("energy_ga")
}

pub fn study_path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("studies").join(name).with_extension("yaml")
}

/// The study, and the tables of the stages that were run.
pub struct Stages {
    study: Study,
    tables: BTreeMap<String, Vec<Table>>,
}

impl Stages {
    pub fn new() -> Self {
        Self::of("energy_ga")
    }

    /// The stages of another study.
    pub fn of(name: &str) -> Self {
        Self::at(&study_path(name))
    }

    pub fn at(path: &Path) -> Self {
        let study = program::load(path).unwrap_or_else(|error| panic!("{error}"));
        Self { study, tables: BTreeMap::new() }
    }

    fn node(&self, name: &str) -> &Node {
        self.study.nodes.iter().find(|node| node.name == name).unwrap_or_else(|| panic!("no stage `{name}`"))
    }

    /// Runs what a stage reads, not the stage.
    pub fn prepare(&mut self, name: &str) {
        let needed: Vec<String> = self.node(name).stage.inputs().into_iter().map(|port| port.stage).collect();
        for stage in needed {
            if !self.tables.contains_key(&stage) {
                self.prepare(&stage);
                let tables = self.run(&stage);
                self.tables.insert(stage, tables);
            }
        }
    }

    /// Runs a stage alone, on what [`Self::prepare`] left.
    pub fn run(&self, name: &str) -> Vec<Table> {
        let node = self.node(name);
        let mut inputs = Inputs::default();
        for port in node.stage.inputs() {
            let stage = match port.through {
                None => port.stage,
                Some(through) => {
                    let ports = self.node(&port.stage).stage.inputs();
                    ports.into_iter().find(|port| port.name == through).map(|port| port.stage).unwrap_or_default()
                }
            };
            inputs.ports.insert(port.name, self.tables[&stage].iter().collect());
        }
        let schemas = node.stage.outputs();
        let tables =
            schemas.iter().filter(|schema| !schema.on_demand).map(|schema| (schema.name.clone(), <_>::default()));
        let demand = Demand { tables: tables.collect() };
        let context = Context {
            seed: Seed::of_stage(self.study.seed, name),
            demand: &demand,
            stop: &AtomicBool::new(false),
            progress: &|_| {},
            warn: &|_| {},
            is_heard: true,
            work: &Tally::default(),
        };
        node.stage.run(&context, &inputs).unwrap_or_else(|error| panic!("{name}: {error:?}"))
    }

    /// The article's pair.
    pub fn pair(&mut self) -> GearPair {
        self.prepare("stiffness");
        let tables = &self.tables["pair"];
        let table = |name: &str| tables.iter().find(|table| table.name() == name).expect("the stage gives it");
        pair::read(table("gears"), table("pair")).expect("it was just written")
    }

    /// A design of the stage `designs`.
    pub fn design(&mut self, name: &str) -> Design {
        let pair = self.pair();
        self.prepare("ste");
        let tables = &self.tables["designs"];
        let table = |name: &str| tables.iter().find(|table| table.name() == name).expect("the stage gives it");
        let designs = designs::read(table("designs"), table("elements"), modification::members());
        let designs = designs.expect("it was just written");
        let named = designs.iter().find(|design| design.name == name).expect("the study has it");
        named.built(&pair).expect("it fits the pair")
    }
}

/// What the study's `stiffness` and `stiffness_coupled` say, with either contact law.
pub fn assumptions(contact: ContactLaw, coupled: bool) -> Assumptions {
    Assumptions { root: RootShape::CircularFillet, contact, coupled, torque: None, accuracy: None }
}

/// The energy method on a pair.
pub fn compliance(pair: &GearPair, assumptions: Assumptions) -> PairCompliance {
    Energy::default().tabulate(pair, assumptions).expect("the study runs with it").compliance
}

/// 64 positions, 33 slices.
pub fn cycle(pair: &GearPair, contact: ContactLaw, coupled: bool) -> Mesh {
    cycle_of(pair, contact, coupled, Settings::default())
}

pub fn cycle_of(pair: &GearPair, contact: ContactLaw, coupled: bool, settings: Settings) -> Mesh {
    let compliance = compliance(pair, assumptions(contact, coupled));
    Mesh::new(pair, &compliance, settings).expect("its contact ratio is 1.65")
}
