//! What a refusal asks for: where the limit that it names really is.

use super::*;
use crate::gear::geometry::outline::roots::base_arc::Base;

/// Tier: invariant; a limit that a refusal names is where it begins.
#[test]
fn what_a_refusal_asks_for_is_just_enough() {
    let pair = |sum: f64| GearPair::new(specification(20, 3.0, 0.5 * sum), specification(20, 3.0, 0.5 * sum), None);
    let refused = |sum: f64| match pair(sum).map_err(|error| error.problem) {
        Err(Problem::ProfileShiftSum { minimum, .. }) => Some(minimum.0),
        _ => None,
    };
    let minimum = refused(-1.0).unwrap();
    assert!(refused(minimum - 1e-6).is_some() && refused(minimum + 1e-6).is_none(), "x1 + x2 {minimum}");
    let refused =
        |pressure_angle: f64| match Gear::new(&Specification { pressure_angle, ..specification(30, 3.0, 0.0) })
            .map_err(|error| error.problem)
        {
            Err(Problem::NoTipLand { largest, .. }) => Some(largest.0),
            _ => None,
        };
    let largest = refused(40.0 * DEGREE).unwrap();
    assert!(refused(largest + 1e-6).is_some() && refused(largest - 1e-6).is_none(), "α {largest}");
    let refused = |shift: f64| match Gear::new(&specification(20, 3.0, shift)).map_err(|error| error.problem) {
        Err(Problem::OutOfRange { parameter: Parameter::ProfileShift, range, .. }) => Some(range),
        _ => None,
    };
    let range = refused(-4.0).unwrap();
    let minimum: f64 = range.strip_prefix("above ").and_then(|rest| rest.split(' ').next()).unwrap().parse().unwrap();
    assert!(refused(minimum - 1e-3).is_some() && refused(minimum + 1e-3).is_none(), "x {range}");

    // A rack so deep that the root circle would vanish.
    let deep = |dedendum: f64| {
        let rack = Rack { dedendum, ..specification(6, 3.0, -1.0).rack };
        Gear::new(&Specification { rack, pressure_angle: 5.0 * DEGREE, ..specification(6, 3.0, -1.0) })
    };
    let refused = |dedendum: f64| match deep(dedendum).map_err(|error| error.problem) {
        Err(Problem::OutOfRange { parameter: Parameter::RackDedendum, range, .. }) => Some(range),
        _ => None,
    };
    assert_eq!(refused(2.0 + 1e-9).unwrap(), "below 2 modules, where the root circle vanishes");
    assert!(refused(2.0 - 1e-9).is_none());
    // Arcs down from the base circle: as many teeth as leave the root circle inside it, for this rack and shift.
    let refused = |teeth: u32| match Base::new(&gear(teeth, 3.0, 0.3), "an arc").map_err(|error| error.problem) {
        Err(Problem::NothingBelowBase { maximum, .. }) => Some(maximum.0),
        _ => None,
    };
    let maximum = refused(60).unwrap();
    for teeth in 20..60 {
        assert_eq!(refused(teeth).is_some(), f64::from(teeth) > maximum, "z {teeth}, limit {maximum}");
    }
}
