//! The worked example of a standard.

use super::*;

/// Tier: published; supplementary calculations A.6 of example 1 of ISO/TR 6336-30:2022, annex A, as tkuhn39/semesterthesis (GitHub,
/// worked example of `gearcore`, at 6ec7e2ae) transcribes the page: z 17/103, m_n 8 mm, α_n 20°, β 15.8°, a 500 mm, h_fP* 1.4, ρ_fP* 0.39,
/// W_k 38.196 mm over 2 and 307.943 mm over 13 teeth. It is helical: its transverse section is a spur pair, whose rack has another round of
/// the tip, under which its flank ends as deep.
#[test]
fn supplementary_calculations_of_the_example_of_the_standard() {
    let (normal, helix) = (20.0 * DEGREE, 15.8 * DEGREE);
    let transverse = (normal.tan() / helix.cos()).atan();
    let base_helix = (helix.tan() * transverse.cos()).atan();
    // Coefficients are of the normal module there, of the transverse one here.
    let share = helix.cos();
    let round = 0.39 * (1.0 - normal.sin()) / (1.0 - transverse.sin());
    let section = |teeth: u32, shift: f64, tip_mm: f64| Specification {
        teeth,
        module: 8e-3 / share,
        pressure_angle: transverse,
        profile_shift: shift * share,
        rack: Rack { addendum: share, dedendum: 1.4 * share, tip_radius: round * share, ..Rack::ISO_53_A },
        tip_radius: Some(0.5e-3 * tip_mm),
        face_width: 0.1,
        bore_radius: 30e-3,
        ..specification(teeth, 8.0, 0.0)
    };
    let nominal = [section(17, 0.145_22, 159.66), section(103, 0.0, 872.35)];
    let spans = [(2, 38.196e-3), (13, 307.943e-3)];
    let [pinion, gear] = [0, 1].map(|index| {
        let given: Specification = nominal[index];
        let (teeth, length) = spans[index];
        let shift = given.profile_shift_of_span(teeth, length / base_helix.cos());
        Specification { thickness_allowance: given.allowance_of(shift), ..given }
    });
    let pair = GearPair::new(pinion, gear, Some(0.5)).unwrap();
    let near = |found: f64, printed: f64, digits: i32| {
        assert!((found - printed).abs() <= 0.5001 * 10_f64.powi(-digits), "{found} for {printed}");
    };
    let printed = [
        (Side::Pinion, [141.340, 132.199, 0.117_79, 120.825, 132.248, 132.921]),
        (Side::Gear, [856.355, 800.968, -0.027_48, 833.515, 839.084, 845.225]),
    ];
    for (side, [reference, base, shift, root, form, usable]) in printed {
        let gear = pair.side(side);
        near(2e3 * gear.reference_radius, reference, 3);
        near(2e3 * gear.base_radius, base, 3);
        near(gear.specification.generating_profile_shift() / share, shift, 5);
        near(2e3 * gear.root_radius, root, 3);
        near(2e3 * gear.form_radius, form, 3);
        near(2e3 * gear.radius_at(pair.lowest_roll(side)), usable, 3);
    }
    near(pair.working_pressure_angle / DEGREE, 21.066, 3);
    near(1e3 * pair.base_pitch, 24.430, 3);
    near(1e3 * (pair.end_of_contact - pair.start_of_contact), 37.845, 3);
    near(pair.contact_ratio, 1.549_09, 5);
}
