//! Crests of piecewise flanks, the ends of traces among them, against a dense scan of turned involutes.

use super::*;
use crate::gear::fixtures::standard;
use crate::gear::modification::Gears;
use crate::gear::modification::measured::Measured;
use crate::gear::random::Random;

/// The pair 59/85, module 2 mm.
fn fine_pair() -> GearPair {
    GearPair::new(standard(59, 2e-3, 2.0), standard(85, 2e-3, 2.0), None).unwrap()
}

#[test]
fn diagnose() {
    let pair = fine_pair();
    let lengths = [14.873, 16.181, 17.488, 18.796, 20.103, 21.411, 22.718, 24.026, 25.333];
    let deviations = [-0.68, -2.347, 1.133, 0.3205, 1.292, -0.7559, 2.321, -1.724, -1.167];
    let mut design = Design::default();
    let trace = Measured {
        deviations: deviations.map(|d| d * 1e-6).to_vec(),
        roll_lengths: Some(lengths.map(|l| l * 1e-3).to_vec()),
        ..Measured::default()
    };
    design.add(Gears::Pinion, &trace, &pair).unwrap();
    let profiles = design.profiles(0.0);
    let gaps = Gaps::new(&pair, &profiles);
    println!("{} {} convex {} rough {}", pair.start_of_contact, pair.end_of_contact, gaps.is_convex, gaps.rough.is_some());
    for step in 0..60 {
        let s = pair.start_of_contact + (pair.end_of_contact - pair.start_of_contact) * (f64::from(step) + 0.5) / 60.0;
        let exact = least(&opposite(&pair, s, |_, _| 0.0), &design);
        let found = gaps.at(s).unwrap();
        println!("{s:.6} found {found:.5e} exact {exact:.5e} off {:.2e}", found - exact);
    }
    let _ = Random::new(1);
}
