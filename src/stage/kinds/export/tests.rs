//! A gear of plain curves, whose area and flanks are known in closed form, through every step of an export.

use std::f64::consts::PI;

use super::contour::{Contour, Piece, contours};
use super::{dxf, svg};
use studygraph::table::data::{Row, Table};
use studygraph::table::schema::{Column, Schema};

const TEETH: usize = 17;
const BASE: f64 = 11.981_081;
const ROOT: f64 = 10.875;
const TIP_ROLL: f64 = 0.64;
const HALF_BASE_ANGLE: f64 = 0.107_304_2;
const BORE: f64 = 4.0;

/// Position, direction, curvature.
type Local = ([f64; 2], f64, f64);

/// Right flank at a roll angle; the curvature is infinite where it begins.
fn flank(roll: f64) -> Local {
    let (sine, cosine) = libm::sincos(roll - HALF_BASE_ANGLE);
    let curvature = if roll > 0.0 { 1.0 / (BASE * roll) } else { f64::NAN };
    ([BASE * (roll * cosine - sine), BASE * (cosine + roll * sine)], libm::atan2(cosine, -sine), curvature)
}

/// A circle about the gear's centre, at an angle clockwise from the y axis.
fn round(radius: f64, angle: f64) -> Local {
    let (sine, cosine) = libm::sincos(angle);
    ([radius * sine, radius * cosine], libm::atan2(sine, -cosine), 1.0 / radius)
}

fn left(([x, y], direction, curvature): Local) -> Local {
    ([-x, y], -direction, curvature)
}

fn tip_angle() -> f64 {
    HALF_BASE_ANGLE - (TIP_ROLL - libm::atan(TIP_ROLL))
}

fn tip_radius() -> f64 {
    BASE * libm::hypot(1.0, TIP_ROLL)
}

/// Curve by curve, counterclockwise from the space on the right; each flank has so many chords.
fn tooth(chords: usize) -> Vec<(&'static str, Vec<Local>)> {
    let share = |place: usize| place as f64 / chords as f64;
    let arc = |radius: f64, from: f64, to: f64| -> Vec<Local> {
        (0..=4).map(|place| round(radius, from + 0.25 * f64::from(place) * (to - from))).collect()
    };
    let upwards: Vec<Local> = (0..=chords).map(|place| flank(TIP_ROLL * share(place).sqrt())).collect();
    let foot: Vec<Local> = {
        let (sine, cosine) = libm::sincos(HALF_BASE_ANGLE);
        [ROOT, BASE].map(|radius| ([radius * sine, radius * cosine], libm::atan2(cosine, sine), 0.0)).to_vec()
    };
    let mirrored = |curve: &[Local]| curve.iter().rev().map(|local| left(*local)).collect::<Vec<_>>();
    let space = PI / TEETH as f64;
    vec![
        ("arc", arc(ROOT, space, HALF_BASE_ANGLE)),
        ("line", foot.clone()),
        ("involute", upwards.clone()),
        ("arc", arc(tip_radius(), tip_angle(), -tip_angle())),
        ("involute", mirrored(&upwards)),
        ("line", mirrored(&foot)),
        ("arc", arc(ROOT, -HALF_BASE_ANGLE, -space)),
    ]
}

fn outline(chords: usize, teeth: usize, spoil: f64) -> Table {
    let columns = vec![
        Column::text("gear", "Gear.").key(),
        Column::integer("tooth", "Tooth.").key(),
        Column::integer("point", "Point.").key(),
        Column::integer("stretch", "Stretch."),
        Column::text("part", "Part."),
        Column::text("curve", "Curve."),
        Column::float("x", "mm", "Across."),
        Column::float("y", "mm", "Up."),
        Column::float("direction", "deg", "Direction."),
        Column::float("curvature", "1/mm", "Curvature.").allows_nan(),
    ];
    let mut rows: Vec<Row> = Vec::new();
    for number in 0..teeth {
        let turned = 2.0 * PI * number as f64 / TEETH as f64;
        let (sine, cosine) = libm::sincos(turned);
        let mut point = 0_usize;
        for (stretch, (curve, locals)) in tooth(chords).into_iter().enumerate() {
            for ([x, y], direction, curvature) in locals {
                point += 1;
                let spoiled = if point == 3 { spoil } else { 0.0 };
                rows.push(vec![
                    "pinion".into(),
                    (number + 1).into(),
                    point.into(),
                    (stretch + 1).into(),
                    "part".into(),
                    curve.into(),
                    (cosine * x - sine * y + spoiled).into(),
                    (sine * x + cosine * y).into(),
                    (direction + turned).to_degrees().into(),
                    curvature.into(),
                ]);
            }
        }
    }
    Table::from_rows(Schema::new("outline", "Points.", columns), rows).unwrap()
}

fn gears() -> Table {
    let columns = vec![Column::text("gear", "Gear.").key(), Column::float("bore_radius", "mm", "Bore.")];
    Table::from_rows(Schema::new("gears", "Gears.", columns), vec![vec!["pinion".into(), BORE.into()]]).unwrap()
}

fn contour(chords: usize, teeth: usize) -> Contour {
    contours(&outline(chords, teeth, 0.0), &gears()).unwrap().remove(0)
}

/// Signed distance of a point to the right flank of tooth 1, along the flank's normal: closed form.
fn from_flank([x, y]: [f64; 2]) -> f64 {
    let tangent = ((x - BASE) * (x + BASE) + y * y).max(0.0).sqrt();
    let roll = libm::atan2(-x, y) + libm::atan(tangent / BASE) + HALF_BASE_ANGLE;
    tangent - BASE * roll
}

#[test]
fn the_whole_gear_is_closed_and_made_of_the_right_curves() {
    let whole = contour(40, TEETH);
    assert!(whole.closed && whole.gap() < 1e-13, "{:e}", whole.gap());
    assert_eq!(whole.counts(), [2 * TEETH, 3 * TEETH, 2 * TEETH]);
    for piece in &whole.pieces {
        if let Piece::Arc { centre, radius, from, turn, ends } = piece {
            assert!(centre.iter().all(|part| part.abs() < 1e-13), "{centre:?}");
            for (angle, end) in [(*from, ends[0]), (from + turn, ends[1])] {
                let (sine, cosine) = libm::sincos(angle);
                let missed = libm::hypot(centre[0] + radius * cosine - end[0], centre[1] + radius * sine - end[1]);
                assert!(missed < 1e-12, "{missed:e}");
            }
        }
    }
    let one = contour(40, 1);
    assert!(!one.closed && one.gap() < 1e-13 && one.area().is_nan() && one.counts() == [2, 3, 2]);
}

/// Tier: closed form and order of convergence. An involute sweeps r_b² t³/6 about the centre.
#[test]
fn the_area_tends_to_the_analytic_one_with_the_square_of_the_points() {
    let exact = TEETH as f64
        * (ROOT * ROOT * (PI / TEETH as f64 - HALF_BASE_ANGLE)
            + BASE * BASE * TIP_ROLL.powi(3) / 3.0
            + tip_radius() * tip_radius() * tip_angle())
        - PI * BORE * BORE;
    let missed = |chords| exact - contour(chords, TEETH).area();
    let ratio = missed(20) / missed(40);
    assert!(missed(40) > 0.0 && missed(40) < 1e-4 * exact, "{} of {exact}", missed(40));
    assert!((ratio - 4.0).abs() < 0.2, "{ratio}");
}

/// Tier: closed form. The stated error holds the true one, and is not more than twice it.
#[test]
fn no_chord_is_farther_from_the_involute_than_stated() {
    for chords in [3, 10, 60] {
        let contour = contour(chords, 1);
        let Some(Piece::Chords(range)) = contour.pieces.get(2) else { panic!("{:?}", contour.pieces) };
        let points = contour.chords(range);
        let mut largest = 0.0_f64;
        for pair in points.windows(2) {
            for step in 0..=20 {
                let share = f64::from(step) / 20.0;
                let at = [0, 1].map(|axis| pair[0][axis] + share * (pair[1][axis] - pair[0][axis]));
                // Chords lie inside; below the base circle there is no flank.
                if libm::hypot(at[0], at[1]) > BASE {
                    largest = largest.max(-from_flank(at));
                }
            }
        }
        let stated = contour.chord_error();
        assert!(largest > 0.0 && largest <= stated, "{chords}: {largest:e} {stated:e}");
        assert!(stated < 2.6 * largest, "{chords}: {largest:e} {stated:e}");
    }
}

#[test]
fn a_point_beside_its_arc_is_refused() {
    let refused = contours(&outline(4, 1, 1e-6), &gears()).unwrap_err().to_string();
    assert!(refused.contains("point 3 of tooth 1 of the pinion lies on no arc"), "{refused}");
}

#[test]
fn a_drawing_says_its_unit_and_scale() {
    let lines = dxf::lines(&contour(10, TEETH));
    let pairs: Vec<(&str, &str)> = lines.chunks(2).map(|pair| (pair[0].as_str(), pair[1].as_str())).collect();
    assert_eq!(lines.len() % 2, 0);
    assert!(lines.iter().all(|line| !line.contains('\n')));
    let at = pairs.iter().position(|pair| *pair == ("9", "$INSUNITS")).unwrap();
    assert_eq!(pairs[at + 1], ("70", "4"));
    assert_eq!(pairs.iter().filter(|pair| **pair == ("0", "ARC")).count(), 3 * TEETH);
    assert_eq!(pairs.last(), Some(&("0", "EOF")));
    // A handle is given once.
    let mut handles: Vec<&str> =
        pairs.iter().filter(|(code, _)| ["5", "105"].contains(code)).map(|(_, h)| *h).collect();
    let all = handles.len();
    handles.sort_unstable();
    handles.dedup();
    // The header names the next one, which nobody has.
    assert_eq!(handles.len(), all);

    let text = svg::lines(&contour(10, TEETH)).join("\n");
    let number = |name: &str| -> f64 {
        let begin = text.find(&format!("{name}=\"")).unwrap() + name.len() + 2;
        let end = begin + text[begin..].find(['m', '"']).unwrap();
        text[begin..end].parse().unwrap()
    };
    let view: Vec<f64> = {
        let begin = text.find("viewBox=\"").unwrap() + 9;
        let end = begin + text[begin..].find('"').unwrap();
        text[begin..end].split(' ').map(|part| part.parse().unwrap()).collect()
    };
    assert!((number("width") - view[2]).abs() < 1e-12 && (number("height") - view[3]).abs() < 1e-12);
    assert!(view[2] > 2.0 * tip_radius() && view[2] < 2.2 * tip_radius() && view[0] < -tip_radius());
    assert_eq!(text.matches("\nA").count(), 3 * TEETH);
}
