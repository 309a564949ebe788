//! Who looks how, over a whole page: a value has one colour in every figure.
//!
//! A quantity has its place on a ramp among all values of its column on the page. A word has the first look that no other
//! word has with which it stands in one figure. What is named by two things, a stage and a column, has the colour of one and
//! dashes, marker or shade of the other: `ste, mean` and `ste` are of one stage. Must not know: how anything is drawn.

use std::collections::BTreeMap;

use super::look::Look;
use super::plot::{Kind, Of, Plot, Series};

/// The values of a column on the page, ascending, by the column's name.
type Quantities = BTreeMap<String, Vec<f64>>;

/// Gives every series and every published mark its look.
pub fn assign<'a>(plots: impl Iterator<Item = &'a mut Plot>) {
    let mut plots: Vec<&mut Plot> = plots.collect();
    let leads = leads(&plots);
    let named = |pick: &dyn Fn(&Series, usize) -> Option<String>| -> Vec<Vec<String>> {
        let of = |(plot, lead): (&&mut Plot, &usize)| {
            let series = plot.series.iter().filter(|series| !plot.is_named_point(series));
            series.filter_map(|series| pick(series, *lead)).collect()
        };
        plots.iter().zip(&leads).map(of).collect()
    };
    let word = |series: &Series, lead: usize| match series.of.get(lead) {
        Some(Of::Word(word)) => Some(word.clone()),
        _ => None,
    };
    let categories = apart(&named(&word));
    let parts = apart(&named(&part));
    let count = 1 + parts.values().copied().max().unwrap_or(0);
    let quantities = quantities(&plots);
    for (plot, lead) in plots.iter_mut().zip(leads) {
        let points: Vec<bool> = plot.series.iter().map(|series| plot.is_named_point(series)).collect();
        for (series, is_point) in plot.series.iter_mut().zip(points) {
            series.look = match series.of.get(lead) {
                _ if is_point => Look::ink(0),
                Some(Of::Quantity { column, value }) => {
                    let all = quantities.get(column).map_or(&[][..], Vec::as_slice);
                    let index = all.iter().position(|known| known.to_bits() == value.to_bits()).unwrap_or(0);
                    Look::on_ramp(index, all.len())
                }
                Some(Of::Word(word)) => Look::of(categories.get(word).copied().unwrap_or(0)),
                None => Look::of(0),
            };
            if let Some(index) = part(series, lead).and_then(|part| parts.get(&part)).filter(|_| !is_point) {
                series.look = series.look.part(*index, count);
            }
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

/// By which of its names a series has its colour, for each figure: the first one, unless only those of another one are alone
/// in a figure of the page and so have a colour of their own.
fn leads(plots: &[&mut Plot]) -> Vec<usize> {
    let series = plots.iter().flat_map(|plot| &plot.series);
    let alone: Vec<&Of> = series.filter_map(|series| if let [of] = &series.of[..] { Some(of) } else { None }).collect();
    let lead = |plot: &&mut Plot| {
        let is_alone =
            |at: usize| plot.series.iter().all(|series| series.of.get(at).is_some_and(|of| alone.contains(&of)));
        let most = plot.series.iter().map(|series| series.of.len()).max().unwrap_or(0);
        (0..most).find(|at| is_alone(*at)).unwrap_or(0)
    };
    plots.iter().map(lead).collect()
}

/// All that a series is named by beside what it has its colour of.
fn part(series: &Series, lead: usize) -> Option<String> {
    let others = series.of.iter().enumerate().filter(|(at, _)| *at != lead).map(|(_, of)| match of {
        Of::Word(word) => word.clone(),
        Of::Quantity { column, value } => format!("{column}={value}"),
    });
    let others: Vec<String> = others.collect();
    (!others.is_empty()).then(|| others.join(", "))
}

fn quantities(plots: &[&mut Plot]) -> Quantities {
    let mut found = Quantities::new();
    for of in plots.iter().flat_map(|plot| &plot.series).flat_map(|series| &series.of) {
        if let Of::Quantity { column, value } = of {
            let all = found.entry(column.clone()).or_default();
            if let Err(at) = all.binary_search_by(|known| known.total_cmp(value)) {
                all.insert(at, *value);
            }
        }
    }
    found
}

/// A number for each word: the first that no other has with which it stands in one figure.
fn apart(figures: &[Vec<String>]) -> BTreeMap<String, usize> {
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
    use crate::report::plot::Mark;

    fn plot(series: &[(&str, Vec<Of>)]) -> Plot {
        let series =
            series.iter().map(|(label, of)| Series { of: of.clone(), ..Series::new(label, vec![vec![(0.0, 1.0)]]) });
        Plot { series: series.collect(), ..Plot::new("t", Kind::Line) }
    }

    fn words<'a>(names: &[&'a str]) -> (&'a str, Vec<Of>) {
        (names[0], names.iter().map(|name| Of::Word((*name).to_owned())).collect())
    }

    fn torque(value: f64) -> Vec<Of> {
        vec![Of::Quantity { column: "torque".to_owned(), value }]
    }

    #[test]
    fn a_value_has_one_colour_on_the_page() {
        let mut plots = [
            plot(&[words(&["iso"]), words(&["genetic"])]),
            plot(&[words(&["alone"])]),
            plot(&[words(&["genetic"]), words(&["long"])]),
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

    /// Stages, and columns of them; designs, and stages with each.
    #[test]
    fn what_two_things_name_has_the_colour_of_the_one_that_stands_alone() {
        let of = [["stiff", "mean"], ["stiff", "peak"], ["soft", "mean"], ["soft", "peak"]];
        let mut plots = [
            plot(&[words(&["stiff"]), words(&["half"]), words(&["soft"])]),
            plot(&of.each_ref().map(|names| words(names))),
            plot(&[words(&["long"]), words(&["short"])]),
            plot(&[words(&["fine", "long"]), words(&["fine", "short"]), words(&["coarse", "long"])]),
        ];
        assign(plots.iter_mut());
        let look = |plot: usize, series: usize| plots[plot].series[series].look;
        assert_eq!((look(1, 0).colour, look(1, 2).colour), (look(0, 0).colour, look(0, 2).colour));
        assert_eq!((look(1, 1).colour, look(1, 3).colour), (look(0, 0).colour, look(0, 2).colour));
        assert_eq!((look(3, 0).colour, look(3, 1).colour), (look(2, 0).colour, look(2, 1).colour));
        for plot in [1, 3] {
            let looks: Vec<(&str, String)> =
                plots[plot].series.iter().map(|series| (series.look.dash(), series.look.bar())).collect();
            for (index, (dash, bar)) in looks.iter().enumerate() {
                assert!(looks[..index].iter().all(|other| other.0 != *dash && other.1 != *bar), "{looks:?}");
            }
        }
        assert!(look(1, 1).bar().contains("fill-opacity:0.5;"), "{}", look(1, 1).bar());
    }

    #[test]
    fn twenty_words_of_one_figure_all_differ() {
        let names: Vec<String> = (0..20).map(|number| format!("design {number}")).collect();
        let mut plots = [plot(&names.iter().map(|name| words(&[name.as_str()])).collect::<Vec<_>>())];
        assign(plots.iter_mut());
        let looks: Vec<Look> = plots[0].series.iter().map(|series| series.look).collect();
        for (index, look) in looks.iter().enumerate() {
            assert!(!looks[..index].contains(look), "{index}");
        }
    }

    #[test]
    fn two_published_lines_differ_and_one_of_a_series_has_its_colour() {
        let mark = |label: &str| Mark { label: label.to_owned(), x: None, y: Some(1.0), look: Look::ink(0) };
        let mut plots = [plot(&[words(&["iso"]), words(&["genetic"])])];
        plots[0].marks = vec![mark("Table 1"), mark("Table 2"), mark("genetic"), mark("Table 1")];
        assign(plots.iter_mut());
        let marks = &plots[0].marks;
        assert_ne!(marks[0].look.published_stroke(), marks[1].look.published_stroke());
        assert_eq!(marks[0].look, marks[3].look);
        assert_eq!(marks[2].look, plots[0].series[1].look);
    }
}
