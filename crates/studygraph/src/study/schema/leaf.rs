//! What the schema says of a single value: how it looks, what an editor says where it does not, what it offers.
//!
//! `title` and `examples` are of the standard. `errorMessage`, `patternErrorMessage` and `defaultSnippets` are those that the
//! YAML language server reads; other readers pass over them. Must not know: how fields are put together.

use serde_json::{Value, json};

use crate::study::assemble::NAME_PATTERN;
use crate::study::decode::varied::COLUMN_PATTERN;
use crate::study::identity::MOST;
use crate::study::quantity::MOST_POINTS;
use crate::study::words;
use declare::units::{ANGLE, Dimension, FORCE, LENGTH, RATIO, TIME, in_unit, parse_quantity, parse_unit, symbols};

const NUMBER: &str = r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?";
/// The same where a minus would be outside every range.
const POSITIVE: &str = r"\+?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?";

/// Before a number and behind its unit: a block scalar ends in a line break. Any space may stand between both, such as the narrow
/// one that does not break a line.
const START: &str = r"^\s*";
const END: &str = r"\s*$";

/// Between the middle and half the width of a number that was printed rounded.
const OFF_BY: &str = r"\s*(±|\+/?-|\\pm)\s*";

/// A name as a heading: `Young's modulus` of `youngs_modulus`.
pub fn title(name: &str) -> String {
    let word = |word: &str| match word {
        "youngs" => "Young's".to_owned(),
        "poisson" => "Poisson's".to_owned(),
        "iso" => "ISO".to_owned(),
        "iso6336" => "ISO 6336".to_owned(),
        "weber" => "Weber".to_owned(),
        "banaschek" => "Banaschek".to_owned(),
        "nelder" => "Nelder".to_owned(),
        "mead" => "Mead".to_owned(),
        "powell" => "Powell".to_owned(),
        "latin" => "Latin".to_owned(),
        "sobol" => "Sobol".to_owned(),
        other => other.to_owned(),
    };
    let words = name.split('_').map(word).collect::<Vec<_>>().join(" ");
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + letters.as_str())
}

/// What is said of a value that does not look as it must, whichever way.
fn explained(mut schema: Value, message: &str) -> Value {
    if schema.get("pattern").is_some() {
        schema["patternErrorMessage"] = json!(message);
    }
    schema["errorMessage"] = json!(message);
    schema
}

fn with_example(mut schema: Value, example: Option<Value>) -> Value {
    if let Some(example) = example {
        schema["examples"] = json!([example]);
    }
    schema
}

/// A number with a unit; a plain one or one in percent where it is a ratio. `rounded`: or an interval about it.
pub fn quantity(dimension: Dimension, (minimum, maximum): (f64, f64), example: Option<&str>, rounded: bool) -> Value {
    if dimension == RATIO {
        let message = "a ratio is a plain number or one with `%`, such as `0.05` or `5 %`";
        let off_by = format!(r"|%{OFF_BY}{POSITIVE}\s*%|{OFF_BY}{POSITIVE}");
        let percent = format!(r"{START}{NUMBER}\s*(%{}){END}", if rounded { &off_by } else { "" });
        let percent = json!({ "type": "string", "pattern": percent });
        let (percent, plain) = match example.map(|text| (text, text.parse::<serde_json::Number>())) {
            Some((_, Ok(plain))) => (percent, Some(Value::Number(plain))),
            Some((text, Err(_))) => (with_example(percent, Some(json!(text))), None),
            None => (percent, None),
        };
        let plain = with_example(bounded(minimum, maximum), plain);
        return json!({ "anyOf": [explained(plain, message), explained(percent, message)] });
    }
    // Simple dimensions have their few units; in others units are put together, and only the reader knows them all.
    let units = if [LENGTH, ANGLE, FORCE, TIME].contains(&dimension) {
        let fits = |symbol: &&str| parse_unit(symbol).is_ok_and(|unit| unit.dimension == dimension);
        symbols().filter(fits).collect::<Vec<_>>().join("|")
    } else {
        "[A-Za-zµμ1].*".to_owned()
    };
    let example = example.map(str::to_owned).or_else(|| words::example(dimension, minimum, maximum));
    let number = if minimum > 0.0 { POSITIVE } else { NUMBER };
    // The unit may stand behind both halves of an interval.
    let off_by = format!(r"((\s*({units}))?{OFF_BY}{POSITIVE})?");
    let pattern = format!(r"{START}{number}{}\s*({units}){END}", if rounded { &off_by } else { "" });
    let schema = json!({ "type": "string", "pattern": pattern });
    let such = example.as_ref().map_or_else(String::new, |text| format!(", such as `{text}`"));
    let more = if minimum > 0.0 { ", more than 0" } else { "" };
    let message = format!("{} is a number and a unit{more}{such}", dimension.describe().0);
    let mut schema = explained(with_example(schema, example.as_ref().map(|text| json!(text))), &message);
    // The number is what is written next, the unit stands.
    if let Some(si) = example.and_then(|text| parse_quantity(&text).ok()).map(|read| read.value) {
        let unit = |unit: &&'static str| {
            let number = words::number(in_unit(si, unit));
            json!({ "label": format!("… {unit}"), "body": format!("${{1:{number}}} {unit}") })
        };
        schema["defaultSnippets"] = dimension.describe().1.iter().map(unit).collect();
    }
    schema
}

fn bounded(minimum: f64, maximum: f64) -> Value {
    let mut schema = json!({ "type": "number" });
    if minimum.is_finite() {
        schema["minimum"] = json!(minimum);
    }
    if maximum.is_finite() {
        schema["maximum"] = json!(maximum);
    }
    schema
}

/// A plain number. `rounded`: or an interval about it.
pub fn number((minimum, maximum): (f64, f64), example: Option<&str>, rounded: bool) -> Value {
    let example = example.and_then(|text| text.parse::<serde_json::Number>().ok()).map(Value::Number);
    let mut schema = bounded(minimum, maximum);
    if rounded {
        schema["type"] = json!(["number", "string"]);
        schema["pattern"] = json!(format!("{START}{NUMBER}{OFF_BY}{POSITIVE}{END}"));
    }
    with_example(explained(schema, "a plain number is expected, without a unit"), example)
}

pub fn integer(minimum: i64, maximum: i64, multiple: i64, example: Option<&str>) -> Value {
    let mut schema = json!({ "type": "integer", "minimum": minimum, "maximum": maximum });
    if multiple != 1 {
        schema["multipleOf"] = json!(multiple);
    }
    let schema = explained(schema, &format!("{} is expected", words::integer(multiple)));
    with_example(schema, example.and_then(|text| text.parse::<i64>().ok()).map(|number| json!(number)))
}

/// A number with any unit, or none.
pub fn any_quantity(example: Option<&str>) -> Value {
    let schema = json!({ "type": ["number", "string"], "pattern": format!("{START}{NUMBER}") });
    let message = "a number is expected, with its unit if it has one, such as `4.2 um`";
    with_example(explained(schema, message), example.map(|text| json!(text)))
}

pub fn text(example: Option<&str>) -> Value {
    let schema = json!({ "type": ["string", "number", "boolean"] });
    with_example(explained(schema, "text is expected, on one line"), example.map(|text| json!(text)))
}

/// The name of a CSV file beside the study.
pub fn file() -> Value {
    let schema = json!({ "type": "string", "pattern": r"^[^/\\]+(/[^/\\]+)*\.[cC][sS][vV](\[[^\]]+\])?$" });
    with_example(explained(schema, "the name of a CSV file beside the study is expected"), Some(json!("trace.csv")))
}

/// What every name of a study, a stage or a file must look like.
const NAMES: &str = "a name has small letters, digits, `-` and `_`, and begins with a letter or a digit";

/// The name of a stage of one of these kinds.
pub fn reference(kinds: &[&str], example: Option<&str>) -> Value {
    let schema = json!({ "type": NAME_TYPES, "pattern": NAME_PATTERN });
    let message = format!("{} is expected; {NAMES}", words::stage_of(kinds));
    // In studies stages are mostly called after their kinds.
    let example = example.or(kinds.first().copied()).unwrap_or("ste");
    with_example(explained(schema, &message), Some(json!(example)))
}

/// What a name is to a reader of YAML: digits alone are a number, and a few words are true or false.
const NAME_TYPES: [&str; 3] = ["string", "integer", "boolean"];

/// The name of a study.
pub fn name() -> Value {
    explained(json!({ "type": NAME_TYPES, "pattern": NAME_PATTERN, "minimum": 0, "exclusiveMaximum": MOST }), NAMES)
}

/// Keys of a mapping, by their pattern. Editors see `<<`, which merges another mapping into this one, as a key.
fn keys(pattern: &str, message: &str) -> Value {
    explained(json!({ "pattern": format!("{pattern}|^<<$") }), message)
}

/// Names of stages, as keys.
pub fn names() -> Value {
    keys(NAME_PATTERN, NAMES)
}

/// Names of columns of the user's own, as keys.
pub fn columns() -> Value {
    keys(COLUMN_PATTERN, "a column's name has small letters, digits and `_`, and begins with a letter")
}

/// Where fields are, in the whole study, as keys.
pub fn paths() -> Value {
    let pattern = r"^[A-Za-z0-9_-]+([.][^.\[\] ]+|\[[0-9]+\])*$";
    let message = "a path is a stage and the way to a field in it, such as `pair.pinion.face_width`";
    keys(pattern, message)
}

/// One value, a list, or evenly spaced ones.
pub fn axis(single: &Value) -> Value {
    json!({ "anyOf": [single, { "type": "array", "minItems": 1, "maxItems": MOST_POINTS, "items": single }, spaced(single)] })
}

fn spaced(single: &Value) -> Value {
    json!({
        "type": "object",
        "required": ["from", "to", "count"],
        "additionalProperties": false,
        "properties": ends(single),
    })
}

/// Evenly spaced values, or values of one unit.
pub fn many(single: &Value) -> [Value; 2] {
    let of_one_unit = json!({
        "type": "object",
        "required": ["unit", "values"],
        "additionalProperties": false,
        "properties": {
            "unit": { "title": "Unit", "description": "The unit of all of them.", "type": "string", "examples": ["um"] },
            "values": {
                "title": "Values",
                "description": "The numbers, without a unit.",
                "type": "array",
                "items": { "type": "number" },
                "examples": [[-3, -1, 0.5]],
            },
        },
    });
    [spaced(single), of_one_unit]
}

/// The fields of evenly spaced values.
pub fn ends(single: &Value) -> Value {
    #[allow(clippy::cast_possible_wrap)] // a constant below a million
    let count = integer(2, MOST_POINTS as i64, 1, Some("5"));
    let named = |name: &str, description: &str, mut schema: Value| {
        schema["title"] = json!(title(name));
        schema["description"] = json!(description);
        schema
    };
    json!({
        "from": named("from", "The first value.", single.clone()),
        "to": named("to", "The last value, which is one of them.", single.clone()),
        "count": named("count", "How many values there are, with both ends.", count),
    })
}
