//! The sentences that doc comments are.
//!
//! Must not know: what they are about.

use syn::{Attribute, Error, Expr, ExprLit, Lit, Meta};

/// The first paragraph of a doc comment on one line: what a user reads. What follows it is for readers of the code.
///
/// # Errors
/// When there is none: a user would read nothing.
pub fn sentence(attributes: &[Attribute], owner: &syn::Ident) -> Result<String, Error> {
    let mut words = Vec::new();
    for attribute in attributes {
        let Meta::NameValue(pair) = &attribute.meta else { continue };
        let Expr::Lit(ExprLit { lit: Lit::Str(line), .. }) = &pair.value else { continue };
        if !pair.path.is_ident("doc") {
            continue;
        }
        let line = line.value();
        if line.trim().is_empty() {
            break;
        }
        words.push(line.trim().to_owned());
    }
    if words.is_empty() {
        return Err(Error::new(owner.span(), "its doc comment is what a user reads of it, and there is none"));
    }
    Ok(words.join(" "))
}
