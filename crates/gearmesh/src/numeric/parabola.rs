//! The top of a function that is known at some points: a parabola through the largest and its neighbours.
//!
//! Must not know: what the function is.

/// The largest of `values` at ascending `places`, and what `others` are there: the top of the parabola through the largest
/// value and its two neighbours, and the parabola through the same three of `others`. At an end it is the value itself.
/// None of no values.
#[must_use]
pub fn peak(places: &[f64], others: &[f64], values: &[f64]) -> Option<(f64, f64)> {
    let top = (0..values.len()).reduce(|a, b| if values[b] > values[a] { b } else { a })?;
    if top == 0 || top + 1 == values.len() {
        return Some((values[top], others[top]));
    }
    let (a, b) = (places[top - 1] - places[top], places[top + 1] - places[top]);
    // y ≈ y_0 + p x + q x² through the three.
    let parabola = |y: &[f64]| {
        let [before, at, after] = [y[top - 1], y[top], y[top + 1]];
        let (left, right) = ((before - at) / a, (after - at) / b);
        let curve = (right - left) / (b - a);
        [at, left - curve * a, curve]
    };
    let [value, slope, curve] = parabola(values);
    let x = if curve < 0.0 { (-0.5 * slope / curve).clamp(a, b) } else { 0.0 };
    let [other, rate, bend] = parabola(others);
    Some((value + x * (slope + x * curve), other + x * (rate + x * bend)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_has_its_top_between_points() {
        let places = [0.0, 0.4, 1.1, 1.5, 2.7];
        let values = places.map(|x| 3.0 - 2.0 * (x - 0.9) * (x - 0.9));
        let (value, other) = peak(&places, &places.map(|x| 5.0 + x + x * x), &values).unwrap();
        assert!((value - 3.0).abs() < 1e-14 && (other - 6.71).abs() < 1e-14, "{value} {other}");
        let rising = peak(&places, &places, &places).unwrap();
        assert_eq!([rising.0, rising.1].map(f64::to_bits), [2.7_f64; 2].map(f64::to_bits), "at an end");
        assert_eq!(peak(&[], &[], &[]), None);
    }
}
