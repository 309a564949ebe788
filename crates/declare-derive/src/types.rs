//! What a type is declared as.
//!
//! Must not know: which struct has it.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Error, GenericArgument, Ident, PathArguments, Type, TypeTuple};

use crate::marks::Marks;

/// How a type is declared, read from an `entry: &PlacedValue`, and written from a `value: &T` to a `PlacedValue`.
pub struct Kind {
    pub shape: TokenStream,
    pub read: TokenStream,
    pub write: TokenStream,
    /// Refuses, in an `entry: &PlacedValue`, what does not go together inside.
    pub check: Option<TokenStream>,
    /// What must hold when it is compiled.
    pub proof: TokenStream,
}

impl Kind {
    /// Of one value: read from a `&Value`, written to a `Value`.
    fn new(shape: TokenStream, read: &TokenStream, write: &TokenStream) -> Self {
        let (read, write) = (quote!(#read(&entry.value)), quote!(::declare::declared::entry(#write)));
        Self { shape, read, write, check: None, proof: TokenStream::new() }
    }
}

pub fn kind(ty: &Type, marks: &Marks, owner: &Ident) -> Result<Kind, Error> {
    if let Some(item) = argument(ty, "Vec") {
        return if marks.axis.is_some() { axis(item, marks, owner) } else { several(item, marks, owner) };
    }
    if let Some(inner) = argument(ty, "Placed") {
        let Kind { shape, read, write, check, proof } = kind(inner, marks, owner)?;
        return Ok(Kind {
            shape,
            read: quote!(::declare::declared::Placed { value: #read, place: entry.place }),
            write: quote!(::declare::record::PlacedValue {
                place: value.place,
                ..{ let value = &value.value; #write }
            }),
            check,
            proof,
        });
    }
    if marks.axis.is_some() {
        return Err(Error::new(owner.span(), "an axis is a `Vec<f64>`"));
    }
    one(ty, marks, owner)
}

/// Values of an axis.
fn axis(item: &Type, marks: &Marks, owner: &Ident) -> Result<Kind, Error> {
    if word(item) != "f64" {
        return Err(Error::new(owner.span(), "an axis is a `Vec<f64>`"));
    }
    let Kind { shape, .. } = one(item, marks, owner)?;
    let write = quote!(::declare::record::Value::Axis(value.clone()));
    Ok(Kind::new(shape, &quote!(::declare::declared::axis), &write))
}

/// A list, or a map where the items have names.
fn several(item: &Type, marks: &Marks, owner: &Ident) -> Result<Kind, Error> {
    if let Some(item) = named(item) {
        let Kind { shape, read, write, check, proof } = kind(item, marks, owner)?;
        let entries = quote!(::declare::declared::named(&entry.value));
        return Ok(Kind {
            shape: quote!(::declare::parameter::Shape::Map(&#shape)),
            read: quote!(#entries.iter().map(|(name, entry)| (name.clone(), #read)).collect()),
            write: quote!(::declare::declared::entry(::declare::record::Value::Map(
                value.iter().map(|(name, value)| (name.clone(), #write)).collect()
            ))),
            check: check.map(|check| quote!(for (_, entry) in #entries { #check })),
            proof,
        });
    }
    let Kind { shape, read, write, check, proof } = kind(item, marks, owner)?;
    let items = quote!(::declare::declared::items(&entry.value));
    Ok(Kind {
        shape: quote!(::declare::parameter::Shape::List(&#shape)),
        read: quote!(#items.iter().map(|entry| #read).collect()),
        write: quote!(::declare::declared::entry(::declare::record::Value::List(
            value.iter().map(|value| #write).collect()
        ))),
        check: check.map(|check| quote!(for entry in #items { #check })),
        proof,
    })
}

fn one(ty: &Type, marks: &Marks, owner: &Ident) -> Result<Kind, Error> {
    if let Some(of) = &marks.overrides {
        return Ok(Kind::new(
            quote!(::declare::parameter::Shape::Overrides(#of)),
            &quote!(::declare::declared::variant),
            &quote!(::declare::record::Value::Variant(value.clone())),
        ));
    }
    if let Some(of) = &marks.varies {
        return Ok(Kind::new(
            quote!(::declare::parameter::Shape::Varied(#of)),
            &quote!(::declare::declared::varied),
            &quote!(::declare::record::Value::Varied(value.clone())),
        ));
    }
    Ok(match word(ty).as_str() {
        "f64" => {
            let (minimum, maximum) = marks.bounds(owner)?;
            match &marks.dimension {
                Some(dimension) => Kind::new(
                    quote!(::declare::parameter::Shape::Quantity {
                        dimension: #dimension, minimum: #minimum, maximum: #maximum
                    }),
                    &quote!(::declare::declared::quantity),
                    &quote!(::declare::record::Value::Quantity(*value)),
                ),
                None => Kind::new(
                    quote!(::declare::parameter::Shape::Number { minimum: #minimum, maximum: #maximum }),
                    &quote!(::declare::declared::number),
                    &quote!(::declare::record::Value::Number(*value)),
                ),
            }
        }
        "u8" | "u16" | "u32" | "u64" | "usize" | "i8" | "i16" | "i32" | "i64" => {
            let (minimum, maximum) = marks.bounds(owner)?;
            let fits = format!("every value of `{owner}` fits its type");
            let multiple = marks.multiple.as_ref().map_or_else(|| quote!(1), |multiple| quote!(#multiple));
            let shape = quote!(::declare::parameter::Shape::Integer {
                minimum: #minimum, maximum: #maximum, multiple: #multiple
            });
            let proof = quote!(
                const _: () = assert!(
                    #minimum as i128 >= <#ty>::MIN as i128 && #maximum as i128 <= <#ty>::MAX as i128, #fits
                );
            );
            let read = quote!(::declare::declared::integer::<#ty>);
            Kind { proof, ..Kind::new(shape, &read, &quote!(::declare::declared::of_integer(*value))) }
        }
        "bool" => Kind::new(
            quote!(::declare::parameter::Shape::Flag),
            &quote!(::declare::declared::flag),
            &quote!(::declare::record::Value::Flag(*value)),
        ),
        "String" => match &marks.kinds {
            Some(kinds) => Kind::new(
                quote!(::declare::parameter::Shape::Reference(&[#kinds])),
                &quote!(::declare::declared::reference),
                &quote!(::declare::record::Value::Reference(value.clone())),
            ),
            None => Kind::new(
                quote!(::declare::parameter::Shape::Text),
                &quote!(::declare::declared::text),
                &quote!(::declare::record::Value::Text(value.clone())),
            ),
        },
        _ => Kind {
            check: Some(quote!(<#ty as ::declare::declared::Parameter>::consistent(&entry.value)?;)),
            ..Kind::new(
                quote!(<#ty as ::declare::declared::Parameter>::SHAPE),
                &quote!(<#ty as ::declare::declared::Parameter>::of_value),
                &quote!(::declare::declared::Parameter::to_value(value)),
            )
        },
    })
}

/// A type that is a single word.
fn word(ty: &Type) -> String {
    match ty {
        Type::Path(path) => path.path.get_ident().map(Ident::to_string).unwrap_or_default(),
        _ => String::new(),
    }
}

/// `T` of `(String, T)`.
fn named(ty: &Type) -> Option<&Type> {
    let Type::Tuple(TypeTuple { elems, .. }) = ty else { return None };
    let mut elems = elems.iter();
    let name = elems.next().filter(|name| word(name) == "String");
    name.and(elems.next()).filter(|_| elems.next().is_none())
}

/// `T` of `Outer<T>`.
pub fn argument<'a>(ty: &'a Type, outer: &str) -> Option<&'a Type> {
    let Type::Path(path) = ty else { return None };
    let last = path.path.segments.last().filter(|last| last.ident == outer)?;
    let PathArguments::AngleBracketed(arguments) = &last.arguments else { return None };
    match arguments.args.first()? {
        GenericArgument::Type(inner) => Some(inner),
        _ => None,
    }
}
