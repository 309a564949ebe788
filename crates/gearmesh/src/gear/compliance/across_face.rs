//! How far a load on a tooth is felt along its face: coupling lengths of the tooth and of the gear body.
//!
//! Kantorovich's reduction: across the face the plane deflection w(z) times its own shape φ(x, y). The energy
//! ½∫(k w² + G w′²)dz with k = 1/c is that of a shear layer, k w − G w″ = q with w′ = 0 at free ends, and ℓ = √(G/k). A
//! shape whose sections only shift and tilt past each other may warp, u_z = w′ χ, and then G = μ min_χ ∫|φ + ∇χ|² dA
//! is Saint-Venant's torsion with the local rotation ω for the twist:
//!
//! - tooth, a plate of the thickness 2x: μ ∫ (2x)³/3 ω² dy over its height, ω = θ + γ/2 with the tilt θ and the shear γ of
//!   the sections; θ begins with that of the half plane under the root, above the load it stays;
//! - body under the tooth: it shifts with the root by v and less and less down to the depth d: μ s_f d/3 · v²; d is the
//!   distance to the bore, and no more than the face is wide;
//! - wind-up of the ring, a separate layer since it reaches much farther: μ ∫ (θ r)² dA with its own θ(r).
//!
//! The shape is that of `weber_banaschek`, of the tooth that the rack cuts; c is that of the tables, whatever their method.
//! Source: Vlasov and Leontiev, Beams, Plates and Shells on Elastic Foundations, 1966 (reduction); the formulas of the
//! shape as in `weber_banaschek`. Must not know: modification, load, slices.

use std::f64::consts::PI;

use super::ToothCompliance;
use super::weber_banaschek::Body;
use crate::gear::geometry::Gear;
use crate::gear::geometry::involute::Section;
use crate::gear::geometry::root::RootShape;
use crate::numeric::chebyshev::Series;

/// Sections on each piece of the root and on the flank.
const SECTIONS: u32 = 96;
/// Chebyshev nodes along the flank.
const ROLLS: usize = 16;
/// How much more a section shears than under a uniform shear stress.
const SHEAR_FACTOR: f64 = 1.2;

/// One gear's layers.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers {
    /// Wind-up of the ring \[m/N\], already in the compliance of the tooth; no more than what its body has.
    pub wind_up: f64,
    /// ℓ of the wind-up \[m\].
    pub wind_up_length: f64,
    /// ℓ² times compliance per width of the tooth and the body under it \[m⁴/N\], against the roll angle.
    reach: Series,
    face_width: f64,
}

impl Layers {
    /// `face_width` is that of the contact \[m\], over which compliances are counted.
    #[must_use]
    pub fn new(gear: &Gear, tooth: &ToothCompliance, face_width: f64) -> Self {
        let shape = SectionedTooth::new(gear, face_width);
        let (lower, upper) = (tooth.body.lower(), gear.flank_end.roll);
        let nodes = (0..=2 * ROLLS).map(|node| lower + (upper - lower) * node as f64 / (2 * ROLLS) as f64);
        let body = nodes.map(|roll| tooth.body.value(roll)).fold(f64::INFINITY, f64::min).max(0.0);
        let (wind_up, wind_up_length) = ring(gear);
        Self {
            wind_up: (wind_up / face_width).min(body),
            wind_up_length,
            reach: Series::fit(lower, upper, ROLLS, |roll| shape.reach(roll)),
            face_width,
        }
    }

    /// ℓ \[m\] of the tooth with the body under it, whose compliance is `compliance` \[m/N\], without the wind-up.
    #[must_use]
    pub fn length(&self, roll: f64, compliance: f64) -> f64 {
        (self.reach.value(roll) / (compliance * self.face_width)).sqrt()
    }
}

/// Shear modulus.
fn shear_modulus(gear: &Gear) -> f64 {
    let material = gear.specification.material;
    material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio))
}

/// Compliance per width \[1/Pa\] and ℓ \[m\] of the wind-up. Below the root circle a ring, above it half full of teeth.
fn ring(gear: &Gear) -> (f64, f64) {
    let modulus = shear_modulus(gear);
    let (bore, root, tip) = (gear.specification.bore_radius, gear.root_radius, gear.tip_radius);
    let (ratio, factor) = (root * root / (bore * bore), gear.base_radius / (4.0 * PI * modulus));
    let rotation = factor * (ratio - 1.0) / (root * root);
    let compliance = gear.base_radius * rotation;
    let below = 2.0 * PI * factor * factor * (0.25 * (ratio * ratio - 1.0) - (ratio - 1.0) + 0.5 * libm::log(ratio));
    let teeth = 0.25 * PI * rotation * rotation * (tip * tip - root * root) * (tip * tip + root * root);
    (compliance, (modulus * (below + teeth) / compliance).sqrt())
}

/// A tooth as a row of sections.
struct SectionedTooth<'a> {
    gear: &'a Gear,
    /// Height, extent along the height, thickness.
    sections: Vec<[f64; 3]>,
    clamped: Body,
    /// Area of the body, weighted by how much it moves with the root \[m²\].
    moved: f64,
}

impl<'a> SectionedTooth<'a> {
    fn new(gear: &'a Gear, face_width: f64) -> Self {
        let mut sections = Vec::new();
        let mut add = |range: (f64, f64), section: &dyn Fn(f64) -> Section| {
            let step = (range.1 - range.0) / f64::from(SECTIONS);
            for index in 0..SECTIONS {
                let Section { half_thickness, height, height_rate } =
                    section(range.0 + step * (f64::from(index) + 0.5));
                sections.push([height, height_rate * step, 2.0 * half_thickness]);
            }
        };
        let mut clamped = None;
        // The generated root is always there.
        if let Ok(root) = gear.root(RootShape::Trochoid) {
            for piece in &root.pieces {
                add(piece.range(), &|parameter| piece.section(parameter));
            }
            add((root.form_roll, gear.tip_roll()), &|roll| gear.flank(roll));
            clamped = Some(Body::new(gear, &root));
        }
        let nothing = Body { height: gear.root_radius, chord: 0.0, wind_up: 0.0 };
        let clamped = clamped.unwrap_or(nothing);
        let depth = (gear.root_radius - gear.specification.bore_radius).min(face_width);
        Self { gear, sections, clamped, moved: clamped.chord * depth / 3.0 }
    }

    /// μ ∫|φ + ∇χ|² dA under a unit load per width at a roll angle \[m⁴/N\].
    fn reach(&self, roll: f64) -> f64 {
        let material = self.gear.specification.material;
        let nu = material.poisson_ratio;
        let cosine = libm::cos(self.gear.load_angle(roll));
        let strain = (1.0 - nu) * (1.0 + nu) * cosine / material.youngs_modulus;
        let top = self.gear.base_radius / cosine;
        let chord = self.clamped.chord;
        let arm = (top - self.clamped.height) / chord;
        let lever = (1.0 - 2.0 * nu) / (1.0 - nu);
        let shift = strain * (4.8 / PI + lever * arm);
        let mut tilt = strain * (18.0 / PI * arm + lever) / chord;
        let modulus = shear_modulus(self.gear);
        let mut twist = 0.0;
        for &[height, extent, thickness] in &self.sections {
            // The part of the section that is below the load.
            let part = ((top - height) / extent + 0.5).clamp(0.0, 1.0);
            let bent = 12.0 * strain * (top - height).max(0.0) / (thickness * thickness * thickness) * part * extent;
            let shear = SHEAR_FACTOR * cosine / (modulus * thickness) * part;
            let rotation = tilt + 0.5 * (bent + shear);
            tilt += bent;
            twist += thickness * thickness * thickness / 3.0 * rotation * rotation * extent;
        }
        modulus * (twist + self.moved * shift * shift)
    }
}

#[cfg(test)]
mod tests;
