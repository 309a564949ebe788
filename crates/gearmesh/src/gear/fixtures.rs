//! For tests only: the pair 19/48, module 3 mm, with compliances in closed form, and records of modifications.
//!
//! Must not know: the constructors of gears and compliances, so that a mistake there cannot hide one here.

pub(crate) mod uneven;

use super::compliance::inclined::Inclined;
use super::compliance::{ContactLaw, PairCompliance, ToothCompliance};
use super::contact::flattening::Bodies;
use super::geometry::flank_end::FlankEnd;
use super::geometry::outline::tip::Tip;
use super::geometry::{Gear, GearPair, Rack, Side, Specification};
use super::material::{Material, Plane};
use super::modification::{Design, family};
use crate::numeric::chebyshev::Series;
use crate::numeric::surface::Surface;
use declare::declared::record_of;
use declare::error::Diagnostic;
use declare::record::{Record, Value};

pub(crate) const STEEL: Material = Material::STEEL;
pub(crate) const STEELS: Bodies = Bodies { materials: [STEEL; 2], plane: Plane::Strain };
pub(crate) const BASE_PITCH: f64 = 8.856_394_302_280_648e-3;

fn gear(teeth: u32, base_radius: f64, face_width: f64) -> Gear {
    let module = 3e-3;
    let reference_radius = 0.5 * module * f64::from(teeth);
    let tip_radius = reference_radius + module;
    Gear {
        specification: Specification { face_width, ..standard(teeth, module, 2.0) },
        reference_radius,
        base_radius,
        tip_radius,
        root_radius: reference_radius - 1.25 * module,
        form_radius: base_radius,
        form_roll: 0.0,
        undercut: false,
        // (π/2)/z + inv 20°.
        half_base_angle: std::f64::consts::FRAC_PI_2 / f64::from(teeth) + 0.014_904_383_867_336_45,
        tip: Tip::Land,
        flank_end: FlankEnd::corner(((tip_radius / base_radius).powi(2) - 1.0).sqrt()),
    }
}

/// A gear of the standard rack without profile shift, 7 modules wide, its bore r_f/`bore_ratio`.
pub(crate) fn standard(teeth: u32, module: f64, bore_ratio: f64) -> Specification {
    Specification {
        teeth,
        module,
        pressure_angle: 20_f64.to_radians(),
        profile_shift: 0.0,
        thickness_allowance: 0.0,
        cutter: None,
        rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A },
        tip_radius: None,
        face_width: 7.0 * module,
        bore_radius: module * (0.5 * f64::from(teeth) - 1.25) / bore_ratio,
        material: STEEL,
    }
}

/// The least gap by a way of its own, of profiles that bend back nowhere: points of each flank by their polar coordinates
/// about the other gear's centre, and their best place by thirds. Good to 1e-16 m.
pub(crate) fn least_gap(pair: &GearPair, design: &Design, s: f64) -> f64 {
    least_gap_of(pair, |side, roll| design.depth(side, roll), s)
}

/// The same of any depths by gear and roll angle.
pub(crate) fn least_gap_of(pair: &GearPair, depth: impl Fn(Side, f64) -> f64, s: f64) -> f64 {
    let length = pair.tangent_length;
    let ways = [(Side::Gear, s, pair.end_of_contact), (Side::Pinion, length - s, length - pair.start_of_contact)];
    let of = |(point, nominal, end): (Side, f64, f64)| {
        let (own, other) = (pair.side(point), pair.side(point.other()));
        let gap = |before: f64| {
            let arc = length - nominal - before;
            let (sine, cosine) = libm::sincos(before / own.base_radius);
            let x = length - arc * cosine - own.base_radius * sine;
            let y = own.base_radius + other.base_radius + arc * sine - own.base_radius * cosine;
            let curvature = (x * x + (y - other.base_radius) * (y + other.base_radius)).sqrt();
            if before > end - nominal || curvature > end {
                return f64::INFINITY;
            }
            let (radius, roll) = (other.base_radius, curvature / other.base_radius);
            let behind = radius * (libm::atan2(x, y) - libm::atan(roll)) + curvature - nominal;
            behind + depth(point, arc / own.base_radius) + depth(point.other(), roll)
        };
        let (mut low, mut high) = (0.0, end - nominal);
        for _ in 0..80 {
            let [one, two] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if gap(one) > gap(two) { low = one } else { high = two }
        }
        gap(low).min(gap(0.0))
    };
    of(ways[0]).min(of(ways[1]))
}

/// 19/48, 20 and 18 mm wide.
pub(crate) fn pair() -> GearPair {
    let (start, end) = (2.009_266_843_717_533_4e-3, 16.583_582_258_918_156e-3);
    let pinion_base = 19.0 * BASE_PITCH / std::f64::consts::TAU;
    GearPair {
        pinion: gear(19, pinion_base, 20e-3),
        gear: gear(48, pinion_base * 48.0 / 19.0, 18e-3),
        centre_distance: 100.5e-3,
        working_pressure_angle: 20_f64.to_radians(),
        tangent_length: 34.373_024_404_229_71e-3,
        start_of_contact: start,
        end_of_contact: end,
        base_pitch: BASE_PITCH,
        contact_ratio: (end - start) / BASE_PITCH,
    }
}

/// The same gears with the end of contact moved: the pinion's teeth are higher, and thicker, so that the angle of their
/// tips is unchanged.
pub(crate) fn pair_with_contact_ratio(ratio: f64) -> GearPair {
    let mut pair = pair();
    let involute = |pair: &GearPair| {
        let roll = pair.end_of_contact / pair.pinion.base_radius;
        roll - libm::atan(roll)
    };
    let before = involute(&pair);
    pair.contact_ratio = ratio;
    pair.end_of_contact = pair.start_of_contact + ratio * BASE_PITCH;
    pair.pinion.tip_radius = libm::hypot(pair.pinion.base_radius, pair.end_of_contact);
    pair.pinion.flank_end = FlankEnd::corner(pair.end_of_contact / pair.pinion.base_radius);
    pair.pinion.half_base_angle += involute(&pair) - before;
    pair
}

/// The same pair with the gear driving: its path of contact is run through backwards.
pub(crate) fn swapped(pair: &GearPair) -> GearPair {
    GearPair {
        pinion: pair.gear.clone(),
        gear: pair.pinion.clone(),
        start_of_contact: pair.tangent_length - pair.end_of_contact,
        end_of_contact: pair.tangent_length - pair.start_of_contact,
        ..pair.clone()
    }
}

/// Teeth whose compliance is `value(u, centre)` with u the roll angle; everything in the bending part.
pub(crate) fn tooth(value: impl Fn(f64) -> f64) -> ToothCompliance {
    let nothing = || Series::from_values(0.0, 2.0, &[0.0]);
    ToothCompliance {
        bending: Series::fit(0.0, 2.0, 40, value),
        shear: nothing(),
        axial: nothing(),
        body: nothing(),
        contact_depth: Series::from_values(0.0, 2.0, &[2.5e-3]),
        corner: 1.6e-12,
        inclined: None,
        neighbours: Vec::new(),
    }
}

/// Every pair has the stiffness `stiffness`, linear contact included, wherever it is.
pub(crate) fn constant(pair: &GearPair, stiffness: f64) -> PairCompliance {
    let width = pair.pinion.specification.face_width.min(pair.gear.specification.face_width);
    let contact = 4.0 * (1.0 - 0.09) / (std::f64::consts::PI * 206e9 * width);
    let half = 0.5 * (1.0 / stiffness - contact);
    PairCompliance {
        pinion: tooth(|_| half),
        gear: tooth(|_| half),
        contact: Some(ContactLaw::Linear),
        plane: Plane::Strain,
        coupled: false,
    }
}

/// Teeth that get softer towards their tips, much like real ones.
pub(crate) fn varying() -> PairCompliance {
    let pinion = tooth(|u| 0.8e-9 + 2.4e-9 * u * u + 1.5e-9 * u * u * u);
    let gear = tooth(|u| 0.5e-9 + 3.0e-9 * u * u);
    PairCompliance { pinion, gear, contact: Some(ContactLaw::Linear), plane: Plane::Strain, coupled: false }
}

/// As [`varying`], with neighbouring teeth deflecting each other.
pub(crate) fn coupled() -> PairCompliance {
    let mut compliance = varying();
    for tooth in [&mut compliance.pinion, &mut compliance.gear] {
        tooth.neighbours = (1..5)
            .map(|pitches| {
                let value = |u: f64, v: f64| 0.35e-9 / f64::from(pitches) * (1.0 + 0.2 * u + 0.1 * v * v);
                Surface::fit([0.0; 2], [2.0; 2], [2, 3], value)
            })
            .collect();
    }
    PairCompliance { coupled: true, ..compliance }
}

/// The same, and loads at the corners of tips that may be inclined.
pub(crate) fn inclined(mut compliance: PairCompliance) -> PairCompliance {
    for tooth in [&mut compliance.pinion, &mut compliance.gear] {
        let neighbours =
            (1..5).map(|pitches| Series::fit(0.0, 2.0, 3, |u| -0.18e-9 / f64::from(pitches) * (1.0 + 0.3 * u)));
        tooth.inclined =
            Some(Inclined { own: [-0.8e-9, 0.05e-9], corner: [-2e-12, 3e-12], neighbours: neighbours.collect() });
    }
    compliance
}

/// A record of the family `name`.
pub(crate) fn record(name: &str, values: &[(&'static str, Value)]) -> Record {
    record_of(family(name).unwrap().member.fields, values)
}

/// A modification: family, gear, other values.
pub(crate) type NamedModification<'a> = (&'a str, &'static str, &'a [(&'static str, Value)]);

/// A design of several modifications.
pub(crate) fn design(pair: &GearPair, parts: &[NamedModification]) -> Result<Design, Diagnostic> {
    let mut design = Design::default();
    for (name, gear, values) in parts {
        let values = [&[("gear", Value::Choice(gear))], *values].concat();
        design.add_record(family(name).unwrap(), &record(name, &values), pair)?;
    }
    Ok(design)
}
