//! The tables `inspection`, `path_points` and `working`: what a gear data sheet and the printouts of other programs have.
//!
//! Diameters, since those say them so. Must not know: how any of it is computed.

use super::drawn::{Drawn, of_gear};
use gearmesh::gear::geometry::inspection::{Balls, Chord, Span};
use gearmesh::gear::geometry::{Gear, GearPair, Side};
use studygraph::table::columns::Columns;
use studygraph::table::schema::Column;

/// A gear and what is measured of it.
pub struct InspectedRow<'a> {
    side: Side,
    gear: &'a Gear,
    span: Span,
    /// None where no ball touches both flanks of a space.
    balls: Option<Balls>,
}

impl<'a> InspectedRow<'a> {
    #[must_use]
    pub fn new(drawn: &'a Drawn) -> Self {
        let gear = &drawn.gear;
        let span = gear.span(gear.usual_span_teeth());
        Self { side: drawn.side, gear, span, balls: gear.balls(gear.usual_ball_diameter()) }
    }

    fn balls(&self, get: impl Fn(&Balls) -> f64) -> f64 {
        self.balls.as_ref().map_or(f64::NAN, get)
    }
}

#[must_use]
pub fn inspection<'a>() -> Columns<InspectedRow<'a>> {
    let description = "What is measured of each gear to know how thick its teeth are (ISO 21771).";
    let over = "Dimension over two balls M_dK; with an odd number of teeth half a pitch from opposite.";
    let usual = "Diameter D_M of the ball that touches the V-circle.";
    let chord = |row: &InspectedRow| -> Chord { row.gear.chord(row.gear.reference_radius) };
    let columns = of_gear(Columns::new("inspection", description), |row: &InspectedRow| row.side)
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
        .integer("span_teeth", "Number k of teeth in the span whose planes touch nearest the V-circle.", |row| {
            row.span.teeth
        })
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

/// One row.
#[must_use]
pub fn working<'a>() -> Columns<&'a GearPair> {
    let tip = |pair: &GearPair, side: Side| {
        let zone = pair.zone_points();
        let length = if side == Side::Pinion { zone.e - zone.c } else { zone.c - zone.a };
        length / pair.base_pitch
    };
    let clearance = |pair: &GearPair, side: Side| {
        pair.centre_distance - pair.side(side).root_radius - pair.side(side.other()).tip_radius
    };
    Columns::new("working", "The pair on its centre distance: what follows for both gears (ISO 21771).")
        .float("pinion_working_diameter", "mm", "Working pitch diameter d_w1.", |pair: &&GearPair| {
            2.0 * pair.working_radius(Side::Pinion)
        })
        .float("gear_working_diameter", "mm", "Working pitch diameter d_w2.", |pair| {
            2.0 * pair.working_radius(Side::Gear)
        })
        .float("length_of_contact", "mm", "Length of contact g_α, from A to E.", |pair| {
            pair.end_of_contact - pair.start_of_contact
        })
        .float("pinion_addendum_contact_ratio", "", "Addendum contact ratio ε_1, from C to E.", move |pair| {
            tip(pair, Side::Pinion)
        })
        .float("gear_addendum_contact_ratio", "", "Addendum contact ratio ε_2, from A to C.", move |pair| {
            tip(pair, Side::Gear)
        })
        .float(
            "pinion_clearance",
            "mm",
            "Clearance c_1 from the pinion's root circle to the gear's tip circle.",
            move |pair| clearance(pair, Side::Pinion),
        )
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float(
            "gear_clearance",
            "mm",
            "Clearance c_2 from the gear's root circle to the pinion's tip circle.",
            move |pair| clearance(pair, Side::Gear),
        )
        .but(|column| column.tolerance(1e-9, 1e-9))
        .float(
            "circumferential_backlash",
            "um",
            "Circumferential backlash j_wt on the working pitch circles.",
            |pair| pair.backlash().circumferential,
        )
        .but(|column| column.tolerance(1e-6, 1e-9))
        .float("normal_backlash", "um", "Normal backlash j_bn.", |pair| pair.backlash().normal)
        .but(|column| column.tolerance(1e-6, 1e-9))
        .float("radial_backlash", "um", "Radial backlash j_r = j_wt/(2 tan α_w).", |pair| pair.backlash().radial)
        .but(|column| column.tolerance(1e-6, 1e-9))
        .on_demand()
}
