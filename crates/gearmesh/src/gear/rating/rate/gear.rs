//! The factors of one gear.
//!
//! Must not know: how the factors of the pair are found.

use super::{PairRating, Rated, Refused, SIDES, depth, place, stated};
use crate::gear::geometry::error::Plain;
use crate::gear::geometry::{Gear, Side};
use crate::gear::rating::bending::{self, Follows, ROUGHEST_ROOT, THINNEST_RIM};
use crate::gear::rating::conditions::GearConditions;
use crate::gear::rating::life;
use crate::gear::rating::material::{MaterialClass, Surface};
use crate::gear::rating::pitting::{self, SingleContact};
use crate::gear::rating::root::{Section, critical_section};

use super::GearRating;

/// A pinion that is substantially harder than a through-hardened wheel.
const HARDER: f64 = 1.2;

impl Rated<'_> {
    pub(super) fn gear_factors(&self, side: Side, of_pair: &PairRating) -> Result<GearRating, Refused> {
        let (given, gear) = (self.conditions(side), self.pair.side(side));
        let factors = &given.factors;

        let single_contact_factor =
            factors.single_contact_factor.unwrap_or_else(|| self.single_contact()[self.place_in_order(side)]);
        let loads = self.given.application_factor * of_pair.dynamic_factor;
        let contact_stress = single_contact_factor
            * of_pair.nominal_contact_stress
            * (loads * of_pair.face_load_factor_contact * of_pair.transverse_load_factor_contact).sqrt();
        let work_hardening_factor = match factors.work_hardening_factor {
            Some(stated) => stated,
            None if given.contact_strength.is_none() => f64::NAN,
            None => self.work_hardening(side, of_pair)?,
        };
        let long_life = self.given.long_life_factor;
        let life_factor_contact = factors.life_factor_contact.unwrap_or_else(|| {
            let after = |cycles| life::contact_factor(given.material, self.given.pitting, long_life, cycles);
            given.cycles.map_or(1.0, after)
        });
        let contact_limit = match given.contact_strength {
            None => f64::NAN,
            Some(strength) => {
                let film = [of_pair.lubricant_factor, of_pair.velocity_factor, of_pair.roughness_factor];
                if let Some(at) = film.iter().position(|factor| factor.is_nan()) {
                    return Err(self.lacks_film(at));
                }
                let [lubricant, velocity, roughness] = film;
                strength
                    * life_factor_contact
                    * (lubricant * velocity * roughness)
                    * work_hardening_factor
                    * factors.size_factor_contact
            }
        };

        let section = match (factors.form_factor, factors.stress_correction_factor) {
            (Some(_), Some(_)) => None,
            _ => Some(critical_section(self.pair, side).map_err(|why| Refused::Root { side, why })?),
        };
        let of_section =
            |stated: Option<f64>, of: fn(&Section) -> f64| stated.or(section.as_ref().map(of)).unwrap_or(f64::NAN);
        let form_factor = of_section(factors.form_factor, |section| section.form_factor);
        let stress_correction_factor =
            of_section(factors.stress_correction_factor, |section| section.stress_correction_factor);
        let rim_thickness_factor = self.rim_factor(side, gear)?;
        let module = gear.specification.module;
        let common = self.pair.contact_width();
        let root_width = gear.specification.face_width.min(common + 2.0 * self.given.overhang * module);
        let nominal_root_stress = of_pair.tangential_load / (root_width * module)
            * form_factor
            * stress_correction_factor
            * rim_thickness_factor;
        let root_stress =
            nominal_root_stress * (loads * of_pair.face_load_factor_root * of_pair.transverse_load_factor_root);
        let life_factor_root = factors
            .life_factor_root
            .unwrap_or_else(|| given.cycles.map_or(1.0, |cycles| life::root_factor(given.material, long_life, cycles)));
        let size_factor_root = factors.size_factor_root.unwrap_or_else(|| bending::size_factor(given.material, module));
        let (notch_sensitivity_factor, surface_factor, root_limit) = match given.bending_strength {
            None => (f64::NAN, f64::NAN, f64::NAN),
            Some(strength) => {
                let notch = self.notch_sensitivity(side, section.as_ref())?;
                let surface = surface(side, given)?;
                let test = factors.test_stress_correction_factor;
                (notch, surface, strength * test * life_factor_root * notch * surface * size_factor_root)
            }
        };
        Ok(GearRating {
            single_contact_factor,
            contact_stress,
            life_factor_contact,
            work_hardening_factor,
            size_factor_contact: factors.size_factor_contact,
            contact_limit,
            permissible_contact_stress: contact_limit / self.given.least_contact_safety,
            contact_safety: contact_limit / contact_stress,
            section,
            form_factor,
            stress_correction_factor,
            rim_thickness_factor,
            root_width,
            nominal_root_stress,
            root_stress,
            life_factor_root,
            notch_sensitivity_factor,
            surface_factor,
            size_factor_root,
            root_limit,
            permissible_root_stress: root_limit / self.given.least_root_safety,
            root_safety: root_limit / root_stress,
        })
    }

    fn place_in_order(&self, side: Side) -> usize {
        usize::from(side != self.order[0])
    }

    fn single_contact(&self) -> [f64; 2] {
        let of = |side: Side| self.pair.side(side);
        pitting::single_contact_factors(&SingleContact {
            teeth: self.both(|side| f64::from(of(side).specification.teeth)),
            tip_roll: self.both(|side| self.pair.highest_roll(side)),
            working_angle: self.pair.working_pressure_angle,
            contact_ratio: self.pair.contact_ratio,
            overlap_ratio: 0.0,
        })
    }

    fn lacks_film(&self, at: usize) -> Refused {
        let factor = ["lubricant_factor", "velocity_factor", "roughness_factor"][at];
        let lacks = |side: Side| {
            let given = self.conditions(side);
            let fields = [("contact_strength", given.contact_strength), ("flank_roughness", given.flank_roughness)];
            fields.into_iter().find(|(_, value)| value.is_none()).map(|(field, _)| place(side, field))
        };
        let field = SIDES.into_iter().find_map(lacks).unwrap_or_else(|| "viscosity".to_owned());
        Refused::Missing("the lubricant film (Z_L, Z_V, Z_R)", field, format!("factors.{factor}"))
    }

    /// Z_W: of a soft wheel with a harder pinion; 1 of all others.
    fn work_hardening(&self, side: Side, of_pair: &PairRating) -> Result<f64, Refused> {
        let [pinion, wheel] = self.both(|side| self.conditions(side));
        let soft = |given: &GearConditions| given.material.surface() == Surface::Soft;
        if side == self.order[0] || !soft(wheel) || pinion.material.surface() == Surface::CastIron {
            return Ok(1.0);
        }
        let missing = |side: Side| {
            Refused::Missing("Z_W", place(side, "hardness"), stated(self.order[1], "work_hardening_factor"))
        };
        let hardness = wheel.hardness.ok_or_else(|| missing(side))?;
        if soft(pinion) {
            let ratio = pinion.hardness.ok_or_else(|| missing(self.order[0]))? / hardness;
            let factor = if ratio < HARDER { 1.0 } else { pitting::through_hardened_factor(ratio, of_pair.gear_ratio) };
            return Ok(factor);
        }
        let film = self.film(of_pair.velocity).ok_or_else(|| self.lacks_film(2))?;
        Ok(film.work_hardening_factor(hardness))
    }

    fn rim_factor(&self, side: Side, gear: &Gear) -> Result<f64, Refused> {
        if let Some(stated) = self.conditions(side).factors.rim_thickness_factor {
            return Ok(stated);
        }
        let Some(rim) = self.rim(side)? else { return Ok(1.0) };
        bending::rim_thickness_factor(rim / depth(gear)).ok_or_else(|| {
            Refused::Outside(format!(
                "ISO 6336-3 has no Y_B for the {}: its rim is {} of the tooth depth thick, and must be more than {}; state \
                 `{}` for what it is",
                side.name(),
                Plain(rim / depth(gear)),
                Plain(THINNEST_RIM),
                stated(side, "rim_thickness_factor")
            ))
        })
    }

    /// Y_δrelT.
    fn notch_sensitivity(&self, side: Side, section: Option<&Section>) -> Result<f64, Refused> {
        let given = self.conditions(side);
        let factor = "notch_sensitivity_factor";
        if let Some(stated) = given.factors.notch_sensitivity_factor {
            return Ok(stated);
        }
        let section = match section {
            Some(section) => *section,
            None => critical_section(self.pair, side).map_err(|why| Refused::Root { side, why })?,
        };
        let (field, strength) = match bending::slip_layer_follows(given.material) {
            Follows::Nothing => ("", Some(0.0)),
            Follows::YieldStrength => ("yield_strength", given.yield_strength),
            Follows::TensileStrength => ("tensile_strength", given.tensile_strength),
        };
        let strength = strength.ok_or_else(|| Refused::Missing("Y_δrelT", place(side, field), stated(side, factor)))?;
        Ok(bending::notch_sensitivity_factor(section.notch, bending::slip_layer(given.material, strength)))
    }
}

/// Y_RrelT.
fn surface(side: Side, given: &GearConditions) -> Result<f64, Refused> {
    let factor = "surface_factor";
    if let Some(stated) = given.factors.surface_factor {
        return Ok(stated);
    }
    let missing = || Refused::Missing("Y_RrelT", place(side, "root_roughness"), stated(side, factor));
    let roughness = given.root_roughness.ok_or_else(missing)?;
    let class: MaterialClass = given.material;
    bending::surface_factor(class, roughness).ok_or_else(|| {
        Refused::Outside(format!(
            "ISO 6336-3 has no Y_RrelT for the {}: R_z of its fillet is {} µm, and may be {}; state `{}` for what it is",
            side.name(),
            Plain(1e6 * roughness),
            Plain(1e6 * ROUGHEST_ROOT),
            stated(side, factor)
        ))
    })
}
