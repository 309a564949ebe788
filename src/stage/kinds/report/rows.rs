//! The operands of a formula or claim side by side: row by row, when they name several.
//!
//! Must not know: published values, verdicts.

use crate::stage::Inputs;

use super::formula::{Formula, Names};
use super::operand::{Operand, Values};
use super::quantity::{Number, shown};

/// The values of every name, in rows that line up.
pub struct Rows<'a> {
    with: &'a [(String, Operand)],
    values: Vec<Values>,
    /// The operand whose rows are counted, if any has several.
    leader: Option<usize>,
    pub count: usize,
}

impl<'a> Rows<'a> {
    /// # Errors
    /// When an operand cannot be looked up, or the rows of two do not line up.
    pub fn of(inputs: &Inputs, with: &'a [(String, Operand)]) -> Result<Self, String> {
        let values: Vec<Values> = with
            .iter()
            .map(|(name, operand)| operand.resolve(inputs).map_err(|problem| format!("{name} = {problem}")))
            .collect::<Result<_, _>>()?;
        let leader = values.iter().position(|values| values.numbers.len() > 1);
        let count = leader.map_or(1, |leader| values[leader].numbers.len());
        if let Some(leader) = leader {
            for (other, (name, _)) in values.iter().zip(with) {
                if other.numbers.len() > 1 && (&other.keys, &other.rows) != (&values[leader].keys, &values[leader].rows)
                {
                    let (first, keys) = (&with[leader].0, values[leader].keys.join(", "));
                    return Err(format!(
                        "the rows of {first} ({count}, by {keys}) and {name} ({}, by {}) do not line up",
                        other.numbers.len(),
                        other.keys.join(", ")
                    ));
                }
            }
        }
        Ok(Self { with, values, leader, count })
    }

    /// # Errors
    /// When an operand names several rows.
    pub fn single(&self) -> Result<(), String> {
        for (values, (_, operand)) in self.values.iter().zip(self.with) {
            values.single(&operand.text)?;
        }
        Ok(())
    }

    pub fn number(&self, operand: usize, row: usize) -> Number {
        let numbers = &self.values[operand].numbers;
        numbers[if numbers.len() == 1 { 0 } else { row }]
    }

    /// The names of one row; `given` are `published` and `computed`, in a proof.
    pub fn names(&self, row: usize, given: Option<(Number, Number)>) -> impl Fn(&str) -> Option<Number> + '_ {
        move |name| match (name, given) {
            ("published", Some((published, _))) => Some(published),
            ("computed", Some((_, computed))) => Some(computed),
            _ => self.with.iter().position(|(known, _)| known == name).map(|operand| self.number(operand, row)),
        }
    }

    /// `k1 = 273.8×10⁶ N/m, …`
    pub fn written(&self, row: usize) -> String {
        let one = |(operand, (name, _)): (usize, &(String, Operand))| {
            let text = shown(self.number(operand, row), &self.values[operand].unit, 6);
            format!("{name} = {text}")
        };
        self.with.iter().enumerate().map(one).collect::<Vec<_>>().join(", ")
    }

    /// Where a claim does not hold, with the numbers of the first such row.
    ///
    /// # Errors
    /// As [`Formula::evaluate`].
    pub fn remark(&self, failing: &[usize], formula: &Formula) -> Result<String, String> {
        const MOST: usize = 6;
        let Some(&first) = failing.first() else { return Ok(String::new()) };
        let Some(leader) = self.leader else { return formula.with_numbers(&self.names(first, None), "") };
        let (keys, rows) = (&self.values[leader].keys, &self.values[leader].rows);
        let at = |row: usize| {
            let parts = keys.iter().zip(&rows[row]).map(|(key, value)| format!("{key} {value}"));
            parts.collect::<Vec<_>>().join(", ")
        };
        let mut places: Vec<String> = failing.iter().take(MOST).map(|&row| at(row)).collect();
        if failing.len() > MOST {
            places.push(format!("and {} more", failing.len() - MOST));
        }
        let names: Names = &self.names(first, None);
        let numbers = formula.with_numbers(names, &self.values[leader].unit)?;
        Ok(format!("does not hold at {}; at {}: {numbers}", places.join("; "), at(first)))
    }
}
