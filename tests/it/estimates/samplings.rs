//! Estimated errors of sampling against the truth, over hundreds of random pairs, loads and designs, with corners and with
//! slices that hold each other among them.

use super::random::{Case, Random};
use gearmesh::gear::contact::{CornerContact, SliceCoupling};
use gearmesh::gear::mesh::Settings;
use gearmesh::gear::mesh::answers::sampling::{Against, Sampled};

/// Below this an error is not that of sampling: the floor of the estimates.
const FLOOR: f64 = 1e-10;
/// What counts as the truth: errors are a hundredth of those that are estimated.
const TRUTH: Settings =
    Settings { positions: 192, slices: 257, corner_contact: CornerContact::None, slice_coupling: SliceCoupling::None };

fn peak_to_peak(case: &Case, settings: Settings) -> f64 {
    case.cycle.sampled(settings).loaded(&case.design, case.torque).peak_to_peak()
}

fn variance(case: &Case, settings: Settings) -> f64 {
    case.cycle.sampled(settings).loaded(&case.design, case.torque).variance()
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
        let case = random.case(finest);
        let truth = peak_to_peak(&case, finest);
        let error = |settings| (peak_to_peak(&case, settings) / truth - 1.0).abs();
        let mut sampled =
            Sampled::new(case.load_case().uses_slices(), Against::Coarser, |settings| peak_to_peak(&case, settings));
        let [positions, slices] = [random.of(&[8, 16, 24, 40, 64]), random.of(&[3, 5, 9, 17, 24])];
        let settings = Settings { positions, slices, ..finest };
        let ratios = if case.load_case().uses_slices() { &mut sliced } else { &mut closed };
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
    sliced.check("with slices", 75, 32.0);
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
        let case = random.case(TRUTH);
        let settings = Settings { positions: random.of(&[8, 16, 24, 40]), slices: random.of(&[5, 9, 17]), ..TRUTH };
        let of = |ratios: &mut Ratios, number: &dyn Fn(Settings) -> f64| {
            let truth = number(TRUTH);
            let mut sampled = Sampled::new(case.load_case().uses_slices(), Against::Finer, number);
            ratios.add(sampled.error(settings), (number(settings) / truth - 1.0).abs());
        };
        of(&mut peaks, &|settings| peak_to_peak(&case, settings));
        of(&mut variances, &|settings| variance(&case, settings));
    }
    peaks.check("peak-to-peak", 100, 30.0);
    variances.check("variance", 100, 30.0);
}
