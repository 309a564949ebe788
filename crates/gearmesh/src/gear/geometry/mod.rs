//! Spur gears and pairs of them, in the terms of ISO 21771. Lengths in m, angles in rad.
//!
//! Must not know: stiffness, modification.

pub mod error;
pub mod flank_end;
pub mod gear;
pub mod generated;
pub mod inspection;
pub mod involute;
pub mod outline;
pub mod pair;
pub mod pinion_cutter;
pub mod root;
pub mod root_piece;
pub mod sliding;
pub mod thickness;
pub mod tip_path;
pub mod trochoid;
pub mod validity;

#[cfg(test)]
mod tests;

use std::f64::consts::FRAC_PI_4;

use super::material::Material;
use declare::Declared;
use declare::units::ANGLE;
use flank_end::FlankEnd;
use outline::tip::Tip;
use pinion_cutter::PinionCutter;

/// The rack that cuts a gear, in units of the module, where it stands against the finished tooth (ISO 53, ISO 6336-3).
///
/// Its dedendum counts from the line on which the finished tooth is half a pitch thick, also where its flanks leave stock: one
/// with the tool addendum h_aP0 of its own has h_fP = h_aP0 − q/sin α.
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
pub struct Rack {
    /// Addendum coefficient h_aP*.
    #[declared(minimum = 0.1, maximum = 3.0, default = "1.0", counts_in = "module")]
    pub addendum: f64,
    /// Dedendum coefficient h_fP*.
    #[declared(minimum = 0.1, maximum = 4.0, default = "1.25", counts_in = "module")]
    pub dedendum: f64,
    /// Tip radius coefficient ρ_fP*.
    #[declared(minimum = 0.0, maximum = 2.0, default = "0.38", counts_in = "module")]
    pub tip_radius: f64,
    /// Protuberance pr*: how far the round of the tip stands out of the straight flank, normal to it.
    #[declared(minimum = 0.0, maximum = 0.5, default = "0.0", counts_in = "module")]
    pub protuberance: f64,
    /// Angle α_prP of the straight side of the protuberance, from the round to the flank; below the pressure angle.
    #[declared(minimum = DEGREE, maximum = FRAC_PI_4, dimension = ANGLE, default = "10 deg")]
    pub protuberance_angle: f64,
    /// Machining allowance q*: what the flanks of the tool leave on each flank of the tooth to be ground off.
    #[declared(minimum = 0.0, maximum = 0.5, default = "0.0", counts_in = "module")]
    pub machining_allowance: f64,
    /// Radius ρ_g* of the notch that grinding leaves in the root, where the allowance is larger than the protuberance.
    #[declared(minimum = 0.0, maximum = 2.0, default = "0.0", counts_in = "module")]
    pub notch_radius: f64,
}

/// Degrees to radians.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

impl Rack {
    /// Basic rack A of ISO 53.
    pub const ISO_53_A: Self = Self {
        addendum: 1.0,
        dedendum: 1.25,
        tip_radius: 0.38,
        protuberance: 0.0,
        protuberance_angle: 10.0 * DEGREE,
        machining_allowance: 0.0,
        notch_radius: 0.0,
    };

    /// s_pr* = pr* − q* \[modules\]: how far the round of the tip reaches beyond the finished flank, normal to it; below 0 where it
    /// stays short of it, and grinding leaves a notch.
    #[must_use]
    pub fn residual_undercut(&self) -> f64 {
        self.protuberance - self.machining_allowance
    }
}

/// What defines one gear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specification {
    /// z.
    pub teeth: u32,
    /// m \[m\].
    pub module: f64,
    /// α \[rad\].
    pub pressure_angle: f64,
    /// x, in units of the module.
    pub profile_shift: f64,
    /// A_s \[m\]: by how much its teeth are thicker on the reference circle than x says; below 0 for backlash. Tip circle and
    /// centre distance stay those of x.
    pub thickness_allowance: f64,
    /// Basic rack that generates its teeth; of one that is shaped it says the addendum.
    pub rack: Rack,
    /// Pinion-type cutter that shapes its teeth, where no rack does.
    pub cutter: Option<PinionCutter>,
    /// r_a \[m\] when it is not m(z/2 + h_aP* + x).
    pub tip_radius: Option<f64>,
    /// b \[m\].
    pub face_width: f64,
    /// Radius of the bore, where the body is clamped \[m\].
    pub bore_radius: f64,
    /// E and ν of tooth and body.
    pub material: Material,
}

impl Specification {
    /// z teeth of module m \[m\] with α of 20°, x of 0, the basic rack ISO 53 A and teeth of steel. Face width and bore are still
    /// to be given; without a face width no pair is made of it.
    #[must_use]
    pub fn spur(teeth: u32, module: f64) -> Self {
        Self {
            teeth,
            module,
            pressure_angle: 20_f64.to_radians(),
            profile_shift: 0.0,
            thickness_allowance: 0.0,
            rack: Rack::ISO_53_A,
            cutter: None,
            tip_radius: None,
            face_width: 0.0,
            bore_radius: 0.0,
            material: Material::STEEL,
        }
    }

    /// The same with the face width b \[m\].
    #[must_use]
    pub fn face_width(self, face_width: f64) -> Self {
        Self { face_width, ..self }
    }

    /// The same with this radius of the bore \[m\].
    #[must_use]
    pub fn bore_radius(self, bore_radius: f64) -> Self {
        Self { bore_radius, ..self }
    }

    /// The same with the profile shift coefficient x.
    #[must_use]
    pub fn profile_shift(self, profile_shift: f64) -> Self {
        Self { profile_shift, ..self }
    }

    /// s_pr \[m\]: how far the protuberance of its rack reaches beyond the finished flank, normal to it; 0 where it does not, and of a
    /// gear that a cutter shapes.
    #[must_use]
    pub fn residual_undercut(&self) -> f64 {
        if self.cutter.is_some() { 0.0 } else { self.module * self.rack.residual_undercut().max(0.0) }
    }

    /// r_f \[m\] that its cutter leaves, if it has one that can cut it.
    pub(crate) fn shaped_root_radius(&self) -> Option<f64> {
        let shaping = self.cutter?.shaping(self).ok()?;
        Some(shaping.centre_distance - shaping.tip_radius)
    }

    /// ρ of the tip of its tool \[modules\].
    #[must_use]
    pub fn tool_tip_radius(&self) -> f64 {
        self.cutter.map_or(self.rack.tip_radius, |cutter| cutter.tip_radius)
    }

    /// The same gear of a tool whose tip has another radius \[modules\].
    #[must_use]
    pub fn with_tool_tip_radius(mut self, tip_radius: f64) -> Self {
        match &mut self.cutter {
            Some(cutter) => cutter.tip_radius = tip_radius,
            None => self.rack.tip_radius = tip_radius,
        }
        self
    }
}

/// Which of the two gears.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// The driving gear, index 1.
    Pinion,
    /// The driven gear, index 2.
    Gear,
}

impl Side {
    /// `pinion` or `gear`, as in studies and tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pinion => "pinion",
            Self::Gear => "gear",
        }
    }

    /// The mate's side.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Pinion => Self::Gear,
            Self::Gear => Self::Pinion,
        }
    }
}

/// One gear with everything that follows from its specification.
#[derive(Clone, Debug, PartialEq)]
pub struct Gear {
    /// What defines it.
    pub specification: Specification,
    /// r = m z / 2.
    pub reference_radius: f64,
    /// r_b.
    pub base_radius: f64,
    /// r_a.
    pub tip_radius: f64,
    /// r_f.
    pub root_radius: f64,
    /// Radius at which the generated root curve meets the involute.
    pub form_radius: f64,
    /// Roll angle at the form radius \[rad\]; known better than the form radius where that is near the base circle.
    pub form_roll: f64,
    /// Whether the rack cuts into the involute: the root curve then crosses it at an angle.
    pub undercut: bool,
    /// ψ_b: half the angle of the tooth at the base circle \[rad\].
    pub half_base_angle: f64,
    /// What becomes of the corner between flank and tip circle.
    pub tip: Tip,
    /// Where the flank ends because of that.
    pub flank_end: FlankEnd,
}

/// Two gears on their centre distance. Path positions `s` \[m\] count from the pinion's tangent point T1.
#[derive(Clone, Debug, PartialEq)]
pub struct GearPair {
    /// Gear 1, which drives.
    pub pinion: Gear,
    /// Gear 2, which is driven.
    pub gear: Gear,
    /// a_w \[m\].
    pub centre_distance: f64,
    /// α_w \[rad\].
    pub working_pressure_angle: f64,
    /// L = a_w sin α_w, the length T1T2 \[m\].
    pub tangent_length: f64,
    /// s_A, start of contact.
    pub start_of_contact: f64,
    /// s_E, end of contact.
    pub end_of_contact: f64,
    /// p_b \[m\].
    pub base_pitch: f64,
    /// ε_α.
    pub contact_ratio: f64,
}

impl Gear {
    /// h_fP \[modules\]: of its rack or, of one that is shaped, as deep as its cutter goes at x_E.
    #[must_use]
    pub fn dedendum(&self) -> f64 {
        let Specification { module, rack, cutter, .. } = self.specification;
        cutter.map_or(rack.dedendum, |_| {
            (self.reference_radius - self.root_radius) / module + self.specification.generating_profile_shift()
        })
    }
}

impl GearPair {
    /// The gear on a side.
    #[must_use]
    pub fn side(&self, side: Side) -> &Gear {
        match side {
            Side::Pinion => &self.pinion,
            Side::Gear => &self.gear,
        }
    }

    /// The roll angle \[rad\] of a gear's contact point at path position `s`: u1 = s/r_b1, u2 = (L − s)/r_b2.
    #[must_use]
    pub fn roll(&self, side: Side, s: f64) -> f64 {
        match side {
            Side::Pinion => s / self.pinion.base_radius,
            Side::Gear => (self.tangent_length - s) / self.gear.base_radius,
        }
    }
}
