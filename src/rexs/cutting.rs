//! The rack or pinion-type cutter that cuts a gear, and the corner of its tip, as tools, settings and flanks say them. Must not know: the text of a study.

use super::Refusal;
use super::around::{Around, Remarks};
use super::model::{Component, Fate, Said};
use super::ways::{ANGLES, LENGTHS, PLAIN, Way, agreed, some};

/// A tip form circle that differs by less from the tip circle is rounded \[mm\].
const ROUNDING: f64 = 1e-3;

/// A root diameter that differs by less from that by the tool has an allowance, modules.
const ROOT: f64 = 0.3;

/// What a tool says of its ramp.
const RAMP: [&str; 3] =
    ["chamfer_angle", "utilized_dedendum_coefficient_reference_profile", "utilized_dedendum_reference_profile"];

/// What becomes of the corner of a tip.
#[derive(Clone, Copy)]
pub(super) enum TipCorner {
    Chamfer(Said),
    /// Angle and height of the ramp.
    SemiTopping(Said, Said),
}

/// The rack that cuts a gear; lengths in modules.
#[derive(Clone, Copy, Default)]
pub(super) struct StatedRack {
    pub addendum: Option<Said>,
    pub dedendum: Option<Said>,
    pub tip_radius: Option<Said>,
    pub protuberance: Option<Said>,
    pub protuberance_angle: Option<Said>,
    pub machining_allowance: Option<Said>,
}

/// The pinion-type cutter that shapes a gear; lengths in modules.
#[derive(Clone, Copy)]
pub(super) struct StatedCutter {
    pub teeth: Said,
    pub profile_shift: Said,
    pub addendum: Said,
    pub tip_radius: Said,
}

impl StatedRack {
    /// What counts of the rack of a gear that is shaped: the root follows from the cutter.
    pub(super) fn of_shaped(self, gear: &Component) -> Self {
        for name in ["root_diameter", "tooth_depth"] {
            gear.set(name, Fate::Follows);
        }
        Self { addendum: self.addendum, ..Self::default() }
    }
}

impl Around<'_> {
    /// The pinion-type cutter, if it says all that a study takes of one; else a note says what is missing.
    pub(super) fn cutter(&self, m: f64, name: &str, remarks: &mut Remarks) -> Result<Option<StatedCutter>, Refusal> {
        let Some(first) = self.cutters.first() else { return Ok(None) };
        let of_cutter = |ways: &[Way]| agreed(&self.cutters, ways);
        let teeth = of_cutter(&[("number_of_teeth", PLAIN, 1.0)])?;
        let profile_shift =
            of_cutter(&[("addendum_modification_coefficient", PLAIN, 1.0), ("addendum_modification", LENGTHS, m)])?;
        let addendum = of_cutter(&[
            ("addendum_coefficient_reference_profile", PLAIN, 1.0),
            ("addendum_reference_profile", LENGTHS, m),
        ])?;
        let tip_radius = of_cutter(&[
            ("tip_radius_factor", PLAIN, 1.0),
            ("tip_corner_radius_factor_reference_profile", PLAIN, 1.0),
            ("tip_radius", LENGTHS, m),
            ("tip_corner_radius_reference_profile", LENGTHS, m),
        ])?;
        if let (Some(teeth), Some(profile_shift), Some(addendum), Some(tip_radius)) =
            (teeth, profile_shift, addendum, tip_radius)
        {
            return Ok(Some(StatedCutter { teeth, profile_shift, addendum, tip_radius }));
        }
        let missing = [
            (teeth, "number_of_teeth"),
            (profile_shift, "addendum_modification_coefficient"),
            (addendum, "addendum_coefficient_reference_profile"),
            (tip_radius, "tip_radius_factor"),
        ];
        let missing: Vec<&str> = missing.iter().filter(|(said, _)| said.is_none()).map(|(_, name)| *name).collect();
        self.cutters.iter().for_each(|cutter| cutter.is_not_supported());
        remarks.notes.push(format!(
            "Not supported: the {} that cuts the {name}, since it does not say {}; a rack stands for it.",
            first.kind,
            missing.join(" and ")
        ));
        Ok(None)
    }

    pub(super) fn rack(
        &self,
        module: Said,
        teeth: Said,
        shift: Option<Said>,
        tip_diameter: Option<Said>,
        pressure_angle: f64,
    ) -> Result<StatedRack, Refusal> {
        let (m, gear) = (module.value, self.gear);
        let of_flank: Vec<&Component> = [gear].into_iter().chain(self.flanks.iter().copied()).collect();
        let of_tool = |ways: &[Way]| agreed(&self.racks, ways);
        // The tool's addendum cuts the gear's dedendum.
        let by_tool = of_tool(&[
            ("addendum_coefficient_reference_profile", PLAIN, 1.0),
            ("addendum_reference_profile", LENGTHS, m),
        ])?;
        let mut dedendum = by_tool;
        if let Some(addendum) = by_tool {
            // d_f = m(z − 2 h_fP* + 2 x), but for the thickness allowance and the machining allowance.
            let x = shift.map_or(0.0, |shift| shift.value);
            let root = teeth.value - 2.0 * (addendum.value - x);
            match gear.number("root_diameter", LENGTHS) {
                Ok(Some(said)) if (said.value / m - root).abs() > ROOT => gear.set("root_diameter", Fate::Contradicts),
                _ => gear.set("root_diameter", Fate::Follows),
            }
            gear.follows("tooth_depth");
        } else {
            let by_depth = |depth: Said| tip_diameter.map(|tip| depth.map(|depth| tip.value - 2.0 * depth));
            let root = match gear.number("root_diameter", LENGTHS)? {
                Some(root) => Some(root),
                None => gear.number("tooth_depth", LENGTHS)?.and_then(by_depth),
            };
            if root.is_none() {
                gear.set("tooth_depth", Fate::NotSupported);
            }
            // r_f = m(z/2 − h_fP* + x).
            let x = shift.map_or(0.0, |shift| shift.value);
            dedendum = root.map(|root| root.map(|root| 0.5 * teeth.value + x - 0.5 * root / m));
        }
        let machining_allowance = match agreed(&self.settings, &[("machining_allowance", LENGTHS, m)])? {
            Some(said) => Some(said),
            None => match agreed(&self.flanks, &[("machining_allowance", LENGTHS, m)])? {
                Some(said) => Some(said),
                None => of_tool(&[
                    ("relative_machining_allowance", PLAIN, 1.0),
                    ("relative_machining_allowance_din_3972", PLAIN, 1.0),
                    ("relative_machining_allowance_din_3972_1952", PLAIN, 1.0),
                    ("machining_allowance", LENGTHS, m),
                    ("machining_allowance_din_3972", LENGTHS, m),
                    ("machining_allowance_din_3972_1952", LENGTHS, m),
                ])?,
            },
        };
        let machining_allowance = some(machining_allowance);
        if by_tool.is_some()
            && let Some(allowance) = machining_allowance
        {
            // The tool stays off by the allowance: h_fP* = h_aP0* − q*/sin α.
            let raised = allowance.value / libm::sin(pressure_angle);
            dedendum = dedendum.map(|said| said.map(|addendum| addendum - raised));
        }
        let protuberance = of_tool(&[("protuberance_amount_factor", PLAIN, 1.0), ("protuberance_amount", LENGTHS, m)])?;
        let protuberance = match protuberance {
            Some(said) => {
                self.flanks.iter().for_each(|flank| flank.follows("remaining_protuberance"));
                Some(said)
            }
            // s_pr* = pr* − q*.
            None => some(agreed(&self.flanks, &[("remaining_protuberance", LENGTHS, m)])?)
                .map(|said| said.map(|rest| rest + machining_allowance.map_or(0.0, |allowance| allowance.value))),
        };
        let protuberance = some(protuberance);
        let angle = of_tool(&[("protuberance_angle", ANGLES, 1.0)])?;
        if protuberance.is_none() {
            self.racks.iter().for_each(|rack| rack.set("protuberance_angle", Fate::Follows));
        }
        Ok(StatedRack {
            addendum: agreed(
                &of_flank,
                &[("addendum_coefficient_basic_profile", PLAIN, 1.0), ("addendum_basic_profile", LENGTHS, m)],
            )?,
            dedendum,
            tip_radius: match of_tool(&[
                ("tip_radius_factor", PLAIN, 1.0),
                ("tip_corner_radius_factor_reference_profile", PLAIN, 1.0),
                ("tip_radius", LENGTHS, m),
                ("tip_corner_radius_reference_profile", LENGTHS, m),
            ])? {
                Some(said) => {
                    self.flanks.iter().for_each(|flank| flank.follows("tool_edge_radius"));
                    Some(said)
                }
                None => agreed(&self.flanks, &[("tool_edge_radius", LENGTHS, m)])?,
            },
            protuberance_angle: angle.filter(|_| protuberance.is_some()),
            protuberance,
            machining_allowance,
        })
    }

    /// The chamfer of the drawing, that down to the tip form circle, or that of a semi-topping tool.
    pub(super) fn tip(
        &self,
        m: f64,
        tip_diameter: Option<Said>,
        rack: &StatedRack,
    ) -> Result<Option<TipCorner>, Refusal> {
        let of_flank: Vec<&Component> = [self.gear].into_iter().chain(self.flanks.iter().copied()).collect();
        let chamfer = agreed(&of_flank, &[("tooth_tip_chamfer", LENGTHS, 1.0)])?;
        if let Some(chamfer) = some(chamfer) {
            self.gear.follows("tip_form_diameter");
            self.racks.iter().for_each(|rack| RAMP.iter().for_each(|name| rack.follows(name)));
            return Ok(Some(TipCorner::Chamfer(chamfer)));
        }
        let form = match tip_diameter {
            Some(tip) => self
                .gear
                .number("tip_form_diameter", LENGTHS)?
                .map(|form| form.map(|form| 0.5 * (tip.value - form)))
                .filter(|depth| depth.value > ROUNDING),
            None => None,
        };
        let angle = some(agreed(&self.racks, &[("chamfer_angle", ANGLES, 1.0)])?);
        let used = agreed(
            &self.racks,
            &[
                ("utilized_dedendum_coefficient_reference_profile", PLAIN, 1.0),
                ("utilized_dedendum_reference_profile", LENGTHS, m),
            ],
        )?;
        // The ramp begins h_K below the addendum line of the rack.
        let addendum = rack.addendum.map_or(1.0, |addendum| addendum.value);
        let height = used.map(|used| used.map(|used| m * (addendum - used)));
        let semi_topping = some(height).zip(angle).map(|(height, angle)| TipCorner::SemiTopping(angle, height));
        if semi_topping.is_none() {
            self.racks.iter().for_each(|rack| RAMP.iter().for_each(|name| rack.set(name, Fate::Follows)));
        }
        if tip_diameter.is_some() && (form.is_none() || semi_topping.is_some()) {
            self.gear.set("tip_form_diameter", Fate::Follows);
        }
        Ok(semi_topping.or(form.map(TipCorner::Chamfer)))
    }
}
