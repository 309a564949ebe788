//! Units that no study has: what each comes to in one that studies have, for messages.
//!
//! Inches and pounds, horsepower, turns per minute, symbols without the sign of a power, hardness. Conversion factors are those
//! of NIST SP 811. Must not know: which field of a study a quantity belongs to.

use super::{Dimension, parse_quantity, parse_unit, split_quantity};

/// What a foreign unit comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ForeignUnit {
    /// So much of a unit that studies have.
    Of(f64, &'static str),
    /// Nothing that has a unit: why.
    None(&'static str),
}

const INCH_POUND: f64 = 0.112_984_829_027_616_7;
const FOOT_POUND: f64 = 1.355_817_948_331_400_4;
const ROCKWELL: &str = "Rockwell hardness has no unit and no formula to other scales; where a field takes Brinell hardness, \
                        convert by the tables of ISO 18265 and write the plain number";
const VICKERS: &str = "Vickers hardness has no unit; where a field takes Brinell hardness, convert by the tables of ISO 18265 and \
                       write the plain number";
const DIAMETRAL_PITCH: &str =
    "a diametral pitch P is stated as the module m = 25.4 mm / P, such as `module: 3.175 mm` for P = 8";
const GRAD: &str =
    "for degrees, `Grad` in German, write `deg`; the grad of surveyors, a hundredth of a right angle, is 0.9 deg";
const BRINELL: &str = "Brinell hardness has no unit: where a field takes it, write the plain number";

/// Words of units in the order of the alphabet: in small letters where these say the same.
const FOREIGN: &[(&str, ForeignUnit)] = &[
    ("in", ForeignUnit::Of(25.4, "mm")),
    ("inch", ForeignUnit::Of(25.4, "mm")),
    ("inches", ForeignUnit::Of(25.4, "mm")),
    ("\"", ForeignUnit::Of(25.4, "mm")),
    ("ft", ForeignUnit::Of(0.3048, "m")),
    ("foot", ForeignUnit::Of(0.3048, "m")),
    ("feet", ForeignUnit::Of(0.3048, "m")),
    ("mil", ForeignUnit::Of(25.4, "um")),
    ("mils", ForeignUnit::Of(25.4, "um")),
    ("thou", ForeignUnit::Of(25.4, "um")),
    ("dm", ForeignUnit::Of(0.1, "m")),
    ("micron", ForeignUnit::Of(1.0, "um")),
    ("microns", ForeignUnit::Of(1.0, "um")),
    ("micrometer", ForeignUnit::Of(1.0, "um")),
    ("micrometre", ForeignUnit::Of(1.0, "um")),
    ("millimeter", ForeignUnit::Of(1.0, "mm")),
    ("millimetre", ForeignUnit::Of(1.0, "mm")),
    ("degree", ForeignUnit::Of(1.0, "deg")),
    ("degrees", ForeignUnit::Of(1.0, "deg")),
    ("radian", ForeignUnit::Of(1.0, "rad")),
    ("radians", ForeignUnit::Of(1.0, "rad")),
    ("gon", ForeignUnit::Of(0.9, "deg")),
    ("arcmin", ForeignUnit::Of(1.0 / 60.0, "deg")),
    ("arcsec", ForeignUnit::Of(1.0 / 3600.0, "deg")),
    ("'", ForeignUnit::Of(1.0 / 60.0, "deg")),
    ("percent", ForeignUnit::Of(1.0, "%")),
    ("newton", ForeignUnit::Of(1.0, "N")),
    ("lbf", ForeignUnit::Of(4.448_221_615_260_5, "N")),
    ("lb", ForeignUnit::Of(4.448_221_615_260_5, "N")),
    ("lbs", ForeignUnit::Of(4.448_221_615_260_5, "N")),
    ("kgf", ForeignUnit::Of(9.806_65, "N")),
    ("kp", ForeignUnit::Of(9.806_65, "N")),
    ("daN", ForeignUnit::Of(10.0, "N")),
    ("in lb", ForeignUnit::Of(INCH_POUND, "N m")),
    ("in lbf", ForeignUnit::Of(INCH_POUND, "N m")),
    ("in lbs", ForeignUnit::Of(INCH_POUND, "N m")),
    ("ft lb", ForeignUnit::Of(FOOT_POUND, "N m")),
    ("ft lbf", ForeignUnit::Of(FOOT_POUND, "N m")),
    ("ft lbs", ForeignUnit::Of(FOOT_POUND, "N m")),
    ("kgf m", ForeignUnit::Of(9.806_65, "N m")),
    ("kgm", ForeignUnit::Of(9.806_65, "N m")),
    ("Ncm", ForeignUnit::Of(0.01, "N m")),
    ("psi", ForeignUnit::Of(0.006_894_757_293_168_36, "MPa")),
    ("ksi", ForeignUnit::Of(6.894_757_293_168_36, "MPa")),
    ("msi", ForeignUnit::Of(6.894_757_293_168_36, "GPa")),
    ("bar", ForeignUnit::Of(0.1, "MPa")),
    ("hPa", ForeignUnit::Of(100.0, "Pa")),
    ("hp", ForeignUnit::Of(0.745_699_871_582_270_2, "kW")),
    ("bhp", ForeignUnit::Of(0.745_699_871_582_270_2, "kW")),
    ("PS", ForeignUnit::Of(0.735_498_75, "kW")),
    ("CV", ForeignUnit::Of(0.735_498_75, "kW")),
    ("watt", ForeignUnit::Of(1.0, "W")),
    ("MW", ForeignUnit::Of(1000.0, "kW")),
    ("1/min", ForeignUnit::Of(1.0, "rpm")),
    ("min^-1", ForeignUnit::Of(1.0, "rpm")),
    ("min-1", ForeignUnit::Of(1.0, "rpm")),
    ("min⁻¹", ForeignUnit::Of(1.0, "rpm")),
    ("rev/min", ForeignUnit::Of(1.0, "rpm")),
    ("r/min", ForeignUnit::Of(1.0, "rpm")),
    ("u/min", ForeignUnit::Of(1.0, "rpm")),
    ("rev/s", ForeignUnit::Of(60.0, "rpm")),
    ("rps", ForeignUnit::Of(60.0, "rpm")),
    ("hz", ForeignUnit::Of(60.0, "rpm")),
    ("min", ForeignUnit::Of(60.0, "s")),
    ("h", ForeignUnit::Of(3600.0, "s")),
    ("g/cm^3", ForeignUnit::Of(1000.0, "kg/m^3")),
    ("g/cm3", ForeignUnit::Of(1000.0, "kg/m^3")),
    ("g/cm³", ForeignUnit::Of(1000.0, "kg/m^3")),
    ("lb/in^3", ForeignUnit::Of(27_679.904_71, "kg/m^3")),
    ("lb/in3", ForeignUnit::Of(27_679.904_71, "kg/m^3")),
    ("cst", ForeignUnit::Of(1.0, "mm^2/s")),
    ("cp", ForeignUnit::Of(1.0, "mPa s")),
    ("1/in", ForeignUnit::None(DIAMETRAL_PITCH)),
    ("grad", ForeignUnit::None(GRAD)),
    ("dp", ForeignUnit::None(DIAMETRAL_PITCH)),
    ("hrc", ForeignUnit::None(ROCKWELL)),
    ("hra", ForeignUnit::None(ROCKWELL)),
    ("hrb", ForeignUnit::None(ROCKWELL)),
    ("hv", ForeignUnit::None(VICKERS)),
    ("hv10", ForeignUnit::None(VICKERS)),
    ("hv1", ForeignUnit::None(VICKERS)),
    ("hb", ForeignUnit::None(BRINELL)),
    ("hbw", ForeignUnit::None(BRINELL)),
];

/// What a unit comes to that [`parse_unit`] does not know; none where it is not known here either.
#[must_use]
pub fn foreign_unit(unit: &str) -> Option<ForeignUnit> {
    let small = unit.trim().to_lowercase();
    let found = |name: &str| FOREIGN.iter().find(|(word, _)| *word == name).map(|(_, of)| *of);
    // `mPa` and `MW` differ by their case alone: what a study has is never foreign.
    if parse_unit(unit).is_ok() {
        return None;
    }
    let mut words: Vec<&str> = small.split([' ', '*', '·', '-', '.']).filter(|word| !word.is_empty()).collect();
    words.sort_unstable();
    found(unit.trim()).or_else(|| found(&small.replace(' ', ""))).or_else(|| found(&words.join(" ")))
}

/// A quantity in a foreign unit in SI, with its dimension.
#[must_use]
pub fn foreign_quantity(text: &str) -> Option<(f64, Dimension)> {
    let (number, unit) = split_quantity(text);
    let Some(ForeignUnit::Of(factor, own)) = foreign_unit(unit) else { return None };
    let value = number.parse::<f64>().ok()? * factor;
    let read = parse_quantity(&format!("{value:e} {own}")).ok()?;
    Some((read.value, read.dimension))
}

/// The unit with the sign of a power before every digit that follows a symbol, `mm^2` for `mm2`; none where that is no unit.
#[must_use]
pub fn with_powers(unit: &str) -> Option<String> {
    let mut text = String::new();
    let mut before = ' ';
    for letter in unit.trim().chars() {
        if letter.is_ascii_digit() && before.is_alphabetic() {
            text.push('^');
        }
        text.push(letter);
        before = letter;
    }
    (text != unit.trim() && parse_unit(&text).is_ok()).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::super::{LENGTH, POWER, STRESS, TORQUE};
    use super::*;

    /// Tier: values of NIST SP 811.
    #[test]
    fn foreign_units_come_to_what_the_tables_say() {
        for (text, si, dimension) in [
            ("1 in", 0.0254, LENGTH),
            ("100 lbf in", 11.298_482_9, TORQUE),
            ("100 in-lb", 11.298_482_9, TORQUE),
            ("10 lbf*ft", 13.558_179_5, TORQUE),
            ("30e6 psi", 206.842_719e9, STRESS),
            ("10 hp", 7_456.998_7, POWER),
        ] {
            let (found, of) = foreign_quantity(text).unwrap();
            assert!((found / si - 1.0).abs() < 1e-8 && of == dimension, "{text}: {found}");
        }
        for known in ["mm", "N m", "MPa", "mPa", "rpm", "1/um^2", "furlong", "mW", "ps"] {
            assert_eq!(foreign_unit(known), None, "{known}");
        }
        for (_, of) in FOREIGN {
            if let ForeignUnit::Of(_, own) = of {
                assert!(parse_unit(own).is_ok(), "{own}");
            }
        }
    }

    #[test]
    fn digits_behind_symbols_are_powers() {
        for (unit, meant) in [("mm2", Some("mm^2")), ("N/mm2", Some("N/mm^2")), ("kg/m3", Some("kg/m^3"))] {
            assert_eq!(with_powers(unit).as_deref(), meant);
        }
        assert_eq!(with_powers("mm"), None);
        assert_eq!(with_powers("HV10"), None);
    }
}
