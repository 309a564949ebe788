//! The gear body as a plane elastic ring: how a load on one tooth moves its neighbours.
//!
//! Outer radius r_f, clamped at the bore; a tooth's load enters as tractions on its root arc ±θ_f: a constant normal
//! stress, a normal stress linear along the arc, a constant shear stress, with the resultants of the load (the
//! assumptions of Sainsot, Velex and Duverger 2004). The displacement of a tooth is the one that does work with its own
//! tractions, so Betti's theorem holds exactly and the matrix of any set of teeth is positive definite. Fourier series;
//! fields from Michell's solution (Barber, Elasticity, tables 8.1 and 9.1), plane stress. Lengths in m, per unit width.
//! Must not know: the tooth above its root.

use std::f64::consts::PI;

use crate::gear::compliance::Material;

/// Harmonics kept. Stresses jump at the ends of the arc, so the terms fall like n⁻³ only: at 1000 the self compliance is
/// within 3e-5 of its limit and the neighbour's within 3e-6, far below what the plane ring leaves out.
const HARMONICS: u32 = 1000;

/// Resultants of a load on a tooth, per unit load: across the tooth, along it (outwards), and the moment about the
/// gear's centre \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    pub across: f64,
    pub outwards: f64,
    pub moment: f64,
}

/// Boundary compliance of the ring, harmonic by harmonic, for unit width \[m²/N\].
pub struct Ring {
    outer: f64,
    half_angle: f64,
    /// Per harmonic n ≥ 1: displacements (u_r, u_θ) per traction (t_r, t_θ).
    harmonics: Vec<[[f64; 2]; 2]>,
    radial: f64,
    torsional: f64,
}

impl Ring {
    /// A ring between `inner` and `outer` radius whose teeth have root arcs of ±`half_angle`.
    #[must_use]
    pub fn new(inner: f64, outer: f64, half_angle: f64, material: &Material) -> Self {
        Self::with_harmonics(inner, outer, half_angle, material, HARMONICS)
    }

    fn with_harmonics(inner: f64, outer: f64, half_angle: f64, material: &Material, count: u32) -> Self {
        let nu = material.poisson_ratio;
        let shear_modulus = 0.5 * material.youngs_modulus / (1.0 + nu);
        let kappa = (3.0 - nu) / (1.0 + nu);
        // In units of the outer radius and of 2μ.
        let scale = outer / (2.0 * shear_modulus);
        let ratio = inner / outer;
        let harmonics =
            (1..=count).map(|n| harmonic(n, ratio, kappa).map(|row| row.map(|value| value * scale))).collect();
        let squared = ratio * ratio;
        Self {
            outer,
            half_angle,
            harmonics,
            // u_r = a(κ − 1)r − b/r with u_r(inner) = 0; σ_rr = 2a + b/r².
            radial: scale * (kappa - 1.0) * (1.0 - squared) / (2.0 + (kappa - 1.0) * squared),
            // u_θ = a r − b/r with u_θ(inner) = 0; σ_rθ = b/r².
            torsional: scale * (1.0 / squared - 1.0),
        }
    }

    /// How a tooth answers a load on the tooth `angle` \[rad\] behind it (0: on itself).
    #[must_use]
    pub fn influence(&self, angle: f64) -> Influence {
        let theta = self.half_angle;
        let mean = 2.0 * theta * theta / (PI * PI);
        // Rows and columns: constant normal, linear normal, constant shear.
        let mut sums = [[mean * self.radial, 0.0, 0.0], [0.0; 3], [0.0, 0.0, mean * self.torsional]];
        for (index, [[rr, rt], [tr, tt]]) in self.harmonics.iter().enumerate() {
            let n = (index + 1) as f64;
            let (sin, cos) = (libm::sin(n * theta), libm::cos(n * theta));
            let constant = 2.0 * sin / (n * PI);
            let linear = 2.0 * (sin / n - theta * cos) / (n * PI);
            let (s, c) = (libm::sin(n * angle), libm::cos(n * angle));
            let terms = [[rr * c, rr * s, -rt * s], [-rr * s, rr * c, -rt * c], [tr * s, -tr * c, tt * c]];
            let sizes = [constant, linear, constant];
            for (row, own) in sizes.iter().enumerate() {
                for (column, other) in sizes.iter().enumerate() {
                    sums[row][column] += own * other * terms[row][column];
                }
            }
        }
        Influence { outer: self.outer, half_angle: theta, sums }
    }
}

/// Work of the tractions of one tooth on the displacements that those of another cause.
pub struct Influence {
    outer: f64,
    half_angle: f64,
    sums: [[f64; 3]; 3],
}

impl Influence {
    /// Work-conjugate displacement of a tooth under `own` unit load, caused by `other`; for unit width \[m²/N\].
    #[must_use]
    pub fn compliance(&self, own: Load, other: Load) -> f64 {
        let (own, other) = (self.tractions(own), self.tractions(other));
        let mut sum = 0.0;
        for (row, a) in self.sums.iter().zip(own) {
            for (value, b) in row.iter().zip(other) {
                sum += a * value * b;
            }
        }
        PI * self.outer * sum
    }

    /// Constant normal, linear normal (t_r = value·φ) and constant shear stress with the load's resultants.
    fn tractions(&self, load: Load) -> [f64; 3] {
        let (theta, r) = (self.half_angle, self.outer);
        let (sin, cos) = (libm::sin(theta), libm::cos(theta));
        let shear = load.moment / (2.0 * theta * r * r);
        [load.outwards / (2.0 * sin * r), (load.across / (2.0 * r) - shear * sin) / (sin - theta * cos), shear]
    }
}

/// Outer displacements per outer traction of harmonic `n`, inner boundary clamped; radii in units of the outer one.
fn harmonic(n: u32, ratio: f64, kappa: f64) -> [[f64; 2]; 2] {
    // Each solution: (u_r, u_θ, σ_rr, σ_rθ) as functions of r; growing ones are 1 at the outer, falling ones at the inner radius.
    let inner = fields(n, ratio, ratio, kappa);
    let outer = fields(n, 1.0, ratio, kappa);
    let mut system = [[0.0; 6]; 4];
    for column in 0..4 {
        system[0][column] = inner[column][0];
        system[1][column] = inner[column][1];
        system[2][column] = outer[column][2];
        system[3][column] = outer[column][3];
    }
    system[2][4] = 1.0;
    system[3][5] = 1.0;
    let weights = solved(system);
    let displacement =
        |component: usize, load: usize| (0..4).map(|column| outer[column][component] * weights[column][load]).sum();
    [[displacement(0, 0), displacement(0, 1)], [displacement(1, 0), displacement(1, 1)]]
}

fn fields(n: u32, r: f64, inner: f64, kappa: f64) -> [[f64; 4]; 4] {
    if n == 1 {
        // The combination of rθ sin θ and r ln r cos θ that is single-valued carries the net force.
        let (a, b) = (kappa + 1.0, -(kappa - 1.0));
        let log = libm::log(r);
        let radial = 0.5 * (-(a + b) + (a * (kappa + 1.0) + b * (kappa - 1.0)) * log);
        let across = 0.5 * (-(a + b) - (a * (kappa + 1.0) + b * (kappa - 1.0)) * log);
        let fall = inner / r;
        return [
            [(kappa - 2.0) * r * r, (kappa + 2.0) * r * r, 2.0 * r, 2.0 * r],
            [fall * fall, fall * fall, -2.0 * fall * fall / r, -2.0 * fall * fall / r],
            [radial, across, (2.0 * a + b) / r, b / r],
            [1.0, -1.0, 0.0, 0.0],
        ];
    }
    let order = f64::from(n);
    let grown = libm::pow(r, order - 1.0);
    let fallen = libm::pow(inner / r, order - 1.0);
    let fallen_more = fallen * (inner / r) * (inner / r);
    let (r2, n1, n2) = (r * r, order + 1.0, order - 1.0);
    [
        [-order * grown, order * grown, -order * n2 * grown / r, order * n2 * grown / r],
        [(kappa - n1) * grown * r2, (kappa + n1) * grown * r2, -n1 * (order - 2.0) * grown * r, order * n1 * grown * r],
        [order * fallen_more, order * fallen_more, -order * n1 * fallen_more / r, -order * n1 * fallen_more / r],
        [(kappa + n2) * fallen, -(kappa - n2) * fallen, -(order + 2.0) * n2 * fallen / r, -order * n2 * fallen / r],
    ]
}

/// Solves a 4 × 4 system with two right-hand sides by elimination with partial pivoting.
fn solved(mut system: [[f64; 6]; 4]) -> [[f64; 2]; 4] {
    for column in 0..4 {
        let pivot =
            (column..4).max_by(|&a, &b| system[a][column].abs().total_cmp(&system[b][column].abs())).unwrap_or(column);
        system.swap(column, pivot);
        for row in column + 1..4 {
            let factor = system[row][column] / system[column][column];
            for entry in column..6 {
                system[row][entry] -= factor * system[column][entry];
            }
        }
    }
    let mut solution = [[0.0; 2]; 4];
    for row in (0..4).rev() {
        for side in 0..2 {
            let known: f64 = (row + 1..4).map(|column| system[row][column] * solution[column][side]).sum();
            solution[row][side] = (system[row][4 + side] - known) / system[row][row];
        }
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: Material = Material { youngs_modulus: 206e9, poisson_ratio: 0.3 };

    fn load(roll_angle: f64, base_radius: f64) -> Load {
        Load { across: libm::cos(roll_angle), outwards: -libm::sin(roll_angle), moment: base_radius }
    }

    /// Betti: a load's work on another's displacement is mutual.
    #[test]
    fn compliances_are_reciprocal() {
        let ring = Ring::new(0.014, 0.024_75, 0.14, &STEEL);
        let (a, b) = (load(0.1, 0.0268), load(0.43, 0.0268));
        for angle in [0.0, 0.33, 0.66] {
            let (there, back) = (ring.influence(angle).compliance(a, b), ring.influence(-angle).compliance(b, a));
            assert!((there - back).abs() < 1e-13 * there.abs(), "{there} and {back} at {angle}");
        }
    }

    #[test]
    fn the_series_converges_as_stated() {
        let of = |count| Ring::with_harmonics(0.014, 0.024_75, 0.14, &STEEL, count);
        let (few, many) = (of(HARMONICS), of(16_000));
        let (a, b) = (load(0.1, 0.0268), load(0.43, 0.0268));
        let error =
            |angle| (few.influence(angle).compliance(a, b) / many.influence(angle).compliance(a, b) - 1.0).abs();
        assert!(error(0.0) < 3e-5 && error(0.0) > 1e-9, "{}", error(0.0));
        assert!(error(0.330_69) < 3e-6, "{}", error(0.330_69));
    }

    /// A thin ring clamped just below its surface hardly moves; a large one moves like a half plane, whatever its bore.
    #[test]
    fn limits_are_right() {
        let a = load(0.2, 0.0268);
        let compliance = |bore: f64| Ring::new(bore, 0.024_75, 0.14, &STEEL).influence(0.0).compliance(a, a);
        assert!(compliance(0.0245) < 0.2 * compliance(0.015));
        // Rigid torsion of a disc clamped at a small shaft: the twist 1/(4πG)(1/r_i² − 1/r²) times the moment dominates.
        let shear_modulus = 206e9 / 2.6;
        let (bore, outer) = (1e-4, 0.024_75);
        let twist = 0.0268 * 0.0268 / (4.0 * PI * shear_modulus) * (1.0 / (bore * bore) - 1.0 / (outer * outer));
        assert!((compliance(bore) / twist - 1.0).abs() < 1e-3, "{}", compliance(bore) / twist);
    }

    /// Uniform radial pull on the whole rim: Lamé's solution for a disc on a rigid shaft.
    #[test]
    fn uniform_tension_is_lames_solution() {
        let (inner, outer) = (0.01_f64, 0.03_f64);
        let ring = Ring::new(inner, outer, 0.1, &STEEL);
        let (e, nu) = (206e9, 0.3);
        let (a2, b2) = (inner * inner, outer * outer);
        let lame = outer / e * (1.0 - nu * nu) * (b2 - a2) / (b2 * (1.0 + nu) + a2 * (1.0 - nu));
        assert!((ring.radial / lame - 1.0).abs() < 1e-13, "{} {lame}", ring.radial);
    }
}
