//! Structs whose fields are parameters.
//!
//! Must not know: who reads them.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Data, DeriveInput, Error, Field, Fields, Ident, LitStr, Visibility};

use crate::doc::sentence;
use crate::marks::Marks;
use crate::types::{Kind, argument, kind};

pub fn expand(input: &DeriveInput) -> Result<TokenStream, Error> {
    let name = &input.ident;
    let Data::Struct(data) = &input.data else { return Err(Error::new(name.span(), "what is declared is a struct")) };
    let Fields::Named(fields) = &data.fields else { return Err(Error::new(name.span(), "its fields have names")) };
    let (member, summary) = (member(input)?, sentence(&input.attrs, name)?);
    let names = format_ident!("{name}Names");
    let visibility = &input.vis;
    let mut all_default = true;
    // Tables of fields, one after the other: those of a struct, or those that an enum has of its own.
    let (mut tables, mut read, mut written) = (Vec::new(), Vec::new(), Vec::new());
    let (mut proofs, mut checks) = (Vec::new(), Vec::new());
    let (mut idents, mut texts) = (Vec::new(), Vec::new());
    let mut defaults = Vec::new();
    for field in &fields.named {
        let Some(ident) = &field.ident else { continue };
        if !matches!(field.vis, Visibility::Public(_)) {
            return Err(Error::new(ident.span(), "a parameter is public: it can be given without a study"));
        }
        let marks = Marks::of(&field.attrs)?;
        if marks.flatten {
            let ty = &field.ty;
            tables.push(quote!(<#ty as ::declare::declared::Joint>::FIELDS));
            read.push(quote!(#ident: <#ty as ::declare::declared::Joint>::read(record)));
            written.push(quote!(::declare::declared::Joint::write(&self.#ident, &mut fields);));
            checks.push(quote!(<#ty as ::declare::declared::Joint>::consistent(record)?;));
            all_default = false;
            continue;
        }
        let Declaration { declared, read: from, write, check, proof, given } = declaration(field, &marks, ident)?;
        all_default &= !given;
        let text = marks.name.as_ref().map_or_else(|| ident.to_string(), LitStr::value);
        defaults.extend(marks.default.as_ref().map(|default| format!("`{ident}`: {}", default.value())));
        tables.push(quote!(&[#declared]));
        proofs.push(proof);
        checks.push(check);
        read.push(quote!(#ident: #from));
        written.push(quote!({ let value = &self.#ident; #write }));
        idents.push(ident);
        texts.push(text);
    }
    let defaults = format!("As a study has it that says nothing: {}.", defaults.join(", "));
    let default = all_default.then(|| {
        quote! {
            impl ::core::default::Default for #name {
                #[doc = #defaults]
                fn default() -> Self {
                    <Self as ::declare::declared::Declared>::read(&::declare::declared::record_of(
                        <Self as ::declare::declared::Declared>::MEMBER.fields,
                        &[],
                    ))
                }
            }
        }
    });
    let note = format!("The names of the fields of [`{name}`], as a study writes them.");
    Ok(quote! {
        #[doc = #note]
        #[allow(dead_code)]
        #visibility struct #names { #(#[doc(hidden)] pub #idents: &'static str),* }

        impl #name {
            /// The names of its fields, for messages about them.
            #[allow(dead_code)] // not every field has a message of its own
            #visibility const NAMES: #names = #names { #(#idents: #texts),* };
        }

        #(#proofs)*

        impl ::declare::declared::Declared for #name {
            const MEMBER: ::declare::parameter::Member = {
                const TABLES: &[&[::declare::parameter::Field]] = &[#(#tables),*];
                const FIELDS: [::declare::parameter::Field; ::declare::parameter::count(TABLES)] =
                    ::declare::parameter::joined(TABLES);
                ::declare::parameter::Member { name: #member, summary: #summary, fields: &FIELDS }
            };

            #[allow(unused_variables)] // where nothing depends on anything
            fn consistent(
                record: &::declare::record::Record,
            ) -> ::core::result::Result<(), ::declare::error::Diagnostic> {
                #(#checks)*
                ::core::result::Result::Ok(())
            }

            #[allow(unused_variables)] // where there are no fields
            fn read(record: &::declare::record::Record) -> Self {
                Self { #(#read),* }
            }

            fn record(&self) -> ::declare::record::Record {
                #[allow(unused_mut)]
                let mut fields = ::std::vec::Vec::new();
                #(#written)*
                ::declare::record::Record { fields, place: ::core::default::Default::default() }
            }
        }

        impl ::declare::declared::Joint for #name {
            const FIELDS: &'static [::declare::parameter::Field] =
                <Self as ::declare::declared::Declared>::MEMBER.fields;

            fn consistent(
                record: &::declare::record::Record,
            ) -> ::core::result::Result<(), ::declare::error::Diagnostic> {
                <Self as ::declare::declared::Declared>::consistent(record)
            }

            fn read(record: &::declare::record::Record) -> Self {
                <Self as ::declare::declared::Declared>::read(record)
            }

            fn write(&self, fields: &mut ::std::vec::Vec<(&'static str, ::declare::record::PlacedValue)>) {
                fields.extend(<Self as ::declare::declared::Declared>::record(self).fields);
            }
        }

        impl ::declare::declared::Parameter for #name {
            const SHAPE: ::declare::parameter::Shape =
                ::declare::parameter::Shape::Group(<Self as ::declare::declared::Declared>::MEMBER.fields);

            fn consistent(
                value: &::declare::record::Value,
            ) -> ::core::result::Result<(), ::declare::error::Diagnostic> {
                <Self as ::declare::declared::Declared>::consistent(::declare::declared::group(value))
            }

            fn of_value(value: &::declare::record::Value) -> Self {
                <Self as ::declare::declared::Declared>::read(::declare::declared::group(value))
            }

            fn to_value(&self) -> ::declare::record::Value {
                ::declare::record::Value::Group(::declare::declared::Declared::record(self))
            }
        }

        #default
    })
}

/// How one field is declared, read from a `record`, and written from a `value: &T` to `fields`.
pub struct Declaration {
    pub declared: TokenStream,
    pub read: TokenStream,
    pub write: TokenStream,
    /// Refuses, in a `record`, what does not go together inside.
    pub check: TokenStream,
    /// What must hold when it is compiled.
    pub proof: TokenStream,
    /// Whether it must be given.
    given: bool,
}

/// The declaration of a field called `ident`, or as its marks say.
pub fn declaration(field: &Field, marks: &Marks, ident: &Ident) -> Result<Declaration, Error> {
    let text = marks.name.as_ref().map_or_else(|| ident.to_string(), LitStr::value);
    let summary = sentence(&field.attrs, ident)?;
    let inner = argument(&field.ty, "Option");
    let Kind { shape, read, write, check, proof } = kind(inner.unwrap_or(&field.ty), marks, ident)?;
    let mut declared = quote!(::declare::parameter::Field::new(#text, #shape, #summary));
    match (&marks.default, inner) {
        (Some(text), None) => declared = quote!(#declared.default(#text)),
        (Some(text), Some(_)) => return Err(Error::new(text.span(), "an `Option` has no default")),
        (None, Some(_)) => declared = quote!(#declared.optional()),
        (None, None) => {}
    }
    if let Some(text) = &marks.example {
        declared = quote!(#declared.example(#text));
    }
    if let Some(field) = &marks.counts_in {
        declared = quote!(#declared.counts_in(#field));
    }
    if let Some(remedy) = &marks.negative {
        declared = quote!(#declared.negative(#remedy));
    }
    if marks.range {
        declared = quote!(#declared.range());
    }
    if marks.chooses {
        declared = quote!(#declared.chooses());
    }
    if let Some(kinds) = &marks.intervals {
        declared = quote!(#declared.intervals(&[#kinds]));
    }
    if let Some(chunk) = &marks.axis {
        declared = quote!(#declared.axis(#chunk));
    }
    let push = quote!(fields.push((#text, #write)););
    let (read, write) = if inner.is_some() {
        (
            quote!(record.entry(#text).map(|entry| #read)),
            quote!(if let ::core::option::Option::Some(value) = value { #push }),
        )
    } else {
        (quote!({ let entry = ::declare::declared::given(record, #text); #read }), push)
    };
    let check = check.map(|check| quote!(if let ::core::option::Option::Some(entry) = record.entry(#text) { #check }));
    let check = check.unwrap_or_default();
    Ok(Declaration { declared, read, write, check, proof, given: marks.default.is_none() && inner.is_none() })
}

/// The name of a member of a family; empty for what is none.
fn member(input: &DeriveInput) -> Result<String, Error> {
    let mut member = String::new();
    for attribute in input.attrs.iter().filter(|attribute| attribute.path().is_ident("declared")) {
        attribute.parse_nested_meta(|meta| {
            if !meta.path.is_ident("name") {
                return Err(meta.error("it is `name`"));
            }
            member = meta.value()?.parse::<LitStr>()?.value();
            Ok(())
        })?;
    }
    Ok(member)
}
