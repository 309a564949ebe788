//! The wedge against closed forms, against pressures found in another way, and against itself at its joints.

use super::*;

#[test]
fn explore() {
    let start = std::time::Instant::now();
    let wedge = Wedge::new(0.286);
    println!("{:?}", start.elapsed());
    for place in [10.0, 5.0, 3.0, 1.5, 1.2, 1.05, 1.0, 0.9, 0.5, 0.0, -0.5, -1.0, -3.0, -10.0, -30.0, -40.0] {
        println!("{place} {:?}", wedge.more(place));
    }
}
