//! What tip and root relief share: amount, start, curve, and the resolved ramp.
//!
//! Sources: ISO 21771-1 for the terms; the article `energy_ga` for the formulas of Δ_max and L_a and for the phrase that
//! allows three readings of where L_a counts from. Must not know: compliance, load.

use super::curve::{Curve, Growth};
use super::flank::Flank;
use super::{MOST_AMOUNT, Modification};
use crate::gear::geometry::GearPair;
use crate::gear::geometry::error::shown::decimals;
use crate::numeric::quadratic::Quadratic;
use declare::error::Diagnostic;
use declare::units::{ANGLE, FORCE, LENGTH, RATIO, SPECIFIC_STIFFNESS};
use declare::{Alternatives, Declared, Words};

/// How deep a relief is at its end.
#[derive(Clone, Debug, PartialEq, Alternatives)]
pub enum Amount {
    /// Depth at the end of the relief, normal to the flank.
    #[declared(name = "amount", dimension = LENGTH, minimum = 0.0, maximum = MOST_AMOUNT, range, example = "12 um")]
    Depth(f64),
    /// Instead of `amount`: Δ_max = K_A F_t / (b ε_α c_γ).
    #[declared(name = "iso_amount")]
    Iso(IsoAmount),
}

/// Δ_max = K_A F_t / (b ε_α c_γ).
#[derive(Clone, Debug, PartialEq, Declared)]
pub struct IsoAmount {
    /// K_A.
    #[declared(minimum = 0.1, maximum = 10.0, default = "1")]
    pub application_factor: f64,
    /// F_t: nominal tangential load.
    #[declared(dimension = FORCE, minimum = 0.0, maximum = 1e9, example = "3 kN")]
    pub tangential_load: f64,
    /// b; the narrower gear's when left out.
    #[declared(dimension = LENGTH, minimum = 1e-4, maximum = 10.0, example = "20 mm")]
    pub face_width: Option<f64>,
    /// ε_α; the pair's when left out.
    #[declared(minimum = 1.0, maximum = 6.0, example = "1.6")]
    pub contact_ratio: Option<f64>,
    /// c_γ: mesh stiffness per face width.
    #[declared(dimension = SPECIFIC_STIFFNESS, minimum = 1e6, maximum = 1e13, example = "20 N/(mm um)")]
    pub mesh_stiffness: f64,
}

/// Where a relief starts.
#[derive(Clone, Copy, Debug, PartialEq, Alternatives)]
pub enum Start {
    /// L: roll length of the relief along the line of action; a relief of no length removes nothing.
    #[declared(dimension = LENGTH, minimum = 0.0, maximum = 1.0, range, example = "4 mm")]
    Length(f64),
    /// Instead of `length`: length over p_b(ε_α − 1); 1 is long relief, 0.5 short relief.
    #[declared(dimension = RATIO, minimum = 0.0, maximum = 10.0, range, example = "0.5")]
    Fraction(f64),
    /// Instead of `length`: roll angle where the relief starts.
    #[declared(name = "start_roll_angle", dimension = ANGLE, minimum = 0.0, maximum = 10.0, range, example = "25 deg")]
    RollAngle(f64),
    /// Instead of `length`: diameter at which the relief starts.
    #[declared(name = "start_diameter", dimension = LENGTH, minimum = 1e-4, maximum = 100.0, range, example = "75 mm")]
    Diameter(f64),
}

/// Where the length of a tip relief counts from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum FromTip {
    /// the relief is the last part of the flank, of that length
    #[default]
    Tip,
    /// it starts that far inside the single-contact zone, measured from the zone's end, and grows to the flank's end
    SingleZone,
    /// it starts at the end of the single-contact zone, grows over that length and then stays
    ZoneEnd,
}

impl FromTip {
    pub(super) fn origin(self) -> Origin {
        match self {
            Self::Tip => Origin::End,
            Self::SingleZone => Origin::SingleZone,
            Self::ZoneEnd => Origin::ZoneEnd,
        }
    }
}

/// Where the length of a root relief counts from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum FromRoot {
    /// the relief is the first part of the active flank, of that length
    #[default]
    Root,
    /// it starts that far inside the single-contact zone, measured from the zone's end, and grows to the flank's end
    SingleZone,
    /// it starts at the end of the single-contact zone, grows over that length and then stays
    ZoneEnd,
}

impl FromRoot {
    pub(super) fn origin(self) -> Origin {
        match self {
            Self::Root => Origin::End,
            Self::SingleZone => Origin::SingleZone,
            Self::ZoneEnd => Origin::ZoneEnd,
        }
    }
}

/// A relief shorter than this share of the base pitch counts as no relief.
const SHORTEST: f64 = 1e-9;

/// Which end of the flank the relief runs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    Tip,
    Root,
}

/// Where a length counts from, whichever end the relief runs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    End,
    SingleZone,
    ZoneEnd,
}

/// A relief as it is stated.
pub(super) struct Stated<'a> {
    pub amount: &'a Amount,
    pub start: Start,
    pub origin: Origin,
    pub curve: Curve,
    pub end: End,
}

/// A ramp along the profile: nothing before its start, the whole amount from its end on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ramp {
    amount: f64,
    growth: Growth,
    /// Roll angles of start and end.
    breaks: [f64; 2],
    /// d t / d roll; 0 for a ramp of no length.
    rate: f64,
    base_radius: f64,
}

impl Amount {
    fn depth(&self, pair: &GearPair) -> f64 {
        let iso = match self {
            Self::Depth(depth) => return *depth,
            Self::Iso(iso) => iso,
        };
        let common = pair.pinion.specification.face_width.min(pair.gear.specification.face_width);
        let load = iso.application_factor * iso.tangential_load / iso.face_width.unwrap_or(common);
        load / (iso.contact_ratio.unwrap_or(pair.contact_ratio) * iso.mesh_stiffness)
    }
}

impl Start {
    /// The roll length \[m\], where the start is given by one.
    fn length(self, flank: &Flank) -> Option<f64> {
        match self {
            Self::Length(length) => Some(length),
            Self::Fraction(fraction) => Some(fraction * flank.long_relief),
            Self::RollAngle(_) | Self::Diameter(_) => None,
        }
    }

    /// The roll angle, where the start is given by a place on the flank.
    fn roll(self, flank: &Flank) -> Result<Option<f64>, Diagnostic> {
        match self {
            Self::Length(_) | Self::Fraction(_) => Ok(None),
            Self::RollAngle(roll) => Ok(Some(roll)),
            Self::Diameter(diameter) => flank.roll_at_diameter(diameter).map(Some).ok_or_else(|| {
                let (given, base) = (diameter * 1e3, flank.base_radius * 2e3);
                let digits = decimals(given, base);
                let message =
                    format!("the start diameter {given:.digits$} mm is below the base circle, {base:.digits$} mm");
                Diagnostic::new(message).of(self.field())
            }),
        }
    }
}

impl Stated<'_> {
    /// Refuses a place on the flank that is said to count from somewhere.
    pub(super) fn check(&self, counted_from: &str) -> Result<(), Diagnostic> {
        match self.start {
            Start::RollAngle(_) | Start::Diameter(_) if self.origin != Origin::End => {
                let start = self.start.field();
                let message =
                    format!("`counted_from: {counted_from}` goes with `length` or `fraction`, not with `{start}`");
                Err(Diagnostic::new(message).of("counted_from"))
            }
            _ => Ok(()),
        }
    }
}

impl Ramp {
    pub(super) fn new(stated: &Stated, pair: &GearPair, flank: &Flank) -> Result<Self, Diagnostic> {
        let (last, first, outward) = match stated.end {
            End::Tip => (flank.tip_roll, flank.root_roll, 1.0),
            End::Root => (flank.root_roll, flank.tip_roll, -1.0),
        };
        // Distances from the flank's end, along the line of action: where the relief starts and where it is complete.
        let (from, to) = match (stated.start.length(flank), stated.origin) {
            (Some(length), Origin::End) => (length, 0.0),
            (Some(length), Origin::SingleZone) => (flank.outer_zone + length, 0.0),
            (Some(length), Origin::ZoneEnd) => (flank.outer_zone, flank.outer_zone - length),
            (None, _) => {
                let roll = stated.start.roll(flank)?.unwrap_or(last);
                ((last - roll) * outward * flank.base_radius, 0.0)
            }
        };
        let longest = flank.length();
        if !(from >= 0.0 && from <= longest * (1.0 + 1e-12)) {
            let (lower, upper) = (first.min(last), first.max(last));
            let digits = decimals(from.abs() * 1e3, longest * 1e3);
            return Err(Diagnostic::new(format!(
                "the relief starts {:.digits$} mm {} the end of the flank; the active flank is {:.digits$} mm long (roll angles {:.6} \
                 to {:.6} deg, diameters {:.6} to {:.6} mm)",
                from.abs() * 1e3,
                if from < 0.0 { "beyond" } else { "from" },
                longest * 1e3,
                lower.to_degrees(),
                upper.to_degrees(),
                flank.diameter(lower) * 1e3,
                flank.diameter(upper) * 1e3,
            ))
            .of(stated.start.field()));
        }
        let span = (from - to) / flank.base_radius;
        Ok(Self {
            amount: stated.amount.depth(pair),
            growth: stated.curve.growth(),
            breaks: [from, to].map(|distance| last - outward * distance / flank.base_radius),
            // The limit of ever shorter reliefs takes nothing away; a step would only unload a single point.
            rate: if span * flank.base_radius > SHORTEST * flank.base_pitch { outward / span } else { 0.0 },
            base_radius: flank.base_radius,
        })
    }
}

impl Modification for Ramp {
    fn depth(&self, roll: f64) -> f64 {
        let t = (roll - self.breaks[0]) * self.rate;
        if t <= 0.0 { 0.0 } else { self.amount * self.growth.value(t) }
    }

    fn profile_quadratic(&self, roll: f64) -> Option<Quadratic> {
        let [start, end] = self.breaks;
        let t = (roll - start) * self.rate;
        if t <= 0.0 {
            return Some(Quadratic::ZERO);
        }
        if t >= 1.0 {
            return Some(Quadratic { origin: end, coefficients: [self.amount, 0.0, 0.0] });
        }
        let [linear, bend] = self.growth.quadratic()?.map(|of_growth| self.amount * of_growth);
        Some(Quadratic { origin: start, coefficients: [0.0, linear * self.rate, bend * self.rate * self.rate] })
    }

    fn profile_rates(&self, roll: f64, inside: f64) -> Option<[f64; 3]> {
        let of = |roll: f64| (roll - self.breaks[0]) * self.rate;
        if !(0.0..=1.0).contains(&of(inside)) {
            return None;
        }
        let [value, slope, bend] = self.growth.rates(of(roll).clamp(0.0, 1.0));
        Some([self.amount * value, self.amount * slope * self.rate, self.amount * bend * self.rate * self.rate])
    }

    fn profile_breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn varies_along_profile(&self) -> bool {
        self.amount != 0.0 && self.rate != 0.0
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        let (radius, [start, end]) = (self.base_radius, self.breaks);
        vec![
            ("amount", self.amount),
            ("length", (end - start).abs() * radius),
            ("start_roll_angle", start),
            ("start_diameter", 2.0 * radius * (1.0 + start * start).sqrt()),
        ]
    }
}
