//! One loaded tooth of a whole gear: displacements and stresses, same elements, same load.

use std::fmt::Write;

use super::press::constants;
use super::program;
use super::wheel::Wheel;
use super::{displacements, model, specification, work};
use gearmesh::gear::finite_elements::element::{self, RULE};
use gearmesh::gear::finite_elements::mesh::{Edge, Sizing};
use gearmesh::gear::geometry::Gear;
use gearmesh::gear::material::Plane;

const TEETH: u32 = 17;

fn compare(plane: Plane) {
    let gear = Gear::new(&specification(TEETH, 0.0, 1.0, 1.0)).unwrap();
    let model = model(&gear, plane, &Sizing::even(6));
    let rolls = [8.0023, 8.5, 9.2].map(|radius| gear.roll_at(radius));
    let loaded = 1;

    let wheel = Wheel::new(&[&model.mesh; TEETH as usize]);
    let nu = 0.3;
    let (modulus, poisson) = constants(gear.specification.material, plane);
    let mut deck = wheel.cards("GEAR", 0);
    write!(deck, "*MATERIAL, NAME=ALL\n*ELASTIC\n{modulus:.12e}, {poisson:.12e}\n").unwrap();
    deck += "*SOLID SECTION, ELSET=GEAR, MATERIAL=ALL\n1.\n*STEP\n*STATIC\n*BOUNDARY\nGEARBORE, 1, 2\n*CLOAD\n";
    for (node, [x, y]) in model.load(rolls[loaded]) {
        write!(deck, "{0}, 1, {x:.12e}\n{0}, 2, {y:.12e}\n", wheel.sectors[0].nodes[node] + 1).unwrap();
    }
    deck += "*NODE PRINT, NSET=GEAR\nU\n*EL PRINT, ELSET=GEAR\nS\n*END STEP\n";
    let Some(printed) = program::run("one loaded tooth", &deck) else { return };

    let table = printed.table("displacements (vx,vy,vz) for set GEAR");
    let moved: Vec<[f64; 2]> = table.iter().map(|row| [row[1], row[2]]).collect();
    assert_eq!(moved.len(), wheel.nodes.len());
    let on = |sector: usize| {
        let (sine, cosine) = (std::f64::consts::TAU / f64::from(TEETH) * sector as f64).sin_cos();
        let (moved, numbers) = (&moved, &wheel.sectors[sector].nodes);
        move |node: usize| {
            let [x, y] = moved[numbers[node]];
            [x * cosine - y * sine, x * sine + y * cosine]
        }
    };

    let ours = model.influences(&rolls, 2).unwrap();
    let near = |ours: f64, theirs: f64| assert!((ours / theirs - 1.0).abs() < 1e-6, "{plane:?}: {ours}, {theirs}");
    near(ours.own[loaded], work(&model.probe(rolls[loaded]).unwrap(), on(0)));
    for (place, &roll) in rolls.iter().enumerate() {
        for (step, further) in ours.further.iter().enumerate() {
            let ahead = step + 1;
            near(further[loaded][place], work(&model.load(roll), on(ahead)));
            // Behind, by reciprocity.
            near(further[place][loaded], work(&model.load(roll), on(TEETH as usize - ahead)));
        }
    }

    // Stresses at all Gauss points of the loaded sector; of the printed 27 the first 9 are those of one layer.
    let field = displacements(&model, TEETH, model.load(rolls[loaded]));
    let constants = element::elasticity(plane, nu);
    let stresses = printed.table("stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set GEAR");
    let (mut largest, mut error) = (0.0_f64, 0.0_f64);
    for (index, nodes) in model.mesh.elements.iter().enumerate() {
        let moved = nodes.map(|node| field[node]);
        for point in 0..9 {
            let at = [RULE[point % 3].0, RULE[point / 3].0];
            let ours = element::stress(&model.mesh.corners(index), &moved, &constants, at);
            let row = &stresses[27 * index + point];
            assert_eq!(row[..2], [index as f64 + 1.0, point as f64 + 1.0]);
            for (ours, theirs) in ours.into_iter().zip([row[2], row[3], row[5]]) {
                largest = largest.max(theirs.abs());
                error = error.max((ours - theirs).abs());
            }
        }
    }
    assert!(error < 1e-6 * largest, "{plane:?}: {error} of {largest}");

    // Along the root: ours from the strain of the surface, theirs from the Gauss points extrapolated to it.
    let ratio = if plane == Plane::Strain { nu / (1.0 - nu) } else { nu };
    let along = &model.root_stresses(&[rolls[loaded]]).unwrap()[0];
    let surface: Vec<&Edge> = model.mesh.root.iter().chain(&model.mesh.flank).collect();
    let theirs = along.iter().enumerate().map(|(index, point)| {
        let edge = surface[index / 2];
        let s = (if index % 2 == 0 { -1.0 } else { 1.0 }) / 3_f64.sqrt();
        on_surface(&stresses, edge, s, point.along, ratio)
    });
    let largest = along.iter().map(|point| point.stress).fold(0.0, f64::max);
    let error = along.iter().zip(theirs).map(|(point, theirs)| (point.stress - theirs).abs()).fold(0.0, f64::max);
    assert!(error < 5e-3 * largest, "{plane:?}: {error} of {largest}");
}

/// The stress along the surface at a place s of an edge of the first sector, from those printed at the Gauss points of its
/// element, extrapolated to it. What is left of a stress across the free surface shrinks with the mesh; ours leaves it out, so
/// `ratio` of it, ν′, is taken off.
pub fn on_surface(stresses: &[Vec<f64>], edge: &Edge, s: f64, along: [f64; 2], ratio: f64) -> f64 {
    // The root lies on the body's third sides, from their ends, and on the tooth's second ones.
    let at = if edge.side == 2 { [-s, 1.0] } else { [1.0, s] };
    let [mut xx, mut yy, mut xy] = [0.0; 3];
    for gauss in 0..9 {
        let weight = lagrange(gauss % 3, at[0]) * lagrange(gauss / 3, at[1]);
        let row = &stresses[27 * edge.element + gauss];
        (xx, yy, xy) = (xx + weight * row[2], yy + weight * row[3], xy + weight * row[5]);
    }
    let [x, y] = along;
    let (along, across) = (x * x * xx + y * y * yy + 2.0 * x * y * xy, y * y * xx + x * x * yy - 2.0 * x * y * xy);
    along - ratio * across
}

/// The polynomial that is 1 at one Gauss point and 0 at the other two.
fn lagrange(point: usize, at: f64) -> f64 {
    let others = (0..3).filter(|&other| other != point);
    others.map(|other| (at - RULE[other].0) / (RULE[point].0 - RULE[other].0)).product()
}

#[test]
fn a_tooth_in_plane_strain() {
    compare(Plane::Strain);
}

#[test]
fn a_tooth_in_plane_stress() {
    compare(Plane::Stress);
}
