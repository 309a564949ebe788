//! Problems of several objectives whose fronts are known. The comparison with another implementation reads this file too.
//!
//! ZDT1 to ZDT3: Zitzler, Deb, Thiele, Evol. Comput. 8 (2000) 173. DTLZ2: Deb, Thiele, Laumanns, Zitzler, CEC 2002. BNH:
//! Binh and Korn, MENDEL 1997. SRN: Srinivas and Deb, Evol. Comput. 2 (1994) 221. The fronts of the last two: Deb,
//! Multi-Objective Optimization using Evolutionary Algorithms (2001), section 8.2.

use super::Evaluation;

pub(super) struct Problem {
    pub name: &'static str,
    pub bounds: Vec<(f64, f64)>,
    pub function: fn(&[f64]) -> Evaluation,
    /// Above which nothing counts.
    pub reference: &'static [f64],
    /// The hypervolume of the whole front, where it has a closed form.
    pub exact: Option<f64>,
    /// A point of the front for a parameter from 0 to 1; of some problems others of them dominate it.
    pub front: fn(f64) -> Vec<f64>,
}

fn two(first: f64, second: f64, constraints: Vec<f64>) -> Evaluation {
    Evaluation { value: first, further: vec![second], constraints }
}

/// The mean of all variables but the first, by which they are off the front, times nine, and one.
fn off(x: &[f64]) -> f64 {
    1.0 + 9.0 * x[1..].iter().sum::<f64>() / (x.len() - 1) as f64
}

fn third(first: f64) -> f64 {
    1.0 - first.sqrt() - first * libm::sin(10.0 * std::f64::consts::PI * first)
}

pub(super) fn problems() -> Vec<Problem> {
    use std::f64::consts::{FRAC_PI_2, PI};
    vec![
        Problem {
            name: "zdt1",
            bounds: vec![(0.0, 1.0); 30],
            function: |x| two(x[0], off(x) * (1.0 - (x[0] / off(x)).sqrt()), Vec::new()),
            reference: &[1.1, 1.1],
            // The integral of 1.1 − (1 − √f) over 0..1, and the strip beyond.
            exact: Some(0.1 + 2.0 / 3.0 + 0.11),
            front: |t| vec![t, 1.0 - t.sqrt()],
        },
        Problem {
            name: "zdt2",
            bounds: vec![(0.0, 1.0); 30],
            function: |x| two(x[0], off(x) * (1.0 - (x[0] / off(x)).powi(2)), Vec::new()),
            reference: &[1.1, 1.1],
            exact: Some(0.1 + 1.0 / 3.0 + 0.11),
            front: |t| vec![t, 1.0 - t * t],
        },
        Problem {
            name: "zdt3",
            bounds: vec![(0.0, 1.0); 30],
            function: |x| {
                let (f, g) = (x[0], off(x));
                two(f, g * (1.0 - (f / g).sqrt() - f / g * libm::sin(10.0 * PI * f)), Vec::new())
            },
            reference: &[1.1, 1.1],
            exact: None,
            front: |t| vec![t, third(t)],
        },
        Problem {
            name: "dtlz2",
            bounds: vec![(0.0, 1.0); 12],
            function: |x| {
                let g = 1.0 + x[2..].iter().map(|x| (x - 0.5).powi(2)).sum::<f64>();
                let [one, other] = [x[0], x[1]].map(|x| x * FRAC_PI_2);
                Evaluation {
                    value: g * libm::cos(one) * libm::cos(other),
                    further: vec![g * libm::cos(one) * libm::sin(other), g * libm::sin(one)],
                    constraints: Vec::new(),
                }
            },
            reference: &[1.1; 3],
            // All but an eighth of the unit ball.
            exact: Some(1.331 - PI / 6.0),
            front: |_| Vec::new(),
        },
        Problem {
            name: "bnh",
            bounds: vec![(0.0, 5.0), (0.0, 3.0)],
            function: |x| {
                let circle = 25.0 - (x[0] - 5.0).powi(2) - x[1] * x[1];
                let other = (x[0] - 8.0).powi(2) + (x[1] + 3.0).powi(2) - 7.7;
                let values = (4.0 * (x[0] * x[0] + x[1] * x[1]), (x[0] - 5.0).powi(2) + (x[1] - 5.0).powi(2));
                two(values.0, values.1, vec![circle / 25.0, other / 7.7])
            },
            reference: &[140.0, 50.0],
            exact: None,
            front: |t| {
                let (x, y) = (5.0 * t, (5.0 * t).min(3.0));
                vec![4.0 * (x * x + y * y), (x - 5.0).powi(2) + (y - 5.0).powi(2)]
            },
        },
        Problem {
            name: "srn",
            bounds: vec![(-20.0, 20.0); 2],
            function: |x| {
                let (circle, line) = (225.0 - x[0] * x[0] - x[1] * x[1], 3.0 * x[1] - x[0] - 10.0);
                let second = (x[1] - 1.0).powi(2);
                two(2.0 + (x[0] - 2.0).powi(2) + second, 9.0 * x[0] - second, vec![circle / 225.0, line / 10.0])
            },
            reference: &[240.0, 0.0],
            exact: None,
            front: |t| {
                // On the line, at x = -2.5 where f1 and f2 weigh the same, and on the circle: weighted sums say so. The
                // book has the middle alone.
                let (x, y) = if t < 0.25 {
                    let x = 1.1 - 3.6 * t / 0.25;
                    (x, (x + 10.0) / 3.0)
                } else if t < 0.75 {
                    (-2.5, 2.5 + (t - 0.25) / 0.5 * ((225.0_f64 - 6.25).sqrt() - 2.5))
                } else {
                    let x = -2.5 - 4.0 * (t - 0.75) / 0.25;
                    (x, (225.0 - x * x).sqrt())
                };
                let second = (y - 1.0).powi(2);
                vec![2.0 + (x - 2.0).powi(2) + second, 9.0 * x - second]
            },
        },
    ]
}
