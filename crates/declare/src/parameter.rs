//! Declared parameters: what a stage kind, a modification family, a stiffness method or an optimiser can be told.
//!
//! One declaration serves the reader of the YAML, its messages, the JSON schema, `gearstudy kinds`, the canonical
//! digest and the conformance tests, so a new member is one file with one struct that declares itself. Must not know:
//! YAML, and what any parameter means. Ranges are inclusive and in SI.

use super::units::Dimension;

/// What a field may hold.
#[derive(Clone, Copy)]
pub enum Shape {
    /// A number with a unit, inside `minimum..=maximum` (SI).
    Quantity {
        dimension: Dimension,
        minimum: f64,
        maximum: f64,
    },
    /// A number with any unit, or none: a published value.
    AnyQuantity,
    /// A plain number.
    Number {
        minimum: f64,
        maximum: f64,
    },
    Integer {
        minimum: i64,
        maximum: i64,
        /// Only multiples of this, 1 for all: two numbers that mean the same would be two keys of one result.
        multiple: i64,
    },
    Flag,
    Text,
    /// The name of a CSV file beside the study, whose columns and first lines stand for other fields of the same mapping.
    File,
    /// One of a few words.
    Choice(&'static [Choice]),
    /// The name of a stage of one of these kinds.
    Reference(&'static [&'static str]),
    /// A list; a single item stands for a list of one.
    List(&'static Shape),
    /// A list of lists' worth of named items: names chosen by the user, in the order of the study.
    Map(&'static Shape),
    /// Fields by name.
    Group(&'static [Field]),
    /// Exactly one member of a family: `name`, or `name: { fields }`.
    Member(fn() -> &'static [Member]),
    /// Fields of the stage that the [`Shape::Reference`] field of this name names, declared before this one. They stand
    /// in the place of that stage's own, each as a whole; the value is the record of all of that stage's fields.
    Overrides(&'static str),
    /// Names of columns, each with a field of the stage that the [`Shape::Reference`] field of this name names, or of any
    /// that it reads, and the values of that field.
    Varied(&'static str),
}

/// A word that a field may hold, and what it means.
#[derive(Clone, Copy)]
pub struct Choice {
    pub name: &'static str,
    pub summary: &'static str,
}

/// One member of a family as a user sees it.
#[derive(Clone, Copy)]
pub struct Member {
    pub name: &'static str,
    pub summary: &'static str,
    pub fields: &'static [Field],
}

/// Whether a field must be given, and what stands when it is not (written as in a study).
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    Required,
    Optional,
    Default(&'static str),
}

/// How many values a quantity may be given.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Span {
    /// One.
    Single,
    /// One, a list, or `{ from, to, count }`: an axis of the stage's tables. The stage is run in chunks of about this many,
    /// or of more where there would be too many chunks.
    Axis { chunk: usize },
    /// One, or, where an optimiser chooses, `[least, most]`.
    Range,
}

/// One declared parameter.
#[derive(Clone, Copy)]
pub struct Field {
    pub name: &'static str,
    pub shape: Shape,
    pub presence: Presence,
    pub span: Span,
    /// Whether an optimiser chooses below this field: quantities with [`Span::Range`] may be `[least, most]` there.
    pub chooses: bool,
    /// Where what is stated here is set against cells of other stages: the kinds of those that are computed anew inside the
    /// intervals of their inputs. The record then has these as a [`Varied`](crate::record::varied::Varied) under
    /// [`INTERVALS`](crate::record::varied::INTERVALS). None: it asks for none.
    pub intervals: &'static [&'static str],
    /// One sentence with the symbol and the unit.
    pub summary: &'static str,
    /// What a study might say, of the size that is usual; where there is a default, that is one.
    pub example: Option<&'static str>,
    /// Of a plain number that counts in a quantity of the study: the field that has it, such as the module.
    pub counts_in: Option<&'static str>,
    /// What a negative value would mean where none is taken: the remedy; empty where there is none.
    pub negative: &'static str,
}

/// How many fields are in several tables together.
#[must_use]
pub const fn count(tables: &[&[Field]]) -> usize {
    let (mut table, mut fields) = (0, 0);
    while table < tables.len() {
        fields += tables[table].len();
        table += 1;
    }
    fields
}

/// Several tables of fields as one, for fields that several kinds have in common; `N` is their [`count`].
#[must_use]
pub const fn joined<const N: usize>(tables: &[&[Field]]) -> [Field; N] {
    let mut all = [Field::new("", Shape::Flag, ""); N];
    let (mut table, mut at) = (0, 0);
    while table < tables.len() {
        let mut field = 0;
        while field < tables[table].len() {
            all[at] = tables[table][field];
            at += 1;
            field += 1;
        }
        table += 1;
    }
    assert!(at == N, "as many fields as are counted");
    all
}

/// The field of what may have its lists from a CSV file: whoever reads a study puts what the file says in its place, so no record
/// holds it.
pub const FILE: Field = Field::new(
    "file",
    Shape::File,
    "CSV file beside the study whose columns and `# name: value` lines stand for other fields.",
)
.optional();

impl Field {
    #[must_use]
    pub const fn new(name: &'static str, shape: Shape, summary: &'static str) -> Self {
        Self {
            name,
            shape,
            presence: Presence::Required,
            span: Span::Single,
            chooses: false,
            intervals: &[],
            summary,
            example: None,
            counts_in: None,
            negative: "",
        }
    }

    /// A quantity inside `minimum..=maximum` (SI).
    #[must_use]
    pub const fn quantity(
        name: &'static str,
        dimension: Dimension,
        minimum: f64,
        maximum: f64,
        summary: &'static str,
    ) -> Self {
        Self::new(name, Shape::Quantity { dimension, minimum, maximum }, summary)
    }

    #[must_use]
    pub const fn number(name: &'static str, minimum: f64, maximum: f64, summary: &'static str) -> Self {
        Self::new(name, Shape::Number { minimum, maximum }, summary)
    }

    #[must_use]
    pub const fn integer(name: &'static str, minimum: i64, maximum: i64, summary: &'static str) -> Self {
        Self::new(name, Shape::Integer { minimum, maximum, multiple: 1 }, summary)
    }

    /// An integer of which only the multiples of `of` are taken; both its bounds are among them.
    #[must_use]
    pub const fn multiple_of(mut self, of: i64) -> Self {
        let Shape::Integer { minimum, maximum, .. } = self.shape else { panic!("only an integer has multiples") };
        assert!(minimum % of == 0 && maximum % of == 0, "the bounds are multiples");
        self.shape = Shape::Integer { minimum, maximum, multiple: of };
        self
    }

    #[must_use]
    pub const fn choice(name: &'static str, choices: &'static [Choice], summary: &'static str) -> Self {
        Self::new(name, Shape::Choice(choices), summary)
    }

    #[must_use]
    pub const fn reference(name: &'static str, kinds: &'static [&'static str], summary: &'static str) -> Self {
        Self::new(name, Shape::Reference(kinds), summary)
    }

    #[must_use]
    pub const fn group(name: &'static str, fields: &'static [Field], summary: &'static str) -> Self {
        Self::new(name, Shape::Group(fields), summary)
    }

    #[must_use]
    pub const fn optional(mut self) -> Self {
        self.presence = Presence::Optional;
        self
    }

    /// `text` is read as if it stood in the study.
    #[must_use]
    pub const fn default(mut self, text: &'static str) -> Self {
        self.presence = Presence::Default(text);
        self
    }

    /// What a study might say, written as in one.
    #[must_use]
    pub const fn example(mut self, text: &'static str) -> Self {
        self.example = Some(text);
        self
    }

    /// The number counts in the quantity of this field.
    #[must_use]
    pub const fn counts_in(mut self, field: &'static str) -> Self {
        self.counts_in = Some(field);
        self
    }

    /// The remedy for a negative value.
    #[must_use]
    pub const fn negative(mut self, remedy: &'static str) -> Self {
        self.negative = remedy;
        self
    }

    #[must_use]
    pub const fn axis(mut self, chunk: usize) -> Self {
        self.span = Span::Axis { chunk };
        self
    }

    /// Below this field an optimiser chooses.
    #[must_use]
    pub const fn chooses(mut self) -> Self {
        self.chooses = true;
        self
    }

    /// What is stated here is set against cells of stages; those of these kinds are computed anew inside the intervals of
    /// their inputs.
    #[must_use]
    pub const fn intervals(mut self, kinds: &'static [&'static str]) -> Self {
        self.intervals = kinds;
        self
    }

    #[must_use]
    pub const fn range(mut self) -> Self {
        self.span = Span::Range;
        self
    }
}
