//! The tables `inspection`, `path_points` and `working`: what a gear data sheet and the printouts of other programs have.
//!
//! Diameters, since those say them so. Must not know: how any of it is computed.

use super::drawn::{Drawn, of_gear};
use gearmesh::gear::geometry::error::GeometryError;
use gearmesh::gear::geometry::inspection::{Balls, Chord, Span};
use gearmesh::gear::geometry::sliding::Backlash;
use gearmesh::gear::geometry::thickness::Limits;
use gearmesh::gear::geometry::{Gear, GearPair, Side, Specification};
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;

/// A gear of a certain thickness and what is measured of it.
#[derive(Clone)]
pub struct InspectedRow {
    side: Side,
    thickness: &'static str,
    gear: Gear,
    span: Span,
    /// None where no ball touches both flanks of a space.
    balls: Option<Balls>,
}

/// How many rows a gear has.
#[must_use]
pub fn count(drawn: &Drawn) -> usize {
    if drawn.limits.is_some_and(|limits| limits.largest > limits.smallest) { 3 } else { 1 }
}

/// The gear as it is computed and, where its thickness may differ, at the limits; spans and balls are the same on all.
///
/// # Errors
/// When a limit leaves no gear.
pub fn rows(drawn: &Drawn) -> Result<Vec<InspectedRow>, GeometryError> {
    let gear = &drawn.gear;
    let teeth = drawn.measured_with.span_teeth.unwrap_or_else(|| gear.usual_span_teeth());
    let diameter = drawn.measured_with.ball_diameter.unwrap_or_else(|| gear.usual_ball_diameter());
    let row = |thickness, gear: Gear| {
        let (span, balls) = (gear.span(teeth), gear.balls(diameter));
        InspectedRow { side: drawn.side, thickness, gear, span, balls }
    };
    let mut rows = vec![row("computed", gear.clone())];
    if let Some(limits) = drawn.limits.filter(|limits| limits.largest > limits.smallest) {
        for (thickness, allowance) in [("largest", limits.largest), ("smallest", limits.smallest)] {
            rows.push(row(thickness, of_thickness(gear, allowance)?));
        }
    }
    Ok(rows)
}

/// The same gear with another allowance.
fn of_thickness(gear: &Gear, thickness_allowance: f64) -> Result<Gear, GeometryError> {
    Gear::new(&Specification { thickness_allowance, ..gear.specification })?.with_tip(gear.tip)
}

impl InspectedRow {
    fn balls(&self, get: impl Fn(&Balls) -> f64) -> f64 {
        self.balls.as_ref().map_or(f64::NAN, get)
    }
}

#[must_use]
pub fn inspection() -> Columns<InspectedRow> {
    let description = "What is measured of each gear to know how thick its teeth are (ISO 21771).";
    let undercut = "How far the protuberance reaches beyond the finished flank s_pr = pr − q, normal to it; 0 where it does not, and of a shaped gear.";
    let over = "Dimension over two balls M_dK; with an odd number of teeth half a pitch from opposite.";
    let usual = "Diameter D_M of the ball: stated, or that of the one that touches the V-circle.";
    let chord = |row: &InspectedRow| -> Chord { row.gear.chord(row.gear.reference_radius) };
    let which = "Which thickness: computed, or the largest or smallest that is allowed where there are limits.";
    let allowance = "Thickness allowance A_s on the reference circle.";
    let columns = of_gear(Columns::new("inspection", description), |row: &InspectedRow| row.side)
        .text("thickness", which, |row| row.thickness)
        .key()
        .float("thickness_allowance", "um", allowance, |row| row.gear.specification.thickness_allowance)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("generating_profile_shift", "", "Generating profile shift coefficient x_E.", |row| {
            row.gear.specification.generating_profile_shift()
        })
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("reference_diameter", "mm", "Reference diameter d.", |row| 2.0 * row.gear.reference_radius)
        .float("base_diameter", "mm", "Base diameter d_b.", |row| 2.0 * row.gear.base_radius)
        .float("tip_diameter", "mm", "Tip diameter d_a.", |row| 2.0 * row.gear.tip_radius)
        .float("tip_form_diameter", "mm", "Tip form diameter d_Fa, where the flank ends towards the tip.", |row| {
            2.0 * row.gear.radius_at(row.gear.flank_end.roll)
        })
        .float("root_form_diameter", "mm", "Root form diameter d_Ff, where the generated flank begins.", |row| {
            2.0 * row.gear.form_radius
        })
        .float("root_diameter", "mm", "Root diameter d_f.", |row| 2.0 * row.gear.root_radius)
        .float("addendum", "mm", "Addendum h_a.", |row| row.gear.tip_radius - row.gear.reference_radius)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("tooth_depth", "mm", "Tooth depth h.", |row| row.gear.tip_radius - row.gear.root_radius)
        .float("tip_form_roll_angle", "deg", "Roll angle at the tip form circle.", |row| row.gear.flank_end.roll)
        .float("root_form_roll_angle", "deg", "Roll angle at the root form circle.", |row| row.gear.form_roll)
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("residual_undercut", "mm", undercut, |row| row.gear.specification.residual_undercut())
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("notch_depth", "mm", "Depth t_g of the notch that grinding leaves in the root; 0 without one.", |row| {
            row.gear.generated().map_or(f64::NAN, |generated| generated.notch_depth)
        })
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("tooth_thickness", "mm", "Arc thickness s on the reference circle.", |row| {
            row.gear.thickness_at(row.gear.reference_radius)
        })
        .float("tip_thickness", "mm", "Arc thickness s_a on the tip circle.", |row| row.gear.tip_thickness())
        .float("chordal_thickness", "mm", "Chord on the reference circle.", move |row| chord(row).length)
        .float("chordal_height", "mm", "From the tip circle down to that chord.", move |row| chord(row).height)
        .float("constant_chord", "mm", "Chord where the basic rack touches both flanks.", |row| {
            row.gear.constant_chord().length
        })
        .float("constant_chord_height", "mm", "From the tip circle down to the constant chord.", |row| {
            row.gear.constant_chord().height
        })
        .integer(
            "span_teeth",
            "Number k of teeth in the span: stated, or whose planes touch nearest the V-circle.",
            |row| row.span.teeth,
        )
        .float("span", "mm", "Span measurement W_k.", |row| row.span.length)
        .float("span_diameter", "mm", "Where the planes touch.", |row| 2.0 * row.span.radius)
        .flag("span_on_flank", "Whether they touch the involute there.", |row| row.span.on_flank);
    let maybe = |column: Column| column.allows_nan();
    columns
        .float("ball_diameter", "mm", usual, |row| row.balls(|balls| balls.diameter))
        .but(maybe)
        .float("ball_contact_diameter", "mm", "Diameter d_M at which the ball touches the flanks.", |row| {
            row.balls(|balls| 2.0 * balls.contact_radius)
        })
        .but(maybe)
        .float("radial_dimension_over_ball", "mm", "Dimension M_rK from the gear's centre over one ball.", |row| {
            row.balls(|balls| balls.radial)
        })
        .but(maybe)
        .float("dimension_over_balls", "mm", over, |row| row.balls(|balls| balls.over_two))
        .but(maybe)
        .flag("balls_measurable", "Whether the ball touches the involute, stands out, and is off the root.", |row| {
            row.balls.is_some_and(|balls| balls.measurable)
        })
        .on_demand()
}

/// A named point of the path of contact on one of the gears.
pub struct PointRow<'a> {
    pair: &'a GearPair,
    side: Side,
    name: &'static str,
    s: f64,
}

/// How many named points there are.
pub const POINTS: usize = 5;

/// The points A to E on both gears.
#[must_use]
pub fn points(pair: &GearPair) -> Vec<PointRow<'_>> {
    let zone = pair.zone_points();
    let named: [_; POINTS] = [("A", zone.a), ("B", zone.b), ("C", zone.c), ("D", zone.d), ("E", zone.e)];
    let of = |side: Side| named.map(|(name, s)| PointRow { pair, side, name, s });
    [Side::Pinion, Side::Gear].into_iter().flat_map(of).collect()
}

#[must_use]
pub fn path_points<'a>() -> Columns<PointRow<'a>> {
    let description = "The points A to E of the path of contact on each gear (ISO 21771).";
    let position = "Path position of the point, from the pinion's tangent point T1.";
    let sliding = "Specific sliding ζ of this gear's flank.";
    let factor = "Sliding factor K_g: sliding speed over that of the working pitch circles; K_gf at A and K_ga at E for the pinion.";
    let roll = |row: &PointRow| row.pair.roll(row.side, row.s);
    of_gear(Columns::new("path_points", description), |row: &PointRow| row.side)
        .text("point", "A, B, C, D or E.", |row| row.name)
        .key()
        .float("path_position", "mm", position, |row| row.s)
        .float("diameter", "mm", "Diameter of the circle through the point.", move |row| {
            2.0 * row.pair.side(row.side).radius_at(roll(row))
        })
        .float("roll_angle", "deg", "Roll angle of this gear.", roll)
        .float("specific_sliding", "", sliding, |row| row.pair.specific_sliding(row.side, row.s))
        .but(|column| column.tolerance(1e-9, 1e-9).allows_nan())
        .float("sliding_factor", "", factor, |row| row.pair.sliding_factor(row.s))
        .but(|column| column.tolerance(1e-9, 1e-9))
        .on_demand()
}

/// A pair, with the backlash that it has within the limits of its gears and of its centre distance.
pub struct WorkingRow<'a> {
    pair: &'a GearPair,
    smallest: Backlash,
    largest: Backlash,
}

impl<'a> WorkingRow<'a> {
    /// # Errors
    /// When gears at a limit cannot run together.
    pub fn new(
        pair: &'a GearPair,
        limits: [Option<Limits>; 2],
        centre_distance: [f64; 2],
    ) -> Result<Self, GeometryError> {
        let gears = [&pair.pinion, &pair.gear];
        let at = |limit: fn(Limits) -> f64, distance: f64| {
            let of = |gear: usize| -> Result<Gear, GeometryError> {
                limits[gear].map_or_else(|| Ok(gears[gear].clone()), |limits| of_thickness(gears[gear], limit(limits)))
            };
            Backlash::of([&of(0)?, &of(1)?], pair.centre_distance + distance)
        };
        let smallest = at(|limits| limits.largest, centre_distance[0])?;
        let largest = at(|limits| limits.smallest, centre_distance[1])?;
        Ok(Self { pair, smallest, largest })
    }
}

/// One row.
#[must_use]
pub fn working<'a>() -> Columns<WorkingRow<'a>> {
    let tip = |pair: &GearPair, side: Side| {
        let zone = pair.zone_points();
        let length = if side == Side::Pinion { zone.e - zone.c } else { zone.c - zone.a };
        length / pair.base_pitch
    };
    let clearance = |pair: &GearPair, side: Side| {
        pair.centre_distance - pair.side(side).root_radius - pair.side(side.other()).tip_radius
    };
    let columns = Columns::new("working", "The pair on its centre distance: what follows for both gears (ISO 21771).")
        .float("pinion_working_diameter", "mm", "Working pitch diameter d_w1.", |row: &WorkingRow| {
            2.0 * row.pair.working_radius(Side::Pinion)
        })
        .float("gear_working_diameter", "mm", "Working pitch diameter d_w2.", |row| {
            2.0 * row.pair.working_radius(Side::Gear)
        })
        .float("length_of_contact", "mm", "Length of contact g_α, from A to E.", |row| {
            row.pair.end_of_contact - row.pair.start_of_contact
        })
        .float("pinion_addendum_contact_ratio", "", "Addendum contact ratio ε_1, from C to E.", move |row| {
            tip(row.pair, Side::Pinion)
        })
        .float("gear_addendum_contact_ratio", "", "Addendum contact ratio ε_2, from A to C.", move |row| {
            tip(row.pair, Side::Gear)
        })
        .float(
            "pinion_clearance",
            "mm",
            "Clearance c_1 from the pinion's root circle to the gear's tip circle.",
            move |row| clearance(row.pair, Side::Pinion),
        )
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float(
            "gear_clearance",
            "mm",
            "Clearance c_2 from the gear's root circle to the pinion's tip circle.",
            move |row| clearance(row.pair, Side::Gear),
        )
        .but(|column| column.tolerance(1e-9, 1e-9));
    let excess = |pair: &GearPair, side: Side| {
        let own = pair.side(side);
        own.radius_at(pair.lowest_roll(side)) - own.form_radius
    };
    let lost = "Contact ratio that is lost where a tip would touch below the mate's root form circle.";
    let tight = "Centre distance without backlash, of the teeth as thick as they are.";
    let columns = columns
        .float("pinion_form_excess", "mm", "Form excess c_F1: root usable above root form radius.", move |row| {
            excess(row.pair, Side::Pinion)
        })
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("gear_form_excess", "mm", "Form excess c_F2 of the gear.", move |row| excess(row.pair, Side::Gear))
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float("lost_contact_ratio", "", lost, |row| row.pair.lost_contact_ratio())
        .but(|column| column.tolerance(1e-12, 1e-9))
        .float("centre_distance_without_backlash", "mm", tight, |row| row.pair.nearest_centre_distance())
        .but(Column::allows_nan);
    BACKLASHES
        .iter()
        .fold(columns, |columns, &(name, description, get)| {
            columns.float(name, "um", description, move |row| get(row)).but(|column| column.tolerance(1e-6, 1e-9))
        })
        .on_demand()
}

type Get = fn(&WorkingRow) -> f64;

/// Name, what it is, and how it is had.
const BACKLASHES: [(&str, &str, Get); 7] = [
    ("circumferential_backlash", "Circumferential backlash j_wt on the working pitch circles.", |row| {
        row.pair.backlash().circumferential
    }),
    (
        "smallest_circumferential_backlash",
        "The smallest j_wt within the limits of thickness and centre distance.",
        |row| row.smallest.circumferential,
    ),
    ("largest_circumferential_backlash", "The largest j_wt within them.", |row| row.largest.circumferential),
    ("normal_backlash", "Normal backlash j_bn.", |row| row.pair.backlash().normal),
    ("smallest_normal_backlash", "The smallest j_bn within the limits.", |row| row.smallest.normal),
    ("largest_normal_backlash", "The largest j_bn within them.", |row| row.largest.normal),
    ("radial_backlash", "Radial backlash j_r = j_wt/(2 tan α_w).", |row| row.pair.backlash().radial),
];
