//! A load less its own field: the field against Hooke and balance, the rest against closed forms of discs and strips.

use std::f64::consts::PI;

use cholesky::{Entries, Factor, Order};

use super::super::element::{NODES, elasticity, stiffness};
use super::super::gear_model::GearModel;
use super::super::mesh::{Focus, Sizing};
use super::super::point_load::{Block, HalfPlane};
use crate::gear::contact::wedge;
use crate::gear::geometry::Gear;
use crate::gear::geometry::outline::tip::Tip;
use crate::gear::geometry::root::RootShape;
use crate::gear::material::{Material, Plane};
use crate::numeric::quadrature::GaussLegendre;

const STEEL: Material = Material::STEEL;

/// A map of the unit square, and how many elements it has along and across.
type Patch<'a> = (&'a dyn Fn(f64, f64) -> [f64; 2], [usize; 2]);

/// A body that is its own mirror image, below whose upper half lies the axis y = 0.
struct Half {
    nodes: Vec<[f64; 2]>,
    elements: Vec<[usize; NODES]>,
}

impl Half {
    /// Of blocks of elements, each from a map of the unit square and counts along and across.
    fn new(blocks: &[Patch]) -> Self {
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
                        #[allow(clippy::cast_possible_truncation)] // places are of the order of 1
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
        self.rest_of(&STEEL, top, plane)
    }

    fn rest_of(&self, material: &Material, top: f64, plane: Plane) -> f64 {
        let elasticity = elasticity(plane, material.poisson_ratio);
        let is_low = |element: &[usize; NODES]| element.iter().any(|&node| self.nodes[node][1].abs() < 1e-9);
        let members: Vec<usize> = (0..self.elements.len()).filter(|&k| !is_low(&self.elements[k])).collect();
        let block = Block::new(&self.nodes, &self.elements, &members, &elasticity).unwrap();
        let field = HalfPlane::new([0.0, top], [0.0, -1.0], material, plane);
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
                    if let (Some(row), Some(column)) = (place(row), place(column))
                        && row >= column
                    {
                        entries.add(row, column, *value);
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
        assert!(errors[2].abs() < 5e-8 * exact.abs());
        for pair in errors.windows(2) {
            assert!((pair[0] / pair[1]).abs().log2() > 4.0, "{errors:?}");
        }
    }
}

/// Tier: closed form; the same disc nearly incompressible in plane strain: elements do not lock, they converge
/// as they do otherwise.
#[test]
fn a_disc_that_is_nearly_incompressible() {
    for poisson_ratio in [0.45, 0.49] {
        let material = Material { poisson_ratio, ..STEEL };
        let exact = 2.0 * (2_f64.ln() - 1.0) / PI * (1.0 - poisson_ratio * poisson_ratio);
        let errors = [4, 8, 16].map(|count| disc(count).rest_of(&material, 1.0, Plane::Strain) - exact);
        assert!(errors[2].abs() < 1e-6 * exact.abs(), "{poisson_ratio}: {errors:?} of {exact}");
        assert!((errors[0] / errors[2]).abs().log2() > 5.0, "{poisson_ratio}: {errors:?}");
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
        assert!(errors[2].abs() < 6e-6 * exact.abs(), "{errors:?} of {exact}");
        assert!((errors[1] / errors[2]).abs().log2() > 4.5, "{errors:?}");
    }
}

/// The loads of a gear: at three tenths of the flank, in its middle, and a tenth of a module from the corner of its tip.
fn rests(teeth: u32, shift: f64, across: usize, rows: usize) -> Vec<f64> {
    let (gear, root) = super::gear(&super::shifted(teeth, shift, 1.4), RootShape::Trochoid);
    let (form, tip) = (root.form_roll, gear.tip_roll());
    let near = (tip * tip - 0.2 / gear.base_radius).sqrt();
    let rolls = [form + 0.3 * (tip - form), 0.5 * (form + tip), near];
    super::model(&gear, &root, across).unwrap().rests(&rolls, 0, rows).unwrap().own
}

/// Tier: invariant; the rest at the load is the same whichever elements are in the block: the tooth, or rows of the body with
/// it.
#[test]
fn the_rest_does_not_depend_on_the_block() {
    for (teeth, shift) in [(12, 0.5), (17, 0.0), (48, 0.0), (200, 0.0)] {
        let [alone, one, two] = [0, 1, 2].map(|rows| rests(teeth, shift, 16, rows));
        for (a, (b, c)) in alone.iter().zip(one.iter().zip(&two)) {
            assert!((b - a).abs() < 5e-6 && (c - a).abs() < 5e-6, "z {teeth}: {a} {b} {c}");
        }
    }
}

/// Tier: order of convergence; nested meshes, 16, 32 and 64 across, against what 64 and 96 tend to. An energy of quadratic
/// elements has the fourth order, which is neared from below; what two of them tend to has more. Every mesh is too stiff.
#[test]
fn the_rest_converges() {
    for (teeth, shift, tip) in
        [(12, 0.5, Tip::Land), (17, 0.0, Tip::Land), (48, 0.0, Tip::Land), (30, 0.0, Tip::Chamfer(0.2))]
    {
        let (gear, root) = super::gear(&super::shifted(teeth, shift, 1.4), RootShape::Trochoid);
        let gear = gear.with_tip(tip).unwrap();
        let end = gear.flank_end.roll;
        // Three and five tenths of the flank, and 0.3 and 0.1 modules from its end.
        let near = |c: f64| (end * end - 2.0 * c / gear.base_radius).sqrt();
        let share = |share: f64| root.form_roll + share * (end - root.form_roll);
        let rolls = [share(0.3), share(0.5), near(0.3), near(0.1)];
        let flank = gear.flank(end);
        let at = |parts: usize| {
            let sizing = Sizing::nested(4 * parts, parts, [flank.half_thickness, flank.height]);
            GearModel::new(&gear, &root, Plane::Strain, &sizing).unwrap().rests(&rolls, 0, 0).unwrap().own
        };
        let found = [2, 4, 8, 16, 24].map(at);
        let limit = |fine: usize, ratio: f64| -> Vec<f64> {
            let change = ratio.powi(4) - 1.0;
            found[fine].iter().zip(&found[fine - 1]).map(|(fine, coarse)| fine + (fine - coarse) / change).collect()
        };
        let exact = limit(4, 1.5);
        let errors = |rests: &[f64]| -> Vec<f64> { rests.iter().zip(&exact).map(|(a, b)| a - b).collect() };
        let plain = [1, 2, 3].map(|k| errors(&found[k]));
        assert!(plain.iter().flatten().all(|error| *error < 0.0), "z {teeth}, {tip:?}: {plain:?}");
        let largest = |errors: &[f64]| errors.iter().fold(0.0_f64, |largest, error| largest.max(error.abs()));
        let orders = |errors: [f64; 3]| [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()];
        let [first, then] = orders(plain.map(|errors| largest(&errors)));
        assert!((3.5..4.1).contains(&first) && (3.8..4.1).contains(&then), "z {teeth}, {tip:?}: {first} {then}");
        let limits = [1, 2, 3].map(|k| largest(&errors(&limit(k, 2.0))));
        let [first, then] = orders(limits);
        assert!(first > 3.8 && then > 4.3 && first + then > 8.2, "z {teeth}, {tip:?}: {first} {then}");
        assert!(limits[0] < 1.2e-4 && limits[2] < 2e-7, "z {teeth}, {tip:?}: {limits:?}");
    }
}

/// Tier: second method; what a load does to the teeth beside it is no matter of the field that is taken off: as by loads that
/// are spread to the nodes.
#[test]
fn neighbours_are_those_of_plain_loads() {
    let (gear, root) = super::gear(&super::shifted(23, 0.1, 1.4), RootShape::Trochoid);
    let rolls = [0.3, 0.6, 0.9].map(|share| root.form_roll + share * (gear.tip_roll() - root.form_roll));
    let model = super::model(&gear, &root, 16).unwrap();
    let (taken, plain) = (model.rests(&rolls, 2, 0).unwrap(), model.influences(&rolls, 2).unwrap());
    for (taken, plain) in taken.further.iter().flatten().flatten().zip(plain.further.iter().flatten().flatten()) {
        assert!((taken - plain).abs() < 1e-4, "{taken} {plain}");
    }
}

/// Tier: closed form; towards the corner of a graded tip the rest grows by −B for each factor e of the distance, and the
/// nearer the more exactly.
#[test]
fn the_rest_grows_towards_the_corner_as_a_wedge() {
    for (teeth, tip) in [(30, Tip::Land), (200, Tip::Land), (30, Tip::Chamfer(0.3))] {
        let (gear, root) = super::gear(&super::standard(teeth, 1.4), RootShape::Trochoid);
        let gear = gear.with_tip(tip).unwrap();
        let tip = gear.flank_end.roll;
        let flank = gear.flank(tip);
        // Elements as small as a thousandth of a module, both ways.
        let half: Vec<f64> = (0..=20).map(|k| 0.5 * (f64::from(k) / 20.0).powi(3)).collect();
        let across: Vec<f64> = half.iter().copied().chain(half.iter().rev().skip(1).map(|part| 1.0 - part)).collect();
        let middles: Vec<f64> =
            across.windows(2).flat_map(|ends| [ends[0], 0.5 * (ends[0] + ends[1])]).chain([1.0]).collect();
        let focus = Focus { height: flank.height, size: 1e-3, growth: 0.3 };
        let sizing = Sizing { across: middles, focus: Some(focus), ..Sizing::even(24) };
        let model = GearModel::new(&gear, &root, Plane::Strain, &sizing).unwrap();
        let rolls = [0.05, 0.025, 0.0125, 0.00625, 0.003_125].map(|c| (tip * tip - 2.0 * c / gear.base_radius).sqrt());
        let found = model.rests(&rolls, 0, 0).unwrap().own;
        let exact = scale(Plane::Strain) * wedge::softening(gear.flank_end.interior_angle);
        let errors: Vec<f64> = found.windows(2).map(|two| (two[1] - two[0]) / std::f64::consts::LN_2 - exact).collect();
        // What is left falls with the distance, so that twice the nearer less the farther has none of it.
        for two in errors.windows(2) {
            assert!((1.9..2.1).contains(&(two[0] / two[1])), "z {teeth}: {errors:?}");
        }
        assert!((2.0 * errors[3] - errors[2]).abs() < 6e-4, "z {teeth}: {errors:?} of {exact}");
    }
}

/// A gear with a tip, meshed; and the roll angles at distances from the end of its flank \[modules\].
fn with_tip(teeth: u32, tip: Tip, across: usize, distances: &[f64]) -> (Gear, Vec<f64>, Vec<f64>) {
    let (gear, root) = super::gear(&super::standard(teeth, 1.4), RootShape::Trochoid);
    let gear = gear.with_tip(tip).unwrap();
    let end = gear.flank_end.roll;
    let rolls: Vec<f64> = distances.iter().map(|c| (end * end - 2.0 * c / gear.base_radius).sqrt()).collect();
    let height = gear.flank(end).height;
    let fine = 1.0 / 16.0 * Sizing::along(gear.flank(end).half_thickness, across);
    let sizing = Sizing { focus: Some(Focus { height, size: fine, growth: 0.3 }), ..Sizing::even(across) };
    let model = GearModel::new(&gear, &root, Plane::Strain, &sizing).unwrap();
    let found = model.rests(&rolls, 0, 0).unwrap().own;
    (gear, rolls, found)
}

const TIPS: [Tip; 4] = [Tip::Chamfer(0.05), Tip::Chamfer(0.2), Tip::Rounding(0.1), Tip::Rounding(0.3)];

/// Tier: order of convergence; broken tips too, with loads from the middle of the flank to where it ends.
#[test]
fn the_rest_converges_with_broken_tips() {
    for tip in TIPS {
        let rests = [8, 16, 32, 64].map(|across| with_tip(30, tip, across, &[1.0, 0.3, 0.1, 0.03]).2);
        let errors: Vec<Vec<f64>> = rests[..3]
            .iter()
            .map(|rest| rest.iter().zip(&rests[3]).map(|(rest, fine)| rest - fine).collect())
            .collect();
        for pair in errors.windows(2) {
            for (coarse, fine) in pair[0].iter().zip(&pair[1]) {
                assert!(*coarse < 0.0 && (coarse / fine).log2() > 3.5, "{tip:?}: {errors:?}");
            }
        }
    }
}

/// Tier: invariant; a body from which material is taken away is softer (minimum of the potential energy), the more so the
/// nearer to it the load is.
#[test]
fn the_more_is_taken_off_a_tip_the_softer_it_is() {
    for tip in TIPS {
        let (_, rolls, found) = with_tip(30, tip, 32, &[1.0, 0.3, 0.1, 0.03]);
        let (gear, root) = super::gear(&super::standard(30, 1.4), RootShape::Trochoid);
        let sharp = super::model(&gear, &root, 32).unwrap().rests(&rolls, 0, 0).unwrap().own;
        let softer: Vec<f64> = found.iter().zip(&sharp).map(|(found, sharp)| found - sharp).collect();
        assert!(softer[0] > 0.0 && softer.windows(2).all(|two| two[1] > two[0]), "{tip:?}: {softer:?}");
    }
}
