//! Rows, filters, invalid designs.
