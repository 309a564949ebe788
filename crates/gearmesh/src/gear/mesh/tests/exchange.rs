//! Invariants that no kink of a flank may break: the gears in each other's place, and all lengths twice as long.

use super::*;
use crate::gear::compliance::energy::Energy;
use crate::gear::compliance::{Assumptions, Method};
use crate::gear::fixtures::standard;
use crate::gear::fixtures::uneven::{Traces, uneven};
use crate::gear::mesh::answers::curve::Summary;
use crate::gear::modification::Gears;
use crate::gear::modification::measured::Measured;
use crate::gear::random::Random;

/// A pair, its mesh cycle in each order of the gears, and with all lengths doubled.
struct Cycles {
    pair: GearPair,
    doubled_pair: GearPair,
    plain: Mesh,
    exchanged: Mesh,
    doubled: Mesh,
}

impl Cycles {
    fn new(teeth: [u32; 2], module: f64, positions: usize) -> Self {
        let of = |teeth: [u32; 2], module: f64| {
            let [pinion, gear] = teeth.map(|teeth| standard(teeth, module, 2.0));
            let pair = GearPair::new(pinion, gear, None).unwrap();
            let compliance = Energy::default().tabulate(&pair, Assumptions::default()).unwrap().compliance;
            let settings = Settings { positions, ..Settings::default() };
            (Mesh::new(&pair, &compliance, settings).unwrap(), pair)
        };
        let (plain, pair) = of(teeth, module);
        let (exchanged, _) = of([teeth[1], teeth[0]], module);
        let (doubled, doubled_pair) = of(teeth, 2.0 * module);
        Self { pair, doubled_pair, plain, exchanged, doubled }
    }

    /// Peak-to-peak and mean, and by how much they differ over the peak-to-peak with the gears exchanged, and with all lengths doubled.
    fn differences(&self, [design, doubled]: [&Design; 2], torque: f64) -> [[f64; 2]; 2] {
        let summary =
            |cycle: &Mesh, design: &Design, torque: f64| cycle.loaded(design, torque).summary(Wanted::default());
        let here = summary(&self.plain, design, torque);
        let other_design = Design { pinion: design.gear.clone(), gear: design.pinion.clone(), tilt: design.tilt };
        let ratio = self.pair.gear.base_radius / self.pair.pinion.base_radius;
        let there = summary(&self.exchanged, &other_design, torque * ratio);
        let larger = summary(&self.doubled, doubled, 8.0 * torque);
        let off = |other: &Summary, scale: f64| {
            [(other.peak_to_peak, here.peak_to_peak), (other.mean, here.mean)]
                .map(|(other, here_value)| (other / scale - here_value).abs() / here.peak_to_peak)
        };
        [off(&there, 1.0), off(&larger, 2.0)]
    }
}

/// Tier: invariant; a trace of nine points that begins and ends 0.1 mm inside the flank, at 512 positions, under several torques.
#[test]
fn a_trace_that_begins_inside_the_flank_does_not_care_which_gear_drives() {
    let cycles = Cycles::new([59, 85], 2e-3, 512);
    let lengths = [14.873, 16.181, 17.488, 18.796, 20.103, 21.411, 22.718, 24.026, 25.333];
    let deviations = [-0.68, -2.347, 1.133, 0.3205, 1.292, -0.7559, 2.321, -1.724, -1.167];
    let design = |pair: &GearPair, scale: f64| {
        let trace = Measured {
            deviations: deviations.map(|deviation| deviation * 1e-6 * scale).to_vec(),
            roll_lengths: Some(lengths.map(|length| length * 1e-3 * scale).to_vec()),
            ..Measured::default()
        };
        let mut design = Design::default();
        design.add(Gears::Pinion, &trace, pair).unwrap();
        design
    };
    let designs = [design(&cycles.pair, 1.0), design(&cycles.doubled_pair, 2.0)];
    for torque in [10.0, 37.76, 60.0, 150.0] {
        let [exchanged, doubled] = cycles.differences(designs.each_ref(), torque);
        assert!(exchanged[0] < 1e-9 && doubled[0] < 1e-9, "{torque} N m: {exchanged:?} {doubled:?}");
    }
}

/// Tier: invariant; random designs of every family and together: peak-to-peak values to 1e-9 of them, means to 1e-11.
#[test]
fn uneven_flanks_do_not_care_which_gear_drives_nor_how_large_they_are() {
    for (teeth, module) in [([59, 85], 2e-3), ([19, 48], 3e-3), ([24, 36], 3e-3)] {
        let cycles = Cycles::new(teeth, module, 256);
        for (traces, drawn, count) in [
            (Traces::Sparse, 0, 12),
            (Traces::Sparse, 3, 12),
            (Traces::Dense, 0, 3),
            (Traces::Grid, 1, 2),
            (Traces::Lead, 2, 4),
            (Traces::None, 2, 20),
        ] {
            for seed in 0..count {
                let of = |pair: &GearPair, scale: f64| uneven(pair, traces, drawn, scale, &mut Random::new(seed));
                let designs = [of(&cycles.pair, 1.0), of(&cycles.doubled_pair, 2.0)];
                let torque = Random::new(seed + 1000).between(10.0, 200.0);
                let [exchanged, doubled] = cycles.differences(designs.each_ref(), torque);
                let is_same = exchanged[0] < 1e-9 && doubled[0] < 1e-9 && exchanged[1] < 1e-11 && doubled[1] < 1e-11;
                assert!(is_same, "{teeth:?} {traces:?} {drawn} {seed}: {exchanged:?} {doubled:?}");
            }
        }
    }
}
