//! Values of fields by formula, from the numbers of the study around another quantity.
//!
//! Must not know: words.

use std::f64::consts::TAU;

use super::{OF_FORCE, OF_LINE_LOAD, OF_POWER};
use declare::number::significant;
use declare::units::{
    ANGLE, ANGULAR_SPEED, Dimension, FORCE, LENGTH, POWER, Quantity, SPEED as LINEAR_SPEED, STIFFNESS as LINE_LOAD,
    TORQUE, in_unit, parse_quantity,
};
use studygraph::program::{Around, Derived};

/// Rules from quantities of other kinds to fields.
pub static DERIVED: &[Derived] = &[
    Derived { field: "torque", from: POWER, rule: OF_POWER, remedy: Some(of_power) },
    Derived { field: "torque", from: FORCE, rule: OF_FORCE, remedy: Some(of_force) },
    Derived { field: "torque", from: LINE_LOAD, rule: OF_LINE_LOAD, remedy: None },
    Derived {
        field: "speed",
        from: LINEAR_SPEED,
        rule: "n = v/(pi d1), of the speed v at the reference circle, d1 = m z1",
        remedy: None,
    },
    Derived {
        field: "length",
        from: ANGLE,
        rule: "a length along the path of contact is the base radius times the roll angle in radians; a field \
               `start_roll_angle` states where a relief starts",
        remedy: None,
    },
];

/// Speeds of the pinion as users call them beside a power.
const SPEEDS: [&str; 8] = ["speed", "n", "rpm", "n1", "rotational_speed", "input_speed", "pinion_speed", "Drehzahl"];
/// Fields with the speed of the pinion.
const OF_STAGES: [&[&str]; 2] = [&["speed"], &["friction", "speed"]];

/// The number of a quantity, if it has this dimension.
fn si(quantity: Option<Quantity>, dimension: Dimension) -> Option<f64> {
    quantity.filter(|read| read.dimension == dimension).map(|read| read.value)
}

/// A number that reads back, with as many digits as a user would write.
fn shown(si: f64, unit: &str) -> String {
    let value = in_unit(si, unit);
    format!("{} {unit}", format!("{value:.6e}").parse().unwrap_or(value))
}

/// The number of the word, if it is no interval: of a formula that is not linear, and of fields that take no interval.
fn single(around: &Around) -> Option<Quantity> {
    around.value.filter(|_| around.half == 0.0)
}

/// A number, or the interval about it, as `show` writes the middle and half the width.
fn with_half(around: &Around, middle: f64, half: f64, show: impl Fn(f64) -> String) -> String {
    let half = if around.half > 0.0 { format!(" ± {}", show(half)) } else { String::new() };
    format!("write `{}{half}`", show(middle))
}

fn times(around: &Around, factor: f64) -> Option<String> {
    let length = si(around.value, LENGTH)?;
    Some(with_half(around, factor * length, factor * around.half, |si| shown(si, "mm")))
}

pub fn half_of(around: &Around) -> Option<String> {
    times(around, 0.5)
}

/// T = P/ω, of a speed beside it.
pub fn of_power(around: &Around) -> Option<String> {
    let power = si(single(around), POWER)?;
    let beside = SPEEDS.iter().find_map(|name| {
        let read = (around.beside)(name)?;
        match read.dimension {
            ANGULAR_SPEED => Some(read.value),
            // A speed without a unit is in turns per minute where its name says so.
            _ if !read.has_unit && *name == "rpm" => Some(read.value * TAU / 60.0),
            _ => None,
        }
    });
    let anywhere = || OF_STAGES.iter().find_map(|path| si((around.anywhere)(path), ANGULAR_SPEED));
    let speed = beside.or_else(anywhere)?;
    let torque = (speed > 0.0).then(|| power / speed)?;
    let (power, speed) = (significant(in_unit(power, "kW"), 6), significant(in_unit(speed, "rpm"), 6));
    Some(format!("{power} kW at {speed} rpm of the pinion: write `torque: {}`", shown(torque, "N m")))
}

/// The tip shortening in modules, -k.
pub fn of_tip_alteration(around: &Around) -> Option<String> {
    let read = around.value?;
    let unit = if read.dimension == LENGTH { si((around.anywhere)(&["module"]), LENGTH)? } else { 1.0 };
    Some(with_half(around, -read.value / unit, around.half / unit, |factor| significant(factor, 6)))
}

/// T = F m z1/2.
pub fn of_force(around: &Around) -> Option<String> {
    let force = si(single(around), FORCE)?;
    let module = si((around.anywhere)(&["module"]), LENGTH)?;
    let teeth = (around.anywhere)(&["pinion", "teeth"])?.value;
    let torque = (teeth > 0.0).then_some(0.5 * force * module * teeth)?;
    Some(format!("with d1 = {} write `torque: {}`", shown(module * teeth, "mm"), shown(torque, "N m")))
}

pub fn twice(around: &Around) -> Option<String> {
    times(around, 2.0)
}

pub fn of_gear_torque(around: &Around) -> Option<String> {
    let torque = si(single(around), TORQUE)?;
    let teeth = |gear: &str| Some((around.anywhere)(&[gear, "teeth"])?.value).filter(|teeth| *teeth > 0.0);
    let (pinion, gear) = (teeth("pinion")?, teeth("gear")?);
    Some(format!("with {pinion} and {gear} teeth write `torque: {}`", shown(torque * pinion / gear, "N m")))
}

/// Of a plain number, or one per inch.
pub fn of_diametral_pitch(around: &Around) -> Option<String> {
    let read = single(around).filter(|read| read.value > 0.0)?;
    let inch = parse_quantity("25.4 mm").ok()?.value;
    let module = if read.has_unit { None } else { Some(inch / read.value) };
    Some(format!("write `module: {}`", shown(module?, "mm")))
}
