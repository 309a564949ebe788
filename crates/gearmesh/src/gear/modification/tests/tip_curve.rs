//! `arc` and `parabola` against their definition: the curves of `mei2016` in the article's own frame, met by bisection.

use crate::gear::fixtures::{design, standard};
use crate::gear::geometry::{Gear, GearPair, Side};
use crate::gear::modification::Modification;
use crate::gear::modification::template::Template;
use declare::record::Value::{self, Choice, Number, Quantity, Range};

/// The article's pair: 30/40, module 3 mm.
fn pair() -> GearPair {
    GearPair::new(standard(30, 3e-3, 2.0), standard(40, 3e-3, 2.0), None).unwrap()
}

const FAMILIES: [&str; 2] = ["arc", "parabola"];
const SIDES: [(Side, &str); 2] = [(Side::Pinion, "pinion"), (Side::Gear, "gear")];
const TIP_SHARES: [f64; 5] = [0.02, 0.04, 0.06, 0.08, 0.10];
const LENGTH_SHARES: [f64; 5] = [0.05, 0.10, 0.15, 0.20, 0.25];

fn built(
    family: &'static str,
    gear: &'static str,
    values: &[(&'static str, Value)],
) -> Result<Box<dyn Modification>, String> {
    #[derive(Debug)]
    struct Of(std::sync::Arc<dyn Modification>);
    impl Modification for Of {
        fn depth(&self, roll: f64) -> f64 {
            self.0.depth(roll)
        }
        fn profile_rates(&self, roll: f64, inside: f64) -> Option<[f64; 3]> {
            self.0.profile_rates(roll, inside)
        }
        fn profile_breaks(&self) -> &[f64] {
            self.0.profile_breaks()
        }
        fn resolved(&self) -> Vec<(&'static str, f64)> {
            self.0.resolved()
        }
    }
    let design = design(&pair(), &[(family, gear, values)]).map_err(|error| error.message)?;
    let side = if gear == "pinion" { &design.pinion } else { &design.gear };
    Ok(Box::new(Of(side[0].modification.clone())))
}

fn shares(tip: f64, length: f64) -> [(&'static str, Value); 2] {
    [("tip_share", Number(tip)), ("length_share", Number(length))]
}

fn resolved(part: &dyn Modification, name: &str) -> f64 {
    part.resolved().into_iter().find(|(found, _)| *found == name).unwrap().1
}

/// The curve as a function that is 0 on it, from A and B in the article's frame and the tangent at B.
fn implicit(family: &str, [x_a, y_a]: [f64; 2], [x_b, y_b]: [f64; 2], t: f64) -> Box<dyn Fn(f64, f64) -> f64> {
    if family == "parabola" {
        let distance = x_a - x_b;
        let a = ((y_a - y_b) - t.tan() * distance) / (distance * distance);
        let b = t.tan() - 2.0 * a * x_b;
        let c = y_b - a * x_b * x_b - b * x_b;
        return Box::new(move |x, y| a * x * x + b * x + c - y);
    }
    // The bisector of AB and the line through B along the normal: equations 6 and 7 with the slope −cot t.
    let (slope, bisector) = (-1.0 / t.tan(), (x_b - x_a) / (y_a - y_b));
    let x_0 = (y_b - slope * x_b - 0.5 * (y_a + y_b) + bisector * 0.5 * (x_a + x_b)) / (bisector - slope);
    let y_0 = slope * (x_0 - x_b) + y_b;
    let radius = (x_b - x_0).hypot(y_b - y_0);
    Box::new(move |x, y| (x - x_0).hypot(y - y_0) - radius)
}

/// Where the flank's normal at a roll angle meets the curve, by bisection from the flank inwards.
fn brute(gear: &Gear, curve: &dyn Fn(f64, f64) -> f64, roll: f64, deepest: f64) -> f64 {
    let value = |depth: f64| {
        let length = gear.base_radius * roll - depth;
        curve(gear.base_radius * roll.cos() + length * roll.sin(), gear.base_radius * roll.sin() - length * roll.cos())
    };
    let (mut outside, mut inside) = (-1e-9, deepest);
    assert!(value(outside) > 0.0 && value(inside) < 0.0, "{} {}", value(outside), value(inside));
    for _ in 0..80 {
        let middle = 0.5 * (outside + inside);
        *(if value(middle) > 0.0 { &mut outside } else { &mut inside }) = middle;
    }
    0.5 * (outside + inside)
}

#[test]
fn every_design_of_the_article_is_its_curve() {
    let pair = pair();
    for family in FAMILIES {
        for (side, name) in SIDES {
            let gear = pair.side(side);
            for (tip, length) in TIP_SHARES.iter().flat_map(|tip| LENGTH_SHARES.map(|length| (*tip, length))) {
                let part = built(family, name, &shares(tip, length)).unwrap();
                // B by arc length, r_b u²/2 from the base circle; A by the angle along the tip circle.
                let (u_a, u_f) = (gear.tip_roll(), gear.form_roll);
                let t = (u_a * u_a - length * (u_a * u_a - u_f * u_f)).sqrt();
                let sigma = tip * gear.tip_thickness() / gear.tip_radius;
                let angle = gear.half_base_angle - gear.half_angle(gear.tip_radius) + sigma;
                let a = [gear.tip_radius * angle.cos(), gear.tip_radius * angle.sin()];
                let b = [gear.base_radius * (t.cos() + t * t.sin()), gear.base_radius * (t.sin() - t * t.cos())];
                for (name, value) in [("x_A", a[0]), ("y_A", a[1]), ("x_B", b[0]), ("y_B", b[1])] {
                    assert!((resolved(&*part, name) - value).abs() < 1e-16, "{name}");
                }
                let curve = implicit(family, a, b, t);
                let corner = u_a + sigma;
                assert!(part.depth(t - 1e-9).to_bits() == 0);
                assert!(part.depth(t) < 1e-30);
                // A is on the normal of the corner's roll angle, where the depth is the turn along the base circle.
                assert!((part.depth(corner) - gear.base_radius * sigma).abs() < 1e-16);
                assert!((part.depth(corner + 0.01) - gear.base_radius * sigma).abs() < 1e-16);
                let deepest = 1.5 * gear.base_radius * sigma;
                let mut before = 0.0;
                for step in 1..=60 {
                    let roll = t + (corner - t) * f64::from(step) / 60.0;
                    let depth = part.depth(roll);
                    let exact = brute(gear, &*curve, roll, deepest);
                    assert!((depth - exact).abs() < 1e-14, "{family} {tip} {length}: {depth:e} {exact:e}");
                    assert!(depth > before, "{family} {tip} {length} at {roll}: {depth:e} {before:e}");
                    before = depth;
                }
                assert!(part.depth(u_a) < gear.base_radius * sigma);
                let breaks = part.profile_breaks();
                assert!((breaks[0] - t).abs() < 1e-15 && (breaks[1] - corner).abs() < 1e-15);
            }
        }
    }
}

/// Tier: second method; differences of the depth to the fourth order, between B and A, and both limits at either.
#[test]
fn rates_are_those_of_the_depth() {
    for (family, (tip, length)) in
        FAMILIES.into_iter().flat_map(|family| TIP_SHARES.into_iter().zip(LENGTH_SHARES).map(move |of| (family, of)))
    {
        let part = built(family, "gear", &shares(tip, length)).unwrap();
        let &[start, corner] = part.profile_breaks() else { panic!("it has two") };
        for share in [0.1, 0.37, 0.5, 0.83] {
            let (roll, step) = (start + share * (corner - start), 0.02 * (corner - start));
            let [depth, slope, bend] = part.profile_rates(roll, roll).unwrap();
            assert_eq!(depth.to_bits(), part.depth(roll).to_bits());
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|steps| part.depth(roll + steps * step));
            let by_differences = (a - d + 8.0 * (c - b)) / (12.0 * step);
            assert!((by_differences / slope - 1.0).abs() < 2e-5, "{family} {share}: {slope} {by_differences}");
            let by_differences = (16.0 * (b + c) - a - d - 30.0 * depth) / (12.0 * step * step);
            assert!((by_differences / bend - 1.0).abs() < 2e-5, "{family} {share}: {bend} {by_differences}");
        }
        let middle = 0.5 * (start + corner);
        assert_eq!(part.profile_rates(start, start - 0.1), Some([0.0; 3]));
        assert_eq!(part.profile_rates(corner, corner + 0.1), Some([part.depth(corner), 0.0, 0.0]));
        // It leaves the flank along its tangent, but curved.
        let [depth, slope, bend] = part.profile_rates(start, middle).unwrap();
        let square = part.depth(start + 1e-6) / 1e-12;
        assert!(depth.abs() < 1e-30 && slope.abs() < 1e-18 && (0.5 * bend / square - 1.0).abs() < 1e-4);
        assert!(part.profile_rates(corner, middle).unwrap()[1] > 0.0);
    }
}

/// The curve leaves the flank with its own curvature: depth → (κ r_b² t² − r_b t)(u − t)²/2, with all its digits.
#[test]
fn near_b_the_depth_is_a_clean_square() {
    let pair = pair();
    let gear = &pair.pinion;
    for family in FAMILIES {
        let part = built(family, "pinion", &shares(0.06, 0.15)).unwrap();
        let value = |name| resolved(&*part, name);
        let (t, rise) = (value("start_roll_angle"), gear.base_radius);
        let (x, y) = (value("x_A") - value("x_B"), value("y_A") - value("y_B"));
        let (along, across) = (x * t.cos() + y * t.sin(), x * t.sin() - y * t.cos());
        let curvature = if family == "arc" {
            -2.0 * across / (along * along + across * across)
        } else {
            2.0 * (y - t.tan() * x) / (x * x) * t.cos().powi(3)
        };
        let limit = 0.5 * rise * t * (curvature * rise * t - 1.0);
        for turn in [1e-4, 1e-6, 1e-8, 1e-10] {
            let square = part.depth(t + turn) / (turn * turn);
            // What the sum t + turn rounds to is known to half a digit of t only.
            let tolerance = 20.0 * turn + 4.0 * f64::EPSILON * t / turn;
            assert!((square / limit - 1.0).abs() < tolerance, "{family} {turn}: {square} {limit}");
        }
    }
}

#[test]
fn all_four_fields_say_the_same() {
    let pair = pair();
    let by_shares = built("arc", "gear", &shares(0.06, 0.15)).unwrap();
    let (amount, diameter) = (0.06 * pair.gear.tip_thickness(), resolved(&*by_shares, "start_diameter"));
    let by_lengths =
        built("arc", "gear", &[("tip_amount", Quantity(amount)), ("start_diameter", Quantity(diameter))]).unwrap();
    for step in 0..20 {
        let roll = 0.4 + 0.005 * f64::from(step);
        assert!((by_shares.depth(roll) - by_lengths.depth(roll)).abs() < 1e-17);
    }
}

#[test]
fn what_adds_material_or_turns_back_is_refused_with_the_range() {
    let refused = |family, tip, length| built(family, "pinion", &shares(tip, length)).unwrap_err();
    for family in FAMILIES {
        // A in the corner itself: the involute bends less and less, the curve does not.
        let message = refused(family, 0.0, 0.25);
        assert!(message.contains("would add") && message.contains("um of material at a roll angle of"), "{message}");
        assert!(message.contains("with this B, A may be moved by"), "{message}");
        // The range it names is the range: just inside is taken, just outside is not.
        let number =
            |word: &str| message.split(word).nth(1).unwrap().split_whitespace().next().unwrap().parse::<f64>().unwrap();
        let (minimum, maximum) = (number("moved by ") * 1e-2, number(" to ") * 1e-2);
        assert!(0.0 < minimum && minimum < 0.02 && maximum > 0.1 && maximum <= 0.5, "{message}");
        assert!(built(family, "pinion", &shares(minimum + 1e-5, 0.25)).is_ok());
        assert!(built(family, "pinion", &shares(minimum - 1e-5, 0.25)).is_err());
        if maximum < 0.5 {
            assert!(built(family, "pinion", &shares(maximum - 1e-5, 0.25)).is_ok());
            assert!(built(family, "pinion", &shares(maximum + 1e-5, 0.25)).is_err());
        }
        // The whole involute: no place on the tip circle makes up for the bend.
        let message = refused(family, 0.06, 1.0);
        assert!(message.contains("below the tip by") || message.contains("may be moved by"), "{message}");
        // From the corner itself neither curve gets to A without turning back over it.
        let message = refused(family, 0.06, 0.0);
        assert!(message.contains("with this B") || message.contains("with this A"), "{message}");
        // A relief of no length and no depth is none.
        let nothing = built(family, "pinion", &shares(0.0, 0.0)).unwrap();
        assert!([0.2, 0.4, 0.6].iter().all(|roll| nothing.depth(*roll) == 0.0));
    }
    let fields = |amount, diameter| [("tip_amount", Quantity(amount)), ("start_diameter", Quantity(diameter))];
    let message = built("arc", "pinion", &fields(1.2e-3, 94e-3)).unwrap_err();
    assert!(message.contains("1.200000 mm") && message.contains("0 to 1.1061"), "{message}");
    let message = built("arc", "pinion", &fields(0.1e-3, 97e-3)).unwrap_err();
    assert!(message.contains("85.60") && message.contains("96.000000 mm"), "{message}");
    let message = built("arc", "pinion", &[("tip_share", Number(0.1))]).unwrap_err();
    assert!(message.contains("exactly one of `length_share`, `start_diameter`"), "{message}");
    let both = [("tip_share", Number(0.1)), ("tip_amount", Quantity(1e-4)), ("length_share", Number(0.1))];
    assert!(built("arc", "pinion", &both).unwrap_err().contains("not both `tip_share` and `tip_amount`"));
}

/// Equations 14 and 15 in mm, the article's α' being the pressure angle at B, written down once more.
fn printed_circle(gear: &Gear, tip: f64, length: f64) -> (f64, impl Fn(f64, f64) -> f64) {
    let (u_a, u_f, rise) = (gear.tip_roll(), gear.form_roll, gear.base_radius * 1e3);
    let pressure = (u_a * u_a - length * (u_a * u_a - u_f * u_f)).sqrt().atan();
    let (x_b, y_b) = (
        rise * pressure.cos() + rise * pressure * pressure.sin(),
        rise * pressure.sin() - rise * pressure * pressure.cos(),
    );
    let angle = u_a - u_a.atan() + tip * gear.tip_thickness() / gear.tip_radius;
    let (x_a, y_a) = (gear.tip_radius * 1e3 * angle.cos(), gear.tip_radius * 1e3 * angle.sin());
    let (k, m) = ((2.0 * pressure - pressure.tan()).tan(), (x_b - x_a) / (y_a - y_b));
    let x_0 = (y_b - k * x_b - (y_a + y_b) * 0.5 + m * (x_a + x_b) * 0.5) / (m - k);
    let y_0 = k * x_0 - k * x_b + y_b;
    let radius = (x_b - x_0).hypot(y_b - y_0);
    (pressure, move |x, y| ((x * 1e3 - x_0).hypot(y * 1e3 - y_0) - radius) * 1e-3)
}

/// What the article printed: no parabola at all, and an arc that is hollow.
#[test]
fn the_formulas_as_printed_give_what_they_give() {
    let pair = pair();
    let printed = |family, gear, tip, length| {
        let [tip, length] = shares(tip, length);
        built(family, gear, &[tip, length, ("formulas", Choice("printed"))])
    };
    for (tip, length) in TIP_SHARES.iter().flat_map(|tip| LENGTH_SHARES.map(|length| (*tip, length))) {
        for (side, name) in SIDES {
            let message = printed("parabola", name, tip, length).unwrap_err();
            assert!(message.contains("as printed give no flank: "), "{message}");
            let gear = pair.side(side);
            let (start, circle) = printed_circle(gear, tip, length);
            let part = printed("arc", name, tip, length).unwrap();
            let corner = gear.tip_roll() + tip * gear.tip_thickness() / gear.tip_radius;
            for step in 1..20 {
                let roll = start + (corner - start) * f64::from(step) / 20.0;
                let depth = part.depth(roll);
                let length = gear.base_radius * roll - depth;
                let off = circle(
                    gear.base_radius * roll.cos() + length * roll.sin(),
                    gear.base_radius * roll.sin() - length * roll.cos(),
                );
                assert!(off.abs() < 1e-14, "{off:e}");
            }
            // Hollow: deeper in the middle than at A, and half a millimetre at least.
            let middle = part.depth(0.5 * (start + corner));
            assert!(middle > 0.5e-3 && middle > 2.0 * part.depth(corner), "{middle:e}");
        }
    }
    let message = printed("parabola", "pinion", 0.06, 0.15).unwrap_err();
    assert!(message.contains("passes B 213.7434 mm beside it, at a roll angle of 26.5148 deg"), "{message}");
    // On a coarse tooth with the whole tip to give, the hollow would go through the tooth.
    let message = printed("arc", "pinion", 0.02, 1.0).unwrap_err();
    assert!(message.contains("half of the tooth"), "{message}");
}

#[test]
fn an_optimiser_may_vary_both_shares() {
    let values = [("gear", Choice("both")), ("tip_share", Range(0.02, 0.10)), ("length_share", Range(0.05, 0.25))];
    let template = Template::new(&super::members_of(&[("arc", &values)])).unwrap();
    let names: Vec<&str> = template.variables().iter().map(|variable| variable.name.as_str()).collect();
    assert_eq!(names, ["arc.tip_share", "arc.length_share"]);
    for point in [[0.02, 0.05], [0.02, 0.25], [0.10, 0.05], [0.10, 0.25]] {
        assert!(template.on(&pair()).design(&point).is_ok(), "{point:?}");
    }
}
