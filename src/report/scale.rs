//! An axis' scale: its range, its round tick values, and the power of ten taken out of their labels.
//!
//! Must not know: pixels, SVG. Tick values and labels are made on decimal texts, so they are exact: 0.3, never
//! 0.30000000000000004.

use declare::number::{magnitude, superscript};

/// From `low` to `high`, `low < high`, both finite; positive when logarithmic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    pub low: f64,
    pub high: f64,
    pub is_log: bool,
}

/// A value worth a line and a label.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    pub value: f64,
    pub label: String,
}

impl Scale {
    /// Holds every finite value, with `margin` (a share of the span) on both sides; `None` when there is none.
    ///
    /// A linear scale with a margin starts at zero when the values come near it or `from_zero` asks for it.
    #[must_use]
    pub fn around(values: impl Iterator<Item = f64>, is_log: bool, margin: f64, from_zero: bool) -> Option<Self> {
        let usable = values.filter(|value| value.is_finite() && (!is_log || *value > 0.0));
        let (low, high) =
            usable.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            return None;
        }
        if is_log {
            let room = if high / low < 1.001 { 1.5 } else { libm::pow(high / low, margin) };
            return Some(Self { low: low / room, high: high * room, is_log });
        }
        let (mut low, mut high) = (low, high);
        if from_zero || (margin > 0.0 && low > 0.0 && low < 0.3 * high) {
            low = low.min(0.0);
            high = high.max(0.0);
        }
        let size = low.abs().max(high.abs());
        if high - low <= 1e-12 * size {
            // One value: enough room to see that it is constant.
            let room = if size == 0.0 { 1.0 } else { 0.1 * size };
            return Some(Self { low: low - room, high: high + room, is_log });
        }
        let room = margin * (high - low);
        let floor = if low == 0.0 { 0.0 } else { low - room };
        let ceiling = if high == 0.0 { 0.0 } else { high + room };
        Some(Self { low: floor, high: ceiling, is_log })
    }

    /// Where `value` lies between the ends, 0 to 1.
    #[must_use]
    pub fn share(&self, value: f64) -> f64 {
        if self.is_log {
            libm::log(value / self.low) / libm::log(self.high / self.low)
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// The power of ten left out of the labels, a multiple of three.
    #[must_use]
    pub fn power(&self) -> i32 {
        let exponent = magnitude(self.low.abs().max(self.high.abs()), 3);
        if self.is_log || (-2..5).contains(&exponent) { 0 } else { exponent.div_euclid(3) * 3 }
    }

    /// About `count` ticks at 1, 2 or 5 times a power of ten.
    #[must_use]
    pub fn ticks(&self, count: usize) -> Vec<Tick> {
        if self.is_log { self.log_ticks() } else { self.linear_ticks(count) }
    }

    fn linear_ticks(&self, count: usize) -> Vec<Tick> {
        let wanted = (self.high - self.low) / count.max(1) as f64;
        let exponent = magnitude(wanted, 6);
        let unit = decimal(1, exponent);
        let (digit, exponent) = match wanted / unit {
            share if share <= 1.0 => (1, exponent),
            share if share <= 2.0 => (2, exponent),
            share if share <= 5.0 => (5, exponent),
            _ => (1, exponent + 1),
        };
        let step = decimal(digit, exponent);
        let power = self.power();
        let places = usize::try_from(power - exponent).unwrap_or(0);
        // The ends are at most a few hundred steps from zero for any data worth drawing; beyond, no ticks are drawn.
        let (first, last) = ((self.low / step - 1e-9).ceil(), (self.high / step + 1e-9).floor());
        if !(first.abs() < 1e9 && last.abs() < 1e9) {
            return Vec::new();
        }
        #[allow(clippy::cast_possible_truncation)] // bounded just above
        let (first, last) = (first as i64, last as i64);
        (first..=last)
            .map(|index| {
                let shown = decimal(index * digit, exponent - power);
                let text = format!("{:.places$}", shown.abs());
                Tick {
                    value: decimal(index * digit, exponent),
                    label: if index < 0 { format!("−{text}") } else { text },
                }
            })
            .collect()
    }

    fn log_ticks(&self) -> Vec<Tick> {
        let (first, last) = (magnitude(self.low, 15), magnitude(self.high, 15));
        let digits: &[i64] = match last - first {
            0..=1 => &[1, 2, 3, 5],
            2..=3 => &[1, 2, 5],
            _ => &[1],
        };
        // At most a dozen labels, however many decades there are.
        let stride = usize::try_from((last - first) / 12 + 1).unwrap_or(1);
        let mut ticks = Vec::new();
        for exponent in (first..=last).step_by(stride) {
            for &digit in digits {
                let value = decimal(digit, exponent);
                if value >= self.low * (1.0 - 1e-9) && value <= self.high * (1.0 + 1e-9) {
                    ticks.push(Tick { value, label: log_label(digit, exponent) });
                }
            }
        }
        // A scale with one label shows no scale: within a small part of a decade round values do, as on a linear one.
        if ticks.len() < 2 { self.linear_ticks(4) } else { ticks }
    }
}

/// The largest of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not larger.
#[must_use]
pub fn rounded_down(value: f64) -> f64 {
    let exponent = magnitude(value, 15).saturating_sub(1);
    let rounded = [80, 60, 50, 40, 30, 25, 20, 15, 10].map(|digits| decimal(digits, exponent));
    rounded.into_iter().find(|rounded| *rounded <= value).unwrap_or(value)
}

fn log_label(digit: i64, exponent: i32) -> String {
    match (digit, exponent) {
        (_, -2..=4) => {
            let places = usize::try_from(-exponent).unwrap_or(0);
            format!("{:.places$}", decimal(digit, exponent))
        }
        (1, _) => format!("10{}", superscript(exponent)),
        _ => format!("{digit}·10{}", superscript(exponent)),
    }
}

fn decimal(digits: i64, exponent: i32) -> f64 {
    format!("{digits}e{exponent}").parse().unwrap_or(f64::NAN)
}

/// A quantity's name with its unit and the power of ten that its values are without.
pub fn with_power(label: &str, symbol: &str, power: i32) -> String {
    match (power, symbol.is_empty()) {
        (0, true) => label.to_owned(),
        (0, false) => format!("{label} ({symbol})"),
        (power, true) => format!("{label} (10{})", superscript(power)),
        (power, false) => format!("{label} (10{} {symbol})", superscript(power)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, is_log: bool) -> Vec<String> {
        Scale { low, high, is_log }.ticks(6).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_and_exact() {
        assert_eq!(labels(0.0, 3.2, false), ["0", "1", "2", "3"]);
        assert_eq!(labels(-0.1, 0.5, false), ["−0.1", "0.0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
        assert_eq!(labels(25.0, 100.0, false), ["40", "60", "80", "100"]);
        assert_eq!(labels(2.7e8, 4.8e8, false), ["300", "350", "400", "450"]);
        assert_eq!(Scale { low: 2.7e8, high: 4.8e8, is_log: false }.power(), 6);
        assert_eq!(labels(1e-9, 3e-9, false).len(), 5);
        let ticks = Scale { low: 0.0, high: 0.6, is_log: false }.ticks(6);
        assert_eq!(ticks[3].value.to_bits(), 0.3_f64.to_bits());
    }

    #[test]
    fn logarithmic_ticks_cover_decades() {
        assert_eq!(labels(0.5, 40.0, true), ["0.5", "1", "2", "5", "10", "20"]);
        assert_eq!(labels(1e-12, 1e-2, true)[0], "10⁻¹²");
        assert!(labels(1e-300, 1e300, true).len() < 30);
    }

    #[test]
    fn a_logarithmic_axis_has_two_labels_at_least() {
        assert_eq!(labels(3.2, 4.8, true), ["3.5", "4.0", "4.5"]);
        for low in [1e-12, 0.013, 0.97, 3.1, 5.1, 9.9, 72.0, 1.9e9] {
            for ratio in [1.002, 1.02, 1.2, 1.9, 3.0, 9.5, 11.0, 99.0, 1e4, 1e13] {
                let shown = labels(low, low * ratio, true);
                assert!(shown.len() >= 2, "{low} to {}: {shown:?}", low * ratio);
                let mut distinct = shown.clone();
                distinct.dedup();
                assert_eq!(distinct, shown);
            }
        }
    }

    #[test]
    fn factors_are_round() {
        for (value, rounded) in [(1999.0, 1500.0), (2000.0, 2000.0), (0.49, 0.4), (0.5, 0.5), (7.2e5, 6e5), (9.99, 8.0)]
        {
            assert_eq!(rounded_down(value).to_bits(), f64::to_bits(rounded), "{value}");
        }
    }

    #[test]
    fn every_value_is_inside() {
        for values in
            [vec![0.0], vec![5.0, 5.0], vec![-3.0, 2.0], vec![f64::NAN, 1.0], vec![1e-300, 1e-299], vec![1e300, -1e300]]
        {
            for margin in [0.0, 0.06] {
                let scale = Scale::around(values.iter().copied(), false, margin, false).unwrap();
                for value in values.iter().filter(|value| value.is_finite()) {
                    assert!((0.0..=1.0).contains(&scale.share(*value)), "{value} in {scale:?}");
                }
                assert!(scale.low < scale.high && scale.ticks(6).len() < 20, "{scale:?}");
            }
        }
        assert_eq!(Scale::around([f64::NAN].into_iter(), false, 0.0, false), None);
        assert_eq!(Scale::around([-1.0].into_iter(), true, 0.0, false), None);
        let log = Scale::around([1.0, 100.0, -5.0].into_iter(), true, 0.0, false).unwrap();
        assert!((log.share(10.0) - 0.5).abs() < 1e-12);
    }
}
