//! What is compared with a published value, and what proves a reason: a cell, a formula, a claim.
//!
//! Must not know: values.

use super::super::printed::{Row, within};
use super::super::stated::{Published, StatedProof};
use crate::stage::formula::{Formula, names_in};
use crate::stage::operand::Operand;
use crate::stage::operand::names::{Operands, Shared, read_formula, read_operands};
use declare::declared::Placed;
use declare::error::{Diagnostic, Place};
use declare::record::Record;

/// Names that a proof may use without giving them.
pub const GIVEN: [&str; 2] = ["published", "computed"];

/// What is compared with the published value.
pub enum Subject {
    Cell(Operand),
    Formula(Formula, Operands),
    /// True or false in every row.
    Claim(Formula, Operands),
}

/// What proves a reason.
pub struct Proof {
    pub claim: Formula,
    /// Where it stands.
    pub place: Place,
    pub with: Operands,
}

impl Subject {
    /// The cell, formula or claim as written.
    pub fn text(&self) -> &str {
        match self {
            Self::Cell(operand) => &operand.text,
            Self::Formula(formula, _) | Self::Claim(formula, _) => &formula.text,
        }
    }

    /// What its names stand for.
    pub fn with(&self) -> String {
        match self {
            Self::Cell(_) => String::new(),
            Self::Formula(_, with) | Self::Claim(_, with) => {
                let with: Vec<String> =
                    with.iter().map(|(name, operand)| format!("{name} = {}", operand.text)).collect();
                with.join("; ")
            }
        }
    }
}

/// What an entry is about, by the name of its field.
pub fn given(stated: &Published) -> impl Iterator<Item = (&'static str, &Placed<String>)> {
    let names = Published::NAMES;
    let all = [(names.cell, &stated.cell), (names.formula, &stated.formula), (names.claim, &stated.claim)];
    all.into_iter().filter_map(|(field, text)| Some((field, text.as_ref()?)))
}

/// # Errors
/// What is wrong with it, at its place.
pub fn read_subject(
    stated: &Published,
    row: Option<&Row>,
    record: &Record,
    shared: &Shared,
) -> Result<Subject, Diagnostic> {
    let given: Vec<_> = given(stated).collect();
    let [(_, written @ Placed { value: text, place })] = given[..] else {
        let fields: Vec<&str> = given.iter().map(|(field, _)| *field).collect();
        let found = if fields.is_empty() { "none".to_owned() } else { format!("`{}`", fields.join("` and `")) };
        let what = match row {
            Some(_) => "a row has one of `cell` and `formula`",
            None => "an entry has one of `cell`, `formula` and `claim`",
        };
        let message = format!("{what}; found {found}");
        return Err(Diagnostic::new(message).at(given.get(1).map_or(record.place, |(_, text)| text.place)));
    };
    let wrong = |message: String| Diagnostic::new(message).at(*place);
    if stated.cell.is_some() {
        if stated.with.is_some() {
            return Err(Diagnostic::new("`with` gives names to a `formula` or `claim`, not to a `cell`")
                .at(record.place_of(Published::NAMES.with)));
        }
        let operand = read_cell(written, row)?;
        return if operand.cell().is_some() {
            Ok(Subject::Cell(operand))
        } else {
            Err(wrong(format!("`{text}` is not a cell; write `stage.table[key=value, …].column`")))
        };
    }
    let mut with = read_operands(stated.with.as_deref().unwrap_or_default(), &[])?;
    if let Some(row) = row {
        let is_given = |name: &str| shared.has(name) || with.iter().any(|(own, _)| own == name);
        let cells = cells_in(written, row, &is_given)?;
        with.extend(cells);
    }
    let (formula, with) = read_formula(text, with, &[], *place, shared)?;
    match (stated.claim.is_some(), formula.is_claim()) {
        (false, false) => Ok(Subject::Formula(formula, with)),
        (true, true) => Ok(Subject::Claim(formula, with)),
        (false, true) if row.is_some() => {
            Err(wrong(format!("`{text}` is true or false, and a row has a number; claims stand in `published`")))
        }
        (false, true) => Err(wrong(format!("`{text}` is true or false; call it `claim` and give no value"))),
        (true, false) => Err(wrong(format!("`{text}` is a number; a claim compares, for example `ga <= iso`"))),
    }
}

/// What names in a formula of a row stand for that nothing else gives: cells, or columns of where the cells of the table begin.
fn cells_in(
    Placed { value: text, place }: &Placed<String>,
    row: &Row,
    is_given: &dyn Fn(&str) -> bool,
) -> Result<Operands, Diagnostic> {
    let names: Vec<String> = names_in(text).into_iter().flatten().filter(|name| !is_given(name)).collect();
    // `new-pair.pair.base_pitch` is a difference, which nobody means.
    let hyphened = |name: &String| {
        let before = text.split_once(name.as_str())?.0.strip_suffix('-')?;
        let from =
            before.rfind(|character: char| !(character.is_alphanumeric() || character == '_')).map_or(0, |at| at + 1);
        let word = &before[from..];
        (name.contains('.') && !word.is_empty() && word.parse::<f64>().is_err() && !is_given(word))
            .then(|| format!("{word}-{name}"))
    };
    if let Some(cell) = names.iter().find_map(hyphened) {
        let message = format!("`{cell}` is a difference here: a stage has a `-` in its name");
        return Err(Diagnostic::new(message).at(*place).help("give the cell a name in `let`"));
    }
    let cell = |name: String| {
        if row.of.is_none() && !name.contains('.') {
            let message = format!("`{name}` is not given, and the table does not say of what it is a column");
            let help = "add `of: stage.table[key=value, …]`, or give it in `let`";
            return Err(Diagnostic::new(message).at(*place).help(help));
        }
        let column = within(row.of.as_ref(), Placed { value: name.clone(), place: *place });
        Ok((name, read_cell(&column, Some(row))?))
    };
    names.into_iter().map(cell).collect()
}

/// A cell; one that begins as those of its table do has its rows from there.
fn read_cell(written: &Placed<String>, row: Option<&Row>) -> Result<Operand, Diagnostic> {
    let operand = Operand::read(written)?;
    let of = row.and_then(|row| row.of.as_ref()).filter(|of| operand.text.starts_with(of.value.trim()));
    Ok(match of {
        Some(of) => operand.with_rows_at(of.place),
        None => operand,
    })
}

/// # Errors
/// What is wrong with it, at its place.
pub fn read_proof(StatedProof { claim, with }: &StatedProof, shared: &Shared) -> Result<Proof, Diagnostic> {
    let with = read_operands(with.as_deref().unwrap_or_default(), &GIVEN)?;
    let place = claim.place;
    let (claim, with) = read_formula(&claim.value, with, &GIVEN, place, shared)?;
    if claim.is_claim() {
        Ok(Proof { claim, place, with })
    } else {
        Err(Diagnostic::new(format!("`{}` is a number; a proof compares, for example `{0} > published`", claim.text))
            .at(place))
    }
}
