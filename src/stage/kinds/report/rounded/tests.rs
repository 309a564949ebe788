//! Numbers of one input or two whose values inside are known.

use super::search::{Found, Goal, How, Place, Value, look};

/// What is found of a number, and how often it was asked for.
fn found(number: impl Fn(&[f64]) -> Value, inputs: usize, published: f64) -> (Found, usize) {
    let stated = number(&vec![0.0; inputs]).unwrap();
    let goal = Goal { inputs, stated, published, tolerance: 1e-3 };
    let mut count = 0;
    let mut ask = |asked: &[(usize, Place)]| {
        count += asked.len();
        Ok(asked.iter().map(|(_, place)| number(place)).collect())
    };
    let found = look(&[None, Some(goal)], &mut ask).unwrap().pop().flatten().unwrap();
    (found, count)
}

fn of_one(number: impl Fn(f64) -> f64, published: f64) -> (Found, usize) {
    found(|place| Ok(number(place[0])), 1, published)
}

/// Tier: closed form; a straight line and a bent one take all values between their ends, and a few are enough to tell.
#[test]
fn what_is_continuous_is_met() {
    for published in [-1.5, 0.3, 1.9] {
        let (found, count) = of_one(|x| 2.0 * x, published);
        assert!(found.broken.is_none() && count <= 3, "{count}");
        assert_eq!([found.least, found.largest].map(f64::to_bits), [-2.0_f64, 2.0].map(f64::to_bits));
        let (found, count) = of_one(|x| (2.0 * x).exp(), published.abs());
        assert!(found.broken.is_none() && count <= 12, "{count}");
    }
    // What lies beyond is not looked for, nor what is there as stated.
    assert_eq!((of_one(|x| 2.0 * x, 2.5).1, of_one(|x| 2.0 * x, 0.0).1), (2, 2));
}

/// Tier: closed form; of 1/(x − c) no value between its ends is taken, and all beyond them are; of 1/(x − c)² those beyond its ends.
#[test]
fn a_pole_inside_is_found() {
    let pole = |x: f64| 1.0 / (x - 0.37);
    // Between 1/−1.37 and 1/0.63.
    let (found, _) = of_one(pole, 0.5);
    let Some(broken) = &found.broken else { panic!("{found:?}") };
    assert!((broken.place[0] - 0.37).abs() < 1e-3 && matches!(broken.how, How::Endless), "{broken:?}");
    assert!(of_one(pole, -20.0).0.broken.is_none(), "it is met between the middle and the pole");
    let (found, _) = of_one(|x| 1.0 / (x - 0.37).powi(2), -1.0);
    assert!(found.broken.is_some_and(|broken| (broken.place[0] - 0.37).abs() < 1e-2));
    assert!(of_one(|x| 1.0 / (x - 0.37).powi(2), 40.0).0.broken.is_none());
    // At the pole itself there is no number.
    let refused = |place: &[f64]| {
        if place[0].total_cmp(&0.5).is_eq() { Err("no".to_owned()) } else { Ok(1.0 / (place[0] - 0.5)) }
    };
    let (found, _) = self::found(refused, 1, -100.0);
    assert!(matches!(found.broken.unwrap().how, How::Refused(reason) if reason == "no"));
}

/// Tier: closed form; what jumps over the published value does not take it.
#[test]
fn a_jump_is_no_value_between() {
    let step = |x: f64| if x < 0.3 { x } else { x + 1.0 };
    let (found, _) = of_one(step, 0.8);
    let Some(broken) = found.broken else { panic!("it jumps") };
    let How::Jumps(from, to) = broken.how else { panic!("{broken:?}") };
    assert!((broken.place[0] - 0.3).abs() < 1e-5 && (from - 0.3).abs() < 1e-4 && (to - 1.3).abs() < 1e-4);
    assert!(of_one(step, 0.2).0.broken.is_none() && of_one(step, 1.7).0.broken.is_none());
}

/// Tier: closed form; a parabola is least inside.
#[test]
fn what_is_least_between_the_ends_is_found() {
    let parabola = |x: f64| (x - 0.1).powi(2);
    let (found, count) = of_one(parabola, -0.5);
    assert!(found.broken.is_none() && found.least < 1e-3 && count <= 12, "{found:?} {count}");
    // −0.0005 is 0 within the tolerance.
    let (found, _) = of_one(parabola, 0.005);
    assert!(found.broken.is_none() && found.least <= 0.006, "{found:?}");
}

/// Tier: closed form; towards an end that has no number it is followed up to where it has none.
#[test]
fn an_end_that_is_refused_is_approached() {
    let half = |place: &[f64]| {
        if place[0] > 0.123 { Err(format!("{} is too much", place[0])) } else { Ok(place[0] + place[1]) }
    };
    let (found, count) = self::found(half, 2, 5.0);
    let [cut] = &found.cuts[..] else { panic!("{found:?}") };
    assert_eq!((cut.input, cut.side), (0, 1));
    assert!((cut.place - 0.123).abs() < 2e-6 && cut.reason.starts_with("0.12300") && cut.reason.ends_with("too much"));
    assert!((found.largest - 1.123).abs() < 2e-6 && found.least <= -2.0 && count <= 28, "{found:?} {count}");
    // Corners that have none are counted.
    let corner = |place: &[f64]| if place[0] + place[1] > 1.5 { Err("no".to_owned()) } else { Ok(place[0] * place[1]) };
    let (found, _) = self::found(corner, 2, 5.0);
    assert_eq!((found.corners, found.refused, found.reason.as_str()), (4, 1, "no"));
}

/// Tier: closed form; many inputs are tried at the ends that make a sum least and largest.
#[test]
fn many_inputs_have_two_corners() {
    let sum = |place: &[f64]| Ok(place.iter().zip([1.0, -2.0, 3.0, 0.0, 5.0]).map(|(x, factor)| x * factor).sum());
    let (found, count) = self::found(sum, 5, 100.0);
    assert_eq!(([found.least, found.largest], found.corners, count), ([-11.0, 11.0], 2, 12));
}
