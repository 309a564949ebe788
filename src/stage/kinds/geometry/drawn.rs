//! The tables of the full profiles: points, junctions, and how far each gear is from what it must not be.
//!
//! Must not know: how a profile is made.

use std::f64::consts::PI;

use crate::base::units::in_unit;
use crate::gear::geometry::outline::Outline;
use crate::gear::geometry::outline::curve::Local;
use crate::gear::geometry::outline::junction::Place;
use crate::gear::geometry::outline::sample::{Density, Point};
use crate::gear::geometry::{Gear, Pair, Side};
use crate::table::data::Row;
use crate::table::schema::{Column, Schema};

/// One gear of a pair with its full profile.
pub struct Drawn<'a> {
    pub side: Side,
    pub pair: &'a Pair,
    pub outline: &'a Outline,
}

fn gear_column() -> Column {
    Column::text("gear", "Which gear: pinion or gear.").key()
}

#[must_use]
pub fn outline_schema() -> Schema {
    Schema::new(
        "outline",
        "Points on the profile, counterclockwise; tooth 1 is symmetric about the gear's y axis.",
        vec![
            gear_column(),
            Column::integer("tooth", "Number of the tooth, counterclockwise.").key(),
            Column::integer("point", "Number of the point on the tooth, from the middle of the space to its right.")
                .key(),
            Column::integer("stretch", "Number of the curve on the tooth; both its ends stand in it."),
            Column::text("part", "What it is part of: root_land, root, step, flank, tip_break, tip_land."),
            Column::text("curve", "What it lies on: line, arc, trochoid, involute, modified_involute."),
            Column::float("radius", "mm", "Distance from the gear's centre."),
            Column::float("angle", "deg", "Polar angle from the y axis, counterclockwise.").tolerance(1e-9, 1e-9),
            Column::float("x", "mm", "Place across, in the gear's frame.").tolerance(1e-9, 1e-9),
            Column::float("y", "mm", "Place upwards, in the gear's frame.").tolerance(1e-9, 1e-9),
            Column::float("direction", "deg", "Direction of the tangent from the x axis, counterclockwise.")
                .tolerance(1e-7, 1e-9),
            Column::float("curvature", "1/mm", "Curvature, positive where convex; NaN where it is infinite.")
                .allows_nan()
                .tolerance(1e-6, 1e-6),
        ],
    )
    .on_demand()
}

impl Drawn<'_> {
    fn gear(&self) -> &Gear {
        self.pair.side(self.side)
    }

    #[must_use]
    pub fn outline_rows(&self, density: Density, teeth: u32) -> Vec<Row> {
        let curves = self.outline.tooth_by_curves(density);
        let mut rows = Vec::new();
        for number in 0..teeth {
            let (sine, cosine) = libm::sincos(2.0 * PI * f64::from(number) / f64::from(self.outline.teeth));
            let points = curves.iter().enumerate().flat_map(|(at, curve)| curve.iter().map(move |point| (at, point)));
            rows.extend(points.enumerate().map(|(place, (stretch, point))| {
                let local = turned(point.local, sine, cosine);
                self.outline_row([number as usize, place, stretch].map(|index| index + 1), point, local)
            }));
        }
        rows
    }

    fn outline_row(&self, numbers: [usize; 3], point: &Point, local: Local) -> Row {
        let segment = &self.outline.segments[point.segment];
        let [x, y] = local.position;
        let mut row: Row = vec![self.side.name().into()];
        row.extend(numbers.map(Into::into));
        row.extend([segment.part.name(), segment.curve.name()].map(Into::into));
        let values = [
            in_unit(libm::hypot(x, y), "mm"),
            in_unit(libm::atan2(-x, y), "deg"),
            in_unit(x, "mm"),
            in_unit(y, "mm"),
            in_unit(libm::atan2(local.tangent[1], local.tangent[0]), "deg"),
            per_millimetre(local.curvature),
        ];
        row.extend(values.map(Into::into));
        row
    }

    #[must_use]
    pub fn junction_rows(&self) -> Vec<Row> {
        let name = |index: usize| {
            let segment = &self.outline.segments[index];
            format!("{} {}", segment.part.name(), segment.curve.name())
        };
        let last = self.outline.segments.len() - 1;
        let row = |(index, junction): (usize, crate::gear::geometry::outline::junction::Junction)| -> Row {
            let (before, after) = match junction.place {
                Place::Space => (0, 0),
                Place::Behind(at) => (at, at + 1),
                Place::Centreline => (last, last),
            };
            let [x, y] = junction.after.position;
            vec![
                self.side.name().into(),
                (index + 1).into(),
                name(before).into(),
                name(after).into(),
                in_unit(libm::hypot(x, y), "mm").into(),
                in_unit(libm::atan2(-x, y), "deg").into(),
                in_unit(junction.position_jump(), "um").into(),
                in_unit(junction.tangent_jump(), "deg").into(),
                per_millimetre(junction.before.curvature).into(),
                per_millimetre(junction.after.curvature).into(),
            ]
        };
        self.outline.junctions().into_iter().enumerate().map(row).collect()
    }

    /// The roll angle to which the mate's tip reaches.
    fn lowest_roll(&self) -> f64 {
        let end = match self.side {
            Side::Pinion => self.pair.start_of_contact,
            Side::Gear => self.pair.end_of_contact,
        };
        self.pair.roll(self.side, end)
    }

    fn interferes(&self) -> bool {
        // A rounding's worth of overlap is none.
        self.lowest_roll() < self.outline.form_roll - 1e-12
    }

    /// What is to be said of a root that begins too high.
    #[must_use]
    pub fn interference(&self) -> Option<String> {
        let [reached, form] =
            [self.lowest_roll(), self.outline.form_roll].map(|roll| self.gear().radius_at(roll) * 1e3);
        let side = self.side.name();
        self.interferes().then(|| {
            format!(
                "{side}: the mate's tip reaches to a radius of {reached:.6} mm, but the flank as drawn begins at {form:.6} mm"
            )
        })
    }

    #[must_use]
    pub fn validity_row(&self) -> Row {
        let (gear, pair) = (self.gear(), self.pair);
        let specification = &gear.specification;
        let module = specification.module;
        let mate = match self.side {
            Side::Pinion => &pair.gear,
            Side::Gear => &pair.pinion,
        };
        let lowest = self.lowest_roll();
        let clearance = pair.centre_distance - mate.tip_radius - gear.root_radius;
        let usual = module * (specification.rack.dedendum - specification.rack.addendum);
        let sine = libm::sin(specification.pressure_angle);
        // h_a*(z_min − z)/z_min with z_min = 2 h_a*/sin² α.
        let least = specification.rack.addendum - 0.5 * f64::from(specification.teeth) * sine * sine;
        let least_here = gear.least_shift_without_undercut();
        let foot = self.outline.segments[0].start();
        vec![
            self.side.name().into(),
            specification.teeth.into(),
            specification.profile_shift.into(),
            least.into(),
            least_here.into(),
            gear.undercut.into(),
            in_unit(gear.radius_at(self.outline.form_roll), "mm").into(),
            in_unit(gear.radius_at(lowest), "mm").into(),
            in_unit(lowest - self.outline.form_roll, "deg").into(),
            self.interferes().into(),
            in_unit(libm::hypot(foot[0], foot[1]) - gear.root_radius, "mm").into(),
            in_unit(gear.tip_thickness(), "mm").into(),
            (gear.tip_thickness() / module).into(),
            in_unit(gear.radius_at(gear.apex_roll()), "mm").into(),
            in_unit(clearance, "mm").into(),
            ((usual - clearance) / module).into(),
            pair.contact_ratio.into(),
        ]
    }
}

fn turned(local: Local, sine: f64, cosine: f64) -> Local {
    let turn = |[x, y]: [f64; 2]| [cosine * x - sine * y, sine * x + cosine * y];
    Local { position: turn(local.position), tangent: turn(local.tangent), ..local }
}

fn per_millimetre(curvature: f64) -> f64 {
    if curvature.is_finite() { in_unit(curvature, "1/mm") } else { f64::NAN }
}

#[must_use]
pub fn junctions_schema() -> Schema {
    Schema::new(
        "junctions",
        "Where the curves of the right half of a tooth meet, from the middle of the space to the tooth's centreline.",
        vec![
            gear_column(),
            Column::integer(
                "junction",
                "Number, upwards; the first is in the middle of the space, the last on the tooth's centreline.",
            )
            .key(),
            Column::text("before", "Part and curve that end."),
            Column::text("after", "Part and curve that begin."),
            Column::float("radius", "mm", "Distance from the gear's centre."),
            Column::float("angle", "deg", "Polar angle from the tooth's centreline, counterclockwise.")
                .tolerance(1e-9, 1e-9),
            Column::float("position_jump", "um", "How far the two curves are apart.").tolerance(1e-9, 1e-6),
            Column::float("tangent_jump", "deg", "By how much the direction turns there, to the left.")
                .tolerance(1e-5, 1e-6),
            Column::float("curvature_before", "1/mm", "Curvature below; NaN where it is infinite.")
                .allows_nan()
                .tolerance(1e-6, 1e-6),
            Column::float("curvature_after", "1/mm", "Curvature above; NaN where it is infinite.")
                .allows_nan()
                .tolerance(1e-6, 1e-6),
        ],
    )
    .on_demand()
}

#[must_use]
pub fn validity_schema() -> Schema {
    Schema::new(
        "validity",
        "How far each gear is from what it must not be.",
        vec![
            gear_column(),
            Column::integer("teeth", "Number of teeth z."),
            Column::float("profile_shift", "", "Profile shift coefficient x."),
            Column::float("least_shift_sharp", "", "x_min = h_a*(z_min − z)/z_min of a sharp rack whose straight flank is h_a* deep, z_min = 2 h_a*/sin² α (zhai2020, 23).").tolerance(1e-12, 1e-9),
            Column::float("least_shift", "", "x_min of this rack: below it the rack undercuts.").tolerance(1e-12, 1e-9),
            Column::flag("undercut", "Whether the rack cuts into the involute, whatever root is drawn."),
            Column::float("form_radius", "mm", "Where the flank begins in the profile as drawn."),
            Column::float("active_radius", "mm", "Where the mate's tip reaches."),
            Column::float("contact_reserve", "deg", "Roll angle from the first to the second.").tolerance(1e-9, 1e-9),
            Column::flag("interference", "Whether the mate's tip reaches below the flank."),
            Column::float("root_gap", "mm", "How far the bottom of the space as drawn lies above the root circle.").tolerance(1e-9, 1e-9),
            Column::float("tip_thickness", "mm", "Arc thickness of the unmodified tooth at the tip."),
            Column::float("tip_thickness_in_modules", "", "The same, in modules; 0.2 to 0.4 are usual least values."),
            Column::float("apex_radius", "mm", "Where the flanks would meet in a point."),
            Column::float("clearance", "mm", "Between the root circle and the mate's tip."),
            Column::float("missing_tip_shortening", "", "By how many modules the mate's tip is to be lower for the rack's own clearance; negative where there is more.").tolerance(1e-12, 1e-9),
            Column::float("contact_ratio", "", "Transverse contact ratio ε_α."),
        ],
    )
    .on_demand()
}
