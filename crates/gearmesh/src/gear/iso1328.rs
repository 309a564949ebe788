//! How far flanks may be off in a tolerance class: ISO 1328-1:2013, 5.2 and 5.3.
//!
//! A tolerance is that of class 5 times (√2)^(A − 5), from lengths as they are, and rounded. Lengths in m; the formulas of the
//! standard take mm and give µm. Must not know: modification, load.

pub mod evaluation;

use std::ops::RangeInclusive;

use declare::error::Diagnostic;

/// Classes that the standard has.
pub const CLASSES: RangeInclusive<i64> = 1..=11;

/// Where the formulas hold: teeth, reference diameter, module and face width \[mm\]. They are not to be extended.
const TEETH: RangeInclusive<i64> = 5..=1000;
const DIAMETER: RangeInclusive<f64> = 5.0..=15_000.0;
const MODULE: RangeInclusive<f64> = 0.5..=70.0;
const FACE_WIDTH: RangeInclusive<f64> = 4.0..=1200.0;

/// What of a flank has a tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deviation {
    /// f_p of a single pitch, formula (5).
    Pitch,
    /// f_Hα, formula (7).
    ProfileSlope,
    /// f_fα, formula (8).
    ProfileForm,
    /// f_Hβ, formula (10).
    HelixSlope,
}

/// What tolerances depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToothSizes {
    /// z.
    pub teeth: i64,
    /// m \[m\].
    pub module: f64,
    /// b \[m\].
    pub face_width: f64,
}

/// The tolerance of a deviation \[m\]: what has a sign may be off by as much to either side.
///
/// # Errors
/// When the class or the gear is outside of the standard's ranges: which number, and what it may be.
pub fn tolerance(deviation: Deviation, gear: &ToothSizes, class: i64) -> Result<f64, Diagnostic> {
    let (diameter, module, width) = (1e3 * gear.module * gear.teeth as f64, 1e3 * gear.module, 1e3 * gear.face_width);
    let outside = |what: &str, value: String, range: String| {
        Err(Diagnostic::new(format!("ISO 1328-1 has no tolerance for {what} {value}; it has them for {range}")))
    };
    if !CLASSES.contains(&class) {
        return outside("class", class.to_string(), format!("classes {} to {}", CLASSES.start(), CLASSES.end()));
    }
    if !TEETH.contains(&gear.teeth) {
        return outside("a number of teeth of", gear.teeth.to_string(), "5 to 1000 teeth".to_owned());
    }
    // Lengths have come from mm and go back to them: what was 0.5 mm must not be outside by a rounding.
    let lengths = [
        ("a reference diameter of", diameter, DIAMETER),
        ("a module of", module, MODULE),
        ("a face width of", width, FACE_WIDTH),
    ];
    for (what, value, range) in lengths {
        let slack = 1e-12 * value;
        if value < range.start() - slack || value > range.end() + slack {
            return outside(what, format!("{value:.6} mm"), format!("{} to {} mm", range.start(), range.end()));
        }
    }
    let of_class_5 = match deviation {
        Deviation::Pitch => 0.001 * diameter + 0.4 * module + 5.0,
        Deviation::ProfileSlope => 0.4 * module + 0.001 * diameter + 4.0,
        Deviation::ProfileForm => 0.55 * module + 5.0,
        Deviation::HelixSlope => 0.05 * diameter.sqrt() + 0.35 * width.sqrt() + 4.0,
    };
    // √2 to a whole power: exact doublings, and one root for odd steps.
    let step = class - 5;
    let power = libm::scalbn(1.0, i32::try_from(step.div_euclid(2)).unwrap_or(0));
    let root = if step.rem_euclid(2) == 1 { std::f64::consts::SQRT_2 } else { 1.0 };
    Ok(1e-6 * rounded(of_class_5 * power * root))
}

/// As 5.2.3 has it \[µm\]: to 1 above 10, to 0.5 from 5 on, to 0.1 below.
fn rounded(value: f64) -> f64 {
    let to = |parts: f64| (value * parts).round() / parts;
    if value > 10.0 {
        to(1.0)
    } else if value >= 5.0 {
        to(2.0)
    } else {
        to(10.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gear(teeth: i64, module: f64, face_width: f64) -> ToothSizes {
        ToothSizes { teeth, module, face_width }
    }

    #[track_caller]
    fn is(deviation: Deviation, gear: &ToothSizes, class: i64, micrometres: f64) {
        let found = tolerance(deviation, gear, class).unwrap() * 1e6;
        assert!((found - micrometres).abs() < 1e-9, "{found} is not {micrometres}");
    }

    /// Tier: worked by hand from formulas (7) and (10) with the rounding of 5.2.3; the edition of 2013 prints no tables. Module 2,
    /// 50 teeth, 20 mm: 0.8 + 0.1 + 4 = 4.9 and 0.05·10 + 0.35·√20 + 4 = 6.065 in class 5. Module 3, 40 teeth, 30 mm in class 6:
    /// 5.32·√2 = 7.524 and (0.5477 + 1.9170 + 4)·√2 = 9.143.
    #[test]
    fn tolerances_are_those_of_the_standard() {
        let one = gear(50, 2e-3, 20e-3);
        is(Deviation::ProfileSlope, &one, 5, 4.9);
        is(Deviation::HelixSlope, &one, 5, 6.0);
        let two = gear(40, 3e-3, 30e-3);
        is(Deviation::ProfileSlope, &two, 6, 7.5);
        is(Deviation::HelixSlope, &two, 6, 9.0);
        // 19 teeth, module 3, 20 mm: 5.257 and 0.3775 + 1.5652 + 4 = 5.9427, in class 7 twice that.
        let pinion = gear(19, 3e-3, 20e-3);
        is(Deviation::ProfileSlope, &pinion, 7, 11.0);
        is(Deviation::HelixSlope, &pinion, 7, 12.0);
        // Where rounding hides no digit of a coefficient: 200 teeth, module 10, 200 mm, eight times 4 + 2 + 4 and
        // 2.2361 + 4.9497 + 4 = 11.1858 in class 11.
        let large = gear(200, 10e-3, 200e-3);
        is(Deviation::ProfileSlope, &large, 11, 80.0);
        is(Deviation::HelixSlope, &large, 11, 89.0);
        // Class 1 is a quarter of class 5: 1.314 and 1.486.
        is(Deviation::ProfileSlope, &pinion, 1, 1.3);
        is(Deviation::HelixSlope, &pinion, 1, 1.5);
    }

    /// Tier: second method; what somebody else's implementation answers, written from DIN ISO 1328-1:2018, which is the edition of 2013:
    /// `flank_tolerances` of `20_code/40_backend/app/services/geometry/tolerances.py` in github.com/tkuhn39/semesterthesis, at
    /// 0279232acae01b5ea7cd232a6d174d791bb5e2cd. Its own tests print the first gear in class 5.
    #[test]
    fn tolerances_are_those_of_another_implementation() {
        // Teeth, module and face width in mm; f_Hα and f_Hβ in µm. None is half way between two steps before it is rounded: there
        // it takes powers of √2 that are exact, and that one has others.
        let rows = [
            ([50.0, 2.0, 20.0], [1.2, 3.5, 4.9, 7.0, 14.0, 39.0], [1.5, 4.3, 6.0, 8.5, 17.0, 49.0]),
            ([19.0, 3.0, 20.0], [1.3, 3.7, 5.5, 7.5, 15.0, 42.0], [1.5, 4.2, 6.0, 8.5, 17.0, 48.0]),
            ([48.0, 3.0, 18.0], [1.3, 3.8, 5.5, 7.5, 15.0, 43.0], [1.5, 4.3, 6.0, 8.5, 17.0, 49.0]),
            ([25.0, 0.5, 4.0], [1.1, 3.0, 4.2, 6.0, 12.0, 34.0], [1.2, 3.4, 4.9, 7.0, 14.0, 39.0]),
            ([31.0, 1.25, 12.5], [1.1, 3.2, 4.5, 6.5, 13.0, 36.0], [1.4, 3.9, 5.5, 8.0, 16.0, 44.0]),
            ([120.0, 8.0, 160.0], [2.0, 6.0, 8.0, 12.0, 23.0, 65.0], [2.5, 7.0, 10.0, 14.0, 28.0, 80.0]),
            ([1000.0, 10.0, 300.0], [4.5, 13.0, 18.0, 25.0, 51.0, 144.0], [3.8, 11.0, 15.0, 21.0, 43.0, 120.0]),
            ([200.0, 65.0, 1200.0], [11.0, 30.0, 43.0, 61.0, 122.0, 344.0], [5.5, 15.0, 22.0, 31.0, 62.0, 175.0]),
        ];
        for ([teeth, module, width], profile, helix) in rows {
            #[allow(clippy::cast_possible_truncation)]
            let gear = gear(teeth as i64, 1e-3 * module, 1e-3 * width);
            for (place, class) in [1, 4, 5, 6, 8, 11].into_iter().enumerate() {
                is(Deviation::ProfileSlope, &gear, class, profile[place]);
                is(Deviation::HelixSlope, &gear, class, helix[place]);
            }
        }
    }

    /// Tier: second method; f_p and f_fα by the same implementation, at c747606.
    #[test]
    fn pitch_and_form_are_those_of_another_implementation() {
        let rows = [
            ([50.0, 2.0], [1.5, 4.2, 6.0, 8.5, 17.0, 47.0], [1.5, 4.3, 6.0, 8.5, 17.0, 49.0]),
            ([19.0, 3.0], [1.6, 4.4, 6.5, 9.0, 18.0, 50.0], [1.7, 4.7, 6.5, 9.5, 19.0, 53.0]),
            ([48.0, 3.0], [1.6, 4.5, 6.5, 9.0, 18.0, 51.0], [1.7, 4.7, 6.5, 9.5, 19.0, 53.0]),
            ([31.0, 1.25], [1.4, 3.9, 5.5, 8.0, 16.0, 44.0], [1.4, 4.0, 5.5, 8.0, 16.0, 46.0]),
            ([120.0, 9.0], [2.4, 7.0, 9.5, 14.0, 27.0, 77.0], [2.5, 7.0, 10.0, 14.0, 28.0, 80.0]),
            ([990.0, 11.0], [5.0, 14.0, 20.0, 29.0, 57.0, 162.0], [2.8, 8.0, 11.0, 16.0, 31.0, 88.0]),
            ([200.0, 65.0], [11.0, 31.0, 44.0, 62.0, 124.0, 352.0], [10.0, 29.0, 41.0, 58.0, 115.0, 326.0]),
        ];
        for ([teeth, module], pitch, form) in rows {
            #[allow(clippy::cast_possible_truncation)]
            let gear = gear(teeth as i64, 1e-3 * module, 0.1);
            for (place, class) in [1, 4, 5, 6, 8, 11].into_iter().enumerate() {
                is(Deviation::Pitch, &gear, class, pitch[place]);
                is(Deviation::ProfileForm, &gear, class, form[place]);
            }
        }
    }

    /// Tier: invariant; two classes double a tolerance, but for rounding.
    #[test]
    fn two_classes_double_a_tolerance() {
        let gear = gear(60, 5e-3, 80e-3);
        for deviation in [Deviation::Pitch, Deviation::ProfileSlope, Deviation::ProfileForm, Deviation::HelixSlope] {
            for class in 1..=9 {
                let [one, two] = [class, class + 2].map(|class| 1e6 * tolerance(deviation, &gear, class).unwrap());
                let half_step = |value: f64| {
                    if value > 10.0 {
                        0.5
                    } else if value >= 5.0 {
                        0.25
                    } else {
                        0.05
                    }
                };
                let off = (two - 2.0 * one).abs();
                assert!(off <= half_step(two) + 2.0 * half_step(one) + 1e-9, "{class}: {one} {two}");
            }
        }
    }

    #[test]
    fn what_is_outside_of_the_standard_is_refused_with_its_range() {
        let refused = |gear: &ToothSizes, class| tolerance(Deviation::HelixSlope, gear, class).unwrap_err().message;
        let plain = gear(40, 3e-3, 30e-3);
        assert!(refused(&plain, 12).contains("class 12") && refused(&plain, 0).contains("classes 1 to 11"));
        assert!(refused(&gear(40, 3e-3, 3e-3), 6).contains("face width of 3.000000 mm; it has them for 4 to 1200 mm"));
        assert!(refused(&gear(40, 0.4e-3, 5e-3), 6).contains("module of"));
        assert!(refused(&gear(4, 3e-3, 5e-3), 6).contains("teeth of 4"));
        // On the border, whatever rounding made of it.
        for module in [0.5e-3, 70e-3] {
            assert!(tolerance(Deviation::ProfileSlope, &gear(20, module, 4e-3), 11).is_ok(), "{module}");
        }
    }
}
