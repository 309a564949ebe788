//! Traces against the families that they are traces of, and what is no trace of a flank.

mod refusals;
mod rough;
mod taken;

use super::*;
use crate::gear::compliance::{ContactLaw, PairCompliance};
use crate::gear::contact::gap::Gaps;
use crate::gear::contact::separation::Facing;
use crate::gear::contact::{CornerContact, SliceCoupling};
use crate::gear::fixtures::{coupled, inclined, pair, varying};
use crate::gear::mesh::answers::curve::{Point, Wanted};
use crate::gear::mesh::{Mesh, Settings};
use crate::gear::modification::curve::Curve;
use crate::gear::modification::lead_crowning::LeadCrowning;
use crate::gear::modification::profile_crowning::ProfileCrowning;
use crate::gear::modification::relief::{Amount, FromTip, Start};
use crate::gear::modification::tip_relief::TipRelief;
use crate::gear::modification::{Design, Gears};
use proptest::prelude::*;

const SIDES: [(Gears, Side); 2] = [(Gears::Pinion, Side::Pinion), (Gears::Gear, Side::Gear)];

/// Places equally far apart, both ends among them.
fn places([from, to]: [f64; 2], count: usize) -> Vec<f64> {
    (0..count).map(|at| from + (to - from) * at as f64 / (count - 1) as f64).collect()
}

/// A trace of so many points along the active flank, of a deviation over the roll angle.
fn profile(pair: &GearPair, side: Side, count: usize, deviation: impl Fn(f64) -> f64) -> Measured {
    let flank = Flank::new(pair, side);
    let rolls = places([flank.root_roll, flank.tip_roll], count);
    Measured {
        deviations: rolls.iter().map(|roll| deviation(*roll)).collect(),
        roll_lengths: Some(rolls.iter().map(|roll| roll * flank.base_radius).collect()),
        ..Measured::default()
    }
}

/// The same across the face, over z.
fn lead(pair: &GearPair, side: Side, count: usize, deviation: impl Fn(f64) -> f64) -> Measured {
    let half = 0.5 * pair.side(side).specification.face_width;
    let positions = places([-half, half], count);
    let deviations = positions.iter().map(|z| deviation(*z)).collect();
    Measured { roll_lengths: None, face_positions: Some(positions), deviations, ..profile(pair, side, 2, |_| 0.0) }
}

/// Parabolic, without a kink at its start.
const SMOOTH: Curve = Curve::Power { exponent: 2.0 };

fn relief(amount: f64, length: f64, curve: Curve) -> TipRelief {
    TipRelief { amount: Amount::Depth(amount), start: Start::Length(length), counted_from: FromTip::Tip, curve }
}

/// Both gears as traces of what a design takes off their profiles.
fn traced(pair: &GearPair, plain: &Design, count: usize) -> Design {
    let mut design = Design::default();
    for (gears, side) in SIDES {
        let trace = profile(pair, side, count, |roll| -plain.depth(side, roll));
        design.add(gears, &trace, pair).unwrap();
    }
    design
}

fn relieved(pair: &GearPair, amount: f64, length: f64, curve: Curve) -> Design {
    let mut plain = Design::default();
    plain.add(Gears::Both, &relief(amount, length, curve), pair).unwrap();
    plain
}

fn crowned(pair: &GearPair) -> Design {
    let mut plain = Design::default();
    plain.add(Gears::Both, &ProfileCrowning { amount: 9e-6 }, pair).unwrap();
    plain
}

/// By how much the transmission error of one design differs from that of another at the other's own points, over the peak-to-peak of
/// the other, or by how much that does.
fn off(cycle: &Mesh, designs: [&Design; 2], torque: f64) -> f64 {
    let [one, other] = designs.map(|design| cycle.loaded(design, torque).peak_to_peak());
    worst(cycle, designs, torque).max((one - other).abs()) / other
}

/// By how much it differs at the most \[m\].
fn worst(cycle: &Mesh, designs: [&Design; 2], torque: f64) -> f64 {
    let [one, other] = designs.map(|design| cycle.loaded(design, torque));
    let at = |point: &Point| {
        let [one, other] = [&one, &other].map(|loading| loading.state(point.cycle_position, point.pairs));
        (one.transmission_error() - other.transmission_error()).abs()
    };
    other.curve(Wanted::default()).iter().map(at).fold(0.0, f64::max)
}

/// Path positions at which the reliefs of pinion and gear start \[m\].
fn starts(pair: &GearPair, design: &Design) -> [f64; 2] {
    let [pinion, gear] = design.profiles(0.0).map(|parts| parts[0].breaks()[0]);
    [pinion * pair.pinion.base_radius, pair.tangent_length - gear * pair.gear.base_radius]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, ..ProptestConfig::default() })]

    /// Tier: second method; a trace of a parabolic relief gives that relief's transmission error as its points come closer: everywhere to 1e-6
    /// where the relief starts without a kink. A kink no spline has: midway between two points `scipy.interpolate.CubicSpline` (1.17) is off by
    /// 0.170 753 of the kink times their distance, which is the most; by both where those of pinion and gear meet.
    #[test]
    fn a_trace_of_a_relief_gives_its_transmission_error(
        amount in 6e-6..25e-6_f64, length in 2.5e-3..6e-3_f64, torque in 60.0..400.0_f64
    ) {
        let (pair, compliance) = (pair(), varying());
        let cycle = Mesh::new(&pair, &compliance, Settings::default()).unwrap();
        let smooth = relieved(&pair, amount, length, SMOOTH);
        let off = [500, 8001].map(|count| off(&cycle, [&traced(&pair, &smooth, count), &smooth], torque));
        prop_assert!(off[1] <= 1e-6 && off[0] <= 2e-4, "{off:?}");
        let kinked = relieved(&pair, amount, length, Curve::Parabolic);
        let trace = traced(&pair, &kinked, 8001);
        let [from_a, from_e] = starts(&pair, &kinked);
        let flank = Flank::new(&pair, Side::Pinion);
        let step = (flank.tip_roll - flank.root_roll) * flank.base_radius / 8000.0;
        let kinks = if (from_a - from_e).abs() < 10.0 * step { 2.0 } else { 1.0 };
        let off = worst(&cycle, [&trace, &kinked], torque);
        // Both gears' points are as far from each other, and their reliefs start with as much of a slope over the roll length.
        prop_assert!(off <= 0.171 * kinks * step * 0.44012 * amount / length + 1e-13, "{off:e}, {kinks}");
    }
}

/// Tier: second method; a trace of crowning, which a spline follows to the last digit, is that crowning to every solver: with and without
/// corner contact, slices on their own and coupled, neighbouring teeth that hold each other, and the logarithmic law.
#[test]
fn a_trace_of_crowning_is_crowning_to_every_solver() {
    let pair = pair();
    let plain = crowned(&pair);
    let trace = traced(&pair, &plain, 500);
    let mut uneven = plain.clone();
    uneven.add(Gears::Gear, &LeadCrowning { amount: 5e-6 }, &pair).unwrap();
    let mut uneven_trace = trace.clone();
    uneven_trace.add(Gears::Gear, &LeadCrowning { amount: 5e-6 }, &pair).unwrap();
    for compliance in [varying(), coupled(), inclined(coupled())] {
        for contact in [ContactLaw::Linear, ContactLaw::LoadDependent] {
            let compliance = PairCompliance { contact: Some(contact), ..compliance.clone() };
            for (corner_contact, slice_coupling, slices) in [
                (CornerContact::None, SliceCoupling::None, 17),
                (CornerContact::Exact, SliceCoupling::None, 9),
                (CornerContact::None, SliceCoupling::Plate, 7),
            ] {
                let settings = Settings { positions: 16, slices, corner_contact, slice_coupling };
                let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
                for designs in [[&trace, &plain], [&uneven_trace, &uneven]] {
                    let off = off(&cycle, designs, 150.0);
                    assert!(off < 1e-7, "{settings:?} {contact:?}: {off:e}");
                }
            }
        }
    }
}

/// Tier: closed form; what is measured all over the flank as a constant only moves the gears nearer.
#[test]
fn a_constant_deviation_shifts_the_transmission_error() {
    let (pair, compliance) = (pair(), varying());
    let cycle = Mesh::new(&pair, &compliance, Settings::default()).unwrap();
    let [low, high] = [0.0, 3e-6].map(|more| {
        let mut design = relieved(&pair, 12e-6, 4e-3, SMOOTH);
        design.add(Gears::Pinion, &profile(&pair, Side::Pinion, 40, |_| more), &pair).unwrap();
        design
    });
    let [low, high] = [&low, &high].map(|design| cycle.loaded(design, 150.0));
    for point in low.curve(Wanted::default()) {
        let [low, high] =
            [&low, &high].map(|loading| loading.state(point.cycle_position, point.pairs).transmission_error());
        assert!((low - high - 3e-6).abs() < 1e-13, "{low:e} {high:e}");
    }
}

/// Waves of an amplitude and a length along the line of action, on a relieved pinion.
fn wavy(pair: &GearPair, amplitude: f64, length: f64) -> Design {
    let plain = relieved(pair, 12e-6, 4e-3, SMOOTH);
    let turn = std::f64::consts::TAU * pair.pinion.base_radius / length;
    let mut design = Design::default();
    let waves = |roll: f64| amplitude * libm::sin(turn * roll) - plain.depth(Side::Pinion, roll);
    design.add(Gears::Pinion, &profile(pair, Side::Pinion, 1500, waves), pair).unwrap();
    design
}

/// Tier: second method; the gap of wavy flanks is the least of a fine scan, whether the mate gets to the bottom of all valleys or not.
#[test]
fn the_gap_of_wavy_flanks_is_the_least_of_a_scan() {
    let pair = pair();
    for (amplitude, length, within) in [(0.05e-6, 1e-3, 1e-12), (0.2e-6, 0.5e-3, 5e-11), (0.05e-6, 0.125e-3, 5e-11)] {
        let design = wavy(&pair, amplitude, length);
        let profiles = design.profiles(0.0);
        let gaps = Gaps::new(&pair, &profiles);
        let (start, end) = (pair.start_of_contact, pair.end_of_contact);
        let mut worst = 0.0_f64;
        for s in places([start, end], 203).into_iter().skip(1).take(201) {
            let scan = scanned(&pair, &design, s);
            let gap = gaps.at(s).unwrap();
            worst = worst.max((gap - scan).abs());
        }
        assert!(worst <= within, "{amplitude} {length}: {worst:e}");
    }
}

/// The least gap of 20 000 places within 2.5 mm to either side, by distances about the gears' own tangent points.
fn scanned(pair: &GearPair, design: &Design, s: f64) -> f64 {
    let facings = [Side::Gear, Side::Pinion].map(|side| (side, Facing::new(pair, side)));
    let mut least = f64::INFINITY;
    for (side, facing) in facings {
        let nominal = facing.turned(side, s);
        for step in 0..10_000 {
            let before = 2.5e-3 * f64::from(step) / 10_000.0;
            let point = nominal + before;
            if point > facing.end {
                break;
            }
            let touch = facing.touch(point, before);
            if touch.curvature > facing.end {
                break;
            }
            let depth = design.depth(side, facing.point_roll(point))
                + design.depth(side.other(), facing.flank_roll(touch.curvature));
            least = least.min(touch.separation + depth);
        }
    }
    least
}

/// Tier: second method; a lead that is a trace of crowning, by slices, and the crowning in closed form, as slices become more.
#[test]
fn a_trace_across_the_face_is_sliced() {
    let (pair, compliance) = (pair(), varying());
    let mut plain = Design::default();
    plain.add(Gears::Gear, &LeadCrowning { amount: 6e-6 }, &pair).unwrap();
    let mut design = Design::default();
    let half = 0.5 * pair.gear.specification.face_width;
    design.add(Gears::Gear, &lead(&pair, Side::Gear, 90, |z| -6e-6 * (z / half) * (z / half)), &pair).unwrap();
    for (slices, within) in [(17, 2e-3), (257, 2e-5)] {
        let settings = Settings { slices, ..Settings::default() };
        let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
        let off = off(&cycle, [&design, &plain], 150.0);
        assert!(off < within, "{slices}: {off:e}");
    }
}

/// Tier: second method; a grid of what is a sum is the sum of the traces along and across.
#[test]
fn a_grid_of_a_sum_is_the_sum_of_both_traces() {
    let (pair, compliance) = (pair(), varying());
    let (flank, half) = (Flank::new(&pair, Side::Gear), 0.5 * pair.gear.specification.face_width);
    let along = |roll: f64| {
        let t = (roll - flank.root_roll) / (flank.tip_roll - flank.root_roll);
        -8e-6 * (2.0 * t - 1.0) * (2.0 * t - 1.0)
    };
    let across = |z: f64| 2e-6 * libm::cos(3.0 * z / half);
    let (profile, lead) = (profile(&pair, Side::Gear, 60, along), lead(&pair, Side::Gear, 30, across));
    let mut sum = Design::default();
    for part in [&profile, &lead] {
        sum.add(Gears::Gear, part, &pair).unwrap();
    }
    let mut grid = Design::default();
    let deviations =
        lead.deviations.iter().flat_map(|of_z| profile.deviations.iter().map(move |of_roll| of_z + of_roll));
    let stated =
        Measured { deviations: deviations.collect(), face_positions: lead.face_positions.clone(), ..profile.clone() };
    grid.add(Gears::Gear, &stated, &pair).unwrap();
    for corner_contact in [CornerContact::None, CornerContact::Exact] {
        let settings = Settings { positions: 16, corner_contact, ..Settings::default() };
        let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
        let off = off(&cycle, [&grid, &sum], 150.0);
        assert!(off < 1e-7, "{corner_contact:?}: {off:e}");
    }
}

/// Tier: closed form; smoothing leaves parabolas, up to both ends and whatever the distances of points, and half of a wave whose length is
/// the cutoff; of one twice as long (1 + u) exp(−u) with u = 1.678/4.
#[test]
fn smoothing_leaves_parabolas_and_half_of_a_wave() {
    let uneven: Vec<f64> = places([0.0, 1.0], 400).into_iter().map(|t| 8e-3 * (t + 0.2 * t * t)).collect();
    let smoothing = Smoothing::Gaussian { cutoff: 0.5e-3 };
    let parabola: Vec<f64> = uneven.iter().map(|x| 3e-6 - 2e-3 * x + 0.4 * x * x).collect();
    for (smooth, exact) in smoothing.smoothed(&uneven, &parabola).iter().zip(&parabola) {
        assert!((smooth - exact).abs() < 1e-17, "{smooth:e} {exact:e}");
    }
    let even = places([0.0, 8e-3], 801);
    let quarter = 0.25 * 1.678_346_990_016_661;
    for (length, left) in [(0.5e-3, 0.5), (1e-3, (1.0 + quarter) * libm::exp(-quarter)), (0.1e-3, 0.0)] {
        let wave = |x: f64| 1e-6 * libm::cos(std::f64::consts::TAU * x / length);
        let values: Vec<f64> = even.iter().map(|x| wave(*x)).collect();
        let smooth = smoothing.smoothed(&even, &values);
        for at in 300..500 {
            assert!((smooth[at] - left * wave(even[at])).abs() < 1e-11, "{length}: {:e}", smooth[at]);
        }
    }
    // Points farther apart than the cutoff stay as they are.
    let few = [0.0, 1e-3, 2e-3, 3e-3];
    assert_eq!(smoothing.smoothed(&few, &[1e-6, -1e-6, 2e-6, 0.0]), [1e-6, -1e-6, 2e-6, 0.0]);
}

/// Tier: closed form; the same trace by its roll lengths, roll angles and diameters, and what it comes to: material that grows by 6 µm to the
/// tip, held where the trace ends.
#[test]
fn a_trace_is_evaluated_and_may_be_told_by_diameters() {
    let pair = pair();
    let flank = Flank::new(&pair, Side::Pinion);
    let rise = |roll: f64| 6e-6 * (roll - flank.root_roll) / (flank.tip_roll - flank.root_roll);
    let by_length = profile(&pair, Side::Pinion, 50, rise);
    let rolls = places([flank.root_roll, flank.tip_roll], 50);
    let by_angle = Measured { roll_lengths: None, roll_angles: Some(rolls.clone()), ..by_length.clone() };
    let diameters = rolls.iter().map(|roll| flank.diameter(*roll)).collect();
    let by_diameter = Measured { roll_lengths: None, diameters: Some(diameters), ..by_length.clone() };
    for stated in [&by_length, &by_angle, &by_diameter] {
        let mut design = Design::default();
        design.add(Gears::Pinion, stated, &pair).unwrap();
        let middle = 0.5 * (flank.root_roll + flank.tip_roll);
        assert!((design.depth(Side::Pinion, middle) + 3e-6).abs() < 1e-15);
        assert!((design.depth(Side::Pinion, 2.0 * flank.tip_roll) + 6e-6).abs() < 1e-15);
        let resolved = design.resolved();
        let value = |name: &str| resolved.iter().find(|row| row.2 == name).unwrap().3;
        let exact = [
            ("amount", -6e-6),
            ("profile_slope_deviation", 6e-6),
            ("profile_form_deviation", 0.0),
            ("profile_total_deviation", 6e-6),
            ("profile_crowning", 0.0),
        ];
        for (name, exact) in exact {
            assert!((value(name) - exact).abs() < 1e-14, "{name}: {:e}", value(name));
        }
        assert!((value("profile_evaluation_end") - flank.base_radius * flank.tip_roll).abs() < 1e-12);
    }
}

/// d = 2 √(r_b² + L_y²): limits as diameters are those as roll lengths; across the face there are none.
#[test]
fn limits_of_the_evaluation_may_be_diameters() {
    let pair = pair();
    for (_, side) in SIDES {
        let flank = Flank::new(&pair, side);
        let measured = profile(&pair, side, 200, |roll| -1e-5 * roll * roll);
        let [start, end] =
            [0.2, 0.9].map(|share| flank.base_radius * (flank.root_roll + share * (flank.tip_roll - flank.root_roll)));
        let diameter = |length: f64| 2.0 * flank.base_radius.hypot(length);
        let by_length = Measured { evaluation_start: Some(start), evaluation_end: Some(end), ..measured.clone() };
        let by_diameter = Measured {
            evaluation_start_diameter: Some(diameter(start)),
            evaluation_end_diameter: Some(diameter(end)),
            ..measured.clone()
        };
        let mixed = Measured { evaluation_start_diameter: None, evaluation_start: Some(start), ..by_diameter.clone() };
        let values = |measured: &Measured| measured.on(&pair, side).unwrap().resolved();
        for other in [&by_diameter, &mixed] {
            for (one, other) in values(&by_length).iter().zip(values(other)) {
                assert!(one.0 == other.0 && (one.1 - other.1).abs() <= 1e-12, "{one:?} {other:?}");
            }
        }
        let inside = Measured { evaluation_start_diameter: Some(1.9 * flank.base_radius), ..measured };
        let refused = inside.on(&pair, side).unwrap_err().message;
        assert!(refused.contains("inside the base circle of this gear"), "{refused}");
        let across = Measured { evaluation_end_diameter: Some(0.06), ..lead(&pair, side, 50, |_| 0.0) };
        assert!(across.check().unwrap_err().message.contains("of a trace along the profile"));
    }
}
