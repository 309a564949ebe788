//! Numbers of a study: quantities with their units, axes, and the ranges between which an optimiser chooses.
//!
//! A number is read from its text, so the same quantity written in two units has the same bits, and so has a point of
//! an axis given by `from`, `to` and `count` and the same point written out. Results in SI. Must not know: stages.

pub mod interval;
mod unreadable;

use super::document::{Content, Node};
use super::notation;
use super::scalar::scalar;
use super::unknown;
use super::words::{self, quote};
use declare::error::Diagnostic;
use declare::parameter::{Field, Shape, Span};
use declare::record::{PlacedValue, Value};
use declare::units::{self, Dimension, RATIO, UnitError, parse_quantity, split_quantity};

/// Largest power of a unit that a message names.
const MOST_POWER: i8 = 9;
/// Most points of an axis.
pub const MOST_POINTS: usize = 100_000;

/// What a field says about its number.
#[derive(Clone, Copy)]
pub struct Measure<'a> {
    /// The field, for messages.
    pub name: &'a str,
    /// `None` for a plain number.
    pub dimension: Option<Dimension>,
    pub minimum: f64,
    pub maximum: f64,
    /// What a study might say, for messages.
    pub example: Option<&'static str>,
    /// Of a plain number: the field in whose quantity it counts, and that quantity in SI where the study has it.
    pub counts_in: Option<(&'static str, Option<f64>)>,
}

impl<'a> Measure<'a> {
    /// What the shape of a field says of a number.
    pub fn new(name: &'a str, shape: &Shape, example: Option<&'static str>) -> Self {
        let (dimension, minimum, maximum) = match *shape {
            Shape::Quantity { dimension, minimum, maximum } => (Some(dimension), minimum, maximum),
            Shape::Number { minimum, maximum } => (None, minimum, maximum),
            Shape::Integer { minimum, maximum, .. } => (None, minimum as f64, maximum as f64),
            _ => (None, f64::NEG_INFINITY, f64::INFINITY),
        };
        Self { name, dimension, minimum, maximum, example, counts_in: None }
    }

    /// Of a field whose number may count in the quantity of another one, as `of` finds it.
    #[must_use]
    pub fn counting(self, field: &Field, of: impl Fn(&str) -> Option<f64>) -> Self {
        Self { counts_in: field.counts_in.map(|name| (name, of(name))), ..self }
    }

    /// The same of a field.
    pub fn of(field: &'a Field) -> Self {
        let shape = if let Shape::List(item) = field.shape { item } else { &field.shape };
        Self::new(field.name, shape, words::example_of(field))
    }

    /// Reads what the span of a field allows.
    ///
    /// # Errors
    /// When it is not there, has a wrong unit, is outside the range, or is more than the span allows; `ranges` is where
    /// a range belongs when it is not allowed here.
    pub fn value(&self, node: &Node, span: Span, ranges: Result<(), &str>) -> Result<Value, Diagnostic> {
        match (&node.content, span) {
            (Content::Sequence(items), Span::Axis { .. }) => self.list(node, items),
            (Content::Mapping(_), Span::Axis { .. }) => self.spaced(node),
            (Content::Scalar { .. }, Span::Axis { .. }) => Ok(Value::Axis(vec![self.single(node)?])),
            (Content::Sequence(items), Span::Range) => {
                ranges.map_err(|place| {
                    let message = format!("{} takes one value here, not a range", quote(self.name));
                    Diagnostic::new(message).at(node.place).help(format!("a range `[least, most]` belongs {place}"))
                })?;
                self.bounds(node, items)
            }
            _ => Ok(self.number(self.single(node)?)),
        }
    }

    /// As a field holds it.
    pub fn number(&self, value: f64) -> Value {
        if self.dimension.is_some() { Value::Quantity(value) } else { Value::Number(value) }
    }

    /// One number, in SI and inside the range.
    ///
    /// # Errors
    /// As [`Measure::value`].
    pub fn single(&self, node: &Node) -> Result<f64, Diagnostic> {
        let Content::Scalar { text, quoted } = &node.content else {
            let message = format!("{} takes one value, not {}", quote(self.name), node.describe());
            return Err(Diagnostic::new(message).at(node.place).help(format!("{} is expected", self.expected())));
        };
        self.read(text, *quoted).map_err(|found| found.or_at(node.place))
    }

    fn read(&self, text: &str, quoted: bool) -> Result<f64, Diagnostic> {
        let shown = quote(text);
        if self.dimension.is_none() && quoted {
            let message = format!("{shown} is text in quotes; {} is expected", self.expected());
            return Err(Diagnostic::new(message).help("write the number without quotes"));
        }
        if notation::halves(text).is_some() {
            return Err(self.no_interval(text));
        }
        if let Some(help) = notation::help(text).or_else(|| interval::elsewhere(text)) {
            let message = format!("{shown} is not a number as a study has it; {} is expected", self.expected());
            let in_modules = self.in_modules(text);
            let help = || notation::with_reading(help, text, &|text| self.distance(text));
            let help = in_modules.unwrap_or_else(help);
            return Err(Diagnostic::new(message).help(help));
        }
        let read = parse_quantity(text).map_err(|error| self.unreadable(text, error))?;
        match self.dimension {
            None if read.has_unit => {
                let message = format!("{shown} has a unit; {} is a plain number", quote(self.name));
                return Err(Diagnostic::new(message).help(self.without_unit(text, read)));
            }
            Some(dimension) if dimension != RATIO && !read.has_unit => {
                let number = split_quantity(text).0;
                let example = words::example_like(number, dimension, self.minimum, self.maximum, self.example);
                let example = example.map_or(String::new(), |example| format!(", for example `{example}`"));
                let message = format!("{shown} has no unit; {} is expected{example}", dimension.describe().0);
                return Err(Diagnostic::new(message));
            }
            Some(dimension) if dimension != read.dimension => {
                let Dimension { length, mass, time, .. } = read.dimension;
                let is = if [length, mass, time].iter().all(|power| power.abs() <= MOST_POWER) {
                    format!("is {}", units::described(read.dimension))
                } else {
                    "has a unit of another kind".to_owned()
                };
                return Err(Diagnostic::new(format!("{shown} {is}; {} is expected", self.expected())));
            }
            _ => {}
        }
        // Adding zero turns a negative zero, the same value with other bits, into zero.
        if (self.minimum..=self.maximum).contains(&read.value) { Ok(read.value + 0.0) } else { Err(self.outside(text)) }
    }

    /// How far a number, or the middle of an interval, is from the usual one, as the logarithm of their ratio: without end where it cannot stand here.
    pub fn distance(&self, text: &str) -> f64 {
        let middle = notation::middle(text);
        let text = middle.as_deref().unwrap_or(text);
        let si = |text: &str| {
            parse_quantity(text).ok().filter(|read| self.dimension.is_none_or(|own| own == read.dimension))
        };
        match (si(text).filter(|read| (self.minimum..=self.maximum).contains(&read.value)), self.example.and_then(si)) {
            (None, _) => f64::INFINITY,
            (Some(read), Some(usual)) if read.value != 0.0 && usual.value != 0.0 => {
                (read.value / usual.value).abs().ln().abs()
            }
            (Some(_), _) => 0.0,
        }
    }

    /// Of a length in another notation that stands where a number counts in a length: the help for it in the notation of studies.
    fn in_modules(&self, text: &str) -> Option<String> {
        self.counts_in?;
        if let Some([middle, half]) = notation::halves_of(text) {
            return self.counted(&middle, &half, text)?.help;
        }
        let point = text.trim().replacen(',', ".", 1);
        let meant = notation::without_commas(text.trim(), &|text| self.distance(text))?;
        if meant == format!("write `{point}`") { self.read(&point, false).err()?.help } else { None }
    }

    fn outside(&self, text: &str) -> Diagnostic {
        let admissible = self.range().unwrap_or_else(|| "finite".to_owned());
        Diagnostic::new(format!("{} must be {admissible}, not {}", quote(self.name), quote(text)))
    }

    fn range(&self) -> Option<String> {
        words::range(self.minimum, self.maximum, |value| match self.dimension {
            Some(dimension) => words::quantity(value, dimension),
            None => words::number(value),
        })
    }

    fn expected(&self) -> String {
        words::measure(self.dimension, self.minimum, self.maximum, self.example)
    }

    /// `[a, b, …]` in any order, without repeats.
    fn list(&self, node: &Node, items: &[Node]) -> Result<Value, Diagnostic> {
        let mut values =
            items.iter().map(|item| Ok((self.single(item)?, item))).collect::<Result<Vec<_>, Diagnostic>>()?;
        if values.is_empty() {
            let message = format!("{} is an empty list; at least one value is expected", quote(self.name));
            return Err(Diagnostic::new(message).at(node.place));
        }
        if values.len() > MOST_POINTS {
            return Err(self.too_many(&values.len().to_string()).at(node.place));
        }
        values.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.place.offset.cmp(&b.1.place.offset)));
        #[allow(clippy::float_cmp)] // the same point twice, not a point nearby
        if let Some(pair) = values.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let message = format!("{} already has this value: {}", quote(self.name), pair[1].1.describe());
            return Err(Diagnostic::new(message).at(pair[1].1.place).help("keep one of them"));
        }
        Ok(Value::Axis(values.into_iter().map(|(value, _)| value).collect()))
    }

    /// `{ from, to, count }`, both ends included.
    ///
    /// # Errors
    /// As [`Measure::value`]; when the ends are not in order, or so many points do not fit between them.
    pub fn spaced(&self, node: &Node) -> Result<Value, Diagnostic> {
        let Content::Mapping(pairs) = &node.content else {
            return self.single(node).map(|value| Value::Axis(vec![value]));
        };
        let names = ["from", "to", "count"];
        if let Some(wrong) = unknown::Mapping::plain(pairs, &names, &quote(self.name), &|_, text| self.distance(text))
            .unknown()
            .into_iter()
            .next()
        {
            return Err(wrong);
        }
        let part = |name: &str| {
            let found = pairs.iter().find(|pair| pair.key == name && !pair.node.is_null());
            found.map(|pair| &pair.node).ok_or_else(|| {
                let message = format!("{} has no {}", quote(self.name), quote(name));
                Diagnostic::new(message).at(node.place).help("evenly spaced values are `{ from: …, to: …, count: … }`")
            })
        };
        let (from, to, count) = (part("from")?, part("to")?, part("count")?);
        let (first, last) = (self.single(from)?, self.single(to)?);
        if first >= last {
            let message = format!("`to` ({}) must be above `from` ({})", to.describe(), from.describe());
            return Err(Diagnostic::new(message).at(to.place));
        }
        let Content::Scalar { text, .. } = &count.content else {
            return Err(Diagnostic::new("`count` is a whole number").at(count.place));
        };
        if let Some(help) = notation::help(text) {
            return Err(Diagnostic::new("`count` is a whole number in digits").at(count.place).help(help));
        }
        let points = text.parse::<usize>().ok().filter(|points| (2..=MOST_POINTS).contains(points));
        let Some(points) = points else { return Err(self.too_many(text).at(count.place)) };
        let mut values: Vec<f64> = (0..points).map(|at| between(from, to, first, last, at, points)).collect();
        (values[0], values[points - 1]) = (first, last);
        if values.windows(2).any(|pair| pair[0] >= pair[1]) {
            let message =
                format!("{points} different values do not fit between {} and {}", from.describe(), to.describe());
            return Err(Diagnostic::new(message).at(count.place));
        }
        Ok(Value::Axis(values))
    }

    /// A list whose numbers have one unit, `{ unit: um, values: [1, 2] }`, or are evenly spaced, `{ from, to, count }`.
    ///
    /// # Errors
    /// As [`Measure::value`]; when a number has a unit of its own too.
    pub fn many(&self, node: &Node) -> Result<Vec<PlacedValue>, Diagnostic> {
        let Content::Mapping(pairs) = &node.content else { return Ok(Vec::new()) };
        let number = |value: f64| self.number(value);
        let part = |name: &str| pairs.iter().find(|pair| pair.key == name && !pair.node.is_null());
        if part("values").is_none() && part("unit").is_none() {
            let Value::Axis(values) = self.spaced(node)? else { return Ok(Vec::new()) };
            return Ok(values
                .into_iter()
                .map(|value| PlacedValue { value: number(value), place: node.place })
                .collect());
        }
        let names = ["unit", "values"];
        let distance = |_: &str, text: &str| self.distance(text);
        let wrong = unknown::Mapping::plain(pairs, &names, &quote(self.name), &distance).unknown();
        if let Some(wrong) = wrong.into_iter().next() {
            return Err(wrong);
        }
        let given = names.map(|name| {
            part(name).map(|pair| &pair.node).ok_or_else(|| {
                let message = format!("{} has no {}", quote(self.name), quote(name));
                Diagnostic::new(message).at(node.place).help("numbers of one unit are `{ unit: …, values: [ … ] }`")
            })
        });
        let [unit, values] = given;
        let (unit, values) = (unit?, values?);
        let Content::Scalar { text: symbol, .. } = &unit.content else {
            return Err(Diagnostic::new(format!("`unit` is {}; a unit is expected", unit.describe())).at(unit.place));
        };
        let items = if let Content::Sequence(items) = &values.content { items } else { std::slice::from_ref(values) };
        let one = |item: &Node| {
            let Content::Scalar { text, quoted } = &item.content else { return self.single(item) };
            if !split_quantity(text).1.is_empty() {
                let message = format!("{} has a unit, and all of {} have `{symbol}`", quote(text), quote(self.name));
                return Err(Diagnostic::new(message).at(item.place).help("leave one of them out"));
            }
            let content = Content::Scalar { text: format!("{text} {symbol}"), quoted: *quoted };
            self.single(&Node { content, place: item.place })
        };
        items.iter().map(|item| Ok(PlacedValue { value: number(one(item)?), place: item.place })).collect()
    }

    fn too_many(&self, found: &str) -> Diagnostic {
        let message =
            format!("{} must have between 2 and {MOST_POINTS} values, not {}", quote(self.name), quote(found));
        Diagnostic::new(message)
    }

    /// `[least, most]`.
    fn bounds(&self, node: &Node, items: &[Node]) -> Result<Value, Diagnostic> {
        let [minimum, maximum] = items else {
            let message = format!("{} takes a range `[least, most]`, not a list of {}", quote(self.name), items.len());
            return Err(Diagnostic::new(message).at(node.place));
        };
        let (low, high) = (self.single(minimum)?, self.single(maximum)?);
        if low >= high {
            let message =
                format!("a range is `[least, most]`; {} is not below {}", minimum.describe(), maximum.describe());
            return Err(Diagnostic::new(message)
                .at(node.place)
                .help("a value that is fixed is written without brackets"));
        }
        Ok(Value::Range(low, high))
    }
}

/// Point `at` of `points`. Where both ends have the same unit the point is found in that unit, to the 15 digits that a
/// binary number keeps, and read as if it were written there, so `{ from: 25 mm, to: 100 mm, count: 16 }` holds the
/// bits of `50 mm`.
fn between(from: &Node, to: &Node, first: f64, last: f64, at: usize, points: usize) -> f64 {
    let share = |low: f64, high: f64| low + (high - low) * at as f64 / (points - 1) as f64;
    let written = |node: &Node| match &node.content {
        Content::Scalar { text, .. } => {
            let (number, unit) = split_quantity(text);
            number.parse::<f64>().ok().map(|number| (number, unit.to_owned()))
        }
        _ => None,
    };
    if let (Some((low, unit)), Some((high, other))) = (written(from), written(to))
        && unit == other
        && let Ok(point) = parse_quantity(&format!("{:.14e} {unit}", share(low, high)))
    {
        return point.value;
    }
    share(first, last)
}

/// A number with any unit, or none.
///
/// # Errors
/// When it cannot be read.
pub fn any_quantity(name: &str, node: &Node) -> Result<Value, Diagnostic> {
    let text = scalar(name, node, &Shape::AnyQuantity)?;
    if let Some(help) = notation::help(text) {
        let message = format!("{} is not a number as a study has it; {name} needs one", quote(text));
        return Err(Diagnostic::new(message).at(node.place).help(notation::with_reading(help, text, &|_| 0.0)));
    }
    let read = parse_quantity(text).map_err(|error| {
        let unit = quote(split_quantity(text).1);
        let (message, help) = match error {
            UnitError::Ambiguous { readings, .. } => (
                format!("{unit} in {} can be read in two ways", quote(text)),
                words::unit_readings(text, &readings, None),
            ),
            UnitError::Malformed { why, instead, .. } => (
                format!("{unit} in {} cannot be read as a unit: {why}", quote(text)),
                words::unit_instead(text, instead.as_deref()),
            ),
            _ => (
                format!("{} is not a number with a unit that is known; {name} needs one", quote(text)),
                "units are written like `um`, `N m`, `N/(mm um)` or `1/um^2`".to_owned(),
            ),
        };
        Diagnostic::new(message).at(node.place).help(help)
    })?;
    let unit = split_quantity(text).1.to_owned();
    Ok(Value::AnyQuantity { value: read.value + 0.0, dimension: read.dimension, unit })
}
