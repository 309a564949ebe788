//! Scales of a drawing that is true to scale: a millimetre is as long across as upwards.
//!
//! Must not know: SVG, tables.

use super::scale::Scale;

/// The highest and the lowest a drawing may be \[px\].
const TALLEST: f64 = 820.0;
const FLATTEST: f64 = 160.0;

/// Both scales widened about their middles until a unit has one length, and the height of the drawing, for a width.
#[must_use]
pub fn true_to_scale(x: Scale, y: Scale, width: f64) -> (Scale, Scale, f64) {
    let (across, up) = (x.high - x.low, y.high - y.low);
    let unit = (across / width).max(up / TALLEST);
    let height = (up / unit).max(FLATTEST);
    let widened = |scale: Scale, length: f64| {
        let (middle, half) = (0.5 * (scale.low + scale.high), 0.5 * unit * length);
        Scale { low: middle - half, high: middle + half, ..scale }
    };
    (widened(x, width), widened(y, height), height)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_has_one_length_and_nothing_is_cut_off() {
        for (x, y) in [((-3.0, 4.0), (10.0, 12.0)), ((0.0, 1.0), (0.0, 50.0)), ((-9.0, 9.0), (5.0, 5.01))] {
            let scale = |(low, high)| Scale { low, high, is_log: false };
            let (across, up, height) = true_to_scale(scale(x), scale(y), 700.0);
            let unit = |scale: Scale, length: f64| (scale.high - scale.low) / length;
            assert!((unit(across, 700.0) / unit(up, height) - 1.0).abs() < 1e-12);
            let room = 1e-12;
            assert!(
                across.low <= x.0 + room && across.high >= x.1 - room && up.low <= y.0 + room && up.high >= y.1 - room
            );
            assert!((FLATTEST..=TALLEST).contains(&height));
        }
    }
}
