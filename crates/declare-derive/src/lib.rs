//! A struct is the declaration of its parameters, an enum that of its words: derives for `declare`.
//!
//! Names, ranges and defaults stand on the fields, the sentences for users are the doc comments, so a renamed field is an
//! error of the compiler and nothing is written twice. What the derives generate is in `declare::declared`, which has the
//! traits. Must not know: what any parameter means.

mod doc;
mod fields;
mod joint;
mod marks;
mod types;
mod words;

use proc_macro::TokenStream;
use syn::{DeriveInput, Error, parse_macro_input};

/// Implements `declare::Declared` for a struct with named fields.
///
/// On the struct: `#[declared(name = "genetic")]` where it is a member of a family. On a field: `minimum`, `maximum`
/// (numbers, in SI), `multiple` (of integers), `dimension` (of `declare::units`, for quantities), `default` (as in a
/// study), `range` (an optimiser may choose), `chooses` (an optimiser may choose below it), `axis = N` (of a
/// `Vec<f64>`), `kinds = ["geometry"]` (a `String` that names a stage of one of these), `overrides = Its::NAMES.of` (a
/// `Variant` of the stage that the field `of` names), `name` (as a study writes it), `flatten` (what is `Joint`). The
/// type says the rest: `f64`, integers, `bool`, `String`, words, structs that are declared themselves, and whatever
/// else is a `Parameter`, such as `Box<dyn Method>` of a registry; `Vec` of these, `Vec<(String, T)>` where the user
/// gives them names, `Placed` of these where a message points there, and `Option` of all. Where every field has a
/// default, `Default` is implemented too.
#[proc_macro_derive(Declared, attributes(declared))]
pub fn declared(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    fields::expand(&input).unwrap_or_else(Error::into_compile_error).into()
}

/// Implements `declare::Words` for an enum without fields: each variant is a word, in small letters with `_`, or as its
/// mark `name` says.
#[proc_macro_derive(Words, attributes(declared))]
pub fn words(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    words::expand(&input).unwrap_or_else(Error::into_compile_error).into()
}

/// Implements `declare::Joint` for an enum whose variants hold one value each: each is a field, with marks as those of a
/// struct, and exactly one of them is given.
#[proc_macro_derive(Alternatives, attributes(declared))]
pub fn alternatives(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    joint::alternatives(&input).unwrap_or_else(Error::into_compile_error).into()
}

/// Implements `declare::Joint` for an enum that is a word, the field that is called as the enum or as its mark `name` says,
/// with fields that go with one of the words only.
#[proc_macro_derive(Tagged, attributes(declared))]
pub fn tagged(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    joint::tagged(&input).unwrap_or_else(Error::into_compile_error).into()
}
