//! What is made of all samples is what the rows say, and has the closed forms it must have.

use super::*;

/// Tier: second method; sorted and counted here.
#[test]
fn numbers_are_those_of_the_rows() {
    let text = scattered(
        &[AMOUNT, TILT, TORQUES],
        "samples: 200\nindices: 0\noutputs: [peak_to_peak, mean]\nlimits: [peak_to_peak <= 3.7 um, mean <= 13 um]\nquantiles: [10 %, 50 %]",
    );
    let (of, _) = ran(&text);
    let rows = of("rows");
    let at_torque = |torque: f64, column: &str| -> Vec<f64> {
        let own = (0..rows.rows()).filter(|row| (rows.floats("torque")[*row] - torque).abs() < 1e-9);
        own.map(|row| rows.floats(column)[row]).collect()
    };
    let statistics = of("statistics");
    assert_eq!(statistics.rows(), 6);
    for at in 0..6 {
        let (output, torque) = (&statistics.texts("output")[at], statistics.floats("torque")[at]);
        let values = at_torque(torque, output);
        assert_eq!(values.len(), 200);
        let mean = values.iter().sum::<f64>() / 200.0;
        assert!((statistics.floats("mean")[at] / mean - 1.0).abs() < 1e-12);
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        assert!((statistics.floats("standard_deviation")[at] / (squares / 199.0).sqrt() - 1.0).abs() < 1e-9);
        // Replicates come in turn.
        let means: Vec<f64> = (0..8).map(|first| values.iter().skip(first).step_by(8).sum::<f64>() / 25.0).collect();
        let spread: f64 = means.iter().map(|own| (own - mean) * (own - mean)).sum();
        assert!((statistics.floats("mean_error")[at] / (spread / 56.0).sqrt() - 1.0).abs() < 1e-9);
    }
    let quantiles = of("quantiles");
    for at in 0..quantiles.rows() {
        let mut values = at_torque(quantiles.floats("torque")[at], &quantiles.texts("output")[at]);
        values.sort_by(f64::total_cmp);
        let below = if quantiles.floats("share")[at] < 0.2 { 19 } else { 99 };
        let exact = 0.5 * (values[below] + values[below + 1]);
        assert!((quantiles.floats("value")[at] / exact - 1.0).abs() < 1e-12);
        assert!(quantiles.floats("error")[at] > 0.0);
    }
    let (yields, torques) = (of("yield"), [25.0, 50.0, 100.0]);
    let kept = |limit: &str, case: i64| {
        let at = (0..yields.rows())
            .find(|at| yields.texts("limit")[*at] == limit && yields.integers("case")[*at] == case)
            .unwrap();
        yields.integers("kept")[at]
    };
    let holds = |sample: usize, torque: f64| at_torque(torque, "peak_to_peak")[sample] <= 3.7;
    let count =
        |keeps: &dyn Fn(usize) -> bool| i64::try_from((0..200).filter(|sample| keeps(*sample)).count()).unwrap();
    assert_eq!(kept("valid", 0), 200);
    assert_eq!(kept("peak_to_peak <= 3.7 um", 3), count(&|sample| holds(sample, 100.0)));
    let all = count(&|sample| torques.iter().all(|torque| holds(sample, *torque)));
    assert_eq!(kept("peak_to_peak <= 3.7 um", 0), all);
    let both = count(&|sample| {
        torques.iter().all(|torque| holds(sample, *torque) && at_torque(*torque, "mean")[sample] <= 13.0)
    });
    assert_eq!(kept("all limits", 0), both);
    assert!(all > 0 && all < 200, "the limit tells samples apart: {all}");
    let bins = of("distribution");
    assert_eq!(bins.integers("samples").iter().sum::<i64>(), 6 * 200);
}

/// Tier: closed form. Under linear contact a tilt that leaves the whole face in contact changes nothing, and the mean deflection
/// without relief is proportional to the torque: one field has all of the variance, the other none.
#[test]
fn indices_know_what_decides() {
    let torque = "torque: { field: ste.torque, within: ± 20 N m }";
    let tilt = "tilt: { field: ste.helix_slope, within: ± 0.2 um }";
    let text = scattered(&[torque, tilt], "samples: 256\nindices: 256\noutputs: [mean]");
    let text = text.replace(DESIGN, "\n  designs: { kind: modification, pair: pair, designs: { plain: [] } }\n");
    let (of, _) = ran(&text);
    let indices = of("indices");
    for at in 0..2 {
        let [first, total] = ["first_order", "total"].map(|column| indices.floats(column)[at]);
        let errors = ["first_order_error", "total_error"].map(|column| indices.floats(column)[at]);
        if indices.texts("field")[at] == "torque" {
            assert!((first - 1.0).abs() < 5.0 * errors[0] && (total - 1.0).abs() < 5.0 * errors[1], "{first} {total}");
            assert!(errors[0] < 0.05 && errors[1] < 0.05, "{errors:?}");
        } else {
            assert!(first.abs() < 1e-9 && total.abs() < 1e-9, "{first} {total}");
        }
        assert_eq!(indices.integers("pairs")[at], 256);
    }
    // The mean of a symmetric distribution through a straight line is the line's middle.
    let (statistics, ste) = (of("statistics"), walk(&load(&text)));
    let summary = ste["ste"].tables.iter().find(|table| table.name() == "summary").unwrap();
    let (mean, error) = (statistics.floats("mean")[0], statistics.floats("mean_error")[0]);
    assert!((mean - summary.floats("mean")[0]).abs() < 5.0 * error && error < 1e-3 * mean, "{mean} {error}");
}

/// Tier: somebody else's implementation; SALib, from the same numbers. Totals are one formula. First orders are about another
/// mean there, which moves them by less than their own errors.
#[test]
fn another_program_finds_the_same_indices() {
    let text = scattered(
        &[AMOUNT, TILT, &TORQUES.replace("25 N m, 50 N m, 100 N m", "50 N m")],
        "samples: 128\nindices: 128\noutputs: [peak_to_peak]",
    );
    let (of, _) = ran(&text);
    let (rows, indices) = (of("rows"), of("indices"));
    let values = rows.floats("peak_to_peak");
    // Two fields: itself, with either of them, and with both.
    let at = |which: usize| -> Vec<f64> { values.chunks(4).map(|sample| sample[which]).collect() };
    let replaced: Vec<[f64; 2]> = values.chunks(4).map(|sample| [sample[1], sample[2]]).collect();
    let given = serde_json::json!({ "first": at(0), "second": at(3), "replaced": replaced });
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("values.json");
    std::fs::write(&file, given.to_string()).unwrap();
    let Some(said) = crate::python::run("salib_indices.py", &[file.as_os_str()]) else { return };
    if said.trim().is_empty() {
        eprintln!("SKIPPED: tests/python/salib_indices.py: there is no SALib");
        return;
    }
    let found: serde_json::Value = serde_json::from_str(&said).unwrap();
    for (place, field) in ["amount", "tilt"].into_iter().enumerate() {
        let at = (0..2).find(|at| indices.texts("field")[*at] == field).unwrap();
        let theirs = |which: &str| found[which][place].as_f64().unwrap();
        let total = indices.floats("total")[at];
        assert!((total / theirs("total") - 1.0).abs() < 1e-9, "{field}: {total} {}", theirs("total"));
        let (first, error) = (indices.floats("first_order")[at], indices.floats("first_order_error")[at]);
        assert!((first - theirs("first")).abs() < error, "{field}: {first} ± {error}, {}", theirs("first"));
    }
}

/// Fields that go together: the rank correlation is that of the copula, and there are no indices.
#[test]
fn correlated_fields_go_together() {
    let text = scattered(
        &[AMOUNT, TILT],
        "samples: 1024\nindices: 64\ncorrelations: [{ between: [amount, tilt], is: 0.7 }]\noutputs: [unloaded_peak_to_peak]",
    );
    let (of, _) = ran(&text);
    let rows = of("rows");
    assert_eq!((rows.rows(), of("indices").rows()), (1024, 0));
    let ranks = |name: &str| {
        let values = rows.floats(name);
        let mut order: Vec<usize> = (0..1024).collect();
        order.sort_by(|one, two| values[*one].total_cmp(&values[*two]));
        let mut ranks = vec![0.0; 1024];
        order.iter().enumerate().for_each(|(rank, at)| ranks[*at] = rank as f64 / 1024.0 - 0.5);
        ranks
    };
    let (one, two) = (ranks("amount"), ranks("tilt"));
    let found = 12.0 * one.iter().zip(&two).map(|(one, two)| one * two).sum::<f64>() / 1024.0;
    let exact = 6.0 / std::f64::consts::PI * 0.35_f64.asin();
    assert!((found - exact).abs() < 0.02, "{found} {exact}");
}
