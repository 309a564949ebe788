//! Every factor of a pair under a torque at a speed, in the order in which the standard finds them.
//!
//! Must not know: where any number is shown.

mod deviations;
mod gear;

use super::conditions::{Conditions, GearConditions};
use super::distribution::{self, Transverse};
use super::dynamic::{self, Inertia, LIGHT_LOAD, Range, Rim, Running};
use super::pitting::{self, Film};
use super::root::{Outside, Section};
use super::running_in::Deviation;
use crate::gear::compliance::iso6336::{self, Iso6336};
use crate::gear::geometry::error::Plain;
use crate::gear::geometry::{Gear, GearPair, Side};

/// C_M: measured over theoretical stiffness.
const CORRECTION_FACTOR: f64 = 0.8;
/// c_γβ/c_γα.
const ACROSS_FACE: f64 = 0.85;

/// The factors of a pair, in SI; a number that nothing is known of is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairRating {
    /// Which of our gears is the standard's pinion.
    pub pinion: Side,
    /// F_t \[N\] on the reference circles.
    pub tangential_load: f64,
    /// v \[m/s\] of the reference circles.
    pub velocity: f64,
    /// u.
    pub gear_ratio: f64,
    /// C_R.
    pub blank_factor: f64,
    /// c′ \[Pa\].
    pub single_stiffness: f64,
    /// c_γα \[Pa\].
    pub mesh_stiffness: f64,
    /// m_red \[kg/m\].
    pub reduced_mass: f64,
    /// n_E1 \[rad/s\], of the standard's pinion.
    pub resonance_speed: f64,
    /// N.
    pub resonance_ratio: f64,
    /// B_p, B_f, B_k.
    pub deviations: [f64; 3],
    /// Where the pair runs, when K_V is computed.
    pub range: Option<Range>,
    /// F_βx \[m\].
    pub equivalent_misalignment: f64,
    /// y_α \[m\].
    pub running_in_transverse: f64,
    /// y_β \[m\].
    pub running_in_helix: f64,
    /// K_V.
    pub dynamic_factor: f64,
    /// K_Hβ.
    pub face_load_factor_contact: f64,
    /// K_Fβ.
    pub face_load_factor_root: f64,
    /// K_Hα.
    pub transverse_load_factor_contact: f64,
    /// K_Fα.
    pub transverse_load_factor_root: f64,
    /// Z_H.
    pub zone_factor: f64,
    /// Z_E \[√Pa\].
    pub elasticity_factor: f64,
    /// Z_ε.
    pub contact_ratio_factor: f64,
    /// σ_H0 \[Pa\].
    pub nominal_contact_stress: f64,
    /// Z_L.
    pub lubricant_factor: f64,
    /// Z_V.
    pub velocity_factor: f64,
    /// Z_R.
    pub roughness_factor: f64,
}

/// The factors of a gear, in SI; a number that nothing is known of is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GearRating {
    /// Z_B of the standard's pinion, Z_D of its wheel.
    pub single_contact_factor: f64,
    /// σ_H \[Pa\].
    pub contact_stress: f64,
    /// Z_NT.
    pub life_factor_contact: f64,
    /// Z_W.
    pub work_hardening_factor: f64,
    /// Z_X.
    pub size_factor_contact: f64,
    /// σ_HG \[Pa\].
    pub contact_limit: f64,
    /// σ_HP \[Pa\].
    pub permissible_contact_stress: f64,
    /// S_H.
    pub contact_safety: f64,
    /// The critical section, in modules; none where both Y_F and Y_S are stated.
    pub section: Option<Section>,
    /// Y_F.
    pub form_factor: f64,
    /// Y_S.
    pub stress_correction_factor: f64,
    /// Y_B.
    pub rim_thickness_factor: f64,
    /// b of the root \[m\].
    pub root_width: f64,
    /// σ_F0 \[Pa\].
    pub nominal_root_stress: f64,
    /// σ_F \[Pa\].
    pub root_stress: f64,
    /// Y_NT.
    pub life_factor_root: f64,
    /// Y_δrelT.
    pub notch_sensitivity_factor: f64,
    /// Y_RrelT.
    pub surface_factor: f64,
    /// Y_X.
    pub size_factor_root: f64,
    /// σ_FG \[Pa\].
    pub root_limit: f64,
    /// σ_FP \[Pa\].
    pub permissible_root_stress: f64,
    /// S_F.
    pub root_safety: f64,
}

/// All factors.
#[derive(Clone, Debug, PartialEq)]
pub struct Rating {
    /// Of the pair.
    pub pair: PairRating,
    /// Of our pinion and gear.
    pub gears: [GearRating; 2],
}

/// Why there is no rating.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refused {
    /// A factor needs a number that is not given: what it is for, where, and what to give.
    #[error("{0} needs `{1}`: give it, or state the factor as `{2}`")]
    Missing(&'static str, String, String),
    /// The standard has no factor there.
    #[error("{0}")]
    Outside(String),
    /// No Y_F and Y_S.
    #[error("ISO 6336-3 gives no Y_F and Y_S of the {}: {why}", .side.name())]
    Root {
        /// Of which gear.
        side: Side,
        /// Why not.
        why: Outside,
    },
}

fn place(side: Side, field: &str) -> String {
    format!("{}.{field}", side.name())
}

fn stated(side: Side, factor: &str) -> String {
    format!("{}.factors.{factor}", side.name())
}

fn of_pair(factor: &str) -> String {
    format!("factors.{factor}")
}

const SIDES: [Side; 2] = [Side::Pinion, Side::Gear];

/// A pair, and what it is rated under.
struct Rated<'a> {
    pair: &'a GearPair,
    given: &'a Conditions,
    /// The standard's pinion and wheel.
    order: [Side; 2],
}

/// Rates a pair under a torque on our pinion \[N m\] at its speed \[rad/s\], both above 0.
///
/// # Errors
/// When a number is missing that a factor needs which is not stated, or the standard has no formula for the pair.
pub fn rate(pair: &GearPair, torque: f64, speed: f64, given: &Conditions) -> Result<Rating, Refused> {
    let fewer = pair.gear.specification.teeth < pair.pinion.specification.teeth;
    let order = if fewer { [Side::Gear, Side::Pinion] } else { SIDES };
    let rated = Rated { pair, given, order };
    let of_pair = rated.pair_factors(torque, speed)?;
    let [pinion, gear] = SIDES.map(|side| rated.gear_factors(side, &of_pair));
    Ok(Rating { pair: of_pair, gears: [pinion?, gear?] })
}

/// Half of tip minus root diameter: h.
fn depth(gear: &Gear) -> f64 {
    gear.tip_radius - gear.root_radius
}

impl Rated<'_> {
    fn conditions(&self, side: Side) -> &GearConditions {
        match side {
            Side::Pinion => &self.given.pinion,
            Side::Gear => &self.given.gear,
        }
    }

    fn both<T>(&self, of: impl FnMut(Side) -> T) -> [T; 2] {
        self.order.map(of)
    }

    /// Rim thickness s_R of a gear, as far as it has one.
    fn rim(&self, side: Side) -> Result<Option<f64>, Refused> {
        let Some(rim) = self.conditions(side).rim_thickness else { return Ok(None) };
        let root = self.pair.side(side).root_radius;
        if rim < root {
            return Ok(Some(rim));
        }
        Err(Refused::Outside(format!(
            "the rim of the {} is {} mm thick, but its root circle has a radius of {} mm",
            side.name(),
            Plain(1e3 * rim),
            Plain(1e3 * root)
        )))
    }

    /// C_R: the mean of both gears, as the standard takes C_B.
    fn blank_factor(&self) -> Result<f64, Refused> {
        if let Some(stated) = self.given.factors.blank_factor {
            return Ok(stated);
        }
        let of = |side: Side| {
            let own = &self.pair.side(side).specification;
            let (rim, web) = (self.rim(side)?, self.conditions(side).web_thickness);
            match (rim, web) {
                (None, None) => Ok(1.0),
                (Some(rim), web) => {
                    let web = web.unwrap_or(own.face_width);
                    Ok(distribution::blank_factor(web / own.face_width, rim / own.module))
                }
                (None, Some(_)) => Err(Refused::Missing("C_R", place(side, "rim_thickness"), of_pair("blank_factor"))),
            }
        };
        Ok(0.5 * (of(Side::Pinion)? + of(Side::Gear)?))
    }

    fn inertia(&self, side: Side) -> Result<Inertia, Refused> {
        let (gear, given) = (self.pair.side(side), self.conditions(side));
        if let Some(inertia) = given.moment_of_inertia {
            return Ok(Inertia::PerWidth(inertia / gear.specification.face_width));
        }
        let inner = self.rim(side)?.map_or(gear.specification.bore_radius, |rim| gear.root_radius - rim);
        let mean_diameter = gear.tip_radius + gear.root_radius;
        Ok(Inertia::Rim(Rim {
            mean_diameter,
            inner_diameter: 2.0 * inner,
            density: gear.specification.material.density,
        }))
    }

    fn pair_factors(&self, torque: f64, speed: f64) -> Result<PairRating, Refused> {
        let (pair, given) = (self.pair, self.given);
        let [pinion, wheel] = self.both(|side| pair.side(side));
        let width = pair.contact_width();
        let tangential_load = torque / pair.pinion.reference_radius;
        let velocity = speed * pair.pinion.reference_radius;
        let pinion_speed = velocity / pinion.reference_radius;
        let specific_load = tangential_load * given.application_factor / width;

        let blank_factor = self.blank_factor()?;
        let method = Iso6336 { correction_factor: CORRECTION_FACTOR, blank_factor };
        let stiffness = iso6336::stiffness(&iso6336::Inputs::of(pair, &method));
        // Formula (84): light loads find softer teeth.
        let light = libm::sqrt(libm::sqrt((specific_load / LIGHT_LOAD).min(1.0)));
        let (single_stiffness, mesh_stiffness) = (stiffness.single * light, stiffness.mesh * light);

        let base_radii = [pinion.base_radius, wheel.base_radius];
        let [one, two] = self.both(|side| self.inertia(side));
        let reduced_mass = dynamic::reduced_mass([one?, two?], base_radii);
        let resonance_speed =
            dynamic::resonance_speed(f64::from(pinion.specification.teeth), mesh_stiffness, reduced_mass);
        let resonance_ratio = pinion_speed / resonance_speed;

        let [pitch, profile] = self.transverse()?;
        let factors = &given.factors;
        let running_in_transverse = self.running_in(Deviation::Transverse, pitch, velocity);
        let of_profile = self.running_in(Deviation::Transverse, profile, velocity);
        let over_deflection = |deviation: Option<f64>, running_in: f64| {
            deviation.map_or(f64::NAN, |deviation| single_stiffness * (deviation - running_in) / specific_load)
        };
        let deviations = [
            over_deflection(pitch, running_in_transverse),
            over_deflection(profile, of_profile),
            self.relief_parameter(single_stiffness, specific_load),
        ];
        let (dynamic_factor, range) = if let Some(stated) = factors.dynamic_factor {
            (stated, None)
        } else {
            let fields = [("base_pitch_deviation", pitch), ("profile_form_deviation", profile), ("tip_relief", None)];
            if let Some(at) = deviations.iter().position(|deviation| deviation.is_nan()) {
                let (field, deviation) = fields[at];
                return Err(self.lacks("K_V", field, deviation, "dynamic_factor"));
            }
            let contact_ratio = pair.contact_ratio;
            let running = Running { resonance_ratio, specific_load, contact_ratio, deviations };
            let (factor, range) = dynamic::dynamic_factor(&running);
            (factor, Some(range))
        };

        let mean_load = specific_load * dynamic_factor;
        let misalignment = self.misalignment(pinion, mean_load)?;
        let running_in_helix = self.running_in(Deviation::Helix, misalignment, velocity);
        let face_load_factor_contact = if let Some(stated) = factors.face_load_factor_contact {
            stated
        } else {
            if running_in_helix.is_nan() {
                let factor = "face_load_factor_contact";
                return Err(self.lacks("K_Hβ", "equivalent_misalignment", misalignment, factor));
            }
            let left = misalignment.unwrap_or(f64::NAN) - running_in_helix;
            distribution::face_load_factor(left, ACROSS_FACE * mesh_stiffness, mean_load)
        };
        let face_load_factor_root = factors.face_load_factor_root.unwrap_or_else(|| {
            let [one, two] = [pinion, wheel].map(|gear| gear.specification.face_width / depth(gear));
            distribution::root_face_load_factor(face_load_factor_contact, one.min(two))
        });

        let contact_ratio_factor = match factors.contact_ratio_factor {
            Some(stated) => stated,
            None => pitting::contact_ratio_factor(pair.contact_ratio, 0.0),
        };
        let stated = [factors.transverse_load_factor_contact, factors.transverse_load_factor_root];
        let [transverse_load_factor_contact, transverse_load_factor_root] = if let [Some(contact), Some(root)] = stated
        {
            [contact, root]
        } else {
            if running_in_transverse.is_nan() {
                let factor = if stated[0].is_none() { "contact" } else { "root" };
                let factor = format!("transverse_load_factor_{factor}");
                return Err(self.lacks("K_Hα and K_Fα", "base_pitch_deviation", pitch, &factor));
            }
            let deviation = pitch.unwrap_or(f64::NAN) - running_in_transverse;
            let found = distribution::transverse_load_factors(&Transverse {
                mesh_stiffness,
                deviation,
                specific_load: mean_load * face_load_factor_contact,
                contact_ratio: pair.contact_ratio,
                overlap_ratio: 0.0,
                contact_ratio_factor,
            });
            [stated[0].unwrap_or(found[0]), stated[1].unwrap_or(found[1])]
        };

        let angle = pinion.specification.pressure_angle;
        let zone_factor =
            factors.zone_factor.unwrap_or_else(|| pitting::zone_factor(pair.working_pressure_angle, angle, 0.0));
        let materials = [&pinion.specification.material, &wheel.specification.material];
        // Stated in √(N/mm²), which is 1000 √Pa.
        let elasticity_factor =
            factors.elasticity_factor.map_or_else(|| pitting::elasticity_factor(materials), |stated| 1e3 * stated);
        let gear_ratio = f64::from(wheel.specification.teeth) / f64::from(pinion.specification.teeth);
        let load = pitting::contact_load(tangential_load, 2.0 * pinion.reference_radius, width, gear_ratio);
        let film = self.film(velocity);
        let of_film = |stated: Option<f64>, of: fn(&Film) -> f64| stated.or(film.as_ref().map(of)).unwrap_or(f64::NAN);
        Ok(PairRating {
            pinion: self.order[0],
            tangential_load,
            velocity,
            gear_ratio,
            blank_factor,
            single_stiffness,
            mesh_stiffness,
            reduced_mass,
            resonance_speed,
            resonance_ratio,
            deviations,
            range,
            equivalent_misalignment: misalignment.unwrap_or(f64::NAN),
            running_in_transverse,
            running_in_helix,
            dynamic_factor,
            face_load_factor_contact,
            face_load_factor_root,
            transverse_load_factor_contact,
            transverse_load_factor_root,
            zone_factor,
            elasticity_factor,
            contact_ratio_factor,
            nominal_contact_stress: zone_factor * elasticity_factor * contact_ratio_factor * load,
            lubricant_factor: of_film(factors.lubricant_factor, Film::lubricant_factor),
            velocity_factor: of_film(factors.velocity_factor, Film::velocity_factor),
            roughness_factor: of_film(factors.roughness_factor, Film::roughness_factor),
        })
    }

    /// The lubricant between the flanks, where all is given that it takes.
    fn film(&self, velocity: f64) -> Option<Film> {
        let [one, two] = self.both(|side| self.conditions(side));
        let roughness = [one.flank_roughness?, two.flank_roughness?];
        let tangent = libm::tan(self.pair.working_pressure_angle);
        let [first, second] = self.both(|side| self.pair.side(side).base_radius * tangent);
        Some(Film {
            strength: one.contact_strength?.min(two.contact_strength?),
            viscosity: self.given.viscosity?,
            velocity,
            roughness,
            curvature_radius: first * second / (first + second),
        })
    }
}
