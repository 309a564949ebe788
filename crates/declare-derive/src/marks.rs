//! The marks of a field: what its type does not say.
//!
//! Must not know: what they are marks of.

use syn::punctuated::Punctuated;
use syn::{Attribute, Error, Expr, Ident, LitStr, Token, bracketed};

/// What stands on a field.
#[derive(Default)]
pub struct Marks {
    minimum: Option<Expr>,
    maximum: Option<Expr>,
    pub dimension: Option<Expr>,
    pub default: Option<LitStr>,
    /// What a study might say.
    pub example: Option<LitStr>,
    /// The field in whose quantity a plain number counts.
    pub counts_in: Option<LitStr>,
    /// The remedy for a negative value.
    pub negative: Option<LitStr>,
    pub axis: Option<Expr>,
    pub multiple: Option<Expr>,
    /// Of which kinds the stage is that is named.
    pub kinds: Option<Punctuated<LitStr, Token![,]>>,
    /// Which kinds of stages are computed anew inside the intervals of their inputs.
    pub intervals: Option<Punctuated<LitStr, Token![,]>>,
    /// The field that names the stage whose fields are replaced.
    pub overrides: Option<Expr>,
    /// The field that names the stage of which fields are varied.
    pub varies: Option<Expr>,
    pub range: bool,
    pub chooses: bool,
    pub flatten: bool,
    /// As a study writes it, where that is not the name in the code.
    pub name: Option<LitStr>,
}

impl Marks {
    pub fn of(attributes: &[Attribute]) -> Result<Self, Error> {
        let mut marks = Self::default();
        for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("declared")) {
            attribute.parse_nested_meta(|meta| {
                let name = meta.path.get_ident().map(Ident::to_string).unwrap_or_default();
                match name.as_str() {
                    "minimum" => marks.minimum = Some(meta.value()?.parse()?),
                    "maximum" => marks.maximum = Some(meta.value()?.parse()?),
                    "dimension" => marks.dimension = Some(meta.value()?.parse()?),
                    "default" => marks.default = Some(meta.value()?.parse()?),
                    "example" => marks.example = Some(meta.value()?.parse()?),
                    "counts_in" => marks.counts_in = Some(meta.value()?.parse()?),
                    "negative" => marks.negative = Some(meta.value()?.parse()?),
                    "axis" => marks.axis = Some(meta.value()?.parse()?),
                    "multiple" => marks.multiple = Some(meta.value()?.parse()?),
                    "kinds" | "intervals" => {
                        let words;
                        let value = meta.value()?;
                        bracketed!(words in value);
                        let words = Some(Punctuated::parse_terminated(&words)?);
                        *(if name == "kinds" { &mut marks.kinds } else { &mut marks.intervals }) = words;
                    }
                    "overrides" => marks.overrides = Some(meta.value()?.parse()?),
                    "varies" => marks.varies = Some(meta.value()?.parse()?),
                    "name" => marks.name = Some(meta.value()?.parse()?),
                    "range" => marks.range = true,
                    "chooses" => marks.chooses = true,
                    "flatten" => marks.flatten = true,
                    _ => {
                        return Err(meta.error(
                            "it is `minimum`, `maximum`, `multiple`, `dimension`, `default`, `example`, `counts_in`, \
                             `negative`, `axis`, \
                             `range`, `chooses`, `kinds`, `intervals`, `overrides`, `varies`, `name` or `flatten`",
                        ));
                    }
                }
                Ok(())
            })?;
        }
        Ok(marks)
    }

    /// The range of a number.
    pub fn bounds(&self, owner: &Ident) -> Result<(&Expr, &Expr), Error> {
        match (&self.minimum, &self.maximum) {
            (Some(minimum), Some(maximum)) => Ok((minimum, maximum)),
            _ => Err(Error::new(owner.span(), "a number has a range: `minimum` and `maximum`")),
        }
    }
}
