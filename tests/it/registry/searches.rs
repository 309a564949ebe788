//! Searches for tip relief, whose peak-to-peak has kinks.

use super::walk::{load, walk};

const STAGES: &str = "
study: t
seed: 1
stages:
  pair:
    kind: geometry
    module: 3 mm
    pressure_angle: 20 deg
    rack: { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38 }
    material: { youngs_modulus: 206 GPa, poisson_ratio: 0.3 }
    pinion: { teeth: 19, face_width: 20 mm, bore_radius: 14.079 mm }
    gear: { teeth: 48, face_width: 18 mm, bore_radius: 38.823 mm }
  k: { kind: stiffness, pair: pair, root: circular_fillet, coupling: none }
  centre: &search
    kind: optimizer
    stiffness: k
    method: powell
    search: plain
    at: { torque: 100 N m }
    design:
      - tip_relief: { gear: both, amount: [0 um, 30 um], length: [0.5 mm, 6 mm] }
  anywhere: { <<: *search, method: { powell: { start: random } } }
  simplex: { <<: *search, method: nelder_mead }
  global: { <<: *search, method: { differential_evolution: { polish: nelder_mead } } }
  alone: { <<: *search, method: { powell: { restarts: 0 } } }
  short: { <<: *search, method: { powell: { evaluations: 40 } } }
  # A relief longer than the active flank of 14.57 mm is refused.
  edge: &edge
    <<: *search
    at: { torque: 500 N m }
    design: [tip_relief: { gear: both, amount: [1 um, 600 um], length: [8 mm, 20 mm] }]
  edge_by_simplex: { <<: *edge, method: nelder_mead }
  edge_in_stages: { <<: *edge, search: staged }
";

/// Tier: second method. From the middle of the box lines along the axes stop on a kink, at twice the least value.
#[test]
fn a_kink_of_the_peak_to_peak_does_not_stop_a_local_search() {
    let ran = walk(&load(STAGES));
    let best = |stage: &str| {
        let table = ran[stage].tables.iter().find(|table| table.name() == "best").unwrap();
        (table.floats("objective")[0], table.texts("ended")[0].clone())
    };
    let minimum = best("global").0;
    for stage in ["centre", "anywhere", "simplex"] {
        // Where a search ends on a kink hangs on the last digits: of 40 torques 1e-15 apart, Powell's ends 1e-6 to 9e-6 above in
        // seven or eight, whichever way gaps are rounded.
        assert!((best(stage).0 / minimum - 1.0).abs() < 1e-5, "{stage}: {:?}, not {minimum}", best(stage));
    }
    assert!(best("alone").0 > 1.5 * minimum, "{:?}", best("alone"));
    assert_eq!(best("short").1, "evaluations used up");
    // The simplex finds a design with a fourteenth of the peak-to-peak where lines stop.
    let inside = best("edge_by_simplex");
    assert_eq!(inside.1, "converged");
    for stage in ["edge", "edge_in_stages"] {
        let (found, ended) = best(stage);
        assert!(
            ended == "stopped at the edge of the valid designs" && found > 10.0 * inside.0,
            "{stage}: {found} {ended}"
        );
    }
}
