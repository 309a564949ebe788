//! Influences of a gear: reciprocity, the ring of sectors against the gear assembled whole.

use cholesky::{Entries, Factor, Order};

use super::super::element::{elasticity, stiffness};
use super::super::gear_model::GearModel;
use super::super::sector::NodalForces;
use super::{gear, model, standard};
use crate::gear::geometry::root::RootShape;
use crate::gear::material::Plane;
use crate::numeric::chebyshev::nodes;

/// Tier: invariant (Maxwell and Betti); what a load at u on one tooth does at v on the next one, the load at v on that
/// does at u on the first: backwards round the ring.
#[test]
fn influences_are_reciprocal() {
    let (gear, root) = gear(&standard(17, 1.4), RootShape::Trochoid);
    let model = model(&gear, &root, 6).unwrap();
    let rolls = nodes(root.form_roll, gear.tip_roll(), 5);
    let found = model.influences(&rolls, 16).unwrap().further;
    for (k, rows) in found.iter().enumerate() {
        for (by, row) in rows.iter().enumerate() {
            for (on, &there) in row.iter().enumerate() {
                // 17 − (k + 1) teeth further is k + 1 teeth back.
                let back = found[15 - k][on][by];
                assert!((there - back).abs() < 1e-13 * found[0][by][by].abs(), "{k} {by} {on}: {there} {back}");
            }
        }
    }
    // Not because they are all alike.
    assert!((found[0][0][4] / found[0][4][0] - 1.0).abs() > 1e-3);
}

/// Tier: closed form; on the line of action the further tooth's roll angle is larger by a pitch, and it stands clockwise:
/// both flanks then have one load line, a base pitch apart.
#[test]
fn further_teeth_stand_where_roll_angles_grow() {
    let (gear, root) = gear(&standard(25, 1.4), RootShape::Trochoid);
    let model = model(&gear, &root, 4).unwrap();
    let pitch = std::f64::consts::TAU / 25.0;
    let roll = 0.3;
    let (first, further) = (gear.flank(roll), gear.flank(roll + pitch));
    let (sine, cosine) = pitch.sin_cos();
    let [x, y] = [further.half_thickness, further.height];
    let clockwise = [x * cosine + y * sine, y * cosine - x * sine];
    let away = [first.half_thickness - clockwise[0], first.height - clockwise[1]];
    for (part, direction) in away.into_iter().zip(model.direction(roll)) {
        assert!((part - direction * gear.base_radius * pitch).abs() < 1e-12);
    }
}

/// Tier: second method; all sectors assembled into one matrix with Cartesian freedoms: the same displacements
/// to 1e-9. An even number of sectors has a harmonic that changes sign from each to the next.
#[test]
fn the_ring_of_sectors_is_the_gear_assembled_whole() {
    [5, 6].into_iter().for_each(assembled_whole);
}

/// Influences on the roots against the same gauges on the displacements that `solved` has of all teeth, the first one being
/// loaded: to 1e-9 of the largest. In the block around the load they are those of the rest, so the field is added.
fn stresses_of_all_teeth(
    model: &GearModel,
    rolls: &[f64],
    teeth: u32,
    solved: impl Fn(&NodalForces) -> Vec<Vec<[f64; 2]>>,
) {
    let neighbours = (teeth - 1) / 2;
    let found = model.stress_influences(rolls, neighbours).unwrap();
    let first_in_block = 2 * (model.mesh.root.len() - 1);
    for (load, &roll) in rolls.iter().enumerate() {
        let moved = solved(&model.load_without_field(roll).unwrap());
        let largest = found.stresses[neighbours as usize][load].iter().copied().fold(0.0, f64::max);
        for (at, stresses) in found.stresses.iter().enumerate() {
            // The loaded tooth is so many pitches further than the stressed one.
            let stressed = (neighbours as usize + teeth as usize - at) % teeth as usize;
            for (place, (gauge, &ours)) in found.gauges.iter().zip(&stresses[load]).enumerate() {
                if stressed == 0 && place >= first_in_block {
                    continue;
                }
                let exact = gauge.stress(|node| moved[stressed][node]);
                assert!((ours - exact).abs() < 1e-9 * largest, "{at} {place}: {ours} for {exact}");
            }
        }
    }
}

fn assembled_whole(teeth: u32) {
    let mut specification = super::shifted(teeth, 0.3, 1.6);
    specification.tip_radius = Some(0.5 * f64::from(teeth) + 0.9);
    let (gear, root) = gear(&specification, RootShape::Trochoid);
    let model = model(&gear, &root, 4).unwrap();
    let mesh = &model.mesh;
    let pitch = 2.0 * mesh.half_pitch;
    let turned = |[x, y]: [f64; 2], sector: usize| {
        let (sine, cosine) = (pitch * sector as f64).sin_cos();
        [x * cosine + y * sine, y * cosine - x * sine]
    };
    let mut places: Vec<[f64; 2]> = Vec::new();
    let mut number = vec![vec![0; mesh.nodes.len()]; teeth as usize];
    for (sector, numbers) in number.iter_mut().enumerate() {
        for (node, &place) in mesh.nodes.iter().enumerate() {
            let place = turned(place, sector);
            let known = places.iter().position(|other| (other[0] - place[0]).hypot(other[1] - place[1]) < 1e-9);
            numbers[node] = known.unwrap_or_else(|| {
                places.push(place);
                places.len() - 1
            });
        }
    }
    // Two sectors share each edge.
    assert_eq!(places.len(), teeth as usize * (mesh.nodes.len() - mesh.left.len() - 1));
    let size = 2 * places.len();
    let mut entries = Entries::default();
    let elasticity = elasticity(Plane::Strain, 0.3);
    for numbers in &number {
        for element in &mesh.elements {
            let element = element.map(|node| numbers[node]);
            let own = stiffness(&element.map(|node| places[node]), &elasticity).unwrap();
            for i in 0..16 {
                for j in 0..16 {
                    let (row, column) = (2 * element[i / 2] + i % 2, 2 * element[j / 2] + j % 2);
                    if row >= column {
                        entries.add(row, column, own[i][j]);
                    }
                }
            }
        }
        for &node in &mesh.bore {
            for freedom in [2 * numbers[node], 2 * numbers[node] + 1] {
                entries.add(freedom, freedom, 1e12);
            }
        }
    }
    // Nothing eliminated last, and column by column: only the library is the same.
    let factor = Factor::new(&entries, size, size, Order::Columns).unwrap();
    let vector = |forces: &NodalForces, sector: usize| {
        let mut column = vec![0.0; size];
        for &(node, force) in forces {
            let force = turned(force, sector);
            for axis in 0..2 {
                column[2 * number[sector][node] + axis] += force[axis];
            }
        }
        column
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let rolls = nodes(root.form_roll, gear.tip_roll(), 3);
    let found = model.influences(&rolls, teeth - 1).unwrap();
    let stresses = model.root_stresses(&rolls).unwrap();
    for (by, &roll) in rolls.iter().enumerate() {
        let mut moved = vector(&model.load(roll), 0);
        factor.solve(&mut moved);
        let own = dot(&vector(&model.probe(roll).unwrap(), 0), &moved);
        assert!((found.own[by] / own - 1.0).abs() < 1e-9, "own: {} {own}", found.own[by]);
        for sector in 1..teeth as usize {
            for (on, &other) in rolls.iter().enumerate() {
                let exact = dot(&vector(&model.load(other), sector), &moved);
                let value = found.further[sector - 1][by][on];
                assert!((value - exact).abs() < 1e-9 * own, "{sector} {by} {on}: {value} for {exact}");
            }
        }
        // The displacements of the loaded sector, as far as stresses show them.
        let displacements: Vec<[f64; 2]> =
            number[0].iter().map(|&place| [moved[2 * place], moved[2 * place + 1]]).collect();
        let surface: Vec<_> = mesh.root.iter().chain(&mesh.flank).copied().collect();
        let direct = super::super::root_stress::along_surface(mesh, &surface, &displacements, Plane::Strain, 0.3);
        for (value, exact) in stresses[by].iter().zip(&direct) {
            assert!((value.stress - exact.stress).abs() < 1e-8 * (1.0 + exact.stress.abs()));
        }
        assert!(stresses[by].len() >= 4);
    }
    stresses_of_all_teeth(&model, &rolls, teeth, |forces| {
        let mut moved = vector(forces, 0);
        factor.solve(&mut moved);
        // Each sector's displacements in its own tooth's frame.
        let of = |sector: usize, node: usize| {
            let place = number[sector][node];
            let ([x, y], (sine, cosine)) =
                ([moved[2 * place], moved[2 * place + 1]], (pitch * sector as f64).sin_cos());
            [x * cosine - y * sine, x * sine + y * cosine]
        };
        (0..teeth as usize).map(|sector| (0..mesh.nodes.len()).map(|node| of(sector, node)).collect()).collect()
    });
}
