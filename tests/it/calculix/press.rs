//! Two whole gears pressed together by CalculiX, flank on flank, at one position of the mesh.
//!
//! The gear's bore is held, the pinion's is turned as a rigid one. Frictionless, small strains, surface to surface with
//! a linear pressure over the overlap. Millimetres and newtons. Must not know: compliances.
//!
//! CalculiX looks for contact where the flanks have moved to, but forces turn the gears where they were: moments,
//! normals and gaps are off by the turn. A [`Case::share`] of turn and gaps leaves as much of that, and the contact as
//! it is.

use std::collections::BTreeSet;
use std::fmt::Write;

use serde::{Deserialize, Serialize};

use super::flanks::{Flanks, Nearest, take_off};
use super::wheel::Wheel;
use super::{program, recorded};
use gearmesh::gear::finite_elements::mesh::{Edge, ElementMesh, Focus, Sizing};
use gearmesh::gear::finite_elements::outline::Outline;
use gearmesh::gear::finite_elements::root_stress::{along_surface, largest};
use gearmesh::gear::geometry::root::RootShape;
use gearmesh::gear::geometry::{Gear, GearPair, Side, Specification};
use gearmesh::gear::material::Material;
use gearmesh::gear::material::Plane;
use gearmesh::gear::modification::Design;

/// Millimetres in a metre.
const MILLI: f64 = 1e3;
/// Pressure over overlap \[MPa/mm\] where the half width is some tenths of a millimetre: as high as leaves it smooth.
pub const PENALTY: f64 = 2e7;

/// How fine the meshes are.
#[derive(Clone, Copy, Debug)]
pub struct Fineness {
    /// Elements across a tooth that is not in contact; the body's sizes follow from it.
    pub level: usize,
    /// Edge of an element in contact \[modules\].
    pub edge: f64,
    /// Pressure over overlap \[MPa/mm\]. Over a length of E over this a pressure cannot change much.
    pub penalty: f64,
}

/// What is pressed together, and how far.
#[derive(Clone, Copy)]
pub struct Case<'a> {
    pub pair: &'a GearPair,
    /// What is taken off the flanks in contact.
    pub design: &'a Design,
    /// Path positions of the pairs that may touch, a base pitch apart. Other pairs pass through each other.
    pub path: &'a [f64],
    /// The turn of the pinion along its base circle \[m\], from where unmodified flanks would touch.
    pub approach: f64,
    pub plane: Plane,
    /// Whose flanks carry the points at which pressure is computed, along the normals of the other's: that with the
    /// corner or the relief.
    pub slave: Side,
    /// The part of turn and gaps that is there; all results are those of the whole. At 1 the flanks are as they are, at
    /// 0 would be the limit of small displacements.
    pub share: f64,
}

impl<'a> Case<'a> {
    /// How the deck calls the flanks of slave and master.
    fn contact_sets(&self) -> [&'static str; 2] {
        if self.slave == Side::Pinion { ["PINION", "GEAR"] } else { ["GEAR", "PINION"] }
    }

    /// The flanks of pair `k`.
    pub fn flanks(&self, k: usize) -> Flanks<'a> {
        Flanks { pair: self.pair, design: self.design, s: self.path[k], of: self.slave }
    }

    /// What one flank of pair `k` loses at a roll angle \[m\]. The slave also gets what closes its gap but for the
    /// share; far from the contact, where gaps are larger than the approach, that does not matter.
    fn depth(&self, side: Side, k: usize, roll: f64) -> f64 {
        let own = self.design.depth(side, roll);
        if side != self.slave || self.share == 1.0 {
            return own;
        }
        own - (1.0 - self.share) * self.flanks(k).gap(roll).0.min(3.0 * self.approach)
    }
}

/// What came out.
#[derive(Debug, Serialize, Deserialize)]
pub struct Pressed {
    /// The moments on the bores of pinion and gear \[N m\].
    pub torques: [f64; 2],
    /// What is left of the forces on both bores, over the normal forces.
    pub unbalance: f64,
    /// The normal force of each pair \[N\].
    pub loads: Vec<f64>,
    /// The largest pressure of each pair \[Pa\].
    pub peaks: Vec<f64>,
    /// On how many edges of elements there is pressure, of each pair.
    pub edges: Vec<usize>,
    /// The energy of the overlap of each pair \[J\].
    pub overlaps: Vec<f64>,
    /// Where the pairs come nearest to each other.
    #[serde(skip)]
    pub nearest: Vec<Nearest>,
    /// The largest root stress of the teeth in contact \[Pa\], of pinion and gear.
    pub root_stresses: [f64; 2],
}

impl Pressed {
    /// By how much the overlap adds to the approach \[m\]: its energy ∫p²/2k grows with the load as F^(3/2) where
    /// pressures are those of Hertz, by 2p₀/(πk) per load, and somewhat faster where a corner does not let the contact
    /// grow.
    pub fn overlap(&self) -> f64 {
        1.5 * self.overlaps.iter().sum::<f64>() / self.loads.iter().sum::<f64>()
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
pub fn sizing(gear: &Gear, roll: f64, fineness: Fineness) -> Sizing {
    let [height, half] = {
        let section = gear.flank(roll);
        [section.height, section.half_thickness].map(|length| length / gear.specification.module)
    };
    let Fineness { level, edge, .. } = fineness;
    Sizing {
        across: across(0.5 * edge / half),
        focus: Some(Focus { height, size: edge, growth: 0.3 }),
        ..Sizing::even(level)
    }
}

/// Modulus and ratio with which plane strain is the plane state. CPS8 is a solid in CalculiX: its thickness changes as
/// a continuous field and shears where it does, which makes it 1 % stiffer than plane stress where it is as thick as
/// the module.
pub fn constants(material: Material, plane: Plane) -> (f64, f64) {
    let Material { youngs_modulus, poisson_ratio: nu, .. } = material;
    match plane {
        Plane::Strain => (youngs_modulus, nu),
        Plane::Stress => (youngs_modulus * (1.0 + 2.0 * nu) / ((1.0 + nu) * (1.0 + nu)), nu / (1.0 + nu)),
    }
}

/// Both gears as they are placed, with numbers of nodes and elements one after the other.
struct Placed {
    wheels: [Wheel; 2],
    /// Behind which numbers those of a gear start.
    offsets: [usize; 2],
    /// The gear's centre \[mm\]; the pinion's is 0.
    centre: [f64; 2],
    /// The meshes of the teeth in contact, pair by pair, and by how much a gear is turned anticlockwise.
    teeth: [(Vec<ElementMesh>, f64); 2],
    /// Nodes, elements and surfaces.
    deck: String,
}

impl Placed {
    /// The largest stress at the root of a gear's tooth in contact \[Pa\], from the displacements of all nodes \[mm\].
    fn root_stress(&self, case: &Case, side: Side, k: usize, moved: &[[f64; 2]]) -> f64 {
        let (meshes, turned) = &self.teeth[side as usize];
        let (gear, mesh) = (case.pair.side(side), &meshes[k]);
        let Specification { teeth, module, material, .. } = gear.specification;
        let sector = sector(side, k, teeth as usize);
        let form = gear.flank(gear.form_roll).height / module;
        let surface: Vec<Edge> = (mesh.root.iter().chain(&mesh.flank))
            .take_while(|edge| mesh.nodes[edge.nodes[2]][1] < form + 1e-6)
            .copied()
            .collect();
        let (sine, cosine) = (2.0 * mesh.half_pitch * sector as f64 - turned).sin_cos();
        let own = |node: usize| {
            let [x, y] = moved[self.wheels[side as usize].sectors[sector].nodes[node]];
            [x * cosine - y * sine, x * sine + y * cosine].map(|part| part / (module * MILLI))
        };
        let displacements: Vec<[f64; 2]> = (0..mesh.nodes.len()).map(own).collect();
        let points = along_surface(mesh, &surface, &displacements, case.plane, material.poisson_ratio);
        largest(&points).unwrap().0 * material.youngs_modulus
    }
}

/// Teeth further along the path follow clockwise on the pinion and anticlockwise on the gear.
fn sector(side: Side, k: usize, teeth: usize) -> usize {
    if side == Side::Pinion { k } else { (teeth - k) % teeth }
}

fn place(case: &Case, nearest: &[Nearest], fineness: Fineness) -> Placed {
    let pair = case.pair;
    let scale = pair.pinion.specification.module * MILLI;
    let width = pair.contact_width() * MILLI;
    let (mut deck, mut surfaces) = (String::new(), String::new());
    let mut offsets = [0; 2];
    let mut centre = [0.0; 2];
    let mut of_contact = Vec::new();
    // Where the flanks meet, and the pinion's normal there.
    let mut met = ([0.0; 2], [0.0; 2]);
    let wheels = [(Side::Pinion, "PINION"), (Side::Gear, "GEAR")].map(|(side, name)| {
        let gear = pair.side(side);
        let outline = Outline::new(gear, &gear.root(RootShape::Trochoid).unwrap()).unwrap();
        let coarse = ElementMesh::new(&outline, &Sizing::even(fineness.level)).unwrap();
        let fine = |(k, place): (usize, &Nearest)| {
            let mut mesh = ElementMesh::new(&outline, &sizing(gear, place.rolls[side as usize], fineness)).unwrap();
            take_off(&mut mesh, gear, |roll| case.depth(side, k, roll));
            mesh
        };
        let fine: Vec<ElementMesh> = nearest.iter().enumerate().map(fine).collect();
        let teeth = gear.specification.teeth as usize;
        let mut meshes = vec![&coarse; teeth];
        for (k, mesh) in fine.iter().enumerate() {
            meshes[sector(side, k, teeth)] = mesh;
        }

        let roll = pair.roll(side, case.path[0]);
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
            centre = shift.map(|x| x * scale);
        }
        let wheel = Wheel::new(&meshes).placed(turned, shift, scale);
        let offset = offsets[side as usize];
        deck += &wheel.cards(name, offset);
        write!(deck, "*SOLID SECTION, ELSET={name}, MATERIAL=ALL\n{width:e}\n").unwrap();
        for (k, mesh) in fine.iter().enumerate() {
            surfaces += &wheel.surface(&format!("{name}{k}"), offset, sector(side, k, teeth), &mesh.flank);
        }
        if side == Side::Pinion {
            offsets[1] = wheel.nodes.len();
        }
        of_contact.push((fine, turned));
        wheel
    });
    let [pinion, gear] = <[_; 2]>::try_from(of_contact).unwrap();
    Placed { wheels, offsets, centre, teeth: [pinion, gear], deck: deck + &surfaces }
}

fn nearest(case: &Case) -> Vec<Nearest> {
    (0..case.path.len()).map(|k| case.flanks(k).nearest()).collect()
}

/// Both gears pressed together, by CalculiX now.
pub fn press(case: &Case, fineness: Fineness) -> Option<Pressed> {
    let placed = place(case, &nearest(case), fineness);
    pressed(case, &placed, &deck(case, &placed, fineness))
}

/// The same, where CalculiX takes long: it may have answered before.
pub fn press_once(case: &Case, fineness: Fineness) -> Option<Pressed> {
    let placed = place(case, &nearest(case), fineness);
    let deck = deck(case, &placed, fineness);
    if let Some(answered) = recorded::answer(&deck) {
        return Some(Pressed { nearest: nearest(case), ..answered });
    }
    let answered = pressed(case, &placed, &deck)?;
    recorded::keep(&deck, &answered);
    Some(answered)
}

/// What CalculiX is given.
fn deck(case: &Case, placed: &Placed, fineness: Fineness) -> String {
    let pair = case.pair;
    let pairs = case.path.len();
    let wheels = &placed.wheels;
    let mut deck = placed.deck.clone();
    let (modulus, poisson) = constants(pair.pinion.specification.material, case.plane);
    writeln!(deck, "*MATERIAL, NAME=ALL\n*ELASTIC\n{:.12e}, {poisson:.12e}", modulus * 1e-6).unwrap();
    writeln!(
        deck,
        "*SURFACE INTERACTION, NAME=FLANKS\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{:e}",
        fineness.penalty
    )
    .unwrap();
    let [slave, master] = case.contact_sets();
    for k in 0..pairs {
        writeln!(deck, "*CONTACT PAIR, INTERACTION=FLANKS, TYPE=SURFACE TO SURFACE\n{slave}{k}, {master}{k}").unwrap();
    }
    // By itself it also stops where the number of points in contact changes by less than a thousandth, by chance far from
    // the end: with given points in contact everything is linear, so forces balance at any step.
    deck += "*STEP, INC=100\n*STATIC\n1., 1.\n";
    deck += "*CONTROLS, PARAMETERS=FIELD\n0.005, 1e-6, 0., 0., 0.02, 1e-5, 1e-3, 1e-30\n";
    deck += "*CONTROLS, PARAMETERS=CONTACT\n1e-9\n";
    deck += "*BOUNDARY\nGEARBORE, 1, 2\n";
    let turn = case.approach / pair.pinion.base_radius * case.share;
    for &node in &wheels[0].bore {
        let [x, y] = wheels[0].nodes[node].map(|x| x * turn);
        write!(deck, "{0}, 1, 1, {y:.12e}\n{0}, 2, 2, {1:.12e}\n", node + 1, -x).unwrap();
    }
    deck += "*NODE PRINT, NSET=PINIONBORE\nRF\n*NODE PRINT, NSET=GEARBORE\nRF\n*CONTACT PRINT\nCSTR, CELS\n";
    deck += "*NODE PRINT, NSET=PINION\nU\n*NODE PRINT, NSET=GEAR\nU\n";
    for k in 0..pairs {
        writeln!(deck, "*CONTACT PRINT, SLAVE={slave}{k}, MASTER={master}{k}\nCF").unwrap();
    }
    deck += "*END STEP\n";
    deck
}

/// What CalculiX answers.
fn pressed(case: &Case, placed: &Placed, deck: &str) -> Option<Pressed> {
    let printed = program::run("two gears in contact", deck)?;
    let pairs = case.path.len();
    let Placed { wheels, offsets, centre, .. } = placed;
    let slave = case.contact_sets()[0];
    // Force, and moment about the gear's centre; clockwise on the pinion as on the gear.
    let held = [("PINION", [0.0; 2]), ("GEAR", *centre)].map(|(name, [p, q])| {
        let side = usize::from(name == "GEAR");
        let rows = printed.table(&format!("forces (fx,fy,fz) for set {name}BORE"));
        let each = rows.iter().map(|row| {
            let [x, y] = wheels[side].nodes[row[0] as usize - 1 - offsets[side]];
            [row[1], row[2], (y - q) * row[1] - (x - p) * row[2]]
        });
        each.fold([0.0; 3], |sum, row| [sum[0] + row[0], sum[1] + row[1], sum[2] + row[2]])
    });
    let pressures = printed.table("contact stress (slave element+face,press,tang1,tang2)");
    let side = case.slave as usize;
    let teeth = wheels[side].sectors.len();
    let energies = printed.table("contact print energy (slave element+face,energy)");
    // The rows of a pair are those of the elements of one sector.
    let own = |rows: &[Vec<f64>], k: usize| -> Vec<[f64; 2]> {
        let sector = sector(case.slave, k, teeth);
        let after = |sector: usize| wheels[side].sectors.get(sector).map(|next| (offsets[side] + next.first) as f64);
        let [first, last] = [sector, sector + 1].map(|sector| after(sector).unwrap_or(f64::INFINITY));
        rows.iter().filter(|row| row[0] > first && row[0] <= last).map(|row| [row[0], row[2]]).collect()
    };
    let loads: Vec<f64> =
        (0..pairs).map(|k| -printed.total(&format!("slave set {slave}{k},"), "area,")[1] / case.share).collect();
    let edges = |k: usize| {
        let pressed: BTreeSet<u64> =
            own(&pressures, k).iter().filter(|row| row[1] > 0.0).map(|row| row[0] as u64).collect();
        pressed.len()
    };
    let root_stresses = [(Side::Pinion, "PINION"), (Side::Gear, "GEAR")].map(|(side, name)| {
        let rows = printed.table(&format!("displacements (vx,vy,vz) for set {name}"));
        let moved: Vec<[f64; 2]> = rows.iter().map(|row| [row[1], row[2]]).collect();
        let each = (0..pairs).map(|k| placed.root_stress(case, side, k, &moved));
        each.fold(0.0, f64::max) / case.share
    });
    let all = |of: &dyn Fn(usize) -> f64| (0..pairs).map(of).collect::<Vec<f64>>();
    let [[a, b, _], [c, d, _]] = held;
    Some(Pressed {
        torques: held.map(|[_, _, moment]| moment / MILLI / case.share),
        unbalance: (a + c).hypot(b + d) / case.share / loads.iter().sum::<f64>(),
        peaks: all(&|k| own(&pressures, k).iter().fold(0.0, |peak, row| row[1].max(peak)) * 1e6 / case.share),
        edges: (0..pairs).map(edges).collect(),
        overlaps: all(&|k| own(&energies, k).iter().map(|row| row[1]).sum::<f64>() / MILLI / case.share.powi(2)),
        loads,
        nearest: nearest(case),
        root_stresses,
    })
}
