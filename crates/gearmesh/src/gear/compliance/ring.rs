//! The gear body as a plane elastic ring: what a tooth's load does to its own root and to those of its neighbours.
//!
//! The bore is clamped. A tooth acts on its root arc |θ| ≤ θ_f by tractions that are uniform along the radius, uniform
//! across it, and linear in θ along the radius (bending): the assumptions behind the fitted formula in `sainsot`. They
//! are matched to the resultant of the load line; a root moves by what does work with these tractions, so influences
//! are reciprocal and self influences positive. Solved by Fourier series in the Kolosov–Muskhelishvili form
//! (Muskhelishvili, Some Basic Problems of the Mathematical Theory of Elasticity, §§ 56–59): for harmonic n the potentials
//! z^(n+1), z^(1−n) and z^(n−1), z^(−n−1) give four displacement fields proportional to powers of r.
//!
//! Lengths here are in units of the outer radius r_f, stresses in units of the shear modulus.
//! Must not know: the tooth above the root circle.

#[cfg(test)]
mod tests;

use crate::numeric::elimination::solve;
use std::f64::consts::PI;

use crate::gear::geometry::Gear;

/// Harmonics kept, times the half root angle: waves much shorter than the root arc.
pub const HARMONICS: f64 = 100.0;
/// What is cut off, times the third power of that number, in units of a root's own influence: a series whose terms fall as
/// n^−3 and change their sign with the root arc. For a root's own the mean of what is cut off is added, for a neighbour's
/// it is not. The largest of hundreds of random gears from 10 to 200, which a test holds.
const CUT_OFF: [f64; 2] = [0.8, 3.5];
/// Below this a field that decays from one rim does not reach the other.
const UNFELT: f64 = 1e-18;

type Matrix3 = [[f64; 3]; 3];

/// One displacement field of harmonic n: u_r = radial · cos nθ, u_θ = tangential · sin nθ, and the tractions with them.
#[derive(Clone, Copy, Debug)]
struct Field {
    radial: f64,
    tangential: f64,
    normal_stress: f64,
    shear_stress: f64,
}

/// A ring whose outer rim carries teeth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// r_bore/r_f.
    bore: f64,
    /// θ_f \[rad\].
    half_angle: f64,
    /// κ = (3 − ν)/(1 + ν): plane stress.
    kappa: f64,
    /// 1/(G b) \[m/N\].
    flexibility: f64,
    harmonics: usize,
}

impl Ring {
    /// The body of a gear whose roots are clamped over ±`half_angle`.
    #[must_use]
    pub fn new(gear: &Gear, half_angle: f64) -> Self {
        let material = gear.specification.material;
        let nu = material.poisson_ratio;
        Self {
            bore: gear.specification.bore_radius / gear.root_radius,
            half_angle,
            kappa: (3.0 - nu) / (1.0 + nu),
            flexibility: 2.0 * (1.0 + nu) / (material.youngs_modulus * gear.specification.face_width),
            harmonics: count(HARMONICS, half_angle),
        }
    }

    /// The same with another number of harmonics, times the half root angle.
    #[must_use]
    pub fn with_harmonics(self, by_angle: f64) -> Self {
        Self { harmonics: count(by_angle, self.half_angle), ..self }
    }

    /// The tractions of a unit load at a roll angle, whose resultants at the gear's centre are the force
    /// (−sin α_1, cos α_1) along and across the tooth, and the torque r_b: uniform radial, uniform tangential, and
    /// radial in proportion to θ/θ_f.
    #[must_use]
    pub fn tractions(&self, gear: &Gear, roll: f64) -> [f64; 3] {
        let (load_sine, load_cosine) = libm::sincos(gear.load_angle(roll));
        let theta = self.half_angle;
        let (sine, cosine) = libm::sincos(theta);
        let tangential = gear.base_radius / gear.root_radius / (2.0 * theta);
        let uniform = -load_sine / (2.0 * sine);
        let linear = (load_cosine - 2.0 * tangential * sine) * theta / (2.0 * (sine - theta * cosine));
        [uniform, tangential, linear]
    }

    /// Displacement along the load line of one tooth \[m\] per load \[N\] on another.
    #[must_use]
    pub fn compliance(&self, influence: &Matrix3, on: [f64; 3], by: [f64; 3]) -> f64 {
        let moved = influence.map(|row| row[0] * by[0] + row[1] * by[1] + row[2] * by[2]);
        (on[0] * moved[0] + on[1] * moved[1] + on[2] * moved[2]) * self.flexibility
    }

    /// The influence of the tractions of a tooth at the angle 0 on the roots that are `offsets` behind it
    /// (in the direction against a positive torque), rows by the affected root's traction.
    #[must_use]
    pub fn influences(&self, offsets: &[f64]) -> Vec<Matrix3> {
        let theta = self.half_angle;
        let mut result = vec![[[0.0; 3]; 3]; offsets.len()];
        let [radial, _, _, tangential] = self.mean();
        for matrix in &mut result {
            // ∫ over the whole turn of the mean of a traction over the turn, θ_f/π: twice θ_f²/π.
            let weight = 2.0 * theta * theta / PI;
            matrix[0][0] += weight * radial;
            matrix[1][1] += weight * tangential;
        }
        for n in 1..=self.harmonics {
            let order = n as f64;
            let [rr, rt, tr, tt] = self.flexibility_of(n);
            let (sine, cosine) = libm::sincos(order * theta);
            // Coefficients of cos nθ of a uniform traction and of sin nθ of a linear one.
            let uniform = 2.0 * sine / (order * PI);
            let linear = 2.0 / (PI * theta) * (sine / order - theta * cosine) / order;
            for (matrix, offset) in result.iter_mut().zip(offsets) {
                let (s, c) = libm::sincos(-order * offset);
                let (uu, ul, ll) = (PI * uniform * uniform, PI * uniform * linear, PI * linear * linear);
                let terms: Matrix3 = [
                    [rr * uu * c, -rt * uu * s, rr * ul * s],
                    [tr * uu * s, tt * uu * c, -tr * ul * c],
                    [-rr * ul * s, -rt * ul * c, rr * ll * c],
                ];
                for (row, term) in matrix.iter_mut().zip(terms) {
                    for (total, value) in row.iter_mut().zip(term) {
                        *total += value;
                    }
                }
            }
        }
        // The rest of a root's own series: far up the rim moves as that of a half plane, (κ + 1)/4n, and the squares of
        // sine and cosine are ½ in the mean. Neighbours' terms change sign and add up to nothing.
        let rest = (self.kappa + 1.0) / (4.0 * PI * (self.harmonics as f64 + 0.5) * (self.harmonics as f64 + 0.5));
        for (matrix, _) in result.iter_mut().zip(offsets).filter(|(_, offset)| offset.abs() <= 0.0) {
            for (k, row) in matrix.iter_mut().enumerate() {
                row[k] += rest;
            }
        }
        result
    }

    /// Displacement of the outer rim by uniform tractions: [radial by radial, 0, 0, tangential by tangential].
    fn mean(&self) -> [f64; 4] {
        let (kappa, square) = (self.kappa, self.bore * self.bore);
        let radial = (1.0 - square) * (kappa - 1.0) / ((kappa + 1.0) * (1.0 + square) + (3.0 - kappa) * (1.0 - square));
        [radial, 0.0, 0.0, 0.5 * (1.0 / square - 1.0)]
    }

    /// Displacement amplitudes of the outer rim by traction amplitudes of harmonic n ≥ 1:
    /// [radial by normal, radial by shear, tangential by normal, tangential by shear].
    fn flexibility_of(&self, n: usize) -> [f64; 4] {
        let order = n as f64;
        if n > 1 && libm::pow(self.bore, order - 1.0) < UNFELT {
            // A full disc: only the two fields that are finite inside.
            let [a, c] = self.growing(n, 1.0);
            let determinant = a.normal_stress * c.shear_stress - c.normal_stress * a.shear_stress;
            let solve = |normal: f64, shear: f64| {
                let x = (normal * c.shear_stress - c.normal_stress * shear) / determinant;
                let y = (a.normal_stress * shear - normal * a.shear_stress) / determinant;
                [x * a.radial + y * c.radial, x * a.tangential + y * c.tangential]
            };
            let ([rr, tr], [rt, tt]) = (solve(1.0, 0.0), solve(0.0, 1.0));
            return [rr, rt, tr, tt];
        }
        let [outer, inner] = [1.0, self.bore].map(|r| self.fields(n, r));
        // Stresses grow with n; bringing the rows to one size keeps the pivots meaningful.
        let scale = 1.0 / order;
        let row = |fields: [Field; 4], part: fn(Field) -> f64, normal: f64, shear: f64| {
            let [a, b, c, d] = fields.map(part);
            [a, b, c, d, normal, shear]
        };
        let mut rows = [
            row(inner, |field| field.radial, 0.0, 0.0),
            row(inner, |field| field.tangential, 0.0, 0.0),
            row(outer, |field| field.normal_stress, 1.0, 0.0).map(|value| value * scale),
            row(outer, |field| field.shear_stress, 0.0, 1.0).map(|value| value * scale),
        ];
        solve(&mut rows);
        let sum = |column: usize, part: fn(&Field) -> f64| -> f64 {
            rows.iter().zip(&outer).map(|(row, field)| row[4 + column] * part(field)).sum()
        };
        [
            sum(0, |field| field.radial),
            sum(1, |field| field.radial),
            sum(0, |field| field.tangential),
            sum(1, |field| field.tangential),
        ]
    }

    /// The four fields of harmonic n at radius r: two that grow outwards, then two that decay.
    fn fields(&self, n: usize, r: f64) -> [Field; 4] {
        let ([a, b], [c, d]) = (self.growing(n, r), self.decaying(n, r));
        [a, b, c, d]
    }

    /// The two fields of harmonic n at radius r that grow outwards, each 1 in size at the outer rim.
    fn growing(&self, n: usize, r: f64) -> [Field; 2] {
        let (kappa, order) = (self.kappa, n as f64);
        let first = [kappa - order - 1.0, kappa + order + 1.0];
        [self.power(n, r, first, order + 1.0, 1.0), self.power(n, r, [-1.0, 1.0], order - 1.0, 1.0)]
    }

    /// The two that decay, each 1 in size at the bore.
    fn decaying(&self, n: usize, r: f64) -> [Field; 2] {
        let (kappa, order) = (self.kappa, n as f64);
        let first = if n == 1 {
            // The two potentials of a rigid shift coincide; the logarithm carries the resultant force instead.
            let logarithm = 2.0 * kappa * libm::log(r);
            Field {
                radial: logarithm - 1.0,
                tangential: -logarithm - 1.0,
                normal_stress: 2.0 * (kappa + 3.0) / r,
                shear_stress: 2.0 * (1.0 - kappa) / r,
            }
        } else {
            self.power(n, r, [kappa + order - 1.0, order - 1.0 - kappa], 1.0 - order, self.bore)
        };
        [first, self.power(n, r, [-1.0, -1.0], -order - 1.0, self.bore)]
    }

    /// The field of harmonic n at radius r whose displacements are `radial` and `tangential` times (r/`rim`)^`exponent`.
    fn power(&self, n: usize, r: f64, [radial, tangential]: [f64; 2], exponent: f64, rim: f64) -> Field {
        let (kappa, order) = (self.kappa, n as f64);
        let size = libm::pow(r / rim, exponent);
        let stretch = (kappa + 1.0) * exponent * radial + (3.0 - kappa) * (radial + order * tangential);
        Field {
            radial: radial * size,
            tangential: tangential * size,
            normal_stress: stretch / (kappa - 1.0) * size / r,
            shear_stress: ((exponent - 1.0) * tangential - order * radial) * size / r,
        }
    }
}

fn count(by_angle: f64, half_angle: f64) -> usize {
    // Root angles are π/z at least for what a rack can cut, so this is far inside the range.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let count = libm::ceil(by_angle / half_angle) as usize;
    count
}

/// How far influences are off with this many harmonics times the half root angle, in units of a root's own: those of
/// neighbours too, or only a root's own.
#[must_use]
pub fn error(by_angle: f64, neighbours: bool) -> f64 {
    CUT_OFF[usize::from(neighbours)] / (by_angle * by_angle * by_angle)
}

/// The least number, from `minimum` to `maximum`, with which they are off by no more than `error`.
#[must_use]
pub fn harmonics(error: f64, neighbours: bool, minimum: f64, maximum: f64) -> f64 {
    libm::ceil(libm::cbrt(CUT_OFF[usize::from(neighbours)] / error)).clamp(minimum, maximum)
}
