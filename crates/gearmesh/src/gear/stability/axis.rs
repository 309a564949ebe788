//! The box of cases: a point in it, its axes with their ranges, and the case that a point stands for.
//!
//! A point names a pair by what does not depend on its size (bores as parts of the root circle, contact ratio), so that
//! one coordinate can move from end to end while the rest stay possible. Pairs have no backlash. Must not know: what
//! is checked.

use std::f64::consts::PI;

use super::{Case, Model};
use crate::gear::geometry::involute::{inverse_involute, involute};
use crate::gear::geometry::outline::tip::Tip;
use crate::gear::geometry::pinion_cutter::PinionCutter;
use crate::gear::geometry::{GearPair, Rack, Side, Specification};
use crate::gear::material::Material;

/// A pair under a load. SI; arrays hold pinion and gear.
#[derive(Clone, Debug)]
pub struct Point {
    /// m \[m\].
    pub module: f64,
    /// α \[rad\].
    pub pressure_angle: f64,
    /// z; whole numbers.
    pub teeth: [f64; 2],
    /// x \[modules\].
    pub shift: [f64; 2],
    /// A_s \[modules\].
    pub thickness_allowance: [f64; 2],
    /// The rack of both gears, whose addendum and dedendum give way to `contact_ratio`.
    pub rack: Rack,
    /// What shapes each gear, where no rack cuts it.
    pub cutters: [Option<PinionCutter>; 2],
    /// What is done to the corners of the tips \[m\]; in modules it stays as it is.
    pub tips: [Tip; 2],
    /// How far the tip circle is beyond m(z/2 + h_aP* + x) \[modules\].
    pub longer: [f64; 2],
    /// Addendum and dedendum follow from it where it is given.
    pub contact_ratio: Option<f64>,
    /// b \[m\].
    pub face_width: [f64; 2],
    /// Bore radius over root radius; of a gear that is shaped, over the one that the rack would cut.
    pub bore: [f64; 2],
    /// E and ν.
    pub material: [Material; 2],
    /// T on the pinion \[N m\].
    pub torque: f64,
    /// C_αa: linear tip relief of both gears \[m\].
    pub relief: f64,
    /// L: roll length of that relief along the line of action \[m\].
    pub relief_length: f64,
    /// C_β: lead crowning of both gears \[m\].
    pub crowning: f64,
}

/// One coordinate.
pub struct Axis {
    /// How a study calls it.
    pub name: &'static str,
    /// Unit in which its values are shown.
    pub unit: &'static str,
    /// SI.
    pub minimum: f64,
    /// SI.
    pub maximum: f64,
    /// Whether a sample is spread evenly over the logarithm of the value instead of the value.
    pub logarithmic: bool,
    /// The part of the unit interval in which a sample leaves the base pair's value.
    absent: f64,
    /// Gives a point a value (SI).
    pub set: fn(&mut Point, f64),
}

const fn logarithmic(
    name: &'static str,
    unit: &'static str,
    [minimum, maximum]: [f64; 2],
    set: fn(&mut Point, f64),
) -> Axis {
    Axis { name, unit, minimum, maximum, logarithmic: true, absent: 0.0, set }
}

const fn linear(
    name: &'static str,
    unit: &'static str,
    [minimum, maximum]: [f64; 2],
    set: fn(&mut Point, f64),
) -> Axis {
    Axis { name, unit, minimum, maximum, logarithmic: false, absent: 0.0, set }
}

const DEGREE: f64 = PI / 180.0;

/// Every axis; a sample sets them in this order.
pub const AXES: &[Axis] = &[
    logarithmic("torque", "N m", [1e-12, 1e9], |point, value| point.torque = value),
    logarithmic("youngs_modulus", "Pa", [1.0, 1e15], |point, value| {
        for material in &mut point.material {
            material.youngs_modulus = value;
        }
    }),
    Axis { absent: 0.5, ..logarithmic("stiffness_ratio", "", [1e-12, 1e12], Point::set_stiffness_ratio) },
    logarithmic("module", "mm", [1e-5, 0.1], Point::set_module),
    logarithmic("pinion_teeth", "", [5.0, 2000.0], |point, value| point.teeth[0] = value.round()),
    logarithmic("gear_teeth", "", [5.0, 2000.0], |point, value| point.teeth[1] = value.round()),
    Axis { absent: 0.4, ..linear("pinion_shift", "", [-1.0, 1.5], |point, value| point.shift[0] = value) },
    Axis { absent: 0.4, ..linear("gear_shift", "", [-1.0, 1.5], |point, value| point.shift[1] = value) },
    Axis {
        absent: 0.5,
        ..linear("pressure_angle", "deg", [10.0 * DEGREE, 35.0 * DEGREE], |point, value| point.pressure_angle = value)
    },
    logarithmic("face_width", "mm", [1e-6, 10.0], |point, value| point.face_width = [value; 2]),
    Axis { absent: 0.3, ..logarithmic("relief", "um", [1e-12, 3e-3], |point, value| point.relief = value) },
    logarithmic("relief_length", "mm", [1e-9, 1e-2], |point, value| point.relief_length = value),
    Axis { absent: 0.3, ..logarithmic("crowning", "um", [1e-12, 3e-3], |point, value| point.crowning = value) },
    linear("bore", "", [1e-3, 1.0 - 1e-9], |point, value| point.bore = [value; 2]),
    Axis {
        absent: 0.6,
        ..linear("contact_ratio", "", [1.0001, 3.0], |point, value| point.contact_ratio = Some(value))
    },
];

/// The axis called `name`.
#[must_use]
pub fn axis(name: &str) -> Option<&'static Axis> {
    AXES.iter().find(|axis| axis.name == name)
}

/// The point of the whole box at `coordinates` of the unit cube, one per axis.
#[must_use]
pub fn sample(base: &Point, coordinates: &[f64]) -> Point {
    let mut point = base.clone();
    for (axis, coordinate) in AXES.iter().zip(coordinates) {
        if *coordinate >= axis.absent {
            let share = (coordinate - axis.absent) / (1.0 - axis.absent);
            let value = if axis.logarithmic {
                axis.minimum * libm::pow(axis.maximum / axis.minimum, share)
            } else {
                axis.minimum + (axis.maximum - axis.minimum) * share
            };
            (axis.set)(&mut point, value);
        }
    }
    point
}

impl Point {
    /// The point a pair stands for, unmodified and under no torque.
    #[must_use]
    pub fn of(pair: &GearPair) -> Self {
        let both = |value: fn(&crate::gear::geometry::Gear) -> f64| {
            [Side::Pinion, Side::Gear].map(|side| value(pair.side(side)))
        };
        let specification = &pair.pinion.specification;
        Self {
            module: specification.module,
            pressure_angle: specification.pressure_angle,
            teeth: both(|gear| f64::from(gear.specification.teeth)),
            shift: both(|gear| gear.specification.profile_shift),
            thickness_allowance: both(|gear| gear.specification.thickness_allowance / gear.specification.module),
            // The one that cuts, where a cutter shapes the other gear.
            rack: [&pair.pinion, &pair.gear]
                .map(|gear| &gear.specification)
                .into_iter()
                .find(|own| own.cutter.is_none())
                .unwrap_or(specification)
                .rack,
            cutters: [Side::Pinion, Side::Gear].map(|side| pair.side(side).specification.cutter),
            tips: [Side::Pinion, Side::Gear].map(|side| pair.side(side).tip),
            longer: both(|gear| {
                let Specification { teeth, module, profile_shift, rack, .. } = gear.specification;
                let longer = gear.tip_radius / module - 0.5 * f64::from(teeth) - rack.addendum - profile_shift;
                // A tip circle that went through a table in mm comes back with its last digit changed.
                if longer.abs() < 1e-12 * f64::from(teeth) { 0.0 } else { longer }
            }),
            contact_ratio: None,
            face_width: both(|gear| gear.specification.face_width),
            bore: both(|gear| gear.specification.bore_radius / gear.root_radius),
            material: [Side::Pinion, Side::Gear].map(|side| pair.side(side).specification.material),
            torque: 0.0,
            relief: 0.0,
            relief_length: 0.0,
            crowning: 0.0,
        }
    }

    /// E of both gears around its present value, as far as the range of a material goes.
    fn set_stiffness_ratio(&mut self, ratio: f64) {
        let mean = (self.material[0].youngs_modulus * self.material[1].youngs_modulus).sqrt();
        let moduli = [mean * ratio.sqrt(), mean / ratio.sqrt()];
        let (minimum, maximum) = (moduli[0].min(moduli[1]), moduli[0].max(moduli[1]));
        let factor = if maximum > 1e15 {
            1e15 / maximum
        } else if minimum < 1.0 {
            1.0 / minimum
        } else {
            1.0
        };
        for (material, modulus) in self.material.iter_mut().zip(moduli) {
            material.youngs_modulus = (modulus * factor).clamp(1.0, 1e15);
        }
    }

    /// All lengths with it.
    fn set_module(&mut self, module: f64) {
        let factor = module / self.module;
        self.module = module;
        self.tips = self.tips.map(|tip| tip.scaled(factor));
        self.face_width = self.face_width.map(|width| width * factor);
        self.relief *= factor;
        self.relief_length *= factor;
        self.crowning *= factor;
    }

    /// The case of this point.
    #[must_use]
    pub fn case(&self, name: impl Into<String>, axis: &'static str, place: f64, model: &Model) -> Case {
        let rack = self.rack_for(self.contact_ratio);
        let gear = |side: usize| {
            let teeth = self.teeth[side];
            let thicker = 0.5 * self.thickness_allowance[side] / libm::tan(self.pressure_angle);
            let root = self.module * (0.5 * teeth - rack.dedendum + self.shift[side] + thicker);
            let tip = self.module * (0.5 * teeth + rack.addendum + self.shift[side] + self.longer[side]);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a number of teeth
            let teeth = teeth as u32;
            let bare = Specification {
                teeth,
                module: self.module,
                pressure_angle: self.pressure_angle,
                profile_shift: self.shift[side],
                cutter: self.cutters[side],
                thickness_allowance: self.thickness_allowance[side] * self.module,
                rack,
                tip_radius: (self.longer[side] != 0.0).then_some(tip),
                face_width: self.face_width[side],
                bore_radius: self.bore[side] * root,
                material: self.material[side],
            };
            let bore_radius = bare.shaped_root_radius().map_or(bare.bore_radius, |root| self.bore[side] * root);
            Specification { bore_radius, ..bare }
        };
        Case {
            name: name.into(),
            axis,
            place,
            gears: [gear(0), gear(1)],
            tips: self.tips,
            torque: self.torque,
            relief: self.relief,
            relief_length: self.relief_length,
            crowning: self.crowning,
            model: model.clone(),
        }
    }

    /// The rack whose addendum gives a contact ratio, with a quarter of a module of clearance; its tip round is cut down
    /// where it would be more than full.
    pub(super) fn rack_for(&self, contact_ratio: Option<f64>) -> Rack {
        let mut rack = self.rack;
        if let Some(ratio) = contact_ratio {
            let (mut low, mut high) = (0.02, 3.0);
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if self.contact_ratio_with(middle) < ratio { low = middle } else { high = middle }
            }
            rack.addendum = 0.5 * (low + high);
            rack.dedendum = rack.dedendum.max(rack.addendum + 0.25);
        }
        let (sine, cosine) = libm::sincos(self.pressure_angle);
        let full_round = (0.25 * PI * cosine - rack.dedendum * sine + rack.residual_undercut()) / (1.0 - sine);
        if full_round > 0.0 {
            rack.tip_radius = rack.tip_radius.min(full_round);
        }
        rack
    }

    /// ε_α for an addendum, even if something else would forbid it; 0 where there is no working pressure angle.
    fn contact_ratio_with(&self, addendum: f64) -> f64 {
        let angle = self.pressure_angle;
        let teeth = self.teeth[0] + self.teeth[1];
        let value = involute(angle) + 2.0 * libm::tan(angle) * (self.shift[0] + self.shift[1]) / teeth;
        if value <= 0.0 {
            return 0.0;
        }
        let cosine = libm::cos(angle);
        let along = |side: usize| {
            let (base, tip) = (0.5 * self.teeth[side] * cosine, 0.5 * self.teeth[side] + addendum + self.shift[side]);
            ((tip - base) * (tip + base)).max(0.0).sqrt()
        };
        let tangent = 0.5 * teeth * cosine * libm::tan(inverse_involute(value, angle));
        (along(0) + along(1) - tangent) / (PI * cosine)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{base, model};
    use super::*;
    use crate::gear::geometry::trochoid;

    type Read = fn(&Point) -> f64;

    fn point() -> Point {
        let (torque, relief, relief_length, crowning) = (50.0, 8e-6, 3e-3, 12e-6);
        Point { torque, relief, relief_length, crowning, ..Point::of(&base().pair().unwrap()) }
    }

    fn near(found: f64, wanted: f64, what: &str) {
        assert!((found - wanted).abs() <= 1e-12 * wanted.abs(), "{what}: {found} for {wanted}");
    }

    /// Tier: closed form; a coordinate goes from one end of its axis to the other, evenly over the value or its logarithm,
    /// where it does not leave the pair's own value; and changes nothing else of the axes.
    #[test]
    fn every_axis_goes_from_end_to_end() {
        let reads: [(&str, Read); 15] = [
            ("torque", |point| point.torque),
            ("youngs_modulus", |point| point.material[1].youngs_modulus),
            ("stiffness_ratio", |point| point.material[0].youngs_modulus / point.material[1].youngs_modulus),
            ("module", |point| point.module),
            ("pinion_teeth", |point| point.teeth[0]),
            ("gear_teeth", |point| point.teeth[1]),
            ("pinion_shift", |point| point.shift[0]),
            ("gear_shift", |point| point.shift[1]),
            ("pressure_angle", |point| point.pressure_angle),
            ("face_width", |point| point.face_width[0]),
            ("relief", |point| point.relief),
            ("relief_length", |point| point.relief_length),
            ("crowning", |point| point.crowning),
            ("bore", |point| point.bore[1]),
            ("contact_ratio", |point| point.contact_ratio.unwrap_or(0.0)),
        ];
        assert_eq!(AXES.len(), reads.len());
        for (at, (name, read)) in reads.into_iter().enumerate() {
            let axis = axis(name).unwrap();
            assert_eq!(axis.name, AXES[at].name);
            let with = |coordinate: f64| {
                // The others at their ends below, which leaves most of them as they are.
                let mut coordinates = [0.0; 15];
                coordinates[at] = coordinate;
                read(&sample(&point(), &coordinates))
            };
            let inside = |share: f64| axis.absent + share * (1.0 - axis.absent);
            let (minimum, maximum) = (axis.minimum, axis.maximum);
            near(with(inside(0.0)), minimum, name);
            near(with(inside(1.0)), maximum, name);
            let half = if axis.logarithmic { (minimum * maximum).sqrt() } else { 0.5 * (minimum + maximum) };
            // The number of teeth is rounded to a whole one.
            let rounded = if name.ends_with("teeth") { half.round() } else { half };
            near(with(inside(0.5)), rounded, name);
            if axis.absent > 0.0 {
                let own = if name == "stiffness_ratio" { 1.0 } else { read(&sample(&point(), &[0.0; 15])) };
                near(with(0.99 * axis.absent), own, name);
            }
        }
        let degrees = axis("pressure_angle").unwrap();
        assert!((degrees.minimum - 10_f64.to_radians()).abs() < 1e-15);
        assert!((degrees.maximum - 35_f64.to_radians()).abs() < 1e-15);
    }

    /// Tier: invariant; both moduli move apart about their mean, until one comes to the end of its range: then the ratio
    /// stays.
    #[test]
    fn a_ratio_of_stiffnesses_is_kept_at_the_ends_of_the_range() {
        for (modulus, ratio, mean_stays) in [
            (2e11, 100.0, true),
            (2e11, 0.01, true),
            (2e11, 1e12, false),
            (2e11, 1e-12, false),
            (10.0, 1e6, false),
            (1e14, 1e3, false),
        ] {
            let mut point = point();
            (point.material[0].youngs_modulus, point.material[1].youngs_modulus) = (2.0 * modulus, 0.5 * modulus);
            point.set_stiffness_ratio(ratio);
            let [a, b] = point.material.map(|material| material.youngs_modulus);
            near(a / b, ratio, "ratio");
            assert!(a.min(b) >= 1.0 && a.max(b) <= 1e15, "{a} {b}");
            assert_eq!(((a * b).sqrt() / modulus - 1.0).abs() < 1e-12, mean_stays, "{modulus} {ratio}");
            // No more than needed.
            assert!(mean_stays || a.min(b) < 1.0 + 1e-9 || a.max(b) > 1e15 * (1.0 - 1e-9), "{a} {b}");
        }
    }

    /// Tier: invariant; the module is a scale.
    #[test]
    fn lengths_go_with_the_module() {
        let (before, mut after) = (point(), point());
        after.set_module(7.0 * before.module);
        let lengths = |point: &Point| {
            [point.module, point.face_width[0], point.face_width[1], point.relief, point.relief_length, point.crowning]
        };
        for (before, after) in lengths(&before).into_iter().zip(lengths(&after)) {
            near(after, 7.0 * before, "length");
        }
    }

    /// Tier: second way; the case of a pair's point is that pair, and a contact ratio asked for is that of the pair.
    #[test]
    fn a_case_is_the_pair_it_stands_for() {
        let higher = |side: usize| {
            let mut gears = base().gears;
            gears[side].tip_radius = Some(3e-3 * (0.5 * f64::from(gears[side].teeth) + 1.03 + 0.05 * side as f64));
            (gears[0].profile_shift, gears[1].profile_shift) = (0.1, -0.05);
            gears
        };
        for gears in [base().gears, higher(0), higher(1)] {
            let pair = GearPair::new(gears[0], gears[1], None).unwrap();
            let case = Point::of(&pair).case("", "trap", 0.0, &model());
            for (found, wanted) in case.gears.iter().zip(gears) {
                assert_eq!(
                    (found.teeth, found.material, found.face_width),
                    (wanted.teeth, wanted.material, wanted.face_width)
                );
                near(found.profile_shift, wanted.profile_shift, "shift");
                near(found.bore_radius, wanted.bore_radius, "bore");
                assert_eq!(found.tip_radius.is_some(), wanted.tip_radius.is_some());
                near(found.tip_radius.unwrap_or(1.0), wanted.tip_radius.unwrap_or(1.0), "tip");
            }
        }
        for (teeth, shift, ratio) in [([60.0, 100.0], [0.0; 2], 2.3), ([30.0, 45.0], [0.3, -0.1], 1.4)] {
            let point = Point { teeth, shift, contact_ratio: Some(ratio), ..point() };
            let case = point.case("", "trap", 0.0, &model());
            let pair = case.pair().unwrap();
            assert!((pair.contact_ratio - ratio).abs() < 1e-12, "{} for {ratio}", pair.contact_ratio);
            let rack = case.gears[0].rack;
            assert!(rack.dedendum - rack.addendum >= 0.25 - 1e-12 && rack.dedendum >= 1.25);
            // Not rounder than round, and as round as before where there is room.
            let full = trochoid::full_round(&case.gears[0]);
            near(rack.tip_radius, point.rack.tip_radius.min(full), "round");
        }
        // No pressure angle works with so much shift taken off.
        assert!(Point { shift: [-30.0; 2], ..point() }.contact_ratio_with(1.0) <= 0.0);
    }
}
