//! Slices that hold each other: invariants, limits, a second method, convergence.

#![allow(clippy::float_cmp)] // where a result must be exact, that is what is asked

use super::*;
use crate::gear::compliance::{ContactLaw, PairCompliance};
use crate::gear::contact::{CornerContact, SliceCoupling};
use crate::gear::fixtures::{NamedModification, constant, coupled, design, pair, pair_with_contact_ratio, varying};
use crate::gear::geometry::GearPair;
use crate::gear::mesh::Settings;
use crate::gear::mesh::answers::curve::{self, Summary, Wanted};
use declare::record::Value::{Choice, Quantity};

const TORQUE: f64 = 50.0;

fn within_reach(pairs: impl Iterator<Item = (usize, f64, f64)>) -> CandidatePairs {
    let mut reach = CandidatePairs::none();
    pairs.for_each(|(spring, position, gap)| reach.push(spring, position, gap));
    reach.count_gaps_from_the_smallest();
    reach
}

fn settings(slices: usize) -> Settings {
    Settings { slices, slice_coupling: SliceCoupling::Plate, ..Settings::default() }
}

fn cycle(pair: &GearPair, compliance: &PairCompliance, slices: usize) -> Mesh {
    Mesh::new(pair, compliance, settings(slices)).unwrap()
}

fn independent(pair: &GearPair, compliance: &PairCompliance) -> Mesh {
    Mesh::new(pair, compliance, Settings::default()).unwrap()
}

fn models() -> Vec<PairCompliance> {
    [varying(), coupled()]
        .into_iter()
        .flat_map(|model| {
            [ContactLaw::Linear, ContactLaw::LoadDependent, ContactLaw::Resolved]
                .map(|contact| PairCompliance { contact: Some(contact), ..model.clone() })
        })
        .collect()
}

fn amount(value: f64) -> (&'static str, declare::record::Value) {
    ("amount", Quantity(value))
}

fn crowned(pair: &GearPair, crown: f64, slope: f64) -> Design {
    let tip = [amount(8e-6), ("length", Quantity(4e-3)), ("curve", Choice("parabolic"))];
    let mut parts: Vec<NamedModification> = vec![("tip_relief", "both", &tip)];
    let (crown, slope) = ([amount(crown)], [amount(slope)]);
    parts.push(("lead_crowning", "pinion", &crown));
    parts.push(("helix_slope", "gear", &slope));
    design(pair, &parts).unwrap()
}

/// Without cuts where the face begins to touch: coupled slices have none, and both are to be sampled alike.
fn summary(cycle: &Mesh, design: &Design, torque: f64) -> Summary {
    let wanted = Wanted { harmonics: 3, pressure: true, ..Wanted::default() };
    curve::summary(&cycle.loaded(design, torque).case.for_values(), wanted)
}

fn pressure(summary: &Summary) -> f64 {
    summary.largest_pressure.unwrap().extremum.value
}

#[track_caller]
fn close(value: f64, exact: f64, relative: f64) {
    assert!((value - exact).abs() <= relative * exact.abs(), "{value:e} is not {exact:e}");
}

/// A face that does not vary takes one slice, and so the same bits.
#[test]
fn a_flat_face_is_one_slice() {
    let pair = pair();
    for compliance in models() {
        let design = design(&pair, &[("tip_relief", "both", &[amount(6e-6), ("length", Quantity(4e-3))])]).unwrap();
        let (plate, none) = (cycle(&pair, &compliance, 17), independent(&pair, &compliance));
        assert!(plate.loaded(&design, TORQUE).case.slices().is_none());
        assert_eq!(summary(&plate, &design, TORQUE), summary(&none, &design, TORQUE));
    }
}

/// Tier: invariant. A load that spreads evenly gives what it gives without coupling: a crown of no height is cut into
/// slices all the same.
#[test]
fn an_even_load_is_that_of_independent_slices() {
    for (pair, torques) in [(pair(), [1e-6, 50.0]), (pair_with_contact_ratio(2.3), [50.0, 1e6])] {
        for compliance in models() {
            let design = crowned(&pair, 1e-300, 0.0);
            for torque in torques {
                let (plate, none) = (cycle(&pair, &compliance, 13), independent(&pair, &compliance));
                assert!(plate.loaded(&design, torque).case.slices().is_some());
                let (plate, none) = (summary(&plate, &design, torque), summary(&none, &design, torque));
                close(plate.peak_to_peak, none.peak_to_peak, 1e-9);
                close(plate.mean, none.mean, 1e-12);
                // 1e-6 N m deflects by 1e-13 m, of which the rounding of a relief of 8 µm is 1e-8.
                let rounding = if torque < 1e-3 { 1e-7 } else { 1e-8 };
                close(pressure(&plate), pressure(&none), rounding);
                close(plate.loaded_contact_ratio, none.loaded_contact_ratio, 1e-9);
            }
        }
    }
}

/// Tier: closed form. As lengths vanish slices become independent, for which the face has its integral.
#[test]
fn without_length_slices_are_independent() {
    let pair = pair();
    for contact in [ContactLaw::Linear, ContactLaw::LoadDependent] {
        let compliance = PairCompliance { contact: Some(contact), ..varying() };
        let none = independent(&pair, &compliance);
        let mut plate = cycle(&pair, &compliance, 12);
        plate.across = plate.across.map(|across| across.scaled(0.0));
        // Three points in a slice do for 17 on the whole face but for the slices whose edge is not loaded.
        let accuracy = if contact == ContactLaw::Linear { 1e-11 } else { 2e-4 };
        for (crown, slope) in [(6e-6, 0.0), (20e-6, 9e-6), (0.0, -30e-6)] {
            let design = crowned(&pair, crown, slope);
            for torque in [1.0, 50.0, 400.0] {
                let (a, b) = (summary(&plate, &design, torque), summary(&none, &design, torque));
                close(a.mean, b.mean, accuracy);
                assert!((a.peak_to_peak - b.peak_to_peak).abs() < 4.0 * accuracy * b.mean);
            }
        }
    }
}

/// The matrix is symmetric and positive definite, and its rows for an even load are the compliances of whole pairs.
#[test]
fn the_matrix_is_symmetric_and_positive_definite() {
    let pair = pair_with_contact_ratio(2.3);
    let compliance = coupled();
    let design = crowned(&pair, 5e-6, 3e-6);
    for factor in [0.0, 0.2, 1.0, 30.0] {
        let mut cycle = cycle(&pair, &compliance, 9);
        cycle.across = cycle.across.map(|across| across.scaled(factor));
        let loading = cycle.loaded(&design, TORQUE);
        let positions: Vec<f64> = (0..3).map(|pair| cycle.path_position(0.5e-3, pair)).collect();
        let (mut matrix, own) = loading.case.slices().unwrap().matrix(&cycle, &[0, 1, 2], &positions);
        let size = 27;
        for (slice, own) in own.into_iter().enumerate() {
            matrix[slice * (size + 1)] += own;
        }
        for row in 0..size {
            for column in 0..size {
                assert_eq!(matrix[row * size + column], matrix[column * size + row]);
            }
            for other in 0..3 {
                let even: f64 = matrix[row * size + 9 * other..][..9].iter().sum::<f64>() / 9.0;
                let own = row / 9;
                let exact = if own == other {
                    let (u, v) = cycle.path.rolls(positions[own]);
                    compliance.pinion.total(u) + compliance.gear.total(v)
                } else {
                    cycle.coupling(positions[own.min(other)], own.abs_diff(other))
                };
                close(even, exact, 1e-12);
            }
        }
        // Gauss: all pivots are positive, and none is lost in rounding.
        let (mut rest, mut minimum, mut maximum) = (matrix.clone(), f64::INFINITY, 0.0_f64);
        for pivot in 0..size {
            let value = rest[pivot * size + pivot];
            (minimum, maximum) = (minimum.min(value), maximum.max(value));
            for row in pivot + 1..size {
                let factor = rest[row * size + pivot] / value;
                for column in pivot..size {
                    rest[row * size + column] -= factor * rest[pivot * size + column];
                }
            }
        }
        assert!(minimum > 1e-9 * maximum, "{factor}: {minimum:e} of {maximum:e}");
    }
}

/// Loads are not negative and add up; loaded slices fulfil the equation they were solved from, the others stay open.
#[test]
fn loads_balance_and_slices_fulfil_complementarity() {
    let pair = pair_with_contact_ratio(2.3);
    for compliance in models() {
        for (crown, slope) in [(9e-6, 0.0), (20e-6, 30e-6)] {
            let design = crowned(&pair, crown, slope);
            let cycle = cycle(&pair, &compliance, 11);
            for torque in [1e-12, 1e-3, 50.0, 3000.0, 1e9] {
                let loading = cycle.loaded(&design, torque);
                for point in loading.curve(Wanted::default()) {
                    assert!(point.loads.iter().all(|load| *load >= 0.0));
                    close(point.loads.iter().sum(), loading.force(), 1e-12);
                }
                let sliced = loading.case.slices().unwrap();
                let (springs, gaps) = ([0, 1, 2], [0.0, 2e-6, 1e-6]);
                let positions = springs.map(|spring| cycle.path_position(1e-3, spring));
                let reach = within_reach((0..3).map(|pair| (springs[pair], positions[pair], gaps[pair])));
                let given = [loading.force(), 10.0 * torque / TORQUE * 1e-5 + 1e-5];
                let (found, smallest) = sliced.slices(&|spring| loading.case.flanks_of(spring), &reach, given);
                let (matrix, _) = sliced.matrix(&cycle, &springs, &positions);
                // The check of it finds nothing, and just the part of a load that is moved on purpose, with what the others
                // give way to it.
                let [value, scale] = sliced.unexplained(&|spring| loading.case.flanks_of(spring), &reach, given);
                assert!(value < 1e-12 * scale, "{value:e} {scale:e}");
                let loaded = (0..found.loads.len()).max_by(|a, b| found.loads[*a].total_cmp(&found.loads[*b])).unwrap();
                let mut moved = found.clone();
                moved.loads[loaded] *= 1.0 + 1e-3;
                let force = loading.force();
                let [value, _] =
                    sliced.unexplained_in(&|spring| loading.case.flanks_of(spring), &reach, force, &(moved, smallest));
                let by = 1e-3 * found.loads[loaded] / force;
                assert!(value > 0.9 * by && value < 3.0 * by, "{value:e} {by:e}");
                let (count, size) = (sliced.count(), 3 * sliced.count());
                assert_eq!(count, if slope == 0.0 { 6 } else { 11 }, "mirror images are one");
                for (slice, &load) in found.loads.iter().enumerate() {
                    let deflection: f64 = matrix[slice * size..][..size]
                        .iter()
                        .zip(&found.loads)
                        .map(|(influence, load)| influence * load)
                        .sum();
                    let gap = gaps[slice / count] + sliced.strips.lows[slice % count] - smallest;
                    let penetration = found.approach - gap - deflection;
                    let size = found.approach + gap + deflection;
                    assert!((penetration - found.penetration[slice]).abs() < 1e-12 * size);
                    assert!(load >= 0.0 && (load > 0.0) == (penetration > 1e-13 * size), "{load:e} {penetration:e}");
                }
            }
        }
    }
}

/// Tier: second method. One pair under a crown with the layers by cosine series, its loads by relaxation. In full contact
/// both are the same problem; else the last slices are loaded or not as a whole there.
#[test]
fn a_crowned_pair_agrees_with_cosines_and_relaxation() {
    crowned_pair(1e-6, [1e-8, 1e-8]);
    crowned_pair(12e-6, [6e-4, 2e-3]);
}

fn crowned_pair(crown: f64, accuracy: [f64; 2]) {
    let pair = pair_with_contact_ratio(1.0);
    let compliance = constant(&pair, 2.8e8);
    let slices = 60;
    let cycle = cycle(&pair, &compliance, slices);
    let design = design(&pair, &[("lead_crowning", "pinion", &[amount(crown)])]).unwrap();
    let loading = cycle.loaded(&design, TORQUE);
    let found = loading.state(0.4 * cycle.period(), 1);
    let across = cycle.across.as_ref().unwrap();
    let s = cycle.path_position(0.4 * cycle.period(), 0);
    let width = cycle.face_width / slices as f64;
    let orders = || (1..4000).map(f64::from);
    let place = |slice: usize| std::f64::consts::PI * (slice as f64 + 0.5) / slices as f64;
    let cosines: Vec<Vec<f64>> =
        (0..slices).map(|slice| orders().map(|n| libm::cos(n * place(slice))).collect()).collect();
    let weights = across.lengths.each_ref().map(|length| -> Vec<f64> {
        let length = length.value(s) * std::f64::consts::PI;
        let mean = |n: f64| {
            let half = 0.5 * n * std::f64::consts::PI / slices as f64;
            (libm::sin(half) / half).powi(2)
        };
        orders().map(|n| 2.0 * mean(n) / (1.0 + n * n * length * length)).collect()
    });
    let influence = |one: usize, two: usize| {
        let mut sum = across.wind_up;
        for (tooth, weights) in across.teeth.iter().zip(&weights) {
            let waves = cosines[one].iter().zip(&cosines[two]).zip(weights);
            sum += tooth.value(s) * (1.0 + waves.map(|((one, two), weight)| weight * one * two).sum::<f64>());
        }
        sum + if one == two { across.contact / width } else { 0.0 }
    };
    let matrix: Vec<Vec<f64>> = (0..slices).map(|one| (0..slices).map(|two| influence(one, two)).collect()).collect();
    // The mean deviation of each slice: (2z/b)² C (18/20)², the pinion being wider than the contact.
    let gap = |slice: usize| {
        let [a, b] = [0.0, 1.0].map(|end| 2.0 * (slice as f64 + end) / slices as f64 - 1.0);
        crown * 0.81 * (a * a + a * b + b * b) / 3.0
    };
    let total = |approach: f64| {
        let mut loads = vec![0.0_f64; slices];
        for _ in 0..400 {
            for slice in 0..slices {
                let others: f64 =
                    matrix[slice].iter().zip(&loads).map(|(influence, load)| influence * load).sum::<f64>()
                        - matrix[slice][slice] * loads[slice];
                loads[slice] = ((approach - gap(slice) - others) / matrix[slice][slice]).max(0.0);
            }
        }
        loads
    };
    let (mut low, mut high) = (0.0, 40e-6);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if total(middle).iter().sum::<f64>() < loading.force() { low = middle } else { high = middle }
    }
    close(found.transmission_error(), low, accuracy[0]);
    let peak = total(low).into_iter().fold(0.0, f64::max) / width;
    close(loading.line_load(0.4 * cycle.period(), &found, 0), peak, accuracy[1]);
}

/// A crowned or tilted face gives way less where slices hold each other; since a tooth then moves more as a whole, fewer
/// slices come to bear, and the highest one bears more.
#[test]
fn coupling_makes_a_crowned_face_stiffer() {
    let pair = pair();
    for compliance in models() {
        let (plate, none) = (cycle(&pair, &compliance, 25), independent(&pair, &compliance));
        for (crown, slope) in [(15e-6, 0.0), (0.0, 30e-6)] {
            let design = crowned(&pair, crown, slope);
            let stiffness = |cycle: &Mesh| {
                let points = cycle.loaded(&design, TORQUE).curve(Wanted::default());
                points.iter().map(|point| point.tangent_stiffness).collect::<Vec<_>>()
            };
            let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
            let [plate, none] = [&plate, &none].map(|cycle| (mean(stiffness(cycle)), summary(cycle, &design, TORQUE)));
            println!(
                "{crown:e} {slope:e}: stiffness {:.3}, mean {:.3}, peak-to-peak {:.3}, pressure {:.3}",
                plate.0 / none.0,
                plate.1.mean / none.1.mean,
                plate.1.peak_to_peak / none.1.peak_to_peak,
                pressure(&plate.1) / pressure(&none.1)
            );
            assert!(plate.1.mean < 0.95 * none.1.mean);
            assert!(pressure(&plate.1) > 1.02 * pressure(&none.1));
        }
    }
}

/// Between first and second order: a slice at whose edge the contact ends bends as a whole.
#[test]
fn results_converge_with_the_slices() {
    let pair = pair();
    for contact in [ContactLaw::Linear, ContactLaw::LoadDependent] {
        let compliance = PairCompliance { contact: Some(contact), ..coupled() };
        for (crown, slope) in [(6e-6, 0.0), (15e-6, 10e-6), (40e-6, 0.0)] {
            let design = crowned(&pair, crown, slope);
            let mean = |slices: usize| {
                let cycle = cycle(&pair, &compliance, slices);
                cycle.loaded(&design, TORQUE).summary(Wanted::default()).mean
            };
            let counts = [6, 12, 24, 48];
            let fine = mean(96);
            let errors = counts.map(|count| (mean(count) / fine - 1.0).abs());
            let order = libm::log2(errors[0] / errors[3]) / 3.0;
            println!("{contact:?} {crown:e} {slope:e}: {errors:?}, order {order:.2}");
            // Errors of the load-dependent law are small and of both signs.
            let minimum = if contact == ContactLaw::Linear { 1.4 } else { 1.1 };
            assert!(order > minimum && errors[3] < 5e-4, "{errors:?}");
        }
    }
}

#[test]
fn a_mirrored_lead_gives_the_mirrored_loads() {
    let pair = pair();
    for compliance in models() {
        let cycle = cycle(&pair, &compliance, 15);
        let designs = [9e-6, -9e-6].map(|slope| crowned(&pair, 7e-6, slope));
        let loadings = designs.each_ref().map(|design| cycle.loaded(design, TORQUE));
        let [one, other] = loadings.each_ref().map(|loading| {
            let sliced = loading.case.slices().unwrap();
            let pair = |spring: usize| (spring, cycle.path_position(1e-3, spring), 1e-6 * spring as f64);
            let reach = within_reach((0..2).map(pair));
            sliced.slices(&|spring| loading.case.flanks_of(spring), &reach, [loading.force(), 4e-5]).0
        });
        for pair in 0..2 {
            for slice in 0..15 {
                let mirrored = other.loads[15 * pair + 14 - slice];
                let error = (one.loads[15 * pair + slice] - mirrored).abs();
                assert!(error < 1e-12 * loadings[0].force(), "{error:e}");
            }
        }
        let heavier: f64 = one.loads[..7].iter().sum::<f64>() - one.loads[8..15].iter().sum::<f64>();
        assert!(heavier.abs() > 0.05 * loadings[0].force(), "a slope moves the load");
        close(one.approach, other.approach, 1e-12);
    }
}

/// Driving and driven gear may change places.
#[test]
fn swapping_the_gears_changes_nothing() {
    let pair = pair();
    let swapped = GearPair {
        pinion: pair.gear.clone(),
        gear: pair.pinion.clone(),
        start_of_contact: pair.tangent_length - pair.end_of_contact,
        end_of_contact: pair.tangent_length - pair.start_of_contact,
        ..pair.clone()
    };
    let of = |pair: &GearPair, one: &'static str, two: &'static str| {
        let tip = [amount(8e-6), ("length", Quantity(4e-3)), ("curve", Choice("parabolic"))];
        design(pair, &[("tip_relief", one, &tip), ("lead_crowning", two, &[amount(9e-6)])]).unwrap()
    };
    for compliance in models() {
        let mirrored =
            PairCompliance { pinion: compliance.gear.clone(), gear: compliance.pinion.clone(), ..compliance.clone() };
        let here = summary(&cycle(&pair, &compliance, 11), &of(&pair, "pinion", "gear"), TORQUE);
        let there = summary(&cycle(&swapped, &mirrored, 11), &of(&swapped, "gear", "pinion"), TORQUE * 48.0 / 19.0);
        close(here.mean, there.mean, 1e-9);
        close(here.peak_to_peak, there.peak_to_peak, 1e-7);
        close(pressure(&here), pressure(&there), 1e-7);
    }
}

/// Kinks of slices that come into contact at an edge are left, but small.
#[test]
fn peak_to_peak_hardly_depends_on_the_number_of_positions() {
    let pair = pair();
    for compliance in models() {
        for (crown, slope) in [(6e-6, 0.0), (20e-6, 20e-6)] {
            let design = crowned(&pair, crown, slope);
            let run = |positions: usize| {
                let settings = Settings { positions, ..settings(11) };
                let cycle = Mesh::new(&pair, &compliance, settings).unwrap();
                cycle.loaded(&design, TORQUE).peak_to_peak()
            };
            let (coarse, fine) = (run(64), run(400));
            println!("{:e}", (coarse / fine - 1.0).abs());
            close(coarse, fine, 1e-6);
        }
    }
}

#[test]
fn corner_contact_and_coupled_slices_go_together() {
    let pair = pair();
    for compliance in models() {
        let exact = |slice_coupling: SliceCoupling| {
            let corner_contact = CornerContact::Exact;
            let settings = Settings { corner_contact, slice_coupling, slices: 9, ..Settings::default() };
            Mesh::new(&pair, &compliance, settings).unwrap()
        };
        let (plate, none) = (exact(SliceCoupling::Plate), exact(SliceCoupling::None));
        let design = crowned(&pair, 1e-300, 0.0);
        close(summary(&plate, &design, TORQUE).mean, summary(&none, &design, TORQUE).mean, 1e-11);
        let design = crowned(&pair, 9e-6, 0.0);
        let loading = plate.loaded(&design, 400.0);
        for point in loading.curve(Wanted { harmonics: 0, pressure: true, ..Wanted::default() }) {
            close(point.loads.iter().sum(), loading.force(), 1e-12);
            assert!(point.pressed.unwrap().largest > 0.0);
        }
    }
}

#[test]
fn pairs_that_are_known_as_a_whole_only_are_refused() {
    let compliance = PairCompliance { contact: None, ..varying() };
    let message = Mesh::new(&pair(), &compliance, settings(5)).unwrap_err().to_string();
    assert!(message.contains("single teeth"), "{message}");
}
