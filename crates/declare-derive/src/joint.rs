//! Enums whose variants have fields of their own, which stand beside those of the struct that has the enum.
//!
//! Must not know: who reads them.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Attribute, Data, DataEnum, DeriveInput, Error, Fields, Ident, LitStr};

use crate::doc::sentence;
use crate::fields::{Declaration, declaration};
use crate::marks::Marks;
use crate::words::name_of;

/// Each variant holds one value and is a field of its own; exactly one of them is given.
pub fn alternatives(input: &DeriveInput) -> Result<TokenStream, Error> {
    let name = &input.ident;
    let (mut tables, mut reads, mut writes, mut proofs) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut idents, mut texts, mut checks) = (Vec::new(), Vec::new(), Vec::new());
    for variant in &variants(input)?.variants {
        let ident = &variant.ident;
        let mut held = match &variant.fields {
            Fields::Unnamed(held) if held.unnamed.len() == 1 => held.unnamed[0].clone(),
            _ => return Err(Error::new(ident.span(), "an alternative holds one value")),
        };
        let (marks, text) = marks(&variant.attrs, ident)?;
        // The doc comment of the variant is that of the field.
        held.attrs.clone_from(&variant.attrs);
        let Declaration { declared, read, write, check, proof, .. } = declaration(&held, &marks, ident)?;
        tables.push(quote!(#declared.optional()));
        reads.push(quote!(if record.entry(#text).is_some() { return Self::#ident(#read); }));
        writes.push(quote!(Self::#ident(value) => { #write }));
        checks.push(check);
        proofs.push(proof);
        idents.push(ident);
        texts.push(text);
    }
    let joint = joint(
        name,
        &tables,
        &quote!(
            ::declare::declared::exactly_one(record, &[#(#texts),*])?;
            #(#checks)*
            ::core::result::Result::Ok(())
        ),
        &quote!(#(#reads)* ::declare::declared::of_another_declaration()),
        &quote!(match self { #(#writes)* }),
    );
    Ok(quote! {
        #(#proofs)*
        #joint

        impl #name {
            /// The name of the field that says it, for messages about it.
            #[must_use]
            pub const fn field(&self) -> &'static str {
                match self { #(Self::#idents(_) => #texts),* }
            }
        }
    })
}

/// The variant is a word, and its fields go with that word only.
pub fn tagged(input: &DeriveInput) -> Result<TokenStream, Error> {
    let name = &input.ident;
    let (marks, tag) = marks(&input.attrs, name)?;
    let summary = sentence(&input.attrs, name)?;
    let (mut choices, mut tables, mut proofs, mut checks) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut reads, mut writes) = (Vec::new(), Vec::new());
    for variant in &variants(input)?.variants {
        let (ident, word) = (&variant.ident, name_of(&variant.attrs, &variant.ident)?);
        let summary = sentence(&variant.attrs, ident)?;
        choices.push(quote!(::declare::parameter::Choice { name: #word, summary: #summary }));
        let (mut read_fields, mut bound, mut write_fields) = (Vec::new(), Vec::new(), Vec::new());
        match &variant.fields {
            Fields::Unit => {}
            Fields::Named(fields) => {
                for field in &fields.named {
                    let Some(own) = &field.ident else { continue };
                    let (marks, text) = self::marks(&field.attrs, own)?;
                    let Declaration { declared, read, write, check, proof, .. } = declaration(field, &marks, own)?;
                    tables.push(quote!(#declared.optional()));
                    proofs.push(proof);
                    checks.push(quote!(::declare::declared::goes_with(record, #text, [#tag, #word])?; #check));
                    read_fields.push(quote!(#own: #read));
                    write_fields.push(quote!({ let value = #own; #write }));
                    bound.push(own);
                }
            }
            Fields::Unnamed(_) => return Err(Error::new(ident.span(), "the fields of a word have names")),
        }
        reads.push(quote!(#word => Self::#ident { #(#read_fields),* }));
        writes.push(quote!(Self::#ident { #(#bound),* } => {
            fields.push((#tag, ::declare::declared::entry(::declare::record::Value::Choice(#word))));
            #(#write_fields)*
        }));
    }
    let mut field = quote!(::declare::parameter::Field::choice(#tag, &[#(#choices),*], #summary));
    if let Some(text) = &marks.default {
        field = quote!(#field.default(#text));
    }
    tables.insert(0, field);
    let joint = joint(
        name,
        &tables,
        &quote!(#(#checks)* ::core::result::Result::Ok(())),
        &quote!(match record.choice(#tag) { #(#reads,)* _ => ::declare::declared::of_another_declaration() }),
        &quote!(match self { #(#writes)* }),
    );
    Ok(quote!(#(#proofs)* #joint))
}

fn variants(input: &DeriveInput) -> Result<&DataEnum, Error> {
    if let Data::Enum(data) = &input.data { Ok(data) } else { Err(Error::new(input.ident.span(), "it is an enum")) }
}

/// The marks and the name as a study writes it, which is among them.
fn marks(attributes: &[Attribute], ident: &Ident) -> Result<(Marks, String), Error> {
    let (mut marks, text) = (Marks::of(attributes)?, name_of(attributes, ident)?);
    marks.name = Some(LitStr::new(&text, ident.span()));
    Ok((marks, text))
}

fn joint(
    name: &Ident,
    tables: &[TokenStream],
    consistent: &TokenStream,
    read: &TokenStream,
    write: &TokenStream,
) -> TokenStream {
    quote! {
        impl ::declare::declared::Joint for #name {
            const FIELDS: &'static [::declare::parameter::Field] = &[#(#tables),*];

            fn consistent(
                record: &::declare::record::Record,
            ) -> ::core::result::Result<(), ::declare::error::Diagnostic> {
                #consistent
            }

            fn read(record: &::declare::record::Record) -> Self {
                #read
            }

            fn write(&self, fields: &mut ::std::vec::Vec<(&'static str, ::declare::record::PlacedValue)>) {
                #write
            }
        }
    }
}
