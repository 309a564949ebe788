//! What no measurement of a flank of this gear can be: one message each.

use super::*;

#[track_caller]
fn refused(change: impl FnOnce(&mut Measured), message: &str) {
    let pair = pair();
    let mut stated = profile(&pair, Side::Pinion, 100, |roll| 4e-6 * libm::sin(9.0 * roll));
    change(&mut stated);
    let said = Design::default().add(Gears::Pinion, &stated, &pair).unwrap_err().message;
    assert!(said.contains(message), "{said}");
}

fn lengths(stated: &mut Measured) -> &mut Vec<f64> {
    stated.roll_lengths.as_mut().unwrap()
}

#[test]
fn what_is_no_trace_is_refused() {
    refused(|stated| lengths(stated).reverse(), "`roll_lengths` falls all along: the trace runs the other way");
    refused(|stated| lengths(stated).swap(3, 4), "point 5 of `roll_lengths` is not above the one before it");
    refused(
        |stated| {
            let places = lengths(stated);
            places[8] = places[7];
        },
        "point 9 of `roll_lengths` is the same as the one before it",
    );
    refused(
        |stated| {
            lengths(stated).drain(40..60);
            stated.deviations.drain(40..60);
        },
        "there is a gap between points 40 and 41 of `roll_lengths`, 21 times as wide as is usual among them",
    );
    refused(|stated| stated.deviations[30] += 60e-6, "deviation 31 stands ");
    refused(
        |stated| stated.deviations.iter_mut().for_each(|value| *value *= 1e-3),
        "no deviation is larger than 4.0e-3 um, and no measurement tells less than 0.05 um from nothing",
    );
    refused(
        |stated| stated.deviations[7] = 1.2e-3,
        "deviation 8 is 1.200000 mm, and a deviation is 0.5 mm at the most",
    );
    refused(|stated| stated.deviations[7] = f64::NAN, "`deviations` is NaN");
    refused(|stated| lengths(stated)[7] = f64::NAN, "`roll_lengths` is NaN");
    refused(
        |stated| stated.deviations.truncate(99),
        "there are 99 deviations for 100 `roll_lengths`; 100 are expected",
    );
    refused(
        |stated| stated.smoothing = Smoothing::Gaussian { cutoff: 0.25 },
        "the cutoff of 250.000000 mm is longer than the trace, which goes over ",
    );
    refused(|stated| stated.roll_lengths = None, "nothing says where the deviations were measured");
    refused(|stated| stated.diameters = Some(vec![60e-3, 61e-3]), "given twice, by `roll_lengths` and `diameters`");
    refused(|stated| *lengths(stated) = vec![1e-3], "`roll_lengths` has 1 point; 2 are the fewest of a trace");
    refused(
        |stated| {
            *lengths(stated) = places([2e-3, 15e-3], MOST_POINTS + 1);
            stated.deviations = vec![0.0; MOST_POINTS + 1];
        },
        "a trace of 10001 points; 10000 are the most",
    );
    refused(
        |stated| (stated.evaluation_start, stated.evaluation_end) = (Some(9e-3), Some(8e-3)),
        "the evaluation ends at 8.000000 mm and starts at 9.000000 mm",
    );
    refused(
        |stated| (stated.evaluation_start_diameter, stated.evaluation_end_diameter) = (Some(62e-3), Some(58e-3)),
        "the evaluation ends at 58.000000 mm and starts at 62.000000 mm",
    );
    refused(
        |stated| (stated.evaluation_end, stated.evaluation_end_diameter) = (Some(9e-3), Some(60e-3)),
        "`evaluation_end` and `evaluation_end_diameter` say the same limit of the evaluation",
    );
}

/// Tier: invariant; one number far beyond others that are in order marks a missing value; if most are beyond, the unit is another one.
#[test]
fn a_number_far_beyond_the_others_marks_a_missing_value() {
    let help = |change: &dyn Fn(&mut Measured)| {
        let pair = pair();
        let mut stated = profile(&pair, Side::Pinion, 100, |roll| 4e-6 * libm::sin(9.0 * roll));
        change(&mut stated);
        Design::default().add(Gears::Pinion, &stated, &pair).unwrap_err().help.unwrap_or_default()
    };
    for mark in [999e-6, -999e-6, 32767e-6, -32768e-6, 65535e-6, 0.999, 9.99e-3] {
        let said = help(&|stated| stated.deviations[7] = mark);
        assert!(
            said.contains("missing value") && said.contains("# missing: ") && !said.contains("unit"),
            "{mark}: {said}"
        );
    }
    let said = help(&|stated| stated.deviations.iter_mut().step_by(3).for_each(|value| *value = 999e-6));
    assert!(said.contains("missing value"), "{said}");
    let said = help(&|stated| stated.deviations.iter_mut().for_each(|value| *value = 1e-3 + 1e3 * *value));
    assert!(said.contains("is the unit `um`?") && !said.contains("missing"), "{said}");
    let said = help(&|stated| stated.deviations[40..50].fill(400e-6));
    assert!(said.contains("missing value"), "{said}");
}

/// A probe falls off the tip and lands on the root, touches dirt twice, or a few times: none hides another.
#[test]
fn spikes_are_found_wherever_and_however_many_they_are() {
    for (points, first) in [
        (&[0][..], "deviation 1 stands "),
        (&[99], "deviation 100 stands "),
        (&[1], "deviation 2 stands "),
        (&[50, 51], "out of those around it"),
        (&[30, 33], "out of those around it"),
        (&[10, 40, 41, 80], "out of those around it"),
        (&[60, 61, 62], "out of those around it"),
    ] {
        let change = |stated: &mut Measured| points.iter().for_each(|at| stated.deviations[*at] += 90e-6);
        refused(change, first);
    }
    refused(|stated| stated.deviations[99] -= 40e-6, "deviation 100 stands ");
    // A few points as well.
    let few = |stated: &mut Measured| {
        *lengths(stated) = places([2e-3, 16e-3], 9);
        stated.deviations = vec![0.0, 1e-6, 0.0, 2e-6, 60e-6, 1e-6, 0.0, 0.0, 1e-6];
    };
    refused(few, "deviation 5 stands ");
    refused(
        |stated| {
            *lengths(stated) = vec![2e-3, 2.1e-3, 2.2e-3, 2.3e-3, 16e-3];
            stated.deviations = vec![0.0; 5];
        },
        "there is a gap between points 4 and 5 of `roll_lengths`, 137 times as wide",
    );
}

/// Tier: invariant; the flank through points that are ever nearer each other stays within a tenth of what they deviate by, or is refused,
/// along the profile and across the face.
#[test]
fn a_flank_does_not_swing_beyond_its_points() {
    let pair = pair();
    let mut refusals = 0;
    for step in [1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7] {
        let mut stated = profile(&pair, Side::Pinion, 100, |roll| 4e-6 * libm::sin(9.0 * roll));
        let at = lengths(&mut stated)[40] + step;
        lengths(&mut stated).insert(41, at);
        let beside = stated.deviations[40];
        stated.deviations.insert(41, beside + 0.5e-6);
        let mut design = Design::default();
        if let Err(wrong) = design.add(Gears::Pinion, &stated, &pair) {
            assert!(wrong.message.contains("points 41 and 42 of `roll_lengths` are so near each other"), "{wrong}");
            refusals += 1;
            continue;
        }
        let flank = Flank::new(&pair, Side::Pinion);
        let ends = [stated.roll_lengths.as_ref().unwrap()[0], *stated.roll_lengths.as_ref().unwrap().last().unwrap()];
        let depths =
            places(ends, 20_000).into_iter().map(|length| design.depth(Side::Pinion, length / flank.base_radius));
        let most = depths.fold(0.0_f64, |most, depth| most.max(depth.abs()));
        assert!(most < 1.2 * 4.5e-6, "{step}: {most}");
    }
    assert!((2..7).contains(&refusals), "{refusals}");
    let face = |stated: &mut Measured| {
        stated.roll_lengths = None;
        stated.face_positions = Some(vec![-10e-3, -5e-3, -4.99e-3, 0.0, 5e-3, 10e-3]);
        stated.deviations = vec![0.0, 0.0, 2e-6, 2e-6, 2e-6, 2e-6];
    };
    refused(face, "points 2 and 3 of `face_positions` are so near each other");
}

#[test]
fn evaluations_beside_the_trace_are_refused() {
    refused(
        |stated| stated.evaluation_start = Some(30e-3),
        "`evaluation_start` is 30.000000 mm, and the trace goes from",
    );
    refused(|stated| stated.evaluation_end = Some(0.18), "`evaluation_end` is 180.000000 mm, and the trace goes from");
    refused(
        |stated| stated.evaluation_start = lengths(stated).last().copied(),
        "the evaluation leaves nothing of the trace",
    );
}

/// A trace of the other gear, of one with another module, or of another face is none of this one.
#[test]
fn traces_of_other_gears_are_refused() {
    let pair = pair();
    refused(
        |stated| *stated = profile(&pair, Side::Gear, 100, |_| 0.0),
        "the active flank of this gear goes from 2.009267 mm to 16.583582 mm, at least half of which must be measured",
    );
    refused(|stated| lengths(stated).iter_mut().for_each(|length| *length *= 1.5), "its tooth ends at 16.583582 mm");
    refused(|stated| stated.teeth = Some(20), "a gear of 20 teeth was measured, and this one has 19");
    refused(
        |stated| stated.module = Some(4e-3),
        "a gear of module 4.000000 mm was measured, and this one has 3.000000 mm",
    );
    refused(
        |stated| stated.deviations.iter_mut().for_each(|value| *value *= 100.0),
        "more than a tenth of the module, 3.000000 mm",
    );
    refused(
        |stated| (stated.roll_lengths, stated.diameters) = (None, Some(places([50e-3, 60e-3], 100))),
        "a trace from 50.000000 mm on, and the base circle of this gear is 53.562",
    );
    refused(
        |stated| {
            stated.roll_lengths = None;
            stated.face_positions = Some(places([0.0, 20e-3], 100));
        },
        "the face of this gear goes from -10.000000 mm to 10.000000 mm",
    );
}

/// A kink, a step between two points, noise, and reliefs of a few points are no spikes.
#[test]
fn what_a_flank_may_be_is_taken() {
    let pair = pair();
    for deviation in [
        |roll: f64| -300e-6 * (roll - 0.4).max(0.0),
        |roll: f64| if roll < 0.4 { 0.0 } else { -30e-6 },
        |roll: f64| 9e-6 * libm::sin(1e6 * roll),
    ] {
        let stated = profile(&pair, Side::Pinion, 300, deviation);
        Design::default().add(Gears::Pinion, &stated, &pair).unwrap();
    }
    let ends: [&[f64]; 9] = [
        &[-6.0, -24.0, -54.0, -96.0],
        &[-2.0, -8.0, -20.0, -49.0],
        &[-8.0, -30.0],
        &[-10.0, -45.0],
        &[-50.0, -50.0],
        &[-10.0, -20.0, -30.0],
        &[-2.5, -20.0],
        &[-1.0, -6.0, -16.0, -32.0, -52.0],
        &[-20.0, -20.0, -20.0, -20.0],
    ];
    for (end, count) in ends.iter().flat_map(|end| [13, 30, 100].map(|count| (end, count))) {
        let mut stated = profile(&pair, Side::Pinion, count, |_| 0.0);
        for (at, value) in end.iter().enumerate() {
            stated.deviations[count - end.len() + at] = 1e-6 * value;
        }
        for _ in 0..2 {
            Design::default()
                .add(Gears::Pinion, &stated, &pair)
                .unwrap_or_else(|wrong| panic!("{end:?} of {count}: {wrong}"));
            stated.deviations.reverse();
        }
    }
}

/// Tier: property; noise of any kind is none either, and a spike in it is found, beside a kink, a step and a relief too.
#[test]
fn spikes_are_found_in_noise_and_beside_kinks() {
    let pair = pair();
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let strategy =
        (0.2e-6..2e-6_f64, proptest::collection::vec(-1.0..1.0_f64, 60..400), 0..1000_usize, 0..4_usize, 1..=3_usize);
    runner
        .run(&strategy, |(noise, values, place, shape, width)| {
            let count = values.len();
            let mut stated = profile(&pair, Side::Pinion, count, |roll| match shape {
                0 => 0.0,
                1 => -300e-6 * (roll - 0.4).max(0.0),
                2 => {
                    if roll < 0.4 {
                        0.0
                    } else {
                        -20e-6
                    }
                }
                _ => -600e-6 * (roll - 0.45).max(0.0).powi(2),
            });
            let step = stated.deviations.windows(2).position(|ends| (ends[1] - ends[0]).abs() > 15e-6);
            stated.deviations.iter_mut().zip(&values).for_each(|(value, random)| *value += noise * random);
            prop_assert!(Design::default().add(Gears::Pinion, &stated, &pair).is_ok());
            // On the edge of a step it is hard to say.
            let is_free = |first: &usize| step.is_none_or(|step| *first > step + 4 || first + width + 3 < step);
            let mut places = (place..place + count).map(|place| 2 + place % (count - width - 4));
            let first = places.find(is_free).unwrap();
            stated.deviations[first..first + width].iter_mut().for_each(|value| *value += 60.0 * noise + 40e-6);
            let found = Design::default().add(Gears::Pinion, &stated, &pair);
            prop_assert!(found.is_err_and(|wrong| wrong.message.contains("a spike")));
            Ok(())
        })
        .unwrap();
}
