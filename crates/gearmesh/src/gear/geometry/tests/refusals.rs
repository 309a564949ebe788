//! What a refusal asks for: where the limit that it names really is.

use super::*;

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
}
