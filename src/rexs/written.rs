//! The pair of a REXS file as the text of a study: what is said, what is not, and what must be filled in.
//!
//! The text is read as any study is, with numbers in the places that are left open, so what no pair can have is refused by
//! the limits and the geometry that hold for every study; the message then stands where the file says the number. Must
//! not know: XML.

use std::path::Path;

use super::{Refusal, RexsPair, Said};
use crate::program::load_text;

/// Stands where a study needs a value that the file does not give: a study with it is refused right there.
const OPEN: &str = "FILL_IN";

/// A text that remembers which of its bytes the file says.
#[derive(Default)]
struct Written {
    text: String,
    /// First byte and end in the text, byte in the file.
    said: Vec<(usize, usize, usize)>,
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

impl RexsPair {
    /// The study.
    ///
    /// # Errors
    /// Where the gears are not a pair, or a value is one that no study takes.
    pub(super) fn text(&self, version: &str) -> Result<String, Refusal> {
        let text = self.body()?;
        self.check(&text)?;
        let mut head = vec![format!("# From a file of REXS {version}.")];
        head.extend(text.missing.iter().map(|what| format!("# It does not say: {what}.")));
        let lines = head.len() + text.open.len();
        for (at, what, _) in &text.open {
            let line = lines + 1 + text.text[..*at].matches('\n').count();
            head.push(format!("# It does not say: {what}; fill it in in line {line}, where {OPEN} stands."));
        }
        Ok(head.join("\n") + "\n" + &text.text)
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
        let rack = [
            ("addendum", self.common("rack addenda", |gear| gear.addendum)?, "1.0"),
            ("dedendum", self.common("rack dedenda", |gear| gear.dedendum)?, "1.25"),
            ("tip_radius", self.common("rack tip radii", |gear| gear.rack_tip_radius)?, "0.38"),
        ];
        let mut before = "    rack: { ";
        for (name, said, usual) in rack {
            text.field(before, name, said, "");
            match said {
                Some(_) => before = ", ",
                None => text.missing.push(format!("the rack's {name} ({usual} modules stand for it)")),
            }
        }
        if before == ", " {
            text.put(" }\n");
        }
        for (name, gear) in ["pinion", "gear"].iter().zip(&self.gears) {
            text.field(&format!("    {name}: {{ "), "teeth", Some(gear.teeth), "");
            let size = gear.module.value * gear.teeth.value;
            text.needed("face_width", gear.width, name, gear.module.value);
            text.needed("bore_radius", gear.bore_diameter.map(|said| said.map(|it| 0.5 * it)), name, 0.05 * size);
            text.field(", ", "profile_shift", gear.shift, "");
            text.field(", ", "tip_radius", gear.tip_diameter.map(|said| said.map(|it| 0.5 * it)), " mm");
            if gear.shift.is_none() {
                text.missing.push(format!("addendum_modification_coefficient of the {name} (0 stands for it)"));
            }
            let mut before = ", material: { ";
            for (name, said, unit) in
                [("youngs_modulus", gear.youngs_modulus, " MPa"), ("poisson_ratio", gear.poisson_ratio, "")]
            {
                text.field(before, name, said, unit);
                before = if said.is_some() { ", " } else { before };
            }
            text.put(if before == ", " { " } }\n" } else { " }\n" });
        }
        text.field("    ", "centre_distance", self.centre_distance, " mm\n");
        Ok(text)
    }

    /// Reads what was written, and says where the file says what is wrong with it.
    fn check(&self, text: &Written) -> Result<(), Refusal> {
        let (filled, back) = text.filled();
        let Err(error) = load_text(&filled, Path::new("imported.yaml")) else { return Ok(()) };
        let byte = error.diagnostic.place.map_or(0, |place| back(place.offset));
        // A message about a whole gear or the whole pair stands at the stage.
        let said = text.said.iter().find(|(from, to, _)| (*from..*to).contains(&byte));
        let at = said.map_or(self.at, |(_, _, at)| *at);
        Err(Refusal::new(error.diagnostic.message.clone()).at(at))
    }
}
