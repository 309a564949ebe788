//! Depths over a grid as a bicubic spline, held at its edges.
//!
//! The spline of splines of both ways: its values and derivatives at the grid's points make one bicubic for each of its cells. Source: de
//! Boor, Bicubic spline interpolation, Journal of Mathematics and Physics 41 (1962). Must not know: gears.

use crate::numeric::spline::{Hermite, Spline};

/// The depths.
#[derive(Debug)]
pub(super) struct Grid {
    along: Hermite,
    across: Hermite,
    /// At each point, line by line of the profile: the value, its derivative along the profile, across the face, and over both.
    corners: Vec<[f64; 4]>,
}

impl Grid {
    /// `depths` hold all of `along` for each of `across`; both are strictly ascending and have two points or more.
    pub(super) fn new(along: &[f64], across: &[f64], depths: &[f64]) -> Self {
        let count = along.len();
        let mut corners: Vec<[f64; 4]> = depths.iter().map(|depth| [*depth, 0.0, 0.0, 0.0]).collect();
        let fill = |corners: &mut [[f64; 4]], [from, to]: [usize; 2]| {
            for line in corners.chunks_mut(count) {
                let values: Vec<f64> = line.iter().map(|corner| corner[from]).collect();
                let slopes = Spline::new(along, &values).slopes();
                for (corner, slope) in line.iter_mut().zip(slopes) {
                    corner[to] = slope;
                }
            }
        };
        fill(&mut corners, [0, 1]);
        for column in 0..count {
            let values: Vec<f64> = corners.iter().skip(column).step_by(count).map(|corner| corner[0]).collect();
            let slopes = Spline::new(across, &values).slopes();
            for (corner, slope) in corners.iter_mut().skip(column).step_by(count).zip(slopes) {
                corner[2] = slope;
            }
        }
        fill(&mut corners, [2, 3]);
        Self { along: Hermite::new(along), across: Hermite::new(across), corners }
    }

    /// The roll angles of its lines across the face.
    pub(super) fn along(&self) -> &[f64] {
        self.along.knots()
    }

    /// The depth at a place, and its first and second derivative along the profile.
    pub(super) fn rates(&self, roll: f64, z: f64) -> [f64; 3] {
        let (column, weights) = self.along.rates(roll);
        let (row, across) = self.across.weights(z);
        let first = row * self.along.knots().len() + column;
        let corners = [first, first + 1, first + self.along.knots().len(), first + self.along.knots().len() + 1];
        weights.map(|weights| {
            (0..4)
                .map(|at| {
                    let [v, x, y, xy] = self.corners[corners[at]];
                    let [value, slope] = [weights[at % 2], weights[at % 2 + 2]];
                    across[at / 2] * (value * v + slope * x) + across[at / 2 + 2] * (value * y + slope * xy)
                })
                .sum()
        })
    }

    /// The depth at a place; outside of the grid that at its edge.
    pub(super) fn value(&self, roll: f64, z: f64) -> f64 {
        let (column, [a0, a1, b0, b1]) = self.along.weights(roll);
        let (row, [c0, c1, d0, d1]) = self.across.weights(z);
        let first = row * self.along.knots().len() + column;
        let corner = |at: usize, [value, slope]: [f64; 2], [near, rise]: [f64; 2]| {
            let [v, x, y, xy] = self.corners[at];
            near * (value * v + slope * x) + rise * (value * y + slope * xy)
        };
        let second = first + self.along.knots().len();
        corner(first, [a0, b0], [c0, d0])
            + corner(first + 1, [a1, b1], [c0, d0])
            + corner(second, [a0, b0], [c1, d1])
            + corner(second + 1, [a1, b1], [c1, d1])
    }
}
