//! Colours of series, and the legend that names them.
//!
//! Must not know: axes, data.

use std::fmt::Write;

use super::svg::{CHARACTER, at, escape};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Colour {
    /// One of the style's colours, made to be told apart by colour-blind readers.
    Of(usize),
    /// Along a ramp, red, green, blue.
    Ramp([u8; 3]),
    /// That of the text.
    Ink,
}

impl Colour {
    pub fn ramp(index: usize, count: usize) -> Self {
        // Blue over violet to orange: rising lightness, readable on white and on black.
        const STOPS: [[f64; 3]; 4] =
            [[49.0, 88.0, 196.0], [140.0, 80.0, 180.0], [208.0, 92.0, 120.0], [236.0, 158.0, 44.0]];
        let along = 3.0 * index as f64 / (count - 1) as f64;
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

    pub fn stroke(self) -> String {
        format!(r#"style="stroke:{}""#, self.value())
    }

    pub fn fill(self) -> String {
        format!(r#"style="fill:{}""#, self.value())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    Line,
    Dot,
    Square,
    Diamond,
    Dashes,
}

/// One entry of the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    pub label: String,
    pub sign: Sign,
    pub colour: Colour,
}

impl Item {
    fn width(&self) -> f64 {
        52.0 + CHARACTER * self.label.chars().count() as f64
    }
}

/// Which entries stand in which row.
pub fn rows(items: &[Item], width: f64) -> Vec<Vec<usize>> {
    let mut rows: Vec<Vec<usize>> = Vec::new();
    let mut used = f64::INFINITY;
    for (index, item) in items.iter().enumerate() {
        if used + item.width() > width - 70.0 {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += item.width();
        if let Some(row) = rows.last_mut() {
            row.push(index);
        }
    }
    rows
}

pub fn draw(svg: &mut String, items: &[Item], rows: &[Vec<usize>], left: f64, top: f64) {
    for (nth, row) in rows.iter().enumerate() {
        let y = top + 14.0 + 22.0 * nth as f64;
        let mut x = left;
        for &index in row {
            let Item { label, sign, colour } = &items[index];
            let (stroke, fill) = (colour.stroke(), colour.fill());
            let (x0, y0) = (at(x), at(y));
            let _ = match sign {
                Sign::Line => write!(svg, r#"<path class="series" {stroke} d="M{x0} {y0}h24"/>"#),
                Sign::Dashes => write!(svg, r#"<path class="dashes" {stroke} d="M{x0} {y0}h24"/>"#),
                Sign::Dot => write!(svg, r#"<circle {fill} cx="{}" cy="{y0}" r="3.6"/>"#, at(x + 12.0)),
                Sign::Square => {
                    write!(svg, r#"<rect {fill} x="{}" y="{}" width="12" height="12"/>"#, at(x + 6.0), at(y - 6.0))
                }
                Sign::Diamond => write!(
                    svg,
                    r#"<path class="mark" {stroke} d="M{} {}l6 6l-6 6l-6 -6z"/>"#,
                    at(x + 12.0),
                    at(y - 6.0)
                ),
            };
            let _ = write!(
                svg,
                r#"<text class="legend" x="{}" y="{}">{}</text>"#,
                at(x + 31.0),
                at(y + 4.5),
                escape(label)
            );
            x += items[index].width();
        }
    }
}
