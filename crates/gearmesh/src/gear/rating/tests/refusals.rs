//! What is missing, and where the standard ends.

use super::*;
use crate::gear::rating::rate;

fn message(conditions: &Conditions) -> String {
    let pair = pair(gear(19, 3e-3, 0.0, 20e-3, 15e-3), gear(48, 3e-3, 0.0, 20e-3, 30e-3));
    rate(&pair, 100.0, 150.0, conditions).unwrap_err().to_string()
}

#[test]
fn what_a_factor_lacks_is_named() {
    assert_eq!(
        message(&bare()),
        "K_V needs `base_pitch_deviation`: give it, or state the factor as `factors.dynamic_factor`"
    );
    let mut conditions = Conditions { base_pitch_deviation: Some(8e-6), ..bare() };
    assert!(message(&conditions).starts_with("K_V needs `profile_form_deviation`"));
    conditions.profile_form_deviation = Some(8e-6);
    assert!(message(&conditions).starts_with("K_V needs `tip_relief`"));
    conditions.tip_relief = Some(0.0);
    assert!(message(&conditions).starts_with("K_Hβ needs `equivalent_misalignment`"));
    // A soft gear runs in by its strength.
    conditions.gear = made_of(MaterialClass::ThroughHardenedSteel);
    assert!(message(&conditions).starts_with("K_V needs `gear.contact_strength`"));

    let mut conditions = without_load_factors();
    conditions.pinion.contact_strength = Some(1500e6);
    assert!(message(&conditions).contains("`pinion.flank_roughness`"));
    conditions.pinion.flank_roughness = Some(3e-6);
    assert!(message(&conditions).contains("`gear.contact_strength`"));
    conditions.gear.contact_strength = Some(1500e6);
    conditions.gear.flank_roughness = Some(3e-6);
    assert!(message(&conditions).contains("needs `viscosity`") && message(&conditions).contains("factors.lubricant"));
    conditions.viscosity = Some(100e-6);
    conditions.gear.material = MaterialClass::StructuralSteel;
    assert!(message(&conditions).starts_with("Z_W needs `gear.hardness`"));

    let mut conditions = without_load_factors();
    conditions.gear = GearConditions { bending_strength: Some(300e6), ..made_of(MaterialClass::GreyCastIron) };
    assert!(message(&conditions).starts_with("Y_δrelT needs `gear.tensile_strength`"));
    conditions.gear.tensile_strength = Some(250e6);
    assert!(message(&conditions).starts_with("Y_RrelT needs `gear.root_roughness`"));
    conditions.gear.root_roughness = Some(41e-6);
    assert!(message(&conditions).contains("R_z of its fillet is 41 µm, and may be 40"));
    conditions.gear.web_thickness = Some(5e-3);
    assert!(message(&conditions).starts_with("C_R needs `gear.rim_thickness`"));
    conditions.gear.rim_thickness = Some(90e-3);
    assert!(message(&conditions).contains("the rim of the gear is 90 mm thick"));
    conditions.gear.rim_thickness = Some(2e-3);
    assert!(
        message(&conditions).contains("no Y_B for the gear") && message(&conditions).contains("rim_thickness_factor")
    );
}

/// Stated factors need nothing: every one of them at once, of a rack that leaves no critical section for Y_S.
#[test]
fn what_is_stated_is_not_computed() {
    let sharp = |teeth| Specification {
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.02, ..Rack::ISO_53_A },
        ..gear(teeth, 3e-3, 0.0, 20e-3, 15e-3)
    };
    let sharp = pair(sharp(30), sharp(180));
    let one = Some(1.0);
    let mut conditions = without_load_factors();
    let refused = rate(&sharp, 100.0, 150.0, &conditions).unwrap_err().to_string();
    assert!(refused.contains("gives no Y_F and Y_S of the gear: the notch parameter"), "{refused}");
    conditions.factors = PairFactors {
        lubricant_factor: one,
        velocity_factor: one,
        roughness_factor: one,
        zone_factor: Some(2.5),
        elasticity_factor: Some(190.0),
        contact_ratio_factor: one,
        blank_factor: one,
        ..conditions.factors
    };
    for gear in [&mut conditions.pinion, &mut conditions.gear] {
        gear.contact_strength = Some(1000e6);
        gear.bending_strength = Some(400e6);
        gear.factors = GearFactors {
            single_contact_factor: one,
            form_factor: Some(1.5),
            stress_correction_factor: Some(2.0),
            notch_sensitivity_factor: one,
            surface_factor: one,
            size_factor_root: one,
            work_hardening_factor: one,
            ..gear.factors.clone()
        };
    }
    let found = rate(&sharp, 100.0, 150.0, &conditions).unwrap();
    // 100 N m on 45 mm: 2222 N on 20 mm; u = 6.
    let load: f64 = 100.0 / 45e-3;
    let contact = 2.5 * 190e3 * (load / (90e-3 * 20e-3) * 7.0 / 6.0).sqrt();
    near(found.pair.nominal_contact_stress / contact, 1.0, 1e-12);
    for gear in &found.gears {
        near(gear.contact_safety, 1000e6 / contact, 1e-9);
        near(gear.nominal_root_stress / (load / (20e-3 * 3e-3) * 3.0), 1.0, 1e-12);
        near(gear.root_safety, 800e6 / gear.root_stress, 1e-9);
        assert!(gear.section.is_none());
    }
}
