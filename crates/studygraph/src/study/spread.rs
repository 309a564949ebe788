//! Distributions of varied fields as a study states them: `within: ± 2 um`, `normal: 1 um`, a mode between two ends, a class of
//! tolerances.
//!
//! What is not stated is the value that the study has: a tolerance lies about it. Must not know: what a class allows, how
//! values are drawn.

use super::document::{Content, KeyValue, Node};
use super::notation::{halves, without_sign};
use super::quantity::Measure;
use super::scalar::scalar;
use super::words::{number, quote};
use declare::error::{Diagnostic, Place, suggest};
use declare::parameter::Shape;
use declare::record::varied::{Form, Spread, Within};
use declare::units::{Dimension, LENGTH, split_quantity};

/// A column of a mapping of varied fields.
pub struct Stated<'a> {
    pub name: &'a str,
    pub fields: &'a [KeyValue],
    /// Of the column.
    pub place: Place,
    /// What the varied field takes.
    pub measure: Measure<'a>,
}

/// Fields that only a distribution has.
const OWN: [&str; 6] = ["within", "shape", "iso1328", "normal", "mean", "mode"];

impl Stated<'_> {
    fn given(&self, field: &str) -> Option<&Node> {
        self.fields.iter().find(|given| given.key == field && !given.node.is_null()).map(|given| &given.node)
    }

    /// The distribution, a value that the field can have, as written, and where it is stated; none where the column has
    /// values, or two ends and no more. `written` is what the study has.
    ///
    /// # Errors
    /// When it cannot be read, or contradicts itself.
    pub fn spread(
        &self,
        multiple: Option<i64>,
        written: impl Fn() -> Result<Node, Diagnostic>,
    ) -> Result<Option<(Spread, Node, Place)>, Diagnostic> {
        let Some(first) = OWN.iter().find_map(|field| self.given(field)) else { return Ok(None) };
        if multiple.is_some() {
            let message = format!("{} takes whole numbers, which no tolerance has", quote(self.name));
            return Err(Diagnostic::new(message).at(first.place).help("write its `values: […]`"));
        }
        for (field, with) in [("values", "a distribution"), ("count", "a distribution")] {
            if let Some(node) = self.given(field) {
                return Err(Diagnostic::new(format!("`{field}` does not go with {with}")).at(node.place));
            }
        }
        let main: Vec<&str> =
            ["within", "iso1328", "normal", "mode"].into_iter().filter(|field| self.given(field).is_some()).collect();
        let [kind] = main[..] else {
            let message = match main[..] {
                [one, other, ..] => format!("{} has both `{one}` and `{other}`", quote(self.name)),
                _ => format!("{} does not say how it is distributed", quote(self.name)),
            };
            return Err(Diagnostic::new(message)
                .at(first.place)
                .help("write one of `within: ± …`, `normal: …`, `iso1328: …`, or `from`, `mode` and `to`"));
        };
        for (field, of) in [("shape", &["within", "iso1328"][..]), ("mean", &["within", "iso1328", "normal"])] {
            if let Some(node) = self.given(field).filter(|_| !of.contains(&kind)) {
                return Err(Diagnostic::new(format!("`{field}` does not go with `{kind}`")).at(node.place));
            }
        }
        let place = self.given(kind).map_or(self.place, |node| node.place);
        let ends = ["from", "to"].map(|end| self.given(end).map(|node| self.measure.single(node)).transpose());
        let [from, to] = ends;
        let ends = [from?, to?];
        if let (Some(node), true) = (self.given("from").or(self.given("to")), matches!(kind, "within" | "iso1328")) {
            let message = format!("`{kind}` is a tolerance and has its own limits");
            return Err(Diagnostic::new(message).at(node.place).help("leave `from` and `to` out, or take `normal`"));
        }
        let about = match (kind, self.given("mode"), self.given("mean")) {
            ("mode", Some(node), _) | (_, _, Some(node)) => node.clone(),
            _ => self.nominal(written()?, place)?,
        };
        let middle = self.measure.single(&about).map_err(|wrong| wrong.or_at(place))?;
        let form = match kind {
            "within" => Form::Within(self.width(place, middle)?, self.shape()?),
            "iso1328" => Form::Class(self.class(place)?, self.shape()?),
            "normal" => Form::Normal(self.width_of("normal", place)?),
            _ => {
                if ends.iter().any(Option::is_none) {
                    let message = format!("{} has a `mode`, and needs `from` and `to`", quote(self.name));
                    return Err(Diagnostic::new(message).at(place));
                }
                Form::Triangular
            }
        };
        let (low, high) = (ends[0].unwrap_or(f64::NEG_INFINITY), ends[1].unwrap_or(f64::INFINITY));
        if low >= high {
            let message = format!("`to` must be above `from` of {}", quote(self.name));
            return Err(Diagnostic::new(message).at(self.given("to").map_or(place, |node| node.place)));
        }
        if form == Form::Triangular && !(low..=high).contains(&middle) {
            return Err(Diagnostic::new("`mode` lies between `from` and `to`").at(place));
        }
        Ok(Some((Spread { form, about: middle, ends }, about, place)))
    }

    /// The value that the study has. A field that may be off to either side and is not stated is off by nothing.
    fn nominal(&self, written: Node, place: Place) -> Result<Node, Diagnostic> {
        if written.is_null() {
            let Measure { minimum, maximum, dimension, .. } = self.measure;
            #[allow(clippy::float_cmp)] // declared so
            if minimum == -maximum {
                // In the unit in which the tolerance is written, where it has one.
                let written = ["within", "normal"].iter().find_map(|field| self.given(field));
                let unit = match written.map(|node| &node.content) {
                    Some(Content::Scalar { text, .. }) => split_quantity(without_sign(text)).1,
                    _ if dimension == Some(LENGTH) => "um",
                    _ => dimension.map_or("", Dimension::si),
                };
                let text = format!("0 {unit}").trim().to_owned();
                return Ok(Node { content: Content::Scalar { text, quoted: false }, place });
            }
            let message = format!("{} has no value in the study about which it could be distributed", quote(self.name));
            return Err(Diagnostic::new(message).at(place).help("write its `mean`"));
        }
        match &written.content {
            Content::Scalar { .. } => Ok(written),
            Content::Sequence(items) if items.len() == 1 => Ok(items[0].clone()),
            _ => {
                let message = format!("{} has several values in the study", quote(self.name));
                Err(Diagnostic::new(message).at(place).help("write its `mean`, or give it `values: […]` here"))
            }
        }
    }

    /// Of `within`, with or without its sign, about a middle.
    fn width(&self, place: Place, middle: f64) -> Result<f64, Diagnostic> {
        let Some(Node { content: Content::Scalar { text, .. }, place: own }) = self.given("within") else {
            return self.width_of("within", place);
        };
        if let Some((mean, half)) = halves(text).filter(|(mean, half)| !mean.is_empty() && !half.is_empty()) {
            let message = format!("{} is an interval, and `within` is half of its width alone", quote(text));
            return Err(Diagnostic::new(message).at(*own).help(format!("write `mean: {mean}, within: ± {half}`")));
        }
        let (share, unit) = split_quantity(without_sign(text));
        if unit == "%"
            && self.measure.dimension.is_none()
            && let Ok(share) = share.parse::<f64>()
        {
            let [of_it, of_one] = [middle.abs(), 1.0].map(|of| number(of * share / 100.0));
            let message = format!("{} can be read in two ways; {} is a plain number", quote(text), quote(self.name));
            let help =
                format!("write `± {of_it}` for {share} % of {}, `± {of_one}` for {share} % of 1", number(middle));
            return Err(Diagnostic::new(message).at(*own).help(help));
        }
        self.width_of("within", place)
    }

    fn width_of(&self, field: &str, place: Place) -> Result<f64, Diagnostic> {
        let Some(node) = self.given(field) else {
            return Err(Diagnostic::new(format!("`{field}` is missing")).at(place));
        };
        let text = without_sign(scalar(field, node, &Shape::Text)?).to_owned();
        let node = Node { content: Content::Scalar { text, quoted: false }, place: node.place };
        let measure = Measure { minimum: 0.0, maximum: f64::INFINITY, name: field, ..self.measure };
        let width = measure.single(&node)?;
        if width <= 0.0 {
            let message = format!("`{field}` is 0: {} would not vary", quote(self.name));
            return Err(Diagnostic::new(message).at(node.place));
        }
        Ok(width)
    }

    fn shape(&self) -> Result<Within, Diagnostic> {
        let Some(node) = self.given("shape") else { return Ok(Within::Uniform) };
        let word = scalar("shape", node, &Shape::Text)?;
        Within::of(word).ok_or_else(|| {
            let message = format!("{} is no shape of a tolerance", quote(word));
            Diagnostic::new(message).at(node.place).help(suggest(word, Within::WORDS))
        })
    }

    fn class(&self, place: Place) -> Result<i64, Diagnostic> {
        let Some(node) = self.given("iso1328") else { return Err(Diagnostic::new("`iso1328` is missing").at(place)) };
        let text = scalar("iso1328", node, &Shape::Text)?;
        text.parse().map_err(|_| {
            Diagnostic::new(format!("{} is no tolerance class; it is a whole number, 1 to 11", quote(text)))
                .at(node.place)
        })
    }
}
