//! Influences of loads on the stress of roots: their own field taken off against loads at nodes.

use super::super::gear_model::{FlankLoad, GearModel};
use super::super::mesh::Sizing;
use super::{gear, model, shifted, standard};
use crate::gear::geometry::pinion_cutter::PinionCutter;
use crate::gear::geometry::root::RootShape;
use crate::gear::geometry::{Rack, Specification};
use crate::gear::material::Plane;
use crate::numeric::chebyshev::{Series, nodes};
use crate::numeric::parabola::peak;

/// Tier: second method. A load is either forces at nodes, whose stresses are wrong for some elements around it, or a field in
/// closed form and a rest. Half a module away both have the error of the mesh and nothing else: they differ by 0.5 % at most with
/// 16 elements across, and by 0.06 % with 32.
#[test]
fn away_from_a_load_its_nodes_do_not_matter() {
    for specification in [shifted(12, 0.5, 1.4), standard(19, 1.758), standard(48, 1.758), standard(150, 1.2)] {
        for shape in [RootShape::Trochoid, RootShape::CircularFillet] {
            let (gear, root) = gear(&specification, shape);
            let (form, tip) = (root.form_roll, gear.tip_roll());
            let rolls = [0.2, 0.5, 0.95].map(|part| form + part * (tip - form));
            for (across, most) in [(16, 5e-3), (32, 6e-4)] {
                let model = model(&gear, &root, across).unwrap();
                let found = model.stress_influences(&rolls, 0).unwrap();
                let at_nodes = model.root_stresses(&rolls).unwrap();
                let (mut compared, mut worst) = (0, 0.0_f64);
                for ((ours, theirs), &roll) in found.stresses[0].iter().zip(&at_nodes).zip(&rolls) {
                    let largest = ours.iter().copied().fold(0.0, f64::max);
                    let load = gear.flank(roll);
                    let away = |[x, y]: [f64; 2]| (x - load.half_thickness).hypot(y - load.height) > 0.5;
                    // Ours begin an edge further on.
                    let theirs = theirs[2..].iter().take_while(|point| away(point.place));
                    for ((ours, theirs), gauge) in ours.iter().zip(theirs).zip(&found.gauges) {
                        assert_eq!(gauge.place.map(f64::to_bits), theirs.place.map(f64::to_bits));
                        worst = worst.max((ours - theirs.stress).abs() / largest);
                        compared += 1;
                    }
                }
                assert!(worst < most && compared > 8, "z {} {shape:?}: {worst} {compared}", specification.teeth);
            }
        }
    }
}

/// Tier: second method. A load at the tip that is turned from the flank's normal, towards the root or away, is a sum of two, and
/// forces at nodes that are turned alike do the same, since the fillet is far from them: to 1e-3 of the largest stress with 32
/// elements across.
#[test]
fn loads_that_are_turned_do_what_turned_forces_at_nodes_do() {
    for specification in [shifted(12, 0.5, 1.4), standard(48, 1.758)] {
        let (gear, root) = gear(&specification, RootShape::Trochoid);
        let roll = 0.98 * gear.tip_roll();
        let model = model(&gear, &root, 32).unwrap();
        let of = |inclination: f64| FlankLoad { inclination, ..FlankLoad::normal(roll) };
        let found = model.stress_influences_of(&[0.0, 0.5, 0.2, -0.1].map(of), 0).unwrap();
        let [normal, one, other, back] = [0, 1, 2, 3].map(|load| &found.stresses[0][load]);
        let largest = normal.iter().copied().fold(0.0, f64::max);
        let along = |place: usize| (one[place] - 0.5_f64.cos() * normal[place]) / 0.5_f64.sin();
        for (place, gauge) in found.gauges.iter().enumerate() {
            for (turned, angle) in [(other, 0.2_f64), (back, -0.1)] {
                let sum = angle.cos() * normal[place] + angle.sin() * along(place);
                assert!((turned[place] - sum).abs() < 1e-11 * largest, "z {}: {place}", specification.teeth);
                let [sine, cosine] = [angle.sin(), angle.cos()];
                let forces = model
                    .load(roll)
                    .into_iter()
                    .map(|(node, [x, y])| (node, [x * cosine - y * sine, y * cosine + x * sine]));
                let at_nodes = model.work_of(&gauge.forces(), &forces.collect()).unwrap();
                assert!(
                    (at_nodes - turned[place]).abs() < 1e-3 * largest,
                    "z {}: {place}, {angle}: {at_nodes} {}",
                    specification.teeth,
                    turned[place]
                );
            }
        }
    }
}

/// Tier: convergence. Next to a load too, where forces at nodes say nothing: the largest stress under a load at a twentieth of
/// the flank against that of 48 elements across.
#[test]
fn next_to_a_load_stresses_converge() {
    for teeth in [17, 60] {
        let (gear, root) = gear(&standard(teeth, 1.4), RootShape::Trochoid);
        let roll = root.form_roll + 0.05 * (gear.tip_roll() - root.form_roll);
        let largest = |across: usize| {
            let found = model(&gear, &root, across).unwrap().stress_influences(&[roll], 0).unwrap();
            let lengths: Vec<f64> = found.gauges.iter().map(|gauge| gauge.length).collect();
            peak(&lengths, &lengths, &found.stresses[0][0]).unwrap().0
        };
        let exact = largest(48);
        for (across, error) in [(8, 4e-2), (16, 1e-2), (24, 5e-3)] {
            let found = largest(across);
            assert!((found / exact - 1.0).abs() < error, "z {teeth}, {across} across: {found} for {exact}");
        }
    }
}

/// Tier: second method; between the nodes of the tables the influences are interpolated. Right beside a load, where a fillet
/// ends, they are less smooth; the largest stress of a tooth is not there: to 1e-5 of it, and 3e-4 where there are very many
/// teeth, whose fillets end high.
#[test]
fn the_largest_influence_is_smooth_in_the_load_s_place() {
    for (teeth, count, [every, of_peak]) in [
        (17, 12, [2e-2, 1e-5]),
        (25, 12, [2e-2, 1e-5]),
        (48, 12, [2e-2, 1e-5]),
        (48, 16, [1e-2, 2e-6]),
        (150, 12, [5e-2, 3e-4]),
    ] {
        let (gear, root) = gear(&standard(teeth, 1.4), RootShape::Trochoid);
        let model = model(&gear, &root, 16).unwrap();
        let (form, tip) = (root.form_roll, gear.tip_roll());
        let tabulated = model.stress_influences(&nodes(form, tip, count), 1).unwrap();
        let rolls: Vec<f64> = (1..80).map(|k| form + (tip - form) * f64::from(k) / 80.0).collect();
        let direct = model.stress_influences(&rolls, 1).unwrap();
        let lengths: Vec<f64> = tabulated.gauges.iter().map(|gauge| gauge.length).collect();
        let series: Vec<Series> = (0..lengths.len())
            .map(|place| {
                let values: Vec<f64> = tabulated.stresses[1].iter().map(|row| row[place]).collect();
                Series::from_values(form, tip, &values)
            })
            .collect();
        for (roll, direct) in rolls.iter().zip(&direct.stresses[1]) {
            let ours: Vec<f64> = series.iter().map(|series| series.value(*roll)).collect();
            let [ours_peak, direct_peak] =
                [&ours, direct].map(|stresses| peak(&lengths, &lengths, stresses).unwrap().0);
            let worst = ours.iter().zip(direct).map(|(a, b)| (a - b).abs() / direct_peak).fold(0.0, f64::max);
            let case = format!("z {teeth}, {count} nodes, load at {:.3}", (roll - form) / (tip - form));
            assert!(worst < every, "{case}: {worst:.1e}");
            assert!((ours_peak / direct_peak - 1.0).abs() < of_peak, "{case}: {ours_peak} for {direct_peak}");
        }
    }
}

/// A gear and a root whose fillet may be sharp, on a bore of r_f/1.6.
type Sharp = (Specification, RootShape);

/// The largest stress under loads at places of the flank, as parts of it, on a mesh that is graded to the fillet.
fn graded((specification, shape): &Sharp, [across, parts]: [usize; 2], loads: &[f64]) -> Vec<f64> {
    let (gear, root) = gear(specification, *shape);
    let model = GearModel::new(&gear, &root, Plane::Strain, &Sizing::graded(across, parts)).unwrap();
    let (form, end) = (root.form_roll, gear.flank_end.roll);
    let rolls: Vec<f64> = loads.iter().map(|part| form + part * (end - form)).collect();
    let found = model.stress_influences(&rolls, 0).unwrap();
    let lengths: Vec<f64> = found.gauges.iter().map(|gauge| gauge.length).collect();
    found.stresses[0].iter().map(|stresses| peak(&lengths, &lengths, stresses).unwrap().0).collect()
}

fn racked(teeth: u32, shift: f64, rack: Rack) -> Specification {
    let bore_radius = (0.5 * f64::from(teeth) - rack.dedendum + shift) / 1.6;
    Specification { rack, bore_radius, ..shifted(teeth, shift, 1.0) }
}

fn of_rack(teeth: u32, shift: f64, tip_radius: f64) -> Sharp {
    let rack = Rack { addendum: 1.0, dedendum: 1.25, tip_radius, ..Rack::ISO_53_A };
    (racked(teeth, shift, rack), RootShape::Trochoid)
}

/// Tier: second method; a program of boundary elements, 850 and 1206 quadratic ones along the same curves of a whole gear that
/// is held at its bore, under a load at 0.6 of the flank.
#[test]
fn a_sharp_root_is_stressed_as_boundary_elements_say() {
    for (tip_radius, exact) in [(0.1, 2.9788), (0.01, 3.7120)] {
        let found = graded(&of_rack(17, 0.5, tip_radius), [16, 2], &[0.6])[0];
        assert!((found / exact - 1.0).abs() < 2e-3, "{tip_radius}: {found} for {exact}");
    }
}

/// Tier: convergence; with 16 elements across, the default, the largest stress is right to 0.3 % for tip radii of the tool of a
/// twentieth of the module and more, and of a hundredth too where few teeth leave a rounder root. Values of the mesh of
/// which each element is a sixteenth of one of those; meshes that know nothing of the fillet are 1 to 3 % off.
#[test]
fn sharp_roots_are_right_to_three_in_a_thousand() {
    for (sharp, exact) in [
        (of_rack(17, 0.5, 0.1), [2.7599, 3.9974]),
        (of_rack(17, 0.5, 0.01), [3.4728, 4.9114]),
        (of_rack(60, 0.5, 0.1), [2.7390, 4.4946]),
        (of_rack(60, 0.0, 0.05), [3.0302, 4.6940]),
        (of_rack(12, 0.0, 0.2), [3.5480, 4.6430]),
        (of_rack(17, 0.0, 0.38), [2.5643, 3.5786]),
    ] {
        let found = graded(&sharp, [16, 2], &[0.4, 0.9]);
        for (found, exact) in found.iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < 3e-3, "{:?}: {found} for {exact}", sharp.0.rack);
        }
    }
}

/// Tier: convergence; the same of circular fillets, cutters with sharp tips, protuberances and notches, against a mesh of
/// which each element is four ninths as large.
#[test]
fn roots_of_other_tools_are_right_to_three_in_a_thousand() {
    let rack = |tip_radius: f64| Rack { addendum: 1.0, dedendum: 1.25, tip_radius, ..Rack::ISO_53_A };
    let deep = Rack { dedendum: 1.4, tip_radius: 0.1, notch_radius: 0.15, ..Rack::ISO_53_A };
    let shaped = |teeth, tip_radius| {
        let cutter = Some(PinionCutter { teeth: 20, profile_shift: 0.1, addendum: 1.25, tip_radius });
        (Specification { cutter, ..racked(teeth, 0.1, rack(0.38)) }, RootShape::Trochoid)
    };
    for sharp in [
        (racked(30, 0.0, rack(0.05)), RootShape::CircularFillet),
        shaped(25, 0.05),
        shaped(40, 0.0),
        (racked(20, 0.1, Rack { protuberance: 0.06, ..deep }), RootShape::Trochoid),
        (racked(40, 0.1, Rack { machining_allowance: 0.06, ..deep }), RootShape::Trochoid),
        of_rack(150, -0.4, 0.25),
    ] {
        let [found, fine] = [[16, 2], [24, 3]].map(|sizes| graded(&sharp, sizes, &[0.4, 0.9]));
        for (found, fine) in found.iter().zip(&fine) {
            assert!((found / fine - 1.0).abs() < 3e-3, "{:?}: {found} for {fine}", sharp.0);
        }
    }
}
