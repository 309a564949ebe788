//! Other values of the fields of an example: every number in its text, and every declared field, as a study would set it.

use declare::parameter::{Choice, Field, Presence, Shape};
use declare::record::{Record, Value};

/// A change of a text, or something that is set.
pub enum Change {
    Text(String),
    Set(String),
}

/// The texts in which one number of `text` within `range` is another one.
pub fn other_numbers(text: &str, range: std::ops::Range<usize>) -> Vec<Vec<Change>> {
    let bytes = text.as_bytes();
    let is_in_word = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'^');
    let mut all = Vec::new();
    let mut at = range.start;
    while at < range.end {
        if !bytes[at].is_ascii_digit() || at > 0 && is_in_word(bytes[at - 1]) {
            at += 1;
            continue;
        }
        let number = |end: usize| text[at..end].parse::<f64>().is_ok();
        let end = (at + 1..=(at + 24).min(range.end))
            .rev()
            .find(|end| number(*end) && !is_in_word(bytes[*end]))
            .unwrap_or(at + 1);
        let value: f64 = text[at..end].parse().unwrap_or(0.0);
        // A little more, one more, one less, and twice as much: whole numbers and ends of ranges do not take all of these.
        let others = [value * 1.03 + 1e-3, value + 1.0, value - 1.0, value * 2.0, value * 0.5];
        let change = |other: f64| Change::Text(format!("{}{other}{}", &text[..at], &text[end..]));
        all.push(others.into_iter().map(change).collect());
        at = end;
    }
    all
}

/// Values of a field as a study writes them, of which at least one is another one than it has.
fn candidates(field: &Field, shape: &Shape) -> Vec<String> {
    let known = match field.presence {
        Presence::Default(text) => Some(text),
        _ => field.example,
    };
    match shape {
        Shape::Flag => vec!["true".to_owned(), "false".to_owned()],
        Shape::Choice(choices) => choices.iter().map(|choice: &Choice| choice.name.to_owned()).collect(),
        Shape::Member(members) => members().iter().map(|member| member.name.to_owned()).collect(),
        Shape::Text => field.example.into_iter().map(str::to_owned).chain(["other".to_owned()]).collect(),
        Shape::Quantity { .. } | Shape::AnyQuantity | Shape::Number { .. } | Shape::Integer { .. } => {
            let mut texts = Vec::new();
            for text in [field.example, known].into_iter().flatten() {
                texts.push(text.to_owned());
                for changes in other_numbers(&format!("{text} "), 0..text.len()) {
                    texts.extend(changes.into_iter().filter_map(|change| match change {
                        Change::Text(text) => Some(text.trim().to_owned()),
                        Change::Set(_) => None,
                    }));
                }
            }
            texts
        }
        Shape::List(item) => candidates(field, item).into_iter().map(|one| format!("[{one}]")).collect(),
        _ => field.example.into_iter().map(str::to_owned).collect(),
    }
}

/// Changes of every field of a record, those that are left out and those of groups, members and lists among them.
pub fn fields(path: &str, declared: &'static [Field], record: Option<&Record>, all: &mut Vec<(String, Vec<Change>)>) {
    for field in declared {
        let path = format!("{path}.{}", field.name);
        let value = record.and_then(|record| record.entry(field.name)).map(|entry| &entry.value);
        of_value(&path, field, &field.shape, value, all);
    }
}

fn of_value(
    path: &str,
    field: &'static Field,
    shape: &'static Shape,
    value: Option<&Value>,
    all: &mut Vec<(String, Vec<Change>)>,
) {
    match (shape, value) {
        // What stands for other stages is changed in the text.
        (Shape::Reference(_) | Shape::Varied(_) | Shape::Overrides(_) | Shape::File, _) => return,
        (Shape::Group(inner), Some(Value::Group(record))) => return fields(path, inner, Some(record), all),
        (Shape::Group(inner), _) => return fields(path, inner, None, all),
        (Shape::Member(members), Some(Value::Member(name, record))) => {
            if let Some(member) = members().iter().find(|member| member.name == *name) {
                fields(&format!("{path}.{name}"), member.fields, Some(record), all);
            }
        }
        (Shape::List(item), Some(Value::List(items))) => {
            for (at, entry) in items.iter().enumerate().take(2) {
                of_value(&format!("{path}[{at}]"), field, item, Some(&entry.value), all);
            }
        }
        (Shape::Map(item), Some(Value::Map(entries))) => {
            for (label, entry) in entries {
                of_value(&format!("{path}.{label}"), field, item, Some(&entry.value), all);
            }
            return;
        }
        _ => {}
    }
    let set = candidates(field, shape).into_iter().map(|text| Change::Set(format!("{path}={text}")));
    all.push((path.to_owned(), set.collect()));
}
