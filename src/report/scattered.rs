//! The figures of a scatter that declares none: how its first output lies, its bands over what is looked at in every sample,
//! what it depends on.
//!
//! Must not know: how anything is drawn.

use super::Tables;
use super::figure::sentence;
use super::plot::Kind;
use super::spec::{Draw, Spec};
use declare::number::{significant, unit_symbol, with_unit};
use studygraph::store::manifest::StageRecord;
use studygraph::table::data::{Data, Table};
use studygraph::table::schema::Column;

/// Of a scatter.
pub fn specs(stage: &StageRecord, draw: &Draw<'_>, tables: Tables<'_>) -> Vec<Spec> {
    let Some(quantiles) = tables(&format!("{}.quantiles", stage.name)) else { return Vec::new() };
    let rows = stage.tables.iter().find(|table| table.table() == "rows");
    let columns = rows.map_or(&[][..], |table| &table.columns[..]);
    let is_number = |column: &&studygraph::store::manifest::ColumnRecord| !column.key && column.kind == "float";
    // Fields come first, and the outputs behind them.
    let outputs = texts(&quantiles, "output");
    let Some(output) = columns.iter().filter(is_number).find(|column| outputs.contains(&column.name.as_str())) else {
        return Vec::new();
    };
    let named = sentence(&output.name);
    let shown = match unit_symbol(&output.unit) {
        unit if unit.is_empty() => named.clone(),
        unit => format!("{named}, {unit}"),
    };
    let crossed: Vec<&Column> = quantiles
        .schema()
        .columns
        .iter()
        .filter(|column| column.key && !["output", "share"].contains(&column.name.as_str()))
        .collect();
    // In the middle of what is looked at.
    let at: Vec<(String, String)> = crossed
        .iter()
        .filter_map(|column| {
            let value = middle(&quantiles, &column.name)?;
            Some((column.name.clone(), format!("{value} {}", column.unit).trim().to_owned()))
        })
        .collect();
    let said = crossed.iter().filter_map(|column| {
        let value = significant(middle(&quantiles, &column.name)?, 6);
        Some(format!("{} {}", sentence(&column.name), with_unit(&value, &column.unit)))
    });
    let said = said.collect::<Vec<_>>().join(", ");
    let said = if said.is_empty() { said } else { format!(" at {}", lower(&said)) };
    let of_output = |spec: Spec, at: &[(String, String)]| {
        let own = ("output".to_owned(), output.name.clone());
        Spec { conditions: std::iter::once(own).chain(at.iter().cloned()).collect(), ..spec }
    };
    let title = format!("How {} scatters{said}", lower(&named));
    let histogram = draw("histogram", &title, Kind::Histogram, "distribution", "from", "samples");
    let histogram = Spec { value: "to".to_owned(), x_label: shown.clone(), y_label: "Samples".to_owned(), ..histogram };
    let mut found = vec![of_output(histogram, &at)];
    if let Some(over) = crossed.iter().find(|column| several(&quantiles, &column.name)) {
        let others: Vec<_> = at.iter().filter(|(name, _)| *name != over.name).cloned().collect();
        let title = format!("Quantiles of {} over {}", lower(&named), lower(&sentence(&over.name)));
        let bands = draw("quantiles", &title, Kind::Quantiles, "quantiles", &over.name, "value");
        let labels = labels(&quantiles);
        found.push(of_output(Spec { series: "share".to_owned(), y_label: shown, labels, ..bands }, &others));
    }
    let title = format!("What {} depends on{said}", lower(&named));
    let tornado = draw("tornado", &title, Kind::Tornado, "indices", "field", "total");
    let tornado = Spec {
        y: vec!["first_order".to_owned(), "total".to_owned()],
        x_label: "Field".to_owned(),
        y_label: "Share of the variance".to_owned(),
        labels: vec![
            ("first_order".to_owned(), "by itself".to_owned()),
            ("total".to_owned(), "with all others".to_owned()),
        ],
        ..tornado
    };
    found.push(of_output(tornado, &at));
    found
}

fn texts<'t>(table: &'t Table, column: &str) -> Vec<&'t str> {
    match table.column(column) {
        Some(Data::Text(values)) => values.iter().map(String::as_str).collect(),
        _ => Vec::new(),
    }
}

/// The different values of a column, ascending.
pub fn values(table: &Table, column: &str) -> Vec<f64> {
    let Some(Data::Float(values)) = table.column(column) else { return Vec::new() };
    let mut values = values.clone();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

fn several(table: &Table, column: &str) -> bool {
    values(table, column).len() > 1
}

fn middle(table: &Table, column: &str) -> Option<f64> {
    let values = values(table, column);
    values.get(values.len() / 2).copied()
}

/// What shares are called.
fn labels(quantiles: &Table) -> Vec<(String, String)> {
    let of = |share: &f64| (significant(*share, 6), with_unit(&significant(100.0 * share, 6), "%"));
    values(quantiles, "share").iter().map(of).collect()
}

fn lower(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_lowercase().chain(characters).collect())
}
