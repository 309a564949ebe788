//! Distributions of varied fields: what a study states, with classes of tolerances as lengths, held to the ranges of fields.
//!
//! Must not know: how shares are drawn.

use crate::stage::cases::Deviations;
use crate::stage::rows::{Column, follows_nothing};
use declare::error::Diagnostic;
use declare::number::significant;
use declare::record::varied::{Form, Spread, Values, Varied, Within};
use declare::record::{Record, Value};
use declare::units::{in_unit, showing};
use gearmesh::gear::iso1328::{Deviation, ToothSizes, tolerance};
use gearmesh::numeric::distribution::Distribution;

/// What a normal distribution may have outside of the range of its field, where nothing is cut off by the study: so little
/// that no sample meets it.
const MOST_OUTSIDE: f64 = 1e-9;
/// Standard deviations from the middle to either limit of a tolerance.
const TO_LIMIT: f64 = 3.0;

/// The distribution of a column; none of one that has values.
///
/// # Errors
/// One that leaves the range of its field, or a class of what has no tolerance.
pub fn of_column(column: &Column, varied: &Varied) -> Result<Option<Distribution>, Diagnostic> {
    let axis = &column.axis;
    let found = match &axis.values {
        Values::Each(_) => return Ok(None),
        Values::Between(..) if axis.multiple.is_some() => {
            let message = format!("`{}` takes whole numbers, which no tolerance has", axis.name);
            return Err(Diagnostic::new(message).at(axis.values_place).help("write its `values: […]`"));
        }
        Values::Between(low, high) => Distribution::Uniform { low: *low, high: *high },
        Values::Spread(spread) => of_spread(spread, column, varied)?,
        Values::Follows(_) => return Err(follows_nothing(column)),
    };
    held(found, column).map(Some)
}

fn of_spread(spread: &Spread, column: &Column, varied: &Varied) -> Result<Distribution, Diagnostic> {
    let Spread { form, about, ends } = *spread;
    let [low, high] = [ends[0].unwrap_or(f64::NEG_INFINITY), ends[1].unwrap_or(f64::INFINITY)];
    Ok(match form {
        Form::Within(half, within) => tolerated(about, half, within),
        Form::Class(class, within) => {
            let half = of_class(class, column, varied).map_err(|wrong| wrong.at(column.axis.values_place))?;
            tolerated(about, half, within)
        }
        Form::Normal(deviation) => Distribution::Normal { mean: about, deviation, low, high },
        Form::Triangular => Distribution::Triangular { low, mode: about, high },
    })
}

fn tolerated(about: f64, half: f64, within: Within) -> Distribution {
    let (low, high) = (about - half, about + half);
    match within {
        Within::Uniform => Distribution::Uniform { low, high },
        Within::Triangular => Distribution::Triangular { low, mode: about, high },
        Within::Normal => Distribution::Normal { mean: about, deviation: half / TO_LIMIT, low, high },
    }
}

/// Refuses what leaves the range of the field; a normal distribution of which next to nothing does is cut off there.
fn held(distribution: Distribution, column: &Column) -> Result<Distribution, Diagnostic> {
    let axis = &column.axis;
    let (least, most) = axis.range;
    let shown = |si: f64| format!("{} {}", significant(in_unit(si, &axis.unit), 6), axis.unit);
    let refused =
        |message: String, help: &str| Err(Diagnostic::new(message).at(axis.values_place).help(help.to_owned()));
    let (low, high) = distribution.range();
    let field = || format!("`{}` takes {} to {}", axis.path, shown(least).trim(), shown(most).trim());
    let Distribution::Normal { mean, deviation, .. } = distribution else {
        if low >= least && high <= most {
            return Ok(distribution);
        }
        let message =
            format!("`{}` would lie between {} and {}; {}", axis.name, shown(low).trim(), shown(high).trim(), field());
        return refused(message, "take a narrower distribution, or another middle");
    };
    let (low, high) = (low.max(least), high.min(most));
    let cut = Distribution::Normal { mean, deviation, low, high };
    let lost = 1.0 - cut.kept() / distribution.kept();
    // Of nothing at all it is NaN.
    if low >= high || lost.is_nan() || lost > MOST_OUTSIDE {
        let message = format!(
            "{:.3} % of the values of `{}` would be outside of its field: {}",
            100.0 * if lost.is_nan() { 1.0 } else { lost },
            axis.name,
            field()
        );
        return refused(message, "cut it off with `from` and `to`, or take a smaller standard deviation");
    }
    if cut.kept() < 1e-6 {
        let message = format!("next to nothing of the distribution of `{}` lies between its ends", axis.name);
        return refused(message, "its ends are far from its mean");
    }
    Ok(cut)
}

/// How far a class lets the slope be off that a column is of \[m\].
fn of_class(class: i64, column: &Column, varied: &Varied) -> Result<f64, Diagnostic> {
    let record = &varied.stages[column.axis.stage].filled;
    let Some((slope, gear)) = slope_of(column, record) else {
        return Err(Diagnostic::new(format!(
            "`{}` has no tolerance in ISO 1328-1 that is known here",
            column.axis.path
        ))
        .help(
            "a class is for the amount of a `profile_slope` or a `helix_slope` of one gear, or for such a deviation in \
                 the stage that loads the pair",
        ));
    };
    let mut pairs = varied.nearby.iter().filter(|(kind, _)| *kind == "geometry").map(|(_, record)| record);
    let (Some(pair), None) = (pairs.next(), pairs.next()) else {
        return Err(Diagnostic::new("a class needs the one pair of gears that it is of"));
    };
    let sizes = sizes(pair, gear)
        .ok_or_else(|| Diagnostic::new("a class needs module, number of teeth and face width of the gear"))?;
    tolerance(slope, &sizes, class)
}

/// Which slope of which gear a field is.
fn slope_of(column: &Column, record: &Record) -> Option<(Deviation, &'static str)> {
    let steps = &column.axis.slot.0;
    let (field, _) = record.fields.get(*steps.first()?)?;
    let names = Deviations::NAMES;
    let of_pair = [
        (names.pinion_profile_slope, Deviation::ProfileSlope, "pinion"),
        (names.gear_profile_slope, Deviation::ProfileSlope, "gear"),
        (names.pinion_helix_slope, Deviation::HelixSlope, "pinion"),
        (names.gear_helix_slope, Deviation::HelixSlope, "gear"),
    ];
    if let Some((_, slope, gear)) = of_pair.iter().find(|(name, ..)| name == field) {
        return Some((*slope, gear));
    }
    // The member that has the field, and which gear it is of.
    let member = declare::record::varied::Slot(steps[..steps.len() - 1].to_vec());
    let Value::Member(family, record) = &member.entry(record)?.value else { return None };
    let slope = match *family {
        "profile_slope" => Deviation::ProfileSlope,
        "helix_slope" => Deviation::HelixSlope,
        _ => return None,
    };
    match record.entry("gear").map(|entry| &entry.value) {
        Some(Value::Choice("pinion")) => Some((slope, "pinion")),
        Some(Value::Choice("gear")) => Some((slope, "gear")),
        _ => None,
    }
}

fn sizes(pair: &Record, gear: &str) -> Option<ToothSizes> {
    let quantity = |record: &Record, field: &str| match record.entry(field)?.value {
        Value::Quantity(value) => Some(value),
        _ => None,
    };
    let Value::Group(of_gear) = &pair.entry(gear)?.value else { return None };
    let Value::Integer(teeth) = of_gear.entry("teeth")?.value else { return None };
    Some(ToothSizes { teeth, module: quantity(pair, "module")?, face_width: quantity(of_gear, "face_width")? })
}

/// What a column's distribution is, in words and in its unit.
pub fn described(column: &Column, distribution: &Distribution) -> String {
    let show = showing(&column.axis.unit);
    let shown = |si: f64| significant(show(si), 6);
    let unit = &column.axis.unit;
    let cut = |low: f64, high: f64| match (low.is_finite(), high.is_finite()) {
        (false, false) => String::new(),
        (true, false) => format!(", not below {}", shown(low)),
        (false, true) => format!(", not above {}", shown(high)),
        (true, true) => format!(", {} to {}", shown(low), shown(high)),
    };
    let text = match *distribution {
        Distribution::Uniform { low, high } => format!("uniform, {} to {}", shown(low), shown(high)),
        Distribution::Triangular { low, mode, high } => {
            format!("triangular, {} to {}, most at {}", shown(low), shown(high), shown(mode))
        }
        Distribution::Normal { mean, deviation, low, high } => {
            format!("normal, {} and {}{}", shown(mean), shown(deviation), cut(low, high))
        }
    };
    format!("{text} {unit}").trim().to_owned()
}
