//! The gears of a stage: which attribute of which component says what a study states, in every version.
//!
//! Up to 1.2 a flank is a `flank_geometry` and a gear refers to its tools by `ordered_reference`; from 1.3 on a flank is a
//! `cylindrical_gear_flank` and the workpiece of `manufacturing_step`. 2.0 renames the tip radius of a tool. Lengths in mm, angles in
//! degrees, as they are shown. Must not know: the text of a study.

use super::Refusal;
use super::around::{Around, Remarks};
use super::cutting::{StatedCutter, StatedRack, TipCorner};
use super::model::{Component, Fate, Model, Relation, Said, refuse};
use super::modifications::{Modification, modifications};
use super::ways::{ANGLES, DENSITIES, LENGTHS, PLAIN, STRESSES, agreed, some};

/// A span that differs by less from that of a gear without allowance is rounded \[mm\].
const ROUNDING: f64 = 1e-3;

/// What a tooth's thickness follows from.
#[derive(Clone, Copy)]
pub(super) enum Thickness {
    /// A_sns and A_sni.
    Allowance(Said, Option<Said>),
    /// k, W_k.
    Span(Said, Said),
    /// D_M, the largest and the smallest M_dK.
    OverBalls(Said, Said, Option<Said>),
}

/// A gear as far as a file says it.
pub(super) struct RexsGear {
    pub teeth: Said,
    pub module: Said,
    pub pressure_angle: Option<Said>,
    pub shift: Option<Said>,
    pub width: Option<Said>,
    pub tip_diameter: Option<Said>,
    pub bore_diameter: Option<Said>,
    pub rack: StatedRack,
    /// The cutter, where a gear is shaped.
    pub cutter: Option<StatedCutter>,
    pub tip: Option<TipCorner>,
    pub thickness: Option<Thickness>,
    pub span_teeth: Option<Said>,
    pub ball_diameter: Option<Said>,
    pub youngs_modulus: Option<Said>,
    pub poisson_ratio: Option<Said>,
    pub density: Option<Said>,
    pub modifications: Vec<Modification>,
}

/// x, as a gear and its flanks say it.
fn shift_of(of_flank: &[&Component], module: f64) -> Result<Option<Said>, Refusal> {
    let ways = [("addendum_modification_coefficient", PLAIN, 1.0), ("addendum_modification", LENGTHS, module)];
    agreed(of_flank, &ways)
}

impl RexsGear {
    /// `missing_shift` is that of a gear that does not say its own.
    fn read<'a>(
        model: &'a Model,
        gear: &'a Component,
        missing_shift: Option<Said>,
        name: &str,
        remarks: &mut Remarks<'a>,
    ) -> Result<Self, Refusal> {
        let id = &gear.id;
        if gear.kind != "cylindrical_gear" {
            let kind = &gear.kind;
            return refuse(
                gear.at,
                format!("the component {id} is a {kind}; only external cylindrical gears can be read"),
            );
        }
        let needed = |said: Option<Said>, name: &str| match said {
            Some(said) => Ok(said),
            None => refuse(gear.at, format!("the cylindrical_gear {id} has no `{name}`")),
        };
        let module = needed(gear.number("normal_module", LENGTHS)?, "normal_module")?;
        let teeth = needed(gear.number("number_of_teeth", PLAIN)?, "number_of_teeth")?;
        let z = teeth.value;
        if !(z.fract() == 0.0 && (1.0..=1e6).contains(&z)) {
            let message = format!("the cylindrical_gear {id} has {z} teeth; only whole external gears can be read");
            return refuse(teeth.at, message);
        }
        let m = module.value;
        if m <= 0.0 {
            return refuse(module.at, format!("the cylindrical_gear {id} has a module of {m} mm; it must be positive"));
        }
        if let Some(helix) = gear.number("helix_angle_reference_diameter", ANGLES)?.filter(|helix| helix.value != 0.0) {
            let helix_angle = helix.value;
            let message =
                format!("the cylindrical_gear {id} has a helix angle of {helix_angle}°; only spur gears can be read");
            return refuse(helix.at, message);
        }
        let around = Around::of(model, gear, name, remarks);
        let of_flank: Vec<&Component> = [gear].into_iter().chain(around.flanks.iter().copied()).collect();
        let shift = shift_of(&of_flank, m)?.or(missing_shift);
        let pressure_angle = agreed(&of_flank, &[("normal_pressure_angle", ANGLES, 1.0)])?
            .map_or_else(|| agreed(&around.racks, &[("normal_pressure_angle", ANGLES, 1.0)]), |said| Ok(Some(said)))?;
        let tip_diameter = agreed(&[gear], &[("tip_diameter", LENGTHS, 1.0)])?.or(agreed(
            &[gear],
            &[("tooth_tip_height", LENGTHS, 1.0)],
        )?
        .map(|height| height.map(|height| m * z + 2.0 * height)));
        let angle = pressure_angle.map_or(20.0, |angle| angle.value).to_radians();
        let cutter = around.cutter(m, name, remarks)?;
        let rack = around.rack(module, teeth, shift, tip_diameter, angle)?;
        let rack = if cutter.is_some() { rack.of_shaped(gear) } else { rack };
        let mut said = Self {
            teeth,
            module,
            pressure_angle,
            shift,
            width: gear.number("face_width", LENGTHS)?,
            tip_diameter,
            bore_diameter: some(gear.number("inner_diameter", LENGTHS)?),
            tip: around.tip(m, tip_diameter, &rack)?,
            rack,
            cutter,
            thickness: None,
            span_teeth: gear.number("number_of_teeth_for_span_measurement", PLAIN)?.filter(|teeth| teeth.value >= 1.0),
            ball_diameter: some(gear.number("diameter_of_measuring_ball_or_pin", LENGTHS)?),
            youngs_modulus: agreed(&around.materials, &[("elastic_modulus", STRESSES, 1.0)])?,
            poisson_ratio: agreed(&around.materials, &[("poisson_ratio", PLAIN, 1.0)])?,
            density: agreed(&around.materials, &[("density", DENSITIES, 1.0)])?,
            modifications: modifications(model, &around.flanks, tip_diameter, remarks),
        };
        said.thickness = said.thickness(&around, &of_flank)?;
        for name in FOLLOWING {
            let all = of_flank.iter().chain(&around.racks).chain(&around.cutters).chain(&around.materials);
            all.for_each(|component| component.follows(name));
        }
        Ok(said)
    }

    /// The allowances by the deviations of a span, of balls, or the finished profile shift; else a span that says another thickness.
    fn thickness(&self, around: &Around, of_flank: &[&Component]) -> Result<Option<Thickness>, Refusal> {
        let gear = around.gear;
        let angle = self.pressure_angle.map_or(20.0, |angle| angle.value).to_radians();
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let m = self.module.value;
        let x = self.shift.map_or(0.0, |shift| shift.value);
        let of_span = ["upper_backlash_allowance_referenced_to_span", "lower_backlash_allowance_referenced_to_span"];
        let [upper, lower] = of_span.map(|name| gear.number(name, LENGTHS));
        if let (Some(upper), lower) = (upper?, lower?) {
            // A_sn = A_W / cos α.
            let finished = "addendum_modification_coefficient_after_finishing";
            for component in of_flank {
                component.follows(finished);
            }
            for name in ["span_measurement", "size_over_balls", "size_over_pins"] {
                gear.follows(name);
            }
            let of_span = |said: Said| said.map(|allowance| allowance / cos);
            return Ok(Some(Thickness::Allowance(of_span(upper), lower.map(of_span))));
        }
        // A lower deviation alone is none.
        for name in of_span {
            gear.set(name, Fate::NotSupported);
        }
        let over = agreed(&[gear], &[("size_over_balls", LENGTHS, 1.0), ("size_over_pins", LENGTHS, 1.0)])?;
        let of_balls = ["upper_backlash_allowance_balls_or_pins", "lower_backlash_allowance_balls_or_pins"];
        let [upper, lower] = of_balls.map(|name| gear.number(name, LENGTHS));
        if let (Some(ball), Some(over), Some(upper), lower) = (self.ball_diameter, over, upper?, lower?) {
            let with = |allowance: Said| allowance.map(|allowance| over.value + allowance);
            return Ok(Some(Thickness::OverBalls(ball, with(upper), lower.map(with))));
        }
        for name in of_balls {
            gear.set(name, Fate::NotSupported);
        }
        for name in ["size_over_balls", "size_over_pins"] {
            gear.set(name, Fate::Follows);
        }
        if let Some(finished) = agreed(of_flank, &[("addendum_modification_coefficient_after_finishing", PLAIN, 1.0)])?
        {
            // A_sn = 2 m (x_E − x) tan α.
            return Ok(Some(Thickness::Allowance(finished.map(|finished| 2.0 * m * (finished - x) * sin / cos), None)));
        }
        let Some(teeth) = self.span_teeth else { return Ok(None) };
        let Some(span) = gear.number("span_measurement", LENGTHS)? else { return Ok(None) };
        // W_k = m cos α (π(k − ½) + z inv α) + 2 x m sin α.
        let involute = sin / cos - angle;
        let without_allowance =
            m * cos * (std::f64::consts::PI * (teeth.value - 0.5) + self.teeth.value * involute) + 2.0 * x * m * sin;
        gear.set("span_measurement", Fate::Follows);
        let is_other = (span.value - without_allowance).abs() > ROUNDING;
        if is_other {
            gear.set("span_measurement", Fate::Read);
        }
        Ok(is_other.then_some(Thickness::Span(teeth, span)))
    }
}

/// Attributes that follow from those that are read.
const FOLLOWING: [&str; 36] = [
    "axial_module",
    "axial_pitch",
    "base_circle_diameter",
    "base_diameter",
    "helix_angle_base_circle",
    "helix_angle_base_diameter",
    "load_angle_at_tip",
    "measuring_diameter_for_span",
    "measuring_diameter_ball_flank",
    "normal_circular_pitch",
    "normal_module",
    "normal_pressure_angle",
    "normal_space_width_at_pitch_diameter",
    "normal_space_width_at_reference_diameter",
    "normal_tooth_thickness_at_pitch_diameter",
    "normal_tooth_thickness_at_reference_diameter",
    "normal_tooth_thickness_at_root_diameter",
    "normal_tooth_thickness_at_tip_diameter",
    "pressure_angle_in_the_transverse_section",
    "protuberance_height",
    "protuberance_height_factor",
    "reference_circle_diameter",
    "reference_diameter_cylindrical_gear",
    "relative_tooth_root_chord_at_30_degree_tangent",
    "relative_tooth_root_radius_at_30_degree_tangent",
    "root_form_diameter",
    "shear_modulus",
    "tooth_depth",
    "tooth_thickness_at_pitch_diameter",
    "transverse_base_pitch",
    "transverse_circular_pitch_on_reference_circle",
    "transverse_circular_pitch_on_reference_diameter",
    "transverse_module",
    "virtual_number_of_teeth",
    "width_to_diameter_ratio",
    "width_to_normal_module_ratio",
];

/// The gears of a stage, and which components are theirs.
pub(super) struct RexsPair<'a> {
    pub stage: String,
    /// Where the relation of the stage stands.
    pub at: Option<usize>,
    /// The pinion and the gear.
    pub gears: Vec<RexsGear>,
    pub centre_distance: Option<Said>,
    /// A_ae and A_ai.
    pub centre_distance_allowance: [Option<Said>; 2],
    pub remarks: Remarks<'a>,
}

/// Attributes of a stage that follow from its gears.
const OF_STAGE: [&str; 8] = [
    "common_face_width",
    "flag_designation_addendum_modification",
    "gear_ratio",
    "length_of_path_of_contact",
    "normal_base_pitch",
    "radial_contact_ratio",
    "sum_of_addendum_modification_coefficients",
    "working_depth",
];

impl<'a> RexsPair<'a> {
    pub(super) fn read(model: &'a Model, relation: &Relation) -> Result<Self, Refusal> {
        let id = relation.in_role("stage").unwrap_or("");
        let stage = model.component(id);
        let number = |name: &str| stage.map_or(Ok(None), |stage| stage.number(name, LENGTHS));
        let mut pair = Self {
            stage: id.to_owned(),
            at: relation.at,
            gears: Vec::new(),
            centre_distance: number("center_distance")?,
            centre_distance_allowance: [
                number("upper_center_distance_allowance")?,
                number("lower_center_distance_allowance")?,
            ],
            remarks: Remarks::default(),
        };
        pair.remarks.concern(stage);
        if pair.centre_distance_allowance.iter().any(Option::is_none)
            && let Some(stage) = stage
        {
            for name in ["upper_center_distance_allowance", "lower_center_distance_allowance"] {
                stage.set(name, Fate::NotSupported);
            }
        }
        let mut gears = Vec::new();
        for role in ["gear_1", "gear_2"] {
            let Some(gear) = relation.in_role(role).and_then(|id| model.component(id)) else {
                return refuse(relation.at, format!("the stage has no `{role}`"));
            };
            gears.push(gear);
        }
        let missing = Self::missing_shifts(model, stage, &gears)?;
        for ((gear, name), missing) in gears.into_iter().zip(["pinion", "gear"]).zip(missing) {
            let gear = RexsGear::read(model, gear, missing, name, &mut pair.remarks)?;
            pair.gears.push(gear);
        }
        if let Some(stage) = stage {
            for name in OF_STAGE {
                stage.follows(name);
            }
        }
        Ok(pair)
    }

    /// x of a gear that does not say it, by that of the other and by x1 + x2 of the stage.
    fn missing_shifts(
        model: &Model,
        stage: Option<&Component>,
        gears: &[&Component],
    ) -> Result<[Option<Said>; 2], Refusal> {
        let Some(stage) = stage else { return Ok([None; 2]) };
        let mut shifts = Vec::new();
        for gear in gears {
            let module = gear.number("normal_module", LENGTHS)?.map_or(1.0, |module| module.value);
            let flanks = model.related(&["flank"], &gear.id, "gear", &["left", "right"]);
            let of_flank: Vec<&Component> =
                [*gear].into_iter().chain(flanks.into_iter().map(|(flank, _)| flank)).collect();
            shifts.push(shift_of(&of_flank, module)?);
        }
        let sum = |other: Said| -> Result<Option<Said>, Refusal> {
            let sum = stage.number("sum_of_addendum_modification_coefficients", PLAIN)?;
            Ok(sum.map(|sum| sum.map(|sum| sum - other.value)))
        };
        Ok(match shifts[..] {
            [None, Some(other)] => [sum(other)?, None],
            [Some(other), None] => [None, sum(other)?],
            _ => [None; 2],
        })
    }

    /// A value that both gears must have in common; what one of them does not say, the other's stands for.
    pub(super) fn common(&self, name: &str, get: impl Fn(&RexsGear) -> Option<Said>) -> Result<Option<Said>, Refusal> {
        let mut found: Option<Said> = None;
        for said in self.gears.iter().filter_map(get) {
            match found {
                Some(first) if is_other(first, said) => {
                    let message =
                        format!("the gears' {name} differ, {} and {}; a pair here has one", first.value, said.value);
                    return refuse(said.at, message);
                }
                _ => found = found.or(Some(said)),
            }
        }
        Ok(found)
    }
}

/// Whether two numbers differ by more than rounding.
pub(super) fn is_other(one: Said, other: Said) -> bool {
    (one.value - other.value).abs() > 1e-9 * one.value.abs().max(other.value.abs())
}
