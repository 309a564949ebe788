//! Two whole gears pressed together by CalculiX, flank on flank, at one position of the mesh.
//!
//! The gear's bore is held, the pinion's is turned as a rigid one. Frictionless, small strains, surface to surface with
//! a linear pressure over the overlap. Millimetres and newtons. Must not know: compliances.

use std::fmt::Write;

use super::program;
use super::wheel::Wheel;
use gearmesh::gear::finite_elements::mesh::{Mesh, Sizing};
use gearmesh::gear::finite_elements::outline::Outline;
use gearmesh::gear::geometry::root::RootShape;
use gearmesh::gear::geometry::{GearPair, Side};

/// Millimetres in a metre.
const MILLI: f64 = 1e3;
/// Pressure over overlap \[MPa/mm\]: as high as leaves the pressure smooth.
const PENALTY: f64 = 2e7;

/// How fine the meshes are.
#[derive(Clone, Copy, Debug)]
pub struct Fineness {
    /// Elements across a tooth that is not in contact; the body's sizes follow from it.
    pub level: usize,
    /// Edge of an element in contact \[modules\].
    pub edge: f64,
}

/// What came out.
#[derive(Debug)]
pub struct Pressed {
    /// The moment on the pinion's bore \[N m\].
    pub torque: f64,
    /// The normal force of each pair \[N\].
    pub loads: Vec<f64>,
    /// The largest pressure of each pair \[Pa\].
    pub peaks: Vec<f64>,
}

impl Pressed {
    /// By how much the overlap adds to the approach of a pair \[m\]: its energy ∫p²/2k = 2p₀² b_H/3k grows with the load
    /// as F^(3/2), by 2p₀/(πk) per load.
    pub fn overlap(&self, pair: usize) -> f64 {
        2.0 * self.peaks[pair] / (std::f64::consts::PI * PENALTY * 1e6 * MILLI)
    }
}

/// Elements across a tooth, thinner towards both flanks in a fixed proportion from the middle; the outermost have
/// `thinnest` of the thickness.
pub fn across(thinnest: f64) -> Vec<f64> {
    let (mut corners, mut width) = (vec![0.0], thinnest);
    while corners[corners.len() - 1] + 1.5 * width < 0.5 {
        corners.push(corners[corners.len() - 1] + width);
        width *= 1.6;
    }
    corners.push(0.5);
    let half: Vec<f64> = corners.windows(2).flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]).collect();
    let mirrored: Vec<f64> = half.iter().rev().map(|place| 1.0 - place).collect();
    [half, vec![0.5], mirrored].concat()
}

/// The sizes of a tooth that is fine about a roll angle.
pub fn sizing(pair: &GearPair, side: Side, s: f64, fineness: Fineness) -> Sizing {
    let gear = pair.side(side);
    let [height, half] = {
        let section = gear.flank(pair.roll(side, s));
        [section.height, section.half_thickness].map(|length| length / gear.specification.module)
    };
    let Fineness { level, edge } = fineness;
    Sizing { across: across(0.5 * edge / half), level: level as f64, focus: Some([edge, height]) }
}

/// Turns the pinion by `turn` \[rad\] with pairs in contact at the path positions `path`, a base pitch apart.
pub fn press(pair: &GearPair, path: &[f64], turn: f64, fineness: Fineness) -> Option<Pressed> {
    let material = pair.pinion.specification.material;
    let scale = pair.pinion.specification.module * MILLI;
    let width = pair.contact_width() * MILLI;
    let (mut deck, mut surfaces) = (String::new(), String::new());
    let mut offset = 0;
    let mut wheels = Vec::new();
    // Where the flanks meet, and the pinion's normal there.
    let mut met = ([0.0; 2], [0.0; 2]);
    for (side, name) in [(Side::Pinion, "PINION"), (Side::Gear, "GEAR")] {
        let gear = pair.side(side);
        let outline = Outline::new(gear, &gear.root(RootShape::Trochoid).unwrap()).unwrap();
        let coarse = Mesh::new(&outline, &Sizing::even(fineness.level)).unwrap();
        let fine: Vec<Mesh> =
            path.iter().map(|&s| Mesh::new(&outline, &sizing(pair, side, s, fineness)).unwrap()).collect();
        let teeth = gear.specification.teeth as usize;
        // Teeth further along the path follow clockwise on the pinion and anticlockwise on the gear.
        let sector = |k: usize| if side == Side::Pinion { k } else { (teeth - k) % teeth };
        let mut meshes = vec![&coarse; teeth];
        for (k, mesh) in fine.iter().enumerate() {
            meshes[sector(k)] = mesh;
        }

        let roll = pair.roll(side, path[0]);
        let section = gear.flank(roll);
        let point = [section.half_thickness, section.height].map(|x| x / gear.specification.module);
        let (sine, cosine) = gear.load_angle(roll).sin_cos();
        let (mut turned, mut shift) = (0.0, [0.0; 2]);
        if side == Side::Pinion {
            met = (point, [cosine, sine]);
        } else {
            let ([x, y], [p, q]) = met;
            turned = (-q).atan2(-p) - sine.atan2(cosine);
            let (sine, cosine) = turned.sin_cos();
            shift = [x - point[0] * cosine + point[1] * sine, y - point[0] * sine - point[1] * cosine];
            let distance = shift[0].hypot(shift[1]) * gear.specification.module;
            assert!((distance / pair.centre_distance - 1.0).abs() < 1e-12, "the flanks do not meet");
        }
        let wheel = Wheel::new(&meshes).placed(turned, shift, scale);
        deck += &wheel.cards(name, offset);
        write!(deck, "*SOLID SECTION, ELSET={name}, MATERIAL=ALL\n{width:e}\n").unwrap();
        for (k, mesh) in fine.iter().enumerate() {
            surfaces += &wheel.surface(&format!("{name}{k}"), offset, sector(k), &mesh.flank);
        }
        offset += wheel.nodes.len();
        wheels.push(wheel);
    }
    let pinion = &wheels[0];
    deck += &surfaces;
    writeln!(deck, "*MATERIAL, NAME=ALL\n*ELASTIC\n{:e}, {}", material.youngs_modulus * 1e-6, material.poisson_ratio)
        .unwrap();
    writeln!(deck, "*SURFACE INTERACTION, NAME=FLANKS\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{PENALTY:e}")
        .unwrap();
    for k in 0..path.len() {
        writeln!(deck, "*CONTACT PAIR, INTERACTION=FLANKS, TYPE=SURFACE TO SURFACE\nPINION{k}, GEAR{k}").unwrap();
    }
    deck += "*STEP, INC=100\n*STATIC\n1., 1.\n*BOUNDARY\nGEARBORE, 1, 2\n";
    for &node in &pinion.bore {
        let [x, y] = pinion.nodes[node].map(|x| x * turn);
        write!(deck, "{0}, 1, 1, {y:.12e}\n{0}, 2, 2, {1:.12e}\n", node + 1, -x).unwrap();
    }
    deck += "*NODE PRINT, NSET=PINIONBORE\nRF\n*CONTACT PRINT\nCSTR\n";
    for k in 0..path.len() {
        writeln!(deck, "*CONTACT PRINT, SLAVE=PINION{k}, MASTER=GEAR{k}\nCF").unwrap();
    }
    deck += "*END STEP\n";
    let printed = program::run("two gears in contact", &deck)?;

    let reactions = printed.table("forces (fx,fy,fz) for set PINIONBORE");
    let moment = |row: &Vec<f64>| {
        let [x, y] = pinion.nodes[row[0] as usize - 1];
        y * row[1] - x * row[2]
    };
    let pressures = printed.table("contact stress (slave element+face,press,tang1,tang2)");
    let peak = |k: usize| {
        let first = pinion.sectors[k].first as f64;
        let last = pinion.sectors[k + 1].first as f64;
        let own = pressures.iter().filter(|row| row[0] > first && row[0] <= last);
        own.map(|row| row[2] * 1e6).fold(0.0, f64::max)
    };
    Some(Pressed {
        torque: reactions.iter().map(moment).sum::<f64>() / MILLI,
        loads: (0..path.len()).map(|k| -printed.total(&format!("slave set PINION{k},"), "area,")[1]).collect(),
        peaks: (0..path.len()).map(peak).collect(),
    })
}
