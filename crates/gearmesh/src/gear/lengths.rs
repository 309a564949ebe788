//! Lengths of drawings in metres: `mm(3.0)` is the number that `3e-3` is.
//!
//! Must not know: anything else.

/// Millimetres as metres.
#[must_use]
pub fn mm(value: f64) -> f64 {
    value / 1e3
}

/// Micrometres as metres.
#[must_use]
pub fn um(value: f64) -> f64 {
    value / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[allow(clippy::float_cmp)] // the same number is meant
    fn they_are_the_numbers_that_are_written_in_metres() {
        assert_eq!([mm(3.0), mm(20.0), um(14.0), um(7.0)], [3e-3, 20e-3, 14e-6, 7e-6]);
    }
}
