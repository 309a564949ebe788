//! Chamfers and roundings of tips in contact: continuity, symmetry, and the gears that they amount to.

use super::corner::{assert_continuous, designs, exact};
use super::*;
use crate::gear::fixtures::standard;
use crate::gear::geometry::Specification;
use crate::gear::geometry::outline::tip::Tip;

const SPECIFICATIONS: fn() -> [Specification; 2] = || [standard(19, 3e-3, 2.0), standard(48, 3e-3, 2.0)];

const TIPS: [[Tip; 2]; 3] = [
    [Tip::Rounding(0.3e-3), Tip::Rounding(0.1e-3)],
    [Tip::Chamfer(0.2e-3), Tip::Rounding(0.2e-3)],
    [Tip::Rounding(1e-3), Tip::Land],
];

fn resolved(model: PairCompliance) -> PairCompliance {
    PairCompliance { contact: Some(ContactLaw::Resolved), ..model }
}

/// Tier: invariant; where a flank goes over into its rounding the flanks pass without a jump, under every law.
#[test]
fn the_curve_is_continuous() {
    for tips in TIPS {
        let pair = GearPair::with_tips(SPECIFICATIONS(), tips, None).unwrap();
        for compliance in [varying(), resolved(varying()), resolved(coupled())] {
            for design in designs(&pair) {
                assert_continuous(&exact(&pair, &compliance, 24), &design);
            }
        }
    }
}

/// Tier: invariant.
#[test]
fn loads_balance_and_peak_to_peak_does_not_depend_on_the_number_of_positions() {
    for tips in TIPS {
        let pair = GearPair::with_tips(SPECIFICATIONS(), tips, None).unwrap();
        let compliance = resolved(coupled());
        let cycles = [16, 64, 500].map(|positions| exact(&pair, &compliance, positions));
        for (design, torque) in designs(&pair).iter().flat_map(|design| [(design, 1.0), (design, 300.0)]) {
            let [coarse, middle, fine] = cycles.each_ref().map(|cycle| cycle.loaded(design, torque));
            for point in coarse.curve(Wanted::default()) {
                close(point.loads.iter().sum(), torque / pair.pinion.base_radius, 1e-12);
            }
            let fine = fine.peak_to_peak();
            for found in [coarse.peak_to_peak(), middle.peak_to_peak()] {
                assert!((found / fine - 1.0).abs() < 1e-8, "{tips:?} {torque}: {found:e} {fine:e}");
            }
        }
    }
}

/// Tier: second method; a chamfer ends the flank as a lower tip does: between the same teeth the same curve.
#[test]
fn a_chamfer_is_a_lower_tip() {
    let size = 0.25e-3;
    let lower = SPECIFICATIONS().map(|gear| Specification {
        tip_radius: Some(gear.module * (0.5 * f64::from(gear.teeth) + 1.0) - size),
        ..gear
    });
    let chamfered = GearPair::with_tips(SPECIFICATIONS(), [Tip::Chamfer(size); 2], None).unwrap();
    let shorter = GearPair::new(lower[0], lower[1], None).unwrap();
    for compliance in [varying(), resolved(coupled())] {
        for (one, two) in designs(&chamfered).iter().zip(&designs(&shorter)) {
            let [one, two] = [(&chamfered, one), (&shorter, two)]
                .map(|(pair, design)| exact(pair, &compliance, 24).loaded(design, 200.0).summary(Wanted::default()));
            close(one.mean, two.mean, 1e-11);
            close(one.peak_to_peak, two.peak_to_peak, 1e-10);
        }
    }
}

/// Tier: invariant; driving and driven gear may change places.
#[test]
fn swapping_the_gears_mirrors_the_curve() {
    for tips in TIPS {
        let pair = GearPair::with_tips(SPECIFICATIONS(), tips, None).unwrap();
        let compliance = resolved(coupled());
        let turned =
            PairCompliance { pinion: compliance.gear.clone(), gear: compliance.pinion.clone(), ..compliance.clone() };
        let [here, there] = [(&pair, &compliance, 50.0), (&swapped(&pair), &turned, 50.0 * 48.0 / 19.0)].map(
            |(pair, compliance, torque)| {
                exact(pair, compliance, 24).loaded(&Design::default(), torque).summary(Wanted::default())
            },
        );
        close(here.mean, there.mean, 1e-11);
        close(here.peak_to_peak, there.peak_to_peak, 1e-9);
    }
}

/// Tier: invariant; the larger the rounding, the nearer its arc to the mate: corners under load carry more of it.
#[test]
fn a_rounding_takes_more_load_beyond_the_end_of_its_flank() {
    let carried = [0.05e-3, 0.2e-3, 0.8e-3].map(|radius| {
        let pair = GearPair::with_tips(SPECIFICATIONS(), [Tip::Rounding(radius); 2], None).unwrap();
        let cycle = exact(&pair, &resolved(varying()), 64);
        let summary = cycle.loaded(&Design::default(), 300.0).summary(Wanted::default());
        summary.loaded_contact_ratio - pair.contact_ratio
    });
    assert!(carried.windows(2).all(|two| two[1] > two[0]) && carried[0] > 0.0, "{carried:?}");
}

/// Tier: invariant; a contact that is not narrow against the rounding or the chamfer that it reaches is in doubt, beside one that
/// is, and the more the smaller that is.
#[test]
fn contacts_wider_than_a_broken_tip_are_in_doubt() {
    let off = |tip: Tip| {
        let pair = GearPair::with_tips(SPECIFICATIONS(), [tip; 2], None).unwrap();
        let cycle = exact(&pair, &resolved(varying()), 24);
        let found = cycle.loaded(&Design::default(), 150.0).contact_law_error().unwrap();
        (found.size - found.by_shape) / found.approach
    };
    for of in [Tip::Chamfer, Tip::Rounding] {
        let [small, large] = [0.02e-3, 0.5e-3].map(|size| off(of(size)));
        assert!(small > 2e-3 && small > 2.0 * large, "{:?}: {small} {large}", of(1.0));
    }
    assert!((off(Tip::Chamfer(0.5e-3)) / off(Tip::Land) - 1.0).abs() < 0.2);
}
