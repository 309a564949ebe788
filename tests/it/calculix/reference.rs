//! Pairs pressed together where a contact law is put to the test: relieved flanks and tip corners.
//!
//! A law for small displacements is meant, so turn and gaps are a quarter of what they are ([`Case::share`]); finer
//! meshes, the whole of both, and plane stress with `GEARSTUDY_CALCULIX_LEVEL`. What is asserted is true whatever the
//! law.

use std::env;

use super::contact::pair;
use super::press::{Case, Fineness, PENALTY, Pressed, press_once};
use gearmesh::gear::compliance::finite_element::FiniteElement;
use gearmesh::gear::compliance::{Assumptions, ContactLaw, Method};
use gearmesh::gear::contact::CornerContact;
use gearmesh::gear::geometry::outline::tip::Tip;
use gearmesh::gear::geometry::root::RootShape;
use gearmesh::gear::geometry::{GearPair, Side};
use gearmesh::gear::material::Plane;
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::gear::modification::curve::Curve;
use gearmesh::gear::modification::relief::{Amount, FromTip, Start};
use gearmesh::gear::modification::tip_relief::TipRelief;
use gearmesh::gear::modification::{Design, Gears};
use gearmesh::numeric::crossing::bracketed;

/// A case but for its plane, and its coarsest mesh.
struct Situation<'a> {
    name: &'static str,
    design: Design,
    path: &'a [f64],
    /// \[m\].
    approach: f64,
    slave: Side,
    /// Edge of an element in contact on the coarsest mesh \[modules\].
    edge: f64,
    penalty: f64,
    /// In plane strain and in plane stress: the torque \[N m\], and the first pair's part of the normal forces; of 4, 6
    /// and 8 elements across extrapolated by the square of their size, less the overlap. Good to 0.1 % of the torque
    /// and 0.0005 of the part.
    converged: [[f64; 2]; 2],
    /// How near to them resolved contact comes: parts of the torque, and of the load. None where other pairs would touch
    /// too, or the arms are not those of a law for forces along the line of action.
    resolved: Option<[f64; 2]>,
}

/// No tip relief, or linear ones at the pinion's tip: amount and length \[m\].
fn design(pair: &GearPair, relief: Option<[f64; 2]>) -> Design {
    let mut design = Design::default();
    if let Some([amount, length]) = relief {
        let relief = TipRelief {
            amount: Amount::Depth(amount),
            start: Start::Length(length),
            counted_from: FromTip::Tip,
            curve: Curve::Linear,
        };
        design.add(Gears::Pinion, &relief, pair).unwrap();
    }
    design
}

impl Situation<'_> {
    fn case<'a>(&'a self, pair: &'a GearPair, plane: Plane, share: f64) -> Case<'a> {
        let Self { design, path, approach, slave, .. } = self;
        Case { pair, design, path, approach: *approach, plane, slave: *slave, share }
    }

    /// Presses the pair and prints a row.
    fn press(&self, case: &Case, level: usize) -> Option<Pressed> {
        let fineness = Fineness { level, edge: self.edge * 4.0 / level as f64, penalty: self.penalty };
        let found = press_once(case, fineness)?;
        let Pressed { torques, loads, peaks, edges, nearest, .. } = &found;
        let [pinion, gear] =
            [Side::Pinion, Side::Gear].map(|side| torques[side as usize] / case.pair.side(side).base_radius);
        let gaps: Vec<[f64; 2]> = nearest.iter().map(|place| [place.gap * 1e6, place.off * 1e6]).collect();
        println!(
            "{}: {:?}, {:?} slave, level {level}, edge {:.2} um, share {}; {:.3} um, {:.5} N m, T/r_b {pinion:.2} \
             {gear:.2} N, loads {loads:.2?} N, peaks {:.1?} MPa, overlap {:.4} um, pressure on {edges:?} edges, gap \
             and place {gaps:.2?} um",
            self.name,
            case.plane,
            case.slave,
            fineness.edge * case.pair.pinion.specification.module * 1e6,
            case.share,
            case.approach * 1e6,
            torques[0],
            peaks.iter().map(|peak| peak * 1e-6).collect::<Vec<f64>>(),
            found.overlap() * 1e6,
        );
        Some(found)
    }

    /// Whether forces and moments balance.
    fn balance(&self, pair: &GearPair, found: &Pressed) {
        let Pressed { torques, unbalance, loads, nearest, .. } = found;
        assert!(*unbalance < 1e-6);
        let [own, other] =
            [self.slave, self.slave.other()].map(|side| torques[side as usize] / pair.side(side).base_radius);
        // Normal forces are along the normals of the other gear than the slave. It is not relieved, so its arm is r_b
        // wherever flanks touch. The slave's is another one off the line of action, and where loaded teeth tilt.
        let sum: f64 = loads.iter().sum();
        let turned: f64 = loads.iter().zip(nearest).map(|(load, place)| load * place.arm).sum();
        assert!((other / sum - 1.0).abs() < 5e-4, "{other} of {sum}");
        assert!((own / turned - 1.0).abs() < 4e-3, "{own} of {turned}");
    }

    /// All that is asked for; the results in plane strain, with a quarter of turn and gaps.
    fn check(&self, pair: &GearPair) -> Option<Pressed> {
        let level = env::var("GEARSTUDY_CALCULIX_LEVEL").ok().map(|level| level.parse().unwrap());
        let wanted: &[(Plane, f64)] = if level.is_some() {
            &[(Plane::Stress, 1.0), (Plane::Stress, 0.25), (Plane::Strain, 1.0), (Plane::Strain, 0.25)]
        } else {
            &[(Plane::Strain, 0.25)]
        };
        let mut last = None;
        for &(plane, share) in wanted {
            let found = self.press(&self.case(pair, plane, share), level.unwrap_or(4))?;
            self.balance(pair, &found);
            let [torque, part] = self.converged[usize::from(plane == Plane::Stress)];
            assert!((found.torques[0] / torque - 1.0).abs() < 5e-3);
            assert!((found.loads[0] / found.loads.iter().sum::<f64>() - part).abs() < 2e-3);
            last = Some(found);
        }
        for (plane, [torque, part]) in [Plane::Strain, Plane::Stress].into_iter().zip(self.converged) {
            let Some(near) = self.resolved else { continue };
            let ours = ours(&self.case(pair, plane, 0.25));
            let off = [ours[0] / torque - 1.0, ours[1] - part];
            println!("{}: {plane:?}, resolved: {ours:.4?}, off by {off:.4?}", self.name);
            assert!(off.iter().zip(near).all(|(off, near)| off.abs() < near), "{}, {plane:?}: {off:?}", self.name);
        }
        last
    }
}

/// The torque \[N m\] under which our pair approaches by so much, with finite elements and resolved contact, and the first
/// pair's part of the load.
fn ours(case: &Case) -> [f64; 2] {
    let Case { pair, design, path, approach, plane, .. } = *case;
    let method = FiniteElement { plane, elements_across: 28 };
    let assumptions = Assumptions {
        root: RootShape::Trochoid,
        contact: ContactLaw::Resolved,
        coupled: true,
        torque: None,
        accuracy: None,
    };
    let compliance = method.tabulate(pair, assumptions).unwrap().compliance;
    let settings = Settings { corner_contact: CornerContact::Exact, ..Settings::default() };
    let cycle = Mesh::new(pair, &compliance, settings).unwrap();
    let position = path.iter().map(|s| s - pair.start_of_contact).find(|position| *position >= 0.0).unwrap();
    let at = |torque: f64| cycle.loaded(design, torque).state(position, 1);
    let torque = bracketed(0.1, 1e3, |torque| at(torque).transmission_error() - approach).unwrap();
    let loads = at(torque).balance.loads;
    let first = loads.iter().find(|load| **load > 0.0).unwrap();
    [torque, first / loads.iter().sum::<f64>()]
}

/// Three edges or more on either side of the largest pressure; a corner has one side.
fn fine(found: &Pressed, corner: bool) {
    let (first, others) = found.edges.split_at(1);
    assert!(first[0] >= if corner { 3 } else { 6 } && others.iter().all(|edges| *edges >= 6), "{:?}", found.edges);
}

/// The start of two pairs in contact, both inside the path of contact.
fn both_inside(pair: &GearPair) -> [f64; 2] {
    let first = pair.start_of_contact + 0.4 * (pair.contact_ratio - 1.0) * pair.base_pitch;
    [first, first + pair.base_pitch]
}

#[test]
fn one_pair() {
    let pair = pair();
    let path = &[pair.zone_points().c];
    let (design, slave) = (design(&pair, None), Side::Pinion);
    let one = Situation {
        name: "one pair",
        design,
        path,
        approach: 27.5e-6,
        slave,
        edge: 0.015,
        penalty: PENALTY,
        converged: [[25.54, 1.0], [23.61, 1.0]],
        resolved: Some([3e-3, 1e-12]),
    };
    let Some(found) = one.check(&pair) else { return };
    fine(&found, false);
}

#[test]
fn two_pairs() {
    let pair = pair();
    let path = &both_inside(&pair);
    let (design, slave) = (design(&pair, None), Side::Pinion);
    let two = Situation {
        name: "two pairs",
        design,
        path,
        approach: 20e-6,
        slave,
        edge: 0.01,
        penalty: PENALTY,
        converged: [[28.02, 0.4629], [26.13, 0.4630]],
        resolved: Some([3e-3, 5e-4]),
    };
    let Some(found) = two.check(&pair) else { return };
    fine(&found, false);
}

/// On a slope of 1 in 100 along the line of action the flanks touch 70 µm from it.
#[test]
fn relieved_pair() {
    let pair = pair();
    let (design, slave) = (design(&pair, Some([40e-6, 4e-3])), Side::Pinion);
    let relieved = Situation {
        name: "relieved pair",
        design,
        path: &[11.6e-3],
        approach: 40e-6,
        slave,
        edge: 0.015,
        penalty: PENALTY,
        converged: [[29.89, 1.0], [27.62, 1.0]],
        resolved: None,
    };
    let Some(found) = relieved.check(&pair) else { return };
    fine(&found, false);
    assert!(found.nearest[0].off < -60e-6 && found.nearest[0].gap > 7e-6);
    // Whose flank carries the pressure does not matter.
    let level = env::var("GEARSTUDY_CALCULIX_LEVEL").map_or(4, |level| level.parse().unwrap());
    let case = relieved.case(&pair, Plane::Strain, 0.25);
    let swapped = relieved.press(&Case { slave: Side::Gear, ..case }, level).unwrap();
    assert!((swapped.loads[0] / found.loads[0] - 1.0).abs() < 2e-3);
}

#[test]
fn two_pairs_one_of_them_relieved() {
    let pair = pair();
    let path = &both_inside(&pair);
    let (design, slave) = (design(&pair, Some([20e-6, 3e-3])), Side::Pinion);
    let relieved = Situation {
        name: "one of two relieved",
        design,
        path,
        approach: 27.5e-6,
        slave,
        edge: 0.01,
        penalty: PENALTY,
        converged: [[32.38, 0.5741], [30.19, 0.5714]],
        resolved: Some([2e-3, 5e-4]),
    };
    let Some(found) = relieved.check(&pair) else { return };
    fine(&found, false);
    assert!(found.nearest[0].gap < 1e-12 && found.nearest[1].gap > 5e-6);
}

/// The gear's tip 0.2 mm before A. The force is along the normal of the pinion's flank, 3° away from that of the gear's.
/// Pressure grows without bound towards the corner, as far as mesh and overlap allow.
#[test]
fn corner_before_a() {
    let pair = pair();
    let first = pair.start_of_contact - 0.2e-3;
    let corner = Situation {
        name: "corner before A",
        design: design(&pair, None),
        path: &[first, first + pair.base_pitch],
        approach: 22e-6,
        slave: Side::Gear,
        edge: 0.002,
        penalty: 10.0 * PENALTY,
        converged: [[27.80, 0.327], [25.90, 0.328]],
        resolved: Some([2e-3, 1e-3]),
    };
    let Some(found) = corner.check(&pair) else { return };
    fine(&found, true);
    assert!(found.nearest[0].gap > 3e-6);
    assert!(found.peaks[0] > 10.0 * found.peaks[1]);
}

/// 0.05 mm after A: half of the width of Hertz is beyond the gear's tip.
#[test]
fn corner_within_the_contact() {
    let pair = pair();
    let first = pair.start_of_contact + 0.05e-3;
    let corner = Situation {
        name: "corner within",
        design: design(&pair, None),
        path: &[first, first + pair.base_pitch],
        approach: 20e-6,
        slave: Side::Gear,
        edge: 0.003,
        penalty: 3.0 * PENALTY,
        converged: [[27.57, 0.4048], [25.69, 0.4048]],
        resolved: Some([5e-3, 2.5e-3]),
    };
    let Some(found) = corner.check(&pair) else { return };
    fine(&found, true);
}

/// About half of the contact on the rounding of the gear's tip, which is in the meshes too: 0.02 mm after A, and 0.03 mm before
/// it. Turn and gaps are whole: a smaller share of them would be another rounding.
#[test]
fn rounded_tip() {
    let [pinion, gear] = [Side::Pinion, Side::Gear].map(|side| pair().side(side).specification);
    let level = env::var("GEARSTUDY_CALCULIX_LEVEL").map_or(4, |level| level.parse().unwrap());
    // Of 6 and 8 elements across extrapolated by the square of their size, less the overlap.
    for (radius, beside, [torque, part]) in [(0.3e-3, 0.02e-3, [27.66, 0.4152]), (0.15e-3, -0.03e-3, [27.34, 0.4004])] {
        let pair = GearPair::with_tips([pinion, gear], [Tip::Land, Tip::Rounding(radius)], None).unwrap();
        let first = pair.start_of_contact + beside;
        let rounded = Situation {
            name: "rounded tip",
            design: design(&pair, None),
            path: &[first, first + pair.base_pitch],
            approach: 20e-6,
            slave: Side::Gear,
            edge: 0.003,
            penalty: 3.0 * PENALTY,
            converged: [[torque, part]; 2],
            resolved: None,
        };
        let case = rounded.case(&pair, Plane::Strain, 1.0);
        let Some(found) = rounded.press(&case, level) else { return };
        let theirs = [found.torques[0], found.loads[0] / found.loads.iter().sum::<f64>()];
        let ours = ours(&case);
        println!("rounded tip: {theirs:?}, ours {ours:?}");
        assert!((theirs[0] / torque - 1.0).abs() < 5e-3 && (theirs[1] - part).abs() < 2e-3, "{theirs:?}");
        assert!((ours[0] / torque - 1.0).abs() < 2e-3 && (ours[1] - part).abs() < 1.5e-3, "{ours:?}");
    }
}
