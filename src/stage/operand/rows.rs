//! The operands of a formula or claim side by side: row by row, when they name several.
//!
//! Must not know: published values, verdicts.

use super::{Operand, Values};
use crate::stage::Inputs;
use crate::stage::formula::{Formula, Names};
use crate::stage::quantity::{Number, shown};
use declare::error::Diagnostic;

/// The values of every name, in rows that line up.
pub struct OperandRows<'a> {
    with: &'a [(String, Operand)],
    values: Vec<Values>,
    /// The operand whose rows are counted, if any has several.
    leader: Option<usize>,
    pub count: usize,
}

impl<'a> OperandRows<'a> {
    /// # Errors
    /// When an operand cannot be looked up, or the rows of two do not line up.
    pub fn of(inputs: &Inputs, with: &'a [(String, Operand)]) -> Result<Self, Diagnostic> {
        let values: Vec<Values> = with.iter().map(|(_, operand)| operand.resolve(inputs)).collect::<Result<_, _>>()?;
        let several = |values: &Values| values.numbers.len() > 1;
        // Rows that have keys tell where a claim fails; quantities as written have none.
        let leader = values.iter().position(|values| several(values) && !values.keys.is_empty());
        let leader = leader.or_else(|| values.iter().position(several));
        let count = leader.map_or(1, |leader| values[leader].numbers.len());
        if let Some(leader) = leader {
            let first = &values[leader];
            // Quantities as written have no keys: they stand in the order of the rows.
            let line_up = |other: &Values| {
                let written = first.keys.is_empty() || other.keys.is_empty();
                if written {
                    other.numbers.len() == count
                } else {
                    (&other.keys, &other.rows) == (&first.keys, &first.rows)
                }
            };
            for (other, (name, operand)) in values.iter().zip(with) {
                if other.numbers.len() > 1 && !line_up(other) {
                    let rows = |values: &Values| match values.keys.join(", ") {
                        keys if keys.is_empty() => values.numbers.len().to_string(),
                        keys => format!("{}, by {keys}", values.numbers.len()),
                    };
                    let (leader, rows_of_first, rows_of_other) = (&with[leader].0, rows(first), rows(other));
                    return Err(operand.refused(format!(
                        "the rows of {leader} ({rows_of_first}) and {name} ({rows_of_other}) do not line up"
                    )));
                }
            }
        }
        Ok(Self { with, values, leader, count })
    }

    /// # Errors
    /// When an operand names several rows where the formula means one.
    pub fn single(&self, formula: &Formula) -> Result<(), Diagnostic> {
        for (values, (name, operand)) in self.values.iter().zip(self.with) {
            if formula.row_by_row(name) {
                values.single(operand)?;
            }
        }
        Ok(())
    }

    /// How often a claim is to be judged: once per row, or once when all rows go into its numbers.
    pub fn judged(&self, claim: &Formula) -> usize {
        let mut named = self.with.iter().zip(&self.values);
        if named.any(|((name, _), values)| values.numbers.len() > 1 && claim.row_by_row(name)) { self.count } else { 1 }
    }

    pub fn number(&self, operand: usize, row: usize) -> Number {
        let numbers = &self.values[operand].numbers;
        numbers[if numbers.len() == 1 { 0 } else { row }]
    }

    /// What a name stands for in a row; `given` are `published` and `computed`, in a proof.
    pub fn lookup(&self, given: Option<(Number, Number)>) -> impl Fn(&str, usize) -> Option<Number> + '_ {
        move |name, row| match (name, given) {
            ("published", Some((published, _))) => Some(published),
            ("computed", Some((_, computed))) => Some(computed),
            _ => self.with.iter().position(|(known, _)| known == name).map(|operand| self.number(operand, row)),
        }
    }

    /// The names of one row.
    pub fn names<'n>(&self, row: usize, value: &'n dyn Fn(&str, usize) -> Option<Number>) -> Names<'n> {
        Names { value, row, rows: self.count }
    }

    /// `k1 = 273.8×10⁶ N/m, …`
    pub fn written(&self, row: usize) -> String {
        let one = |(operand, (name, _)): (usize, &(String, Operand))| match self.values[operand].numbers.len() {
            1 => format!("{name} = {}", shown(self.number(operand, row), &self.values[operand].unit, 6)),
            several => format!("{name} = {several} values"),
        };
        self.with.iter().enumerate().map(one).collect::<Vec<_>>().join(", ")
    }

    /// The keys of a row with their values; of quantities as written which one it is. Empty where there is one row.
    pub fn place(&self, row: usize) -> String {
        self.leader.map_or_else(String::new, |leader| self.place_of(leader, row))
    }

    fn place_of(&self, leader: usize, row: usize) -> String {
        let parts = self.values[leader].keys.iter().zip(&self.values[leader].rows[row]);
        let place = parts.map(|(key, value)| format!("{key} {value}")).collect::<Vec<_>>().join(", ");
        if place.is_empty() { format!("value {}", row + 1) } else { place }
    }

    /// Where a claim does not hold, with the numbers of the first such row.
    ///
    /// # Errors
    /// As [`Formula::evaluate`].
    pub fn remark(&self, failing: &[usize], formula: &Formula) -> Result<String, String> {
        const MOST: usize = 6;
        let Some(&first) = failing.first() else { return Ok(String::new()) };
        let value = self.lookup(None);
        let Some(leader) = self.leader.filter(|_| self.judged(formula) > 1) else {
            return formula.with_numbers(self.names(first, &value), "");
        };
        let at = |row: usize| self.place_of(leader, row);
        let mut places: Vec<String> = failing.iter().take(MOST).map(|&row| at(row)).collect();
        if failing.len() > MOST {
            places.push(format!("and {} more", failing.len() - MOST));
        }
        let numbers = formula.with_numbers(self.names(first, &value), &self.values[leader].unit)?;
        Ok(format!("does not hold at {}; at {}: {numbers}", places.join("; "), at(first)))
    }
}
