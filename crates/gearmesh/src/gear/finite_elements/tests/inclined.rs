//! Loads that are turned from the flank's normal: against loads at nodes, against the wedge, and by what they must hold.

use super::super::gear_model::{FlankLoad, GearModel};
use super::super::mesh::{Focus, Sizing};
use super::super::sector::NodalForces;
use super::{gear, shifted};
use crate::gear::contact::wedge;
use crate::gear::geometry::Gear;
use crate::gear::geometry::root::{Root, RootShape};
use crate::gear::material::Plane;

/// A flank that is meshed finely about a roll angle, both ways.
fn fine<'a>(gear: &'a Gear, root: &Root, across: u32, [edge, roll]: [f64; 2]) -> GearModel<'a> {
    let half: Vec<f64> = (0..=across).map(|k| 0.5 * (f64::from(k) / f64::from(across)).powi(3)).collect();
    let corners: Vec<f64> = half.iter().copied().chain(half.iter().rev().skip(1).map(|part| 1.0 - part)).collect();
    let across: Vec<f64> =
        corners.windows(2).flat_map(|ends| [ends[0], 0.5 * (ends[0] + ends[1])]).chain([1.0]).collect();
    let focus = Focus { height: gear.flank(roll).height, size: edge, growth: 0.3 };
    let sizing = Sizing { across, focus: Some(focus), ..Sizing::even(16) };
    GearModel::new(gear, root, Plane::Strain, &sizing).unwrap()
}

/// So far from the corner of the tip \[modules\].
fn before_the_tip(gear: &Gear, distance: f64) -> f64 {
    (gear.tip_roll().powi(2) - 2.0 * distance / gear.base_radius).sqrt()
}

fn turned(roll: f64, inclination: f64) -> FlankLoad {
    FlankLoad { inclination, ..FlankLoad::normal(roll) }
}

/// What is left of displacements along the flank by normal loads, and of those along the flank by such loads less the normal
/// ones, from loads that are turned to both sides.
fn forms(own: [f64; 3], turn: f64) -> [f64; 2] {
    let [normal, one, other] = own;
    [(one - other) / (2.0 * (2.0 * turn).sin()), (one + other - 2.0 * normal) / (2.0 * turn.sin().powi(2))]
}

/// Tier: invariant; what a load moves itself by is a quadratic form of its direction, and what it does to other teeth is
/// linear in it, whatever the field that was taken off.
#[test]
fn displacements_follow_the_direction() {
    for (teeth, shift) in [(12, 0.5), (48, 0.0)] {
        let (gear, root) = gear(&shifted(teeth, shift, 1.4), RootShape::Trochoid);
        let model = super::model(&gear, &root, 8).unwrap();
        for distance in [0.02, 0.5] {
            let roll = before_the_tip(&gear, distance);
            let angles = [0.0, 0.5, -0.5, 0.2, -0.8];
            let found = model.rests_of(&angles.map(|angle| turned(roll, angle)), 1).unwrap();
            let [across, along] = forms([found.own[0], found.own[1], found.own[2]], 0.5);
            let other = &found.further[0][0];
            let tangential = (other[1] - other[2]) / (2.0 * 0.5_f64.sin());
            for (k, angle) in angles.into_iter().enumerate().skip(3) {
                let own = found.own[0] + (2.0 * angle).sin() * across + angle.sin().powi(2) * along;
                assert!((found.own[k] - own).abs() < 1e-8, "z {teeth} {distance} {angle}: {own} {}", found.own[k]);
                let further = angle.cos() * other[0] + angle.sin() * tangential;
                assert!((other[k] - further).abs() < 1e-12, "z {teeth} {distance} {angle}: {further} {}", other[k]);
            }
        }
    }
}

/// A pressure of a total of 1 on so much to either side of a place of the flank, all of it along the normal of that place.
fn spread(model: &GearModel, gear: &Gear, roll: f64, half: f64) -> NodalForces {
    const POINTS: u32 = 200;
    let [x, y] = model.direction(roll);
    let point = |k: u32| {
        let angle = std::f64::consts::PI * ((f64::from(k) + 0.5) / f64::from(POINTS) - 0.5);
        let share = 2.0 / f64::from(POINTS) * angle.cos().powi(2);
        let at = (roll * roll + 2.0 * half * angle.sin() / gear.base_radius).sqrt();
        let [p, q] = model.direction(at);
        model.load(at).into_iter().map(move |(node, [a, b])| {
            let size = share * (a * p + b * q);
            (node, [x * size, y * size])
        })
    };
    (0..POINTS).flat_map(point).collect()
}

/// Tier: second method; pressures on a mesh that resolves them: a normal one moves its place along the flank, and one along
/// the flank moves it along the normal, by what inclined point loads say. The half plane's own part goes one way on one side
/// and the other way on the other, and falls out.
#[test]
fn pressures_say_the_same() {
    let (gear, root) = gear(&shifted(17, 0.2, 1.4), RootShape::Trochoid);
    for (distance, half) in [(0.4, 0.06), (0.1, 0.03)] {
        let roll = before_the_tip(&gear, distance);
        let loads = [0.0, 0.5, -0.5].map(|angle| turned(roll, angle));
        let own = super::model(&gear, &root, 24).unwrap().rests_of(&loads, 0).unwrap().own;
        let [across, _] = forms([own[0], own[1], own[2]], 0.5);
        let model = fine(&gear, &root, 16, [0.2 * half, roll]);
        let normal = spread(&model, &gear, roll, half);
        // By a right angle towards the root.
        let tangential: NodalForces = normal.iter().map(|&(node, [x, y])| (node, [-y, x])).collect();
        for (probe, load) in [(&tangential, &normal), (&normal, &tangential)] {
            let found = model.work_of(probe, load).unwrap();
            assert!((found / across - 1.0).abs() < 2e-3, "{distance}: {across} {found}");
        }
    }
}

/// Tier: closed form; towards the corner they grow as a wedge has it, by B's own part for each factor e of the distance.
#[test]
fn inclined_loads_grow_towards_the_corner_as_on_a_wedge() {
    let (gear, root) = gear(&shifted(30, 0.0, 1.4), RootShape::Trochoid);
    let model = fine(&gear, &root, 20, [1e-3, gear.tip_roll()]);
    let found = [0.025, 0.0125, 0.00625, 0.003_125].map(|distance| {
        let roll = before_the_tip(&gear, distance);
        let own = model.rests_of(&[0.0, 0.5, -0.5].map(|angle| turned(roll, angle)), 0).unwrap().own;
        forms([own[0], own[1], own[2]], 0.5)
    });
    let exact = wedge::inclined_softening(std::f64::consts::FRAC_PI_2 + gear.tip_roll().atan());
    for k in 0..2 {
        let errors: Vec<f64> = found
            .windows(2)
            .map(|two| (two[1][k] - two[0][k]) / std::f64::consts::LN_2 / (0.91 * exact[k]) - 1.0)
            .collect();
        // What is left falls with the distance.
        assert!((2.0 * errors[2] - errors[1]).abs() < 1e-2, "{k}: {errors:?}");
    }
}
