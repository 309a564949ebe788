//! From a published and a computed value to a verdict.
//!
//! A difference alone says nothing: either it lies within the tolerance, or somebody says why it is there, and can prove
//! it, and says where the computed value stands today so that it cannot drift behind the reason. Where inputs were printed rounded
//! a value agrees if it does for any of those that they may be. Must not know: tables, cells, units (all values are in one).

/// What is said about one entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Unexplained,
    Moved,
    Outdated,
    Explained,
    Refuted,
    Reproduced,
    Holds,
}

impl Verdict {
    /// In the order in which a reader wants to see them: what needs attention first.
    pub const ALL: [Self; 7] =
        [Self::Unexplained, Self::Moved, Self::Outdated, Self::Explained, Self::Refuted, Self::Reproduced, Self::Holds];

    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Unexplained => "unexplained",
            Self::Moved => "moved",
            Self::Outdated => "outdated",
            Self::Explained => "explained",
            Self::Refuted => "refuted",
            Self::Reproduced => "reproduced",
            Self::Holds => "holds",
        }
    }

    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Unexplained => "differs from the paper by more than the tolerance, and no reason that holds is given",
            Self::Moved => "left the value that the study expects: what was explained before is now something else",
            Self::Outdated => "agrees with the paper although the study gives a reason why it should not",
            Self::Explained => "differs from the paper; the reason is given, and its proof holds",
            Self::Refuted => "a claim of the paper that does not hold; the reason is given, and its proof holds",
            Self::Reproduced => "agrees with the paper within the tolerance",
            Self::Holds => "a claim of the paper that holds in every row",
        }
    }

    /// Whether somebody has to look at it.
    #[must_use]
    pub const fn needs_attention(self) -> bool {
        matches!(self, Self::Unexplained | Self::Moved | Self::Outdated)
    }
}

/// A published value and what is known about it, all in one unit. For a claim: in how many rows it should and does hold.
#[derive(Clone, Copy, Debug)]
pub struct Comparison {
    pub published: f64,
    pub computed: f64,
    /// The least and the largest value that it comes to inside the intervals of its inputs, where any matters.
    pub range: Option<(f64, f64)>,
    /// Whether not all that lies between both is taken, so that a published value there need not be.
    pub is_broken: bool,
    /// How far apart the two may be and still agree.
    pub tolerance: f64,
    /// The value the study stands by, and how far the computed one may be from it.
    pub expected: Option<(f64, f64)>,
    /// Whether a reason for a difference is given.
    pub has_reason: bool,
    /// Whether the arithmetic that proves the reason holds, when some is given.
    pub proof_holds: Option<bool>,
    pub is_claim: bool,
}

impl Comparison {
    /// # Errors
    /// When a value is not finite: no verdict can be founded on it.
    pub fn judge(&self) -> Result<Verdict, String> {
        for (name, value) in [("computed", self.computed), ("published", self.published), ("tolerance", self.tolerance)]
        {
            if !value.is_finite() {
                return Err(format!("the {name} value is {value}; a verdict needs a finite number"));
            }
        }
        if self.expected.is_some_and(|(value, tolerance)| !within(self.computed, value, tolerance)) {
            return Ok(Verdict::Moved);
        }
        // What the rounding of an input already accounts for needs no other reason either: that has not been shown to differ.
        let agrees = self.agrees_as_stated() || self.is_reached() == Some(true);
        let explained = self.has_reason && self.proof_holds != Some(false);
        Ok(match (agrees, self.is_claim) {
            (true, _) if self.has_reason => Verdict::Outdated,
            (true, false) => Verdict::Reproduced,
            (true, true) => Verdict::Holds,
            (false, false) if explained => Verdict::Explained,
            (false, true) if explained => Verdict::Refuted,
            (false, _) => Verdict::Unexplained,
        })
    }

    /// Whether both agree with the inputs in the middle of their intervals.
    #[must_use]
    pub fn agrees_as_stated(&self) -> bool {
        within(self.computed, self.published, self.tolerance)
    }

    /// Whether some value from the least to the largest agrees; none where there are none.
    #[must_use]
    pub fn is_reached(&self) -> Option<bool> {
        let (least, largest) = self.range?;
        Some(!self.is_broken && within(self.published.clamp(least, largest), self.published, self.tolerance))
    }
}

/// A value exactly on the tolerance's edge counts as inside, whichever way its last bit was rounded.
fn within(value: f64, target: f64, tolerance: f64) -> bool {
    (value - target).abs() <= tolerance + 1e-12 * value.abs().max(target.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Comparison = Comparison {
        published: 2.316,
        computed: 2.316,
        range: None,
        is_broken: false,
        tolerance: 0.0005,
        expected: None,
        has_reason: false,
        proof_holds: None,
        is_claim: false,
    };
    const CLAIM: Comparison = Comparison { published: 16.0, computed: 16.0, tolerance: 0.0, is_claim: true, ..PLAIN };

    #[test]
    fn every_combination_has_its_verdict() {
        let reason = |proof_holds| Comparison { computed: 3.0009, has_reason: true, proof_holds, ..PLAIN };
        let expecting = |expected| Comparison { expected: Some(expected), ..reason(None) };
        for (case, comparison, verdict) in [
            ("the same", PLAIN, Verdict::Reproduced),
            ("on the upper edge", Comparison { computed: 2.3165, ..PLAIN }, Verdict::Reproduced),
            ("on the lower edge", Comparison { computed: 2.3155, ..PLAIN }, Verdict::Reproduced),
            ("just beyond the edge", Comparison { computed: 2.316_500_1, ..PLAIN }, Verdict::Unexplained),
            ("no reason", Comparison { computed: 3.0009, ..PLAIN }, Verdict::Unexplained),
            ("a reason", reason(None), Verdict::Explained),
            ("a reason with its proof", reason(Some(true)), Verdict::Explained),
            ("a proof that fails", reason(Some(false)), Verdict::Unexplained),
            ("where it was expected", expecting((3.0, 0.001)), Verdict::Explained),
            ("not where it was expected", expecting((3.0, 0.0008)), Verdict::Moved),
            (
                "agrees, but was expected elsewhere",
                Comparison { computed: 2.316, ..expecting((3.0, 0.01)) },
                Verdict::Moved,
            ),
            ("agrees against its reason", Comparison { computed: 2.316, ..reason(None) }, Verdict::Outdated),
            ("agrees, failed proof", Comparison { computed: 2.316, ..reason(Some(false)) }, Verdict::Outdated),
            ("expected and reproduced", Comparison { expected: Some((2.316, 1e-6)), ..PLAIN }, Verdict::Reproduced),
            (
                "published 0, computed 0",
                Comparison { published: 0.0, computed: 0.0, tolerance: 0.0, ..PLAIN },
                Verdict::Reproduced,
            ),
            (
                "published 0",
                Comparison { published: 0.0, computed: 0.004, tolerance: 0.005, ..PLAIN },
                Verdict::Reproduced,
            ),
            (
                "published 0, far",
                Comparison { published: 0.0, computed: 0.006, tolerance: 0.005, ..PLAIN },
                Verdict::Unexplained,
            ),
            ("negative", Comparison { published: -2.316, computed: -2.3162, ..PLAIN }, Verdict::Reproduced),
            ("the wrong sign", Comparison { published: -2.316, ..PLAIN }, Verdict::Unexplained),
            ("a claim that holds", CLAIM, Verdict::Holds),
            ("a claim that fails once", Comparison { computed: 15.0, ..CLAIM }, Verdict::Unexplained),
            ("refuted with a reason", Comparison { computed: 12.0, has_reason: true, ..CLAIM }, Verdict::Refuted),
            ("holds against its reason", Comparison { has_reason: true, ..CLAIM }, Verdict::Outdated),
            (
                "refuted elsewhere than expected",
                Comparison { computed: 12.0, has_reason: true, expected: Some((11.0, 0.0)), ..CLAIM },
                Verdict::Moved,
            ),
        ] {
            assert_eq!(comparison.judge(), Ok(verdict), "{case}");
        }
    }

    #[test]
    fn rounded_inputs_reproduce_what_lies_between_the_least_and_the_largest_value() {
        // 2.316 ± 0.0005 beside 2.320, which is too much by itself.
        let rounded = |least, largest| Comparison { computed: 2.320, range: Some((least, largest)), ..PLAIN };
        let reason = |least, largest| Comparison { has_reason: true, ..rounded(least, largest) };
        for (case, comparison, reached, verdict) in [
            ("between", rounded(2.310, 2.330), true, Verdict::Reproduced),
            ("the least is inside the tolerance", rounded(2.3164, 2.330), true, Verdict::Reproduced),
            ("the least is on its edge", rounded(2.3165, 2.330), true, Verdict::Reproduced),
            ("the least is beyond it", rounded(2.316_51, 2.330), false, Verdict::Unexplained),
            ("all is below", rounded(2.310, 2.3154), false, Verdict::Unexplained),
            ("the largest is on the lower edge", rounded(2.310, 2.3155), true, Verdict::Reproduced),
            ("a reason that is not needed", reason(2.310, 2.330), true, Verdict::Outdated),
            ("a reason that is", reason(2.317, 2.330), false, Verdict::Explained),
            (
                "between, but at a pole",
                Comparison { is_broken: true, ..rounded(2.310, 2.330) },
                false,
                Verdict::Unexplained,
            ),
            ("a reason at a pole", Comparison { is_broken: true, ..reason(2.310, 2.330) }, false, Verdict::Explained),
            (
                "not where it was expected",
                Comparison { expected: Some((2.4, 0.01)), ..rounded(2.310, 2.330) },
                true,
                Verdict::Moved,
            ),
        ] {
            assert_eq!((comparison.is_reached(), comparison.judge()), (Some(reached), Ok(verdict)), "{case}");
        }
        assert_eq!(PLAIN.is_reached(), None);
    }

    #[test]
    fn what_is_no_number_gets_no_verdict() {
        for computed in [f64::NAN, f64::INFINITY] {
            let error = Comparison { computed, ..PLAIN }.judge().unwrap_err();
            assert!(error.contains("the computed value is"), "{error}");
        }
    }

    #[test]
    fn words_are_unique_and_attention_comes_first() {
        let mut words: Vec<_> = Verdict::ALL.iter().map(|verdict| verdict.word()).collect();
        words.sort_unstable();
        words.dedup();
        assert_eq!(words.len(), Verdict::ALL.len());
        assert!(Verdict::ALL.is_sorted_by_key(|verdict| !verdict.needs_attention()));
    }
}
