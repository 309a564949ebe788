//! A figure as it was declared: a row of the table `figures` of a report stage.
//!
//! Must not know: the tables that it is drawn from.

use super::cells::Best;
use super::frame::Size;
use super::plot::Kind;
use super::{ReportError, flags, integers, texts};
use studygraph::table::data::Table;
use studygraph::table::select::parse_conditions;

/// What is drawn from which table; empty texts where nothing was said.
#[derive(Clone, Debug, Default)]
pub struct Spec {
    pub number: i64,
    pub name: String,
    pub title: String,
    pub kind: Kind,
    /// `stage.table`.
    pub tables: Vec<String>,
    pub x: String,
    pub y: Vec<String>,
    /// Column of the colours of a map, or of where the bars of a histogram end.
    pub value: String,
    pub isolines: bool,
    pub best: Best,
    /// `stage.table` of points that are named, and its columns for both axes; empty where there are none.
    pub marked: [String; 3],
    pub series: String,
    pub segments: String,
    /// Column of the length that x stands for, of a chart.
    pub length: String,
    pub reference: String,
    pub conditions: Vec<(String, String)>,
    /// Values and names, and what they are called.
    pub labels: Vec<(String, String)>,
    pub x_label: String,
    pub y_label: String,
    pub is_log: [bool; 2],
    pub size: Size,
    pub note: String,
}

/// Makes a figure of a stage, from its name, its title, its kind, its table and the columns of both axes.
pub type Draw<'a> = dyn Fn(&str, &str, Kind, &str, &str, &str) -> Spec + 'a;

impl Spec {
    /// With nothing but what every figure has.
    #[must_use]
    pub fn new(name: &str, title: &str, kind: Kind, table: &str, x: &str, y: &str) -> Self {
        Self {
            name: name.to_owned(),
            title: title.to_owned(),
            kind,
            tables: vec![table.to_owned()],
            x: x.to_owned(),
            y: vec![y.to_owned()],
            ..Self::default()
        }
    }

    /// # Errors
    /// When a column is missing or says what no figure can be.
    pub fn read(declared: &Table, row: usize) -> Result<Self, ReportError> {
        let text = |column: &str| texts(declared, column).map(|values| values[row].clone());
        let words = |text: String| -> Vec<String> {
            text.split(", ").filter(|word| !word.is_empty()).map(str::to_owned).collect()
        };
        let log = text("log")?;
        let unfit = |problem: String| ReportError::Unfit(problem);
        let labels = text("labels")?;
        let labels = if labels.is_empty() { Ok(Vec::new()) } else { serde_json::from_str(&labels) };
        Ok(Self {
            number: integers(declared, "figure")?[row],
            name: text("name")?,
            title: text("title")?,
            kind: match text("kind")?.as_str() {
                "bar" => Kind::Bar,
                "points" => Kind::Points,
                "drawing" => Kind::Drawing,
                "map" => Kind::Map,
                "front" => Kind::Front,
                "chart" => Kind::Chart,
                "histogram" => Kind::Histogram,
                "quantiles" => Kind::Quantiles,
                "tornado" => Kind::Tornado,
                _ => Kind::Line,
            },
            tables: words(text("tables")?),
            x: text("x")?,
            y: words(text("y")?),
            value: text("value")?,
            isolines: flags(declared, "isolines")?[row],
            best: match text("best")?.as_str() {
                "smallest" => Best::Smallest,
                "largest" => Best::Largest,
                _ => Best::None,
            },
            marked: [text("marked")?, text("marked_x")?, text("marked_y")?],
            series: text("series")?,
            segments: text("segments")?,
            length: text("length")?,
            reference: text("reference")?,
            conditions: parse_conditions(&text("conditions")?).map_err(unfit)?,
            labels: labels.map_err(|error| unfit(format!("labels of a figure: {error}")))?,
            x_label: text("x_label")?,
            y_label: text("y_label")?,
            is_log: [matches!(log.as_str(), "x" | "both"), matches!(log.as_str(), "y" | "both")],
            size: if text("width")? == "column" { Size::Column } else { Size::Page },
            note: text("note")?,
        })
    }

    /// What a value or a name is called.
    #[must_use]
    pub fn label(&self, of: &str) -> String {
        let given = self.labels.iter().find(|(known, _)| known == of);
        given.map_or(of, |(_, label)| label).to_owned()
    }
}
