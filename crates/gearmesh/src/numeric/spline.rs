//! Cubic splines through points: two continuous derivatives, and no knot beside either end (not-a-knot).
//!
//! Cubics are followed exactly and smooth functions to the fourth order of the distance of the points; what a single point is
//! off by fades by 2 − √3 from point to point. Source: de Boor, A Practical Guide to Splines, chapter IV. Must not know: what
//! is interpolated.

#[cfg(test)]
mod tests;

/// A piecewise cubic with two continuous derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// Ascending.
    knots: Vec<f64>,
    /// The coefficients of each interval over the distance from its lower end.
    cubics: Vec<[f64; 4]>,
}

impl Spline {
    /// Through the points (`knots[i]`, `values[i]`), at least two of them and as many of one as of the other; `knots` are strictly
    /// ascending. Two points make a line, three a parabola.
    ///
    /// # Panics
    /// When there are fewer.
    #[must_use]
    pub fn new(knots: &[f64], values: &[f64]) -> Self {
        assert!(knots.len() > 1 && knots.len() == values.len(), "a spline has two points or more");
        let steps: Vec<f64> = knots.windows(2).map(|ends| ends[1] - ends[0]).collect();
        let secants: Vec<f64> = values.windows(2).zip(&steps).map(|(ends, step)| (ends[1] - ends[0]) / step).collect();
        let slopes = slopes(&steps, &secants);
        let cubic = |at: usize| {
            let (step, secant) = (steps[at], secants[at]);
            let bend = (slopes[at] + slopes[at + 1] - 2.0 * secant) / step;
            [values[at], slopes[at], (secant - slopes[at]) / step - bend, bend / step]
        };
        Self { knots: knots.to_vec(), cubics: (0..steps.len()).map(cubic).collect() }
    }

    /// The first and the last knot.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        [self.knots[0], self.knots[self.knots.len() - 1]]
    }

    /// Its knots, ascending.
    #[must_use]
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The value, and the first and second derivative, at `x`; outside of its ends the outermost cubics go on.
    #[must_use]
    #[inline]
    pub fn rates(&self, x: f64) -> [f64; 3] {
        let at = interval(&self.knots, x);
        let ([c0, c1, c2, c3], t) = (self.cubics[at], x - self.knots[at]);
        [c0 + t * (c1 + t * (c2 + t * c3)), c1 + t * (2.0 * c2 + 3.0 * t * c3), 2.0 * c2 + 6.0 * t * c3]
    }

    /// The value at `x`.
    #[must_use]
    pub fn value(&self, x: f64) -> f64 {
        self.rates(x)[0]
    }

    /// The slope at every knot.
    #[must_use]
    pub fn slopes(&self) -> Vec<f64> {
        self.knots.iter().map(|knot| self.rates(*knot)[1]).collect()
    }
}

/// The interval of a place, the outermost one outside of all.
#[inline]
fn interval(knots: &[f64], x: f64) -> usize {
    knots[1..knots.len() - 1].partition_point(|knot| *knot <= x)
}

/// The slope at every knot.
fn slopes(steps: &[f64], secants: &[f64]) -> Vec<f64> {
    let last = steps.len();
    if last == 1 {
        return vec![secants[0]; 2];
    }
    if last == 2 {
        // The parabola through three points.
        let bend = (secants[1] - secants[0]) / (steps[0] + steps[1]);
        return vec![secants[0] - bend * steps[0], secants[0] + bend * steps[0], secants[1] + bend * steps[1]];
    }
    // Rows of a tridiagonal matrix: below, on and above its diagonal, and the right-hand side. No pivoting: all rows but the
    // outermost are dominated by their diagonal, and what is left of their neighbours' when they are eliminated is positive.
    let end = |near: usize, next: usize| {
        let ([near, next], [here, there]) = ([steps[near], steps[next]], [secants[near], secants[next]]);
        let both = near + next;
        (next, both, ((near + 2.0 * both) * next * here + near * near * there) / both)
    };
    let (mut diagonal, mut above, mut right) = (vec![0.0; last + 1], vec![0.0; last + 1], vec![0.0; last + 1]);
    (diagonal[0], above[0], right[0]) = end(0, 1);
    for at in 1..last {
        let (before, after) = (steps[at - 1], steps[at]);
        let factor = after / diagonal[at - 1];
        diagonal[at] = 2.0 * (before + after) - factor * above[at - 1];
        above[at] = before;
        right[at] = 3.0 * (after * secants[at - 1] + before * secants[at]) - factor * right[at - 1];
    }
    let (own, below, side) = end(last - 1, last - 2);
    let factor = below / diagonal[last - 1];
    diagonal[last] = own - factor * above[last - 1];
    right[last] = side - factor * right[last - 1];
    let mut slopes = right;
    slopes[last] /= diagonal[last];
    for at in (0..last).rev() {
        slopes[at] = (slopes[at] - above[at] * slopes[at + 1]) / diagonal[at];
    }
    slopes
}

/// Places at which values and slopes are known, for cubics between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Hermite {
    knots: Vec<f64>,
}

impl Hermite {
    /// Between these, which are strictly ascending and two or more.
    #[must_use]
    pub fn new(knots: &[f64]) -> Self {
        Self { knots: knots.to_vec() }
    }

    /// All of them.
    #[must_use]
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// As [`Hermite::weights`], for the value, and the first and second derivative.
    #[must_use]
    pub fn rates(&self, x: f64) -> (usize, [[f64; 4]; 3]) {
        let (at, weights) = self.weights(x);
        let step = self.knots[at + 1] - self.knots[at];
        let t = (x - self.knots[at]) / step;
        if !(0.0..=1.0).contains(&t) {
            return (at, [weights, [0.0; 4], [0.0; 4]]);
        }
        let s = 1.0 - t;
        let (rise, bend) = (6.0 * t * s / step, 6.0 * (s - t) / (step * step));
        let slopes = [-rise, rise, s * (s - 2.0 * t), t * (t - 2.0 * s)];
        (at, [weights, slopes, [-bend, bend, (6.0 * t - 4.0) / step, (6.0 * t - 2.0) / step]])
    }

    /// The interval of a place, and what the values and then the slopes at both its ends count for there; outside of all
    /// intervals those of the outermost knot.
    #[must_use]
    pub fn weights(&self, x: f64) -> (usize, [f64; 4]) {
        let at = interval(&self.knots, x);
        let step = self.knots[at + 1] - self.knots[at];
        let t = ((x - self.knots[at]) / step).clamp(0.0, 1.0);
        let (s, end) = (1.0 - t, t * t * (3.0 - 2.0 * t));
        (at, [1.0 - end, end, step * t * s * s, -step * t * t * s])
    }
}
