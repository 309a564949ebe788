//! What compliances must do where gears are larger, wider or stiffer; how many teeth they know, and how far formulas go.

use super::{Energy, GearBody, SUMMED, WeberBanaschek, energy, energy_on, extremes, pair, specifications};
use crate::gear::compliance::finite_element::FiniteElement;
use crate::gear::compliance::{Assumptions, Method, neighbours, sainsot};
use crate::gear::fixtures::pair_with_contact_ratio;
use crate::gear::geometry::{GearPair, Side, Specification};
use crate::gear::material::Material;

/// Tier: invariant; compliances of gears k times as large in every direction are 1/k as large.
#[test]
fn stiffness_scales_with_the_module() {
    let coupled = Assumptions { coupled: true, ..SUMMED };
    let small = pair(1.75);
    let base = extremes(&small, &energy(&small, coupled).unwrap());
    for factor in [1e-3, 0.1, 7.0, 1000.0] {
        let [pinion, gear] = specifications(3e-3 * factor, 1.75);
        let large = GearPair::new(pinion, gear, None).unwrap();
        let scaled = extremes(&large, &energy(&large, coupled).unwrap());
        for (one, many) in base.into_iter().zip(scaled) {
            assert!((many / (factor * one) - 1.0).abs() < 1e-11, "{many} for {factor} times {one}");
        }
    }
}

/// Tier: invariant; gears that are k times as wide, or of a material k times as stiff, give way 1/k as much under the same
/// force. Each part for itself, by every method that has a formula or a mesh of its own.
#[test]
fn compliance_is_inverse_to_width_and_modulus() {
    let mesh = FiniteElement { elements_across: 6, ..FiniteElement::default() };
    let methods: [&dyn Method; 4] = [&Energy::default(), &energy_on(GearBody::Ring), &WeberBanaschek {}, &mesh];
    for method in methods {
        let tables = |width: f64, modulus: f64| {
            let [pinion, gear] = specifications(3e-3, 1.75).map(|one| {
                let material = Material { youngs_modulus: modulus * one.material.youngs_modulus, ..one.material };
                Specification { face_width: width * one.face_width, material, ..one }
            });
            let pair = GearPair::new(pinion, gear, None).unwrap();
            let tabulated = method.tabulate(&pair, Assumptions { coupled: true, ..SUMMED }).unwrap();
            let sides = [(Side::Pinion, tabulated.compliance.pinion), (Side::Gear, tabulated.compliance.gear)];
            let parts = sides.map(|(side, tooth)| {
                let (low, high) = (pair.lowest_roll(side), pair.side(side).tip_roll());
                [0.0, 0.3, 1.0].map(|part| {
                    let roll = low + part * (high - low);
                    let own = [&tooth.bending, &tooth.shear, &tooth.axial, &tooth.body].map(|part| part.value(roll));
                    (own, tooth.neighbours[0].value(low, roll), tooth.contact_depth.value(roll))
                })
            });
            parts.concat()
        };
        let (base, factors) = (tables(1.0, 1.0), [(3.0, 1.0), (1.0, 0.2)]);
        for (width, modulus) in factors {
            for ((own, neighbour, depth), (own_0, neighbour_0, depth_0)) in tables(width, modulus).iter().zip(&base) {
                let near = |value: f64, exact: f64| (value - exact).abs() <= 1e-11 * exact.abs();
                let scaled = |value: &f64| value * width * modulus;
                assert!(own.iter().zip(own_0).all(|(value, exact)| near(scaled(value), *exact)), "{method:?} {own:?}");
                assert!(near(scaled(neighbour), *neighbour_0) && near(*depth, *depth_0), "{method:?} {neighbour}");
            }
        }
    }
}

/// As many neighbours on a side as pairs can be loaded with a tooth, one more for corner contact; no more than springs are
/// kept for, and than there are teeth.
#[test]
fn as_many_neighbours_are_known_as_can_be_loaded() {
    for (ratio, count) in [(1.0, 2), (1.6, 3), (2.0, 3), (2.3, 4), (9.0, 5)] {
        let mut pair = pair_with_contact_ratio(ratio);
        assert_eq!(neighbours(&pair, Side::Gear), count, "{ratio}");
        pair.gear.specification.teeth = 3;
        assert_eq!(neighbours(&pair, Side::Gear), 2, "{ratio}");
    }
}

/// Tier: published value; Sainsot, Velex and Duverger fitted 0.01 to 0.12 rad and 1.4 to 7.
#[test]
fn the_fitted_range_is_the_published_one() {
    let warned = |half_angle: f64, ratio: f64| sainsot::Body::new(half_angle, ratio).range_warning().is_some();
    let (inside, outside) = (1.0 + 1e-4, 1.0 - 1e-4);
    for (low, high) in [(0.01, 7.0), (0.01, 1.4 * inside * inside), (0.12 * outside * outside, 7.0)] {
        assert!(!warned(low * inside, high * outside), "{low} {high}");
    }
    assert!(warned(0.01 * outside, 3.0) && warned(0.12 * inside, 3.0));
    assert!(warned(0.05, 1.4 * outside) && warned(0.05, 7.0 * inside));
}
