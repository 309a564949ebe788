//! Corner contact: continuity, balance, symmetry, limits, and brute force.

use super::*;
use crate::gear::contact::CornerContact;
use crate::gear::contact::separation::Facing;
use crate::gear::fixtures;
use crate::gear::geometry::Side;

pub(super) fn exact(pair: &GearPair, compliance: &PairCompliance, positions: usize) -> Mesh {
    let settings = Settings { positions, slices: 9, corner_contact: CornerContact::Exact, ..Settings::default() };
    Mesh::new(pair, compliance, settings).unwrap()
}

/// Gentle, long and steep: the last are like those of mei2016, 44 to 220 µm over 5 to 25 % of the flank.
pub(super) fn designs(pair: &GearPair) -> Vec<Design> {
    let tip = |gear: &'static str, amount: f64, length: f64, curve: &'static str| {
        (gear, [("amount", Quantity(amount)), ("length", Quantity(length)), ("curve", Choice(curve))])
    };
    let of = |reliefs: &[(&'static str, [(&'static str, declare::record::Value); 3])]| {
        let parts: Vec<fixtures::NamedModification> =
            reliefs.iter().map(|(gear, values)| ("tip_relief", *gear, &values[..])).collect();
        design(pair, &parts).unwrap()
    };
    vec![
        Design::default(),
        of(&[tip("both", 7e-6, 3.4e-3, "parabolic")]),
        of(&[tip("pinion", 44e-6, 0.8e-3, "linear"), tip("gear", 90e-6, 2.2e-3, "parabolic")]),
        of(&[tip("both", 220e-6, 3.6e-3, "parabolic")]),
        ga_design(pair, 20e-6, 5e-3, 9e-6),
    ]
}

fn models() -> Vec<PairCompliance> {
    let with = |contact: ContactLaw, model: PairCompliance| PairCompliance { contact: Some(contact), ..model };
    let mut models = vec![varying(), coupled()];
    for contact in [ContactLaw::LoadDependent, ContactLaw::Resolved] {
        models.extend([with(contact, coupled()), with(contact, varying())]);
    }
    models.push(with(ContactLaw::Resolved, inclined(coupled())));
    models
}

/// Off the line of action both ends of contact are passed without a jump.
#[test]
fn the_curve_is_continuous() {
    for ratio in [1.645_626_2, 2.0, 2.3, 1.05] {
        let pair = pair_with_contact_ratio(ratio);
        for compliance in models() {
            for design in designs(&pair) {
                assert_continuous(&exact(&pair, &compliance, 24), &design);
            }
        }
    }
}

pub(super) fn assert_continuous(cycle: &Mesh, design: &Design) {
    let ratio = cycle.pair.contact_ratio;
    for torque in [1e-9, 50.0, 2500.0] {
        let loading = cycle.loaded(design, torque);
        let points = loading.curve(Wanted::default());
        let value = |point: &super::super::answers::curve::Point| point.transmission_error;
        let (first, last) = (points[0], points[points.len() - 1]);
        let size = value(&first) + 1e-12;
        assert!((value(&first) - value(&last)).abs() < 1e-9 * size, "{ratio} {torque} over A");
        for two in points.windows(2).filter(|two| two[0].pairs != two[1].pairs) {
            assert!((value(&two[0]) - value(&two[1])).abs() < 1e-12 * size, "{ratio} {torque} at E");
        }
        // Without jumps: no two positions a nanometre apart differ by more than a steep slope.
        for cut in points.iter().map(|point| point.cycle_position) {
            let [low, high] = [-0.5e-9, 0.5e-9].map(|shift| {
                let at = (cut + shift).clamp(0.0, cycle.period());
                loading.state(at, 1).transmission_error()
            });
            assert!((low - high).abs() < 1e-9 * 0.5, "{ratio} {torque}: {low:e} {high:e} at {cut}");
        }
    }
}

#[test]
fn peak_to_peak_does_not_depend_on_the_number_of_positions() {
    let pair = pair();
    for (which, compliance) in models().iter().enumerate() {
        let cycles = [16, 64, 1000].map(|positions| exact(&pair, compliance, positions));
        for (index, design) in designs(&pair).iter().enumerate() {
            for torque in [1.0, 50.0, 300.0, 2500.0] {
                let [coarse, middle, fine] =
                    [0, 1, 2].map(|cycle: usize| cycles[cycle].loaded(design, torque).peak_to_peak());
                for found in [coarse, middle] {
                    // The tables of the wedge are joined with slopes that differ in the sixth digit.
                    let close = if compliance.contact == Some(ContactLaw::Resolved) { 1e-8 } else { 1e-9 };
                    assert!((found / fine - 1.0).abs() < close, "{which} {index} {torque}: {found:e} {fine:e}");
                }
            }
        }
    }
}

/// By how much the normals of both flanks differ where a corner touches, by the angles of both, pinion's corner and gear's.
fn inclinations_by_hand(pair: &GearPair, s: f64) -> [f64; 2] {
    let (one, two, length) = (pair.pinion.base_radius, pair.gear.base_radius, pair.tangent_length);
    let corner = |own: f64, other: f64, position: f64, nominal: f64| {
        let (roll, angle) = ((length - position) / own, (position - nominal).max(0.0) / own);
        let x = length - own * (roll * angle.cos() + angle.sin());
        let y = own + other - own * (angle.cos() - roll * angle.sin());
        angle - (x.atan2(y) - ((x * x + y * y) / (other * other) - 1.0).sqrt().atan())
    };
    [corner(one, two, length - pair.end_of_contact, length - s), corner(two, one, pair.start_of_contact, s)]
}

/// Tier: second method; and the sense: a corner that has left the line of action is pressed more towards its root.
#[test]
fn loads_at_corners_are_normal_to_the_other_flank() {
    let pair = pair();
    let cycle = exact(&pair, &varying(), 24);
    for step in -30..=230 {
        let s = pair.start_of_contact + 0.05e-3 * f64::from(step) * pair.contact_ratio;
        for (found, exact) in cycle.inclinations(s).into_iter().zip(inclinations_by_hand(&pair, s)) {
            let inside = s >= pair.start_of_contact && s <= pair.end_of_contact;
            assert!(if inside { found == 0.0 } else { (found - exact).abs() < 1e-12 }, "{s}: {found} for {exact}");
        }
        let [pinion, gear] = cycle.inclinations(s);
        assert!((gear > 0.0) == (s < pair.start_of_contact) && (pinion > 0.0) == (s > pair.end_of_contact));
    }
}

/// Tier: second method; where a corner lies in the contact, half of what both teeth yield more farther from it, along the
/// flanks: by differences of arcs, r_b u²/2.
#[test]
fn teeth_change_along_the_contact() {
    let pair = pair();
    let compliance = PairCompliance { contact: Some(ContactLaw::Resolved), ..coupled() };
    let cycle = exact(&pair, &compliance, 24);
    for s in [0.1e-3, 3e-3, 9e-3].map(|after| pair.start_of_contact + after) {
        let radii = [s, pair.tangent_length - s];
        let bases = [pair.pinion.base_radius, pair.gear.base_radius];
        // Away from the corner of the gear's tip.
        let teeth = |x: f64| {
            let roll = |side: usize, x: f64| (radii[side].powi(2) + 2.0 * bases[side] * x).sqrt() / bases[side];
            18e-3 * (compliance.pinion.total(roll(0, x)) + compliance.gear.total(roll(1, -x)))
        };
        let exact = 0.5 * (teeth(1e-6) - teeth(-1e-6)) / 2e-6;
        let [pinion, gear] = cycle.tips(s).unwrap().corners.map(|corner| corner.turned.tooth * corner.turned.curvature);
        let combined = radii[0] * radii[1] / (radii[0] + radii[1]);
        assert!((cycle.tips(s).unwrap().corners[0].turned.curvature * combined - 1.0).abs() < 1e-10);
        for (found, exact) in [(gear, exact), (pinion, -exact)] {
            // Flanks that are hardly curved, near the base circle, are not followed to the last.
            assert!((found / exact - 1.0).abs() < 2e-2, "{s}: {found:e} for {exact:e}");
        }
    }
}

/// Separation and rolls by polar coordinates, as in no line of the program.
fn by_hand(pair: &GearPair, s: f64) -> (f64, f64, f64) {
    let (one, two, length) = (pair.pinion.base_radius, pair.gear.base_radius, pair.tangent_length);
    let corner = |own: f64, other: f64, position: f64, nominal: f64| {
        let (roll, angle) = ((length - position) / own, (nominal - position) / own);
        let x = length - own * (roll * angle.cos() - angle.sin());
        let y = own + other - own * (roll * angle.sin() + angle.cos());
        let touched = ((x * x + y * y) / (other * other) - 1.0).sqrt();
        (other * (x.atan2(y) - touched.atan() + touched) - nominal, touched, roll)
    };
    if s < pair.start_of_contact {
        let (gap, pinion, gear) = corner(two, one, pair.start_of_contact, s);
        (gap, pinion, gear)
    } else if s > pair.end_of_contact {
        let (gap, gear, pinion) = corner(one, two, length - pair.end_of_contact, length - s);
        (gap, pinion, gear)
    } else {
        (0.0, s / one, (length - s) / two)
    }
}

/// Everything by hand on a uniform grid: unmodified gears, pairs summed, bisection on the balance of loads.
#[test]
fn unmodified_gears_agree_with_a_brute_grid() {
    let pair = pair();
    let compliance = varying();
    let cycle = exact(&pair, &compliance, 24);
    let contact = 4.0 * 0.91 / (std::f64::consts::PI * 206e9 * 18e-3);
    for torque in [5.0, 50.0, 700.0, 4000.0] {
        let force = torque / pair.pinion.base_radius;
        let (mut low, mut high, mut sum) = (f64::INFINITY, 0.0_f64, 0.0);
        let count = 20_000;
        for i in 0..count {
            let tau = BASE_PITCH * (f64::from(i) + 0.5) / f64::from(count);
            let springs: Vec<(f64, f64)> = (-1..3)
                .map(|pitch| pair.start_of_contact + tau + BASE_PITCH * f64::from(pitch))
                .filter(|s| *s > pair.start_of_contact - 7e-3 && *s < pair.end_of_contact + 7e-3)
                .map(|s| {
                    let (gap, u1, u2) = by_hand(&pair, s);
                    (gap, 1.0 / (compliance.pinion.total(u1) + compliance.gear.total(u2) + contact))
                })
                .collect();
            let (mut a, mut b) = (0.0, 2e-3);
            for _ in 0..60 {
                let middle = 0.5 * (a + b);
                let load: f64 = springs.iter().map(|(gap, k)| k * f64::max(middle - gap, 0.0)).sum();
                if load < force { a = middle } else { b = middle }
            }
            (low, high, sum) = (low.min(b), high.max(b), sum + b);
        }
        let summary = cycle.loaded(&Design::default(), torque).summary(Wanted::default());
        close(summary.peak_to_peak, high - low, 3e-4);
        assert!(summary.peak_to_peak >= (high - low) * (1.0 - 1e-9), "a grid cannot see more than everything");
        close(summary.mean, sum / f64::from(count), 1e-6);
        assert!(summary.loaded_contact_ratio > pair.contact_ratio + 0.01);
    }
}

#[test]
fn loads_balance_and_fulfil_complementarity() {
    let pair = pair_with_contact_ratio(2.3);
    let compliance = inclined(coupled());
    let cycle = exact(&pair, &compliance, 24);
    let contact = 4.0 * 0.91 / (std::f64::consts::PI * 206e9 * 18e-3);
    let mut corners = 0;
    for (design, torque) in designs(&pair).iter().flat_map(|design| [(design, 80.0), (design, 3000.0)]) {
        if design.pinion.iter().any(|part| part.modification.varies_along_face()) {
            continue;
        }
        let gaps = crate::gear::contact::gap::Gaps::new(&pair, &design.profiles(0.0));
        for point in cycle.loaded(design, torque).curve(Wanted::default()) {
            close(point.loads.iter().sum(), torque / pair.pinion.base_radius, 1e-12);
            let places = (0..5).map(|spring| point.path_position + BASE_PITCH * (f64::from(spring) - 1.0));
            let springs: Vec<_> = places.enumerate().filter(|(_, s)| gaps.at(*s).is_some()).collect();
            for &(j, s) in &springs {
                let (_, u1, u2) = by_hand(&pair, s);
                let turned = |s: f64| {
                    let outside = s < pair.start_of_contact || s > pair.end_of_contact;
                    inclinations_by_hand(&pair, s).map(|turn| if outside { turn } else { 0.0 })
                };
                // A tooth of 0.8 across for 1 along its normal.
                let own = |turn: f64| (2.0 * turn).sin() * -0.8e-9 + turn.sin().powi(2) * 0.05e-9;
                let [of_pinion, of_gear] = turned(s);
                let mut deflection = point.loads[j]
                    * (compliance.pinion.total(u1)
                        + own(of_pinion)
                        + compliance.gear.total(u2)
                        + own(of_gear)
                        + contact);
                for &(k, other) in springs.iter().filter(|(k, _)| *k != j) {
                    let (_, v1, v2) = by_hand(&pair, other);
                    let of = |tooth: &crate::gear::compliance::ToothCompliance, first: f64, further: f64, turn: f64| {
                        let pitches = j.abs_diff(k);
                        let at_tip = -0.18e-9 / pitches as f64 * (1.0 + 0.3 * first);
                        let normal = tooth.neighbours.get(pitches - 1);
                        normal.map_or(0.0, |normal| turn.cos() * normal.value(first, further) + turn.sin() * at_tip)
                    };
                    let ahead = k > j;
                    let (behind_s, ahead_s) = if ahead { (s, other) } else { (other, s) };
                    let turns = [turned(ahead_s)[0], turned(behind_s)[1]];
                    let pinion = if ahead { [u1, v1] } else { [v1, u1] };
                    let gear = if ahead { [v2, u2] } else { [u2, v2] };
                    let pinion = of(&compliance.pinion, pinion[0], pinion[1], turns[0]);
                    let gear = of(&compliance.gear, gear[0], gear[1], turns[1]);
                    deflection += point.loads[k] * (pinion + gear);
                }
                let open = gaps.at(s).unwrap() + deflection - point.transmission_error;
                if point.loads[j] > 0.0 {
                    assert!(open.abs() < 1e-11 * point.transmission_error, "{open:e} at {s}");
                    corners += usize::from(s < pair.start_of_contact || s > pair.end_of_contact);
                } else {
                    assert!(open > -1e-11 * point.transmission_error, "{open:e} at {s}");
                }
            }
            let unreached = (0..6).filter(|spring| springs.iter().all(|(j, _)| j != spring));
            assert!(unreached.map(|spring| point.loads[spring]).sum::<f64>() == 0.0);
        }
    }
    assert!(corners > 100, "{corners} loaded corners were looked at");
}

/// Driving and driven gear may change places: the curve is then run through backwards.
#[test]
fn swapping_the_gears_mirrors_the_curve() {
    let pair = pair();
    let swapped = swapped(&pair);
    let tip = [("amount", Quantity(30e-6)), ("length", Quantity(2e-3)), ("curve", Choice("parabolic"))];
    let root = [("amount", Quantity(5e-6)), ("fraction", Quantity(0.5))];
    let of = |pair: &GearPair, one: &'static str, two: &'static str| {
        design(pair, &[("tip_relief", one, &tip), ("root_relief", two, &root)]).unwrap()
    };
    let (one, two) = (of(&pair, "pinion", "gear"), of(&swapped, "gear", "pinion"));
    for compliance in models() {
        let mirrored =
            PairCompliance { pinion: compliance.gear.clone(), gear: compliance.pinion.clone(), ..compliance.clone() };
        let (here, there) = (exact(&pair, &compliance, 24), exact(&swapped, &mirrored, 24));
        for (torque, designs) in [(50.0, [&one, &two]), (2500.0, [&one, &two]), (50.0, [&Design::default(); 2])] {
            let here = here.loaded(designs[0], torque);
            let there = there.loaded(designs[1], torque * 48.0 / 19.0);
            for index in 0..200 {
                let tau = BASE_PITCH * (f64::from(index) + 0.3) / 200.0;
                // E folded into the cycle is where the mirrored one starts.
                let shared = (pair.contact_ratio - pair.contact_ratio.floor()) * BASE_PITCH;
                let back = shared - tau + if tau > shared { BASE_PITCH } else { 0.0 };
                let (one, two) = (here.state(tau, 1).transmission_error(), there.state(back, 1).transmission_error());
                close(one, two, 1e-12);
            }
            close(here.peak_to_peak(), there.peak_to_peak(), 1e-11);
        }
    }
}

/// As the load vanishes corners no longer touch: what they change goes down with the root of the load, the width of the
/// separation's parabola.
#[test]
fn a_vanishing_load_gives_the_nominal_curve() {
    let pair = pair();
    for compliance in [varying(), coupled()] {
        let (with, without) = (exact(&pair, &compliance, 64), cycle(&pair, &compliance));
        let design = Design::default();
        let change = |torque: f64| {
            let of = |cycle: &Mesh| cycle.loaded(&design, torque).summary(Wanted::default());
            let (with, without) = (of(&with), of(&without));
            if torque < 60.0 {
                close(with.peak_to_peak, without.peak_to_peak, 0.02);
            }
            (1.0 - with.mean / without.mean, with.loaded_contact_ratio - without.loaded_contact_ratio)
        };
        let mut before = change(1e-4);
        for torque in [1e-6, 1e-8, 1e-10] {
            let next = change(torque);
            assert!((before.0 / next.0 - 10.0).abs() < 0.3, "{} {}", before.0, next.0);
            assert!((before.1 / next.1 - 10.0).abs() < 0.3, "{} {}", before.1, next.1);
            before = next;
        }
    }
}

/// A tip relief deeper than the approach keeps the corners apart.
#[test]
fn relief_above_the_deflection_leaves_no_corner_contact() {
    let pair = pair();
    let cycle = exact(&pair, &varying(), 64);
    let relief = [("amount", Quantity(40e-6)), ("length", Quantity(4.5e-3))];
    let design = design(&pair, &[("tip_relief", "both", &relief)]).unwrap();
    let loading = cycle.loaded(&design, 50.0);
    let points = loading.curve(Wanted::default());
    assert!(points.iter().all(|point| point.loads[0] == 0.0 && point.loaded_pairs <= point.pairs));
    let unmodified = Design::default();
    let touched = cycle.loaded(&unmodified, 50.0).curve(Wanted::default());
    assert!(touched.iter().any(|point| point.loads[0] > 0.0 && point.loaded_pairs > point.pairs));
}

#[test]
fn vanishing_torques_are_solved_and_absurd_ones_refused() {
    let pair = pair();
    for compliance in models() {
        let cycle = exact(&pair, &compliance, 24);
        for design in designs(&pair) {
            let small = cycle.loaded(&design, 1e-9);
            assert!(small.peak_to_peak().is_finite());
            let summary = small.summary(Wanted { harmonics: 2, pressure: true, ..Wanted::default() });
            assert!(
                small.check_approach(summary.largest.value).is_ok()
                    && summary.mean.is_finite()
                    && summary.variance >= 0.0
            );
            let absurd = cycle.loaded(&design, 1e9);
            assert!(absurd.peak_to_peak().is_infinite() && absurd.variance().is_infinite());
            let summary = absurd.summary(Wanted::default());
            assert!(absurd.check_approach(summary.largest.value).is_err());
        }
    }
}

/// Just below the approach at which the tips pass each other the answer is finite, just above there is none.
#[test]
fn the_model_ends_where_a_tip_would_pass_the_other() {
    let pair = pair();
    let cycle = exact(&pair, &varying(), 24);
    let design = Design::default();
    let limit = cycle.loaded(&design, 1.0).case.largest_approach();
    let ends = [Side::Gear, Side::Pinion].map(|side| {
        let facing = Facing::new(&pair, side);
        facing.tip(facing.reach(BASE_PITCH)).separation
    });
    close(limit, ends[0].min(ends[1]), 1e-6);
    let largest = |torque: f64| cycle.loaded(&design, torque).summary(Wanted::default()).largest.value;
    let (mut low, mut high) = (1e3, 1e6);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if largest(middle) < limit { low = middle } else { high = middle }
    }
    assert!(cycle.loaded(&design, 0.999 * low).peak_to_peak().is_finite());
    assert!(cycle.loaded(&design, 1.001 * high).peak_to_peak().is_infinite());
}

#[test]
fn more_pairs_than_the_solver_holds_are_refused() {
    let pair = pair_with_contact_ratio(4.2);
    let settings = Settings { corner_contact: CornerContact::Exact, ..Settings::default() };
    let message = Mesh::new(&pair, &varying(), settings).unwrap_err().to_string();
    assert!(message.contains("with corner contact it must be 1 to 4"), "{message}");
    // End of contact near the gear's base circle.
    let high = exact(&pair_with_contact_ratio(3.2), &varying(), 24);
    let summary = high.loaded(&Design::default(), 50.0).summary(Wanted::default());
    assert!(summary.loaded_contact_ratio > 3.2 && summary.peak_to_peak.is_finite());
}
