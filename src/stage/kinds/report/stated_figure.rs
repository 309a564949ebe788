//! Figures as a study states them.
//!
//! Must not know: tables.

use declare::declared::{Placed, Words as _};
use declare::error::Diagnostic;
use declare::record::Record;
use declare::{Declared, Words};

/// A figure as a study states it.
#[derive(Debug, Declared)]
pub struct StatedFigure {
    /// name of the file in `figures/`: letters, digits, - and _
    #[declared(example = "peak_to_peak")]
    pub name: String,
    /// what is shown
    #[declared(example = "Peak-to-peak over torque")]
    pub title: String,
    /// how it is drawn
    #[declared(default = "line")]
    pub kind: How,
    /// `stage.table`; several are drawn together, told apart by stage
    #[declared(example = "ste.summary")]
    pub table: Vec<Placed<String>>,
    /// column of the x axis
    #[declared(example = "torque")]
    pub x: String,
    /// column of the y axis; several need one unit
    #[declared(example = "peak_to_peak")]
    pub y: Vec<String>,
    /// column that a map shows as colours, or where the bars of a histogram end
    #[declared(example = "pressure")]
    pub value: Option<String>,
    /// lines of one value over a map
    #[declared(default = "false")]
    pub isolines: bool,
    /// which cell of a map is marked
    #[declared(default = "none")]
    pub best: Best,
    /// `stage.table` with a column `design` whose rows are named where they lie
    #[declared(example = "optimum.best")]
    pub marked: Option<Placed<String>>,
    /// column of `marked` for the x axis; that of the figure unless it is said
    #[declared(example = "tip_relief_amount")]
    pub marked_x: Option<String>,
    /// column of `marked` for the y axis; that of the figure unless it is said
    #[declared(example = "tip_relief_length")]
    pub marked_y: Option<String>,
    /// column whose values are drawn apart, one line each
    #[declared(example = "design")]
    pub series: Option<String>,
    /// column at whose changes a line is interrupted (a jump stays a jump)
    #[declared(example = "pairs")]
    pub segments: Option<String>,
    /// column of the length that x stands for: a chart says how many times as long depths are drawn
    #[declared(example = "path_position")]
    pub length: Option<String>,
    /// only the rows with these values, column: value
    #[declared(name = "where", example = "long")]
    pub conditions: Option<Vec<(String, String)>>,
    /// `stage.table` of one row: y is drawn as its relative distance from the same column there, |y/reference − 1|
    #[declared(example = "converged.summary")]
    pub reference: Option<Placed<String>>,
    /// name of the x axis; otherwise that of the column
    #[declared(example = "Torque")]
    pub x_label: Option<String>,
    /// name of the y axis; otherwise that of the column
    #[declared(example = "Peak-to-peak")]
    pub y_label: Option<String>,
    /// what values of `series`, columns and stages are called, value: name; series are drawn in this order
    #[declared(example = "With tip relief")]
    pub labels: Option<Vec<(String, String)>>,
    /// how large its file is
    #[declared(default = "page")]
    pub width: Width,
    /// axes with a logarithmic scale
    #[declared(default = "none")]
    pub log: Logarithmic,
    /// what the paper says, drawn for comparison
    pub published: Option<Vec<StatedMark>>,
    /// what to see in it
    #[declared(example = "The optimum moves with torque.")]
    pub note: Option<String>,
}

/// A published point or line as a study states it.
#[derive(Debug, Declared)]
pub struct StatedMark {
    /// place on the x axis, with its unit; without it a line across the figure
    #[declared(example = "100 N m")]
    pub x: Option<Placed<String>>,
    /// place on the y axis, with its unit; without it an upright line
    #[declared(example = "4.2 um")]
    pub y: Option<Placed<String>>,
    /// name in the legend; the name of a series takes that series' colour
    #[declared(default = "published")]
    pub label: String,
}

/// How a figure is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum How {
    /// a line for each series
    Line,
    /// markers only
    Points,
    /// bars over the words or numbers of the x column
    Bar,
    /// lines, true to scale: both axes have one length per unit
    Drawing,
    /// colours over both axes; places that the table does not have stay blank, those without a value are crossed out
    Map,
    /// points of a front, with the steps between what they beat and what nobody reaches
    Front,
    /// lines that go down with depth, a round number of times as long as `length`
    Chart,
    /// a bar for each row, from `x` to `value`
    Histogram,
    /// bands between the quantiles of a column of shares, `series`: the outermost, and so on; the middle one is a line
    Quantiles,
    /// bars to the right, one below the other, the largest on top
    Tornado,
}

/// Which cell of a map is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Best {
    /// no cell
    None,
    /// the one with the smallest value
    Smallest,
    /// the one with the largest value
    Largest,
}

/// How large the file of a figure is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Width {
    /// as in the page
    Page,
    /// 90 mm, a column of a journal, without a title
    Column,
}

/// Which axes are logarithmic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Logarithmic {
    /// both axes linear
    None,
    /// the x axis
    X,
    /// the y axis
    Y,
    /// both axes
    Both,
}

/// A map has a value, one y and one table; a histogram has one too, and quantiles have shares. Other figures have no value.
///
/// # Errors
/// At the field that does not fit.
pub fn check_map(stated: &StatedFigure, record: &Record) -> Result<(), Diagnostic> {
    const NAMES: StatedFigureNames = StatedFigure::NAMES;
    let refused = |field: &str, message: &str| Err(Diagnostic::new(message).at(record.place_of(field)));
    let marked_places = [(NAMES.marked_x, &stated.marked_x), (NAMES.marked_y, &stated.marked_y)];
    if let Some((field, _)) = marked_places.iter().find(|(_, column)| column.is_some() && stated.marked.is_none()) {
        return refused(field, &format!("`{field}` is a column of the table `marked`, which is not given"));
    }
    let has_rows = matches!(stated.kind, How::Histogram | How::Quantiles | How::Tornado);
    if has_rows && stated.log != Logarithmic::None {
        return refused(NAMES.log, &format!("`kind: {}` has no logarithmic axis", stated.kind.word()));
    }
    if stated.kind == How::Histogram && stated.value.is_none() {
        let message = "a histogram needs `value`, the column of where its bars end; they begin at `x`";
        return Err(Diagnostic::new(message).at(record.place).help("for example `x: from, value: to`"));
    }
    if stated.kind == How::Quantiles && stated.series.is_none() {
        let message = "quantiles need `series`, the column of their shares";
        return Err(Diagnostic::new(message).at(record.place).help("for example `series: share`"));
    }
    if stated.kind != How::Map {
        let of_maps = [
            (
                NAMES.value,
                stated.value.is_some() && stated.kind != How::Histogram,
                "is the column that a map shows as colours",
            ),
            (NAMES.isolines, stated.isolines, "are lines over a map"),
            (NAMES.best, stated.best != Best::None, "is a cell of a map"),
        ];
        return match of_maps.iter().find(|(_, is_given, _)| *is_given) {
            Some((field, _, what)) => refused(field, &format!("`{field}` {what}; write `kind: map`")),
            None => Ok(()),
        };
    }
    if stated.kind == How::Histogram {
        return Ok(());
    }
    if stated.value.is_none() {
        let message = "a map needs `value`, the column that it shows as colours";
        return Err(Diagnostic::new(message).at(record.place).help("for example `value: pressure`"));
    }
    if stated.y.len() > 1 {
        return refused(NAMES.y, "a map has one column on its y axis");
    }
    if stated.table.len() > 1 {
        return refused(NAMES.table, "a map shows one table");
    }
    if stated.log != Logarithmic::None {
        return refused(NAMES.log, "a map has no logarithmic axis");
    }
    for (field, is_given) in [(NAMES.series, stated.series.is_some()), (NAMES.reference, stated.reference.is_some())] {
        if is_given {
            return refused(field, &format!("a map has no `{field}`"));
        }
    }
    Ok(())
}
