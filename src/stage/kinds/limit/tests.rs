//! The ends of sets that are known.

use super::search::{End, Parameter, Side, ends};
use declare::error::Failure;

fn parameter(unit: &str, bounds: [f64; 2], own: Option<f64>) -> Parameter {
    let (name, path) = ("x".to_owned(), "stage.x".to_owned());
    Parameter { name, path, unit: unit.to_owned(), bounds, multiple: None, own }
}

/// Both ends of one parameter of which `is_admitted` says what is.
fn found(parameter: &Parameter, probes: usize, is_admitted: impl Fn(f64) -> bool) -> Result<[End; 2], Failure> {
    let mut ask = |asked: &[(usize, f64)]| {
        let reason = |(_, value): &(usize, f64)| (!is_admitted(*value)).then(|| format!("{value} is not"));
        Ok(asked.iter().map(reason).collect())
    };
    let found = ends(("stage", std::slice::from_ref(parameter)), probes, &mut ask)?;
    let Ok(found) = <[End; 2]>::try_from(found) else { panic!("two ends") };
    assert_eq!(found.each_ref().map(|end| end.side), Side::BOTH);
    Ok(found)
}

/// Tier: closed form; the value itself is admitted, and what is refused lies beside it.
#[test]
fn ends_lie_beside_what_is_refused() {
    for probes in [1, 2, 7, 32] {
        let [lower, upper] =
            found(&parameter("", [-1.0, 3.0], Some(0.25)), probes, |x| -0.1 < x && x <= 2.0 / 3.0).unwrap();
        let (refused, _) = upper.refused.unwrap();
        assert!(upper.admitted <= 2.0 / 3.0 && refused > 2.0 / 3.0, "{} {refused}", upper.admitted);
        assert!(refused - upper.admitted <= 4e-12);
        let (refused, reason) = lower.refused.unwrap();
        assert!(lower.admitted > -0.1 && refused <= -0.1 && lower.admitted - refused <= 4e-12);
        assert_eq!(reason, format!("{refused} is not"));
        assert!((20..=42 + probes).contains(&lower.evaluations), "{}", lower.evaluations);
    }
}

/// Tier: closed form; what is written in the unit of the parameter is read as what was tried.
#[test]
fn values_are_what_can_be_written() {
    let parameter = parameter("mm", [1e-3, 1.0], Some(30e-3));
    let limit = 0.1 / 3.0;
    let [lower, upper] = found(&parameter, 32, |x| x < limit).unwrap();
    let read = |end: &End| declare::units::parse_quantity(&format!("{:e} mm", parameter.shown(end.admitted))).unwrap();
    assert_eq!(read(&upper).value.to_bits(), upper.admitted.to_bits());
    assert!(upper.admitted < limit && limit - upper.admitted < 1.1e-12);
    // Nothing is refused up to this bound, which is as it was written.
    assert!(lower.refused.is_none() && parameter.shown(lower.admitted).to_bits() == 1f64.to_bits());
    assert_eq!(lower.evaluations, 32);
}

/// Tier: closed form; whole numbers and multiples are exact, and tried once each at most.
#[test]
fn whole_numbers_are_exact() {
    for (multiple, own, probes) in [(1.0, 30.0, 32), (1.0, 30.0, 3), (3.0, 30.0, 5), (1.0, 13.0, 100)] {
        let whole = Parameter { multiple: Some(multiple), ..parameter("", [6.0, 90.0], Some(own)) };
        let [lower, upper] = found(&whole, probes, |x| {
            assert!(x % multiple == 0.0, "{x}");
            (12.5..=61.0).contains(&x)
        })
        .unwrap();
        let wanted = if multiple > 2.0 { [15.0, 60.0] } else { [13.0, 61.0] };
        assert_eq!([lower.admitted, upper.admitted].map(f64::to_bits), wanted.map(f64::to_bits), "{multiple} {probes}");
        assert_eq!(upper.refused.unwrap().0.to_bits(), (wanted[1] + multiple).to_bits());
        assert!(upper.evaluations <= 77, "{}", upper.evaluations);
    }
}

/// Tier: closed form; of several intervals the one about the value counts, where a step falls into the gap beside it.
#[test]
fn gaps_that_are_wider_than_a_step_are_seen() {
    let is_admitted = |x: f64| !(0.5..0.6).contains(&x);
    let of = |probes: usize| found(&parameter("", [0.0, 1.0], Some(0.25)), probes, is_admitted).unwrap();
    let [lower, upper] = of(8);
    assert!(lower.refused.is_none() && (upper.admitted - 0.5).abs() < 2e-12, "{}", upper.admitted);
    // A single step jumps over it.
    assert!(of(1)[1].refused.is_none());
    // Of two gaps the nearer one, though there is a step in each.
    let two = |x: f64| is_admitted(x) && !(0.8..0.9).contains(&x);
    let [_, upper] = found(&parameter("", [0.0, 1.0], Some(0.25)), 32, two).unwrap();
    assert!((upper.admitted - 0.5).abs() < 2e-12);
}

/// Where the study's own value is refused, or lies elsewhere, or is not there.
#[test]
fn the_nearest_admitted_value_counts_where_the_study_s_does_not() {
    let is_admitted = |x: f64| (0.1..=0.2).contains(&x) || (0.7..=0.8).contains(&x);
    for (own, wanted) in [(Some(0.3), 0.1), (Some(0.6), 0.7), (Some(2.0), 0.7), (None, 0.7)] {
        let [lower, _] = found(&parameter("", [0.0, 1.0], own), 32, is_admitted).unwrap();
        assert!((lower.admitted - wanted).abs() < 2e-12, "{own:?}: {}", lower.admitted);
    }
    // A value on a bound has nothing beyond it.
    let [lower, upper] = found(&parameter("", [0.1, 0.2], Some(0.2)), 4, is_admitted).unwrap();
    assert_eq!((lower.evaluations, upper.evaluations), (4, 0));
    assert!(lower.refused.is_none() && upper.refused.is_none());
}

#[test]
fn what_is_refused_everywhere_says_so() {
    let Err(failure) = found(&parameter("mm", [1e-3, 3e-3], Some(2e-3)), 4, |_| false) else { panic!("accepted") };
    assert_eq!(
        failure.to_string(),
        "`stage` is refused with each of 5 values of `x` from 1\u{202f}mm to 3\u{202f}mm, with 2\u{202f}mm for example: 0.002 is not"
    );
}
