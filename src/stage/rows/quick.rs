//! The short way to what a curve of the transmission error amounts to: designs and load cases by themselves, no tables
//! between them, and nothing that is not asked.
//!
//! It is taken where the asked stage is one that loads a pair under a torque, as its fields say, and every asked column is
//! one of `numbers.rs`. Rows that differ in their torque alone share the gaps of their design. Must not know: where rows come
//! from, how a number is read off a curve.

use super::chain::{Chain, Tables, Trouble};
use super::numbers::{HARMONICS, Numbers};
use super::output::Output;
use super::{Class, Column};
use crate::stage::cases::{DEVIATIONS, Deviations};
use crate::stage::common::{self, Contact, Slices};
use crate::stage::designs::{self, Element, NamedDesign};
use crate::stage::neglected_corners::{self, REMEDY, WithoutCorners};
use crate::stage::{Context, Inputs};
use declare::declared::Declared;
use declare::error::{Failure, suggest};
use declare::number::significant;
use declare::record::varied::Axis;
use declare::record::{PlacedValue, Record, Value};
use declare::units::in_unit;
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::gear::modification::template::{Fitted, Template};
use gearmesh::gear::modification::{self, Design};
use studygraph::warning::Warning;

/// Names of fields and tables of the stage that loads a pair, and of the one that has the designs.
const TORQUE: &str = "torque";
const POSITIONS: &str = "positions";
const ACCURACY: &str = "accuracy";
const DESIGNS: &str = "designs";

/// The short way of rows.
pub struct Quick {
    numbers: Numbers,
    /// The columns of the torque and of the design.
    torque: Option<usize>,
    fixed_torque: f64,
    source: DesignSource,
    /// Whether the pair may be off as it is made and mounted.
    deviates: bool,
    /// Of the asked stage.
    last: usize,
}

/// Where the designs of rows come from.
enum DesignSource {
    /// The tables behind a port of the asked stage, which are those of a run.
    Tables,
    /// The record of a stage that has them: the link, and for each of its values that is varied its column, and the template's
    /// variable or none.
    Record { link: usize, template: Option<(Template, Vec<usize>)> },
}

/// What rows with the same pair and compliances share.
pub struct Upstream<'q> {
    pair: GearPair,
    base: Mesh,
    /// The design's.
    name: String,
    design: Option<Design>,
    /// The template that rows have their designs from.
    fitted: Option<Fitted<'q>>,
}

/// What the rows before left behind.
#[derive(Default)]
pub struct Before {
    sampled: Option<(Vec<u64>, CycleOfRow)>,
    design: Option<(Vec<u64>, Result<Design, String>)>,
    /// The same as it is made and mounted.
    off: Option<(Vec<u64>, Result<Design, String>)>,
}

/// A pair's cycle as a row has it sampled.
struct CycleOfRow {
    settings: Settings,
    harmonics: usize,
    cycle: Mesh,
}

impl Quick {
    /// None where the long way must be gone.
    pub fn new(chain: &Chain, columns: &[Column], outputs: &[Output], design: Option<&str>) -> Option<Self> {
        let last = chain.links.len() - 1;
        let record = &chain.links[last].record;
        let Value::Axis(torques) = &record.entry(TORQUE)?.value else { return None };
        if record.entry(ACCURACY).is_some() || record.entry(DESIGNS).is_none() {
            return None;
        }
        let Value::Integer(harmonics) = record.entry(HARMONICS)?.value else { return None };
        let numbers = Numbers::new(outputs)?;
        let varies_harmonics = columns.iter().any(|column| is_at(column, last, record, HARMONICS));
        if varies_harmonics || i64::try_from(numbers.highest_order()).map_or(true, |order| order > harmonics) {
            return None;
        }
        let torque = columns.iter().position(|column| column.class == Class::Torque);
        let has = |link: &usize| design.is_some_and(|design| names(&chain.links[*link].record).contains(&design));
        let source = match chain.ports(last).filter_map(|port| chain.read_by(last, port)).find(has).zip(design) {
            Some((link, design)) => {
                DesignSource::Record { link, template: template(&chain.links[link].record, columns, link, design) }
            }
            None => DesignSource::Tables,
        };
        let deviates = DEVIATIONS.iter().any(|(field, _)| record.entry(field).is_some());
        Some(Self { numbers, torque, fixed_torque: torques[0], source, deviates, last })
    }

    /// The link whose record has the designs: it need not be run.
    pub fn skips(&self) -> Option<usize> {
        if let DesignSource::Record { link, .. } = self.source { Some(link) } else { None }
    }

    /// What a row's pair and compliances come to.
    ///
    /// # Errors
    /// When the pair cannot be loaded, or the designs cannot be read.
    pub fn upstream<'q>(
        &'q self,
        chain: &Chain,
        tables: &Tables,
        outer: &Inputs,
        design: Option<&str>,
    ) -> Result<Upstream<'q>, Trouble> {
        let link = &chain.links[self.last];
        let of = |failure| Trouble::of(link.kind.name, failure);
        let inputs = chain.inputs(self.last, tables, outer);
        let (pair, base) = common::mesh_cycle(&inputs, sampling(&link.record)).map_err(of)?;
        let (name, design) = match &self.source {
            DesignSource::Record { link, .. } => {
                let name = design.or(names(&chain.links[*link].record).first().copied());
                (name.unwrap_or_default().to_owned(), None)
            }
            DesignSource::Tables => {
                let mut all: Vec<NamedDesign> = Vec::new();
                for port in inputs.ports.keys().filter(|port| port.starts_with(DESIGNS)) {
                    all.extend(designs::of(&inputs, port, modification::members()).map_err(Trouble::Failed)?);
                }
                let names: Vec<&str> = all.iter().map(|named| named.name.as_str()).collect();
                let meant: Vec<_> =
                    all.iter().filter(|named| design.is_none_or(|design| named.name == design)).collect();
                let [only] = meant[..] else {
                    let message = match design {
                        Some(design) => format!("there is no design `{design}`; {}", suggest(design, names)),
                        None => {
                            format!("a row has one design; say with `design` which one is meant: {}", names.join(", "))
                        }
                    };
                    return Err(Trouble::Failed(Failure::new(message)));
                };
                (only.name.clone(), Some(only.built(&pair).map_err(of)?))
            }
        };
        let fitted = match &self.source {
            DesignSource::Record { template: Some((template, _)), .. } => Some(template.on(&pair)),
            _ => None,
        };
        Ok(Upstream { pair, base, name, design, fitted })
    }

    /// The asked numbers of rows that differ in their torque alone, as their columns show them, or why there are none.
    pub fn rows<'r>(
        &self,
        (chain, columns): (&Chain, &[Column]),
        upstream: &Upstream,
        before: &mut Before,
        rows: impl Iterator<Item = &'r [f64]>,
        found: &mut Vec<Result<Vec<f64>, String>>,
    ) {
        let mut rows = rows.peekable();
        let Some(first) = rows.peek() else { return };
        let (sampled, design) = match self.ready((chain, columns), upstream, before, first) {
            Ok(ready) => ready,
            Err(message) => return found.extend(rows.map(|_| Err(message.clone()))),
        };
        let mut meshed = sampled.cycle.design(design);
        for row in rows {
            let torque = self.torque.map_or(self.fixed_torque, |column| row[column]);
            let loading = meshed.under(torque);
            let again = |settings: Settings| sampled.cycle.sampled(settings).loaded(design, torque).peak_to_peak();
            let numbers = self.numbers.of(&loading, (sampled.settings, sampled.harmonics), again);
            found.push(numbers.map_err(|message| format!("{}: {message}", chain.links[self.last].kind.name)));
        }
    }

    /// What a row's curve leaves out by `corner_contact: none`, and what a curve with corner contact makes of it; nothing where
    /// that is little.
    pub fn neglected_corners(
        &self,
        (chain, columns): (&Chain, &[Column]),
        (tables, outer): (&Tables, &Inputs),
        upstream: &Upstream,
        row: &[f64],
    ) -> Option<Warning> {
        let mut before = Before::default();
        let (sampled, design) = self.ready((chain, columns), upstream, &mut before, row).ok()?;
        let torque = self.torque.map_or(self.fixed_torque, |column| row[column]);
        let written = |(column, value): (&Column, &f64)| {
            let Axis { name, unit, .. } = &column.axis;
            let space = if unit.is_empty() { "" } else { " " };
            format!("{name} {}{space}{unit}", significant(in_unit(*value, unit), 6))
        };
        let varied = columns.iter().zip(row).filter(|(column, _)| column.class != Class::Torque);
        let values = varied.map(written).collect::<Vec<_>>().join(", ");
        // Rows that differ in their torque alone have one design.
        let name = if values.is_empty() { upstream.name.clone() } else { values };
        let loading = sampled.cycle.loaded(design, torque);
        let without = WithoutCorners::of(&name, torque, &loading).filter(WithoutCorners::may_matter)?;
        let cycle = neglected_corners::cycle(&chain.inputs(self.last, tables, outer), sampled.settings)?;
        without.compared(&cycle.loaded(design, torque), REMEDY)
    }

    /// The cycle and the design of a row, found or as the row before had them.
    fn ready<'b>(
        &self,
        (chain, columns): (&Chain, &[Column]),
        upstream: &'b Upstream,
        before: &'b mut Before,
        row: &[f64],
    ) -> Result<(&'b CycleOfRow, &'b Design), String> {
        let bits = |class: Class| -> Vec<u64> {
            let own = columns.iter().zip(row).filter(|(column, _)| column.class == class);
            own.map(|(_, value)| value.to_bits()).collect()
        };
        let key = bits(Class::Sampling);
        if before.sampled.as_ref().is_none_or(|(old, ..)| *old != key) {
            let record = chain.record(self.last, columns, row);
            let settings = sampling(&record);
            let Value::Integer(harmonics) =
                record.entry(HARMONICS).map_or(Value::Integer(0), |entry| entry.value.clone())
            else {
                return Err("the number of harmonics is not known".to_owned());
            };
            common::check_slices(settings, &record).map_err(|wrong| wrong.message)?;
            let (cycle, harmonics) = (upstream.base.sampled(settings), usize::try_from(harmonics).unwrap_or(0));
            before.sampled = Some((key, CycleOfRow { settings, harmonics, cycle }));
        }
        if let DesignSource::Record { link, template } = &self.source {
            let key = bits(Class::Design);
            if before.design.as_ref().is_none_or(|(old, _)| *old != key) {
                let built = match (template, &upstream.fitted) {
                    (Some((_, variables)), Some(fitted)) => {
                        let values: Vec<f64> = variables.iter().map(|column| row[*column]).collect();
                        fitted.design(&values).map_err(|wrong| wrong.message)
                    }
                    _ => by_record(&chain.record(*link, columns, row), &upstream.pair),
                };
                let built = built.map_err(|message| format!("{}: {message}", chain.links[*link].kind.name));
                before.design = Some((key, built));
            }
        }
        let drawn = match (&upstream.design, &before.design) {
            (Some(design), _) | (None, Some((_, Ok(design)))) => design,
            (None, Some((_, Err(message)))) => return Err(message.clone()),
            (None, None) => return Err("there is no design".to_owned()),
        };
        if self.deviates {
            let key = [bits(Class::Design), bits(Class::Deviation)].concat();
            if before.off.as_ref().is_none_or(|(old, _)| *old != key) {
                let record = chain.record(self.last, columns, row);
                let off = match &Deviations::read(&record).combinations()[..] {
                    [one] => one.on(drawn, &upstream.pair).map_err(|wrong| wrong.message),
                    _ => Err("a row has one value of each field".to_owned()),
                };
                before.off = Some((key, off));
            }
        }
        let Some((_, sampled)) = &before.sampled else { return Err(String::new()) };
        match &before.off {
            Some((_, Ok(design))) => Ok((sampled, design)),
            Some((_, Err(message))) => Err(message.clone()),
            None => Ok((sampled, drawn)),
        }
    }
}

/// How the record of the asked stage has its curves sampled, where it has curves.
pub fn sampling(record: &Record) -> Settings {
    let positions = match record.entry(POSITIONS).map(|entry| &entry.value) {
        Some(Value::Integer(positions)) => usize::try_from(*positions).unwrap_or(0),
        _ => Settings::default().positions,
    };
    common::settings(positions, Slices::read(record), Contact::read(record))
}

fn is_deviation(field: &str) -> bool {
    field == Deviations::NAMES.bearing_span || DEVIATIONS.iter().any(|(name, _)| *name == field)
}

/// Whether a record has designs by name.
fn has_designs(record: &Record) -> bool {
    record.entry(DESIGNS).is_some_and(|entry| matches!(entry.value, Value::Map(_)))
}

/// Whether a column varies a field of the stage `link` itself.
pub fn is_at(column: &Column, link: usize, record: &Record, field: &str) -> bool {
    let position = record.fields.iter().position(|(name, _)| *name == field);
    column.axis.stage == link && column.axis.slot.0.first().copied() == position
}

/// How long it takes to go on to another value of a field of a stage; `is_last` of the asked one.
pub fn class(record: &Record, is_last: bool, slot: &[usize]) -> Class {
    let field = slot.first().and_then(|first| record.fields.get(*first)).map(|(name, _)| *name);
    match field {
        Some(DESIGNS) if !is_last && has_designs(record) => Class::Design,
        Some(TORQUE) if is_last && record.entry(DESIGNS).is_some() => Class::Torque,
        Some(field) if is_last && record.entry(DESIGNS).is_some() && is_deviation(field) => Class::Deviation,
        _ if is_last => Class::Sampling,
        _ => Class::Upstream,
    }
}

/// The names of the designs that a record has.
pub fn names(record: &Record) -> Vec<&str> {
    match record.entry(DESIGNS).map(|entry| &entry.value) {
        Some(Value::Map(entries)) => entries.iter().map(|(name, _)| name.as_str()).collect(),
        _ => Vec::new(),
    }
}

/// A field of the asked stage of which it has several values and none is varied, where it loads a pair.
pub fn several(record: &Record, is_varied: impl Fn(&str) -> bool) -> Option<(&'static str, &PlacedValue)> {
    record.entry(DESIGNS)?;
    let fields = std::iter::once(TORQUE).chain(DEVIATIONS.map(|(field, _)| field));
    fields
        .filter_map(|field| Some((field, record.entry(field)?)))
        .find(|(field, entry)| matches!(&entry.value, Value::Axis(values) if values.len() > 1) && !is_varied(field))
}

fn elements<'r>(record: &'r Record, design: &str) -> Option<&'r [PlacedValue]> {
    let Value::Map(entries) = &record.entry(DESIGNS)?.value else { return None };
    let (_, entry) = entries.iter().find(|(name, _)| name == design)?;
    if let Value::List(items) = &entry.value { Some(items) } else { None }
}

/// The design as a template, and the columns of its variables; none where something other than a number of a modification
/// is varied, which no template has.
fn template(record: &Record, columns: &[Column], link: usize, design: &str) -> Option<(Template, Vec<usize>)> {
    let mut items = elements(record, design)?.to_vec();
    let mut slots = Vec::new();
    for (index, column) in columns.iter().enumerate().filter(|(_, column)| column.axis.stage == link) {
        let [_, _, item, field] = column.axis.slot.0[..] else { return None };
        let Value::Member(_, record) = &mut items.get_mut(item)?.value else { return None };
        let entry = &mut record.fields.get_mut(field)?.1;
        let (Value::Quantity(value) | Value::Number(value)) = entry.value else { return None };
        // Which of the two does not matter: a value stands there before anybody looks.
        entry.value = Value::Range(value, value);
        slots.push(((item, field), index));
    }
    slots.sort_unstable();
    let template = Template::new(&items).ok()?;
    let fits = template.variables().len() == slots.len();
    fits.then(|| (template, slots.into_iter().map(|(_, index)| index).collect()))
}

/// The only design of a record.
fn by_record(record: &Record, pair: &GearPair) -> Result<Design, String> {
    let name = names(record).first().map_or_else(String::new, |name| (*name).to_owned());
    let of = |item: &PlacedValue| match &item.value {
        Value::Member(family, record) => Some(Element { family, record: record.clone() }),
        _ => None,
    };
    let elements = elements(record, &name).unwrap_or_default().iter().filter_map(of).collect();
    NamedDesign { name, elements }.built(pair).map_err(|failure| failure.to_string())
}

/// Adds the work that the load cases of a pair did.
pub fn count(context: &Context, upstream: &Upstream) {
    context.work.add(&upstream.base.work());
}
