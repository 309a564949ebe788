//! A load less its own field: the field against Hooke and balance, the rest against closed forms of discs and strips.

use std::f64::consts::PI;

use cholesky::{Entries, Factor, Order};

use super::super::element::{NODES, elasticity, stiffness};
use super::super::point_load::{Block, HalfPlane};
use crate::gear::material::{Material, Plane};
use crate::numeric::quadrature::GaussLegendre;

const STEEL: Material = Material { youngs_modulus: 206e9, poisson_ratio: 0.3 };

/// A body that is its own mirror image, below whose upper half lies the axis y = 0.
struct Half {
    nodes: Vec<[f64; 2]>,
    elements: Vec<[usize; NODES]>,
}

impl Half {
    /// Of blocks of elements, each from a map of the unit square and counts along and across.
    fn new(blocks: &[(&dyn Fn(f64, f64) -> [f64; 2], [usize; 2])]) -> Self {
        let (mut nodes, mut elements): (Vec<[f64; 2]>, Vec<[usize; NODES]>) = (Vec::new(), Vec::new());
        let mut known = std::collections::BTreeMap::new();
        for (map, [along, across]) in blocks {
            for i in 0..*along {
                for j in 0..*across {
                    let places = [[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1]];
                    elements.push(places.map(|[x, y]| {
                        let u = (2 * i + x) as f64 / (2 * along) as f64;
                        let v = (2 * j + y) as f64 / (2 * across) as f64;
                        let place = map(u, v);
                        let key = place.map(|x| (x * 1e8 + 0.3).round() as i64);
                        *known.entry(key).or_insert_with(|| {
                            nodes.push(place);
                            nodes.len() - 1
                        })
                    }));
                }
            }
        }
        Self { nodes, elements }
    }

    /// The rest at the load in the middle of the top, against the axis. The block is all elements that do not touch the
    /// axis.
    fn rest(&self, top: f64, plane: Plane) -> f64 {
        let elasticity = elasticity(plane, STEEL.poisson_ratio);
        let is_low = |element: &[usize; NODES]| element.iter().any(|&node| self.nodes[node][1].abs() < 1e-9);
        let members: Vec<usize> = (0..self.elements.len()).filter(|&k| !is_low(&self.elements[k])).collect();
        let block = Block::new(&self.nodes, &self.elements, &members, &elasticity).unwrap();
        let field = HalfPlane::new([0.0, top], [0.0, -1.0], &STEEL, plane);
        let taken = block.take(&self.nodes, &field);
        let mut numbers = Vec::new();
        let mut count = 0;
        for [x, y] in &self.nodes {
            let free = [!(x.abs() < 1e-9 && y.abs() < 1e-9), y.abs() > 1e-9];
            numbers.push(free.map(|free| {
                free.then(|| {
                    count += 1;
                    count - 1
                })
            }));
        }
        let mut entries = Entries::default();
        for element in &self.elements {
            let matrix = stiffness(&element.map(|node| self.nodes[node]), &elasticity).unwrap();
            let place = |k: usize| numbers[element[k / 2]][k % 2];
            for (row, values) in matrix.iter().enumerate() {
                for (column, value) in values.iter().enumerate() {
                    if let (Some(row), Some(column)) = (place(row), place(column)) {
                        if row >= column {
                            entries.add(row, column, *value);
                        }
                    }
                }
            }
        }
        let factor = Factor::new(&entries, count, count, Order::Blocks).unwrap();
        let mut forces = vec![0.0; count];
        for (node, force) in &taken.forces {
            for (number, value) in numbers[*node].iter().zip(force) {
                if let Some(number) = number {
                    forces[*number] += value;
                }
            }
        }
        let mut moved = forces.clone();
        factor.solve(&mut moved);
        taken.own + forces.iter().zip(&moved).map(|(force, moved)| force * moved).sum::<f64>()
    }
}

fn scale(plane: Plane) -> f64 {
    STEEL.plane_compliance(plane) * STEEL.youngs_modulus
}

/// Half a disc of radius 1: a square in the middle, and three rings of elements around it.
fn disc(count: usize) -> Half {
    let h = 0.45;
    let blend = |[x, y]: [f64; 2], angle: f64, part: f64| [x + part * (angle.cos() - x), y + part * (angle.sin() - y)];
    let (square, right, top, left) = (
        |u: f64, v: f64| [h * (2.0 * u - 1.0), h * v],
        |u: f64, v: f64| blend([h, h * v], 0.25 * PI * v, u),
        |u: f64, v: f64| blend([h * (1.0 - 2.0 * v), h], 0.25 * PI * (1.0 + 2.0 * v), u),
        |u: f64, v: f64| blend([-h, h * (1.0 - v)], 0.25 * PI * (3.0 + v), u),
    );
    Half::new(&[
        (&square, [2 * count, count]),
        (&right, [count, count]),
        (&top, [count, 2 * count]),
        (&left, [count, count]),
    ])
}

/// Tier: closed form; a disc between two loads comes nearer to its middle by (ln 2 − 1) 2/(π E′) more than a half plane
/// at the depth 1 (Johnson, Contact Mechanics, 5.6), in either plane state; the order of convergence.
#[test]
fn a_disc_between_two_loads() {
    for plane in [Plane::Strain, Plane::Stress] {
        let exact = 2.0 * (2_f64.ln() - 1.0) / PI * scale(plane);
        let errors = [4, 8, 16].map(|count| disc(count).rest(1.0, plane) - exact);
        println!("{plane:?} {errors:?} of {exact}");
        assert!(errors[2].abs() < 1e-4 * exact.abs());
        for pair in errors.windows(2) {
            assert!((pair[0] / pair[1]).abs().log2() > 3.5, "{errors:?}");
        }
    }
}

/// Tier: closed form; a strip of half the thickness h, pressed from both sides: R = (ln h + C) 2/(π E′) with
/// C = ∫ (K − 1 + e⁻ᵗ)/t dt from 0 to ∞, K = 2 sinh² t/(sinh 2t + 2t). What a law needs that takes a tooth for a half
/// plane down to its middle: Weber's has −(1 + ν′)/2.
#[test]
fn a_strip_between_two_loads() {
    let kernel = |t: f64| 2.0 * t.sinh().powi(2) / ((2.0 * t).sinh() + 2.0 * t) - 1.0 + (-t).exp();
    let rule = GaussLegendre::new(40);
    let pieces = [0.0, 0.5, 2.0, 6.0, 14.0, 40.0];
    let constant: f64 = pieces.windows(2).map(|ends| rule.integrate(ends[0], ends[1], |t| [kernel(t) / t])[0]).sum();
    assert!((constant + 0.351_68).abs() < 5e-6, "{constant}");
    for (plane, h) in [(Plane::Strain, 1.0), (Plane::Stress, 0.5)] {
        let exact = 2.0 / PI * scale(plane) * (f64::ln(h) + constant);
        let strip = |count: usize| Half::new(&[(&|u, v| [6.0 * h * (2.0 * u - 1.0), h * v], [12 * count, count])]);
        let errors = [2, 4, 8].map(|count| strip(count).rest(h, plane) - exact);
        println!("{plane:?} {errors:?} of {exact}");
        assert!(errors[2].abs() < 1e-4 * exact.abs(), "{errors:?} of {exact}");
    }
}

#[test]
fn explore() {
    use crate::gear::contact::wedge;
    for (teeth, shift) in [(12, 0.5), (48, 0.0), (1000, 0.0)] {
        let (gear, root) = super::gear(&super::shifted(teeth, shift, 1.4), super::RootShape::Trochoid);
        let tip = gear.tip_roll();
        let at = |c: f64| (tip * tip - 2.0 * c / gear.base_radius).sqrt();
        let rolls =
            [root.form_roll + 0.3 * (tip - root.form_roll), 0.5 * (root.form_roll + tip), at(0.1), at(0.01), at(0.003)];
        let b = wedge::softening(std::f64::consts::FRAC_PI_2 + tip.atan());
        println!("z {teeth}: B E' = {b}");
        for across in [4, 8, 12, 16, 24, 32] {
            for fine in [1.0, 4.0, 16.0, 64.0] {
                let mut sizing = super::super::mesh::Sizing::even(across);
                let tip = gear.flank(tip);
                if fine > 1.0 {
                    sizing.focus = Some([2.4 * tip.half_thickness / across as f64 / fine, tip.height]);
                }
                let model = super::super::gear_model::GearModel::new(&gear, &root, Plane::Strain, &sizing).unwrap();
                let found: Vec<Vec<f64>> =
                    [0, 1, 2].iter().map(|&rows| model.rests(&rolls, 1, rows).unwrap().own).collect();
                println!(
                    "{across}: {:.6?} S {:.1e} {:.1e}",
                    found[0],
                    (0..5).map(|k| (found[0][k] - found[1][k]).abs()).fold(0.0, f64::max),
                    (0..5).map(|k| (found[0][k] - found[2][k]).abs()).fold(0.0, f64::max)
                );
            }
        }
    }
}
