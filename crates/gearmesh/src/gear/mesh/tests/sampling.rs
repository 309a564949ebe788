//! The estimate of the sampling's error, on numbers whose error is known: 1 + c (16/n)^p in the positions, and the like in
//! the slices.

use crate::gear::contact::{CornerContact, MOST_COUPLED_SLICES, SliceCoupling};
use crate::gear::mesh::Settings;
use crate::gear::mesh::answers::sampling::{Against, Sampled};
use std::cell::RefCell;

/// Load begins at an edge as the 3/2 power of the way in.
const EDGE: f64 = 1.5;
const SIZE: f64 = 1e-3;

fn settings(positions: usize, slices: usize, slice_coupling: SliceCoupling) -> Settings {
    Settings { positions, slices, corner_contact: CornerContact::None, slice_coupling }
}

/// Error of the number for this many positions, and for this many slices.
fn by_positions(settings: Settings) -> f64 {
    SIZE * (16.0 / settings.positions as f64).powf(EDGE)
}

fn by_slices(settings: Settings) -> f64 {
    SIZE * (16.0 / (settings.slices - 1) as f64).powf(EDGE)
}

/// What half of the distance between the last two slices may hide, for it is of second order there: Lobatto's first node is
/// 2 / (s (s − 1)) of the stretch from its end (its integral is exact up to the degree 2 s − 3), equal slices are 1/s wide.
fn unseen(settings: Settings) -> f64 {
    let slices = settings.slices as f64;
    let half =
        if settings.slice_coupling == SliceCoupling::None { 2.0 / (slices * (slices - 1.0)) } else { 0.5 / slices };
    half.powi(2)
}

/// Tier: closed form. The estimate is never below the error, and at most this many times it, whatever it is compared with.
#[test]
fn an_error_of_known_order_is_neither_missed_nor_drowned() {
    for against in [Against::Coarser, Against::Finer] {
        for positions in [4, 8, 15, 16, 17, 24, 32, 64, 1000, 4096] {
            let at = settings(positions, 17, SliceCoupling::None);
            let estimate = Sampled::new(false, against, |at| 1.0 + by_positions(at)).error(at);
            let ratio = estimate / by_positions(at);
            assert!((1.0..5.0).contains(&ratio), "{against:?}, {positions} positions: {ratio}");
        }
        for coupling in [SliceCoupling::None, SliceCoupling::Plate] {
            for slices in [4, 5, 8, 9, 10, 16, 17, 18, 33, 49, 50, 51, 65, 200] {
                let at = settings(16, slices, coupling);
                let estimate = Sampled::new(true, against, |at| 1.0 + by_slices(at)).error(at) - unseen(at);
                let ratio = estimate / by_slices(at);
                // Coarser samplings alone show their own error, which is larger.
                let maximum = if coupling == SliceCoupling::Plate && slices > 16 { 6.8 } else { 5.2 };
                assert!((1.0..maximum).contains(&ratio), "{against:?}, {coupling:?}, {slices} slices: {ratio}");
            }
        }
    }
}

/// Tier: invariant. What one pair of samplings has in common by chance, the others tell: an error that is gone in the first
/// or the second of them still shows.
#[test]
fn samplings_that_agree_by_chance_hide_no_error() {
    for (slices, against) in [(5, Against::Coarser), (17, Against::Coarser), (5, Against::Finer), (17, Against::Finer)]
    {
        for coupling in [SliceCoupling::None, SliceCoupling::Plate] {
            let at = settings(16, slices, coupling);
            for lucky in [slices.div_ceil(2), slices.div_ceil(4), slices.div_ceil(8), 2 * slices - 1, 4 * slices - 3] {
                let number = |other: Settings| 1.0 + by_slices(if other.slices == lucky { at } else { other });
                let estimate = Sampled::new(true, against, number).error(at);
                assert!(estimate >= by_slices(at), "{against:?}, {coupling:?}, {slices} slices, {lucky}: {estimate}");
            }
        }
    }
}

/// Tier: invariant. The coarsest sampling for an accuracy has an estimate below it, and one with half as many of either not;
/// where no sampling meets it, it is the finest.
#[test]
fn the_coarsest_sampling_is_the_coarsest() {
    for coupling in [SliceCoupling::None, SliceCoupling::Plate] {
        for sliced in [false, true] {
            let number = |at| 1.0 + by_positions(at) + if sliced { by_slices(at) } else { 0.0 };
            let estimate = |at| Sampled::new(sliced, Against::Coarser, number).error(at);
            let base = settings(64, 33, coupling);
            for accuracy in [0.2, 3e-2, 1e-2, 4e-3, 2e-3] {
                let found = Sampled::new(sliced, Against::Coarser, number).coarsest(base, accuracy);
                assert!(estimate(found) <= accuracy, "{found:?} for {accuracy}");
                assert!(
                    found.positions == 16 || 2.0 * 4.2 * by_positions(found) > accuracy / 4.0,
                    "{found:?} for {accuracy}"
                );
                if sliced {
                    let half = Settings { slices: found.slices.div_ceil(2), ..found };
                    assert!(found.slices == 9 || 5.2 * by_slices(half) + unseen(half) > accuracy / 2.0, "{found:?}");
                } else {
                    assert_eq!(found.slices, base.slices);
                    let half = Settings { positions: found.positions / 2, ..found };
                    assert!(found.positions == 16 || estimate(half) > accuracy, "{found:?} for {accuracy}");
                }
            }
            let finest = Sampled::new(sliced, Against::Coarser, number).coarsest(base, 0.0);
            assert_eq!(finest.positions, 4096);
            let slices = match (sliced, coupling) {
                (false, _) => base.slices,
                (true, SliceCoupling::None) => 1025,
                (true, SliceCoupling::Plate) => 129,
            };
            assert_eq!(finest.slices, slices);
            assert!(slices <= MOST_COUPLED_SLICES || coupling == SliceCoupling::None);
        }
    }
}

/// Tier: invariant. Each sampling is computed once, what is known not at all, and slices that hold each other are not compared
/// with samplings that would cost eight times as much, or that are too many. (positions, slices) in order.
#[test]
fn nothing_is_computed_twice_or_for_nothing() {
    let made = |against, coupling, slices, known: bool| {
        let asked = RefCell::new(Vec::new());
        let at = settings(64, slices, coupling);
        let mut sampled = Sampled::new(true, against, |at: Settings| {
            asked.borrow_mut().push((at.positions, at.slices));
            1.0 + by_slices(at)
        });
        if known {
            sampled.know(at, 1.0 + by_slices(at));
        }
        let first = sampled.error(at);
        assert_eq!(sampled.error(at).to_bits(), first.to_bits());
        drop(sampled);
        let mut asked = asked.into_inner();
        asked.sort_unstable();
        asked
    };
    let (none, plate) = (SliceCoupling::None, SliceCoupling::Plate);
    assert_eq!(made(Against::Coarser, none, 33, true), [(16, 5), (16, 9), (16, 17), (16, 33), (16, 65), (32, 33)]);
    assert_eq!(made(Against::Coarser, plate, 33, true), [(16, 5), (16, 9), (16, 17), (16, 33), (32, 33)]);
    assert_eq!(made(Against::Coarser, plate, 33, false), [(16, 5), (16, 9), (16, 17), (16, 33), (32, 33), (64, 33)]);
    assert_eq!(made(Against::Coarser, plate, 9, true), [(16, 3), (16, 5), (16, 9), (16, 17), (32, 9)]);
    assert_eq!(made(Against::Coarser, none, 8, true), [(16, 8), (16, 15), (16, 29), (32, 8)]);
    assert_eq!(made(Against::Coarser, none, 2, true), [(16, 2), (16, 3), (16, 9), (32, 2)]);
    assert_eq!(made(Against::Finer, none, 17, true), [(16, 17), (16, 33), (16, 65), (256, 17)]);
    assert_eq!(made(Against::Finer, none, 257, true), [(16, 257), (16, 513), (16, 1025), (256, 257)]);
    // 4 · 50 − 3 = 197 are few enough, 201 not.
    assert_eq!(made(Against::Finer, plate, 50, true), [(16, 50), (16, 99), (16, 197), (256, 50)]);
    assert_eq!(made(Against::Finer, plate, 51, true), [(16, 7), (16, 13), (16, 26), (16, 51), (256, 51)]);
}

/// Tier: invariant. Numbers that are equal have no error but rounding, those that have nothing in common one of 1.
#[test]
fn an_estimate_is_between_rounding_and_one() {
    let at = settings(16, 17, SliceCoupling::None);
    let mut equal = Sampled::new(true, Against::Coarser, |_| 0.0);
    let rounding = equal.error(at) - unseen(at);
    assert!((1e-12..1e-9).contains(&rounding), "{rounding}");
    let mut count = 0.0;
    let mut wild = Sampled::new(false, Against::Coarser, |_| {
        count += 1.0;
        1e3_f64.powf(count)
    });
    assert_eq!(wild.error(at).to_bits(), 1.0_f64.to_bits());
}
