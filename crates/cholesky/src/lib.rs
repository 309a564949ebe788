//! L Lᵀ of a sparse, symmetric, positive definite matrix, with some unknowns eliminated last, in their order.
//!
//! A crate of its own, since the library that factorises is generic: here it is compiled once, with optimisation, and not
//! each time with all that uses it. Must not know: what a matrix means.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, amd};
use faer::sparse::{SparseColMat, SymbolicSparseColMat, SymbolicSparseColMatRef, Triplet};
use faer::{Conj, MatMut, Par, Side, Spec};

/// In which order the sums of a factorisation are made. [`Order::Blocks`] is the quick one; the others show by how much
/// the order moves results, as a processor does for which the library uses other instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Dense blocks of columns.
    Blocks,
    /// Column by column.
    Columns,
    /// Unknowns as they are numbered, with much more fill.
    Numbered,
}

/// Why a matrix cannot be factorised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CholeskyError {
    #[error("the matrix does not fit into memory")]
    Memory,
    #[error("the matrix is not positive definite to rounding")]
    Singular,
}

/// The lower half of a symmetric matrix, entry by entry; entries of one place add up.
#[derive(Clone, Debug, Default)]
pub struct Entries(Vec<Triplet<usize, usize, f64>>);

impl Entries {
    /// Adds `value` to a place on or below the diagonal.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        debug_assert!(row >= column, "the lower half is kept");
        self.0.push(Triplet::new(row, column, value));
    }
}

/// L Lᵀ of a sparse matrix.
pub struct Factor {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

impl Factor {
    /// Of a matrix with `size` unknowns, of which those from `inside` on are eliminated last, in their order.
    ///
    /// # Errors
    /// When the matrix is too large, or not positive definite to rounding.
    pub fn new(Entries(triplets): &Entries, inside: usize, size: usize, order: Order) -> Result<Self, CholeskyError> {
        let matrix = SparseColMat::try_new_from_triplets(size, size, triplets).map_err(|_| CholeskyError::Memory)?;
        let inner = first_unknowns(matrix.symbolic(), inside);
        let (mut forward, mut inverse) = (vec![0; inside], vec![0; inside]);
        let scratch = amd::order_maybe_unsorted_scratch::<usize>(inside, inner.compute_nnz());
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        amd::order_maybe_unsorted(&mut forward, &mut inverse, inner.as_ref(), amd::Control::default(), stack)
            .map_err(|_| CholeskyError::Memory)?;
        for direction in [&mut forward, &mut inverse] {
            if order == Order::Numbered {
                *direction = (0..inside).collect();
            }
            direction.extend(inside..size);
        }
        let threshold = match order {
            Order::Columns => SupernodalThreshold::FORCE_SIMPLICIAL,
            _ => SupernodalThreshold::FORCE_SUPERNODAL,
        };
        let ordering = SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, size));
        let params =
            CholeskySymbolicParams { supernodal_flop_ratio_threshold: threshold, ..CholeskySymbolicParams::default() };
        let symbolic = factorize_symbolic_cholesky(matrix.symbolic(), Side::Lower, ordering, params)
            .map_err(|_| CholeskyError::Memory)?;
        let mut values = vec![0.0; symbolic.len_val()];
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        symbolic
            .factorize_numeric_llt(
                &mut values,
                matrix.as_ref(),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut MemBuffer::new(scratch)),
                Spec::default(),
            )
            .map_err(|_| CholeskyError::Singular)?;
        Ok(Self { symbolic, values })
    }

    /// What remains of the matrix for the unknowns from `first` on, which are among those eliminated last, when the others
    /// are eliminated: L_EE L_EEᵀ, by columns.
    #[must_use]
    pub fn trailing(&self, first: usize) -> Vec<Vec<f64>> {
        let size = self.symbolic.nrows() - first;
        let mut lower = vec![vec![0.0; size]; size];
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(symbolic) => {
                let factor = SupernodalLltRef::new(symbolic, &self.values);
                for index in 0..symbolic.n_supernodes() {
                    let node = factor.supernode(index);
                    let (start, values) = (node.start(), node.val());
                    for column in first.max(start)..start + values.ncols() {
                        let rows = (start..start + values.ncols()).chain(node.pattern().iter().copied());
                        for (row, &value) in rows.zip(values.col(column - start).iter()) {
                            if row >= column {
                                lower[column - first][row - first] = value;
                            }
                        }
                    }
                }
            }
            SymbolicCholeskyRaw::Simplicial(symbolic) => {
                for (column, slots) in (first..).zip(&mut lower) {
                    let range = symbolic.col_ptr()[column]..symbolic.col_ptr()[column + 1];
                    for (&row, &value) in symbolic.row_idx()[range.clone()].iter().zip(&self.values[range]) {
                        slots[row - first] = value;
                    }
                }
            }
        }
        let mut product = vec![vec![0.0; size]; size];
        for (pivot, column) in lower.iter().enumerate() {
            for (row, &left) in column.iter().enumerate().skip(pivot) {
                for (slot, &right) in product[row][pivot..].iter_mut().zip(&column[pivot..]) {
                    *slot += left * right;
                }
            }
        }
        product
    }

    /// Replaces right sides by solutions, one column of as many values as there are unknowns after the other.
    pub fn solve(&self, columns: &mut [f64]) {
        let size = self.symbolic.nrows();
        let count = columns.len() / size;
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(count, Par::Seq));
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(columns, size, count),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }
}

/// Which entries there are between the first `count` unknowns, in a lower half whose rows are sorted.
fn first_unknowns(lower: SymbolicSparseColMatRef<'_, usize>, count: usize) -> SymbolicSparseColMat<usize> {
    let mut starts = vec![0];
    let mut rows = Vec::with_capacity(lower.row_idx().len());
    for column in 0..count {
        rows.extend(lower.row_idx_of_col(column).take_while(|row| *row < count));
        starts.push(rows.len());
    }
    SymbolicSparseColMat::new_checked(count, count, starts, None, rows)
}
