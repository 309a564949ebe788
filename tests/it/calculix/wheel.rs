//! A whole gear as CalculiX gets it: one mesh per sector, joined along their radial edges, and the cards that define it.
//!
//! Must not know: cyclic symmetry, factorisations.

use std::fmt::Write;

use gearmesh::gear::finite_elements::mesh::{Edge, ElementMesh};

/// Where a sector is in the whole.
pub struct Sector {
    /// The numbers of its mesh's nodes.
    pub nodes: Vec<usize>,
    /// The number of its first element.
    pub first: usize,
}

/// Joined sectors; number k is turned clockwise by k pitches.
pub struct Wheel {
    pub nodes: Vec<[f64; 2]>,
    pub elements: Vec<[usize; 8]>,
    pub sectors: Vec<Sector>,
    pub bore: Vec<usize>,
}

/// Nodes of the radial edges, outwards from the bore: left, right.
fn edges(mesh: &ElementMesh) -> [Vec<usize>; 2] {
    let [left, right] = [mesh.bore[0], mesh.bore[mesh.bore.len() - 1]];
    [[&[left], &mesh.left[..]].concat(), [&[right], &mesh.right[..]].concat()]
}

impl Wheel {
    /// One mesh for each tooth, all with like edges.
    pub fn new(meshes: &[&ElementMesh]) -> Self {
        let mut wheel = Self { nodes: Vec::new(), elements: Vec::new(), sectors: Vec::new(), bore: Vec::new() };
        for (sector, mesh) in meshes.iter().enumerate() {
            let mut known = vec![None; mesh.nodes.len()];
            let mut share = |side: usize, other: usize| {
                let (own, others) = (&edges(mesh)[side], &edges(meshes[other])[1 - side]);
                assert_eq!(own.len(), others.len(), "sectors that do not fit");
                for (&own, &node) in own.iter().zip(others) {
                    known[own] = Some(wheel.sectors[other].nodes[node]);
                }
            };
            if sector > 0 {
                share(0, sector - 1);
                if sector + 1 == meshes.len() {
                    share(1, 0);
                }
            }
            let (sine, cosine) = (2.0 * mesh.half_pitch * sector as f64).sin_cos();
            let mut nodes = Vec::new();
            for (&[x, y], known) in mesh.nodes.iter().zip(known) {
                let point = [x * cosine + y * sine, y * cosine - x * sine];
                let number = known.unwrap_or(wheel.nodes.len());
                if number == wheel.nodes.len() {
                    wheel.nodes.push(point);
                }
                let [x, y] = wheel.nodes[number];
                assert!((x - point[0]).hypot(y - point[1]) < 1e-11, "edges that do not meet");
                nodes.push(number);
            }
            let first = wheel.elements.len();
            wheel.elements.extend(mesh.elements.iter().map(|element| element.map(|node| nodes[node])));
            wheel.bore.extend(mesh.bore.iter().map(|&node| nodes[node]));
            wheel.sectors.push(Sector { nodes, first });
        }
        wheel.bore.sort_unstable();
        wheel.bore.dedup();
        wheel
    }

    /// Turned anticlockwise, shifted, and then in another unit of length.
    pub fn placed(mut self, turn: f64, shift: [f64; 2], scale: f64) -> Self {
        let (sine, cosine) = turn.sin_cos();
        for node in &mut self.nodes {
            let [x, y] = *node;
            *node = [x * cosine - y * sine + shift[0], x * sine + y * cosine + shift[1]].map(|x| x * scale);
        }
        self
    }

    /// Nodes and elements as sets `name`, the bore as `nameBORE`. Numbers of both kinds start behind `offset`.
    pub fn cards(&self, name: &str, offset: usize) -> String {
        let mut deck = format!("*NODE, NSET={name}\n");
        for (node, [x, y]) in self.nodes.iter().enumerate() {
            // No field may be longer than 20 characters.
            writeln!(deck, "{}, {x:.12e}, {y:.12e}", offset + node + 1).unwrap();
        }
        writeln!(deck, "*ELEMENT, TYPE=CPE8, ELSET={name}").unwrap();
        for (element, nodes) in self.elements.iter().enumerate() {
            let nodes = nodes.map(|node| (offset + node + 1).to_string()).join(", ");
            writeln!(deck, "{}, {nodes}", offset + element + 1).unwrap();
        }
        writeln!(deck, "*NSET, NSET={name}BORE").unwrap();
        for node in &self.bore {
            writeln!(deck, "{}", offset + node + 1).unwrap();
        }
        deck
    }

    /// A surface `name` of edges of a sector.
    pub fn surface(&self, name: &str, offset: usize, sector: usize, edges: &[Edge]) -> String {
        let mut deck = format!("*SURFACE, NAME={name}, TYPE=ELEMENT\n");
        for edge in edges {
            let element = self.sectors[sector].first + edge.element;
            writeln!(deck, "{}, S{}", offset + element + 1, edge.side + 1).unwrap();
        }
        deck
    }
}
