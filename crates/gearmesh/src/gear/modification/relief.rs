//! What tip and root relief share: amount, start, curve, and the resolved ramp.
//!
//! Sources: ISO 21771-1 for the terms; the article `energy_ga` for the formulas of Δ_max and L_a and for the phrase that
//! allows three readings of where L_a counts from. Must not know: compliance, load.

use super::curve::Curve;
use super::flank::Flank;
use super::{MOST_AMOUNT, Modification};
use crate::gear::geometry::GearPair;
use declare::error::Diagnostic;
use declare::parameter::{Choice, Field};
use declare::record::Record;
use declare::units;

pub const AMOUNT: Field =
    Field::quantity("amount", units::LENGTH, 0.0, MOST_AMOUNT, "Depth at the end of the relief, normal to the flank.")
        .range()
        .optional();

pub const ISO_AMOUNT: Field = Field::group(
    "iso_amount",
    &[
        Field::number("application_factor", 0.1, 10.0, "K_A.").default("1"),
        Field::quantity("tangential_load", units::FORCE, 0.0, 1e9, "F_t: nominal tangential load."),
        Field::quantity("face_width", units::LENGTH, 1e-4, 10.0, "b; the narrower gear's when left out.").optional(),
        Field::number("contact_ratio", 1.0, 6.0, "ε_α; the pair's when left out.").optional(),
        Field::quantity("mesh_stiffness", units::SPECIFIC_STIFFNESS, 1e6, 1e13, "c_γ: mesh stiffness per face width."),
    ],
    "Instead of `amount`: Δ_max = K_A F_t / (b ε_α c_γ).",
)
.optional();

pub const LENGTH: Field = Field::quantity(
    "length",
    units::LENGTH,
    0.0,
    1.0,
    "L: roll length of the relief along the line of action; a relief of no length removes nothing.",
)
.range()
.optional();

pub const FRACTION: Field = Field::number(
    "fraction",
    0.0,
    10.0,
    "Instead of `length`: length over p_b(ε_α − 1); 1 is long relief, 0.5 short relief.",
)
.range()
.optional();

pub const START_ROLL_ANGLE: Field = Field::quantity(
    "start_roll_angle",
    units::ANGLE,
    0.0,
    10.0,
    "Instead of `length`: roll angle where the relief starts.",
)
.range()
.optional();

pub const START_DIAMETER: Field = Field::quantity(
    "start_diameter",
    units::LENGTH,
    1e-4,
    100.0,
    "Instead of `length`: diameter at which the relief starts.",
)
.range()
.optional();

const SINGLE_ZONE: Choice = Choice {
    name: "single_zone",
    summary: "it starts that far inside the single-contact zone, measured from the zone's end, and grows to the flank's end",
};
const ZONE_END: Choice = Choice {
    name: "zone_end",
    summary: "it starts at the end of the single-contact zone, grows over that length and then stays",
};

pub const COUNTED_FROM_TIP: Field = Field::choice(
    "counted_from",
    &[
        Choice { name: "tip", summary: "the relief is the last part of the flank, of that length" },
        SINGLE_ZONE,
        ZONE_END,
    ],
    "Where `length` or `fraction` counts from.",
)
.default("tip");

pub const COUNTED_FROM_ROOT: Field = Field::choice(
    "counted_from",
    &[
        Choice { name: "root", summary: "the relief is the first part of the active flank, of that length" },
        SINGLE_ZONE,
        ZONE_END,
    ],
    "Where `length` or `fraction` counts from.",
)
.default("root");

const STARTS: [&str; 4] = [LENGTH.name, FRACTION.name, START_ROLL_ANGLE.name, START_DIAMETER.name];

/// A relief shorter than this share of the base pitch counts as no relief.
const SHORTEST: f64 = 1e-9;

/// Which end of the flank the relief runs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    Tip,
    Root,
}

/// A ramp along the profile: nothing before its start, the whole amount from its end on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ramp {
    amount: f64,
    curve: Curve,
    /// Roll angles.
    start: f64,
    end: f64,
    /// d t / d roll; 0 for a ramp of no length.
    rate: f64,
    base_radius: f64,
}

/// Exactly one amount, exactly one start, a curve with what it needs.
pub(super) fn check(record: &Record) -> Result<(), Diagnostic> {
    exactly_one(record, &[AMOUNT.name, ISO_AMOUNT.name])?;
    let start = exactly_one(record, &STARTS)?;
    let counted_from = record.choice("counted_from");
    if [START_ROLL_ANGLE.name, START_DIAMETER.name].contains(&start) && !["tip", "root"].contains(&counted_from) {
        let message = format!("`counted_from: {counted_from}` goes with `length` or `fraction`, not with `{start}`");
        return Err(Diagnostic::new(message).at(record.place_of("counted_from")));
    }
    Curve::check(record)
}

pub(super) fn exactly_one<'a>(record: &Record, names: &[&'a str]) -> Result<&'a str, Diagnostic> {
    let mut given = names.iter().filter(|name| record.entry(name).is_some());
    let (first, second) = (given.next(), given.next());
    let list = || names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    match (first, second) {
        (Some(only), None) => Ok(only),
        (None, _) => {
            Err(Diagnostic::new(format!("exactly one of {} is needed, and there is none", list())).at(record.place))
        }
        (Some(one), Some(other)) => {
            let message = format!("exactly one of {} is needed, not both `{one}` and `{other}`", list());
            Err(Diagnostic::new(message).at(record.place_of(other)))
        }
    }
}

fn amount(record: &Record, pair: &GearPair) -> f64 {
    if let Some(amount) = record.maybe_quantity(AMOUNT.name) {
        return amount;
    }
    let iso = record.group(ISO_AMOUNT.name);
    let common = pair.pinion.specification.face_width.min(pair.gear.specification.face_width);
    let width = iso.maybe_quantity("face_width").unwrap_or(common);
    let contact_ratio = iso.maybe_number("contact_ratio").unwrap_or(pair.contact_ratio);
    let load = iso.number("application_factor") * iso.quantity("tangential_load") / width;
    load / (contact_ratio * iso.quantity("mesh_stiffness"))
}

impl Ramp {
    pub(super) fn build(record: &Record, pair: &GearPair, flank: &Flank, end: End) -> Result<Self, Diagnostic> {
        let (last, first, outward) = match end {
            End::Tip => (flank.tip_roll, flank.root_roll, 1.0),
            End::Root => (flank.root_roll, flank.tip_roll, -1.0),
        };
        let length = record.maybe_quantity(LENGTH.name).map(|length| (LENGTH.name, length));
        let fraction = record.maybe_number(FRACTION.name);
        let length = length.or_else(|| fraction.map(|share| (FRACTION.name, share * flank.long_relief)));
        // Distances from the flank's end, along the line of action: where the relief starts and where it is complete.
        let (name, from, to) = if let Some((name, length)) = length {
            match record.choice("counted_from") {
                "single_zone" => (name, flank.outer_zone + length, 0.0),
                "zone_end" => (name, flank.outer_zone, flank.outer_zone - length),
                _ => (name, length, 0.0),
            }
        } else {
            let (name, roll) = start_roll(record, flank)?;
            (name, (last - roll) * outward * flank.base_radius, 0.0)
        };
        let longest = flank.length();
        if !(from >= 0.0 && from <= longest * (1.0 + 1e-12)) {
            let (lower, upper) = (first.min(last), first.max(last));
            return Err(Diagnostic::new(format!(
                "the relief starts {:.6} mm from the end of the flank; the active flank is {:.6} mm long (roll angles \
                 {:.6} to {:.6} deg, diameters {:.6} to {:.6} mm)",
                from * 1e3,
                longest * 1e3,
                lower.to_degrees(),
                upper.to_degrees(),
                flank.diameter(lower) * 1e3,
                flank.diameter(upper) * 1e3,
            ))
            .at(record.place_of(name)));
        }
        let span = (from - to) / flank.base_radius;
        Ok(Self {
            amount: amount(record, pair),
            curve: Curve::read(record),
            start: last - outward * from / flank.base_radius,
            end: last - outward * to / flank.base_radius,
            // The limit of ever shorter reliefs takes nothing away; a step would only unload a single point.
            rate: if span * flank.base_radius > SHORTEST * flank.base_pitch { outward / span } else { 0.0 },
            base_radius: flank.base_radius,
        })
    }
}

fn start_roll(record: &Record, flank: &Flank) -> Result<(&'static str, f64), Diagnostic> {
    if let Some(roll) = record.maybe_quantity(START_ROLL_ANGLE.name) {
        return Ok((START_ROLL_ANGLE.name, roll));
    }
    let diameter = record.quantity(START_DIAMETER.name);
    let roll = flank.roll_at_diameter(diameter).ok_or_else(|| {
        let (given, base) = (diameter * 1e3, flank.base_radius * 2e3);
        let message = format!("the start diameter {given:.6} mm is below the base circle, {base:.6} mm");
        Diagnostic::new(message).at(record.place_of(START_DIAMETER.name))
    })?;
    Ok((START_DIAMETER.name, roll))
}

impl Modification for Ramp {
    fn depth(&self, roll: f64) -> f64 {
        let t = (roll - self.start) * self.rate;
        if t <= 0.0 { 0.0 } else { self.amount * self.curve.value(t) }
    }

    fn profile_breaks(&self) -> [Option<f64>; 2] {
        [Some(self.start), Some(self.end)]
    }

    fn varies_along_profile(&self) -> bool {
        self.amount != 0.0 && self.rate != 0.0
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        let radius = self.base_radius;
        vec![
            ("amount", self.amount),
            ("length", (self.end - self.start).abs() * radius),
            ("start_roll_angle", self.start),
            ("start_diameter", 2.0 * radius * (1.0 + self.start * self.start).sqrt()),
        ]
    }
}
