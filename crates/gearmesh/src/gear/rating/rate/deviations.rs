//! By how much the flanks are off: stated, or as a tolerance class allows; and by how much they run in.
//!
//! Must not know: what factors follow.

use super::{Rated, Refused, SIDES, of_pair, place};
use crate::gear::geometry::{Gear, Side};
use crate::gear::iso1328::{self, ToothSizes};
use crate::gear::rating::distribution::{equivalent_misalignment, shaft_deflection};
use crate::gear::rating::material::Surface;
use crate::gear::rating::running_in::{self, Deviation};

/// The finest class in which B_k is 1 (ISO 6336-1, 6.5.4, footnote).
const COARSE_CLASS: i64 = 6;

impl Rated<'_> {
    /// A deviation of a gear that its tolerance class allows; none without one.
    fn allowed(&self, which: iso1328::Deviation, side: Side) -> Result<Option<f64>, Refused> {
        let Some(class) = self.given.tolerance_class else { return Ok(None) };
        let own = &self.pair.side(side).specification;
        let sizes = ToothSizes { teeth: own.teeth.into(), module: own.module, face_width: own.face_width };
        let found = iso1328::tolerance(which, &sizes, class);
        found.map(Some).map_err(|why| Refused::Outside(format!("the {}: {}", side.name(), why.message)))
    }

    fn larger(&self, which: iso1328::Deviation) -> Result<Option<f64>, Refused> {
        let [one, two] = SIDES.map(|side| self.allowed(which, side));
        Ok(one?.zip(two?).map(|(one, two)| one.max(two)))
    }

    /// f_pb and f_fα, as far as they are known.
    pub(super) fn transverse(&self) -> Result<[Option<f64>; 2], Refused> {
        let cosine = libm::cos(self.pair.pinion.specification.pressure_angle);
        let pitch = match self.given.base_pitch_deviation {
            Some(stated) => Some(stated),
            None => self.larger(iso1328::Deviation::Pitch)?.map(|pitch| pitch * cosine),
        };
        let profile = match self.given.profile_form_deviation {
            Some(stated) => Some(stated),
            None => self.larger(iso1328::Deviation::ProfileForm)?,
        };
        Ok([pitch, profile])
    }

    /// F_βx, stated or by shaft and helix slopes, under F_m/b.
    pub(super) fn misalignment(&self, pinion: &Gear, mean_load: f64) -> Result<Option<f64>, Refused> {
        if let Some(stated) = self.given.equivalent_misalignment {
            return Ok(Some(stated));
        }
        let slope = |side: Side| match self.conditions(side).helix_slope_deviation {
            Some(stated) => Ok(Some(stated)),
            None => self.allowed(iso1328::Deviation::HelixSlope, side),
        };
        let Some((one, two)) = slope(Side::Pinion)?.zip(slope(Side::Gear)?) else { return Ok(None) };
        let shaft = self.given.shaft.as_ref();
        let bent = shaft_deflection(mean_load, self.pair.contact_width(), 2.0 * pinion.reference_radius, shaft);
        Ok(Some(equivalent_misalignment(bent, [one, two], mean_load)))
    }

    /// What both gears together run in by; NaN where there is no deviation, or a strength that it takes is not given.
    pub(super) fn running_in(&self, which: Deviation, deviation: Option<f64>, velocity: f64) -> f64 {
        let gears = SIDES.map(|side| (self.conditions(side).material, self.conditions(side).contact_strength));
        let found = deviation.and_then(|deviation| running_in::mean(which, gears, deviation, velocity));
        found.unwrap_or(f64::NAN)
    }

    /// What a factor by a deviation lacks: that, or the strength of a soft gear, by which it runs in.
    pub(super) fn lacks(&self, what: &'static str, field: &str, deviation: Option<f64>, factor: &str) -> Refused {
        let soft = |side: &Side| {
            let given = self.conditions(*side);
            given.material.surface() == Surface::Soft && given.contact_strength.is_none()
        };
        let strength = SIDES.into_iter().find(soft).map(|side| place(side, "contact_strength"));
        let field = strength.filter(|_| deviation.is_some()).unwrap_or_else(|| field.to_owned());
        Refused::Missing(what, field, of_pair(factor))
    }

    /// B_k.
    pub(super) fn relief_parameter(&self, stiffness: f64, specific_load: f64) -> f64 {
        if let Some(stated) = self.given.factors.relief_parameter {
            return stated;
        }
        if self.given.tolerance_class.is_some_and(|class| class >= COARSE_CLASS) {
            return 1.0;
        }
        let by_running_in = || {
            let [one, two] = SIDES.map(|side| self.conditions(side).contact_strength.map(running_in::tip_relief));
            Some(0.5 * (one? + two?))
        };
        let relief = self.given.tip_relief.or_else(by_running_in);
        relief.map_or(f64::NAN, |relief| (1.0 - stiffness * relief / specific_load).abs())
    }
}
