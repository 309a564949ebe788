//! The section integrals of a tooth as a cantilever, from its clamped end up to any point of the flank.
//!
//! With y counted from the clamped section, ∫dy/I, ∫y dy/I, ∫y² dy/I and ∫dy/A serve every contact point, because the arm
//! of the load is r_b − y cos a1 identically. Per width and per modulus: I/b = (2x)³/12, A/b = 2x. Lengths in m.
//! Must not know: where the load is.

use crate::gear::geometry::Gear;
use crate::gear::geometry::root::Root;
use crate::numeric::chebyshev::Series;
use crate::numeric::quadrature::integrate;

/// Gauss points on each piece of the root, and degree of the series on the flank. Both reach 1e-13 on every gear that
/// the tests try; halving them is seen at 1e-9.
const ROOT_POINTS: usize = 48;
const FLANK_NODES: usize = 56;

/// ∫dy/I·b \[1/m²\], ∫y dy/I·b \[1/m\], ∫y² dy/I·b, ∫dy/A·b, the y of all from the clamped section.
pub type Integrals = [f64; 4];

/// The integrals of one tooth as functions of the roll angle of their upper end.
pub struct Sections {
    root: Integrals,
    flank: [Series; 4],
    point_roll: f64,
}

impl Sections {
    #[must_use]
    pub fn new(gear: &Gear, root: &Root) -> Self {
        let mut below = [0.0; 4];
        root.for_each(|start, end, point| {
            let piece = integrate(start, end, ROOT_POINTS, |parameter| {
                let section = point(parameter);
                integrands(section.x, section.y - root.clamped_height, section.dy)
            });
            for (sum, value) in below.iter_mut().zip(piece) {
                *sum += value;
            }
        });
        // The thickness vanishes at u_p like u_p − u; in v = −ln(u_p − u) the integrands are smooth on any flank.
        let point_roll = gear.point_roll();
        let parameter = |roll: f64| -libm::log(point_roll - roll);
        let (start, end) = (parameter(root.junction_roll), parameter(gear.roll_at(gear.tip_radius)));
        let section = |v: f64| {
            let ahead = libm::exp(-v);
            let roll = point_roll - ahead;
            let angle = roll - gear.half_base_angle;
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            let x = gear.base_radius * (roll * cos - sin);
            let y = gear.base_radius * (roll * sin + cos);
            integrands(x, y - root.clamped_height, gear.base_radius * roll * cos * ahead)
        };
        let flank = std::array::from_fn(|index| Series::fit(start, end, FLANK_NODES, |v| section(v)[index]).integral());
        Self { root: below, flank, point_roll }
    }

    /// The integrals from the clamped section up to the flank's point at `roll`.
    #[must_use]
    pub fn up_to(&self, roll: f64) -> Integrals {
        let v = -libm::log(self.point_roll - roll);
        std::array::from_fn(|index| self.root[index] + self.flank[index].value(v))
    }
}

fn integrands(x: f64, y: f64, dy: f64) -> Integrals {
    let thickness = 2.0 * x;
    let per_inertia = 12.0 * dy / (thickness * thickness * thickness);
    [per_inertia, y * per_inertia, y * y * per_inertia, dy / thickness]
}
