//! Who looks how, over a whole page: a value has one colour in every figure.
//!
//! A quantity has its place on a ramp among all values of its column on the page. A word has the first look that no other
//! word has with which it stands in one figure. Must not know: how anything is drawn.

use std::collections::BTreeMap;

use super::look::Look;
use super::plot::{Kind, Of, Plot};

/// The values of a column on the page, ascending, by the column's name.
type Quantities = BTreeMap<String, Vec<f64>>;

/// Gives every series and every published mark its look.
pub fn assign<'a>(plots: impl Iterator<Item = &'a mut Plot>) {
    let mut plots: Vec<&mut Plot> = plots.collect();
    let (quantities, categories) = (quantities(&plots), categories(&plots));
    for plot in &mut plots {
        let points: Vec<bool> = plot.series.iter().map(|series| plot.is_named_point(series)).collect();
        for (series, is_point) in plot.series.iter_mut().zip(points) {
            series.look = match &series.of {
                _ if is_point => Look::ink(0),
                Of::Quantity { column, value } => {
                    let all = quantities.get(column).map_or(&[][..], Vec::as_slice);
                    let index = all.iter().position(|known| known.to_bits() == value.to_bits()).unwrap_or(0);
                    Look::on_ramp(index, all.len())
                }
                Of::Word => Look::of(categories.get(&series.label).copied().unwrap_or(0)),
            };
            if plot.kind == Kind::Drawing {
                series.look = series.look.in_drawing(series.line);
            }
        }
        // Of a series' name its colour; others are told apart by dashes and markers, in the order of the study.
        let mut others: Vec<String> = Vec::new();
        for mark in &mut plot.marks {
            let series = plot.series.iter().find(|series| series.label == mark.label || series.raw == mark.label);
            mark.look = series.map_or_else(
                || {
                    let known = others.iter().position(|label| *label == mark.label);
                    Look::ink(known.unwrap_or_else(|| {
                        others.push(mark.label.clone());
                        others.len() - 1
                    }))
                },
                |series| series.look,
            );
        }
    }
}

fn quantities(plots: &[&mut Plot]) -> Quantities {
    let mut found = Quantities::new();
    for series in plots.iter().flat_map(|plot| &plot.series) {
        if let Of::Quantity { column, value } = &series.of {
            let all = found.entry(column.clone()).or_default();
            if let Err(at) = all.binary_search_by(|known| known.total_cmp(value)) {
                all.insert(at, *value);
            }
        }
    }
    found
}

/// The looks of the words, by their labels.
fn categories(plots: &[&mut Plot]) -> BTreeMap<String, usize> {
    let words = |plot: &Plot| -> Vec<String> {
        let words = plot.series.iter().filter(|series| series.of == Of::Word && !plot.is_named_point(series));
        words.map(|series| series.label.clone()).collect()
    };
    let figures: Vec<Vec<String>> = plots.iter().map(|plot| words(plot)).collect();
    let mut chosen: BTreeMap<String, usize> = BTreeMap::new();
    for label in figures.iter().flatten() {
        if chosen.contains_key(label) {
            continue;
        }
        let beside = figures.iter().filter(|figure| figure.contains(label)).flatten();
        let taken: Vec<usize> = beside.filter_map(|other| chosen.get(other).copied()).collect();
        let free = (0..=taken.len()).find(|look| !taken.contains(look)).unwrap_or(0);
        chosen.insert(label.clone(), free);
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::look::Colour;
    use crate::report::plot::{Mark, Series};

    fn plot(series: &[(&str, Of)]) -> Plot {
        let series =
            series.iter().map(|(label, of)| Series { of: of.clone(), ..Series::new(label, vec![vec![(0.0, 1.0)]]) });
        Plot { series: series.collect(), ..Plot::new("t", Kind::Line) }
    }

    fn torque(value: f64) -> Of {
        Of::Quantity { column: "torque".to_owned(), value }
    }

    #[test]
    fn a_value_has_one_colour_on_the_page() {
        let mut plots = [
            plot(&[("iso", Of::Word), ("genetic", Of::Word)]),
            plot(&[("alone", Of::Word)]),
            plot(&[("genetic", Of::Word), ("long", Of::Word)]),
            plot(&[("50 N m", torque(50.0)), ("150 N m", torque(150.0))]),
            plot(&[("150 N m", torque(150.0)), ("100 N m", torque(100.0))]),
        ];
        assign(plots.iter_mut());
        let look = |plot: usize, series: usize| plots[plot].series[series].look;
        assert_eq!(look(0, 1), look(2, 0), "genetic");
        assert_ne!(look(0, 0), look(0, 1));
        assert_ne!(look(2, 0), look(2, 1));
        assert_eq!(look(1, 0), Look::of(0), "what stands with nobody has the first look");
        assert_eq!(look(2, 1), Look::of(0), "iso is in no figure with long");
        assert_eq!(look(3, 1), look(4, 0), "150 N m");
        assert_eq!((look(3, 0).colour, look(4, 1).colour), (Colour::ramp(0, 3), Colour::ramp(1, 3)));
    }

    #[test]
    fn twenty_words_of_one_figure_all_differ() {
        let names: Vec<String> = (0..20).map(|number| format!("design {number}")).collect();
        let mut plots = [plot(&names.iter().map(|name| (name.as_str(), Of::Word)).collect::<Vec<_>>())];
        assign(plots.iter_mut());
        let looks: Vec<Look> = plots[0].series.iter().map(|series| series.look).collect();
        for (index, look) in looks.iter().enumerate() {
            assert!(!looks[..index].contains(look), "{index}");
        }
    }

    #[test]
    fn two_published_lines_differ_and_one_of_a_series_has_its_colour() {
        let mark = |label: &str| Mark { label: label.to_owned(), x: None, y: Some(1.0), look: Look::ink(0) };
        let mut plots = [plot(&[("iso", Of::Word), ("genetic", Of::Word)])];
        plots[0].marks = vec![mark("Table 1"), mark("Table 2"), mark("genetic"), mark("Table 1")];
        assign(plots.iter_mut());
        let marks = &plots[0].marks;
        assert_ne!(marks[0].look.published_stroke(), marks[1].look.published_stroke());
        assert_eq!(marks[0].look, marks[3].look);
        assert_eq!(marks[2].look, plots[0].series[1].look);
    }
}
