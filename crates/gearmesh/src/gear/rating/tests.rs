//! Printed examples, other programs, limits.

mod examples;
mod factors;
mod refusals;

use super::conditions::{Conditions, GearConditions, GearFactors, PairFactors};
use super::life::Pitting;
use super::material::MaterialClass;
use crate::gear::fixtures::standard;
use crate::gear::geometry::{GearPair, Rack, Specification};
use declare::declared::{Declared, record_of};

/// As a study has it that says nothing of this gear but its material.
fn made_of(material: MaterialClass) -> GearConditions {
    GearConditions {
        material,
        contact_strength: None,
        bending_strength: None,
        yield_strength: None,
        tensile_strength: None,
        hardness: None,
        helix_slope_deviation: None,
        cycles: None,
        flank_roughness: None,
        root_roughness: None,
        rim_thickness: None,
        web_thickness: None,
        moment_of_inertia: None,
        factors: GearFactors::read(&record_of(GearFactors::MEMBER.fields, &[])),
    }
}

/// Case-hardened gears, and nothing else said.
fn bare() -> Conditions {
    let gear = made_of(MaterialClass::CaseHardenedSteel);
    Conditions {
        application_factor: 1.0,
        tolerance_class: None,
        base_pitch_deviation: None,
        profile_form_deviation: None,
        equivalent_misalignment: None,
        shaft: None,
        tip_relief: None,
        viscosity: None,
        pitting: Pitting::None,
        long_life_factor: 0.85,
        overhang: 1.0,
        least_contact_safety: 1.0,
        least_root_safety: 1.0,
        factors: PairFactors::read(&record_of(PairFactors::MEMBER.fields, &[])),
        pinion: gear.clone(),
        gear,
    }
}

/// The same with all factors of load stated as 1.
fn without_load_factors() -> Conditions {
    let one = Some(1.0);
    let factors = PairFactors {
        dynamic_factor: one,
        face_load_factor_contact: one,
        face_load_factor_root: one,
        transverse_load_factor_contact: one,
        transverse_load_factor_root: one,
        ..bare().factors
    };
    Conditions { factors, ..bare() }
}

/// A gear of the standard rack with a fillet of 0.38.
fn gear(teeth: u32, module: f64, profile_shift: f64, face_width: f64, bore_radius: f64) -> Specification {
    let rack = Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A };
    Specification { profile_shift, rack, face_width, bore_radius, ..standard(teeth, module, 2.0) }
}

fn pair(pinion: Specification, gear: Specification) -> GearPair {
    GearPair::new(pinion, gear, None).unwrap()
}

#[track_caller]
fn near(ours: f64, theirs: f64, within: f64) {
    assert!((ours - theirs).abs() <= within, "{ours} for {theirs}");
}
