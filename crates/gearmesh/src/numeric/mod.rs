//! Numerical methods on plain numbers: interpolation, quadrature, roots, complementarity, harmonics.
//!
//! Must not know: gears, files, units of anything.

pub mod bundle;
pub mod by_loads;
pub mod chebyshev;
pub mod complementarity;
pub mod crossing;
pub mod distribution;
pub mod double_double;
pub mod elimination;
pub mod extremum;
pub mod graded;
pub mod harmonics;
pub mod indices;
pub mod lambert;
pub mod layer;
pub mod lobatto;
pub mod logarithm;
pub mod many_springs;
pub mod normal;
pub mod panels;
pub mod parabola;
pub mod piecewise;
pub mod quadratic;
pub mod quadrature;
pub mod replicates;
pub mod singular_values;
pub mod spectrum;
pub mod spline;
pub mod student;
pub mod surface;
pub mod together;
