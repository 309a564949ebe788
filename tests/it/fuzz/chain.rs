//! The chain under parameters from end to end of their ranges, and specifications that are not numbers at all.

use rand_core::Rng;

use super::drive;
use crate::properties::{base, coarse_mesh, model, ring};
use declare::seed::Seed;
use gearmesh::gear::compliance::ContactLaw;
use gearmesh::gear::compliance::energy::Energy;
use gearmesh::gear::compliance::iso6336::Iso6336;
use gearmesh::gear::compliance::weber_banaschek::WeberBanaschek;
use gearmesh::gear::contact::CornerContact;
use gearmesh::gear::geometry::root::RootShape;
use gearmesh::gear::geometry::{GearPair, Specification};
use gearmesh::gear::mesh::answers::curve::Wanted;
use gearmesh::gear::mesh::answers::stiffness::stiffness;
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::gear::modification::Design;
use gearmesh::gear::stability::{AXES, Case, Model, Rules, Verdict, check, sample};

/// What a specification must survive.
const STRANGE: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    1e-300,
    -1e-300,
    5e-324,
    1e300,
    -1e300,
    f64::MAX,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    f64::EPSILON,
    0.1,
    1e6,
];

fn uniform(generator: &mut impl Rng) -> f64 {
    (generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

fn pick<T: Copy>(generator: &mut impl Rng, values: &[T]) -> T {
    values[(generator.next_u64() % values.len() as u64) as usize]
}

fn any_model(number: u64, generator: &mut impl Rng) -> Model {
    let contact = pick(generator, &[ContactLaw::Linear, ContactLaw::LoadDependent]);
    let coupled = generator.next_u64().is_multiple_of(2);
    let mut found = match number % 8 {
        0 => model(WeberBanaschek {}, contact, coupled),
        1 => model(Iso6336::default(), ContactLaw::Linear, coupled),
        2 if number % 40 == 2 => model(coarse_mesh(), contact, coupled),
        2..=4 => model(ring(), contact, coupled),
        _ => model(Energy::default(), contact, coupled),
    };
    found.assumptions.root =
        pick(generator, &[RootShape::Trochoid, RootShape::Trochoid, RootShape::CircularFillet, RootShape::BaseCircle]);
    found.settings = Settings { positions: pick(generator, &[1, 8, 64, 257]), ..Settings::default() };
    found
}

/// The case of a number: half of them lean towards pairs that can be.
fn case(number: u64) -> Case {
    let mut generator = Seed::of_stage(1, "chain").generator(number);
    let model = any_model(number, &mut generator);
    let tame = !generator.next_u64().is_multiple_of(4);
    let coordinates: Vec<f64> = AXES
        .iter()
        .map(|axis| {
            let shape =
                ["pinion_teeth", "gear_teeth", "pinion_shift", "gear_shift", "pressure_angle"].contains(&axis.name);
            let value = uniform(&mut generator);
            if tame && shape { 0.35 * value } else { value }
        })
        .collect();
    let mut point = sample(&base(), &coordinates);
    if tame {
        point.teeth = [20.0 + (coordinates[4] * 300.0).floor(), 30.0 + (coordinates[5] * 400.0).floor()];
    }
    let mut case = point.case(format!("case {number}"), "sample", 0.0, &model);
    let (minimum, maximum) = ([1e-12, 0.0, 0.0, 0.0], [1e9, 5e-3, 1.0, 5e-3]);
    for (index, value) in
        [&mut case.torque, &mut case.relief, &mut case.relief_length, &mut case.crowning].into_iter().enumerate()
    {
        match generator.next_u64() % 12 {
            0 => *value = minimum[index],
            1 => *value = maximum[index],
            2 => *value = 1e-300_f64.max(minimum[index]),
            _ => {}
        }
    }
    if number % 5 == 3 {
        let strange = pick(&mut generator, &STRANGE);
        let gear = &mut case.gears[(generator.next_u64() % 2) as usize];
        let Specification { module, pressure_angle, profile_shift, rack, face_width, bore_radius, material, .. } = gear;
        let slots: [&mut f64; 10] = [
            module,
            pressure_angle,
            profile_shift,
            &mut rack.addendum,
            &mut rack.dedendum,
            &mut rack.tip_radius,
            face_width,
            bore_radius,
            &mut material.youngs_modulus,
            &mut material.poisson_ratio,
        ];
        let at = (generator.next_u64() % 11) as usize;
        match slots.into_iter().nth(at) {
            Some(slot) => *slot = strange,
            None => gear.tip_radius = Some(strange),
        }
    }
    case
}

/// Every table a stage would write of it, as far as the case goes.
fn run(case: &Case, corner_contact: CornerContact) {
    let Ok(pair) = case.pair() else { return };
    let Ok(design) = case.design(&pair) else { return };
    let Ok(found) = case.model.method.tabulate(&pair, case.model.assumptions) else { return };
    let settings = Settings { corner_contact, ..case.model.settings };
    let Ok(cycle) = Mesh::new(&pair, &found.compliance, settings) else { return };
    follow(&pair, &cycle, &design, case.torque);
}

fn follow(pair: &GearPair, cycle: &Mesh, design: &Design, torque: f64) {
    let loading = cycle.loaded(design, torque);
    let (points, summary) = loading.curve_and_summary(Wanted { harmonics: 4, pressure: true, ..Wanted::default() });
    assert!(
        summary.mean.is_finite() && summary.peak_to_peak.is_finite() && summary.variance.is_finite(),
        "{summary:?}"
    );
    for point in &points {
        let sum: f64 = point.loads.iter().sum();
        assert!(point.loads.iter().all(|load| *load >= 0.0), "{point:?}");
        assert!((sum / loading.force() - 1.0).abs() < 1e-9, "{sum:e} for {:e}: {point:?}", loading.force());
    }
    let lean = loading.peak_to_peak();
    assert!(lean >= 0.0 && loading.variance() >= 0.0);
    let (curve, summary) = stiffness(cycle, torque);
    assert!(!curve.is_empty() && summary.mean.is_finite(), "{:?}", pair.contact_ratio);
}

#[test]
fn no_case_panics_or_hangs() {
    let rules = Rules::new();
    drive("geometry to transmission error", 400, move |number| {
        let case = case(number);
        run(&case, CornerContact::None);
        if number % 3 == 0 {
            run(&case, CornerContact::Exact);
        }
        if number % 16 == 5 {
            let report = check(&case, &rules);
            for finding in &report.findings {
                let basic = ["no NaN, no infinity", "load balance", "no negative load"].contains(&finding.invariant);
                assert!(!(basic && finding.verdict == Verdict::Broken), "{}: {finding:?}", case.name);
            }
        }
    });
}
