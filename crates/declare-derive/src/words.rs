//! Enums whose variants are words.
//!
//! Must not know: where a word may be written.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Attribute, Data, DeriveInput, Error, Fields, Ident};

use crate::doc::sentence;
use crate::marks::Marks;

pub fn expand(input: &DeriveInput) -> Result<TokenStream, Error> {
    let name = &input.ident;
    let Data::Enum(data) = &input.data else { return Err(Error::new(name.span(), "words are an enum")) };
    let mut choices = Vec::new();
    let mut of = Vec::new();
    let mut word = Vec::new();
    for (at, variant) in data.variants.iter().enumerate() {
        if !matches!(variant.fields, Fields::Unit) {
            return Err(Error::new(variant.ident.span(), "a word has no fields"));
        }
        let (ident, text) = (&variant.ident, name_of(&variant.attrs, &variant.ident)?);
        let summary = sentence(&variant.attrs, ident)?;
        choices.push(quote!(::declare::parameter::Choice { name: #text, summary: #summary }));
        of.push(quote!(#text => ::core::option::Option::Some(Self::#ident)));
        word.push(quote!(Self::#ident => Self::CHOICES[#at].name));
    }
    Ok(quote! {
        impl ::declare::declared::Words for #name {
            const CHOICES: &'static [::declare::parameter::Choice] = &[#(#choices),*];

            fn of(word: &str) -> ::core::option::Option<Self> {
                match word {
                    #(#of,)*
                    _ => ::core::option::Option::None,
                }
            }

            fn word(self) -> &'static str {
                match self {
                    #(#word,)*
                }
            }
        }

        impl ::declare::declared::Parameter for #name {
            const SHAPE: ::declare::parameter::Shape =
                ::declare::parameter::Shape::Choice(<Self as ::declare::declared::Words>::CHOICES);

            fn of_value(value: &::declare::record::Value) -> Self {
                ::declare::declared::word(value)
            }

            fn to_value(&self) -> ::declare::record::Value {
                ::declare::record::Value::Choice(::declare::declared::Words::word(*self))
            }
        }
    })
}

/// What is called `ident` in the code, as a study writes it: in small letters with `_`, or as its mark `name` says.
pub fn name_of(attributes: &[Attribute], ident: &Ident) -> Result<String, Error> {
    Ok(Marks::of(attributes)?.name.map_or_else(|| snake(&ident.to_string()), |name| name.value()))
}

/// `CurrentToBest` as a study writes it: `current_to_best`.
fn snake(name: &str) -> String {
    let mut text = String::new();
    for (at, character) in name.char_indices() {
        if character.is_uppercase() && at > 0 {
            text.push('_');
        }
        text.extend(character.to_lowercase());
    }
    text
}
