//! Every family by its definition, and what must be refused.

mod outlines;
mod tip_curve;
mod typed;

use super::flank::Flank;
use super::relief::IsoAmount;
use super::template::Template;
use super::{Design, FAMILIES, members};
use crate::gear::fixtures::{BASE_PITCH, NamedModification, design, pair, record};
use crate::gear::geometry::{GearPair, Side};
use declare::declared::{Declared, entry, record_of};
use declare::record::PlacedValue;
use declare::record::Value::{self, Choice, Group, Member, Number, Quantity, Range};

const AMOUNT: f64 = 7.81e-6;

/// A field and its value.
type Given = (&'static str, Value);

/// Depth of one modification of the pinion where the contact is at path position `s`.
fn pinion_depth(name: &'static str, values: &[(&'static str, Value)], s: f64) -> f64 {
    let pair = pair();
    let design = design(&pair, &[(name, "pinion", values)]).unwrap();
    design.depth(Side::Pinion, pair.roll(Side::Pinion, s))
}

fn refused(name: &'static str, values: &[(&'static str, Value)]) -> String {
    design(&pair(), &[(name, "pinion", values)]).unwrap_err().message
}

#[track_caller]
fn close(value: f64, exact: f64) {
    assert!((value - exact).abs() <= 1e-12 * AMOUNT, "{value:e} is not {exact:e}");
}

/// The article's formula with x from the start of the relief.
fn parabolic(t: f64) -> f64 {
    AMOUNT * (0.44 * t + 0.56 * t * t)
}

#[test]
fn tip_relief_follows_the_article_in_each_reading_of_its_length() {
    let pair = pair();
    let (end, long) = (pair.end_of_contact, pair.base_pitch * (pair.contact_ratio - 1.0));
    let single_end = pair.start_of_contact + BASE_PITCH;
    let values = |counted: &'static str, length: f64| {
        [
            ("amount", Quantity(AMOUNT)),
            ("length", Quantity(length)),
            ("curve", Choice("parabolic")),
            ("counted_from", Choice(counted)),
        ]
    };
    for from_tip in [0.0, 1e-3, 2.5e-3, 4e-3, 5.8e-3, 8e-3, 12e-3] {
        let s = end - from_tip;
        let length = 3.41e-3;
        close(pinion_depth("tip_relief", &values("tip", length), s), parabolic((1.0 - from_tip / length).max(0.0)));
        let inside = length + long;
        close(
            pinion_depth("tip_relief", &values("single_zone", length), s),
            parabolic((1.0 - from_tip / inside).max(0.0)),
        );
        let outward = ((s - single_end) / length).clamp(0.0, 1.0);
        close(pinion_depth("tip_relief", &values("zone_end", length), s), parabolic(outward));
        // Long relief is the same whether it is counted from the tip or from the end of single contact.
        close(
            pinion_depth("tip_relief", &values("zone_end", long), s),
            pinion_depth("tip_relief", &values("tip", long), s),
        );
    }
}

#[test]
fn the_four_ways_to_give_a_start_agree() {
    let pair = pair();
    let length = 0.5 * pair.base_pitch * (pair.contact_ratio - 1.0);
    let roll = pair.roll(Side::Pinion, pair.end_of_contact - length);
    let diameter = 2.0 * pair.pinion.base_radius * (1.0 + roll * roll).sqrt();
    let starts = [
        ("length", Quantity(length)),
        ("fraction", Quantity(0.5)),
        ("start_roll_angle", Quantity(roll)),
        ("start_diameter", Quantity(diameter)),
    ];
    for start in starts {
        let values = [("amount", Quantity(AMOUNT)), start.clone()];
        let design = design(&pair, &[("tip_relief", "pinion", &values)]).unwrap();
        for (name, exact) in
            [("length", length), ("start_roll_angle", roll), ("start_diameter", diameter), ("amount", AMOUNT)]
        {
            let found = design.resolved().into_iter().find(|(_, _, resolved, _)| *resolved == name).unwrap().3;
            assert!((found / exact - 1.0).abs() < 1e-12, "{} from {}", name, start.0);
        }
        close(pinion_depth("tip_relief", &values, pair.end_of_contact - 0.5 * length), 0.5 * AMOUNT);
        // The tip's own diameter, 31.5 mm, is where the flank ends.
        close(pinion_depth("tip_relief", &values, pair.end_of_contact), AMOUNT);
    }
    let tip = ((31.5e-3_f64 * 31.5e-3 - pair.pinion.base_radius * pair.pinion.base_radius).sqrt()
        - pair.end_of_contact)
        .abs();
    assert!(tip < 1e-14);
}

/// Δ_max = K_A F_t/(b ε c_γ); with the article's pair, 50 N·m and c_γ 19.05 N/(mm µm) it is 3.11 µm.
#[test]
fn the_iso_amount_is_the_printed_formula() {
    let pair = pair();
    let tangential = 50.0 / 28.5e-3;
    let iso = |extra: &[(&'static str, f64)]| {
        let mut fields = vec![("application_factor", Number(1.0)), ("tangential_load", Quantity(tangential))];
        for (name, value) in extra {
            fields.push((name, if *name == "contact_ratio" { Number(*value) } else { Quantity(*value) }));
        }
        fields.push(("mesh_stiffness", Quantity(19.05e9)));
        let group = record_of(IsoAmount::MEMBER.fields, &fields);
        let values = [("iso_amount", Group(group)), ("fraction", Quantity(1.0))];
        pinion_depth("tip_relief", &values, pair.end_of_contact)
    };
    assert!((iso(&[]) - 3.11e-6).abs() < 0.005e-6, "{:e}", iso(&[]));
    let halved = iso(&[("face_width", 36e-3), ("contact_ratio", 2.0 * pair.contact_ratio)]);
    assert!((halved / iso(&[]) - 0.25).abs() < 1e-14);
}

#[test]
fn crowning_and_slopes_have_their_ends() {
    let pair = pair();
    let (start, end) = (pair.start_of_contact, pair.end_of_contact);
    let amount = |value: f64| [("amount", Quantity(value))];
    for (s, exact) in [(start, 1.0), (0.5 * (start + end), 0.0), (end, 1.0), (0.25 * start + 0.75 * end, 0.25)] {
        close(pinion_depth("profile_crowning", &amount(AMOUNT), s), exact * AMOUNT);
    }
    for (sign, root, tip) in [(1.0, 0.0, 1.0), (-1.0, 1.0, 0.0)] {
        close(pinion_depth("profile_slope", &amount(sign * AMOUNT), start), root * AMOUNT);
        close(pinion_depth("profile_slope", &amount(sign * AMOUNT), end), tip * AMOUNT);
        let helix = design(&pair, &[("helix_slope", "pinion", &amount(sign * AMOUNT))]).unwrap();
        close(helix.lead(-10e-3), root * AMOUNT);
        close(helix.lead(10e-3), tip * AMOUNT);
    }
    // Crowning is over each gear's own width, 20 and 18 mm.
    for (gear, edge) in [("pinion", 0.81), ("gear", 1.0)] {
        let crowned = design(&pair, &[("lead_crowning", gear, &amount(AMOUNT))]).unwrap();
        close(crowned.lead(9e-3), edge * AMOUNT);
        close(crowned.lead(0.0), 0.0);
    }
    // On the pinion, with the places that they are laid out from.
    let middle = pair.roll(Side::Pinion, 0.5 * (start + end));
    for (family, name, place) in
        [("profile_crowning", "middle_roll_angle", middle), ("helix_slope", "face_width", 20e-3)]
    {
        let design = design(&pair, &[(family, "pinion", &amount(AMOUNT))]).unwrap();
        let found = |wanted: &str| design.resolved().into_iter().find(|(_, _, name, _)| *name == wanted).unwrap().3;
        close(found("amount"), AMOUNT);
        assert!((found(name) / place - 1.0).abs() < 1e-12, "{family}: {name} {}", found(name));
    }
}

#[test]
fn end_relief_starts_on_the_face_and_its_quadratic_is_its_lead() {
    let pair = pair();
    for end in ["I", "II", "both"] {
        for curve in ["linear", "parabolic"] {
            let length = 8e-3;
            let values = [
                ("amount", Quantity(AMOUNT)),
                ("length", Quantity(length)),
                ("end", Choice(end)),
                ("curve", Choice(curve)),
            ];
            let design = design(&pair, &[("end_relief", "gear", &values)]).unwrap();
            let part = &design.gear[0].modification;
            assert_eq!(part.resolved(), [("amount", AMOUNT), ("length", length)]);
            assert_eq!(part.lead_is_even(), end == "both");
            for step in -90..=90 {
                let z = f64::from(step) * 1e-4;
                let relieved = if z > 0.0 { end != "I" } else { end != "II" };
                let t = if relieved { ((z.abs() - 1e-3) / length).max(0.0) } else { 0.0 };
                close(design.lead(z), if curve == "linear" { AMOUNT * t } else { parabolic(t) });
                let [constant, slope, bend] = part.lead_quadratic(z).unwrap();
                close(constant + slope * z + bend * z * z, design.lead(z));
            }
        }
        // Nothing is alike on both sides.
        let values = [("amount", Quantity(0.0)), ("length", Quantity(8e-3)), ("end", Choice(end))];
        assert!(design(&pair, &[("end_relief", "gear", &values)]).unwrap().lead_is_even());
    }
}

/// Tier: second method; between breaks what a family says to be its quadratic is its depth, and a curve that is none says so.
#[test]
fn the_quadratics_of_profiles_are_their_depths() {
    let pair = pair();
    let ramp =
        |curve: &'static str| [("amount", Quantity(AMOUNT)), ("length", Quantity(4e-3)), ("curve", Choice(curve))];
    let crown = [("amount", Quantity(AMOUNT))];
    let mut of_quadratics = 0;
    for (name, values) in [
        ("tip_relief", &ramp("linear")[..]),
        ("tip_relief", &ramp("parabolic")),
        ("root_relief", &ramp("parabolic")),
        ("profile_crowning", &crown),
        ("profile_slope", &crown),
    ] {
        for side in ["pinion", "gear"] {
            let design = design(&pair, &[(name, side, values)]).unwrap();
            let part = &design.side(if side == "gear" { Side::Gear } else { Side::Pinion })[0].modification;
            let flank = super::flank::Flank::new(&pair, if side == "gear" { Side::Gear } else { Side::Pinion });
            for step in -10..=110 {
                let roll = flank.root_roll + (flank.tip_roll - flank.root_roll) * f64::from(step) * 0.01;
                let value = part.profile_quadratic(roll).unwrap().value(roll);
                let off = (value - part.depth(roll)).abs();
                assert!(off <= 4e-16 * AMOUNT + 1e-15 * value.abs(), "{name} of the {side} at {roll}: {off:e}");
                of_quadratics += u32::from(value != 0.0);
            }
        }
    }
    assert!(of_quadratics > 600);
    let [amount, length, _] = ramp("power");
    let power = [amount, length, ("curve", Choice("power")), ("exponent", Number(1.5))];
    let design = design(&pair, &[("tip_relief", "pinion", &power)]).unwrap();
    let flank = super::flank::Flank::new(&pair, Side::Pinion);
    let part = &design.pinion[0].modification;
    assert!(part.profile_quadratic(flank.tip_roll - 1e-3).is_none());
    assert_eq!(part.profile_quadratic(flank.root_roll).map(|quadratic| quadratic.is_zero()), Some(true));
}

#[test]
fn reliefs_add_up() {
    let pair = pair();
    let relief = [("amount", Quantity(AMOUNT)), ("fraction", Quantity(1.0))];
    let slope = [("amount", Quantity(2e-6))];
    let all = design(&pair, &[("tip_relief", "both", &relief), ("profile_slope", "pinion", &slope)]).unwrap();
    let roll = pair.roll(Side::Pinion, pair.end_of_contact);
    close(all.depth(Side::Pinion, roll), AMOUNT + 2e-6);
    assert_eq!((all.pinion.len(), all.gear.len()), (2, 1));
}

#[test]
fn contradictions_and_impossible_reliefs_are_refused_with_the_range() {
    let amount = ("amount", Quantity(AMOUNT));
    let message = refused("tip_relief", std::slice::from_ref(&amount));
    assert!(message.contains("exactly one of `length`"), "{message}");
    let message = refused("tip_relief", &[amount.clone(), ("length", Quantity(1e-3)), ("fraction", Quantity(1.0))]);
    assert!(message.contains("not both `length` and `fraction`"), "{message}");
    assert!(refused("tip_relief", &[("length", Quantity(1e-3))]).contains("`iso_amount`"));
    let message = refused("root_relief", &[amount.clone(), ("length", Quantity(14.6e-3))]);
    assert!(message.contains("14.574315 mm long") && message.contains("14.600000 mm"), "{message}");
    let message = refused("tip_relief", &[amount.clone(), ("start_diameter", Quantity(53e-3))]);
    assert!(message.contains("diameter 53.000000 mm is below the base circle, 53.562"), "{message}");
    let message = refused("tip_relief", &[amount.clone(), ("start_diameter", Quantity(64e-3))]);
    assert!(message.contains("diameters") && message.contains("63.000000 mm"), "{message}");
    assert!(message.contains("mm beyond the end of the flank"), "{message}");
    let message = refused("tip_relief", &[amount.clone(), ("length", Quantity(1e-3)), ("curve", Choice("power"))]);
    assert!(message.contains("needs its `exponent`"), "{message}");
    let message = refused("tip_relief", &[amount.clone(), ("length", Quantity(1e-3)), ("exponent", Number(2.0))]);
    assert!(message.contains("`curve: power` only"), "{message}");
    let start = ("start_roll_angle", Quantity(0.5));
    for family in ["tip_relief", "root_relief"] {
        let message = refused(family, &[amount.clone(), start.clone(), ("counted_from", Choice("single_zone"))]);
        assert!(message.contains("`counted_from: single_zone` goes with"), "{family}: {message}");
    }
    let message = refused("end_relief", &[amount, ("length", Quantity(10.1e-3))]);
    assert!(message.contains("10.100000 mm long") && message.contains("0 to 10.000000 mm"), "{message}");
}

/// Half of the tooth, with its end found independently: the flank's normal is followed point by point until the
/// point's polar angle passes the centreline.
fn room_by_bisection(pair: &GearPair, side: Side, roll: f64) -> f64 {
    let gear = pair.side(side);
    let (sine, cosine) = roll.sin_cos();
    let beyond = |depth: f64| {
        let length = gear.base_radius * roll - depth;
        let (x, y) = (gear.base_radius * cosine + length * sine, gear.base_radius * sine - length * cosine);
        y.atan2(x) > gear.half_base_angle
    };
    let (mut inside, mut outside) = (0.0, 5e-3);
    assert!(!beyond(inside) && beyond(outside));
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        *(if beyond(middle) { &mut outside } else { &mut inside }) = middle;
    }
    inside
}

#[test]
fn more_than_half_of_the_tooth_is_refused_with_what_may_be_taken() {
    let pair = pair();
    for (side, name) in [(Side::Pinion, "pinion"), (Side::Gear, "gear")] {
        let flank = Flank::new(&pair, side);
        let gear = pair.side(side);
        // The normal through the middle of the tip land, and what is left there: both flanks would meet on the tip circle.
        let land = 0.5 * gear.tip_thickness() / gear.tip_radius;
        let last = flank.tip_roll + land;
        let [tip, root] = [last, flank.root_roll].map(|roll| room_by_bisection(&pair, side, roll));
        assert!((tip / (gear.base_radius * land) - 1.0).abs() < 1e-9 && tip < root);
        let length = ("length", Quantity(3e-3));
        let ends = ("end", Choice("I"));
        let cases: [(&str, f64, &[Given]); 7] = [
            ("tip_relief", tip, std::slice::from_ref(&length)),
            ("root_relief", root, std::slice::from_ref(&length)),
            ("profile_crowning", tip, &[]),
            ("profile_slope", tip, &[]),
            ("lead_crowning", tip, &[]),
            ("helix_slope", tip, &[]),
            ("end_relief", tip, &[length.clone(), ends]),
        ];
        for (family, maximum, others) in cases {
            let taken = |amount: f64| {
                let values = [&[("amount", Quantity(amount))], others].concat();
                design(&pair, &[(family, name, &values)])
            };
            // Crownings and slopes go on growing beyond the nominal corner.
            let one = taken(1e-6).unwrap();
            let roll = if family == "root_relief" { flank.root_roll } else { last };
            let deepest =
                one.depth(side, roll) + one.lead(-0.5 * flank.face_width).max(one.lead(0.5 * flank.face_width));
            let limit = maximum * 1e-6 / deepest;
            for amount in [0.0, 1e-300, limit * (1.0 - 1e-9)] {
                assert!(taken(amount).is_ok(), "{family} of {amount:e}");
            }
            let message = taken(limit * (1.0 + 1e-9)).unwrap_err().message;
            let diameter = flank.diameter(if family == "root_relief" { flank.root_roll } else { flank.tip_roll });
            let number = |before: &str, behind: &str| -> f64 {
                let (_, rest) = message.split_once(before).unwrap();
                rest.split_once(behind).unwrap().0.parse().unwrap()
            };
            let [lost, most] = [number("would lose ", " mm"), number("0 to ", " mm there")];
            assert!((most / (maximum * 1e3) - 1.0).abs() < 1e-6 && lost > most, "{message}");
            assert!(message.contains(&format!("{:.6} mm;", diameter * 1e3)), "{message}");
        }
        // Two that fit alone: along the profile and along the face, each half.
        let half = [("amount", Quantity(0.5001 * tip)), length.clone()];
        let crown = [("amount", Quantity(0.5001 * tip))];
        assert!(design(&pair, &[("tip_relief", name, &half)]).is_ok());
        assert!(design(&pair, &[("lead_crowning", name, &crown)]).is_ok());
        let message = design(&pair, &[("tip_relief", name, &half), ("lead_crowning", name, &crown)]).unwrap_err();
        assert!(message.message.contains("all its modifications together"), "{}", message.message);
        // The other gear's do not count.
        let other = if name == "pinion" { "gear" } else { "pinion" };
        let fits = 0.7 * tip.min(0.5e-3);
        let both = [("amount", Quantity(fits)), length.clone()];
        assert!(design(&pair, &[("tip_relief", name, &both), ("tip_relief", other, &both)]).is_ok());
    }
    // 10 · 1 GN on 0.1 mm of width, over 1e6 N/m²: 1e8 m of relief.
    let fields = [("application_factor", Number(10.0)), ("tangential_load", Quantity(1e9))];
    let more = [("face_width", Quantity(1e-4)), ("mesh_stiffness", Quantity(1e6))];
    let iso = Group(record_of(IsoAmount::MEMBER.fields, &[fields, more].concat()));
    assert!(refused("tip_relief", &[("iso_amount", iso), ("fraction", Quantity(1.0))]).contains("half of the tooth"));
}

/// Powers that overlap are deepest where none of them ends.
#[test]
fn what_reliefs_take_between_their_ends_counts() {
    let pair = pair();
    let flank = Flank::new(&pair, Side::Gear);
    let relief = |amount: f64| {
        let bulge = [
            ("amount", Quantity(amount)),
            ("length", Quantity(flank.length())),
            ("curve", Choice("power")),
            ("exponent", Number(0.5)),
        ];
        let root: NamedModification = ("root_relief", "gear", &bulge);
        design(&pair, &[("tip_relief", "gear", &bulge), root, root])
    };
    let land = 0.5 * pair.gear.tip_thickness() * pair.gear.base_radius / pair.gear.tip_radius;
    // √t + 2√(1 − t) is 1 at the tip, 2 at the root and 2.2 between.
    assert!(relief(0.6 * land).is_ok());
    let message = relief(0.999 * land).unwrap_err().message;
    let tip = format!("{:.6} mm;", flank.diameter(flank.tip_roll) * 1e3);
    assert!(message.contains("half of the tooth") && !message.contains(&tip), "{message}");
}

#[test]
fn every_family_is_listed_once_with_its_gear() {
    let names: Vec<&str> = members().iter().map(|member| member.name).collect();
    assert_eq!(names, FAMILIES.iter().map(|family| family.member.name).collect::<Vec<_>>());
    for member in members() {
        assert_eq!(member.fields[0].name, "gear");
        assert_eq!(names.iter().filter(|name| **name == member.name).count(), 1);
    }
}

fn members_of(parts: &[(&'static str, &[(&'static str, Value)])]) -> Vec<PlacedValue> {
    parts.iter().map(|(name, values)| entry(Member(name, record(name, values)))).collect()
}

#[test]
fn a_template_opens_the_ranges_and_closes_them_with_values() {
    let pair = pair();
    let tip = [
        ("gear", Choice("both")),
        ("amount", Range(0.0, 8e-6)),
        ("length", Range(0.0, 6e-3)),
        ("curve", Choice("parabolic")),
    ];
    let crown = [("gear", Choice("pinion")), ("amount", Range(0.0, 8e-6))];
    let slope = [("gear", Choice("gear")), ("amount", Quantity(1e-6))];
    let template = Template::new(&members_of(&[
        ("tip_relief", &tip),
        ("profile_slope", &slope),
        ("lead_crowning", &crown),
        ("lead_crowning", &crown),
    ]))
    .unwrap();
    let names: Vec<&str> = template.variables().iter().map(|variable| variable.name.as_str()).collect();
    let crowning = "pinion.lead_crowning.amount";
    assert_eq!(names, ["tip_relief.amount", "tip_relief.length", crowning, "pinion.lead_crowning.amount_2"]);
    assert_eq!((template.variables()[1].minimum, template.variables()[1].maximum), (0.0, 6e-3));
    let built = template.on(&pair).design(&[6.93e-6, 3.41e-3, 5e-6, 0.67e-6]).unwrap();
    let fixed = [("amount", Quantity(6.93e-6)), ("length", Quantity(3.41e-3)), ("curve", Choice("parabolic"))];
    let by_hand: Design = design(
        &pair,
        &[
            ("tip_relief", "both", &fixed),
            ("profile_slope", "gear", &[("amount", Quantity(1e-6))]),
            ("lead_crowning", "pinion", &[("amount", Quantity(5e-6))]),
            ("lead_crowning", "pinion", &[("amount", Quantity(0.67e-6))]),
        ],
    )
    .unwrap();
    assert_eq!(built.resolved(), by_hand.resolved());
    assert!(template.on(&pair).design(&[1e-6, 20e-3, 0.0, 0.0]).unwrap_err().message.contains("active flank"));
    // What has no open values and does not fit is told of every design.
    let long = [("gear", Choice("pinion")), ("amount", Quantity(1e-6)), ("length", Quantity(20e-3))];
    let template = Template::new(&members_of(&[("lead_crowning", &crown), ("tip_relief", &long)])).unwrap();
    let fitted = template.on(&pair);
    for amount in [0.0, 5e-6] {
        assert!(fitted.design(&[amount]).unwrap_err().message.contains("active flank"));
    }
    let both = [
        ("gear", Choice("both")),
        ("amount", Range(0.0, 1e-6)),
        ("length", Range(0.0, 1e-3)),
        ("fraction", Quantity(1.0)),
    ];
    assert!(Template::new(&members_of(&[("tip_relief", &both)])).is_err());
}
