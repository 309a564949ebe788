//! A tooth loaded on a part of its face: a solid of the plane mesh drawn out, against the layers of `slice_coupling`.
//!
//! Three teeth on their share of the body, held at the bore and at the outer radial edges; the face ends freely. Loads and
//! displacements are those of the plane tables: along the load line, on the flank and on the centreline.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::program;
use super::{model, specification};
use gearmesh::gear::compliance::ToothCompliance;
use gearmesh::gear::compliance::across_face::Layers;
use gearmesh::gear::finite_elements::element::{RULE, shape};
use gearmesh::gear::finite_elements::gear_model::GearModel;
use gearmesh::gear::finite_elements::mesh::{ElementMesh, Sizing};
use gearmesh::gear::geometry::{Gear, Specification};
use gearmesh::gear::material::Plane;
use gearmesh::numeric::chebyshev::Series;

const TEETH: u32 = 17;
/// Face width \[modules\].
const WIDTH: f64 = 8.0;
const SLICES: usize = 16;

/// Plane nodes and elements of three sectors; those of the middle one come first.
struct Plate {
    nodes: Vec<[f64; 2]>,
    elements: Vec<[usize; 8]>,
    held: Vec<usize>,
}

impl Plate {
    fn new(mesh: &ElementMesh) -> Self {
        let mut plate = Self { nodes: Vec::new(), elements: Vec::new(), held: Vec::new() };
        let mut known = BTreeMap::new();
        for turns in [0.0, 1.0, -1.0] {
            let (sine, cosine) = (2.0 * mesh.half_pitch * turns).sin_cos();
            let mut number = |&[x, y]: &[f64; 2]| {
                let point = [x * cosine + y * sine, y * cosine - x * sine];
                let key = point.map(|x| (x * 1e7).round() as i64);
                *known.entry(key).or_insert_with(|| {
                    plate.nodes.push(point);
                    plate.nodes.len() - 1
                })
            };
            let numbers: Vec<usize> = mesh.nodes.iter().map(&mut number).collect();
            plate.elements.extend(mesh.elements.iter().map(|element| element.map(|node| numbers[node])));
            // Clockwise is to the right.
            let edge: &[usize] = if turns > 0.0 {
                &mesh.right
            } else if turns < 0.0 {
                &mesh.left
            } else {
                &[]
            };
            plate.held.extend(mesh.bore.iter().chain(edge).map(|&node| numbers[node]));
        }
        plate.held.sort_unstable();
        plate.held.dedup();
        plate
    }

    /// The number of a node of a layer; those between layers stand behind all others.
    fn node(&self, node: usize, layer: usize) -> usize {
        layer * self.nodes.len() + node + 1
    }

    fn between(&self, node: usize, layer: usize) -> usize {
        (SLICES + 1 + layer) * self.nodes.len() + node + 1
    }

    fn deck(&self, load: &BTreeMap<usize, [f64; 2]>, watched: &[usize]) -> String {
        let mut deck = String::from("*NODE, NSET=ALL\n");
        let step = WIDTH / SLICES as f64;
        let mut corners: Vec<usize> = self.elements.iter().flat_map(|element| element[..4].to_vec()).collect();
        corners.sort_unstable();
        corners.dedup();
        for layer in 0..=SLICES {
            for (node, [x, y]) in self.nodes.iter().enumerate() {
                writeln!(deck, "{}, {x:.12e}, {y:.12e}, {:.12e}", self.node(node, layer), layer as f64 * step).unwrap();
            }
        }
        for layer in 0..SLICES {
            for &node in &corners {
                let [x, y] = self.nodes[node];
                let z = (layer as f64 + 0.5) * step;
                writeln!(deck, "{}, {x:.12e}, {y:.12e}, {z:.12e}", self.between(node, layer)).unwrap();
            }
        }
        deck += "*ELEMENT, TYPE=C3D20, ELSET=ALL\n";
        for layer in 0..SLICES {
            for (index, element) in self.elements.iter().enumerate() {
                let mut numbers = vec![layer * self.elements.len() + index + 1];
                numbers.extend(element[..4].iter().map(|&node| self.node(node, layer)));
                numbers.extend(element[..4].iter().map(|&node| self.node(node, layer + 1)));
                numbers.extend(element[4..].iter().map(|&node| self.node(node, layer)));
                numbers.extend(element[4..].iter().map(|&node| self.node(node, layer + 1)));
                numbers.extend(element[..4].iter().map(|&node| self.between(node, layer)));
                let words: Vec<String> = numbers.iter().map(usize::to_string).collect();
                writeln!(deck, "{},\n{}", words[..11].join(", "), words[11..].join(", ")).unwrap();
            }
        }
        deck += "*NSET, NSET=HELD\n";
        for &node in &self.held {
            for layer in 0..=SLICES {
                writeln!(deck, "{}", self.node(node, layer)).unwrap();
            }
            if corners.binary_search(&node).is_ok() {
                for layer in 0..SLICES {
                    writeln!(deck, "{}", self.between(node, layer)).unwrap();
                }
            }
        }
        deck += "*NSET, NSET=WATCHED\n";
        for layer in 0..=SLICES {
            for &node in watched {
                writeln!(deck, "{}", self.node(node, layer)).unwrap();
            }
        }
        deck += "*MATERIAL, NAME=ALL\n*ELASTIC\n1., 0.3\n*SOLID SECTION, ELSET=ALL, MATERIAL=ALL\n";
        deck += "*STEP\n*STATIC\n*BOUNDARY\nHELD, 1, 3\n*CLOAD\n";
        for (node, [x, y]) in load {
            writeln!(deck, "{node}, 1, {x:.12e}\n{node}, 2, {y:.12e}").unwrap();
        }
        deck + "*NODE PRINT, NSET=WATCHED\nU\n*END STEP\n"
    }

    /// A load of 1 at a flank point, spread evenly over some slices: on each a line over a face of eight nodes.
    fn load(&self, model: &GearModel, roll: f64, slices: std::ops::Range<usize>) -> BTreeMap<usize, [f64; 2]> {
        let line = model.load(roll);
        let [x, y] = model.direction(roll);
        // The place on the edge from the shares of its ends: they differ by s.
        let along = |node: usize| {
            let [fx, fy] = line[node].1;
            fx * x + fy * y
        };
        let place = along(2) - along(0);
        let edge: Vec<usize> = line.iter().map(|(node, _)| *node).collect();
        let mut forces: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        let share = 1.0 / slices.len() as f64;
        for layer in slices {
            // Corners counter-clockwise: along the edge, then along the face.
            let nodes = [
                self.node(edge[0], layer),
                self.node(edge[2], layer),
                self.node(edge[2], layer + 1),
                self.node(edge[0], layer + 1),
                self.node(edge[1], layer),
                self.between(edge[2], layer),
                self.node(edge[1], layer + 1),
                self.between(edge[0], layer),
            ];
            for (at, weight) in RULE {
                for (node, value) in nodes.iter().zip(shape([place, at]).0) {
                    let force = forces.entry(*node).or_default();
                    force[0] += 0.5 * weight * share * value * x;
                    force[1] += 0.5 * weight * share * value * y;
                }
            }
        }
        forces
    }
}

/// The layer's deflection at `z` by a load spread over `from..to`, over that by the same load on the whole face: the integral
/// of its Green's function.
fn layer(length: f64, z: f64, from: f64, to: f64) -> f64 {
    let sinh = |x: f64| (x / length).sinh();
    let cosh = |x: f64| (x / length).cosh();
    let below = |end: f64| sinh(end.min(z)) * cosh(WIDTH - z);
    let above = |end: f64| -sinh(WIDTH - end.max(z)) * cosh(z);
    WIDTH * (below(to) - below(from) + above(to) - above(from)) / ((to - from) * sinh(WIDTH))
}

fn compare(height: f64, bounds: [f64; 4]) {
    let gear = Gear::new(&Specification { face_width: WIDTH, ..specification(TEETH, 0.0, 1.0, 1.0) }).unwrap();
    let model = model(&gear, Plane::Strain, &Sizing::even(4));
    let roll = gear.roll_at(0.5 * f64::from(TEETH) + height);
    let plate = Plate::new(&model.mesh);
    let probe = model.probe(roll).unwrap();
    let watched: Vec<usize> = probe.iter().map(|(node, _)| *node).collect();
    let solve = |slices: std::ops::Range<usize>| {
        let printed =
            program::run("a load on a part of the face", &plate.deck(&plate.load(&model, roll, slices), &watched))?;
        let rows: BTreeMap<usize, [f64; 2]> = (printed.table("displacements (vx,vy,vz) for set WATCHED").iter())
            .map(|row| (row[0] as usize, [row[1], row[2]]))
            .collect();
        let at = |layer: usize| -> f64 {
            let part = |&(node, [x, y]): &(usize, [f64; 2])| {
                let [u, v] = rows[&plate.node(node, layer)];
                x * u + y * v
            };
            probe.iter().map(part).sum()
        };
        Some((0..=SLICES).map(at).collect::<Vec<f64>>())
    };
    let Some(even) = solve(0..SLICES) else { return };
    let [middle, end] = [7..9, 0..2].map(|slices| solve(slices).unwrap());
    let mean = |values: &[f64]| (values.iter().sum::<f64>() - 0.5 * (values[0] + values[SLICES])) / SLICES as f64;
    // The plane tables know the whole gear; the solid's own compliance under an even load takes its place.
    let compliance = mean(&even);
    let plane = model.influences(&[roll], 0).unwrap().own[0] / WIDTH;
    let constant = |value: f64| Series::from_values(gear.form_roll, gear.tip_roll(), &[value]);
    let tooth = ToothCompliance {
        bending: constant(0.0),
        shear: constant(0.0),
        axial: constant(0.0),
        body: constant(plane),
        contact_depth: constant(0.0),
        corner: 0.0,
        inclined: None,
        neighbours: Vec::new(),
    };
    let layers = Layers::new(&gear, &tooth, WIDTH);
    let length = layers.length(roll, plane - layers.wind_up);
    let ours = |z: f64, from: f64, to: f64| {
        ((plane - layers.wind_up) * layer(length, z, from, to)
            + layers.wind_up * layer(layers.wind_up_length, z, from, to))
            / plane
    };
    println!(
        "z {TEETH}, r = {height:+}: even {compliance:.4} for {plane:.4}, ends {:.4}, l = {length:.3}",
        even[0] / compliance
    );
    let mut errors = Vec::new();
    for (name, found, from, to) in [("middle", &middle, 3.5, 4.5), ("end", &end, 0.0, 1.0)] {
        let largest = found.iter().copied().fold(0.0, f64::max) / compliance;
        let (mut near, mut far) = (0.0_f64, 0.0_f64);
        for (index, value) in found.iter().enumerate() {
            let z = index as f64 * WIDTH / SLICES as f64;
            let (theirs, ours) = (value / compliance, ours(z, from, to));
            print!(" {z:.1}: {theirs:.3} {ours:.3};");
            let error = (ours - theirs).abs() / largest;
            if z > from - 0.1 && z < to + 0.1 { near = near.max(error) } else { far = far.max(error) }
        }
        println!("\n{name}: {near:.3} where it is loaded, {far:.3} elsewhere");
        errors.extend([near, far]);
    }
    for (error, bound) in errors.into_iter().zip(bounds) {
        assert!(error < bound, "{height}: {error} of {bound}");
    }
}

#[test]
fn a_load_on_a_part_of_the_face_at_the_pitch_circle() {
    compare(0.1, [0.06, 0.13, 0.20, 0.04]);
}

#[test]
fn a_load_on_a_part_of_the_face_near_the_tip() {
    compare(0.7, [0.03, 0.11, 0.18, 0.04]);
}
