//! Smooth functions joined end to end, each a row of panels, which may start or end like a square root.
//!
//! Towards an end that is marked so, a stretch is a smooth function of the root of the distance from it, and is fitted as
//! one. Must not know: what the functions are.

use super::panels::Panels;

/// One stretch.
#[derive(Clone, Debug, PartialEq)]
struct Stretch {
    upper: f64,
    lower: f64,
    roots: [bool; 2],
    panels: Panels,
}

/// A function on consecutive stretches.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Graded(Vec<Stretch>);

impl Graded {
    /// Adds a stretch above those that are there; `roots` marks its lower and its upper end.
    pub fn push(&mut self, range: (f64, f64), roots: [bool; 2], tolerance: f64, function: impl Fn(f64) -> f64) {
        let (lower, upper) = range;
        let length = upper - lower;
        let panels = match roots {
            [false, false] => Panels::fit(lower, upper, tolerance, function),
            [true, false] => Panels::fit(0.0, length.sqrt(), tolerance, |q| function(lower + q * q)),
            [false, true] => Panels::fit(0.0, length.sqrt(), tolerance, |q| function(upper - q * q)),
            [true, true] => Panels::fit(0.0, std::f64::consts::FRAC_PI_2, tolerance, |angle| {
                let share = libm::sin(angle);
                function(lower + length * share * share)
            }),
        };
        self.0.push(Stretch { upper, lower, roots, panels });
    }

    /// The value at `x`; outside all stretches the outermost one goes on, as far as its roots allow.
    #[must_use]
    #[inline]
    pub fn value(&self, x: f64) -> f64 {
        // Of most functions there is one stretch, without roots.
        match &self.0[..] {
            [Stretch { roots: [false, false], panels, .. }] => panels.value(x),
            _ => self.value_of_many(x),
        }
    }

    fn value_of_many(&self, x: f64) -> f64 {
        let last = self.0.len() - 1;
        let stretch = &self.0[self.0[..last].iter().position(|stretch| x <= stretch.upper).unwrap_or(last)];
        let Stretch { upper, lower, roots, panels } = stretch;
        let (below, above) = ((x - lower).max(0.0), (upper - x).max(0.0));
        match roots {
            [false, false] => panels.value(x),
            [true, false] => panels.value(below.sqrt()),
            [false, true] => panels.value(above.sqrt()),
            [true, true] => panels.value(libm::atan2(below.sqrt(), above.sqrt())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_with_roots_at_any_end_are_followed() {
        let pieces: [(f64, f64, [bool; 2]); 4] =
            [(-2.0, 0.0, [false, true]), (0.0, 1.0, [false; 2]), (1.0, 3.0, [true, false]), (3.0, 4.5, [true, true])];
        let function = |x: f64| match x {
            x if x <= 0.0 => libm::exp((-x).sqrt()),
            x if x <= 1.0 => libm::exp(-x),
            x if x <= 3.0 => libm::cos((x - 1.0).sqrt()) - (x - 1.0),
            x => libm::exp((x - 3.0).sqrt() - 0.5 * (4.5 - x).sqrt()),
        };
        let mut graded = Graded::default();
        for (lower, upper, roots) in pieces {
            // One-sided at the joints.
            graded.push((lower, upper), roots, 1e-14, |x| function(x.clamp(lower + 1e-300, upper)));
        }
        for index in 1..650 {
            let x = -2.0 + 0.01 * f64::from(index) + 1e-9;
            assert!((graded.value(x) / function(x) - 1.0).abs() < 3e-13, "{x}");
        }
    }
}
