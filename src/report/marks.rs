//! What stands on a figure by itself: published values, and the named points of a drawing.
//!
//! Must not know: lines, axes, tables.

use std::fmt::Write;

use super::frame::Frame;
use super::plot::{Kind, Plot, Series};
use super::svg::{at, escape};

/// Of a named point.
const MARKER: &str = "m0-6l6 6l-6 6l-6-6z";

/// Where a name may stand beside its point, the best first: anchor, and how far aside and below \[px\].
const BESIDE: [(&str, f64, f64); 8] = [
    ("start", 9.0, -8.0),
    ("end", -9.0, 18.0),
    ("end", -9.0, -8.0),
    ("start", 9.0, 18.0),
    ("middle", 0.0, -12.0),
    ("middle", 0.0, 24.0),
    ("start", 12.0, 5.0),
    ("end", -12.0, 5.0),
];

/// The room that a named point and its name take: left, right, top, bottom.
type Room = [f64; 4];

fn overlap(one: &Room, two: &Room) -> bool {
    one[0] < two[1] && two[0] < one[1] && one[2] < two[3] && two[2] < one[3]
}

/// A place for each name beside its point where it meets no other point and no name before it, if there is one.
fn places(frame: &Frame, points: &[(f64, f64, &str)]) -> Vec<(&'static str, f64, f64)> {
    let mut taken: Vec<Room> = points.iter().map(|(x, y, _)| [x - 3.5, x + 3.5, y - 3.5, y + 3.5]).collect();
    let place = |&(x, y, name): &(f64, f64, &str)| {
        // The letters are wider than those of a label, and as high above the line as wide.
        let long = 1.6 * frame.layout.character * name.chars().count() as f64;
        let room = |(anchor, aside, below): (&str, f64, f64)| {
            let before = match anchor {
                "start" => 0.0,
                "middle" => 0.5 * long,
                _ => long,
            };
            let left = x + aside - before;
            [left, left + long, y + below - 11.0, y + below + 1.0]
        };
        let is_free = |beside: &(&str, f64, f64)| taken.iter().all(|other| !overlap(&room(*beside), other));
        let chosen = BESIDE.into_iter().find(is_free).unwrap_or(BESIDE[0]);
        taken.push(room(chosen));
        chosen
    };
    points.iter().map(place).collect()
}

impl Plot {
    /// A series of a drawing that is made of single points is named where it stands, not in the legend.
    pub(super) fn is_named_point(&self, series: &Series) -> bool {
        self.kind == Kind::Drawing && series.runs.iter().all(|run| run.len() == 1)
    }

    pub(super) fn draw_named_points(&self, svg: &mut String, frame: &Frame) {
        let named = || self.series.iter().enumerate().filter(|(_, series)| self.is_named_point(series));
        let placed = |series: &Series| -> Vec<(f64, f64)> {
            series.runs.iter().flatten().filter_map(|&point| frame.place(point)).collect()
        };
        let of = |(_, series)| placed(series).into_iter().map(move |(x, y)| (x, y, series.label.as_str()));
        let points: Vec<(f64, f64, &str)> = named().flat_map(of).collect();
        let mut places = places(frame, &points).into_iter();
        for (index, series) in named() {
            let _ = write!(svg, r#"<g data-s="s{index}">"#);
            for ((x, y), (anchor, aside, below)) in placed(series).into_iter().zip(&mut places) {
                let (x, y, label) = (at(x), at(y), escape(&series.label));
                let _ = write!(
                    svg,
                    r#"<path class="dot" style="stroke:var(--ink)" d="M{x} {y}h0"/><text class="point" x="{x}" y="{y}" dx="{aside}" dy="{below}" text-anchor="{anchor}">{label}</text>"#
                );
            }
            svg.push_str("</g>");
        }
    }

    /// Points with their names beside them: of a design on a map or a front.
    pub(super) fn draw_named(&self, svg: &mut String, frame: &Frame) {
        for named in &self.named {
            let Some((x, y)) = frame.place(named.place) else { continue };
            // Beside the right edge there is no room on the right.
            let (anchor, aside) = if x > frame.left + 0.75 * frame.width { ("end", -9) } else { ("start", 9) };
            let below = if y < frame.top + 24.0 { 18 } else { -8 };
            let (x, y, name) = (at(x), at(y), escape(&named.name));
            let _ = write!(
                svg,
                r#"<path class="mark" style="stroke:var(--ink)" d="M{x} {y}{MARKER}"/><text class="point" x="{x}" y="{y}" dx="{aside}" dy="{below}" text-anchor="{anchor}">{name}</text>"#
            );
        }
    }

    pub(super) fn draw_marks(&self, svg: &mut String, frame: &Frame) {
        for mark in &self.marks {
            let x = mark.x.map(|x| frame.x(x)).filter(|x| x.is_finite());
            let y = mark.y.map(|y| frame.y(y)).filter(|y| y.is_finite());
            let (class, style, path) = match (x, y) {
                (Some(x), Some(y)) => {
                    let marker = mark.look.published_marker();
                    ("mark", mark.look.colour.stroke(), format!("M{} {}{marker}", at(x), at(y)))
                }
                (Some(x), None) if mark.y.is_none() => {
                    let path = format!("M{} {}V{}", at(x), at(frame.top), at(frame.bottom()));
                    ("dashes", mark.look.published_stroke(), path)
                }
                (None, Some(y)) if mark.x.is_none() => {
                    let path = format!("M{} {}H{}", at(frame.left), at(y), at(frame.right()));
                    ("dashes", mark.look.published_stroke(), path)
                }
                _ => continue,
            };
            let _ = write!(svg, r#"<g data-s="{}"><path class="{class}" {style} d="{path}"/></g>"#, self.key_of(mark));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::cells::Cells;
    use crate::report::frame::Layout;
    use crate::report::plot::Named;

    fn drawing(points: &[(&str, (f64, f64))]) -> Plot {
        let frame = Series::new("", vec![vec![(0.0, 0.0), (100.0, 0.0), (100.0, 40.0)]]);
        let named = points.iter().map(|(name, place)| Series::new(name, vec![vec![*place]]));
        Plot { series: std::iter::once(frame).chain(named).collect(), ..Plot::new("t", Kind::Drawing) }
    }

    /// Contact ratios from just one to just two: A beside B, and B, C and D beside each other.
    #[test]
    fn names_of_points_that_lie_close_together_stand_apart() {
        for ends in [0.1, 1.0, 4.0, 12.0, 19.0, 19.9] {
            let on = |s: f64| (30.0 + s, 10.0 + 0.36 * s);
            let points = [("A", 0.0), ("B", ends), ("C", 20.0), ("D", 40.0 - ends), ("E", 40.0)];
            let points = points.map(|(name, s)| (name, on(s)));
            let plot = drawing(&points);
            let frame = plot.frame(0.0, Layout::PAGE).unwrap();
            let placed = points.map(|(name, point)| frame.place(point).map(|(x, y)| (x, y, name)).unwrap());
            let names: Vec<Room> = places(&frame, &placed)
                .into_iter()
                .zip(placed)
                .map(|((anchor, aside, below), (x, y, _))| {
                    let left = x + aside
                        - match anchor {
                            "start" => 0.0,
                            "middle" => 5.5,
                            _ => 11.0,
                        };
                    [left, left + 11.0, y + below - 11.0, y + below]
                })
                .collect();
            for (index, name) in names.iter().enumerate() {
                assert!(names[..index].iter().all(|other| !overlap(name, other)), "{ends}: {names:?}");
                assert!(placed.iter().all(|(x, y, _)| !overlap(name, &[*x, *x, *y, *y])), "{ends}: {names:?}");
            }
            let svg = plot.inline();
            assert!(points.iter().all(|(name, _)| svg.contains(&format!(">{name}</text>"))), "{svg}");
        }
    }

    /// A name stands at its place, inside of the frame; one whose place is no number is left out.
    #[test]
    fn designs_are_named_where_they_lie_on_a_map() {
        let grid: Vec<(f64, f64, f64)> =
            (0..9).map(|at| (f64::from(at % 3), f64::from(at / 3), f64::from(at))).collect();
        let named = |name: &str, place| Named { name: name.to_owned(), place };
        let found = [named("found <1>", (0.5, 1.0)), named("right", (2.4, 2.4)), named("none", (f64::NAN, 1.0))];
        let cells = Cells::new(&grid, String::new(), String::new());
        let plot = Plot { cells, named: found.to_vec(), ..Plot::new("t", Kind::Map) };
        let (svg, frame) = (plot.inline(), plot.frame(8.0, Layout::PAGE).unwrap());
        for (name, place, anchor) in [("found &lt;1&gt;", (0.5, 1.0), "start"), ("right", (2.4, 2.4), "end")] {
            let [x, y] = [at(frame.x(place.0)), at(frame.y(place.1))];
            assert!(
                svg.contains(&format!(r#"d="M{x} {y}{MARKER}"/><text class="point" x="{x}" y="{y}""#)),
                "{name}: {svg}"
            );
            assert!(svg.contains(&format!(r#"text-anchor="{anchor}">{name}</text>"#)), "{name}: {svg}");
        }
        assert!(!svg.contains(">none<"));
    }
}
