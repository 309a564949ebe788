//! The legend that names what a figure shows: in a file beside the figure, in a page as buttons.
//!
//! Must not know: axes, data.

use std::fmt::Write;

use super::look::Look;
use super::svg::{at, escape};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    Line,
    LineAndMarker,
    Marker,
    Square,
    /// A band upon so many others.
    Band(usize),
    PublishedPoint,
    PublishedLine,
}

/// One entry of the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    pub label: String,
    /// Of what it shows and hides.
    pub key: String,
    pub sign: Sign,
    pub look: Look,
}

impl Item {
    fn width(&self, character: f64) -> f64 {
        45.0 + character * (1 + self.label.chars().count()) as f64
    }

    /// Its sign, 28 px wide, with its middle at a height of 7.
    #[must_use]
    pub fn swatch(&self) -> String {
        let (look, stroke) = (self.look, self.look.stroke());
        let line = || format!(r#"<path class="series" {stroke} d="M0 7h28"/>"#);
        let marker = || {
            let (class, shape) = look.marker();
            let style = if class == "sign" { look.colour.fill() } else { look.colour.stroke() };
            format!(r#"<path class="{class}" {style} d="M14 7{shape}"/>"#)
        };
        match self.sign {
            Sign::Line => line(),
            Sign::LineAndMarker => line() + &marker(),
            Sign::Marker => marker(),
            Sign::Square => format!(r#"<path class="bar" {} d="M8 1h12v12h-12z"/>"#, look.bar()),
            Sign::Band(below) => {
                format!(r#"<path {} fill-opacity=".2" d="M8 1h12v12h-12z"/>"#, look.colour.fill()).repeat(below + 1)
            }
            Sign::PublishedLine => format!(r#"<path class="dashes" {} d="M0 7h28"/>"#, look.published_stroke()),
            Sign::PublishedPoint => {
                format!(r#"<path class="mark" {} d="M14 7{}"/>"#, look.colour.stroke(), look.published_marker())
            }
        }
    }
}

/// Which entries stand in which row.
pub fn rows(items: &[Item], width: f64, character: f64) -> Vec<Vec<usize>> {
    let mut rows: Vec<Vec<usize>> = Vec::new();
    let mut used = f64::INFINITY;
    for (index, item) in items.iter().enumerate() {
        if used + item.width(character) > width - 50.0 {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += item.width(character);
        if let Some(row) = rows.last_mut() {
            row.push(index);
        }
    }
    rows
}

pub fn draw(svg: &mut String, items: &[Item], rows: &[Vec<usize>], (left, top): (f64, f64), character: f64) {
    for (nth, row) in rows.iter().enumerate() {
        let y = top + 14.0 + 22.0 * nth as f64;
        let mut x = left;
        for item in row.iter().map(|&index| &items[index]) {
            let _ = write!(
                svg,
                r#"<g transform="translate({} {})">{}<text class="legend" x="34" y="11.5">{}</text></g>"#,
                at(x),
                at(y - 7.0),
                item.swatch(),
                escape(&item.label)
            );
            x += item.width(character);
        }
    }
}
