//! Stage kinds in words, from the declarations that read them.
//!
//! Must not know: any kind by name, or how wide the terminal is.

use std::fmt::Write as _;

use super::words::{self, quote};
use crate::stage::Kind;
use declare::error::suggest;
use declare::parameter::{Field, Member, Presence, Shape, Span};
use declare::units::RATIO;

/// One line for each kind.
#[must_use]
pub fn list(kinds: &[&'static Kind]) -> String {
    let width = kinds.iter().map(|kind| kind.name.len()).max().unwrap_or(0);
    let lines: Vec<_> = kinds.iter().map(|kind| format!("{:width$}  {}\n", kind.name, kind.summary)).collect();
    lines.concat()
}

/// A kind with all its fields and its example.
#[must_use]
pub fn kind(kind: &'static Kind) -> String {
    let mut text = format!("{}\n  {}\n\nfields\n", kind.name, kind.summary);
    let mut families = Vec::new();
    fields(&mut text, kind.fields, 1, &mut families);
    text += "\nexample\n";
    for line in kind.example.trim().lines() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {line}");
    }
    text
}

/// What a path of names leads to from the fields of a kind: `design.tip_relief.amount` of an optimiser.
///
/// # Errors
/// The name that is not there, and what is.
pub fn within(kind: &'static Kind, path: &str) -> Result<String, String> {
    let mut here: Inside = Inside::Fields(kind.fields);
    let mut place = kind.name.to_owned();
    let mut found = String::new();
    for name in path.split('.') {
        let missing = |known: Vec<&'static str>| {
            format!("{} has no {}; {}", quote(&place), quote(name), suggest(name, known.iter().copied()))
        };
        let mut text = format!("{place}.{name}\n");
        let mut families = Vec::new();
        here = match here {
            Inside::Fields(all) => {
                let named = |field: &&Field| field.name == name;
                let at = all.iter().position(|field| named(&field));
                let at = at.ok_or_else(|| missing(all.iter().map(|field| field.name).collect()))?;
                fields(&mut text, &all[at..=at], 1, &mut families);
                Inside::of(&all[at].shape)
            }
            Inside::Members(all) => {
                let member = all.iter().find(|member| member.name == name);
                let member = member.ok_or_else(|| missing(all.iter().map(|member| member.name).collect()))?;
                let _ = writeln!(text, "  {}: {}", member.name, member.summary);
                fields(&mut text, member.fields, 2, &mut families);
                Inside::Fields(member.fields)
            }
            Inside::Nothing => return Err(missing(Vec::new())),
        };
        found = text;
        place = format!("{place}.{name}");
    }
    Ok(found)
}

/// What has names below a field.
pub(super) enum Inside {
    Fields(&'static [Field]),
    Members(&'static [Member]),
    Nothing,
}

impl Inside {
    pub(super) fn of(shape: &'static Shape) -> Self {
        match shape {
            Shape::List(item) | Shape::Map(item) => Self::of(item),
            Shape::Group(fields) => Self::Fields(fields),
            Shape::Member(members) => Self::Members(members()),
            _ => Self::Nothing,
        }
    }
}

/// Whether a field, a word or a member of a family of a kind is called so.
#[must_use]
pub fn mentions(described: &'static Kind, name: &str) -> bool {
    let text = kind(described);
    let mut names = text.lines().filter_map(|line| line.trim_start_matches([' ', '-']).split_once(": "));
    names.any(|(found, _)| found == name)
}

fn fields(text: &mut String, fields: &'static [Field], level: usize, families: &mut Vec<Vec<&'static str>>) {
    let indent = "  ".repeat(level);
    for field in fields {
        let _ = writeln!(text, "{indent}{}", heading(field));
        let _ = writeln!(text, "{indent}    {}", field.summary);
        inside(text, &field.shape, level + 1, families);
    }
}

/// What a field holds, and whether it must be there, on one line.
fn heading(field: &Field) -> String {
    let presence = match field.presence {
        Presence::Required => "required".to_owned(),
        Presence::Optional => "optional".to_owned(),
        Presence::Default(default) => format!("default {}", quote(default)),
    };
    let span = match field.span {
        Span::Single => "",
        Span::Axis { .. } => "; one value, a list, or { from, to, count }",
        Span::Range => "; [least, most] where an optimiser chooses",
    };
    format!("{}: {}{span} ({presence})", field.name, holds(&field.shape))
}

/// A field by itself, without what is below it.
#[must_use]
pub fn field(field: &Field) -> String {
    let example = field.example.map_or_else(String::new, |example| format!("\nfor example `{example}`"));
    format!("{}\n{}{example}", heading(field), field.summary)
}

/// What is named below a field: choices, fields, members.
fn inside(text: &mut String, shape: &'static Shape, level: usize, families: &mut Vec<Vec<&'static str>>) {
    let indent = "  ".repeat(level);
    match shape {
        Shape::Choice(choices) => {
            for choice in *choices {
                let _ = writeln!(text, "{indent}- {}: {}", choice.name, choice.summary);
            }
        }
        Shape::List(item) | Shape::Map(item) => inside(text, item, level, families),
        Shape::Group(inner) => fields(text, inner, level, families),
        Shape::Member(members) => {
            let names: Vec<_> = members().iter().map(|member| member.name).collect();
            // A family may be used twice, and may hold itself.
            if families.contains(&names) {
                let _ = writeln!(text, "{indent}- the same as above: {}", words::alternatives(names));
                return;
            }
            families.push(names);
            for member in members() {
                let _ = writeln!(text, "{indent}- {}: {}", member.name, member.summary);
                fields(text, member.fields, level + 2, families);
            }
        }
        _ => {}
    }
}

/// What a shape holds, in a few words.
pub(super) fn holds(shape: &Shape) -> String {
    let with_range = |what: &str, range: Option<String>| match range {
        Some(range) => format!("{what}, {range}"),
        None => what.to_owned(),
    };
    match shape {
        Shape::Quantity { dimension, minimum, maximum } => {
            let range = words::range(*minimum, *maximum, |value| words::quantity(value, *dimension));
            let (name, units) = dimension.describe();
            if *dimension == RATIO || units.is_empty() {
                return with_range(name, range);
            }
            with_range(&format!("{name} in {}", units.join(", ")), range)
        }
        Shape::AnyQuantity => "a number, with or without a unit".to_owned(),
        Shape::Number { minimum, maximum } => {
            with_range("a plain number", words::range(*minimum, *maximum, words::number))
        }
        Shape::Integer { minimum, maximum, multiple } => {
            with_range(&words::integer(*multiple), words::integer_range(*minimum, *maximum))
        }
        Shape::Flag => "true or false".to_owned(),
        Shape::Text => "text".to_owned(),
        Shape::File => "the name of a CSV file, `NAME.csv`".to_owned(),
        Shape::Choice(_) => "one of these words".to_owned(),
        Shape::Reference(kinds) => words::stage_of(kinds),
        Shape::List(item @ (Shape::Quantity { .. } | Shape::Number { .. })) => {
            format!("a list, {{ unit, values }} or {{ from, to, count }}, each {}", holds(item))
        }
        Shape::List(item) => format!("a list, each {}", holds(item)),
        Shape::Map(item) => format!("names of your own, each with {}", holds(item)),
        Shape::Group(_) => "these fields".to_owned(),
        Shape::Member(_) => "one of these, `name` or `name: { fields }`".to_owned(),
        Shape::Overrides(of) => format!("fields of the stage in `{of}`, in the place of its own"),
        Shape::Varied(of) => format!(
            "names of columns, each with a `field` of the stage in `{of}` or of one that it reads, and its `values` or \
             `from`, `to` and `count`"
        ),
    }
}
