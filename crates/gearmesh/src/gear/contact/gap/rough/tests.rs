//! What blocks of places have in common.

use super::line::Line;
use super::*;
use crate::gear::contact::gap::Gaps;
use crate::gear::fixtures::standard;
use crate::gear::geometry::Side;
use crate::gear::modification::flank::Flank;
use crate::gear::modification::measured::Measured;
use crate::gear::modification::{Design, Gears};
use crate::gear::random::Random;

/// Tier: invariant; a place is as high in every block, to what the ends of blocks are raised by, however steep the flanks are there and however far apart: no
/// lowest place is left to the block beside it by both.
#[test]
fn a_place_is_as_high_in_every_block() {
    let pair = GearPair::new(standard(30, 20e-3, 2.0), standard(115, 20e-3, 2.0), None).unwrap();
    let (mut random, mut design) = (Random::new(53), Design::default());
    for (gears, side) in [(Gears::Pinion, Side::Pinion), (Gears::Gear, Side::Gear)] {
        let flank = Flank::new(&pair, side);
        let lengths = [flank.root_roll, flank.tip_roll].map(|roll| roll * flank.base_radius);
        let place = |at: u32| lengths[0] + (lengths[1] - lengths[0]) * f64::from(at) / 399.0;
        let trace = Measured {
            deviations: (0..400).map(|_| random.between(-3e-6, 3e-6)).collect(),
            roll_lengths: Some((0..400).map(place).collect()),
            ..Measured::default()
        };
        design.add(gears, &trace, &pair).unwrap();
    }
    let profiles = design.profiles(0.0);
    let gaps = Gaps::new(&pair, &profiles);
    let rough = gaps.rough.as_ref().unwrap();
    let mut compared = 0;
    for place in 1..40 {
        let s = pair.start_of_contact + (pair.end_of_contact - pair.start_of_contact) * f64::from(place) / 40.0;
        let flanks = &rough.stretches[rough.part(s).stretch.unwrap()];
        let line = Line::new(&rough.pair, [s, pair.tangent_length - s]).unwrap();
        let scan = Scan::new(line, flanks, &rough.hulls);
        let ([lowest, highest], rounding) = (scan.known(), ROUNDING * single(pair.tangent_length));
        #[allow(clippy::cast_possible_truncation)] // numbers of places
        let nominal = scan.nominal as isize;
        for first in (nominal - 80).max(lowest)..(nominal + 50).min(highest - 9) {
            let [[values, _], [later, _]] = [first, first + 9].map(|first| scan.values(first));
            for (one, other) in values[9..].iter().zip(&later) {
                let is_same = one.total_cmp(other).is_eq();
                assert!(is_same || (one - other).abs() < rounding, "{first} at {s}: {one:e} {other:e}");
                compared += i32::from(!is_same);
            }
        }
    }
    assert!(compared > 20_000, "{compared}");
}
