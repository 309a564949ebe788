//! A contour as SVG, true to scale: a unit of the drawing is a mm, and so says its size.
//!
//! Source: SVG 1.1, chapters 7 and 8. The y axis points downwards there; what is drawn is the gear as seen, not its mirror
//! image. Must not know: how a contour comes about.

use std::f64::consts::PI;

use super::contour::{Contour, Piece};

/// Width of the lines \[mm\]: a hair, as cutters ask for.
const WIDTH: f64 = 0.05;

/// Room around the drawing, as a share of its size.
const MARGIN: f64 = 0.02;

#[must_use]
pub fn lines(contour: &Contour) -> Vec<String> {
    let corners = contour.points.iter().map(|point| point.at);
    let fold = |pick: fn(f64, f64) -> f64, start: f64| {
        corners.clone().fold([start; 2], |[x, y], at| [pick(x, at[0]), pick(y, at[1])])
    };
    // A whole gear reaches as far as its farthest point in every direction; on the axes lies none by necessity.
    let radius = corners.clone().map(|[x, y]| libm::hypot(x, y)).fold(0.0, f64::max);
    let (minimum, maximum) = if contour.closed {
        ([-radius; 2], [radius; 2])
    } else {
        (fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY))
    };
    let margin = MARGIN * (maximum[0] - minimum[0]).max(maximum[1] - minimum[1]) + WIDTH;
    let [width, height] = [0, 1].map(|axis| maximum[axis] - minimum[axis] + 2.0 * margin);
    let (left, top) = (minimum[0] - margin, -maximum[1] - margin);
    let mut lines = vec![
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" viewBox=\"{left} {top} \
             {width} {height}\">"
        ),
        format!("<title>{}</title>", contour.gear),
        format!("<g fill=\"none\" stroke=\"black\" stroke-width=\"{WIDTH}\" stroke-linejoin=\"round\">"),
        "<path d=\"".to_owned(),
    ];
    let place = |[x, y]: [f64; 2]| format!("{} {}", plain(x), plain(-y));
    if let Some(first) = contour.pieces.first() {
        lines.push(format!("M{}", place(contour.ends(first)[0])));
    }
    for piece in &contour.pieces {
        let end = place(contour.ends(piece)[1]);
        match piece {
            Piece::Line { .. } => lines.push(format!("L{end}")),
            Piece::Arc { radius, turn, .. } => {
                let (large, sweep) = (u8::from(turn.abs() > PI), u8::from(*turn < 0.0));
                lines.push(format!("A{radius} {radius} 0 {large} {sweep} {end}"));
            }
            Piece::Chords(range) => {
                lines.extend(contour.chords(range).into_iter().skip(1).map(|point| format!("L{}", place(point))));
            }
        }
    }
    if contour.closed {
        lines.push("Z".to_owned());
    }
    lines.push("\"/>".to_owned());
    if contour.closed && contour.bore_radius > 0.0 {
        lines.push(format!("<circle r=\"{}\"/>", contour.bore_radius));
    }
    lines.extend(["</g>".to_owned(), "</svg>".to_owned()]);
    lines
}

/// No minus zero.
fn plain(value: f64) -> f64 {
    value + 0.0
}
