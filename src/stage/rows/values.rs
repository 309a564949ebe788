//! Values of varied fields: as a field holds them and as a column shows them; rows of them.
//!
//! Must not know: which rows there are.

use declare::units::{parse_quantity, showing};

/// A value of a field: as the field holds it, and as the column shows it. The first follows from the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    pub si: f64,
    pub shown: f64,
}

/// The level nearest to a value.
pub fn level(si: f64, unit: &str) -> Level {
    if unit.is_empty() {
        return Level { si, shown: si };
    }
    let read = |shown: f64| parse_quantity(&format!("{shown:e} {unit}")).map_or(f64::NAN, |quantity| quantity.value);
    let shown = showing(unit)(si);
    // As somebody would have written it, where that is it.
    let rounded = format!("{shown:.14e}").parse().unwrap_or(shown);
    if read(rounded).to_bits() == si.to_bits() {
        Level { si, shown: rounded }
    } else {
        Level { si: read(shown), shown }
    }
}

/// Rows of a part, one behind the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowSet {
    width: usize,
    /// Numbers of a row.
    leading: usize,
    count: usize,
    si: Vec<f64>,
    shown: Vec<f64>,
    /// Those that tell rows apart beside their values, such as the number under which a row was drawn.
    numbers: Vec<usize>,
}

impl RowSet {
    /// Without rows yet, of so many numbers and columns.
    pub fn new(leading: usize, width: usize) -> Self {
        Self { width, leading, ..Self::default() }
    }

    pub fn len(&self) -> usize {
        self.count
    }

    /// By column, in SI.
    pub fn si(&self, row: usize) -> &[f64] {
        &self.si[row * self.width..(row + 1) * self.width]
    }

    /// By column, as shown.
    pub fn shown(&self, row: usize) -> &[f64] {
        &self.shown[row * self.width..(row + 1) * self.width]
    }

    pub fn numbers(&self, row: usize) -> &[usize] {
        &self.numbers[row * self.leading..(row + 1) * self.leading]
    }

    pub fn push(&mut self, numbers: &[usize], levels: impl Iterator<Item = Level>) {
        self.count += 1;
        self.numbers.extend_from_slice(numbers);
        for level in levels {
            self.si.push(level.si);
            self.shown.push(level.shown);
        }
    }

    pub fn pop(&mut self) {
        self.count = self.count.saturating_sub(1);
        self.numbers.truncate(self.count * self.leading);
        self.si.truncate(self.count * self.width);
        self.shown.truncate(self.count * self.width);
    }
}
