//! Scales of a drawing that is true to scale: a millimetre is as long across as upwards.
//!
//! Must not know: SVG, tables.

use super::scale::Scale;

/// The lowest and the narrowest a drawing may be \[px\].
const FLATTEST: f64 = 160.0;
const NARROWEST: f64 = 240.0;

/// Both scales widened about their middles until a unit has one length, and the width and height of the drawing, within the
/// widest and the tallest; it is as narrow as what it shows.
#[must_use]
pub fn true_to_scale(x: Scale, y: Scale, widest: f64, tallest: f64) -> (Scale, Scale, f64, f64) {
    let (across, up) = (x.high - x.low, y.high - y.low);
    let unit = (across / widest).max(up / tallest);
    let (width, height) = ((across / unit).max(NARROWEST), (up / unit).max(FLATTEST));
    let widened = |scale: Scale, length: f64| {
        let (middle, half) = (0.5 * (scale.low + scale.high), 0.5 * unit * length);
        Scale { low: middle - half, high: middle + half, ..scale }
    };
    (widened(x, width), widened(y, height), width, height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::frame::Layout;
    use crate::report::look::Look;
    use crate::report::plot::{Kind, Plot, Series};

    #[test]
    fn a_unit_has_one_length_and_nothing_is_cut_off() {
        for (x, y) in [((-3.0, 4.0), (10.0, 12.0)), ((0.0, 1.0), (0.0, 50.0)), ((-9.0, 9.0), (5.0, 5.01))] {
            let scale = |(low, high)| Scale { low, high, is_log: false };
            let (across, up, width, height) = true_to_scale(scale(x), scale(y), 700.0, 480.0);
            let unit = |scale: Scale, length: f64| (scale.high - scale.low) / length;
            assert!((unit(across, width) / unit(up, height) - 1.0).abs() < 1e-12);
            let room = 1e-12;
            assert!(
                across.low <= x.0 + room && across.high >= x.1 - room && up.low <= y.0 + room && up.high >= y.1 - room
            );
            assert!((FLATTEST..=480.0).contains(&height) && (NARROWEST..=700.0).contains(&width));
            // What is drawn fills the drawing in one direction, in both unless the drawing would be too flat or narrow.
            let fills = |scale: Scale, (low, high): (f64, f64)| (scale.high - scale.low) / (high - low) < 1.0 + 1e-9;
            assert!(fills(across, x) || fills(up, y));
            assert!((fills(across, x) || width == NARROWEST) && (fills(up, y) || height == FLATTEST));
        }
    }

    #[test]
    fn a_drawing_without_another_beside_it_fills_its_row() {
        for aspect in [0.5, 1.2, 1.3, 1.35, 1.4, 1.5, 1.8, 2.5, 6.0] {
            let line = vec![(0.0, 0.0), (aspect, 0.0), (aspect, 1.0)];
            let plot = Plot { series: vec![Series::new("", vec![line])], ..Plot::new("t", Kind::Drawing) };
            // A page has 1104 px; a figure is enlarged by so much at most.
            let width = 1.3 * plot.extent(&plot.frame(0.0, Layout::PAGE).unwrap()).0;
            assert!(plot.narrow().is_some() || width > 0.9 * 1104.0, "{aspect}: {width} px");
        }
    }

    #[test]
    fn a_square_is_drawn_as_a_square() {
        let line = vec![(2.0, 30.0), (12.0, 30.0), (12.0, 40.0)];
        let plot = Plot { series: vec![Series::new("", vec![line])], ..Plot::new("square", Kind::Drawing) };
        let svg = plot.file();
        let path = svg.split(r#"class="series""#).nth(1).and_then(|rest| rest.split(r#"d="M"#).nth(1)).unwrap();
        let numbers: Vec<f64> =
            path.split('"').next().unwrap().split(['L', ' ']).map(|number| number.parse().unwrap()).collect();
        let [x0, y0, x1, y1, x2, y2] = numbers[..] else { panic!("{numbers:?}") };
        assert!((x1 - x0 - (y1 - y2)).abs() < 0.03 && (y0 - y1).abs() < 0.01 && (x1 - x2).abs() < 0.01, "{numbers:?}");
        assert!(!svg.contains(r#"class="dot""#) && !svg.contains(r#"class="jump""#), "{svg}");
        assert!(plot.narrow().is_some_and(|width| width < 600.0), "nothing stands beside a square");
        // A series of one point is a point with a name, and not in the legend.
        let mut named = plot;
        named.series.insert(0, Series { look: Look::ink(0), ..Series::new("A", vec![vec![(7.0, 35.0)]]) });
        let svg = named.file();
        assert!(svg.contains(r#"class="dot""#) && svg.matches(">A</text>").count() == 1, "{svg}");
        assert!(svg.contains(r#"class="series" style="stroke:var(--s0)""#), "{svg}");
    }
}
