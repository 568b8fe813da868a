//! Pass or fail.

use serde::Serialize;

/// Outcome of a check, and of everything made of checks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Within its bound, or not gated.
    Pass,
    /// Outside its bound, or not a number.
    Fail,
}

impl Verdict {
    /// [`Verdict::Pass`] exactly if `ok`.
    pub fn of(ok: bool) -> Self {
        if ok { Verdict::Pass } else { Verdict::Fail }
    }

    /// Whether this is a pass.
    pub fn passed(self) -> bool {
        self == Verdict::Pass
    }

    /// In a word.
    pub fn words(self) -> &'static str {
        match self {
            Verdict::Pass => "pass",
            Verdict::Fail => "fail",
        }
    }

    /// Fail if any of `verdicts` is a fail; pass if there are none.
    pub fn all(verdicts: impl IntoIterator<Item = Verdict>) -> Self {
        Verdict::of(verdicts.into_iter().all(Verdict::passed))
    }
}

/// A verdict as people are told it: what nothing was asked of has not passed anything.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// Within all bounds.
    Pass,
    /// Within all bounds, some of them about a known discrepancy (a bias).
    PassAboutBias,
    /// Beyond a bound, or contradicting itself.
    Fail,
    /// Nothing is gated.
    NotGated,
}

impl Shown {
    /// Of checks with `verdict`, of which `gated` have a bound and `biased` a bias.
    pub fn of(verdict: Verdict, gated: usize, biased: usize) -> Self {
        match (verdict, gated, biased) {
            (Verdict::Fail, ..) => Shown::Fail,
            (Verdict::Pass, 0, _) => Shown::NotGated,
            (Verdict::Pass, _, 0) => Shown::Pass,
            (Verdict::Pass, ..) => Shown::PassAboutBias,
        }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Shown::Pass => "pass",
            Shown::PassAboutBias => "pass about a known discrepancy",
            Shown::Fail => "fail",
            Shown::NotGated => "not gated",
        }
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.words())
    }
}
