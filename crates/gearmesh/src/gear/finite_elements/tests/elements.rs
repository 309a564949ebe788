//! Patch test, rigid bodies, and a thick ring against Lamé's closed form: displacement and stress.

use super::super::element::{NODES, RULE, edge_shape, elasticity, shape, stiffness, stress};
use super::super::mesh::{Edge, ElementMesh};
use super::super::root_stress::{SurfaceStress, along_surface, largest};
use super::super::sector::{NodalForces, Sector};
use super::super::wheel::Wheel;
use crate::gear::material::Plane;

/// A distorted element with curved edges.
fn distorted() -> [[f64; 2]; NODES] {
    [[0.0, 0.0], [2.0, 0.3], [2.2, 1.9], [-0.3, 1.5], [1.1, 0.05], [2.2, 1.0], [0.9, 1.8], [-0.05, 0.7]]
}

fn forces(matrix: &[[f64; 16]; 16], displacements: &[[f64; 2]; NODES]) -> Vec<f64> {
    matrix.iter().map(|row| (0..16).map(|k| row[k] * displacements[k / 2][k % 2]).sum()).collect()
}

#[test]
fn shape_functions_are_one_at_their_node_and_follow_their_derivatives() {
    let places = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
    for (node, place) in places.into_iter().enumerate() {
        for (other, value) in shape(place).0.into_iter().enumerate() {
            assert!((value - f64::from(u8::from(other == node))).abs() < 1e-15);
        }
    }
    let (at, step) = ([0.3, -0.4], 1e-6);
    for axis in 0..2 {
        let moved = |sign: f64| {
            let mut place = at;
            place[axis] += sign * step;
            shape(place).0
        };
        for node in 0..NODES {
            let rate = (moved(1.0)[node] - moved(-1.0)[node]) / (2.0 * step);
            assert!((rate - shape(at).1[node][axis]).abs() < 1e-9, "node {node}");
        }
    }
}

/// Tier: invariant; shifts and turns need no force, and nothing else is as soft.
#[test]
fn rigid_bodies_need_no_force() {
    let nodes = distorted();
    for plane in [Plane::Strain, Plane::Stress] {
        let matrix = stiffness(&nodes, &elasticity(plane, 0.3)).unwrap();
        let motions: [fn([f64; 2]) -> [f64; 2]; 3] = [|_| [1.0, 0.0], |_| [0.0, 1.0], |[x, y]| [-y, x]];
        for motion in motions {
            for force in forces(&matrix, &nodes.map(motion)) {
                assert!(force.abs() < 1e-14, "{force}");
            }
        }
        let stretch = forces(&matrix, &nodes.map(|[x, _]| [x, 0.0]));
        assert!(stretch.iter().any(|force| force.abs() > 0.1));
    }
}

/// Tier: invariant (patch test); four elements of any shape about a free node reproduce every uniform strain: the free
/// node and the middles need no force, and the stress is Hooke's everywhere.
#[test]
fn a_patch_reproduces_uniform_strain() {
    let corner = |x: usize, y: usize| {
        let bend = if (x, y) == (1, 1) { [0.17, -0.11] } else { [0.0, 0.0] };
        [x as f64 + bend[0], y as f64 + bend[1]]
    };
    let elements: Vec<[[f64; 2]; NODES]> = (0..4)
        .map(|k| {
            let (x, y) = (k % 2, k / 2);
            let c = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
            let middle = |a: [f64; 2], b: [f64; 2]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            [c[0], c[1], c[2], c[3], middle(c[0], c[1]), middle(c[1], c[2]), middle(c[2], c[3]), middle(c[3], c[0])]
        })
        .collect();
    for plane in [Plane::Strain, Plane::Stress] {
        let elasticity = elasticity(plane, 0.3);
        for [a, b, c, d] in [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.3, 0.7, 0.2, -0.4]] {
            let field = |[x, y]: [f64; 2]| [a * x + b * y, c * x + d * y];
            let mut sums: Vec<([f64; 2], [f64; 2])> = Vec::new();
            for nodes in &elements {
                let displacements = nodes.map(field);
                let found = forces(&stiffness(nodes, &elasticity).unwrap(), &displacements);
                for (k, node) in nodes.iter().enumerate() {
                    let force = [found[2 * k], found[2 * k + 1]];
                    match sums.iter_mut().find(|(place, _)| (place[0] - node[0]).hypot(place[1] - node[1]) < 1e-12) {
                        Some((_, sum)) => *sum = [sum[0] + force[0], sum[1] + force[1]],
                        None => sums.push((*node, force)),
                    }
                }
                let expected = elasticity.map(|row| row[0] * a + row[1] * d + row[2] * (b + c));
                for (value, expected) in
                    stress(nodes, &displacements, &elasticity, [0.4, -0.7]).into_iter().zip(expected)
                {
                    assert!((value - expected).abs() < 1e-13);
                }
            }
            let inner = |[x, y]: [f64; 2]| x > 1e-9 && x < 2.0 - 1e-9 && y > 1e-9 && y < 2.0 - 1e-9;
            assert_eq!(sums.iter().filter(|(place, _)| inner(*place)).count(), 5);
            for (place, force) in sums.iter().filter(|(place, _)| inner(*place)) {
                assert!(force[0].hypot(force[1]) < 1e-13, "{place:?}: {force:?}");
            }
        }
    }
}

/// A sector of a ring from 1 to 2, `count` elements deep and across.
fn ring(sectors: u32, count: usize) -> ElementMesh {
    let half_pitch = std::f64::consts::PI / f64::from(sectors);
    let (columns, mut nodes, mut numbers) = (2 * count + 1, Vec::new(), Vec::new());
    for row in 0..columns {
        for column in 0..columns {
            if row % 2 == 1 && column % 2 == 1 {
                numbers.push(usize::MAX);
                continue;
            }
            numbers.push(nodes.len());
            let radius = 1.0 + row as f64 / (columns - 1) as f64;
            let angle = half_pitch * (2.0 * column as f64 / (columns - 1) as f64 - 1.0);
            nodes.push([radius * angle.sin(), radius * angle.cos()]);
        }
    }
    let at = |column: usize, row: usize| numbers[row * columns + column];
    let mut elements = Vec::new();
    let mut root = Vec::new();
    for row in (0..columns - 1).step_by(2) {
        for column in (0..columns - 1).step_by(2) {
            if row + 3 == columns {
                let nodes = [0, 1, 2].map(|step| at(column + step, row + 2));
                root.push(Edge { element: elements.len(), side: 2, nodes });
            }
            elements.push(
                [[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1]].map(|[x, y]| at(column + x, row + y)),
            );
        }
    }
    let edge = |column: usize| (1..columns).map(|row| at(column, row)).collect();
    ElementMesh {
        bore: (0..columns).map(|column| at(column, 0)).collect(),
        left: edge(0),
        right: edge(columns - 1),
        nodes,
        elements,
        flank: Vec::new(),
        root,
        centreline: Vec::new(),
        first_of_tooth: 0,
        body_row: [0; 2],
        half_pitch,
    }
}

/// Tier: closed form, order of convergence; a thick ring clamped inside under a uniform shear and a uniform pull along
/// its rim (Lamé): u_θ = r(1/r_i² − 1/r²)/(2G)·τ r_o², u_r = A r + B/r. Both converge with about the third order.
#[test]
fn a_thick_ring_follows_lame() {
    let (nu, sectors) = (0.3_f64, 7);
    let mut errors: Vec<[f64; 3]> = Vec::new();
    for count in [2, 4, 8] {
        let mesh = ring(sectors, count);
        let sector = Sector::new(&mesh, &elasticity(Plane::Strain, nu)).unwrap();
        // Consistent loads of a traction of 1 on the exact arc; the corners' act at the edges, in radial and clockwise parts.
        let load = |clockwise: bool| -> (NodalForces, [Vec<f64>; 2]) {
            let mut inside = Vec::new();
            let mut edges = [vec![0.0; 2 * mesh.left.len()], vec![0.0; 2 * mesh.left.len()]];
            for edge in &mesh.root {
                let [from, _, to] = edge.nodes.map(|node| mesh.nodes[node][0].atan2(mesh.nodes[node][1]));
                for (s, weight) in RULE {
                    let (sine, cosine) = (0.5 * (from + to) + 0.5 * s * (to - from)).sin_cos();
                    let traction = if clockwise { [cosine, -sine] } else { [sine, cosine] };
                    for (node, share) in edge.nodes.into_iter().zip(edge_shape(s)) {
                        let force = traction.map(|t| t * share * weight * (to - from));
                        let side = [&mesh.left, &mesh.right].into_iter().position(|edge| edge.contains(&node));
                        let Some(side) = side else {
                            inside.push((node, force));
                            continue;
                        };
                        let (sine, cosine) = mesh.nodes[node][0].atan2(mesh.nodes[node][1]).sin_cos();
                        let last = edges[side].len();
                        edges[side][last - 2] += force[0] * sine + force[1] * cosine;
                        edges[side][last - 1] += force[0] * cosine - force[1] * sine;
                    }
                }
            }
            (inside, edges)
        };
        let stiffness = sector.stiffness();
        let wheel = Wheel { sectors, stiffness: &stiffness };
        let moved = |clockwise: bool| {
            let (inside, edges) = load(clockwise);
            let response = sector.responses(&[inside]).remove(0);
            // Every sector is loaded, so all edges move as those of one sector under the harmonic 0.
            let mut pressed = response.pressed.clone();
            for (all, own) in pressed.iter_mut().zip(&edges) {
                for (all, own) in all.iter_mut().zip(own) {
                    *all += own;
                }
            }
            let steps: Vec<u32> = (0..sectors).collect();
            let edge = pressed[0].len();
            let units: Vec<[Vec<f64>; 2]> = (0..edge)
                .map(|place| {
                    let mut unit = [vec![0.0; edge], vec![0.0; edge]];
                    unit[0][place] = 1.0;
                    unit
                })
                .collect();
            let found = wheel.influences(&units.iter().collect::<Vec<_>>(), &[&pressed], &steps).unwrap();
            let one: Vec<f64> = (0..edge).map(|place| found.iter().map(|matrix| matrix[place][0]).sum()).collect();
            sector.displacements(&response, &[one.clone(), one].concat())
        };
        let middle = mesh.root[count / 2].nodes[0];
        let shear = 1.0 / (2.0 * (1.0 + nu));
        let turned = moved(true)[middle][0] / (2.0 * (1.0 - 0.25) * 4.0 / (2.0 * shear)) - 1.0;
        // u_r = A(r − 1/r); σ_r = 2G/(1 − 2ν)·[(1 − ν) u′ + ν u/r] = 1 at the rim.
        let factor = 2.0 * shear / (1.0 - 2.0 * nu);
        let constant = 1.0 / (factor * ((1.0 - nu) * 1.25 + nu * 0.75));
        let pulled = moved(false);
        let radial = pulled[middle][1] / (constant * 1.5) - 1.0;
        let hoop = factor * constant * (nu * 1.25 + (1.0 - nu) * 0.75);
        // The surface is not free here: σ_θ = E/(1 − ν²) ε_θ + ν/(1 − ν) σ_r.
        let points = along_surface(&mesh, &mesh.root, &pulled, Plane::Strain, nu);
        let stress =
            points.iter().map(|point| ((point.stress + nu / (1.0 - nu)) / hoop - 1.0).abs()).fold(0.0, f64::max);
        errors.push([turned.abs(), radial.abs(), stress]);
    }
    for pair in errors.windows(2) {
        let order = [0, 1, 2].map(|k| (pair[0][k] / pair[1][k]).log2());
        assert!(order[0] > 2.8 && order[1] > 2.8 && order[2] > 2.5, "{order:?}");
    }
    assert!(errors[2].iter().all(|error| *error < 1e-3));
}

/// Tier: closed form; Hooke's law in space, with no stress along the width or no strain.
#[test]
fn both_planes_are_hooke_s_law() {
    let (nu, stresses) = (0.3, [3.0, -2.0, 0.7]);
    let [x, y, shear] = stresses;
    for (plane, z) in [(Plane::Stress, 0.0), (Plane::Strain, nu * (x + y))] {
        let strain = [x - nu * (y + z), y - nu * (x + z), 2.0 * (1.0 + nu) * shear];
        for (row, stress) in elasticity(plane, nu).iter().zip(stresses) {
            let found: f64 = row.iter().zip(strain).map(|(d, strain)| d * strain).sum();
            assert!((found - stress).abs() < 1e-14, "{plane:?}: {found} for {stress}");
        }
    }
}

/// Tier: closed form; on a straight line the length from its start is the place, whatever divides it, and the points are
/// those of Gauss: (1 ± 1/√3)/2 of an edge whose middle node is in the middle.
#[test]
fn the_length_along_a_straight_surface_is_the_place_on_it() {
    let mut mesh = ring(7, 2);
    mesh.nodes = [0.0, 0.4, 1.0, 2.1, 3.0, 3.5, 4.0].map(|x| [0.6 * x, 0.8 * x]).to_vec();
    let edges = [0, 2, 4].map(|first| Edge { element: 0, side: 0, nodes: [first, first + 1, first + 2] });
    // Stretched by a thousandth.
    let moved: Vec<[f64; 2]> = mesh.nodes.iter().map(|node| node.map(|x| 1e-3 * x)).collect();
    let points = along_surface(&mesh, &edges, &moved, Plane::Strain, 0.3);
    for point in &points {
        let [x, y] = point.place;
        assert!((point.length - x.hypot(y)).abs() < 1e-14, "{point:?}");
        assert!((point.stress - 1e-3 / 0.91).abs() < 1e-16, "{point:?}");
    }
    for (point, sign) in points[4..].iter().zip([-1.0, 1.0]) {
        assert!((point.length - 3.0 - 0.5 * (1.0 + sign / 3_f64.sqrt())).abs() < 1e-14, "{point:?}");
    }
}

/// Tier: closed form; the top of a parabola over the length, and its radius, which is one too.
#[test]
fn the_largest_stress_is_the_top_of_a_parabola() {
    let point = |length: f64| SurfaceStress {
        place: [0.0, 20.0 + 0.3 * length + 0.1 * length * length],
        along: [1.0, 0.0],
        length,
        stress: 5.0 - 2.0 * (length - 0.9).powi(2),
    };
    for lengths in [[0.0, 0.7, 1.2, 1.4], [0.1, 0.5, 0.8, 2.0]] {
        let (stress, radius) = largest(&lengths.map(point)).unwrap();
        assert!((stress - 5.0).abs() < 1e-14 && (radius - 20.351).abs() < 1e-13, "{stress} at {radius}");
    }
}
