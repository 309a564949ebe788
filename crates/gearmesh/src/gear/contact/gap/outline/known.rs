//! A profile as one piecewise cubic, where it is a spline through many points and whatever is drawn beside it.
//!
//! Must not know: positions, the other flank.

use std::ops::Deref;
use std::sync::Arc;

use crate::gear::modification::section::Section;
use crate::numeric::quadratic::Quadratic;
use crate::numeric::spline::Spline;

/// What stands for all parts of a profile, over the roll angle; held at its ends.
#[derive(Clone, Debug)]
pub(super) enum Known<'a> {
    /// The spline of its only part.
    Alone(&'a Spline),
    /// With what other parts take off, which may have kinks.
    Sum(Arc<Spline>),
}

impl Deref for Known<'_> {
    type Target = Spline;

    #[inline]
    fn deref(&self) -> &Spline {
        match self {
            Self::Alone(spline) => spline,
            Self::Sum(spline) => spline,
        }
    }
}

impl<'a> Known<'a> {
    /// Between two roll angles; none where more than one part is a spline, or another one is no quadratic somewhere.
    pub(super) fn of(parts: &[Section<'a>], [from, to]: [f64; 2]) -> Option<Self> {
        if let [part] = parts {
            return part.spline().map(Self::Alone);
        }
        let place = parts.iter().position(|part| part.spline().is_some())?;
        let others = || parts.iter().enumerate().filter(|(at, _)| *at != place).map(|(_, part)| part);
        let mut begins: Vec<f64> = others().flat_map(Section::breaks).copied().collect();
        begins.retain(|roll| *roll > from && *roll < to);
        begins.push(from);
        begins.sort_by(f64::total_cmp);
        let quadratic = |at: usize| {
            let end = begins.get(at + 1).copied().unwrap_or(to);
            let middle = 0.5 * (begins[at] + end);
            let sum = others().try_fold(Quadratic::ZERO, |sum, part| Some(sum.plus(&part.quadratic(middle)?)))?;
            Some((begins[at], sum))
        };
        let quadratics = (0..begins.len()).map(quadratic).collect::<Option<Vec<_>>>()?;
        Some(Self::Sum(Arc::new(parts[place].spline()?.with_quadratics([from, to], &quadratics))))
    }
}
