//! The pair of a REXS file as the text of a study: what is said, what is not, and what must be filled in.
//!
//! The text is read as any study is, with numbers in the places that are left open, so what no pair can have is refused by
//! the limits and the geometry that hold for every study; the message then stands where the file says the number. Must
//! not know: XML.

use std::path::Path;

use super::Refusal;
use super::cutting::{StatedCutter, StatedRack, TipCorner};
use super::gear::{RexsPair, Thickness, is_other};
use super::model::Said;
use crate::program::load_text;

/// Stands where a study needs a value that the file does not give: a study with it is refused right there.
const OPEN: &str = "FILL_IN";

/// A text that remembers which of its bytes the file says.
#[derive(Default)]
struct Written {
    text: String,
    /// First byte and end in the text, byte in the file.
    said: Vec<(usize, usize, Option<usize>)>,
    /// First byte of what is left open, which value, and a number that is likely.
    open: Vec<(usize, String, String)>,
    /// What the file does not say and the study's defaults do.
    missing: Vec<String>,
}

impl Written {
    fn put(&mut self, text: &str) {
        self.text += text;
    }

    /// `name: value unit`, if it is said.
    fn field(&mut self, before: &str, name: &str, said: Option<Said>, unit: &str) {
        if let Some(said) = said {
            self.put(before);
            let from = self.text.len();
            self.put(&format!("{name}: {}{unit}", said.value));
            self.said.push((from, self.text.len(), said.at));
        }
    }

    /// The same, left open where it is not said.
    fn needed(&mut self, name: &str, said: Option<Said>, gear: &str, likely: f64) {
        if said.is_none() {
            self.put(&format!(", {name}: "));
            self.open.push((self.text.len(), format!("{name} of the {gear}"), format!("{likely}")));
            self.put(&format!("{OPEN} mm"));
        }
        self.field(", ", name, said, " mm");
    }

    /// Fields between `before` and `after`; nothing where none is said.
    fn group(&mut self, mut before: &str, fields: &[(&str, Option<Said>, &str)], after: &str) {
        for (name, said, unit) in fields {
            self.field(before, name, *said, unit);
            before = if said.is_some() { ", " } else { before };
        }
        if fields.iter().any(|(_, said, _)| said.is_some()) {
            self.put(after);
        }
    }

    /// `is_cutting` is false where pinion-type cutters shape all gears that it is for: only its addendum counts then.
    fn rack(&mut self, before: &str, after: &str, rack: StatedRack, (whose, is_cutting): (&str, bool)) {
        let fields = rack.fields();
        let fields_said = fields.map(|(name, said, unit, _)| (name, said, unit));
        self.group(&format!("{before}rack: {{ "), &fields_said, "");
        // Grinding leaves a notch where the allowance is larger than the protuberance.
        let protuberance = rack.protuberance.map_or(0.0, |said| said.value);
        if rack.machining_allowance.is_some_and(|allowance| allowance.value > protuberance) {
            self.put(", notch_radius: ");
            self.open.push((self.text.len(), format!("{whose} notch_radius (modules)"), "0.2".to_owned()));
            self.put(OPEN);
        }
        if fields.iter().any(|(_, said, ..)| said.is_some()) {
            self.put(&format!(" }}{after}"));
        }
        for (name, said, _, usual) in fields.into_iter().take(if is_cutting { RACK } else { 1 }) {
            if let (None, Some(usual)) = (said, usual) {
                self.missing.push(format!("{whose} {name} ({usual} modules stand for it)"));
            }
        }
    }

    /// With likely numbers for what is left open, and where a byte of that text stands in this one.
    fn filled(&self) -> (String, impl Fn(usize) -> usize) {
        let (mut filled, mut from) = (String::new(), 0);
        let mut shifts = Vec::new();
        for (at, _, likely) in &self.open {
            filled += &self.text[from..*at];
            filled += likely;
            from = at + OPEN.len();
            shifts.push((filled.len(), from));
        }
        filled += &self.text[from..];
        let back = move |byte: usize| {
            let last = shifts.iter().rev().find(|(filled, _)| *filled <= byte);
            last.map_or(byte, |(filled, own)| own + byte - filled)
        };
        (filled, back)
    }
}

/// A text, what the file does not say, and what is left open: its byte, which value, and a likely number.
type Body = (String, Vec<String>, Vec<(usize, String, String)>);

/// The text of a study below its comments, each open value with the line in which it stands.
pub(super) fn with_head(mut head: Vec<String>, body: &str, open: &[(usize, String, String)]) -> String {
    let lines = head.len() + open.len();
    for (at, what, _) in open {
        let line = lines + 1 + body[..*at].matches('\n').count();
        head.push(format!("# It does not say: {what}; fill it in in line {line}, where {OPEN} stands."));
    }
    head.join("\n") + "\n" + body
}

impl RexsPair<'_> {
    /// The study.
    ///
    /// # Errors
    /// Where the gears are not a pair, or a value is one that no study takes.
    pub(super) fn text(&self) -> Result<Body, Refusal> {
        let text = self.body()?;
        self.check(&text)?;
        Ok((text.text, text.missing, text.open))
    }

    fn body(&self) -> Result<Written, Refusal> {
        let stage: String = self.stage.chars().filter(char::is_ascii_alphanumeric).take(16).collect();
        let mut text = Written::default();
        text.put(&format!("study: imported\ntitle: Cylindrical stage {stage} of a REXS file\n\nstages:\n  pair:\n"));
        text.put("    kind: geometry\n");
        let module = self.common("modules", |gear| Some(gear.module))?;
        text.field("    ", "module", module, " mm\n");
        let angle = self.common("pressure angles", |gear| gear.pressure_angle)?;
        text.field("    ", "pressure_angle", angle, " deg\n");
        if angle.is_none() {
            text.missing.push("normal_pressure_angle (20 deg stands for it)".to_owned());
        }
        let racks: Vec<StatedRack> = self.gears.iter().map(|gear| gear.rack).collect();
        let is_common = (0..RACK).all(|at| {
            let said: Vec<Said> = racks.iter().filter_map(|rack| rack.fields()[at].1).collect();
            said.windows(2).all(|two| !is_other(two[0], two[1]))
        });
        if is_common {
            let mut common = racks[0];
            racks[1..].iter().for_each(|other| common.fill(other));
            let is_cutting = self.gears.iter().any(|gear| gear.cutter.is_none());
            text.rack("    ", "\n", common, ("the rack's", is_cutting));
            self.taken_over(&mut text, &racks);
        }
        for (name, gear) in ["pinion", "gear"].iter().zip(&self.gears) {
            text.field(&format!("    {name}: {{ "), "teeth", Some(gear.teeth), "");
            let size = gear.module.value * gear.teeth.value;
            text.needed("face_width", gear.width, name, gear.module.value);
            text.needed("bore_radius", gear.bore_diameter.map(|said| said.map(|it| 0.5 * it)), name, 0.05 * size);
            text.field(", ", "profile_shift", gear.shift, "");
            text.field(", ", "tip_radius", gear.tip_diameter.map(|said| said.map(|it| 0.5 * it)), " mm");
            let follows = self.centre_distance.is_some() && self.gears.iter().any(|other| other.shift.is_some());
            if gear.shift.is_none() && follows {
                text.put(", from_centre_distance: profile_shift");
                let what =
                    format!("addendum_modification_coefficient of the {name} (it follows from the centre distance)");
                text.missing.push(what);
            } else if gear.shift.is_none() {
                text.missing.push(format!("addendum_modification_coefficient of the {name} (0 stands for it)"));
            }
            if !is_common {
                text.rack(", ", "", gear.rack, (&format!("the {name}'s rack's"), gear.cutter.is_none()));
            }
            if let Some(StatedCutter { teeth, profile_shift, addendum, tip_radius }) = gear.cutter {
                let fields = [
                    ("teeth", Some(teeth), ""),
                    ("profile_shift", Some(profile_shift), ""),
                    ("addendum", Some(addendum), ""),
                    ("tip_radius", Some(tip_radius), ""),
                ];
                text.group(", pinion_cutter: { ", &fields, " }");
            }
            match gear.tip {
                Some(TipCorner::Chamfer(size)) => {
                    text.group(", tip: { chamfer: { ", &[("size", Some(size), " mm")], " } }");
                }
                Some(TipCorner::SemiTopping(angle, height)) => {
                    let fields = [("angle", Some(angle), " deg"), ("height", Some(height), " mm")];
                    text.group(", tip: { semi_topping: { ", &fields, " } }");
                }
                None => {}
            }
            match gear.thickness {
                Some(Thickness::Allowance(upper, lower)) => {
                    let fields = [("upper", Some(upper), " mm"), ("lower", lower, " mm")];
                    text.group(", tooth_thickness: { allowance: { ", &fields, " } }");
                }
                Some(Thickness::Span(teeth, span)) => {
                    let fields = [("teeth", Some(teeth), ""), ("largest", Some(span), " mm")];
                    text.group(", tooth_thickness: { span: { ", &fields, " } }");
                }
                Some(Thickness::OverBalls(ball, largest, smallest)) => {
                    let fields = [
                        ("ball_diameter", Some(ball), " mm"),
                        ("largest", Some(largest), " mm"),
                        ("smallest", smallest, " mm"),
                    ];
                    text.group(", tooth_thickness: { over_balls: { ", &fields, " } }");
                }
                None => {}
            }
            let with = [("span_teeth", gear.span_teeth, ""), ("ball_diameter", gear.ball_diameter, " mm")];
            text.group(", measured_with: { ", &with, " }");
            let material = [
                ("youngs_modulus", gear.youngs_modulus, " MPa"),
                ("poisson_ratio", gear.poisson_ratio, ""),
                ("density", gear.density, " kg/m^3"),
            ];
            text.group(", material: { ", &material, " }");
            let steel = ["modulus_of_elasticity (206 GPa", "poisson_ratio (0.3"];
            for ((_, said, _), usual) in material.into_iter().zip(steel) {
                if said.is_none() {
                    text.missing.push(format!("{usual} stands for it) of the {name}"));
                }
            }
            if gear.tip_diameter.is_none() {
                text.missing.push(format!("tip_diameter of the {name} (it follows from the rack's addendum)"));
            }
            text.put(" }\n");
        }
        text.field("    ", "centre_distance", self.centre_distance, " mm\n");
        if self.centre_distance.is_none() {
            text.missing.push("center_distance (that without backlash stands for it)".to_owned());
        }
        if let [Some(upper), Some(lower)] = self.centre_distance_allowance {
            let fields = [("upper", Some(upper), " mm"), ("lower", Some(lower), " mm")];
            text.group("    centre_distance_allowance: { ", &fields, " }\n");
        }
        self.modifications(&mut text);
        Ok(text)
    }

    /// Reports values of a rack that one gear says and that stand for the other's too.
    fn taken_over(&self, text: &mut Written, racks: &[StatedRack]) {
        for (at, (name, other)) in [("pinion", "gear"), ("gear", "pinion")].into_iter().enumerate() {
            if self.gears[at].cutter.is_some() {
                continue;
            }
            let pairs = racks[at].fields().into_iter().zip(racks[1 - at].fields());
            let taken: Vec<&str> = pairs
                .filter(|((_, own, ..), (_, others, ..))| own.is_none() && others.is_some())
                .map(|((field, ..), _)| field)
                .collect();
            if !taken.is_empty() {
                let what = taken.join(", ");
                text.missing.push(format!("{what} of the {name}'s rack (as of the {other}'s, which stands for it)"));
            }
        }
    }

    fn modifications(&self, text: &mut Written) {
        if self.gears.iter().all(|gear| gear.modifications.is_empty()) {
            return;
        }
        text.put("  designs:\n    kind: modification\n    pair: pair\n    designs:\n      imported:\n");
        for (name, gear) in ["pinion", "gear"].iter().zip(&self.gears) {
            for modification in &gear.modifications {
                text.put(&format!("        - {}: {{ gear: {name}", modification.family));
                for (field, said) in &modification.fields {
                    text.field(", ", field, Some(*said), " mm");
                }
                text.put(&modification.curve.map_or(String::new(), |curve| format!(", curve: {curve}")));
                text.put(" }\n");
            }
        }
    }

    /// Reads what was written, and says where the file says what is wrong with it.
    fn check(&self, text: &Written) -> Result<(), Refusal> {
        let (filled, back) = text.filled();
        let Err(error) = load_text(&filled, Path::new("imported.yaml")) else { return Ok(()) };
        let byte = error.diagnostic.place.map_or(0, |place| back(place.offset));
        // A message about a whole gear or the whole pair stands at the stage.
        let said = text.said.iter().find(|(from, to, _)| (*from..*to).contains(&byte));
        let at = said.map_or(self.at, |(_, _, at)| *at);
        Err(Refusal::new(error.diagnostic.message.clone()).maybe_at(at))
    }
}

/// Fields of a rack.
const RACK: usize = 6;

impl StatedRack {
    /// Each with its name, its unit, and the default that stands for what is not said.
    fn fields(&self) -> [(&'static str, Option<Said>, &'static str, Option<&'static str>); RACK] {
        [
            ("addendum", self.addendum, "", Some("1.0")),
            ("dedendum", self.dedendum, "", Some("1.25")),
            ("tip_radius", self.tip_radius, "", Some("0.38")),
            ("protuberance", self.protuberance, "", None),
            ("protuberance_angle", self.protuberance_angle, " deg", None),
            ("machining_allowance", self.machining_allowance, "", None),
        ]
    }

    /// What is not said as another rack has it.
    fn fill(&mut self, other: &Self) {
        self.addendum = self.addendum.or(other.addendum);
        self.dedendum = self.dedendum.or(other.dedendum);
        self.tip_radius = self.tip_radius.or(other.tip_radius);
        self.protuberance = self.protuberance.or(other.protuberance);
        self.protuberance_angle = self.protuberance_angle.or(other.protuberance_angle);
        self.machining_allowance = self.machining_allowance.or(other.machining_allowance);
    }
}
