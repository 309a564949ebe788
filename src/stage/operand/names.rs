//! What the names in a formula, claim or proof stand for: its own `with`, or what a report gives to all with `let`.
//!
//! Must not know: what a formula is for.

use std::cell::RefCell;
use std::collections::BTreeSet;

use super::Operand;
use crate::stage::formula::{Formula, names_in};
use declare::declared::Placed;
use declare::error::{Diagnostic, Place};

/// Names and what they stand for.
pub type Operands = Vec<(String, Operand)>;

/// What names stand for in every formula, claim and proof that does not say it itself; and which of them are used.
#[derive(Default)]
pub struct Shared {
    operands: Operands,
    used: RefCell<BTreeSet<usize>>,
}

impl Shared {
    /// Those that stand for something other than what is `taken`.
    ///
    /// # Errors
    /// What is wrong with one of them, at its place.
    pub fn read(stated: &[(String, Placed<String>)], taken: &[&str]) -> Result<Self, Diagnostic> {
        Ok(Self { operands: read_operands(stated, taken)?, used: RefCell::default() })
    }

    /// Whether a name is one of them.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.operands.iter().any(|(known, _)| known == name)
    }

    /// The first that nothing uses.
    ///
    /// # Errors
    /// That, at its place.
    pub fn check_used(&self) -> Result<(), Diagnostic> {
        let used = self.used.borrow();
        let unused = self.operands.iter().enumerate().find(|(index, _)| !used.contains(index));
        unused.map_or(Ok(()), |(_, (name, operand))| {
            Err(Diagnostic::new(format!("`let` gives `{name}`, but no formula, claim or proof uses it"))
                .at(operand.place))
        })
    }
}

/// Refuses a name that no formula can have.
///
/// # Errors
/// That, without its place.
pub fn check_name(name: &str) -> Result<(), Diagnostic> {
    if !name.contains('.') && names_in(name).is_some_and(|names| names.len() == 1 && names.contains(name)) {
        return Ok(());
    }
    Err(Diagnostic::new(format!("`{name}` cannot be a name in a formula")).help("use letters, digits and `_`"))
}

/// Reads what names stand for; refuses those that stand for something already.
///
/// # Errors
/// What is wrong with one of them, at its place.
pub fn read_operands(with: &[(String, Placed<String>)], taken: &[&str]) -> Result<Operands, Diagnostic> {
    let mut operands = Operands::new();
    for (name, given) in with {
        check_name(name).map_err(|wrong| wrong.at(given.place))?;
        if taken.contains(&name.as_str()) {
            let message = format!("`{name}` stands for the {name} value already; choose another name");
            return Err(Diagnostic::new(message).at(given.place));
        }
        operands.push((name.clone(), Operand::read(given)?));
    }
    Ok(operands)
}

/// A formula, and what its names stand for: its own first.
///
/// # Errors
/// A formula that cannot be read, or a name that it does not use.
pub fn read_formula(
    text: &str,
    mut with: Operands,
    given: &[&str],
    place: Place,
    shared: &Shared,
) -> Result<(Formula, Operands), Diagnostic> {
    let own = |(name, _): &&(String, Operand)| with.iter().all(|(own, _)| own != name);
    let shared_names = shared.operands.iter().filter(own).map(|(name, _)| name.as_str());
    let names: Vec<&str> =
        with.iter().map(|(name, _)| name.as_str()).chain(given.iter().copied()).chain(shared_names).collect();
    let formula = Formula::parse(text, &names).map_err(|message| {
        Diagnostic::new(message).at(place).help(
            "allowed: + - * / ^ sqrt() abs() min() max() < <= > >= == != && || !; over all rows mean() rms() sum()",
        )
    })?;
    if let Some((unused, _)) = with.iter().find(|(name, _)| formula.names().all(|used| used != name)) {
        return Err(Diagnostic::new(format!("`with` gives `{unused}`, but `{text}` does not use it")).at(place));
    }
    for (index, (name, operand)) in shared.operands.iter().enumerate() {
        let is_own = with.iter().any(|(own, _)| own == name);
        if !is_own && formula.names().any(|used| used == name) {
            shared.used.borrow_mut().insert(index);
            with.push((name.clone(), operand.clone()));
        }
    }
    Ok((formula, with))
}
