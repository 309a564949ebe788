//! Structs whose fields are parameters.
//!
//! Must not know: who reads them.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{
    Attribute, Data, DeriveInput, Error, Expr, Field, Fields, GenericArgument, Ident, LitStr, PathArguments, Type,
    Visibility,
};

use crate::doc::sentence;

/// What stands on a field.
#[derive(Default)]
pub struct Marks {
    minimum: Option<Expr>,
    maximum: Option<Expr>,
    dimension: Option<Expr>,
    pub default: Option<LitStr>,
    axis: Option<Expr>,
    multiple: Option<Expr>,
    range: bool,
    flatten: bool,
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
                    "axis" => marks.axis = Some(meta.value()?.parse()?),
                    "multiple" => marks.multiple = Some(meta.value()?.parse()?),
                    "name" => marks.name = Some(meta.value()?.parse()?),
                    "range" => marks.range = true,
                    "flatten" => marks.flatten = true,
                    _ => {
                        return Err(meta.error(
                            "it is `minimum`, `maximum`, `multiple`, `dimension`, `default`, `axis`, `range`, `name` or \
                             `flatten`",
                        ));
                    }
                }
                Ok(())
            })?;
        }
        Ok(marks)
    }

    /// The range of a number.
    fn bounds(&self, owner: &Ident) -> Result<(&Expr, &Expr), Error> {
        match (&self.minimum, &self.maximum) {
            (Some(minimum), Some(maximum)) => Ok((minimum, maximum)),
            _ => Err(Error::new(owner.span(), "a number has a range: `minimum` and `maximum`")),
        }
    }
}

/// How a type is declared, read from a `value: &Value`, and written from a `value: &T`.
struct Kind {
    shape: TokenStream,
    read: TokenStream,
    write: TokenStream,
    /// What must hold when it is compiled.
    proof: TokenStream,
}

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
        let Declaration { declared, read: from, write, proof, given } = declaration(field, &marks, ident)?;
        all_default &= !given;
        let text = marks.name.as_ref().map_or_else(|| ident.to_string(), LitStr::value);
        tables.push(quote!(&[#declared]));
        proofs.push(proof);
        read.push(quote!(#ident: #from));
        written.push(quote!({ let value = &self.#ident; #write }));
        idents.push(ident);
        texts.push(text);
    }
    let default = all_default.then(|| {
        quote! {
            impl ::core::default::Default for #name {
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

            fn of_value(value: &::declare::record::Value) -> Self {
                ::declare::declared::group(value)
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
    let Kind { shape, read, write, proof } = kind(inner.unwrap_or(&field.ty), marks, ident)?;
    let mut declared = quote!(::declare::parameter::Field::new(#text, #shape, #summary));
    match (&marks.default, inner) {
        (Some(text), None) => declared = quote!(#declared.default(#text)),
        (Some(text), Some(_)) => return Err(Error::new(text.span(), "an `Option` has no default")),
        (None, Some(_)) => declared = quote!(#declared.optional()),
        (None, None) => {}
    }
    if marks.range {
        declared = quote!(#declared.range());
    }
    if let Some(chunk) = &marks.axis {
        declared = quote!(#declared.axis(#chunk));
    }
    let push = quote!(fields.push((#text, ::declare::declared::entry(#write))););
    let (read, write) = if inner.is_some() {
        (
            quote!(record.entry(#text).map(|entry| { let value = &entry.value; #read })),
            quote!(if let ::core::option::Option::Some(value) = value { #push }),
        )
    } else {
        (quote!({ let value = ::declare::declared::value(record, #text); #read }), push)
    };
    Ok(Declaration { declared, read, write, proof, given: marks.default.is_none() && inner.is_none() })
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

fn kind(ty: &Type, marks: &Marks, owner: &Ident) -> Result<Kind, Error> {
    if let Some(item) = argument(ty, "Vec") {
        let Kind { shape, read, write, proof } = kind(item, marks, owner)?;
        return Ok(Kind {
            shape: quote!(::declare::parameter::Shape::List(&#shape)),
            read: quote!(::declare::declared::items(value).map(|value| #read).collect()),
            write: quote!(::declare::record::Value::List(
                value.iter().map(|value| ::declare::declared::entry(#write)).collect()
            )),
            proof,
        });
    }
    let word = match ty {
        Type::Path(path) => path.path.get_ident().map(Ident::to_string).unwrap_or_default(),
        _ => String::new(),
    };
    Ok(match word.as_str() {
        "f64" => {
            let (minimum, maximum) = marks.bounds(owner)?;
            match &marks.dimension {
                Some(dimension) => Kind {
                    shape: quote!(::declare::parameter::Shape::Quantity {
                        dimension: #dimension, minimum: #minimum, maximum: #maximum
                    }),
                    read: quote!(::declare::declared::quantity(value)),
                    write: quote!(::declare::record::Value::Quantity(*value)),
                    proof: TokenStream::new(),
                },
                None => Kind {
                    shape: quote!(::declare::parameter::Shape::Number { minimum: #minimum, maximum: #maximum }),
                    read: quote!(::declare::declared::number(value)),
                    write: quote!(::declare::record::Value::Number(*value)),
                    proof: TokenStream::new(),
                },
            }
        }
        "u8" | "u16" | "u32" | "u64" | "usize" | "i8" | "i16" | "i32" | "i64" => {
            let (minimum, maximum) = marks.bounds(owner)?;
            let fits = format!("every value of `{owner}` fits its type");
            let multiple = marks.multiple.as_ref().map_or_else(|| quote!(1), |multiple| quote!(#multiple));
            Kind {
                shape: quote!(::declare::parameter::Shape::Integer {
                    minimum: #minimum, maximum: #maximum, multiple: #multiple
                }),
                read: quote!(::declare::declared::integer::<#ty>(value)),
                write: quote!(::declare::declared::of_integer(*value)),
                proof: quote!(
                    const _: () = assert!(
                        #minimum as i128 >= <#ty>::MIN as i128 && #maximum as i128 <= <#ty>::MAX as i128, #fits
                    );
                ),
            }
        }
        "bool" => Kind {
            shape: quote!(::declare::parameter::Shape::Flag),
            read: quote!(::declare::declared::flag(value)),
            write: quote!(::declare::record::Value::Flag(*value)),
            proof: TokenStream::new(),
        },
        "String" => Kind {
            shape: quote!(::declare::parameter::Shape::Text),
            read: quote!(::declare::declared::text(value)),
            write: quote!(::declare::record::Value::Text(value.clone())),
            proof: TokenStream::new(),
        },
        _ => Kind {
            shape: quote!(<#ty as ::declare::declared::Parameter>::SHAPE),
            read: quote!(<#ty as ::declare::declared::Parameter>::of_value(value)),
            write: quote!(::declare::declared::Parameter::to_value(value)),
            proof: TokenStream::new(),
        },
    })
}

/// `T` of `Outer<T>`.
fn argument<'a>(ty: &'a Type, outer: &str) -> Option<&'a Type> {
    let Type::Path(path) = ty else { return None };
    let last = path.path.segments.last().filter(|last| last.ident == outer)?;
    let PathArguments::AngleBracketed(arguments) = &last.arguments else { return None };
    match arguments.args.first()? {
        GenericArgument::Type(inner) => Some(inner),
        _ => None,
    }
}
