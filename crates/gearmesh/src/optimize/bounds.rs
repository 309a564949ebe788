//! A box of variables, and the only way from the unit cube into it.
//!
//! Must not know: what the variables mean; their units are the caller's (SI).

use declare::error::Diagnostic;

/// Least and most of each variable; at least one variable, each with least < most.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds(Vec<(f64, f64)>);

impl Bounds {
    /// # Errors
    /// When there is no variable, or one whose bounds are not two finite numbers in ascending order.
    pub fn new(pairs: Vec<(f64, f64)>) -> Result<Self, Diagnostic> {
        if pairs.is_empty() {
            return Err(Diagnostic::new("there is nothing to optimise: no variable has a range")
                .help("give at least one design variable as `[least, most]`"));
        }
        for (at, &(minimum, maximum)) in pairs.iter().enumerate() {
            let variable = at + 1;
            if !(minimum.is_finite() && maximum.is_finite()) {
                return Err(Diagnostic::new(format!(
                    "the bounds {minimum} and {maximum} of variable {variable} are not finite"
                )));
            }
            if minimum >= maximum {
                return Err(Diagnostic::new(format!(
                    "the range of variable {variable} is empty: its least value {minimum} must be below its most {maximum}"
                ))
                .help("give a single value for what is not to be varied"));
            }
        }
        Ok(Self(pairs))
    }

    /// How many variables there are; at least one.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.0.len()
    }

    /// Least and most of each variable.
    #[must_use]
    pub fn pairs(&self) -> &[(f64, f64)] {
        &self.0
    }

    /// The point of the box for a point of the unit cube. 0 and 1 give the bounds exactly, and no rounding leaves them.
    #[must_use]
    pub fn point(&self, unit: &[f64]) -> Vec<f64> {
        self.0
            .iter()
            .zip(unit)
            // The weighted mean, not minimum + t·(maximum − minimum): that can miss `maximum` and overflow.
            .map(|(&(minimum, maximum), t)| (minimum * (1.0 - t) + maximum * t).clamp(minimum, maximum))
            .collect()
    }

    /// The point of the unit cube for a point of the box.
    #[must_use]
    pub fn unit(&self, point: &[f64]) -> Vec<f64> {
        let share = |(&(minimum, maximum), x): (&(f64, f64), &f64)| {
            // Halves, or the difference may overflow.
            ((0.5 * x - 0.5 * minimum) / (0.5 * maximum - 0.5 * minimum)).clamp(0.0, 1.0)
        };
        self.0.iter().zip(point).map(share).collect()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_unit_cube_maps_onto_the_box(a in -1e300..1e300_f64, b in -1e300..1e300_f64, t in 0.0..=1.0_f64) {
            prop_assume!(a < b);
            let bounds = Bounds::new(vec![(a, b)]).unwrap();
            let at = |t| bounds.point(&[t])[0];
            prop_assert_eq!(at(0.0).to_bits(), a.to_bits());
            prop_assert_eq!(at(1.0).to_bits(), b.to_bits());
            prop_assert!((a..=b).contains(&at(t)));
            // As near as the box has numbers.
            let back = bounds.unit(&[at(t)])[0];
            let size = a.abs().max(b.abs());
            prop_assert!((back - t).abs() <= 4.0 * f64::EPSILON * (size / (0.5 * b - 0.5 * a) + 1.0), "{}", back);
        }
    }

    #[test]
    fn the_upper_bound_is_met_where_the_usual_map_misses_it() {
        let (minimum, maximum) = (0.4_f64, 1.7);
        assert!(minimum + (maximum - minimum) < maximum);
        assert_eq!(Bounds::new(vec![(minimum, maximum)]).unwrap().point(&[1.0])[0].to_bits(), maximum.to_bits());
    }

    #[test]
    fn impossible_boxes_are_refused() {
        let refusal = |pairs: &[(f64, f64)]| Bounds::new(pairs.to_vec()).unwrap_err().message;
        assert!(refusal(&[]).contains("nothing to optimise"));
        assert!(refusal(&[(0.0, 1.0), (2.0, 2.0)]).contains("variable 2 is empty"));
        assert!(refusal(&[(1.0, 0.0)]).contains("below"));
        assert!(refusal(&[(0.0, f64::INFINITY)]).contains("not finite"));
        assert!(refusal(&[(f64::NAN, 1.0)]).contains("not finite"));
    }
}
