//! Several problems of as many springs without coupling, solved side by side: what a processor does several of at a time.
//!
//! Each is solved as if it were alone, to the last bit. Must not know: what the springs are.

use super::{NEARLY, ROUNDING};

/// The most steps of Newton's method; a handful is taken.
const STEPS: usize = 200;

/// Equilibria of M problems of N springs: arrays of what each problem has.
pub struct Balances<const N: usize, const M: usize> {
    /// Counted from the smallest gap.
    pub approach: [f64; M],
    /// d total/d approach.
    pub slope: [f64; M],
    /// Of each spring, 0 or more; they add up to the total.
    pub loads: [[f64; M]; N],
    /// Of each spring; where there is no load, minus the distance that is still open.
    pub penetration: [[f64; M]; N],
}

/// Equilibria without coupling, of springs whose loads and slopes at penetrations `responses` gives: 0 where those are not
/// above 0. `total` > 0, the smallest gap of each problem is 0, and at `above` its springs carry `total` or more.
#[inline]
pub fn balances<const N: usize, const M: usize>(
    responses: impl Fn(usize, &[f64; M]) -> [[f64; M]; 2],
    gaps: &[[f64; M]; N],
    total: f64,
    above: [f64; M],
) -> Balances<N, M> {
    let mut approach = above;
    let (mut loads, mut rises) = ([[0.0; M]; N], [[0.0; M]; N]);
    let (mut step, mut slope) = ([0.0; M], [0.0; M]);
    for _ in 0..STEPS {
        let mut sum = [0.0; M];
        slope = [0.0; M];
        for spring in 0..N {
            let penetration: [f64; M] = std::array::from_fn(|m| approach[m] - gaps[spring][m]);
            [loads[spring], rises[spring]] = responses(spring, &penetration);
            for m in 0..M {
                sum[m] += loads[spring][m];
                slope[m] += rises[spring][m];
            }
        }
        // A problem that has settled stays where it is, whatever others do.
        let mut moves = false;
        for m in 0..M {
            let excess = sum[m] - total;
            step[m] = -excess / slope[m];
            let next = approach[m] + step[m];
            // A spring that the last step would lift off has to be left out by a whole step.
            let lifts = (0..N).any(|spring| loads[spring][m] + rises[spring][m] * step[m] < 0.0);
            let settled = excess.abs() <= ROUNDING * total || (excess.abs() <= NEARLY * total && !lifts);
            if !settled && next > 0.0 && next.is_finite() {
                approach[m] = next;
                moves = true;
            }
        }
        if !moves {
            break;
        }
    }
    // The last step is so short that it needs no new responses.
    let step: [f64; M] = std::array::from_fn(|m| if slope[m] > 0.0 { step[m] } else { 0.0 });
    let approach: [f64; M] = std::array::from_fn(|m| approach[m] + step[m]);
    let of =
        |value: &dyn Fn(usize, usize) -> f64| std::array::from_fn(|spring| std::array::from_fn(|m| value(spring, m)));
    Balances {
        approach,
        slope,
        loads: of(&|spring, m| (loads[spring][m] + rises[spring][m] * step[m]).max(0.0)),
        penetration: of(&|spring, m| approach[m] - gaps[spring][m]),
    }
}

/// The approaches of linear springs: of one, or of two, by [`linear_approach`](super::linear_approach) of each problem.
#[must_use]
#[inline]
pub fn linear_approaches<const N: usize, const M: usize>(
    stiffness: &[[f64; M]; N],
    gaps: &[[f64; M]; N],
    total: f64,
) -> [f64; M] {
    if N == 1 {
        return std::array::from_fn(|m| (total + stiffness[0][m] * gaps[0][m]) / stiffness[0][m]);
    }
    std::array::from_fn(|m| {
        let (one, two) = ((stiffness[0][m], gaps[0][m]), (stiffness[1][m], gaps[1][m]));
        let ((first, near), (second, far)) = if two.1 < one.1 { (two, one) } else { (one, two) };
        let moment = first * near;
        let (alone, both) = ((total + moment) / first, (total + (moment + second * far)) / (first + second));
        if alone <= far { alone } else { both }
    })
}

#[cfg(test)]
mod tests {
    use super::super::linear_approach;
    use super::*;

    /// Tier: second method, to the last bit; each problem alone, whatever it stands beside: both springs loaded, one, nearly one.
    #[test]
    fn each_problem_is_solved_as_if_alone() {
        let stiffness = [[3.0, 2.0, 1.0, 5.0, 4.0, 1e3], [2.0, 2.5, 7.0, 1e-3, 4.0, 1e3]];
        let gaps = [[0.0, 0.0, 0.4, 0.0, 2.0, 0.0], [0.1, 0.0, 0.0, 7.0, 0.0, 1e-9]];
        // A crown: as the 3/2 power at first, then straight on.
        let response = |stiffness: f64, w: f64| {
            let reach = w.max(0.0).sqrt().min(1.0);
            [stiffness * reach * (w.max(0.0) - reach * reach / 3.0), stiffness * reach]
        };
        for total in [1e-6, 0.3, 1.0, 40.0] {
            let above = linear_approaches(&stiffness, &gaps, total).map(|approach| approach + 1.0 / 3.0);
            let together = balances(
                |spring, w: &[f64; 6]| {
                    let each: [[f64; 2]; 6] = std::array::from_fn(|m| response(stiffness[spring][m], w[m]));
                    [each.map(|[load, _]| load), each.map(|[_, rise]| rise)]
                },
                &gaps,
                total,
                above,
            );
            for m in 0..6 {
                let own = [gaps[0][m], gaps[1][m]];
                let padded = [stiffness[0][m], stiffness[1][m], 0.0, 0.0, 0.0, 0.0];
                assert_eq!(above[m].to_bits(), (linear_approach(&padded, &own, total) + 1.0 / 3.0).to_bits(), "{m}");
                let alone = balances(
                    |spring, [w]: &[f64; 1]| response(stiffness[spring][m], *w).map(|value| [value]),
                    &[[own[0]], [own[1]]],
                    total,
                    [above[m]],
                );
                assert_eq!(together.approach[m].to_bits(), alone.approach[0].to_bits(), "{m} under {total}");
                assert_eq!(together.slope[m].to_bits(), alone.slope[0].to_bits(), "{m} under {total}");
                let sum: f64 = (0..2).map(|spring| together.loads[spring][m]).sum();
                assert!((sum / total - 1.0).abs() < 1e-14, "{m}: {sum} of {total}");
            }
        }
    }
}
