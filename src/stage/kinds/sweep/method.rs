//! Which combinations of values a sweep takes.
//!
//! Must not know: what is varied.

use declare::Declared;
use declare::declared::{Declared, Parameter};
use declare::parameter::{Member, Shape};
use declare::record::Value;

/// Which combinations are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    Grid,
    Zip,
    LatinHypercube(Samples),
    Sobol(Samples),
    Random(Samples),
}

/// How many designs are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Declared)]
pub struct Samples {
    /// Number of designs.
    #[declared(minimum = 1, maximum = 1_000_000_000, default = "1000")]
    pub samples: usize,
}

const MEMBERS: [Member; 5] = [
    Member { name: "grid", summary: "every combination of all values", fields: &[] },
    Member {
        name: "zip",
        summary: "the first values together, the second ones, and so on: a list of designs",
        fields: &[],
    },
    Member {
        name: "latin_hypercube",
        summary: "random designs, one in each of as many strata of every field",
        fields: Samples::MEMBER.fields,
    },
    Member {
        name: "sobol",
        summary: "evenly spread designs, best when their number is a power of two; more of them leave the first as they are",
        fields: Samples::MEMBER.fields,
    },
    Member {
        name: "random",
        summary: "independent random designs; more of them leave the first as they are",
        fields: Samples::MEMBER.fields,
    },
];

fn members() -> &'static [Member] {
    &MEMBERS
}

impl Method {
    /// As a study writes it.
    pub fn name(self) -> &'static str {
        let index = match self {
            Self::Grid => 0,
            Self::Zip => 1,
            Self::LatinHypercube(_) => 2,
            Self::Sobol(_) => 3,
            Self::Random(_) => 4,
        };
        MEMBERS[index].name
    }

    /// How many designs are drawn; none where values are combined.
    pub fn samples(self) -> Option<usize> {
        match self {
            Self::Grid | Self::Zip => None,
            Self::LatinHypercube(one) | Self::Sobol(one) | Self::Random(one) => Some(one.samples),
        }
    }
}

impl Parameter for Method {
    const SHAPE: Shape = Shape::Member(members);

    fn of_value(value: &Value) -> Self {
        let (name, record) = declare::declared::member(value);
        let samples = || Samples::read(record);
        match name {
            "zip" => Self::Zip,
            "latin_hypercube" => Self::LatinHypercube(samples()),
            "sobol" => Self::Sobol(samples()),
            "random" => Self::Random(samples()),
            _ => Self::Grid,
        }
    }

    fn to_value(&self) -> Value {
        let record = self.samples().map(|samples| Samples { samples }.record());
        Value::Member(self.name(), record.unwrap_or_default())
    }
}
