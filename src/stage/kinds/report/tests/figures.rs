//! Figures of a report on small tables.

use super::super::stated_figure::StatedMark;
use super::*;

pub(super) fn figure(changes: Fields) -> Value {
    let mut fields = vec![
        ("name", text("sweep")),
        ("title", text("Sweep")),
        ("kind", Value::Choice("line")),
        ("table", list(vec![text("ste.summary")])),
        ("x", text("torque")),
        ("y", list(vec![text("peak_to_peak")])),
        ("series", text("design")),
        ("log", Value::Choice("none")),
    ];
    for (name, value) in changes {
        match fields.iter_mut().find(|(field, _)| field == name) {
            Some(field) => field.1 = value.clone(),
            None => fields.push((name, value.clone())),
        }
    }
    group::<StatedFigure>(&fields)
}

#[test]
fn figures_are_checked_and_their_points_put_in_the_axes_units() {
    let mark =
        group::<StatedMark>(&[("x", text("50000 N mm")), ("y", text("0.002316 mm")), ("label", text("unmodified"))]);
    let across = group::<StatedMark>(&[("y", text("2.316 um")), ("label", text("Table 2"))]);
    let tables = run(vec![], vec![figure(&[("published", list(vec![mark, across]))])]).unwrap();
    let (figures, marks) = (&tables[2], &tables[3]);
    assert_eq!(figures.texts("tables"), ["ste.summary"]);
    assert!((marks.floats("x")[0] - 50.0).abs() < 1e-12 && marks.floats("x")[1].is_nan());
    assert_eq!(marks.floats("y")[1].to_bits(), 2.316_f64.to_bits());
    for (changes, message) in [
        (("x", text("torq")), "did you mean `torque`?"),
        (("x", text("design")), "holds texts"),
        (("y", list(vec![text("peak_to_peak"), text("seconds")])), "different units"),
        (("where", map(&[("design", "best")])), "no row has `design=best`"),
        (
            ("published", list(vec![group::<StatedMark>(&[("x", text("5 um")), ("label", text("p"))])])),
            "`5 um` is a length, but the axis shows a torque",
        ),
        (("published", list(vec![group::<StatedMark>(&[("label", text("p"))])])), "needs `x`, `y`, or both"),
        (("name", text("../x")), "not a name for a file"),
        (("name", text("NUL")), "`NUL` is not a name for a file: Windows keeps it for a device"),
        (("table", list(vec![text("ste")])), "is not a table"),
        (("reference", text("ste")), "is not a table"),
        (("reference", text("ste.summary")), "the reference must be one row; table `summary` has"),
    ] {
        let error = run(vec![], vec![figure(&[changes])]).unwrap_err();
        assert!(error.contains(message), "{message}: {error}");
    }
    assert!(run(vec![], vec![figure(&[]), figure(&[])]).unwrap_err().contains("two figures are called `sweep`"));
}

/// Energy methods have no mesh: a figure over its table fails nothing, whatever rows it asks for.
#[test]
fn a_figure_over_a_table_without_rows_is_a_warning() {
    let empty = Table::from_rows(summary().schema().clone(), Vec::new()).unwrap();
    let figures = || vec![figure(&[("where", map(&[("design", "best")]))])];
    let (tables, warned) = run_on(&empty, vec![], figures()).unwrap();
    assert_eq!(tables[2].texts("name"), ["sweep"]);
    assert_eq!(warned, ["figure `sweep`: table `ste.summary` has no rows"]);
    assert!(run(vec![], figures()).unwrap_err().contains("no row has `design=best`"));
}

/// Three torques, of which one is 0; a design without a value at one of the others; a published point, and a line across.
#[test]
fn points_that_a_logarithmic_axis_has_no_place_for_are_counted() {
    let rows = [0.0, 50.0, 100.0].into_iter().flat_map(|torque| {
        let row =
            |design: &'static str, value: f64| vec![design.into(), torque.into(), value.into(), 0.1.into(), 64.into()];
        [row("ga", if torque > 60.0 { f64::NAN } else { 1.0 }), row("iso", torque - 50.0)]
    });
    let summary = Table::from_rows(summary().schema().clone(), rows.collect()).unwrap();
    let mark = |x: &str| group::<StatedMark>(&[("x", text(x)), ("y", text("1 um")), ("label", text("p"))]);
    let across = group::<StatedMark>(&[("y", text("2 um")), ("label", text("q"))]);
    let marks = list(vec![mark("0 N m"), mark("5 N m"), across]);
    for (log, lost) in [("none", 0), ("x", 3), ("y", 2), ("both", 4)] {
        let drawn = figure(&[("log", Value::Choice(log)), ("published", marks.clone())]);
        let (_, warned) = run_on(&summary, vec![], vec![drawn]).unwrap();
        let said = format!("figure `sweep`: {lost} points at or below 0 are not drawn: an axis is logarithmic");
        assert_eq!(warned, if lost > 0 { vec![said] } else { vec![] }, "{log}");
    }
}
