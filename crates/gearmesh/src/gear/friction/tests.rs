//! Laws of friction against other people's programs, other units, and what they must tend to.

#![allow(clippy::float_cmp)] // where a result must be exact, that is what is asked

use super::benedict_kelley::BenedictKelley;
use super::constant::Constant;
use super::iso_14179_2::Iso14179;
use super::xu::Xu;
use super::*;

fn rolling(speeds: [f64; 2], pressure: f64, radius: f64, line_load: f64) -> Rolling {
    Rolling { line_load, pressure, radius, speeds }
}

#[track_caller]
fn close(value: f64, exact: f64, relative: f64) {
    assert!((value - exact).abs() <= relative * exact.abs(), "{value:e} is not {exact:e}");
}

/// Tier: published, a program by others; GEARpie (C. M. C. G. Fernandes, MIT licence, commit cb30c911) prints these for FZG gears
/// C14 and C40 with a mineral oil and a polyalphaolefin. v_ΣC and ρ_redC are those of its geometry.
#[test]
fn the_mean_coefficient_is_that_of_another_program() {
    let of = |viscosity: f64, lubricant_factor: f64, line_load: f64, sum: f64| {
        let law = Iso14179 { viscosity, roughness: 0.355e-6, lubricant_factor };
        law.coefficient(&rolling([0.5 * sum; 2], 0.0, 8.382_099e-3, line_load))
    };
    let printed = |value: f64, exact: f64| assert!((value - exact).abs() <= 0.5e-4, "{value} for {exact}");
    printed(of(13.28e-3, 0.846, 5912.1 / 14e-3, 4.388_857), 0.0449);
    printed(of(49.85e-3, 0.65, 6370.7 / 40e-3, 1.2 * 4.388_857), 0.0256);
}

/// Tier: a program by others; the expression of `mesh_Kahraman.m`, an open script, with the same numbers.
#[test]
fn the_regression_is_that_of_another_program() {
    for (speeds, pressure, viscosity, radius, roughness, exact) in [
        ([12.5, 7.5], 1.0e9, 10e-3, 0.02, 0.2e-6, 0.013_335_592_626_377_62),
        ([3.0, 5.0], 0.6e9, 25e-3, 0.008, 0.4e-6, 0.034_548_979_684_429_1),
        ([20.0, 10.0], 1.6e9, 6.5e-3, 0.04, 0.1e-6, 0.007_476_865_981_490_842),
    ] {
        let law = Xu { viscosity, roughness };
        close(law.coefficient(&rolling(speeds, pressure, radius, 1e5)), exact, 1e-12);
        // Whichever flank is the faster one.
        let [pinion, gear] = speeds;
        close(law.coefficient(&rolling([gear, pinion], pressure, radius, 1e5)), exact, 1e-15);
    }
}

/// Tier: second method; the constant of the source with its units, 3.17e8 with lb/in, cP and in/s.
#[test]
fn benedict_and_kelley_is_the_same_in_the_units_of_its_source() {
    let (inch, pound) = (0.0254, 0.453_592_37 * 9.806_65);
    for (speeds, load, viscosity) in [([4.75, 3.25], 250e3, 40e-3), ([1.0, 2.2], 600e3, 8e-3)] {
        let rolling = rolling(speeds, 1e9, 8e-3, load);
        let [sliding, sum] = [rolling.sliding().abs(), rolling.sum()].map(|speed| speed / inch);
        let argument = 3.17e8 * (load * inch / pound) / (viscosity * 1e3 * sliding * sum * sum);
        // 3.17e8 has three digits.
        close(BenedictKelley { viscosity }.coefficient(&rolling), 0.0127 * libm::log10(argument), 1e-4);
    }
    let fast = rolling([400.0, 100.0], 1e9, 8e-3, 1e3);
    let law = BenedictKelley { viscosity: 0.1 };
    assert!(law.coefficient(&fast) == 0.0 && law.limits(&fast)[0].value < 1.0);
}

#[test]
fn where_nothing_slides_local_laws_tend_to_what_they_say() {
    let nearly = |difference: f64| rolling([5.0 + difference, 5.0], 1e9, 8e-3, 250e3);
    let xu = Xu { viscosity: 10e-3, roughness: 0.3e-6 };
    assert!(xu.coefficient(&nearly(0.0)) == 0.0 && xu.coefficient(&nearly(1e-6)) < 1e-6);
    let discs = BenedictKelley { viscosity: 10e-3 };
    // A decade of sliding is worth 0.0127.
    let difference = discs.coefficient(&nearly(1e-4)) - discs.coefficient(&nearly(1e-3));
    close(difference, 0.0127, 1e-3);
    let same = Constant { coefficient: 0.06 };
    assert!(same.coefficient(&nearly(0.0)) == 0.06 && same.is_mean() && !xu.is_mean());
}

#[test]
fn laws_know_their_limits() {
    let law = Iso14179 { viscosity: 40e-3, roughness: 0.5e-6, lubricant_factor: 1.0 };
    let out = |rolling: &Rolling| -> Vec<&str> {
        let is_out = |limit: &&Limit| limit.value < limit.range[0] || limit.value > limit.range[1];
        law.limits(rolling).iter().filter(is_out).map(|limit| limit.quantity).collect()
    };
    assert!(out(&rolling([2.0; 2], 1e9, 8e-3, 151e3)).is_empty());
    assert_eq!(out(&rolling([2.0; 2], 1e9, 8e-3, 149e3)), ["the load per width F_bt/b"]);
    assert_eq!(out(&rolling([18.0; 2], 1e9, 8e-3, 151e3)), ["the sum speed v_ΣC"]);
}
