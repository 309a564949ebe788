//! The outline that modifications give: the curvature of the circle and the parabola a flank was cut to, and its breaks.

use crate::gear::fixtures::{design, standard};
use crate::gear::geometry::outline::Outline;
use crate::gear::geometry::outline::curve::{OutlinePart, Segment};
use crate::gear::geometry::outline::roots::Root;
use crate::gear::geometry::outline::roots::trochoid::Trochoid;
use crate::gear::geometry::outline::tip::Tip;
use crate::gear::geometry::{GearPair, Side};
use crate::gear::modification::curve::Curve;
use crate::gear::modification::relief::{Amount, FromTip, Start};
use crate::gear::modification::tip_relief::TipRelief;
use crate::gear::modification::{Design, Gears};
use declare::record::Value::Number;

/// The pair of `mei2016`: 30/40, module 3 mm.
fn pair() -> GearPair {
    GearPair::new(standard(30, 3e-3, 2.0), standard(40, 3e-3, 2.0), None).unwrap()
}

/// The flank of the outline, in pieces between its breaks.
fn flank(pair: &GearPair, side: Side, design: &Design) -> Vec<Segment> {
    let toe = Trochoid::default().toe(pair.side(side)).unwrap();
    let outline = Outline::new(pair.side(side), toe, Tip::Land, design.relief(side)).unwrap();
    outline.segments.into_iter().filter(|segment| segment.part == OutlinePart::Flank).collect()
}

/// Tier: closed form; a flank cut to a circle has its curvature up to both ends, one cut to a parabola 2a cos³θ where its
/// tangent has the angle θ. 1e-6: the second derivative comes from three depths; at an end it is that of the place 1e-4 rad
/// inside.
#[test]
fn a_flank_cut_to_a_curve_has_its_curvature() {
    let pair = pair();
    for (side, name) in [(Side::Pinion, "pinion"), (Side::Gear, "gear")] {
        for (family, tip, length) in [("arc", 0.02, 0.25), ("arc", 0.1, 0.15), ("parabola", 0.06, 0.2)] {
            let values = [("tip_share", Number(tip)), ("length_share", Number(length))];
            let design = design(&pair, &[(family, name, &values)]).unwrap();
            let gear = pair.side(side);
            let value = |wanted: &str| {
                let part = design.side(side)[0].modification.resolved();
                part.into_iter().find(|(found, _)| *found == wanted).unwrap().1
            };
            let roll = value("start_roll_angle");
            let (x, y) = (value("x_A") - value("x_B"), value("y_A") - value("y_B"));
            // From B to A along the tangent in B, and across it.
            let (along, across) = (x * roll.cos() + y * roll.sin(), x * roll.sin() - y * roll.cos());
            let closed_form = |tilt: f64| match family {
                "arc" => 2.0 * across.abs() / (along * along + across * across),
                _ => 2.0 * (y - roll.tan() * x).abs() / (x * x) * tilt.cos().powi(3),
            };
            let pieces = flank(&pair, side, &design);
            let last = pieces.iter().find(|piece| (piece.from - roll).abs() < 1e-12).unwrap();
            let narrow = last.curve.between(last.from, last.from + 3e-5);
            let whole = (0..=20).map(|step| (&last.curve, last.from + (last.to - last.from) * f64::from(step) / 20.0));
            let short = (0..=3).map(|step| (&narrow, last.from + 1e-5 * f64::from(step)));
            for (curve, parameter) in whole.chain(short) {
                let tolerance = if (last.from + 1e-4..last.to - 1e-4).contains(&parameter) { 1e-6 } else { 3e-3 };
                let local = curve.local(parameter);
                // The article's frame starts on the flank's base point, this one on the tooth's centreline.
                let tilt = (-local.tangent[0]).atan2(local.tangent[1]) + gear.half_base_angle;
                // The curve leaves the involute along its tangent, which has the roll angle there.
                assert!(parameter > last.from || (tilt - roll).abs() < 1e-6, "{family} {name}: {tilt} {roll}");
                let (found, wanted) = (local.curvature.abs(), closed_form(tilt));
                assert!((found / wanted - 1.0).abs() < tolerance, "{family} {name} at {parameter}: {found} {wanted}");
            }
        }
    }
}

/// Tier: invariant; the flank is cut where a relief starts, once for each place, from the root to the tip, and there.
#[test]
fn the_flank_breaks_where_its_reliefs_start() {
    let pair = pair();
    let starting = |rolls: &[f64]| {
        let mut design = Design::default();
        for roll in rolls {
            let relief = TipRelief {
                amount: Amount::Depth(5e-6),
                start: Start::RollAngle(*roll),
                counted_from: FromTip::Tip,
                curve: Curve::default(),
            };
            design.add(Gears::Pinion, &relief, &pair).unwrap();
        }
        flank(&pair, Side::Pinion, &design).iter().map(|segment| segment.from).skip(1).collect::<Vec<_>>()
    };
    let (low, high, tip) = (0.45, 0.5, pair.pinion.tip_roll());
    for (rolls, wanted) in [
        (vec![low], vec![low, tip]),
        (vec![low, high], vec![low, high, tip]),
        (vec![high, low], vec![low, high, tip]),
        (vec![high, low, high], vec![low, high, tip]),
    ] {
        let found = starting(&rolls);
        assert_eq!(found.len(), wanted.len(), "{found:?}");
        assert!(found.iter().zip(&wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-12), "{found:?}");
    }
}
