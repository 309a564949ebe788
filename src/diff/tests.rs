//! Comparisons of tables made for it.
