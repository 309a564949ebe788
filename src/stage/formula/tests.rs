//! What formulas give, and what is refused.

use super::super::quantity::same_dimension;
use super::*;
use declare::units::{LENGTH, STRESS, parse_quantity};

fn given(name: &str) -> Option<Number> {
    let text = match name {
        "F" => "1866.979 N",
        "k1" => "2.738e8 N/m",
        "k2" => "4.724e8 N/m",
        "published" => "2.316 um",
        "b" => "18 mm",
        "angle" => "90 deg",
        _ => return None,
    };
    let quantity = parse_quantity(text).unwrap();
    Some(Number { si: quantity.value, dimension: quantity.dimension })
}

const NAMES: [&str; 7] = ["F", "k1", "k2", "published", "b", "angle", "list"];

/// Three rows: `list` is 1, 2 and 4 mm, all else the same in each.
const IN_ROW_ONE: Names =
    Names { value: &|name, row| if name == "list" { Some(listed(row)) } else { given(name) }, row: 0, rows: 3 };

fn listed(row: usize) -> Number {
    Number { si: [1e-3, 2e-3, 4e-3][row], dimension: LENGTH }
}

fn value(text: &str) -> Result<Outcome, String> {
    Formula::parse(text, &NAMES)?.evaluate(IN_ROW_ONE)
}

fn plain(text: &str) -> f64 {
    match value(text) {
        Ok(Outcome::Number(Number { si, dimension })) if same_dimension(dimension, RATIO) => si,
        other => panic!("{text} gives {other:?}"),
    }
}

#[test]
fn arithmetic_is_that_of_real_numbers() {
    for (text, expected) in [
        ("1 / 2", 0.5),
        ("-2 ^ 2", -4.0),
        ("2 ^ 0.5 * sqrt(2)", 2.0),
        ("1 - 0.728 / 2.316", 1.0 - 0.728 / 2.316),
        ("max(1, 2, 3) - min(4, 5)", -1.0),
        ("abs(-1.5e-3)", 1.5e-3),
        ("(1 + 2) * 3", 9.0),
        ("10 - 4 - 3", 3.0),
        ("F / (k1 * published)", 1866.979 / (2.738e8 * 2.316e-6)),
        ("angle", std::f64::consts::FRAC_PI_2),
        ("sin(angle / 3)", 0.5),
        ("cos(angle * 2 / 3)", 0.5),
        ("tan(angle / 2)", 1.0),
        ("atan(1) * 4 - 2 * angle + 1", 1.0),
    ] {
        assert!((plain(text) - expected).abs() <= 4.0 * f64::EPSILON * expected.abs(), "{text} = {}", plain(text));
    }
}

#[test]
fn functions_over_rows_make_one_number_of_all() {
    for (text, expected) in [
        ("sum(list) / b", 7.0 / 18.0),
        ("mean(list - b) / b", 7.0 / 3.0 / 18.0 - 1.0),
        ("rms(list) / b", libm::sqrt(21.0 / 3.0) / 18.0),
        ("rms(list - mean(list)) / list", libm::sqrt(7.0 - 49.0 / 9.0)),
        ("sum(1)", 3.0),
        ("list / b", 1.0 / 18.0),
    ] {
        assert!((plain(text) - expected).abs() <= 4.0 * f64::EPSILON, "{text} = {}", plain(text));
    }
    let formula = Formula::parse("rms(list - b) < list + F", &NAMES).unwrap();
    assert!(formula.row_by_row("list") && formula.row_by_row("F") && !formula.row_by_row("b"));
    assert!(value("rms(list, b)").unwrap_err().contains("`rms` is given 2 values"));
    assert!(value("mean(list + F)").unwrap_err().contains("do not go together"));
}

/// The paper's own stiffnesses bound its own transmission error: F/k1 − F/k2 = 2.867 µm (physics: 2.867).
#[test]
fn the_bound_on_the_published_error_is_shown_with_its_numbers() {
    let formula = Formula::parse("F / k1 - F / k2 > published", &NAMES).unwrap();
    assert_eq!(formula.evaluate(IN_ROW_ONE), Ok(Outcome::Truth(true)));
    assert_eq!(formula.with_numbers(IN_ROW_ONE, "um").unwrap(), "2.867\u{202f}µm > 2.316\u{202f}µm");
    let refuted = Formula::parse("F / k1 - F / k2 < published && b > 0", &NAMES).unwrap();
    assert_eq!(
        refuted.with_numbers(IN_ROW_ONE, "um").unwrap(),
        "2.867\u{202f}µm ≥ 2.316\u{202f}µm and 18000\u{202f}µm > 0\u{202f}µm"
    );
    assert_eq!(formula.names().collect::<Vec<_>>(), ["F", "k1", "F", "k2", "published"]);
}

#[test]
fn units_that_do_not_go_together_are_refused() {
    for (text, message) in [
        ("F + published", "a force and a length do not go together at `+`"),
        ("F > published", "do not go together at `>`"),
        ("max(F, b)", "do not go together in `max`"),
        ("2 ^ F", "an exponent is a plain number, not a force"),
        ("sqrt(F)", "to the power 0.5 has no unit"),
        ("sin(F)", "`sin` needs an angle or a plain number, not a force"),
        ("F / (k1 - k1)", "not a finite number"),
        ("sqrt(-1)", "not a finite number"),
        ("b > 0 || F > b", "a force and a length"),
    ] {
        let error = value(text).unwrap_err();
        assert!(error.contains(message), "{text}: {error}");
    }
    let Ok(Outcome::Number(stress)) = value("F / (b * b)") else { panic!("no number") };
    assert_eq!(stress.dimension, STRESS);
    let Ok(Outcome::Number(length)) = value("sqrt(b * b)") else { panic!("no number") };
    assert_eq!((length.dimension, length.si.to_bits()), (LENGTH, 0.018_f64.to_bits()));
    assert_eq!(value("F > 0 && b > 0"), Ok(Outcome::Truth(true)));
}

/// Tier: second method; what is said of dimensions alone is what comes of the values.
#[test]
fn dimensions_are_known_before_values_are() {
    let of = |name: &str| if name == "list" { Some(LENGTH) } else { given(name).map(|number| number.dimension) };
    let texts = "F + published; F > published; b > 3; b > 0; max(F, b); min(b, published); 2 ^ F; b ^ 2; b ^ 2 / b; sqrt(F); \
                 sqrt(b * b); sin(F); sin(angle); abs(-b); F / (b * b); mean(list) - b; mean(list + F); rms(list) / b; 1 / 2; \
                 b > 0 || F > b; F > 0 && b > 0; !(F > k1); -F; 2 * b + published; atan(b / published)";
    for text in texts.split(';').map(str::trim) {
        let said = Formula::parse(text, &NAMES).unwrap().dimension(&of);
        match (value(text), said) {
            (Ok(Outcome::Truth(_)), Ok(None)) => {}
            (Ok(Outcome::Number(number)), Ok(Some(dimension))) => {
                assert!(same_dimension(number.dimension, dimension), "{text}: {dimension:?}");
            }
            (Err(found), Err(said)) => assert_eq!(found, said, "{text}"),
            (found, said) => panic!("{text}: {found:?}, and before {said:?}"),
        }
    }
    // A name of which nothing is known, and a power of which only the value decides.
    let unknown =
        |text: &str| Formula::parse(text, &NAMES).unwrap().dimension(&|name| of(name).filter(|_| name != "F"));
    assert_eq!(unknown("F + b"), Ok(None));
    assert_eq!(unknown("b ^ angle"), Ok(None));
    assert!(unknown("F > 0 && k1 > b").is_err());
}

#[test]
fn what_is_no_formula_is_refused_when_it_is_read() {
    for (text, message) in [
        ("", "empty"),
        ("F /", "a value is missing at `/`"),
        ("b <= 3 um", "a number with a unit, `3 um`; write a name there"),
        ("b <= (3 um)", "`with: { limit: 3 um }`"),
        ("F b", "no function `F`"),
        ("F / k3", "`k3` is not given; known here: `F`, `k1`"),
        ("anlge * F", "`anlge` is not given; did you mean `angle`?"),
        ("(F", "cannot be read"),
        ("F = 3", "no place"),
        ("F; b", "no place"),
        ("\"F\"", "no place"),
        ("F % 2", "no place"),
        ("sinh(F)", "did you mean `sin`?"),
        ("sqrtt(F)", "did you mean `sqrt`?"),
        ("math::sin(F)", "no function"),
        ("sqrt(F, b)", "given 2 values"),
        ("min(F)", "given 1 value"),
        ("F < b < k1", "needs numbers"),
        ("F && b", "joins comparisons"),
        ("true", "no place"),
        ("()", "missing between brackets"),
        ("F // 2", "a division is one `/`"),
        ("F /* + 3 */", "no sign of a formula"),
        ("F + 0x10", "hexadecimal"),
        ("b ^ 2 ^ 3", "read in two ways"),
        ("sqrt 4 * b", "takes its values in brackets"),
        ("ste.summary[torque=3].mean + b", "name it in `let` or `with`"),
    ] {
        let error = Formula::parse(text, &NAMES).unwrap_err();
        assert!(error.contains(message), "{text}: {error}");
    }
    assert!(Formula::parse("(b ^ 2) ^ 3 + b ^ (2 ^ 3) - sqrt(b)", &NAMES).is_ok());
    let deep = "(".repeat(100_000);
    assert!(Formula::parse(&deep, &NAMES).unwrap_err().contains("at most"));
}

#[test]
fn close_sides_are_shown_with_digits_that_tell_them_apart() {
    let one = |name: &str, _| Some(Number::plain(if name == "b" { 1.000_001 } else { 1.0 }));
    let names = Names { value: &one, row: 0, rows: 1 };
    let formula = Formula::parse("b > F", &NAMES).unwrap();
    assert_eq!(formula.with_numbers(names, "").unwrap(), "1.000001 > 1");
}
