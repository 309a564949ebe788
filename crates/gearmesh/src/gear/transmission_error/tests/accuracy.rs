//! Estimated errors of sampling against the truth, over hundreds of random pairs, loads and designs, with corners and with
//! slices that hold each other among them.

use crate::gear::compliance::energy::Energy;
use crate::gear::compliance::{Assumptions, ContactLaw, Method};
use crate::gear::contact::{CornerContact, SliceCoupling};
use crate::gear::geometry::root::RootShape;
use crate::gear::modification::Design;
use crate::gear::random::Random;
use crate::gear::transmission_error::curve::{Point, Wanted};
use crate::gear::transmission_error::cycle::{MeshCycle, Settings};
use crate::gear::transmission_error::load_case::LoadCase;
use crate::gear::transmission_error::sampling::{Against, Sampled};

/// Below this an error is not that of sampling: the floor of the estimates.
const FLOOR: f64 = 1e-10;
/// What counts as the truth: errors are a hundredth of those that are estimated.
const TRUTH: Settings =
    Settings { positions: 192, slices: 257, corner_contact: CornerContact::None, slice_coupling: SliceCoupling::None };

struct Case {
    base: MeshCycle,
    design: Design,
    torque: f64,
}

impl Case {
    fn random(random: &mut Random) -> Self {
        Self::random_with(random, TRUTH)
    }

    fn random_with(random: &mut Random, settings: Settings) -> Self {
        let pair = random.pair();
        let contact = random.of(&[ContactLaw::Linear, ContactLaw::LoadDependent]);
        let coupled = random.share() < 0.2;
        let assumptions = Assumptions { root: RootShape::Trochoid, contact, coupled, torque: None, accuracy: None };
        let Ok(found) = Energy { harmonics: 10, ..Energy::default() }.tabulate(&pair, assumptions) else {
            return Self::random_with(random, settings);
        };
        let base = MeshCycle::new(&pair, &found.compliance, settings).unwrap();
        let (design, torque) = (random.design(&pair), random.torque(&pair));
        Self { base, design, torque }
    }

    fn is_sliced(&self) -> bool {
        LoadCase::new(&self.base, &self.design, self.torque).uses_slices()
    }

    fn peak_to_peak(&self, settings: Settings) -> f64 {
        LoadCase::new(&self.base.sampled(settings), &self.design, self.torque).peak_to_peak()
    }

    fn variance(&self, settings: Settings) -> f64 {
        LoadCase::new(&self.base.sampled(settings), &self.design, self.torque).variance()
    }
}

/// Estimates over true errors.
#[derive(Default)]
struct Ratios(Vec<f64>);

impl Ratios {
    /// An estimate of 1 says that nothing is known.
    fn add(&mut self, estimate: f64, error: f64) {
        self.0.push(estimate / error.clamp(FLOOR, 1.0));
    }

    /// Holds in every case, and is no more than `maximum` times the error in the median.
    #[track_caller]
    fn check(&mut self, what: &str, minimum: usize, maximum: f64) {
        self.0.sort_by(f64::total_cmp);
        let (count, holds) = (self.0.len(), self.0.iter().filter(|ratio| **ratio >= 1.0).count());
        let median = self.0[count / 2];
        println!("{what}: {holds} of {count} hold, median {median:.1}");
        assert!(count >= minimum, "{what}: only {count}");
        assert!(holds == count, "{what}: holds in {holds} of {count}, by {} of the error", self.0[0]);
        assert!(median <= maximum, "{what}: {median} times the error in the median");
    }
}

#[test]
fn the_estimate_from_coarser_samplings_holds() {
    let mut random = Random::new(11);
    let (mut sliced, mut closed) = (Ratios::default(), Ratios::default());
    // Of what sampling a wish picks, as a share of the wish.
    let (mut wished, mut coarse) = (Ratios::default(), 0);
    for _ in 0..150 {
        let corner_contact = random.of(&[CornerContact::None, CornerContact::Exact]);
        let plate = random.share() < 0.05;
        let finest = if plate {
            Settings { positions: 16, slices: 65, corner_contact, slice_coupling: SliceCoupling::Plate }
        } else {
            Settings { corner_contact, ..TRUTH }
        };
        let case = Case::random_with(&mut random, finest);
        let truth = case.peak_to_peak(finest);
        let error = |settings| (case.peak_to_peak(settings) / truth - 1.0).abs();
        let mut sampled = Sampled::new(case.is_sliced(), Against::Coarser, |settings| case.peak_to_peak(settings));
        let [positions, slices] = [random.of(&[8, 16, 24, 40, 64]), random.of(&[3, 5, 9, 17, 24])];
        let settings = Settings { positions, slices, ..finest };
        let ratios = if case.is_sliced() { &mut sliced } else { &mut closed };
        ratios.add(sampled.error(settings), error(settings));
        let accuracy = random.scaled(5e-4, 3e-2);
        if plate {
            continue;
        }
        let chosen = sampled.coarsest(finest, accuracy);
        if sampled.error(chosen) <= accuracy {
            wished.add(accuracy, error(chosen));
            coarse += usize::from(chosen.slices <= 33 && chosen.positions == 16);
        }
    }
    sliced.check("with slices", 75, 30.0);
    closed.check("in closed form", 30, 30.0);
    let held = wished.0.iter().filter(|ratio| **ratio >= 1.0).count();
    assert!(wished.0.len() > 125 && held * 100 >= wished.0.len() * 99, "{held} of {}", wished.0.len());
    assert!(coarse > 50, "a coarse sampling is enough for most wishes: {coarse}");
}

#[test]
fn the_estimate_from_a_finer_sampling_holds() {
    let mut random = Random::new(12);
    let (mut peaks, mut variances) = (Ratios::default(), Ratios::default());
    for _ in 0..100 {
        let case = Case::random(&mut random);
        let settings = Settings { positions: random.of(&[8, 16, 24, 40]), slices: random.of(&[5, 9, 17]), ..TRUTH };
        let of = |ratios: &mut Ratios, number: &dyn Fn(Settings) -> f64| {
            let truth = number(TRUTH);
            let mut sampled = Sampled::new(case.is_sliced(), Against::Finer, number);
            ratios.add(sampled.error(settings), (number(settings) / truth - 1.0).abs());
        };
        of(&mut peaks, &|settings| case.peak_to_peak(settings));
        of(&mut variances, &|settings| case.variance(settings));
    }
    peaks.check("peak-to-peak", 100, 30.0);
    variances.check("variance", 100, 30.0);
}

/// Tier: invariant. What a curve spans is the summary's peak-to-peak, under load and without, also where corners touch; its
/// points are in order, and no share of the load exceeds 1.
#[test]
fn a_curve_spans_its_summary_s_peak_to_peak() {
    let mut random = Random::new(13);
    let mut added = 0;
    for case in 0..200 {
        let corner_contact = random.of(&[CornerContact::None, CornerContact::Exact]);
        let settings = Settings { positions: random.of(&[8, 16, 24]), slices: 5, corner_contact, ..TRUTH };
        let case = (case, Case::random_with(&mut random, settings));
        let loading = LoadCase::new(&case.1.base, &case.1.design, case.1.torque);
        let (points, summary) = loading.curve_and_summary(Wanted::default());
        let spanned = |value: &dyn Fn(&Point) -> f64| {
            let values = || points.iter().map(value);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        };
        let loaded = spanned(&|point| point.transmission_error);
        assert!((loaded - summary.peak_to_peak).abs() <= 1e-15 * summary.largest.value, "{}: {loaded:e}", case.0);
        let unloaded = spanned(&|point| point.unloaded_transmission_error);
        assert!((unloaded - summary.unloaded_peak_to_peak).abs() <= 1e-12 * unloaded.abs(), "{}: {unloaded:e}", case.0);
        for two in points.windows(2).filter(|two| two[0].pairs == two[1].pairs) {
            assert!(two[0].cycle_position <= two[1].cycle_position, "{}", case.0);
        }
        let share = summary.largest_load_share;
        assert!((1.0 / 6.0..=1.0).contains(&share), "{}: {share}", case.0);
        for point in &points {
            assert!(point.loads.iter().all(|load| *load <= point.load()), "{}: {point:?}", case.0);
        }
        let nodes = loading.trace().nodes(&loading.cycle.rows);
        let is_node = |point: &Point| nodes.iter().any(|node| node.position.total_cmp(&point.cycle_position).is_eq());
        added += usize::from(!points.iter().all(is_node));
    }
    assert!(added > 100, "extrema between nodes: {added}");
}
