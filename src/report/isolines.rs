//! Lines of one value over a grid: marching squares.
//!
//! In a square whose corners lie on both sides a line crosses each edge where a straight line between its ends has the value;
//! of the two ways through a saddle the mean of the corners decides (Lorensen and Cline 1987 in two dimensions; Nielson and
//! Hamann 1991). Squares with a corner without a value have none. Must not know: what is drawn, colours.

/// A piece of a line, from place to place.
pub type Piece = [(f64, f64); 2];

/// The pieces of the line of a value over `values`, row by row at the places `xs` and `ys`, both ascending.
#[must_use]
pub fn pieces(xs: &[f64], ys: &[f64], values: &[f64], level: f64) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for row in 1..ys.len() {
        for column in 1..xs.len() {
            let at = |up: usize, right: usize| values[(row - 1 + up) * xs.len() + column - 1 + right];
            // Around the square.
            let corners = [at(0, 0), at(0, 1), at(1, 1), at(1, 0)];
            if corners.iter().any(|value| !value.is_finite()) {
                continue;
            }
            let [left, right] = [xs[column - 1], xs[column]];
            let [low, high] = [ys[row - 1], ys[row]];
            let places = [(left, low), (right, low), (right, high), (left, high)];
            let above = corners.map(|value| value >= level);
            let crossing = |edge: usize| {
                let (from, to) = (edge, (edge + 1) % 4);
                let share = (level - corners[from]) / (corners[to] - corners[from]);
                let between = |a: f64, b: f64| a + share * (b - a);
                (between(places[from].0, places[to].0), between(places[from].1, places[to].1))
            };
            let crossed: Vec<usize> = (0..4).filter(|edge| above[*edge] != above[(edge + 1) % 4]).collect();
            match crossed[..] {
                [one, other] => pieces.push([crossing(one), crossing(other)]),
                [_, _, _, _] => {
                    // Corners 0 and 2 are on one side; with the middle on it too they are joined.
                    let middle = 0.25 * corners.iter().sum::<f64>() >= level;
                    let pairs = if middle == above[0] { [[0, 1], [2, 3]] } else { [[3, 0], [1, 2]] };
                    pieces.extend(pairs.map(|pair| pair.map(crossing)));
                }
                _ => {}
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(count: usize, value: impl Fn(f64, f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let places: Vec<f64> = (0..=count).map(|at| -1.0 + 2.0 * at as f64 / count as f64).collect();
        let values = places.iter().flat_map(|y| places.iter().map(|x| value(*x, *y)).collect::<Vec<_>>()).collect();
        (places, values)
    }

    /// Tier: order of convergence, closed form. Places on the circle are off by the square of a cell, and the pieces are as
    /// long as its circumference.
    #[test]
    fn a_circle_is_met_to_second_order() {
        let off = |count: usize| {
            let (places, values) = grid(count, |x, y| x * x + y * y);
            let pieces = pieces(&places, &places, &values, 0.5);
            let radius = 0.5_f64.sqrt();
            let worst = pieces.iter().flatten().map(|(x, y)| (x.hypot(*y) - radius).abs()).fold(0.0, f64::max);
            let long: f64 = pieces.iter().map(|[a, b]| (a.0 - b.0).hypot(a.1 - b.1)).sum();
            assert!((long / (std::f64::consts::TAU * radius) - 1.0).abs() < 0.02, "{long}");
            worst
        };
        let [coarse, fine] = [off(20), off(40)];
        assert!(coarse < 2e-3 && (3.0..5.5).contains(&(coarse / fine)), "{coarse} {fine}");
    }

    #[test]
    fn saddles_join_the_side_of_their_middle_and_holes_have_no_line() {
        let square = |values: [f64; 4], level: f64| pieces(&[0.0, 1.0], &[0.0, 1.0], &values, level);
        // Corners low left and high right are 1; the middle of 0.5 is above 0.4: the lines cut off the other two.
        let joined = square([1.0, 0.0, 0.0, 1.0], 0.4);
        assert_eq!(joined.len(), 2);
        let ends: Vec<(f64, f64)> = joined.iter().flatten().copied().collect();
        assert!(ends.iter().all(|(x, y)| [0.0, 1.0].contains(x) || [0.0, 1.0].contains(y)));
        let cuts_corner =
            |piece: &Piece, corner: (f64, f64)| piece.iter().all(|(x, y)| (x - corner.0).hypot(y - corner.1) < 0.7);
        assert!(joined.iter().any(|piece| cuts_corner(piece, (1.0, 0.0))));
        let parted = square([1.0, 0.0, 0.0, 1.0], 0.6);
        assert!(parted.iter().any(|piece| cuts_corner(piece, (0.0, 0.0))), "{parted:?}");
        assert!(square([1.0, 0.0, f64::NAN, 1.0], 0.4).is_empty());
        assert!(square([1.0, 1.0, 1.0, 1.0], 0.4).is_empty());
    }
}
