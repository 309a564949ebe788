//! Whether a simpler design does as well as another one: long relief, the tip relief of the handbooks.
//!
//! Long relief is linear and as long as p_b(ε_α − 1), from the highest point of single contact to the tip, on both gears
//! (Smith, Gear Noise and Vibration, 2nd edition 2003, chapter 2; Munro, Proc. Inst. Mech. Eng. 204 C (1990)). Its amount is
//! all that is left open. Must not know: what a design is worth, where the other one comes from.

use crate::stage::designs::Element;
use declare::declared::Declared;
use declare::error::{Diagnostic, Failure};
use declare::number::significant;
use declare::units::in_unit;
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::modification::curve::Curve;
use gearmesh::gear::modification::relief::{Amount, FromTip, Start};
use gearmesh::gear::modification::tip_relief::TipRelief;
use gearmesh::gear::modification::{Design, Gears};
use gearmesh::optimize;
use gearmesh::optimize::bounds::Bounds;

/// Amounts that are tried evenly, and evaluations of a simplex that begins at the best of them, at most.
const AMOUNTS: usize = 6;
const EVALUATIONS: usize = 40;
/// All of them, at most.
pub const TRIED: usize = AMOUNTS + 1 + EVALUATIONS;

/// Long relief that is as good as another design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simpler {
    /// Of the relief \[m\].
    pub amount: f64,
    /// What it is worth; less is better.
    pub value: f64,
    /// What the other one is worth.
    other: f64,
}

/// Long relief of the best amount, if what it is worth is larger than the `other` value by no more than the share `within` of
/// that. Amounts are tried up to twice the `deflection`; what `value` says of one is infinite where it does not fit.
pub fn as_good(other: f64, within: f64, deflection: f64, mut value: impl FnMut(f64) -> f64) -> Option<Simpler> {
    let most = 2.0 * deflection;
    let bounds = Bounds::new(vec![(0.0, most)]).ok()?;
    let scanned = (0..=AMOUNTS).map(|at| most * at as f64 / AMOUNTS as f64);
    let (from, _) = scanned.map(|amount| (amount, value(amount))).min_by(|a, b| a.1.total_cmp(&b.1))?;
    let mut search = optimize::refinement(bounds, &[from], 0.5 / AMOUNTS as f64, EVALUATIONS);
    search.run(|points| Ok::<_, Failure>(points.iter().map(|point| value(point[0])).collect())).ok()?;
    let best = search.best()?;
    let is_as_good = best.value - other <= within * other.abs();
    is_as_good.then(|| Simpler { amount: best.point[0], value: best.value, other })
}

impl Simpler {
    /// `a simpler design is as good: …, whose objective is larger by 0.3 %`.
    pub fn said(&self, quantity: &str) -> String {
        let amount = significant(in_unit(self.amount, "um"), 4);
        let what = if self.amount > 0.0 {
            format!(
                "linear tip relief of both gears by {amount} um from the highest point of single contact (`tip_relief: \
                 {{ gear: both, amount: {amount} um, fraction: 1, curve: linear }}`)"
            )
        } else {
            "no modification at all".to_owned()
        };
        // Nothing is a share of nothing.
        let more = if self.value.total_cmp(&self.other).is_eq() { 0.0 } else { self.value / self.other - 1.0 };
        let than = if more < 0.0 { "smaller" } else { "larger" };
        let share = significant(100.0 * more.abs(), 2);
        format!("a simpler design is as good: {what}, whose {quantity} is {than} by {share} %")
    }
}

fn relief(amount: f64) -> TipRelief {
    TipRelief {
        amount: Amount::Depth(amount),
        start: Start::Fraction(1.0),
        counted_from: FromTip::Tip,
        curve: Curve::Linear,
    }
}

/// Long relief by `amount` \[m\].
///
/// # Errors
/// When it does not fit the pair.
pub fn long_relief(amount: f64, pair: &GearPair) -> Result<Design, Diagnostic> {
    let mut design = Design::default();
    design.add(Gears::Both, &relief(amount), pair)?;
    Ok(design)
}

/// Whether a design is as simple itself: no modification, or long relief alone.
pub fn is_simple(elements: &[Element]) -> bool {
    elements.iter().all(|Element { family, record }| {
        *family == TipRelief::MEMBER.name
            && TipRelief::checked(record).is_ok_and(|it| TipRelief { amount: it.amount.clone(), ..relief(0.0) } == it)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tier: exact; a parabola with its least value 2 at 3 µm.
    #[test]
    fn long_relief_is_as_good_within_the_share_and_not_beyond() {
        let worth = |amount: f64| 2.0 + (1e6 * amount - 3.0).powi(2);
        let found = as_good(1.9, 0.06, 5e-6, worth).unwrap();
        assert!((found.amount - 3e-6).abs() < 1e-9 && (found.value - 2.0).abs() < 1e-6, "{found:?}");
        let said = found.said("objective");
        assert!(said.contains("by 3 um") && said.ends_with("objective is larger by 5.3 %"), "{said}");
        assert_eq!(as_good(1.9, 0.05, 5e-6, worth), None);
        // The best one is beyond what is tried.
        assert_eq!(as_good(1.9, 0.06, 1e-6, worth), None);
        assert!(as_good(2.5, 0.0, 5e-6, worth).unwrap().said("peak-to-peak").ends_with("is smaller by 20 %"));
    }

    #[test]
    fn what_does_not_fit_and_what_is_worth_nothing_is_no_trouble() {
        assert_eq!(as_good(1.0, 0.5, 5e-6, |_| f64::INFINITY), None);
        assert_eq!(as_good(1.0, 0.5, 0.0, |_| 1.0), None);
        let none = as_good(0.0, 0.01, 5e-6, |amount| amount).unwrap();
        assert!(none.said("objective").contains("no modification at all, whose objective is larger by 0 %"));
    }
}
