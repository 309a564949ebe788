//! Numbers of messages: the digits that tell.

use super::*;

#[test]
fn numbers_are_shown_with_the_digits_that_tell() {
    for (value, shown) in [
        (0.014_25, "14.25 mm"),
        (0.1, "100 mm"),
        (-1.234_567_8e-4, "-0.123457 mm"),
        (0.0, "0 mm"),
        (1e-12, "1.00000e-9 mm"),
    ] {
        assert_eq!(Millimetres(value).to_string(), shown);
    }
    // What is compared differs as it is shown.
    for (bore, root, shown) in [
        (25.0, 24.75, "the bore radius is 25 mm, but must be at least 0.02475 mm and below the root radius 24.75 mm"),
        (
            25.380_000_002,
            25.38,
            "the bore radius is 25.380000002 mm, but must be at least 0.02538 mm and below the root radius 25.38 mm",
        ),
        (
            25.38,
            25.38,
            "the bore radius is 25.38 mm, but must be at least 0.02538 mm and below the root radius 25.38 mm",
        ),
    ] {
        let [bore, minimum, root] = [bore, root * 1e-3, root].map(|length: f64| Millimetres(length * 1e-3));
        assert_eq!(Problem::Bore { bore, minimum, root }.to_string(), shown);
    }
    let ratio = |ratio: f64| Problem::ContactRatio { ratio: Plain(ratio) }.to_string();
    assert_eq!(ratio(0.97), "the contact ratio is 0.97, but must be above 1");
    assert_eq!(ratio(1.0 - 3e-12), "the contact ratio is 0.999999999997, but must be above 1");
    // Neighbouring numbers.
    assert_eq!(ratio(1.0 - f64::EPSILON / 2.0), "the contact ratio is 0.9999999999999999, but must be above 1");
    // Five digits below one and nine above are written out.
    for (value, shown) in [
        (123_456_789.0, "123456789"),
        (999_999_999.0, "999999999"),
        (1e9, "1.00000e9"),
        (1e-4, "0.0001"),
        (0.999e-4, "9.99000e-5"),
    ] {
        assert_eq!(Plain(value).to_string(), shown);
    }
}
