//! What a series looks like: colour, dashes, marker.
//!
//! Words are categories: each has a colour, dashes and a marker, so that colour is never alone. Quantities lie on a ramp. What
//! is a part of something has its colour, and other dashes.
//! Must not know: axes, data.

use super::svg::at;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Colour {
    /// One of the style's colours, made to be told apart by colour-blind readers.
    Of(usize),
    /// Along a ramp, red, green, blue.
    Ramp([u8; 3]),
    /// That of the text.
    Ink,
}

/// So many colours has the style, and so many dashes and markers there are.
const KINDS: usize = 8;

/// Those of the style on white paper, where a file has no style.
const ON_WHITE: [&str; KINDS] =
    ["#0067a5", "#cc4c00", "#00856a", "#b0578d", "#c08a00", "#4aa3df", "#5b4ea8", "#6b6b6b"];

/// Lengths of dashes and gaps; the first is a solid line.
const DASHES: [&str; KINDS] = ["", "10 4", "3 4", "10 4 3 4", "6 3", "14 4 3 4 3 4", "1 4", "16 6"];

/// Markers about a point, beside those that a thick line of no length makes, which take the fewest bytes by far.
const MARKERS: [&str; KINDS] = [
    "h0",
    "h0",
    "m0-4.4l4.2 7.4h-8.4z",
    "m0-4.8l4.2 4.8l-4.2 4.8l-4.2-4.8z",
    "m0 4.4l-4.2-7.4h8.4z",
    "m-1.3-4.2h2.6v2.9h2.9v2.6h-2.9v2.9h-2.6v-2.9h-2.9v-2.6h2.9z",
    "m-4.2 0l2.1-3.7h4.2l2.1 3.7l-2.1 3.7h-4.2z",
    "m-3.6-3.9h7.2l-7.2 7.8h7.2z",
];

/// Markers of published points, hollow.
const HOLLOW: [&str; 4] =
    ["m0-6l6 6l-6 6l-6-6z", "m-5-5h10v10h-10z", "m0-6.5l6 10.5h-12z", "m-5.5 0a5.5 5.5 0 1 0 11 0a5.5 5.5 0 1 0-11 0"];

/// Lines of published values: dashes that no series has.
const PUBLISHED: [&str; 4] = ["7 5", "2 3", "12 3 2 3 2 3", "4 8"];

/// A line of a technical drawing, by what it is: outlines wide and solid, what helps to read them narrow (ISO 128-2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Line {
    Wide,
    Narrow,
    Dashed,
    DashDotted,
}

impl Line {
    /// By its name in a table.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "wide" => Some(Self::Wide),
            "narrow" => Some(Self::Narrow),
            "dashed" => Some(Self::Dashed),
            "dash-dotted" => Some(Self::DashDotted),
            _ => None,
        }
    }

    const fn dash(self) -> &'static str {
        match self {
            Self::Wide | Self::Narrow => "",
            Self::Dashed => "7 4",
            Self::DashDotted => "14 3 1 3",
        }
    }
}

/// A category's dashes and marker are counted apart from its colour: where colours come again, those do not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    pub colour: Colour,
    kind: usize,
    /// Of a drawing, where it is told.
    line: Option<Line>,
    /// Which of so many parts of what has its colour.
    part: [usize; 2],
}

/// Of what has no parts.
const WHOLE: [usize; 2] = [0, 1];

impl Look {
    /// Of a category, counted from 0.
    pub fn of(category: usize) -> Self {
        Self {
            colour: Colour::Of(category % KINDS),
            kind: (category + category / KINDS) % KINDS,
            line: None,
            part: WHOLE,
        }
    }

    /// Of a value on a ramp of so many; a solid line with round dots.
    pub fn on_ramp(index: usize, count: usize) -> Self {
        Self { colour: Colour::ramp(index, count), kind: 0, line: None, part: WHOLE }
    }

    /// The same colour with other dashes and another marker, and paler as a bar: the first part looks as the whole.
    pub fn part(self, index: usize, count: usize) -> Self {
        let step = (KINDS / count.max(1)).max(1);
        Self { kind: (self.kind + index * step) % KINDS, part: [index, count.max(1)], ..self }
    }

    /// As in a drawing, where bodies are solid: what is told to be, or the first two, which are told apart by where they
    /// are too.
    pub fn in_drawing(self, line: Option<Line>) -> Self {
        if self.kind < 2 { Self { kind: 0, line, ..self } } else { Self { line, ..self } }
    }

    pub const fn ink(kind: usize) -> Self {
        Self { colour: Colour::Ink, kind, line: None, part: WHOLE }
    }

    pub fn dash(self) -> &'static str {
        self.line.map_or(DASHES[self.kind % DASHES.len()], Line::dash)
    }

    /// Class and path of a marker.
    pub fn marker(self) -> (&'static str, &'static str) {
        let class = match self.kind % KINDS {
            0 => "dot",
            1 => "box",
            _ => "sign",
        };
        (class, MARKERS[self.kind % KINDS])
    }

    /// How dark a bar is.
    pub fn opacity(self) -> f64 {
        1.0 - self.part[0] as f64 / self.part[1] as f64
    }

    /// The style of a bar; a pale one has an outline.
    pub fn bar(self) -> String {
        let colour = self.colour.value();
        match self.part[0] {
            0 => self.colour.fill(),
            _ => format!(r#"style="fill:{colour};fill-opacity:{};stroke:{colour}""#, at(self.opacity())),
        }
    }

    pub fn published_dash(self) -> &'static str {
        PUBLISHED[self.kind % PUBLISHED.len()]
    }

    pub fn published_marker(self) -> &'static str {
        HOLLOW[self.kind % HOLLOW.len()]
    }

    /// The style of a line in it.
    pub fn stroke(self) -> String {
        let is_narrow = self.line.is_some_and(|line| line != Line::Wide);
        Self::stroked(self.colour, self.dash(), if is_narrow { ";stroke-width:1.1" } else { "" })
    }

    pub fn published_stroke(self) -> String {
        Self::stroked(self.colour, self.published_dash(), "")
    }

    fn stroked(colour: Colour, dash: &str, width: &str) -> String {
        let dashes = if dash.is_empty() { String::new() } else { format!(";stroke-dasharray:{dash}") };
        format!(r#"style="stroke:{}{dashes}{width}""#, colour.value())
    }
}

impl Colour {
    /// The place of one of `count` values; in the middle where there is one.
    pub fn ramp(index: usize, count: usize) -> Self {
        Self::along(if count > 1 { index as f64 / (count - 1) as f64 } else { 0.5 })
    }

    /// From 0 to 1 along blue over violet to orange: rising lightness, readable on white and on black.
    pub fn along(share: f64) -> Self {
        const STOPS: [[f64; 3]; 4] =
            [[49.0, 88.0, 196.0], [140.0, 80.0, 180.0], [208.0, 92.0, 120.0], [236.0, 158.0, 44.0]];
        let along = 3.0 * share.clamp(0.0, 1.0);
        let from = if along >= 2.0 { 2 } else { usize::from(along >= 1.0) };
        let share = along - from as f64;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between 0 and 255
        let mix =
            |channel: usize| (STOPS[from][channel] * (1.0 - share) + STOPS[from + 1][channel] * share).round() as u8;
        Self::Ramp([mix(0), mix(1), mix(2)])
    }

    pub fn value(self) -> String {
        match self {
            Self::Of(index) => format!("var(--s{index})"),
            Self::Ramp([red, green, blue]) => format!("#{red:02x}{green:02x}{blue:02x}"),
            Self::Ink => "var(--ink)".to_owned(),
        }
    }

    /// As a colour of its own.
    pub fn on_white(self) -> String {
        match self {
            Self::Of(index) => ON_WHITE[index % KINDS].to_owned(),
            Self::Ramp(_) => self.value(),
            Self::Ink => "#1b2230".to_owned(),
        }
    }

    pub fn stroke(self) -> String {
        format!(r#"style="stroke:{}""#, self.value())
    }

    pub fn fill(self) -> String {
        format!(r#"style="fill:{}""#, self.value())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_come_again_only_after_every_pair_of_colour_and_dash() {
        let looks: Vec<Look> = (0..KINDS * KINDS).map(Look::of).collect();
        for (index, look) in looks.iter().enumerate() {
            assert!(!looks[..index].contains(look), "{index}");
        }
        assert_eq!(Look::of(0).dash(), "", "the first line is solid");
        for (index, colour) in ON_WHITE.iter().enumerate() {
            let style = crate::report::plot::STYLE.split("@media").next().unwrap();
            assert!(style.contains(&format!("--s{index}:{colour}")), "{colour}");
        }
        assert!(PUBLISHED.iter().all(|dash| !DASHES.contains(dash)));
    }

    #[test]
    fn a_ramp_gets_lighter_all_the_way() {
        let light = |share| match Colour::along(share) {
            Colour::Ramp([red, green, blue]) => {
                0.2126 * f64::from(red) + 0.7152 * f64::from(green) + 0.0722 * f64::from(blue)
            }
            _ => f64::NAN,
        };
        let steps: Vec<f64> = (0..=20).map(|step| light(f64::from(step) / 20.0)).collect();
        assert!(steps.is_sorted_by(|one, other| one < other), "{steps:?}");
        assert_eq!(Colour::ramp(0, 1), Colour::along(0.5));
    }
}
