//! Which lines of a CSV file count: of several teeth one, or their average; and none with a mark of a missing value.
//!
//! `NAME.csv[tooth=3]` names the lines with 3 in the column `tooth`, `NAME.csv[tooth=mean]` the average of all teeth. A line `# missing: ---`
//! in the file leaves out every line with that mark. Must not know: fields.

use super::document::{Content, Node};
use super::words::quote;
use declare::error::{Diagnostic, Place};
use declare::number::counted;

/// The column of files of several teeth.
pub const TOOTH: &str = "tooth";
/// First letters of columns with the number of a tooth, in small letters.
const TEETH: [&str; 5] = ["tooth", "zahn", "teeth", "zähne", "dent"];
/// First letters of columns with the side of a tooth.
const FLANKS: [&str; 5] = ["flank", "side", "seite", "left/right", "l/r"];
/// The value of a condition that stands for the average of all.
const MEAN: &str = "mean";
/// Name of the line that says which marks stand for missing values.
const MISSING: &str = "missing";
/// Marks of missing values that are words, without the signs between their letters; those without digits and letters are marks too.
const MARKS: [&str; 17] = [
    "nan", "na", "nd", "ka", "null", "none", "nil", "missing", "void", "empty", "invalid", "error", "overflow", "ovf",
    "inf", "infinity", "infinite",
];
/// Errors of spreadsheets behind a `#`, in English and in German.
const ERRORS: [&str; 13] = [
    "n/a",
    "nv",
    "value!",
    "wert!",
    "div/0!",
    "num!",
    "zahl!",
    "null!",
    "ref!",
    "bezug!",
    "name?",
    "getting_data",
    "spill!",
];
/// What C libraries of Windows print behind the point, or the comma, of a number that is none: `1.#QNAN`, `-1.#IND00`.
const NO_NUMBERS: [&str; 4] = ["#qnan", "#snan", "#ind", "#inf"];
/// So many nines and nothing else are a mark, not a value.
const NINES: usize = 4;
/// How much of the range of a column its numbers may differ between teeth at places that are the same.
const SAME_PLACE: f64 = 1e-3;
/// Most values in a message.
const MOST_NAMED: usize = 10;

/// One cell of a line.
#[derive(Clone, Copy)]
pub(super) struct Cell<'a> {
    pub text: &'a str,
    pub place: Place,
}

/// A column.
pub(super) struct Column<'a> {
    pub name: Cell<'a>,
    /// None of a plain number.
    pub unit: Option<&'a str>,
    /// Whether its values say which lines are meant, and are no field.
    pub is_key: bool,
}

/// A line of values.
pub(super) struct Line<'a> {
    pub cells: Vec<Cell<'a>>,
}

/// A column, and the value that it must have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Condition {
    pub column: String,
    pub value: String,
}

/// The name of a file, and which of its lines are meant.
///
/// # Errors
/// When what stands in brackets is no condition.
pub fn file_and_conditions(text: &str) -> Result<(&str, Vec<Condition>), Diagnostic> {
    let Some((name, inside)) = text.strip_suffix(']').and_then(|rest| rest.split_once('[')) else {
        return Ok((text, Vec::new()));
    };
    let condition = |part: &str| {
        let (column, value) = part.split_once('=')?;
        let (column, value) = (column.trim().to_owned(), value.trim().to_owned());
        (!column.is_empty() && !value.is_empty()).then_some(Condition { column, value })
    };
    let conditions: Option<Vec<Condition>> = inside.split(',').map(condition).collect();
    match conditions {
        Some(conditions) => {
            let repeated = conditions.iter().enumerate().find(|(index, one)| {
                conditions[..*index].iter().any(|other| other.column.eq_ignore_ascii_case(&one.column))
            });
            if let Some((_, Condition { column, .. })) = repeated {
                let message =
                    format!("{} has two conditions on the column {}", quote(&format!("[{inside}]")), quote(column));
                return Err(Diagnostic::new(message).help("name one value of it"));
            }
            Ok((name, conditions))
        }
        None => {
            let message = format!("{} is not a condition on the lines of a file", quote(&format!("[{inside}]")));
            Err(Diagnostic::new(message).help("write `NAME.csv[tooth=3]`, or `NAME.csv[tooth=mean]` for the average"))
        }
    }
}

/// The lines that meet all conditions, tooth by tooth where their average is wanted, and of how many teeth that is.
pub(super) fn chosen<'a>(
    mut lines: Vec<Line<'a>>,
    columns: &[Column],
    conditions: &[Condition],
    header: Place,
) -> Result<(Vec<Line<'a>>, usize), Diagnostic> {
    let mut averaged = None;
    for condition in conditions {
        let name = &condition.column;
        let Some(at) = columns.iter().position(|column| column.name.text.eq_ignore_ascii_case(name)) else {
            let message =
                format!("there is no column {}, and the study names {}", quote(name), quote(&condition.value));
            return Err(Diagnostic::new(message)
                .at(header)
                .help("leave out the condition behind the name of the file"));
        };
        if condition.value == MEAN {
            averaged = Some(at);
            continue;
        }
        let values = values(&lines, at);
        lines.retain(|line| is_same(line.cells[at].text, &condition.value));
        if lines.is_empty() {
            let message = format!("no line has {} in the column {}", quote(&condition.value), quote(name));
            let help = format!("there are {}", listed(&values));
            return Err(Diagnostic::new(message).at(columns[at].name.place).help(help));
        }
    }
    if let Some(at) = averaged {
        let values = values(&lines, at);
        let groups: Vec<Vec<usize>> = values
            .iter()
            .map(|value| (0..lines.len()).filter(|line| is_same(lines[*line].cells[at].text, value)).collect())
            .collect();
        if let Some((other, group)) = values.iter().zip(&groups).find(|(_, group)| group.len() != groups[0].len()) {
            let (first, count) = (quote(values[0]), groups[0].len());
            let message = format!("{first} has {}, and {} has {}", counted(count, "line"), quote(other), group.len());
            let help = "an average needs as many of each: name one";
            return Err(Diagnostic::new(message).at(columns[at].name.place).help(help));
        }
        let order: Vec<usize> = groups.concat();
        let mut taken: Vec<Option<Line>> = lines.into_iter().map(Some).collect();
        return Ok((order.iter().filter_map(|line| taken[*line].take()).collect(), groups.len()));
    }
    for (at, column) in columns.iter().enumerate().filter(|(_, column)| is_tooth(column.name.text) && column.is_key) {
        let values = values(&lines, at);
        if values.len() > 1 && !conditions.iter().any(|condition| is_tooth(&condition.column)) {
            let message = format!("this file has several teeth: {}", listed(&values));
            let help = format!(
                "name one behind the file, `\"NAME.csv[tooth={}]\"`, or their average, `\"NAME.csv[tooth=mean]\"`",
                values[0]
            );
            return Err(Diagnostic::new(message).at(column.name.place).help(help));
        }
    }
    Ok((lines, 1))
}

/// The values of a column, each once, in the order of the lines.
fn values<'a>(lines: &[Line<'a>], at: usize) -> Vec<&'a str> {
    let mut found: Vec<&str> = Vec::new();
    for line in lines {
        let Cell { text, .. } = line.cells[at];
        if !found.iter().any(|other| is_same(other, text)) {
            found.push(text);
        }
    }
    found
}

fn listed(values: &[&str]) -> String {
    let shown: Vec<String> = values.iter().take(MOST_NAMED).map(|value| quote(value)).collect();
    shown.join(", ") + if values.len() > MOST_NAMED { ", …" } else { "" }
}

/// Replaces lists of so many teeth by their average, place by place.
pub(super) fn average(columns: &[Column], lists: &mut [(Vec<Node>, Place)], teeth: usize) -> Result<(), Diagnostic> {
    let last = columns.iter().rposition(|column| !column.is_key);
    for (index, ((items, _), column)) in
        lists.iter_mut().zip(columns).enumerate().filter(|(_, (_, column))| !column.is_key)
    {
        let numbers: Option<Vec<f64>> = items.iter().map(number).collect();
        let Some(numbers) = numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite())) else {
            let message = format!("the column {} has no average: not all of it are numbers", quote(column.name.text));
            return Err(Diagnostic::new(message).at(column.name.place));
        };
        let count = numbers.len() / teeth;
        let of = |point: usize| (0..teeth).map(move |tooth| tooth * count + point);
        let (least, largest) =
            numbers.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(*value), b.max(*value)));
        let is_same_place =
            |point: usize| of(point).all(|at| (numbers[at] - numbers[point]).abs() <= SAME_PLACE * (largest - least));
        // Values of the last column are averaged; those before it say where.
        if Some(index) != last && !(0..count).all(is_same_place) {
            let message =
                format!("the places in {} are not the same for all that are averaged", quote(column.name.text));
            let help = "an average needs the same places for all of them, and the averaged values in the last column";
            return Err(Diagnostic::new(message).at(column.name.place).help(help));
        }
        for point in 0..count {
            #[allow(clippy::cast_precision_loss)] // no file has so many teeth
            let mean = of(point).map(|at| numbers[at]).sum::<f64>() / teeth as f64;
            let is_one = of(point).all(|at| numbers[at].to_bits() == numbers[point].to_bits());
            if let (Content::Scalar { text, .. }, false) = (&mut items[point].content, is_one) {
                let unit = text.split_once(' ').map_or(String::new(), |(_, unit)| format!(" {unit}"));
                *text = format!("{mean}{unit}");
            }
        }
        items.truncate(count);
    }
    Ok(())
}

/// The number of a value, without its unit.
fn number(node: &Node) -> Option<f64> {
    let Content::Scalar { text, .. } = &node.content else { return None };
    text.split(' ').next()?.parse().ok()
}

/// Whether two cells say the same: as texts, whatever their letters, or as numbers, with a decimal point or a decimal comma.
pub(super) fn is_same(one: &str, other: &str) -> bool {
    let number = |text: &str| text.replacen(',', ".", 1).parse::<f64>().ok();
    let both = number(one).zip(number(other));
    one.eq_ignore_ascii_case(other) || both.is_some_and(|(one, other)| one - other == 0.0)
}

/// Whether a column says which tooth a line is of.
pub(super) fn is_tooth(name: &str) -> bool {
    name.eq_ignore_ascii_case(TOOTH)
}

/// The remedy for a column that says which lines are meant by another name than a study does.
pub(super) fn of_lines(name: &str) -> Option<String> {
    let name_in_small = name.to_lowercase();
    let begins = |words: &[&str]| words.iter().any(|word| name_in_small.starts_with(word));
    let condition = |column: &str, value: &str| format!("`\"NAME.csv[{column}={value}]\"`");
    if begins(&TEETH) {
        return Some(format!(
            "call the column `{TOOTH}`, or name the lines that count behind the file, {}",
            condition(name, "1")
        ));
    }
    begins(&FLANKS).then(|| format!("name the lines that count behind the file, {}", condition(name, "left")))
}

/// Whether a cell is a mark that programs write for what was not measured.
pub(super) fn is_mark(text: &str) -> bool {
    let has_none = !text.chars().any(char::is_alphanumeric);
    let whole = text.trim_start_matches(['-', '+']);
    let whole = whole
        .split_once(['.', ','])
        .filter(|(_, rest)| is_all(rest, b'0') || is_all(rest, b'9'))
        .map_or(whole, |it| it.0);
    let is_nines = whole.len() >= NINES && is_all(whole, b'9');
    let word = text.trim_start_matches(['-', '+']).to_ascii_lowercase();
    let letters: String = word.chars().filter(|letter| !"./ <>()".contains(*letter)).collect();
    let is_no_number = |text: &str| NO_NUMBERS.iter().any(|begin| text.starts_with(begin));
    has_none
        || is_nines
        || is_error(text)
        || MARKS.contains(&letters.as_str())
        || word.starts_with("nan(")
        || word.split_once(['.', ',']).is_some_and(|(whole, rest)| whole == "1" && is_no_number(rest))
}

/// Whether a text is an error of a spreadsheet, which begins as a comment does.
pub(super) fn is_error(text: &str) -> bool {
    text.strip_prefix('#').is_some_and(|word| ERRORS.iter().any(|error| word.eq_ignore_ascii_case(error)))
}

fn is_all(digits: &str, digit: u8) -> bool {
    digits.bytes().all(|byte| byte == digit)
}

/// The list of marks that a comment line states.
pub(super) fn missing(said: &str) -> Option<&str> {
    let (_, list) = said.split_once(':').filter(|(name, _)| name.trim().eq_ignore_ascii_case(MISSING))?;
    let list = list.trim();
    Some(list.strip_prefix('[').and_then(|list| list.strip_suffix(']')).unwrap_or(list))
}

/// The marks of a list of a file whose columns are parted by `separator`. Commas part them; one between two digits is a decimal comma.
///
/// # Errors
/// If a comma stands between two digits, and the columns are parted by commas.
pub(super) fn marks(list: &str, separator: char) -> Result<Vec<&str>, Diagnostic> {
    let mut marks = Vec::new();
    let (mut start, mut quote_sign) = (0, None);
    for (at, letter) in list.char_indices() {
        match (letter, quote_sign) {
            ('"' | '\'', None) => quote_sign = Some(letter),
            (_, Some(sign)) if sign == letter => quote_sign = None,
            (',', None) => {
                let is_digit = |letter: Option<char>| letter.is_some_and(|letter| letter.is_ascii_digit());
                let next = list[at + 1..].chars().next();
                let is_decimal = is_digit(list[..at].chars().next_back()) && (is_digit(next) || next == Some('#'));
                if !is_decimal {
                    marks.push(&list[start..at]);
                    start = at + 1;
                } else if separator == ',' {
                    let message = format!("{} can be read as one mark and as two", quote(&list[start..]));
                    return Err(Diagnostic::new(message)
                        .help("write a space behind a comma between two marks, and a decimal point in a number"));
                }
            }
            _ => {}
        }
    }
    marks.push(&list[start..]);
    Ok(marks.into_iter().map(|mark| mark.trim().trim_matches(['"', '\''])).collect())
}
