//! The program that runs studies, handed in by itself: its kinds of stages, and what it knows of itself.
//!
//! Must not know: which kinds there are.

use crate::about::About;
use crate::stage::Kind;
use declare::units::{Dimension, Quantity};
use declare::work::Counter;

/// A word that users of other programs and other textbooks know for a field of this one.
#[derive(Clone, Copy)]
pub struct Foreign {
    pub word: &'static str,
    /// The field that is meant, where there is one.
    pub field: Option<&'static str>,
    /// The mappings in which it means this; empty where it means this anywhere.
    pub inside: &'static [&'static str],
    /// What else is to be said: that a radius is half of the diameter, or why there is no such thing.
    pub remark: &'static str,
    /// Whether the field has another quantity, to which the remark says the way.
    pub is_other: bool,
    /// What to write in the field, where the numbers of the study tell.
    pub remedy: Option<fn(&Around) -> Option<String>>,
}

/// A field that follows from a quantity of another kind, which users state in its place.
#[derive(Clone, Copy)]
pub struct Derived {
    pub field: &'static str,
    pub from: Dimension,
    /// The formula and the meaning of its symbols.
    pub rule: &'static str,
    /// The value of the field, if the study has the numbers of the formula.
    pub remedy: Option<fn(&Around) -> Option<String>>,
}

/// Numbers of a study around a word that is no field.
#[derive(Clone, Copy)]
pub struct Around<'a> {
    /// The number of the word itself; the middle of an interval.
    pub value: Option<Quantity>,
    /// Half the width of that interval, in SI; 0 of a single number.
    pub half: f64,
    /// The number of a name beside it; none of an interval.
    pub beside: &'a dyn Fn(&str) -> Option<Quantity>,
    /// The number at the end of these names in any stage; none where stages differ, or of an interval.
    pub anywhere: &'a dyn Fn(&[&str]) -> Option<Quantity>,
}

/// A field of a kind of stage that names what is in tables: for editors, to which a text is a text otherwise.
#[derive(Clone, Copy)]
pub struct Naming {
    pub kind: &'static str,
    pub field: &'static str,
    pub names: Names,
}

/// What a text of a field names.
#[derive(Clone, Copy)]
pub enum Names {
    /// Numbers, `stage.table[column=value, …].column`.
    Cells,
    /// The same without the stage, which is the one in the field of this name beside it. `column` by itself is one of `table`,
    /// where there is one that can be left out.
    CellsOf { stage: &'static str, table: Option<&'static str> },
    /// The same of what a stage of this kind would give.
    CellsOfKind { kind: &'static str, table: Option<&'static str> },
    /// `stage.table`.
    Table,
    /// A column of the table in the field of this name beside it; a map names columns, and values of them.
    Columns { table: &'static str },
}

/// A program that runs studies.
pub struct Program {
    /// Every kind of stage, in the order in which they are listed to the user.
    pub kinds: &'static [&'static Kind],
    /// What others call its fields.
    pub foreign: &'static [&'static [Foreign]],
    /// Rules from quantities of other kinds to its fields.
    pub derived: &'static [Derived],
    pub named: &'static [Naming],
    /// The digest of the code that the tables of a kind, called by its name, come from; part of every cache key.
    pub code_of: fn(&str) -> String,
    /// What its stages count of their work.
    pub counters: &'static [&'static Counter],
    pub about: About,
    pub pictures: Pictures,
}

/// What a study has for people to look at that says nothing of it: tables on demand are computed then all the same.
#[derive(Clone, Copy)]
pub struct Pictures {
    /// The kind of stage by which a study says itself what is shown; with one of them nothing is added.
    pub reader: &'static str,
    /// Kinds of stages, and the tables of a picture of each: the first one that the stage has.
    pub tables: &'static [(&'static str, &'static [&'static str])],
}

impl Pictures {
    pub const NONE: Self = Self { reader: "", tables: &[] };
}

impl Program {
    /// The kind called `name`.
    #[must_use]
    pub fn kind(&self, name: &str) -> Option<&'static Kind> {
        self.kinds.iter().copied().find(|kind| kind.name == name)
    }
}
