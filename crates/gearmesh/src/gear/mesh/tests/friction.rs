//! Friction: closed forms of losses, energy, levers, the balance by hand, and what must not change.

use super::corner::exact;
use super::*;
use crate::gear::contact::SliceCoupling;
use crate::gear::fixtures::standard;
use crate::gear::friction::Law;
use crate::gear::friction::benedict_kelley::BenedictKelley;
use crate::gear::friction::constant::Constant;
use crate::gear::friction::iso_14179_2::Iso14179;
use crate::gear::friction::xu::Xu;
use crate::gear::geometry::{Side, Specification};
use crate::gear::mesh::answers::curve;
use crate::gear::mesh::cycle::flank_friction::{FlankFriction, Friction};
use crate::gear::mesh::cycle::mesh::Elasticity;

const SPEED: f64 = 157.0;
const CONSTANT: Constant = Constant { coefficient: 0.08 };
const XU: Xu = Xu { viscosity: 12e-3, roughness: 0.3e-6 };
const DISCS: BenedictKelley = BenedictKelley { viscosity: 12e-3 };

fn under(law: &dyn Law) -> Friction<'_> {
    Friction { law, speed: SPEED }
}

/// Tier: closed form; Ohlendorf's loss factor is that of halves of the load in double contact.
#[test]
fn equal_halves_lose_what_ohlendorf_has() {
    for ratio in [1.0001, 1.1, 1.35, 1.645_626_2, 1.85] {
        let pair = pair_with_contact_ratio(ratio);
        let cycle = cycle(&pair, &constant(&pair, STIFFNESS));
        let (design, torque) = (Design::default(), torque(1867.0));
        let loss = cycle.loaded(&design, torque).friction_loss(under(&CONSTANT));
        let factor = pair.tooth_loss_factor().unwrap();
        close(loss.tooth_loss_factor, factor, 1e-12);
        close(loss.mean_coefficient, 0.08, 1e-14);
        close(loss.power, torque * SPEED * 0.08 * factor, 1e-12);
        close(loss.efficiency, 1.0 - 0.08 * factor, 1e-13);
        close(loss.gear_torque, torque * 48.0 / 19.0 * loss.efficiency, 1e-12);
    }
    // Two pairs at the pitch point.
    assert_eq!(pair_with_contact_ratio(1.9).tooth_loss_factor(), None);
}

/// Tier: published, a program by others; the FZG gears C14 and C40 as GEARpie prints them (see `friction/tests.rs`). Its local
/// factor of C40 is that of load sharing by its own compliances, of C14 that of equal halves on a grid that leaves out an end.
#[test]
fn losses_of_fzg_gears_are_those_of_another_program() {
    let gear = |teeth: u32, profile_shift: f64, face_width: f64| {
        let module = 4.5e-3;
        Specification { profile_shift, face_width, ..standard(teeth, module, 2.0) }
    };
    let printed = |value: f64, exact: f64, unit: f64| assert!((value - exact).abs() <= 0.5 * unit, "{value} {exact}");
    for (width, turning, moment, viscosity, lubricant_factor, coefficient, power) in [
        (14e-3, 1500.0, 200.0, 13.28e-3, 0.846, 0.0449, 31_415.9),
        (40e-3, 1800.0, 215.513, 49.85e-3, 0.65, 0.0256, 40_623.2),
    ] {
        let pair = GearPair::new(gear(16, 0.1817, width), gear(24, 0.1715, width), None).unwrap();
        let cycle = cycle(&pair, &constant(&pair, STIFFNESS));
        let law = Iso14179 { viscosity, roughness: 0.355e-6, lubricant_factor };
        let speed = turning * std::f64::consts::PI / 30.0;
        let design = Design::default();
        let loss = cycle.loaded(&design, moment).friction_loss(Friction { law: &law, speed });
        printed(pair.centre_distance * 1e3, 91.5, 0.1);
        printed(pair.contact_ratio, 1.46, 0.01);
        printed(loss.mean_coefficient, coefficient, 1e-4);
        printed(pair.tooth_loss_factor().unwrap(), 0.1986, 1e-4);
        printed(loss.tooth_loss_factor, 0.1986, 1e-4);
        close(loss.power, power * 0.1986 * coefficient, 2e-3);
        assert!(loss.beyond.is_empty(), "{:?}", loss.beyond);
    }
}

fn models() -> Vec<(PairCompliance, SliceCoupling)> {
    let load_dependent = |model: PairCompliance| PairCompliance { contact: Some(ContactLaw::LoadDependent), ..model };
    vec![
        (varying(), SliceCoupling::None),
        (load_dependent(varying()), SliceCoupling::None),
        (coupled(), SliceCoupling::None),
        (load_dependent(coupled()), SliceCoupling::None),
        (varying(), SliceCoupling::Plate),
    ]
}

fn cycle_of(pair: &GearPair, compliance: &PairCompliance, slice_coupling: SliceCoupling) -> Mesh {
    let settings = Settings { positions: 16, slices: 5, slice_coupling, ..Settings::default() };
    Mesh::new(pair, compliance, settings).unwrap()
}

/// Tier: invariant; T1 ω1 − T2 ω2 = Σ μ F v_g, with the moments of all forces about both centres.
#[test]
fn energy_is_kept_at_every_position() {
    for ratio in [1.645_626_2, 2.3] {
        let pair = pair_with_contact_ratio(ratio);
        let base_radii = [pair.pinion.base_radius, pair.gear.base_radius];
        for (compliance, coupling) in models() {
            let cycle = cycle_of(&pair, &compliance, coupling);
            for design in [Design::default(), ga_design(&pair, 9e-6, 4e-3, 5e-6)] {
                for law in [&CONSTANT as &dyn Law, &XU, &DISCS] {
                    let torque = 150.0;
                    let loading = cycle.loaded(&design, torque).with_friction(under(law));
                    for share in [0.0, 0.13, 0.37, 0.52, 0.874, 0.99] {
                        let position = share * cycle.period();
                        let pairs = cycle.pairs_behind(position);
                        let rubbing = loading.rubbing(under(law), position, pairs);
                        let moment = |gear: usize| -> f64 {
                            rubbing.iter().map(|rubbing| rubbing.moments(base_radii)[gear]).sum()
                        };
                        close(moment(0), torque, 1e-13);
                        let power: f64 = rubbing.iter().map(FlankFriction::power).sum();
                        let other = SPEED * base_radii[0] / base_radii[1];
                        let lost = moment(0) * SPEED - moment(1) * other;
                        assert!((lost - power).abs() < 1e-13 * torque * SPEED, "{lost} {power}");
                        let [lost, left] = loading.friction_at(under(law), position, pairs);
                        close(lost, power, 1e-14);
                        close(left, moment(1), 1e-12);
                    }
                }
            }
        }
    }
}

/// Tier: closed form; two linear springs k_i(x − g_i) with Σ w_i k_i (x − g_i) = T1/r_b1 and w = 1 ± μ s/r_b1.
#[test]
fn two_springs_share_as_their_levers_say() {
    let pair = pair();
    let cycle = cycle(&pair, &varying());
    let design = relief(&pair, 4e-6, 0.9);
    let loading = cycle.loaded(&design, torque(2500.0));
    let resisted = loading.clone().with_friction(under(&CONSTANT));
    let Elasticity::Linear(stiffness) = &cycle.elasticity else { panic!("a linear law") };
    let mut double = 0;
    for step in 0..60 {
        let position = f64::from(step) / 60.0 * cycle.zones[0].end;
        let state = resisted.state(position, 2);
        let springs = [0, 1].map(|spring| {
            let s = cycle.path_position(position, spring);
            let sense = if s < pair.zone_points().c { -1.0 } else { 1.0 };
            (stiffness.value(s), loading.gap(s).unwrap(), 1.0 + sense * 0.08 * s / pair.pinion.base_radius)
        });
        if state.loaded_pairs() < 2 {
            continue;
        }
        double += 1;
        let [weighted, pulled] =
            springs.iter().fold([0.0; 2], |[weighted, pulled], (k, gap, w)| [weighted + w * k, pulled + w * k * gap]);
        let approach = (2500.0 + pulled) / weighted;
        close(state.transmission_error(), approach, 1e-12);
        for (spring, (k, gap, _)) in springs.iter().enumerate() {
            close(state.balance.loads[spring], k * (approach - gap), 1e-11);
        }
    }
    assert!(double > 30, "{double}");
}

/// Tier: limit; no friction is no friction, to the last bit at a position.
#[test]
fn a_coefficient_of_0_changes_nothing() {
    let pair = pair();
    let none = Constant { coefficient: 0.0 };
    for (compliance, coupling) in models() {
        let cycle = cycle_of(&pair, &compliance, coupling);
        for design in [Design::default(), ga_design(&pair, 9e-6, 4e-3, 5e-6)] {
            let loading = cycle.loaded(&design, 150.0);
            let resisted = loading.clone().with_friction(under(&none));
            for share in [0.01, 0.3, 0.8] {
                let position = share * cycle.period();
                let pairs = cycle.pairs_behind(position);
                assert_eq!(resisted.state(position, pairs), loading.state(position, pairs));
            }
            let [one, other] = [&loading, &resisted].map(|loading| loading.summary(Wanted::default()));
            close(other.peak_to_peak, one.peak_to_peak, 1e-9);
            close(other.mean, one.mean, 1e-6);
        }
    }
}

/// Tier: invariant; the gear driving, with what the pinion had left, is the same pair run backwards: friction is reversed.
#[test]
fn the_gear_driving_is_the_pair_run_backwards() {
    let (pair, reversed) = (pair(), Constant { coefficient: -0.08 });
    let other = swapped(&pair);
    let compliance = varying();
    let turned =
        PairCompliance { pinion: compliance.gear.clone(), gear: compliance.pinion.clone(), ..compliance.clone() };
    let [cycle, back] =
        [cycle_of(&pair, &compliance, SliceCoupling::None), cycle_of(&other, &turned, SliceCoupling::None)];
    let design = Design::default();
    let loading = cycle.loaded(&design, 150.0).with_friction(under(&reversed));
    let speed = SPEED * pair.pinion.base_radius / pair.gear.base_radius;
    let law = Friction { law: &CONSTANT, speed };
    for share in [0.05, 0.3, 0.6, 0.7, 0.9] {
        let position = share * cycle.period();
        let pairs = cycle.pairs_behind(position);
        let state = loading.state(position, pairs);
        // What the reversed friction gives the gear is what the gear has to put in.
        let [_, given] = loading.friction_at(under(&reversed), position, pairs);
        let driven = back.loaded(&design, given).with_friction(law);
        let last = cycle.path_position(position, pairs - 1);
        let mirrored = pair.end_of_contact - last;
        let mirror = driven.state(mirrored, pairs);
        close(mirror.transmission_error(), state.transmission_error(), 1e-12);
        for spring in 0..pairs {
            close(mirror.balance.loads[pairs - 1 - spring], state.balance.loads[spring], 1e-11);
        }
    }
}

/// Tier: second method; the jump at the pitch point, its two rows, no friction in it, and the mean by brute force.
#[test]
fn friction_changes_its_direction_at_the_pitch_point() {
    let pair = pair();
    let cycle = cycle(&pair, &varying());
    let design = Design::default();
    let loading = cycle.loaded(&design, 150.0).with_friction(under(&CONSTANT));
    let plain = cycle.loaded(&design, 150.0);
    let at = pair.zone_points().c - pair.start_of_contact;
    let error = |position: f64| loading.state(position, cycle.pairs_behind(position)).transmission_error();
    let none = plain.state(at, cycle.pairs_behind(at)).transmission_error();
    let [before, after] = [at - 1e-12, at + 1e-12].map(error);
    // One pair: the force is T1/r_b1 over 1 ± μ tan α_w.
    let lever = 0.08 * libm::tan(pair.working_pressure_angle);
    close(before, none / (1.0 - lever), 1e-9);
    close(after, none / (1.0 + lever), 1e-9);
    close(error(at), none, 1e-12);
    let (points, summary) = loading.curve_and_summary(Wanted::default());
    let rows: Vec<f64> = (points.iter().filter(|point| (point.cycle_position - at).abs() < 1e-15))
        .map(|point| point.transmission_error)
        .collect();
    assert_eq!(rows.len(), 2);
    close(rows[0], before, 1e-9);
    close(rows[1], after, 1e-9);
    let count = 40_000;
    let middle = |index: i32| error((f64::from(index) + 0.5) / f64::from(count) * cycle.period());
    let mean = (0..count).map(middle).sum::<f64>() / f64::from(count);
    close(summary.mean, mean, 1e-5);
    let (most, least) =
        (0..count).map(middle).fold((0.0_f64, f64::MAX), |(most, least), value| (most.max(value), least.min(value)));
    close(summary.peak_to_peak, most - least, 1e-3);
    assert!(summary.peak_to_peak >= most - least);
}

/// Tier: convergence; losses by local laws do not depend on the sampling, and are those of brute force.
#[test]
fn losses_of_local_laws_converge() {
    let pair = pair();
    let design = ga_design(&pair, 9e-6, 4e-3, 5e-6);
    let cycle = cycle(&pair, &varying());
    for (law, accuracy) in [(&XU as &dyn Law, 1e-7), (&DISCS, 1e-4), (&CONSTANT, 1e-9)] {
        for in_balance in [false, true] {
            let loading = cycle.loaded(&design, 150.0);
            let loading = if in_balance { loading.with_friction(under(law)) } else { loading };
            let of = |positions: usize| loading.with_positions(positions).friction_loss(under(law));
            let (coarse, fine) = (of(64), of(1024));
            close(coarse.power, fine.power, accuracy);
            close(coarse.tooth_loss_factor, fine.tooth_loss_factor, if in_balance { accuracy } else { 1e-9 });
            let count = 20_000;
            let power = |index: i32| {
                let position = (f64::from(index) + 0.5) / f64::from(count) * cycle.period();
                loading.friction_at(under(law), position, cycle.pairs_behind(position))[0]
            };
            close(fine.power, (0..count).map(power).sum::<f64>() / f64::from(count), 3e-5);
            assert!((0.001..0.2).contains(&fine.mean_coefficient), "{}", fine.mean_coefficient);
        }
    }
}

/// Tier: second method; a triangle of both centres and the corner, and the tangent to the other gear's base circle through it.
#[test]
fn levers_at_corners_are_those_of_the_point_that_touches() {
    let pair = pair();
    let cycle = exact(&pair, &varying(), 16);
    let distance = pair.centre_distance;
    let mut corners = 0;
    for (side, from, to) in [
        (Side::Gear, pair.start_of_contact - 1.5e-3, pair.start_of_contact),
        (Side::Pinion, pair.end_of_contact + 1.5e-3, pair.end_of_contact),
    ] {
        let (own, other) = (pair.side(side), pair.side(side.other()));
        for step in 0..8 {
            let s = from + (to - from) * f64::from(step) / 8.0;
            let levers = cycle.friction_levers(s);
            let flank = cycle.radii(s)[side.other() as usize];
            // The other gear's centre at the origin, its base tangent along x; the corner has yet to pass the line of centres.
            let near = libm::hypot(flank, other.base_radius);
            let (reach, tip) = (near * near + distance * distance, own.tip_radius);
            let between = libm::acos((reach - tip * tip) / (2.0 * near * distance));
            let centre = distance * libm::cos(libm::atan2(other.base_radius, flank) - between);
            close(levers[side.other() as usize], flank, 1e-15);
            close(levers[side as usize], centre - flank, 1e-9);
            corners += 1;
        }
    }
    assert_eq!(corners, 16);
    for share in [0.0, 0.4, 1.0] {
        let s = pair.start_of_contact + share * (pair.end_of_contact - pair.start_of_contact);
        let [pinion, gear] = cycle.friction_levers(s);
        close(pinion, s, 1e-14);
        close(gear, pair.tangent_length - s, 1e-14);
    }
}

#[test]
fn another_torque_is_as_if_it_had_been_the_first() {
    let pair = pair();
    let cycle = cycle(&pair, &varying());
    let design = ga_design(&pair, 9e-6, 4e-3, 5e-6);
    let law = Iso14179 { viscosity: 20e-3, roughness: 0.5e-6, lubricant_factor: 1.0 };
    let mut meshed = cycle.design(&design);
    let [_, one] = [150.0, 90.0].map(|torque| meshed.under(torque).with_friction(under(&law)));
    let other = cycle.loaded(&design, 90.0).with_friction(under(&law));
    assert_eq!(one.peak_to_peak(), other.peak_to_peak());
    assert_eq!(one.friction_loss(under(&law)), other.friction_loss(under(&law)));
    assert!(one.friction_loss(under(&law)).beyond.iter().all(|limit| limit.quantity.contains("F_bt/b")));
    // Nothing is transmitted, nothing rubs.
    assert_eq!(curve::peak_to_peak(&one.case.without_load()), cycle.loaded(&design, 0.0).peak_to_peak());
    assert!(cycle.loaded(&design, 0.0).with_friction(under(&law)).friction_loss(under(&law)).efficiency.is_nan());
}

#[test]
fn places_on_the_path_are_those_of_the_cycle() {
    let pair = pair();
    let cycle = cycle(&pair, &varying());
    let design = Design::default();
    let loading = cycle.loaded(&design, 150.0);
    let places = loading.friction_along(under(&XU), 20);
    let steps: Vec<isize> = places.iter().map(|place| place.step).collect();
    let last = steps.len().cast_signed();
    assert_eq!(steps, (0..last).collect::<Vec<_>>());
    for place in &places {
        close(place.path_position, place.step as f64 * cycle.period() / 20.0, 1e-12);
        let s = pair.start_of_contact + place.path_position;
        let factor = pair.sliding_factor(s) * SPEED * pair.working_radius(Side::Pinion);
        assert!((place.rubbing.rolling.sliding() - factor).abs() < 1e-12);
        assert_eq!(place.rubbing.force(), place.rubbing.coefficient * place.rubbing.load);
    }
    // Pairs a pitch apart carry the load together.
    let load = |step: usize| places.get(step).map_or(0.0, |place| place.rubbing.load);
    (0..20).for_each(|step| close(load(step) + load(step + 20), 150.0 / pair.pinion.base_radius, 1e-12));
}
