//! From what Python gives to the values of declared parameters: numbers are SI, a text has its unit (`"12 um"`), and what
//! has units of its own (pint) is converted.
//!
//! Must not know: what any parameter means.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyException, PyOverflowError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

use declare::declared::default;
use declare::error::{Diagnostic, Place, suggest};
use declare::parameter::{Field, Member, Presence, Shape, Span};
use declare::record::{PlacedValue, Record, Value};
use declare::units::{Dimension, Quantity, RATIO, described, parse_quantity, same_dimension};

use crate::errors::{refused, unless_stopped};

/// A number of things, as the word of a call says it.
///
/// # Errors
/// What is no whole number from 0 on.
pub fn count(given: &Bound<'_, PyAny>) -> PyResult<usize> {
    given.extract().map_err(|wrong: PyErr| {
        let beyond = wrong.is_instance_of::<PyOverflowError>(given.py());
        // Python's own words for it name neither the argument nor the value.
        if beyond { PyTypeError::new_err(format!("{given} is no number of things")) } else { wrong }
    })
}

/// A field that was given as many values as there are designs.
pub type Column = (&'static str, Vec<f64>);

/// The record that the words of a call say; `of` is what they are about, in messages.
///
/// # Errors
/// A word that no field has, a value of another type, unit or range, a field that is missing.
pub fn record(fields: &'static [Field], given: &Bound<'_, PyDict>, of: &str) -> PyResult<Record> {
    read(fields, given, of, None)
}

/// The same where numbers with a range may be arrays: the record has their first elements.
///
/// # Errors
/// As [`record`]; an empty array.
pub fn record_of_arrays(
    fields: &'static [Field],
    given: &Bound<'_, PyDict>,
    of: &str,
) -> PyResult<(Record, Vec<Column>)> {
    let mut columns = Vec::new();
    let record = read(fields, given, of, Some(&mut columns))?;
    Ok((record, columns))
}

fn read(
    fields: &'static [Field],
    given: &Bound<'_, PyDict>,
    of: &str,
    mut columns: Option<&mut Vec<Column>>,
) -> PyResult<Record> {
    let py = given.py();
    let names = || fields.iter().map(|field| field.name);
    for key in given.keys() {
        let key: String = key.extract()?;
        if !names().any(|name| name == key) {
            let help = suggest(&key, names());
            return Err(refused(py, &Diagnostic::new(format!("{of} has no `{key}`")).help(help)));
        }
    }
    let mut all = Vec::with_capacity(fields.len());
    for field in fields {
        let value = given.get_item(field.name)?.filter(|value| !value.is_none());
        let value = match (value, field.presence) {
            (Some(value), _) => match columns.as_deref_mut().filter(|_| field.span == Span::Range) {
                Some(columns) => varied(field, &value, columns)?,
                None => one(&field.shape, &value, field.name)?,
            },
            (None, Presence::Optional) => continue,
            (None, Presence::Default(text)) => default(&field.shape, text),
            (None, Presence::Required) => {
                let wrong = Diagnostic::new(format!("{of} needs `{}`", field.name)).help(field.summary);
                return Err(refused(py, &wrong));
            }
        };
        all.push((field.name, placed(value)));
    }
    Ok(Record { fields: all, place: Place::default() })
}

fn placed(value: Value) -> PlacedValue {
    PlacedValue { value, place: Place::default() }
}

/// A number, or an array of which each element is a design's own.
fn varied(field: &Field, given: &Bound<'_, PyAny>, columns: &mut Vec<Column>) -> PyResult<Value> {
    let values = match &field.shape {
        Shape::Quantity { dimension, .. } => quantities(given, *dimension, field.name)?,
        _ => array(given, field.name)?,
    };
    let Some(values) = values else { return one(&field.shape, given, field.name) };
    let scalar = |value: f64| number_of(&field.shape, value, field.name);
    let Some(&first) = values.first() else {
        return Err(refused(given.py(), &Diagnostic::new(format!("`{}` is an empty array", field.name))));
    };
    for (index, value) in values.iter().enumerate() {
        scalar(*value).map_err(|wrong| crate::errors::refused_at(given.py(), index, &wrong))?;
    }
    columns.push((field.name, values));
    scalar(first).map_err(|wrong| refused(given.py(), &wrong))
}

/// The values in SI of an array, also one with units, or of a list of quantities and texts; none of what is a single value.
///
/// # Errors
/// As [`array`] and [`number`].
pub fn quantities(given: &Bound<'_, PyAny>, dimension: Dimension, name: &str) -> PyResult<Option<Vec<f64>>> {
    if has_units(given)? {
        let magnitude = magnitude(given, dimension)?.ok_or_else(|| misfit(given, dimension, name))?;
        return array(&magnitude, name);
    }
    if given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() {
        let items = given.try_iter()?.collect::<PyResult<Vec<_>>>()?;
        let has_unit = |item: &Bound<'_, PyAny>| Ok::<_, PyErr>(item.is_instance_of::<PyString>() || has_units(item)?);
        if items.iter().map(has_unit).collect::<PyResult<Vec<_>>>()?.contains(&true) {
            return items.iter().map(|item| number(item, dimension, name)).collect::<PyResult<_>>().map(Some);
        }
    }
    array(given, name)
}

/// What numpy makes of something, its kind of numbers, and its shape; refused with a mask, which nothing here minds.
///
/// # Errors
/// What numpy cannot take for an array.
pub fn numpy_array<'py>(given: &Bound<'py, PyAny>, name: &str) -> PyResult<(Bound<'py, PyAny>, String, Vec<usize>)> {
    let py = given.py();
    let numpy = py.import("numpy")?;
    let wrong =
        |what: &str| refused(py, &Diagnostic::new(format!("`{name}` {what}")).help("an array of numbers is expected"));
    if given.is_instance(&numpy.getattr("ma")?.getattr("MaskedArray")?)? {
        return Err(wrong("is an array with a mask"));
    }
    let read = numpy
        .call_method1("asarray", (given,))
        .map_err(|raised| unless_stopped(py, raised, || wrong("is no array")))?;
    let kind = read.getattr("dtype")?.getattr("kind")?.extract()?;
    let shape = read.getattr("shape")?.extract()?;
    Ok((read, kind, shape))
}

/// The values of an array, of any stride and any type of numbers, in one dimension; none of what is a single value.
///
/// # Errors
/// More than one dimension; elements that are no numbers; a mask.
pub fn array(given: &Bound<'_, PyAny>, name: &str) -> PyResult<Option<Vec<f64>>> {
    let py = given.py();
    let is_single = |value: &Bound<'_, PyAny>| {
        value.is_instance_of::<PyFloat>() || value.is_instance_of::<PyInt>() || value.is_instance_of::<PyString>()
    };
    if is_single(given) {
        return Ok(None);
    }
    if let Ok(array) = given.cast_exact::<PyArray1<f64>>()
        && let Ok(values) = array.to_vec()
    {
        return Ok(Some(values));
    }
    if !(given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() || given.hasattr("__array__")?) {
        return Ok(None);
    }
    let (read, kind, shape) = numpy_array(given, name)?;
    if shape.is_empty() {
        return Ok(None);
    }
    if shape.len() > 1 || !matches!(kind.as_str(), "f" | "i" | "u") {
        let wrong = format!("`{name}` is an array of shape {shape:?} and type {}", read.getattr("dtype")?);
        return Err(refused(py, &Diagnostic::new(wrong).help("numbers in one dimension are expected")));
    }
    let values = py.import("numpy")?.call_method1("ascontiguousarray", (read, "float64"))?;
    Ok(Some(values.cast::<PyArray1<f64>>()?.to_vec()?))
}

/// One number in SI.
///
/// # Errors
/// What is no number, or of another unit.
pub fn number(given: &Bound<'_, PyAny>, dimension: Dimension, name: &str) -> PyResult<f64> {
    let wrong = |found: String| unfit(given, dimension, name, &found);
    let finite = |value: f64| if value.is_finite() { Ok(value) } else { Err(wrong(value.to_string())) };
    if given.is_instance_of::<PyFloat>() {
        return finite(given.extract()?);
    }
    if is_flag(given)? {
        return Err(wrong(given.to_string()));
    }
    if let Ok(text) = given.cast::<PyString>() {
        let text = text.to_str()?;
        let Quantity { value, dimension: found, has_unit } =
            parse_quantity(text).map_err(|error| wrong(format!("`{text}`: {error}")))?;
        let is_bare = !has_unit && !same_dimension(dimension, RATIO);
        let fits = same_dimension(found, dimension) && !is_bare;
        return if fits { Ok(value) } else { Err(wrong(format!("`{text}`"))) };
    }
    if has_units(given)? {
        let magnitude = magnitude(given, dimension)?.ok_or_else(|| misfit(given, dimension, name))?;
        let misfit = |raised| unless_stopped(given.py(), raised, || misfit(given, dimension, name));
        return magnitude.extract().map_err(misfit).and_then(finite);
    }
    let no_number = |raised| unless_stopped(given.py(), raised, || wrong(described_value(given)));
    given.extract::<f64>().map_err(no_number).and_then(finite)
}

/// Whether it is true or false, be it numpy's.
fn is_flag(given: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(given.is_instance_of::<PyBool>() || matches!(&*given.get_type().name()?.to_string_lossy(), "bool" | "bool_"))
}

/// What is said of a value that is none of a dimension.
fn unfit(given: &Bound<'_, PyAny>, dimension: Dimension, name: &str, found: &str) -> PyErr {
    let wanted = if dimension == RATIO { "a number".to_owned() } else { format!("{} in SI", described(dimension)) };
    let help = format!("{wanted} is expected, as a number or with its unit as a text");
    refused(given.py(), &Diagnostic::new(format!("`{name}` is {found}")).help(help))
}

fn misfit(given: &Bound<'_, PyAny>, dimension: Dimension, name: &str) -> PyErr {
    unfit(given, dimension, name, &format!("`{given}`"))
}

/// Whether it is a quantity of pint, or of what converts itself as those do.
fn has_units(given: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(given.hasattr("dimensionality")? && given.hasattr("to")?)
}

/// The magnitude in SI of what converts itself; none of another dimension.
fn magnitude<'py>(given: &Bound<'py, PyAny>, dimension: Dimension) -> PyResult<Option<Bound<'py, PyAny>>> {
    let mut found = Dimension { angle: dimension.angle, ..RATIO };
    let powers = given.py().import("builtins")?.getattr("dict")?.call1((given.getattr("dimensionality")?,))?;
    for (name, power) in powers.cast::<PyDict>()? {
        let power: f64 = power.extract()?;
        let name: String = name.extract()?;
        let is_whole = power.fract() == 0.0 && power.abs() <= f64::from(i8::MAX);
        let place = match name.as_str() {
            "[length]" => &mut found.length,
            "[mass]" => &mut found.mass,
            "[time]" => &mut found.time,
            _ => return Ok(None),
        };
        if !is_whole {
            return Ok(None);
        }
        #[allow(clippy::cast_possible_truncation)] // whole and small
        let whole = power as i8;
        *place = whole;
    }
    if !same_dimension(found, dimension) {
        return Ok(None);
    }
    // Its base units may be others than those of SI.
    let Dimension { length, mass, time, angle, .. } = dimension;
    let unit = format!("meter ** {length} * kilogram ** {mass} * second ** {time} * radian ** {angle}");
    given.call_method1("to", (unit,))?.getattr("magnitude").map(Some)
}

fn described_value(given: &Bound<'_, PyAny>) -> String {
    let kind = given.get_type().name().map_or_else(|_| "something".to_owned(), |name| name.to_string());
    let shown = given.repr().map_or_else(|_| String::new(), |shown| shown.to_string());
    if shown.is_empty() || shown.len() > 60 { format!("of type {kind}") } else { shown }
}

/// A number that is within what a field declares.
fn number_of(shape: &Shape, value: f64, name: &str) -> Result<Value, Diagnostic> {
    let (minimum, maximum, unit) = match *shape {
        Shape::Quantity { dimension: RATIO, minimum, maximum } | Shape::Number { minimum, maximum } => {
            (minimum, maximum, "")
        }
        Shape::Quantity { dimension, minimum, maximum } => (minimum, maximum, dimension.si()),
        _ => return Err(Diagnostic::new(format!("`{name}` is no number"))),
    };
    if !(minimum..=maximum).contains(&value) {
        let shown = |value: f64| format!("{value} {unit}").trim_end().to_owned();
        let help = format!("it may be {} to {}", shown(minimum), shown(maximum));
        return Err(Diagnostic::new(format!("`{name}` is {}", shown(value))).help(help));
    }
    Ok(if matches!(shape, Shape::Number { .. }) { Value::Number(value) } else { Value::Quantity(value) })
}

fn one(shape: &Shape, given: &Bound<'_, PyAny>, name: &str) -> PyResult<Value> {
    let py = given.py();
    let wrong = |expected: &str| {
        let message = format!("`{name}` is {}", described_value(given));
        refused(py, &Diagnostic::new(message).help(format!("{expected} is expected")))
    };
    let listed = |names: &[&str]| format!("one of {}", names.join(", "));
    match shape {
        Shape::Quantity { dimension, .. } => {
            number_of(shape, number(given, *dimension, name)?, name).map_err(|wrong| refused(py, &wrong))
        }
        Shape::Number { .. } => {
            number_of(shape, number(given, RATIO, name)?, name).map_err(|wrong| refused(py, &wrong))
        }
        Shape::Integer { minimum, maximum, multiple } => {
            let is_flag = is_flag(given)?;
            let read = given.extract::<i64>().map(Some);
            let read =
                read.or_else(|raised| if raised.is_instance_of::<PyException>(py) { Ok(None) } else { Err(raised) });
            let found =
                read?.filter(|found| !is_flag && (*minimum..=*maximum).contains(found) && found % multiple == 0);
            let of = if *multiple == 1 { String::new() } else { format!(", a multiple of {multiple},") };
            let expected = format!("a whole number from {minimum} to {maximum}{of}");
            found.map(Value::Integer).ok_or_else(|| wrong(&expected))
        }
        Shape::Flag => {
            given.cast::<PyBool>().map(|flag| Value::Flag(flag.is_true())).map_err(|_| wrong("True or False"))
        }
        Shape::Text => given.extract().map(Value::Text).map_err(|_| wrong("a text")),
        Shape::Choice(choices) => {
            let names: Vec<&str> = choices.iter().map(|choice| choice.name).collect();
            let text: String = given.extract().map_err(|_| wrong(&listed(&names)))?;
            let found = names.iter().find(|name| **name == text);
            found.map(|name| Value::Choice(name)).ok_or_else(|| {
                let help = suggest(&text, names.iter().copied());
                refused(py, &Diagnostic::new(format!("`{name}` is `{text}`")).help(help))
            })
        }
        Shape::List(item) => {
            let items: Vec<Bound<'_, PyAny>> = match given.cast::<PyString>() {
                Ok(_) => vec![given.clone()],
                Err(_) => given.try_iter().map_or_else(|_| Ok(vec![given.clone()]), Iterator::collect)?,
            };
            items.iter().map(|each| one(item, each, name).map(placed)).collect::<PyResult<_>>().map(Value::List)
        }
        Shape::Group(fields) => {
            let (_, inside) = declared(given)?.ok_or_else(|| wrong("a mapping from names to values"))?;
            record(fields, &inside, &format!("`{name}`")).map(Value::Group)
        }
        Shape::Member(members) => member(members(), given, name)?.ok_or_else(|| {
            let names: Vec<&str> = members().iter().map(|member| member.name).collect();
            wrong(&listed(&names))
        }),
        Shape::File
        | Shape::AnyQuantity
        | Shape::Reference(_)
        | Shape::Map(_)
        | Shape::Overrides(_)
        | Shape::Varied(_) => Err(wrong("a value that only a study can have")),
    }
}

/// The name and the fields of an object of `gearstudy.declared`, or the fields of a mapping; none of anything else.
///
/// # Errors
/// What Python says.
pub fn declared<'py>(given: &Bound<'py, PyAny>) -> PyResult<Option<(Option<String>, Bound<'py, PyDict>)>> {
    if let Ok(fields) = given.cast::<PyDict>() {
        return Ok(Some((None, fields.clone())));
    }
    let Some(fields) = given.getattr_opt("fields")? else { return Ok(None) };
    let Ok(fields) = fields.cast_into::<PyDict>() else { return Ok(None) };
    let name = given.getattr_opt("name")?.filter(|name| !name.is_none());
    Ok(Some((name.map(|name| name.extract()).transpose()?, fields)))
}

/// A member of a family: its name, `{name: {fields}}`, or an object of `gearstudy.declared`; none of anything else.
fn member(members: &'static [Member], given: &Bound<'_, PyAny>, of: &str) -> PyResult<Option<Value>> {
    let py = given.py();
    let (name, fields) = if let Ok(name) = given.cast::<PyString>() {
        (name.to_str()?.to_owned(), PyDict::new(py))
    } else {
        match declared(given)? {
            Some((Some(name), fields)) => (name, fields),
            Some((None, pairs)) if pairs.len() == 1 => {
                let (name, fields) = pairs.iter().next().ok_or_else(|| crate::errors::bug("an empty mapping"))?;
                let Ok(fields) = fields.cast_into::<PyDict>() else { return Ok(None) };
                (name.extract()?, fields)
            }
            _ => return Ok(None),
        }
    };
    let Some(found) = members.iter().find(|member| member.name == name) else {
        let help = suggest(&name, members.iter().map(|member| member.name));
        return Err(refused(py, &Diagnostic::new(format!("`{of}` is `{name}`")).help(help)));
    };
    record(found.fields, &fields, &format!("`{name}`")).map(|record| Some(Value::Member(found.name, record)))
}
