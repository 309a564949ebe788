//! What a crown carries under a law that tells the penetration at a load and not the reverse.
//!
//! Along a stretch from its highest place on, h = C ζ², the load per width p falls from p_t to p_e, or to 0 where the contact ends. By
//! parts ∫ p dζ = p_e ℓ + ∫ ζ dp from p_e to p_t, with ζ = √((w − w(p))/C): only p_t and p_e are looked for. With
//! p = p_e + (p_t − p_e)(1 − t²)³ the integrand is smooth in t where the contact is widest, and what a logarithm does to the least
//! loads is of a high power of 1 − t: nine slices come nearer than seventeen do that lie along the face. Must not know: which law it is.

use super::piece::Piece;
use crate::numeric::logarithm::{Known, of_each};

/// A crown that rises by less than this share of the penetration has the same load all over but for a thousandth: slices
/// follow from each other, and what their loads differ by has lost digits.
const LEAST_RISE: f64 = 1e-3;
/// So few slices are better spread along the face.
const FEWEST: usize = 5;
/// Loads whose logarithms are found together.
const TOGETHER: usize = 4;

/// Nodes and weights of the rule of seven, which is 1e-6 off: for a search that is far from its end.
pub(super) const FEW: [&[f64]; 2] = [
    &[
        0.0,
        0.084_888_051_860_716_53,
        0.265_575_603_264_642_9,
        0.5,
        0.734_424_396_735_357_1,
        0.915_111_948_139_283_5,
        1.0,
    ],
    &[
        1.0 / 42.0,
        0.138_413_023_680_782_97,
        0.215_872_690_604_931_36,
        128.0 / 525.0,
        0.215_872_690_604_931_36,
        0.138_413_023_680_782_97,
        1.0 / 42.0,
    ],
];

/// How a width of the flanks yields.
pub trait LineLaw {
    /// The load per width at a penetration > 0, and its slope; of a place by its number, nearer to that of the same number before
    /// than to others.
    fn load(&mut self, place: usize, penetration: f64) -> (f64, f64);

    /// The penetration at a load per width, and its slope.
    fn penetration(&self, load: Known) -> [f64; 2];
}

impl Piece {
    /// Whether [`Piece::carried`] is good at this depth.
    pub(super) fn is_crown(&self, depth: f64, [nodes, _]: [&[f64]; 2]) -> bool {
        let is_parabola = self.slope <= 0.0 && self.bend > 0.0;
        is_parabola && self.rise > LEAST_RISE * depth && nodes.len() >= FEWEST
    }

    /// The part of the mean load per width that it carries at the depth > 0 of its lower end, and its slope; `places`: those of its
    /// lower and of its upper end.
    pub(super) fn carried(
        &self,
        depth: f64,
        [nodes, weights]: [&[f64]; 2],
        places: [usize; 2],
        law: &mut impl LineLaw,
    ) -> (f64, f64) {
        let (top, top_slope) = law.load(places[0], depth);
        let at_end = depth - self.rise;
        let (end, end_slope) = if at_end > 0.0 { law.load(places[1], at_end) } else { (0.0, 0.0) };
        let (range, range_slope) = (top - end, top_slope - end_slope);
        let (mut sum, mut slope) = (self.length * end, self.length * end_slope);
        // At both ends of the range nothing is added.
        let inner = 1..nodes.len() - 1;
        for (nodes, weights) in nodes[inner.clone()].chunks(TOGETHER).zip(weights[inner].chunks(TOGETHER)) {
            // Of a last group that is not whole the rest is not looked at.
            let (mut shares, mut weighted) = ([1.0; TOGETHER], [0.0; TOGETHER]);
            for (slot, (t, weight)) in nodes.iter().zip(weights).enumerate() {
                let rest = 1.0 - t * t;
                shares[slot] = rest * rest * rest;
                weighted[slot] = 6.0 * weight * t * rest * rest;
            }
            let loads = shares.map(|share| end + range * share);
            let logs = of_each(&loads);
            for slot in 0..nodes.len() {
                let [penetration, rise] = law.penetration(Known { number: loads[slot], log: logs[slot] });
                let place = ((depth - penetration).max(0.0) * self.per_bend).sqrt().min(self.length);
                let moved = 1.0 - rise * (end_slope + range_slope * shares[slot]);
                sum += weighted[slot] * range * place;
                slope += weighted[slot] * range_slope * place;
                if place > 0.0 {
                    slope += weighted[slot] * range * (0.5 * self.per_bend * moved / place);
                }
            }
        }
        (self.weight * sum, self.weight * slope)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Face;
    use super::*;
    use crate::gear::contact::plain::PlainLaw;
    use crate::gear::fixtures::{design, pair};
    use crate::numeric::lobatto::Rule;
    use declare::record::Value::Quantity;

    const RATE: f64 = 1.4e-12;
    const LAW: PlainLaw = PlainLaw { total: 6.8e-11, rest: 1e-22, last: 1e12 };
    const WIDTH: f64 = 18e-3;
    /// Of a pinion 20 mm wide on a common face of 18 mm.
    const CROWN: f64 = 6e-6;
    const RISE: f64 = 0.81 * CROWN;

    struct Plain;

    impl LineLaw for Plain {
        fn load(&mut self, _: usize, penetration: f64) -> (f64, f64) {
            LAW.load([RATE, libm::log(RATE)], penetration).expect("it holds there")
        }

        fn penetration(&self, load: Known) -> [f64; 2] {
            let [penetration, slope, _] = LAW.rates_at(RATE, load.number, load.log);
            [penetration, slope]
        }
    }

    fn crowned<T>(rule: &Rule, slope: f64, ask: impl Fn(&Face) -> T) -> T {
        let of = |amount: f64| [("amount", Quantity(amount))];
        let parts = [("lead_crowning", "pinion", &of(CROWN)[..]), ("helix_slope", "gear", &of(slope)[..])];
        let design = design(&pair(), &parts[..if slope > 0.0 { 2 } else { 1 }]).unwrap();
        ask(&Face::new(&design, WIDTH, rule))
    }

    fn carried(slices: usize, penetration: f64, slope: f64) -> (f64, f64) {
        crowned(&Rule::new(slices), slope, |face| face.carried(penetration, &mut Plain))
    }

    /// The same along the face, in ζ = reach sin θ, in which the loads end flat.
    fn along_the_face(penetration: f64) -> f64 {
        let reach = (penetration / RISE).sqrt().min(1.0);
        let end = f64::asin(reach / (penetration / RISE).sqrt());
        let rule = Rule::new(200);
        let at = |(node, weight): (&f64, &f64)| {
            let angle = end * node;
            let depth = penetration * angle.cos().powi(2);
            if depth > 0.0 { weight * end * angle.cos() * Plain.load(0, depth).0 } else { 0.0 }
        };
        (penetration / RISE).sqrt() * rule.nodes.iter().zip(&rule.weights).map(at).sum::<f64>()
    }

    /// Penetrations over what the crown rises: part of the face, just less and more than all of it, and far more.
    const RATIOS: [f64; 9] = [1e-6, 0.01, 0.3, 0.98, 1.0, 1.02, 1.5, 6.0, 900.0];

    /// Tier: second method; the integral along the face, with 200 nodes.
    #[test]
    fn loads_summed_by_parts_are_those_along_the_face() {
        for ratio in RATIOS {
            let exact = along_the_face(ratio * RISE);
            for (slices, tolerance) in [(5, 3e-4), (9, 3e-8), (17, 2e-11), (33, 1e-13)] {
                let error = carried(slices, ratio * RISE, 0.0).0 / exact - 1.0;
                println!("{ratio}: {error:e} with {slices}");
                assert!(error.abs() < tolerance, "{ratio}: {error:e} with {slices}");
            }
        }
    }

    /// Tier: second method; the rule itself, and what it is off by.
    #[test]
    fn few_nodes_are_the_rule_of_seven() {
        let rule = Rule::new(7);
        for (few, all) in FEW.into_iter().zip([&rule.nodes, &rule.weights]) {
            assert!(few.iter().zip(all).all(|(one, other)| (one - other).abs() < 2e-16));
        }
        for ratio in RATIOS {
            let about = crowned(&Rule::new(9), 0.0, |face| face.carried_about(ratio * RISE, &mut Plain));
            let (about, exact) = (about.unwrap(), carried(7, ratio * RISE, 0.0));
            assert!((about.0 / exact.0 - 1.0).abs() < 1e-14 && (about.1 / exact.1 - 1.0).abs() < 1e-14, "{ratio}");
            assert!(crowned(&rule, 0.0, |face| face.carried_about(ratio * RISE, &mut Plain)).is_none());
            let about = about.0 / along_the_face(ratio * RISE) - 1.0;
            assert!(about.abs() < 2e-6, "{ratio}: {about:e}");
        }
    }

    /// Tier: invariant; the slope is that of the sum, of a crown that is tilted too.
    #[test]
    fn the_slope_is_that_of_the_sum() {
        // Where the ends just touch it has a corner.
        for ratio in RATIOS.into_iter().filter(|ratio| (ratio - 1.0).abs() > 1e-3) {
            for tilt in [0.0, 4e-6] {
                let penetration = ratio * RISE;
                let step = 1e-5 * penetration;
                let [below, above] = [-step, step].map(|step| carried(9, penetration + step, tilt).0);
                let ratio = carried(9, penetration, tilt).1 * 2.0 * step / (above - below);
                assert!((ratio - 1.0).abs() < 1e-7, "{penetration} {tilt}: {ratio}");
            }
        }
    }

    /// Tier: second method; slices along the face, where one end is higher and both halves are stretches of their own.
    #[test]
    fn a_tilted_crown_is_the_sum_of_its_halves() {
        for penetration in [0.5e-6, 4e-6, 30e-6] {
            let many = carried(33, penetration, 4e-6).0;
            assert!((carried(17, penetration, 4e-6).0 / many - 1.0).abs() < 2e-10);
            let along = |face: &Face| face.summed(penetration, |_, depth| Plain.load(0, depth)).0;
            let slices = crowned(&Rule::new(400), 4e-6, along);
            assert!((many / slices - 1.0).abs() < 1e-9, "{penetration}: {:e}", many / slices - 1.0);
        }
    }
}
